//! The report's words and tables, from made-up results.

mod report_data;

use harness::report::{
    TABLE_WIDTH, finding, notices, render_html, render_markdown, render_table, write_html,
};
use harness::results::{
    Clock, DeviceType, Mode, MotionSetting, PassKind, PassTimes, Results, TruthLevel,
};
use report_data::{empty, pictures, record, spoil, typical};

fn of(records: impl IntoIterator<Item = harness::results::Record>) -> Results {
    let mut results = empty();
    results.records.extend(records);
    results
}

fn pair() -> Results {
    of([
        record("None", Mode::Deferred, 0.0, 1_000.0),
        record("DC-I/64x64x24", Mode::Deferred, 12.0, 50.0),
    ])
}

#[test]
fn the_finding_is_computed_from_the_records() {
    let mut results = pair();
    let both = results.records[1].assign_and_shade_ms();
    let speedup = results.records[0].assign_and_shade_ms() / both;
    let expected = format!(
        "On llvmpipe, DC-I/64x64x24 (dense clusters, implicit bounds) shades 1,000 lights {speedup:.1}\u{d7} as fast as no culling \
         and shows the same image, bit for bit."
    );
    assert!((15.0..17.0).contains(&speedup));
    assert_eq!(finding(&results), [expected]);

    spoil(&mut results.records[1]);
    let lossy = &finding(&results)[0];
    assert!(lossy.contains("but misses 1,234 of 3,275,827"), "{lossy}");
    assert!(
        lossy.contains("differs from no culling in 5,678 channels, by at most 0.0313"),
        "{lossy}"
    );
}

/// The same method with lights that the CPU moves, whose order and boxes the GPU makes.
fn moving(strategy: &str) -> harness::results::Record {
    let mut moving = record(strategy, Mode::Deferred, 12.0, 50.0);
    let law = "drift".to_owned();
    moving.setting.motion = Some(MotionSetting { law, speed_m_s: 1.0, moved_by: "cpu".to_owned() });
    moving.setting.light_order = Some("gpu8".to_owned());
    (moving.times.light_build_ms, moving.times.upload_bytes) = (None, Some(3 << 19));
    for (name, ms) in [("upload", 4.0), ("order", 2.0), ("boxes", 1.0)] {
        moving.times.passes.insert(name, PassTimes::new(PassKind::Assign, vec![ms; 8]));
    }
    moving.set_times();
    moving
}

#[test]
fn the_bill_names_every_pass_and_what_is_off_the_clock() {
    let still = of([
        record("None", Mode::Deferred, 0.0, 1_000.0),
        record("SC-E/48x48x40/bvh", Mode::Deferred, 12.0, 50.0),
        record("SC-E/48x48x40", Mode::Deferred, 20.0, 50.0),
    ]);
    let text = render_table(&still);
    let bill: Vec<&str> = text.split("\n\n").nth(1).expect("a second table").lines().collect();
    let columns = |line: &str| line.split_whitespace().map(str::to_owned).collect::<Vec<_>>();
    assert_eq!(columns(bill[0]), ["strategy", "off-clock", "bounds", "cull", "shade"]);
    assert_eq!(columns(bill[2])[..4], ["None", "\u{2013}", "\u{2013}", "\u{2013}"]);
    assert_eq!(columns(bill[3])[..2], ["SC-E/48x48x40/bvh", "0.400"]);
    assert_eq!(columns(bill[4])[..2], ["SC-E/48x48x40", "\u{2013}"], "it needs no hierarchy");
    let page = render_html(&still, &[]);
    let note = "SC-E/48x48x40/bvh</span> <small>build 0.400 ms, off the clock</small></th>";
    assert_eq!(page.matches(note).count(), 1, "in the row of the result table");
    assert_eq!(page.matches("data-metric=\"build_ms\" data-value=\"0.4\"").count(), 1);
    assert!(finding(&still)[0].contains("if no light moves, SC-E"), "{:?}", finding(&still));
    assert!(render_markdown(&still).contains("| off the clock: build ms |"));

    let living = of([record("None", Mode::Deferred, 0.0, 1_000.0), moving("SC-E/48x48x40/bvh")]);
    // A comparison of lights that move and lights that stand still would be none.
    assert_eq!(finding(&living).len(), 2);
    let living = of([moving("T-E/28x28"), moving("SC-E/48x48x40/bvh")]);
    let text = render_table(&living);
    let bill: Vec<&str> = text.split("\n\n").nth(1).expect("a second table").lines().collect();
    let heads = ["strategy", "uploaded", "upload", "order", "boxes", "bounds", "cull", "shade"];
    assert_eq!(columns(bill[0]), heads);
    assert_eq!(columns(bill[2])[1..5], ["1.50", "4.00", "2.00", "1.00"]);
    let page = render_html(&living, &[]);
    assert!(!page.contains("off the clock</small>"));
    for pass in 0..3 {
        assert!(page.contains(&format!("tint pass-living-{pass}")), "the bars have pass {pass}");
    }
    let motion = "lights move: drift at speed 1, moved by the CPU, sorted every 8 frames";
    assert!(page.contains(motion), "the setting says how the lights move");
    let found = &finding(&living)[0];
    assert!(found.contains("(lights move: drift)") && !found.contains("if no light"), "{found}");
    let cost = "upload 4.00 ms (1.50 MiB), order 2.00 ms and boxes 1.00 ms.";
    assert!(found.contains(cost), "{found}");
    let table = render_markdown(&living);
    assert!(table.contains(", upload 4.00, order 2.00, boxes 1.00)"), "{table}");
}

