//! The jobs of a study, and which of them are done.

use std::collections::BTreeMap;
use std::path::{Path, PathBuf};

use serde::{Deserialize, Serialize};
use serde_json::Value;

use crate::study::job::Job;
use crate::{
    grouping::distinct,
    messages::say,
    results::{Results, ResultsError, sealed, unsealed, write_atomically},
    visible::visible,
};

/// The file that lists a study's jobs.
const FILE: &str = "study.json";

/// All jobs of a study: `study.json`.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub struct Manifest {
    /// Version of the file: `VERSION`. Files without it are of version 1, whose jobs have no settings.
    #[serde(default = "first_version")]
    pub version: u32,
    /// The command that was asked for, without its folder and its shard.
    pub identity: Vec<String>,
    /// The study's name.
    pub study: String,
    /// Its jobs, in the order in which they run.
    pub jobs: Vec<Job>,
}

/// The version that is written.
const VERSION: u32 = 2;

fn first_version() -> u32 {
    1
}

/// What a field must be: its name, a test of its value, and what the test accepts.
type Rule = (&'static str, fn(&Value) -> bool, &'static str);

const RULES: [Rule; 3] = [
    ("study", is_plain_text, "the name of a study"),
    ("identity", is_list_of_text, "a list of texts"),
    (
        "jobs",
        |jobs| jobs.as_array().is_some_and(|jobs| !jobs.is_empty()),
        "a list of at least one job",
    ),
];

const JOB_RULES: [Rule; 4] = [
    ("name", is_name, "letters, digits, '-', '_' and '.', the first no '.'"),
    ("scene", is_plain_text, "text without control characters"),
    ("section", is_plain_text, "text without control characters"),
    ("command", is_list_of_text, "a list of texts"),
];

/// Jobs have settings from version 2 on.
const SETTINGS: Rule = ("settings", Value::is_object, "an object; {} where there are none");

fn is_list_of_text(value: &Value) -> bool {
    value.as_array().is_some_and(|texts| texts.iter().all(Value::is_string))
}

fn is_plain_text(value: &Value) -> bool {
    value.as_str().is_some_and(|text| visible(text) == text)
}

/// Names of jobs are names of folders: the file may come from anywhere.
fn is_name(value: &Value) -> bool {
    let plain = |c: char| c.is_ascii_alphanumeric() || "-_.".contains(c);
    let is_plain =
        |name: &str| !name.is_empty() && !name.starts_with('.') && name.chars().all(plain);
    value.as_str().is_some_and(is_plain)
}

/// Characters of a faulty value that a message shows.
const SHOWN: usize = 60;

/// Checks the fields of an object; an error names the first faulty one, its value and what is accepted.
fn check_fields(at: &str, object: &Value, rules: &[Rule]) -> Result<(), String> {
    for (name, is_right, accepted) in rules {
        match object.get(name) {
            None => return Err(format!("{at}{name} is missing: it must be {accepted}")),
            Some(value) if !is_right(value) => {
                let value: String = value.to_string().chars().take(SHOWN).collect();
                return Err(format!("{at}{name} is {value}: it must be {accepted}"));
            }
            Some(_) => {}
        }
    }
    Ok(())
}

/// Checks a file of a known version, field by field.
fn check_file(file: &Value, version: u64) -> Result<(), String> {
    check_fields("", file, &RULES)?;
    let jobs = file.get("jobs").and_then(Value::as_array).map_or(&[][..], Vec::as_slice);
    for (ix, job) in jobs.iter().enumerate() {
        let at = format!("jobs[{ix}].");
        check_fields(&at, job, &JOB_RULES)?;
        check_fields(&at, job, if version > 1 { &[SETTINGS] } else { &[] })?;
        let is_same = |other: &Value| other.get("name") == job.get("name");
        if let Some(first) = jobs[..ix].iter().position(is_same) {
            let name = &job["name"];
            return Err(format!("{at}name is {name}: it must not be that of jobs[{first}]"));
        }
    }
    Ok(())
}

