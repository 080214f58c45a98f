//! Plans shadow maps: which points get maps, which faces they have, and where in the atlas each face lies.

use assign::{AssignError, Light, LightShape, Outline};
use glam::{DMat3, DVec3, Mat4, Vec3};

use super::{
    face::{FACES, Face, across, beyond, bits, turned, view_to_clip, world_to_view},
    patch::{PATCH_VECTORS, WIDEST_SEARCH, middles_of, patch_of},
    points::{LightPoint, points_of},
    reach::{Reach, axes_of, round_spread},
    sun_maps::{SunMapsRecord, SunnyScene},
};
use crate::{FEWEST_ADAPTIVE, MAP_COUNTS, ShadowModel};

/// Texels beyond each edge of a face, per texel of the filter's side. The offset along the normal moves a look-up by at
/// most one texel per texel of the filter, and its taps reach half as far again.
const GUARD_PX: u32 = 2;

/// The near plane of a map, in ranges of its light. Reversed depth in floating point is as precise for any near plane.
const NEAR_SHARE: f64 = 1.0 / (1 << 20) as f64;

/// The share of a distance by which a map's depth may lie in front of the surface that it shows, because the rasteriser
/// rounds: 2^-10, a millimetre per metre. Adapters interpolate the depth of a triangle less precisely where it is much larger
/// than the map. In a room whose walls are two triangles each, an H200 needs more than 2^-12 and passes with 2^-10
/// (`no_surface_shadows_itself`), whatever the near plane; llvmpipe passes with 2^-14.
const DEPTH_SLACK: f64 = 1.0 / (1 << 10) as f64;

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
    /// The rectangles that frames subdivide, ascending. Their maps are placed, and wait for their points.
    pub(super) sites: Vec<Site>,
    /// The maps of suns, which are the first faces.
    pub(super) suns: SunMapsRecord,
}

/// Where the maps of a light lie whose points change.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Site {
    /// Its slot.
    pub(super) light: usize,
    /// The vector of its first map in the records. Each map has three.
    pub(super) first_map: usize,
    /// The index of the first face of its first map.
    pub(super) first_face: usize,
    /// Faces of a map.
    pub(super) face_count: usize,
    /// Right, down and forward of each face.
    turned: [(DVec3, DVec3, DVec3); FACES],
}

impl Site {
    /// World to view space of a face, seen from `eye`.
    pub(super) fn world_to_view(&self, face: usize, eye: DVec3) -> Mat4 {
        let (right, down, forward) = self.turned[face];
        world_to_view(right, down, -forward, eye)
    }
}

/// Whether a light is a rectangle, whose points are corners of quads.
fn is_rectangle(light: &Light) -> bool {
    matches!(&light.shape, LightShape::Area(emitter) if emitter.outline() == Outline::Rectangle)
}

/// A corner of a rectangle.
fn corner_of(light: &Light) -> LightPoint {
    let LightShape::Area(emitter) = &light.shape else { return LightPoint::MIDDLE };
    let [x, y] = emitter.half_axes().map(Vec3::as_dvec3);
    LightPoint { offset: x + y, ..LightPoint::MIDDLE }
}

/// The number of maps of a light. Other area lights than rectangles get the largest of [`MAP_COUNTS`] that is not
/// above `maps`.
fn maps_of(light: &Light, maps: u32) -> u64 {
    match &light.shape {
        LightShape::Area(_) if is_rectangle(light) => u64::from(maps),
        LightShape::Area(_) => u64::from(fixed_count(maps)),
        LightShape::Point | LightShape::Spot { .. } | LightShape::Vpl { .. } => 1,
    }
}

/// The largest of [`MAP_COUNTS`] that is not above a number.
fn fixed_count(maps: u32) -> u32 {
    MAP_COUNTS.into_iter().rfind(|count| *count <= maps).unwrap_or(1)
}

