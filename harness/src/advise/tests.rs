use super::*;
use crate::results::{MotionSetting, PassKind, PassTimes};

/// A record whose rounds took these times.
fn record(strategy: &str, times_ms: &[f64], bytes: u64) -> Record {
    let example: Results =
        serde_json::from_str(include_str!("../results/example.json")).expect("the example");
    let mut record = example.records[0].clone();
    record.strategy = strategy.into();
    record.times.passes = Default::default();
    record.times.passes.insert("shade", PassTimes::new(PassKind::Shade, times_ms.to_vec()));
    record.times.frames = times_ms.len() as u32;
    record.times.rounds = record.times.frames;
    record.setting.along_path = false;
    (record.lists.list_bytes, record.lists.assignment_bytes) = (bytes, Some(bytes));
    record.times.light_build_ms = Some(9.7);
    (record.lists.missed_pairs, record.image.max_abs_diff, record.image.differing_channels) =
        (Some(0), Some(0.0), Some(0));
    record.set_times();
    record
}

/// Ten rounds around a time, the same on every run: each method has noise of its own.
fn around(strategy: &str, ms: f64, spread: f64, bytes: u64) -> Record {
    let salt = strategy.bytes().fold(7_u32, |sum, byte| sum.wrapping_mul(31) + u32::from(byte));
    let noise = |round: u32| {
        let hash = (round * 97 + salt).wrapping_mul(2_654_435_761) >> 8;
        f64::from(hash) / f64::from(1 << 24) - 0.5
    };
    let times: Vec<f64> = (0..10).map(|round| ms * (1.0 + spread * noise(round))).collect();
    record(strategy, &times, bytes)
}

/// A capped list that errs.
fn lossy(strategy: &str, ms: f64, spread: f64, rel_mse: f64) -> Record {
    let mut record = around(strategy, ms, spread, 1 << 20);
    record.is_lossy = true;
    record.lists.missed_pairs = Some(802_864);
    record.image.differing_channels = Some(90);
    record.image.max_abs_diff = Some(0.2);
    record.image.errors = [("rel_mse", rel_mse), ("missing_energy", 0.3), ("flip", 0.01)]
        .map(|(id, error)| (id.to_owned(), Some(error)))
        .into();
    record
}

fn results_of(records: Vec<Record>) -> Results {
    let mut results: Results =
        serde_json::from_str(include_str!("../results/example.json")).expect("the example");
    results.records = records;
    results
}

fn named(results: &Results, budget: f64) -> &str {
    verdict(results, budget).expect("a verdict").best.strategy.as_str()
}

#[test]
fn a_method_that_fails_on_purpose_is_never_advised() {
    let sound = || around("T-E/28x28", 2.0, 0.01, 1 << 20);
    let named_beside = |id: &str| {
        let results = results_of(vec![sound(), lossy(id, 1.0, 0.01, 0.0005)]);
        named(&results, 0.001).to_owned()
    };
    assert_eq!(named_beside("T-E/28x28/cap64"), "T-E/28x28/cap64", "a limit within the budget");
    for flawed in ["T-E/28x28/rect", "T-E/28x28/half", "T-E/28x28/unordered/cap64"] {
        assert_eq!(named_beside(flawed), "T-E/28x28", "{flawed}");
    }
}

#[test]
fn the_first_round_has_every_family_that_a_device_can_run() {
    let gpu = Gpu::noop().expect("a device");
    let ids = first_ids(&gpu, 1_000);
    let families: Vec<&str> =
        ids.iter().map(|id| id.split('/').next().expect("a family")).collect();
    for row in rows() {
        // The control shows no lights, and light volumes round in another way.
        let is_out = ["Clay", "RasterSphere"].contains(&row.family);
        // The lanes of a subgroup cull together.
        let needs_subgroups = row.family == "W" && !gpu.has_subgroups();
        assert_eq!(families.contains(&row.family), !is_out && !needs_subgroups, "{}", row.family);
    }
}

#[test]
fn variants_keep_family_and_source() {
    for id in ["T-E/28x28/bvh", "SC-E/48x48x40", "G/20x20x20/bvh", "M/2", "HG/48x48x40"] {
        let id = StrategyId::read(id);
        let all = variants(&id);
        assert!(all.len() >= 4);
        for variant in all {
            assert_eq!(
                (variant.family(), variant.is_bvh()),
                (id.family(), id.is_bvh()),
                "{variant}"
            );
        }
    }
}

