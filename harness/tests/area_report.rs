//! The page of the study of area lights, from made-up results and images.

mod made_study;
mod report_data;

use std::path::Path;

use harness::results::{Mode, Record, Results, TruthImage};
use harness::study::{Done, complete};
use made_study::{Written, place, study, write};
use report_data::{empty, record};
use shading::HdrImage;

/// Adds a job whose images lie in a folder.
fn add(done: &mut Done, section: &str, variant: &str, results: Results, folder: &Path) {
    let job = made_study::add(done, section, variant, results);
    place(done, job, folder);
}

const WIDTH: u32 = 80;
const HEIGHT: u32 = 48;

fn image(value: impl Fn(u32, u32) -> f32) -> HdrImage {
    let at = |ix: u32| [value(ix % WIDTH, ix / WIDTH); 3];
    HdrImage { width: WIDTH, height: HEIGHT, pixels: (0..WIDTH * HEIGHT).map(at).collect() }
}

fn true_value(x: u32, y: u32) -> f32 {
    0.2 + 0.01 * x as f32 + 0.005 * y as f32
}

fn truth() -> TruthImage {
    TruthImage {
        scene: "atrium".into(),
        scene_hash: "5f0c1b7e9ad24410".into(),
        lights: 3,
        width: WIDTH,
        height: HEIGHT,
        raw: "truth.exr".into(),
        image: "truth.png".into(),
        error_image: "error.png".into(),
        raw_error: Some("error.exr".into()),
        exposure: 1.0,
        standard_error: 0.0004,
        shadows: false,
        bounces: 0,
        is_separated: false,
        is_indirect: false,
        is_matte: false,
        samples: 64,
        sample_seed: Some(1),
        gbuffer_errors: [("rel_mse".to_owned(), Some(3.25e-5))].into(),
        against_errors: Default::default(),
        seconds: 2.5,
    }
}

/// Models with their times, ms, and what their images are.
type Model = (&'static str, f64, fn(u32, u32) -> f32);

const MODELS: [Model; 6] = [
    // A quarter too dark, and nothing in one tile.
    ("point", 1.0, |x, y| match (x / 16, y / 16) {
        (2, 1) => 0.0,
        _ => 0.75 * true_value(x, y),
    }),
    ("mrp", 1.5, |x, y| 1.1 * true_value(x, y)),
    ("ltc", 2.0, |x, y| 1.01 * true_value(x, y)),
    ("ltc-polynomial", 3.0, |x, y| 1.02 * true_value(x, y)),
    ("monte-carlo:1", 4.0, |x, y| true_value(x, y) * if (x + y) % 2 == 0 { 0.5 } else { 1.5 }),
    ("monte-carlo:16", 40.0, |x, y| true_value(x, y) * if (x + y) % 2 == 0 { 0.92 } else { 1.08 }),
];

/// A study of models, its images in a folder.
fn area(folder: &Path) -> Done {
    let mut done = study("area");
    image(true_value).write_exr(&folder.join("truth.exr")).expect("writes");
    add(&mut done, "truth", "", Results { truth_image: Some(truth()), ..empty() }, folder);
    for (model, time, value) in MODELS {
        let file = format!("{}.exr", model.replace(':', "-"));
        image(value).write_exr(&folder.join(&file)).expect("writes");
        let mut record = record("None", Mode::Deferred, 0.0, time);
        record.setting.area_model = Some(model.into());
        record.image.files.raw = Some(file);
        let variant = model.replace(':', "-");
        add(&mut done, "models", &variant, Results { records: vec![record], ..empty() }, folder);
    }
    for lights in [1, 4, 16] {
        for (model, each) in [(None, 0.5), (Some("ltc"), 1.0), (Some("point"), 0.75)] {
            let mut record = record("None", Mode::Deferred, 0.0, each * lights as f64);
            (record.setting.lights, record.setting.area_model) = (lights, model.map(str::to_owned));
            let variant = format!("{lights}-{}", model.unwrap_or("spots"));
            add(&mut done, "cost", &variant, Results { records: vec![record], ..empty() }, folder);
        }
    }
    done
}

fn of<'a>(done: &'a Done, model: &str) -> &'a Record {
    &done.results[&format!("atrium-models-{model}")].records[0]
}

