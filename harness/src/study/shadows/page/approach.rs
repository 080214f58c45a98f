//! The table of one light that the camera approaches: its maps, and what a frame would take if it moved.

use crate::report::column::{Better, Column};
use crate::report::format::{number, significant};
use crate::report::markup::Html;
use crate::report::table::{Look, Row, Table};
use crate::study::data::{Entry, entries};
use crate::study::manifest::Done;
use crate::study::shadows::cells::{adaptive, distance_m, moving_ms};
use crate::study::shadows::jobs::APPROACH;

use super::charts::name;

/// One row per distance and model; nothing without records.
pub(crate) fn table<'a>(done: &'a Done, scene: &'a str) -> Html {
    let all = entries(done, scene, APPROACH);
    if all.is_empty() {
        return Html::default();
    }
    let row = |entry: &Entry<'a>| {
        let distance = distance_m(entry).map(|m| format!("{} m: ", significant(m)));
        Row::new(distance.unwrap_or_default() + &name(entry), *entry)
    };
    let rows: Vec<Row<Entry<'a>>> = all.iter().map(row).collect();
    let maps = |entry: &Entry<'a>| Some(f64::from(entry.record.setting.shadows.as_ref()?.maps));
    let draw_ms = |entry: &Entry<'a>| entry.record.setting.shadows.as_ref()?.draw_ms;
    let frames = |entry: &Entry<'a>| Some(f64::from(adaptive(entry.record)?.frames));
    let columns = vec![
        Column::figure("maps", "", Better::Neither, maps, number),
        Column::figure("frames to settle", "", Better::Less, frames, number),
        Column::ms("test", |entry: &Entry<'a>| adaptive(entry.record)?.banding_ms).id("test_ms"),
        Column::ms("draw maps", draw_ms).id("draw_ms"),
        Column::ms("shade", |entry: &Entry<'a>| Some(entry.record.times.shade_ms)).id("shade_ms"),
        Column::ms("all three", |entry: &Entry<'a>| moving_ms(entry.record)).id("moving_ms"),
    ];
    Table::new("image", columns, rows)
        .competing(|_| false)
        .html("One light that the camera approaches", Look::Plain)
}