#[test]
fn a_lossy_setting_that_gains_nothing_is_never_named() {
    // The least median is that of a capped list, by a per cent that its noise of ten hides.
    let results = results_of(vec![
        around("SC-E/48x48x40", 1.0, 0.1, 1 << 20),
        lossy("SC-E/48x48x40/cap64", 0.99, 0.1, 0.0005),
    ]);
    let fastest = &results.records[1];
    assert!(fastest.assign_and_shade_ms() < results.records[0].assign_and_shade_ms());
    assert_eq!(named(&results, 0.001), "SC-E/48x48x40");
    let text = answer(&results, 0.001);
    assert!(text.contains("No lossy setting within relMSE 0.001 is certainly faster"), "{text}");

    // One that loses nothing in this view may lose light in another.
    let mut harmless = around("SC-E/48x48x40/cap64", 0.99, 0.1, 1 << 10);
    harmless.is_lossy = true;
    let results = results_of(vec![around("SC-E/48x48x40", 1.0, 0.1, 1 << 20), harmless]);
    assert_eq!(named(&results, 0.001), "SC-E/48x48x40");

    // Sure, but by less than anyone wants.
    let results = results_of(vec![
        record("SC-E/48x48x40", &[1.0; 10], 1),
        lossy("SC-E/48x48x40/cap64", 0.997, 0.0, 0.0005),
    ]);
    assert_eq!(named(&results, 0.001), "SC-E/48x48x40");

    // Where no rounds tell, a gain is not shown.
    let mut along = results_of(vec![record("SC-E/48x48x40", &[1.0], 1), {
        let mut lossy = lossy("SC-E/48x48x40/cap64", 0.5, 0.0, 0.0005);
        lossy.times.rounds = 7;
        lossy
    }]);
    assert_eq!(named(&along, 0.001), "SC-E/48x48x40");
    along.records.remove(0);
    assert_eq!(named(&along, 0.001), "SC-E/48x48x40/cap64");
}

#[test]
fn a_lossy_setting_that_gains_is_named_with_its_error_and_only_within_the_budget() {
    let results = results_of(vec![
        around("SC-E/48x48x40", 1.0, 0.02, 1 << 20),
        lossy("SC-E/48x48x40/cap8", 0.5, 0.02, 0.0005),
    ]);
    assert_eq!(named(&results, 0.001), "SC-E/48x48x40/cap8");
    let text = answer(&results, 0.001);
    let first = text.lines().next().expect("a line");
    assert!(first.contains("relMSE 5.0e-4") && first.contains("30.0 % missing energy"), "{first}");
    assert!(!first.contains("bit for bit"), "{first}");
    assert_eq!(named(&results, 0.0001), "SC-E/48x48x40");
    assert!(verdict(&results_of(vec![lossy("DC-I/cap8", 1.0, 0.0, 0.5)]), 0.1).is_none());
}

#[test]
fn among_ties_less_memory_comes_first_and_then_the_simpler() {
    let results = results_of(vec![
        around("SC-E/48x48x40", 1.0, 0.0, 3 << 20),
        around("DC-E/64x64x40", 1.002, 0.0, 2 << 20),
        around("T-E/28x28", 2.0, 0.1, 1 << 10),
    ]);
    assert_eq!(named(&results, 0.0), "DC-E/64x64x40");
    let text = answer(&results, 0.0);
    assert!(text.starts_with("Use DC-E/64x64x40 (dense clusters, explicit bounds): "), "{text}");
    assert!(text.contains("It ties with SC-E/48x48x40"), "{text}");
    assert!(text.contains("needs less memory"), "{text}");
    assert!(text.contains("Next: T-E/28x28"), "{text}");

    // As much memory: tiles are simpler than clusters, a list is simpler than a hierarchy.
    let results = results_of(vec![
        around("SC-E/48x48x40/bvh", 1.0, 0.0, 1 << 20),
        around("SC-E/48x48x40", 1.002, 0.0, 1 << 20),
        around("T-E/28x28", 1.001, 0.0, 1 << 20),
    ]);
    assert_eq!(named(&results, 0.0), "T-E/28x28");
    assert!(answer(&results, 0.0).contains("it is simpler"));
}

#[test]
fn what_ties_with_a_best_chosen_for_memory_does_not_come_next() {
    // The third is surely slower than the first, and ties with the second, which needs less memory.
    let results = results_of(vec![
        record("SC-E/48x48x40", &[1.0; 10], 3 << 20),
        record("DC-E/64x64x40", &[1.004; 10], 2 << 20),
        record("DC-I/64x64x24", &[1.008; 10], 3 << 20),
        record("T-E/28x28", &[2.0; 10], 3 << 20),
    ]);
    assert_eq!(named(&results, 0.0), "DC-E/64x64x40");
    let text = answer(&results, 0.0);
    assert!(text.contains("Next: T-E/28x28"), "{text}");
}

#[test]
fn an_image_that_was_not_compared_is_not_called_the_same() {
    let mut results = results_of(vec![around("SC-E/48x48x40", 1.0, 0.02, 1 << 20)]);
    assert!(answer(&results, 0.0).contains("bit for bit"));
    (results.records[0].image.differing_channels, results.records[0].image.max_abs_diff) =
        (None, None);
    assert!(!answer(&results, 0.0).contains("bit for bit"));
    // Nor one that differs as much as its method states of itself.
    results.records[0].image.differing_channels = Some(9);
    (results.records[0].image.max_abs_diff, results.records[0].image.max_rel_diff) =
        (Some(1e-6), Some(1e-6));
    results.records[0].image.tolerance = Some(1e-3);
    assert!(!answer(&results, 0.0).contains("bit for bit"));
}

