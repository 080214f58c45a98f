//! Studies: lists of comparisons, each a job of its own, so that a study goes on where it was
//! interrupted and can be split over machines.
//!
//! A job is a `lightbench compare`, `truth` or `cdi` command. Its folder, `jobs/NAME`, holds what that
//! command writes. A job is done where its `results.json` is there, whole and with all records of its
//! command. `study.json` beside `jobs` lists all jobs, those of other shards too.

mod against_builds;
mod against_truth;
mod area;
pub mod cdi;
mod comparison;
mod culling;
mod endless;
mod frames;
mod manifest;
mod scene;
mod views;

use std::path::{Path, PathBuf};
use std::time::Instant;

use crate::{
    bench::Bench,
    checks::check_options,
    cli::{self, CdiArgs, CliError, CompareArgs, Invocation, StudyArgs, StudyName, TruthArgs},
    compare::compare_on,
    deep_image_run::measure,
    error::HarnessError,
    messages::say,
    out_folder::OutFolder,
    report,
    results::{Results, ResultsError},
    truth::render,
};

pub use against_builds::compare_builds;
pub use against_truth::{compare_with_truth, truth_of};
pub use manifest::{Done, Job, Manifest};
pub use scene::StudyScene;

/// The section of a study whose jobs render the truth images of its scenes.
pub const TRUTH: &str = "truth";

/// The section whose images are compared with them.
pub const MODELS: &str = "models";

/// The section whose records list area lights by their outlines and by balls around them.
pub const BOUNDS: &str = "bounds";

/// Runs a study, or a share of it, and writes its report; returns what to print. `command` is the command
/// line, which others see who want the same folder.
pub fn study(args: &StudyArgs, command: &[String]) -> Result<String, HarnessError> {
    let scenes = StudyScene::all(args)?;
    let out = &args.folder();
    let _held = OutFolder::hold(out, command)?;
    let wanted = args.identity();
    let known = Manifest::find(out)?;
    if let Some(known) = known.as_ref().filter(|known| known.identity != wanted) {
        let value = out.display().to_string();
        let accepted = format!(
            "a folder without a study or with this study; it holds `{}`: choose another --out",
            known.identity.join(" ")
        );
        return Err(CliError::out_of_range("--out", &value, &accepted).into());
    }
    let mut bench = Bench::open(args.adapter.as_deref())?;
    let is_new = known.is_none();
    let manifest = match known {
        Some(known) => known,
        None => Manifest {
            identity: wanted,
            study: args.study.name().into(),
            jobs: jobs_of(&mut bench, args, &scenes)?,
        },
    };
    // What is wrong with a job shows before the first is run, and before anything is written.
    manifest.jobs.iter().try_for_each(Job::check).map_err(|error| match is_new {
        true => error,
        false => CliError::new(format!(
            "{}: {error}: another version of lightbench listed these jobs; choose another --out",
            out.display()
        )),
    })?;
    let mine = share(args, &manifest)?;
    if is_new {
        manifest.write(out)?;
    }
    run(&mut bench, out, &mine)?;
    let mut done = Done::read(std::slice::from_ref(out))?;
    compare_with_truth(&mut done)?;
    compare_builds(&mut done)?;
    done.write_metrics()?;
    report::write_study(&done, out)
}

/// The jobs of all scenes of a study.
fn jobs_of(
    bench: &mut Bench,
    args: &StudyArgs,
    scenes: &[StudyScene],
) -> Result<Vec<Job>, HarnessError> {
    let mut jobs = Vec::new();
    for scene in scenes {
        jobs.extend(match args.study {
            StudyName::Comparison => comparison::jobs(bench, args, scene)?,
            StudyName::Culling => {
                // A scene that cannot be opened shows before anything is written.
                scene.boxes(bench)?;
                culling::jobs(args, scene)
            }
            StudyName::Area => area::jobs(bench, args, scene)?,
            StudyName::Endless => endless::jobs(bench, args, scene)?,
            StudyName::Cdi => cdi::jobs(bench, args, scene)?,
        });
    }
    Ok(jobs)
}

/// The jobs that are chosen, those of this shard.
fn share<'a>(args: &StudyArgs, manifest: &'a Manifest) -> Result<Vec<&'a Job>, CliError> {
    let chosen: Vec<&Job> = manifest.jobs.iter().filter(|job| args.wants(&job.name)).collect();
    if chosen.is_empty() && !args.only.is_empty() {
        let (known, others) = manifest.jobs.split_at(manifest.jobs.len().min(NAMED));
        let known: Vec<&str> = known.iter().map(|job| job.name.as_str()).collect();
        let more =
            if others.is_empty() { String::new() } else { format!(" and {} more", others.len()) };
        let accepted = format!("words from job names, such as {}{more}", known.join(", "));
        return Err(CliError::out_of_range("--only", &args.only.join(","), &accepted));
    }
    let jobs = chosen.into_iter().enumerate();
    Ok(jobs.filter(|(ix, _)| args.shard.holds(*ix)).map(|(_, job)| job).collect())
}

