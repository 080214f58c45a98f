//! The study of shadow maps: its claims from made-up results, and its quick form as a user runs it.

mod made_study;
mod report_data;

use std::process::Command;

use harness::results::{AdaptiveSetting, DeviceType, Mode, Results, ShadowSetting, TruthImage};
use harness::study::{Done, Settings, write_study};
use made_study::{add, add_with, study, verdict, write};
use report_data::{empty, record};

/// Maps of each light, the side of each, and FLIP against the truth.
type Step = (u32, u32, f64);

const LARGE: [Step; 6] = [
    (1, 2048, 0.08),
    (4, 1170, 0.07),
    (9, 744, 0.06),
    (25, 454, 0.05),
    (81, 256, 0.04),
    (289, 138, 0.06),
];

const SMALL: [Step; 6] = [
    (1, 512, 0.09),
    (4, 292, 0.08),
    (9, 256, 0.07),
    (25, 256, 0.05),
    (81, 64, 0.08),
    (289, 34, 0.1),
];

/// Maps, taps and FLIP of maps of 256 texels.
const FILTERS: [(u32, u32, f64); 4] = [(4, 1, 0.06), (4, 9, 0.05), (25, 1, 0.05), (25, 9, 0.04)];

fn truth() -> TruthImage {
    TruthImage {
        scene: "atrium".into(),
        scene_hash: "5f0c1b7e9ad24410".into(),
        lights: 4,
        width: 640,
        height: 360,
        raw: "truth.exr".into(),
        image: "truth.png".into(),
        error_image: "error.png".into(),
        raw_error: None,
        exposure: 1.0,
        standard_error: 0.001,
        shadows: true,
        bounces: 0,
        is_separated: true,
        is_indirect: false,
        is_matte: false,
        samples: 64,
        sample_seed: Some(1),
        gbuffer_errors: Default::default(),
        against_errors: [("flip", 0.006), ("rel_mse", 0.002)]
            .map(|(id, error)| (id.to_owned(), Some(error)))
            .into(),
        seconds: 1.0,
    }
}

fn image(maps: u32, px: u32, taps: u32, flip: f64) -> Results {
    let mut record = record("None", Mode::Deferred, 0.0, 1.0);
    record.setting.lights = 4;
    let filter = if taps == 1 { String::new() } else { format!(",pcf{taps}") };
    record.setting.shadows = Some(ShadowSetting {
        model: format!("maps:{maps},{px}{filter}"),
        maps_per_area_light: maps,
        maps: 4 * maps,
        faces: 20 * maps,
        atlas_px: [8192, 8192],
        occluder_bytes: None,
        draw_ms: Some(3.25),
        adaptive: None,
        deep: None,
    });
    record.image.truth_errors.insert("flip".into(), Some(flip));
    record.image.truth_errors.insert("rel_mse".into(), Some(10.0 * flip));
    Results { records: vec![record], ..empty() }
}

/// A study in which all claims hold that images decide, but for one FLIP: of an image, by its job's name.
fn made_up(turn: Option<(&str, f64)>) -> Done {
    let mut done = study("shadows");
    let flip = |job: &str, flip: f64| turn.filter(|(name, _)| *name == job).map_or(flip, |t| t.1);
    add(&mut done, "separated", "", Results { truth_image: Some(truth()), ..empty() });
    for (atlas, steps) in [("8192", LARGE), ("2048", SMALL)] {
        for (maps, px, error) in steps {
            let name = format!("{atlas}-{maps}");
            let results = image(maps, px, 1, flip(&name, error));
            add_with(&mut done, "maps", &name, Settings::from([("atlas_px", atlas)]), results);
        }
    }
    for (maps, taps, error) in FILTERS {
        let name = format!("{maps}-pcf{taps}");
        add(&mut done, "taps", &name, image(maps, 256, taps, flip(&name, error)));
    }
    done
}

