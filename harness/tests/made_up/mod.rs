//! A made-up study of the comparison paper, and its report.
#![allow(dead_code, reason = "each test uses its share")]

use std::path::Path;

use harness::results::{Mode, PassKind, PassTimes, Record, Results};
use harness::study::{Done, Settings};

use crate::made_study::{self, add_with};
use crate::report_data::{empty, pictures, record};

pub(crate) use crate::made_study::{Written, verdict, write};

const FAMILIES: [&str; 9] = [
    "T-I/28x28",
    "T-E/28x28",
    "DC-I/128x128x64",
    "DC-E/64x64x40",
    "SC-I/48x48x40",
    "SC-E/48x48x40",
    "G/20x20x20",
    "M",
    "M/2",
];

/// Offset and slope of a strategy, ms and ms per light: as the paper has it.
pub(crate) fn line(strategy: &str) -> (f64, f64) {
    match strategy.split('/').next().expect("it is there") {
        "T-I" => (0.9, 6.0e-3),
        "T-E" => (2.0, 1.4e-3),
        "DC-I" => (1.0, 3.0e-3),
        "DC-E" => (3.1, 0.45e-3),
        "SC-I" => (3.0, 0.7e-3),
        "SC-E" => (4.0, 0.45e-3),
        "G" => (1.15, 3.2e-3),
        _ if strategy == "M" => (0.5, 0.2),
        _ => (2.0, 2.5e-3),
    }
}

/// By how much the times of a strategy vary along the path, as a share of their mean.
pub(crate) fn swing(strategy: &str) -> f64 {
    match strategy.split('/').next().expect("it is there") {
        "SC-E" => 0.02,
        "SC-I" | "M" => 0.03,
        "T-E" => 0.05,
        "T-I" => 0.1,
        "G" => 0.023,
        _ => 0.025,
    }
}

/// A made-up study in which every claim holds but the one that is turned round.
pub(crate) struct Maker {
    turned: &'static str,
    pub(crate) done: Done,
}

impl Maker {
    pub(crate) fn new(turned: &'static str) -> Self {
        Self { turned, done: made_study::study("comparison") }
    }

    pub(crate) fn add(&mut self, section: &str, variant: &str, records: Vec<Record>) {
        self.add_with(section, variant, Settings::default(), records);
    }

    pub(crate) fn add_with(
        &mut self,
        section: &str,
        variant: &str,
        settings: Settings,
        records: Vec<Record>,
    ) {
        add_with(&mut self.done, section, variant, settings, Results { records, ..empty() });
    }

    /// Every strategy at a count of lights.
    pub(crate) fn all(&self, lights: u64) -> Vec<Record> {
        FAMILIES.iter().map(|id| self.one(id, lights)).collect()
    }

