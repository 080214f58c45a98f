//! `lightbench explain`, and the pixels that `compare` names.

use std::{
    path::Path,
    process::{Command, Output},
};

use assign::conformance::faulty::{Fault, Faulty};
use harness::{
    bench::Bench,
    choice::Choice,
    cli::{ExplainArgs, Invocation, Pixel, parse},
    explain::{Asked, Explanation, explain_methods, set_stage, text_of},
    measure::{Contest, Plan},
    moving::lights_by_slot,
    results::Results,
    strategy::Method,
};
use serde_json::Value;
use shading::{Cut, LightBvh, ListCheck};

/// What every test draws: few triangles, few pixels.
const SMALL: [&str; 6] = ["--scene", "town-small", "--size", "64x36", "--lights", "300"];

fn lightbench(arguments: &[&str]) -> Output {
    let mut program = Command::new(env!("CARGO_BIN_EXE_lightbench"));
    program.env_remove("XDG_RUNTIME_DIR").args(arguments).output().expect("starts")
}

/// What `explain` prints; it must fit the terminal.
fn explained(arguments: &[&str]) -> String {
    let output = lightbench(&[&["explain"], &SMALL[..], arguments].concat());
    let text = String::from_utf8(output.stdout).expect("UTF-8");
    assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
    let long = text.lines().find(|line| line.chars().count() > 100);
    assert_eq!(long, None, "{text}");
    text
}

fn args_of(arguments: &[&str]) -> ExplainArgs {
    let words = [&["lightbench", "explain"], &SMALL[..], arguments].concat();
    match parse(words) {
        Ok(Invocation::Explain(args)) => args,
        other => panic!("{other:?}"),
    }
}

/// A strategy with a fault in it, or without.
fn method_of(bench: &Bench, id: &str, fault: Option<Fault>) -> Method {
    let method = Choice::parse(id).expect("an id").make(bench.gpu()).expect("made");
    let Method::Lists { mut strategy, early_exit, stochastic, is_random } = method else {
        panic!("{id}")
    };
    if let Some(fault) = fault {
        strategy = Box::new(Faulty::new(bench.gpu(), strategy, fault).expect("planted"));
    }
    Method::Lists { strategy, early_exit, stochastic, is_random }
}

/// The explanation of a pixel for a strategy.
fn explain_one(bench: &mut Bench, id: &str, fault: Option<Fault>, pixel: [u32; 2]) -> Explanation {
    let method = method_of(bench, id, fault);
    let mut args = args_of(&["--pixel", "0,0"]);
    args.pixel = Pixel { x: pixel[0], y: pixel[1] };
    let gpu = bench.gpu().clone();
    let stage = set_stage(bench, &args).expect("a stage");
    let asked = Asked { id: id.into(), is_lossy: false, remembers: false, method };
    explain_methods(&gpu, stage, &args, vec![asked]).expect("explained")
}

#[test]
fn a_planted_fault_names_the_missed_light() {
    let mut bench = Bench::open(None).expect("an adapter");
    let gpu = bench.gpu().clone();
    let args = args_of(&["--pixel", "0,0"]);
    for (id, fault) in [("T-I/16x16", Fault::DroppedLight), ("SC-E/16x16x8", Fault::ShrunkenBound)]
    {
        // The check of lists finds a pair that the faulty strategy misses.
        let mut methods = [method_of(&bench, id, Some(fault))];
        let stage = set_stage(&mut bench, &args).expect("a stage");
        let lights = lights_by_slot(&gpu, &stage.lights).expect("lights");
        let plan = Plan {
            warmup: 0,
            timed: 1,
            laps: 0,
            checks: 1,
            seed: 1,
            cut: Cut::Windowed,
            operations: false,
            is_temporal: false,
        };
        let mut contest = Contest::new(&gpu, stage, &mut methods, args.mode, plan).expect("made");
        let bvh = LightBvh::new(&lights);
        let checked = contest.check(stage, 0, Some(&mut ListCheck::new(&bvh))).expect("checked");
        let missed = checked.lists.and_then(|lists| lists.first_missed).expect("a missed pair");
        let light = missed.light.expect("a light");

        let explanation = explain_one(&mut bench, id, Some(fault), missed.pixel);
        let seen = &explanation.strategies[1];
        let list = seen.list.as_ref().expect("a list");
        assert_eq!(list.lights[0].light, light, "{id}: {list:?}");
        assert!(list.lights[0].is_missed && !list.lights[0].is_listed && list.missed > 0);
        assert_eq!(list.lights[0].given, missed.given);
        let text = text_of(&explanation, false);
        let row = text.lines().find(|line| line.ends_with("  MISSED")).expect("a row");
        assert_eq!(row.split_whitespace().next(), Some(light.to_string().as_str()), "{text}");
        assert!(text.contains("\n  MISSED     "), "{text}");
        // The missed lights are what the pixel lacks.
        let [none, with] = [&explanation.strategies[0], seen].map(|seen| seen.radiance);
        let lacks: Vec<f32> = (0..3)
            .map(|c| list.lights.iter().filter(|l| l.is_missed).map(|l| l.radiance[c]).sum())
            .collect();
        for c in 0..3 {
            assert!((none[c] - with[c] - lacks[c]).abs() <= 1e-5 * none[c], "{id}: {text}");
        }

        // Without the fault nothing is missed, and the listed lights sum up to the pixel.
        let sound = explain_one(&mut bench, id, None, missed.pixel);
        let seen = &sound.strategies[1];
        let list = seen.list.as_ref().expect("a list");
        assert!(list.missed == 0 && !text_of(&sound, true).contains("MISSED"), "{id}: {list:?}");
        assert!(list.lights.iter().any(|l| l.light == light && l.is_listed && l.reaches), "{id}");
        assert_eq!(list.reaching, sound.sample.as_ref().expect("a surface").reached_by);
        assert!(seen.difference.expect("compared").is_same, "{id}");
        for c in 0..3 {
            let sum: f32 = list.lights.iter().map(|light| light.radiance[c]).sum();
            assert!(
                (sum - seen.radiance[c]).abs() <= 1e-5 * sum,
                "{id}: {sum} {:?}",
                seen.radiance
            );
        }
    }
}

