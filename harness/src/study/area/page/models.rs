//! Models of area lights against the truth: errors, times, and what each gets wrong.

use crate::report::column::{Better, Column};
use crate::report::format::{ABSENT, difference, percent, significant};
use crate::report::frontier::frontier;
use crate::report::markup::Html;
use crate::report::rank::listed;
use crate::report::table::{Look, Row, Table};
use crate::results::{Errors, Record, TruthImage};
use crate::study::against_truth::{MODELS, truth_of};
use crate::study::data::{Entry, entries};
use crate::study::manifest::Done;
use crate::study::page::error_columns::error_columns;
use crate::study::page::errors_plot::{FIRST, Plot};
use crate::study::page::figure::Charts;
use crate::study::page::part::Part;
use crate::study::page::shots::{Shots, Wanted};

/// The metric by which sentences compare models.
const METRIC: &str = "flip";

/// The name of spots among models.
pub(crate) const SPOTS: &str = "spots";

/// A family of models, and what it cannot represent.
struct Family {
    id: &'static str,
    class: &'static str,
    about: &'static str,
}

/// All families, in the order of the table.
const FAMILIES: [Family; 11] = [
    Family {
        id: "point",
        class: "series-0",
        about: "All light comes from the emitter\u{2019}s middle. Highlights lose the outline, \
                surfaces near a large emitter are too bright, and light ends abruptly where the \
                middle sets.",
    },
    Family {
        id: "mrp",
        class: "series-1",
        about: "One point stands for the emitter in each term, so highlights keep the outline. The \
                cosine and the lobe are greater at that point than on average over the emitter, \
                so the image is too bright.",
    },
    Family {
        id: "mrp-published",
        class: "series-5",
        about: "The same points with the paper\u{2019}s weights. Specular light is missing where \
                the cone around the mirror direction misses the emitter. Smooth surfaces get far \
                too much of it.",
    },
    Family {
        id: "ltc",
        class: "series-2",
        about: "A transformed cosine replaces the BRDF\u{2019}s lobe, and its integral is exact. \
                There is no noise. The error is that of the fit, greatest at grazing views.",
    },
    Family {
        id: "ltc-hammon",
        class: "series-6",
        about: "The same with a table fitted to an approximation of the BRDF that engines use.",
    },
    Family {
        id: "ltc-unsplit",
        class: "series-8",
        about: "The same without splitting long edges. Noise shows where an edge spans nearly half \
                the sphere.",
    },
    Family {
        id: "ltc-per-light",
        class: "series-2",
        about: "The image equals that of ltc; each light looks up the lobe again.",
    },
    Family {
        id: "ltc-polynomial",
        class: "series-3",
        about: "The same with polynomials instead of the table, which adds the error of their fit.",
    },
    Family {
        id: "ltc-polynomial-per-light",
        class: "series-3",
        about: "The image equals that of ltc-polynomial; each light evaluates the polynomials \
                again.",
    },
    Family {
        id: "monte-carlo",
        class: "series-4",
        about: "Correct on average but noisy. Highlights on smooth surfaces need the most samples.",
    },
    Family {
        id: "monte-carlo-reflected",
        class: "series-7",
        about: "Specular samples lie where the surface mirrors the emitter. Noise falls, but \
                specular light from elsewhere is missing.",
    },
];

/// The family of a model: `monte-carlo` of `monte-carlo:16`.
pub(crate) fn family(model: &str) -> &str {
    model.split(':').next().unwrap_or(model)
}

/// The samples per light of a model: 16 of `monte-carlo:16`; `None` where it draws none.
pub(crate) fn samples(model: &str) -> Option<u32> {
    model.split_once(':')?.1.parse().ok()
}

/// The class that colours a model.
pub(crate) fn class(model: &str) -> String {
    let known = FAMILIES.iter().find(|known| known.id == family(model));
    known.map_or("strategy-none", |known| known.class).to_owned()
}

/// A record's model of area lights; spots where it has none.
pub(crate) fn model(record: &Record) -> &str {
    record.setting.area_model.as_deref().unwrap_or(SPOTS)
}

