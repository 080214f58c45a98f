//! What the scenarios promise.

use std::collections::BTreeSet;

use assign::{LightFault, LightShape, View};
use glam::{DVec3, Vec3};

use super::*;
use crate::{Camera, Framing, Lens, SceneError};

/// All rows but the heavy ones, which take seconds to make without optimisation.
fn rows() -> impl Iterator<Item = &'static Scenario> {
    list().iter().filter(|scenario| !scenario.heavy)
}

fn open(name: &str) -> Scene {
    crate::open(&format!("{PREFIX}{name}")).expect(name)
}

/// The view of a scenario's camera, without its framing.
fn view(scene: &Scene) -> View {
    let Camera { pose, lens, near_m, far_m, .. } = scene.cameras[0];
    let fov_y = if let Lens::Perspective { fov_y } = lens { fov_y } else { 1.0 };
    let mut view = View::looking(pose.eye, pose.forward(), pose.up, fov_y, near_m, [160, 90]);
    if let Lens::Orthographic { half_width, half_height } = lens {
        let corner = glam::Vec2::new(half_width, half_height);
        view.projection = assign::Projection::Orthographic { min: -corner, max: corner };
    }
    view.far_m = far_m;
    view
}

/// View depth of a point.
fn depth_m(scene: &Scene, point: Vec3) -> f32 {
    -view(scene).world_to_view.transform_point3(point).z
}

/// Points of a triangle, 28 in all.
fn points_on([a, b, c]: [Vec3; 3]) -> impl Iterator<Item = DVec3> {
    let [a, b, c] = [a, b, c].map(Vec3::as_dvec3);
    let shares = (0..7).flat_map(|u| (0..7 - u).map(move |v| (f64::from(u), f64::from(v))));
    shares.map(move |(u, v)| a + (b - a) * (u / 6.0) + (c - a) * (v / 6.0))
}

#[test]
fn every_number_is_there_and_every_name_is_unique() {
    let names: BTreeSet<_> = list().iter().map(|scenario| scenario.name).collect();
    assert_eq!(names.len(), list().len());
    let numbers: BTreeSet<u32> = list().iter().filter_map(|scenario| scenario.number).collect();
    assert_eq!(numbers, (1..=34).collect());
    for scenario in list() {
        let Scenario { name, breaks, .. } = scenario;
        let is_kebab = |c: char| c.is_ascii_lowercase() || c.is_ascii_digit() || c == '-';
        assert!(name.chars().all(is_kebab), "{name}");
        assert!(breaks.ends_with('.') && !breaks[..breaks.len() - 1].contains(". "), "{name}");
        assert_eq!(scenario.number.is_none(), scenario.group == Group::Reported, "{name}");
    }
}

#[test]
fn every_scene_shows_geometry_and_its_lights_reach_it() {
    for scenario in rows() {
        let Scenario { name, .. } = scenario;
        let scene = open(name);
        assert_eq!(scene.name, scenario.id());
        assert!(scene.bounds.min.is_finite() && scene.bounds.max.is_finite(), "{name}");
        assert!((2..20_000).contains(&scene.triangle_count()), "{name}");
        let view = view(&scene);
        assert_eq!(view.check(), Ok(()), "{name}");
        let span = scene.depths_shown(&view).expect(name);
        assert!(span.nearest_m < f64::from(view.far_m.unwrap_or(f32::MAX)), "{name}: {span:?}");
        let points: Vec<DVec3> = scene.world_triangles().flat_map(points_on).collect();
        let reaches = |light: &&assign::Light| points.iter().any(|point| light.reach(*point) > 0.0);
        let good = scene.lights.iter().filter(|light| light.check().is_ok());
        let (good, reaching) = (good.clone().count(), good.filter(reaches).count());
        // Many lights only graze a surface between these points, or hang in a void on purpose.
        assert!(reaching * 25 >= good, "{name}: {reaching} of {good} lights reach a surface");
        assert!(reaching > 0 || *name == "count-0", "{name}: no light");
        for mesh in &scene.meshes {
            assert!(mesh.triangle_count() > 0, "{name}: {mesh:?}");
            assert!((mesh.material as usize) < scene.materials.len(), "{name}");
        }
    }
}

/// Faulty lights are there on purpose, and nowhere else.
#[test]
fn only_the_scenarios_of_faulty_lights_hold_any() {
    for scenario in rows() {
        let scene = open(scenario.name);
        let faults: Vec<LightFault> =
            scene.lights.iter().filter_map(|light| light.check().err()).collect();
        let not_finite =
            faults.iter().filter(|fault| matches!(fault, LightFault::NotFinite { .. })).count();
        match scenario.name {
            "degenerate-lights" => assert_eq!((faults.len(), not_finite), (8, 0), "{faults:?}"),
            "non-finite-lights" => assert_eq!((faults.len(), not_finite), (12, 12), "{faults:?}"),
            name => assert!(faults.is_empty(), "{name}: {faults:?}"),
        }
    }
}

