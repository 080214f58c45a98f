//! Times against the number of lights, with straight lines through them.

use crate::chart::{Axis, Marks, Point, Scale, Series, XyChart};
use crate::grouping::distinct;
use crate::report::column::{Better, Column};
use crate::report::fit::Fit;
use crate::report::format::{ABSENT, number, percent, significant};
use crate::report::living;
use crate::report::markup::{Html, html};
use crate::report::table::{Look, Row, Table};
use crate::results::Record;
use crate::strategy::StrategyId;
use crate::study::data::{Entry, Line, counts, entries, lines, marked_name, poses, ranking, stand};
use crate::study::manifest::Done;
use crate::study::page::figure::{Charts, panels};
use crate::study::page::lines::{Time, fit, times_series};
use crate::study::page::part::Part;

/// Points along a fitted line; on logarithmic axes it is a curve.
const STEPS: u32 = 40;

/// A time no farther than this share of itself from a line lies on it.
const TOLERANCE: f64 = 0.1;

/// A line is judged over at least as many counts: through three, a line with two ends always comes
/// close.
const FEWEST: usize = 4;

/// How straight a strategy's times are against the number of lights.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Straight {
    /// The largest relative distance of a time from the best line.
    pub(crate) worst: f64,
    /// The count of lights at which it is.
    pub(crate) at: u64,
    /// The widest range of neighbouring counts over which the times are straight.
    pub(crate) range: Option<[u64; 2]>,
}

impl Straight {
    /// Whether no time is off the line over all counts.
    pub(crate) fn holds(&self) -> bool {
        self.worst <= TOLERANCE
    }
}

/// How straight times are: through the line that takes every count's relative distance alike, so that the
/// greatest counts do not decide on their own. `None` with fewer than four counts.
pub(crate) fn straight(records: &[&Record], time: Time) -> Option<Straight> {
    let points: Vec<(f64, f64)> =
        records.iter().map(|r| (r.setting.lights as f64, time(r))).collect();
    let worst = |points: &[(f64, f64)]| Fit::relative(points).map(|fit| fit.worst(points));
    if points.len() < FEWEST {
        return None;
    }
    let (whole, at) = worst(&points)?;
    let mut range: Option<[usize; 2]> = None;
    let width = |[from, to]: [usize; 2]| points[to].0 / points[from].0.max(1.0);
    for from in 0..points.len() {
        for to in from + FEWEST - 1..points.len() {
            let is_straight = worst(&points[from..=to]).is_some_and(|(off, _)| off <= TOLERANCE);
            if is_straight && range.is_none_or(|best| width([from, to]) > width(best)) {
                range = Some([from, to]);
            }
        }
    }
    let range = range.map(|ends| ends.map(|ix| points[ix].0 as u64));
    Some(Straight { worst: whole, at: at as u64, range })
}

/// Scaling with lights: fits, growing and constant density, radii.
pub(crate) fn scaling(done: &Done, scene: &str, charts: &mut Charts) -> [Part; 3] {
    let scaling = entries(done, scene, "scaling");
    let html = by_source(&scaling, |source, entries| {
        let slug = format!("{scene}-scaling-{source}");
        let title = "Time against lights, and the straight lines through them".to_owned();
        charts.xy(&slug, &fitted_chart(title, &lines(entries), Record::assign_and_shade_ms))
            + fits_table(entries)
    });
    let scaled = Part::new(
        "scaling",
        "Scaling",
        format!(
            "{} Whiskers are confidence intervals over rounds or laps. Dashes show the \
             least-squares line through each strategy\u{2019}s times, which is curved on these \
             logarithmic axes. For the column \u{201c}largest distance from a line\u{201d}, we \
             fit another line to the same times. This fit minimises relative errors, so that a \
             time at few lights weighs as much as a time at many.",
            stands(&scaling)
        ),
        html,
    );
    let density = Part::new(
        "density",
        "Many more lights",
        "Growing density: more lights in the same box. Constant density: the scene grows with the \
         cube root of the number of lights, and lights keep their size. All strategies use the \
         hierarchy.",
        density(done, scene, charts),
    );
    let radii = Part::new(
        "radii",
        "Other radii",
        "The lights have the same mean radius, but other distributions of radii. Brackets hold the \
         time divided by the time with the gamma distribution.",
        radii(done, scene),
    );
    [scaled, density, radii]
}