    pub(crate) fn one(&self, id: &str, lights: u64) -> Record {
        let (mut offset, mut slope) = line(id);
        let count = lights as f64;
        let of = |names: &[&str]| names.iter().any(|name| id.split('/').next() == Some(name));
        match self.turned {
            "many" if of(&["DC-E", "SC-E"]) => offset += 5_000.0,
            "dense" if of(&["DC-E"]) => offset += 3.0,
            "explicit" if of(&["T-E", "DC-E", "SC-E"]) => offset += 500.0,
            "few" if of(&["DC-I"]) => offset += 50.0,
            "few-order" if of(&["DC-I", "G", "T-I"]) => offset += 50.0,
            "few-order" if of(&["T-E"]) => offset = 40.0,
            "few-order" if of(&["SC-I", "SC-E"]) => offset = 30.0,
            "few-order" if id == "M" => (offset, slope) = (0.1, 0.01),
            "medium" if of(&["T-E"]) => offset += 5_000.0,
            "medium-order" if of(&["T-I"]) => (offset, slope) = (0.1, 1e-5),
            "medium-order" if id == "M" => (offset, slope) = (0.01, 1e-6),
            "many-order" if of(&["SC-E"]) => offset += 5_000.0,
            "many-order" if of(&["SC-I"]) => offset += 4_000.0,
            "many-order" if of(&["T-E"]) => offset += 3_000.0,
            "many-order" if of(&["DC-I", "G"]) => offset += 2_000.0,
            "many-order" | "slopes" if id == "M" => slope = 1e-3,
            "slopes" if of(&["SC-E", "SC-I"]) => slope = 1.0,
            "slopes" if of(&["T-E"]) => slope = 0.5,
            "slopes" if of(&["DC-I", "G"]) => slope = 0.2,
            "slopes" if of(&["T-I"]) => slope = 0.05,
            "offsets" if of(&["SC-E", "SC-I"]) => offset = 1.0,
            "offsets" if of(&["T-E"]) => offset = 10.0,
            "offsets" if of(&["T-I", "G", "DC-I"]) => offset = 100.0,
            "offsets" if id == "M" => offset = 500.0,
            "model-slopes" if id == "M" => slope = 2e-3,
            "alike" if of(&["DC-I"]) => (offset, slope) = (9.0, 0.05),
            "models" | "subdivision" if id == "M/2" => offset += 5_000.0,
            _ => {}
        }
        let in_assignment = match self.turned {
            "dominates" => 0.8,
            "model-slopes" if id == "M" => 0.9,
            _ if id == "M" => 1e-5,
            _ => 0.3,
        };
        let bend = match self.turned {
            "linear" => (count / 3_000.0 - 1.0).powi(2) * 500.0,
            _ => 0.0,
        };
        let assign = offset * 0.5 + in_assignment * slope * count;
        let shade = offset * 0.5 + (1.0 - in_assignment) * slope * count + bend;
        let mut record = record(id, Mode::Deferred, assign, shade);
        record.setting.lights = lights;
        record.lists.list_bytes = match (of(&["DC-E"]), self.turned) {
            (true, "memory") => 1_000,
            (true, _) => 9_000_000,
            _ => 1_310_720,
        };
        record.lists.assignment_bytes = Some(record.lists.list_bytes);
        let is_extreme = id == "M" && self.turned != "models";
        record.lists.longest = if is_extreme { lights * 3 / 4 } else { 96 };
        record.lists.listed_per_sample = Some(match (id, self.turned) {
            ("M", _) => 100.0,
            ("M/2", "models") => 200.0,
            _ => 5.0,
        });
        record
    }

    /// A view of low or of high depth discontinuity.
    pub(crate) fn view(&self, view: &str) -> Vec<Record> {
        let mut records = self.all(10_000);
        let is_high = view == "high";
        for record in records.iter_mut().filter(|_| is_high) {
            let family = record.strategy.family();
            let growth = match (family, self.turned) {
                ("T-E", _) => 2.0,
                ("SC-E", "discontinuity") => 2.5,
                ("SC-E", _) => 1.4,
                _ => 1.0,
            };
            record.lists.listed_per_sample =
                record.lists.listed_per_sample.map(|listed| listed * growth);
            if growth > 1.0 || self.turned == "view-free" {
                record.lists.entries = record.lists.entries * 3 / 2;
            }
        }
        records
    }

    /// Sizes of a family, the paper's first.
    pub(crate) fn sizes(&self, family: &str, sizes: &[&str], source: &str) -> Vec<Record> {
        let time = |ix: usize| match (self.turned, family) {
            ("sizes", _) => 9.0 - 2.0 * ix as f64,
            ("grids", _) => 3.0 + 2.0 * ix as f64,
            // The last grid is the shaped one, which the paper did not try.
            (_, "G") if ix == 2 => 2.5,
            _ => 3.0 + 2.0 * ix as f64,
        };
        let make = |(ix, size): (usize, &&str)| {
            record(&format!("{family}/{size}{source}"), Mode::Deferred, 3.0, time(ix))
        };
        sizes.iter().enumerate().map(make).collect()
    }

