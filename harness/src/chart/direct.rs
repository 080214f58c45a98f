//! Names at the ends of lines, and labels beside points.

use super::canvas::{Anchor, Canvas, LINE, WIDTH};
use super::domain::{Domain, check};
use super::marks::{Placed, RADIUS};
use super::model::{Series, XyChart};
use super::occupancy::{Area, Occupancy};
use super::reduce::Place;
use super::text::{bold_width, shorten, shorten_bold, width};

/// Charts with more lines than this use a legend.
const MOST_LINES: usize = 10;
/// The widest name beside a line.
const ROOM: f64 = 200.0;
/// The widest name in the plot.
const ROOM_IN_PLOT: f64 = 260.0;
/// The height of a label.
const LABEL: f64 = 14.0;
/// A line that ends beyond this share of the width has its name in the margin.
const NEAR_EDGE: f64 = 0.85;
/// How many points of a line are tried as places for its name.
const TRIES: usize = 24;

/// Where a series' name is.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Naming {
    /// In the margin at the right of the plot.
    Margin,
    /// In the plot, where there is room.
    Plot,
    /// In the legend.
    Legend,
    Nowhere,
}

/// Where each series' name should be.
pub(super) fn plan(chart: &XyChart, x: &Domain) -> Vec<Naming> {
    let named_line = |series: &Series| series.marks.has_line() && !series.name.is_empty();
    let near_edge = |series: &Series| {
        let fits = |value: f64| check(chart.x.scale, value).is_ok();
        let last = series.points.iter().map(|point| point.x).filter(|&x| fits(x));
        last.fold(None, |most: Option<f64>, x| Some(most.map_or(x, |most| most.max(x))))
            .is_some_and(|last| x.share(last) >= NEAR_EDGE)
    };
    let lines: Vec<&Series> = chart.series.iter().filter(|series| named_line(series)).collect();
    let at_edge = lines.iter().filter(|series| near_edge(series)).count();
    let margin = at_edge * 2 >= lines.len();
    chart
        .series
        .iter()
        .map(|series| {
            let same_line = || lines.iter().any(|line| line.name == series.name);
            if series.name.is_empty() || series.points.is_empty() {
                Naming::Nowhere
            } else if !named_line(series) {
                if same_line() && lines.len() <= MOST_LINES {
                    Naming::Nowhere
                } else {
                    Naming::Legend
                }
            } else if lines.len() > MOST_LINES {
                Naming::Legend
            } else if margin && near_edge(series) {
                Naming::Margin
            } else {
                Naming::Plot
            }
        })
        .collect()
}

/// The room that names in the margin take.
pub(super) fn margin_room<'a>(names: impl Iterator<Item = &'a str>) -> f64 {
    names.map(|name| bold_width(&cut(name)) + 18.0).fold(14.0, f64::max)
}

/// The places closest to the wanted ones that keep the spacing and the limits.
fn spread(wanted: &[f64], spacing: f64, [low, high]: [f64; 2]) -> Vec<f64> {
    let mut blocks: Vec<(f64, usize)> = Vec::new();
    for (ix, place) in wanted.iter().enumerate() {
        let mut block = (place - ix as f64 * spacing, 1);
        while let Some((mean, count)) = blocks.pop_if(|(mean, _)| *mean >= block.0) {
            let all = count + block.1;
            block = ((mean * count as f64 + block.0 * block.1 as f64) / all as f64, all);
        }
        blocks.push(block);
    }
    let last = (high - wanted.len().saturating_sub(1) as f64 * spacing).max(low);
    let places = blocks.into_iter().flat_map(|(mean, count)| std::iter::repeat_n(mean, count));
    places.enumerate().map(|(ix, place)| place.clamp(low, last) + ix as f64 * spacing).collect()
}

