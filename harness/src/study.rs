//! Studies: lists of comparisons, each a job of its own, so that a study goes on where it was
//! interrupted and can be split over machines.
//!
//! A job is a `lightbench compare`, `truth` or `cdi` command. Its folder, `jobs/NAME`, holds what that command writes;
//! a job whose `results.json` is there is done. `study.json` beside `jobs` lists all jobs, those of
//! other shards too.

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
    cdi::measure,
    checks::check_writable,
    cli::{self, CdiArgs, CliError, CompareArgs, Invocation, StudyArgs, StudyName, TruthArgs},
    compare::Bench,
    error::HarnessError,
    report,
    results::{Results, ResultsError},
    truth::render,
};

pub use against_truth::{compare_with_truth, truth_of};
pub use manifest::{Done, Job, Manifest};
pub use scene::StudyScene;

/// The section of a study whose jobs render the truth images of its scenes.
pub const TRUTH: &str = "truth";

/// The section whose images are compared with them.
pub const MODELS: &str = "models";

/// Runs a study, or a share of it, and writes its report; returns what to print.
pub fn study(args: &StudyArgs) -> Result<String, HarnessError> {
    let scenes = StudyScene::all(args)?;
    let out = &args.folder();
    check_writable(out)?;
    let mut bench = Bench::open(args.adapter.as_deref())?;
    let wanted = args.identity();
    let manifest = match Manifest::find(out)? {
        Some(known) if known.identity == wanted => known,
        Some(known) => {
            let value = out.display().to_string();
            let accepted = format!(
                "a folder without a study, or with this one; it holds `{}`: give another --out",
                known.identity.join(" ")
            );
            return Err(CliError::out_of_range("--out", &value, &accepted).into());
        }
        None => {
            let mut jobs = Vec::new();
            for scene in &scenes {
                jobs.extend(match args.study {
                    StudyName::Comparison => comparison::jobs(&mut bench, args, scene)?,
                    StudyName::Culling => culling::jobs(args, scene),
                    StudyName::Area => area::jobs(&mut bench, args, scene)?,
                    StudyName::Endless => endless::jobs(&mut bench, args, scene)?,
                    StudyName::Cdi => cdi::jobs(&mut bench, args, scene)?,
                });
            }
            let manifest = Manifest { identity: wanted, study: args.study.name().into(), jobs };
            manifest.write(out)?;
            manifest
        }
    };
    run(&mut bench, args, &manifest)?;
    let mut done = Done::read(std::slice::from_ref(out))?;
    compare_with_truth(&mut done)?;
    done.write()?;
    report::write_study(&done, out)
}

/// Runs the jobs of this shard that are not done.
fn run(bench: &mut Bench, args: &StudyArgs, manifest: &Manifest) -> Result<(), HarnessError> {
    let began = Instant::now();
    let mine: Vec<&Job> = manifest
        .jobs
        .iter()
        .enumerate()
        .filter(|(ix, _)| args.shard.holds(*ix))
        .map(|(_, job)| job)
        .collect();
    for (ix, job) in mine.iter().enumerate() {
        let folder = job.folder(&args.folder());
        if is_done(bench, job, &folder)? {
            continue;
        }
        eprintln!(
            "job      {} of {}, {} s so far: {}",
            ix + 1,
            mine.len(),
            began.elapsed().as_secs(),
            job.name
        );
        let asked = job.asked(&folder)?;
        // What an interrupted run left there is not this one's.
        if folder.is_dir() {
            std::fs::remove_dir_all(&folder)
                .map_err(|source| ResultsError::Write { path: folder.clone(), source })?;
        }
        let results = match asked {
            Asked::Compare(args) => bench.compare(&args, job.command.clone())?.0,
            Asked::Truth(args) => render(bench, &args, job.command.clone())?,
            Asked::Cdi(args) => measure(bench, &args, job.command.clone())?,
        };
        results.write(&folder.join("results.json"))?;
    }
    Ok(())
}

/// Whether a job was done, by this commit on this adapter: an error where by another.
fn is_done(bench: &Bench, job: &Job, folder: &Path) -> Result<bool, HarnessError> {
    let path = folder.join("results.json");
    if !path.is_file() {
        return Ok(false);
    }
    let results = Results::read(&path)?;
    let (then, now) = (&results.machine, bench.machine());
    if then.identity() == now.identity() {
        return Ok(results.command == job.command);
    }
    Err(CliError::new(format!(
        "{}: measured on {} by commit {}, this is {} and commit {}: --out must be another folder",
        path.display(),
        then.adapter,
        then.commit,
        now.adapter,
        now.commit,
    ))
    .into())
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
