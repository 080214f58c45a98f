//! The columns of a comparison's table, on the page, in the terminal and in documents.

use super::column::Better::{self, Less, More, Neither, Zero};
use super::column::Column;
use super::comparison::Comparison;
use super::format::{difference, factor, mebibytes, number, percent, significant};
use super::markup::{Html, html};
use super::rank::competes;
use super::table::{Row, Table};
use crate::results::Record;

/// A record among those that it is compared with.
#[derive(Clone, Copy)]
pub(crate) struct Measured<'a> {
    pub(crate) comparison: &'a Comparison<'a>,
    pub(crate) record: &'a Record,
}

/// A column of a comparison's table.
pub(crate) type Metric<'a> = Column<'a, Measured<'a>>;

impl Measured<'_> {
    /// Whether it shares the first rank, and some strategy is slower.
    fn leads(&self) -> bool {
        let ranks = self.comparison.ranks();
        ranks.iter().any(|ranked| ranked.rank == 1 && std::ptr::eq(ranked.record, self.record))
            && ranks.iter().any(|ranked| ranked.rank > 1)
    }

    fn competes(&self) -> bool {
        competes(self.record)
    }
}

/// A table of records of a comparison, under their names.
pub(crate) fn table<'a>(
    head: &'static str,
    comparison: &'a Comparison<'a>,
    records: impl Iterator<Item = &'a Record>,
    columns: Vec<Metric<'a>>,
) -> Table<'a, Measured<'a>> {
    let row = |record| Row::new(comparison.name(record), Measured { comparison, record });
    Table::new(head, columns, records.map(row).collect()).competing(Measured::competes)
}

/// A column of figures; see [`Column::figure`].
pub(crate) fn figure<'a>(
    id: &'static str,
    head: &str,
    unit: &str,
    better: Better,
    value: impl Fn(&Measured<'a>) -> Option<f64> + 'a,
    show: fn(f64) -> String,
) -> Metric<'a> {
    Column::figure(head, unit, better, value, show).id(id)
}

/// All columns, in order: times, lists, losses, memory.
pub(crate) fn metrics<'a>() -> Vec<Metric<'a>> {
    [times(), ratios_and_parts(), lists(), losses(), memory()].into_iter().flatten().collect()
}

fn times<'a>() -> Vec<Metric<'a>> {
    vec![
        figure("rank", "rank", "", Neither, |m| m.comparison.rank(m.record), number)
            .terminal("rank")
            .about(
                "Rank by assign + shade, among the strategies of the table that cull without a \
                 loss. For each round, we take the ratio of two strategies\u{2019} times. The \
                 strategies tie and share a rank if the confidence interval of the median ratio \
                 contains 1, or if the median ratio is within 0.5 % of 1.",
            ),
        figure(
            "both_ms",
            "assign + shade",
            "ms",
            Less,
            |m| finite(m.record.assign_and_shade_ms()),
            significant,
        )
        .terminal("both")
        .best(Measured::leads)
        .note(|m| interval(m.record))
        .about(
            "Assign and shade together: compare strategies by this time. It is the median over \
                 frames, or the mean along a path. The small figures below it are a confidence \
                 interval for the median over rounds or laps, from order statistics. A tooltip \
                 shows its coverage, which is at least 95 % from six rounds on.",
        ),
        figure(
            "span_ms",
            "span",
            "ms",
            Less,
            |m| m.record.times.span_ms.and_then(finite),
            significant,
        )
        .terminal("span")
        .optional()
        .about(
            "Time from the start of the first pass that assigns lights to the end of the last \
                 pass that lights pixels, gaps between passes included: median over frames, or the \
                 mean along a path. Assign + shade sums the passes without the gaps. The span is \
                 unknown where each pass is submitted separately.",
        ),
    ]
}

