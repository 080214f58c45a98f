//! The boxes that G can cut into cells.

use std::str::FromStr;

use assign::{AssignError, View};
use glam::{Vec2, Vec3};

/// The box that is cut into cells. Look-ups outside the box stay exact: a sample outside belongs to the
/// nearest cell if that cell extends to it or if no light reaches it. Otherwise it reads all lights.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
pub enum GridBox {
    /// The box around the lights' positions, as in the comparison paper (Enhuber 2019, sections 3.3
    /// and 4.1). Cells at the border extend outwards as far as any light reaches.
    ///
    /// Extending a border cell adds no point light to its list: the light's centre lies in the box,
    /// so the nearest point of the extended cell lies in the box as well.
    #[default]
    Positions,
    /// The box around the lights' supports. No light reaches a sample outside it. It is larger than
    /// the box of the positions by a range on each side, so cells are coarser.
    Supports,
    /// The intersection of the box around the supports and the box around the surfaces. Cells at the
    /// border extend as for [`Positions`](Self::Positions).
    Surfaces,
    /// The intersection of the box around the supports and the box around the view's frustum, which ends
    /// where no light reaches any deeper (Enhuber 2019, outlook). Cells move with the camera.
    Frustum,
    /// The intersection of the box around the supports and the box around the visible samples, which the
    /// GPU finds in every frame (Enhuber 2019, outlook). It reads the depth buffer.
    Visible,
}

impl GridBox {
    /// All boxes.
    pub const ALL: [Self; 5] =
        [Self::Positions, Self::Supports, Self::Surfaces, Self::Frustum, Self::Visible];

    /// The name in ids: `positions`, `supports`, `surfaces`, `frustum` or `visible`.
    pub fn name(self) -> &'static str {
        match self {
            Self::Positions => "positions",
            Self::Supports => "supports",
            Self::Surfaces => "surfaces",
            Self::Frustum => "frustum",
            Self::Visible => "visible",
        }
    }

    /// Whether it moves with the camera.
    pub fn is_view_bound(self) -> bool {
        matches!(self, Self::Frustum | Self::Visible)
    }
}

impl FromStr for GridBox {
    type Err = AssignError;

    /// Reads a [`name`](Self::name). Also reads `lights`, the former name of `supports`.
    fn from_str(text: &str) -> Result<Self, AssignError> {
        let found = Self::ALL.into_iter().find(|grid_box| grid_box.name() == text);
        match (found, text) {
            (Some(found), _) => Ok(found),
            (None, "lights") => Ok(Self::Supports),
            (None, _) => Err(AssignError::Parameter {
                field: "grid box".into(),
                value: text.into(),
                accepted: "positions, supports, surfaces, frustum or visible".into(),
            }),
        }
    }
}

/// The greatest view depth of the frustum's box, metres, so that its corners are finite.
const DEEPEST_M: f32 = 1e30;

/// The box around the view's frustum, from the near plane to the far plane or to the deepest point that a
/// light reaches, whichever is nearer: lowest and highest corner, world space, metres. `lights` is the box
/// around all lights' supports.
pub(crate) fn frustum_box(view: &View, lights: (Vec3, Vec3)) -> (Vec3, Vec3) {
    let uniform = view.uniform();
    let view_to_world = view.world_to_view.inverse();
    let (scale, offset) = (Vec2::from(uniform.ray_scale), Vec2::from(uniform.ray_offset));
    let near_m = view.nearest_rebuilt_m();
    let far_m = view.farthest_rebuilt_m().unwrap_or(DEEPEST_M);
    let deepest_m = view.deepest_m(lights.0, lights.1).min(DEEPEST_M);
    let end_m = far_m.min(deepest_m).max(near_m);
    let mut corners = (Vec3::INFINITY, Vec3::NEG_INFINITY);
    for depth_m in [near_m, end_m] {
        let footprint = if uniform.perspective > 0.5 { depth_m } else { 1.0 };
        for ndc in [Vec2::NEG_ONE, Vec2::new(1.0, -1.0), Vec2::new(-1.0, 1.0), Vec2::ONE] {
            let at = ((scale * ndc + offset) * footprint).extend(-depth_m);
            let corner = view_to_world.transform_point3(at);
            corners = (corners.0.min(corner), corners.1.max(corner));
        }
    }
    corners
}

