//! Tests of KHR_lights_punctual.

use glam::Vec3;
use serde_json::{Value, json};

use super::{Sample, load, sample};
use crate::Scene;

#[test]
fn faulty_lights_stay_to_be_reported() {
    let mut sample = sample();
    sample.json["extensions"]["KHR_lights_punctual"]["lights"] = json!([
        {"type": "point", "intensity": 1e39}, {"type": "point", "range": -2.0},
        {"type": "point", "intensity": 0.0}, {"type": "point", "intensity": -1.0},
        {"type": "point", "intensity": 1e39, "color": [0.0, 1.0, 1.0]},
        {"type": "spot", "spot": {"outerConeAngle": 9.0}}, {"type": "point"},
        {"type": "directional", "intensity": 1e39}]);
    let nodes = sample.json["nodes"].as_array_mut().expect("nodes");
    nodes[2] = json!({"children": [4, 5, 6, 7, 8, 9, 10, 11]});
    for light in 0..8 {
        nodes.push(json!({"extensions": {"KHR_lights_punctual": {"light": light}}}));
    }
    // Without the camera, the path is fitted to the scene and its lights.
    sample.json["scenes"][0]["nodes"] = json!([0]);
    let scene = load(&sample).expect("valid but for its lights");
    let faults = |scene: &Scene| -> Vec<_> {
        let fault = |light: &assign::Light| light.check().err().map(|fault| fault.to_string());
        let first = |fault: String| fault.split(" is ").next().unwrap_or_default().to_owned();
        scene.lights.iter().map(|light| fault(light).map(first).unwrap_or_default()).collect()
    };
    let expected =
        ["intensity", "range", "intensity", "intensity", "intensity", "spot outer angle", ""];
    assert_eq!(faults(&scene), expected);
    let inf = "light \"light 7\" is left out: sun irradiance is inf: it must be finite";
    assert_eq!((scene.warnings.clone(), scene.suns.len()), (vec![inf.to_owned()], 0));
    let pose = scene.path.pose(0, 10);
    assert!(pose.eye.is_finite() && pose.forward().is_finite());
    assert_eq!(scene.hash(), scene.clone().hash());
    assert_eq!(faults(&scene.scaled(1e-6).expect("in range"))[..6], expected[..6]);
}

/// The sample with these lights instead of its own. Each has its own node, which looks down.
fn lit_by(lights: Vec<Value>) -> Sample {
    let mut sample = sample();
    let nodes = sample.json["nodes"].as_array_mut().expect("nodes");
    let first = nodes.len();
    let down = json!([-0.5_f32.sqrt(), 0.0, 0.0, 0.5_f32.sqrt()]);
    for light in 0..lights.len() {
        let extensions = json!({"KHR_lights_punctual": {"light": light}});
        nodes.push(json!({"rotation": down, "scale": [3.0, 3.0, 3.0], "extensions": extensions}));
    }
    nodes[2] = json!({"children": (first..nodes.len()).collect::<Vec<_>>()});
    sample.json["extensions"]["KHR_lights_punctual"]["lights"] = lights.into();
    sample
}

#[test]
fn directional_lights_are_suns() {
    let sun = |irradiance: f64| json!({"type": "directional", "name": "sol", "intensity": irradiance, "color": [1.0, 0.5, 0.0]});
    let scene = load(&lit_by(vec![sun(3.0), sun(0.0), sun(-1.0), sun(9.0)])).expect("valid");
    assert!(scene.lights.is_empty());
    assert_eq!(scene.suns.len(), 2);
    assert_eq!(scene.suns[0].irradiance, Vec3::new(3.0, 1.5, 0.0));
    assert!(scene.suns[0].direction.distance(Vec3::NEG_Y) < 1e-6, "{:?}", scene.suns);
    let left_out = |value: &str| format!("light \"sol\" is left out: sun irradiance is {value}");
    assert_eq!(scene.warnings.len(), 2, "{:?}", scene.warnings);
    assert!(scene.warnings[0].starts_with(&left_out("0")), "{:?}", scene.warnings);
    assert!(scene.warnings[1].starts_with(&left_out("-1")), "{:?}", scene.warnings);
    let scaled = scene.clone().scaled(10.0).expect("in range").replicated(2).expect("in range");
    assert_eq!(scaled.suns, scene.suns);
    let mut dark = scene.clone();
    dark.suns.clear();
    assert_ne!(scene.hash(), dark.hash());
    let nine = load(&lit_by(vec![sun(1.0); 9])).expect_err("nine").to_string();
    assert!(nine.contains("sample.glb") && nine.ends_with("is 9: it must be at most 8"), "{nine}");
}

#[test]
fn lights_without_a_range_light_the_whole_scene() {
    let lamp = |intensity: f64| json!({"type": "point", "intensity": intensity});
    let ended = json!({"type": "point", "intensity": 0.001, "range": 2.5});
    let scene = load(&lit_by(vec![lamp(0.05), ended.clone()])).expect("valid");
    assert_eq!(scene.open_lights, [0]);
    assert!(scene.lights[0].range_m > 4.9 * scene.core_bounds.diagonal(), "{:?}", scene.lights);
    assert_eq!(scene.lights[1].range_m, 2.5);
    assert_eq!(scene.replicated(2).expect("in range").open_lights, [0, 2, 4, 6]);
    let bright = load(&lit_by(vec![lamp(200.0)])).expect("valid");
    assert_eq!(bright.lights[0].range_m, 100.0);
}
