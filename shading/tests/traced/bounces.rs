//! Tests bounces and emission against integrals over the walls, and against a random walk.

use assign::Light;
use glam::{DVec3, Vec3};
use rand::{RngExt, SeedableRng};
use scenes::Material;
use shading::{
    LightBvh,
    ltc::diffuse_fresnel,
    reference::{Surface, light_contribution, reflect_light},
    traced::{Estimate, Paths, SurfaceSample, TracedScene, bounced_light},
};

use crate::{
    common::quads::{grey, scene_of},
    cube, numbers, paths, sample, surface,
};

#[test]
fn a_bounce_matches_the_integral_over_the_walls() {
    let walls = cube();
    let scene = scene_of(&walls, grey(0.7), vec![]);
    let traced = TracedScene::new(&scene);
    let lights = [Light::point(Vec3::new(0.2, 0.3, -0.1), 10.0, Vec3::new(1.0, 2.0, 3.0))];
    for roughness in [0.25, 0.9] {
        let at = sample(DVec3::new(-0.3, -1.0, 0.4), DVec3::Y, roughness);
        let estimate =
            bounced_light(&LightBvh::new(&lights), &at, &traced, paths(1, 16_384), numbers());
        let expected = over_walls(&walls, &lights[0], &at);
        let off = (estimate.mean - expected).abs() / estimate.standard_error();
        let error = estimate.standard_error() / expected;
        assert!(off.max_element() < 3.0, "{roughness}: {estimate:?}, expected {expected}");
        assert!(error.max_element() < 1e-3, "{roughness}: {estimate:?}, expected {expected}");
    }
}

/// The light of lit walls that a sample reflects.
fn over_walls(walls: &[[Vec3; 3]], light: &Light, at: &SurfaceSample) -> DVec3 {
    over_quads(walls, at, |point, normal, direction| {
        let wall = surface(normal, f64::from(0.7_f32), f64::from(0.6_f32));
        light_contribution(light, point, &wall, -direction)
    })
}

/// The light of rectangles that a sample reflects, by the midpoint rule over them. `radiance` is
/// the radiance of a point with a normal in a direction.
fn over_quads(
    quads: &[[Vec3; 3]],
    at: &SurfaceSample,
    radiance: impl Fn(DVec3, DVec3, DVec3) -> DVec3,
) -> DVec3 {
    let side = 200;
    let mut sum = DVec3::ZERO;
    for [center, x, y] in quads.iter().map(|quad| quad.map(Vec3::as_dvec3)) {
        let across = x.cross(y);
        let normal = across.normalize();
        let cell_m2 = 4.0 * across.length() / f64::from(side * side);
        for cell in 0..side * side {
            let along = |step: u32| (f64::from(step) + 0.5) / f64::from(side) * 2.0 - 1.0;
            let point = center + x * along(cell % side) + y * along(cell / side);
            let offset = point - at.position;
            let direction = offset.normalize();
            let solid_angle = normal.dot(direction).abs() * cell_m2 / offset.length_squared();
            let reflected = reflect_light(&at.surface, at.to_eye, direction);
            sum += radiance(point, normal, direction) * reflected * solid_angle;
        }
    }
    sum
}

#[test]
fn emitting_triangles_match_the_integral() {
    let walls = cube();
    let emission = DVec3::new(1.0, 2.0, 4.0);
    // Either all walls emit, or a small, powerful double-sided square near the middle.
    let glowing = Material { emissive: emission.as_vec3(), ..grey(0.7) };
    let spark = [Vec3::new(0.1, 0.2, 0.0), Vec3::X * 0.01, Vec3::Z * 0.01];
    for (quads, shine) in [(walls.clone(), 1.0), (vec![spark], 1e4)] {
        let material =
            Material { emissive: glowing.emissive * shine, double_sided: true, ..glowing.clone() };
        let scene = scene_of(&quads, material, vec![]);
        let traced = TracedScene::new(&scene);
        assert_eq!(traced.emissive_count(), 2 * quads.len());
        for roughness in [0.1, 0.9] {
            let at = sample(DVec3::new(-0.3, -1.0, 0.4), DVec3::Y, roughness);
            let drawn = bounced_light(&LightBvh::new(&[]), &at, &traced, paths(1, 4096), numbers());
            let emitted = |_, _, _| emission * f64::from(shine);
            let expected = over_quads(&quads, &at, emitted);
            // The error of the midpoint rule is 1e-4.
            let off = (drawn.mean - expected).abs() - 1e-4 * expected;
            let error = drawn.standard_error() / expected;
            let most = 3.0 * drawn.standard_error();
            assert!(off.cmplt(most).all(), "{roughness}: {drawn:?}, expected {expected}");
            assert!(error.max_element() < 5e-3, "{roughness}: {drawn:?}, expected {expected}");
        }
    }
}