#[test]
fn a_built_hierarchy_wins_for_still_lights_only() {
    let results = results_of(vec![
        around("SC-E/48x48x40", 2.0, 0.02, 1 << 20),
        around("SC-E/48x48x40/bvh", 1.0, 0.02, 1 << 20),
    ]);
    let text = answer(&results, 0.0);
    let mut lines = text.lines();
    let first = lines.next().expect("a line");
    assert!(first.starts_with("Use SC-E/48x48x40/bvh"), "{text}");
    assert!(first.contains("Still lights only") && first.contains("in 9.70 ms"), "{first}");
    let second = lines.next().expect("a line");
    assert!(second.starts_with("Without a hierarchy: SC-E/48x48x40, 2.0"), "{second}");
    assert!(second.contains("not measured: --motion"), "{second}");

    let results = results_of(vec![around("SC-E/48x48x40", 2.0, 0.02, 1 << 20)]);
    let text = answer(&results, 0.0);
    assert!(!text.contains("till lights") && !text.contains("ights that move"), "{text}");
}

#[test]
fn lights_that_move_are_measured_and_their_cost_is_on_the_bill() {
    let mut results = results_of(vec![
        around("SC-E/48x48x40", 2.0, 0.02, 1 << 20),
        around("SC-E/48x48x40/bvh", 1.0, 0.02, 1 << 20),
    ]);
    for record in &mut results.records {
        let motion = MotionSetting { law: "drift".into(), speed_m_s: 1.0, moved_by: "cpu".into() };
        (record.setting.motion, record.setting.light_order) = (Some(motion), Some("gpu8".into()));
        (record.times.light_build_ms, record.times.upload_bytes) = (None, Some(1 << 19));
        let living =
            if record.strategy.is_bvh() { &["upload", "order", "boxes"][..] } else { &["upload"] };
        for name in living {
            let times = PassTimes::new(PassKind::Assign, vec![0.25; 10]);
            record.times.passes.insert(*name, times);
        }
        record.set_times();
    }
    let text = answer(&results, 0.0);
    let first = text.lines().next().expect("a line");
    assert!(first.starts_with("Use SC-E/48x48x40/bvh (sparse clusters"), "{text}");
    assert!(first.contains("lights that move (0.750 + 1.0"), "{first}");
    let second = text.lines().nth(1).expect("a line");
    let bill = "The lights move: drift at speed 1, moved by the CPU, sorted every 8 frames. In each frame: \
                upload 0.250 ms, order 0.250 ms, boxes 0.250 ms and shade 1.0";
    assert!(second.starts_with(bill), "{second}");
    assert!(second.ends_with("The CPU uploads 0.500 MiB."), "{second}");
    assert!(!text.contains("till lights") && !text.contains("not measured"), "{text}");
}

#[test]
fn the_last_round_holds_what_the_answer_needs() {
    let mut all: Vec<Record> = ["T-E/28x28", "DC-E/64x64x40", "SC-E/48x48x40"]
        .iter()
        .enumerate()
        .flat_map(|(ix, id)| {
            let ms = 1.0 + 0.1 * ix as f64;
            [around(&format!("{id}/bvh"), ms, 0.0, 1), around(id, 3.0 * ms, 0.0, 1)]
        })
        .collect();
    all.push(around("None", 90.0, 0.0, 1));
    all.push(around("Sphere", 1.5, 0.0, 1));
    let mut other = vec![around("T-E/16x16/bvh", 1.05, 0.0, 1)];
    all.iter_mut().chain(&mut other).for_each(|record| record.lists.longest = 20);
    let (families, parameters) = (results_of(all), results_of(other));
    let exact = last_ids(&families, &parameters, 0.0);
    assert!(exact.contains(&"Sphere".into()) && !exact.contains(&"None".into()));
    let linear = exact.iter().filter(|id| !id.is_bvh() && **id != "Sphere").count();
    assert_eq!(linear, 2, "{exact:?}");
    assert!(exact.iter().all(|id| id.options().cap.is_none()));
    let lossy = last_ids(&families, &parameters, 0.001);
    assert!(lossy.contains(&"T-E/28x28/bvh/cap16".into()), "{lossy:?}");
    assert!(
        !lossy.iter().any(|id| id.options().cap == Some(32)),
        "longer than any list: {lossy:?}"
    );
}

#[test]
fn a_new_row_joins_the_search() {
    let family = crate::strategy::made_up::FAMILY;
    let id = StrategyId::read(family);
    let first = first_ids(&Gpu::noop().expect("a device"), 1_000);
    assert!(first.iter().any(|known| known == id.as_str()), "{first:?}");
    assert_eq!(variants(&id), ["Made-Up/5", "Made-Up/9"]);
}