/// What the points of a chart are: means along the path, or medians of one pose.
fn stands(entries: &[Entry<'_>]) -> String {
    match entries.iter().map(|entry| entry.record).max_by_key(|record| poses(record)) {
        Some(record) if record.setting.along_path => {
            format!("Points are means of {} along the path.", stand(record))
        }
        _ => "Points are medians from one pose.".to_owned(),
    }
}

/// A panel per source of lights: strategies without one, such as None, are in both.
fn by_source(all: &[Entry<'_>], mut body: impl FnMut(&str, &[Entry<'_>]) -> Html) -> Html {
    let mut shown = Vec::new();
    for (source, text, bvh) in [
        ("linear", "With the list of all lights", false),
        ("bvh", "With the hierarchy (/bvh)", true),
    ] {
        let has_source = |entry: &&Entry<'_>| entry.record.culls();
        let chosen: Vec<Entry<'_>> = all
            .iter()
            .filter(|entry| !has_source(entry) || entry.record.strategy.is_bvh() == bvh)
            .copied()
            .collect();
        if chosen.iter().any(|entry| entry.record.culls()) {
            shown.push((text.to_owned(), body(source, &chosen)));
        }
    }
    panels("Where strategies look for lights", &shown)
}

/// A chart of times against lights, logarithmic, with the fit of each strategy.
pub(crate) fn fitted_chart(title: String, lines: &[Line<'_>], time: Time) -> XyChart {
    let mut series = Vec::new();
    for (id, records) in lines {
        let line = fit(records, time).filter(|fit| fit.points > 2);
        let ends = (records.first(), records.last());
        if let (Some(line), (Some(first), Some(last))) = (line, ends) {
            let (low, high) =
                (first.setting.lights.max(1) as f64, last.setting.lights.max(1) as f64);
            let at = |step: u32| low * (high / low).powf(f64::from(step) / f64::from(STEPS));
            let points = (0..=STEPS)
                .map(at)
                .filter(|x| line.at(*x) > 0.0)
                .map(|x| Point { x, y: line.at(x), ..Point::default() })
                .collect();
            series.push(Series::new(id.short(), id.class(), Marks::Dashed, points));
        }
        series.push(times_series(id, records, time, Marks::Points));
    }
    XyChart::new(title, axes(), series)
}

fn axes() -> [Axis; 2] {
    [Axis::new("Lights", "", Scale::Log), Axis::new("Assign + shade", "ms", Scale::Log)]
}

/// The lines through a strategy's times, and how straight these are.
struct Fits<'a> {
    id: &'a StrategyId,
    both: Fit,
    straight: Option<Straight>,
    assign: Option<Fit>,
    /// Of the passes of lights that move.
    living: [Option<Fit>; 3],
    shade: Option<Fit>,
}

/// Slope, offset and goodness of the line through each strategy's times; slopes of its passes.
fn fits_table<'a>(entries: &[Entry<'a>]) -> Html {
    let row = |(id, records): Line<'a>| {
        let both = fit(&records, Record::assign_and_shade_ms)?;
        let straight = straight(&records, Record::assign_and_shade_ms);
        let of_pass = |time: &dyn Fn(&Record) -> f64| {
            let is_there = records.iter().any(|record| time(record) != 0.0);
            fit(&records, time).filter(|_| is_there)
        };
        let assign = of_pass(&|record| record.times.assign_ms);
        let living = living::PASSES.map(|pass| of_pass(&|record| record.time_of(|n, _| n == pass)));
        let shade = of_pass(&|record| record.times.shade_ms);
        Some(Row::new(marked_name(entries, id), Fits { id, both, straight, assign, living, shade }))
    };
    let rows: Vec<Row<Fits<'a>>> = lines(entries).into_iter().filter_map(row).collect();
    let off = |fits: &Fits<'_>| Some(fits.straight.as_ref()?.worst);
    let straight_over = |fits: &Fits<'_>| match fits.straight.and_then(|found| found.range) {
        Some([low, high]) => format!("{} to {}", number(low as f64), number(high as f64)),
        None => ABSENT.to_owned(),
    };
    let [slope, offset, r2] = line_columns("slope", |fits| Some(&fits.both));
    let mut columns = vec![
        slope,
        offset,
        r2,
        Column::figure("largest distance from a line", "%", Better::Less, off, percent),
        Column::words("straight within 10 %, lights", "", straight_over),
    ];
    columns.extend(line_columns("assign: slope", |fits| fits.assign.as_ref()));
    columns.extend(living::PASSES.iter().enumerate().map(|(ix, pass)| {
        let slope = move |fits: &Fits<'a>| fits.living[ix].map(|fit| fit.slope * 1e6);
        let unit = "\u{b5}s per 1,000 lights";
        Column::figure(format!("{pass}: slope"), unit, Better::Less, slope, significant).optional()
    }));
    columns.extend(line_columns("shade: slope", |fits| fits.shade.as_ref()));
    Table::new("strategy", columns, rows)
        .competing(|_| false)
        .dotted(|fits| fits.id.class())
        .html("Straight lines through times against lights", Look::Plain)
}

