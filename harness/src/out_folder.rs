//! The folder that a run writes into: made where it is missing, and held by one process at a time.
//!
//! Two runs in one folder would overwrite each other, and spoil each other's times. So a run locks a
//! file in its folder and writes there who it is. The lock is the system's: it ends with the process,
//! however that ends, so a file that a killed run left behind stands in nobody's way.
//!
//! A run that ends without having written anything takes the folders with it that it made.

use std::fs::{self, File, TryLockError};
use std::io::{self, Read, Write};
use std::path::{Path, PathBuf};
use std::sync::{Mutex, PoisonError};

use serde::{Deserialize, Serialize};

use crate::{
    cli::CliError,
    error::HarnessError,
    machine::{host_name, now},
    results::{ResultsError, remove_temporaries},
};

/// The file that is locked.
const LOCK: &str = "lightbench.lock";

/// A lock that is removed just as this process takes it is tried again, so often.
const ATTEMPTS: u32 = 16;

/// Folders that this process holds.
static HELD: Mutex<Vec<Held>> = Mutex::new(Vec::new());

/// A folder that is held until this value is dropped.
#[must_use = "the folder is held until this is dropped"]
pub struct OutFolder {
    path: PathBuf,
}

struct Held {
    path: PathBuf,
    lock: File,
    /// Folders that were made for it, innermost first.
    made: Vec<PathBuf>,
}

/// Who holds a folder, as its lock says.
#[derive(Debug, Serialize, Deserialize)]
struct Holder {
    pid: u32,
    host: String,
    since: String,
    command: Vec<String>,
}

impl OutFolder {
    /// Makes a folder where it is missing, holds it, and removes the temporary files of killed runs.
    ///
    /// # Errors
    ///
    /// Where the folder cannot be written to, or another process holds it: the message names both.
    pub fn hold(path: &Path, command: &[String]) -> Result<Self, HarnessError> {
        let made = make(path)?;
        let lock = match lock(path, command) {
            Ok(lock) => lock,
            Err(error) => {
                remove_empty(&made);
                return Err(error);
            }
        };
        let held = Held { path: path.to_owned(), lock, made };
        HELD.lock().unwrap_or_else(PoisonError::into_inner).push(held);
        remove_temporaries(path);
        Ok(Self { path: path.to_owned() })
    }
}

impl Drop for OutFolder {
    fn drop(&mut self) {
        leave(|held| held.path == self.path);
    }
}

/// Leaves all folders: for ends of the program that drop nothing.
pub fn leave_all() {
    leave(|_| true);
}

fn leave(is_left: impl Fn(&Held) -> bool) {
    let mut all = HELD.lock().unwrap_or_else(PoisonError::into_inner);
    for held in all.extract_if(.., |held| is_left(held)) {
        // Removed while it is locked: whoever opened it meanwhile sees that it is another file by then.
        let _ = fs::remove_file(held.path.join(LOCK));
        drop(held.lock);
        remove_empty(&held.made);
    }
}

/// Makes a folder with those above it; returns those that were missing, innermost first.
fn make(path: &Path) -> Result<Vec<PathBuf>, ResultsError> {
    let is_missing = |folder: &&Path| !folder.as_os_str().is_empty() && !folder.exists();
    let missing: Vec<PathBuf> =
        path.ancestors().take_while(is_missing).map(Path::to_owned).collect();
    fs::create_dir_all(path).map_err(|source| {
        remove_empty(&missing);
        ResultsError::Write { path: path.to_owned(), source }
    })?;
    Ok(missing)
}

/// Removes folders as long as they are empty.
fn remove_empty(folders: &[PathBuf]) {
    let _ = folders.iter().try_for_each(fs::remove_dir);
}

/// Locks a folder's file and writes there who holds it.
fn lock(folder: &Path, command: &[String]) -> Result<File, HarnessError> {
    let path = folder.join(LOCK);
    let fail = |source| ResultsError::Write { path: path.clone(), source };
    for _ in 0..ATTEMPTS {
        let mut file = File::options()
            .read(true)
            .write(true)
            .create(true)
            .truncate(false)
            .open(&path)
            .map_err(fail)?;
        // A file system without locks cannot tell: the run goes on without one.
        if let Err(TryLockError::WouldBlock) = file.try_lock() {
            return Err(held_by(folder, &mut file).into());
        }
        if !is_still(&file, &path) {
            continue;
        }
        let holder = Holder {
            pid: std::process::id(),
            host: host_name(),
            since: now(),
            command: command.to_vec(),
        };
        let text = serde_json::to_string(&holder).unwrap_or_default() + "\n";
        file.set_len(0).and_then(|()| file.write_all(text.as_bytes())).map_err(fail)?;
        return Ok(file);
    }
    Err(fail(io::Error::other("other runs take and leave it all the time")).into())
}

