//! The errors of a study's images against its truth images: errors of shading, never of culling.

use std::rc::Rc;

use shading::HdrImage;

use super::job::Job;
use super::manifest::Done;
use crate::{
    error::HarnessError,
    image_errors::{ImagePair, errors, stored},
    results::{Errors, Results, TruthImage},
    stored::Store,
};

/// The section of a study whose jobs render the truth images of its scenes.
pub const TRUTH: &str = "truth";

/// The section of area-light models, whose images are compared with them.
pub const MODELS: &str = "models";

/// Sections whose images are compared, each with the section of its truth images.
pub(crate) type Compared = [(&'static str, &'static str)];

/// Which truth image of a section an image is compared with.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum TruthOf {
    /// The only one of the scene. Its lights may be others: virtual ones stand for those of the truth.
    Scene,
    /// The one whose job has the same values of these options.
    Alike(&'static [&'static str]),
}

/// A truth image.
struct Truth {
    /// The options that [`TruthOf::Alike`] compares, as its job has them.
    options: Vec<Option<String>>,
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

/// Computes the errors of every image of these sections against its truth image, where both images are there.
///
/// # Errors
///
/// Where a file is no image, or of another size than the truth.
pub(crate) fn compare_with_truths(
    done: &mut Done,
    compared: &Compared,
    by: TruthOf,
) -> Result<(), HarnessError> {
    let scenes: Vec<String> = done.scenes().into_iter().map(str::to_owned).collect();
    for (scene, (section, truth)) in
        scenes.iter().flat_map(|scene| compared.iter().map(move |pair| (scene, *pair)))
    {
        let truths = truths(done, scene, truth, by)?;
        let jobs: Vec<(String, Vec<Option<String>>)> = done
            .section(scene, section)
            .map(|(job, _)| (job.name.clone(), options(job, by)))
            .collect();
        for (job, options) in jobs {
            let Some(truth) = truths.iter().find(|truth| truth.options == options) else {
                continue;
            };
            let Some(folder) = done.folders.get(&job) else { continue };
            let Some(results) = done.results.get_mut(&job) else { continue };
            let mut store = Store::new(folder);
            if let Some(image) = &mut results.truth_image
                && let Some(found) = truth.compare(&mut store, Some(&image.raw))?
            {
                image.against_errors = found;
            }
            for record in &mut results.records {
                let raw = record.image.files.raw.as_deref();
                if let Some(found) = truth.compare(&mut store, raw)? {
                    record.image.truth_errors = found;
                }
            }
        }
    }
    Ok(())
}

/// The truth images of a scene and a section that are there.
fn truths(
    done: &Done,
    scene: &str,
    section: &str,
    by: TruthOf,
) -> Result<Vec<Truth>, HarnessError> {
    let mut all = Vec::new();
    for (job, results) in done.section(scene, section) {
        let (Some(truth), Some(folder)) = (&results.truth_image, done.folders.get(&job.name))
        else {
            continue;
        };
        let Some(image) = Store::new(folder).image(Some(&truth.raw))? else { continue };
        all.push(Truth { options: options(job, by), image, exposure: truth.exposure as f32 });
    }
    Ok(all)
}

/// What decides which truth image belongs to a job.
fn options(job: &Job, by: TruthOf) -> Vec<Option<String>> {
    let TruthOf::Alike(names) = by else { return Vec::new() };
    names.iter().map(|name| job.option(name).map(str::to_owned)).collect()
}

/// The truth image of a scene, with its job.
pub fn truth_of<'a>(done: &'a Done, scene: &'a str) -> Option<(&'a Job, &'a TruthImage)> {
    let with_image =
        |(job, results): (&'a Job, &'a Results)| Some((job, results.truth_image.as_ref()?));
    done.section(scene, TRUTH).find_map(with_image)
}
