//! The surfaces that the pixels of a view show, by rays from the eye.

use assign::{Projection, View, ViewUniform};
use glam::{DMat4, DVec2, DVec3, Vec2};

use super::{
    TracedScene,
    seen::{SeenFrom, SurfaceSample, offset},
    triangles::Hit,
};

/// The rays of a view's pixels, in f64.
struct Rays {
    view_to_world: DMat4,
    is_perspective: bool,
    uniform: ViewUniform,
}

impl Rays {
    fn new(view: &View) -> Self {
        Self {
            view_to_world: view.world_to_view.as_dmat4().inverse(),
            is_perspective: matches!(view.projection, Projection::Perspective { .. }),
            uniform: view.uniform(),
        }
    }

    /// The place in the window of the middle of a pixel of the viewport.
    fn window(&self, pixel: DVec2) -> DVec2 {
        let to_f64 = |pair: [f32; 2]| Vec2::from(pair).as_dvec2();
        let uv = (pixel + 0.5) / to_f64(self.uniform.viewport_size);
        let ndc = DVec2::new(2.0 * uv.x - 1.0, 1.0 - 2.0 * uv.y);
        to_f64(self.uniform.ray_scale) * ndc + to_f64(self.uniform.ray_offset)
    }

    /// The ray through the middle of a pixel of the viewport: origin, unit direction, and view
    /// depth per metre along it.
    fn through(&self, pixel: DVec2) -> (DVec3, DVec3, f64) {
        let at = self.window(pixel);
        let (origin, direction) = if self.is_perspective {
            (DVec3::ZERO, at.extend(-1.0))
        } else {
            (at.extend(0.0), DVec3::NEG_Z)
        };
        let to_world = |direction| self.view_to_world.transform_vector3(direction).normalize();
        let origin = self.view_to_world.transform_point3(origin);
        (origin, to_world(direction), 1.0 / direction.length())
    }

    /// The rays through the neighbouring pixels in the block of 2 x 2 pixels over which GPUs take
    /// differences.
    fn beside(&self, pixel: [u32; 2]) -> [(DVec3, DVec3); 2] {
        let pixel_at = pixel.map(f64::from);
        [0, 1].map(|axis| {
            let is_odd = (pixel[axis] + self.uniform.viewport_origin[axis] as u32) % 2 == 1;
            let mut at = pixel_at;
            at[axis] += if is_odd { -1.0 } else { 1.0 };
            let (origin, direction, _) = self.through(at.into());
            (origin, direction)
        })
    }
}

impl TracedScene<'_> {
    /// The surface that a pixel of the viewport shows, by a ray through its middle. It is the
    /// surface that the rasteriser draws, but without the rounding of depth and G-buffer.
    pub fn primary(&self, view: &View, pixel: [u32; 2]) -> Option<SurfaceSample> {
        let rays = Rays::new(view);
        let middle = pixel.map(f64::from).into();
        let (origin, direction, per_metre) = rays.through(middle);
        let (near_m, far_m) = view.shown_m(rays.window(middle))?;
        let (start_m, end_m) = (near_m / per_metre, far_m / per_metre);
        let drawn = |hit: &Hit| self.is_drawn(hit) && self.is_solid(hit);
        let start = origin + direction * start_m;
        let hit = self.triangles.first(start, direction, end_m - start_m, drawn)?;
        let seen = SeenFrom::pixel(direction, rays.beside(pixel));
        let mut sample = self.surface_at(&hit, &seen);
        sample.offset_m = offset(sample.position, start_m + hit.distance_m);
        Some(sample)
    }
}