    pub(crate) fn scaling(&self, lights: u64) -> Vec<Record> {
        let mut records = self.all(lights);
        if self.turned == "bounds" {
            for record in &mut records {
                let id = record.strategy.as_str();
                record.strategy = if id.contains("-I") {
                    id.replacen("-I", "-E", 1).into()
                } else {
                    id.replacen("-E", "-I", 1).into()
                };
                // Even the depth pre-pass does not raise their offset then.
                record.times.passes.insert("depth", PassTimes::new(PassKind::Scene, vec![0.01; 8]));
            }
        }
        records
    }

    pub(crate) fn tests(&self, family: &str) -> Vec<Record> {
        let times = |union: &str| match (union, self.turned) {
            ("hs+sat-n", "tests") => (5.0, 30.0),
            ("hs+sat-n", "union") => (15.0, 8.0),
            ("hs+sat-n", _) => (5.0, 8.0),
            ("hs+sat-e+sat-p+sat-v", "union") => (5.0, 24.0),
            ("hs+sat-e+sat-p+sat-v", _) => (9.0, 8.0),
            _ => (5.0, 20.0),
        };
        let make = |union: &&str| {
            let (assign, shade) = times(union);
            record(&format!("{family}/{union}"), Mode::Deferred, assign, shade)
        };
        ["hs", "hs+sat-n", "hs+sat-v", "hs+sat-e+sat-p+sat-v"].iter().map(make).collect()
    }

    /// Times along the path: `poses` of them, `laps` times; one lap of old results has no count of
    /// poses.
    pub(crate) fn path(&self, lights: u64, poses: u32, laps: u32) -> Vec<Record> {
        let mut records = self.all(lights);
        for record in &mut records {
            let id = record.strategy.as_str();
            let of = |name: &str| id.split('/').next() == Some(name);
            let swing = match self.turned {
                "steady" if of("SC-E") => 5.0,
                "spread" if of("SC-E") || of("SC-I") => 5.0,
                "spread" if of("T-E") || of("DC-I") || of("G") => 0.5,
                "spread" => 1e-4,
                "steady-explicit" if of("T-E") || of("SC-E") => 60.0,
                "steady-alike" if of("G") => 0.4,
                _ => swing(id),
            };
            let mean = [record.times.assign_ms, record.times.shade_ms];
            let wave = |frame: u32| {
                1.0 + swing
                    * (std::f64::consts::TAU * f64::from(frame % poses) / f64::from(poses)).sin()
            };
            let frames = poses * laps;
            let of = |part: usize| (0..frames).map(|frame| mean[part] * wave(frame)).collect();
            let (assign, shade) = (of(0), of(1));
            record.times.passes = Default::default();
            record.times.passes.insert("cull", PassTimes::new(PassKind::Assign, assign));
            record.times.passes.insert("shade", PassTimes::new(PassKind::Shade, shade));
            (record.times.frames, record.times.rounds, record.setting.along_path) =
                (frames, laps, true);
            record.setting.poses = (laps > 1).then_some(poses);
            if laps == 1 {
                record.times.rounds = frames;
            }
            record.set_times();
        }
        records
    }

    /// Exact and capped lists, with pictures in a folder.
    pub(crate) fn caps(&self, folder: &Path) -> Vec<Record> {
        let mut records = Vec::new();
        for (family, time) in [("T-E/28x28/bvh", 12.0), ("SC-E/48x48x40/bvh", 8.0)] {
            for (knob, share, error) in
                [("", 1.0, 0.0), ("/cap4", 0.5, 0.2), ("/cap16", 0.8, 0.005)]
            {
                let id = format!("{family}{knob}");
                let mut record = record(&id, Mode::Deferred, 2.0, time * share);
                record.is_lossy = !knob.is_empty();
                (record.image.max_abs_diff, record.image.differing_channels) =
                    (Some(error), Some(u64::from(record.is_lossy) * 9));
                let errors = [("rel_mse", error), ("flip", error * 0.5), ("bias", f64::NAN)];
                record.image.errors = errors
                    .map(|(id, e)| (id.to_owned(), e.is_finite().then_some(e)))
                    .into_iter()
                    .collect();
                record.image.files.baseline = Some("None.png".into());
                records.push(record);
            }
        }
        let results = Results { records, ..empty() };
        for (name, png) in pictures(&results) {
            std::fs::write(folder.join(name), png).expect("writes");
        }
        results.records
    }
}

