//! How often each test says "reaches" for a light that does not reach: the table in
//! `assign::intersect`. To print it: `cargo test -p lightbench-assign --test intersect rates -- --nocapture`.

use assign::{Emitter, FrustumTests, Light, LightShape, View};
use glam::{DVec3, Mat3, Vec2, Vec3};
use rand::{RngExt, SeedableRng};
use rand_pcg::Pcg64Mcg;

use crate::groups::{Group, Shape, UNIONS, union};
use crate::oracle::{Overlap, overlap, wedges};

const CLUSTERS: usize = 600;
const LIGHTS: usize = 8_000;
/// The unions of tests on frusta, and two kinds of boxes.
const ROWS: usize = UNIONS.len() + 2;
/// Size of Sponza, metres (Enhuber 2019, table 4.2). Lights lie in this box; the camera is at one
/// end.
const SCENE_M: Vec3 = Vec3::new(37.2, 15.6, 22.9);

#[derive(Clone, Copy, Debug)]
enum Kind {
    Point,
    /// Half angle of the cone, degrees.
    Spot(f32),
    /// A one-sided emitter with half axes of 0.1 to 1 m: a rectangle (2), or a polygon with this
    /// number of vertices.
    Area(usize),
}

const COLUMNS: usize = 8;
const KINDS: [Kind; COLUMNS] = [
    Kind::Point,
    Kind::Spot(15.0),
    Kind::Spot(45.0),
    Kind::Spot(75.0),
    Kind::Spot(90.0),
    Kind::Area(2),
    Kind::Area(3),
    Kind::Area(6),
];
/// The documented share of false hits, per cent: one row per test, one column per kind.
const DOCUMENTED: [(&str, [f64; COLUMNS]); 9] = [
    ("hs", [36.0, 21.7, 25.7, 32.0, 34.8, 31.9, 36.2, 37.0]),
    ("sat-e", [60.3, 71.5, 64.1, 61.8, 61.3, 55.3, 58.7, 58.9]),
    ("sat-n", [53.5, 86.7, 76.1, 66.6, 63.0, 43.9, 49.6, 48.6]),
    ("sat-p", [35.1, 21.4, 25.0, 31.3, 34.0, 31.1, 35.5, 36.3]),
    ("sat-v", [41.1, 79.7, 66.0, 55.0, 51.1, 32.5, 39.2, 38.2]),
    ("hs+sat-n", [6.5, 20.4, 15.2, 14.5, 14.1, 8.2, 15.0, 15.3]),
    ("hs+sat-e+sat-p+sat-v", [5.5, 17.6, 12.8, 12.3, 12.1, 6.5, 13.6, 13.7]),
    ("box", [0.0, 16.7, 12.5, 7.6, 5.8, 2.1, 8.6, 7.3]),
    ("oriented box", [0.0, 16.5, 11.5, 7.5, 5.5, 2.0, 8.8, 7.3]),
];

/// The comparison paper's radii: a gamma distribution with alpha 4/3 and beta 0.75 (Enhuber 2019,
/// section 4.2), drawn by the method of Marsaglia and Tsang 2000.
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

fn light(rng: &mut Pcg64Mcg, kind: Kind) -> Light {
    let position = between(rng, -0.5 * SCENE_M, 0.5 * SCENE_M);
    let mut light = Light::point(position, radius(rng).max(0.01), Vec3::ONE);
    let direction = between(rng, Vec3::NEG_ONE, Vec3::ONE).normalize();
    match kind {
        Kind::Point => {}
        Kind::Spot(degrees) => {
            let outer_angle = degrees.to_radians();
            light.shape = LightShape::Spot { direction, inner_angle: 0.0, outer_angle };
        }
        Kind::Area(vertices) => {
            let x = direction.any_orthonormal_vector() * rng.random_range(0.1..1.0);
            let y = direction.cross(x).normalize() * rng.random_range(0.1..1.0);
            if vertices == 2 {
                light.shape = LightShape::Area(Emitter::rectangle(x, y));
            } else {
                let angle = |ix: usize| std::f32::consts::TAU * ix as f32 / vertices as f32;
                let corner = |ix| light.position + x * angle(ix).cos() + y * angle(ix).sin();
                let corners: Vec<Vec3> = (0..vertices).map(corner).collect();
                let (emitter, center) = Emitter::polygon(&corners).unwrap();
                (light.shape, light.position) = (LightShape::Area(emitter), center);
            }
        }
    }
    light
}

/// A cluster of 64x64 pixels at 1920x1080 with 24 exponential slices from 0.1 to 100 m, and the
/// boxes around it along the world's axes and along the view's.
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

/// Whether the light certainly does not reach the group.
fn is_apart(group: &Group, light: &Light) -> bool {
    let radius = f64::from(light.radius_m());
    let hull = group.hull(light.position.as_dvec3(), radius);
    let nearest = hull.nearest(DVec3::ZERO);
    nearest.length() > radius
        || light.shape != LightShape::Point
            && wedges(light, nearest).iter().all(|wedge| overlap(&hull, wedge) == Overlap::Apart)
}

/// The share of false hits of each test, per cent.
fn measure(kind: Kind) -> [f64; ROWS] {
    let mut rng = Pcg64Mcg::seed_from_u64(2019);
    let lights: Vec<Light> = (0..LIGHTS).map(|_| light(&mut rng, kind)).collect();
    let mut hits = [0_usize; ROWS];
    let mut wrong = [0_usize; ROWS];
    for _ in 0..CLUSTERS {
        let [frustum, aabb, oriented] = groups(&mut rng);
        let alone = || vec![FrustumTests::default()];
        let frusta = UNIONS.map(union).to_vec();
        let mut first = 0;
        for (group, tests) in [(frustum, frusta), (aabb, alone()), (oriented, alone())] {
            let bounds = group.bounds();
            for light in &lights {
                // All tests of a shape have the same exact answer.
                let mut apart = None;
                for (row, tests) in (first..).zip(&tests) {
                    if bounds.reaches(light, *tests) {
                        hits[row] += 1;
                        let is_apart = *apart.get_or_insert_with(|| is_apart(&group, light));
                        wrong[row] += usize::from(is_apart);
                    }
                }
            }
            first += tests.len();
        }
    }
    // This many hits give a standard error of 1 percentage point.
    assert!(hits.iter().all(|hits| *hits > 2_000), "too few hits: {hits:?}");
    std::array::from_fn(|row| 100.0 * wrong[row] as f64 / hits[row] as f64)
}

#[test]
fn rates_are_as_documented() {
    println!(
        "false share of hits, % | point | spots of half angle 15, 45, 75, 90 degrees | rectangle, triangle, hexagon"
    );
    let columns = std::thread::scope(|scope| {
        let all = KINDS.map(|kind| scope.spawn(move || measure(kind)));
        all.map(|column| column.join().expect("measures"))
    });
    let measured: [[f64; COLUMNS]; ROWS] =
        std::array::from_fn(|row| columns.map(|column| column[row]));
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
