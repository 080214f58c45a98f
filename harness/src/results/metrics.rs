//! `metrics.json`: errors that a report computed again from stored images.
//!
//! `results.json` holds the measurements of a run and is never written again. A report computes errors from
//! it and from the images beside it, and writes them to this file. The file can be removed: the next report
//! creates it again.

use std::path::{Path, PathBuf};

use serde::{Deserialize, Serialize};

use super::{
    Errors, Mode, Results, ResultsError,
    file::write_atomically,
    seal::{sealed, unsealed},
};

/// The names of this file and of the results file that it belongs to.
const FILE: &str = "metrics.json";
const RESULTS: &str = "results.json";

/// The errors of all records.
#[derive(Debug, PartialEq, Serialize, Deserialize)]
struct Metrics {
    /// The checksum of the results that they belong to.
    #[serde(alias = "of")]
    results_checksum: String,
    records: Vec<RecordMetrics>,
    /// The errors of a truth image against another one; empty where it was not compared.
    #[serde(default, skip_serializing_if = "Errors::is_empty")]
    against_errors: Errors,
}

/// The errors of one record.
#[derive(Debug, PartialEq, Serialize, Deserialize)]
struct RecordMetrics {
    strategy: String,
    mode: Mode,
    errors: Errors,
    unbounded_errors: Errors,
    truth_errors: Errors,
    build_errors: Option<Errors>,
}

impl Results {
    fn metrics(&self, results_checksum: String) -> Metrics {
        let one = |record: &super::Record| RecordMetrics {
            strategy: record.strategy.to_string(),
            mode: record.setting.mode,
            errors: record.image.errors.clone(),
            unbounded_errors: record.image.unbounded_errors.clone(),
            truth_errors: record.image.truth_errors.clone(),
            build_errors: record.indirect.as_ref().map(|vpls| vpls.build_errors.clone()),
        };
        Metrics {
            results_checksum,
            records: self.records.iter().map(one).collect(),
            against_errors: self
                .truth_image
                .as_ref()
                .map(|truth| truth.against_errors.clone())
                .unwrap_or_default(),
        }
    }

    /// Reads the errors from the file beside a `results.json` with this checksum, if the file exists.
    pub(super) fn take_metrics(&mut self, results: &Path, checksum: &str) {
        let known = beside(results)
            .and_then(|path| std::fs::read(path).ok())
            .filter(|bytes| unsealed(bytes).is_ok())
            .and_then(|bytes| serde_json::from_slice::<Metrics>(&bytes).ok());
        let Some(known) = known.filter(|known| known.results_checksum == checksum) else { return };
        if let Some(truth) = &mut self.truth_image
            && !known.against_errors.is_empty()
        {
            truth.against_errors = known.against_errors;
        }
        for (record, metrics) in self.records.iter_mut().zip(known.records) {
            if record.strategy != metrics.strategy.as_str() || record.setting.mode != metrics.mode {
                continue;
            }
            record.image.errors = metrics.errors;
            record.image.unbounded_errors = metrics.unbounded_errors;
            record.image.truth_errors = metrics.truth_errors;
            if let (Some(vpls), Some(errors)) = (&mut record.indirect, metrics.build_errors) {
                vpls.build_errors = errors;
            }
        }
    }

    /// Writes the errors beside the `results.json` that these results come from, if they differ from those in
    /// it.
    ///
    /// # Errors
    ///
    /// [`ResultsError`] names the file that cannot be read or written.
    pub fn write_metrics(&self, results: &Path) -> Result<(), ResultsError> {
        let Some(path) = beside(results) else { return Ok(()) };
        let (mut known, checksum) = Self::read_raw(results)?;
        known.bill_as_today();
        let fresh = self.metrics(checksum.clone());
        if fresh == known.metrics(checksum.clone()) && !path.exists() {
            return Ok(());
        }
        known.take_metrics(results, &checksum);
        if fresh == known.metrics(checksum) {
            return Ok(());
        }
        let text = sealed(&fresh).map_err(|error| ResultsError::Parse {
            path: path.clone(),
            reason: error.to_string(),
        })?;
        write_atomically(&path, text.as_bytes())
    }
}

/// The file of errors. `None` for results files under other names, because a folder may hold many of these.
fn beside(results: &Path) -> Option<PathBuf> {
    (results.file_name()? == RESULTS).then(|| results.with_file_name(FILE))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn writing_errors_leaves_the_results_file_unchanged() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join(RESULTS);
        let text = include_str!("example.json");
        std::fs::write(&path, text).unwrap();
        let raw = Results::read(&path).unwrap();
        raw.write_metrics(&path).unwrap();
        assert!(!folder.path().join(FILE).exists(), "nothing new, nothing written");
        let mut computed = raw.clone();
        computed.records[0].image.truth_errors.insert("flip".into(), Some(0.1 + 0.2));
        computed.write_metrics(&path).unwrap();
        assert_eq!(std::fs::read_to_string(&path).unwrap(), text);
        assert_eq!(Results::read(&path).unwrap(), computed);
        // Errors of other results are ignored.
        let mut other = raw;
        other.machine.date = "another day".into();
        other.write(&path).unwrap();
        assert_eq!(Results::read(&path).unwrap(), other);
    }
}
