//! The error of the models of a study against its truth image: an error of shading, never of culling.

use super::job::Job;
use super::manifest::Done;
use crate::{
    error::HarnessError,
    image_errors::{ImagePair, errors, stored},
    results::{Results, TruthImage},
    stored::Store,
};

/// The section of a study whose jobs render the truth images of its scenes.
pub const TRUTH: &str = "truth";

/// The section whose images are compared with them.
pub const MODELS: &str = "models";

/// Computes the errors of every record of [`MODELS`] against the truth image of its scene, where both
/// images are there.
///
/// # Errors
///
/// Where a file is no image, or of another size than the truth.
pub(crate) fn compare_with_truth(done: &mut Done) -> Result<(), HarnessError> {
    let scenes: Vec<String> = done.scenes().into_iter().map(str::to_owned).collect();
    for scene in &scenes {
        let Some((job, truth)) = truth_of(done, scene) else { continue };
        let Some(folder) = done.folders.get(&job.name) else { continue };
        let Some(reference) = Store::new(folder).image(Some(&truth.raw))? else { continue };
        let exposure = truth.exposure as f32;
        let models: Vec<String> =
            done.section(scene, MODELS).map(|(job, _)| job.name.clone()).collect();
        for model in models {
            let Some(folder) = done.folders.get(&model) else { continue };
            let Some(results) = done.results.get_mut(&model) else { continue };
            let mut store = Store::new(folder);
            for record in &mut results.records {
                let raw = record.image.files.raw.as_deref();
                let Some(image) = store.image_like(raw, &reference, "the truth")? else { continue };
                let pair = ImagePair { image: &image, reference: &reference, exposure };
                record.image.truth_errors = stored(errors(&pair));
            }
        }
    }
    Ok(())
}

/// The truth image of a scene, with its job.
pub fn truth_of<'a>(done: &'a Done, scene: &'a str) -> Option<(&'a Job, &'a TruthImage)> {
    let with_image =
        |(job, results): (&'a Job, &'a Results)| Some((job, results.truth_image.as_ref()?));
    done.section(scene, TRUTH).find_map(with_image)
}
