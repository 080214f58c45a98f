//! The folder that a run writes to. The run creates it if it is missing, and one process holds it at a time.
//!
//! Two runs in one folder would overwrite each other's files and disturb each other's times. So a run locks a
//! file in its folder and writes its process id, host and command into it. The operating system releases the
//! lock when the process ends, even when it is killed. A lock file that a killed run left blocks nobody.
//!
//! A run that wrote nothing removes the folders that it created.

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

/// The most attempts at a lock file that another process removes while this one takes it.
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
    /// The folders that this run created, innermost first.
    made: Vec<PathBuf>,
}

/// The process that holds a folder, as its lock file names it.
#[derive(Debug, Serialize, Deserialize)]
struct Holder {
    pid: u32,
    host: String,
    since: String,
    command: Vec<String>,
}

impl OutFolder {
    /// Creates a missing folder, holds it, and removes the temporary files of killed runs.
    ///
    /// # Errors
    ///
    /// The folder cannot be written to, or another process holds it; the message names both.
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

/// Releases all folders when the program ends without dropping its values.
pub fn leave_all() {
    leave(|_| true);
}

fn leave(is_left: impl Fn(&Held) -> bool) {
    let mut all = HELD.lock().unwrap_or_else(PoisonError::into_inner);
    for held in all.extract_if(.., |held| is_left(held)) {
        // The file is removed while locked: a process that has opened it sees that the path is now free.
        let _ = fs::remove_file(held.path.join(LOCK));
        drop(held.lock);
        remove_empty(&held.made);
    }
}

/// Creates a folder and its parents; returns those that were missing, innermost first.
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

/// Removes folders until one is not empty.
fn remove_empty(folders: &[PathBuf]) {
    let _ = folders.iter().try_for_each(fs::remove_dir);
}

/// Locks the folder's lock file and writes the holder into it.
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
        // On a file system without locks, the run continues without one.
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
    Err(fail(io::Error::other("other runs keep locking and releasing it")).into())
}

/// Whether an open file is the one at a path: another process may have removed it.
#[cfg(unix)]
fn is_still(file: &File, path: &Path) -> bool {
    use std::os::unix::fs::MetadataExt;

    let place = |metadata: io::Result<fs::Metadata>| metadata.ok().map(|m| (m.dev(), m.ino()));
    place(file.metadata()) == place(fs::metadata(path))
}

/// On systems where an open file cannot be removed, it is still the same file.
#[cfg(not(unix))]
fn is_still(_: &File, _: &Path) -> bool {
    true
}

/// The error that names the process that holds a folder.
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
            format!("another lightbench (process {pid} on {host} since {since}, `{command}`)")
        },
    );
    CliError::new(format!(
        "{}: {who} is writing to this folder: wait until it ends, or choose another --out",
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
        assert_eq!(fs::read_dir(folder.path()).unwrap().count(), 0, "files are left in the folder");
    }

    #[test]
    fn a_run_takes_over_the_folder_of_a_killed_run() {
        let folder = tempfile::tempdir().unwrap();
        let left = |name: &str| folder.path().join(name);
        fs::write(left(LOCK), "{\"pid\": 1, cut").unwrap();
        fs::create_dir(left("charts")).unwrap();
        for name in ["results.json.123.tmp", "charts/a.svg.7.tmp"] {
            fs::write(left(name), "half").unwrap();
        }
        let kept = ["results.json", "notes.tmp", "a.json.b.tmp", "x.1.tmp", "x.json.1.tmp2"];
        kept.iter().for_each(|name| fs::write(left(name), "whole").unwrap());
        drop(hold(folder.path()).unwrap());
        assert!(kept.iter().all(|name| left(name).is_file()));
        assert!(!left("results.json.123.tmp").exists() && !left("charts/a.svg.7.tmp").exists());
        assert!(!left(LOCK).exists());
    }

    #[test]
    fn a_run_that_wrote_nothing_removes_the_folders_that_it_created() {
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
