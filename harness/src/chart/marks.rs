//! The marks of a series: shapes, lines, whiskers.

use super::canvas::Canvas;
use super::domain::Track;
use super::model::{Marks, Point, Series};
use super::number::length;
use super::reduce::{Place, by_column};

/// The radius of a point's shape.
pub(super) const RADIUS: f64 = 4.6;
/// The radius within which a point is hit.
const HIT: f64 = 9.0;
/// Lines with more points than this are drawn thinner.
const DENSE: usize = 150;
/// The width of the columns within which a long line has one tip.
const TIP_COLUMN: f64 = 14.0;

/// A series laid out in the plot.
pub(super) struct Placed<'a> {
    pub(super) series: &'a Series,
    /// Which shape its points have.
    pub(super) shape: usize,
    /// Its points that can be shown, in their order.
    pub(super) points: Vec<(Place, &'a Point)>,
    /// Its lines: they break where a point cannot be shown.
    pub(super) runs: Vec<Vec<Place>>,
}

impl<'a> Placed<'a> {
    /// Lays a series out; `zero` is the height of its exact zeros where they have a lane.
    pub(super) fn new(
        series: &'a Series,
        shape: usize,
        [x, y]: [&Track; 2],
        zero: Option<f64>,
    ) -> Self {
        let place = |point: &Point| {
            let height = y.at(point.y)?;
            Some([x.at(point.x)?, zero.filter(|_| point.y == 0.0).unwrap_or(height)])
        };
        let points = series.points.iter().filter_map(|point| Some((place(point)?, point)));
        let runs: Vec<Vec<Place>> = if series.marks.has_line() {
            series
                .points
                .split(|point| place(point).is_none())
                .map(|run| run.iter().filter_map(place).collect::<Vec<Place>>())
                .filter(|run| !run.is_empty())
                .map(|run| by_column(&run))
                .collect()
        } else {
            Vec::new()
        };
        Self { series, shape, points: points.collect(), runs }
    }

    /// The corners of its lines.
    pub(super) fn corners(&self, run: &[Place]) -> Vec<Place> {
        if self.series.marks != Marks::Steps {
            return run.to_vec();
        }
        let mut corners: Vec<Place> = run.first().copied().into_iter().collect();
        for (from, to) in run.iter().zip(run.iter().skip(1)) {
            corners.extend([[to[0], from[1]], *to]);
        }
        corners
    }

    /// The place farthest right.
    pub(super) fn rightmost(&self) -> Option<Place> {
        self.points.iter().map(|(place, _)| *place).max_by(|a, b| a[0].total_cmp(&b[0]))
    }

    /// The classes that give its marks their colour.
    pub(super) fn tint(&self) -> String {
        let faded = if self.series.faded { "faded " } else { "" };
        format!("{faded}tint {}", self.series.class)
    }

    /// The classes that give its name's surroundings their colour.
    pub(super) fn name_tint(&self) -> String {
        format!("tint {}", self.series.class)
    }

    /// The classes of its name: it stays legible where the series is faded.
    pub(super) fn name_class(&self) -> &'static str {
        if self.series.faded { "soft halo" } else { "name halo" }
    }
}

/// The outline of a point's shape: circle, square, diamond, triangle.
pub(super) fn shape(index: usize, [x, y]: Place, radius: f64) -> String {
    let polygon = |corners: &[Place]| {
        let corners: Vec<String> = corners
            .iter()
            .map(|[dx, dy]| format!("{} {}", length(x + dx * radius), length(y + dy * radius)))
            .collect();
        format!("M{}z", corners.join("L"))
    };
    match index % 4 {
        0 => {
            let (left, r, d) = (length(x - radius), length(radius), length(radius * 2.0));
            format!("M{left} {}a{r} {r} 0 1 0 {d} 0a{r} {r} 0 1 0 -{d} 0z", length(y))
        }
        1 => polygon(&[[-0.9, -0.9], [0.9, -0.9], [0.9, 0.9], [-0.9, 0.9]]),
        2 => polygon(&[[0.0, -1.3], [1.3, 0.0], [0.0, 1.3], [-1.3, 0.0]]),
        _ => polygon(&[[0.0, -1.25], [1.2, 0.9], [-1.2, 0.9]]),
    }
}

