//! The page of the living frame and its verdicts, from made-up records.

mod made_study;
mod report_data;

use std::collections::BTreeMap;

use harness::results::{
    Mode, MotionSetting, PassKind, PassTimes, Passes, Record, Results, is_raster_pass,
};
use harness::study::Done;
use made_study::{Written, add, write};
use report_data::{empty, record};

const TILES: &str = "T-E/28x28";
const CLUSTERS: &str = "SC-E/48x48x40/bvh";

/// Laps of two poses.
const LAPS: u32 = 6;

/// A record of an id whose lights stand still, or are moved by the CPU or the GPU in an order.
fn made(id: &str, lights: u64, moved: Option<(&str, &str)>, passes: &[(&str, f64)]) -> Record {
    let mut made = record(id, Mode::Deferred, 0.0, 0.0);
    made.setting.lights = lights;
    made.times.passes = Passes::default();
    let living = passes.iter().filter(|(name, _)| match *name {
        "upload" => moved.is_some_and(|(mover, _)| mover == "cpu"),
        "order" | "boxes" => moved.is_some() && id.ends_with("/bvh"),
        _ => true,
    });
    for (name, ms) in living {
        let kind = if *name == "shade" { PassKind::Shade } else { PassKind::Assign };
        assert!(!is_raster_pass(name, Mode::Deferred, &id.into()));
        made.times.passes.insert(*name, PassTimes::new(kind, vec![*ms; 2 * LAPS as usize]));
    }
    (made.times.frames, made.times.rounds) = (2 * LAPS, LAPS);
    (made.setting.along_path, made.setting.poses) = (true, Some(2));
    made.times.light_build_ms = Some(9.7);
    made.lists.assignment_bytes = Some(3 << 20);
    if let Some((mover, order)) = moved {
        let law = "drift".to_owned();
        made.setting.motion =
            Some(MotionSetting { law, speed_m_s: 1.0, moved_by: mover.to_owned() });
        made.setting.light_order = Some(order.to_owned());
        made.times.light_build_ms = None;
        made.times.upload_bytes = (mover == "cpu").then_some(1 << 19);
    }
    made.set_times();
    made
}

/// Tiles and clusters; clusters gain with many lights.
fn pair(lights: u64, moved: Option<(&str, &str)>, order_ms: f64) -> Vec<Record> {
    let (cull, shade) = if lights < 1_000 { (0.01, 0.375) } else { (5.0, 0.5) };
    let own = [("upload", 1.25), ("order", order_ms), ("boxes", 0.0625), ("bounds", 0.03125)];
    let tiles = [&own[..], &[("cull", cull), ("shade", shade)]].concat();
    let clusters = [&own[..], &[("cull", 0.125), ("shade", 0.25)]].concat();
    vec![made(TILES, lights, moved, &tiles), made(CLUSTERS, lights, moved, &clusters)]
}

/// A study; `turned` names the claim that is turned round.
fn study(turned: &str) -> Done {
    let mut done = made_study::study("living");
    let of = |records: Vec<Record>| Results { records, ..empty() };
    let movements = [
        ("still", None),
        ("gpu8", Some(("gpu", "gpu8"))),
        ("gpu", Some(("gpu", "gpu"))),
        ("cpu", Some(("cpu", "gpu8"))),
    ];
    for lights in [100, 1_000] {
        for (name, moved) in movements {
            let records = pair(lights, moved, if name == "gpu" { 0.4 } else { 0.05 });
            add(&mut done, "lights", &format!("{lights}-{name}"), of(records));
        }
    }
    let mut kinds = pair(1_000, Some(("gpu", "gpu8")), 0.05);
    for record in &mut kinds {
        let all = [("point", 334), ("spot", 333), ("polygon", 333)];
        record.setting.light_kinds = all.map(|(kind, count)| (kind.to_owned(), count)).into();
    }
    let mut compared = kinds.clone();
    compared[0].image.differing_channels = Some(if turned == "images" { 7 } else { 0 });
    add(&mut done, "kinds", "1000-gpu8", of(kinds));
    add(&mut done, "images", "kinds", of(compared));
    for (lights, frame) in [(200_000, 4.3), (1_000_000, 9.5), (4_000_000, 32.0)] {
        let order = if turned == "sort" { 0.01 } else { 3.0 };
        let mut records = pair(lights, Some(("gpu", "gpu")), order);
        if turned == "hierarchy" {
            records[0].times.passes = Passes::from_iter([(
                "shade",
                PassTimes::new(PassKind::Shade, vec![0.125; 2 * LAPS as usize]),
            )]);
            records[0].set_times();
        }
        for record in &mut records {
            record.times.frame_ms = if turned == "rate" { 3.0 * frame } else { frame };
        }
        let mut results = of(records);
        results.machine.adapter = "NVIDIA GeForce GTX TITAN X".into();
        add(&mut done, "density", &lights.to_string(), results);
    }
    // Absolute times are judged on the thesis's GPU only.
    for results in done.results.values_mut() {
        results.machine.adapter = "NVIDIA GeForce GTX TITAN X".into();
    }
    done
}

