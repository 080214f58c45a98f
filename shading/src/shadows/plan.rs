//! Plans shadow maps: which points get maps, which faces they have, and where in the atlas each face lies.

use assign::{AssignError, Light, LightShape};
use glam::{DMat3, DVec3, Mat4, Vec4};

use super::points::{LightPoint, points_of};
use crate::{MAP_COUNTS, ShadowModel};

/// Texels beyond each edge of a face, per texel of the filter's side. The offset along the normal moves a look-up by at
/// most one texel per texel of the filter, and its taps reach half as far again.
const GUARD_PX: u32 = 2;

/// Faces of a map that looks to all sides: each looks along an axis of the light.
pub(super) const FACES: usize = 6;

/// Outer half angles of spots up to this one, radians, get one face. A wider one would waste more texels at its edge
/// than a hemisphere's five faces do.
const WIDEST_FACE: f32 = std::f32::consts::FRAC_PI_3;

/// The near plane of a map, in ranges of its light. Reversed depth in floating point is as precise for any near plane.
const NEAR_SHARE: f64 = 1.0 / (1 << 20) as f64;

/// The share of a distance by which a map's depth may lie in front of the surface that it shows, because the rasteriser
/// rounds: 2^-14. A triangle interpolates depth to a few units in the last place of its largest depth, which is some
/// hundred times that of its far end if it passes close to the light.
const DEPTH_SLACK: f64 = 1.0 / (1 << 14) as f64;

/// How far the rasteriser may move a vertex, texels: the least of the 8 bits that wgpu's back ends have below a texel.
const SNAP_PX: f64 = 1.0 / 256.0;

/// One face of a map: a picture of depth.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Face {
    /// World to view space: x right, y down, and -z forward. It may mirror.
    pub(super) world_to_view: Mat4,
    /// View to clip space, with reversed infinite depth.
    pub(super) view_to_clip: Mat4,
    /// Upper left corner in the atlas, texels.
    pub(super) origin: [u32; 2],
    /// Width and height, texels.
    pub(super) size: [u32; 2],
}

/// Planned maps.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Plan {
    /// Vectors of `shadow_records` in `shadow.wesl`.
    pub(super) records: Vec<[u32; 4]>,
    pub(super) faces: Vec<Face>,
    /// Width and height of the atlas, texels.
    pub(super) size: [u32; 2],
    /// How far the rasteriser moves depth away from the light, in greatest differences between neighbouring texels.
    pub(super) slopes: f32,
    /// Maps for each area light.
    pub(super) maps: u32,
    /// All maps.
    pub(super) map_count: u32,
}

/// The directions in which a light shines, as faces of maps.
#[derive(Clone, Copy, Debug, PartialEq)]
enum Reach {
    /// A cone around z: one face, with the tangent of the half angle.
    Cone(f64),
    /// The half space around +z: one whole face, and the upper halves of four more.
    Half,
    /// All directions: six faces.
    All,
}

impl Reach {
    fn of_light(light: &Light) -> Self {
        match &light.shape {
            LightShape::Point => Self::All,
            LightShape::Spot { outer_angle, .. } if *outer_angle <= WIDEST_FACE => {
                Self::Cone(f64::from(*outer_angle).tan())
            }
            LightShape::Spot { outer_angle, .. } if *outer_angle <= std::f32::consts::FRAC_PI_2 => {
                Self::Half
            }
            LightShape::Spot { .. } => Self::All,
            LightShape::Area(emitter) if emitter.shines_all_around() => Self::All,
            LightShape::Area(_) | LightShape::Vpl { .. } => Self::Half,
        }
    }

    /// Squares of the atlas that a map takes. Two halves share one.
    fn squares(self) -> u64 {
        match self {
            Self::Cone(_) => 1,
            Self::Half => 3,
            Self::All => FACES as u64,
        }
    }
}

/// The number of maps of a light.
fn maps_of(light: &Light, maps: u32) -> u64 {
    match light.shape {
        LightShape::Area(_) => u64::from(maps),
        LightShape::Point | LightShape::Spot { .. } | LightShape::Vpl { .. } => 1,
    }
}

/// Squares of the atlas that all lights take.
fn squares(lights: &[Light], maps: u32) -> u64 {
    lights.iter().map(|light| maps_of(light, maps) * Reach::of_light(light).squares()).sum()
}

