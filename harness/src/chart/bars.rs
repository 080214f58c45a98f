//! Bars of stacked segments. On a logarithmic axis lengths do not add up, so a bar becomes a dot per segment
//! and a mark at the sum.

use super::axis;
use super::canvas::{Anchor, Canvas, LINE, Target, WIDTH};
use super::domain::{Domain, Track};
use super::legend::{self, Entry, Sample};
use super::marks::shape;
use super::model::{Axis, Scale};
use super::number::significant;
use super::occupancy::Area;
use super::text::{bold_width, count_of, shorten_bold, width};

/// A part of a bar.
#[derive(Clone, Debug, Default)]
pub struct Segment {
    /// What it stands for: a pass.
    pub name: String,
    /// The class that gives `--colour`: `pass-shade-0`.
    pub class: String,
    /// Its length, in the unit of the axis.
    pub value: f64,
}

/// A bar.
#[derive(Clone, Debug, Default)]
pub struct BarRow {
    /// What it stands for: a strategy.
    pub name: String,
    /// The class of the dot before the name; empty draws none.
    pub class: String,
    /// Its parts, from left to right.
    pub segments: Vec<Segment>,
    /// The text at its end.
    pub value_text: String,
    /// The text of the hover tip of the row; may be empty.
    pub tip: String,
}

/// Horizontal bars, one per row.
#[derive(Clone, Debug, Default)]
pub struct BarChart {
    /// What the chart shows, in a few words.
    pub title: String,
    /// What the bars measure. Both linear scales start at zero here.
    pub axis: Axis,
    /// The bars, from top to bottom.
    pub rows: Vec<BarRow>,
    /// A remark below the chart; may be empty.
    pub note: String,
}

const ROW: f64 = 34.0;
const BAR: f64 = 22.0;
const NAMES: f64 = 215.0;
const VALUES: f64 = 110.0;
/// From the start of a segment to its label.
const LABEL_MARGIN: f64 = 5.0;

impl Segment {
    fn shown(&self) -> bool {
        self.value.is_finite() && self.value >= 0.0
    }
}

impl BarRow {
    fn parts(&self) -> impl Iterator<Item = &Segment> {
        self.segments.iter().filter(|segment| segment.shown())
    }

    fn total(&self) -> f64 {
        self.parts().map(|segment| segment.value).sum()
    }
}

impl BarChart {
    /// A fragment for a page that has [`CHART_CSS`](super::CHART_CSS) and its variables.
    pub fn to_svg(&self) -> String {
        self.render(Target::Page)
    }

    /// A file of its own, light or dark as its reader prefers.
    pub fn to_svg_file(&self) -> String {
        self.render(Target::File)
    }

    fn logarithmic(&self) -> bool {
        self.axis.scale == Scale::Log
    }

    fn domain(&self) -> Domain {
        let totals = self.rows.iter().map(BarRow::total);
        if self.logarithmic() {
            let parts = self.rows.iter().flat_map(BarRow::parts).map(|segment| segment.value);
            let values = totals.chain(parts).filter(|&value| value > 0.0);
            Domain::spanning(Scale::Log, values, std::iter::empty())
        } else {
            Domain::from_zero(totals)
        }
    }

