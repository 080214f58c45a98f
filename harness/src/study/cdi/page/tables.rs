//! Compound deep images: the paper's three tables with ours, memory, and ranges against exact rays.

use super::builds::{self, cast_chart};
use super::light::indirect;
use super::ranges;
use crate::report::column::{Better, Column};
use crate::report::format::{ABSENT, mebibytes, number, significant};
use crate::report::markup::Html;
use crate::report::table::{Look, Row, Table};
use crate::results::{DeepImageRun, PassKind, Record, median};
use crate::study::cdi::jobs;
use crate::study::cdi::times::{PAPER, runs, shown, timed_casts};
use crate::study::cdi::verdicts::{in_common, quietest, rays_against_random};
use crate::study::data::{Entry, entries};
use crate::study::manifest::Done;
use crate::study::page::figure::{Charts, table, unit};
use crate::study::page::part::Part;
use crate::study::page::shots::Shots;

/// All parts of a scene.
pub(crate) fn parts(
    done: &Done,
    scene: &str,
    charts: &mut Charts,
    shots: &mut Shots<'_>,
) -> Vec<Part> {
    let mut parts = indirect(done, scene, charts, shots);
    parts.extend(steps(done, scene));
    parts.extend(builds::builds(done, scene, charts));
    parts.extend(casts(done, scene, charts));
    parts.extend(ranges::ranges(done, scene, charts));
    parts.extend(strategies(done, scene));
    parts
}

