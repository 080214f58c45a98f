//! Scatters particles, such as smoke or dust, from a seed.

use glam::Vec3;
use rand::{RngExt, SeedableRng};
use rand_pcg::Pcg64Mcg;

use crate::{
    Aabb, SceneError,
    random::{random_color, seed_of},
};

/// The most particles that [`scatter_particles`] makes.
pub const MAX_PARTICLES: u32 = 1 << 20;

/// Range of the radii, as shares of the box's diagonal: 14 to 43 cm in a hall of 29 m.
const RADIUS_SHARE: (f32, f32) = (0.005, 0.015);

/// Range of the opacities in the middle of a particle.
const OPACITY: (f32, f32) = (0.2, 0.7);

/// How far colours are mixed towards white.
const PALE: f32 = 0.8;

/// A disc that faces the camera.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Particle {
    /// Its centre, world space, metres.
    pub position: Vec3,
    /// Its radius, metres.
    pub radius_m: f32,
    /// The share of light that it scatters, linear RGB, 0..=1.
    pub color: Vec3,
    /// The share of what lies behind its centre that it hides, 0..=1.
    pub opacity: f32,
}

/// Scatters `count` particles in `bounds`. The seed and a particle's index decide everything random about it, so
/// fewer particles are the first ones of more.
///
/// # Errors
///
/// [`SceneError::OutOfRange`] for more than [`MAX_PARTICLES`], or an empty or infinite box.
pub fn scatter_particles(count: u32, seed: u64, bounds: Aabb) -> Result<Vec<Particle>, SceneError> {
    let fail = |field, value, accepted| Err(SceneError::OutOfRange { field, value, accepted });
    if count > MAX_PARTICLES {
        return fail("particle count", count.to_string(), "at most 1048576");
    }
    let Aabb { min, max } = bounds;
    if !(min.is_finite() && max.is_finite()) || bounds.is_empty() {
        let value = format!("{min} to {max}");
        return fail("particle bounds", value, "finite, with min at most max");
    }
    let diagonal_m = bounds.diagonal();
    let particle = |ix| {
        // Lights of the same seed and index must not lie in the same place.
        let mut rng = Pcg64Mcg::seed_from_u64(seed_of(!seed, ix));
        let mut between = |(low, high): (f32, f32)| low + (high - low) * rng.random::<f32>();
        let place = Vec3::from_array(std::array::from_fn(|_| between((0.0, 1.0))));
        Particle {
            position: min + (max - min) * place,
            radius_m: between(RADIUS_SHARE) * diagonal_m,
            opacity: between(OPACITY),
            color: random_color(&mut rng).lerp(Vec3::ONE, PALE),
        }
    };
    Ok((0..count).map(particle).collect())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_seed_gives_the_same_particles_and_fewer_are_the_first_ones() {
        let bounds = Aabb::new(Vec3::new(-1.0, 0.0, 2.0), Vec3::new(3.0, 2.0, 9.0));
        let all = scatter_particles(200, 7, bounds).expect("valid");
        assert_eq!(scatter_particles(20, 7, bounds).expect("valid"), all[..20]);
        assert_ne!(scatter_particles(200, 8, bounds).expect("valid"), all);
        for particle in &all {
            assert_eq!(particle.position, particle.position.clamp(bounds.min, bounds.max));
            assert!(particle.radius_m > 0.0 && (0.0..=1.0).contains(&particle.opacity));
            assert!(particle.color.min_element() >= 0.0 && particle.color.max_element() <= 1.0);
        }
        let mean = all.iter().map(|p| p.position).sum::<Vec3>() / 200.0;
        assert!((mean - bounds.center()).abs().max_element() < 1.0, "{mean}");
    }

    #[test]
    fn too_many_particles_and_boxes_without_room_are_refused() {
        let unit = Aabb::new(Vec3::ZERO, Vec3::ONE);
        let error = scatter_particles(MAX_PARTICLES + 1, 1, unit).expect_err("too many");
        assert!(error.to_string().contains("1048577"), "{error}");
        let empty = Aabb { min: Vec3::ONE, max: Vec3::ZERO };
        assert!(scatter_particles(1, 1, empty).is_err());
    }
}
