//! Tests of animated lights.

use assign::Light;
use glam::DVec3;

use super::{
    valid::{add_floats, assert_warns},
    *,
};

/// A channel: node, property, key times, values, interpolation.
type Channel<'a> = (usize, &'a str, &'a [f32], &'a [f32], &'a str);

/// The sample with an animation of these channels instead of its own, behind `others`.
fn animated_by(mut sample: Sample, channels: &[Channel]) -> Sample {
    let (mut samplers, mut json_channels) = (Vec::new(), Vec::new());
    for (ix, (node, path, times, values, interpolation)) in channels.iter().enumerate() {
        let input = add_floats(&mut sample, times, "SCALAR");
        let kind = if *path == "rotation" { "VEC4" } else { "VEC3" };
        let output = add_floats(&mut sample, values, kind);
        samplers.push(json!({"input": input, "output": output, "interpolation": interpolation}));
        json_channels.push(json!({"sampler": ix, "target": {"node": node, "path": path}}));
    }
    sample.json["animations"] =
        json!([{"name": "swing", "samplers": samplers, "channels": json_channels}]);
    sample
}

fn load_animated(channels: &[Channel]) -> Scene {
    load(&animated_by(sample(), channels)).expect("valid")
}

/// The sample's spot at a time.
fn spot_at(scene: &Scene, time_s: f32) -> (Vec3, Vec3) {
    let light = lights_at(scene, time_s)[0];
    light.check().expect("sound");
    let LightShape::Spot { direction, .. } = light.shape else { panic!("{light:?}") };
    (light.position, direction)
}

fn lights_at(scene: &Scene, time_s: f32) -> Vec<Light> {
    let mut lights = scene.lights.clone();
    scene.light_animation.as_ref().expect("animated").pose_lights(time_s, &mut lights);
    lights
}

fn assert_near((a, b): (Vec3, Vec3), position: Vec3, direction: Vec3) {
    assert!(a.distance(position) < 1e-5 && b.distance(direction) < 1e-5, "{a} {b}");
}

/// One metre from the light at (0, 0, 3) to (4, 0, 3) and back.
const TIMES: [f32; 3] = [1.0, 3.0, 5.0];
const PLACES: [f32; 9] = [0.0, 0.0, 3.0, 4.0, 0.0, 3.0, 0.0, 0.0, 3.0];

#[test]
fn keys_move_a_light_in_a_loop() {
    let scene = load_animated(&[(2, "translation", &TIMES, &PLACES, "LINEAR")]);
    assert!(scene.warnings.is_empty(), "{:?}", scene.warnings);
    let animation = scene.light_animation.as_ref().expect("animated");
    assert_eq!((animation.count(), animation.duration_s()), (1, 4.0));
    // At rest, the light stands where its node does.
    assert_eq!(scene.lights, load(&sample()).expect("valid").lights);
    for round in [0.0, 4.0, 4000.0, -4.0] {
        for (time_s, x) in [(0.0, 0.0), (0.5, 1.0), (2.0, 4.0), (3.0, 2.0)] {
            assert_near(spot_at(&scene, round + time_s), Vec3::new(x, 0.0, 3.0), Vec3::NEG_Z);
        }
    }
    assert_eq!(spot_at(&scene, 0.7), spot_at(&scene, 0.7));
    // The same keys as steps, and as a spline without tangents.
    let steps = load_animated(&[(2, "translation", &TIMES, &PLACES, "STEP")]);
    assert_near(spot_at(&steps, 1.9), Vec3::Z * 3.0, Vec3::NEG_Z);
    assert_near(spot_at(&steps, 2.1), Vec3::new(4.0, 0.0, 3.0), Vec3::NEG_Z);
    let flat = [0.0; 3];
    let spline: Vec<f32> = PLACES.chunks(3).flat_map(|v| [&flat, v, &flat].concat()).collect();
    let spline = load_animated(&[(2, "translation", &TIMES, &spline, "CUBICSPLINE")]);
    let share = 3.0 * 0.25_f32.powi(2) - 2.0 * 0.25_f32.powi(3);
    assert_near(spot_at(&spline, 0.5), Vec3::new(4.0 * share, 0.0, 3.0), Vec3::NEG_Z);
    // Another animation gives another hash, and so does none.
    let still = load(&animated_by(sample(), &[(3, "scale", &[0.0], &[1.0; 3], "LINEAR")]));
    let hashes = [scene, steps, spline, still.expect("valid")].map(|scene| scene.hash());
    assert!((0..4).all(|ix| !hashes[ix + 1..].contains(&hashes[ix])), "{hashes:?}");
}

