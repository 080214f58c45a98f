//! Rays through deep images against exact ones: how far off distances are, by directions and by size.

use crate::chart::{Axis, Histogram, Scale, XyChart};
use crate::report::column::{Better, Column};
use crate::report::format::{percent, significant};
use crate::report::markup::Html;
use crate::report::table::{Look, Row, Table};
use crate::results::{DeepImageRun, RangeErrors};
use crate::study::cdi::jobs;
use crate::study::cdi::page::builds::images_name;
use crate::study::cdi::times::runs;
use crate::study::manifest::Done;
use crate::study::page::figure::Charts;
use crate::study::page::lines::tipped_line;
use crate::study::page::part::Part;

/// The runs whose rays were compared, with what was found.
fn compared<'a>(done: &'a Done, scene: &'a str) -> Vec<(&'a DeepImageRun, &'a RangeErrors)> {
    let all = runs(done, scene, jobs::BUILDS).into_iter();
    all.filter_map(|run| Some((run, run.range_errors.as_ref()?))).collect()
}

/// Charts and table.
pub(crate) fn ranges(done: &Done, scene: &str, charts: &mut Charts) -> Option<Part> {
    let all = compared(done, scene);
    let (first, _) = all.first().copied()?;
    let of_size = |run: &&(&DeepImageRun, &RangeErrors)| {
        run.0.deep.size_px == first.deep.size_px && is_paper_build(run.0)
    };
    let by_directions: Vec<_> = all.iter().filter(of_size).copied().collect();
    let most = all.iter().map(|(run, _)| run.deep.directions()).max().unwrap_or(0);
    let of_most = |run: &&(&DeepImageRun, &RangeErrors)| {
        run.0.deep.directions() == most && is_paper_build(run.0)
    };
    let mut by_size: Vec<_> = all.iter().filter(of_most).copied().collect();
    by_size.sort_by_key(|(run, _)| run.deep.size_px);
    let directions = chart("Errors of rays by directions", "Directions", &by_directions, |run| {
        f64::from(run.deep.directions())
    });
    let sizes = chart("Errors of rays by size of images", "Pixels along a side", &by_size, |run| {
        f64::from(run.deep.size_px)
    });
    let histograms: Vec<Histogram> = by_directions.iter().map(histogram).collect();
    let body = charts.histograms(
        &format!("{scene}-range-errors"),
        "Distribution of the errors of rays",
        &histograms,
    ) + charts.xy(&format!("{scene}-ranges-directions"), &directions)
        + charts.xy(&format!("{scene}-ranges-sizes"), &sizes)
        + errors_table(&all);
    let text = "Rays start on surfaces, along the normal and around it, as lights cast them. Exact \
                rays intersect the same triangles, in the requested direction. A footprint is the \
                side of a pixel. A ray is lost if it hits a surface but nothing in the deep \
                images, and invented if it hits something only there.";
    Some(Part::new("ranges", "Ranges against exact rays", text, body))
}

/// Whether it is built as in the paper.
fn is_paper_build(run: &DeepImageRun) -> bool {
    run.deep.oversampling == 1 && run.deep.build == "compute" && run.deep.spread != "squares"
}

fn chart(
    title: &str,
    label: &str,
    all: &[(&DeepImageRun, &RangeErrors)],
    x: fn(&DeepImageRun) -> f64,
) -> XyChart {
    let line = |name: &str, class: &str, error: fn(&RangeErrors) -> f64| {
        let points = all.iter().map(|(run, errors)| (x(run), error(errors)));
        let known = points.filter(|(_, error)| error.is_finite());
        tipped_line(name, class, [label, "footprints"], known)
    };
    let series = vec![
        line("median of rays", "series-0", RangeErrors::median),
        line("90 % of rays", "series-1", |errors| quantile(errors, 0.9)),
        line("median of lights\u{2019} ranges", "series-2", |errors| errors.median_range_error),
    ];
    let axes = [Axis::new(label, "", Scale::Log), Axis::new("Error", "footprints", Scale::Log)];
    XyChart::new(title, axes, series)
}

/// A quantile of the errors of rays, in footprints.
fn quantile(errors: &RangeErrors, share: f64) -> f64 {
    let last = errors.error_quantiles.len().saturating_sub(1);
    let at = (share * last as f64).round() as usize;
    errors.error_quantiles.get(at).copied().unwrap_or(f64::NAN)
}

fn histogram((run, errors): &(&DeepImageRun, &RangeErrors)) -> Histogram {
    let mut low = 0.0;
    let mut bins = Vec::new();
    for (ix, count) in errors.histogram.iter().enumerate() {
        let name = match RangeErrors::BINS.get(ix) {
            Some(high) => format!("{}\u{2013}{}", significant(low), significant(*high)),
            None => format!("> {}", significant(low)),
        };
        low = RangeErrors::BINS.get(ix).copied().unwrap_or(low);
        bins.push((name, *count));
    }
    Histogram {
        title: format!("{} directions", run.deep.directions()),
        x_label: "Error, footprints".to_owned(),
        bins,
        class: "series-0".to_owned(),
        note: format!("median {}", significant(errors.median())),
    }
}

/// The errors of a run, and whether directions were corrected.
type Errors<'a> = (&'a DeepImageRun, &'a RangeErrors, bool);

fn errors_table<'a>(all: &[(&'a DeepImageRun, &'a RangeErrors)]) -> Html {
    let corrected =
        all.iter().filter_map(|(run, _)| Some((*run, run.corrected_errors.as_ref()?, true)));
    let both = all.iter().map(|(run, errors)| (*run, *errors, false)).chain(corrected);
    let row = |row: Errors<'a>| {
        let corrected = if row.2 { ", corrected" } else { "" };
        Row::new(images_name(&row.0.deep) + corrected, row)
    };
    let footprints = |head, value: fn(&RangeErrors) -> f64| {
        let value = move |row: &Errors<'_>| Some(value(row.1));
        Column::figure(head, "footprints", Better::Less, value, significant)
    };
    let share = |head, count: fn(&RangeErrors) -> u64| {
        let value = move |row: &Errors<'_>| Some(count(row.1) as f64 / row.1.rays.max(1) as f64);
        Column::figure(head, "%", Better::Less, value, percent)
    };
    let columns = [
        footprints("median", RangeErrors::median),
        footprints("90 %", |errors| quantile(errors, 0.9)),
        footprints("range, median", |errors| errors.median_range_error),
        share("too near", |errors| errors.too_near),
        share("too far", |errors| errors.too_far),
        share("lost", |errors| errors.lost),
        share("invented", |errors| errors.invented),
    ];
    Table::new("deep images", columns, both.map(row).collect())
        .competing(|_| false)
        .html("Ranges against exact rays", Look::Plain)
}

/// The median error at the most directions.
pub(crate) fn findings(done: &Done, scene: &str) -> Option<String> {
    let all = compared(done, scene);
    let usual = all
        .iter()
        .filter(|(run, _)| is_paper_build(run) && run.deep.size_px == all[0].0.deep.size_px);
    let (run, errors) = usual.max_by_key(|(run, _)| run.deep.directions())?;
    errors.median().is_finite().then(|| {
        format!(
            "In {scene} at {} directions the median error of a ray is {} of a pixel\u{2019}s \
             footprint of {} m; {} % of rays are lost and {} % invented.",
            run.deep.directions(),
            significant(errors.median()),
            significant(run.deep.footprint_m),
            percent(errors.lost as f64 / errors.rays.max(1) as f64),
            percent(errors.invented as f64 / errors.rays.max(1) as f64)
        )
    })
}
