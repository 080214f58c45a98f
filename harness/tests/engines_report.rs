//! The page of the engines' defaults, from made-up records.

mod made_study;
mod report_data;

use std::collections::BTreeMap;

use base64::{Engine, engine::general_purpose::STANDARD};
use harness::results::{Mode, PassKind, PassTimes, Passes, Record, Results};
use harness::strategy::engines::ENGINES;
use harness::study::Done;
use made_study::{Written, add, place, write};
use report_data::{empty, record};
use shading::HdrImage;

/// The default of Filament at the size of the made-up records, 640 x 360.
const FILAMENT: &str = "DC-I/24x24x16/near5/nearest256";
const FILAMENT_WHOLE: &str = "DC-I/24x24x16/near5";
/// The default of a tiled renderer that keeps 8 lights per tile.
const TILED: &str = "T-I/32x32/first1024/cap8";
const TILED_WHOLE: &str = "T-I/32x32";
/// A default without a limit.
const UNREAL: &str = "DC-I/64x64x32";
const OURS: &str = "SC-E/48x48x40/bvh";

/// What is changed in a made-up study.
#[derive(Clone, Copy, Default)]
struct Change {
    /// The limit of Filament loses nothing.
    idle: bool,
    /// The whole lists of Filament take as long as its default.
    tie: bool,
    /// Laps; 0 is 6.
    laps: u32,
}

fn made(id: &str, lights: u64, ms: f64, along_path: bool, laps: u32) -> Record {
    let mut made = record(id, Mode::Deferred, 0.0, 0.0);
    made.setting.lights = lights;
    made.times.passes = Passes::default();
    let samples = vec![ms / 2.0; 2 * laps as usize];
    made.times.passes.insert("cull", PassTimes::new(PassKind::Assign, samples.clone()));
    made.times.passes.insert("shade", PassTimes::new(PassKind::Shade, samples));
    (made.times.frames, made.times.rounds) = (2 * laps, laps);
    if along_path {
        (made.setting.along_path, made.setting.poses) = (true, Some(2));
        (made.lists.missed_pairs, made.lists.checked_pairs) = (None, None);
        made.lists.listed_per_sample = None;
        made.image.files = Default::default();
    } else {
        made.image.files.baseline = Some("none.png".into());
        made.image.files.tone_mapped = Some("none.png".into());
        let raw = || Some("none.exr".to_owned());
        (made.image.files.raw, made.image.files.raw_baseline) = (raw(), raw());
        made.image.files.exposure = Some(1.0);
        (made.image.files.difference, made.image.files.heat_map) = (None, None);
    }
    made.lists.assignment_bytes = Some(3 << 20);
    made.set_times();
    made
}

/// A record that lost light.
fn lossy(mut record: Record, missing: f64, share: f64) -> Record {
    record.is_lossy = true;
    if missing == 0.0 {
        return record;
    }
    (record.image.differing_channels, record.image.max_abs_diff) = (Some(77), Some(0.5));
    record.image.errors = [("missing_energy", missing), ("rel_mse", 0.21), ("flip", 0.104)]
        .map(|(id, error)| (id.to_owned(), Some(error)))
        .into();
    if !record.setting.along_path {
        record.lists.missed_pairs =
            record.lists.checked_pairs.map(|pairs| (pairs as f64 * share) as u64);
        record.image.files.tone_mapped = Some("lost.png".into());
        record.image.files.raw = Some("lost.exr".into());
    }
    record
}

