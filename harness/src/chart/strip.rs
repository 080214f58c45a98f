//! A strip: each sample of one quantity as a tick, placed by how far it is from their median.

use super::number::length;
use super::text::escape;

/// The samples of one quantity, drawn as a line of a table.
#[derive(Clone, Debug, Default)]
pub struct Strip {
    /// What was sampled: a pass.
    pub name: String,
    /// The class that gives `--colour`.
    pub class: String,
    /// The text for screen readers and the tip.
    pub title: String,
    /// The samples, of which only finite ones are drawn.
    pub samples: Vec<f64>,
    /// Their median: the middle of the strip.
    pub median: f64,
    /// The distance from the middle to either end, as a share of the median.
    pub half_width: f64,
}

const HEIGHT: f64 = 24.0;
/// Half the width of a strip.
const HALF: f64 = 500.0;
/// The room at each end, so that a tick at the end is whole.
const MARGIN: f64 = 10.0;

impl Strip {
    /// How far a sample is from the median, as a share of it; 0 where the median is 0.
    fn deviation(&self, sample: f64) -> f64 {
        if self.median > 0.0 { sample / self.median - 1.0 } else { 0.0 }
    }

    fn finite(&self) -> impl Iterator<Item = f64> {
        self.samples.iter().copied().filter(|sample| sample.is_finite())
    }

    /// The largest distance of a sample from the median, as a share of it.
    pub fn reach(&self) -> f64 {
        self.finite().map(|sample| self.deviation(sample).abs()).fold(0.0, f64::max)
    }

    /// The samples that lie beyond the ends and are not drawn.
    pub fn beyond(&self) -> usize {
        self.finite().filter(|&sample| self.deviation(sample).abs() > self.half_width).count()
    }

    /// A fragment for a page that has [`CHART_CSS`](super::CHART_CSS). It stretches to the room it gets.
    pub fn to_svg(&self) -> String {
        let inside = self.finite().map(|sample| self.deviation(sample) / self.half_width);
        // Ticks of one unit's distance cannot be told apart, however many samples there are.
        let mut places: Vec<i32> = inside
            .filter(|share| share.abs() <= 1.0)
            .map(|share| (share * (HALF - MARGIN)).round() as i32)
            .collect();
        places.sort_unstable();
        places.dedup();
        let tick = |place: i32| format!("M{} 4V20", length(HALF + f64::from(place)));
        let ticks: String = places.into_iter().map(tick).collect();
        format!(
            "<svg class=\"strip\" xmlns=\"http://www.w3.org/2000/svg\" viewBox=\"0 0 {} {HEIGHT}\" \
             preserveAspectRatio=\"none\" role=\"img\"><title>{}</title>\
             <path class=\"middle\" d=\"M{HALF} 0V{HEIGHT}\"/>\
             <path class=\"ticks {}\" d=\"{ticks}\"/></svg>",
            2.0 * HALF,
            escape(&self.title),
            escape(&self.class),
        )
    }
}

/// A round share of the median within which all samples of all strips lie, at most 1.
pub fn half_width<'a>(strips: impl IntoIterator<Item = &'a Strip>) -> f64 {
    let reach = strips.into_iter().map(Strip::reach).fold(0.0, f64::max);
    let round = [0.01, 0.02, 0.03, 0.05, 0.1, 0.2, 0.3, 0.5];
    round.into_iter().find(|&share| share >= reach).unwrap_or(1.0)
}
