//! Tests of area lights in `extras` and by EXT_lights_area.

use assign::LightKind;

use super::{valid::assert_warns, *};

/// The sample with an area light on its first node.
fn with_area_light(light: Value) -> Result<Scene, SceneError> {
    let mut sample = sample();
    sample.json["nodes"][0]["extras"] = json!({ "someone": 1, "lightbench_area_light": light });
    load(&sample)
}

#[test]
fn extras_carry_area_lights() {
    let rectangle = json!({
        "shape": "rectangle", "width": 2.0, "height": 4.0, "intensity": 8.0, "range": 5.0,
        "two_sided": true, "diffuse_share": 0.5
    });
    let scene = with_area_light(rectangle).expect("valid");
    let light = scene.lights.iter().find(|l| l.kind() == LightKind::Rectangle).expect("there");
    light.check().expect("sound");
    let LightShape::Area(emitter) = light.shape else { panic!("{light:?}") };
    assert_eq!((emitter.area(), light.range_m, light.intensity), (8.0, 5.0, Vec3::splat(8.0)));
    assert_eq!((emitter.normal(), emitter.two_sided), (Vec3::NEG_Z, true));
    assert_eq!(light.diffuse_range_m(), 2.5);
    let triangle = json!({ "shape": "polygon", "vertices": [[0, 0, 1], [1, 0, 1], [0, 1, 1]] });
    let scene = with_area_light(triangle).expect("valid");
    let light = scene.lights.iter().find(|l| l.kind() == LightKind::Polygon).expect("there");
    let LightShape::Area(emitter) = light.shape else { panic!("{light:?}") };
    assert!((emitter.normal() - Vec3::Z).length() < 1e-6 && (emitter.area() - 0.5).abs() < 1e-6);
    let scaled = scene.scaled(3.0).expect("in range");
    let light = scaled.lights.iter().find(|l| l.kind() == LightKind::Polygon).expect("there");
    let LightShape::Area(emitter) = light.shape else { panic!("{light:?}") };
    assert!((emitter.area() - 4.5).abs() < 1e-5);
}

#[test]
fn errors_of_area_lights_name_the_field() {
    let error = |light| with_area_light(light).expect_err("faulty").to_string();
    let missing = error(json!({ "shape": "rectangle", "width": 1.0 }));
    assert!(missing.contains("nodes[0].extras.lightbench_area_light"), "{missing}");
    assert!(missing.contains("width and height"), "{missing}");
    let turned = error(json!({ "shape": "rectangle", "width": -1.0, "height": 1.0 }));
    assert!(turned.contains("above 0"), "{turned}");
    let misspelt = error(json!({ "shape": "rectangle", "width": 1, "height": 1, "colour": 1 }));
    assert!(misspelt.contains("colour"), "{misspelt}");
    let disc = error(json!({ "shape": "disc" }));
    assert!(disc.contains("radius above 0"), "{disc}");
    let flat = error(json!({ "shape": "sphere", "radius": 0.0 }));
    assert!(flat.contains("radius above 0"), "{flat}");
    let short = error(json!({ "shape": "line", "radius": 0.1 }));
    assert!(short.contains("length and radius"), "{short}");
    let round = error(json!({ "shape": "rectangle", "width": 1, "height": 1, "radius": 1 }));
    assert!(round.contains("radius only for a disc"), "{round}");
    let wide = error(json!({ "shape": "sphere", "radius": 1, "width": 1 }));
    assert!(wide.contains("a disc or a sphere"), "{wide}");
    let mut sample = sample();
    sample.json["nodes"][0]["extras"] =
        json!({ "lightbench_area_light": { "shape": "sphere", "radius": 1 } });
    sample.json["nodes"][0]["scale"] = json!([1, 2, 1]);
    let stretched = load(&sample).expect_err("faulty").to_string();
    assert!(stretched.contains("alike along all axes"), "{stretched}");
    let line = error(json!({ "shape": "polygon", "vertices": [[0, 0, 0], [1, 0, 0]] }));
    assert!(line.contains("vertex count is 2"), "{line}");
}