/// Writes names in the margin, each joined to the end of its line.
pub(super) fn draw_margin(canvas: &mut Canvas, lines: &[&Placed<'_>], plot: &Area) {
    let mut ends: Vec<(Place, &Placed<'_>)> =
        lines.iter().filter_map(|line| Some((line.rightmost()?, *line))).collect();
    ends.sort_by(|a, b| a.0[1].total_cmp(&b.0[1]));
    let wanted: Vec<f64> = ends.iter().map(|(end, _)| end[1]).collect();
    let spacing = LINE * 0.86;
    let places = spread(&wanted, spacing, [plot.top + 2.0, plot.bottom - 2.0]);
    for ((end, line), y) in ends.iter().zip(places) {
        let left = plot.right + 14.0;
        canvas.open(&line.name_tint(), "", "");
        if (end[1] - y).abs() > 3.0 || left - end[0] > 36.0 {
            let from = [end[0] + RADIUS + 2.0, end[1]];
            let bend = [plot.right.max(from[0]), end[1]];
            if bend[0] > from[0] + 1.0 {
                canvas.line("leader", from, bend);
            }
            canvas.line("leader", bend, [left - 3.0, y]);
        }
        let name = &line.series.name;
        canvas.cut_text(line.name_class(), [left, y + 5.0], Anchor::Start, &cut(name), name);
        canvas.close();
    }
}

fn cut(name: &str) -> String {
    shorten_bold(name, ROOM)
}

/// Writes a line's name beside one of its points. Returns whether there was room.
pub(super) fn draw_in_plot(
    canvas: &mut Canvas,
    line: &Placed<'_>,
    occupancy: &mut Occupancy,
) -> bool {
    let name = &line.series.name;
    let text = shorten_bold(name, ROOM_IN_PLOT);
    let size = [bold_width(&text), LABEL];
    let mut places: Vec<Place> = line.points.iter().map(|(place, _)| *place).collect();
    places.sort_by(|a, b| b[0].total_cmp(&a[0]));
    let stride = places.len().div_ceil(TRIES).max(1);
    let ends = places.first().into_iter().chain(places.last());
    let level = places.windows(2).all(|pair| matches!(pair, [a, b] if a[1] == b[1]));
    let best = ends
        .chain(places.iter().step_by(stride))
        .zip(0_u32..)
        .filter_map(|(place, rank)| {
            let (area, cost) = occupancy.beside(*place, size, level)?;
            Some((area, cost + f64::from(rank) * 0.05))
        })
        .min_by(|a, b| a.1.total_cmp(&b.1));
    let Some((area, _)) = best else { return false };
    occupancy.take(&area);
    canvas.open(&line.name_tint(), "", "");
    let at = [area.left, area.bottom - 2.0];
    canvas.cut_text(line.name_class(), at, Anchor::Start, &text, name);
    canvas.close();
    true
}

/// Writes the labels of points that have room.
pub(super) fn draw_point_labels(
    canvas: &mut Canvas,
    placed: &Placed<'_>,
    occupancy: &mut Occupancy,
) {
    if placed.series.faded {
        return;
    }
    for (place, point) in placed.points.iter().filter(|(_, point)| !point.label.is_empty()) {
        let text = shorten(&point.label, WIDTH * 0.2);
        let size = [width(&text), LABEL];
        if let Some((area, _)) = occupancy.beside(*place, size, false) {
            occupancy.take(&area);
            canvas.open(&placed.name_tint(), "", "");
            canvas.text("hint halo", [area.left, area.bottom - 2.0], Anchor::Start, &text);
            canvas.close();
        }
    }
}

#[cfg(test)]
mod tests {
    use super::spread;

    #[test]
    fn names_spread_around_where_they_belong() {
        assert_eq!(spread(&[50.0, 50.0, 120.0], 20.0, [0.0, 200.0]), [40.0, 60.0, 120.0]);
        assert_eq!(spread(&[198.0, 199.0], 20.0, [0.0, 200.0]), [180.0, 200.0]);
        assert!(spread(&[], 20.0, [0.0, 200.0]).is_empty());
    }
}
