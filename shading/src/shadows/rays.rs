//! Rays from samples to points of lights, through compound deep images (Archer, Leach, Knowles 2019), in place of maps.
//!
//! # The idea
//!
//! The points of a light and their weights are those of maps ([`points`](super::points)), and so is the visible share. Only
//! the test of a point differs: does a stored surface lie between it and the sample? One set of images serves all lights.
//! It holds for a still scene, whatever the lights do.
//!
//! The paper's rays read the list of one pixel, in the image of the direction nearest to their own. That list belongs to a
//! line which leaves the ray by the angle between both directions: 40 cm aside after 5 m, on average of 169 directions. A shadow
//! needs the line to end at the light. So `segment.wesl` changes the pixel on the way, and reads every pixel that the ray
//! crosses. Directions then decide how many pixels these are, and no longer how far the ray is off.
//!
//! # Widths
//!
//! Let `p` be the width of a pixel. Nothing is tuned.
//!
//! *The ends.* In a pixel, the line through its middle stands for the ray. It is at most `p / sqrt(2)` aside. A surface
//! through the sample, or through the light, meets this line up to `p / sqrt(2) / cos(t)` from there, if `t` is the angle
//! between its normal and the line. It may rise above the plane of the shading normal by the sine of the angle `d` between both
//! normals. So what lies less than `p / sqrt(2)` in front of this plane does not count, and no flat surface hides itself as
//! long as `sin d <= cos t`: any normal map where the light stands high, and 30 degrees at 60 degrees from the normal. The same
//! holds at the light. Its plane is that of a flat emitter, and for other lights the one across the ray.
//!
//! *From pixel to pixel.* The line of the next pixel lies `p` aside. A surface that the ray crosses here may have a greater
//! depth in the pixel that the ray leaves, and a smaller one in the next: both would miss it. Its depths differ by
//! `p tan t`, so one of them is within half of that. Each pixel's part of the way is `p` longer at both ends, which finds
//! surfaces up to `tan t = 2`, 63 degrees.
//!
//! # Cost
//!
//! A ray of length `l` crosses up to `2 + sqrt(2) l sin(a) / p` pixels if its direction is `a` off, and halves the list of
//! each.
//!
//! # Where it fails
//!
//! Shadows are as coarse as the pixels, everywhere: `p` is a constant of the scene, so a large scene has coarse
//! shadows. What rises less than `p / sqrt(2)` from the sample's plane casts none: light leaks at feet, and farther where it
//! is low. Beside a wall, half a pixel wide, the line may lie behind the wall and cross it, which darkens. A wall along a stored
//! direction lies between the lines of its pixels, and rays of this direction's cell pass it: take directions in which
//! no walls stand. Some rays pass walls that are more than 63 degrees from the image's plane. Alpha masks are solid. The share multiplies both lobes, as with maps.

use assign::{Gpu, Light, LightBuffer, LightShape, Outline, Passes};
use assign_cdi::{Build, Coverage, DeepImageSettings, DeepImages, Directions, Triangles};
use bytemuck::cast_slice;

use super::{
    ShadowFigures, check_device, check_known,
    plan::{axes_record, point_record},
    points::{LightPoint, points_of},
    reach::{axes_of, round_spread},
};
use crate::{ShadingError, ShadowModel, WorldTriangles, bound_shadows::BoundRays};

/// Storage buffers that a shader with lists and rays may bind: those with maps, and three of deep images.
const STORAGE_BUFFERS: u32 = super::STORAGE_BUFFERS + 3;

/// Vectors of a point in the records: as those of a map, of which rays read the first.
const POINT_VECTORS: usize = 3;

/// Settings of the deep images that rays of shadows cross. 8 x 8 directions by squares of 512 x 512 pixels are a start. The
/// pixels decide how far rays are off, and the directions only how many pixels they cross, so pixels are the better use of
/// memory. Take even numbers of directions: with odd ones, some lie in the planes of the axes, along which walls stand, and
/// no line meets a wall along it. A visit to the triangles for each direction leaves no holes: each line through the middle of a pixel meets all
/// surfaces that it crosses.
pub fn shadow_images(directions: Directions, size_px: u32) -> DeepImageSettings {
    DeepImageSettings {
        build: Build::PerDirection { coverage: Coverage::Centres, at_once: directions.count() },
        directions,
        size_px,
        ..DeepImageSettings::default()
    }
}

/// The points of a scene's lights, and the deep images that rays to them cross.
#[derive(Debug)]
pub(crate) struct ShadowRays {
    figures: ShadowFigures,
    /// The lights that the points are for, by slot.
    lights: Vec<Light>,
    images: DeepImages,
    bound: BoundRays,
    rounds: u64,
}

