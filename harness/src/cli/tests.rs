use std::path::PathBuf;

use shading::{Cut, Mode};

use super::*;
use crate::truth_level::TruthLevel;

fn parse_line(line: &str) -> Result<Invocation, CliError> {
    parse(std::iter::once("lightbench").chain(line.split_whitespace()))
}

fn compare(line: &str) -> CompareArgs {
    match parse_line(line) {
        Ok(Invocation::Compare(args)) => args,
        other => panic!("{line}: {other:?}"),
    }
}

fn error_of(line: &str) -> String {
    message(parse_line(line))
}

fn message(parsed: Result<Invocation, CliError>) -> String {
    let error = parsed.expect_err("an error");
    assert_eq!(error.exit_code(), 2);
    let message = error.to_string();
    assert_eq!(message.lines().count(), 1, "{message}");
    message
}

#[test]
fn clap_accepts_the_definition() {
    definition().debug_assert();
}

#[test]
fn without_arguments_compare_runs_with_its_defaults() {
    let args = compare("");
    assert_eq!(args.stage.scene, "atrium");
    assert_eq!(args.strategies.0, ["None", "Sphere", "DC-I", "SC-E/bvh"]);
    assert_eq!((args.stage.scattered(), args.stage.spots, args.stage.seed), (1000, 0.0, 1));
    assert_eq!((args.stage.scene_scale, args.stage.radius_scale), (1.0, None));
    assert_eq!(args.stage.size, Size { width: 640, height: 360 });
    assert_eq!((args.frames, args.warmup), (None, None));
    assert_eq!(args.mode.modes(), [Mode::Deferred]);
    assert_eq!(args.stage.light_box, LightBox::Core);
    assert_eq!(args.out, PathBuf::from("out/compare"));
    assert_eq!((args.truth, args.cut, args.source), (TruthLevel::Full, Cut::Windowed, None));
    assert_eq!((args.stage.camera, args.adapter, args.stage.no_own_lights), (None, None, false));
}

#[test]
fn compare_is_the_default_command() {
    let line = "--scene a.gltf --lights 0 --mode both --camera -1,2,3.5:0,-1,0 --spots 0.5 \
                --size 1x16384 --strategies None,T-I/28x28 --truth none --light-box bounds \
                --no-own-lights --adapter llvm --out x --seed 18446744073709551615";
    let args = compare(line);
    assert_eq!(args, compare(&format!("compare {line}")));
    let pose = CameraPose { eye: [-1.0, 2.0, 3.5], target: [0.0, -1.0, 0.0] };
    assert_eq!(args.stage.camera, Some(Camera::Pose(pose)));
    let on_path = compare("--camera path:3/12").stage.camera;
    assert_eq!(on_path, Some(Camera::OnPath { frame: 3, count: 12 }));
    assert_eq!(args.mode.modes(), [Mode::Deferred, Mode::Forward]);
    assert_eq!(args.truth, TruthLevel::None);
}

#[test]
fn list_takes_strategies_scenes_or_adapters() {
    assert_eq!(parse_line("list strategies"), Ok(Invocation::List(Listing::Strategies)));
    assert_eq!(parse_line("list engines"), Ok(Invocation::List(Listing::Engines)));
    assert_eq!(parse_line("list scenes"), Ok(Invocation::List(Listing::Scenes)));
    assert_eq!(parse_line("list scenarios"), Ok(Invocation::List(Listing::Scenarios)));
    assert_eq!(parse_line("list adapters"), Ok(Invocation::List(Listing::Adapters)));
    assert_eq!(parse_line("list studies"), Ok(Invocation::List(Listing::Studies)));
    assert_eq!(
        error_of("list"),
        "list needs <WHAT>: one of strategies, engines, scenes, scenarios, adapters, studies"
    );
    let unknown = error_of("list lights");
    assert!(
        unknown.ends_with(
            "is lights: it must be one of strategies, engines, scenes, scenarios, adapters, studies"
        ),
        "{unknown}"
    );
}