/// Squares of the atlas that all lights take.
fn squares(lights: &[Light], maps: u32, are_curved: bool) -> u64 {
    let of_light = |light| maps_of(light, maps) * Reach::of_light(light).squares(are_curved);
    lights.iter().map(of_light).sum()
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
        sunny: SunnyScene,
        model: ShadowModel,
        most_px: u32,
    ) -> Result<Self, AssignError> {
        model.check()?;
        let px = model.px();
        // The numbers of maps to try, from the most.
        let counts: Vec<u32> = match model {
            ShadowModel::None | ShadowModel::Cdi { .. } => {
                return Err(AssignError::Parameter {
                    field: "shadow model".into(),
                    value: model.to_string(),
                    accepted: "a model with maps".into(),
                });
            }
            ShadowModel::Maps { maps, .. }
            | ShadowModel::Pcss { maps, .. }
            | ShadowModel::Paraboloids { maps, .. } => {
                MAP_COUNTS.into_iter().rev().filter(|count| *count <= maps).collect()
            }
            ShadowModel::Adaptive { most, .. } => (FEWEST_ADAPTIVE..=most).rev().collect(),
        };
        let columns_most = most_px / px;
        let most = u64::from(columns_most).pow(2);
        let fewest = counts.last().copied().unwrap_or(1);
        let are_curved = model.is_curved();
        let squares = |maps: u32| squares(lights, maps, are_curved) + u64::from(sunny.squares());
        let fits = |maps: u32| squares(maps) <= most;
        let maps = counts.into_iter().filter(|_| fits(fewest)).find(|maps| fits(*maps));
        let Some(maps) = maps else {
            return Err(AssignError::Parameter {
                field: "shadow model".into(),
                value: format!("{model} for {} lights", lights.len()),
                accepted: format!(
                    "one whose maps fit an atlas of {most_px}x{most_px} texels: {fewest} for each area light and one \
                     for each other light take {} squares of {px} texels, and {most} fit",
                    squares(fewest)
                ),
            });
        };
        let total = squares(maps).max(1) as u32;
        let columns = ((f64::from(total)).sqrt().ceil() as u32).clamp(1, columns_most);
        Ok(Self::place(lights, sunny, model, (maps, columns)))
    }

    /// Plans so many maps for each area light, in an atlas of so many columns of squares. It has as many rows as it needs.
    pub(super) fn place(
        lights: &[Light],
        sunny: SunnyScene,
        model: ShadowModel,
        (maps, columns): (u32, u32),
    ) -> Self {
        let (px, taps) = (model.px(), model.taps());
        let total = (squares(lights, maps, model.is_curved()) as u32 + sunny.squares()).max(1);
        let guard = GUARD_PX * taps.isqrt();
        let (sun_faces, suns) = sunny.maps(columns, px, (guard, taps.isqrt()));
        let size = [columns * px, total.div_ceil(columns) * px];
        let mut planner = Planner {
            px,
            columns,
            texel: 2.0 / f64::from(px - 2 * guard),
            taps: f64::from(taps.isqrt()),
            soft_taps: model.look_ups() / 2,
            are_curved: model.is_curved(),
            squares: sunny.squares(),
            faces: sun_faces,
            maps: Vec::new(),
        };
        // The farthest texel centre that a look-up reads, along one axis and in all.
        let across = across(planner.taps);
        let reach = across * std::f64::consts::SQRT_2;
        let mut records = vec![[taps.isqrt(), px, bits(planner.texel), bits(reach)]];
        let first = 1 + 3 * lights.len();
        let mut sites = Vec::new();
        for (ix, light) in lights.iter().enumerate() {
            if model.is_adaptive() && is_rectangle(light) {
                let reach = Reach::of_light(light);
                sites.push(Site {
                    light: ix,
                    first_map: first + planner.maps.len(),
                    first_face: planner.faces.len(),
                    face_count: reach.face_count(false),
                    turned: turned(axes_of(light)),
                });
                // Any point of the rectangle may take a place, so each reaches as far as a corner does.
                let waiting = vec![corner_of(light); maps as usize];
                records.extend(planner.add(light, waiting, first));
                continue;
            }
            let count = maps_of(light, maps) as u32;
            let points = match &light.shape {
                LightShape::Area(emitter) if model.is_soft() => middles_of(emitter, count),
                LightShape::Area(emitter) => points_of(emitter, count),
                LightShape::Point | LightShape::Spot { .. } | LightShape::Vpl { .. } => {
                    vec![LightPoint::MIDDLE]
                }
            };
            records.extend(planner.add(light, points, first));
        }
        records.append(&mut planner.maps);
        let vectors = if model.is_soft() { 3 + PATCH_VECTORS } else { 3 };
        let map_count = ((records.len() - first) / vectors) as u32;
        // Depth differs by at most one greatest difference along each of the two axes.
        let slopes = (2.0 * across) as f32;
        Self { records, faces: planner.faces, size, slopes, maps, map_count, sites, suns }
    }
}

