//! Axes as they are drawn: grid lines, ticks, captions.

use super::canvas::{Anchor, Canvas, LINE, WIDTH};
use super::domain::{Domain, Track};
use super::number::plain;
use super::occupancy::Area;
use super::text::{shorten, width};
use super::ticks::Tick;

const VERTICAL_TICKS: usize = 6;
const HORIZONTAL_TICKS: usize = 7;
/// The gap beside a tick's label.
const GAP: f64 = 8.0;
/// The length of the marks between the ticks of a logarithmic axis.
const MINOR: f64 = 4.0;

/// The room that the labels beside a vertical axis take.
pub(super) fn room_beside(domain: &Domain) -> f64 {
    let ticks = domain.ticks(VERTICAL_TICKS);
    let widest = ticks.iter().map(|tick| width(&plain(tick.value))).fold(width("0"), f64::max);
    (widest + GAP).max(24.0)
}

/// The ticks whose labels do not overlap each other or the label of the zero lane. Major ticks go first. The
/// minor ones follow if there is room for all of them.
fn apart(ticks: Vec<Tick>, track: &Track, size: impl Fn(&str) -> f64) -> Vec<(f64, String)> {
    let (major, minor): (Vec<Tick>, Vec<Tick>) = ticks.into_iter().partition(|tick| tick.major);
    let zero = track.zero().map(|at| (at, size("0") * 0.5, "0".to_owned()));
    let lane = usize::from(zero.is_some());
    let mut kept: Vec<(f64, f64, String)> = zero.into_iter().collect();
    let lay = |ticks: Vec<Tick>, kept: &mut Vec<(f64, f64, String)>| {
        let mut all = true;
        for tick in ticks {
            let Some(at) = track.at(tick.value) else { continue };
            let text = plain(tick.value);
            let half = size(&text) * 0.5;
            if kept.iter().all(|(other, its_half, _)| (at - other).abs() >= half + its_half) {
                kept.push((at, half, text));
            } else {
                all = false;
            }
        }
        all
    };
    lay(major, &mut kept);
    let powers = kept.len();
    if !lay(minor, &mut kept) && powers > lane + 1 {
        kept.truncate(powers);
    }
    kept.into_iter().skip(lane).map(|(at, _, text)| (at, text)).collect()
}

/// Draws a vertical axis at the left of the plot, its caption above it.
pub(super) fn draw_vertical(canvas: &mut Canvas, track: &Track, domain: &Domain, plot: &Area) {
    if let Some(zero) = track.zero() {
        canvas.area("lane", &Area { top: track.floor(), ..*plot });
        canvas.text("soft", [plot.left - GAP, zero + 5.0], Anchor::End, "0");
        let (left, right, y) = (plot.left - 6.0, plot.left + 6.0, track.floor());
        canvas.line("base", [left, y + 1.0], [right, y - 5.0]);
        canvas.line("base", [left, y + 6.0], [right, y]);
    }
    for (y, text) in apart(domain.ticks(VERTICAL_TICKS), track, |_| LINE) {
        canvas.line("grid", [plot.left, y], [plot.right, y]);
        canvas.text("soft", [plot.left - GAP, y + 5.0], Anchor::End, &text);
    }
}

/// Draws a horizontal axis below the plot, with grid lines.
pub(super) fn draw_horizontal(canvas: &mut Canvas, track: &Track, domain: &Domain, plot: &Area) {
    if let Some(zero) = track.zero() {
        canvas.area("lane", &Area { right: track.floor(), ..*plot });
        canvas.text("soft", [zero, plot.bottom + LINE], Anchor::Middle, "0");
        let (x, y) = (track.floor(), plot.bottom);
        canvas.line("base", [x - 5.0, y + 6.0], [x + 1.0, y - 6.0]);
        canvas.line("base", [x, y + 6.0], [x + 6.0, y - 6.0]);
    }
    for x in domain.subdivisions().into_iter().filter_map(|value| track.at(value)) {
        canvas.line("base", [x, plot.bottom], [x, plot.bottom + MINOR]);
    }
    for (x, text) in apart(domain.ticks(HORIZONTAL_TICKS), track, |text| width(text) + 2.0 * GAP) {
        canvas.line("grid", [x, plot.top], [x, plot.bottom]);
        let half = width(&text) * 0.5;
        let x = x.clamp(half, (WIDTH - half).max(half));
        canvas.text("soft", [x, plot.bottom + LINE], Anchor::Middle, &text);
    }
}

/// Writes what an axis measures.
pub(super) fn caption(canvas: &mut Canvas, at: [f64; 2], anchor: Anchor, room: f64, text: &str) {
    canvas.cut_text("soft", at, anchor, &shorten(text, room), text);
}
