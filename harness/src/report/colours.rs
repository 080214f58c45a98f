//! Style classes that give strategies and passes their colours: the same in every table and chart of a page.

use std::collections::BTreeMap;

use crate::results::{PassKind, Record, Results};

/// Colours that the style sheet has for strategies other than no culling.
pub(crate) const STRATEGY_COLOURS: usize = 9;

/// Colours that it has for the passes of one kind.
const PASS_COLOURS: usize = 4;

/// The classes of a page's strategies and passes.
pub(crate) struct Colours<'a> {
    strategies: BTreeMap<&'a str, String>,
    passes: BTreeMap<&'a str, String>,
}

impl<'a> Colours<'a> {
    /// Gives each strategy a hue, in the order of the records, and each pass a hue by its kind and a shade
    /// by its place among passes of that kind.
    pub(crate) fn new(results: &'a Results) -> Self {
        Self { strategies: strategies(results), passes: passes(results) }
    }

    /// The class of a record's strategy.
    pub(crate) fn strategy(&self, record: &Record) -> &str {
        self.strategies.get(record.strategy.as_str()).map_or("strategy-none", String::as_str)
    }

    /// The class of a pass.
    pub(crate) fn pass(&self, name: &str) -> &str {
        self.passes.get(name).map_or("pass-other-0", String::as_str)
    }
}

fn strategies(results: &Results) -> BTreeMap<&str, String> {
    let mut classes = BTreeMap::new();
    let mut next = 0;
    for record in &results.records {
        classes.entry(record.strategy.as_str()).or_insert_with(|| {
            if record.is_baseline() || record.is_control() {
                return "strategy-none".to_owned();
            }
            next += 1;
            format!("strategy-{}", (next - 1) % STRATEGY_COLOURS)
        });
    }
    classes
}

fn passes(results: &Results) -> BTreeMap<&str, String> {
    let mut classes = BTreeMap::new();
    let mut next: [usize; 4] = [0; 4];
    for (name, times) in results.records.iter().flat_map(|record| record.times.passes.iter()) {
        let (kind, label) = match times.kind {
            PassKind::Scene => (0, "scene"),
            PassKind::Assign => (1, "assign"),
            PassKind::Shade => (2, "shade"),
            PassKind::Other => (3, "other"),
        };
        classes.entry(name).or_insert_with(|| {
            next[kind] += 1;
            format!("pass-{label}-{}", (next[kind] - 1) % PASS_COLOURS)
        });
    }
    classes
}
