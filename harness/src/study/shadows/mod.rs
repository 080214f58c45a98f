//! Shadows of area lights by many shadow maps (Dobetsberger 2025, chapter 6): how far images are from the truth by the
//! number of maps, their size, their filter and the number of lights in one atlas.
//!
//! Each job draws four rectangles (or the number that it names) without culling. So no error comes from lists and no
//! time from assignment. Errors are those against T, the truth with shadows. P is the exact visible share times the
//! exact light without shadows. Its own error against T is the floor: no model of visible shares is below it. Another
//! floor is the error of the pipeline without shadows against the truth without shadows: G-buffer, textures, area-light
//! model.

mod cells;
mod claims;
mod jobs;
mod lod;
mod occlusion;
mod page;
mod rays;
mod roughness;

use super::against_truth::{TruthOf, compare_with_truths};
use super::job::Job;
use super::scene::StudyScene;
use super::slice::{Study, TakesMotion, atrium};
use crate::bench::Bench;
use crate::cli::StudyArgs;
use crate::error::HarnessError;
use crate::report::markup::Html;

/// The study of shadow maps.
pub(crate) const STUDY: Study = Study {
    name: "shadows",
    answers: "How far shadow maps of area lights are from the truth, by their number, size and filter, and by the lights in one atlas",
    scenes: atrium,
    jobs: all_jobs,
    motion: TakesMotion::None(
        "its times of moving lights are sums of the times of drawing and shading",
    ),
    after_run: |done| compare_with_truths(done, &jobs::AGAINST, TruthOf::Alike(jobs::ALIKE)),
    headline: page::headline,
    findings: page::findings,
    front: |_| Html::default(),
    parts: page::parts,
    overall: |_| Html::default(),
    paper: &claims::PAPER,
    tells_warnings: true,
    notices: |_| Vec::new(),
};

/// The jobs of all sections.
///
/// # Errors
///
/// Names what is wrong with the scene: a scene that cannot be opened shows before anything is written.
fn all_jobs(
    bench: &mut Bench,
    args: &StudyArgs,
    scene: &StudyScene,
) -> Result<Vec<Job>, HarnessError> {
    let ([core, _], _) = scene.boxes(bench)?;
    let range_m = core.diagonal() * jobs::RANGE_SHARE;
    let stops = jobs::stops(bench, args, scene, range_m)?;
    Ok(plan(args, scene, range_m, &stops))
}

fn plan(args: &StudyArgs, scene: &StudyScene, range_m: f32, stops: &[jobs::Stop]) -> Vec<Job> {
    let mut all = jobs::jobs(args, scene, range_m, stops);
    all.extend(rays::jobs(args, scene, range_m));
    all.extend(roughness::jobs(args, scene, range_m));
    all.extend(lod::jobs(args, scene, range_m));
    all.push(occlusion::job(args, scene, jobs::extent_of(args)));
    all
}

#[cfg(test)]
mod tests {
    use super::jobs::{AGAINST, ALIKE, APPROACH, COMPARED, Stop};
    use super::jobs::{LOD, LOD_TRUTH, RAYS, SEPARATED_BY, TRUTH_BY};
    use super::*;
    use crate::checks::check_options;
    use crate::cli::{Invocation, parse};

    fn planned(line: &str) -> Vec<Job> {
        let words = ["lightbench", "study", "shadows"].into_iter().chain(line.split_whitespace());
        let Ok(Invocation::Study(args)) = parse(words) else { panic!("{line}: a study") };
        let args = args.with_scenes(|_| vec!["atrium".to_owned()]);
        let scenes = StudyScene::all(&args).expect("scenes");
        let stops = [Stop { camera: "-1.5,2,0:0,1,0.25".into(), distance_m: 3.5 }];
        scenes.iter().flat_map(|scene| plan(&args, scene, 10.0, &stops)).collect()
    }

    #[test]
    fn every_job_is_a_command_and_every_image_has_a_truth_of_the_same_options() {
        for line in ["", "--quick"] {
            let jobs = planned(line);
            for job in &jobs {
                assert!(parse(&job.command).is_ok(), "{:?}", job.command);
                let Some((_, truth)) = AGAINST.iter().find(|(section, _)| *section == job.section)
                else {
                    continue;
                };
                let alike = |other: &Job| {
                    ALIKE.iter().all(|option| other.option(option) == job.option(option))
                };
                let truths = jobs.iter().filter(|other| other.section == *truth);
                assert_eq!(truths.filter(|other| alike(other)).count(), 1, "{}", job.name);
            }
            for section in COMPARED.into_iter().chain([APPROACH]) {
                assert!(jobs.iter().any(|job| job.section == section), "{line}: {section}");
            }
        }
    }

    #[test]
    fn sections_have_as_many_jobs_as_they_vary() {
        for (line, counts) in [("", [14, 10, 8]), ("--quick", [4, 4, 4])] {
            let jobs = planned(line);
            let sections: [&[&str]; 3] = [&[RAYS], &[SEPARATED_BY, TRUTH_BY], &[LOD, LOD_TRUTH]];
            let found = sections.map(|sections| {
                jobs.iter().filter(|job| sections.contains(&job.section.as_str())).count()
            });
            assert_eq!(found, counts, "{line}");
        }
    }

    #[test]
    fn jobs_of_rays_are_not_refused() {
        for line in ["", "--quick"] {
            for job in planned(line).iter().filter(|job| job.section == RAYS) {
                let Ok(Invocation::Compare(compare)) = parse(&job.command) else {
                    panic!("{:?}", job.command)
                };
                let choices = compare.choices().expect("strategies");
                check_options(&compare, &choices).expect("accepted");
            }
        }
    }
}
