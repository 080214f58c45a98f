//! Tests of a file's cameras: their fields, their directions, and scenes far from the origin.

use glam::{DVec3, Quat, Vec3};
use serde_json::{Value, json};

use super::{error_with, load, sample};
use crate::{Lens, Scene};

/// The sample with another camera that stands still.
fn with_camera(camera: Value, node: Value) -> Scene {
    let mut sample = sample();
    sample.json["cameras"][0] = camera;
    sample.json["nodes"][3] = node;
    sample.json["animations"] = json!([]);
    load(&sample).expect("valid")
}

#[test]
fn faulty_fields_are_named_with_their_value() {
    let perspective = |field: &str, value: Value| {
        let mut lens = json!({"yfov": 1.0, "znear": 0.1, "zfar": 9.0, "aspectRatio": 1.5});
        lens[field] = value;
        json!({"type": "perspective", "perspective": lens})
    };
    let orthographic = |field: &str, value: Value| {
        let mut lens = json!({"xmag": 5, "ymag": 3, "znear": 0.1, "zfar": 9.0});
        lens[field] = value;
        json!({"type": "orthographic", "orthographic": lens})
    };
    let yfov = "above 0.000001 and below 3.138 radians";
    let size = "from 1e-9 to 1e12 metres";
    let cases = [
        (perspective("zfar", json!(0.0)), "perspective.zfar is 0: it must be above znear, 0.1 m"),
        (perspective("zfar", json!(0.1)), "perspective.zfar is 0.1: it must be above znear"),
        (perspective("zfar", json!(-1)), "perspective.zfar is -1: it must be above znear"),
        (perspective("zfar", json!(1e39)), "perspective.zfar is inf: it must be above znear"),
        (perspective("znear", json!(0)), "perspective.znear is 0: it must be from 1e-12 to"),
        (perspective("znear", json!(-2)), "perspective.znear is -2: it must be from 1e-12 to"),
        (perspective("znear", json!(1e39)), "perspective.znear is inf: it must be from 1e-12 to"),
        (perspective("yfov", json!(0)), &format!("perspective.yfov is 0: it must be {yfov}")),
        (perspective("yfov", json!(3.2)), &format!("perspective.yfov is 3.2: it must be {yfov}")),
        (perspective("aspectRatio", json!(0)), "perspective.aspectRatio is 0: it must be above 0"),
        (orthographic("zfar", json!(0)), "orthographic.zfar is 0: it must be above znear, 0.1 m"),
        (orthographic("znear", json!(-1)), "orthographic.znear is -1: it must be from 0 to 1e12"),
        (orthographic("xmag", json!(0)), &format!("orthographic.xmag is 0: it must be {size}")),
        (
            orthographic("ymag", json!(1e39)),
            &format!("orthographic.ymag is inf: it must be {size}"),
        ),
    ];
    for (camera, expected) in cases {
        let error = error_with("/cameras/0", camera);
        let expected = format!("sample.glb: cameras[0].{expected}");
        assert!(error.ends_with(&expected) || error.contains(&expected), "{error}");
    }
    // A camera that the scene does not place is not read.
    let mut unplaced = sample();
    unplaced.json["cameras"][0]["perspective"]["znear"] = json!(0);
    unplaced.json["nodes"][3] = json!({});
    unplaced.json["animations"] = json!([]);
    load(&unplaced).expect("valid without it");
}

#[test]
fn scale_and_flat_axes_do_not_turn_a_camera() {
    let lens = || json!({"type": "perspective", "perspective": {"yfov": 1.0, "znear": 0.1}});
    let turn = Quat::from_rotation_y(0.7) * Quat::from_rotation_x(-0.3);
    let node = |scale: [f32; 3]| json!({"camera": 0, "rotation": turn.to_array(), "scale": scale});
    for scale in
        [[1.0, 1.0, 1.0], [1e-30, 1e-30, 1e-30], [3.0, 0.5, 9.0], [2.0, 2.0, 0.0], [1.0, 0.0, 1.0]]
    {
        let pose = with_camera(lens(), node(scale)).cameras[0].pose;
        let (forward, up) = (turn * Vec3::NEG_Z, turn * Vec3::Y);
        assert!(pose.forward().distance(forward) < 1e-6, "{scale:?}: {}", pose.forward());
        assert!(pose.up.distance(up) < 1e-6, "{scale:?}: {}", pose.up);
    }
}