/// Names of jobs that a message lists.
const NAMED: usize = 6;

/// Runs the jobs that are not done.
fn run(bench: &mut Bench, out: &Path, mine: &[&Job]) -> Result<(), HarnessError> {
    let began = Instant::now();
    // What stands in the way of the last job shows before the first is run.
    let mut open = Vec::new();
    for (ix, job) in mine.iter().enumerate() {
        if !is_done(bench, job, &job.folder(out))? {
            open.push((ix, job));
        }
    }
    for (ix, job) in open {
        let folder = job.folder(out);
        let seconds = began.elapsed().as_secs();
        let (at, of) = (ix + 1, mine.len());
        say(format!("job      {at} of {of}, {seconds} s so far: {}", job.name));
        let asked = job.asked(&folder)?;
        // What an interrupted run left there is not this one's.
        if folder.is_dir() {
            std::fs::remove_dir_all(&folder)
                .map_err(|source| ResultsError::Write { path: folder.clone(), source })?;
        }
        let results = match asked {
            Asked::Compare(args) => compare_on(bench, &args, job.command.clone())?.0,
            Asked::Truth(args) => render(bench, &args, job.command.clone())?,
            Asked::Cdi(args) => measure(bench, &args, job.command.clone())?,
        };
        results.write(&folder.join("results.json"))?;
    }
    Ok(())
}

/// Whether a job was done, by this commit on this adapter: an error where by another. Results that are
/// damaged or incomplete are none, and the job runs again.
fn is_done(bench: &Bench, job: &Job, folder: &Path) -> Result<bool, HarnessError> {
    let path = folder.join("results.json");
    if !path.is_file() {
        return Ok(false);
    }
    let again = |why: &dyn std::fmt::Display| {
        say(format!("warning  job {} runs again: {why}", job.name));
        Ok(false)
    };
    let (results, lack) = match Results::read_checked(&path) {
        Ok(read) => read,
        Err(error @ ResultsError::Version { .. }) => return Err(error.into()),
        Err(error) => return again(&error),
    };
    let (then, now) = (&results.machine, bench.machine());
    if then.identity() != now.identity() {
        return Err(CliError::new(format!(
            "{}: measured on {} by commit {}, this is {} and commit {}: --out must be another folder",
            path.display(),
            then.adapter,
            then.commit,
            now.adapter,
            now.commit,
        ))
        .into());
    }
    if results.command != job.command {
        return again(&format!("{} belongs to another command", path.display()));
    }
    match lack {
        Some(lack) => again(&format!("{}: {lack}", path.display())),
        None => Ok(true),
    }
}

/// What a job asks for.
#[allow(clippy::large_enum_variant, reason = "one value a job")]
enum Asked {
    /// A comparison.
    Compare(CompareArgs),
    /// A truth image.
    Truth(TruthArgs),
    /// Deep images.
    Cdi(CdiArgs),
}

impl Job {
    /// The job's folder in that of its study.
    pub fn folder(&self, out: &Path) -> PathBuf {
        out.join("jobs").join(&self.name)
    }

    /// Whether its command would be understood.
    fn check(&self) -> Result<(), CliError> {
        let checked = self.asked(Path::new("")).and_then(|asked| match asked {
            Asked::Compare(args) => check_options(&args, &args.choices()?),
            Asked::Truth(_) | Asked::Cdi(_) => Ok(()),
        });
        checked.map_err(|error| CliError::new(format!("job {}: {error}", self.name)))
    }

    /// What it asks for, written to `folder`.
    fn asked(&self, folder: &Path) -> Result<Asked, CliError> {
        let out = folder.to_owned();
        match cli::parse(&self.command)? {
            Invocation::Compare(args) => Ok(Asked::Compare(CompareArgs { out, ..args })),
            Invocation::Truth(args) => Ok(Asked::Truth(TruthArgs { out, ..args })),
            Invocation::Cdi(args) => Ok(Asked::Cdi(CdiArgs { out, ..args })),
            _ => Err(CliError::new(format!(
                "job {}: its command must be compare, truth or cdi, `{}`",
                self.name,
                self.command.join(" ")
            ))),
        }
    }
}