/// The columns of one line: slope, offset and R².
fn line_columns<'a>(
    slope: &str,
    line: for<'f> fn(&'f Fits<'a>) -> Option<&'f Fit>,
) -> [Column<'a, Fits<'a>>; 3] {
    // Two points always lie on a line, so their R² says nothing.
    let r2 = move |fits: &Fits<'a>| line(fits).filter(|fit| fit.points > 2).map(|fit| fit.r2);
    let slope_of = move |fits: &Fits<'a>| line(fits).map(|fit| fit.slope * 1e6);
    let offset = move |fits: &Fits<'a>| line(fits).map(|fit| fit.offset);
    [
        Column::figure(slope, "\u{b5}s per 1,000 lights", Better::Less, slope_of, significant),
        Column::ms("offset", offset),
        Column::figure("R\u{b2}", "", Better::More, r2, |r2| format!("{r2:.3}")),
    ]
}

fn density(done: &Done, scene: &str, charts: &mut Charts) -> Html {
    let scaling = entries(done, scene, "scaling");
    let bvh = |entry: &&Entry<'_>| entry.record.strategy.is_bvh();
    let most = counts(&ranking(done, scene)).last().copied();
    let mut html = Html::default();
    for (section, title, base) in [
        ("growing", "More lights in the same box", &scaling),
        ("constant", "More lights in a larger scene, at the same density", &scaling),
    ] {
        let chosen = entries(done, scene, section);
        if chosen.is_empty() {
            continue;
        }
        let from =
            |entry: &&Entry<'_>| section == "growing" || Some(entry.record.setting.lights) == most;
        let known = |entry: &&Entry<'_>| {
            chosen.iter().any(|other| other.record.strategy == entry.record.strategy)
        };
        let mut all: Vec<Entry<'_>> =
            base.iter().filter(bvh).filter(from).filter(known).copied().collect();
        all.extend(&chosen);
        let time: Time = Record::assign_and_shade_ms;
        let series = lines(&all)
            .iter()
            .map(|(id, records)| times_series(id, records, time, Marks::LineAndPoints))
            .collect();
        html += charts.xy(&format!("{scene}-{section}"), &XyChart::new(title, axes(), series));
    }
    if html.is_empty() { html } else { html!("<div class=\"pair\">{}</div>", html) }
}

fn radii<'a>(done: &'a Done, scene: &'a str) -> Html {
    let all = entries(done, scene, "radii");
    let radii = all.iter().map(|entry| entry.record.setting.radii.as_deref());
    let kinds = distinct(radii.map(|kind| kind.unwrap_or("unknown")));
    let time = |(_, records): &Line<'_>, kind: &str| {
        let mut records = records.iter();
        let found = records.find(|record| record.setting.radii.as_deref() == Some(kind));
        found.map(|record| record.assign_and_shade_ms())
    };
    let column = |kind| {
        Column::ms(kind, move |line: &Line<'_>| time(line, kind)).note(move |line| {
            let factor = || {
                let gamma = time(line, "gamma").filter(|gamma| kind != "gamma" && *gamma > 0.0)?;
                Some(html!(" (\u{d7} {})", significant(time(line, kind)? / gamma)))
            };
            factor().unwrap_or_default()
        })
    };
    let columns: Vec<_> = kinds.into_iter().map(column).collect();
    let row = |line: Line<'a>| Row::new(marked_name(&all, line.0), line);
    Table::new("strategy", columns, lines(&all).into_iter().map(row).collect())
        .competing(|_| false)
        .dotted(|(id, _)| id.class())
        .html("Times by the distribution of radii", Look::Plain)
}
