//! Ids and parameters of all stored results are what this program reads and writes.

use std::{
    collections::BTreeMap,
    path::{Path, PathBuf},
};

use harness::{results::Results, strategy::StrategyId};
use serde::Deserialize;
use serde_json::Value;

/// What a file of schema 1 says of its strategies.
#[derive(Deserialize)]
struct Stored {
    #[serde(default)]
    records: Vec<StoredRecord>,
}

#[derive(Deserialize)]
struct StoredRecord {
    strategy: String,
    strategy_parameters: BTreeMap<String, Value>,
}

/// All files of results below a folder.
fn files(folder: &Path, found: &mut Vec<PathBuf>) {
    for entry in std::fs::read_dir(folder).expect("a folder").flatten() {
        let path = entry.path();
        match path.is_dir() {
            true => files(&path, found),
            false if path.extension().is_some_and(|end| end == "json") => found.push(path),
            false => {}
        }
    }
}

/// A number with the fewest digits that give its single precision: earlier versions stored `0.001` as
/// `0.0010000000474974513`.
fn shortest(value: Value) -> Value {
    match value.as_f64() {
        Some(number) if value.is_f64() => {
            (number as f32).to_string().parse().map_or(value, |n: f64| n.into())
        }
        _ => value,
    }
}

/// The id says everything that stored results say of a strategy's parameters. Records whose id has
/// changed its meaning differ in the box of a grid and in the tests of tiles, and nothing else.
#[test]
fn the_ids_of_stored_results_say_their_parameters() {
    let mut all = Vec::new();
    files(&Path::new(env!("CARGO_MANIFEST_DIR")).join("../results"), &mut all);
    let (mut same, mut renamed) = (0, 0);
    for path in all {
        let text = std::fs::read_to_string(&path).expect("a file");
        let Ok(stored) = serde_json::from_str::<Stored>(&text) else { continue };
        if stored.records.is_empty() {
            continue;
        }
        let results = Results::read(&path).expect("results");
        for (old, record) in stored.records.iter().zip(&results.records) {
            let file = path.display();
            assert_eq!(StrategyId::read(&old.strategy).as_str(), old.strategy, "{file}");
            assert!(record.strategy.row().is_some(), "{file}: {}", record.strategy);
            let mut parameters = record.strategy.parameters();
            if record.strategy == old.strategy.as_str() {
                let stored = old.strategy_parameters.clone().into_iter();
                let stored = stored.map(|(name, value)| (name, shortest(value))).collect();
                assert_eq!(parameters, stored, "{file}: {}", record.strategy);
                same += 1;
            } else {
                for (name, value) in &old.strategy_parameters {
                    let is_changed = ["box", "tests"].contains(&name.as_str());
                    let today = parameters.remove(name);
                    assert!(is_changed || today.as_ref() == Some(value), "{file}: {name}");
                }
                assert!(record.strategy.stand_in().is_some(), "{file}: {}", record.strategy);
                renamed += 1;
            }
        }
    }
    assert!(same > 2_000 && renamed > 100, "{same} as they were, {renamed} renamed");
}
