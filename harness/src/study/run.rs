//! Runs a study, or a share of its jobs, and writes its report.

use std::path::Path;
use std::time::Instant;

use super::{
    job::Job,
    list,
    manifest::{Done, Manifest},
    motion, report,
    scene::StudyScene,
    slice::Study,
};
use crate::{
    bench::Bench,
    checks::check_options,
    cli::{
        self, CdiArgs, CliError, CompareArgs, Invocation, SOAK_SCENE, SoakArgs, StudyArgs,
        TruthArgs,
    },
    compare::compare_on,
    deep_image_run::measure,
    error::HarnessError,
    messages::say,
    out_folder::OutFolder,
    results::{Results, ResultsError},
    soak::soak_alone,
    truth::render,
};

/// Runs a study, or a share of it, and writes its report; returns what to print. `command` is the command
/// line; a process that wants the same folder is shown it.
pub fn study(args: &StudyArgs, command: &[String]) -> Result<String, HarnessError> {
    let study = list::named(&args.study)?;
    if let Some(frames) = args.soak {
        return soak(study, args, frames);
    }
    let args = &args.with_scenes(study.scenes);
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
        None => {
            let mut jobs = Vec::new();
            for scene in &scenes {
                let mut of_scene = (study.jobs)(&mut bench, args, scene)?;
                motion::set(study, &mut bench, args, scene, &mut of_scene)?;
                jobs.extend(of_scene);
            }
            Manifest::new(wanted, study.name, jobs)
        }
    };
    // Faulty jobs show before the first one runs, and before anything is written.
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
    (study.after_run)(&mut done)?;
    done.write_metrics()?;
    report::write_study(&done, out)
}

/// Random frames in place of the jobs.
fn soak(study: &Study, args: &StudyArgs, frames: u32) -> Result<String, HarnessError> {
    let refuse = |accepted: &str| {
        Err(CliError::out_of_range("--soak", &frames.to_string(), accepted).into())
    };
    if study.name != SOAKED {
        return refuse("left out of studies other than stability");
    }
    let scene = match args.scene.as_slice() {
        [] => SOAK_SCENE.to_owned(),
        [only] => only.clone(),
        _ => return refuse("given with one --scene at most"),
    };
    let given = [
        ("--out", args.out.is_some()),
        ("--size", args.size.is_some()),
        ("--only", !args.only.is_empty()),
        ("--scene-scale", !args.scene_scale.is_empty()),
        ("--motion", args.motion.motion.is_some()),
        ("--quick", args.quick),
    ];
    if let Some((option, _)) = given.into_iter().find(|(_, is_given)| *is_given) {
        return refuse(&format!("given without {option}, which a soak does not read"));
    }
    let adapter = args.adapter.clone();
    soak_alone(&SoakArgs { frames, seed: args.seed, from: 0, scene, adapter })
}

/// The study that soaks.
const SOAKED: &str = "stability";

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
    // Problems of any job show before the first one runs.
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
        // Remove what an interrupted run left there.
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

/// Whether this commit did a job on this adapter; an error where another commit or adapter did it. A job
/// with damaged or incomplete results runs again.
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

/// The command of a job.
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
    /// Checks that its command is valid.
    fn check(&self) -> Result<(), CliError> {
        let checked = self.asked(Path::new("")).and_then(|asked| match asked {
            Asked::Compare(args) => check_options(&args, &args.choices()?),
            Asked::Truth(_) | Asked::Cdi(_) => Ok(()),
        });
        checked.map_err(|error| CliError::new(format!("job {}: {error}", self.name)))
    }

    /// Its command, with `folder` as its output.
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