impl Manifest {
    /// The manifest of a new study: the command that was asked for, the study's name and its jobs.
    pub fn new(identity: Vec<String>, study: &str, jobs: Vec<Job>) -> Self {
        Self { version: VERSION, identity, study: study.to_owned(), jobs }
    }

    /// The manifest in a folder; `None` where there is none.
    pub fn find(folder: &Path) -> Result<Option<Self>, ResultsError> {
        let path = folder.join(FILE);
        if !path.is_file() {
            return Ok(None);
        }
        let bytes = std::fs::read(&path)
            .map_err(|source| ResultsError::Read { path: path.clone(), source })?;
        let damaged = |reason: String| {
            format!(
                "{reason}: remove this file; the study then lists its jobs again and keeps the \
                 finished ones"
            )
        };
        let manifest = || -> Result<Self, String> {
            let (file, _) = unsealed(&bytes).map_err(damaged)?;
            let version = match file.get("version").unwrap_or(&Value::from(1)) {
                found if *found == 1 => 1,
                found if *found == VERSION => u64::from(VERSION),
                found => {
                    let is_newer = found.as_u64().is_some_and(|found| found > u64::from(VERSION));
                    let advice = if is_newer { ": use a newer lightbench" } else { "" };
                    return Err(format!("version is {found}: it must be 1 to {VERSION}{advice}"));
                }
            };
            check_file(&file, version).map_err(damaged)?;
            let mut manifest: Self =
                serde_json::from_slice(&bytes).map_err(|e| damaged(e.to_string()))?;
            manifest.upgrade();
            Ok(manifest)
        };
        let fail = |reason| ResultsError::Study { path: path.clone(), reason };
        manifest().map(Some).map_err(fail)
    }

    /// Gives the jobs of version 1 the settings that their names and commands imply.
    fn upgrade(&mut self) {
        if self.version == 1 {
            self.jobs.iter_mut().for_each(Job::derive_settings);
            self.version = VERSION;
        }
    }

    /// How the study of another folder differs from this one, that of the first folder.
    fn difference(&self, other: &Self) -> String {
        if self.identity == other.identity {
            let advice = "one version of lightbench must have listed both";
            return format!("jobs are not those of the first folder: {advice}");
        }
        let [first, other] = [self, other].map(|manifest| manifest.identity.join(" "));
        format!("identity is `{other}`: it must be that of the first folder, `{first}`")
    }

    /// Writes it into a folder.
    pub fn write(&self, folder: &Path) -> Result<(), ResultsError> {
        let path = folder.join(FILE);
        let text = sealed(self).map_err(|error| {
            let reason = error.to_string();
            ResultsError::Study { path: path.clone(), reason }
        })?;
        write_atomically(&path, text.as_bytes())
    }
}

/// A study with the results of the jobs that are done.
#[derive(Clone, Debug)]
pub struct Done {
    /// All jobs.
    pub manifest: Manifest,
    /// Results by the name of their job.
    pub results: BTreeMap<String, Results>,
    /// The folder of each job that is done.
    pub folders: BTreeMap<String, PathBuf>,
}

impl Done {
    /// Reads a study from the folders of its shards.
    ///
    /// # Errors
    ///
    /// Where a folder holds no study, or another than the first.
    pub fn read(folders: &[PathBuf]) -> Result<Self, ResultsError> {
        let mut done: Option<Self> = None;
        for folder in folders {
            let path = folder.join(FILE);
            let fail = |reason: String| ResultsError::Study { path: path.clone(), reason };
            let is_gone = || fail("it is missing: each folder must be one of a study".to_owned());
            let manifest = Manifest::find(folder)?.ok_or_else(is_gone)?;
            let done = done.get_or_insert_with(|| Self {
                manifest: manifest.clone(),
                results: BTreeMap::new(),
                folders: BTreeMap::new(),
            });
            if done.manifest != manifest {
                return Err(fail(done.manifest.difference(&manifest)));
            }
            for job in &manifest.jobs {
                let path = job.folder(folder).join("results.json");
                if path.is_file() && !done.results.contains_key(&job.name) {
                    let Some(results) = read_job(job, &path)? else { continue };
                    done.check(job, &results)
                        .map_err(|reason| ResultsError::Parse { path, reason })?;
                    done.results.insert(job.name.clone(), results);
                    done.folders.insert(job.name.clone(), job.folder(folder));
                }
            }
        }
        done.ok_or_else(|| ResultsError::Parse { path: PathBuf::new(), reason: "no folder".into() })
    }