#[test]
fn models_are_held_against_the_truth_and_told_in_tables_charts_and_pictures() {
    let folder = tempfile::tempdir().expect("a folder");
    let mut done = area(folder.path());
    let before = write(&done);
    assert!(!before.page.contains("data-part=\"models\""), "no errors, no table");
    complete(&mut done).expect("images");
    let error = |model: &str, id: &str| of(&done, model).image.truth_errors[id].expect("finite");
    assert!((error("ltc", "bias") - 0.01).abs() < 1e-4 && error("ltc", "missing_energy") == 0.0);
    assert!((error("point", "bias") + 0.25).abs() < 0.1, "{}", error("point", "bias"));
    assert!(error("monte-carlo-1", "rel_mse") > 10.0 * error("monte-carlo-16", "rel_mse"));
    assert!(!of(&done, "ltc").image.errors.contains_key("flip"), "culling errors are left alone");

    let Written { text, page, charts } = write(&done);
    for part in ["models", "model-times", "pictures", "cost"] {
        assert!(page.contains(&format!("data-part=\"{part}\"")), "{part}");
    }
    for chart in ["models-flip", "models-rel-mse", "cost"] {
        let name = format!("atrium-{chart}.svg");
        assert!(charts.contains(&name), "{name} of {charts:?}");
    }
    assert!(page.contains("G-buffer</span> alone"), "what the G-buffer costs has a row");
    assert!(text.contains("without noise, ltc is nearest to the truth in atrium"), "{text}");
    assert!(text.contains("no model beats any of these in both time and FLIP"), "{text}");
    // The polynomials are slower and further off.
    assert!(!text.contains("ltc-polynomial ("), "{text}");
    assert!(text.contains("polynomials instead of the table take 1.5"), "{text}");
    assert!(text.contains("at 16 lights, LTC takes 2."), "{text}");
    // The dark tile is the worst, and cut out.
    assert!(
        page.contains("at 32, 16, with its surroundings: truth on the left, point on the right")
    );
    let panel = page.split("data-part=\"pictures\"").nth(1).expect("pictures");
    // The pictures behind the points of a chart follow in templates.
    let panel = panel.split("<template").next().unwrap_or(panel);
    assert_eq!(panel.matches("data-picture=").count(), MODELS.len() * 4);
    // Pictures are stored once: the truth, and three of each model.
    let uris = page.split("\"uris\":[").nth(1).and_then(|rest| rest.split(']').next());
    assert_eq!(uris.expect("pictures").matches("data:image/png").count(), 1 + MODELS.len() * 3);
    // Spots are those that have no model.
    assert!(page.contains("area : spot") && page.contains("strategy-none\"></i>spots"));
}

#[test]
fn an_image_that_equals_the_truth_has_no_error_and_one_of_another_size_is_named() {
    let folder = tempfile::tempdir().expect("a folder");
    let mut done = area(folder.path());
    image(true_value).write_exr(&folder.path().join("ltc.exr")).expect("writes");
    complete(&mut done).expect("images");
    assert!(of(&done, "ltc").image.truth_errors.values().all(|error| *error == Some(0.0)));
    assert!(of(&done, "mrp").image.truth_errors.values().any(|error| *error > Some(0.0)));
    let small = HdrImage { width: 2, height: 1, pixels: vec![[1.0; 3]; 2] };
    small.write_exr(&folder.path().join("ltc.exr")).expect("writes");
    let error = complete(&mut done).expect_err("refused").to_string();
    assert!(error.contains("ltc.exr") && error.contains("2x1"), "{error}");
    // Without a truth there is nothing to hold models against.
    std::fs::remove_file(folder.path().join("truth.exr")).expect("removes");
    complete(&mut done).expect("nothing to do");
}
