//! Made-up results and pictures to show.
#![allow(dead_code, reason = "each test uses its share")]

use std::collections::BTreeMap;
use std::io::Cursor;

use harness::results::{
    Clock, DeviceType, ImageFigures, Images, ListFigures, Machine, Mode, PassKind, PassTimes,
    Passes, Record, Results, Setting, Times, Truth, TruthLevel,
};
use image::{ImageFormat, Rgb, RgbImage};

pub(crate) fn machine() -> Machine {
    Machine {
        adapter: "llvmpipe (LLVM 15.0.6, 256 bits)".to_owned(),
        driver: "llvmpipe Mesa 22.3.6 (LLVM 15.0.6)".to_owned(),
        backend: "vulkan".to_owned(),
        device_type: DeviceType::Cpu,
        cpu: "AMD EPYC 7B13".to_owned(),
        os: "linux x86_64".to_owned(),
        commit: "9833da8c41f6".to_owned(),
        date: "2026-11-22T04:00:00Z".to_owned(),
        rustc: Some("rustc 1.95.0".to_owned()),
    }
}

pub(crate) fn empty() -> Results {
    let command = "lightbench compare --scene atrium --lights 1000 --mode both";
    let truth = Truth { level: TruthLevel::Full, edge_tolerance: 1e-6, notes: vec![] };
    Results::new(machine(), command.split(' ').map(str::to_owned).collect(), truth)
}

/// Times around a median, the same on every run.
fn times(kind: PassKind, median_ms: f64, spread: f64, salt: u32, frames: u32) -> PassTimes {
    let noise = |frame: u32| {
        let hash = (frame * 7 + salt * 31 + 3).wrapping_mul(2_654_435_761) >> 8;
        f64::from(hash) / f64::from(1 << 24) - 0.5
    };
    let sample = |frame| median_ms * (1.0 + spread * noise(frame));
    PassTimes::new(kind, (0..frames).map(sample).collect())
}

pub(crate) fn record(strategy: &str, mode: Mode, assign_ms: f64, shade_ms: f64) -> Record {
    let frames = 8;
    let salt = strategy.len() as u32;
    let mut passes = Passes::default();
    if mode == Mode::Deferred {
        passes.insert("depth", times(PassKind::Scene, 21.4, 0.05, salt, frames));
        passes.insert("G-buffer", times(PassKind::Scene, 38.1, 0.04, salt + 1, frames));
    } else {
        passes.insert("depth", times(PassKind::Scene, 21.6, 0.05, salt, frames));
    }
    if assign_ms > 0.0 {
        passes.insert("bounds", times(PassKind::Assign, assign_ms * 0.2, 0.06, salt + 2, frames));
        passes.insert("cull", times(PassKind::Assign, assign_ms * 0.8, 0.08, salt + 3, frames));
    }
    passes.insert("shade", times(PassKind::Shade, shade_ms, 0.03, salt + 4, frames));
    let is_none = strategy == "None";
    let stem = format!("atrium-{}-{}", mode.name(), strategy.replace('/', "-"));
    let mut record = Record {
        strategy: strategy.into(),
        is_lossy: false,
        indirect: None,
        note: None,
        setting: Setting {
            compensation: None,
            specular_reach: None,
            area_lod: None,
            shadows: None,
            scene: "atrium".to_owned(),
            scene_hash: "5f0c1b7e9ad24410".to_owned(),
            path_hash: None,
            scene_scale: 1.0,
            roughness: None,
            triangles: 262_144,
            mode,
            lights: 1_000,
            light_kinds: BTreeMap::from([("point".to_owned(), 900), ("spot".to_owned(), 100)]),
            area_model: None,
            radius_scale: 1.0,
            eye: [0.0, 1.7, 8.0],
            forward: [0.0, 0.0, -1.0],
            planes: None,
            light_box: [[-15.0, 0.0, -7.0], [15.0, 10.0, 7.0]],
            own_lights: 0,
            open_lights: None,
            open_threshold: None,
            width: 640,
            height: 360,
            seed: 1,
            along_path: false,
            poses: None,
            radii: Some("gamma".to_owned()),
            light_places: Some("core".to_owned()),
            threshold: None,
            cut: Some("windowed".to_owned()),
            light_order: Some("bvh".to_owned()),
            layers: None,
            msaa: None,
            motion: None,
        },
        times: Times {
            frames,
            warmup_frames: 2,
            clock: Clock::WallClock,
            passes,
            assign_ms: 0.0,
            shade_ms: 0.0,
            frame_ms: 0.0,
            spans: None,
            span_ms: None,
            frame_span_ms: None,
            rounds: frames,
            light_build_ms: Some(0.4),
            upload_bytes: None,
        },
        lists: ListFigures {
            operations: None,
            groups: if is_none { 1 } else { 1_440 },
            occupied_groups: if is_none { 1 } else { 1_102 },
            entries: if is_none { 1_000 } else { 21_834 },
            longest: if is_none { 1_000 } else { 96 },
            listed_per_sample: Some(if is_none { 1_000.0 } else { 26.37 }),
            contributing_per_sample: Some(14.218),
            hidden: None,
            missed_pairs: Some(0),
            first_missed: None,
            checked_pairs: Some(3_275_827),
            samples: 230_400,
            layer_samples: None,
            untested: None,
            list_bytes: if is_none { 4_016 } else { 1_310_720 },
            assignment_bytes: None,
            overflowed_groups: 0,
            lengths_all: vec![],
            lengths_read: if is_none { vec![] } else { vec![210, 96, 180, 402, 210, 4] },
        },
        image: ImageFigures {
            temporal: None,
            max_abs_diff: Some(0.0),
            max_rel_diff: Some(0.0),
            differing_channels: Some(0),
            worst_pixel: None,
            errors: BTreeMap::from([("rel_mse".to_owned(), Some(0.0))]),
            unbounded_errors: BTreeMap::new(),
            truth_errors: BTreeMap::new(),
            tolerance: None,
            files: Images {
                tone_mapped: Some(format!("{stem}.png")),
                baseline: None,
                difference: (!is_none).then(|| format!("{stem}-difference.png")),
                heat_map: (!is_none).then(|| format!("{stem}-heat.png")),
                difference_amplification: (!is_none).then_some(64.0),
                ..Images::default()
            },
        },
    };
    record.set_times();
    record
}

