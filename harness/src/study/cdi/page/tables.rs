//! Compound deep images: the paper's three tables with ours, memory, and ranges against exact rays.

use super::builds::{self, cast_chart};
use super::light::indirect;
use super::ranges;
use crate::report::column::{Better, Column};
use crate::report::format::{ABSENT, mebibytes, number, significant};
use crate::report::table::{Look, Row, Table};
use crate::results::{CastTimes, DeepImageRun, PassKind, Record, median};
use crate::study::cdi::jobs;
use crate::study::cdi::times::{PAPER, runs, shown, timed_casts};
use crate::study::cdi::verdicts::{in_common, quietest, rays_against_random};
use crate::study::data::{Entry, entries};
use crate::study::manifest::Done;
use crate::study::page::figure::Charts;
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
            let passes = vpls.passes.iter().filter(|(pass, _)| is_own(pass));
            row(name, passes.map(|(_, times)| times.median_ms).sum(), *paper)
        })
        .collect();
    let scene_ms = record.times.passes.median_ms(Some(PassKind::Scene));
    rows.insert(2, row("render G-buffer", scene_ms, [1.3, 8.0]));
    rows.push(row("build light grid", record.times.assign_ms, [0.7, 0.5]));
    rows.push(row("apply lighting", record.times.shade_ms, [12.0, 6.1]));
    let total = vpls.total_ms() + scene_ms + record.assign_and_shade_ms();
    rows.push(row("total", total, [20.6, 43.5]));
    let paper = |head, scene: usize| {
        Column::ms(head, move |step: &(f64, [f64; 2])| {
            step.1.get(scene).copied().filter(|ms| ms.is_finite())
        })
    };
    let columns = [
        Column::ms("here", |step: &(f64, [f64; 2])| Some(step.0)),
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
fn casts<'a>(done: &'a Done, scene: &'a str, charts: &mut Charts) -> Option<Part> {
    let all = runs(done, scene, jobs::CASTS);
    let is_linked = |run: &&&DeepImageRun| run.deep.build == "linked-lists";
    let run = all.iter().find(|run| !is_linked(run)).copied()?;
    let linked = all.iter().find(is_linked).copied();
    let counted = timed_casts(done, scene, run);
    let of_lists = linked.map(|run| timed_casts(done, scene, run)).unwrap_or_default();
    let counts = |cast: &CastTimes| counted.iter().any(|known| std::ptr::eq(*known, cast));
    let in_lists = |cast: &CastTimes| {
        let same =
            |other: &&CastTimes| (other.rsm_px, other.is_middle) == (cast.rsm_px, cast.is_middle);
        linked?.casts.iter().find(same)
    };
    let ms = |head, ms: fn(&CastTimes) -> &[f64]| {
        Column::markup(head, "ms", move |cast: &&CastTimes| match ms(cast) {
            [] => ABSENT.into(),
            ms => shown(median(ms), counts(cast)),
        })
    };
    let rays = |cast: &CastTimes| cast.lights as f64 * f64::from(cast.rays);
    let paper = |head, figure: usize| {
        Column::ms(head, move |cast: &&CastTimes| {
            let mut known = PAPER_CASTS.iter().filter(|_| !cast.is_middle);
            Some(known.find(|(side, _)| *side == cast.rsm_px)?.1[figure])
        })
    };
    let columns = [
        Column::figure("rays", "", Better::Neither, |cast: &&CastTimes| Some(rays(cast)), number),
        ms("cast", |cast| &cast.cast_ms),
        Column::markup("rate", "10\u{2079} rays/s", |cast: &&CastTimes| {
            shown(rays(cast) / median(&cast.cast_ms) / 1e6, counts(cast))
        }),
        ms("corrected", |cast| &cast.corrected_ms),
        Column::markup("through linked lists", "ms", |cast: &&CastTimes| match in_lists(cast) {
            Some(list) => {
                let counts = of_lists.iter().any(|known| std::ptr::eq(*known, list));
                shown(median(&list.cast_ms), counts)
            }
            None => ABSENT.into(),
        }),
        ms("random", |cast| &cast.random_ms),
        paper("paper, Atrium", 0),
        paper("paper, Rungholt", 1),
        paper("paper, random", 2),
    ];
    let row = |cast: &'a CastTimes| {
        let middle = if cast.is_middle { ", the middle" } else { "" };
        Row::new(format!("{0} x {0}{middle}", cast.rsm_px), cast)
    };
    let title = "Rays from every pixel of the shadow map";
    let table = Table::new("shadow map", columns, run.casts.iter().map(row).collect())
        .competing(|_| false)
        .html(title, Look::Plain);
    if table.is_empty() {
        return None;
    }
    let drawn = cast_chart(&counted, &of_lists);
    let chart = charts.xy(&format!("{scene}-casts"), &drawn);
    Some(Part::new(
        "casts",
        title,
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
        chart + table,
    ))
}

/// Every strategy under the same virtual point lights.
fn strategies<'a>(done: &'a Done, scene: &'a str) -> Option<Part> {
    let all = entries(done, scene, jobs::STRATEGIES);
    let first = all.first()?;
    let ms = |head, time: fn(&Record) -> f64| {
        Column::ms(head, move |record: &&Record| Some(time(record)))
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
    let row = |entry: &Entry<'a>| {
        Row::new(format!("{}{}", entry.record.strategy, entry.mark()), entry.record)
    };
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