#[test]
fn an_error_names_the_option_the_value_and_the_range() {
    let counts = "a whole number from";
    for (option, values, accepted) in [
        (
            "--scene-scale",
            &["0", "-1", "1e7", "NaN", "inf", "-inf", "x"][..],
            "a number from 1e-6 to 1e6",
        ),
        ("--radius-scale", &["0", "-0.5", "1e-7", "nan", "x"], "a number from 1e-6 to 1e6"),
        ("--area-model", &["LTC", "disc", "monte-carlo:0"], shading::ACCEPTED_AREA_MODELS),
        (
            "--shadows",
            &["on", "maps", "maps:5,64", "maps:4,64,pcf8", "adaptive:64,3,25", "adaptive:64,4,3"],
            shading::ACCEPTED_SHADOW_MODELS,
        ),
        ("--areas", &["-0.1", "1.01", "NaN", "half"], "a number from 0 to 1"),
        ("--diffuse-share", &["0", "1.01", "NaN"], "a number above 0 and at most 1"),
        ("--replicate", &["0", "65", "1.5"], "a whole number from 1 to 64"),
        ("--spots", &["-0.1", "1.01", "NaN", "half"], "a number from 0 to 1"),
        ("--near", &["0", "-1", "1e7", "NaN", "x"], "a number from 1e-6 to 1e6"),
        (
            "--far",
            &["0", "-1", "2e9", "NaN", "inf", "none"],
            "a number of metres from 1e-6 to 1e9, or infinite",
        ),
        ("--lights", &["-1", "16777217", "1.5", "99999999999999999999"], counts),
        ("--frames", &["0", "100001", "-3", "all"], counts),
        ("--warmup", &["-1", "100001", "x"], counts),
        ("--checks", &["9", "-1", "x"], "a whole number from 0 to 8"),
        ("--laps", &["0", "1001", "-2", "x"], "a whole number from 1 to 1,000"),
        ("--seed", &["-1", "18446744073709551616", "x"], counts),
        (
            "--size",
            &["0x1", "1x0", "16385x1", "640", "640x", "ax1", "-1x5", "1x2x3"],
            "WIDTHxHEIGHT",
        ),
        (
            "--camera",
            &["1,2,3", "1,2:1,2", "0,0,0:0,0,NaN", "1,1,1:1,1,1", "1,2,3,4:0,0,0"],
            "eye and target",
        ),
        ("--strategies", &["None,", ",", "None,None"], "ids separated by commas, each given once"),
        (
            "--mode",
            &["clay", "Deferred"],
            "one of deferred, forward, deferred-ids, forward-no-prepass, both",
        ),
        ("--truth", &["half"], "one of full, none"),
        ("--light-box", &["scene"], "one of core, bounds"),
    ] {
        for value in values {
            for line in [format!("{option} {value}"), format!("compare {option} {value}")] {
                let message = error_of(&line);
                let expected = format!("{option} is {value}: it must be {accepted}");
                assert!(message.starts_with(&expected), "{line}: {message}");
            }
        }
    }
}

#[test]
fn fit_ltc_takes_a_folder_and_a_size() {
    let args = |line| match parse_line(line) {
        Ok(Invocation::FitLtc(args)) => args,
        other => panic!("{line}: {other:?}"),
    };
    assert_eq!(args("fit-ltc"), FitLtcArgs { out: None, size: 64 });
    let out = Some(PathBuf::from("x"));
    assert_eq!(args("fit-ltc --out x --size 1024"), FitLtcArgs { out, size: 1024 });
    for size in ["1", "1025", "-2", "x"] {
        let message = error_of(&format!("fit-ltc --size {size}"));
        let expected = format!("--size is {size}: it must be a whole number from 2 to 1,024");
        assert_eq!(message, expected);
    }
}

#[test]
fn empty_values_are_refused() {
    assert_eq!(message(parse(["lightbench", "--out", ""])), "--out needs a value");
    for option in ["--scene", "--adapter", "--strategies", "--size", "--seed"] {
        let message = message(parse(["lightbench", option, ""]));
        assert!(message.starts_with(&format!("{option} is empty: it must be ")), "{message}");
    }
}

#[test]
fn an_error_names_the_option_whose_value_is_missing() {
    assert!(error_of("--out").starts_with("--out needs a value"));
    assert!(error_of("--mode").starts_with("--mode needs a value: one of deferred"));
}

#[test]
fn unknown_names_get_a_suggestion() {
    assert_eq!(error_of("--light 5"), "there is no option called --light: did you mean --lights?");
    let unknown = "there is no option called --zzzz: `lightbench --help` lists all options";
    assert_eq!(error_of("--zzzz"), unknown);
    assert_eq!(error_of("compar"), "there is no command called compar: did you mean compare?");
    let known = "the known names are compare, explain, advise, study, report, truth, cdi, soak, \
         fit-ltc, list";
    assert_eq!(error_of("zzzz"), format!("there is no command called zzzz: {known}"));
    let needed = "study needs <STUDY>: Study to run: `lightbench list studies` lists them";
    assert_eq!(error_of("study"), needed);
    assert_eq!(
        error_of("report"),
        "report needs <DIR|FILE.json>...: A folder of a comparison or a study, or a file of results"
    );
    assert!(error_of("study comparison --shard 3/2").contains("K from 1 to N"));
    assert_eq!(error_of("--rays 3"), "options of virtual point lights need --vpls N");
}

#[test]
fn an_option_given_twice_or_before_a_command_is_refused() {
    assert_eq!(error_of("--seed 1 --seed 2"), "--seed is given twice: it must be given once");
    let before = "list has no option --seed: `lightbench help list` lists its options";
    assert_eq!(error_of("--seed 1 list scenes"), before);
    let before = error_of("--seed 1 --lights 3 truth --shadows");
    let expected = "options must stand after the command: `lightbench truth --seed --lights ...`";
    assert_eq!(before, expected);
    let before = error_of("--frames 3 study culling");
    assert!(before.starts_with("study has no option --frames"), "{before}");
    assert_eq!(error_of("--path --camera path:0/2"), "--path and --camera cannot be combined");
    let several = error_of("--vpls 64 --lights 3 --spots 0.5");
    assert!(several.contains("--vpls") && several.contains("--lights"), "{several}");
    assert!(!several.contains("after the command"), "{several}");
}