fn verdict<'a>(page: &'a str, claim: &str) -> &'a str {
    made_study::verdict(page, &format!("volume-tiles-{claim}"))
}

#[test]
fn every_claim_holds_where_the_figures_say_so_and_fails_turned_round() {
    let Written { text, page: holds, .. } = write(&study(""));
    for claim in ["hierarchy", "sort", "rate"] {
        assert_eq!(verdict(&holds, claim), "holds", "{claim}: {text}");
        let Written { text, page: fails, .. } = write(&study(claim));
        assert_eq!(verdict(&fails, claim), "fails", "{claim}, turned round: {text}");
    }
    let mut elsewhere = study("");
    for results in elsewhere.results.values_mut() {
        results.machine.adapter = "NVIDIA H200".into();
    }
    assert_eq!(verdict(&write(&elsewhere).page, "rate"), "unknown", "another GPU decides nothing");
    assert_eq!(verdict(&write(&elsewhere).page, "sort"), "holds");
}

/// The markup of a part of the page.
fn part<'a>(page: &'a str, id: &str) -> &'a str {
    let start = format!("data-part=\"{id}\"");
    let (_, rest) = page.split_once(&start).unwrap_or_else(|| panic!("the page lacks {id}"));
    rest.split("data-part=").next().unwrap_or_default()
}

/// The headings of the first table of some markup, without their units.
fn heads(markup: &str) -> Vec<&str> {
    let table = markup.split("<thead>").nth(1).expect("a table");
    let table = table.split("</thead>").next().unwrap_or_default();
    table
        .split("<th scope=\"col\"")
        .skip(1)
        .filter_map(|cell| cell.split_once('>')?.1.split(['<', '\u{a0}']).next())
        .map(str::trim)
        .collect()
}

#[test]
fn the_bill_stands_beside_still_lights_and_says_what_is_off_the_clock() {
    let Written { text, page, charts } = write(&study(""));
    // The fastest at the most lights, what moving costs, and what stands still.
    for words in [
        "at 1,000 lights, in atrium, SC-E/48x48x40/bvh is fastest (lights move: drift) with 0.519 ms; still \
         lights take 0.406 ms. SC-E means \u{201c}sparse clusters, explicit bounds\u{201d}.",
        "In atrium at 1,000 lights (lights move: drift), SC-E/48x48x40/bvh is fastest with 0.519 ms (2 poses). \
         That costs it in each frame: order 0.0500 ms and boxes 0.0625 ms. Still lights take 21.7 % less: \
         SC-E/48x48x40/bvh 0.406 ms, with a hierarchy that the CPU built in 9.70 ms off the clock. Sorted in \
         every frame: SC-E/48x48x40/bvh 0.869 ms. Moved by the CPU: SC-E/48x48x40/bvh 1.77 ms.",
    ] {
        assert!(text.contains(words), "{words}\n{text}");
    }
    // Tiles read the plain list, so they need no order.
    let few = "In atrium at 100 lights (lights move: drift), T-E/28x28 is fastest with 0.416 ms (2 poses). It \
               reads the plain list, so moving lights cost it nothing.";
    assert!(text.contains(few), "{text}");
    let bill = part(&page, "bill");
    let expected = [
        "strategy",
        "assign + shade",
        "off the clock: build",
        "uploaded",
        "upload",
        "order",
        "boxes",
        "bounds",
        "cull",
        "shade",
        "memory",
    ];
    assert_eq!(heads(bill), expected);
    for words in ["SC-E/48x48x40/bvh, moved by CPU", "T-E/28x28, still"] {
        assert!(bill.contains(words), "{words}");
    }
    for pass in 0..3 {
        assert!(bill.contains(&format!("pass-living-{pass}")), "the bars have pass {pass}");
    }
    for id in ["times", "memory", "kinds", "images"] {
        assert!(part(&page, id).contains("SC-E/"), "{id}");
    }
    assert!(part(&page, "kinds").contains("334 point"), "the kinds of lights");
    let thesis = part(&page, "density");
    assert_eq!(thesis.matches("Van Oosten 2017, GTX TITAN X</th>").count(), 3);
    for chart in ["fastest", "times-sc-e-48x48x40-bvh", "bill-1000", "memory", "kinds"] {
        let name = format!("atrium-{chart}.svg");
        assert!(charts.contains(&name), "{name}: {charts:?}");
    }
    let faults = |page: &str| part(page, "images").matches("class=\"fault\"").count();
    assert_eq!((faults(&page), faults(&write(&study("images")).page)), (0, 1));
}

/// A study that is hardly begun has a page too.
#[test]
fn a_part_of_the_jobs_makes_a_page() {
    let whole = study("");
    for kept in [vec![], vec!["still"], vec!["gpu8"], vec!["density"], vec!["images"]] {
        let is_kept = |name: &String| kept.iter().any(|word| name.contains(word));
        let results: BTreeMap<String, Results> =
            whole.results.clone().into_iter().filter(|(name, _)| is_kept(name)).collect();
        let mut done = whole.clone();
        done.results = results;
        let text = write(&done).text;
        assert!(text.contains("jobs are done; missing"), "{kept:?}: {text}");
    }
}
