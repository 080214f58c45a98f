//! Tests how much less noise Sobol points leave than independent ones.

use assign::{Emitter, Light};
use glam::{DVec3, Vec3};
use shading::{
    LightBvh,
    traced::{Estimate, Numbers, TracedScene, bounced_light, direct_light},
};

use crate::{
    common::quads::{grey, scene_of},
    cube, numbers, paths, rectangle, sample,
};

/// Variance of 4,096 independent samples over that of as many points of Sobol sequences.
fn gain(estimate: impl Fn(u32, u64) -> Estimate) -> f64 {
    // One point of one sequence is an independent sample.
    let singles: Vec<f64> = (0..4096).map(|seed| estimate(1, seed).mean.y).collect();
    let mean = singles.iter().sum::<f64>() / 4096.0;
    let spread = singles.iter().map(|v| (v - mean).powi(2)).sum::<f64>() / 4095.0;
    let all: Vec<Estimate> = (0..24).map(|seed| estimate(4096, seed)).collect();
    let mean = all.iter().map(|one| one.mean.y).sum::<f64>() / 24.0;
    let seen = all.iter().map(|one| (one.mean.y - mean).powi(2)).sum::<f64>() / 23.0;
    // The variance that the images state must be the variance among 24 of them, as far as 24 can
    // show.
    let stated = all.iter().map(|one| one.variance.y).sum::<f64>() / 24.0;
    assert!((0.3..3.0).contains(&(stated / seen)), "stated {stated}, seen {seen}");
    println!("gain {} seen, {} stated", spread / 4096.0 / seen, spread / 4096.0 / stated);
    spread / 4096.0 / seen.max(stated)
}

#[test]
fn sobol_points_have_a_twentieth_of_the_variance() {
    // A penumbra with a slanted edge.
    let across = Vec3::new(3.0, 0.0, -1.5);
    let blocker = [Vec3::new(0.1, 1.0, 0.0) - across, across, Vec3::new(2.0, 0.0, 4.0)];
    let scene = scene_of(&[blocker], grey(0.5), vec![]);
    let traced = TracedScene::new(&scene);
    let light = Light::area(rectangle(1.0, false), Vec3::Y * 2.0, 50.0, Vec3::ONE);
    for roughness in [0.1, 0.4, 1.0] {
        let at = sample(DVec3::ZERO, DVec3::Y, roughness);
        let drawn =
            |count, seed| direct_light(&light, &at, Some(&traced), count, Numbers::new(seed));
        let share = drawn(4096, 1).mean.y / direct_light(&light, &at, None, 1, numbers()).mean.y;
        assert!((0.2..0.8).contains(&share), "{share}");
        let gain = gain(drawn);
        assert!(gain > 20.0, "roughness {roughness}: {gain}");
    }
    // A bounce of the light of a point and of an emitter, in a room.
    let scene = scene_of(&cube(), grey(0.7), vec![]);
    let traced = TracedScene::new(&scene);
    let at = sample(DVec3::new(-0.3, -1.0, 0.4), DVec3::Y, 0.6);
    let point = Light::point(Vec3::new(0.2, 0.3, -0.1), 10.0, Vec3::ONE);
    let emitter = Emitter::rectangle(Vec3::X * 0.3, Vec3::Z * 0.2);
    for light in [point, Light::area(emitter, Vec3::new(0.1, 0.9, 0.1), 10.0, Vec3::ONE)] {
        let lights = [light];
        let drawn = |count, seed| {
            let lights = LightBvh::new(&lights);
            bounced_light(&lights, &at, &traced, paths(1, count), Numbers::new(seed))
        };
        let gain = gain(drawn);
        assert!(gain > 20.0, "a bounce of {:?}: {gain}", light.kind());
    }
}