/// An error against the truth, where it is finite.
fn error(record: &Record, id: &str) -> Option<f64> {
    record.image.truth_errors.get(id).copied().flatten()
}

/// Errors and times of all models, and the faults of each.
pub(crate) fn models(
    done: &Done,
    scene: &str,
    charts: &mut Charts,
    shots: &mut Shots<'_>,
) -> Vec<Part> {
    let all = entries(done, scene, MODELS);
    let known: Vec<Entry<'_>> =
        all.iter().filter(|entry| !entry.record.image.truth_errors.is_empty()).copied().collect();
    let truth = truth_of(done, scene).map(|(_, truth)| truth);
    let mut parts = Vec::new();
    if let (Some(truth), false) = (truth, known.is_empty()) {
        parts.push(Part::new(
            "models",
            "Models of area lights against the truth",
            about(truth),
            errors_table(&known, truth) + words_table(&known),
        ));
    }
    let plot = Plot {
        slug: "models",
        title: "Error of models against time",
        entries: known,
        errors: |record| &record.image.truth_errors,
        series: |record| family(model(record)).to_owned(),
        class: |record| class(model(record)),
        shape: |_| None,
        name: |record| model(record).to_owned(),
        label: |record| samples(model(record)).map_or_else(String::new, |count| count.to_string()),
        wanted: Wanted::Truth,
        time: "Shade",
        first: FIRST,
        ms: Record::assign_and_shade_ms,
    };
    parts.push(Part::new(
        "model-times",
        "Speed against accuracy: models",
        "The error of shading against the truth image, without culling. Points at the lower left \
         are best. The curve of Monte Carlo runs over its numbers of samples; hover over a point \
         to see its number. The staircase joins the models that no other model beats in both time \
         and error. Click a point to see its picture beside the truth.",
        plot.html(scene, charts, shots),
    ));
    parts
}

/// What the truth image is.
fn about(truth: &TruthImage) -> String {
    format!(
        "{} area lights at {} x {}; every light is evaluated at every sample. The CPU integrated \
         the truth in {} s, {} shadows, {} bounces; its standard error is {} % of the mean \
         luminance. All errors come from the model, none from culling.",
        truth.lights,
        truth.width,
        truth.height,
        significant(truth.seconds),
        if truth.shadows { "with" } else { "without" },
        truth.bounces,
        percent(truth.standard_error)
    )
}

/// A row of errors: of a model with its time, or of the G-buffer.
struct ErrorRow<'a> {
    class: String,
    shade_ms: Option<f64>,
    errors: &'a Errors,
}

fn errors_of<'r>(row: &'r ErrorRow<'_>) -> &'r Errors {
    row.errors
}

fn errors_table<'a>(entries: &[Entry<'a>], truth: &'a TruthImage) -> Html {
    let of_model = |Entry { record, .. }: &Entry<'a>| {
        let model = model(record);
        let shade_ms = Some(record.times.shade_ms);
        let row = ErrorRow { class: class(model), shade_ms, errors: &record.image.truth_errors };
        Row::new(model, row)
    };
    let mut rows: Vec<Row<ErrorRow<'a>>> = entries.iter().map(of_model).collect();
    // Every model reads the G-buffer, so the cost of its rounding is in all rows above.
    if !truth.gbuffer_errors.is_empty() {
        let errors = &truth.gbuffer_errors;
        let row = ErrorRow { class: String::new(), shade_ms: None, errors };
        rows.push(Row::new("the G-buffer alone", row));
    }
    let shade = |row: &ErrorRow<'_>| row.shade_ms;
    let mut columns = vec![Column::figure("shade", "ms", Better::Less, shade, significant)];
    columns.extend(error_columns(errors_of));
    Table::new("model", columns, rows)
        .competing(|_| false)
        .dotted(|row| row.class.clone())
        .html("Errors of models against the truth", Look::Plain)
}

