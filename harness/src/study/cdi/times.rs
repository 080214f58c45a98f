//! Which times of deep images and rays count: those of a steady, risen clock. The others stand in the
//! tables, struck out, and decide nothing.

use crate::drift::slower_than_again;
use crate::report::format::significant;
use crate::report::markup::{Html, html};
use crate::results::{CastTimes, DeepImageRun, DeepImages};
use crate::study::cdi::jobs;
use crate::study::manifest::Done;

/// The paper's card, for every figure of its own.
pub(crate) const PAPER: &str = "Archer, Leach and Knowles 2019, on a GTX 1060";

/// The runs of `lightbench cdi` of a section.
pub(crate) fn runs<'a>(done: &'a Done, scene: &'a str, section: &'a str) -> Vec<&'a DeepImageRun> {
    done.section(scene, section).filter_map(|(_, results)| results.deep_images.as_ref()).collect()
}

/// Those whose builds were timed at a steady, risen clock.
pub(crate) fn timed_runs<'a>(
    done: &'a Done,
    scene: &'a str,
    section: &'a str,
) -> Vec<&'a DeepImageRun> {
    let all = runs(done, scene, section).into_iter();
    all.filter(|run| refused_build(done, scene, run).is_none()).collect()
}

/// Why the times of a build do not count. They drift, or another job of the study did the same work
/// much faster: then this one ran at a low clock throughout.
pub(crate) fn refused_build(done: &Done, scene: &str, run: &DeepImageRun) -> Option<String> {
    if let Some(why) = run.unsteady() {
        return Some(why);
    }
    let sections = [jobs::BUILDS, jobs::CASTS].into_iter();
    let same = sections
        .flat_map(|section| runs(done, scene, section))
        .filter(|other| other.scene_hash == run.scene_hash && is_same_work(&other.deep, &run.deep));
    let steady = same.filter(|other| other.unsteady().is_none());
    let least = steady.map(DeepImageRun::build_ms).fold(f64::INFINITY, f64::min);
    let build_ms = run.build_ms();
    slower_than_again(build_ms, least).then(|| {
        format!(
            "another job of this study took {} ms for the same work, this one {}",
            significant(least),
            significant(build_ms)
        )
    })
}

/// Whether two builds make the same images in the same way. How much memory grew does not matter.
fn is_same_work(a: &DeepImages, b: &DeepImages) -> bool {
    let work = |deep: &DeepImages| DeepImages { bytes: 0, ..deep.clone() };
    work(a) == work(b)
}

/// The times of rays of a run that count: those after the last that drift, for the clock rose there.
/// Where the build was timed at a low clock and no rays drift, nothing tells when it rose: none counts.
pub(crate) fn timed_casts<'a>(
    done: &Done,
    scene: &str,
    run: &'a DeepImageRun,
) -> Vec<&'a CastTimes> {
    let from = match run.casts.iter().rposition(|cast| cast.unsteady().is_some()) {
        Some(last) => last + 1,
        None if refused_build(done, scene, run).is_some() => run.casts.len(),
        None => 0,
    };
    run.casts.iter().skip(from).collect()
}

/// A time for a table: struck out where it does not count.
pub(crate) fn shown(ms: f64, counts: bool) -> Html {
    let text = significant(ms);
    if counts { text.into() } else { html!("<s>{}</s>", text) }
}

/// What a reader must know: which times are struck out, and which lights the errors belong to.
pub(crate) fn notices(done: &Done) -> Vec<String> {
    let mut notices = Vec::new();
    for scene in done.scenes() {
        let jobs = [jobs::BUILDS, jobs::CASTS]
            .into_iter()
            .flat_map(|section| done.section(scene, section));
        for (job, results) in jobs {
            let Some(run) = results.deep_images.as_ref() else { continue };
            // The job's own warning already stands among the notices.
            if results.warnings.iter().any(|warning| warning.contains("are refused")) {
                continue;
            }
            if let Some(why) = refused_build(done, scene, run) {
                notices.push(format!("{}: times of its build are left out: {why}.", job.name));
            }
            let counted = timed_casts(done, scene, run);
            let left_out = run.casts.len() - counted.len();
            if left_out > 0 {
                notices.push(format!(
                    "{}: {left_out} of {} times of rays are left out because the clock was still \
                     rising.",
                    job.name,
                    run.casts.len()
                ));
            }
        }
    }
    let lights = || {
        done.results.iter().flat_map(|(job, results)| {
            let with_job = move |record| Some((job, Option::as_ref(record)?));
            results.records.iter().map(|record| &record.indirect).filter_map(with_job)
        })
    };
    for (job, vpls) in lights() {
        if let Some(why) = vpls.unsteady() {
            notices.push(format!("{job}: the times of making its lights are left out: {why}."));
        }
    }
    if lights().any(|(_, vpls)| !vpls.has_fresnel) {
        notices.push(
            "An older program measured these results without Fresnel\u{2019}s term in diffuse \
             reflection, so their lights are 4 to 7 % too bright. Measure the errors against the \
             truth again. Times are not affected."
                .to_owned(),
        );
    }
    notices
}

