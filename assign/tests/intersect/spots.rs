//! Spots: balls cut by a cone of any half angle up to π. A spot must reach a group if its support
//! contains a point of the group, or if shading in f32 lights a sample of the group.

use std::f32::consts::FRAC_PI_2;

use assign::{FrustumTests, Light, LightShape, Projection, SpotRamp, View};
use glam::{DVec3, Mat4, Vec2, Vec3};
use proptest::prelude::*;

use crate::aims::{Kind, aim, witness};
use crate::cases::group;
use crate::deterministic;
use crate::groups::{Group, Shape, UNIONS, box_of, union};

/// Whether shading gives the sample any light: `range_window` of `window.wesl` and `cone_fall_off`
/// of `shading/src/shaders/lighting.wesl`, in f32.
fn is_lit(light: &Light, sample: Vec3) -> bool {
    let offset = light.position - sample;
    let distance_2 = offset.dot(offset);
    let to_light = offset / distance_2.max(1e-20).sqrt();
    let ratio_2 = distance_2 / (light.range_m * light.range_m);
    let in_cone = match light.shape {
        LightShape::Point | LightShape::Area(_) => true,
        LightShape::Spot { direction, inner_angle, outer_angle } => {
            let chord = direction.normalize() + to_light;
            SpotRamp::new(inner_angle, outer_angle).at(chord.dot(chord)) > 0.0
        }
        LightShape::Vpl { normal, .. } => normal.normalize().dot(-to_light) > 0.0,
    };
    1.0 - ratio_2 * ratio_2 > 0.0 && in_cone
}

proptest! {
    #![proptest_config(deterministic(2_500))]

    #[test]
    fn a_cone_that_contains_a_point_of_the_group_reaches_it(
        group in group(),
        aims in prop::collection::vec(aim(Kind::Spot), 4),
        samples in prop::collection::vec(prop::array::uniform3(0.0_f32..1.0), 24),
    ) {
        let bounds = group.bounds();
        for aim in aims {
            let light = aim.light(&group);
            let center = light.position.as_dvec3();
            let hull = group.hull(center, f64::from(light.range_m));
            let found = witness(&group, &light);
            let nearest = center + hull.nearest(DVec3::ZERO);
            let points = hull.0.iter().map(|corner| center + corner).chain([nearest]).chain(found);
            let seen = samples.iter().map(|at| group.sample(Vec3::from_array(*at)));
            let must = found.is_some()
                || points.clone().any(|p| light.reach(p) > 0.0)
                || points.map(DVec3::as_vec3).chain(seen).any(|p| is_lit(&light, p));
            if must {
                for tests in UNIONS {
                    prop_assert!(bounds.reaches(&light, union(tests)), "{tests} misses a light that reaches: {light:?}");
                }
                let (min_world, max_world) = box_of(&light);
                prop_assert!(bounds.reaches_box(min_world, max_world), "the box test misses a light that reaches: {light:?}");
            }
        }
    }
}

fn spot(position: Vec3, range_m: f32, direction: Vec3, outer_angle: f32) -> Light {
    let shape = LightShape::Spot {
        direction: direction.normalize(),
        inner_angle: 0.5 * outer_angle,
        outer_angle,
    };
    Light { shape, ..Light::point(position, range_m, Vec3::ONE) }
}

proptest! {
    #![proptest_config(deterministic(60_000))]

    /// Shading finds a cone's edge by a squared chord, whose rounding moves the edge outwards.
    #[test]
    fn a_sample_on_the_edge_that_shading_lights_is_reached(
        sample in prop::array::uniform3(-1.0_f32..1.0),
        away in prop::array::uniform3(0.05_f32..1.0),
        outer in -4.0_f32..0.3,
        beyond in -7.0_f32..0.0,
    ) {
        let (sample, away, outer) = (Vec3::from(sample), Vec3::from(away), 10_f32.powf(outer));
        let across = away.any_orthogonal_vector().normalize();
        let angle = outer * (1.0 + 10_f32.powf(beyond));
        let axis = -away.normalize() * angle.cos() + across * angle.sin();
        let light = spot(sample + away, 1.01 * away.length(), axis, outer);
        let view = View::look_at(Vec3::ZERO, Vec3::X, 1.0, 0.1, [8, 8]);
        for shape in [
            Shape::Aabb { min_world: sample, max_world: sample },
            Shape::Oriented { center_world: sample, axes: [Vec3::X, Vec3::Y, Vec3::Z], half_extents_m: Vec3::ZERO },
        ] {
            let reaches = Group { view, shape }.bounds().reaches(&light, FrustumTests::default());
            prop_assert!(reaches || !is_lit(&light, sample), "the test misses a lit sample: {light:?}");
        }
    }
}

/// A half ball that is turned almost straight away from a wide plate dips its rim into the plate,
/// at `1 / dip` times its height above the plate. The test fails if the sine of the angle between
/// them comes from its cosine.
#[test]
fn a_half_ball_turned_away_dips_its_rim_into_a_plate() {
    let view = View {
        world_to_view: Mat4::IDENTITY,
        projection: Projection::Orthographic { min: Vec2::splat(-1e6), max: Vec2::splat(1e6) },
        near_m: 0.0,
        far_m: Some(1.0),
        ..View::look_at(Vec3::ZERO, Vec3::NEG_Z, 1.0, 0.1, [8, 8])
    };
    let half = Vec3::new(1e6, 1e6, 0.5);
    let center_world = Vec3::new(0.0, 0.0, -0.5);
    let shapes = [
        Shape::Frustum {
            ndc_min: Vec2::NEG_ONE,
            ndc_max: Vec2::ONE,
            depth_min: 0.0,
            depth_max: 1.0,
        },
        Shape::Aabb { min_world: center_world - half, max_world: center_world + half },
        Shape::Oriented { center_world, axes: [Vec3::X, Vec3::Y, Vec3::Z], half_extents_m: half },
    ];
    for shape in shapes {
        let group = Group { view, shape };
        for dip in [1e-2_f32, 1e-3, 1e-4, 1e-5] {
            let away = Vec3::new(dip.sin(), 0.0, dip.cos());
            // The plate's slack is 4 m: 16 units in the last place of its size.
            let light = spot(Vec3::new(0.0, 0.0, 10.0), 12.0 / dip.sin(), away, FRAC_PI_2);
            assert!(witness(&group, &light).is_some(), "dip {dip:e}: the light touches the plate");
            let reaches = group.bounds().reaches(&light, FrustumTests::default());
            assert!(reaches, "dip {dip:e}: the test misses the light: {shape:?}");
        }
    }
}
