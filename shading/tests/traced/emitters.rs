//! Tests area lights with shadows against quadrature.

use assign::{Emitter, Light};
use glam::{DVec3, Vec3};
use shading::{
    reference::{Surface, light_contribution},
    traced::{Estimate, Numbers, SurfaceSample, TracedScene, direct_light},
};

use crate::{
    common::quads::{grey, scene_of},
    numbers, rectangle, sample,
};

#[test]
fn sampled_emitters_agree_with_the_quadrature() {
    let empty = scene_of(&[], grey(0.5), vec![]);
    let traced = TracedScene::new(&empty);
    let corner = |x: f32, z: f32| Vec3::new(x, 2.0 + 0.3 * x, z);
    let pentagon = [(-1.0, 0.0), (-0.3, -0.9), (0.8, -0.8), (1.2, 0.4), (0.0, 1.0)];
    let (polygon, middle) = Emitter::polygon(&pentagon.map(|(x, z)| corner(x, z))).unwrap();
    let far = Vec3::new(-1.0, 2.0, 0.4);
    let close = Vec3::new(0.3, 0.1, 0.1);
    // X x Z looks down.
    let above = Vec3::new(0.02, 2.0, 0.01);
    for (emitter, position) in [
        (rectangle(1.0, false), far),
        (rectangle(0.2, true), close),
        (polygon, middle),
        (Emitter::disc(Vec3::NEG_Y, 0.9), far),
        (Emitter::sphere(0.8), far),
        (Emitter::line(Vec3::new(0.8, 0.2, 0.0), 0.2), far),
        // Seen along its axis, and with one end below the horizon.
        (Emitter::line(Vec3::Y, 0.3), above),
        (Emitter::line(Vec3::new(0.3, 0.5, 0.0), 0.1), close + 0.2 * Vec3::X),
    ] {
        let light = Light::area(emitter, position, 5.0, Vec3::new(1.0, 2.0, 4.0));
        for roughness in [0.05, 0.3, 1.0] {
            let at = sample(DVec3::ZERO, DVec3::Y, roughness);
            let exact = direct_light(&light, &at, None, 1, numbers());
            assert!(exact.mean.x > 1e-3 && exact.variance == DVec3::ZERO, "{exact:?}");
            // So few pairs that they estimate the radiance, not a share of the quadrature.
            let drawn = |seed| direct_light(&light, &at, Some(&traced), 32, Numbers::new(seed));
            let all: Vec<Estimate> = (0..128).map(drawn).collect();
            let mean = all.iter().map(|one| one.mean).sum::<DVec3>() / 128.0;
            let variance = all.iter().map(|one| one.variance).sum::<DVec3>() / 128.0 / 128.0;
            let error = DVec3::from_array(variance.to_array().map(f64::sqrt));
            let off = (mean - exact.mean).abs() / error;
            assert!(off.max_element() < 3.0, "{roughness}: {mean}, expected {exact:?}");
            let error = error / exact.mean;
            assert!(error.max_element() < 0.02, "{roughness}: {error}");
            // Nothing blocks it, so all of its light arrives.
            assert_eq!(direct_light(&light, &at, Some(&traced), 64, numbers()), exact);
        }
    }
    let behind = sample(DVec3::new(0.0, 3.0, 0.0), DVec3::NEG_Y, 0.5);
    let light = Light::area(rectangle(1.0, false), far, 5.0, Vec3::ONE);
    assert_eq!(direct_light(&light, &behind, None, 1, numbers()), Estimate::default());
    // Nothing shines inwards.
    for solid in [Emitter::sphere(1.0), Emitter::line(Vec3::X, 1.0)] {
        let light = Light::area(solid, Vec3::new(0.2, 0.5, 0.0), 5.0, Vec3::ONE);
        let inside = sample(DVec3::ZERO, DVec3::Y, 0.5);
        assert_eq!(
            direct_light(&light, &inside, Some(&traced), 64, numbers()),
            Estimate::default()
        );
    }
    let both = Light::area(rectangle(1.0, true), far, 5.0, Vec3::ONE);
    assert!(direct_light(&both, &behind, None, 1, numbers()).mean.x > 0.0);
}

