//! Points and lines over two axes, laid out and drawn.

use super::axis;
use super::canvas::{Anchor, Canvas, LINE, Target, WIDTH};
use super::direct::{self, Naming};
use super::domain::{Domain, Misfit, Track, check};
use super::legend::{self, Entry, Sample};
use super::marks::{self, Placed, RADIUS};
use super::model::{Marks, Point, Series, XyChart};
use super::occupancy::{Area, Occupancy};
use super::text::count_of;

const HEIGHT: f64 = 300.0;
/// The height of a series' row in the lane of exact zeros.
const ROW: f64 = 17.0;

impl XyChart {
    /// A fragment for a page that has [`CHART_CSS`](super::CHART_CSS) and its variables.
    pub fn to_svg(&self) -> String {
        self.render(Target::Page)
    }

    /// A file of its own, light or dark as its reader prefers.
    pub fn to_svg_file(&self) -> String {
        self.render(Target::File)
    }

    fn misfit(&self, point: &Point) -> Option<Misfit> {
        let misfits = [check(self.x.scale, point.x), check(self.y.scale, point.y)].map(Result::err);
        let not_finite = misfits.contains(&Some(Misfit::NotFinite)).then_some(Misfit::NotFinite);
        not_finite.or(misfits.into_iter().flatten().next())
    }

    fn points(&self) -> impl Iterator<Item = &Point> {
        self.series.iter().flat_map(|series| &series.points)
    }

    fn domains(&self) -> [Domain; 2] {
        let shown = || self.points().filter(|point| self.misfit(point).is_none());
        let ends = |range: Option<[f64; 2]>| range.into_iter().flatten();
        [
            Domain::spanning(
                self.x.scale,
                shown().map(|point| point.x),
                shown().flat_map(|point| ends(point.x_range)),
            ),
            Domain::spanning(
                self.y.scale,
                shown().map(|point| point.y),
                shown().flat_map(|point| ends(point.y_range)),
            ),
        ]
    }

    /// The row of each series in the lane of exact zeros: apart from each other, as all of them
    /// are equal.
    fn rows_in_lane(&self) -> Vec<Option<usize>> {
        // The series that have a row, each with those of its shape and class.
        let mut rows: Vec<&Series> = Vec::new();
        self.series
            .iter()
            .map(|series| {
                let zero = |point: &Point| point.y == 0.0 && self.misfit(point).is_none();
                if series.marks == Marks::Steps || !series.points.iter().any(zero) {
                    return None;
                }
                let same = |known: &&Series| {
                    series.shape.is_some()
                        && (known.shape, &known.class) == (series.shape, &series.class)
                };
                Some(rows.iter().position(same).unwrap_or_else(|| {
                    rows.push(series);
                    rows.len() - 1
                }))
            })
            .collect()
    }

    fn notes(&self) -> Vec<String> {
        let count = |misfit| self.points().filter(|p| self.misfit(p) == Some(misfit)).count();
        let mut notes = vec![self.note.clone()];
        for (misfit, fault) in
            [(Misfit::NotFinite, "not finite"), (Misfit::BelowZero, "below zero")]
        {
            match count(misfit) {
                0 => {}
                count => notes.push(format!("{} {fault}.", count_of(count, "point"))),
            }
        }
        notes
    }

