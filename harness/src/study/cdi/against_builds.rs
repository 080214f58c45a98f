//! Compares images by the build of their deep images: the same lights, with ranges through deep images of
//! one pass over the triangles and of one pass per direction.

use crate::study::against_truth::MODELS;
use crate::study::manifest::Done;
use crate::{
    error::HarnessError,
    image_errors::{ImagePair, errors, stored},
    results::{Results, Vpls},
    stored::Store,
};

/// The build that the others are compared with.
const SINGLE_PASS: &str = "compute";

/// Computes how far the image of each record of [`MODELS`] whose deep images were built otherwise is
/// from that of the record with the same settings and `SINGLE_PASS`, where both images are there.
///
/// # Errors
///
/// Where a file is no image, or the two are of different sizes.
pub(crate) fn compare_builds(done: &mut Done) -> Result<(), HarnessError> {
    let jobs: Vec<(String, String)> = done
        .manifest
        .jobs
        .iter()
        .filter(|job| job.section == MODELS)
        .map(|job| (job.scene.clone(), job.name.clone()))
        .collect();
    for (scene, name) in &jobs {
        let Some(own) = done.results.get(name).and_then(vpls_of) else { continue };
        if own.deep.as_ref().is_none_or(|deep| deep.build == SINGLE_PASS) {
            continue;
        }
        let is_reference = |other: &&String| {
            let known = done.results.get(*other).and_then(vpls_of);
            known.is_some_and(|known| differs_by_build(own, known))
        };
        let others = jobs.iter().filter(|(of, _)| of == scene).map(|(_, name)| name);
        let Some(reference_job) = others.clone().find(is_reference) else { continue };
        let raw = |job: &str| {
            let record = done.results.get(job)?.records.last()?;
            Some((record.image.files.raw.clone()?, record.image.files.exposure))
        };
        let (Some((reference_raw, exposure)), Some((own_raw, _))) = (raw(reference_job), raw(name))
        else {
            continue;
        };
        let folders = [reference_job, name].map(|job| done.folders.get(job));
        let [Some(reference_folder), Some(own_folder)] = folders else { continue };
        let Some(reference) = Store::new(reference_folder).image(Some(&reference_raw))? else {
            continue;
        };
        let what = "the image through deep images of one pass";
        let Some(image) = Store::new(own_folder).image_like(Some(&own_raw), &reference, what)?
        else {
            continue;
        };
        let exposure = exposure.map_or(1.0, |exposure| exposure as f32);
        let found = stored(errors(&ImagePair { image: &image, reference: &reference, exposure }));
        let records = done.results.get_mut(name).map(|results| &mut results.records);
        for record in records.into_iter().flatten() {
            if let Some(vpls) = &mut record.indirect {
                vpls.build_errors.clone_from(&found);
            }
        }
    }
    Ok(())
}

fn vpls_of(results: &Results) -> Option<&Vpls> {
    results.records.last()?.indirect.as_ref()
}

/// Whether two sets of lights differ in nothing but the build of their deep images, the second being
/// of one pass.
fn differs_by_build(own: &Vpls, reference: &Vpls) -> bool {
    let setting = |vpls: &Vpls| {
        let deep = vpls.deep.as_ref()?;
        Some((
            (vpls.rsm_px, vpls.ranges.clone(), vpls.rays, vpls.is_reflected, vpls.is_corrected),
            (vpls.range_scale, vpls.given_ranges_m, vpls.spacing_m, vpls.clamp_m),
            (deep.stacks, deep.slices, deep.spread.clone(), deep.size_px, deep.oversampling),
        ))
    };
    let build = reference.deep.as_ref().map(|deep| deep.build.as_str());
    build == Some(SINGLE_PASS) && setting(own) == setting(reference)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::results::DeepImages;

    #[test]
    fn only_the_build_may_differ() {
        let vpls = |build: &str, rays| Vpls {
            rays,
            deep: Some(DeepImages { build: build.into(), ..DeepImages::default() }),
            ..Vpls::default()
        };
        assert!(differs_by_build(&vpls("per-direction", 6), &vpls("compute", 6)));
        assert!(!differs_by_build(&vpls("per-direction", 6), &vpls("compute", 3)));
        assert!(!differs_by_build(&vpls("per-direction", 6), &vpls("fragment", 6)));
        assert!(!differs_by_build(&vpls("per-direction", 6), &Vpls::default()));
    }
}
