//! Tests of material extensions, vertex colours, quantized vertices and WebP.

use glam::{Vec2, Vec4};

use super::{
    valid::{add_accessor, add_view, assert_warns},
    *,
};
use crate::{Dielectric, Material};

fn with_extensions(extensions: Value) -> Result<Material, SceneError> {
    let mut sample = sample();
    sample.json["materials"][0]["extensions"] = extensions;
    Ok(load(&sample)?.materials[0].clone())
}

#[test]
fn ior_and_specular_make_reflectances() {
    let dielectric = |extensions| with_extensions(extensions).expect("valid").dielectric;
    assert_eq!(dielectric(json!({})), Dielectric::default());
    assert_eq!(dielectric(json!({"KHR_materials_ior": {}})), Dielectric::default());
    let water = dielectric(json!({"KHR_materials_ior": {"ior": 1.33}}));
    assert!((water.f0.x - 0.02006).abs() < 1e-5 && water.f90 == 1.0, "{water:?}");
    // 0 stands for an infinite index.
    assert_eq!(dielectric(json!({"KHR_materials_ior": {"ior": 0}})).f0, Vec3::ONE);
    let tinted = json!({"KHR_materials_specular":
        {"specularFactor": 0.5, "specularColorFactor": [2.0, 1.0, 100.0]}});
    let tinted = dielectric(tinted);
    assert_eq!((tinted.f0, tinted.f90), (Vec3::new(0.04, 0.02, 0.5), 0.5));
    let matte = dielectric(json!({"KHR_materials_specular": {"specularFactor": 0}}));
    assert_eq!(matte, Dielectric::BLACK);
    for (extensions, expected) in [
        (json!({"KHR_materials_ior": {"ior": 0.5}}), "KHR_materials_ior.ior is 0.5"),
        (json!({"KHR_materials_specular": {"specularFactor": 2}}), "specularFactor is 2"),
        (
            json!({"KHR_materials_specular": {"specularColorFactor": [-1, 0, 0]}}),
            "specularColorFactor is [-1, 0, 0]",
        ),
    ] {
        let error = with_extensions(extensions).expect_err("faulty").to_string();
        assert!(error.contains(expected), "{error}");
    }
    let mut textured = sample();
    textured.json["materials"][0]["extensions"] =
        json!({"KHR_materials_specular": {"specularColorTexture": {"index": 0}}});
    assert_warns(
        &load(&textured).expect("valid"),
        "specularColorTexture of KHR_materials_specular is ignored",
    );
}

#[test]
fn specular_and_glossiness_make_a_dielectric() {
    let glossy =
        |value: Value| with_extensions(json!({"KHR_materials_pbrSpecularGlossiness": value}));
    let coin = json!({"diffuseFactor": [0.5, 0.25, 0.0, 1.0], "specularFactor": [0.5, 0.4, 0.1],
        "glossinessFactor": 0.75, "diffuseTexture": {"index": 0}});
    let coin = glossy(coin).expect("valid");
    assert_eq!(coin.base_color, Vec4::new(0.5, 0.25, 0.0, 1.0));
    assert_eq!((coin.metallic, coin.roughness), (0.0, 0.25));
    let expected = Dielectric { f0: Vec3::new(0.5, 0.4, 0.1), f90: 1.0 };
    assert_eq!(coin.dielectric, expected);
    assert!(coin.base_color_texture.is_some() && coin.metallic_roughness_texture.is_none());
    for (value, expected) in [
        (json!({"diffuseTexture": {"index": 9}}), "below 1"),
        (json!({"glossinessFactor": 2}), "between 0 and 1"),
        (json!({"diffuseFactor": 1}), "invalid type"),
    ] {
        let error = glossy(value).expect_err("faulty").to_string();
        assert!(error.contains(expected), "{error}");
    }
    let mut textured = sample();
    textured.json["materials"][0]["extensions"] = json!({"KHR_materials_pbrSpecularGlossiness":
        {"specularGlossinessTexture": {"index": 0}}});
    let scene = load(&textured).expect("valid");
    assert_eq!((scene.materials[0].roughness, scene.materials[0].metallic), (0.5, 0.0));
    assert_warns(&scene, "specularGlossinessTexture is ignored");
}

