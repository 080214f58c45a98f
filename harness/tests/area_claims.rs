//! The claims of the engine paper, judged from made-up results: each holds where the figures say so, and
//! does not where they are turned round.

mod made_study;
mod report_data;

use harness::results::{Mode, Record, Results};
use harness::study::{BOUNDS, Done, MODELS};
use made_study::{verdict, write};
use report_data::{empty, record};

fn add(done: &mut Done, section: &str, variant: &str, records: Vec<Record>) {
    made_study::add(done, section, variant, Results { records, ..empty() });
}

/// A model's FLIP, relMSE and bias.
type Errors = (&'static str, f64, f64, f64);

const ERRORS: [Errors; 11] = [
    ("point", 0.06, 0.1, 0.01),
    ("mrp", 0.09, 0.1, 0.1),
    ("mrp-published", 0.2, 0.3, -0.2),
    ("ltc", 0.02, 0.001, 0.001),
    ("ltc-hammon", 0.0201, 0.001, 0.001),
    ("ltc-unsplit", 0.025, 0.001, 0.001),
    ("ltc-polynomial", 0.021, 0.001, 0.001),
    ("monte-carlo:2", 0.05, 0.2, 0.0),
    ("monte-carlo:8", 0.04, 0.1, 0.0),
    ("monte-carlo-reflected:2", 0.0401, 0.1, -0.02),
    ("monte-carlo-reflected:8", 0.04, 0.05, -0.02),
];

/// A model, lights, and the time of its frame and of its shading.
type Cost = (&'static str, u64, f64);

const COSTS: [Cost; 19] = [
    ("spots", 16, 1.0),
    ("spots", 64, 4.0),
    ("ltc", 1, 0.2),
    ("ltc", 16, 2.0),
    ("ltc", 64, 8.0),
    ("ltc-unsplit", 16, 1.95),
    ("ltc-unsplit", 64, 7.8),
    ("mrp-published", 1, 0.1),
    ("mrp-published", 16, 1.4),
    ("mrp-published", 64, 5.2),
    ("ltc-per-light", 1, 0.2),
    ("ltc-per-light", 64, 9.0),
    ("ltc-polynomial-per-light", 1, 0.2),
    ("ltc-polynomial-per-light", 64, 12.0),
    ("monte-carlo-reflected:1", 1, 0.4),
    ("monte-carlo-reflected:1", 16, 3.0),
    ("monte-carlo-reflected:1", 64, 12.0),
    ("monte-carlo-reflected:4", 16, 6.0),
    ("monte-carlo-reflected:4", 64, 30.0),
];

/// A study in which all claims hold that can, but for figures that are multiplied: those of one metric
/// or time of one model, at all counts of lights or at one.
fn study(turn: Option<(&str, &str, f64)>) -> Done {
    let mut done = made_study::study("area");
    let factor = |model: &str, what: &str| match turn {
        Some((turned, kind, factor)) if turned == model && kind == what => factor,
        _ => 1.0,
    };
    for (model, flip, rel_mse, bias) in ERRORS {
        let mut record = record("None", Mode::Deferred, 0.0, 1.0);
        record.setting.area_model = Some(model.into());
        for (metric, error) in [("flip", flip), ("rel_mse", rel_mse), ("bias", bias)] {
            record.image.truth_errors.insert(metric.into(), Some(error * factor(model, metric)));
        }
        add(&mut done, MODELS, &model.replace(':', "-"), vec![record]);
    }
    for (model, lights, time) in COSTS {
        let at = format!("{model}@{lights}");
        let time = time * factor(model, "time") * factor(&at, "time");
        let mut record = record("None", Mode::Deferred, 0.0, time);
        record.times.frame_ms = time;
        record.setting.lights = lights;
        record.setting.area_model = (model != "spots").then(|| model.to_owned());
        add(&mut done, "cost", &format!("{lights}-{}", model.replace(':', "-")), vec![record]);
    }
    let bounds = ["SC-E/48x48x40", "SC-E/48x48x40/ball"].map(|id| {
        let mut record = record(id, Mode::Deferred, 0.1, 1.0);
        let more = if id.ends_with("/ball") { 2.0 } else { 1.0 };
        record.lists.entries = (20_000.0 * more * factor(id, "entries")) as u64;
        record
    });
    add(&mut done, BOUNDS, "200", bounds.into());
    done
}

fn page(done: &Done) -> String {
    write(done).page
}

/// A claim, what is turned round of which model, by which factor, and what the verdict becomes.
type Turn = (&'static str, (&'static str, &'static str, f64), &'static str);

const TURNS: [Turn; 20] = [
    ("balls", ("SC-E/48x48x40/ball", "entries", 0.4), "fails"),
    ("region-noise", ("monte-carlo-reflected:2", "rel_mse", 9.0), "differs"),
    ("more-samples", ("monte-carlo-reflected:8", "flip", 0.8), "fails"),
    ("region-bias", ("monte-carlo-reflected:8", "bias", -1.0), "fails"),
    ("tables", ("ltc-hammon", "flip", 0.9), "fails"),
    ("tables", ("ltc-hammon", "flip", 0.9995 * 0.02 / 0.0201), "differs"),
    ("table-or-polynomial", ("ltc-polynomial-per-light@64", "time", 0.5), "fails"),
    ("table-or-polynomial", ("ltc-polynomial-per-light@1", "time", 2.0), "differs"),
    ("splitting", ("ltc-unsplit", "flip", 0.5), "fails"),
    ("splitting-cost", ("ltc-unsplit", "time", 0.5), "fails"),
    ("least", ("mrp-published", "flip", 0.05), "differs"),
    ("least", ("monte-carlo-reflected:8", "flip", 0.2), "fails"),
    ("least", ("monte-carlo:8", "flip", 0.2), "differs"),
    ("mrp-flip", ("mrp-published", "flip", 0.05), "differs"),
    ("mrp-flip", ("ltc", "flip", 20.0), "fails"),
    ("one-light", ("mrp-published@1", "time", 3.0), "differs"),
    ("mrp-gain", ("mrp-published", "time", 1.6), "fails"),
    ("mrp-gain", ("mrp-published", "time", 1.2), "differs"),
    ("one-sample", ("monte-carlo-reflected:1", "time", 0.2), "fails"),
    ("lights-or-samples", ("monte-carlo-reflected:4@16", "time", 3.0), "fails"),
];

#[test]
fn claims_hold_where_figures_say_so_and_not_where_they_are_turned_round() {
    let whole = page(&study(None));
    for (claim, ..) in TURNS {
        assert_eq!(verdict(&whole, claim), "holds", "{claim}");
    }
    for claim in ["spots", "ratings", "polynomial-fit"] {
        assert_eq!(verdict(&whole, claim), "holds", "{claim}");
    }
    for (claim, turn, expected) in TURNS {
        assert_eq!(verdict(&page(&study(Some(turn))), claim), expected, "{claim}, {turn:?}");
    }
    let dear = page(&study(Some(("ltc", "time", 5.0))));
    assert_eq!(verdict(&dear, "spots"), "fails");
    assert_eq!(verdict(&dear, "ratings"), "differs");
}

#[test]
fn what_is_not_measured_is_said_to_be_so() {
    let whole = page(&study(None));
    for claim in ["lpips", "cpu", "many-samples", "fresnel", "polynomial-image"] {
        assert_eq!(verdict(&whole, claim), "unknown", "{claim}");
    }
    // The derived weights are not the paper's: they do not stand for its MRP.
    let mut derived = study(None);
    derived.results.retain(|job, _| !job.contains("mrp-published"));
    let page = page(&derived);
    for claim in ["mrp-flip", "mrp-gain", "one-light", "one-sample"] {
        assert_eq!(verdict(&page, claim), "unknown", "{claim}");
    }
}