#[test]
fn nodes_above_a_light_turn_and_scale_it() {
    let half = 0.5_f32.sqrt();
    let turns = [0.0, 0.0, 0.0, 1.0, 0.0, half, 0.0, half];
    let scales = [1.0, 1.0, 1.0, 1.0, 1.0, 0.0];
    let mut sample = sample();
    // A still node between the turning one and the light.
    let light = sample.json["nodes"][2].take();
    let nodes = sample.json["nodes"].as_array_mut().expect("nodes");
    nodes[2] = json!({"children": [4], "translation": [0.0, 1.0, 0.0]});
    nodes.push(light);
    let turned = [(0, "rotation", &[0.0, 1.0][..], &turns[..], "LINEAR")];
    let scene = load(&animated_by(sample.clone(), &turned)).expect("valid");
    assert_warns(&scene, "those of 1 animated nodes stay at rest; the first is \"node 0\"");
    assert_near(spot_at(&scene, 0.0), Vec3::new(0.0, 1.0, 3.0), Vec3::NEG_Z);
    // Half a quarter turn about Y takes Z to (1, 0, 1) / sqrt(2).
    let (x, y) = (3.0 * half, Vec3::new(-half, 0.0, -half));
    assert_near(spot_at(&scene, 0.5), Vec3::new(x, 1.0, x), y);
    // A scale moves the light, but a scale of 0 does not turn it.
    let below = (4, "rotation", turned[0].2, turned[0].3, "LINEAR");
    let scaled = [(0, "scale", &[0.0, 0.25][..], &scales[..], "STEP"), below];
    let scene = load(&animated_by(sample, &scaled)).expect("valid");
    assert_near(spot_at(&scene, 0.5), Vec3::Y, y);
    let animation = scene.light_animation.as_ref().expect("animated");
    assert_eq!((animation.limbs.len(), animation.limbs[1].parent), (2, Some(0)));
}

#[test]
fn scaling_copying_and_far_origins_keep_the_motion() {
    let scene = load_animated(&[(2, "translation", &TIMES, &PLACES, "LINEAR")]);
    let size = scene.bounds.size();
    let copies = scene.clone().replicated(2).expect("in range").scaled(2.0).expect("in range");
    assert_eq!(copies.light_animation.as_ref().expect("animated").count(), 4);
    for time_s in [0.0, 0.5, 2.0] {
        let (place, _) = spot_at(&scene, time_s);
        let lights = lights_at(&copies, time_s);
        let offsets = [Vec3::ZERO, Vec3::Z * size, Vec3::X * size, (Vec3::X + Vec3::Z) * size];
        for (light, (rest, offset)) in lights.iter().zip(copies.lights.iter().zip(offsets)) {
            assert!(light.position.distance(2.0 * (place + offset)) < 1e-4, "{light:?}");
            assert_eq!((light.range_m, light.intensity), (rest.range_m, rest.intensity));
        }
    }
    // Scaled first and copied later, lights stand at the same places.
    let other = scene.clone().scaled(2.0).expect("in range").replicated(2).expect("in range");
    assert_eq!(lights_at(&other, 0.5), lights_at(&copies, 0.5));
    let mut far = animated_by(sample(), &[(2, "translation", &TIMES, &PLACES, "LINEAR")]);
    let nodes = far.json["nodes"].as_array_mut().expect("nodes");
    nodes.push(json!({"translation": [1e6, 0.0, -1e7], "children": [0, 3]}));
    far.json["scenes"][0]["nodes"] = json!([4]);
    let far = load(&far).expect("valid");
    assert_ne!(far.origin, DVec3::ZERO);
    let by = (DVec3::new(1e6, 0.0, -1e7) - far.origin).as_vec3();
    for time_s in [0.0, 0.5, 2.0] {
        let (place, direction) = spot_at(&scene, time_s);
        assert_near(spot_at(&far, time_s), place + by, direction);
    }
}