/// The size of an emitter matters, the range of its light does not.
#[test]
fn an_emitters_size_does_not_depend_on_its_range() {
    let empty = scene_of(&[], grey(0.5), vec![]);
    let traced = TracedScene::new(&empty);
    let pentagon = [(-0.6, 0.2), (0.1, 0.0), (0.7, 0.3), (0.53, 0.9), (-0.26, 0.8)]
        .map(|(x, z): (f32, f32)| Vec3::new(x, 2.0 + 0.2 * x, z));
    let (polygon, middle) = Emitter::polygon(&pentagon).unwrap();
    let (polygon, rectangle) = (polygon.two_sided(), rectangle(0.5, true));
    let line = Emitter::line(Vec3::X * 0.5, 0.1);
    let at = sample(DVec3::ZERO, DVec3::Y, 0.5);
    for range_m in [1e2, 1e7, 1e8] {
        let high = Vec3::Y * 3.0;
        for (emitter, position) in [(polygon, middle), (rectangle, high), (line, high)] {
            let light = Light::area(emitter, position, range_m, Vec3::ONE);
            let exact = direct_light(&light, &at, None, 1, numbers()).mean.x;
            let drawn = |seed| direct_light(&light, &at, Some(&traced), 63, Numbers::new(seed));
            let mean = (0..64).map(|seed| drawn(seed).mean.x).sum::<f64>() / 64.0;
            assert!((mean / exact - 1.0).abs() < 0.01, "{range_m}: {mean}, expected {exact}");
        }
    }
}

#[test]
fn a_small_emitter_is_a_point_light_with_a_cosine() {
    let at = sample(DVec3::ZERO, DVec3::Y, 0.4);
    let position = Vec3::new(1.0, 2.0, 0.5);
    let emitter = Emitter::rectangle(Vec3::X * 1e-3, Vec3::Z * 2e-3);
    let radiance = |emitter: Emitter, surface: Surface| {
        let light = Light::area(emitter, position, 3.0, Vec3::new(1.0, 2.0, 4.0));
        direct_light(&light, &SurfaceSample { surface, ..at }, None, 1, numbers()).mean
    };
    let point = Light::point(position, 3.0, Vec3::new(1.0, 2.0, 4.0));
    let reflected = |surface: &Surface| {
        let cos = f64::from(position.y / position.length());
        light_contribution(&point, DVec3::ZERO, surface, at.to_eye) * cos
    };
    let close = |a: DVec3, b: DVec3| assert!((a / b - 1.0).abs().max_element() < 2e-3, "{a} {b}");
    close(radiance(emitter, at.surface), reflected(&at.surface));
    // Beyond the range of its diffuse light, a surface reflects as a black one does.
    let black = Surface { base_color: DVec3::ZERO, ..at.surface };
    close(radiance(emitter.with_diffuse_share(0.7), at.surface), reflected(&black));
}

#[test]
fn a_half_blocked_emitter_gives_half_its_light() {
    let blocker = [Vec3::new(-5.0, 1.0, 0.0), Vec3::X * 5.0, Vec3::Z * 9.0];
    let scene = scene_of(&[blocker], grey(0.5), vec![]);
    let at = sample(DVec3::ZERO, DVec3::Y, 0.4);
    let whole = Light::area(rectangle(1.0, false), Vec3::Y * 2.0, 50.0, Vec3::ONE);
    // The half at positive x is as bright, and its closest point is the same.
    let right = Vec3::new(0.5, 2.0, 0.0);
    let half = Light::area(rectangle(0.5, false), right, 50.0, Vec3::splat(0.5));
    let expected = direct_light(&half, &at, None, 1, numbers()).mean;
    let traced = TracedScene::new(&scene);
    let sampled = direct_light(&whole, &at, Some(&traced), 4000, numbers());
    let off = (sampled.mean - expected).abs() / sampled.standard_error();
    assert!(off.max_element() < 4.0, "{sampled:?}, expected {expected}");
}
