//! Building deep images: times by directions and by build, and memory.

use crate::chart::{Axis, Scale, XyChart};
use crate::report::column::{Better, Column};
use crate::report::format::{ABSENT, mebibytes, number, significant};
use crate::report::markup::{Html, html};
use crate::report::table::{Look, Row, Table};
use crate::results::{CastTimes, DeepImageRun, DeepImages, PassTimes, median};
use crate::study::cdi::jobs;
use crate::study::cdi::times::{PAPER, refused_build, runs, shown, timed_runs};
use crate::study::manifest::Done;
use crate::study::page::figure::Charts;
use crate::study::page::lines::tipped_line;
use crate::study::page::part::Part;

/// The paper's table 2: directions, and times in its atrium and its town; of 169 from the text.
const PAPER_BUILDS: [(u32, [f64; 2]); 6] = [
    (8, [1.5, 18.0]),
    (16, [1.8, 18.4]),
    (32, [2.0, 18.6]),
    (64, [3.2, 19.7]),
    (128, [4.7, 21.3]),
    (169, [5.5, 22.1]),
];

/// The paper's speed-up of one pass over one pass per direction, at 169 directions: atrium and town.
const PAPER_FACTORS: [f64; 2] = [20.0, 100.0];

/// Whether an image is of the size and sampling that directions and builds are compared at.
fn is_plain(run: &DeepImageRun, first: &DeepImageRun) -> bool {
    run.deep.size_px == first.deep.size_px
        && run.deep.oversampling == 1
        && run.deep.spread == first.deep.spread
}

/// Builds that are charted against the number of directions: id, name, class.
const BUILDS: [(&str, &str, &str); 4] = [
    ("compute", "one pass, compute", "series-0"),
    ("fragment", "one pass, rasterised", "series-1"),
    ("per-direction", "a dispatch per direction", "series-2"),
    ("per-direction-batched", "per direction, one dispatch", "series-5"),
];

/// Times, factors and memory.
pub(crate) fn builds(done: &Done, scene: &str, charts: &mut Charts) -> Option<Part> {
    let all = runs(done, scene, jobs::BUILDS);
    let first = all.first().copied()?;
    let plain: Vec<&DeepImageRun> =
        all.iter().copied().filter(|run| is_plain(run, first)).collect();
    let find = |build: &str, directions: u32| {
        plain
            .iter()
            .copied()
            .find(|run| run.deep.build == build && run.deep.directions() == directions)
    };
    let is_compared = |run: &&&DeepImageRun| BUILDS.iter().any(|(id, ..)| run.deep.build == *id);
    let mut counts: Vec<u32> =
        plain.iter().filter(is_compared).map(|run| run.deep.directions()).collect();
    counts.sort_unstable();
    counts.dedup();
    let counts_as_time = |run: &DeepImageRun| refused_build(done, scene, run).is_none();
    let timed = |run: Option<&DeepImageRun>| {
        run.filter(|run| counts_as_time(run)).map(DeepImageRun::build_ms)
    };
    let compute = BUILDS[0].0;
    let ms = |(build, head, _): (&'static str, &'static str, &str)| {
        Column::markup(head, "ms", move |count: &u32| match find(build, *count) {
            Some(run) => shown(run.build_ms(), counts_as_time(run)),
            None => ABSENT.into(),
        })
    };
    let factor = |build: &'static str| {
        let value = move |count: &u32| {
            let one_pass = timed(find(compute, *count))?;
            Some(timed(find(build, *count))? / one_pass)
        };
        Column::figure("factor", "", Better::More, value, significant)
    };
    let paper = |head, scene: usize| {
        Column::ms(head, move |count: &u32| {
            let (_, ms) = PAPER_BUILDS.iter().find(|(known, _)| known == count)?;
            Some(ms[scene])
        })
    };
    let [one_pass, rasterised, each, batched] = BUILDS;
    let columns = [
        ms(one_pass),
        ms(rasterised),
        ms(each),
        factor(each.0),
        ms(batched),
        factor(batched.0),
        paper("paper, Atrium", 0),
        paper("paper, Rungholt", 1),
    ];
    let rows = counts.iter().map(|count| Row::new(number(f64::from(*count)), *count)).collect();
    let title = "Build time against directions";
    let table =
        Table::new("directions", columns, rows).competing(|_| false).html(title, Look::Plain);
    let steady: Vec<&DeepImageRun> =
        plain.iter().copied().filter(|run| counts_as_time(run)).collect();
    let body = charts.xy(&format!("{scene}-builds"), &build_chart(title, &steady))
        + table
        + passes(find(compute, counts.last().copied().unwrap_or(0)))
        + memory(&all, counts_as_time);
    let text = format!(
        "{} triangles, {1} x {1} pixels per direction. Build times include sampling or drawing, \
         counting, prefix sum, filling and sorting, but not clearing the counters. Brute force \
         visits all triangles for each direction, in one dispatch per direction or in one for \
         all; it shares the prefix sum and the sort. Struck-out times were taken while the GPU \
         clock was low or rising. A data-centre GPU draws fragments on a few of its processors, \
         so rasterised builds are unusually slow there. The paper\u{2019}s figures: {2}.",
        number(first.triangles as f64),
        first.deep.size_px,
        PAPER
    );
    Some(Part::new("builds", "Building deep images", text, body))
}

fn build_chart(title: &str, plain: &[&DeepImageRun]) -> XyChart {
    let series = |(build, name, class): &(&str, &str, &str)| {
        let runs = plain.iter().filter(|run| run.deep.build == *build);
        let mut points: Vec<(f64, f64)> =
            runs.map(|run| (f64::from(run.deep.directions()), run.build_ms())).collect();
        points.sort_by(|a, b| a.0.total_cmp(&b.0));
        tipped_line(name, class, ["directions", "ms"], points.into_iter())
    };
    let axes = [Axis::new("Directions", "", Scale::Log), Axis::new("Build", "ms", Scale::Log)];
    XyChart::new(title, axes, BUILDS.iter().map(series).collect())
}

