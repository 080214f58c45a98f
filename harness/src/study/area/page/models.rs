//! Models of area lights against the truth: errors, times, and what each gets wrong.

use crate::image_errors::ERROR_METRICS;
use crate::report::format::{ABSENT, difference, percent, significant};
use crate::report::markup::Html;
use crate::report::rank::listed;
use crate::results::{Record, TruthImage};
use crate::study::against_truth::{MODELS, truth_of};
use crate::study::data::{Entry, entries};
use crate::study::manifest::Done;
use crate::study::page::errors_plot::{FIRST, Plot, frontier};
use crate::study::page::figure::{Charts, dotted, table, unit, words};
use crate::study::page::part::Part;
use crate::study::page::shots::{Shots, Wanted};

/// The metric by which models are told apart in words.
const METRIC: &str = "flip";

/// What spots are called among models.
pub(crate) const SPOTS: &str = "spots";

/// A family of models: what it leaves out by its construction.
struct Family {
    id: &'static str,
    class: &'static str,
    about: &'static str,
}

/// All families, in the order in which they are told.
const FAMILIES: [Family; 11] = [
    Family {
        id: "point",
        class: "series-0",
        about: "All light comes from the middle: no outline in highlights, too bright beside a large \
                emitter, and edges of light where the middle sets.",
    },
    Family {
        id: "mrp",
        class: "series-1",
        about: "One point stands for the emitter in each term: the highlight keeps the outline. The cosine \
                and the lobe at that point are greater than their means over the emitter, so it is too bright.",
    },
    Family {
        id: "mrp-published",
        class: "series-5",
        about: "The same points with the paper\u{2019}s weights: no specular light where the cone around the \
                mirror direction misses the emitter, and far too much on smooth surfaces.",
    },
    Family {
        id: "ltc",
        class: "series-2",
        about: "The BRDF\u{2019}s lobe is replaced by a transformed cosine, whose integral is exact: no noise, \
                off where the fit is, most at grazing views.",
    },
    Family {
        id: "ltc-hammon",
        class: "series-6",
        about: "The same with a table fitted to an approximation of the BRDF that engines use.",
    },
    Family {
        id: "ltc-unsplit",
        class: "series-8",
        about: "The same without splitting long edges: noise where an edge spans nearly half the sphere.",
    },
    Family {
        id: "ltc-per-light",
        class: "series-2",
        about: "The image of ltc: each light looks the lobe up again.",
    },
    Family {
        id: "ltc-polynomial",
        class: "series-3",
        about: "The same with polynomials for the table: off by their fit, too.",
    },
    Family {
        id: "ltc-polynomial-per-light",
        class: "series-3",
        about: "The image of ltc-polynomial: each light evaluates the polynomials again.",
    },
    Family {
        id: "monte-carlo",
        class: "series-4",
        about: "Right on average, and noisy: highlights on smooth surfaces need the most samples.",
    },
    Family {
        id: "monte-carlo-reflected",
        class: "series-7",
        about: "Specular samples lie where the surface mirrors the emitter: less noise, and specular light \
                from elsewhere is missing.",
    },
];

/// The family of a model: `monte-carlo` of `monte-carlo:16`.
pub(crate) fn family(model: &str) -> &str {
    model.split(':').next().unwrap_or(model)
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

/// A model's name with the dot of its colour.
pub(crate) fn name(model: &str) -> Html {
    dotted(&class(model), model)
}

/// An error against the truth, where it is finite.
fn error(record: &Record, id: &str) -> Option<f64> {
    record.image.truth_errors.get(id).copied().flatten()
}

/// Errors and times of all models, and what each gets wrong.
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
        label: |record| model(record).split(':').nth(1).unwrap_or_default().to_owned(),
        wanted: Wanted::Truth,
        time: "Shade",
        first: FIRST,
        ms: Record::assign_and_shade_ms,
    };
    parts.push(Part::new(
        "model-times",
        "Speed against accuracy: models",
        "The error of shading against the truth image; no light is culled. Left and low is good. Monte \
         Carlo is a curve over its samples; the tip of a point says how many. The staircase joins the models \
         that none beats in both. A point opens its picture beside the truth.",
        plot.html(scene, charts, shots),
    ));
    parts
}

