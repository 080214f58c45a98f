//! Histograms, several side by side on one scale.

use super::canvas::{Anchor, Canvas, LINE, Target, WIDTH};
use super::domain::{Domain, Track};
use super::number::{grouped, plain, significant};
use super::occupancy::Area;
use super::text::{shorten, shorten_bold, width, wrap};

/// Counts per bin.
#[derive(Clone, Debug, Default)]
pub struct Histogram {
    /// What is counted.
    pub title: String,
    /// The quantity that the bins divide.
    pub x_label: String,
    /// The name and the count of each bin.
    pub bins: Vec<(String, u64)>,
    /// The class that gives `--colour`.
    pub class: String,
    /// A remark below it; may be empty.
    pub note: String,
}

const GAP: f64 = 20.0;
const HEIGHT: f64 = 120.0;
const TICKS: usize = 4;

impl Histogram {
    /// A fragment for a page that has [`CHART_CSS`](super::CHART_CSS) and its variables.
    pub fn to_svg(&self) -> String {
        histograms_svg(&self.title, std::slice::from_ref(self))
    }

    /// A file of its own, light or dark as its reader prefers.
    pub fn to_svg_file(&self) -> String {
        histograms_svg_file(&self.title, std::slice::from_ref(self))
    }

    fn total(&self) -> f64 {
        self.bins.iter().map(|(_, count)| *count as f64).sum()
    }
}

/// Histograms in a grid, as a fragment for a page.
pub fn histograms_svg(title: &str, histograms: &[Histogram]) -> String {
    render(title, histograms, Target::Page)
}

/// Histograms in a grid, as a file of their own.
pub fn histograms_svg_file(title: &str, histograms: &[Histogram]) -> String {
    render(title, histograms, Target::File)
}

fn render(title: &str, histograms: &[Histogram], target: Target) -> String {
    let columns = match histograms.len() {
        0 | 1 => 1,
        2 | 4 => 2,
        _ => 3,
    };
    let counts = histograms.iter().flat_map(|h| &h.bins).map(|(_, count)| *count as f64);
    let domain = Domain::from_zero(counts);
    let labels = domain.ticks(TICKS).into_iter().map(|tick| width(&plain(tick.value)));
    let beside = labels.fold(0.0, f64::max) + 8.0;
    let panel = (WIDTH - beside - GAP * (columns - 1) as f64) / columns as f64;
    let mut canvas = Canvas::new(target);
    let mut end = 0.0_f64;
    for row in histograms.chunks(columns) {
        let top = if end > 0.0 { end + 14.0 } else { 0.0 };
        for (histogram, ix) in row.iter().zip(0_u32..) {
            let left = beside + f64::from(ix) * (panel + GAP);
            let top = if histograms.len() > 1 { top + LINE + 6.0 } else { top + 8.0 };
            let plot = Area { left, top, right: left + panel, bottom: top + HEIGHT };
            if histograms.len() > 1 {
                let name = shorten_bold(&histogram.title, panel);
                let at = [left, top - 11.0];
                canvas.cut_text("strong", at, Anchor::Start, &name, &histogram.title);
            }
            end = end.max(draw(&mut canvas, histogram, &domain, &plot, ix == 0));
        }
    }
    canvas.finish(title, end + 4.0)
}

/// Draws one. Returns where it ends.
fn draw(canvas: &mut Canvas, shown: &Histogram, domain: &Domain, plot: &Area, first: bool) -> f64 {
    let track = Track::new(*domain, plot.bottom, plot.top);
    for tick in domain.ticks(TICKS) {
        let y = track.within(tick.value);
        canvas.line("grid", [plot.left, y], [plot.right, y]);
        if first {
            let at = [plot.left - 7.0, y + 5.0];
            canvas.text("soft", at, Anchor::End, &plain(tick.value));
        }
    }
    let step = plot.width() / shown.bins.len().max(1) as f64;
    let total = shown.total().max(1.0);
    canvas.open(&format!("tint {}", shown.class), "", "");
    for (ix, (name, count)) in shown.bins.iter().enumerate() {
        let left = plot.left + step * ix as f64;
        let share = *count as f64 / total * 100.0;
        let heading = if shown.title.is_empty() { "" } else { &shown.title };
        let count_text = grouped(&count.to_string());
        let tip = format!("{heading}\n{name}: {count_text} ({}%)", significant(share));
        let column = Area { left, right: left + step, ..*plot };
        let gap = (step * 0.12).min(2.0);
        let mut bar = Area { left: left + gap, right: left + step - gap, ..column };
        bar.top = track.within(*count as f64);
        if *count > 0 {
            bar.top = bar.top.min(plot.bottom - 1.0);
        }
        canvas.open("", tip.trim(), "");
        canvas.area("fill", &bar);
        canvas.area("hit", &column);
        canvas.close();
    }
    canvas.close();
    canvas.line("base", [plot.left, plot.bottom], [plot.right, plot.bottom]);
    let mut end = plot.bottom + LINE;
    draw_bin_names(canvas, shown, step, plot);
    if !shown.x_label.is_empty() {
        end += LINE;
        let text = shorten(&shown.x_label, plot.width());
        canvas.cut_text("soft", [plot.left, end - 2.0], Anchor::Start, &text, &shown.x_label);
    }
    for line in wrap(&shown.note, plot.width()) {
        end += LINE;
        canvas.text("soft", [plot.left, end - 2.0], Anchor::Start, &line);
    }
    end + 4.0
}

/// Names every bin, or every second, third … where there is no room.
fn draw_bin_names(canvas: &mut Canvas, shown: &Histogram, step: f64, plot: &Area) {
    let widest = shown.bins.iter().map(|(name, _)| width(name)).fold(0.0, f64::max);
    let most = plot.width() * 0.45;
    let stride = ((widest.min(most) + 10.0) / step.max(0.1)).ceil().max(1.0) as usize;
    for (ix, (name, _)) in shown.bins.iter().enumerate().step_by(stride) {
        let text = shorten(name, most);
        let half = width(&text) * 0.5;
        let middle = plot.left + step * (ix as f64 + 0.5);
        let x = middle.clamp(plot.left + half, (plot.right - half).max(plot.left + half));
        canvas.text("soft", [x, plot.bottom + LINE - 3.0], Anchor::Middle, &text);
    }
}