#[test]
fn slower_and_equal_strategies_are_not_called_faster() {
    let slower = of([
        record("None", Mode::Deferred, 0.0, 100.0),
        record("DC-I", Mode::Deferred, 100.0, 100.0),
    ]);
    let text = &finding(&slower)[0];
    assert!(text.contains("as long as no culling") && !text.contains("faster"), "{text}");

    let mut equal = slower.clone();
    equal.records[1].times.assign_ms = 0.0;
    equal.records[1].times.shade_ms = equal.records[0].times.shade_ms * 1.02;
    let text = &finding(&equal)[0];
    assert!(text.contains("takes as long as no culling to shade 1,000 lights"), "{text}");
}

#[test]
fn a_lossless_strategy_wins_over_a_faster_lossy_one_and_over_the_control() {
    let mut results = pair();
    results.records.push(record("Clay", Mode::Deferred, 0.0, 0.1));
    results.records.push(record("Broken", Mode::Deferred, 1.0, 1.0));
    spoil(&mut results.records[3]);
    assert!(
        finding(&results)[0].contains("DC-I/64x64x24 (dense clusters, implicit bounds) shades")
    );
}

/// A copy of a record under another name, `factor` times as slow in every frame.
fn copy(record: &harness::results::Record, name: &str, factor: f64) -> harness::results::Record {
    let mut copy = record.clone();
    copy.strategy = name.into();
    let passes: Vec<_> =
        record.times.passes.iter().map(|(name, times)| (name.to_owned(), times.clone())).collect();
    for (name, mut times) in passes {
        times.samples.iter_mut().for_each(|ms| *ms *= factor);
        copy.times.passes.insert(&name, PassTimes::new(times.kind, times.samples));
    }
    copy.set_times();
    copy
}

#[test]
fn a_tie_has_no_winner_in_headline_terminal_or_page() {
    let mut results = pair();
    results.records.push(copy(&results.records[1], "T-E/28x28", 1.001));
    results.records.push(copy(&results.records[1], "SC-E/48x48x40", 1.5));
    let headline = &finding(&results)[0];
    let tie = "DC-I/64x64x24 and T-E/28x28 tie for fastest: they shade 1,000 lights";
    assert!(headline.contains(tie), "{headline}");
    let names = "and show the same image, bit for bit. DC-I: dense clusters, implicit bounds; T-E: tiles, \
                 explicit bounds.";
    assert!(headline.ends_with(names), "{headline}");
    assert!(
        !headline.contains("DC-I/64x64x24 (dense clusters, implicit bounds) shades"),
        "{headline}"
    );
    assert!(render_table(&results).contains("DC-I/64x64x24 and T-E/28x28 tie: "));
    let page = render_html(&results, &[]);
    let best = page.matches("data-metric=\"both_ms\"").count();
    let marked = page.split("data-metric=\"both_ms\"").skip(1);
    let marked = marked.filter(|cell| cell.split('>').next().unwrap_or("").contains("best"));
    assert_eq!((best, marked.count()), (4, 2), "both of the tie stand out");

    // One that is surely slower leaves a winner.
    results.records[2] = copy(&results.records[1], "T-E/28x28", 1.1);
    assert!(
        finding(&results)[0]
            .contains("DC-I/64x64x24 (dense clusters, implicit bounds) shades 1,000 lights")
    );
}

