//! Building deep images: times by directions and by build, and memory.

use crate::chart::{Axis, Marks, Point, Scale, Series, XyChart};
use crate::report::format::{ABSENT, mebibytes, number, significant};
use crate::report::markup::{Html, html};
use crate::results::{CastTimes, DeepImageRun, median};
use crate::study::cdi::jobs;
use crate::study::cdi::times::{PAPER, refused_build, runs, shown, timed_runs};
use crate::study::manifest::Done;
use crate::study::page::figure::{Charts, table, unit};
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
    let of = |build: &str, directions: u32| {
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
    let ms = |run: Option<&DeepImageRun>| {
        run.map_or_else(|| ABSENT.into(), |run| shown(run.build_ms(), counts_as_time(run)))
    };
    let rows: Vec<Vec<Html>> = counts
        .iter()
        .map(|&count| {
            let [compute, fragment, each, batched] = BUILDS.map(|(id, ..)| of(id, count));
            let timed = |run: Option<&DeepImageRun>| {
                run.filter(|run| counts_as_time(run)).map(DeepImageRun::build_ms)
            };
            let factor = |all: Option<&DeepImageRun>| {
                let factor = timed(compute).zip(timed(all)).map(|(one, all)| all / one);
                Html::from(factor.map_or(ABSENT.to_owned(), significant))
            };
            let paper = PAPER_BUILDS.iter().find(|(known, _)| *known == count);
            let theirs = |ix: usize| {
                let ms = paper.map(|(_, ms)| significant(ms[ix]));
                Html::from(ms.unwrap_or_else(|| ABSENT.to_owned()))
            };
            let mut row = vec![number(f64::from(count)).into(), ms(compute), ms(fragment)];
            row.extend([ms(each), factor(each), ms(batched), factor(batched)]);
            row.extend([theirs(0), theirs(1)]);
            row
        })
        .collect();
    let steady: Vec<&DeepImageRun> =
        plain.iter().copied().filter(|run| counts_as_time(run)).collect();
    let ms = |head| unit(head, "ms");
    let heads = [
        "directions".into(),
        ms("one pass, compute"),
        ms("one pass, rasterised"),
        ms("a dispatch per direction"),
        "factor".into(),
        ms("per direction, one dispatch"),
        "factor".into(),
        ms("paper, Atrium"),
        ms("paper, Rungholt"),
    ];
    let chart = charts.xy(&format!("{scene}-builds"), &build_chart(&steady));
    let body = chart
        + table("Build time against directions", &heads, &rows)
        + passes(of("compute", counts.last().copied().unwrap_or(0)))
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

fn build_chart(plain: &[&DeepImageRun]) -> XyChart {
    let series = BUILDS
        .iter()
        .map(|(id, name, class)| {
            let own = plain.iter().filter(|run| run.deep.build == *id);
            let mut points: Vec<Point> = own
                .map(|run| {
                    let (x, y) = (f64::from(run.deep.directions()), run.build_ms());
                    let tip = format!("{name}\n{} directions\n{} ms", number(x), significant(y));
                    Point { x, y, tip, ..Point::default() }
                })
                .collect();
            points.sort_by(|a, b| a.x.total_cmp(&b.x));
            let (name, class) = ((*name).to_owned(), (*class).to_owned());
            Series { name, class, marks: Marks::LineAndPoints, points, ..Series::default() }
        })
        .filter(|series| !series.points.is_empty())
        .collect();
    XyChart {
        title: "Build time against directions".to_owned(),
        x: Axis { label: "Directions".to_owned(), unit: String::new(), scale: Scale::Log },
        y: Axis { label: "Build".to_owned(), unit: "ms".to_owned(), scale: Scale::Log },
        series,
        note: String::new(),
    }
}

/// Times of casting rays and of random ranges against the number of lights.
pub(crate) fn cast_chart(arrays: &[&CastTimes], linked: &[&CastTimes]) -> XyChart {
    let line =
        |casts: &[&CastTimes], name: &str, class: &str, of: fn(&CastTimes) -> &[f64]| Series {
            name: name.to_owned(),
            class: class.to_owned(),
            marks: Marks::LineAndPoints,
            points: casts
                .iter()
                .filter(|cast| !cast.is_middle)
                .map(|cast| {
                    let (x, y) = (cast.lights as f64, median(of(cast)));
                    let tip = format!("{name}\n{} lights\n{} ms", number(x), significant(y));
                    Point { x, y, tip, ..Point::default() }
                })
                .collect(),
            ..Series::default()
        };
    let series = vec![
        line(arrays, "rays through arrays", "series-0", |cast| &cast.cast_ms),
        line(arrays, "random ranges", "series-3", |cast| &cast.random_ms),
        line(linked, "rays through linked lists", "series-2", |cast| &cast.cast_ms),
    ];
    let series = series.into_iter().filter(|series| !series.points.is_empty()).collect();
    XyChart {
        title: "Time to find the ranges of all lights".to_owned(),
        x: Axis {
            label: "Virtual point lights".to_owned(),
            unit: String::new(),
            scale: Scale::Log,
        },
        y: Axis { label: "Ranges".to_owned(), unit: "ms".to_owned(), scale: Scale::Log },
        series,
        note: String::new(),
    }
}

/// The passes of a build.
fn passes(run: Option<&DeepImageRun>) -> Html {
    let Some(run) = run else { return Html::default() };
    let rows: Vec<Vec<String>> = run
        .passes
        .iter()
        .map(|(pass, times)| {
            vec![pass.to_owned(), significant(times.median_ms), significant(times.p95_ms)]
        })
        .collect();
    let title = format!("The passes of {} directions", run.deep.directions());
    html!("<h4>{}</h4>\n", title)
        + table(&title, &["pass".into(), unit("median", "ms"), unit("p95", "ms")], &rows)
}

/// What every setting takes.
fn memory(all: &[&DeepImageRun], counts_as_time: impl Fn(&DeepImageRun) -> bool) -> Html {
    let rows: Vec<Vec<Html>> = all
        .iter()
        .map(|run| {
            let deep = &run.deep;
            let name = format!(
                "{} x {}\u{b2}{}{}, {}",
                deep.directions(),
                deep.size_px,
                if deep.oversampling > 1 { ", oversampled" } else { "" },
                if deep.spread == "squares" { ", squares" } else { "" },
                deep.build
            );
            vec![
                name.into(),
                significant(deep.footprint_m).into(),
                number(deep.samples as f64).into(),
                number(deep.fragments as f64).into(),
                number(deep.longest_list as f64).into(),
                mebibytes(deep.bytes as f64).into(),
                shown(run.build_ms(), counts_as_time(run)),
            ]
        })
        .collect();
    let heads = [
        "deep images".into(),
        unit("pixel", "m"),
        "samples".into(),
        "fragments".into(),
        "longest list".into(),
        unit("memory", "MiB"),
        unit("build", "ms"),
    ];
    html!("<h4>Memory</h4>\n") + table("Memory of deep images", &heads, &rows)
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
        let own = all.iter().filter(|run| {
            is_plain(run, first)
                && run.deep.directions() == directions
                && builds.contains(&run.deep.build.as_str())
        });
        own.map(|run| run.build_ms()).filter(|ms| ms.is_finite()).min_by(f64::total_cmp)
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
                "{} times as fast as {what}, {} ms",
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
        "In {scene} one pass over the triangles builds {} directions in {} ms: {}. The paper \
         reports {} times in its atrium and {} in its town.",
        most.directions,
        significant(most.single_ms),
        both.join("; "),
        PAPER_FACTORS[0],
        PAPER_FACTORS[1]
    ))
}
