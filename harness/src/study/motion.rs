//! Lights that move in the jobs of a study: `--motion` in their commands, and what the page says of it.

use super::{
    job::Job,
    manifest::Done,
    scene::StudyScene,
    slice::{Study, TakesMotion},
};
use crate::{
    bench::Bench,
    cli::{self, CliError, Invocation, StudyArgs},
    error::HarnessError,
    grouping::grouped_by,
    report::living,
};

/// Has the jobs of a scene move their lights as the command line asks.
///
/// # Errors
///
/// Names why the study or the scene cannot take the motion: before a job runs.
pub(crate) fn set(
    study: &Study,
    bench: &mut Bench,
    args: &StudyArgs,
    scene: &StudyScene,
    jobs: &mut [Job],
) -> Result<(), HarnessError> {
    let changes = add(study, args, jobs)?;
    if changes { open(bench, scene, &args.motion.words()) } else { Ok(()) }
}

/// Adds the options to the jobs that take them. Returns whether there are any such options.
fn add(study: &Study, args: &StudyArgs, jobs: &mut [Job]) -> Result<bool, CliError> {
    let Some(motion) = args.motion.motion else { return Ok(false) };
    let still = match study.motion {
        TakesMotion::BySection => return Ok(false),
        TakesMotion::None(why) => {
            let accepted = format!("left out of study {}, because {why}", study.name);
            return Err(CliError::out_of_range("--motion", motion.name(), &accepted));
        }
        TakesMotion::AllBut(still) => still,
    };
    let moves = |job: &&mut Job| {
        job.command.get(1).is_some_and(|word| word == "compare")
            && !still.contains(&job.section.as_str())
    };
    for job in jobs.iter_mut().filter(moves) {
        job.command.extend(args.motion.words());
    }
    Ok(true)
}

/// Moves one light of the scene, so that an error shows at once.
fn open(bench: &mut Bench, scene: &StudyScene, motion: &[String]) -> Result<(), HarnessError> {
    let scale = scene.scale.to_string();
    let words = ["lightbench", "compare", "--scene", &scene.scene, "--scene-scale", &scale];
    let small = ["--size", "16x9", "--lights", "1"];
    let words = words.into_iter().chain(small).chain(motion.iter().map(String::as_str));
    if let Invocation::Compare(args) = cli::parse(words)? {
        bench.stage(&args.stage)?;
    }
    Ok(())
}

/// How the lights of a study move that moves them at the user's wish, a sentence per motion; none if they stand
/// still.
pub(crate) fn notices(study: &Study, done: &Done) -> Vec<String> {
    if matches!(study.motion, TakesMotion::BySection) || !study.tells_warnings {
        return Vec::new();
    }
    let of_job = |results: &crate::results::Results| {
        results.records.first().and_then(|record| living::motion_words(&record.setting))
    };
    let moving = done.results.iter().filter_map(|(job, results)| Some((of_job(results)?, job)));
    let sentence = |(words, jobs): (String, Vec<&String>)| {
        let jobs = match jobs.len() {
            count if count == done.results.len() => "every job".to_owned(),
            count => format!("{count} of {} jobs", done.results.len()),
        };
        format!(
            "The lights move in {jobs}: {words}. The times contain what that costs in each frame (upload, order, \
             boxes). Claims of papers are about lights that stand still."
        )
    };
    grouped_by(moving).into_iter().map(sentence).collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::study::list::named;

    fn jobs() -> Vec<Job> {
        let scene = StudyScene { scene: "atrium".into(), name: "atrium".into(), scale: 1.0 };
        let job = |(section, command): (&str, &str)| Job::new(&scene, section, "", &[command]);
        [("cost", "compare"), ("models", "compare"), ("truth", "truth")].map(job).into()
    }

    fn args(line: &str) -> StudyArgs {
        match cli::parse(["lightbench", "study"].into_iter().chain(line.split(' '))) {
            Ok(Invocation::Study(args)) => args,
            other => panic!("{line}: {other:?}"),
        }
    }

    #[test]
    fn comparisons_move_their_lights_and_other_jobs_do_not() {
        let mut moved = jobs();
        let args = args("area --motion orbit --speed 2");
        assert_eq!(add(named("area").unwrap(), &args, &mut moved), Ok(true));
        let commands: Vec<String> = moved.iter().map(|job| job.command[1..].join(" ")).collect();
        let cost = "compare --motion orbit --speed 2 --moved-by cpu";
        assert_eq!(commands, [cost, "compare", "truth"], "models stand still, as their truth does");
        for study in ["culling", "comparison", "endless"] {
            let mut moved = jobs();
            assert_eq!(add(named(study).unwrap(), &args, &mut moved), Ok(true));
            let with = moved.iter().filter(|job| job.option("--motion").is_some()).count();
            assert_eq!(with, 2, "{study}");
        }
    }

    #[test]
    fn a_study_whose_lights_cannot_move_says_why() {
        let mut still = jobs();
        let refused = add(named("cdi").unwrap(), &args("cdi --motion drift"), &mut still);
        let error = refused.expect_err("refused").to_string();
        assert!(
            error.starts_with("--motion is drift: it must be left out of study cdi"),
            "{error}"
        );
        assert_eq!(add(named("cdi").unwrap(), &args("cdi"), &mut still), Ok(false));
        assert_eq!(still, jobs());
    }
}
