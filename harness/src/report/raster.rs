//! Marks rows whose times are limited by rasterisation, on chips that are weak at it.
//!
//! Data-centre GPUs run fragment shaders on only a few of their processors. A row is marked if a pass on its
//! bill draws triangles: lighting in forward shading, light volumes, model ids, layers,
//! and lights that the rasteriser adds to cells. The report computes the
//! mark, so stored results get it too.

use super::rank::listed;
use crate::grouping::{distinct, grouped_by};
use crate::results::{Machine, Record};

/// Follows the name of a marked row.
pub(crate) const MARK: &str = "\u{2020}";

/// Strategies of one mode beyond this number are counted, not named.
const NAMED: usize = 6;

/// What older programs wrote into the note of each forward record.
const OLD_NOTE: &str = "this data-centre GPU runs fragment shaders on a few of its processors: compare \
                        forward figures with no other chip's";

/// Whether a record's row is marked.
pub(crate) fn is_marked(machine: &Machine, record: &Record) -> bool {
    machine.weak_raster().is_some() && !record.raster_passes().is_empty()
}

/// ` \u{2020}` for a marked row, else nothing.
pub(crate) fn mark(machine: &Machine, record: &Record) -> &'static str {
    if is_marked(machine, record) { " \u{2020}" } else { "" }
}

/// What the mark means and which rows carry it; `None` where no row does.
pub(crate) fn notice<'a>(
    machine: &Machine,
    records: impl IntoIterator<Item = &'a Record>,
) -> Option<String> {
    let chip = machine.weak_raster()?;
    // Strategies by mode and passes, in the order of the records.
    let marked = records.into_iter().filter_map(|record| {
        let passes = record.raster_passes();
        let key = (record.setting.mode.name(), quoted(&passes));
        (!passes.is_empty()).then_some((key, record.strategy.as_str()))
    });
    let of_passes = |((mode, passes), names): ((&'static str, String), Vec<&str>)| {
        let names = distinct(names);
        let names = match names.len() {
            1 => format!("the strategy {}", listed(&names)),
            count if count > NAMED => format!("{count} strategies"),
            _ => format!("the strategies {}", listed(&names)),
        };
        (mode, format!("{passes} of {names}"))
    };
    let marked: String = grouped_by(grouped_by(marked).into_iter().map(of_passes))
        .into_iter()
        .map(|(mode, parts)| format!(" Marked passes in {mode} frames: {}.", parts.join("; ")))
        .collect();
    (!marked.is_empty()).then(|| {
        format!(
            "{MARK} {chip} runs fragment shaders on only a few of its processors, so passes that draw triangles \
             are slow there. Do not compare marked figures across chips.{marked}"
        )
    })
}

/// `the pass “shade”`, or `the passes “depth” and “shade”`.
fn quoted(passes: &[&str]) -> String {
    let names: Vec<String> = passes.iter().map(|name| format!("\u{201c}{name}\u{201d}")).collect();
    let noun = if names.len() == 1 { "pass" } else { "passes" };
    format!("the {noun} {}", listed(&names))
}

/// A record's note without the words that the mark replaces.
pub(crate) fn unmarked_note(record: &Record) -> Option<String> {
    let note = record.note.as_ref()?.replace(OLD_NOTE, "");
    let note = note.trim_matches(|c: char| c == ';' || c.is_whitespace());
    (!note.is_empty()).then(|| note.to_owned())
}

#[cfg(test)]
mod tests {
    use shading::Mode;

    use super::*;
    use crate::results::{PassKind, PassTimes, Results};

    #[test]
    fn stored_rows_are_marked_by_their_passes() {
        let example: Results =
            serde_json::from_str(include_str!("../results/example.json")).expect("the example");
        let machine = example.machine.clone();
        let record_of = |strategy: &str, mode, passes: &[(&str, PassKind)]| {
            let mut record = example.records[0].clone();
            (record.strategy, record.setting.mode) = (strategy.into(), mode);
            let times = |kind| PassTimes::new(kind, vec![1.0]);
            record.times.passes = passes.iter().map(|(name, kind)| (*name, times(*kind))).collect();
            record
        };
        let deferred =
            [("gbuffer", PassKind::Scene), ("cull", PassKind::Assign), ("shade", PassKind::Shade)];
        let ids = [("model-ids", PassKind::Assign), ("shade", PassKind::Shade)];
        let tiles = record_of("T-E/28x28", Mode::Deferred, &deferred);
        let volumes = record_of("RasterSphere", Mode::Deferred, &deferred);
        let models = record_of("M/2", Mode::Deferred, &ids);
        let mut forward = record_of("T-E/28x28", Mode::Forward, &deferred[1..]);
        forward.note = Some(format!("{OLD_NOTE}; lists overflowed"));
        assert_eq!(mark(&machine, &tiles), "");
        for record in [&volumes, &models, &forward] {
            assert_eq!(mark(&machine, record), " \u{2020}", "{}", record.strategy);
        }
        assert_eq!(unmarked_note(&forward).as_deref(), Some("lists overflowed"));
        let all = notice(&machine, [&tiles, &volumes, &models, &forward]).expect("three rows");
        for part in [
            "H200 runs",
            "Marked passes in deferred frames: the pass \u{201c}shade\u{201d} of the strategy \
             RasterSphere; the pass \u{201c}model-ids\u{201d} of the strategy M/2.",
            "Marked passes in forward frames: the pass \u{201c}shade\u{201d} of the strategy T-E/28x28.",
        ] {
            assert!(all.contains(part), "{part}: {all}");
        }
        let mut desktop = machine;
        desktop.adapter = "NVIDIA GeForce RTX 4090".to_owned();
        assert!(notice(&desktop, [&volumes]).is_none() && !is_marked(&desktop, &volumes));
    }
}
