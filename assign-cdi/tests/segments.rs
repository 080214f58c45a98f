//! Compares segments through deep images with a test against all triangles.

#![allow(clippy::unwrap_used, reason = "a helper of a test may fail it")]

mod scene;

use assign::{
    Gpu, Shader,
    conformance::{Bound, download, run_kernel},
    kernel::Slot,
};
use assign_cdi::{Build, Coverage, DeepImageSettings, DeepImages, Directions, Spread, Storage};
use glam::{Vec3, Vec4};
use rand::{RngExt, SeedableRng};
use rand_pcg::Pcg64Mcg;
use scene::{
    Scene,
    rays::{MIDDLE, Ray, true_length, upload},
    room, surface,
};

/// The module of segments, which controls change.
const SEGMENT_WESL: &str = include_str!("../src/shaders/segment.wesl");

struct Segment {
    start: Vec3,
    normal: Vec3,
    end: Vec3,
}

/// From surfaces that the middle of the room sees to points of a lamp under the ceiling, which faces down.
fn segments(scene: &Scene, count: usize) -> Vec<Segment> {
    let mut rng = Pcg64Mcg::seed_from_u64(3);
    let mut all = Vec::new();
    while all.len() < count {
        let (start, normal) = surface(&mut rng, &scene.triangles, MIDDLE);
        let [x, z] = [0; 2].map(|_| rng.random_range(-1.0_f32..1.0));
        let end = Vec3::new(1.0 + x, 4.9, 3.0 + z);
        let way = end - start;
        let seen = Ray { origin: start, direction: (MIDDLE - start).normalize(), normal };
        let is_seen =
            !true_length(&scene.triangles, &seen).is_some_and(|at| at < (MIDDLE - start).length());
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

/// Images with a visit to the triangles for each direction.
fn settings(directions: Directions, size_px: u32) -> DeepImageSettings {
    let build = Build::PerDirection { coverage: Coverage::Centres, at_once: directions.count() };
    DeepImageSettings { directions, size_px, build, ..Default::default() }
}

fn squares(side: u32) -> Directions {
    Directions::new(Spread::Squares, side, side).unwrap()
}

/// Shares of segments that are wrong, for images of so many directions along each axis and pixels along each side: with the walk
/// through the pixels, and with the list of the first pixel for all of the way, as in Archer et al. 2019.
fn wrong(gpu: &Gpu, scene: &Scene, side: u32, size_px: u32) -> [[f64; 2]; 2] {
    let segments = segments(scene, 4_000);
    let truth = truth(scene, &segments);
    let blocked_share = truth.iter().filter(|is| **is).count() as f64 / truth.len() as f64;
    assert!(blocked_share > 0.05, "{blocked_share}");
    let mut images = DeepImages::new(gpu, settings(squares(side), size_px)).unwrap();
    images.settle(gpu, &scene.input()).unwrap();
    images.ray_buffers().unwrap();
    let first = SEGMENT_WESL
        .replace("let left = clamp(min(border.x, border.y), entered, 1.0);", "let left = 1.0;")
        .replace("min(crossed, 2u * ray_images.size_px + 2u)", "1u");
    assert!(first.contains("let left = 1.0;") && first.contains("i < 1u;"));
    let found = [SEGMENT_WESL, &first]
        .map(|module| errors(&blocked(gpu, &images, &segments, module), &truth));
    let footprint_m = images.space().footprint_m;
    println!(
        "{side} x {side} directions, pixels of {footprint_m:.3} m, {:.1} % blocked: dark and lit {:.2?} %, by the first pixel \
         {:.2?} %",
        100.0 * blocked_share,
        found[0].map(|share| 100.0 * share),
        found[1].map(|share| 100.0 * share)
    );
    found
}

/// Pixels decide how far segments are off, and the walk makes up for directions.
#[test]
fn segments_are_right_but_for_a_pixel() {
    let gpu = Gpu::open(None).unwrap();
    let scene = Scene::new(&gpu, room(11, 12, 0));
    let sum = |errors: [f64; 2]| errors[0] + errors[1];
    let [coarse, _] = wrong(&gpu, &scene, 6, 64).map(sum);
    let [fine, by_first] = wrong(&gpu, &scene, 6, 256).map(sum);
    assert!(fine < 0.015 && fine < 0.6 * coarse, "{fine}, {coarse}");
    assert!(by_first > 4.0 * fine, "{by_first}, {fine}");
    let [few, _] = wrong(&gpu, &scene, 4, 256).map(sum);
    assert!(few < 2.0 * fine, "{few}, {fine}");
}

/// A surface that a segment begins or ends on does not block it, and a plate between does.
#[test]
fn the_ends_do_not_block() {
    let gpu = Gpu::open(None).unwrap();
    // A floor and a ceiling, and a plate between them over negative x.
    let level = |y: f32, x: [f32; 2]| {
        let at = |x: f32, z: f32| Vec3::new(x, y, z);
        let [low, high] = x;
        [
            [at(low, -4.0), at(high, -4.0), at(high, 4.0)],
            [at(low, -4.0), at(high, 4.0), at(low, 4.0)],
        ]
    };
    let all = [level(0.0, [-4.0, 4.0]), level(3.0, [-4.0, 4.0]), level(1.5, [-4.0, 0.0])];
    let scene = Scene::new(&gpu, all.concat());
    let mut images = DeepImages::new(&gpu, settings(squares(6), 128)).unwrap();
    images.settle(&gpu, &scene.input()).unwrap();
    let mut rng = Pcg64Mcg::seed_from_u64(5);
    // Up to 18 degrees from the vertical: the images' planes are level up to a direction's cell.
    let mut across = |x: [f32; 2]| -> Vec<Segment> {
        (0..1000)
            .map(|_| {
                let mut at = |reach: f32| rng.random_range(-reach..reach);
                let start = Vec3::new(0.5 * (x[0] + x[1]) + at(1.0), 0.0, at(3.0));
                let end = start + Vec3::new(at(0.7), 3.0, at(0.7));
                Segment { start, normal: Vec3::Y, end }
            })
            .collect()
    };
    let [open, hidden] = [across([0.0, 4.0]), across([-4.0, 0.0])];
    let count = |segments: &[Segment], module: &str| {
        blocked(&gpu, &images, segments, module).into_iter().filter(|is| *is).count()
    };
    assert_eq!((count(&open, SEGMENT_WESL), count(&hidden, SEGMENT_WESL)), (0, 1000));
    // Control: floor and ceiling count.
    let counted = SEGMENT_WESL.replace("= PIXEL_REACH * width_m", "= -PIXEL_REACH * width_m");
    assert_ne!(counted, SEGMENT_WESL);
    assert!(count(&open, &counted) > 500);
}

#[test]
fn unfinished_images_are_not_handed_out() {
    let gpu = Gpu::open(None).unwrap();
    let scene = Scene::new(&gpu, room(11, 3, 0));
    let refused = |settings: DeepImageSettings| {
        let mut images = DeepImages::new(&gpu, settings).unwrap();
        let before = images.ray_buffers().unwrap_err().to_string();
        (before, images.settle(&gpu, &scene.input()), images.ray_buffers().map(|_| ()))
    };
    let good = settings(squares(2), 32);
    let (before, settled, after) = refused(good);
    assert!(before.contains("deep images that are settled"), "{before}");
    assert!(settled.is_ok() && after.is_ok());
    let (_, settled, after) = refused(DeepImageSettings { most_fragments: 100, ..good });
    let error = settled.unwrap_err().to_string();
    assert!(error.contains("deep images of ") && error.contains("400"), "{error}");
    assert!(after.is_err());
    let linked = DeepImageSettings { storage: Storage::LinkedLists, ..good };
    let (before, ..) = refused(linked);
    assert!(before.starts_with("storage of deep images is LinkedLists"), "{before}");
}
