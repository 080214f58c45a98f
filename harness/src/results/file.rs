//! Reading and writing `results.json`.

use std::fs;
use std::io::{self, Write};
use std::path::{Path, PathBuf};

use serde_json::Value;
use thiserror::Error;

use super::{
    Record, Results, SCHEMA_VERSION,
    fault::{flat_fault, nested_fault},
    flat::FlatResults,
    lack::lack,
    renamed::warned_today,
    seal::{sealed, unsealed},
};

/// Errors of reading and writing results, one line each.
#[derive(Debug, Error)]
pub enum ResultsError {
    /// A file or folder cannot be written.
    #[error("{}: cannot be written: {source}", path.display())]
    Write {
        /// The file or folder.
        path: PathBuf,
        /// The error of the operating system.
        source: io::Error,
    },
    /// A file cannot be read.
    #[error("{}: cannot be read: {source}", path.display())]
    Read {
        /// The file.
        path: PathBuf,
        /// The error of the operating system.
        source: io::Error,
    },
    /// A file is not `results.json` as documented here.
    #[error("{}: not a results.json: {reason}", path.display())]
    Parse {
        /// The file.
        path: PathBuf,
        /// The fault and its place in the file.
        reason: String,
    },
    /// A `study.json` cannot be used.
    #[error("{}: not the list of a study's jobs: {reason}", path.display())]
    Study {
        /// The file.
        path: PathBuf,
        /// The fault and its place in the file.
        reason: String,
    },
    /// A file of a version that this program does not know.
    #[error("{}: schema_version is {found}: it must be 1 to {SCHEMA_VERSION}", path.display())]
    Version {
        /// The file.
        path: PathBuf,
        /// Its version, or what stands in its place.
        found: Value,
    },
}

impl Results {
    /// The results as JSON, without a checksum.
    pub fn to_json(&self) -> String {
        serde_json::to_string_pretty(self).expect("keys are strings and values are plain data")
    }

    /// Writes `results.json` with its checksum, completely or not at all. Creates a missing folder.
    ///
    /// # Errors
    ///
    /// [`ResultsError::Write`] names the path.
    pub fn write(&self, path: &Path) -> Result<(), ResultsError> {
        let text = sealed(self).map_err(|error| ResultsError::Parse {
            path: path.to_owned(),
            reason: error.to_string(),
        })?;
        write_atomically(path, text.as_bytes())
    }

    /// Reads a `results.json` of [`SCHEMA_VERSION`], with the errors that lie beside it.
    ///
    /// # Errors
    ///
    /// [`ResultsError::Read`], [`ResultsError::Parse`] or [`ResultsError::Version`].
    pub fn read(path: &Path) -> Result<Self, ResultsError> {
        Self::read_checked(path).map(|(results, _)| results)
    }

    /// Reads results, and checks that they hold all records of their command: returns the first fault.
    ///
    /// # Errors
    ///
    /// As [`read`](Self::read).
    pub fn read_checked(path: &Path) -> Result<(Self, Option<String>), ResultsError> {
        let (mut results, checksum) = Self::read_raw(path)?;
        let lack = lack(&results);
        results.bill_as_today();
        results.take_metrics(path, &checksum);
        Ok((results, lack))
    }

    /// Reads a file, with the ids of this version, and its checksum.
    pub(super) fn read_raw(path: &Path) -> Result<(Self, String), ResultsError> {
        let fail = |reason| ResultsError::Parse { path: path.to_owned(), reason };
        let bytes = fs::read(path)
            .map_err(|source| ResultsError::Read { path: path.to_owned(), source })?;
        let (value, checksum) = unsealed(&bytes).map_err(fail)?;
        // From the text: the order of passes counts.
        type Read = (serde_json::Result<Results>, fn(&Value) -> Option<String>);
        let (results, fault): Read = match value.get("schema_version") {
            None => {
                let accepted = format!("it must be 1 to {SCHEMA_VERSION}");
                return Err(fail(format!("schema_version is missing: {accepted}")));
            }
            Some(version) if *version == 1 => {
                (serde_json::from_slice::<FlatResults>(&bytes).map(Results::from), flat_fault)
            }
            Some(version) if *version == SCHEMA_VERSION => {
                (serde_json::from_slice(&bytes), nested_fault)
            }
            Some(found) => {
                return Err(ResultsError::Version { path: path.to_owned(), found: found.clone() });
            }
        };
        let results =
            results.map_err(|error| fail(fault(&value).unwrap_or_else(|| error.to_string())))?;
        Ok((results, checksum))
    }

    /// Gives records of earlier versions the bills and the warnings of today, and shows what names hide.
    pub(super) fn bill_as_today(&mut self) {
        self.show_hidden();
        for warning in &mut self.warnings {
            if let Some(today) = warned_today(warning) {
                *warning = today;
            }
        }
        self.records.iter_mut().for_each(Record::bill_again);
    }
}

