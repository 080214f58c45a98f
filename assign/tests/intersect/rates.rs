//! How often each test says "reaches" of a light that does not: the table in
//! `assign::intersect`, printed by
//! `cargo test -p assign --test intersect rates -- --nocapture`.

use assign::{FrustumTests, Light, LightShape, View};
use glam::{DVec3, Mat3, Vec2, Vec3};
use rand::{RngExt, SeedableRng};
use rand_pcg::Pcg64Mcg;

use crate::groups::{Group, Shape, UNIONS, union};
use crate::oracle::{Overlap, overlap, wedges};

const CLUSTERS: usize = 600;
const LIGHTS: usize = 8_000;
/// The unions of tests on frusta, and two kinds of boxes.
const ROWS: usize = UNIONS.len() + 2;
/// Size of Sponza, metres (Enhuber 2019, table 4.2): lights lie in it, the camera at an end.
const SCENE_M: Vec3 = Vec3::new(37.2, 15.6, 22.9);

/// Half angle of the lights' cones, degrees; `None` for point lights.
const KINDS: [Option<f32>; 5] = [None, Some(15.0), Some(45.0), Some(75.0), Some(90.0)];
/// The documented share of hits that are false, per cent: a row per test, a column per kind.
const DOCUMENTED: [(&str, [f64; 5]); 9] = [
    ("hs", [36.0, 21.7, 25.7, 32.0, 34.8]),
    ("sat-e", [60.3, 71.5, 64.1, 61.8, 61.3]),
    ("sat-n", [53.5, 86.7, 76.1, 66.6, 63.0]),
    ("sat-p", [35.1, 21.4, 25.0, 31.3, 34.0]),
    ("sat-v", [41.1, 79.7, 66.0, 55.0, 51.1]),
    ("hs+sat-n", [6.5, 20.4, 15.2, 14.5, 14.1]),
    ("hs+sat-e+sat-p+sat-v", [5.5, 17.6, 12.8, 12.3, 12.1]),
    ("box", [0.0, 16.7, 12.5, 7.6, 5.8]),
    ("oriented box", [0.0, 16.5, 11.5, 7.5, 5.5]),
];

/// Radii of the comparison: gamma with alpha 4/3 and beta 0.75 (Enhuber 2019, section 4.2), drawn
/// as Marsaglia and Tsang 2000 do.
fn radius(rng: &mut Pcg64Mcg) -> f32 {
    let d = 4.0_f64 / 3.0 - 1.0 / 3.0;
    let c = 1.0 / (9.0 * d).sqrt();
    loop {
        let (u, v, w): (f64, f64, f64) = (rng.random(), rng.random(), rng.random());
        let normal = (-2.0 * (1.0 - u).ln()).sqrt() * (std::f64::consts::TAU * v).cos();
        let cube = (1.0 + c * normal).powi(3);
        if cube > 0.0 && (1.0 - w).ln() < 0.5 * normal * normal + d - d * cube + d * cube.ln() {
            return (0.75 * d * cube) as f32;
        }
    }
}

fn between(rng: &mut Pcg64Mcg, min: Vec3, max: Vec3) -> Vec3 {
    min + (max - min) * Vec3::from_array(rng.random())
}

fn light(rng: &mut Pcg64Mcg, half_angle: Option<f32>) -> Light {
    let position = between(rng, -0.5 * SCENE_M, 0.5 * SCENE_M);
    let mut light = Light::point(position, radius(rng).max(0.01), Vec3::ONE);
    let direction = between(rng, Vec3::NEG_ONE, Vec3::ONE).normalize();
    if let Some(degrees) = half_angle {
        light.shape =
            LightShape::Spot { direction, inner_angle: 0.0, outer_angle: degrees.to_radians() };
    }
    light
}