#[test]
fn extras_carry_curved_area_lights() {
    let emitter = |light, kind| {
        let scene = with_area_light(light).expect("valid");
        let light = *scene.lights.iter().find(|l| l.kind() == kind).expect("there");
        light.check().expect("sound");
        let hash = scene.hash();
        let scaled = scene.scaled(2.0).expect("in range");
        let LightShape::Area(emitter) = light.shape else { panic!("{light:?}") };
        let twice = scaled.lights.iter().find(|l| l.kind() == kind).expect("there");
        let LightShape::Area(twice) = twice.shape else { panic!("{twice:?}") };
        assert_eq!(twice.radius_m(), 2.0 * emitter.radius_m());
        (emitter, light.intensity, hash)
    };
    let sphere = json!({ "shape": "sphere", "radius": 0.5, "intensity": 3.0 });
    let (found, intensity, hash) = emitter(sphere, LightKind::Sphere);
    assert_eq!((found.radius_m(), intensity), (0.5, Vec3::splat(3.0)));
    let larger = json!({ "shape": "sphere", "radius": 0.6, "intensity": 3.0 });
    assert_ne!(emitter(larger, LightKind::Sphere).2, hash);
    let disc = json!({ "shape": "disc", "radius": 0.5, "two_sided": true });
    let (found, _, hash) = emitter(disc, LightKind::Disc);
    assert!((found.normal() - Vec3::NEG_Z).length() < 1e-6 && found.two_sided, "{found:?}");
    let one_sided = json!({ "shape": "disc", "radius": 0.5 });
    assert_ne!(emitter(one_sided, LightKind::Disc).2, hash);
    let line = json!({ "shape": "line", "radius": 0.1, "length": 3.0 });
    let (found, ..) = emitter(line, LightKind::Line);
    assert_eq!((found.half_axes()[0], found.radius_m()), (Vec3::X * 1.5, 0.1));
}

/// The sample with a light of EXT_lights_area on its third node, which looks along -Z.
fn with_area_extension(light: Value) -> Result<Scene, SceneError> {
    let mut sample = sample();
    sample.json["extensions"]["EXT_lights_area"] = json!({"lights": [light]});
    sample.json["nodes"][2]["extensions"] = json!({"EXT_lights_area": {"light": 0}});
    sample.json["nodes"][2]["scale"] = json!([2, 2, 2]);
    load(&sample)
}

#[test]
fn ext_lights_area_gives_area_lights() {
    let emitter_of = |scene: &Scene| {
        scene.lights[0].check().expect("sound");
        match scene.lights[0].shape {
            LightShape::Area(emitter) => (emitter, scene.lights[0].intensity),
            other => panic!("{other:?}"),
        }
    };
    let rectangle = json!({"type": "rect", "intensity": 100.0, "size": 0.5, "rect": {"aspect": 2},
        "color": [1.0, 0.5, 0.25]});
    let scene = with_area_extension(rectangle).expect("valid");
    let (emitter, intensity) = emitter_of(&scene);
    // The node's scale doubles the size in the file. 100 cd on each of 2 square metres.
    assert_eq!((emitter.area(), emitter.normal()), (2.0, Vec3::NEG_Z));
    assert_eq!(intensity, Vec3::new(200.0, 100.0, 50.0));
    assert!(scene.warnings.is_empty(), "{:?}", scene.warnings);
    let disc = json!({"type": "disc", "intensity": 10.0, "size": 1.0});
    let scene = with_area_extension(disc).expect("valid");
    let (emitter, _) = emitter_of(&scene);
    assert_eq!((scene.lights[0].kind(), scene.warnings.len()), (LightKind::Disc, 0));
    assert!((emitter.area() / std::f32::consts::PI - 1.0).abs() < 1e-5, "{}", emitter.area());
    assert!((emitter.normal() - Vec3::NEG_Z).length() < 1e-5, "{}", emitter.normal());
    let mut stretched = sample();
    stretched.json["extensions"]["EXT_lights_area"] = json!({"lights": [{"type": "disc"}]});
    stretched.json["nodes"][2]["extensions"] = json!({"EXT_lights_area": {"light": 0}});
    stretched.json["nodes"][2]["scale"] = json!([1, 2, 1]);
    let scene = load(&stretched).expect("valid");
    assert_eq!(scene.lights[0].kind(), LightKind::Polygon);
    assert_warns(&scene, "stretches to an ellipse");
    let odd = with_area_extension(json!({"type": "tube", "name": "neon"})).expect("valid");
    assert!(odd.lights.is_empty());
    assert_warns(
        &odd,
        "light \"neon\" is left out: EXT_lights_area type \"tube\" is not supported",
    );
    for (light, expected) in [
        (json!({"type": "rect", "size": 0}), "size and aspect above 0"),
        (json!({"size": 1}), "missing field `type`"),
    ] {
        let error = with_area_extension(light).expect_err("faulty").to_string();
        assert!(error.contains(expected) && error.contains("lights[0]"), "{error}");
    }
}