#[test]
fn every_strategy_is_explained() {
    let text = explained(&["--pixel", "30,30", "--strategies", "all", "--spots", "0.3"]);
    assert!(!text.contains("MISSED"), "{text}");
    let same = text.matches("the same as without culling, in every bit").count();
    // None is the reference, Clay shows no light, and light volumes round in their own way.
    let strategies = harness::strategy::rows().count();
    assert!(same + 3 >= strategies, "{same} of {strategies}: {text}");
    assert!(text.contains("\n  bounds     box from ("), "{text}");
    assert!(text.contains(": tile ("), "{text}");
    assert!(text.contains("\n  and group  "), "a strategy intersects two groups: {text}");
    assert_eq!(text.matches("it has none: no list decides").count(), 2, "{text}");
}

#[test]
fn json_holds_every_light_and_an_overflow_is_named() {
    let text = explained(&["--pixel", "30,30", "--strategies", "T-I/16x16", "--json"]);
    let read: Value = serde_json::from_str(&text).expect("JSON");
    let tiles = &read["strategies"][1];
    assert_eq!((&tiles["strategy"], &read["pixel"]), (&"T-I/16x16".into(), &[30, 30].into()));
    let list = &tiles["list"];
    let lights = list["lights"].as_array().expect("lights").len() as u64;
    assert!(lights > 3 && list["listed"] == lights, "{list}");
    assert_eq!(tiles["groups"][0]["overflowed"], false);
    assert_eq!(tiles["groups"][0]["bounds"]["low_px"], serde_json::json!([16.0, 16.0]));

    let mut bench = Bench::open(None).expect("an adapter");
    let starved = explain_one(&mut bench, "T-I/16x16", Some(Fault::StarvedPool), [30, 30]);
    assert!(starved.strategies[1].groups[0].overflowed);
    assert_eq!(starved.strategies[1].list.as_ref().expect("a list").listed, 300);
    assert!(text_of(&starved, false).contains("OVERFLOW: "));
}

#[test]
fn a_frame_of_a_path_or_of_a_motion_is_explained() {
    let path = ["--path", "--frames", "3", "--frame", "2", "--strategies", "G/4x4x4/reuse4"];
    let text = explained(&[&["--pixel", "30,30"], &path[..]].concat());
    assert!(
        text.starts_with("Pixel 30,30 of 64x36, deferred, frame 2 of 3 of the path: "),
        "{text}"
    );
    assert!(text.contains("in every bit") && !text.contains("MISSED"), "{text}");
    let still = explained(&["--pixel", "30,30", "--strategies", "None"]);
    let position =
        |text: &str| text.lines().find(|line| line.contains("in the world")).map(str::to_owned);
    assert!(position(&still).is_some() && position(&still) != position(&text), "another view");
    for mover in ["cpu", "gpu"] {
        let moved = ["--motion", "drift", "--moved-by", mover, "--frame", "3", "--mode", "forward"];
        let text = explained(&[&["--pixel", "30,30", "--strategies", "W1"], &moved[..]].concat());
        assert!(text.contains("in every bit") && text.contains(", forward, frame 3: "), "{text}");
        // The CPU knows the lights that it moved, whoever ordered them.
        let is_unknown = text.lines().any(|line| line.split_whitespace().nth(1) == Some("?"));
        assert_eq!(is_unknown, mover == "gpu", "{text}");
    }
}

