//! The same methods in each kind of frame that a renderer may draw.

use crate::report::format::number;
use crate::report::frames::{READING, table};
use crate::report::markup::Html;
use crate::results::{Machine, Record};
use crate::study::manifest::Done;
use crate::study::page::part::Part;

/// The kinds of frame: from jobs in several modes (section `frames`), or what the main comparison lets
/// derive.
pub(crate) fn frames(done: &Done, scene: &str) -> Part {
    let jobs_of = |section| -> Vec<(&Machine, Vec<&Record>)> {
        let jobs = done.section(scene, section);
        jobs.map(|(_, results)| (&results.machine, results.records.iter().collect())).collect()
    };
    let jobs =
        Some(jobs_of("frames")).filter(|jobs| !jobs.is_empty()).unwrap_or_else(|| jobs_of("main"));
    let mut tables = Html::default();
    for (machine, records) in jobs.iter().rev() {
        let Some(first) = records.first() else { continue };
        let caption = format!("{scene}, {} lights", number(first.setting.lights as f64));
        tables += table(&format!("Kinds of frame: {caption}"), records, machine);
    }
    Part::new("frames", "Kinds of frame", READING, tables)
}
