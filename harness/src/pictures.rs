//! The images of a comparison: the reference that they are compared with, and the pictures that are kept.

use std::{path::Path, sync::Arc};

use rayon::prelude::*;
use shading::{HdrImage, Mode, heat_map_png};

use crate::{
    choice::Choice,
    cli::{CompareArgs, PicturesChoice},
    error::HarnessError,
    image_errors::{ImagePair, errors},
    measure::Checked,
    record::Seen,
    results::{Images, write_atomically},
};

/// Pictures of a report, PNG files, by name.
pub type Pictures = Vec<(String, Vec<u8>)>;

/// Gain of difference images: a difference of 1/64 is white.
const DIFFERENCE_GAIN: f32 = 64.0;

/// The images that those of one mode are compared with, and the exposure that all pictures of the mode share.
pub(crate) struct Reference {
    image: Arc<HdrImage>,
    unbounded: Option<HdrImage>,
    /// Errors of no culling against lights without a range.
    unbounded_errors: Vec<(&'static str, f64)>,
    pub(crate) exposure: f32,
    picture: Option<String>,
    /// Whether the linear image is kept too.
    is_linear: bool,
}

impl Reference {
    /// Keeps the images that others are compared with. Returns the pictures for the report. The linear image is kept with
    /// all pictures, or if some method `differs`.
    pub(crate) fn new(
        args: &CompareArgs,
        image: Arc<HdrImage>,
        unbounded: Option<HdrImage>,
        mode: Mode,
        differs: bool,
    ) -> Result<(Self, Pictures), HarnessError> {
        let is_linear = differs || args.unbounded || args.pictures == PicturesChoice::All;
        let exposure = image.auto_exposure();
        let mut picture = None;
        let mut pictures = Pictures::new();
        if args.pictures != PicturesChoice::None {
            let out = &args.out;
            let name = format!("{}-None.png", mode.name());
            let images = [
                Some((name.clone(), &*image)),
                unbounded.as_ref().map(|image| (format!("{}-unbounded.png", mode.name()), image)),
            ];
            let keep = |(name, image): (String, &HdrImage)| -> Result<_, HarnessError> {
                keep(out, &name, image.to_png(exposure)?, Some(image).filter(|_| is_linear))
            };
            let kept: Result<Pictures, _> =
                images.into_par_iter().flatten_iter().map(keep).collect();
            pictures = kept?;
            picture = Some(name);
        }
        let unbounded_errors = unbounded
            .as_ref()
            .map(|reference| errors(&ImagePair { image: &image, reference, exposure }))
            .unwrap_or_default();
        Ok((Self { image, unbounded, unbounded_errors, exposure, picture, is_linear }, pictures))
    }
}

/// Writes a picture, and the linear image that it shows. Returns the picture for the report.
fn keep(
    out: &Path,
    name: &str,
    png: Vec<u8>,
    raw: Option<&HdrImage>,
) -> Result<(String, Vec<u8>), HarnessError> {
    let path = out.join(name);
    write_atomically(&path, &png)?;
    if let Some(image) = raw {
        write_atomically(&path.with_extension("exr"), &image.to_exr()?)?;
    }
    Ok((name.to_owned(), png))
}

/// Compares a strategy's image with the reference, and keeps its pictures. Without a reference it does neither.
pub(crate) fn see(
    args: &CompareArgs,
    choice: &Choice,
    mode: Mode,
    checked: Checked,
    reference: Option<&Reference>,
) -> Result<(Seen, Pictures), HarnessError> {
    let is_control = choice.is_control();
    let Checked { image, lists } = checked;
    let mut seen = Seen::new(lists.unwrap_or_default(), is_control);
    let (Some(reference), Some(shown)) = (reference, image) else {
        return Ok((seen, Pictures::new()));
    };
    let exposure = reference.exposure;
    let pair = shown.pair(exposure);
    if !is_control {
        seen.compare(&shown, exposure, None)?;
        seen.unbounded_errors = match (&reference.unbounded, &pair) {
            (Some(unbounded), Some(pair)) => errors(&ImagePair { reference: unbounded, ..*pair }),
            _ => reference.unbounded_errors.clone(),
        };
    }
    if args.path {
        // Along a path, errors are means over the frames that are compared later.
        seen.forget_errors();
    }
    let mut pictures = Pictures::new();
    let Some(baseline) = &reference.picture else { return Ok((seen, pictures)) };
    let exr = |picture: &str| Some(picture.replace(".png", ".exr"));
    let raw = |picture: &str| exr(picture).filter(|_| reference.is_linear);
    let mut images = Images {
        baseline: Some(baseline.clone()),
        raw_baseline: raw(baseline),
        raw_unbounded: reference
            .unbounded
            .as_ref()
            .map(|_| format!("{}-unbounded.exr", mode.name())),
        exposure: Some(f64::from(exposure)),
        ..Images::default()
    };
    let stem = format!("{}-{}", mode.name(), choice.id().as_str().replace('/', "-"));
    if pair.is_none() {
        // An identical image is kept once.
        (images.tone_mapped, images.raw) = (Some(baseline.clone()), raw(baseline));
    }
    if let Some(ImagePair { image, .. }) = pair {
        let name = format!("{stem}.png");
        let exposure = if is_control { 1.0 } else { exposure };
        pictures.push(keep(&args.out, &name, image.to_png(exposure)?, Some(image))?);
        images.raw = exr(&name);
        images.tone_mapped = Some(name);
    }
    if let Some(ImagePair { image, .. }) = pair.filter(|_| !is_control) {
        let name = format!("{stem}-difference.png");
        let gain = DIFFERENCE_GAIN * exposure;
        let png = image.difference_png(&reference.image, gain)?;
        pictures.push(keep(&args.out, &name, png, None)?);
        images.difference = Some(name);
        images.difference_amplification = Some(f64::from(gain));
    }
    let lengths = &seen.lists.lengths.per_pixel;
    let is_wanted = args.pictures == PicturesChoice::All || pair.is_some();
    if is_wanted && !lengths.is_empty() {
        let name = format!("{stem}-heat.png");
        let png = heat_map_png(&reference.image, exposure, lengths)?;
        pictures.push(keep(&args.out, &name, png, None)?);
        images.heat_map = Some(name);
    }
    seen.images = images;
    Ok((seen, pictures))
}
