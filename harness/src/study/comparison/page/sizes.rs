//! Which parameters and which intersection tests are best.

use crate::chart::{Axis, BarChart, Scale};
use crate::grouping::{distinct, grouped_by};
use crate::report::column::{Better, Column};
use crate::report::format::{ABSENT, number, significant};
use crate::report::markup::{Html, html};
use crate::report::metrics::interval;
use crate::report::rank::{first, listed, ranks};
use crate::report::table::{Look, Row, Table};
use crate::results::Record;
use crate::study::data::{Entry, entries, mark, stand, tests};
use crate::study::manifest::Done;
use crate::study::page::figure::{Charts, panels, time_bar};
use crate::study::page::part::Part;

/// A family with the source of its lights: `SC-E`, `SC-E/bvh`. Sizes of one compete.
fn searched(record: &Record) -> String {
    let family = record.strategy.family();
    if record.strategy.is_bvh() { format!("{family}/bvh") } else { family.to_owned() }
}

/// The records of each family and source, in the order of the jobs.
fn families<'a>(entries: &[Entry<'a>]) -> Vec<(String, Vec<&'a Record>)> {
    grouped_by(entries.iter().map(|entry| (searched(entry.record), entry.record)))
}

/// The parameters of a record, or what it has instead.
fn size(record: &Record) -> &str {
    match record.strategy.size() {
        "" => "whole",
        size => size,
    }
}

/// A family of a search, with the sizes that lead.
struct Searched<'a> {
    best: &'a Record,
    /// Others that tie with it.
    same: Vec<&'a str>,
    count: usize,
}