/// A cluster of 64x64 pixels at 1920x1080, of 24 exponential slices from 0.1 to 100 m, and the
/// boxes around it, along the world's axes and along the view's.
fn groups(rng: &mut Pcg64Mcg) -> [Group; 3] {
    let eye = Vec3::new(-0.5 * SCENE_M.x, 0.0, 0.0);
    let view = View::look_at(eye, Vec3::new(5.0, -2.0, 3.0), 1.0, 0.1, [1920, 1080]);
    let tile = Vec2::new(rng.random_range(0..30) as f32, rng.random_range(0..17) as f32);
    let size = Vec2::new(128.0 / 1920.0, 128.0 / 1080.0);
    // The slices from 2 to 30 m, where the scene is.
    let slice: i32 = rng.random_range(10..20);
    let start = |slice: i32| 0.1 * 1000_f32.powf(slice as f32 / 24.0);
    let shape = Shape::Frustum {
        ndc_min: Vec2::NEG_ONE + tile * size,
        ndc_max: Vec2::NEG_ONE + (tile + 1.0) * size,
        depth_min: start(slice),
        depth_max: start(slice + 1),
    };
    let frustum = Group { view, shape };
    let corners = frustum.hull(DVec3::ZERO, 0.0).0.map(DVec3::as_vec3);
    let bounds = |corners: [Vec3; 8]| {
        let min = corners.into_iter().reduce(Vec3::min).unwrap();
        (min, corners.into_iter().reduce(Vec3::max).unwrap())
    };
    let (min_world, max_world) = bounds(corners);
    let turn = Mat3::from_mat4(view.world_to_view);
    let (min, max) = bounds(corners.map(|c| turn * c));
    let to_world = turn.transpose();
    let oriented = Shape::Oriented {
        center_world: to_world * (0.5 * (min + max)),
        axes: [to_world.x_axis, to_world.y_axis, to_world.z_axis],
        half_extents_m: 0.5 * (max - min),
    };
    let aabb = Shape::Aabb { min_world, max_world };
    [shape, aabb, oriented].map(|shape| Group { view, shape })
}

/// Whether the light is known not to reach the group.
fn is_apart(group: &Group, light: &Light) -> bool {
    let hull = group.hull(light.position.as_dvec3(), f64::from(light.range_m));
    let nearest = hull.nearest(DVec3::ZERO);
    nearest.length() > f64::from(light.range_m)
        || light.shape != LightShape::Point
            && wedges(light, nearest).iter().all(|wedge| overlap(&hull, wedge) == Overlap::Apart)
}

#[test]
fn rates_are_as_documented() {
    println!("false share of hits, % | point | spots of half angle 15, 45, 75, 90 degrees");
    let mut measured = [[0.0; 5]; ROWS];
    for (column, kind) in KINDS.into_iter().enumerate() {
        let mut rng = Pcg64Mcg::seed_from_u64(2019);
        let lights: Vec<Light> = (0..LIGHTS).map(|_| light(&mut rng, kind)).collect();
        let mut hits = [0_usize; ROWS];
        let mut wrong = [0_usize; ROWS];
        for _ in 0..CLUSTERS {
            let [frustum, aabb, oriented] = groups(&mut rng);
            let frusta = UNIONS.map(|tests| (frustum, union(tests)));
            let boxes = [aabb, oriented].map(|group| (group, FrustumTests::default()));
            for (row, (group, tests)) in frusta.into_iter().chain(boxes).enumerate() {
                let bounds = group.bounds();
                for light in lights.iter().filter(|l| bounds.reaches(l, tests)) {
                    hits[row] += 1;
                    wrong[row] += usize::from(is_apart(&group, light));
                }
            }
        }
        for row in 0..ROWS {
            // Enough hits for a standard error of 1 point.
            assert!(hits[row] > 2_000, "{hits:?}");
            measured[row][column] = 100.0 * wrong[row] as f64 / hits[row] as f64;
        }
    }
    for ((name, _), row) in DOCUMENTED.iter().zip(measured) {
        println!("{name} | {}", row.map(|share| format!("{share:.2}")).join(" | "));
    }
    for ((name, documented), row) in DOCUMENTED.iter().zip(measured) {
        for (documented, measured) in documented.iter().zip(row) {
            assert!(
                (documented - measured).abs() < 0.3,
                "{name}: documented {documented}, measured {measured}"
            );
        }
    }
}
