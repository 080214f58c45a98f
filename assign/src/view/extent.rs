//! The view depths of samples and boxes, and where a view's slices end.

use glam::Vec3;

use super::View;

impl View {
    /// The greatest view depth that shading can rebuild from a clip depth, metres; `None` if it is
    /// unbounded. If depth is not reversed and the near plane is close, rounding moves the far
    /// plane well outwards: from 1,000 m to 1,049 m with a near plane at 1 mm.
    pub fn farthest_rebuilt_m(&self) -> Option<f32> {
        let far_m = self.far_m?;
        if self.is_tilted() {
            let (_, farthest_m) = self.rebuilt_span_m();
            return farthest_m.map(|rebuilt| far_m.max(rebuilt));
        }
        // WGSL divides to 2.5 units in the last place.
        let rebuilt = self.rebuilt_m(self.depth_clear()) * (1.0 + 4.0 * f32::EPSILON);
        (rebuilt.is_finite() && rebuilt > 0.0).then_some(far_m.max(rebuilt))
    }

    /// The least view depth that shading can rebuild from a clip depth, metres. It lies in front of
    /// the near plane if a distant far plane leaves an orthographic depth few bits.
    pub fn nearest_rebuilt_m(&self) -> f32 {
        if self.is_tilted() {
            let (nearest_m, _) = self.rebuilt_span_m();
            return self.near_m.min(nearest_m);
        }
        let rebuilt = self.rebuilt_m(1.0 - self.depth_clear());
        let slack = 4.0 * f32::EPSILON * rebuilt.abs();
        if rebuilt.is_finite() { self.near_m.min(rebuilt - slack) } else { 0.0 }
    }

    /// The greatest view depth inside a world-space box, metres.
    pub fn deepest_m(&self, min_world: Vec3, max_world: Vec3) -> f32 {
        // View depth is linear in position, so the deepest corner takes the deeper end of each
        // coordinate.
        let depth = -self.world_to_view.row(2);
        let axis = depth.truncate();
        (axis * min_world).max(axis * max_world).element_sum() + depth.w
    }

    /// The distance from the eye to the farthest point of a world-space box, metres. However the
    /// camera turns, no point of the box has a greater view depth.
    pub fn farthest_m(&self, min_world: Vec3, max_world: Vec3) -> f32 {
        let eye = self.eye();
        (eye - min_world).abs().max((max_world - eye).abs()).length()
    }

    /// The view depth at which slices of a perspective view end, metres: the far plane, or the
    /// farthest point that a light reaches (`light_bounds`) if that is nearer. No light reaches the
    /// samples behind it, so the last slice takes them all. Unless the far plane is nearer, it is
    /// at least twice the near plane's depth.
    pub fn slices_end_m(&self, light_bounds: Option<(Vec3, Vec3)>) -> f32 {
        let lit = |(min, max)| self.deepest_m(min, max).max(2.0 * self.near_m);
        match (self.far_m, light_bounds.map(lit)) {
            (Some(far), Some(lit)) => far.min(lit),
            (Some(end), None) | (None, Some(end)) => end,
            (None, None) => 2.0 * self.near_m,
        }
    }

    /// View depth of a clip depth, computed as in `view.wesl`, metres. The near plane must not be oblique.
    fn rebuilt_m(&self, depth_clip: f32) -> f32 {
        let clip = self.view_to_clip();
        (clip.w_axis.z - depth_clip * clip.w_axis.w) / (clip.z_axis.z - depth_clip * clip.z_axis.w)
    }
}

#[cfg(test)]
mod tests {
    use glam::Vec2;

    use super::*;
    use crate::Projection;

    #[test]
    fn a_far_plane_at_the_farthest_corner_sees_all_of_a_box_from_any_pose() {
        let (min, max) = (Vec3::new(-3.0, 0.0, -9.0), Vec3::new(5.0, 4.0, 2.0));
        for target in [Vec3::ZERO, Vec3::Z, Vec3::new(-8.0, 3.0, 1.0), Vec3::NEG_Y] {
            for eye in [Vec3::new(1.0, 1.7, 0.5), Vec3::new(40.0, -3.0, 7.0)] {
                let view = View::look_at(eye, target, 1.0, 0.1, [64, 48]);
                let far_m = view.farthest_m(min, max);
                assert!(
                    view.deepest_m(min, max) <= far_m * (1.0 + 1e-5),
                    "from {eye} to {target}: deeper than {far_m} m"
                );
            }
        }
        let view = View::look_at(Vec3::ZERO, Vec3::X, 1.0, 0.1, [64, 48]);
        assert_eq!(view.farthest_m(Vec3::ZERO, Vec3::new(2.0, 3.0, 6.0)), 7.0);
    }

    #[test]
    fn an_orthographic_near_plane_may_be_rebuilt_before_itself() {
        let mut view = View::look_at(Vec3::ONE, Vec3::ZERO, 1.0, 1.0, [64, 48]);
        view.projection = Projection::Orthographic { min: Vec2::splat(-1.0), max: Vec2::ONE };
        view.far_m = Some(1e6);
        assert!(view.nearest_rebuilt_m() < 0.96, "{}", view.nearest_rebuilt_m());
        view.far_m = Some(10.0);
        assert!((view.nearest_rebuilt_m() - 1.0).abs() < 1e-5, "{}", view.nearest_rebuilt_m());
    }
}
