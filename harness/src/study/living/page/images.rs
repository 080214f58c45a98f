//! Images of many lights, which are compared with no culling at a small size.

use crate::report::column::{Better, Column};
use crate::report::format::number;
use crate::report::markup::Html;
use crate::report::table::{Look, Row, Table};
use crate::results::{Record, Results};
use crate::study::data::{Line, entries, lines, marked_name};
use crate::study::job::Job;
use crate::study::living::jobs::IMAGES;
use crate::study::manifest::Done;
use crate::study::page::part::Part;

/// The channels in which the images of each job differ from no culling.
pub(crate) fn images<'a>(done: &'a Done, scene: &'a str) -> Part {
    let all = entries(done, scene, IMAGES);
    // A job has each strategy once.
    let column = |(_, results): (&Job, &'a Results)| {
        let records = &results.records;
        let differing = move |(id, _): &Line<'a>| {
            let record = records.iter().find(|record| record.strategy == **id)?;
            Some(record.image.differing_channels? as f64)
        };
        let head = records.first().map_or_else(String::new, head);
        Column::figure(head, "channels", Better::Zero, differing, number)
    };
    let columns: Vec<_> = done.section(scene, IMAGES).map(column).collect();
    let row = |line: Line<'a>| Row::new(marked_name(&all, line.0), line);
    let rows: Vec<Row<Line<'a>>> = lines(&all).into_iter().map(row).collect();
    let body: Html = Table::new("strategy", columns, rows)
        .competing(|_| false)
        .dotted(|(id, _)| id.class())
        .html("Channels that differ from no culling", Look::Plain);
    Part::new(
        "images",
        "Images of many lights",
        "No culling takes half a minute for such a frame at full size. So the timed jobs of a million lights and \
         more compare no images. These jobs draw the same lights at a small size and compare eight frames \
         each, one at every age of the order. 0 channels differ if every image equals that of no culling, bit \
         for bit.",
        body,
    )
}

/// `1,000,000 lights`, with the kinds if there are several.
fn head(record: &Record) -> String {
    let lights = crate::report::finding::lights(record.setting.lights);
    let kinds: Vec<&str> = record.setting.light_kinds.keys().map(String::as_str).collect();
    if kinds.len() > 1 { format!("{lights} ({})", kinds.join(", ")) } else { lights }
}