#[test]
fn a_lead_that_rounds_do_not_show_says_so() {
    let mut results = pair();
    results.records.push(copy(&results.records[1], "T-E/28x28", 3.0));
    for record in &mut results.records {
        record.times.rounds = 3;
    }
    let headline = &finding(&results)[0];
    assert!(headline.contains("3 rounds are too few to rank 2 strategies"), "{headline}");
    for record in &mut results.records {
        record.setting.along_path = true;
        record.times.rounds = 1;
    }
    let headline = &finding(&results)[0];
    assert!(headline.contains("ranked by time only: too few rounds to test ties"), "{headline}");
    results.records.pop();
    assert!(!finding(&results)[0].contains("ranked"), "one method needs no rank");
}

#[test]
fn a_built_hierarchy_leads_for_still_lights_only() {
    let mut results = pair();
    results.records[1].strategy = "SC-E/48x48x40/bvh".into();
    results.records[1].times.light_build_ms = Some(9.7);
    let headline = &finding(&results)[0];
    let limit = "On llvmpipe, if no light moves, SC-E/48x48x40/bvh (";
    assert!(headline.contains(limit), "{headline}");
    assert!(
        headline.contains(
            "is built once, before the first frame, so it is valid only while no \
                           light moves. Building it takes 9.70 ms"
        ),
        "{headline}"
    );
    results.records.push(copy(&results.records[1], "SC-E/48x48x40", 1.0));
    let headline = &finding(&results)[0];
    assert!(headline.contains("(ids with /bvh: only if no light moves)"), "{headline}");
    results.records.remove(1);
    assert!(!finding(&results)[0].contains("still"));
}

#[test]
fn a_lossy_method_states_its_errors_wherever_it_is_shown() {
    let mut results = pair();
    assert!(!render_html(&results, &[]).contains("data-metric=\"flip\""));
    assert!(!render_table(&results).contains("FLIP"));
    assert!(!render_markdown(&results).contains("FLIP"));

    let mut lossy = copy(&results.records[1], "SC-E/48x48x40/cap64", 0.5);
    spoil(&mut lossy);
    lossy.is_lossy = true;
    lossy.image.errors = [("missing_energy", 0.3012), ("rel_mse", 0.21), ("flip", 0.104)]
        .map(|(id, error)| (id.to_owned(), Some(error)))
        .into();
    results.records.push(lossy);
    let page = render_html(&results, &[]);
    for (metric, value, text) in [
        ("missing_energy", "0.3012", "30.1"),
        ("rel_mse", "0.21", "0.210"),
        ("flip", "0.104", "0.104"),
    ] {
        let cell =
            format!("data-metric=\"{metric}\" data-value=\"{value}\" class=\"fault\">{text}<");
        assert!(page.contains(&cell), "{cell}");
    }
    let words = "30.1 % missing energy, relMSE 0.210, FLIP 0.104";
    assert!(notices(&results).iter().any(|notice| notice.contains(words)), "{results:?}");
    let table = render_table(&results);
    let row: Vec<&str> = table
        .lines()
        .filter(|line| line.starts_with("SC-E/48x48x40/cap64"))
        .filter(|line| line.contains("0.104"))
        .flat_map(str::split_whitespace)
        .collect();
    assert_eq!(row, ["SC-E/48x48x40/cap64", "30.1", "0.210", "0.104"], "{table}");
    let markdown = render_markdown(&results);
    assert!(markdown.contains("| FLIP  |") && markdown.contains("| 0.104 |"), "{markdown}");
    // Nothing but a lossy method is left: its errors follow its speed in the headline.
    results.records.remove(1);
    results.records[1].is_lossy = false;
    assert!(finding(&results)[0].contains(words), "{:?}", finding(&results));
}

#[test]
fn odd_runs_still_read_well() {
    assert_eq!(finding(&empty()), ["On llvmpipe, nothing was measured."]);

    let alone = finding(&of([record("None", Mode::Deferred, 0.0, 50.0)]));
    assert!(alone[0].starts_with("On llvmpipe, no culling takes "), "{}", alone[0]);

    let orphan = finding(&of([record("DC-I", Mode::Forward, 10.0, 40.0)]));
    assert!(
        orphan[0].contains(
            "DC-I/128x128x64 (dense clusters, implicit bounds) assigns and shades 1,000 lights in "
        ),
        "{}",
        orphan[0]
    );

    let mut dark = pair();
    for record in &mut dark.records {
        record.setting.lights = 0;
    }
    assert!(finding(&dark)[0].contains("there is no light to assign"));

    let several = finding(&typical());
    assert_eq!(several.len(), 2);
    assert!(
        several[0].starts_with("On llvmpipe, deferred, ") && several[1].contains(", forward, ")
    );
}

