//! The cone test of Swarbrick 2025 (section 3.4.1, listing H.3). `reflected.wesl` describes it.

use glam::Vec3;

use super::{Aabb, LightVolume, eye_world};
use crate::View;

/// A group whose normals lie in a cone, seen from the eye.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct MirrorGroup {
    center: Vec3,
    to_eye: Vec3,
    axis: Vec3,
    most_angle: f32,
}

impl MirrorGroup {
    /// The surfaces in a box whose normals lie within `half_angle` of a unit axis, and whose lobes
    /// have the half angle `lobe_angle`; both in radians.
    pub fn new(view: &View, bounds: &Aabb, axis: Vec3, half_angle: f32, lobe_angle: f32) -> Self {
        let uniform = view.uniform();
        let center = 0.5 * (bounds.min_world + bounds.max_world);
        let to_eye = if uniform.perspective > 0.5 {
            let across = eye_world(&uniform) - center;
            across / across.length().max(1e-20)
        } else {
            let [x, y, z, _] = uniform.view_to_world[2];
            Vec3::new(x, y, z)
        };
        Self { center, to_eye, axis, most_angle: lobe_angle + 2.0 * half_angle }
    }

    /// Whether the group's normals may mirror the light's centre to the eye. **Lossy**.
    pub fn mirrors(&self, volume: &LightVolume) -> bool {
        let across = volume.center - self.center;
        let to_light = across / across.length().max(1e-20);
        let mirror = 2.0 * self.axis.dot(to_light) * self.axis - to_light;
        mirror.dot(self.to_eye).clamp(-1.0, 1.0).acos() <= self.most_angle
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{Emitter, Light};

    /// A floor tile with one normal, and the eye at 45 degrees above it. By hand: light from 45
    /// degrees on the other side is mirrored into the eye. Light turned from there by less than the
    /// lobe plus twice the cone passes.
    #[test]
    fn light_passes_within_the_lobe_and_twice_the_cone() {
        let view = View::look_at(Vec3::new(4.0, 4.0, 0.0), Vec3::ZERO, 1.0, 0.1, [64, 64]);
        let bounds = Aabb::new(&view, Vec3::splat(-0.1), Vec3::splat(0.1));
        let emitter = Emitter::rectangle(Vec3::X, Vec3::Z);
        for (half_angle, lobe_angle) in [(0.0_f32, 45.0_f32), (10.0, 30.0), (25.24, 45.0)] {
            let (half, lobe) = (half_angle.to_radians(), lobe_angle.to_radians());
            let group = MirrorGroup::new(&view, &bounds, Vec3::Y, half, lobe);
            let most = lobe_angle + 2.0 * half_angle;
            // Turned about z, away from the mirror direction, either way.
            for (turn, passes) in [(0.0, true), (most - 0.1, true), (most + 0.1, false)] {
                for side in [-1.0_f32, 1.0] {
                    let angle = (135.0 + side * turn).to_radians();
                    let position = 5.0 * Vec3::new(angle.cos(), angle.sin(), 0.0);
                    let light = Light::area(emitter, position, 9.0, Vec3::ONE);
                    let mirrors = group.mirrors(&LightVolume::from(&light));
                    assert_eq!(mirrors, passes, "{half_angle}, {lobe_angle}: turned by {turn}");
                }
            }
        }
    }
}