/// Writes a file completely or not at all: writes a temporary file beside it, then renames it. Creates missing
/// folders.
///
/// # Errors
///
/// [`ResultsError::Write`] names the path. The temporary file is removed.
pub fn write_atomically(path: &Path, bytes: &[u8]) -> Result<(), ResultsError> {
    let fail = |path: &Path, source| ResultsError::Write { path: path.to_owned(), source };
    if let Some(folder) = path.parent() {
        fs::create_dir_all(folder).map_err(|source| fail(folder, source))?;
    }
    let mut temporary = path.as_os_str().to_owned();
    temporary.push(format!(".{}{TEMPORARY}", std::process::id()));
    let temporary = PathBuf::from(temporary);
    let written = fs::File::create(&temporary)
        .and_then(|mut file| {
            file.write_all(bytes)?;
            file.sync_all()
        })
        .and_then(|()| fs::rename(&temporary, path));
    written.map_err(|source| {
        // The temporary file may not exist.
        let _ = fs::remove_file(&temporary);
        fail(path, source)
    })
}

/// The end of the names of temporary files, after the process id.
const TEMPORARY: &str = ".tmp";

/// Removes the temporary files that killed runs left in an output folder, among its charts and its jobs.
/// The caller must hold the folder, or this would remove files of a run that is still writing.
pub(crate) fn remove_temporaries(folder: &Path) {
    let jobs = folder.join("jobs");
    let each_job = entries(&jobs).filter(|(kind, _)| kind.is_dir()).map(|(_, path)| path);
    let folders = [folder.to_owned(), folder.join("charts"), jobs.clone()];
    for folder in folders.into_iter().chain(each_job) {
        // Links are not followed and not removed.
        for (_, path) in entries(&folder).filter(|(kind, _)| kind.is_file()) {
            if path.file_name().is_some_and(|name| is_temporary(&name.to_string_lossy())) {
                // A file that cannot be removed does no harm.
                let _ = fs::remove_file(path);
            }
        }
    }
}

/// The entries of a folder; none if it cannot be read.
fn entries(folder: &Path) -> impl Iterator<Item = (fs::FileType, PathBuf)> {
    let entries = fs::read_dir(folder).into_iter().flatten().flatten();
    entries.filter_map(|entry| Some((entry.file_type().ok()?, entry.path())))
}

/// Whether a name is one that [`write_atomically`] gives: `results.json.4711.tmp`.
fn is_temporary(name: &str) -> bool {
    const WRITTEN: [&str; 5] = [".json", ".html", ".svg", ".png", ".exr"];
    name.strip_suffix(TEMPORARY).and_then(|rest| rest.rsplit_once('.')).is_some_and(
        |(file, process)| {
            process.parse::<u32>().is_ok() && WRITTEN.iter().any(|end| file.ends_with(end))
        },
    )
}

#[cfg(test)]
mod tests {
    use super::*;

    const EXAMPLE: &str = include_str!("example.json");

    fn example() -> Results {
        serde_json::from_str(EXAMPLE).expect("the documented example parses")
    }

    #[test]
    fn the_documented_example_is_complete_and_in_order() {
        let ours: Value = serde_json::from_str(&example().to_json()).expect("JSON");
        let documented: Value = serde_json::from_str(EXAMPLE).expect("JSON");
        assert_eq!(ours, documented);
    }

    #[test]
    fn a_written_file_reads_back_and_leaves_nothing_beside_it() {
        let folder = tempfile::tempdir().expect("a temporary folder");
        let path = folder.path().join("a/b/results.json");
        example().write(&path).expect("writes");
        example().write(&path).expect("replaces");
        assert_eq!(Results::read(&path).expect("reads"), example());
        let beside = fs::read_dir(folder.path().join("a/b")).expect("a folder");
        assert_eq!(beside.count(), 1);
    }

    #[test]
    fn an_error_names_the_path_that_cannot_be_written() {
        let folder = tempfile::tempdir().expect("a temporary folder");
        let file = folder.path().join("file");
        fs::write(&file, "").expect("writes");
        let error = example().write(&file.join("results.json")).expect_err("no folder");
        let message = error.to_string();
        assert!(message.starts_with(&format!("{}: cannot be written: ", file.display())));
        assert_eq!(message.lines().count(), 1);

        fs::create_dir(folder.path().join("results.json")).expect("a folder");
        let taken = folder.path().join("results.json");
        assert!(example().write(&taken).is_err());
        assert_eq!(fs::read_dir(folder.path()).expect("a folder").count(), 2);
    }

    #[test]
    fn other_versions_and_other_files_are_refused() {
        let folder = tempfile::tempdir().expect("a temporary folder");
        let path = folder.path().join("results.json");
        let read = |text: &str| {
            fs::write(&path, text).expect("writes");
            Results::read(&path).expect_err("refused").to_string()
        };
        assert!(
            read(r#"{"schema_version": 3}"#).contains("schema_version is 3: it must be 1 to 2")
        );
        for (faulty, reason) in [
            (r#"{"schema_version": "new"}"#, r#"schema_version is "new": it must be 1 to 2"#),
            (r#"{"schema_version": 2.5}"#, "schema_version is 2.5: it must be 1 to 2"),
            ("{}", "schema_version is missing: it must be 1 to 2"),
            (r#"{"schema_version": 1}"#, "missing field"),
            (r#"{"schema_version": 2, "machine": 7}"#, "machine: invalid type: integer `7`"),
        ] {
            let error = read(faulty);
            assert!(error.contains(reason) && error.contains("results.json: "), "{error}");
        }
        assert!(read("{").contains("not a results.json"));
        fs::remove_file(&path).expect("removes");
        assert!(Results::read(&path).expect_err("gone").to_string().contains("cannot be read"));
    }
}
