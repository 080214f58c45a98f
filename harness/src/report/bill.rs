//! The bill: what each pass costs a strategy in a frame, and what was done once, off the clock.

use super::column::{Better, Column};
use super::comparison::Comparison;
use super::format::{mebibytes, significant};
use super::lead::needs_built_hierarchy;
use super::living;
use super::markup::{Html, html};
use super::metrics::{Measured, Metric, table};
use super::table::{Look, Table};
use crate::grouping::distinct;
use crate::results::{PassKind, Record};

/// Time in which the hierarchy that a method reads was built, before the first frame, ms; `None` for a method
/// that needs none, and for one whose hierarchy is made in every frame.
pub(crate) fn build_ms(record: &Record) -> Option<f64> {
    record.times.light_build_ms.filter(|_| needs_built_hierarchy(record))
}

/// Follows the name of a method whose hierarchy was built beforehand: `build 9.70 ms, off the clock`.
pub(crate) fn build_note(record: &Record) -> Html {
    build_ms(record).map_or_else(Html::default, |ms| {
        html!(" <small>build {} ms, off the clock</small>", significant(ms))
    })
}

/// The passes that some of these records pay for to assign lights, in the order in which they run.
pub(crate) fn assign_passes<'a>(records: impl IntoIterator<Item = &'a Record>) -> Vec<&'a str> {
    let of_record = |record: &'a Record| {
        let passes = record.times.passes.iter();
        passes.filter(|(_, times)| times.kind == PassKind::Assign).map(|(name, _)| name)
    };
    let mut names: Vec<&str> = distinct(records.into_iter().flat_map(of_record));
    // Methods that read the plain list lack the passes of lights that move.
    let place = |name: &str| living::PASSES.iter().position(|pass| *pass == name);
    names.sort_by_key(|name| place(name).unwrap_or(living::PASSES.len()));
    names
}

/// The time of a pass in a frame of a record, ms; `None` if it has no such pass.
fn pass_ms(record: &Record, name: &str) -> Option<f64> {
    let ms = record.times.passes.get(name).map(|_| record.time_of(|pass, _| pass == name));
    ms.filter(|ms| ms.is_finite())
}

/// The column of hierarchies that were built beforehand.
pub(crate) fn build_column<'a, T: 'a>(record: fn(&T) -> &Record) -> Column<'a, T> {
    let value = move |row: &T| build_ms(record(row));
    Column::figure("off the clock: build", "ms", Better::Neither, value, significant)
        .id("build_ms")
        .terminal("off-clock")
        .optional()
        .about(
            "Time in which the CPU ordered the lights and built the hierarchy over them, once, before the first \
             frame. No other time contains it, so the row holds only while no light moves.",
        )
}

/// One column per pass that is paid for, with what was uploaded and what was built beforehand.
pub(crate) fn columns<'a, 'r, T: 'a>(
    records: impl IntoIterator<Item = &'r Record>,
    record: fn(&T) -> &Record,
) -> Vec<Column<'a, T>> {
    let uploaded = move |row: &T| record(row).times.upload_bytes.map(|bytes| bytes as f64);
    let mut columns = vec![
        build_column(record),
        Column::figure("uploaded", "MiB", Better::Less, uploaded, mebibytes)
            .id("upload_bytes")
            .terminal("uploaded")
            .optional()
            .about(
                "What the CPU copied to the GPU in the last frame, because it moves the lights.",
            ),
    ];
    let pass = |name: &str| {
        let (head, name) = (name.to_owned(), name.to_owned());
        Column::ms(head.clone(), move |row: &T| pass_ms(record(row), &name)).terminal(head)
    };
    columns.extend(assign_passes(records).into_iter().map(pass));
    // The last two light what is drawn over the opaque surfaces.
    columns.extend(["shade", "fog-light", "blend"].map(|name| pass(name).optional()));
    columns
}

/// The bill of a comparison; `None` if no method assigns lights.
fn bill<'a>(comparison: &'a Comparison<'a>) -> Option<Table<'a, Measured<'a>>> {
    let records: Vec<&Record> = comparison.all().filter(|record| !record.is_control()).collect();
    let assigns = |record: &&Record| record.times.passes.has(Some(PassKind::Assign));
    if !records.iter().any(assigns) {
        return None;
    }
    let columns: Vec<Metric<'a>> = columns(records.iter().copied(), |row| row.record);
    Some(table("strategy", comparison, records.into_iter(), columns))
}

/// The bill for a page, under its heading; empty if no method assigns lights.
pub(crate) fn bill_html(label: &str, comparison: &Comparison<'_>) -> Html {
    let Some(table) = bill(comparison) else { return Html::default() };
    let table = table.dotted(|row| row.record.strategy.class()).html(label, Look::Plain);
    html!("<h3>What each pass costs</h3>\n{}", table)
}

/// The bill for the terminal, after an empty line; empty if no method assigns lights.
pub(crate) fn bill_text(comparison: &Comparison<'_>) -> String {
    bill(comparison).map_or_else(String::new, |table| format!("\n{}", table.text()))
}
