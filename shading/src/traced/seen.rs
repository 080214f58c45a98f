//! A point of a surface as a ray sees it, and where rays from it start.

use glam::DVec3;

use crate::reference::Surface;

/// How far rays start off their surface, as a share of the largest of its coordinates and its
/// distance from where it was seen: four times what rebuilding a position from depth may err by.
const RAY_OFFSET: f64 = 64.0 * f32::EPSILON as f64;

/// A point of a surface, seen from one direction.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SurfaceSample {
    /// World space, metres.
    pub position: DVec3,
    /// Its material and shading normal.
    pub surface: Surface,
    /// Emitted radiance, linear RGB.
    pub emission: DVec3,
    /// Unit vector to whence it is seen.
    pub to_eye: DVec3,
    /// Unit normal of its triangle, on the side of the eye.
    pub geometric_normal: DVec3,
    /// How far rays start above the surface, and end before a light, metres.
    pub offset_m: f64,
}

impl SurfaceSample {
    /// Where its rays start: off the surface on the side of the eye.
    pub fn ray_origin(&self) -> DVec3 {
        self.position + self.geometric_normal * self.offset_m
    }
}

/// A ray that meets a surface.
pub(super) struct SeenFrom {
    /// Unit vector along the ray.
    pub(super) direction: DVec3,
    /// Origins and directions of the rays through the pixels beside and below; none where textures
    /// are read at their finest level.
    pub(super) neighbours: Option<[(DVec3, DVec3); 2]>,
}

impl SeenFrom {
    /// A ray that stands for itself only.
    pub(super) fn afar(direction: DVec3) -> Self {
        Self { direction, neighbours: None }
    }

    /// A ray through a pixel: textures are averaged over the pixel.
    pub(super) fn pixel(direction: DVec3, neighbours: [(DVec3, DVec3); 2]) -> Self {
        Self { direction, neighbours: Some(neighbours) }
    }
}

/// How far rays start off a position that was seen from a distance, metres.
pub(super) fn offset(position: DVec3, distance_m: f64) -> f64 {
    RAY_OFFSET * position.abs().max_element().max(distance_m)
}

/// The normal or its opposite, on the side of a direction.
pub(super) fn towards(normal: DVec3, direction: DVec3) -> DVec3 {
    if normal.dot(direction) < 0.0 { -normal } else { normal }
}
