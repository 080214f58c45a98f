//! Tests that paths climb, keep clear of surfaces, and see both smooth and broken depth.

use std::{io::Write, path::PathBuf};

use super::*;
use crate::{CameraPath, Scene, atrium, load_gltf};

/// The number of poses tested per path.
const POSES: u32 = 60;

/// The number of rays per picture.
const RAYS: [u32; 2] = [64, 36];

/// Measures of a path.
struct Shown {
    /// Range of heights over the height of the core.
    heights: f32,
    /// The least distance to a triangle, metres.
    clearance_m: f32,
    /// For each pose, the share of neighbouring rays whose depths differ by more than a tenth.
    broken: Vec<f32>,
}

impl Shown {
    fn measure(scene: &Scene) -> Self {
        let bvh = TriangleBvh::new(scene, scene.core_bounds.grown(1.0));
        let eyes: Vec<Vec3> = (0..1200).map(|frame| scene.path.pose(frame, 1200).eye).collect();
        let low = eyes.iter().map(|eye| eye.y).fold(f32::INFINITY, f32::min);
        let high = eyes.iter().map(|eye| eye.y).fold(f32::NEG_INFINITY, f32::max);
        let clearances = eyes.par_iter().map(|eye| bvh.clearance(*eye, 1.0));
        Self {
            heights: (high - low) / scene.core_bounds.size().y,
            clearance_m: clearances.reduce(|| 1.0, f32::min),
            broken: (0..POSES).into_par_iter().map(|pose| broken(scene, &bvh, pose)).collect(),
        }
    }

    fn least(&self) -> f32 {
        self.broken.iter().copied().fold(f32::INFINITY, f32::min)
    }

    fn most(&self) -> f32 {
        self.broken.iter().copied().fold(0.0, f32::max)
    }
}

/// The share of neighbouring rays of a picture whose depths are more than a tenth apart.
fn broken(scene: &Scene, bvh: &TriangleBvh, pose: u32) -> f32 {
    let pose = scene.path.pose(pose, POSES);
    let right = pose.forward().cross(pose.up).normalize();
    let up = right.cross(pose.forward());
    let [width, height] = RAYS;
    let half = 30_f32.to_radians().tan();
    let depth = |x: u32, y: u32| {
        let at = |ix: u32, count: u32| (2.0 * ix as f32 + 1.0) / count as f32 - 1.0;
        let aside = at(x, width) * half * width as f32 / height as f32;
        let along = pose.forward() + right * aside + up * (at(y, height) * half);
        let hit = bvh.cast(pose.eye, along.normalize(), 1e4)?;
        Some(hit.distance_m / along.length())
    };
    let depths: Vec<Option<f32>> =
        (0..width * height).map(|ix| depth(ix % width, ix / width)).collect();
    let (mut apart, mut all) = (0, 0);
    let mut compare = |a: usize, b: usize| {
        if let (Some(Some(a)), Some(Some(b))) = (depths.get(a), depths.get(b)) {
            all += 1;
            apart += usize::from(a.max(*b) > 1.1 * a.min(*b));
        }
    };
    let width = width as usize;
    for ix in 0..depths.len() {
        compare(ix, ix + width);
        if ix % width + 1 < width {
            compare(ix, ix + 1);
        }
    }
    apart as f32 / all.max(1) as f32
}

fn check(name: &str, shown: &Shown) {
    let said = format!(
        "{name}: heights {:.2}, clearance {:.2} m, broken {:.3} to {:.3}, at first {:.3}",
        shown.heights,
        shown.clearance_m,
        shown.least(),
        shown.most(),
        shown.broken[0]
    );
    println!("{said}");
    assert!(lacks(shown).is_empty(), "{:?}: {said}", lacks(shown));
}

/// The properties of a tour that a path does not have.
fn lacks(shown: &Shown) -> Vec<&'static str> {
    let demands = [
        ("heights", shown.heights > 0.2),
        ("clearance", shown.clearance_m > 0.15),
        ("smooth and broken views", shown.most() > 2.0 * shown.least()),
    ];
    demands.into_iter().filter(|(_, is_met)| !is_met).map(|(name, _)| name).collect()
}