impl ShadowRays {
    /// Places the points, and builds the images until they fit. It blocks. Samples may lie up to `ranges` of the lights'
    /// ranges from them.
    ///
    /// # Errors
    ///
    /// [`AssignError::Unsupported`](assign::AssignError::Unsupported) for lights whose slots the CPU does not know,
    /// [`AssignError::TooLarge`](assign::AssignError::TooLarge) if the images do not fit, and
    /// [`AssignError::Parameter`](assign::AssignError::Parameter) for faulty settings and linked lists.
    pub(crate) fn new(
        gpu: &Gpu,
        lights: &LightBuffer,
        (model, ranges): (ShadowModel, f32),
        (triangles, settings): (&WorldTriangles, DeepImageSettings),
    ) -> Result<Self, ShadingError> {
        check_device(gpu, "shading with rays through deep images", STORAGE_BUFFERS)?;
        check_known(model, lights)?;
        model.check()?;
        let records = records(lights.lights(), model.maps());
        let bytes: &[u8] = cast_slice(&records);
        let buffer = gpu.storage("points of lights", bytes.len() as u64)?;
        gpu.queue.write_buffer(&buffer, 0, bytes);
        let mut images = DeepImages::new(gpu, settings)?;
        images.settle(
            gpu,
            &Triangles {
                positions: &triangles.positions,
                count: triangles.count,
                bounds_world: triangles.bounds_world,
            },
        )?;
        let bound = BoundRays { model, ranges, records: buffer, images: images.ray_buffers()? };
        let reach_m = lights.lights().iter().map(|light| {
            f64::from(light.range_m) * f64::from(ranges) + f64::from(light.radius_m())
        });
        let rounds = rounds_of_ray(&images, reach_m.fold(0.0, f64::max));
        let figures = ShadowFigures {
            model,
            maps_per_area_light: model.maps(),
            maps: ((records.len() - 1 - 3 * lights.lights().len()) / POINT_VECTORS) as u32,
            faces: 0,
            atlas_px: [0; 2],
            occluder_bytes: 0,
            image_bytes: images.bytes(),
        };
        let lights = lights.lights().to_vec();
        Ok(Self { figures, lights, images, bound, rounds })
    }

    pub(crate) fn figures(&self) -> ShadowFigures {
        self.figures
    }

    /// The lights that the points are for, by slot.
    pub(crate) fn lights(&self) -> &[Light] {
        &self.lights
    }

    /// The images that rays cross.
    pub(crate) fn images(&self) -> &DeepImages {
        &self.images
    }

    /// What lighting reads.
    pub(crate) fn bound(&self) -> &BoundRays {
        &self.bound
    }

    /// The most rounds of loops that a ray takes.
    pub(crate) fn rounds(&self) -> u64 {
        self.rounds
    }

    /// Records the passes that build the images again. They stay the same.
    pub(crate) fn record(&mut self, passes: &mut dyn Passes) {
        self.images.record(passes);
    }
}

/// The most rounds of loops of a ray that is at most so long: one for each pixel that it crosses and one to end, and in each
/// pixel those that halve a list.
fn rounds_of_ray(images: &DeepImages, longest_m: f64) -> u64 {
    let space = images.space();
    let aside_m = longest_m * images.settings().directions.max_angle().sin();
    let across = std::f64::consts::SQRT_2 * aside_m / f64::from(space.footprint_m) + 3.0;
    // A ray that leaves the image does not come back.
    let pixels = across.min(2.0 * f64::from(space.size_px) + 2.0) as u64;
    let longest = images.stats().map_or(u32::MAX, |stats| stats.longest);
    let halvings = u64::from(u32::BITS - longest.leading_zeros());
    pixels * (2 + halvings) + 1
}

/// Vectors of `shadow_records` in `shadow.wesl`: as those of maps, without faces.
fn records(lights: &[Light], rays: u32) -> Vec<[u32; 4]> {
    // One tap.
    let mut records = vec![[1, 0, 0, 0]];
    let first = 1 + 3 * lights.len();
    let mut points = Vec::new();
    for light in lights {
        let (of_light, is_flat) = match &light.shape {
            LightShape::Area(emitter) => {
                let is_flat = !matches!(emitter.outline(), Outline::Sphere | Outline::Line);
                (points_of(emitter, rays), is_flat)
            }
            LightShape::Vpl { .. } => (vec![LightPoint::MIDDLE], true),
            LightShape::Point | LightShape::Spot { .. } => (vec![LightPoint::MIDDLE], false),
        };
        let place = (first + points.len()) as u32;
        let count = of_light.len() as u32 | if is_flat { 1 << 31 } else { 0 };
        records.extend(axes_record(axes_of(light), place, count, round_spread(light)));
        for point in of_light {
            let at = (light.position.as_dvec3() + point.offset).as_vec3();
            points.extend([point_record(at, point.weight), [0; 4], [0; 4]]);
        }
    }
    records.extend(points);
    records
}