#[test]
fn what_cannot_be_explained_is_said_clearly() {
    let sky = explained(&["--pixel", "5,0", "--strategies", "None,T-E"]);
    assert!(sky.contains("This pixel shows no opaque surface (sky)"), "{sky}");
    for (arguments, expected) in [
        (
            &["--pixel", "64,3"][..],
            "--pixel is 64,3: it must be inside the image of 64x36 pixels: X from 0 to 63",
        ),
        (&["--pixel", "1"], "--pixel is 1: it must be X,Y"),
        (&[], "explain needs --pixel X,Y"),
        (&["--pixel", "1,1", "--strategies", "X-I"], "there is no strategy called X-I"),
        (
            &["--pixel", "1,1", "--frame", "2"],
            "--frame has no effect here: it needs --path or --motion",
        ),
        (&["--pixel", "1,1", "--frames", "2"], "--frames has no effect here: it needs --path"),
        (
            &["--pixel", "1,1", "--path", "--frames", "2", "--frame", "2"],
            "--frame is 2: it must be 0 to 1",
        ),
        (
            &["--pixel", "1,1", "--strategies", "RasterSphere", "--mode", "forward"],
            "--mode is forward: it must be another one for RasterSphere",
        ),
    ] {
        let output = lightbench(&[&["explain"], &SMALL[..], arguments].concat());
        let error = String::from_utf8_lossy(&output.stderr).into_owned();
        assert_eq!(output.status.code(), Some(2), "{arguments:?}: {error}");
        let last = error.lines().last().unwrap_or_default();
        assert!(last.starts_with(&format!("lightbench: {expected}")), "{arguments:?}: {error}");
    }
}

/// The command in backticks of a comparison's output, on one line.
fn command_in(output: &str) -> Vec<String> {
    let words = output.split_whitespace().collect::<Vec<_>>().join(" ");
    let (_, command) = words.split_once("Why: `").expect("a command");
    let (command, _) = command.split_once('`').expect("an end");
    command.split(' ').skip(1).map(str::to_owned).collect()
}

#[test]
fn compare_names_a_pixel_that_explain_shows_to_be_wrong() {
    let folder = tempfile::tempdir().expect("a folder");
    let compare = |arguments: &[&str]| -> (Results, String) {
        let out = folder.path().to_str().expect("UTF-8");
        let fast = ["--warmup", "0", "--pictures", "none", "--out", out];
        let output = lightbench(&[&["compare"], &SMALL[..], &fast, arguments].concat());
        assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
        let results = Results::read(&Path::new(out).join("results.json")).expect("results");
        (results, String::from_utf8_lossy(&output.stdout).into_owned())
    };
    let capped = "T-I/16x16/cap2";
    let (results, output) = compare(&["--frames", "1", "--strategies", &format!("None,{capped}")]);
    let [none, record] = &results.records[..] else { panic!("two records") };
    assert_eq!((none.lists.first_missed, none.image.worst_pixel), (None, None));
    let missed = record.lists.first_missed.expect("a missed pair");
    let worst = record.image.worst_pixel.expect("a worst pixel");
    assert_eq!((worst.frame, worst.rel_diff), (None, record.image.max_rel_diff));
    let command = command_in(&output);
    let words: Vec<&str> = command.iter().map(String::as_str).collect();
    let [x, y] = missed.pixel;
    assert_eq!(words.last(), Some(&format!("{x},{y}").as_str()), "{words:?}");
    let explained = lightbench(&words);
    let text = String::from_utf8_lossy(&explained.stdout);
    let given = missed.given.expect("the CPU ordered the lights").to_string();
    let names =
        |line: &str| line.ends_with("  MISSED") && line.split_whitespace().nth(1) == Some(&given);
    assert!(text.lines().any(names), "light {given}: {text}");
    assert!(text.contains("(it loses light on purpose)"), "{text}");

    // Along a path, the frame is named and reproduced.
    let path = ["--path", "--frames", "4", "--strategies", "G/4x4x4/cap1", "--truth", "none"];
    let (results, output) = compare(&path);
    let worst = results.records[0].image.worst_pixel.expect("a worst pixel");
    let command = command_in(&output);
    let words: Vec<&str> = command.iter().map(String::as_str).chain(["--json"]).collect();
    let explained = lightbench(&words);
    let read: Value = serde_json::from_slice(&explained.stdout).expect("JSON");
    assert_eq!(
        (&read["frame"], &read["pixel"]),
        (&worst.frame.into(), &worst.pixel.to_vec().into())
    );
    let relative = read["strategies"][1]["difference"]["relative"].as_f64();
    assert_eq!(relative, worst.rel_diff, "{words:?}");
}