impl Plan {
    /// Plans maps for lights in the order of their slots. `most_px` is the longest side of an atlas. If the maps do not
    /// fit, all area lights get the largest number of maps that does.
    ///
    /// # Errors
    ///
    /// [`AssignError::Parameter`] if not even one map for each light fits, or the model is faulty or off.
    pub(super) fn new(
        lights: &[Light],
        model: ShadowModel,
        most_px: u32,
    ) -> Result<Self, AssignError> {
        model.check()?;
        let ShadowModel::Maps { maps: asked, px, taps } = model else {
            return Err(AssignError::Parameter {
                field: "shadow model".into(),
                value: model.to_string(),
                accepted: "a model with maps".into(),
            });
        };
        let columns_most = most_px / px;
        let most = u64::from(columns_most).pow(2);
        let counts = MAP_COUNTS.into_iter().rev().filter(|maps| *maps <= asked);
        let maps = counts.into_iter().find(|maps| squares(lights, *maps) <= most);
        let Some(maps) = maps else {
            return Err(AssignError::Parameter {
                field: "shadow model".into(),
                value: format!("{model} for {} lights", lights.len()),
                accepted: format!(
                    "one whose maps fit an atlas of {most_px}x{most_px} texels: one map for each light takes {} \
                     squares of {px} texels, and {most} fit",
                    squares(lights, 1)
                ),
            });
        };
        let total = squares(lights, maps).max(1) as u32;
        let columns = ((f64::from(total)).sqrt().ceil() as u32).clamp(1, columns_most);
        let size = [columns * px, total.div_ceil(columns) * px];
        let mut planner = Planner {
            px,
            columns,
            texel: 2.0 / f64::from(px - 2 * GUARD_PX * taps.isqrt()),
            squares: 0,
            faces: Vec::new(),
            maps: Vec::new(),
        };
        // The farthest texel centre that a look-up reads, along one axis and in all.
        let across = 0.5 * f64::from(taps.isqrt()) + SNAP_PX;
        let reach = across * std::f64::consts::SQRT_2;
        let mut records = vec![[taps.isqrt(), px, bits(planner.texel), bits(reach)]];
        let first = 1 + 3 * lights.len();
        for light in lights {
            let record = planner.add(light, maps, first)?;
            records.extend(record);
        }
        records.append(&mut planner.maps);
        let map_count = ((records.len() - first) / 3) as u32;
        // Depth differs by at most one greatest difference along each of the two axes.
        let slopes = (2.0 * across) as f32;
        Ok(Self { records, faces: planner.faces, size, slopes, maps, map_count })
    }
}

/// Places faces in the atlas, one after the other.
struct Planner {
    px: u32,
    columns: u32,
    /// Tangents per texel of a face that covers a quarter turn.
    texel: f64,
    /// Squares that are taken.
    squares: u32,
    faces: Vec<Face>,
    /// Records of maps.
    maps: Vec<[u32; 4]>,
}

impl Planner {
    /// The record of a light. Its maps begin at the vector `first` plus those that were added before.
    fn add(
        &mut self,
        light: &Light,
        maps: u32,
        first: usize,
    ) -> Result<[[u32; 4]; 3], AssignError> {
        let reach = Reach::of_light(light);
        let axes = axes_of(light);
        let points = match &light.shape {
            LightShape::Area(emitter) => points_of(emitter, maps),
            LightShape::Point | LightShape::Spot { .. } | LightShape::Vpl { .. } => {
                vec![LightPoint::MIDDLE]
            }
        };
        let first_map = (first + self.maps.len()) as u32;
        let near_m = f64::from(light.range_m) * NEAR_SHARE;
        for point in &points {
            // Faces and shading start from the same rounded position.
            let eye = (light.position.as_dvec3() + point.offset).as_vec3();
            let faces = self.faces(reach, axes, eye.as_dvec3(), near_m);
            self.maps.extend([
                [eye.x.to_bits(), eye.y.to_bits(), eye.z.to_bits(), point.weight],
                [faces[0], faces[1], faces[2], faces[3]],
                [faces[4], faces[5], bits(near_m * (1.0 + DEPTH_SLACK)), 0],
            ]);
        }
        let (spread, half) = match reach {
            Reach::Cone(tangent) => (tangent, 0),
            Reach::Half => (0.0, 1 << 31),
            Reach::All => (0.0, 0),
        };
        let axis = |axis: DVec3, last| [bits(axis.x), bits(axis.y), bits(axis.z), last];
        Ok([
            axis(axes.x_axis, first_map),
            axis(axes.y_axis, points.len() as u32 | half),
            axis(axes.z_axis, bits(spread)),
        ])
    }