#[test]
fn what_was_not_measured_is_not_claimed() {
    let mut results = pair();
    results.records[1].image.differing_channels = None;
    results.records[1].image.max_abs_diff = None;
    assert!(finding(&results)[0].ends_with("as fast as no culling."));
    results.records[1].times.shade_ms = f64::NAN;
    assert!(!finding(&results)[0].contains("NaN"));

    // A record without passes took no time that anyone knows.
    let mut results = pair();
    results.records.remove(0);
    results.records[0].times.passes = Default::default();
    results.records[0].set_times();
    assert!(finding(&results)[0].contains("no time was recorded for DC-I/64x64x24"));
    let mut none = of([record("None", Mode::Deferred, 0.0, 50.0)]);
    none.records[0].times.shade_ms = f64::NAN;
    assert!(finding(&none)[0].contains("no time was recorded for no culling"));
}

#[test]
fn notices_say_what_the_figures_are_not() {
    let mut results = pair();
    assert!(notices(&results)[0].starts_with("These are not GPU figures. llvmpipe is a software"));
    results.machine.device_type = DeviceType::DiscreteGpu;
    assert!(notices(&results)[0].starts_with("Times are wall-clock times of the host"));
    for record in &mut results.records {
        record.times.clock = Clock::GpuTimestamps;
    }
    assert!(notices(&results).is_empty());

    results.truth.level = TruthLevel::None;
    results.warnings.push("a warning".to_owned());
    spoil(&mut results.records[1]);
    let all = notices(&results).join("\n");
    for part in ["1,234 of 3,275,827", "3 of 1,440 groups", "not checked", "a warning", "4 frames"]
    {
        assert!(all.contains(part), "{part}: {all}");
    }
}

#[test]
fn the_terminal_table_is_aligned_and_narrow() {
    let mut results = typical();
    spoil(&mut results.records[4]);
    results.records[1].strategy =
        "a strategy with a name that is far too long for its column".into();
    results.records[2].lists.listed_per_sample = None;
    let text = render_table(&results);
    for line in text.lines() {
        assert!(line.chars().count() <= TABLE_WIDTH, "{line}");
        assert_eq!(line, line.trim_end());
    }
    let rows: Vec<_> = text.lines().take(7).collect();
    assert!(
        rows[0].starts_with("atrium, deferred, 1,000 lights, 640x360, on llvmpipe (wall-clock")
    );
    let width = rows[1].chars().count();
    assert!(rows[2..].iter().filter(|row| row.len() > 60).all(|row| row.chars().count() == width));
    assert!(rows[4].starts_with("a strategy with"), "the long name has its own line: {text}");
    assert!(rows[6].contains('\u{2013}'), "a dash for what was not measured: {text}");
    assert!(text.contains("1,234") && text.contains("0.0313"));
    assert!(render_table(&empty()).lines().count() <= 4);
}

#[test]
fn the_page_holds_everything() {
    let folder = tempfile::tempdir().expect("a temporary folder");
    let results = typical();
    let path = write_html(&results, &pictures(&results), folder.path()).expect("writes");
    assert_eq!(path, folder.path().join("index.html"));
    let page = std::fs::read_to_string(path).expect("reads");
    let uris = page.matches("data:image/png;base64,").count();
    assert_eq!(uris, 3, "equal pictures are stored once");
    for text in ["AMD EPYC 7B13", "9833da8c41f6", "5f0c1b7e9ad24410", "--mode both", "2026-11-22"] {
        assert!(page.contains(text), "{text}");
    }
}

#[test]
fn names_cannot_inject_markup() {
    let mut results = pair();
    results.records[1].strategy = "</script><script>alert(1)</script><b>".into();
    results.records[1].setting.scene = "{{data}} & \"x\"".to_owned();
    let page = render_html(&results, &[]);
    assert!(!page.contains("<script>alert") && !page.contains("{{data}} & \""));
    assert_eq!(page.matches("id=\"data\"").count(), 1);
}