    fn render(&self, target: Target) -> String {
        let mut canvas = Canvas::new(target);
        let [across, up] = self.domains();
        let mut naming = direct::plan(self, &across);
        let in_margin = self
            .series
            .iter()
            .zip(&naming)
            .filter(|(_, naming)| **naming == Naming::Margin)
            .map(|(series, _)| series.name.as_str());
        let top = if self.y.caption().is_empty() { 8.0 } else { 30.0 };
        let in_lane = self.rows_in_lane();
        let rows = in_lane.iter().flatten().map(|row| row + 1).max().unwrap_or(1);
        let lane = if up.has_lane() { ROW * rows as f64 + 12.0 } else { 0.0 };
        let plot = Area {
            left: axis::room_beside(&up),
            top,
            right: WIDTH - direct::margin_room(in_margin),
            bottom: top + HEIGHT + lane,
        };
        let x = Track::new(across, plot.left, plot.right);
        let y = Track::new(up, plot.bottom, plot.top).with_lane(lane);
        let mut y_end = plot.bottom + LINE + 6.0;
        axis::draw_vertical(&mut canvas, &y, &up, &plot);
        axis::draw_horizontal(&mut canvas, &x, &across, &plot);
        canvas.line("base", [plot.left, plot.bottom], [plot.right, plot.bottom]);
        axis::caption(&mut canvas, [0.0, 15.0], Anchor::Start, WIDTH, &self.y.caption());
        let caption = self.x.caption();
        if !caption.is_empty() {
            y_end += LINE;
            let at = [plot.right, y_end - 6.0];
            axis::caption(&mut canvas, at, Anchor::End, plot.width(), &caption);
        }

        let mut shapes = 0..;
        let placed: Vec<Placed<'_>> = self
            .series
            .iter()
            .zip(in_lane)
            .map(|(series, row)| {
                let zero = match row {
                    Some(row) => y.floor() + 6.0 + ROW * (row as f64 + 0.5),
                    None => plot.bottom,
                };
                let shape = match series.shape {
                    Some(shape) => shape,
                    None if series.marks.has_shapes() => shapes.next().unwrap_or(0),
                    None => 0,
                };
                Placed::new(series, shape, [&x, &y], y.zero().map(|_| zero))
            })
            .collect();
        let rank = |placed: &Placed<'_>| match placed.series.marks {
            _ if placed.series.faded => 0,
            Marks::Steps => 2,
            _ => 1,
        };
        let mut order: Vec<&Placed<'_>> = placed.iter().collect();
        order.sort_by_key(|placed| rank(placed));
        for placed in &order {
            marks::draw(&mut canvas, placed, [&x, &y]);
        }
        if placed.iter().all(|placed| placed.points.is_empty()) {
            let middle = [(plot.left + plot.right) * 0.5, (plot.top + plot.bottom) * 0.5];
            canvas.text("soft", middle, Anchor::Middle, "No points to show");
        }
        name_marks(&mut canvas, &placed, &mut naming, &plot);

        let entries: Vec<Entry<'_>> = placed
            .iter()
            .zip(&naming)
            .filter(|(_, naming)| **naming == Naming::Legend)
            .map(|(placed, _)| Entry {
                name: &placed.series.name,
                class: &placed.series.class,
                sample: Sample::Series(placed.series.marks, placed.shape),
            })
            .collect();
        if !entries.is_empty() {
            y_end = legend::draw(&mut canvas, &entries, y_end + 8.0);
        }
        let y_end = canvas.notes(&self.notes(), y_end + 4.0);
        canvas.finish(&self.title, y_end + 4.0)
    }
}

/// Writes names and labels; a name that finds no room goes to the legend.
fn name_marks(canvas: &mut Canvas, placed: &[Placed<'_>], naming: &mut [Naming], plot: &Area) {
    let mut occupancy = Occupancy::new(*plot);
    for placed in placed {
        for run in &placed.runs {
            let corners = placed.corners(run);
            for (from, to) in corners.iter().zip(corners.iter().skip(1)) {
                occupancy.cross(*from, *to, placed.series.marks == Marks::Steps);
            }
        }
        if placed.series.marks.has_shapes() {
            for (place, _) in &placed.points {
                occupancy.take(&Area::around(*place, RADIUS + 1.0));
            }
        }
    }
    let margin: Vec<&Placed<'_>> = placed
        .iter()
        .zip(&*naming)
        .filter(|(_, naming)| **naming == Naming::Margin)
        .map(|(placed, _)| placed)
        .collect();
    direct::draw_margin(canvas, &margin, plot);
    for (placed, naming) in placed.iter().zip(naming) {
        if *naming == Naming::Plot && !direct::draw_in_plot(canvas, placed, &mut occupancy) {
            *naming = Naming::Legend;
        }
    }
    for placed in placed {
        direct::draw_point_labels(canvas, placed, &mut occupancy);
    }
}