    /// Adds the faces of a map; returns the place of each in the atlas, x in the low half and y in the high one.
    fn faces(&mut self, reach: Reach, axes: DMat3, eye: DVec3, near_m: f64) -> [u32; FACES] {
        let (x, y, z) = (axes.x_axis, axes.y_axis, axes.z_axis);
        let px = self.px;
        // Right, down and forward of each face: `face_of` in `shadow.wesl`.
        let turned = [(x, y, z), (y, z, x), (y, z, -x), (x, z, y), (x, z, -y), (x, y, -z)];
        let mut places = [0; FACES];
        let count = match reach {
            Reach::Cone(_) => 1,
            Reach::Half => FACES - 1,
            Reach::All => FACES,
        };
        for (ix, (right, down, forward)) in turned.into_iter().enumerate().take(count) {
            let is_half = reach == Reach::Half && ix > 0;
            // The second of two halves lies below the first.
            let below = is_half && ix % 2 == 0;
            let square = if below { self.squares - 1 } else { self.squares };
            self.squares = square + 1;
            let (left, top) = (square % self.columns * px, square / self.columns * px);
            let origin = [left, if below { top + px / 2 } else { top }];
            let texel = self.texel * if let Reach::Cone(tangent) = reach { tangent } else { 1.0 };
            let side = 0.5 * f64::from(px) * texel;
            let rows = if is_half { [0.0, side] } else { [-side, side] };
            self.faces.push(Face {
                world_to_view: world_to_view(right, down, -forward, eye),
                view_to_clip: view_to_clip(side, rows, near_m),
                origin,
                size: [px, if is_half { px / 2 } else { px }],
            });
            places[ix] = origin[0] | origin[1] << 16;
        }
        places
    }
}

/// Single precision, as bits.
fn bits(value: f64) -> u32 {
    (value as f32).to_bits()
}

/// Unit axes of a light, world space. z is its direction or normal, if it has one.
fn axes_of(light: &Light) -> DMat3 {
    let around = |z: DVec3| {
        let z = z.normalize_or(DVec3::Z);
        let x = z.any_orthonormal_vector();
        DMat3::from_cols(x, z.cross(x), z)
    };
    match &light.shape {
        LightShape::Point => DMat3::IDENTITY,
        LightShape::Spot { direction, .. } => around(direction.as_dvec3()),
        LightShape::Vpl { normal, .. } => around(normal.as_dvec3()),
        LightShape::Area(emitter) => around(emitter.normal().as_dvec3()),
    }
}

/// A rigid or mirrored transform with these unit rows, and `eye` at its origin.
fn world_to_view(x: DVec3, y: DVec3, z: DVec3, eye: DVec3) -> Mat4 {
    let row = |axis: DVec3| axis.extend(-axis.dot(eye));
    glam::DMat4::from_cols(row(x), row(y), row(z), glam::DVec4::W).transpose().as_mat4()
}

/// Clip x runs from -`side` to `side` and clip y downwards from `rows[0]` to `rows[1]`, at depth 1. Clip depth is near
/// over depth: 1 at the near plane and 0 at infinity.
fn view_to_clip(side: f64, rows: [f64; 2], near_m: f64) -> Mat4 {
    let height = rows[1] - rows[0];
    // The image's top, clip y = 1, is row 0.
    let (down, top) = (-2.0 / height, 1.0 + 2.0 * rows[0] / height);
    Mat4::from_cols(
        Vec4::new((1.0 / side) as f32, 0.0, 0.0, 0.0),
        Vec4::new(0.0, down as f32, 0.0, 0.0),
        Vec4::new(0.0, -top as f32, 0.0, -1.0),
        Vec4::new(0.0, 0.0, near_m as f32, 0.0),
    )
}

#[cfg(test)]
mod tests;