#[test]
fn the_atriums_path_climbs_and_crosses_edges() {
    check("atrium", &Shown::measure(&atrium(1)));
}

/// A path at one height is no tour, and a camera that stands still shows only one kind of view.
#[test]
fn level_and_still_paths_are_not_tours() {
    let mut scene = atrium(1);
    let first = scene.path.pose(0, 48);
    let level = |ix| {
        let pose = scene.path.pose(ix, 48);
        (pose.eye.with_y(first.eye.y), pose.eye + 10.0 * pose.forward())
    };
    let knots = (0..48).map(level).collect();
    scene.path = CameraPath::closed_loop(knots, first);
    assert!(lacks(&Shown::measure(&scene)).contains(&"heights"));
    scene.path = CameraPath::still(first);
    let lacking = lacks(&Shown::measure(&scene));
    assert!(lacking.contains(&"heights"), "{lacking:?}");
    assert!(lacking.contains(&"smooth and broken views"), "{lacking:?}");
}

/// Sponza's path is fitted. Its first pose is that of earlier versions, because pictures show it.
#[test]
fn a_fitted_path_climbs_and_crosses_edges() {
    let beside = || PathBuf::from(env!("CARGO_MANIFEST_DIR")).join("../../shared/scenes");
    let folder = std::env::var_os("LIGHTBENCH_SCENES").map_or_else(beside, PathBuf::from);
    let path = folder.join("crytek-sponza/Sponza.gltf");
    if !path.exists() {
        let line = format!("skipped: {} is absent, nothing was tested\n", path.display());
        let _ = std::io::stderr().write_all(line.as_bytes());
        return;
    }
    let scene = load_gltf(&path).expect("a valid scene");
    check("Sponza", &Shown::measure(&scene));
}

/// A level loop in the atrium's court.
fn ring() -> Vec<Vec3> {
    (0..48)
        .map(|ix| {
            let (sin, cos) = (TAU * ix as f32 / 48.0).sin_cos();
            Vec3::new(8.0 * cos, 2.5, 3.5 * sin)
        })
        .collect()
}

/// In a hall with a row of posts, the loop leaves its ellipse and touches nothing.
#[test]
fn a_bent_loop_keeps_its_first_knot_and_its_margin() {
    let scene = atrium(1);
    let bvh = TriangleBvh::new(&scene, scene.bounds);
    let room = Room { bvh: &bvh, core: scene.core_bounds, margin_m: 0.3 };
    let level = ring();
    let eyes = room.bend(&level);
    assert_eq!(eyes[0], level[0]);
    let rise = eyes.iter().map(|eye| eye.y - 2.5).fold(0.0, f32::max);
    let pushed = eyes
        .iter()
        .zip(&level)
        .map(|(eye, at)| Vec3::new(eye.x - at.x, 0.0, eye.z - at.z).length());
    let pushed = pushed.fold(0.0, f32::max);
    assert!(rise > 2.0 && pushed > 1.5, "rise {rise}, push {pushed}");
    assert!((0..48).all(|ix| room.is_clear(&eyes, ix)));
}

/// A camera without room for a loop turns on the spot.
#[test]
fn a_loop_of_one_point_stays_there() {
    let scene = atrium(1);
    let bvh = TriangleBvh::new(&scene, scene.bounds);
    let room = Room { bvh: &bvh, core: scene.core_bounds, margin_m: 0.3 };
    // The mean of 48 equal numbers is not always that number.
    for eye in [Vec3::new(0.1, 2.5, 0.3), Vec3::new(-3.3, 1.7, 2.9)] {
        let level = vec![eye; 48];
        assert_eq!(room.bend(&level), level);
    }
}

/// A stretch of a bent loop never counts as clear if it cannot be sampled closely enough.
#[test]
fn a_loop_with_too_small_a_margin_to_sample_stays_level() {
    let scene = atrium(1);
    let bvh = TriangleBvh::new(&scene, scene.bounds);
    let level = ring();
    let bent = |margin_m| Room { bvh: &bvh, core: scene.core_bounds, margin_m }.bend(&level);
    assert_eq!(bent(1e-5), level);
    assert_ne!(bent(0.3), level);
}
