//! Random values for all kinds of lights.

use std::f64::consts::TAU;

use glam::{DVec3, Vec3};
use rand::{Rng, RngExt};

/// A well-mixed 64-bit value for one light (splitmix64's finaliser).
pub(crate) fn seed_of(seed: u64, ix: u32) -> u64 {
    let mut z = seed
        .wrapping_mul(0x9e37_79b9_7f4a_7c15)
        .wrapping_add(u64::from(ix).wrapping_mul(0xd1b5_4a32_d192_ed03));
    z = (z ^ z >> 30).wrapping_mul(0xbf58_476d_1ce4_e5b9);
    z = (z ^ z >> 27).wrapping_mul(0x94d0_49bb_1331_11eb);
    z ^ z >> 31
}

/// A colour whose largest channel is 1: hue uniform, saturation up to 0.85.
pub(crate) fn random_color(rng: &mut impl Rng) -> Vec3 {
    let hue = rng.random::<f32>() * 6.0;
    let saturation = rng.random::<f32>() * 0.85;
    let channel = |offset: f32| {
        let k = (offset + hue) % 6.0;
        1.0 - saturation * k.min(4.0 - k).clamp(0.0, 1.0)
    };
    Vec3::new(channel(5.0), channel(3.0), channel(1.0))
}

/// A unit vector, uniform on the sphere.
pub(crate) fn random_direction(rng: &mut impl Rng) -> DVec3 {
    let cos_theta: f64 = 1.0 - 2.0 * rng.random::<f64>();
    let phi = TAU * rng.random::<f64>();
    let sin_theta = (1.0 - cos_theta * cos_theta).max(0.0).sqrt();
    DVec3::new(sin_theta * phi.cos(), cos_theta, sin_theta * phi.sin()).normalize()
}