#[test]
fn one_seed_gives_one_scene() {
    for scenario in rows() {
        let scene = |seed| scenario.open(None, seed).expect("opens");
        let (one, again, other) = (scene(1), scene(1), scene(2));
        assert_eq!((one.hash(), one.path_hash()), (again.hash(), again.path_hash()));
        let few = one.lights.len() < 2 || scenario.name == "long-rectangle";
        assert!(few || one.hash() != other.hash(), "{}", scenario.name);
    }
}

#[test]
fn ids_name_moves_and_refuse_others() {
    for scenario in rows() {
        let moves: Vec<Move> = scenario.camera_moves().collect();
        let still = open(scenario.name);
        assert_eq!(still.path.moves(), !moves.is_empty(), "{}", scenario.name);
        for way in moves {
            let scene = crate::open(&scenario.id_with(way)).expect("its own move");
            assert_eq!(scene.hash(), still.hash());
            let poses: Vec<_> = (0..8).map(|frame| scene.path.pose(frame, 8)).collect();
            let is_still = poses.iter().all(|pose| *pose == poses[0]);
            assert!(!is_still, "{} {way:?}", scenario.name);
        }
    }
    let error = crate::open("stability:sub-pixel-moves:teleport").expect_err("no such move");
    assert!(matches!(error, SceneError::Move { .. }));
    let line = error.to_string();
    assert!(line.contains("dolly or rotation") && line.contains("teleport"), "{line}");
}

/// A point moves by less than a pixel of an image with 1,080 lines in each frame.
#[test]
fn small_moves_are_smaller_than_a_pixel() {
    let way = |way: &str| crate::open(&format!("stability:sub-pixel-moves:{way}")).expect("a move");
    for scene in [way("dolly"), way("rotation")] {
        let pixel = |frame: u32, point: Vec3| {
            let pose = scene.path.pose(frame, 60);
            let view = View::looking(pose.eye, pose.forward(), pose.up, 1.0, 0.1, [1920, 1080]);
            let clip = view.world_to_clip() * point.extend(1.0);
            clip.truncate().truncate() / clip.w * glam::Vec2::new(960.0, 540.0)
        };
        let point = Vec3::new(0.0, 1.2, -7.0);
        for frame in 0..60 {
            let step = pixel(frame, point).distance(pixel(frame + 1, point));
            assert!((0.3..1.0).contains(&step), "frame {frame}: {step} pixels");
        }
    }
}

#[test]
fn all_lights_of_6_lie_beyond_the_far_plane_and_reach_in() {
    let scene = open("beyond-far-lights");
    let far_m = view(&scene).far_m.expect("a far plane");
    for light in &scene.lights {
        let depth_m = depth_m(&scene, light.position);
        assert!(depth_m > far_m && depth_m - light.range_m < far_m, "{light:?}");
    }
    let span = scene.depths_shown(&view(&scene)).expect("surfaces");
    assert!(span.farthest_m < f64::from(far_m), "{span:?}");
}

#[test]
fn lights_of_7_to_9_stand_as_promised() {
    let inside = open("inside-lights");
    let eye = inside.cameras[0].pose.eye;
    assert!(inside.lights.iter().all(|light| light.reach(eye.as_dvec3()) > 0.0));
    let behind = open("behind-camera");
    for light in &behind.lights {
        let depth_m = depth_m(&behind, light.position);
        assert!(depth_m < 0.0 && depth_m + light.range_m > 0.0, "{light:?}");
    }
    let at_eye = open("light-at-eye");
    let eye = at_eye.cameras[0].pose.eye;
    assert_eq!(at_eye.lights.iter().filter(|light| light.position == eye).count(), 5);
    assert!(at_eye.lights.iter().filter(|light| light.position.y == 0.0).count() >= 80);
}

#[test]
fn planes_and_framings_are_as_promised() {
    let camera = |name: &str| open(name).cameras[0].clone();
    assert_eq!(camera("thin-near-slices").near_m, 0.001);
    let endless = camera("infinite-far");
    assert!(endless.far_m.is_none() && endless.framing.is_endless);
    let flat = camera("orthographic-near-0");
    assert!(flat.near_m == 0.0 && matches!(flat.lens, Lens::Orthographic { .. }));
    assert_ne!(camera("off-centre-window").framing.shift, glam::Vec2::ZERO);
    assert_ne!(camera("sub-pixel-jitter").framing.jitter_px, glam::Vec2::ZERO);
    assert_ne!(camera("viewport-offset").framing.before_px, [0; 2]);
    assert_ne!(camera("split-screen").framing.after_px, [0; 2]);
    assert_ne!(camera("odd-size").framing.less_px, [0; 2]);
    assert!(camera("mirrored-view").framing.is_mirrored);
    let mirror = camera("oblique-near-plane");
    let plane = mirror.framing.clip_plane.expect("a plane");
    assert!(mirror.framing.is_mirrored && plane.dot(mirror.pose.eye.extend(1.0)) < -1.0);
    assert_eq!(camera("standard-depth").framing.depth, assign::DepthMapping::Standard);
    assert_eq!(camera("tile-corner-light").framing, Framing::PLAIN);
    let far = open("range-beyond-far");
    let far_m = far.cameras[0].far_m.expect("a far plane");
    assert!(far.lights.iter().filter(|light| light.range_m > far_m).count() >= 20);
}