#[cfg(test)]
mod tests {
    use std::collections::BTreeMap;

    use super::*;
    use crate::results::{
        DeviceType, Machine, PassKind, PassTimes, Passes, Results, Truth, TruthLevel,
    };
    use crate::study::job::{Job, Settings};
    use crate::study::manifest::Manifest;

    fn run(build_ms: f64, cast_ms: &[&[f64]]) -> DeepImageRun {
        let cast = |ms: &&[f64]| CastTimes { cast_ms: ms.to_vec(), ..CastTimes::default() };
        let samples = PassTimes::new(PassKind::Assign, vec![build_ms; 32]);
        DeepImageRun {
            scene: "town".into(),
            scene_hash: "1".into(),
            triangles: 1,
            deep: DeepImages { build: "compute".into(), ..DeepImages::default() },
            passes: Passes::from_iter([("cdi-count", samples)]),
            casts: cast_ms.iter().map(cast).collect(),
            range_errors: None,
            corrected_errors: None,
        }
    }

    fn done(runs: Vec<(&str, DeepImageRun)>) -> Done {
        let machine = Machine {
            adapter: "GPU".into(),
            driver: String::new(),
            backend: String::new(),
            device_type: DeviceType::DiscreteGpu,
            cpu: String::new(),
            os: String::new(),
            commit: String::new(),
            date: String::new(),
            rustc: None,
        };
        let job = |ix: usize, section: &str| Job {
            name: format!("town-{ix}"),
            scene: "town".into(),
            section: section.into(),
            settings: Settings::default(),
            command: Vec::new(),
        };
        let jobs: Vec<Job> =
            runs.iter().enumerate().map(|(ix, (section, _))| job(ix, section)).collect();
        let truth = Truth { level: TruthLevel::None, edge_tolerance: 0.0, notes: Vec::new() };
        let results = jobs.iter().zip(runs).map(|(job, (_, run))| {
            let mut results = Results::new(machine.clone(), Vec::new(), truth.clone());
            results.deep_images = Some(run);
            (job.name.clone(), results)
        });
        let results: BTreeMap<String, Results> = results.collect();
        let manifest = Manifest::new(Vec::new(), "cdi", jobs);
        Done { manifest, results, folders: BTreeMap::new() }
    }

    /// As `town-casts` of the results of 2026-11-25: a build of 0.967 ms that took 0.316 in another job,
    /// and rays that become faster at the second map.
    #[test]
    fn a_build_at_a_low_clock_is_left_out_though_it_is_steady() {
        let rising = [[0.138; 16], [0.122; 16]].concat();
        let casts: [&[f64]; 3] = [&[0.144; 32], &rising, &[0.166; 32]];
        let done = done(vec![
            (jobs::BUILDS, run(0.316, &[])),
            (jobs::CASTS, run(0.967, &casts)),
            (jobs::BUILDS, run(0.33, &[])),
        ]);
        let cold = runs(&done, "town", jobs::CASTS)[0];
        let why = refused_build(&done, "town", cold).expect("refused");
        assert!(why.contains("0.316 ms") && why.contains("0.967"), "{why}");
        assert_eq!(timed_runs(&done, "town", jobs::BUILDS).len(), 2);
        assert!(timed_runs(&done, "town", jobs::CASTS).is_empty());
        let counted = timed_casts(&done, "town", cold);
        assert_eq!(counted.len(), 1, "what came before the clock rose is left out");
        assert_eq!(counted[0].cast_ms[0], 0.166);
        assert_eq!(notices(&done).len(), 2, "{:?}", notices(&done));
    }

    #[test]
    fn without_a_rise_no_ray_of_a_cold_job_counts() {
        let steady: [&[f64]; 2] = [&[0.144; 32], &[0.166; 32]];
        let both =
            |other| done(vec![(jobs::BUILDS, run(other, &[])), (jobs::CASTS, run(0.967, &steady))]);
        let counted =
            |done: &Done| timed_casts(done, "town", runs(done, "town", jobs::CASTS)[0]).len();
        assert_eq!(counted(&both(0.316)), 0);
        assert_eq!(counted(&both(0.95)), 2);
    }
}
