//! The order in which layers are blended: from back to front.

use std::ops::Range;

use assign::{Projection, View};
use glam::Vec3;
use scenes::Particle;

/// What is drawn at once.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(super) enum Item {
    /// A transparent surface, by its index.
    Sheet(usize),
    /// Particles, by their places in the sorted list.
    Particles(Range<u32>),
}

/// The items of a view, and the indices of the particles, both from back to front.
#[derive(Debug, Default)]
pub(super) struct Order {
    pub(super) items: Vec<Item>,
    pub(super) particles: Vec<usize>,
}

/// A particle is not drawn if its view depth is below this many of its radii. It would hide much of the image.
const NEAREST_RADII: f32 = 2.0;

/// Sorts by the distance of centres from the eye, or by view depth in an orthographic view. Of equal distances,
/// surfaces come before particles, and each kind in the order of its indices.
pub(super) fn back_to_front(view: &View, sheets: &[Vec3], particles: &[Particle]) -> Order {
    let distance = |position: Vec3| {
        let position_view = view.world_to_view.transform_point3(position);
        match view.projection {
            Projection::Perspective { .. } => position_view.length(),
            Projection::Orthographic { .. } => -position_view.z,
        }
    };
    let depth = |position: Vec3| -view.world_to_view.transform_point3(position).z;
    let is_drawn = |particle: &Particle| {
        depth(particle.position) > view.near_m.max(NEAREST_RADII * particle.radius_m)
    };
    let sheets = sheets.iter().enumerate().map(|(ix, center)| (distance(*center), false, ix));
    let particles = particles
        .iter()
        .enumerate()
        .filter(|(_, particle)| is_drawn(particle))
        .map(|(ix, particle)| (distance(particle.position), true, ix));
    let mut all: Vec<(f32, bool, usize)> = sheets.chain(particles).collect();
    all.sort_unstable_by(|a, b| b.0.total_cmp(&a.0).then((a.1, a.2).cmp(&(b.1, b.2))));
    let mut order = Order::default();
    for (_, is_particle, ix) in all {
        if !is_particle {
            order.items.push(Item::Sheet(ix));
            continue;
        }
        let place = order.particles.len() as u32;
        order.particles.push(ix);
        match order.items.last_mut() {
            Some(Item::Particles(run)) => run.end = place + 1,
            _ => order.items.push(Item::Particles(place..place + 1)),
        }
    }
    order
}

#[cfg(test)]
mod tests {
    use super::*;

    fn particle(z: f32) -> Particle {
        Particle { position: Vec3::new(0.0, 0.0, z), radius_m: 0.1, color: Vec3::ONE, opacity: 0.5 }
    }

    #[test]
    fn surfaces_and_particles_are_sorted_together() {
        let view = View::look_at(Vec3::ZERO, Vec3::NEG_Z, 1.0, 0.1, [64, 48]);
        let sheets = [-2.0, -6.0, -2.0].map(|z| Vec3::new(0.0, 0.0, z));
        // The last two are too near, and behind the camera.
        let particles = [-1.0, -4.0, -3.0, -2.0, -0.15, 3.0].map(particle);
        let order = back_to_front(&view, &sheets, &particles);
        assert_eq!(order.particles, [1, 2, 3, 0]);
        let items = [
            Item::Sheet(1),
            Item::Particles(0..2),
            Item::Sheet(0),
            Item::Sheet(2),
            Item::Particles(2..4),
        ];
        assert_eq!(order.items, items);
        assert!(back_to_front(&view, &[], &[]).items.is_empty());
    }
}
