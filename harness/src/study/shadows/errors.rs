//! The errors of all images against T of as many lights, and those of P.

use std::rc::Rc;

use shading::HdrImage;

use super::jobs::{COMPARED, SEPARATED};
use crate::{
    error::HarnessError,
    image_errors::{ImagePair, errors, stored},
    results::Errors,
    stored::Store,
    study::{against_truth::TRUTH, manifest::Done},
};

/// T of one number of lights.
struct Truth {
    lights: u64,
    image: Rc<HdrImage>,
    exposure: f32,
}

impl Truth {
    /// The errors of a stored image; `None` where it is missing.
    fn compare(
        &self,
        store: &mut Store<'_>,
        raw: Option<&str>,
    ) -> Result<Option<Errors>, HarnessError> {
        let image = store.image_like(raw, &self.image, "the truth")?;
        Ok(image.map(|image| {
            let (reference, exposure) = (&*self.image, self.exposure);
            stored(errors(&ImagePair { image: &image, reference, exposure }))
        }))
    }
}

/// Computes the errors of every image of a scene against its T, where both images are there.
///
/// # Errors
///
/// Where a file is no image, or of another size than the truth.
pub(crate) fn compare_with_truths(done: &mut Done) -> Result<(), HarnessError> {
    let scenes: Vec<String> = done.scenes().into_iter().map(str::to_owned).collect();
    for scene in &scenes {
        let truths = truths(done, scene)?;
        let truth_of = |lights: u64| truths.iter().find(|truth| truth.lights == lights);
        let sections = COMPARED.into_iter().chain([SEPARATED]);
        let jobs: Vec<String> = sections
            .flat_map(|section| done.section(scene, section).map(|(job, _)| job.name.clone()))
            .collect();
        for job in jobs {
            let Some(folder) = done.folders.get(&job) else { continue };
            let Some(results) = done.results.get_mut(&job) else { continue };
            let mut store = Store::new(folder);
            if let Some(separated) = &mut results.truth_image
                && let Some(truth) = truth_of(separated.lights)
                && let Some(found) = truth.compare(&mut store, Some(&separated.raw))?
            {
                separated.against_errors = found;
            }
            for record in &mut results.records {
                let Some(truth) = truth_of(record.setting.lights) else { continue };
                let raw = record.image.files.raw.as_deref();
                if let Some(found) = truth.compare(&mut store, raw)? {
                    record.image.truth_errors = found;
                }
            }
        }
    }
    Ok(())
}

/// The truth images of a scene that are there.
fn truths(done: &Done, scene: &str) -> Result<Vec<Truth>, HarnessError> {
    let mut all = Vec::new();
    for (job, results) in done.section(scene, TRUTH) {
        let (Some(truth), Some(folder)) = (&results.truth_image, done.folders.get(&job.name))
        else {
            continue;
        };
        let Some(image) = Store::new(folder).image(Some(&truth.raw))? else { continue };
        all.push(Truth { lights: truth.lights, image, exposure: truth.exposure as f32 });
    }
    Ok(all)
}
