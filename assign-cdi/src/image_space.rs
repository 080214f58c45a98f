//! The place of deep images in the world.

use assign::AssignError;
use bytemuck::{Pod, Zeroable};
use glam::{UVec2, Vec3};

use crate::{DeepImageSettings, Directions};

/// The triangles of a scene, on the GPU.
#[derive(Clone, Copy, Debug)]
pub struct Triangles<'a> {
    /// `array<f32>`: nine coordinates per triangle, world space, metres.
    pub positions: &'a wgpu::Buffer,
    /// Number of triangles.
    pub count: u32,
    /// Lowest and highest corner of the box around them. Triangles that reach out of it are left out and counted.
    pub bounds_world: (Vec3, Vec3),
}

/// The images as kernels read them: `struct Images` of `deep_images.wesl`.
#[repr(C)]
#[derive(Clone, Copy, Debug, Default, PartialEq, Pod, Zeroable)]
pub struct ImagesUniform {
    /// Centre of the sphere around the scene, world space.
    pub centre_world: [f32; 3],
    /// Radius of the sphere, metres: slightly more than half the box's diagonal.
    pub radius_m: f32,
    /// Width of a pixel, metres.
    pub footprint_m: f32,
    /// Pixels along each side of an image.
    pub size_px: u32,
    /// Number of images.
    pub direction_count: u32,
    /// Number of triangles.
    pub triangle_count: u32,
    /// The most samples that fit.
    pub sample_capacity: u32,
    /// The most fragments that fit.
    pub fragment_capacity: u32,
    /// Width of a cell of the grid that triangles are sampled on, metres.
    pub cell_m: f32,
    /// Cells along each side of the grid.
    pub side_cells: u32,
    /// Slightly more than half the size of the scene's box, metres.
    pub half_box_m: [f32; 3],
    /// The longest list that is sorted. If a list is longer, every ray's length is unknown.
    pub sorted_longest: u32,
}

/// How much larger than its box the scene is assumed to be. It covers rounding of single precision.
const SLACK: f32 = 1.001;

impl ImagesUniform {
    /// The images around `triangles`. Capacities stay 0.
    pub(crate) fn new(
        settings: &DeepImageSettings,
        triangles: &Triangles<'_>,
    ) -> Result<Self, AssignError> {
        let (low, high) = triangles.bounds_world;
        let half = 0.5 * high - 0.5 * low;
        // Single precision cannot hold the squares of much larger or smaller numbers.
        let is_good = half.cmpge(Vec3::ZERO).all()
            && low.abs().max(high.abs()).max_element() <= MOST_COORDINATE_M;
        let fail = |field: &str, value: String, accepted: &str| AssignError::Parameter {
            field: field.into(),
            value,
            accepted: accepted.into(),
        };
        if !is_good {
            let accepted = format!(
                "the lower and the higher corner, within {MOST_COORDINATE_M:e} m of the origin"
            );
            return Err(fail(
                "box around the triangles (bounds_world)",
                format!("{low} to {high}"),
                &accepted,
            ));
        }
        let needed = u64::from(triangles.count) * 36;
        if triangles.positions.size() < needed {
            let accepted = format!("at least {needed} bytes for {} triangles", triangles.count);
            let bytes = format!("{} bytes", triangles.positions.size());
            return Err(fail("buffer of triangle positions", bytes, &accepted));
        }
        if triangles.count > MAX_TRIANGLES {
            let accepted = format!("at most {MAX_TRIANGLES}");
            return Err(fail("number of triangles", triangles.count.to_string(), &accepted));
        }
        let centre = low + half;
        // Coordinates far from the origin are rounded more, so the box grows by that.
        let rounding = 4.0 * f32::EPSILON * low.abs().max(high.abs()).max_element();
        let half = half * SLACK + rounding;
        let radius_m = half.length().max(LEAST_RADIUS_M) * SLACK;
        Ok(Self {
            centre_world: centre.into(),
            radius_m,
            footprint_m: 2.0 * radius_m / settings.size_px as f32,
            size_px: settings.size_px,
            direction_count: settings.directions.count(),
            triangle_count: triangles.count,
            sample_capacity: 0,
            fragment_capacity: 0,
            cell_m: 2.0 * radius_m / settings.side_cells() as f32,
            side_cells: settings.side_cells(),
            half_box_m: half.into(),
            sorted_longest: 0,
        })
    }

    /// Metres right, up and forward from the near corner of a direction's image.
    pub fn place(&self, directions: &Directions, direction: u32, point_world: Vec3) -> Vec3 {
        let from_centre = point_world - Vec3::from(self.centre_world);
        directions.frame(direction).transpose() * from_centre + self.radius_m
    }

    /// The pixel of a place in an image.
    pub fn pixel(&self, place: Vec3) -> UVec2 {
        (place.truncate() / self.footprint_m).as_uvec2().min(UVec2::splat(self.size_px - 1))
    }
}

/// The most triangles: 32 bits index nine coordinates each.
const MAX_TRIANGLES: u32 = u32::MAX / 9;
/// The largest coordinate of a scene, metres.
const MOST_COORDINATE_M: f32 = 1e9;
/// The least radius, metres: even a scene of one point has images.
const LEAST_RADIUS_M: f32 = 1e-6;