/// Two bounces against a random walk of another kind: uniform directions, independent numbers, and
/// the planes of the walls.
#[test]
fn two_bounces_match_a_random_walk() {
    let walls = cube();
    let scene = scene_of(&walls, grey(0.7), vec![]);
    let traced = TracedScene::new(&scene);
    let light = Light::point(Vec3::new(0.2, 0.3, -0.1), 10.0, Vec3::new(1.0, 2.0, 3.0));
    let at = sample(DVec3::new(-0.3, -1.0, 0.4), DVec3::Y, 0.6);
    let drawn = bounced_light(&LightBvh::new(&[light]), &at, &traced, paths(2, 8192), numbers());
    let mut rng = rand_pcg::Pcg64Mcg::seed_from_u64(3);
    let walk = Estimate::of_samples(300_000, || {
        let (mut position, mut surface, mut to_eye) = (at.position, at.surface, at.to_eye);
        let (mut share, mut radiance) = (DVec3::ONE, DVec3::ZERO);
        for _ in 0..2 {
            let cos: f64 = rng.random();
            let (sin, turn) =
                ((1.0 - cos * cos).sqrt(), rng.random::<f64>() * std::f64::consts::TAU);
            let (x, y) = surface.normal.any_orthonormal_pair();
            let direction = surface.normal * cos + (x * turn.cos() + y * turn.sin()) * sin;
            share *= reflect_light(&surface, to_eye, direction) * std::f64::consts::TAU;
            // The first hit of the planes at 1 and -1 along the axes.
            let to_plane = DVec3::from_array(std::array::from_fn(|axis| {
                (direction[axis].signum() - position[axis]) / direction[axis]
            }));
            let axis = to_plane.min_position();
            position += direction * to_plane[axis];
            let mut normal = DVec3::ZERO;
            normal[axis] = -direction[axis].signum();
            let wall = Surface {
                base_color: DVec3::splat(f64::from(0.7_f32)),
                metallic: 0.0,
                normal,
                roughness: f64::from(0.6_f32),
                dielectric: Default::default(),
            };
            (surface, to_eye) = (wall, -direction);
            radiance += share * light_contribution(&light, position, &surface, to_eye);
        }
        radiance
    });
    let error = (drawn.variance + walk.variance).to_array().map(f64::sqrt);
    let off = (drawn.mean - walk.mean).abs() / DVec3::from_array(error);
    assert!(off.max_element() < 3.0, "{drawn:?}, expected {walk:?}");
    assert!((error[0] / walk.mean.x) < 5e-3, "{drawn:?}, expected {walk:?}");
    // The second bounce is part of it.
    let one = bounced_light(&LightBvh::new(&[light]), &at, &traced, paths(1, 8192), numbers());
    assert!(drawn.mean.x > 1.2 * one.mean.x, "{drawn:?} {one:?}");
}

/// Surfaces that reflect as virtual point lights emit: without a specular term, and with the mean
/// of Fresnel's term.
#[test]
fn a_matte_bounce_matches_virtual_point_lights() {
    let walls = cube();
    let scene = scene_of(&walls, grey(0.7), vec![]);
    let traced = TracedScene::new(&scene);
    let light = Light::point(Vec3::new(0.2, 0.3, -0.1), 10.0, Vec3::new(1.0, 2.0, 3.0));
    let at = sample(DVec3::new(-0.3, -1.0, 0.4), DVec3::Y, 0.6);
    let matte = Paths { is_matte: true, ..paths(1, 16_384) };
    let drawn = bounced_light(&LightBvh::new(&[light]), &at, &traced, matte, numbers());
    let expected = over_quads(&walls, &at, |point, normal, _| {
        let offset = light.position.as_dvec3() - point;
        let cos = normal.dot(offset.normalize());
        let window = (1.0 - (offset.length() / f64::from(light.range_m)).powi(4)).powi(2);
        let kept = 0.96 * (1.0 - diffuse_fresnel(cos)) * f64::from(0.7_f32);
        light.intensity.as_dvec3() * window * kept * cos
            / offset.length_squared()
            / std::f64::consts::PI
    });
    let off = (drawn.mean / expected - 1.0).abs().max_element();
    assert!(off < 3e-4, "{drawn:?}, expected {expected}");
    let whole = bounced_light(&LightBvh::new(&[light]), &at, &traced, paths(1, 16_384), numbers());
    assert!(whole.mean.x > 1.01 * drawn.mean.x, "the specular term adds light: {whole:?}");
}
