//! The verdicts of the culling survey, from made-up records.

mod made_study;
mod report_data;

use harness::results::{Mode, PassKind, PassTimes, Passes, Record, Results};
use harness::study::Done;
use made_study::{Written, add, write};
use report_data::{empty, record};

const CAPPED: &str = "DC-I/40x40x24/cap128";
const WHOLE: &str = "DC-I/40x40x24";

/// The survey's claims, all but that of tiles, which lists without a loss contradict.
const CLAIMS: [&str; 11] = [
    "linear", "clay", "slowest", "gain", "sphere", "raster", "deferred", "clusters", "rate", "cap",
    "range",
];

/// A frame of a method, ms: as the survey has it, but for the claim that is turned round.
fn frame_ms(turned: &str, mode: Mode, strategy: &str, lights: u64) -> f64 {
    let (offset, slope) = match (strategy, turned) {
        ("Clay", "clay") => (100.0, 0.0),
        ("Clay", _) => return 1.0,
        ("None", _) => (2.0, 0.020),
        ("Sphere", "slowest" | "gain") => (2.0, 0.030),
        ("Sphere", "sphere") => (2.0, 0.018),
        ("Sphere", _) => (2.0, 0.010),
        ("RasterSphere", "raster") => (2.0, 0.005),
        ("RasterSphere", "gain") => (2.0, 0.030),
        ("RasterSphere", _) => (2.0, 0.012),
        (CAPPED, "gain" | "clusters") => (2.0, 0.030),
        (CAPPED, "rate") => (30.0, 0.0005),
        (CAPPED, _) => (2.0, 0.0025),
        _ => (2.0, 0.0005),
    };
    let bend = if turned == "linear" && lights == 750 { 9.0 } else { 0.0 };
    let factor = match (mode, turned) {
        (Mode::Forward, "deferred") => 0.5,
        (Mode::Forward, _) => 1.3,
        _ => 1.0,
    };
    factor * (offset + slope * lights as f64 + bend)
}

fn made(turned: &str, mode: Mode, strategy: &str, lights: u64) -> Record {
    let mut made = record(strategy, mode, 0.0, 1.0);
    made.setting.lights = lights;
    made.times.passes = Passes::default();
    let times = vec![frame_ms(turned, mode, strategy, lights); 8];
    made.times.passes.insert("shade", PassTimes::new(PassKind::Shade, times));
    made.set_times();
    made.is_lossy = strategy == CAPPED;
    made.image.errors.insert("missing_energy".into(), Some(0.0));
    made.lists.longest = if turned == "cap" { 200 } else { 90 };
    let lost = if turned == "range" { 0.0 } else { 0.2 };
    made.image.unbounded_errors.insert("missing_energy".into(), Some(lost));
    made.image.differing_channels = Some(if turned == "tiles" { 5 } else { 0 });
    made
}

fn study(turned: &str) -> Done {
    let mut done = made_study::study("culling");
    for mode in [Mode::Deferred, Mode::Forward] {
        for lights in [0, 750, 1_500] {
            let all = ["Clay", "None", "Sphere", "RasterSphere", CAPPED, WHOLE];
            let served =
                all.into_iter().filter(|id| mode == Mode::Deferred || *id != "RasterSphere");
            let records = served.map(|id| made(turned, mode, id, lights)).collect();
            let mut made = Results { records, ..empty() };
            // The survey's own: absolute times are judged on it only.
            made.machine.adapter = "NVIDIA GeForce RTX 3080".into();
            add(&mut done, mode.name(), &lights.to_string(), made);
        }
    }
    done
}

fn page(done: &Done) -> (String, String) {
    let Written { text, page, .. } = write(done);
    (text, page)
}

/// The verdict on a claim of the survey.
fn verdict<'a>(page: &'a str, claim: &str) -> &'a str {
    made_study::verdict(page, &format!("survey-{claim}"))
}

#[test]
fn every_claim_of_the_survey_holds_where_the_figures_say_so_and_fails_turned_round() {
    let (text, holds) = page(&study(""));
    for claim in CLAIMS {
        assert_eq!(verdict(&holds, claim), "holds", "{claim}: {text}");
        let (text, fails) = page(&study(claim));
        assert_eq!(verdict(&fails, claim), "fails", "{claim}, turned round: {text}");
    }
    // Where shading ends lights at their ranges, whole lists cannot show tiles.
    assert_eq!(verdict(&holds, "tiles"), "unknown");
    assert_eq!(verdict(&page(&study("tiles")).1, "tiles"), "holds");
}

/// With fewer than six laps, 5 % is the least difference that orders two frames, and a great one counts.
#[test]
fn few_laps_are_told_from_ties() {
    let two_laps = |turned: &str| {
        let mut done = study(turned);
        for record in done.results.values_mut().flat_map(|results| &mut results.records) {
            (record.setting.along_path, record.setting.poses, record.times.frames) =
                (true, Some(4), 8);
            record.set_times();
        }
        page(&done)
    };
    let (text, whole) = two_laps("");
    for claim in ["slowest", "gain", "raster"] {
        assert_eq!(verdict(&whole, claim), "holds", "{claim}: {text}");
        assert_eq!(verdict(&two_laps(claim).1, claim), "fails", "{claim}, turned round");
    }
}

#[test]
fn a_data_centre_gpu_does_not_judge_forward_against_deferred() {
    let mut done = study("");
    for results in done.results.values_mut() {
        results.machine.adapter = "NVIDIA H200".into();
    }
    let (text, page) = page(&done);
    assert_eq!(verdict(&page, "deferred"), "unknown", "{text}");
    assert_eq!(verdict(&page, "rate"), "unknown", "another GPU: {text}");
    assert!(page.contains("RasterSphere and Clay shade there"), "the deferred times are cautioned");
    assert!(page.contains("not with deferred ones or"), "the forward times are cautioned");
}

#[test]
fn lossy_rows_state_their_error_and_never_lead() {
    let mut done = study("");
    for results in done.results.values_mut() {
        for record in results.records.iter_mut().filter(|record| record.strategy == CAPPED) {
            record.image.errors.insert("rel_mse".into(), Some(0.25));
            let times = vec![0.5; 8];
            record.times.passes.insert("shade", PassTimes::new(PassKind::Shade, times));
            record.set_times();
        }
    }
    let (text, _) = page(&done);
    assert!(
        text.contains(&format!("without a loss: {WHOLE} is fastest with deferred lighting ("))
            && text.contains(&format!("; {WHOLE} is fastest with forward lighting (")),
        "{text}"
    );
    assert!(text.contains(&format!("{CAPPED} 0.500 ms (lossy, relMSE 0.250)")), "{text}");
}
