//! The same strategies in each kind of frame that a renderer may draw: forward shading without a depth
//! pre-pass and with one, and deferred shading without and with model ids in the G-buffer.

use super::column::Column;
use super::format::{number, significant};
use super::markup::{Html, html};
use super::raster::{self, MARK};
use super::table::{Look, Row, Table};
use crate::grouping::grouped_by;
use crate::results::{Bill, FrameKind, Machine, Record, Results};
use shading::Mode;

/// The heading of a kind of frame, and what strategies pay for in it.
fn words(kind: FrameKind) -> (&'static str, &'static str) {
    match kind {
        FrameKind::NoPrepass => (
            "forward, no pre-pass",
            "A strategy that reads depth pays for a depth pre-pass and then lights visible surfaces only. The \
             other strategies draw and light surfaces in one pass. So they also light surfaces that are hidden \
             by surfaces drawn later. Draws are not sorted by depth.",
        ),
        FrameKind::Prepass => (
            "forward, pre-pass",
            "The renderer draws a depth pre-pass anyway, so no strategy pays for it.",
        ),
        FrameKind::Deferred => (
            "deferred",
            "The renderer draws depth and a G-buffer anyway. A strategy that needs to know the model at each \
             pixel pays for a pass that draws model ids.",
        ),
        FrameKind::DeferredIds => (
            "deferred, ids",
            "The G-buffer also holds the model id of each pixel, so no strategy pays for a pass that draws them.",
        ),
    }
}

/// Methods under the same lights, each with its records in all modes, in the order of the records.
fn methods<'a>(records: &[&'a Record]) -> Vec<(&'a str, Vec<&'a Record>)> {
    let methods = records.iter().filter(|record| !record.is_control());
    grouped_by(methods.map(|record| (record.strategy.as_str(), *record)))
}

/// The kinds of frame that were measured or can be derived.
fn kinds(methods: &[(&str, Vec<&Record>)]) -> Vec<FrameKind> {
    let is_known =
        |kind: &FrameKind| methods.iter().any(|(_, own)| Bill::in_frame(*kind, own).is_some());
    FrameKind::ALL.into_iter().filter(is_known).collect()
}

/// How many modes were measured.
fn modes(records: &[&Record]) -> usize {
    let modes: std::collections::BTreeSet<_> =
        records.iter().map(|record| record.setting.mode).collect();
    modes.len()
}

/// Whether a kind of frame that is derived from the records of other kinds draws triangles for the method. With ids in
/// the G-buffer, `model-ids` is not drawn.
fn derived_rasterises(kind: FrameKind, own: &[&Record]) -> bool {
    let in_deferred = |record: &&&Record| record.setting.mode == Mode::Deferred;
    match kind {
        FrameKind::NoPrepass => true,
        FrameKind::DeferredIds => own
            .iter()
            .filter(in_deferred)
            .any(|record| record.raster_passes().iter().any(|name| *name != "model-ids")),
        FrameKind::Prepass | FrameKind::Deferred => false,
    }
}

fn cell(kind: FrameKind, own: &[&Record], machine: &Machine) -> Html {
    let Some(bill) = Bill::in_frame(kind, own) else { return super::format::ABSENT.into() };
    let measured = own.iter().find(|record| record.setting.mode == kind.mode());
    let is_marked = match measured {
        Some(record) => raster::is_marked(machine, record),
        None => machine.weak_raster().is_some() && derived_rasterises(kind, own),
    };
    let mark = if is_marked { format!(" {MARK}") } else { String::new() };
    let span = bill.span_ms.map_or_else(String::new, |ms| format!("; span {}", significant(ms)));
    let derived = if bill.is_derived { "; derived" } else { "" };
    html!(
        "{}{}<br><small>{} + {}; frame {}{}{}</small>",
        significant(bill.both_ms()),
        mark,
        significant(bill.assign_ms),
        significant(bill.shade_ms),
        significant(bill.frame_ms),
        span,
        derived
    )
}