/// Group sizes and intersection tests of a scene.
pub(crate) fn sizes(done: &Done, scene: &str, charts: &mut Charts) -> [Part; 2] {
    let searches = entries(done, scene, "sizes");
    let families = families(&searches);
    let mut rows = Vec::new();
    let mut shown = Vec::new();
    for (family, records) in &families {
        let leaders = first(&ranks(records.iter().copied()));
        let Some((&best, others)) = leaders.split_first() else { continue };
        let same = others.iter().map(|record| size(record)).collect();
        let mark = mark(&searches, &best.strategy);
        rows.push(Row::new(
            format!("{family}{mark}"),
            Searched { best, same, count: records.len() },
        ));
        let slug = format!("{scene}-sizes-{family}");
        shown.push((family.clone(), charts.bars(&slug, &bars(family, records))));
    }
    let columns = [
        Column::words("best size", "", |row: &Searched<'_>| size(row.best).to_owned()),
        Column::ms("assign + shade", |row: &Searched<'_>| Some(row.best.assign_and_shade_ms()))
            .note(|row| interval(row.best)),
        Column::words("ties with it", "", |row: &Searched<'_>| match row.same.as_slice() {
            [] => ABSENT.to_owned(),
            same => listed(same),
        }),
        Column::words("sizes tried", "", |row: &Searched<'_>| number(row.count as f64)),
        Column::words("mean of", "", |row: &Searched<'_>| stand(row.best)),
    ];
    let body = Table::new("family", columns, rows)
        .competing(|_| false)
        .dotted(|row| row.best.strategy.class())
        .html("The best size of each family", Look::Plain)
        + panels("Family", &shown);
    let sizes = Part::new(
        "sizes",
        "Group sizes",
        "Sizes of tiles and clusters are in pixels and depth slices. Sizes of grids are numbers of \
         cells along the sides of the grid\u{2019}s box. Sizes of model parts are in metres. Small \
         groups take longer to assign, and large groups take longer to shade. For each family, we \
         look for the best size with the list of all lights. For some families, we look again \
         with the hierarchy (/bvh).",
        body,
    );
    let tests = Part::new(
        "tests",
        "Intersection tests",
        "Each row is a combination of tests that compare a light\u{2019}s bounds with a \
         group\u{2019}s frustum. HS: half-spaces, one per plane of the frustum. SAT: separating \
         axes, along the frustum\u{2019}s edges (SAT-E), towards its nearest corner (SAT-N), along \
         its planes\u{2019} normals (SAT-P) or towards every corner (SAT-V). Figures are assign + \
         shade in ms. The fastest of each family, and all that tie with it, are bold.",
        tests_table(done, scene),
    );
    [sizes, tests]
}

fn bars(family: &str, records: &[&Record]) -> BarChart {
    let mut sorted = records.to_vec();
    sorted.sort_by(|a, b| a.assign_and_shade_ms().total_cmp(&b.assign_and_shade_ms()));
    let bar = |record: &&Record| time_bar(size(record).to_owned(), record.strategy.class(), record);
    BarChart {
        title: format!("{family} by size"),
        axis: Axis::new("Assign + shade", "ms", Scale::LinearFromZero),
        rows: sorted.iter().map(bar).collect(),
        note: String::new(),
    }
}

fn tests_table<'a>(done: &'a Done, scene: &'a str) -> Html {
    let all = entries(done, scene, "tests");
    let families = families(&all);
    let unions = distinct(all.iter().filter_map(|entry| tests(entry.record)));
    let column = |(family, records): (String, Vec<&'a Record>)| {
        let leaders = first(&ranks(records.iter().copied()));
        let class = records.first().map_or_else(String::new, |record| record.strategy.class());
        let find = move |union: &String| {
            records.iter().copied().find(|record| tests(record).as_ref() == Some(union))
        };
        let leads = find.clone();
        let time = move |union: &String| Some(find(union)?.assign_and_shade_ms());
        Column::figure(family, "", Better::Less, time, significant).dotted(class).best(
            move |union| {
                let record = leads(union);
                leaders.iter().any(|leader| record.is_some_and(|r| std::ptr::eq(*leader, r)))
            },
        )
    };
    let columns: Vec<_> = families.into_iter().map(column).collect();
    let rows = unions.into_iter().map(|union| Row::new(union.to_uppercase(), union)).collect();
    Table::new("tests", columns, rows).html("Times by intersection tests", Look::Plain)
}

/// A size with the geometric mean and the greatest of its factors over the best size of each scene.
type Overall<'a> = (&'a Record, f64, f64);

/// The size of each family that is best over all scenes: least geometric mean of its time over that
/// of the best size in the scene.
pub(crate) fn best_overall(done: &Done) -> Html {
    let scenes = done.scenes();
    let per_scene: Vec<Vec<Entry<'_>>> =
        scenes.iter().map(|scene| entries(done, scene, "sizes")).collect();
    let complete: Vec<&Vec<Entry<'_>>> =
        per_scene.iter().filter(|entries| !entries.is_empty()).collect();
    let Some(leading) = complete.first().filter(|_| complete.len() > 1) else {
        return Html::default();
    };
    let mut rows = Vec::new();
    for (family, records) in families(leading) {
        let factor = |record: &'_ Record| -> Option<(f64, f64)> {
            let (mut logs, mut worst, mut count) = (0.0, 0.0_f64, 0.0);
            for entries in &complete {
                let same_family = || {
                    let records = entries.iter().map(|entry| entry.record);
                    records.filter(|record| searched(record) == family)
                };
                // A heavy scene searches fewer families.
                if same_family().next().is_none() {
                    continue;
                }
                let best =
                    same_family().map(Record::assign_and_shade_ms).fold(f64::INFINITY, f64::min);
                let time = same_family()
                    .find(|known| known.strategy == record.strategy)?
                    .assign_and_shade_ms();
                logs += (time / best).ln();
                count += 1.0;
                worst = worst.max(time / best);
            }
            let mean = (logs / count).exp();
            mean.is_finite().then_some((mean, worst))
        };
        let factors = records
            .iter()
            .filter_map(|record| factor(record).map(|(mean, worst)| (*record, mean, worst)));
        if let Some(best) = factors.min_by(|a, b| a.1.total_cmp(&b.1)) {
            rows.push(Row::new(format!("{family}{}", mark(leading, &best.0.strategy)), best));
        }
    }
    let times = |head, value: fn(&Overall<'_>) -> f64| {
        let value = move |row: &Overall<'_>| Some(value(row));
        Column::figure(head, "\u{d7}", Better::Less, value, significant)
    };
    let columns = [
        Column::words("size", "", |row: &Overall<'_>| size(row.0).to_owned()),
        times("geometric mean over the best", |row| row.1),
        times("worst scene", |row| row.2),
    ];
    let table = Table::new("family", columns, rows)
        .competing(|_| false)
        .dotted(|row| row.0.strategy.class())
        .html("The best size over all scenes", Look::Plain);
    if table.is_empty() {
        return table;
    }
    html!(
        "<section aria-labelledby=\"overall\"><h2 id=\"overall\">The size for all scenes</h2>\n<p \
         class=\"note\">We divide the time of each size by the time of the best size in the same \
                       scene. The table shows the size for which the geometric mean of these \
                       ratios over the scenes is least.</p>\n{}</section>\n",
        table
    )
}