/// A step: its name, whether a pass belongs to it, and the paper's times in its atrium and its town.
type Step = (&'static str, fn(&str) -> bool, [f64; 2]);

/// The paper's table 1, by our passes.
const STEPS: [Step; 6] = [
    (
        "capture deep images",
        |pass| pass.starts_with("cdi-") && !["cdi-sort", "cdi-ranges"].contains(&pass),
        [3.5, 18.8],
    ),
    ("sort deep images", |pass| pass == "cdi-sort", [2.0, 3.3]),
    ("render RSM", |pass| pass.starts_with("rsm-"), [0.5, 5.9]),
    ("build VPL buffer, without rays", |pass| pass.starts_with("vpl-"), [f64::NAN; 2]),
    ("cast rays", |pass| pass.ends_with("ranges"), [f64::NAN; 2]),
    (
        "build VPL buffer, rays and all",
        |pass| pass.starts_with("vpl-") || pass.ends_with("ranges"),
        [0.15, 0.4],
    ),
];

/// The paper's table 1 with our times.
fn steps(done: &Done, scene: &str) -> Option<Part> {
    let all = entries(done, scene, jobs::STEPS);
    let record = all.first()?.record;
    let vpls = record.indirect.as_ref()?;
    let row = |name: &str, ms: f64, paper: [f64; 2]| Row::new(name, (ms, paper));
    let mut rows: Vec<Row<(f64, [f64; 2])>> = STEPS
        .iter()
        .map(|(name, is_own, paper)| {
            let own = vpls.passes.iter().filter(|(pass, _)| is_own(pass));
            row(name, own.map(|(_, times)| times.median_ms).sum(), *paper)
        })
        .collect();
    let scene_ms = record.times.passes.median_ms(Some(PassKind::Scene));
    rows.insert(2, row("render G-buffer", scene_ms, [1.3, 8.0]));
    rows.push(row("build light grid", record.times.assign_ms, [0.7, 0.5]));
    rows.push(row("apply lighting", record.times.shade_ms, [12.0, 6.1]));
    let total = vpls.total_ms() + scene_ms + record.assign_and_shade_ms();
    rows.push(row("total", total, [20.6, 43.5]));
    let paper = |head, scene: usize| {
        let ms =
            move |step: &(f64, [f64; 2])| step.1.get(scene).copied().filter(|ms| ms.is_finite());
        Column::figure(head, "ms", Better::Less, ms, significant)
    };
    let columns = [
        Column::figure(
            "here",
            "ms",
            Better::Less,
            |step: &(f64, [f64; 2])| Some(step.0),
            significant,
        ),
        paper("paper, Atrium", 0),
        paper("paper, Rungholt", 1),
    ];
    let text = format!(
        "{} at {} x {}: {} virtual point lights from a reflective shadow map of {} x {}, listed by \
         {}. The paper\u{2019}s figures: {PAPER}, 1920 x 1080, 2,000 and 8,000 lights after \
         discarding. A data-centre GPU draws fragments on a few of its processors, so rasterised \
         passes are unusually slow there.",
        record.setting.scene,
        record.setting.width,
        record.setting.height,
        number(vpls.kept as f64),
        vpls.rsm_px,
        vpls.rsm_px,
        record.strategy
    );
    let table = Table::new("step", columns, rows).competing(|_| false);
    let table = table.html("Time of each step", Look::Plain);
    Some(Part::new("steps", "Time of each step", text, table))
}

/// The paper's table 3: sides of the shadow map, and its times in its atrium, its town, and of random
/// ranges.
const PAPER_CASTS: [(u32, [f64; 3]); 4] = [
    (256, [0.5, 0.6, 0.04]),
    (512, [1.8, 2.1, 0.14]),
    (1024, [6.0, 6.9, 0.5]),
    (2048, [20.2, 23.5, 2.1]),
];

/// The paper's table 3 with ours.
fn casts(done: &Done, scene: &str, charts: &mut Charts) -> Option<Part> {
    let all = runs(done, scene, jobs::CASTS);
    let of = |build: fn(&DeepImageRun) -> bool| all.iter().copied().find(|run| build(run));
    let run = of(|run| run.deep.build != "linked-lists")?;
    let linked = of(|run| run.deep.build == "linked-lists");
    let counted = timed_casts(done, scene, run);
    let of_lists = linked.map(|run| timed_casts(done, scene, run)).unwrap_or_default();
    let mut rows = Vec::new();
    for cast in &run.casts {
        let counts = counted.iter().any(|known| std::ptr::eq(*known, cast));
        let (ms, random) = (median(&cast.cast_ms), median(&cast.random_ms));
        let list = linked.and_then(|run| {
            run.casts
                .iter()
                .find(|other| (other.rsm_px, other.is_middle) == (cast.rsm_px, cast.is_middle))
        });
        let is_paper = |side: u32| side == cast.rsm_px && !cast.is_middle;
        let paper = PAPER_CASTS.iter().find(|(side, _)| is_paper(*side));
        let theirs = |ix: usize| paper.map_or(ABSENT.to_owned(), |(_, ms)| significant(ms[ix]));
        let rays = cast.lights as f64 * f64::from(cast.rays);
        let row: Vec<Html> = vec![
            format!("{0} x {0}{1}", cast.rsm_px, if cast.is_middle { ", the middle" } else { "" })
                .into(),
            number(rays).into(),
            shown(ms, counts),
            shown(rays / ms / 1e6, counts),
            match cast.corrected_ms.is_empty() {
                true => ABSENT.into(),
                false => shown(median(&cast.corrected_ms), counts),
            },
            list.map_or_else(
                || ABSENT.into(),
                |list| {
                    let counts = of_lists.iter().any(|known| std::ptr::eq(*known, list));
                    shown(median(&list.cast_ms), counts)
                },
            ),
            shown(random, counts),
            theirs(0).into(),
            theirs(1).into(),
            theirs(2).into(),
        ];
        rows.push(row);
    }
    if rows.is_empty() {
        return None;
    }
    let heads = [
        "shadow map".into(),
        "rays".into(),
        unit("cast", "ms"),
        unit("rate", "10\u{2079} rays/s"),
        unit("corrected", "ms"),
        unit("through linked lists", "ms"),
        unit("random", "ms"),
        unit("paper, Atrium", "ms"),
        unit("paper, Rungholt", "ms"),
        unit("paper, random", "ms"),
    ];
    let drawn = cast_chart(&counted, &of_lists);
    let chart = charts.xy(&format!("{scene}-casts"), &drawn);
    Some(Part::new(
        "casts",
        "Rays from every pixel of the shadow map",
        format!(
            "Every pixel that shows a surface becomes a virtual point light; none is discarded. In \
             a map of the scene\u{2019}s middle nearly every pixel does, and rays lie closer \
             together. Each light casts {} rays through {} directions of {} x {} pixels. \
             Struck-out times were taken while the GPU clock was still rising. The paper\u{2019}s \
             figures: {PAPER}.",
            run.casts.first().map_or(0, |cast| cast.rays),
            run.deep.directions(),
            run.deep.size_px,
            run.deep.size_px
        ),
        chart + table("Rays from every pixel of the shadow map", &heads, &rows),
    ))
}

/// Every strategy under the same virtual point lights.
fn strategies<'a>(done: &'a Done, scene: &'a str) -> Option<Part> {
    let all = entries(done, scene, jobs::STRATEGIES);
    let first = all.first()?;
    let ms = |head, time: fn(&Record) -> f64| {
        let value = move |record: &&Record| Some(time(record));
        Column::figure(head, "ms", Better::Less, value, significant)
    };
    let differing = |record: &&Record| Some(record.image.differing_channels? as f64);
    let bytes = |record: &&Record| Some(record.lists.list_bytes as f64);
    let columns = [
        ms("assign + shade", Record::assign_and_shade_ms),
        ms("assign", |record| record.times.assign_ms),
        ms("shade", |record| record.times.shade_ms),
        Column::figure("differing channels", "", Better::Zero, differing, number),
        Column::figure("lists", "MiB", Better::Less, bytes, mebibytes),
    ];
    let text = format!(
        "{} virtual point lights at {} x {}, in the order of their map. Strategies take them from \
         the list of all lights, because lights made in this frame have no hierarchy.",
        number(first.record.setting.lights as f64),
        first.record.setting.width,
        first.record.setting.height
    );
    let title = "Strategies under virtual point lights";
    let row = |entry: &Entry<'a>| Row::new(entry.record.strategy.to_string(), entry.record);
    let table = Table::new("strategy", columns, all.iter().map(row).collect())
        .competing(|_| false)
        .dotted(|record| record.strategy.class())
        .html(title, Look::Plain);
    Some(Part::new("vpl-strategies", title, text, table))
}

/// What a scene found, a sentence each.
pub(crate) fn findings(done: &Done, scene: &str) -> Vec<String> {
    let mut found = quietest(done, scene);
    found.extend(builds::findings(done, scene));
    let casts = runs(done, scene, jobs::CASTS);
    let arrays = casts.iter().copied().filter(|run| run.deep.build != "linked-lists");
    let counted = arrays.flat_map(|run| timed_casts(done, scene, run));
    let cast = counted.max_by_key(|cast| cast.lights);
    found.extend(cast.map(|cast| {
        let (ms, rays) = (median(&cast.cast_ms), cast.lights as f64 * f64::from(cast.rays));
        format!("In {scene} {} million rays take {} ms.", significant(rays / 1e6), significant(ms))
    }));
    found.extend(ranges::findings(done, scene));
    found
}

/// What stands above all.
pub(crate) fn headline(done: &Done) -> Option<String> {
    let first = |scene| findings(done, scene).into_iter().next();
    in_common(done)
        .or_else(|| rays_against_random(done))
        .or_else(|| done.scenes().into_iter().find_map(first))
}