#[test]
fn options_without_effect_are_refused() {
    for (line, option, with) in [
        ("--directions 8x8", "--directions", "--vpls"),
        ("truth --spread squares", "--spread", "--vpls"),
        ("advise --deep-size 32", "--deep-size", "--vpls"),
        ("--oversampling 2", "--oversampling", "--vpls"),
        ("--build fragment", "--build", "--vpls"),
        ("--vpls 0 --ranges random", "--ranges", "--vpls"),
        ("--vpls 0 --vpl-clamp 1", "--vpl-clamp", "--vpls"),
        ("--vpls 64 --ranges random --directions 8x8", "--directions", "--ranges"),
        ("--vpls 64 --ranges infinite --rays 3", "--rays", "--ranges"),
        ("--vpls 64 --ranges random --range-scale 3", "--range-scale", "--ranges"),
        ("--vpls 64 --ranges infinite --correct-rays", "--correct-rays", "--ranges"),
        ("--vpls 64 --random-ranges 0,3", "--random-ranges", "random"),
        ("--vpls 64 --radii equal", "--radii", "scattered"),
        ("truth --primary --light-box bounds", "--light-box", "scattered"),
        ("--outlines polygons", "--outlines", "--areas"),
        ("--areas 0 --diffuse-share 0.5", "--diffuse-share", "--areas"),
        ("--vpls 64 --ranges infinite --keep-ranges 1,2", "--keep-ranges", "infinite"),
        ("--vpls 64 --constant-range 1", "--constant-range", "constant-discard"),
        ("cdi --casts none --compared 0 --rays 3", "--rays", "--compared"),
        ("study culling --speed 2", "--speed", "--motion"),
        ("advise --moved-by gpu", "--moved-by", "--motion"),
    ] {
        let message = error_of(line);
        let expected = format!("{option} has no effect here: it needs ");
        assert!(message.starts_with(&expected) && message.contains(with), "{line}: {message}");
        // Earlier versions accepted such options, and `report` still opens their results.
        let words = std::iter::once("lightbench").chain(line.split_whitespace());
        assert!(parse_stored(words).is_ok(), "{line}");
    }
    for line in [
        "--vpls 64 --directions 8x8 --rays 3 --range-scale 3",
        "--vpls 64 --ranges constant-discard --directions 8x8",
        "--areas 0.5 --outlines polygons --diffuse-share 0.5",
        "--lights 0 --radii equal",
        "--strategies None,T-E --test hs --source both --operations",
        "cdi --directions 8x8 --rays 3",
    ] {
        parse_line(line).unwrap_or_else(|error| panic!("{line}: {error}"));
    }
}

#[test]
fn help_is_a_command_too() {
    for (line, part) in
        [("help", "Examples:"), ("help study", "--shard"), ("help truth", "--shadows")]
    {
        let shown = parse_line(line);
        assert!(
            matches!(&shown, Ok(Invocation::Show(text)) if text.contains(part)),
            "{line}: {shown:?}"
        );
    }
    assert_eq!(error_of("help stdy"), "there is no command called stdy: did you mean study?");
}

#[test]
fn an_error_about_a_value_with_line_breaks_has_one_line() {
    let message = message(parse(["lightbench", "--size", "1\n2"]));
    assert!(message.starts_with("--size is 1\\n2: it must be"), "{message}");
}

#[test]
fn help_has_examples_and_everyday_options() {
    for line in ["--help", "compare --help"] {
        let Ok(Invocation::Show(help)) = parse_line(line) else { panic!("`{line}` shows no help") };
        assert!(help.contains("Examples:") && help.contains("How to read the result:"));
        for option in ["--scene", "--strategies", "--lights", "--size", "--frames", "--out"] {
            assert!(help.contains(option), "the help of `{line}` lacks {option}");
        }
    }
    assert!(
        matches!(parse_line("--version"), Ok(Invocation::Show(text)) if text.contains("lightbench"))
    );
    assert!(matches!(parse_line("list --help"), Ok(Invocation::Show(_))));
}

#[test]
fn every_example_in_the_help_is_accepted() {
    let examples: Vec<_> =
        EXAMPLES.lines().filter_map(|line| line.strip_prefix("  lightbench")).collect();
    assert_eq!(examples.len(), 3);
    for example in examples {
        compare(example);
    }
}

#[test]
fn an_unknown_id_gets_the_nearest_names_or_all() {
    let known = ["None", "DC-I/64x64x24"];
    let near = CliError::unknown("strategy", "dc-i", &known).to_string();
    assert_eq!(near, "there is no strategy called dc-i: did you mean DC-I/64x64x24?");
    let far = CliError::unknown("strategy", "quaternion", &known).to_string();
    assert_eq!(
        far,
        "there is no strategy called quaternion: the known names are None, DC-I/64x64x24"
    );
}
