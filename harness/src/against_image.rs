//! `compare --against`: the errors of images against a truth image.
//!
//! They include those of shading, of shadows and of the G-buffer. Images that differ in no bit from no culling are not
//! kept, and have its errors.

use std::path::PathBuf;

use shading::{HdrImage, ShadingError};

use crate::{
    cli::{CliError, CompareArgs, PicturesChoice},
    error::HarnessError,
    image_errors::{ImagePair, errors, stored},
    pictures::Pictures,
    results::Results,
};

/// Metrics that are printed.
const PRINTED: [&str; 4] = ["flip", "rel_mse", "bias", "pixels_off"];

/// A truth image and its file.
pub(crate) struct TruthFile {
    path: PathBuf,
    image: HdrImage,
}

/// Reads the truth image of the arguments, before anything is measured.
///
/// # Errors
///
/// Where the file is no image, or of another size than the images; and with other pictures than all, which keep no
/// image to compare.
pub(crate) fn open(args: &CompareArgs) -> Result<Option<TruthFile>, HarnessError> {
    let Some(path) = &args.against else { return Ok(None) };
    let refuse = |accepted: &str| {
        Err(CliError::out_of_range("--against", &path.display().to_string(), accepted).into())
    };
    if args.pictures != PicturesChoice::All {
        return refuse(
            "left out with --pictures differing and none, which keep no image of no culling",
        );
    }
    let image = HdrImage::read_exr(path)?;
    let size = args.stage.size;
    if (image.width, image.height) != (size.width, size.height) {
        let (left, right) = ([size.width, size.height], [image.width, image.height]);
        return Err(ShadingError::Mismatch { left, right }.into());
    }
    Ok(Some(TruthFile { path: path.clone(), image }))
}

/// Stores the errors of every record whose image was kept; returns a line for each.
pub(crate) fn compare(
    results: &mut Results,
    pictures: &Pictures,
    truth: &TruthFile,
) -> Result<String, HarnessError> {
    let exposure = truth.image.auto_exposure();
    let mut lines = String::new();
    for record in &mut results.records {
        let Some(raw) = record.image.files.raw.as_deref() else { continue };
        let Some((_, bytes)) = pictures.iter().find(|(name, _)| name == raw) else { continue };
        let image = HdrImage::from_exr(bytes)?;
        let pair = ImagePair { image: &image, reference: &truth.image, exposure };
        let found = errors(&pair);
        let value =
            |id: &str| found.iter().find(|(known, _)| *known == id).map(|(_, value)| *value);
        let printed: Vec<String> =
            PRINTED.iter().filter_map(|id| Some(format!("{id} {:.5}", value(id)?))).collect();
        lines += &format!(
            "against  {}: {} in {}: {}\n",
            truth.path.display(),
            record.strategy,
            record.setting.mode.name(),
            printed.join(", ")
        );
        record.image.truth_errors = stored(found);
    }
    Ok(lines)
}
