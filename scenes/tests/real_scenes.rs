//! Tests of the real scenes that measurements use, where they are present.

use std::{io::Write, path::PathBuf};

use scenes::{Scene, load_gltf};

/// The file below `$LIGHTBENCH_SCENES` or `../shared/scenes` beside the workspace. If it is absent,
/// prints so and returns `None`.
fn open(file: &str) -> Option<Scene> {
    let beside = || PathBuf::from(env!("CARGO_MANIFEST_DIR")).join("../../shared/scenes");
    let folder = std::env::var_os("LIGHTBENCH_SCENES").map_or_else(beside, PathBuf::from);
    let path = folder.join(file);
    if !path.exists() {
        // Write straight to stderr, because tests show what eprintln! writes only when they fail.
        let line = format!("skipped: {} is absent, nothing was tested\n", path.display());
        let _ = std::io::stderr().write_all(line.as_bytes());
        return None;
    }
    Some(load_gltf(&path).expect("a valid scene"))
}

#[test]
fn sponza() {
    let Some(scene) = open("crytek-sponza/Sponza.gltf") else { return };
    assert_eq!(scene.triangle_count(), 262_267);
    assert_eq!((scene.meshes.len(), scene.images.len()), (25, 64));
    assert_eq!(scene.core_bounds, scene.bounds);
    // Inside the court, between the columns and below the roof.
    let eye = scene.path.pose(0, 1200).eye;
    assert!(eye.x.abs() < 10.0 && eye.z.abs() < 2.5 && (0.5..8.0).contains(&eye.y), "{eye}");
}

#[test]
fn candela_city_has_a_core() {
    let Some(scene) = open("stk-candela-city/scene.gltf") else { return };
    assert_eq!((scene.triangle_count(), scene.lights.len()), (431_624, 70));
    assert_eq!(scene.name, "stk-candela-city");
    assert!(scene.bounds.size().x > 4000.0 && scene.core_bounds.size().x < 1000.0);
    for frame in 0..1200 {
        assert!(scene.core_bounds.contains(scene.path.pose(frame, 1200).eye));
    }
}

#[test]
fn munich_is_many_models() {
    let Some(scene) = open("city-munich/scene.gltf") else { return };
    assert_eq!((scene.triangle_count(), scene.models.len()), (38_936, 2_367));
    assert!(scene.warnings.is_empty(), "{:?}", scene.warnings);
}

#[test]
fn boombox_is_seen_from_outside() {
    let Some(scene) = open("boombox/BoomBox.glb") else { return };
    assert_eq!((scene.triangle_count(), scene.images.len()), (6_036, 4));
    assert!(!scene.bounds.contains(scene.path.pose(0, 1200).eye));
}

#[test]
fn punctual_lights() {
    let Some(scene) = open("lights-punctual-test/gltf_KHR_lights_punctual_test.glb") else {
        return;
    };
    assert_eq!((scene.lights.len(), scene.cameras.len()), (2, 1));
    assert_eq!(scene.suns.len(), 1);
    let (path, camera) = (scene.path.pose(0, 1200), scene.cameras[0].pose);
    assert!(path.eye == camera.eye && path.forward().dot(camera.forward()) > 0.9999);
}