/// What each model leaves out, and what that comes to here.
fn words_table<'a>(entries: &[Entry<'a>]) -> Html {
    let about = |record: &&Record| {
        let known = FAMILIES.iter().find(|known| known.id == family(model(record)));
        known.map_or_else(String::new, |known| known.about.to_owned())
    };
    let measured = |record: &&Record| {
        let bias = error(record, "bias");
        let share = |error: Option<f64>| error.map_or_else(|| ABSENT.to_owned(), percent);
        format!(
            "{} % too {} in total; {} % of the light is missing where it is too dark; the worst \
             tile is off by {} % of the mean",
            share(bias.map(f64::abs)),
            if bias.is_some_and(|bias| bias < 0.0) { "dark" } else { "bright" },
            share(error(record, "missing_energy")),
            share(error(record, "tile")),
        )
    };
    let columns = [Column::prose("what it leaves out", about), Column::prose("measured", measured)];
    let row = |entry: &Entry<'a>| Row::new(model(entry.record), entry.record);
    Table::new("model", columns, entries.iter().map(row).collect())
        .dotted(|record| class(model(record)))
        .html("What each model gets wrong", Look::Plain)
}

/// Names the models on the frontier of time and error, and compares the table with its polynomials.
pub(crate) fn findings(done: &Done, scene: &str) -> Vec<String> {
    let all = entries(done, scene, MODELS);
    let known: Vec<(&Record, f64)> = all
        .iter()
        .filter_map(|entry| Some((entry.record, error(entry.record, METRIC)?)))
        .filter(|(record, _)| record.times.shade_ms.is_finite())
        .collect();
    let best = frontier(known.iter().map(|(record, error)| (record.times.shade_ms, *error)));
    if best.is_empty() {
        return Vec::new();
    }
    let on: Vec<String> = best
        .iter()
        .filter_map(|at| {
            known.iter().find(|(record, error)| (record.times.shade_ms, *error) == *at)
        })
        .map(|(record, error)| {
            format!(
                "{} ({} ms, FLIP {})",
                model(record),
                significant(record.times.shade_ms),
                difference(*error)
            )
        })
        .collect();
    let mut found = vec![format!(
        "In {scene} no model beats any of these in both time and FLIP: {}.",
        listed(&on)
    )];
    let find = |wanted: &str| known.iter().find(|(record, _)| model(record) == wanted);
    if let (Some((table, error)), Some((polynomial, other))) = (find("ltc"), find("ltc-polynomial"))
    {
        found.push(format!(
            "In {scene} polynomials instead of the table take {} times as long and have a FLIP of \
             {} instead of {}.",
            significant(polynomial.times.shade_ms / table.times.shade_ms),
            difference(*other),
            difference(*error)
        ));
    }
    found
}

/// The model nearest to the truth, in the first scene that has one.
pub(crate) fn headline(done: &Done) -> Option<String> {
    done.scenes().into_iter().find_map(|scene| {
        let all = entries(done, scene, MODELS);
        let known = all.iter().filter_map(|entry| {
            let has_noise = samples(model(entry.record)).is_some();
            Some((entry.record, error(entry.record, METRIC)?)).filter(|_| !has_noise)
        });
        let (record, error) = known.min_by(|a, b| a.1.total_cmp(&b.1))?;
        Some(format!(
            "Of the models without noise, {} is nearest to the truth in {scene}: FLIP {} in {} ms.",
            model(record),
            difference(error),
            significant(record.times.shade_ms)
        ))
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_family_has_a_colour_of_its_own() {
        // Those that look the lobe up per light show the image of their base in its colour.
        let coloured = FAMILIES.iter().filter(|known| !known.id.ends_with("-per-light"));
        let mut classes: Vec<String> = coloured.map(|known| class(known.id)).collect();
        classes.push(class(SPOTS));
        let count = classes.len();
        classes.sort();
        classes.dedup();
        assert_eq!(classes.len(), count);
        assert_eq!((family("monte-carlo:16"), family("ltc")), ("monte-carlo", "ltc"));
        for model in shading::AreaModel::ALL {
            let name = model.to_string();
            assert!(FAMILIES.iter().any(|known| known.id == family(&name)), "{name}");
        }
    }
}