fn study(change: Change) -> Done {
    let mut done = made_study::study("engines");
    let laps = if change.laps == 0 { 6 } else { change.laps };
    for lights in [1_000, 10_000] {
        for (section, along_path) in [("path", true), ("view", false)] {
            let made = |id: &str, ms: f64| made(id, lights, ms, along_path, laps);
            let filament = if change.idle { 0.0 } else { 0.125 };
            let whole = if change.tie { 0.25 } else { 0.5 };
            let records = vec![
                made("None", 40.0),
                made(OURS, 0.125),
                lossy(made(FILAMENT, 0.25), filament, 0.25),
                lossy(made(TILED, 0.0625), 0.75, 0.5),
                made(UNREAL, 1.0),
                made(FILAMENT_WHOLE, whole),
                made(TILED_WHOLE, 0.25),
            ];
            add(&mut done, section, &lights.to_string(), Results { records, ..empty() });
        }
    }
    done
}

/// The markup of a part of the page.
fn part<'a>(page: &'a str, id: &str) -> &'a str {
    let start = format!("data-part=\"{id}\"");
    let (_, rest) = page.split_once(&start).unwrap_or_else(|| panic!("the page lacks {id}"));
    rest.split("data-part=").next().unwrap_or_default()
}

/// The row of a table whose name starts so.
fn row<'a>(markup: &'a str, name: &str) -> &'a str {
    let found = markup.split("<tr>").find(|row| row.contains(&format!("</i>{name}")));
    found.unwrap_or_else(|| panic!("no row of {name}")).split("</tr>").next().unwrap_or_default()
}

/// The value of a figure in a row; `None` where it was not measured.
fn figure(row: &str, id: &str) -> Option<f64> {
    let start = format!("data-metric=\"{id}\" data-value=\"");
    let (_, rest) = row.split_once(&start).unwrap_or_else(|| panic!("no {id} in {row}"));
    rest.split('"').next().and_then(|value| value.parse().ok())
}

#[test]
fn a_default_that_loses_light_stands_beside_its_error_and_what_not_losing_costs() {
    let Written { text, page, charts } = write(&study(Change::default()));
    let headline = "On llvmpipe at 10,000 lights, in atrium, 2 of 3 stand-ins for engines\u{2019} defaults lose light \
                    (12.5 to 75.0 % of the energy) and take 2.00 to 4.00 times as long without their limits.";
    assert!(text.contains(headline), "{text}");
    for words in [
        "Filament froxels takes 0.250 ms with 12.5 % missing energy, relMSE 0.210, FLIP 0.104. DC-I/24x24x16/near5 \
         loses nothing and takes 0.500 ms, 2.00 times as long.",
        "In atrium at 1,000 lights, 2 of 3 stand-ins for engines\u{2019} defaults lose light. Filament",
        "Of the methods in the table that lose no light, SC-E/48x48x40/bvh is fastest if no light moves with 0.125 ms.",
        "These are not GPU figures.",
    ] {
        assert!(text.contains(words), "{words}\n{text}");
    }
    let tables = part(&page, "defaults");
    assert_eq!(tables.matches("<table").count(), 2, "one per number of lights");
    let filament = row(tables, "Filament, froxels");
    for (id, value) in [
        ("both_ms", 0.25),
        ("lost", 0.25),
        ("missing_energy", 0.125),
        ("flip", 0.104),
        ("lossless_ms", 0.5),
        ("cost", 2.0),
    ] {
        let found = figure(filament, id).expect("a figure");
        assert!((found - value).abs() < 1e-3, "{id}: {found}");
    }
    assert!(
        filament.contains("near5/<wbr>nearest256</small>") && filament.contains("class=\"fault\""),
        "{filament}"
    );
    let unreal = row(tables, "Unreal Engine 5, light grid");
    assert!(unreal.contains("the default") && figure(unreal, "cost").is_none(), "{unreal}");
    // Lossless settings of defaults have no row. The fastest of all is lossy, so it is not the best.
    let names = tables.matches("<tr><th scope=\"row\">").count();
    assert_eq!(names, 2 * 5, "three defaults, no culling and ours, with both numbers of lights");
    let is_best = |row: &str| row.contains("data-value=\"0.125\" class=\"best\"");
    assert!(is_best(row(tables, "sparse clusters, explicit bounds")), "{tables}");
    assert!(!row(tables, "three.js, TiledLightsNode").contains("class=\"best\""));
    for engine in ENGINES {
        assert!(page.contains(&engine.differs.replace('\'', "&#39;")), "{}", engine.name);
    }
    for chart in ["errors-10000-missing-energy", "memory-1000"] {
        assert!(charts.contains(&format!("atrium-{chart}.svg")), "{chart}: {charts:?}");
    }
}

