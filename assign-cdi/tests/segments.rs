//! Compares segments through deep images with a test against all triangles.

#![allow(clippy::unwrap_used, reason = "a helper of a test may fail it")]

mod scene;

use assign::{
    Gpu, Shader,
    conformance::{Bound, download, run_kernel},
    kernel::Slot,
};
use assign_cdi::{
    Build, Coverage, DeepImageSettings, DeepImages, Spread,
};
use glam::{Vec3, Vec4};
use rand::{RngExt, SeedableRng};
use rand_pcg::Pcg64Mcg;
use scene::{
    Scene,
    rays::{MIDDLE, Ray, cast, true_length, upload},
    room, surface,
};

/// The module of segments, which negative controls change.
const SEGMENT_WESL: &str = include_str!("../src/shaders/segment.wesl");

struct Segment {
    start: Vec3,
    normal: Vec3,
    end: Vec3,
}

/// From surfaces to points of a lamp under the ceiling, which faces down.
fn segments(scene: &Scene, count: usize) -> Vec<Segment> {
    let mut rng = Pcg64Mcg::seed_from_u64(3);
    let mut all = Vec::new();
    while all.len() < count {
        let (start, normal) = surface(&mut rng, &scene.triangles, MIDDLE);
        let [x, z] = [0; 2].map(|_| rng.random_range(-1.0_f32..1.0));
        let end = Vec3::new(1.0 + x, 4.9, 3.0 + z);
        let way = end - start;
        let seen = Ray { origin: start, direction: (MIDDLE - start).normalize(), normal };
        let is_seen = !true_length(&scene.triangles, &seen).is_some_and(|at| at < (MIDDLE - start).length());
        if way.dot(normal) > 0.05 && way.y > 0.05 && is_seen {
            all.push(Segment { start, normal, end });
        }
    }
    all
}

fn blocked(gpu: &Gpu, images: &DeepImages, segments: &[Segment], module: &str) -> Vec<bool> {
    let shader = DeepImages::mount(images.settings(), Shader::new(3), 0)
        .module("package::segment", module.to_owned())
        .module("package::block", include_str!("scene/block.wesl"));
    let module = shader.create(gpu, "package::block").unwrap();
    let words: Vec<Vec4> = segments
        .iter()
        .flat_map(|it| [it.start, it.normal, it.end, Vec3::NEG_Y].map(|v| v.extend(0.0)))
        .collect();
    let input = upload(gpu, &words);
    let output = gpu.storage("blocked", segments.len() as u64 * 4).unwrap();
    let groups = [
        Bound::Group(images.layout(), images.bind_group().unwrap()),
        Bound::Buffers(&[(0, Slot::Read, &input), (1, Slot::Write, &output)]),
    ];
    run_kernel(gpu, &module, "block_segments", &groups, (segments.len() as u32).div_ceil(64));
    let words: Vec<u32> = download(gpu, &output, segments.len()).unwrap();
    words.into_iter().map(|word| word == 1).collect()
}

/// Whether triangles block each segment.
fn truth(scene: &Scene, segments: &[Segment]) -> Vec<bool> {
    let one = |it: &Segment| {
        let way = it.end - it.start;
        let ray = Ray { origin: it.start, direction: way.normalize(), normal: it.normal };
        true_length(&scene.triangles, &ray).is_some_and(|at| at < way.length() - 1e-4)
    };
    segments.iter().map(one).collect()
}

/// Shares of segments that are blocked though the truth is open, and open though it is blocked.
fn errors(found: &[bool], truth: &[bool]) -> [f64; 2] {
    let share = |wanted: bool| {
        let count = found.iter().zip(truth).filter(|(found, is)| found != is && **is == wanted);
        count.count() as f64 / found.len() as f64
    };
    [share(false), share(true)]
}

fn per_direction(count: u32, size_px: u32, coverage: Coverage) -> DeepImageSettings {
    let settings = scene::rays::settings(count, size_px, Spread::Squares);
    DeepImageSettings { build: Build::PerDirection { coverage, at_once: count }, ..settings }
}

#[test]
#[ignore]
fn sweep() {
    let gpu = Gpu::open(None).unwrap();
    let scene = Scene::new(&gpu, room(11, 12, 0));
    let segments = segments(&scene, 10_000);
    let truth = truth(&scene, &segments);
    println!("blocked {:.3}", truth.iter().filter(|b| **b).count() as f64 / 10_000.0);
    for (px, count) in [(64, 169), (128, 169), (256, 169), (256, 49), (256, 25)] {
        let settings = per_direction(count, px, Coverage::Centres);
        let mut images = DeepImages::new(&gpu, settings).unwrap();
        images.settle(&gpu, &scene.input()).unwrap();
        for (name, from, to) in [
            ("as is", "PIXEL_REACH * width_m", "PIXEL_REACH * width_m"),
            ("half slack", "PIXEL_REACH * width_m", "0.35 * width_m"),
            ("no slack", "PIXEL_REACH * width_m", "0.02 * width_m"),
            ("half ends", "max(ends.x, ends.y) + width_m", "max(ends.x, ends.y) + 0.5 * width_m"),
            ("2 ends", "max(ends.x, ends.y) + width_m", "max(ends.x, ends.y) + 2.0 * width_m"),
            ("0 ends", "max(ends.x, ends.y) + width_m", "max(ends.x, ends.y)"),
            ("last", "max(ends.x, ends.y) + width_m", "max(ends.x, ends.y)"),
        ] {
            let mut module = SEGMENT_WESL.replace(from, to);
            module = match name {
                "half ends" => module.replace("min(ends.x, ends.y) - width_m", "min(ends.x, ends.y) - 0.5 * width_m"),
                "2 ends" => module.replace("min(ends.x, ends.y) - width_m", "min(ends.x, ends.y) - 2.0 * width_m"),
                "0 ends" => module.replace("min(ends.x, ends.y) - width_m", "min(ends.x, ends.y)"),
                _ => module,
            };
            let found = blocked(&gpu, &images, &segments, &module);
            let [dark, lit] = errors(&found, &truth);
            println!("{count} {px}: {:.3} m {name}: dark {dark:.4} lit {lit:.4}", images.space().footprint_m);
        }
            let rays: Vec<Ray> = segments.iter().map(|it| Ray { origin: it.start, direction: (it.end - it.start).normalize(), normal: it.normal }).collect();
            let lengths = cast(&gpu, &images, &rays);
            let single: Vec<bool> = lengths.iter().zip(&segments).map(|(l, it)| *l >= 0.0 && *l < (it.end - it.start).length() - images.space().footprint_m).collect();
            let [sdark, slit] = errors(&single, &truth);
            println!("one list {sdark:.4} {slit:.4}");
    }
}
