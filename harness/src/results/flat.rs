//! Files of schema 1, whose records were flat: every figure stood beside the strategy.

use std::collections::BTreeMap;

use serde::Deserialize;
use serde_json::Value;

use super::{
    DeepImageRun, ImageFigures, ListFigures, Machine, Record, RejectedLight, Results, Setting,
    Times, Truth, TruthImage, Vpls, renamed::named_today,
};

/// The root of a file of schema 1.
#[derive(Deserialize)]
pub(super) struct FlatResults {
    machine: Machine,
    command: Vec<String>,
    truth: Truth,
    records: Vec<FlatRecord>,
    #[serde(default)]
    truth_image: Option<TruthImage>,
    #[serde(default)]
    deep_images: Option<DeepImageRun>,
    #[serde(default)]
    rejected_lights: Vec<RejectedLight>,
    #[serde(default)]
    warnings: Vec<String>,
}

/// A record of schema 1. Its fields have the names of today, or are aliases of them.
#[derive(Deserialize)]
pub(super) struct FlatRecord {
    strategy: String,
    #[serde(default)]
    strategy_parameters: BTreeMap<String, Value>,
    #[serde(default)]
    is_lossy: bool,
    #[serde(flatten)]
    setting: Setting,
    #[serde(flatten)]
    times: Times,
    #[serde(flatten)]
    lists: ListFigures,
    #[serde(flatten)]
    image: ImageFigures,
    #[serde(default)]
    vpls: Option<Vpls>,
    #[serde(default)]
    note: Option<String>,
}

impl From<FlatResults> for Results {
    fn from(flat: FlatResults) -> Self {
        Self {
            schema_version: 1,
            machine: flat.machine,
            command: flat.command,
            truth: flat.truth,
            records: flat.records.into_iter().map(Record::from).collect(),
            truth_image: flat.truth_image,
            deep_images: flat.deep_images,
            rejected_lights: flat.rejected_lights,
            refused: Vec::new(),
            warnings: flat.warnings,
        }
    }
}

impl From<FlatRecord> for Record {
    fn from(flat: FlatRecord) -> Self {
        let FlatRecord {
            strategy,
            strategy_parameters,
            is_lossy,
            setting,
            times,
            lists,
            image,
            vpls,
            note,
        } = flat;
        let strategy = named_today(&strategy, &strategy_parameters, &setting);
        Self { strategy, is_lossy, setting, times, lists, image, indirect: vpls, note }
    }
}

#[cfg(test)]
mod tests {
    use super::super::SCHEMA_VERSION;
    use super::*;

    #[test]
    fn a_flat_file_gives_the_same_results_as_a_nested_one() {
        let folder = tempfile::tempdir().unwrap();
        let read = |text: &str| {
            let path = folder.path().join("results.json");
            std::fs::write(&path, text).unwrap();
            Results::read(&path).unwrap()
        };
        let mut flat = read(include_str!("example_schema_1.json"));
        assert_eq!(flat.schema_version, 1, "pages say what they read");
        let written: Value = serde_json::from_str(&flat.to_json()).unwrap();
        assert_eq!(written["schema_version"], SCHEMA_VERSION);
        flat.schema_version = SCHEMA_VERSION;
        assert_eq!(flat, read(include_str!("example.json")));
        let record = &flat.records[0];
        assert_eq!(record.lists.entries, 412_345);
        let passes: Vec<&str> = record.times.passes.iter().map(|(name, _)| name).collect();
        assert_eq!(passes, ["depth", "cull", "shade"], "passes keep their order");
    }
}