    /// The segments, in the order of the bar with the most segments.
    fn legend(&self) -> Vec<Entry<'_>> {
        let sample = if self.logarithmic() { Sample::Dot } else { Sample::Fill };
        let mut entries: Vec<Entry<'_>> = Vec::new();
        let mut fullest: Vec<&BarRow> = self.rows.iter().collect();
        fullest.sort_by_key(|row| std::cmp::Reverse(row.segments.len()));
        for segment in fullest.into_iter().flat_map(|row| &row.segments) {
            let known = entries.iter().any(|e| e.name == segment.name && e.class == segment.class);
            if !known && !segment.name.is_empty() {
                entries.push(Entry { name: &segment.name, class: &segment.class, sample });
            }
        }
        entries
    }

    fn render(&self, target: Target) -> String {
        let mut canvas = Canvas::new(target);
        let domain = self.domain();
        let entries = self.legend();
        let top = match legend::draw(&mut canvas, &entries, 0.0) {
            0.0 => 4.0,
            end => end + 8.0,
        };
        let widest = |texts: &mut dyn Iterator<Item = &String>, most: f64| {
            texts.map(|text| bold_width(text)).fold(0.0, f64::max).min(most)
        };
        let names = widest(&mut self.rows.iter().map(|row| &row.name), NAMES);
        let values = widest(&mut self.rows.iter().map(|row| &row.value_text), VALUES);
        let plot = Area {
            left: names + 30.0,
            top,
            right: WIDTH - values - 16.0,
            bottom: top + ROW * self.rows.len().max(1) as f64,
        };
        let track = Track::new(domain, plot.left, plot.right);
        axis::draw_horizontal(&mut canvas, &track, &domain, &plot);
        if !self.logarithmic() {
            canvas.line("base", [plot.left, plot.top], [plot.left, plot.bottom]);
        }
        for (row, ix) in self.rows.iter().zip(0_u32..) {
            let area = Area {
                left: 0.0,
                top: plot.top + ROW * f64::from(ix),
                right: WIDTH,
                bottom: plot.top + ROW * f64::from(ix + 1),
            };
            self.draw_row(&mut canvas, row, &track, &area);
        }
        let mut end = plot.bottom + LINE + 6.0;
        let caption = self.axis.caption();
        if !caption.is_empty() {
            end += LINE;
            let at = [plot.right, end - 6.0];
            axis::caption(&mut canvas, at, Anchor::End, WIDTH * 0.7, &caption);
        }
        let segments = || self.rows.iter().flat_map(|row| &row.segments);
        let mut notes = vec![self.note.clone()];
        match segments().filter(|segment| !segment.shown()).count() {
            0 => {}
            count => notes.push(format!("{} not finite or below zero.", count_of(count, "part"))),
        }
        let end = canvas.notes(&notes, end + 4.0);
        canvas.finish(&self.title, end + 4.0)
    }

    fn draw_row(&self, canvas: &mut Canvas, row: &BarRow, track: &Track, area: &Area) {
        let middle = (area.top + area.bottom) * 0.5;
        canvas.open("row", &row.tip, "");
        canvas.area("hit", area);
        if !row.class.is_empty() {
            canvas.open(&format!("tint {}", row.class), "", "");
            canvas.path("fill", &shape(1, [9.0, middle], 5.5));
            canvas.close();
        }
        let name = shorten_bold(&row.name, NAMES);
        canvas.cut_text("strong", [21.0, middle + 5.0], Anchor::Start, &name, &row.name);
        let end = if self.logarithmic() {
            self.draw_dots(canvas, row, track, middle)
        } else {
            self.draw_stack(canvas, row, track, middle)
        };
        if !row.value_text.is_empty() {
            let text = shorten_bold(&row.value_text, VALUES);
            let at = [end + 9.0, middle + 5.0];
            canvas.cut_text("strong halo", at, Anchor::Start, &text, &row.value_text);
        }
        canvas.close();
    }

    fn open_segment(&self, canvas: &mut Canvas, row: &BarRow, segment: &Segment) {
        let value = format!("{} {}", significant(segment.value), self.axis.unit);
        let mut tip = if row.tip.is_empty() { row.name.clone() } else { row.tip.clone() };
        if !segment.name.is_empty() {
            tip = format!("{tip}\n{}: {}", segment.name, value.trim());
        }
        canvas.open(&format!("tint {}", segment.class), tip.trim(), "");
    }

    fn draw_stack(&self, canvas: &mut Canvas, row: &BarRow, track: &Track, middle: f64) -> f64 {
        let mut sum = 0.0;
        let mut end = track.within(0.0);
        for segment in row.parts() {
            sum += segment.value;
            let left = end;
            end = track.within(sum);
            if end > left {
                let (top, bottom) = (middle - BAR * 0.5, middle + BAR * 0.5);
                self.open_segment(canvas, row, segment);
                canvas.area("fill", &Area { left, top, right: end, bottom });
                if width(&segment.name) + 2.0 * LABEL_MARGIN < end - left {
                    let at = [left + LABEL_MARGIN, middle + 5.0];
                    canvas.page_text("label", at, Anchor::Start, &segment.name);
                }
                if end - left > 3.0 {
                    canvas.line("edge", [end, top], [end, bottom]);
                }
                canvas.close();
            }
        }
        end
    }

    fn draw_dots(&self, canvas: &mut Canvas, row: &BarRow, track: &Track, middle: f64) -> f64 {
        let parts: Vec<&Segment> = row.parts().filter(|segment| segment.value > 0.0).collect();
        let total = row.total();
        if parts.is_empty() || !total.is_finite() {
            return track.floor();
        }
        let end = track.within(total);
        let start = parts.iter().map(|part| track.within(part.value)).fold(end, f64::min);
        canvas.line("span", [start, middle], [end, middle]);
        for part in parts {
            self.open_segment(canvas, row, part);
            canvas.circle("shape", [track.within(part.value), middle], 6.5);
            canvas.close();
        }
        let half = BAR * 0.5;
        let (top, bottom) = (middle - half, middle + half);
        canvas.area("mark", &Area { left: end - 1.5, top, right: end + 1.5, bottom });
        end
    }
}