    /// Writes recomputed errors beside the raw results of their jobs.
    pub fn write_metrics(&self) -> Result<(), ResultsError> {
        for (job, results) in &self.results {
            if let Some(folder) = self.folders.get(job) {
                results.write_metrics(&folder.join("results.json"))?;
            }
        }
        Ok(())
    }

    /// Checks that results belong to a job, and may be compared with the other results.
    fn check(&self, job: &Job, results: &Results) -> Result<(), String> {
        if results.command != job.command {
            return Err(format!(
                "command is `{}`: it must be the job's, `{}`",
                results.command.join(" "),
                job.command.join(" ")
            ));
        }
        let is_same_scene =
            |known: &Job| known.scene == job.scene && known.scene_changes() == job.scene_changes();
        let hash = |results: &Results| {
            let record = results.records.first().map(|record| record.setting.scene_hash.clone());
            record.or_else(|| results.truth_image.as_ref().map(|truth| truth.scene_hash.clone()))
        };
        for known_job in &self.manifest.jobs {
            let Some(known) = self.results.get(&known_job.name) else { continue };
            let same_scene = is_same_scene(known_job);
            let machines = known.machine.identity().into_iter().zip(results.machine.identity());
            for ((field, known), (_, own)) in machines {
                // A later commit may add a scene, because times of two scenes are never compared.
                if known != own && (same_scene || field != "commit") {
                    return Err(format!(
                        "machine.{field} is {own}: it must be that of the other jobs, {known}"
                    ));
                }
            }
            if let (true, Some(known), Some(own)) = (same_scene, hash(known), hash(results))
                && known != own
            {
                return Err(format!(
                    "scene_hash is {own}: it must be that of the scene in the other jobs, {known}"
                ));
            }
        }
        Ok(())
    }

    /// Names of the jobs that are not done.
    pub fn missing(&self) -> Vec<&str> {
        let jobs = self.manifest.jobs.iter().map(|job| job.name.as_str());
        jobs.filter(|name| !self.results.contains_key(*name)).collect()
    }

    /// The jobs of a scene that are done, with their results, of one section.
    pub fn section<'a>(
        &'a self,
        scene: &'a str,
        section: &'a str,
    ) -> impl Iterator<Item = (&'a Job, &'a Results)> {
        self.manifest
            .jobs
            .iter()
            .filter(move |job| job.scene == scene && job.section == section)
            .filter_map(|job| Some((job, self.results.get(&job.name)?)))
    }

    /// The scenes, in the order of their jobs.
    pub fn scenes(&self) -> Vec<&str> {
        distinct(self.manifest.jobs.iter().map(|job| job.scene.as_str()))
    }
}

/// The results of a job; `None`, with a warning that names the job, where they are damaged or incomplete:
/// it counts as not done.
fn read_job(job: &Job, path: &Path) -> Result<Option<Results>, ResultsError> {
    let not_done = |why: String| {
        let folder = path.parent().unwrap_or(path).display();
        say(format!(
            "warning  job {} is not done: {why}: run the study again, or remove {folder}",
            job.name
        ));
        Ok(None)
    };
    match Results::read_checked(path) {
        Ok((results, None)) => Ok(Some(results)),
        // Results of another command are refused by the caller.
        Ok((results, Some(_))) if results.command != job.command => Ok(Some(results)),
        Ok((_, Some(lack))) => not_done(format!("{}: {lack}", path.display())),
        Err(error @ ResultsError::Version { .. }) => Err(error),
        Err(error) => not_done(error.to_string()),
    }
}
