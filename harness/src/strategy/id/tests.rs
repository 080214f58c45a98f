use super::super::{Role, rows};
use super::*;

fn id(text: &str) -> StrategyId {
    StrategyId::parse(text).unwrap_or_else(|error| panic!("{error}"))
}

#[test]
fn ids_in_any_case_and_order_become_canonical() {
    for (given, canonical) in [
        ("sc-e", "SC-E/48x48x40"),
        ("t-i/BVH/28X28", "T-I/28x28/bvh"),
        ("m", "M"),
        ("M/2.0", "M/2"),
        ("m/0.50/bvh", "M/0.5/bvh"),
        ("HG/32x032x8/CAP8", "HG/32x32x8/cap8"),
        ("T-E/first9/Stochastic0.010", "T-E/28x28/stochastic0.01/first9"),
        ("g/surfaces/8x8x2", "G/8x8x2/surfaces"),
        ("G/positions", "G/20x20x20"),
        ("G/8x8x8/lights", "G/8x8x8/supports"),
        ("G/Supports/bvh", "G/20x20x20/supports/bvh"),
        ("G/bvh/FRUSTUM", "G/20x20x20/frustum/bvh"),
        ("G/visible/4x4x4", "G/4x4x4/visible"),
        ("hc/mask/024", "HC/24/mask"),
        ("sc-e/cap32/bvh", "SC-E/48x48x40/bvh/cap32"),
        ("T-E/cap8/reuse4/linear", "T-E/28x28/reuse4/cap8"),
        ("T-I/outline/bvh/hs+sat-n", "T-I/28x28/bvh"),
        ("g/BALL/surfaces", "G/20x20x20/surfaces/ball"),
        ("SC-E/s0.001/n24", "SC-E/48x48x40/n24/s0.001"),
        ("SC-E/CONE45/n24", "SC-E/48x48x40/n24/cone45"),
        ("SC-E/bvh/REACH2.50", "SC-E/48x48x40/reach2.5/bvh"),
        ("SC-E/dif/bvh/no-exit", "SC-E/48x48x40/dif/bvh/no-exit"),
    ] {
        assert_eq!(id(given).as_str(), canonical, "{given}");
        assert_eq!(id(canonical).as_str(), canonical, "a canonical id stays as it is");
        assert_eq!(StrategyId::read(given), id(canonical), "stored ids are read alike");
    }
}

#[test]
fn parts_of_ids_are_methods() {
    let long = id("SC-E/48x48x40/n24/s0.001/bvh");
    assert_eq!((long.family(), long.size(), long.is_bvh()), ("SC-E", "48x48x40", true));
    assert_eq!(long.knob().as_deref(), Some("s0.001"));
    assert_eq!(id("T-E/bvh/cap16").knob().as_deref(), Some("cap16"));
    assert_eq!(id("T-E/reuse2").knob().as_deref(), Some("reuse2"));
    assert_eq!(id("T-I/sat-n").knob(), None);
    assert_eq!((id("M/bvh").size(), id("M/2/bvh").size()), ("", "2"));
    assert_eq!(id("T-I/hs").tests().map(|tests| tests.to_string()).as_deref(), Some("hs"));
    assert_eq!(id("DC-E").tests(), None);
    assert!(id("SC-E").reads_depth() && !id("T-I").reads_depth());
    assert!(id("G/visible").reads_depth() && !id("G/frustum").reads_depth());
    assert_eq!((id("M/bvh").segment_count(), id("SC-E/bvh/cap8").segment_count()), (1, 2));
}

#[test]
fn the_nearest_lossless_setting_keeps_all_that_loses_no_light() {
    for (given, lossless) in [
        ("SC-E/48x48x40/n6/bvh/first256/cap32", Some("SC-E/48x48x40/n6/bvh")),
        ("DC-I/72x72x16/near5/nearest256", Some("DC-I/72x72x16/near5")),
        ("T-E/28x28/reuse4/no-exit", Some("T-E/28x28/no-exit")),
        ("SC-E/n24/s0.001", Some("SC-E/48x48x40/n24")),
        ("DC-I/stochastic0.01/bvh", Some("DC-I/128x128x64/bvh")),
        ("T-E/28x28/keep4", None),
        ("SC-E", None),
    ] {
        let found = id(given).nearest_lossless();
        assert_eq!(found.as_ref().map(StrategyId::as_str), lossless, "{given}");
    }
    assert!(StrategyId::read("Unknown/7/cap4").nearest_lossless().is_none());
}