/// How far rounding may move a sample in a box, metres: once where a shader or the CPU finds the box, and once
/// where shading looks the sample up.
pub(crate) fn position_slack_m(view: &View, (low, high): (Vec3, Vec3)) -> f32 {
    let extreme = low.abs().max(high.abs()).length();
    2.0 * view.uniform().position_error * (view.eye().length() + 2.0 * extreme)
}

#[cfg(test)]
mod tests {
    use assign::{DepthMapping, Projection};

    use super::*;

    /// Rust's frustum box holds the positions that shading rebuilds, for every projection.
    #[test]
    fn the_frustum_lies_in_its_box() {
        let eye = Vec3::new(3.0, 2.0, -5.0);
        let looking = View::look_at(eye, Vec3::new(-4.0, 1.0, 9.0), 1.0, 0.1, [64, 48]);
        let window = (Vec2::new(-4.0, -2.5), Vec2::new(5.0, 3.0));
        let orthographic = Projection::Orthographic { min: window.0, max: window.1 };
        let lights = (Vec3::splat(-30.0), Vec3::splat(30.0));
        for view in [
            looking,
            View { far_m: Some(12.0), depth: DepthMapping::Standard, ..looking },
            View { projection: orthographic, near_m: 0.0, far_m: Some(20.0), ..looking },
        ] {
            let (low, high) = frustum_box(&view, lights);
            let deepest = view.deepest_m(lights.0, lights.1);
            let end_m = view.far_m.map_or(deepest, |far_m| far_m.min(deepest));
            let to_world = view.world_to_view.inverse();
            let uniform = view.uniform();
            let mut touched = [f32::INFINITY; 3];
            for step in 0..9 * 9 * 9 {
                let part = |digit: u32| (step / digit % 9) as f32 / 8.0;
                let depth_m = view.near_m + (end_m - view.near_m) * part(81);
                let ndc = Vec2::new(part(1), part(9)) * 2.0 - 1.0;
                let ray = Vec2::from(uniform.ray_scale) * ndc + Vec2::from(uniform.ray_offset);
                let footprint = if uniform.perspective > 0.5 { depth_m } else { 1.0 };
                let point = to_world.transform_point3((ray * footprint).extend(-depth_m));
                let slack = position_slack_m(&view, (low, high));
                assert!((point - low).min_element() > -slack, "{view:?}: {point} below {low}");
                assert!((high - point).min_element() > -slack, "{view:?}: {point} above {high}");
                for axis in 0..3 {
                    touched[axis] = touched[axis].min(high[axis] - point[axis]);
                }
            }
            // The box is no larger than it must be.
            assert!(touched.iter().all(|gap| *gap < 0.02), "{view:?}: gaps of {touched:?}");
        }
        // All lights lie behind the camera: the near plane's box.
        let behind = frustum_box(&looking, (Vec3::new(4.0, 2.0, -9.0), Vec3::new(5.0, 3.0, -8.0)));
        assert!((behind.1 - behind.0).max_element() < 0.2, "{behind:?}");
    }

    #[test]
    fn names_parse_as_they_print() {
        for grid_box in GridBox::ALL {
            assert_eq!(grid_box.name().parse::<GridBox>().unwrap(), grid_box);
        }
        assert_eq!("lights".parse::<GridBox>().unwrap(), GridBox::Supports);
        let error = "cells".parse::<GridBox>().unwrap_err().to_string();
        assert!(error.contains("surfaces, frustum or visible"), "{error}");
    }
}
