//! Tests that shadows end where geometry says.

use assign::{Light, Sun, Suns};
use glam::{DVec3, Vec3};
use scenes::{Encoding, Image, Material, Scene, TextureRef};
use shading::{
    LightBvh,
    reference::{light_contribution, sun_contribution},
    traced::{Estimate, TracedScene, bounced_light, direct_light, direct_radiance},
};

use crate::{
    common::quads::{grey, scene_of},
    numbers, paths, sample,
};

/// Whether light reaches the floor at `x`, lit from 3 m above its origin.
fn is_lit(scene: &Scene, x: f64) -> bool {
    let light = Light::point(Vec3::new(0.0, 3.0, 0.0), 20.0, Vec3::ONE);
    let at = sample(DVec3::new(x, 0.0, 0.1), DVec3::Y, 0.6);
    let traced = TracedScene::new(scene);
    let lit = direct_light(&light, &at, Some(&traced), 1, numbers());
    let expected = light_contribution(&light, at.position, &at.surface, at.to_eye);
    assert!(lit == Estimate::exact(expected) || lit == Estimate::default(), "{lit:?}");
    lit.mean.x > 0.0
}

#[test]
fn a_shadow_ends_where_the_blocker_does() {
    let floor = [Vec3::ZERO, Vec3::Z * 9.0, Vec3::X * 9.0];
    // A square of 1 m at a height of 1 m casts a shadow of 1.5 m, whichever side faces up.
    for blocker in
        [[Vec3::Y, Vec3::Z * 0.5, Vec3::X * 0.5], [Vec3::Y, Vec3::X * 0.5, Vec3::Z * 0.5]]
    {
        let scene = scene_of(&[floor, blocker], grey(0.5), vec![]);
        for (x, lit) in [(0.7499, false), (0.7501, true), (-0.7499, false), (-0.7501, true)] {
            assert_eq!(is_lit(&scene, x), lit, "at {x}");
        }
        assert!(!is_lit(&scene, 0.0));
    }
}

#[test]
fn light_falls_through_the_holes_of_a_mask() {
    // The left half of the image is opaque; it is the blocker's half at negative x.
    let texel = |i: u32| [255, 255, 255, if i < 8 { 255 } else { 0 }];
    let image = Image {
        name: "half".into(),
        width: 16,
        height: 1,
        rgba: (0..16).flat_map(texel).collect(),
        encoding: Encoding::Srgb,
    };
    let blocker = [Vec3::Y, Vec3::X * 0.5, Vec3::NEG_Z * 0.5];
    let mut material = Material { base_color_texture: Some(TextureRef::new(0)), ..grey(1.0) };
    let scene = scene_of(&[blocker], material.clone(), vec![image.clone()]);
    assert!(!is_lit(&scene, 0.4) && !is_lit(&scene, -0.4), "without a cutoff it is opaque");
    material.alpha_cutoff = Some(0.5);
    let scene = scene_of(&[blocker], material, vec![image]);
    assert!(is_lit(&scene, 0.4) && !is_lit(&scene, -0.4));
}

/// A square of 1 m at a height of 1 m shades the floor where a sun at 45 degrees casts its shadow.
/// The floor below a sunlit wall gets a bounce of its light.
#[test]
fn suns_cast_shadows_and_bounce() {
    let floor = [Vec3::ZERO, Vec3::Z * 9.0, Vec3::X * 9.0];
    let blocker = [Vec3::Y, Vec3::Z * 0.5, Vec3::X * 0.5];
    let wall = [Vec3::X * 3.0, Vec3::Y * 9.0, Vec3::Z * 9.0];
    let scene =
        scene_of(&[floor, blocker, wall], Material { double_sided: true, ..grey(0.5) }, vec![]);
    let traced = TracedScene::new(&scene);
    let sun = Sun { direction: Vec3::new(1.0, -1.0, 0.0).normalize(), irradiance: Vec3::ONE };
    let lights = LightBvh::new(&[]).with_suns(Suns::new(&[sun]).unwrap());
    for (x, lit) in [(0.499, true), (0.501, false), (1.499, false), (1.501, true)] {
        let at = sample(DVec3::new(x, 0.0, 0.1), DVec3::Y, 0.6);
        let seen = direct_radiance(&lights, &at, Some(&traced), 1, numbers());
        let expected = sun_contribution(&sun, &at.surface, at.to_eye);
        assert!(expected.x > 0.05, "{expected}");
        assert_eq!(seen.mean, if lit { expected } else { DVec3::ZERO }, "at {x}");
    }
    let at = sample(DVec3::new(1.0, 0.0, 0.1), DVec3::Y, 0.6);
    let bounced = bounced_light(&lights, &at, &traced, paths(1, 2_048), numbers());
    assert!(bounced.mean.x > 5.0 * bounced.standard_error().x, "{bounced:?}");
    let dark = bounced_light(&LightBvh::new(&[]), &at, &traced, paths(1, 128), numbers());
    assert_eq!(dark.mean, DVec3::ZERO);
}