#[test]
fn all_animations_play_and_the_first_channel_wins() {
    let first = animated_by(sample(), &[(2, "translation", &TIMES, &PLACES, "LINEAR")]);
    let half = 0.5_f32.sqrt();
    let turn = [0.0, half, 0.0, half];
    let later = [
        (2, "translation", &[0.0][..], &[9.0; 3][..], "LINEAR"),
        (2, "rotation", &[0.0][..], &turn[..], "LINEAR"),
    ];
    let mut both = animated_by(first.clone(), &later);
    both.json["animations"] =
        json!([first.json["animations"][0].clone(), both.json["animations"][0].clone()]);
    let scene = load(&both).expect("valid");
    assert_near(spot_at(&scene, 3.0), Vec3::new(4.0, 0.0, 3.0), Vec3::NEG_X);
    assert_near(spot_at(&scene, 0.5), Vec3::Z * 3.0, Vec3::NEG_X);
    assert_warns(&scene, "1 channels are not played");
}

#[test]
fn one_key_and_nodes_with_a_matrix_stand_still() {
    let scene = load_animated(&[(2, "translation", &[7.0], &[1.0, 2.0, 3.0], "LINEAR")]);
    for time_s in [0.0, 1.0, 1e6, -3.0, f32::NAN, f32::INFINITY] {
        assert_near(spot_at(&scene, time_s), Vec3::new(1.0, 2.0, 3.0), Vec3::NEG_Z);
    }
    let mut matrix = animated_by(sample(), &[(2, "translation", &TIMES, &PLACES, "LINEAR")]);
    let light = matrix.json["nodes"][2]["extensions"].take();
    let identity = glam::Mat4::IDENTITY.to_cols_array();
    matrix.json["nodes"][2] = json!({"matrix": identity, "extensions": light, "name": "lamp"});
    let scene = load(&matrix).expect("valid");
    assert!(scene.light_animation.is_none());
    assert_warns(&scene, "animations[0].channels[0] is not played: its node \"lamp\" has a matrix");
}

#[test]
fn suns_area_lights_and_hidden_lights_stay_at_rest() {
    let moved = animated_by(sample(), &[(2, "translation", &TIMES, &PLACES, "LINEAR")]);
    let mut sun = moved.clone();
    sun.json["extensions"]["KHR_lights_punctual"]["lights"] = json!([{"type": "directional"}]);
    let mut area = moved.clone();
    area.json["nodes"][2]["extensions"] = json!({"EXT_lights_area": {"light": 0}});
    area.json["extensions"]["EXT_lights_area"] = json!({"lights": [{"type": "rect"}]});
    for still in [sun, area] {
        let scene = load(&still).expect("valid");
        assert!(scene.light_animation.is_none());
        assert_warns(&scene, "those of 1 animated nodes stay at rest; the first is \"node 2\"");
    }
    let mut hidden = moved;
    hidden.json["nodes"][2]["extensions"]["KHR_node_visibility"] = json!({"visible": false});
    assert!(load(&hidden).expect("valid").light_animation.is_none());
}

#[test]
fn files_with_only_lights_move_too() {
    let mut only = animated_by(sample(), &[(2, "translation", &TIMES, &PLACES, "LINEAR")]);
    only.json["scenes"][0]["nodes"] = json!([2]);
    only.json["nodes"][0]["children"] = json!([1]);
    let folder = tempfile::tempdir().expect("a temporary folder");
    let path = folder.path().join("lights.glb");
    std::fs::write(&path, glb(&only)).expect("writes");
    let mut scene = crate::open_lights(&path.to_string_lossy(), DVec3::X).expect("lights");
    crate::close_ranges(&mut scene.lights, 10.0);
    assert_near(spot_at(&scene, 2.0), Vec3::new(3.0, 0.0, 3.0), Vec3::NEG_Z);
}