/// Three strategies, deferred and forward, one of them with a fault.
pub(crate) fn typical() -> Results {
    let mut results = empty();
    for (mode, factor) in [(Mode::Deferred, 1.0), (Mode::Forward, 1.12)] {
        results.records.push(record("None", mode, 0.0, 5_732.0 * factor));
        results.records.push(record("DC-I/64x64x24", mode, 31.4, 371.0 * factor));
        results.records.push(record("DC-I/32x32x32", mode, 88.0, 290.0 * factor));
    }
    results
}

/// A lossy record: pairs missed, channels that differ, groups that overflowed.
pub(crate) fn spoil(record: &mut Record) {
    record.lists.missed_pairs = Some(1_234);
    record.image.max_abs_diff = Some(0.031_26);
    record.image.max_rel_diff = Some(0.4);
    record.image.differing_channels = Some(5_678);
    record.lists.overflowed_groups = 3;
    record.note = Some("Lists were reused for 4 frames.".to_owned());
}

/// A picture for every name in the results.
pub(crate) fn pictures(results: &Results) -> Vec<(String, Vec<u8>)> {
    let mut all: Vec<(String, Vec<u8>)> = vec![];
    for record in &results.records {
        let lossy = record.image.max_abs_diff != Some(0.0);
        // Smaller than the record says, to be quick: the page scales them.
        let (width, height) = (record.setting.width / 2, record.setting.height / 2);
        for (name, png) in [
            (&record.image.files.tone_mapped, scene(width, height, lossy)),
            (&record.image.files.baseline, scene(width, height, false)),
            (&record.image.files.difference, difference(width, height, lossy)),
            (&record.image.files.heat_map, scene(width, height, !lossy)),
        ] {
            if let Some(name) = name {
                all.push((name.clone(), png));
            }
        }
    }
    all
}

/// A floor in perspective under coloured lights.
fn scene(width: u32, height: u32, lossy: bool) -> Vec<u8> {
    let lights = (0..40_u32).map(|ix| {
        let angle = ix as f32 * 2.399;
        let radius = 0.12 + 0.016 * ix as f32;
        let hue = [
            (ix * 37 % 97) as f32 / 97.0,
            (ix * 53 % 89) as f32 / 89.0,
            (ix * 71 % 83) as f32 / 83.0,
        ];
        ((angle.cos() * radius * 1.6, 0.25 + angle.sin() * radius * 0.8), hue)
    });
    let lights: Vec<_> = lights.skip(usize::from(lossy) * 3).collect();
    png(width, height, |x, y| {
        let (u, v) = (x as f32 / height as f32 - 0.89, y as f32 / height as f32 - 0.35);
        let depth = if v > 0.0 { 0.12 / (v + 0.05) } else { 0.12 / (0.05 - v * 1.4) };
        let check = ((u * depth * 30.0).floor() + (depth * 24.0).floor()) as i32 & 1;
        let base = if v > 0.0 {
            0.35 + 0.3 * check as f32
        } else {
            0.4 + 0.15 * ((u * depth * 20.0).sin().abs())
        };
        let mut sum = [0.015_f32; 3];
        for ((lx, ly), hue) in &lights {
            let distance2 = (u - lx).powi(2) + (v - ly).powi(2) * 2.0;
            let glow = (1.0 - (distance2 / 0.05).min(1.0)).powi(2) / (distance2 * 120.0 + 1.0);
            for (channel, tint) in sum.iter_mut().zip(hue) {
                *channel += base * glow * (0.3 + 1.2 * tint);
            }
        }
        sum
    })
}

fn difference(width: u32, height: u32, lossy: bool) -> Vec<u8> {
    png(width, height, |x, y| {
        let distance = (x as f32 - 150.0).hypot(y as f32 - 100.0);
        [if lossy { (1.0 - distance / 30.0).max(0.0) } else { 0.0 }; 3]
    })
}

fn png(width: u32, height: u32, colour: impl Fn(u32, u32) -> [f32; 3]) -> Vec<u8> {
    let image = RgbImage::from_fn(width, height, |x, y| {
        Rgb(colour(x, y).map(|c| ((c / (1.0 + c) * 1.5).min(1.0).powf(1.0 / 2.2) * 255.0) as u8))
    });
    let mut bytes = Cursor::new(vec![]);
    image.write_to(&mut bytes, ImageFormat::Png).expect("encodes");
    bytes.into_inner()
}
