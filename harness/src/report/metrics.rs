//! The columns of both views. A metric is a row: what it is called, its unit, which way is
//! better, how it is computed and how it is shown.

use super::comparison::Comparison;
use super::format;
use crate::results::Record;

/// Which way a metric is better.
#[derive(Clone, Copy, PartialEq, Eq)]
pub(super) enum Better {
    Less,
    More,
    /// Anything but 0 is a fault.
    Zero,
    Neither,
}

/// One column.
pub(super) struct Metric {
    /// Names the column in the page's markup.
    pub(super) id: &'static str,
    /// Its heading, without the unit.
    pub(super) head: &'static str,
    /// Its unit; in the terminal the second line of the heading.
    pub(super) unit: &'static str,
    /// Its heading in the terminal; empty where it is left out there.
    pub(super) terminal: &'static str,
    /// What it means, one sentence.
    pub(super) about: &'static str,
    pub(super) better: Better,
    /// `None` where it was not measured.
    pub(super) value: fn(&Comparison<'_>, &Record) -> Option<f64>,
    pub(super) show: fn(f64) -> String,
    /// Whether it is left out where no record has a value.
    pub(super) is_optional: bool,
}

/// All columns, in order.
pub(super) static METRICS: &[Metric] = &[
    Metric {
        id: "rank",
        head: "rank",
        unit: "",
        terminal: "rank",
        about: "Place by assign + shade among those that cull without a loss. Two methods tie and \
                share a place where the interval of the ratio of their times, round by round, \
                holds 1, or its median is within 0.5 % of 1.",
        better: Better::Neither,
        value: |c, r| c.rank(r),
        show: format::number,
        is_optional: false,
    },
    Metric {
        id: "both_ms",
        head: "assign + shade",
        unit: "ms",
        terminal: "both",
        about: "Assigning and shading together, median over frames, along a path the mean: compare strategies by it. The small figures \
                below it are the interval in which the median lies, from order statistics of the \
                rounds: with a probability of at least 95 % from six rounds on, with fewer as their \
                tip says.",
        better: Better::Less,
        value: |_, r| finite(r.assign_and_shade_ms()),
        show: format::significant,
        is_optional: false,
    },
    Metric {
        id: "span_ms",
        head: "span",
        unit: "ms",
        terminal: "span",
        about: "The second total: from the first pass that assigns lights to the end of the last that \
                lights pixels, gaps between passes included, median. Assign + shade is the sum of the \
                passes alone. Not known where each pass is submitted alone.",
        better: Better::Less,
        value: |_, r| r.times.span_ms.and_then(finite),
        show: format::significant,
        is_optional: true,
    },
    Metric {
        id: "speedup",
        head: "against None",
        unit: "\u{d7}",
        terminal: "faster",
        about: "How many times as fast as no culling, which evaluates every light at every sample; \
                the others leave out early what adds nothing.",
        better: Better::More,
        value: |c, r| c.speedup(r),
        show: format::factor,
        is_optional: false,
    },
    Metric {
        id: "speedup_sphere",
        head: "against Sphere",
        unit: "\u{d7}",
        terminal: "",
        about: "How many times as fast as no culling with the same early exit: what lists alone give.",
        better: Better::More,
        value: |c, r| c.speedup_over_exit(r),
        show: format::factor,
        is_optional: false,
    },
    Metric {
        id: "assign_ms",
        head: "assign",
        unit: "ms",
        terminal: "assign",
        about: "Every pass that makes the lists, summed: median over frames, along a path the mean.",
        better: Better::Less,
        value: |_, r| finite(r.times.assign_ms),
        show: format::significant,
        is_optional: false,
    },
    Metric {
        id: "shade_ms",
        head: "shade",
        unit: "ms",
        terminal: "shade",
        about: "Lighting every sample with the lights of its list: median over frames, along a path the mean.",
        better: Better::Less,
        value: |_, r| finite(r.times.shade_ms),
        show: format::significant,
        is_optional: false,
    },
    Metric {
        id: "frame_ms",
        head: "frame",
        unit: "ms",
        terminal: "",
        about: "All passes, those that draw the surfaces included, summed: median over frames, along a path the mean.",
        better: Better::Less,
        value: |_, r| finite(r.times.frame_ms),
        show: format::significant,
        is_optional: false,
    },
    Metric {
        id: "frame_span_ms",
        head: "frame span",
        unit: "ms",
        terminal: "",
        about: "From the first pass of the frame to the end of its last, gaps between passes included, \
                median.",
        better: Better::Less,
        value: |_, r| r.times.frame_span_ms.and_then(finite),
        show: format::significant,
        is_optional: true,
    },
    Metric {
        id: "efficiency",
        head: "efficiency",
        unit: "%",
        terminal: "",
        about: "Efficiency = ideal time / measured time. The ideal time is what no culling would \
                need, at its own rate, if it evaluated only the lights that reach each sample.",
        better: Better::More,
        value: |c, r| c.efficiency(r),
        show: format::percent,
        is_optional: false,
    },
    Metric {
        id: "listed",
        head: "listed",
        unit: "/sample",
        terminal: "listed",
        about: "Lights in the list that a sample reads, mean.",
        better: Better::Less,
        value: |_, r| r.lists.listed_per_sample,
        show: format::number,
        is_optional: false,
    },
    Metric {
        id: "contributing",
        head: "contributing",
        unit: "/sample",
        terminal: "contrib.",
        about: "Lights whose range reaches a sample, mean: what a perfect list would hold.",
        better: Better::Neither,
        value: |_, r| r.lists.contributing_per_sample,
        show: format::number,
        is_optional: false,
    },
    Metric {
        id: "missed",
        head: "missed",
        unit: "pairs",
        terminal: "missed",
        about: "(light, sample) pairs that the lists lack: 0, or the image is wrong.",
        better: Better::Zero,
        value: |_, r| r.lists.missed_pairs.map(|pairs| pairs as f64),
        show: format::number,
        is_optional: false,
    },
    Metric {
        id: "max_diff",
        head: "largest difference",
        unit: "linear",
        terminal: "max diff",
        about: "Largest difference of a channel to the image of no culling, linear HDR.",
        better: Better::Zero,
        value: |_, r| match (r.image.max_abs_diff, r.image.differing_channels) {
            (None, Some(1..)) => Some(f64::INFINITY),
            (difference, _) => difference,
        },
        show: format::difference,
        is_optional: false,
    },
    Metric {
        id: "differing",
        head: "differing",
        unit: "channels",
        terminal: "",
        about: "Channels, three a pixel, of which any bit differs from the image of no culling.",
        better: Better::Zero,
        value: |_, r| r.image.differing_channels.map(|channels| channels as f64),
        show: format::number,
        is_optional: false,
    },
    Metric {
        id: "memory_bytes",
        head: "memory",
        unit: "MiB",
        terminal: "memory",
        about: "GPU memory of everything that assignment needs: lists, marks, bounds, pools, the \
                hierarchy over the lights, and images that the renderer draws only for this method.",
        better: Better::Less,
        value: |_, r| r.lists.memory_bytes.map(|bytes| bytes as f64),
        show: format::mebibytes,
        is_optional: true,
    },
    Metric {
        id: "lists_bytes",
        head: "lists",
        unit: "MiB",
        terminal: "lists",
        about: "GPU memory of groups and lists only: these results were stored before all memory was \
                counted, and a method\u{2019}s marks, bounds and second pools are missing.",
        better: Better::Less,
        value: |_, r| {
            (r.lists.memory_bytes.is_none() && r.lists.bytes > 0).then_some(r.lists.bytes as f64)
        },
        show: format::mebibytes,
        is_optional: true,
    },
    Metric {
        id: "overflow",
        head: "overflow",
        unit: "groups",
        terminal: "overflow",
        about: "Groups whose list did not fit and that fell back to all lights: slow, still correct.",
        better: Better::Neither,
        value: |_, r| Some(r.lists.overflowed_groups as f64),
        show: format::number,
        is_optional: false,
    },
];

impl Metric {
    /// Whether a comparison has the column.
    pub(super) fn is_shown(&self, comparison: &Comparison<'_>) -> bool {
        let has_value = |(_, record): &(usize, &Record)| (self.value)(comparison, record).is_some();
        !self.is_optional || comparison.records.iter().any(has_value)
    }

    /// The value as text; a dash where there is none.
    pub(super) fn text(&self, comparison: &Comparison<'_>, record: &Record) -> String {
        (self.value)(comparison, record).map_or_else(|| format::ABSENT.to_owned(), self.show)
    }
}

fn finite(value: f64) -> Option<f64> {
    value.is_finite().then_some(value)
}