#[test]
fn ties_idle_limits_and_few_laps_are_said() {
    let tie = write(&study(Change { tie: true, ..Change::default() }));
    assert!(tie.text.contains("takes 0.250 ms, 1.00 times as long: the two tie."), "{}", tie.text);
    assert!(tie.text.contains("without their limits (one is a tie)"), "{}", tie.text);
    assert!(row(part(&tie.page, "defaults"), "Filament, froxels").contains(">tie<"));
    let idle = write(&study(Change { idle: true, ..Change::default() }));
    assert!(
        idle.text.contains("1 of 3 stand-ins for engines\u{2019} defaults loses light"),
        "{}",
        idle.text
    );
    let words = "atrium, 1,000 lights: these defaults have a limit that loses no light here";
    assert!(idle.text.contains(words) && !tie.text.contains(words), "{}", idle.text);
    let few = write(&study(Change { laps: 2, tie: true, ..Change::default() }));
    let words = "2 laps are too few to test ties";
    assert!(few.text.contains(words) && !tie.text.contains(words), "{}", few.text);
    assert!(!few.text.contains("the two tie"), "{}", few.text);
}

#[test]
fn each_default_that_loses_light_has_its_picture_beside_the_truth_and_the_lost_light() {
    let folder = tempfile::tempdir().expect("a folder");
    for (name, level) in [("none", 0.75_f32), ("lost", 0.25)] {
        let image = HdrImage { width: 8, height: 4, pixels: vec![[level; 3]; 32] };
        image.write_exr(&folder.path().join(format!("{name}.exr"))).expect("writes");
        let png = image.to_png(1.0).expect("encodes");
        std::fs::write(folder.path().join(format!("{name}.png")), png).expect("writes");
    }
    let mut done = study(Change::default());
    let names: Vec<String> = done.results.keys().cloned().collect();
    for name in names {
        place(&mut done, name, folder.path());
    }
    let page = write(&done).page;
    let pictures = part(&page, "pictures");
    // Two engines lose light, with both numbers of lights; three pictures each.
    assert_eq!(pictures.matches("<figure>").count(), 12, "{pictures}");
    let all = ["Filament froxels</b>", "No culling</b>", "Lost light</b>"];
    assert!(all.iter().all(|name| pictures.matches(name).count() >= 2), "{pictures}");
    assert!(!pictures.contains("Unreal"), "what loses nothing has no picture");
    // The lost light is 0.75 - 0.25, by the tone curve of the others.
    let lost = HdrImage { width: 8, height: 4, pixels: vec![[0.5; 3]; 32] };
    let lost = STANDARD.encode(lost.to_png(1.0).expect("encodes"));
    assert!(page.contains(&lost), "the picture of the lost light");
}

/// A study that is hardly begun has a page too.
#[test]
fn a_part_of_the_jobs_makes_a_page() {
    let whole = study(Change::default());
    for (kept, has_table) in [("nothing", false), ("path", true), ("view", false), ("1000", true)] {
        let mut done = whole.clone();
        let results: BTreeMap<String, Results> =
            whole.results.clone().into_iter().filter(|(name, _)| name.contains(kept)).collect();
        done.results = results;
        let Written { text, page, .. } = write(&done);
        assert_eq!(
            text.contains("jobs are done; missing"),
            kept != "1000" || done.results.len() < 4
        );
        assert_eq!(page.contains("data-part=\"defaults\""), has_table, "{kept}: {text}");
    }
}