#[test]
fn short_names_say_what_differs_from_the_paper() {
    for (given, short, stand_in) in [
        ("M/2/bvh", "M/2", None),
        ("M/bvh", "M", None),
        ("T-E/28x28", "T-E", None),
        ("G/20x20x20/bvh", "G", None),
        ("G/surfaces", "G/surfaces", None),
        ("G/supports/bvh", "G/supports", Some("G over supports")),
        ("T-I/28x28/hs/bvh", "T-I/hs", Some("T-I by HS only")),
        ("T-I/hs+sat-e", "T-I", None),
        ("SC-I/48x48x40/hs", "SC-I", None),
    ] {
        assert_eq!(
            (id(given).short().as_str(), id(given).stand_in()),
            (short, stand_in),
            "{given}"
        );
    }
}

#[test]
fn only_the_comparison_papers_strategies_are_counted_as_its_own() {
    for of_the_paper in
        ["T-I", "T-I/hs", "T-E", "DC-I", "DC-E", "SC-I", "SC-E", "G", "G/supports", "M"]
    {
        assert!(id(of_the_paper).is_of_the_paper(), "{of_the_paper}");
    }
    for other in [
        "None",
        "Clay",
        "Sphere",
        "RasterSphere",
        "HG",
        "M/2",
        "G/surfaces",
        "G/frustum",
        "G/visible",
        "HC",
        "SC-E/bvh",
        "SC-E/n24",
        "SC-E/no-exit",
        "SC-E/ball",
        "SC-E/cap8",
        "T-E/reuse2",
        "T-E/touched",
    ] {
        assert!(!id(other).is_of_the_paper(), "{other}");
    }
    let later = StrategyId::read("SC-E/48x48x40/warp3");
    assert!(!later.is_of_the_paper() && !later.is_runnable(), "what warp3 is, nobody knows");
}

#[test]
fn parameters_have_names() {
    let parameters = id("SC-I/32x16x8/hs").parameters();
    assert_eq!((&parameters["tile_width_px"], &parameters["slices"]), (&32.into(), &8.into()));
    assert_eq!((&parameters["tests"], &parameters["source"]), (&"hs".into(), &"linear".into()));
    assert_eq!(id("SC-E/n24").parameters()["normal_bins"], 24);
    assert_eq!(id("SC-E/ball").parameters()["area_bounds"], "ball");
    assert_eq!(id("G/touched").parameters()["touched"], true);
    for storage in ["mask", "scalar", "prune", "tree"] {
        assert_eq!(id(&format!("T-E/{storage}")).parameters()["storage"], storage);
    }
    assert_eq!(id("HG/raster").parameters()["scatter"], "raster");
    assert_eq!(id("DC-I/cascades3").parameters()["cascades"], 3);
    for invalid in ["SC-E/near0", "SC-E/nearnan", "SC-E/near", "SC-E/cascades1", "SC-E/cascades"] {
        let read = StrategyId::read(invalid).parameters();
        let is_set = |name| read.contains_key(name);
        assert!(!is_set("first_slice_end_m") && !is_set("cascades"), "{invalid}");
    }
    assert_eq!(id("DC-E/near0.5").parameters()["first_slice_end_m"], 0.5);
    assert_eq!(id("SC-E/bvh/even").as_str(), "SC-E/48x48x40/even/bvh");
    assert_eq!(id("M/0.5").parameters()["part_size_m"], 0.5);
}

#[test]
fn what_reads_the_hierarchy_need_not_say_so() {
    for (given, reads) in [("SC-E/bvh", true), ("W1", true), ("SC-E", false), ("W", false)] {
        assert_eq!(id(given).reads_hierarchy(), reads, "{given}");
    }
    assert!(!id("W1").is_bvh());
}

