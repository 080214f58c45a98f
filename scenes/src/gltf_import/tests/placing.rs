//! Tests of extensions and skins that place meshes.

use super::{
    valid::{add_accessor, add_floats, assert_warns},
    *,
};

/// The sample whose second node is drawn many times by EXT_mesh_gpu_instancing.
fn instanced(attributes: Value) -> Sample {
    let mut sample = sample();
    sample.json["nodes"][1] = json!({"mesh": 0, "translation": [0, 0, 1],
        "extensions": {"EXT_mesh_gpu_instancing": {"attributes": attributes}}});
    sample
}

#[test]
fn instances_are_models() {
    let mut sample = instanced(json!({}));
    let at = add_floats(&mut sample, &[-3.0, 0.0, 0.0, 0.0, 0.0, 0.0, 3.0, 0.0, 0.0], "VEC3");
    let scale = add_floats(&mut sample, &[1.0, 1.0, 1.0, 2.0, 2.0, 2.0, 1.0, -1.0, 1.0], "VEC3");
    // Rotations in normalised bytes: none, none, and half a turn about Z.
    let turns = [[0_i8, 0, 0, 127], [0, 0, 0, 127], [0, 0, 127, 0]];
    let turns: Vec<u8> = turns.as_flattened().iter().flat_map(|v| v.to_le_bytes()).collect();
    let bytes = json!({"componentType": 5120, "normalized": true, "type": "VEC4", "count": 3});
    let rotation = add_accessor(&mut sample, &turns, bytes);
    sample.json["nodes"][1]["extensions"]["EXT_mesh_gpu_instancing"]["attributes"] =
        json!({"TRANSLATION": at, "ROTATION": rotation, "SCALE": scale});
    let scene = load(&sample).expect("valid");
    assert_eq!((scene.models.len(), scene.triangle_count()), (4, 8));
    let corner = |model: usize| scene.models[model].object_to_world.transform_point3(Vec3::ONE);
    assert!((corner(1) - Vec3::new(-2.0, 1.0, 2.0)).length() < 1e-6, "{}", corner(1));
    assert!((corner(2) - Vec3::new(2.0, 2.0, 3.0)).length() < 1e-6, "{}", corner(2));
    assert!((corner(3) - Vec3::new(2.0, 1.0, 2.0)).length() < 1e-6, "{}", corner(3));
    assert!(scene.warnings.is_empty(), "{:?}", scene.warnings);
    // Counts that differ, and an accessor that does not exist.
    let short = add_floats(&mut sample, &[1.0; 6], "VEC3");
    let attributes = "/nodes/1/extensions/EXT_mesh_gpu_instancing/attributes";
    for (scale, expected) in [(json!(short), "SCALE count is 2"), (json!(99), "SCALE is 99")] {
        sample.json.pointer_mut(attributes).expect("there")["SCALE"] = scale;
        let error = load(&sample).expect_err("faulty").to_string();
        assert!(error.contains(expected), "{error}");
    }
}

#[test]
fn too_many_instances_are_refused() {
    let mut sample = instanced(json!({"TRANSLATION": 6}));
    let accessors = sample.json["accessors"].as_array_mut().expect("accessors");
    accessors.push(json!({"count": 1 << 22, "componentType": 5126, "type": "VEC3"}));
    let error = load(&sample).expect_err("too many").to_string();
    assert!(error.contains("at most 4194304 models"), "{error}");
}

#[test]
fn hidden_nodes_hide_what_is_below_them() {
    let mut sample = sample();
    let hidden = json!({"KHR_node_visibility": {"visible": false}});
    sample.json["nodes"][1]["extensions"] = hidden.clone();
    assert_eq!(load(&sample).expect("valid").triangle_count(), 2);
    sample.json["nodes"][1]["extensions"] = json!({"KHR_node_visibility": {"visible": true}});
    assert_eq!(load(&sample).expect("valid").triangle_count(), 4);
    // Node 4 is drawn. Node 0 and everything below it, its light included, are not.
    sample.json["nodes"][0]["extensions"] = hidden;
    sample.json["nodes"].as_array_mut().expect("nodes").push(json!({"mesh": 0}));
    sample.json["scenes"][0]["nodes"] = json!([0, 3, 4]);
    let scene = load(&sample).expect("valid");
    assert_eq!((scene.triangle_count(), scene.lights.len(), scene.cameras.len()), (2, 0, 1));
    assert!(scene.warnings.is_empty(), "{:?}", scene.warnings);
}