/// What the truth image is.
fn about(truth: &TruthImage) -> String {
    format!(
        "{} area lights at {} x {}, every light at every sample. The truth is integrated on the CPU in {} s, {} \
         shadows, {} bounces; its own standard error is {} % of the mean luminance. All errors are those of \
         the model, none of culling.",
        truth.lights,
        truth.width,
        truth.height,
        significant(truth.seconds),
        if truth.shadows { "with" } else { "without" },
        truth.bounces,
        percent(truth.standard_error)
    )
}

fn errors_table(entries: &[Entry<'_>], truth: &TruthImage) -> Html {
    let mut heads: Vec<Html> = vec!["model".into(), unit("shade", "ms")];
    heads.extend(ERROR_METRICS.iter().map(|metric| Html::from(metric.head)));
    let cells = |of: &dyn Fn(&str) -> Option<f64>| -> Vec<Html> {
        let cell = |id| of(id).map_or_else(|| ABSENT.to_owned(), difference);
        ERROR_METRICS.iter().map(|metric| Html::from(cell(metric.id))).collect()
    };
    let mut rows: Vec<Vec<Html>> = entries
        .iter()
        .map(|Entry { record, .. }| {
            let mut row = vec![name(model(record)), significant(record.times.shade_ms).into()];
            row.extend(cells(&|id| error(record, id)));
            row
        })
        .collect();
    // Every model reads the G-buffer: what its rounding costs is in all rows above.
    if !truth.gbuffer_errors.is_empty() {
        let mut row: Vec<Html> = vec!["the G-buffer alone".into(), ABSENT.into()];
        row.extend(cells(&|id| truth.gbuffer_errors.get(id).copied().flatten()));
        rows.push(row);
    }
    table("Errors of models against the truth", &heads, &rows)
}

/// What each model leaves out, and what that comes to here.
fn words_table(entries: &[Entry<'_>]) -> Html {
    let rows: Vec<Vec<Html>> = entries
        .iter()
        .map(|Entry { record, .. }| {
            let known = FAMILIES.iter().find(|known| known.id == family(model(record)));
            let share = |id| error(record, id).map_or_else(|| ABSENT.to_owned(), percent);
            let measured = format!(
                "{} % too {} in all; {} % of the light lacks where it is too dark; worst tile off by {} % of \
                 the mean",
                error(record, "bias").map_or_else(|| ABSENT.to_owned(), |bias| percent(bias.abs())),
                if error(record, "bias").is_some_and(|bias| bias < 0.0) { "dark" } else { "bright" },
                share("missing_energy"),
                share("tile"),
            );
            vec![
                name(model(record)),
                words(known.map_or("", |known| known.about)),
                words(&measured),
            ]
        })
        .collect();
    let heads = ["model".into(), words("what it leaves out"), words("measured")];
    table("What each model gets wrong", &heads, &rows)
}

/// Which models lie on the frontier of time and error, and the table against its polynomials.
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
                "{} ({} ms, {})",
                model(record),
                significant(record.times.shade_ms),
                difference(*error)
            )
        })
        .collect();
    let mut found = vec![format!(
        "In {scene} no model is both faster and nearer to the truth by FLIP than {}.",
        listed(&on)
    )];
    let of = |wanted: &str| known.iter().find(|(record, _)| model(record) == wanted);
    if let (Some((table, error)), Some((polynomial, other))) = (of("ltc"), of("ltc-polynomial")) {
        found.push(format!(
            "In {scene} polynomials in place of the table take {} times as long, FLIP {} instead of {}.",
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
            let is_sampled = model(entry.record).starts_with("monte-carlo");
            Some((entry.record, error(entry.record, METRIC)?)).filter(|_| !is_sampled)
        });
        let (record, error) = known.min_by(|a, b| a.1.total_cmp(&b.1))?;
        Some(format!(
            "Without noise, {} is nearest to the truth in {scene}: FLIP {} in {} ms.",
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
        let own = FAMILIES.iter().filter(|known| !known.id.ends_with("-per-light"));
        let mut classes: Vec<String> = own.map(|known| class(known.id)).collect();
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