/// Times of casting rays and of random ranges against the number of lights.
pub(crate) fn cast_chart(arrays: &[&CastTimes], linked: &[&CastTimes]) -> XyChart {
    let line = |casts: &[&CastTimes], name: &str, class: &str, ms: fn(&CastTimes) -> &[f64]| {
        let casts = casts.iter().filter(|cast| !cast.is_middle);
        let points = casts.map(|cast| (cast.lights as f64, median(ms(cast))));
        tipped_line(name, class, ["lights", "ms"], points)
    };
    let series = vec![
        line(arrays, "rays through arrays", "series-0", |cast| &cast.cast_ms),
        line(arrays, "random ranges", "series-3", |cast| &cast.random_ms),
        line(linked, "rays through linked lists", "series-2", |cast| &cast.cast_ms),
    ];
    let lights = Axis::new("Virtual point lights", "", Scale::Log);
    let axes = [lights, Axis::new("Ranges", "ms", Scale::Log)];
    XyChart::new("Time to find the ranges of all lights", axes, series)
}

/// The passes of a build.
fn passes(run: Option<&DeepImageRun>) -> Html {
    let Some(run) = run else { return Html::default() };
    let columns = [
        Column::ms("median", |times: &&PassTimes| Some(times.median_ms)),
        Column::ms("p95", |times: &&PassTimes| Some(times.p95_ms)),
    ];
    let rows = run.passes.iter().map(|(pass, times)| Row::new(pass, times)).collect();
    let title = format!("The passes of {} directions", run.deep.directions());
    let table = Table::new("pass", columns, rows).competing(|_| false);
    html!("<h4>{}</h4>\n", title) + table.html(&title, Look::Plain)
}

/// What deep images are, for the first column of a table.
pub(crate) fn images_name(deep: &DeepImages) -> String {
    format!(
        "{} x {}\u{b2}{}{}, {}",
        deep.directions(),
        deep.size_px,
        if deep.oversampling > 1 { ", oversampled" } else { "" },
        if deep.spread == "squares" { ", squares" } else { "" },
        deep.build
    )
}

/// What every setting takes.
fn memory(all: &[&DeepImageRun], counts_as_time: impl Fn(&DeepImageRun) -> bool) -> Html {
    let figure = |head, unit, value: fn(&DeepImages) -> f64, show| {
        let value = move |run: &&DeepImageRun| Some(value(&run.deep));
        Column::figure(head, unit, Better::Less, value, show)
    };
    let columns = [
        figure("pixel", "m", |deep| deep.footprint_m, significant),
        figure("samples", "", |deep| deep.samples as f64, number),
        figure("fragments", "", |deep| deep.fragments as f64, number),
        figure("longest list", "", |deep| deep.longest_list as f64, number),
        figure("memory", "MiB", |deep| deep.bytes as f64, mebibytes),
        Column::markup("build", "ms", |run: &&DeepImageRun| {
            shown(run.build_ms(), counts_as_time(run))
        }),
    ];
    let rows = all.iter().map(|run| Row::new(images_name(&run.deep), *run)).collect();
    let table = Table::new("deep images", columns, rows).competing(|_| false);
    html!("<h4>Memory</h4>\n") + table.html("Memory of deep images", Look::Plain)
}

/// Times of the builds of most directions that count: the faster of the two single passes, brute force
/// in a dispatch per direction, and brute force in one dispatch. Each is ms.
pub(crate) struct MostDirections {
    pub(crate) directions: u32,
    pub(crate) single_ms: f64,
    pub(crate) each_ms: Option<f64>,
    pub(crate) batched_ms: Option<f64>,
}

/// The builds of most directions, where a single pass was timed at a steady, risen clock.
pub(crate) fn most_directions(done: &Done, scene: &str) -> Option<MostDirections> {
    let first = runs(done, scene, jobs::BUILDS).first().copied()?;
    let all = timed_runs(done, scene, jobs::BUILDS);
    let directions = all.iter().map(|run| run.deep.directions()).max()?;
    let best = |builds: &[&str]| {
        let timed = all.iter().filter(|run| {
            is_plain(run, first)
                && run.deep.directions() == directions
                && builds.contains(&run.deep.build.as_str())
        });
        timed.map(|run| run.build_ms()).filter(|ms| ms.is_finite()).min_by(f64::total_cmp)
    };
    Some(MostDirections {
        directions,
        single_ms: best(&["compute", "fragment"])?,
        each_ms: best(&["per-direction"]),
        batched_ms: best(&["per-direction-batched"]),
    })
}

/// How much one pass over the triangles saves at the most directions.
pub(crate) fn findings(done: &Done, scene: &str) -> Option<String> {
    let most = most_directions(done, scene)?;
    let times = |ms: Option<f64>, what: &str| {
        ms.map(|ms| {
            format!(
                "{} times as fast as {what} ({} ms)",
                significant(ms / most.single_ms),
                significant(ms)
            )
        })
    };
    let each = times(most.each_ms, "brute force in a dispatch per direction");
    let batched = times(most.batched_ms, "brute force in one dispatch");
    let both: Vec<String> = each.into_iter().chain(batched).collect();
    if both.is_empty() {
        return None;
    }
    Some(format!(
        "In {scene}, one pass over the triangles builds {} directions in {} ms. That is {}. The \
         paper reports {} times in its atrium and {} in its town.",
        most.directions,
        significant(most.single_ms),
        both.join(" and "),
        PAPER_FACTORS[0],
        PAPER_FACTORS[1]
    ))
}
