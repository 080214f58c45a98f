//! Legends: samples of marks with their names, in rows.

use super::canvas::{Anchor, Canvas, LINE, WIDTH};
use super::marks::{RADIUS, shape};
use super::model::Marks;
use super::text::{shorten, width};

/// What a legend explains.
pub(super) struct Entry<'a> {
    pub(super) name: &'a str,
    pub(super) class: &'a str,
    pub(super) sample: Sample,
}

/// What stands before a name.
#[derive(Clone, Copy)]
pub(super) enum Sample {
    /// The marks of a series with its shape.
    Series(Marks, usize),
    /// A filled square.
    Fill,
    /// A dot, as on logarithmic bars.
    Dot,
}

/// Draws a legend from `top` down. Returns where it ends.
pub(super) fn draw(canvas: &mut Canvas, entries: &[Entry<'_>], top: f64) -> f64 {
    const ROOM: f64 = 230.0;
    let wide = entries
        .iter()
        .any(|entry| matches!(entry.sample, Sample::Series(marks, _) if marks.has_line()));
    let sample = if wide { 26.0 } else { 12.0 };
    let (mut x, mut y) = (0.0, top);
    for entry in entries {
        let text = shorten(entry.name, ROOM);
        let size = sample + 6.0 + width(&text) + 13.0;
        if x > 0.0 && x + size - 13.0 > WIDTH {
            (x, y) = (0.0, y + LINE);
        }
        let middle = y + LINE * 0.5;
        canvas.open(&format!("tint {}", entry.class), "", "");
        draw_sample(canvas, entry.sample, [x, middle], sample);
        canvas.close();
        let at = [x + sample + 6.0, middle + 5.0];
        canvas.cut_text("", at, Anchor::Start, &text, entry.name);
        x += size;
    }
    if entries.is_empty() { top } else { y + LINE }
}

fn draw_sample(canvas: &mut Canvas, sample: Sample, [x, y]: [f64; 2], size: f64) {
    let middle = [x + size * 0.5, y];
    match sample {
        Sample::Fill => canvas.path("fill", &shape(1, middle, 6.2)),
        Sample::Dot => canvas.path("fill", &shape(0, middle, 5.5)),
        Sample::Series(marks, index) => {
            let class = match marks {
                Marks::Points => None,
                Marks::Dashed => Some("run dashed"),
                Marks::Steps => Some("run steps"),
                Marks::Line | Marks::LineAndPoints => Some("run"),
            };
            if let Some(class) = class {
                canvas.line(class, [x, y], [x + size, y]);
            }
            if marks.has_shapes() {
                canvas.path("shape", &shape(index, middle, RADIUS));
            }
        }
    }
}