/// Places faces in the atlas, one after the other.
struct Planner {
    px: u32,
    columns: u32,
    /// Tangents per texel of a face that covers a quarter turn.
    texel: f64,
    /// Texels on a side of the filter.
    taps: f64,
    /// Look-ups of a soft filter; 0 without one.
    soft_taps: u32,
    /// Whether faces are paraboloids, where they are no cones.
    are_curved: bool,
    /// Squares that are taken.
    squares: u32,
    faces: Vec<Face>,
    /// Records of maps.
    maps: Vec<[u32; 4]>,
}

impl Planner {
    /// The record of a light with a map from each of its points. Its maps begin at the vector `first` plus those that
    /// were added before.
    fn add(&mut self, light: &Light, points: Vec<LightPoint>, first: usize) -> [[u32; 4]; 3] {
        let reach = Reach::of_light(light);
        let axes = axes_of(light);
        let first_map = (first + self.maps.len()) as u32;
        let near_m = f64::from(light.range_m) * NEAR_SHARE;
        for point in &points {
            // Faces and shading start from the same rounded position.
            let eye = (light.position.as_dvec3() + point.offset).as_vec3();
            let widest = if self.soft_taps > 0 { WIDEST_SEARCH } else { 1.0 };
            let reach_m = widest * (f64::from(light.radius_m()) + point.offset.length());
            let faces = self.faces(reach, axes, eye, (near_m, reach_m));
            self.maps.extend([
                point_record(eye, point.weight),
                [faces[0], faces[1], faces[2], faces[3]],
                [faces[4], faces[5], bits(near_m * (1.0 + DEPTH_SLACK)), self.soft_taps],
            ]);
            if self.soft_taps > 0 {
                self.maps.extend(patch_of(light, points.len() as u32, axes));
            }
        }
        let (spread, half) = match reach {
            Reach::Cone(tangent) => (tangent, 0),
            Reach::Half => (0.0, 1 << 31),
            Reach::All => (round_spread(light), 0),
        };
        axes_record(axes, first_map, points.len() as u32 | half, spread)
    }

    /// Adds the faces of a map; returns the place of each in the atlas, x in the low half and y in the high one.
    /// `eye` is the point of the light, and the light reaches from `near_m` to `reach_m` around it.
    fn faces(
        &mut self,
        reach: Reach,
        axes: DMat3,
        eye: Vec3,
        (near_m, reach_m): (f64, f64),
    ) -> [u32; FACES] {
        let px = self.px;
        let mut places = [0; FACES];
        let is_curved = self.are_curved && !matches!(reach, Reach::Cone(_));
        let all = turned(axes);
        // The second paraboloid looks backwards.
        let turned = if is_curved { vec![all[0], all[FACES - 1]] } else { all.to_vec() };
        let turned = turned.into_iter().take(reach.face_count(is_curved));
        for (ix, (right, down, forward)) in turned.enumerate() {
            let is_half = !is_curved && reach == Reach::Half && ix > 0;
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
                world_to_view: world_to_view(right, down, -forward, eye.as_dvec3()),
                view_to_clip: view_to_clip(side, rows, near_m),
                origin,
                size: [px, if is_half { px / 2 } else { px }],
                eye,
                reach_m: (reach_m * beyond(texel, self.taps)) as f32,
                is_curved,
            });
            places[ix] = origin[0] | origin[1] << 16;
        }
        places
    }
}

/// The vectors of a light: its axes, the vector of its first map or point, their number, and its spread.
pub(super) fn axes_record(axes: DMat3, first: u32, count: u32, spread: f64) -> [[u32; 4]; 3] {
    let axis = |axis: DVec3, last| [bits(axis.x), bits(axis.y), bits(axis.z), last];
    [axis(axes.x_axis, first), axis(axes.y_axis, count), axis(axes.z_axis, bits(spread))]
}

/// The first vector of a map: its point, and the weight of that.
pub(super) fn point_record(eye: Vec3, weight: u32) -> [u32; 4] {
    [eye.x.to_bits(), eye.y.to_bits(), eye.z.to_bits(), weight]
}

#[cfg(test)]
mod tests;
