//! Style classes that give passes their colours: the same in every table and chart of a page.

use std::collections::BTreeMap;

use super::living;
use crate::results::{PassKind, Results};

/// Colours that the style sheet has for the passes of one kind.
const PASS_COLOURS: usize = 4;

/// The classes of a page's passes. A strategy's class comes from its row: `StrategyId::class`.
pub(crate) struct Colours<'a> {
    passes: BTreeMap<&'a str, String>,
}

impl<'a> Colours<'a> {
    /// Gives each pass a hue by its kind and a shade by its place among passes of that kind. The passes of lights
    /// that move have a hue of their own.
    pub(crate) fn new(results: &'a Results) -> Self {
        Self { passes: passes(results) }
    }

    /// The class of a pass.
    pub(crate) fn pass(&self, name: &str) -> &str {
        self.passes.get(name).map_or("pass-other-0", String::as_str)
    }
}

fn passes(results: &Results) -> BTreeMap<&str, String> {
    let mut classes = BTreeMap::new();
    let mut next: [usize; 4] = [0; 4];
    for (name, times) in results.records.iter().flat_map(|record| record.times.passes.iter()) {
        if let Some(ix) = living::PASSES.iter().position(|pass| *pass == name) {
            classes.insert(name, format!("pass-living-{ix}"));
            continue;
        }
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
