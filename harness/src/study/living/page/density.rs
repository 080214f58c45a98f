//! Van Oosten's density, and the figures of the thesis beside ours.

use crate::report::column::{Better, Column};
use crate::report::format::{number, significant};
use crate::report::living::PASSES;
use crate::report::markup::Html;
use crate::report::table::{Look, Row, Table};
use crate::results::{PassKind, Record};
use crate::study::data::{counts, entries};
use crate::study::living::jobs::DENSITY;
use crate::study::manifest::Done;
use crate::study::page::part::Part;

/// Times of the thesis at a number of lights, ms (Van Oosten 2017, results, Sponza with a hierarchy, at most one
/// light per cubic unit).
#[derive(Clone, Copy, Debug)]
pub(crate) struct Published {
    pub(crate) lights: u64,
    /// Its pass "Sort".
    pub(crate) sort: f64,
    /// Its pass "Build BVH".
    pub(crate) build: f64,
    /// Its pass "Assign Lights".
    pub(crate) assign: f64,
    /// Its passes "Opaque" and "Transparent".
    pub(crate) shade: f64,
    /// All passes, also those that its table leaves out.
    pub(crate) frame: f64,
}

/// The rows with which our jobs share the number of lights.
pub(crate) const PUBLISHED: [Published; 3] = [
    Published {
        lights: 200_000,
        sort: 1.361,
        build: 0.230,
        assign: 0.643,
        shade: 1.721,
        frame: 4.327,
    },
    Published {
        lights: 1_000_000,
        sort: 5.691,
        build: 0.840,
        assign: 0.681,
        shade: 1.649,
        frame: 9.501,
    },
    Published {
        lights: 4_000_000,
        sort: 21.492,
        build: 6.203,
        assign: 0.968,
        shade: 1.673,
        frame: 32.037,
    },
];

/// A row of the table.
#[derive(Clone, Copy)]
enum Entry<'a> {
    Ours(&'a Record),
    Theirs(Published),
}

impl Entry<'_> {
    /// A time: of the passes that are counted here, or of the thesis.
    fn ms(&self, ours: fn(&Record) -> f64, theirs: fn(&Published) -> f64) -> Option<f64> {
        let ms = match self {
            Self::Ours(record) => ours(record),
            Self::Theirs(published) => theirs(published),
        };
        ms.is_finite().then_some(ms)
    }

    fn lights(&self) -> u64 {
        match self {
            Self::Ours(record) => record.setting.lights,
            Self::Theirs(published) => published.lights,
        }
    }
}

fn order(record: &Record) -> f64 {
    record.time_of(|name, _| name == PASSES[1])
}

fn boxes(record: &Record) -> f64 {
    record.time_of(|name, _| name == PASSES[2])
}

/// Bounds and culling: what is left of assigning lights without what moving lights cost.
fn lists(record: &Record) -> f64 {
    record.time_of(|name, kind| kind == PassKind::Assign && !PASSES.contains(&name))
}

/// What sorting and boxing the lights costs, ms.
pub(crate) fn hierarchy_ms(record: &Record) -> f64 {
    order(record) + boxes(record)
}

/// Our rows and those of the thesis, by number of lights.
pub(crate) fn density(done: &Done, scene: &str) -> Part {
    let all = entries(done, scene, DENSITY);
    let mut rows = Vec::new();
    for count in counts(&all) {
        let here = all.iter().filter(|entry| entry.record.setting.lights == count);
        rows.extend(
            here.map(|entry| {
                Row::new(entry.record.strategy.to_string(), Entry::Ours(entry.record))
            }),
        );
        let theirs = PUBLISHED.iter().filter(|published| published.lights == count);
        let name = "Van Oosten 2017, GTX TITAN X";
        rows.extend(theirs.map(|published| Row::new(name, Entry::Theirs(*published))));
    }
    let lights = |row: &Entry<'_>| Some(row.lights() as f64);
    let total = |row: &Entry<'_>| match row {
        Entry::Ours(record) => Some(record.assign_and_shade_ms()),
        Entry::Theirs(p) => Some(p.sort + p.build + p.assign + p.shade),
    };
    let columns = [
        Column::figure("lights", "", Better::Neither, lights, number),
        Column::ms("sort", |row: &Entry<'_>| row.ms(order, |p| p.sort)),
        Column::ms("hierarchy", |row: &Entry<'_>| row.ms(boxes, |p| p.build)),
        Column::ms("lists", |row: &Entry<'_>| row.ms(lists, |p| p.assign)),
        Column::ms("shade", |row: &Entry<'_>| row.ms(|r| r.times.shade_ms, |p| p.shade)),
        Column::figure("sum", "ms", Better::Less, total, significant),
        Column::ms("frame", |row: &Entry<'_>| row.ms(|r| r.times.frame_ms, |p| p.frame)),
    ];
    let class = |row: &Entry<'_>| match row {
        Entry::Ours(record) => record.strategy.class(),
        Entry::Theirs(_) => "strategy-none".to_owned(),
    };
    let body = match rows.is_empty() {
        true => Html::default(),
        false => Table::new("strategy", columns, rows)
            .competing(|_| false)
            .dotted(class)
            .html("One light per cubic metre, beside Van Oosten 2017", Look::Plain),
    };
    Part::new(
        "density",
        "One light per cubic metre",
        "As in the thesis, the camera stands still and the lights are sorted in every frame. Compare proportions \
         and not times: the thesis measured on a GTX TITAN X (2015). Its shading is forward and also draws \
         transparent surfaces; ours is deferred. Its tree has 32 children per node and is walked to the leaves; \
         ours has boxes around 64 lights in up to three levels. Its clusters have implicit bounds. Its lights \
         fill a box that grows beyond a hall of fixed size, so few of them are in view; ours fill a hall that \
         grows with them. The thesis does not state the ranges of its lights; ours have a mean of one metre. Its \
         frame has further passes, such as the Morton codes, which its table leaves out. Our frame has the depth \
         pre-pass and the G-buffer.",
        body,
    )
}
