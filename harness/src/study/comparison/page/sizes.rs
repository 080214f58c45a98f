//! Which parameters and which intersection tests are best.

use crate::chart::{Axis, BarChart, BarRow, Scale, Segment};
use crate::report::format::{ABSENT, number, significant};
use crate::report::markup::{Html, html};
use crate::report::metrics::interval;
use crate::report::rank::{first, listed, ranks};
use crate::results::Record;
use crate::study::data::{Entry, entries, stand, tests};
use crate::study::manifest::Done;
use crate::study::page::figure::{Charts, name, panels, table, unit};
use crate::study::page::part::Part;

/// A family with the source of its lights: `SC-E`, `SC-E/bvh`. Sizes of one compete.
fn searched(record: &Record) -> String {
    let family = record.strategy.family();
    if record.strategy.is_bvh() { format!("{family}/bvh") } else { family.to_owned() }
}

/// The records of each family and source, in the order of the jobs.
fn families<'a>(entries: &[Entry<'a>]) -> Vec<(String, Vec<&'a Record>)> {
    let mut all: Vec<(String, Vec<&Record>)> = Vec::new();
    for Entry { record, .. } in entries {
        let name = searched(record);
        match all.iter_mut().find(|(known, _)| *known == name) {
            Some((_, records)) => records.push(record),
            None => all.push((name, vec![record])),
        }
    }
    all
}

/// The parameters of a record, or what it has instead.
fn size(record: &Record) -> &str {
    match record.strategy.size() {
        "" => "whole",
        size => size,
    }
}

/// Group sizes and intersection tests of a scene.
pub(crate) fn sizes(done: &Done, scene: &str, charts: &mut Charts) -> [Part; 2] {
    let searches = entries(done, scene, "sizes");
    let families = families(&searches);
    let mut rows = Vec::new();
    let mut shown = Vec::new();
    for (family, records) in &families {
        let ranked = ranks(records.iter().copied());
        let Some(best) = first(&ranked).first().copied() else { continue };
        let same: Vec<&str> = first(&ranked).iter().skip(1).map(|record| size(record)).collect();
        rows.push(vec![
            name(family),
            size(best).into(),
            Html::from(significant(best.assign_and_shade_ms())) + interval(best),
            if same.is_empty() { ABSENT.into() } else { listed(&same).into() },
            number(records.len() as f64).into(),
            stand(best).into(),
        ]);
        let slug = format!("{scene}-sizes-{family}");
        shown.push((family.clone(), charts.bars(&slug, &bars(family, records))));
    }
    let heads = [
        "family".into(),
        "best size".into(),
        unit("assign + shade", "ms"),
        "ties with it".into(),
        "sizes tried".into(),
        "mean of".into(),
    ];
    let body = if rows.is_empty() {
        Html::default()
    } else {
        table("The best size of each family", &heads, &rows) + panels("Family", &shown)
    };
    let sizes = Part::new(
        "sizes",
        "Group sizes",
        "Sizes of tiles and clusters are in pixels and depth slices. Sizes of grids are numbers of \
         cells along the sides of the grid\u{2019}s box. Sizes of model parts are in metres. Small \
         groups take longer to assign, and large groups take longer to shade. We search a family \
         once with the list of all lights, and some families again with the hierarchy (/bvh).",
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
    let rows = sorted
        .iter()
        .map(|record| BarRow {
            name: size(record).to_owned(),
            class: record.strategy.class(),
            segments: vec![
                Segment {
                    name: "assign".to_owned(),
                    class: "pass-assign-0".to_owned(),
                    value: record.times.assign_ms,
                },
                Segment {
                    name: "shade".to_owned(),
                    class: "pass-shade-0".to_owned(),
                    value: record.times.shade_ms,
                },
            ],
            value_text: format!("{} ms", significant(record.assign_and_shade_ms())),
            tip: format!(
                "{}\nassign {} ms\nshade {} ms",
                record.strategy,
                significant(record.times.assign_ms),
                significant(record.times.shade_ms)
            ),
        })
        .collect();
    BarChart {
        title: format!("{family} by size"),
        axis: Axis {
            label: "Assign + shade".to_owned(),
            unit: "ms".to_owned(),
            scale: Scale::LinearFromZero,
        },
        rows,
        note: String::new(),
    }
}

fn tests_table(done: &Done, scene: &str) -> Html {
    let all = entries(done, scene, "tests");
    let families = families(&all);
    let mut unions: Vec<String> = Vec::new();
    for union in all.iter().filter_map(|entry| tests(entry.record)) {
        if !unions.contains(&union) {
            unions.push(union);
        }
    }
    let best: Vec<Vec<&Record>> =
        families.iter().map(|(_, records)| first(&ranks(records.iter().copied()))).collect();
    let rows: Vec<Vec<Html>> = unions
        .iter()
        .map(|union| {
            let cell = |((_, records), best): (&(String, Vec<&Record>), &Vec<&Record>)| {
                let found =
                    records.iter().find(|record| tests(record).as_deref() == Some(union.as_str()));
                found.map_or_else(
                    || ABSENT.into(),
                    |record| {
                        let time = significant(record.assign_and_shade_ms());
                        let is_best = best.iter().any(|best| std::ptr::eq(*best, *record));
                        if is_best { html!("<b class=\"best\">{}</b>", time) } else { time.into() }
                    },
                )
            };
            let name = Html::from(union.to_uppercase());
            std::iter::once(name).chain(families.iter().zip(&best).map(cell)).collect()
        })
        .collect();
    if rows.is_empty() {
        return Html::default();
    }
    let names = families.iter().map(|(family, _)| name(family));
    let heads: Vec<Html> = std::iter::once("tests".into()).chain(names).collect();
    table("Times by intersection tests", &heads, &rows)
}

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
        let factor = |id: &str| -> Option<(f64, f64)> {
            let (mut logs, mut worst, mut count) = (0.0, 0.0_f64, 0.0);
            for entries in &complete {
                let own = || {
                    entries
                        .iter()
                        .map(|entry| entry.record)
                        .filter(|record| searched(record) == family)
                };
                // A heavy scene searches fewer families.
                if own().next().is_none() {
                    continue;
                }
                let best = own().map(Record::assign_and_shade_ms).fold(f64::INFINITY, f64::min);
                let time = own().find(|record| record.strategy == id)?.assign_and_shade_ms();
                logs += (time / best).ln();
                count += 1.0;
                worst = worst.max(time / best);
            }
            let mean = (logs / count).exp();
            mean.is_finite().then_some((mean, worst))
        };
        let mut factors: Vec<(&Record, f64, f64)> = records
            .iter()
            .filter_map(|record| {
                factor(&record.strategy).map(|(mean, worst)| (*record, mean, worst))
            })
            .collect();
        factors.sort_by(|a, b| a.1.total_cmp(&b.1));
        if let Some((record, mean, worst)) = factors.first() {
            rows.push(vec![
                name(&family),
                size(record).into(),
                significant(*mean).into(),
                significant(*worst).into(),
            ]);
        }
    }
    if rows.is_empty() {
        return Html::default();
    }
    let heads = [
        "family".into(),
        "size".into(),
        unit("geometric mean over the best", "\u{d7}"),
        unit("worst scene", "\u{d7}"),
    ];
    html!(
        "<section aria-labelledby=\"overall\"><h2 id=\"overall\">The size for all scenes</h2>\n<p \
         class=\"note\">We divide the time of each size by the time of the best size in the same \
                       scene. The table shows the size for which the geometric mean of these \
                       ratios over the scenes is least.</p>\n{}</section>\n",
        table("The best size over all scenes", &heads, &rows)
    )
}