/// The file's coordinates are a thousand kilometres away, and those of the renderer near 0.
#[test]
fn scenario_24_is_rebased_and_its_neighbour_is_not() {
    let rebased = open("far-from-origin");
    assert!((rebased.origin.length() - 1e6).abs() < 1e3, "{}", rebased.origin);
    assert!(rebased.bounds.max.abs().max_element() < 100.0);
    let huge = open("huge-coordinates");
    assert_eq!(huge.origin, DVec3::ZERO);
    assert!((huge.cameras[0].pose.eye.length() - 1e5).abs() < 1e3);
    assert!(huge.lights.iter().all(|light| light.position.length() > 9e4));
}

#[test]
fn counts_are_exact() {
    for (name, count) in [
        ("count-0", 0),
        ("count-1", 1),
        ("count-31", 31),
        ("count-33", 33),
        ("count-65537", 65_537),
    ] {
        assert_eq!(open(name).lights.len(), count, "{name}");
    }
    assert!(named("count-1048577").expect("a row").heavy);
    let crowded = open("crowded-group");
    let (first, rest) = crowded.lights.split_first().expect("lights");
    let near = rest.iter().filter(|light| light.position.distance(first.position) < 0.1).count();
    assert_eq!(near, 1_999);
    let coincident = open("coincident-centres");
    let place = coincident.lights[0].position;
    assert_eq!(coincident.lights.iter().filter(|light| light.position == place).count(), 500);
}

#[test]
fn shapes_are_as_promised() {
    let spots = open("spot-angles");
    let angles: Vec<f32> = spots
        .lights
        .iter()
        .filter_map(|light| match light.shape {
            LightShape::Spot { outer_angle, .. } => Some(outer_angle),
            _ => None,
        })
        .collect();
    let has = |low: f32, high: f32| angles.iter().any(|angle| (low..=high).contains(angle));
    assert!(
        has(0.0, 2e-5) && has(0.78, 0.79) && has(1.57, 1.571) && has(2.5, 2.7) && has(3.1, 3.2)
    );
    for light in &open("long-rectangle").lights {
        let LightShape::Area(emitter) = light.shape else { panic!("{light:?}") };
        let [x, y] = emitter.half_axes().map(Vec3::length);
        assert!((y / x - 100.0).abs() < 1e-3 && light.range_m < y, "{light:?}");
    }
    let determinants = |name: &str| -> Vec<f32> {
        open(name).models.iter().map(|model| model.object_to_world.determinant()).collect()
    };
    assert!(determinants("odd-transforms").iter().any(|d| *d < 0.0));
    assert!(determinants("negative-scale").iter().filter(|d| **d < 0.0).count() >= 8);
    let vpls = open("vpl-on-surface");
    assert!(vpls.lights.iter().all(|light| matches!(light.shape, LightShape::Vpl { .. })));
}

/// A pose is shown twice in a row, and two cameras are shown in turn.
#[test]
fn cuts_repeat_and_alternate() {
    let twice = open("same-frame-twice").path;
    for frame in 0..4 {
        assert_eq!(twice.pose(2 * frame, 64), twice.pose(2 * frame + 1, 64));
        assert_ne!(twice.pose(2 * frame, 64), twice.pose(2 * frame + 2, 64));
    }
    let two = open("two-cameras").path;
    assert_eq!(two.pose(0, 64), two.pose(2, 64));
    assert_eq!(two.pose(1, 64), two.pose(3, 64));
    assert_ne!(two.pose(0, 64), two.pose(1, 64));
}

/// The middle of the lights is the middle of the scene and of the image.
#[test]
fn the_lights_at_a_corner_are_where_cells_meet() {
    let scene = open("lights-at-cell-corner");
    let corner = scene.lights[0].position;
    assert_eq!(corner, scene.bounds.center());
    assert_eq!(scene.lights.iter().filter(|light| light.position == corner).count(), 400);
    let clip = view(&scene).world_to_clip() * corner.extend(1.0);
    assert_eq!((clip.x, clip.y), (0.0, 0.0));
}
