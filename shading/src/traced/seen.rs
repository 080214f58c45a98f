//! A surface point seen by a ray, and where rays from it start.

use glam::DVec3;

use crate::reference::Surface;

/// The distance from a surface at which rays start, as a share of the larger of its largest
/// coordinate and the distance from which it was seen. It is four times the error of a position
/// rebuilt from depth.
const RAY_OFFSET: f64 = 64.0 * f32::EPSILON as f64;

/// A point of a surface, seen from one direction.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SurfaceSample {
    /// Position in world space, metres.
    pub position: DVec3,
    /// Its material and shading normal.
    pub surface: Surface,
    /// Emitted radiance, linear RGB.
    pub emission: DVec3,
    /// Unit vector towards the eye.
    pub to_eye: DVec3,
    /// Unit normal of its triangle, on the side of the eye.
    pub geometric_normal: DVec3,
    /// The distance from the surface at which rays start, and from a light at which they end,
    /// metres.
    pub offset_m: f64,
}

impl SurfaceSample {
    /// The start of its rays, off the surface on the side of the eye.
    pub fn ray_origin(&self) -> DVec3 {
        self.position + self.geometric_normal * self.offset_m
    }
}

/// A ray that hits a surface.
pub(super) struct SeenFrom {
    /// Unit vector along the ray.
    pub(super) direction: DVec3,
    /// Origins and directions of the rays through the pixels beside and below; `None` if textures
    /// are read at their finest level.
    pub(super) neighbours: Option<[(DVec3, DVec3); 2]>,
}

impl SeenFrom {
    /// A ray that stands for no pixel area.
    pub(super) fn afar(direction: DVec3) -> Self {
        Self { direction, neighbours: None }
    }

    /// A ray through a pixel. Textures are averaged over the pixel.
    pub(super) fn pixel(direction: DVec3, neighbours: [(DVec3, DVec3); 2]) -> Self {
        Self { direction, neighbours: Some(neighbours) }
    }
}

/// The distance from a position at which rays start, if it was seen from `distance_m`, metres.
pub(super) fn offset(position: DVec3, distance_m: f64) -> f64 {
    RAY_OFFSET * position.abs().max_element().max(distance_m)
}

/// The normal or its opposite, whichever is on the side of a direction.
pub(super) fn towards(normal: DVec3, direction: DVec3) -> DVec3 {
    if normal.dot(direction) < 0.0 { -normal } else { normal }
}