/// Whether an open file is the one at a path: another process may have removed it.
#[cfg(unix)]
fn is_still(file: &File, path: &Path) -> bool {
    use std::os::unix::fs::MetadataExt;

    let place = |metadata: io::Result<fs::Metadata>| metadata.ok().map(|m| (m.dev(), m.ino()));
    place(file.metadata()) == place(fs::metadata(path))
}

/// Where an open file cannot be removed it is the same.
#[cfg(not(unix))]
fn is_still(_: &File, _: &Path) -> bool {
    true
}

/// The error that names who holds a folder.
fn held_by(folder: &Path, file: &mut File) -> CliError {
    let mut text = String::new();
    let holder: Option<Holder> = match file.read_to_string(&mut text) {
        Ok(_) => serde_json::from_str(&text).ok(),
        Err(_) => None,
    };
    let who = holder.map_or_else(
        || "another lightbench".to_owned(),
        |Holder { pid, host, since, command }| {
            let command = command.join(" ");
            format!("another lightbench, process {pid} on {host} since {since}, `{command}`,")
        },
    );
    CliError::new(format!(
        "{}: {who} is writing there: wait until it ends, or give another --out",
        folder.display()
    ))
}

#[cfg(test)]
mod tests {
    use super::*;

    fn hold(path: &Path) -> Result<OutFolder, HarnessError> {
        OutFolder::hold(path, &["lightbench".to_owned(), "study".to_owned()])
    }

    #[test]
    fn a_folder_is_held_once_and_the_holder_is_named() {
        let folder = tempfile::tempdir().unwrap();
        let held = hold(folder.path()).unwrap();
        let error = hold(folder.path()).err().expect("held").to_string();
        let pid = format!("process {}", std::process::id());
        for part in [pid.as_str(), &host_name(), "`lightbench study`", "--out"] {
            assert!(error.contains(part), "{error} lacks {part}");
        }
        drop(held);
        drop(hold(folder.path()).unwrap());
        assert_eq!(fs::read_dir(folder.path()).unwrap().count(), 0, "nothing is left");
    }

    #[test]
    fn what_a_killed_run_left_is_taken_over() {
        let folder = tempfile::tempdir().unwrap();
        let left = |name: &str| folder.path().join(name);
        fs::write(left(LOCK), "{\"pid\": 1, cut").unwrap();
        fs::create_dir(left("charts")).unwrap();
        for name in ["results.json.123.tmp", "charts/a.svg.7.tmp"] {
            fs::write(left(name), "half").unwrap();
        }
        let own = ["results.json", "notes.tmp", "a.json.b.tmp", "x.1.tmp", "x.json.1.tmp2"];
        own.iter().for_each(|name| fs::write(left(name), "whole").unwrap());
        drop(hold(folder.path()).unwrap());
        assert!(own.iter().all(|name| left(name).is_file()));
        assert!(!left("results.json.123.tmp").exists() && !left("charts/a.svg.7.tmp").exists());
        assert!(!left(LOCK).exists());
    }

    #[test]
    fn folders_are_left_as_they_were_where_nothing_was_written() {
        let folder = tempfile::tempdir().unwrap();
        let deep = folder.path().join("a/b/c");
        drop(hold(&deep).unwrap());
        assert!(!folder.path().join("a").exists());
        let held = hold(&deep).unwrap();
        fs::write(folder.path().join("a/b/kept"), "").unwrap();
        drop(held);
        assert!(folder.path().join("a/b/kept").is_file() && !deep.exists());
        fs::write(folder.path().join("file"), "").unwrap();
        let error = hold(&folder.path().join("file/out")).err().expect("no folder").to_string();
        assert!(error.contains("cannot be written"), "{error}");
    }
}