/// Puts everything under one node at a place.
fn moved_to(place: [f64; 3]) -> Scene {
    let mut sample = sample();
    let turn = Quat::from_rotation_y(0.7) * Quat::from_rotation_x(-0.3);
    let nodes = sample.json["nodes"].as_array_mut().expect("nodes");
    nodes[3] = json!({"camera": 0, "translation": [0.3, 0.7, 5.1], "rotation": turn.to_array()});
    nodes.push(json!({"translation": place, "children": [0, 3]}));
    sample.json["scenes"][0]["nodes"] = json!([4]);
    load(&sample).expect("valid")
}

/// A scene 1,000 and 100,000 km away equals the one at the origin, up to the digits of its own
/// size. So does its animated camera. In the file's coordinates it still stands where it stood.
#[test]
fn a_scene_far_from_the_origin_equals_one_at_it() {
    let near = moved_to([0.0; 3]);
    assert_eq!(near.origin, DVec3::ZERO);
    for place in [[1e6, 0.0, 1e6], [0.0, -1e8, 3.0], [20_000.0, 0.0, 0.0]] {
        let far = moved_to(place);
        let by = (DVec3::from(place) - far.origin).as_vec3();
        assert!(far.bounds.max.length() < 10.0, "{place:?}: {:?}", far.bounds);
        let off = |a: Vec3, b: Vec3| a.distance(b + by);
        let worst = near
            .world_triangles()
            .flatten()
            .zip(far.world_triangles().flatten())
            .map(|(near, far)| off(far, near))
            .fold(0.0, f32::max);
        assert!(worst < 1e-5, "{place:?}: {worst} m");
        assert!(off(far.lights[0].position, near.lights[0].position) < 1e-5, "{place:?}");
        for frame in 0..3 {
            let (near, far) = (near.path.pose(frame, 3), far.path.pose(frame, 3));
            assert!(off(far.eye, near.eye) < 1e-5, "{place:?}: {} {}", far.eye, near.eye);
            assert!(far.forward().distance(near.forward()) < 1e-6, "{place:?}: {far:?} {near:?}");
        }
        let (near, far) = (&near.cameras[0], &far.cameras[0]);
        assert!(far.pose.forward().distance(near.pose.forward()) < 1e-6, "{place:?}");
        assert!(matches!(far.lens, Lens::Perspective { fov_y } if fov_y == 1.0));
    }
    let scaled = moved_to([1e6, 0.0, 0.0]).scaled(2.0).expect("in range");
    assert!((scaled.origin.x - 2e6).abs() < 10.0, "{}", scaled.origin);
}

/// A camera under a node that is flat along one axis looks in the same direction with and without
/// an animation. A warning names the second animated camera.
#[test]
fn animated_cameras_keep_their_directions_and_others_are_named() {
    let mut sample = sample();
    let animated = sample.json["animations"][0].clone();
    let target = animated["channels"][0]["target"]["node"].as_u64().expect("a node") as usize;
    let still = {
        let mut still = sample.clone();
        still.json["animations"] = json!([]);
        still.json["nodes"][target]["scale"] = json!([1.0, 0.0, 1.0]);
        load(&still).expect("valid").cameras[0].pose.forward()
    };
    sample.json["nodes"][target]["scale"] = json!([1.0, 0.0, 1.0]);
    let channels = sample.json["animations"][0]["channels"].as_array_mut().expect("channels");
    channels.retain(|channel| channel["target"]["path"] == "translation");
    let scene = load(&sample).expect("valid");
    assert!(scene.path.pose(0, 3).forward().distance(still) < 1e-6, "{:?}", scene.path.pose(0, 3));
}

#[test]
fn transforms_must_be_affine() {
    let mut sample = sample();
    let mut matrix = [0.0; 16];
    (0..4).for_each(|ix| matrix[5 * ix] = 1.0);
    matrix[3] = 0.5;
    sample.json["nodes"][0] = json!({"mesh": 0, "matrix": matrix});
    let error = load(&sample).expect_err("projective").to_string();
    assert!(error.contains("nodes[0].matrix last row is [0.5, 0.0, 0.0, 1.0]"), "{error}");
}