#[test]
fn knobs_make_an_id_lossy() {
    for lossy in ["SC-E/n24/s0.001", "SC-E/n24/cone45", "SC-E/dif", "T-E/reuse2", "T-E/cap8"] {
        assert!(id(lossy).is_lossy(9), "{lossy}");
    }
    for lossless in
        ["SC-E/no-exit", "SC-E/n24", "T-E/reuse1", "T-E/cap9", "T-E/touched", "T-E/mask"]
    {
        assert!(!id(lossless).is_lossy(9), "{lossless}");
    }
}

#[test]
fn ids_of_other_programs_keep_their_text() {
    let other = StrategyId::read("Their-Way/64/bvh/Cap16");
    assert_eq!((other.as_str(), other.family()), ("Their-Way/64/bvh/Cap16", "Their-Way"));
    assert_eq!(
        (other.row().map(|row| row.family), other.class().as_str()),
        (None, "strategy-none")
    );
    assert_eq!((other.size(), other.is_bvh(), other.short().as_str()), ("64", true, "Their-Way"));
    assert_eq!(other.knob().as_deref(), Some("cap16"));
    assert!(!other.is_of_the_paper() && other.role().is_none());
    assert_eq!(other, StrategyId::read("Their-Way/64/bvh/Cap16"));
    // A later version of a known family keeps its colour.
    let later = StrategyId::read("SC-E/48x48x40/warp3/bvh");
    assert_eq!((later.as_str(), later.is_bvh()), ("SC-E/48x48x40/warp3/bvh", true));
    assert_eq!((later.role(), later.class()), (Some(Role::ComparisonPaper), id("SC-E").class()));
    for odd in ["", "/", "//", "None/", "SC-E//x", "T-I/cap", "M/x", "\u{1f4a1}/s", "s/sNaN/n0"] {
        assert_eq!(StrategyId::read(odd).as_str(), odd);
    }
}

#[test]
fn results_store_the_id_with_its_parts_and_older_ones_the_id_alone() {
    let new = id("SC-I/32x16x8/hs/bvh");
    let json = serde_json::to_value(&new).expect("JSON");
    assert_eq!((&json["id"], &json["family"]), (&new.as_str().into(), &"SC-I".into()));
    assert_eq!(json["parameters"]["tile_width_px"], 32);
    for stored in [json, "SC-I/32x16x8/hs/bvh".into(), serde_json::json!({ "id": new.as_str() })] {
        let read: StrategyId = serde_json::from_value(stored).expect("an id");
        assert_eq!((&read, read.options()), (&new, new.options()));
    }
    let other = StrategyId::read("Their-Way/x");
    let json = serde_json::to_string(&other).expect("JSON");
    assert_eq!(serde_json::from_str::<StrategyId>(&json).expect("an id"), other);
}

#[test]
fn stored_parts_that_contradict_the_id_are_errors() {
    let read = |json: Value| serde_json::from_value::<StrategyId>(json);
    for (stored, reason) in [
        (serde_json::json!({ "id": "T-I", "family": "SC-E" }), "strategy.family is \"SC-E\""),
        (serde_json::json!({ "id": 5 }), "strategy.id is 5"),
        (serde_json::json!({ "family": "SC-E" }), "strategy.id is missing"),
        (serde_json::json!({ "id": "T-I", "parameters": [] }), "strategy.parameters is []"),
        (
            serde_json::json!({ "id": "SC-E/48x48x40", "parameters": { "slices": 3 } }),
            "strategy.parameters.slices is 3: it must be 40",
        ),
        (7.into(), "expected as strategy an id such as \"SC-E/48x48x40\""),
    ] {
        let error = read(stored).expect_err(reason).to_string();
        assert!(error.contains(reason), "{error}");
    }
    let rounded = serde_json::json!({ "id": "SC-E/s0.001", "parameters": { "specular_threshold": 0.0010000000474974513 } });
    let id = read(rounded).expect("a rounded number");
    assert_eq!(id.parameters()["specular_threshold"], 0.001);
}

