//! Where deep images lie in the world.

use assign::AssignError;
use bytemuck::{Pod, Zeroable};
use glam::{UVec2, Vec3};

use crate::{DeepImageSettings, Directions};

/// The triangles of a scene, on the GPU.
#[derive(Clone, Copy, Debug)]
pub struct Triangles<'a> {
    /// `array<f32>`: nine a triangle, world space, metres.
    pub positions: &'a wgpu::Buffer,
    /// Number of triangles.
    pub count: u32,
    /// Corners of the box around them. Triangles that reach out of it are left out, and counted.
    pub bounds_world: (Vec3, Vec3),
}

/// What kernels are told of the images: `deep_images.wesl`, `struct Images`.
#[repr(C)]
#[derive(Clone, Copy, Debug, Default, PartialEq, Pod, Zeroable)]
pub struct ImagesUniform {
    /// Centre of the sphere around the scene, world space.
    pub centre_world: [f32; 3],
    /// Its radius: half the box's diagonal, and a little more.
    pub radius_m: f32,
    /// Width of a pixel.
    pub footprint_m: f32,
    /// Pixels along each side.
    pub size_px: u32,
    /// Number of images.
    pub direction_count: u32,
    /// Number of triangles.
    pub triangle_count: u32,
    /// Samples that there is room for.
    pub sample_capacity: u32,
    /// Fragments that there is room for.
    pub fragment_capacity: u32,
    /// Width of a cell of the grid that samples are taken on.
    pub cell_m: f32,
    /// Its cells along each side.
    pub side_cells: u32,
    /// Half the scene's box, and a little more.
    pub half_box_m: [f32; 3],
    /// The longest list that is sorted: longer ones say nothing.
    pub sorted_longest: u32,
}

/// How much larger than its box the scene is taken to be: rounding of single precision.
const SLACK: f32 = 1.001;

impl ImagesUniform {
    /// The images around `triangles`; capacities are left at zero.
    pub(crate) fn new(
        settings: &DeepImageSettings,
        triangles: &Triangles<'_>,
    ) -> Result<Self, AssignError> {
        let (low, high) = triangles.bounds_world;
        let half = 0.5 * high - 0.5 * low;
        // Squares of larger numbers, and of smaller ones, leave single precision.
        let is_good = half.cmpge(Vec3::ZERO).all()
            && low.abs().max(high.abs()).max_element() <= MOST_COORDINATE_M;
        let fail = |field: &str, value: String, accepted: &str| AssignError::Parameter {
            field: field.into(),
            value,
            accepted: accepted.into(),
        };
        if !is_good {
            let accepted = format!("two corners, lower first, within {MOST_COORDINATE_M:e} m");
            return Err(fail("bounds_world", format!("{low} to {high}"), &accepted));
        }
        let needed = u64::from(triangles.count) * 36;
        if triangles.positions.size() < needed {
            let accepted = format!("at least {needed} bytes for {} triangles", triangles.count);
            return Err(fail("positions", triangles.positions.size().to_string(), &accepted));
        }
        if triangles.count > MAX_TRIANGLES {
            let accepted = format!("at most {MAX_TRIANGLES}");
            return Err(fail("count of triangles", triangles.count.to_string(), &accepted));
        }
        let centre = low + half;
        // Rounding of coordinates far from the origin adds to the box.
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

    /// Metres right, up and forward of the near end of a direction's image.
    pub fn place(&self, directions: &Directions, direction: u32, point_world: Vec3) -> Vec3 {
        let from_centre = point_world - Vec3::from(self.centre_world);
        directions.frame(direction).transpose() * from_centre + self.radius_m
    }

    /// The pixel of a place.
    pub fn pixel(&self, place: Vec3) -> UVec2 {
        (place.truncate() / self.footprint_m).as_uvec2().min(UVec2::splat(self.size_px - 1))
    }
}

/// The most triangles: nine coordinates each are indexed with 32 bits.
const MAX_TRIANGLES: u32 = u32::MAX / 9;
/// The largest coordinate of a scene.
const MOST_COORDINATE_M: f32 = 1e9;
/// The least radius: a scene of one point has images, too.
const LEAST_RADIUS_M: f32 = 1e-6;
