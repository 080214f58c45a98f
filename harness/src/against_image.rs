//! `compare --against` and `truth --against`: the errors of images against a truth image.
//!
//! They include those of shading, of shadows and of the G-buffer.

use std::path::{Path, PathBuf};

use shading::{HdrImage, ShadingError};

use crate::{
    cli::Size,
    error::HarnessError,
    image_errors::{ImagePair, errors, stored},
    results::{Errors, Results},
    stored::Store,
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
/// Where the file is no image, or of another size than the images.
pub(crate) fn open(path: Option<&Path>, size: Size) -> Result<Option<TruthFile>, HarnessError> {
    let Some(path) = path else { return Ok(None) };
    let image = HdrImage::read_exr(path)?;
    if (image.width, image.height) != (size.width, size.height) {
        let (left, right) = ([size.width, size.height], [image.width, image.height]);
        return Err(ShadingError::Mismatch { left, right }.into());
    }
    Ok(Some(TruthFile { path: path.to_owned(), image }))
}

impl TruthFile {
    /// The errors of an image against it, and a line about them.
    pub(crate) fn compare(&self, name: &str, image: &HdrImage) -> (Errors, String) {
        let exposure = self.image.auto_exposure();
        let found = errors(&ImagePair { image, reference: &self.image, exposure });
        let known = |id: &str| found.iter().find(|(known, _)| *known == id);
        let printed: Vec<String> = PRINTED
            .iter()
            .filter_map(|id| known(id).map(|(_, value)| format!("{id} {value:.5}")))
            .collect();
        let line = format!("against  {}: {name}: {}\n", self.path.display(), printed.join(", "));
        (stored(found), line)
    }
}

/// Stores the errors of every record whose image was kept in the folder `out`; returns a line for each.
pub(crate) fn compare(
    results: &mut Results,
    out: &Path,
    truth: &TruthFile,
) -> Result<String, HarnessError> {
    let mut store = Store::new(out);
    let mut lines = String::new();
    for record in &mut results.records {
        let raw = record.image.files.raw.as_deref();
        let Some(image) = store.image(raw)? else { continue };
        let name = format!("{} in {}", record.strategy, record.setting.mode.name());
        let (found, line) = truth.compare(&name, &image);
        record.image.truth_errors = found;
        lines += &line;
    }
    Ok(lines)
}
