//! The table of all images: maps, errors and times.

use super::charts::name;
use crate::report::column::{Better, Column};
use crate::report::format::{number, significant};
use crate::report::markup::Html;
use crate::report::table::{Look, Row, Table};
use crate::results::{Errors, Record, ShadowSetting};
use crate::study::data::Entry;
use crate::study::manifest::Done;
use crate::study::page::error_columns::error_columns;
use crate::study::shadows::cells::floor;

const MIB: f64 = 1_048_576.0;

/// An image with its errors. P has no record.
struct Line<'a> {
    record: Option<&'a Record>,
    errors: &'a Errors,
}

impl Line<'_> {
    fn shadows(&self) -> Option<&ShadowSetting> {
        self.record?.setting.shadows.as_ref()
    }
}

fn errors_of<'r>(line: &'r Line<'_>) -> &'r Errors {
    line.errors
}

/// One row per image, and one for P; nothing without records.
pub(crate) fn table<'a>(done: &'a Done, scene: &'a str, all: &[Entry<'a>]) -> Html {
    if all.is_empty() {
        return Html::default();
    }
    let row = |entry: &Entry<'a>| {
        let line = Line { record: Some(entry.record), errors: &entry.record.image.truth_errors };
        Row::new(format!("{}{}", name(entry), entry.mark()), line)
    };
    let mut rows: Vec<Row<Line<'a>>> = all.iter().map(row).collect();
    if let Some(errors) = floor(done, scene) {
        rows.push(Row::new("P, exact shares", Line { record: None, errors }));
    }
    let maps = |line: &Line<'_>| Some(f64::from(line.shadows()?.maps));
    let bytes = |line: &Line<'_>| {
        let shadows = line.shadows()?;
        if let Some(deep) = &shadows.deep {
            return Some(deep.bytes as f64 / MIB);
        }
        let [width, height] = shadows.atlas_px.map(f64::from);
        Some(4.0 * width * height / MIB)
    };
    let mut columns = vec![
        Column::figure("all maps or points", "", Better::Neither, maps, number),
        Column::figure("atlas or images", "MiB", Better::Less, bytes, significant),
    ];
    columns.extend(error_columns(errors_of));
    columns.push(Column::ms("draw maps", |line: &Line<'_>| line.shadows()?.draw_ms).id("draw_ms"));
    let shade = |line: &Line<'_>| Some(line.record?.times.shade_ms);
    columns.push(Column::ms("shade", shade).id("shade_ms"));
    Table::new("image", columns, rows)
        .competing(|_| false)
        .html("Shadow maps against the truth", Look::Plain)
}