/// A table of strategies and kinds of frame; empty where fewer than two kinds are known.
pub(crate) fn table(caption: &str, records: &[&Record], machine: &Machine) -> Html {
    let methods = methods(records);
    let kinds = kinds(&methods);
    if kinds.len() < 2 {
        return Html::default();
    }
    let column = |kind: FrameKind| {
        let (head, about) = words(kind);
        Column::markup(head, "ms", move |own: &Vec<&Record>| cell(kind, own, machine)).about(about)
    };
    let columns: Vec<_> = kinds.iter().copied().map(column).collect();
    let rows = methods.into_iter().map(|(name, own)| Row::new(name, own)).collect();
    let explain = |kind: &FrameKind| {
        let (head, about) = words(*kind);
        html!("<dt>{}</dt><dd>{}</dd>\n", head, about)
    };
    let explained: Html = kinds.iter().map(explain).collect();
    let table = Table::new("strategy", columns, rows).html(caption, Look::Plain);
    html!("{}<dl class=\"columns\">{}</dl>\n", table, explained)
}

/// What a cell holds.
pub(crate) const READING: &str = "The large figure is assign + shade. The small figures are \
                                  assign, shade, and the sum of all passes of the frame. Span is \
                                  the time from the start of the first pass that assigns to the \
                                  end of the last pass that shades, gaps included. It is missing \
                                  where it was not measured. \u{201c}Derived\u{201d} marks a cell \
                                  that was not measured. It is computed from the times in \
                                  another kind of frame. For \u{201c}forward, no \
                                  pre-pass\u{201d}, the time of the depth pre-pass is added. For \
                                  \u{201c}deferred, ids\u{201d}, the time of the pass that draws \
                                  model ids is left out.";

/// A section per set of lights that was measured in several modes; empty where there is none.
pub(crate) fn sections(results: &Results) -> Html {
    let key = |record: &Record| {
        let size = (
            record.setting.width,
            record.setting.height,
            record.setting.lights,
            record.setting.seed,
        );
        (record.setting.scene.clone(), record.setting.scene_hash.clone(), size)
    };
    let groups = grouped_by(results.records.iter().map(|record| (key(record), record)));
    let section = |(ix, (_, group)): (usize, &(_, Vec<&Record>))| {
        let first = group.first().filter(|_| modes(group) > 1)?;
        let caption =
            format!("{}, {} lights", first.setting.scene, number(first.setting.lights as f64));
        let table = table(&format!("Kinds of frame: {caption}"), group, &results.machine);
        (!table.is_empty()).then(|| {
            html!(
                "<section class=\"frames\" aria-labelledby=\"frames{0}\"><h2 id=\"frames{0}\">Kinds of frame: \
                 {1}</h2>\n<p class=\"meta\">{2}</p>\n{3}</section>\n",
                ix,
                caption,
                READING,
                table
            )
        })
    };
    groups.iter().enumerate().filter_map(section).collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::results::{PassKind, PassTimes};

    /// A deferred record of these passes, 1 ms each.
    fn record(strategy: &str, passes: &[&'static str]) -> Record {
        let example: Results =
            serde_json::from_str(include_str!("../results/example.json")).expect("the example");
        let mut record = example.records[0].clone();
        record.strategy = strategy.into();
        record.setting.mode = Mode::Deferred;
        record.times.passes = Default::default();
        for name in passes {
            record.times.passes.insert(*name, PassTimes::new(PassKind::Assign, vec![1.0]));
        }
        record
    }

    #[test]
    fn frames_with_ids_are_marked_for_what_they_still_rasterise() {
        for (strategy, passes, marked) in [
            ("M/2", &["model-ids", "cull"][..], false),
            ("HG/48x48x40", &["count", "fill"], false),
            ("HG/48x48x40/raster", &["count", "fill"], true),
            ("RasterSphere", &["shade"], true),
        ] {
            let record = record(strategy, passes);
            assert_eq!(
                derived_rasterises(FrameKind::DeferredIds, &[&record]),
                marked,
                "{strategy}"
            );
        }
    }
}
