//! What a strategy lost: in words, in the columns that a comparison with lossy strategies gains, and in the
//! terminal's table of losses.

use super::column::{Better, Column};
use super::comparison::Comparison;
use super::format::{difference, number, percent};
use super::metrics::{Metric, figure, metrics, table};
use super::rank::listed;
use crate::results::{Record, TemporalError};

/// The columns of errors against no culling.
pub(crate) fn error_columns<'a>() -> Vec<Metric<'a>> {
    [
        figure(
            "missing_energy",
            "missing energy",
            "%",
            Better::Zero,
            |m| error(m.record, "missing_energy"),
            percent,
        )
        .terminal("missing energy")
        .about(
            "Luminance that is lost in pixels that are darker than without culling, as a share of \
             the total luminance without culling.",
        ),
        figure("rel_mse", "relMSE", "", Better::Zero, |m| error(m.record, "rel_mse"), difference)
            .terminal("relMSE")
            .about(
                "Mean over channels of (a - b)^2 / (b^2 + (0.1 \u{d7} L)^2). Here a is the channel \
                 with this strategy, b is the same channel without culling, and L is the mean \
                 luminance of the image without culling.",
            ),
        figure("flip", "FLIP", "", Better::Zero, |m| error(m.record, "flip"), difference)
            .terminal("FLIP")
            .about(
                "Mean FLIP against no culling: the difference that an eye sees when it flips \
                 between the two images, from 0 to 1.",
            ),
        figure(
            "temporal",
            "temporal error",
            "",
            Better::Zero,
            |m| temporal(m.record).and_then(|found| found.worst),
            difference,
        )
        .terminal("temporal")
        .about(
            "The largest change of a channel\u{2019}s error from one frame to the next, linear HDR. The error is \
             the image minus that of no culling in the same frame. It is known where --temporal compared \
             frames that follow each other.",
        ),
    ]
    .map(Column::optional)
    .into()
}

/// The temporal error of a record; `None` where none was measured.
fn temporal(record: &Record) -> Option<&TemporalError> {
    record.image.temporal.as_ref()
}

/// An error against no culling: 0 where no bit differs.
fn error(record: &Record, id: &str) -> Option<f64> {
    let same =
        record.image.differing_channels == Some(0) && record.lists.missed_pairs.unwrap_or(0) == 0;
    record.image.errors.get(id).copied().flatten().or(same.then_some(0.0))
}

/// Whether a strategy may lose light, or has lost some.
fn is_lossy(record: &Record) -> bool {
    !record.is_control() && !record.shows_no_loss()
}

/// The columns of a comparison: those of all, and errors where a strategy may lose light.
pub(crate) fn columns<'a>(comparison: &Comparison<'_>) -> Vec<Metric<'a>> {
    metrics().into_iter().chain(errors_of(comparison)).collect()
}

/// The columns of errors where a strategy of the comparison may lose light; else none.
pub(crate) fn errors_of<'a>(comparison: &Comparison<'_>) -> Vec<Metric<'a>> {
    if comparison.all().any(is_lossy) { error_columns() } else { Vec::new() }
}

/// The errors of a record: `30.1 % missing energy, relMSE 0.210, FLIP 0.104`; empty where none is known.
pub fn error_words(record: &Record) -> String {
    let metric = |id| error(record, id);
    let words = [
        metric("missing_energy").map(|share| format!("{} % missing energy", percent(share))),
        metric("rel_mse").map(|error| format!("relMSE {}", difference(error))),
        metric("flip").map(|error| format!("FLIP {}", difference(error))),
    ];
    words.into_iter().flatten().collect::<Vec<_>>().join(", ")
}

/// What a record lost, in words; `None` where it shows no loss.
pub(crate) fn loss(record: &Record) -> Option<String> {
    let missed = record.lists.missed_pairs.filter(|missed| *missed > 0).map(|missed| {
        format!("misses {} of {} (light, sample) pairs", number(missed as f64), checked(record))
    });
    let differs = match (record.image.differing_channels, record.image.max_abs_diff) {
        (Some(channels @ 1..), Some(most)) => Some(format!(
            "differs from no culling in {} channels, by at most {}",
            number(channels as f64),
            difference(most)
        )),
        (Some(channels @ 1..), None) => Some(format!(
            "differs from no culling in {} channels, by an amount that is not finite",
            number(channels as f64)
        )),
        (_, Some(most)) if most != 0.0 => {
            Some(format!("differs from no culling by at most {}", difference(most)))
        }
        _ => None,
    };
    let flickers = temporal(record).filter(|found| found.changes()).map(|found| {
        let [x, y] = found.worst_pixel;
        let frame = found.worst_frame;
        let worst = found.worst.map_or_else(|| "more than is finite".to_owned(), difference);
        format!("changes its error from frame to frame, by {worst} at most, at pixel {x},{y} of frame {frame}")
    });
    let parts: Vec<String> = [missed, differs, flickers].into_iter().flatten().collect();
    if parts.is_empty() {
        return None;
    }
    let errors = error_words(record);
    let errors = if errors.is_empty() { errors } else { format!(" ({errors})") };
    Some(listed(&parts) + &errors)
}

/// What the range of the lights loses in a record, whatever its strategy; `None` where it was not measured.
pub(crate) fn range_loss(record: &Record) -> Option<String> {
    let error = |id| record.image.unbounded_errors.get(id).copied().flatten();
    Some(format!(
        "{}, {}: against lights without a range, the image of {} has {} % missing energy and relMSE {}.",
        record.setting.scene,
        record.setting.mode.name(),
        record.strategy,
        percent(error("missing_energy")?),
        difference(error("rel_mse")?)
    ))
}

fn checked(record: &Record) -> String {
    record
        .lists
        .checked_pairs
        .map_or_else(|| "an unknown number of".to_owned(), |pairs| number(pairs as f64))
}

/// The terminal's table of what each lossy strategy lost; empty where there is none.
pub(crate) fn loss_table(comparison: &Comparison<'_>) -> String {
    if !comparison.all().any(is_lossy) {
        return String::new();
    }
    let lossy = comparison.all().filter(|record| is_lossy(record));
    format!("\n{}", table("lossy", comparison, lossy, error_columns()).text())
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::results::Results;

    #[test]
    fn only_known_errors_are_stated() {
        let example: Results =
            serde_json::from_str(include_str!("../results/example.json")).expect("the example");
        let mut record = example.records[0].clone();
        record.image.differing_channels = Some(7);
        record.image.errors = [("missing_energy", 0.3012), ("rel_mse", 0.21), ("flip", 0.1)]
            .map(|(id, error)| (id.to_owned(), Some(error)))
            .into();
        assert_eq!(error_words(&record), "30.1 % missing energy, relMSE 0.210, FLIP 0.100");
        record.image.errors.clear();
        assert_eq!(error_words(&record), "");
        record.image.differing_channels = Some(0);
        record.lists.missed_pairs = Some(0);
        assert_eq!(error_words(&record), "0 % missing energy, relMSE 0, FLIP 0");
    }
}