#[test]
fn claims_follow_the_figures_and_ties_are_ties() {
    let whole = write(&made_up(None)).page;
    for claim in ["turn", "least-8192", "least-2048", "below-256", "filter"] {
        assert_eq!(verdict(&whole, claim), "holds", "{claim}");
    }
    for (claim, turn, expected) in [
        // The most maps are best: no turn in one of two atlases.
        ("turn", ("8192-289", 0.01), "differs"),
        ("least-8192", ("8192-25", 0.02), "fails"),
        // 2 % apart.
        ("least-8192", ("8192-25", 0.0408), "differs"),
        ("least-2048", ("2048-81", 0.02), "fails"),
        ("below-256", ("2048-289", 0.02), "differs"),
        ("below-256", ("2048-289", 0.0801), "differs"),
        ("filter", ("4-pcf9", 0.2), "differs"),
    ] {
        let page = write(&made_up(Some(turn))).page;
        assert_eq!(verdict(&page, claim), expected, "{claim}, {turn:?}");
    }
    // A neighbour is missing.
    let mut part = made_up(None);
    part.results.remove("atrium-maps-8192-289");
    assert_eq!(verdict(&write(&part).page, "least-8192"), "unknown");
    for claim in ["least-lpips", "adaptive", "adaptive-cost", "adaptive-resolution", "time"] {
        assert_eq!(verdict(&whole, claim), "unknown", "{claim}");
    }
    assert!(whole.contains("not decided: times of a software adapter are not those of a GPU"));
}