#[test]
fn unlit_materials_emit_their_colour_and_reflect_nothing() {
    let mut unlit = sample();
    let material = &mut unlit.json["materials"][0];
    material["extensions"] = json!({"KHR_materials_unlit": {}});
    material["pbrMetallicRoughness"]["baseColorFactor"] = json!([0.5, 0.25, 1.0, 0.75]);
    let scene = load(&unlit).expect("valid");
    let material = &scene.materials[0];
    assert!(material.unlit && material.normal_texture.is_none());
    assert_eq!(material.emissive, Vec3::new(0.5, 0.25, 1.0));
    assert_eq!(material.emissive_texture, material.base_color_texture);
    assert_eq!(material.base_color, Vec4::new(0.0, 0.0, 0.0, 0.75));
    assert_eq!((material.metallic, material.dielectric), (0.0, Dielectric::BLACK));
    assert!(scene.warnings.is_empty(), "{:?}", scene.warnings);
}

#[test]
fn colours_of_vertices_follow_their_vertices() {
    let colors = [[255_u8, 0, 0, 255], [0, 255, 0, 255], [0, 0, 255, 255], [255, 255, 255, 0]];
    let mut colored = sample();
    let hash = load(&colored).expect("valid").hash();
    let accessor = json!({"componentType": 5121, "normalized": true, "type": "VEC4", "count": 4});
    let ix = add_accessor(&mut colored, colors.as_flattened(), accessor);
    let attributes = &mut colored.json["meshes"][0]["primitives"][0]["attributes"];
    attributes["COLOR_0"] = ix.into();
    let scene = load(&colored).expect("valid");
    assert_ne!(scene.hash(), hash);
    let expected = [
        [1.0, 0.0, 0.0, 1.0],
        [0.0, 1.0, 0.0, 1.0],
        [0.0, 0.0, 1.0, 1.0],
        [1.0, 1.0, 1.0, 0.0_f32],
    ];
    assert_eq!(scene.meshes[0].colors, expected);
    // Flat normals give every corner a vertex of its own.
    colored.json["meshes"][0]["primitives"][0]["attributes"] =
        json!({"POSITION": 0, "COLOR_0": ix});
    let flat = load(&colored).expect("valid");
    assert_eq!(flat.meshes[0].colors.len(), flat.meshes[0].vertices.len());
    for (vertex, color) in flat.meshes[0].vertices.iter().zip(&flat.meshes[0].colors) {
        let corner = POSITIONS.iter().position(|p| *p == vertex.position).expect("a corner");
        assert_eq!(*color, expected[corner]);
    }
    // White colours cost nothing.
    let white = json!({"componentType": 5121, "normalized": true, "type": "VEC3", "count": 4});
    let ix = add_accessor(&mut colored, &[255; 12], white);
    colored.json["meshes"][0]["primitives"][0]["attributes"]["COLOR_0"] = ix.into();
    assert!(load(&colored).expect("valid").meshes[0].colors.is_empty());
}