fn polyline(corners: &[Place]) -> String {
    let mut path = String::with_capacity(corners.len() * 11);
    for (ix, [x, y]) in corners.iter().enumerate() {
        path.push_str(match ix {
            0 => "M",
            1 => "L",
            _ => " ",
        });
        path.push_str(&format!("{} {}", length(*x), length(*y)));
    }
    if corners.len() == 1 {
        path.push_str("h0");
    }
    path
}

/// Draws a series.
pub(super) fn draw(canvas: &mut Canvas, placed: &Placed<'_>, tracks: [&Track; 2]) {
    let marks = placed.series.marks;
    canvas.open(&placed.tint(), "", "");
    draw_lines(canvas, placed);
    for (place, point) in &placed.points {
        draw_whiskers(canvas, *place, point, tracks);
    }
    if marks.has_shapes() {
        for (place, point) in &placed.points {
            draw_point(canvas, Some(placed.shape), *place, point);
        }
    } else if marks != Marks::Steps {
        draw_hits(canvas, placed);
    }
    canvas.close();
}

fn draw_lines(canvas: &mut Canvas, placed: &Placed<'_>) {
    if placed.runs.is_empty() {
        return;
    }
    let lines: String = placed.runs.iter().map(|run| polyline(&placed.corners(run))).collect();
    let class = match placed.series.marks {
        Marks::Dashed => "run dashed",
        Marks::Steps => "run steps",
        _ if placed.points.len() > DENSE => "run dense",
        _ => "run",
    };
    let named = placed.points.iter().all(|(_, point)| point.tip.is_empty());
    if named && !placed.series.name.is_empty() {
        canvas.open("", &placed.series.name, "");
        canvas.path(class, &lines);
        canvas.close();
    } else {
        canvas.path(class, &lines);
    }
}

fn draw_whiskers(canvas: &mut Canvas, [x, y]: Place, point: &Point, tracks: [&Track; 2]) {
    const CAP: f64 = 3.5;
    let [across, up] = tracks;
    let mut lines = String::new();
    let mut add = |from: Place, to: Place| lines.push_str(&polyline(&[from, to]));
    let sound = |range: &[f64; 2]| range.iter().all(|end| !end.is_nan());
    if let Some([low, high]) = point.x_range.filter(sound) {
        let (low, high) = (across.within(low), across.within(high));
        add([low, y], [high, y]);
        add([low, y - CAP], [low, y + CAP]);
        add([high, y - CAP], [high, y + CAP]);
    }
    if let Some([low, high]) = point.y_range.filter(sound) {
        let (low, high) = (up.within(low), up.within(high));
        add([x, low], [x, high]);
        add([x - CAP, low], [x + CAP, low]);
        add([x - CAP, high], [x + CAP, high]);
    }
    if !lines.is_empty() {
        canvas.path("whisker", &lines);
    }
}

fn draw_point(canvas: &mut Canvas, index: Option<usize>, place: Place, point: &Point) {
    let outline = index.map(|index| shape(index, place, RADIUS));
    let reacts = !(point.tip.is_empty() && point.key.is_empty());
    if reacts {
        canvas.open("", &point.tip, &point.key);
    }
    if let Some(outline) = outline {
        canvas.path("shape", &outline);
    }
    if reacts {
        canvas.circle("hit", place, HIT);
        canvas.close();
    }
}

/// Draws the points of a line that have tips: on long lines, the highest of each column.
fn draw_hits(canvas: &mut Canvas, placed: &Placed<'_>) {
    let column = |place: &Place| (place[0] / TIP_COLUMN).floor() as i64;
    let reacting: Vec<_> = placed
        .points
        .iter()
        .filter(|(_, point)| !(point.tip.is_empty() && point.key.is_empty()))
        .collect();
    for column in reacting.chunk_by(|a, b| column(&a.0) == column(&b.0)) {
        let highest = column.iter().min_by(|a, b| a.0[1].total_cmp(&b.0[1]));
        if let Some((place, point)) = highest {
            draw_point(canvas, None, *place, point);
        }
    }
}
