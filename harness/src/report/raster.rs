//! Marks rows whose times are limited by rasterisation, on chips that are weak at it.
//!
//! Data-centre GPUs run fragment shaders on only a few of their processors. A row is marked if a pass on its
//! bill draws triangles: lighting in forward shading, light volumes, and model ids. The report computes the
//! mark, so stored results get it too.

use super::rank::listed;
use crate::results::{Machine, Mode, Record};

/// Marked passes, and the strategies that have them.
type Group<'a> = (Vec<&'a str>, Vec<&'a str>);

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
pub(crate) fn mark(machine: &Machine, record: &Record) -> String {
    if is_marked(machine, record) { format!(" {MARK}") } else { String::new() }
}

/// What the mark means and which rows carry it; `None` where no row does.
pub(crate) fn notice<'a>(
    machine: &Machine,
    records: impl IntoIterator<Item = &'a Record>,
) -> Option<String> {
    let chip = machine.weak_raster()?;
    // Strategies by mode and passes, in the order of the records.
    let mut modes: Vec<(Mode, Vec<Group<'_>>)> = Vec::new();
    for record in records {
        let passes = record.raster_passes();
        if passes.is_empty() {
            continue;
        }
        let mode = record.setting.mode;
        let known = modes.iter().position(|(known, _)| *known == mode);
        let ix = known.unwrap_or_else(|| {
            modes.push((mode, Vec::new()));
            modes.len() - 1
        });
        let groups = &mut modes[ix].1;
        match groups.iter_mut().find(|(known, _)| *known == passes) {
            Some((_, names)) if !names.contains(&record.strategy.as_str()) => {
                names.push(&record.strategy);
            }
            Some(_) => {}
            None => groups.push((passes, vec![&record.strategy])),
        }
    }
    let words = |(passes, names): &Group<'_>| {
        let pass = if passes.len() == 1 { "pass" } else { "passes" };
        let names = match names.len() {
            count if count > NAMED => format!("{count} strategies"),
            _ => listed(names),
        };
        format!("the {pass} {} of {names}", listed(passes))
    };
    let marked: String = modes
        .iter()
        .map(|(mode, groups)| {
            let parts: Vec<String> = groups.iter().map(words).collect();
            format!(" Marked in {} frames: {}.", mode.name(), parts.join("; "))
        })
        .collect();
    (!marked.is_empty()).then(|| {
        format!(
            "{MARK} {chip} runs fragment shaders on only a few of its processors, so passes that draw triangles \
             are slow there. Do not compare marked figures across chips.{marked}"
        )
    })
}

/// A record's note without the words that the mark replaces.
pub(crate) fn unmarked_note(record: &Record) -> Option<String> {
    let note = record.note.as_ref()?.replace(OLD_NOTE, "");
    let note = note.trim_matches(|c: char| c == ';' || c.is_whitespace());
    (!note.is_empty()).then(|| note.to_owned())
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::results::{PassKind, PassTimes, Results};

    #[test]
    fn stored_rows_are_marked_by_their_passes() {
        let example: Results =
            serde_json::from_str(include_str!("../results/example.json")).expect("the example");
        let machine = example.machine.clone();
        let of = |strategy: &str, mode, passes: &[(&str, PassKind)]| {
            let mut record = example.records[0].clone();
            (record.strategy, record.setting.mode) = (strategy.into(), mode);
            let times = |kind| PassTimes::new(kind, vec![1.0]);
            record.times.passes = passes.iter().map(|(name, kind)| (*name, times(*kind))).collect();
            record
        };
        let deferred =
            [("gbuffer", PassKind::Scene), ("cull", PassKind::Assign), ("shade", PassKind::Shade)];
        let ids = [("model-ids", PassKind::Assign), ("shade", PassKind::Shade)];
        let tiles = of("T-E/28x28", Mode::Deferred, &deferred);
        let volumes = of("RasterSphere", Mode::Deferred, &deferred);
        let models = of("M/2", Mode::Deferred, &ids);
        let mut forward = of("T-E/28x28", Mode::Forward, &deferred[1..]);
        forward.note = Some(format!("{OLD_NOTE}; lists overflowed"));
        assert_eq!(mark(&machine, &tiles), "");
        for record in [&volumes, &models, &forward] {
            assert_eq!(mark(&machine, record), " \u{2020}", "{}", record.strategy);
        }
        assert_eq!(unmarked_note(&forward).as_deref(), Some("lists overflowed"));
        let all = notice(&machine, [&tiles, &volumes, &models, &forward]).expect("three rows");
        for part in [
            "H200 runs",
            "Marked in deferred frames: the pass shade of RasterSphere; the pass model-ids of M/2.",
            "Marked in forward frames: the pass shade of T-E/28x28.",
        ] {
            assert!(all.contains(part), "{part}: {all}");
        }
        let mut desktop = machine;
        desktop.adapter = "NVIDIA GeForce RTX 4090".to_owned();
        assert!(notice(&desktop, [&volumes]).is_none() && !is_marked(&desktop, &volumes));
    }
}