#[test]
fn quantized_vertices_are_read() {
    let mut small = sample();
    let positions: Vec<u8> = POSITIONS
        .iter()
        .flat_map(|p| p.map(|x| (x * 100.0) as i16).into_iter().chain([0]))
        .flat_map(i16::to_le_bytes)
        .collect();
    let ix = add_accessor(
        &mut small,
        &positions,
        json!({"componentType": 5122, "type": "VEC3", "count": 4}),
    );
    let view = small.json["accessors"][ix]["bufferView"].as_u64().expect("a view") as usize;
    small.json["bufferViews"][view]["byteStride"] = 8.into();
    let normals = add_accessor(
        &mut small,
        &[0, 0, 127].repeat(4),
        json!({"componentType": 5120, "normalized": true, "type": "VEC3", "count": 4}),
    );
    let uvs = add_accessor(
        &mut small,
        &[0, 255, 255, 255, 255, 0, 0, 0],
        json!({"componentType": 5121, "normalized": true, "type": "VEC2", "count": 4}),
    );
    small.json["meshes"][0]["primitives"][0]["attributes"] =
        json!({"POSITION": ix, "NORMAL": normals, "TEXCOORD_0": uvs});
    small.json["extensionsRequired"] = json!(["KHR_mesh_quantization"]);
    small.json["nodes"][0]["scale"] = json!([0.01, 0.01, 0.01]);
    let scene = load(&small).expect("valid");
    let plain = load(&sample()).expect("valid");
    for (a, b) in scene.meshes[0].vertices.iter().zip(&plain.meshes[0].vertices) {
        assert_eq!(a.position, b.position.map(|x| x * 100.0));
        assert_eq!((a.normal, Vec2::from(a.uv)), (b.normal, Vec2::from(b.uv)));
    }
}

#[test]
fn webp_textures_are_decoded() {
    // A lossless image of one pixel.
    let webp = base64::engine::general_purpose::STANDARD
        .decode("UklGRhoAAABXRUJQVlA4TA0AAAAvAAAAEAcQERGIiP4HAA==")
        .expect("base64");
    let mut webp_only = sample();
    let view = add_view(&mut webp_only, &webp);
    webp_only.json["images"] = json!([{"mimeType": "image/webp", "bufferView": view}]);
    webp_only.json["textures"] = json!([{"extensions": {"EXT_texture_webp": {"source": 0}}}]);
    webp_only.json["extensionsRequired"] = json!(["EXT_texture_webp"]);
    let scene = load(&webp_only).expect("valid");
    assert_eq!((scene.images[0].width, scene.images[0].height), (1, 1));
    assert!(scene.warnings.is_empty(), "{:?}", scene.warnings);
    // KTX2 is not supported: a warning names its texture.
    webp_only.json["textures"] = json!([{"extensions": {"KHR_texture_basisu": {"source": 0}}}]);
    webp_only.json["extensionsRequired"] = json!(["KHR_texture_basisu"]);
    let scene = load(&webp_only).expect("valid");
    assert!(scene.materials[0].base_color_texture.is_none());
    assert_warns(&scene, "KHR_texture_basisu");
}

#[test]
fn blend_and_transmission_make_transparent_materials() {
    let plain = with_extensions(json!({})).expect("valid");
    assert!(!plain.is_transparent());
    let extension =
        |factor: f32| json!({"KHR_materials_transmission": {"transmissionFactor": factor}});
    let clear = with_extensions(extension(0.75)).expect("valid");
    assert_eq!((clear.transmission, clear.is_blended, clear.is_transparent()), (0.75, false, true));
    // The same file, with a texture, and drawn without it.
    let mut textured = sample();
    textured.json["materials"][0]["extensions"] = json!({"KHR_materials_transmission":
        {"transmissionFactor": 0.5, "transmissionTexture": {"index": 0}}});
    assert_warns(
        &load(&textured).expect("valid"),
        "transmissionTexture of KHR_materials_transmission",
    );
    for factor in [-0.5, 1.5] {
        let error = with_extensions(extension(factor)).expect_err("faulty").to_string();
        assert!(error.contains("transmissionFactor is"), "{error}");
    }
    let mut blended = sample();
    blended.json["materials"][0]["alphaMode"] = "BLEND".into();
    let blended = load(&blended).expect("valid");
    let glass = &blended.materials[0];
    assert!(glass.is_blended && glass.is_transparent() && glass.alpha_cutoff == Some(0.5));
    assert_warns(&blended, "unless transparent surfaces are drawn");
    assert_ne!(blended.hash(), load(&sample()).expect("valid").hash());
}