/// Distance, the name of a model, and the times to test, draw and shade.
type Stop = (f64, &'static str, f64, f64, f64);

/// An approach in which all claims hold: a coarser test is faster, and a test at an eighth lies between 25 and 81 maps.
const STOPS: [Stop; 8] = [
    (8.0, "adaptive:256,1,64", 9.0, 2.0, 1.0),
    (8.0, "adaptive:256,8,64", 3.5, 2.5, 1.0),
    (8.0, "maps:25,256", 0.0, 3.0, 2.0),
    (8.0, "maps:81,256", 0.0, 5.0, 4.0),
    (2.0, "adaptive:256,1,64", 9.0, 4.0, 2.0),
    (2.0, "adaptive:256,8,64", 3.1, 3.5, 2.0),
    (2.0, "maps:25,256", 0.0, 3.0, 2.0),
    (2.0, "maps:81,256", 0.0, 6.0, 4.0),
];

fn approach(stops: &[Stop], adapter: Option<&str>) -> Done {
    let mut done = study("shadows");
    for (ix, (distance, model, banding, draw, shade)) in stops.iter().enumerate() {
        let mut results = image(25, 256, 1, 0.1);
        let record = &mut results.records[0];
        record.times.shade_ms = *shade;
        let shadows = record.setting.shadows.as_mut().expect("maps");
        shadows.model = (*model).into();
        shadows.maps_per_area_light =
            model.parse::<shading::ShadowModel>().expect("a model").maps();
        shadows.draw_ms = Some(*draw);
        shadows.adaptive = (*banding > 0.0).then(|| AdaptiveSetting {
            maps_of_rectangles: vec![4, 31],
            full_rectangles: 0,
            frames: 3,
            banding_ms: Some(*banding),
        });
        if let Some(adapter) = adapter {
            results.machine.device_type = DeviceType::DiscreteGpu;
            results.machine.adapter = adapter.into();
        }
        let settings = Settings::from([("distance_m", distance.to_string().as_str())]);
        add_with(&mut done, "approach", &ix.to_string(), settings, results);
    }
    done
}

#[test]
fn claims_on_subdivision_follow_the_times_along_the_approach() {
    const CLAIMS: [&str; 3] = ["adaptive-cost", "adaptive-resolution", "adaptive"];
    let verdicts = |stops: &[Stop], adapter| {
        let page = write(&approach(stops, adapter)).page;
        CLAIMS.map(|claim| verdict(&page, claim).to_owned())
    };
    let paper = Some("NVIDIA GeForce RTX 3070");
    assert_eq!(verdicts(&STOPS, paper), ["holds", "holds", "holds"]);
    // Absolute times of another GPU decide nothing, and those of a software adapter neither.
    assert_eq!(verdicts(&STOPS, Some("NVIDIA H200")), ["unknown", "holds", "holds"]);
    assert_eq!(verdicts(&STOPS, None), ["unknown"; 3]);
    // A stop is missing.
    assert_eq!(verdicts(&STOPS[..7], paper), ["holds", "holds", "unknown"]);
    let changed = |ix: usize, (banding, draw): (f64, f64)| {
        let mut stops = STOPS;
        (stops[ix].2, stops[ix].3) = (banding, draw);
        verdicts(&stops, paper)
    };
    // The coarse test takes longer at one distance.
    assert_eq!(changed(5, (3.9, 12.0)), ["differs", "differs", "differs"]);
    // 25 maps are slower than a subdivided light.
    assert_eq!(changed(2, (0.0, 12.0)), ["holds", "holds", "differs"]);
    let page = write(&approach(&STOPS, paper)).page;
    assert!(page.contains("data-part=\"approach\""));
    let name = "8.00 m: 4 lights, 4 to 31 maps of 256\u{b2}, adaptive at 1/8";
    assert!(page.contains(name), "the page names the models");
}

#[test]
fn the_page_draws_the_floor_and_names_the_best_maps() {
    let written = write(&made_up(None));
    for part in ["maps", "taps", "table"] {
        assert!(written.page.contains(&format!("data-part=\"{part}\"")), "{part}");
    }
    assert!(written.charts.contains(&"atrium-maps-flip.svg".to_owned()), "{:?}", written.charts);
    let chart = |page: &str| {
        let chart = page.split("data-chart=\"atrium-maps-flip\"").nth(1).expect("a chart");
        chart.split("</figure>").next().unwrap_or_default().to_owned()
    };
    assert!(chart(&written.page).contains("P, exact shares"), "the floor has a name");
    let best = "is least with 81 maps of 256\u{b2} (0.0400) for each light.";
    assert!(written.text.contains(best), "{}", written.text);
    assert!(written.text.contains("have a FLIP of 0.00600 against the truth"), "{}", written.text);
    assert!(written.page.contains("3.25"), "the time to draw maps");
    // Without P there is no line.
    let mut without = made_up(None);
    without.results.remove("atrium-separated-");
    let page = write(&without).page;
    assert!(!chart(&page).contains("P, exact shares") && !page.contains("P, exact shares"));
}

#[test]
fn the_quick_study_compares_every_image_with_its_truth() {
    let folder = tempfile::tempdir().expect("a folder");
    let out = folder.path().join("study");
    let out_text = out.to_str().expect("UTF-8");
    let only = "small-truth,separated,none,maps-1024-1,maps-1024-9,sides-9-64,taps-4,lights-1,\
        adaptive-1-8,approach-0-1-8,approach-2-fixed,rays-1-4x4,rays-maps-1";
    let words = ["study", "shadows", "--quick", "--scene", "town-small", "--size", "32x18"];
    let output = Command::new(env!("CARGO_BIN_EXE_lightbench"))
        .args([&words[..], &["--only", only, "--out", out_text]].concat())
        .output()
        .expect("starts");
    let stderr = String::from_utf8_lossy(&output.stderr);
    assert!(output.status.success(), "{stderr}");
    let done = Done::read(std::slice::from_ref(&out)).expect("a study");
    let mut compared = 0;
    for (job, results) in &done.results {
        for record in &results.records {
            // The approach has no truth.
            let error = record.image.truth_errors.get("flip").copied().flatten();
            assert_eq!(error > Some(0.0), !job.contains("approach"), "{job}: {error:?}");
            let draw_ms = record.setting.shadows.as_ref().map(|shadows| shadows.draw_ms);
            assert_eq!(draw_ms.is_none(), job.ends_with("none"), "{job}");
            assert!(draw_ms.is_none_or(|ms| ms > Some(0.0)), "{job}");
            compared += 1;
        }
    }
    assert!(compared >= 10, "{compared}");
    // The errors of P survive without images.
    let floor = |done: &Done| {
        let truth = done.results["town-small-separated"].truth_image.as_ref().expect("P");
        truth.against_errors["flip"]
    };
    assert!(floor(&done) > Some(0.0));
    let page = std::fs::read_to_string(out.join("index.html")).expect("a page");
    for part in
        ["maps", "sides", "taps", "lights", "adaptive", "table", "approach", "rays", "pictures"]
    {
        assert!(page.contains(&format!("data-part=\"{part}\"")), "{part}");
    }
    assert!(page.contains("P, exact shares"));
    assert!(
        page.contains("with 4 lights, 1 ray through 16 images of 32\u{b2}, and "),
        "rays are named"
    );
    write_study(&done, folder.path()).expect("writes");
}