#[test]
fn hostile_keys_are_refused_and_named() {
    let nan = f32::NAN;
    let cases: [(&[f32], &[f32], &str, &str); 9] = [
        (&[0.0, nan, 2.0], &PLACES, "LINEAR", "(key times) is not increasing"),
        (&[nan; 3], &PLACES, "LINEAR", "(key times) is not increasing"),
        (&[0.0, 1.0, f32::INFINITY], &PLACES, "LINEAR", "(key times) is not increasing"),
        (&[0.0, 2.0, 1.0], &PLACES, "LINEAR", "(key times) is not increasing"),
        (&[1.0, 1.0, 1.0], &PLACES, "LINEAR", "(key times) is not increasing"),
        (&[1.0, 2.0], &PLACES, "LINEAR", "(keys) is 3: it must be 2, 1 per key"),
        (&TIMES, &PLACES, "CUBICSPLINE", "(keys) is 3: it must be 9, 3 per key"),
        (&[], &PLACES, "LINEAR", "count is 0"),
        (&[1.0], &[nan; 3], "STEP", "(keys) is not finite"),
    ];
    let sound = (0, "scale", &TIMES[..], &[1.0; 9][..], "LINEAR");
    for (times, values, interpolation, expected) in cases {
        let channels = [sound, (2, "translation", times, values, interpolation)];
        let error = load(&animated_by(sample(), &channels)).expect_err(expected).to_string();
        assert!(error.contains("sample.glb: animations[0].channels[1]: acc"), "{error}");
        assert!(error.contains(expected), "{error}");
    }
    let sampler = |field: &str, value: Value| {
        let mut faulty = animated_by(sample(), &[(2, "translation", &TIMES, &PLACES, "LINEAR")]);
        faulty.json["animations"][0]["samplers"][0][field] = value;
        load(&faulty).expect_err(field).to_string()
    };
    let error = sampler("output", json!(3));
    assert!(error.contains("animations[0].channels[0]: accessors[3].type is"), "{error}");
    let error = sampler("input", json!(99));
    assert!(error.contains("animations[0].samplers[0].input"), "{error}");
    // Accessors without data cost nothing, but may not add up without end.
    let mut long = animated_by(sample(), &[(2, "translation", &TIMES, &PLACES, "LINEAR")]);
    let accessors = long.json["accessors"].as_array_mut().expect("accessors");
    accessors.push(json!({"count": 1 << 24, "componentType": 5126, "type": "VEC3"}));
    let last = accessors.len() - 1;
    long.json["animations"][0]["samplers"][0]["output"] = last.into();
    let error = load(&long).expect_err("too long").to_string();
    assert!(error.contains("channels[0]: keys of lights so far is 16777219"), "{error}");
}

/// Huge but finite numbers: places may overflow, and then the light stays where it was.
#[test]
fn places_that_overflow_leave_the_light_at_rest() {
    let huge = [3e38_f32; 6];
    let channels: [Channel; 3] = [
        (0, "scale", &[-3e38, 3e38], &huge, "LINEAR"),
        (2, "translation", &[0.0, 1.0], &huge, "CUBICSPLINE"),
        (2, "rotation", &[0.0, 1.0], &[0.0; 8], "LINEAR"),
    ];
    let mut splines = channels;
    let tripled = [huge, huge, huge].concat();
    splines[1].3 = &tripled;
    let scene = load_animated(&splines);
    for time_s in [0.0, 0.5, 1e30, 3e38] {
        for light in lights_at(&scene, time_s) {
            light.check().expect("sound");
        }
    }
}

#[test]
fn odd_values_of_animated_lights_never_panic() {
    let half = 0.5_f32.sqrt();
    let whole = animated_by(
        sample(),
        &[
            (2, "translation", &TIMES, &PLACES, "LINEAR"),
            (0, "rotation", &[0.0, 1.0], &[0.0, 0.0, 0.0, 1.0, 0.0, half, 0.0, half], "STEP"),
        ],
    );
    let mut pointers = Vec::new();
    leaves(&whole.json, String::new(), &mut pointers);
    let new = ["/animations", "/nodes", "/accessors/6", "/accessors/7", "/accessors/8"];
    pointers.retain(|pointer| new.iter().any(|start| pointer.starts_with(start)));
    let (mut moving, mut refused) = (0, 0);
    for pointer in &pointers {
        for value in odd_values() {
            let mut json = whole.json.clone();
            *json.pointer_mut(pointer).expect("a leaf") = value;
            let Ok(scene) = load(&Sample { json, binary: whole.binary.clone() }) else {
                refused += 1;
                continue;
            };
            if scene.light_animation.is_some() {
                moving += 1;
                lights_at(&scene, 0.3);
            }
        }
    }
    assert!(moving > 20 && refused > 20, "{moving} moving, {refused} refused");
}