/// Node 1 holds the mesh and node 4 is the joint. The first vertex follows node 5.
fn skinned() -> Sample {
    let mut sample = sample();
    let joints = [[0_u8, 1, 0, 0]; 4];
    let bytes = json!({"componentType": 5121, "type": "VEC4", "count": 4});
    let joints = add_accessor(&mut sample, joints.as_flattened(), bytes);
    let mut weights = [[1.0_f32, 0.0, 0.0, 0.0]; 4];
    weights[0] = [0.0, 0.5, 0.0, 0.0];
    let weights = add_floats(&mut sample, weights.as_flattened(), "VEC4");
    // The second joint's inverse bind matrix cancels its own place, except for 7 along Y.
    let mut inverse_bind = [glam::Mat4::IDENTITY.to_cols_array(); 2];
    inverse_bind[1] = glam::Mat4::from_translation(Vec3::new(-9.0, 7.0, 0.0)).to_cols_array();
    let matrices = add_floats(&mut sample, inverse_bind.as_flattened(), "MAT4");
    let attributes = &mut sample.json["meshes"][0]["primitives"][0]["attributes"];
    attributes["JOINTS_0"] = joints.into();
    attributes["WEIGHTS_0"] = weights.into();
    sample.json["skins"] = json!([{"joints": [4, 5], "inverseBindMatrices": matrices}]);
    sample.json["nodes"][1] = json!({"mesh": 0, "skin": 0, "translation": [50, 0, 0]});
    let half = std::f32::consts::FRAC_1_SQRT_2;
    let nodes = sample.json["nodes"].as_array_mut().expect("nodes");
    nodes.push(json!({"translation": [2, 0, 0], "rotation": [0, half, 0, half]}));
    nodes.push(json!({"translation": [9, 0, 0]}));
    sample.json["scenes"][0]["nodes"] = json!([0, 3, 4, 5]);
    sample
}

#[test]
fn joints_place_skinned_meshes_and_their_node_does_not() {
    let scene = load(&skinned()).expect("valid");
    assert_eq!((scene.models.len(), scene.triangle_count()), (2, 4));
    let mesh = &scene.meshes[scene.instances[1].mesh as usize];
    assert_eq!(scene.models[1].object_to_world, glam::Mat4::IDENTITY);
    // A quarter turn about Y takes X to -Z and Z to X.
    let expected = [[0.0, 7.0, 0.0], [2.0, 0.0, -1.0], [2.0, 1.0, -1.0], [2.0, 1.0, 0.0]];
    for (vertex, expected) in mesh.vertices.iter().zip(expected) {
        let place = Vec3::from(vertex.position);
        assert!((place - Vec3::from(expected)).length() < 1e-6, "{place}");
    }
    for (vertex, normal) in mesh.vertices.iter().zip([Vec3::Z, Vec3::X, Vec3::X, Vec3::X]) {
        assert!((Vec3::from(vertex.normal) - normal).length() < 1e-6, "{vertex:?}");
    }
    assert!(scene.warnings.is_empty(), "{:?}", scene.warnings);
    // Node 0, which has no skin, draws the mesh itself.
    assert_eq!(
        scene.meshes[scene.instances[0].mesh as usize].vertices[1].position,
        [1.0, 0.0, 0.0]
    );
}

#[test]
fn skins_that_cannot_pose_are_named() {
    let mut outside = skinned();
    outside.json["scenes"][0]["nodes"] = json!([0, 3, 4]);
    assert_warns(&load(&outside).expect("valid"), "skin 0: joints lie outside the scene");
    let mut unbound = skinned();
    let attributes = &mut unbound.json["meshes"][0]["primitives"][0]["attributes"];
    attributes.as_object_mut().expect("attributes").remove("JOINTS_0");
    assert_warns(&load(&unbound).expect("valid"), "without JOINTS_0");
    let mut one = skinned();
    one.json["skins"][0]["joints"] = json!([4]);
    let error = load(&one).expect_err("joint 1 of 1").to_string();
    assert!(error.contains("JOINTS_0 is out of range: it must be below 1"), "{error}");
    let mut animated = skinned();
    animated.json["animations"][0]["channels"][0]["target"]["node"] = 4.into();
    assert_warns(&load(&animated).expect("valid"), "the first is \"node 4\"");
}

/// Odd values replace every number of a skin, of instances and of an area light.
#[test]
fn odd_values_of_skins_and_instances_never_panic() {
    let mut whole = skinned();
    let at = add_floats(&mut whole, &[0.0; 9], "VEC3");
    whole.json["nodes"][0]["extensions"] = json!({"EXT_mesh_gpu_instancing":
        {"attributes": {"TRANSLATION": at, "SCALE": at}}, "EXT_lights_area": {"light": 0}});
    whole.json["extensions"]["EXT_lights_area"] =
        json!({"lights": [{"type": "disc", "size": 1, "intensity": 1, "color": [1, 1, 1]}]});
    load(&whole).expect("valid");
    let mut pointers = Vec::new();
    leaves(&whole.json, String::new(), &mut pointers);
    let new = [
        "/skins",
        "/nodes/0",
        "/nodes/1",
        "/extensions/EXT_lights_area",
        "/accessors/6",
        "/accessors/7",
        "/accessors/8",
        "/accessors/9",
        "/meshes",
    ];
    pointers.retain(|pointer| new.iter().any(|start| pointer.starts_with(start)));
    assert!(pointers.len() > 40, "{pointers:?}");
    for pointer in &pointers {
        for value in odd_values() {
            let mut json = whole.json.clone();
            *json.pointer_mut(pointer).expect("a leaf") = value;
            // A scene or an error is accepted, a panic is not.
            let _ = load(&Sample { json, binary: whole.binary.clone() });
        }
    }
}