#[test]
fn parameters_that_an_id_does_not_say_survive_a_rewrite() {
    for id in ["Their-Way/64", "SC-E/48x48x40/warp3", "SC-E/48x48x40", "Odd\u{1b}"] {
        let stored = serde_json::json!({ "id": id, "parameters": { "warp": [3, "x"] } });
        let mut read: StrategyId = serde_json::from_value(stored).expect("an id");
        read.show_hidden();
        let written = serde_json::to_value(&read).expect("JSON");
        assert_eq!(written["parameters"]["warp"], serde_json::json!([3, "x"]), "{written}");
    }
}

#[test]
fn an_id_takes_only_options_of_its_family() {
    let refused = |family: &str, change: fn(&mut Options)| {
        id(family).with(change).expect_err("no such axis").to_string()
    };
    assert!(refused("None", |options| options.cap = Some(8)).contains("\"cap8\""));
    let source = refused("HG", |options| options.source = Some(LightSource::Hierarchy));
    assert!(source.contains("\"bvh\""), "{source}");
    assert!(refused("None", |options| options.parameters = "3".into()).contains("\"3\""));
    let later = StrategyId::read("SC-E/48x48x40/warp3");
    assert!(later.with(|options| options.cap = Some(8)).is_err(), "nobody knows what it keeps");
    let capped = id("T-E").with(|options| options.cap = Some(8)).expect("an id");
    assert_eq!((capped.as_str(), capped.is_lossy(9)), ("T-E/28x28/cap8", true));
}

#[test]
fn errors_say_what_an_id_may_be() {
    let error = |id: &str| StrategyId::parse(id).expect_err(id).to_string();
    assert!(error("DCI").contains("DCI"));
    for (id, accepted) in [
        ("None/3", "nothing after a slash"),
        ("DC-E/hs", "linear or bvh"),
        ("DC-E/n6", "linear or bvh"),
        ("DC-E/cap0", "cap32"),
        ("T-I/28x28/16x16", "16x16"),
        ("T-I/28", "tile_width_px x tile_height_px"),
        ("HC/48x48", "cell_px"),
        ("HC/visible", "linear or bvh"),
        ("T-I/axb", "tile_width_px x tile_height_px"),
        ("T-I/surfaces", "hs"),
        ("T-I/", "tile_width_px"),
        ("SC-E/n7", "n54"),
        ("T-E/dif", "cap32"),
    ] {
        assert!(error(id).contains(accepted), "{}", error(id));
    }
}

#[test]
fn contradictions_name_both_segments() {
    for (id, first, second) in [
        ("SC-E/linear/bvh", "linear", "bvh"),
        ("SC-E/dif/s0.1", "dif", "s0.1"),
        ("T-E/hs/no-exit/no-exit", "no-exit", "no-exit"),
        ("T-I/hs/sat-p", "hs", "sat-p"),
        ("SC-E/cap8/cap16", "cap8", "cap16"),
        ("SC-E/bvh/bvh", "bvh", "bvh"),
        ("T-I/28x28/bvh/16x16", "28x28", "16x16"),
        ("SC-E/dif/n6", "dif", "n6"),
        ("SC-E/n6/dif", "dif", "n6"),
        ("SC-E/ball/bvh", "ball", "bvh"),
        ("T-E/touched/cap8", "touched", "cap8"),
        ("SC-E/dif/mask", "mask", "dif"),
        ("SC-E/dif/scalar", "scalar", "dif"),
        ("T-E/scalar/tree", "scalar", "tree"),
        ("T-E/tree/reuse4", "tree", "reuse4"),
        ("G/tree/keep4", "tree", "keep4"),
        ("T-E/tree/touched", "tree", "touched"),
        ("SC-E/keep4/touched", "touched", "keep4"),
    ] {
        let error = StrategyId::parse(id).expect_err(id).to_string();
        let quoted = [first, second].map(|segment| format!("{segment:?}"));
        assert!(quoted.iter().all(|segment| error.contains(segment)), "{id}: {error}");
    }
}

#[test]
fn every_default_id_is_canonical() {
    for row in rows() {
        for overview in row.overview_ids() {
            assert_eq!(id(&overview).as_str(), overview);
        }
        for size in row.sizes.few.iter().chain(row.sizes.many) {
            assert_eq!(id(&row.id_of(size)).size(), *size, "{}", row.family);
        }
    }
}