/// A whole study; pictures are kept in a folder.
pub(crate) fn study(turned: &'static str, folder: &Path) -> Done {
    study_of(turned, folder, 6)
}

/// The same with other laps along the path.
pub(crate) fn study_of(turned: &'static str, folder: &Path, laps: u32) -> Done {
    let mut maker = Maker::new(turned);
    for lights in [100, 1_000, 10_000] {
        let mut records = maker.all(lights);
        let mut none = record("None", Mode::Deferred, 0.0, 0.2 * lights as f64);
        none.setting.lights = lights;
        records.insert(0, none);
        maker.add("main", &lights.to_string(), records);
    }
    for lights in [100, 1_000, 3_000, 10_000] {
        maker.add("scaling", &lights.to_string(), maker.scaling(lights));
    }
    for family in ["T-I/28x28", "SC-I/48x48x40"] {
        maker.add("tests", &family[..3], maker.tests(family));
    }
    for (family, sizes) in [
        ("T-I", &["28x28", "16x16"][..]),
        ("T-E", &["28x28", "16x16"]),
        ("DC-I", &["128x128x64", "64x64x40"]),
        ("DC-E", &["64x64x40", "32x32x40"]),
        ("SC-I", &["48x48x40", "32x32x40"]),
        ("SC-E", &["48x48x40", "32x32x40"]),
        ("G", &["20x20x20", "16x16x16", "40x12x20"]),
    ] {
        maker.add("sizes", family, maker.sizes(family, sizes, ""));
        maker.add("sizes", &format!("{family}-bvh"), maker.sizes(family, sizes, "/bvh"));
    }
    maker.add("path", "10000", maker.path(10_000, 40, laps));
    for view in ["low", "high"] {
        maker.add_with(
            "views",
            view,
            Settings::from([("depth_discontinuity", view)]),
            maker.view(view),
        );
    }
    for (section, lights) in [("growing", 30_000), ("constant", 30_000)] {
        let mut records = maker.all(lights);
        for record in &mut records {
            record.strategy = format!("{}/bvh", record.strategy).into();
        }
        maker.add(section, "30000", records);
    }
    for radii in ["gamma", "equal"] {
        let mut records = maker.all(10_000);
        for record in &mut records {
            record.setting.radii = Some(radii.into());
        }
        maker.add("radii", radii, records);
    }
    maker.add("caps", "all", maker.caps(folder));
    let mut reuse = maker.path(10_000, 40, 1);
    for (record, error) in reuse.iter_mut().zip([0.1, 0.2, 0.3]) {
        record.strategy = format!("{}/reuse2", record.strategy).into();
        record.is_lossy = true;
        record.image.errors.insert("rel_mse".into(), Some(error));
    }
    maker.add("reuse", "all", reuse);
    for cut in ["windowed", "hard"] {
        let mut records = maker.all(10_000);
        for record in &mut records {
            (record.setting.cut, record.setting.threshold) = (Some(cut.into()), Some(0.01));
            record.image.unbounded_errors.insert("rel_mse".into(), Some(0.3));
        }
        maker.add("ranges", cut, records);
    }
    let mut done = maker.done;
    for name in ["atrium-caps-all", "atrium-views-low", "atrium-views-high"] {
        done.folders.insert(name.into(), folder.to_owned());
    }
    let heat: Vec<_> = done.results["atrium-views-low"].records.to_vec();
    for (name, png) in pictures(&Results { records: heat, ..empty() }) {
        std::fs::write(folder.join(name), png).expect("writes");
    }
    done
}

pub(crate) fn whole(turned: &'static str) -> Written {
    let folder = tempfile::tempdir().expect("a temporary folder");
    write(&study(turned, folder.path()))
}