fn ratios_and_parts<'a>() -> Vec<Metric<'a>> {
    vec![
        figure("speedup", "against None", "\u{d7}", More, |m| m.comparison.speedup(m.record), factor)
            .terminal("faster")
            .best(Measured::leads)
            .about(
                "How many times as fast as the strategy None, which evaluates every light at every \
                 sample. All other strategies skip a light that adds nothing to the sample (early exit), \
                 unless their id has no-exit.",
            ),
        figure(
            "speedup_sphere",
            "against Sphere",
            "\u{d7}",
            More,
            |m| m.comparison.speedup_over_exit(m.record),
            factor,
        )
        .best(Measured::leads)
        .about(
            "How many times as fast as the strategy Sphere, which does not cull but has the same \
             early exit. This is the gain from the lists only.",
        ),
        figure("assign_ms", "assign", "ms", Less, |m| finite(m.record.times.assign_ms), significant)
            .terminal("assign")
            .about(
                "Sum of the passes that make the lists: median over frames, or the mean along a path.",
            ),
        figure("shade_ms", "shade", "ms", Less, |m| finite(m.record.times.shade_ms), significant)
            .terminal("shade")
            .about(
                "Time to light every sample with the lights of its list: median over frames, or the mean \
                 along a path.",
            ),
        figure("frame_ms", "frame", "ms", Less, |m| finite(m.record.times.frame_ms), significant).about(
            "Sum of all passes, those that draw the surfaces included: median over frames, or the mean along \
             a path.",
        ),
        figure(
            "frame_span_ms",
            "frame span",
            "ms",
            Less,
            |m| m.record.times.frame_span_ms.and_then(finite),
            significant,
        )
        .optional()
        .about(
            "Time from the start of the first pass of the frame to the end of its last pass, gaps \
             between passes included: median over frames, or the mean along a path.",
        ),
        figure("efficiency", "efficiency", "%", More, |m| m.comparison.efficiency(m.record), percent)
            .best(Measured::leads)
            .about(
                "Efficiency = ideal time / measured time. Ideal time = (shade time of None) \u{d7} \
                 (number of contributing lights) / (number of all lights). None would take about \
                 this long if it evaluated only the lights that reach each sample.",
            ),
    ]
}

fn lists<'a>() -> Vec<Metric<'a>> {
    vec![
        figure("listed", "listed", "/sample", Less, |m| m.record.lists.listed_per_sample, number)
            .terminal("listed")
            .about("Mean number of lights in the list that a sample reads."),
        figure(
            "contributing",
            "contributing",
            "/sample",
            Neither,
            |m| m.record.lists.contributing_per_sample,
            number,
        )
        .terminal("contrib.")
        .about(
            "Mean number of lights whose support holds a sample. A perfect list holds these lights only.",
        ),
    ]
}

fn losses<'a>() -> Vec<Metric<'a>> {
    let largest =
        |m: &Measured<'_>| match (m.record.image.max_abs_diff, m.record.image.differing_channels) {
            (None, Some(1..)) => Some(f64::INFINITY),
            (difference, _) => difference,
        };
    vec![
        figure("missed", "missed", "pairs", Zero, |m| m.record.lists.missed_pairs.map(count), number)
            .terminal("missed")
            .about(
                "Pairs of a light and a sample in which the light reaches the sample, but is \
                 missing from its list. If this is not 0, the image is wrong.",
            ),
        figure("max_diff", "largest difference", "linear", Zero, largest, difference)
            .terminal("max diff")
            .about("Largest difference of a channel from the image of no culling, in linear HDR."),
        figure(
            "differing",
            "differing",
            "channels",
            Zero,
            |m| m.record.image.differing_channels.map(count),
            number,
        )
        .about(
            "Channels, three per pixel, in which at least one bit differs from the image of no culling.",
        ),
    ]
}

fn memory<'a>() -> Vec<Metric<'a>> {
    let lists_only = |m: &Measured<'_>| {
        let is_stored = m.record.lists.assignment_bytes.is_none() && m.record.lists.list_bytes > 0;
        is_stored.then(|| count(m.record.lists.list_bytes))
    };
    vec![
        figure(
            "memory_bytes",
            "memory",
            "MiB",
            Less,
            |m| m.record.lists.assignment_bytes.map(count),
            mebibytes,
        )
        .terminal("memory")
        .optional()
        .about(
            "GPU memory of everything that assignment needs: lists, bounds, working buffers, \
                 the hierarchy over the lights, and images that the renderer draws for this \
                 strategy only.",
        ),
        figure("lists_bytes", "lists", "MiB", Less, lists_only, mebibytes)
            .terminal("lists")
            .optional()
            .about(
                "GPU memory of groups and lists only. When these results were measured, lightbench \
                 did not count bounds and other working buffers.",
            ),
        figure(
            "overflow",
            "overflow",
            "groups",
            Neither,
            |m| Some(count(m.record.lists.overflowed_groups)),
            number,
        )
        .terminal("overflow")
        .about(
            "Groups whose list did not fit into memory. They use the list of all lights, which is \
             slow but correct.",
        ),
    ]
}

/// Where the median of assign + shade lies, in small; its tooltip says how surely.
pub(crate) fn interval(record: &Record) -> Html {
    record.interval_ms().map_or_else(Html::default, |interval| {
        html!(
            "<small class=\"interval\" title=\"{} % of such intervals contain the median\">\
             {}\u{2013}{}</small>",
            significant(interval.coverage * 100.0),
            significant(interval.low),
            significant(interval.high)
        )
    })
}

fn count(count: u64) -> f64 {
    count as f64
}

fn finite(value: f64) -> Option<f64> {
    value.is_finite().then_some(value)
}
