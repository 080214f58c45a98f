//! Reads cameras: where a node puts them, their lens and their planes.
//!
//! A camera that the scene places must hold what glTF 2.0 requires; an error names the faulty
//! field. Cameras that no node places are not read.

use std::f32::consts::PI;

use glam::DMat4;
use gltf::json::{
    camera::{Camera as JsonCamera, Orthographic, Perspective, Type},
    validation::Checked,
};

use super::{file::File, warnings::kept_name};
use crate::{Camera, Framing, Lens, Pose, SceneError};

/// Fields of view are larger than this, radians. In a smaller one, f32 could not separate the
/// 16,384 pixels of an image.
const LEAST_FOV_Y: f32 = 1e-6;
/// Fields of view are smaller than this, just short of half a turn.
const MOST_FOV_Y: f32 = 0.999 * PI;

/// The range of plane distances that f32 can still separate after a scene is scaled, metres.
const LEAST_NEAR_M: f32 = 1e-12;
const MOST_NEAR_M: f32 = 1e12;
const MOST_FAR_M: f32 = 1e30;

/// Camera `ix` of the file, where a node places it.
pub(super) fn placed(
    file: &File,
    ix: usize,
    json: &JsonCamera,
    node_name: &str,
    to_world: &DMat4,
) -> Result<Camera, SceneError> {
    let name = json.name.as_deref().map_or_else(|| node_name.into(), kept_name);
    let check = Check { file, ix };
    let (lens, near_m, far_m) = match (json.type_, &json.perspective, &json.orthographic) {
        (Checked::Valid(Type::Orthographic), _, Some(lens)) => check.orthographic(lens)?,
        (Checked::Valid(Type::Orthographic), _, None) => return Err(check.missing("orthographic")),
        (_, Some(lens), _) => check.perspective(lens)?,
        (_, None, _) => return Err(check.missing("perspective")),
    };
    let framing = Framing::PLAIN;
    Ok(Camera { name, pose: Pose::of_node(to_world), lens, near_m, far_m, framing })
}

/// Checks the fields of one camera.
struct Check<'a> {
    file: &'a File,
    ix: usize,
}

impl Check<'_> {
    fn missing(&self, field: &str) -> SceneError {
        let accepted = "present: it is the camera's type";
        self.file.invalid(format!("cameras[{}].{field}", self.ix), "missing", accepted)
    }

    fn is(
        &self,
        field: &str,
        value: f32,
        is_accepted: bool,
        accepted: impl Into<String>,
    ) -> Result<(), SceneError> {
        if is_accepted && value.is_finite() {
            return Ok(());
        }
        Err(self.file.invalid(format!("cameras[{}].{field}", self.ix), value, accepted))
    }

    fn perspective(&self, lens: &Perspective) -> Result<(Lens, f32, Option<f32>), SceneError> {
        let (fov_y, near) = (lens.yfov, lens.znear);
        let fov_ok = fov_y > LEAST_FOV_Y && fov_y < MOST_FOV_Y;
        self.is("perspective.yfov", fov_y, fov_ok, "above 0.000001 and below 3.138 radians")?;
        if let Some(aspect) = lens.aspect_ratio {
            self.is("perspective.aspectRatio", aspect, aspect > 0.0, "above 0 and finite")?;
        }
        let near_ok = (LEAST_NEAR_M..=MOST_NEAR_M).contains(&near);
        self.is("perspective.znear", near, near_ok, "from 1e-12 to 1e12 metres")?;
        if let Some(far) = lens.zfar {
            let accepted = format!(
                "above znear, {near} m, and at most 1e30 m, or absent for an infinite far plane"
            );
            self.is("perspective.zfar", far, far > near && far <= MOST_FAR_M, accepted)?;
        }
        Ok((Lens::Perspective { fov_y }, near, lens.zfar))
    }

    fn orthographic(&self, lens: &Orthographic) -> Result<(Lens, f32, Option<f32>), SceneError> {
        let (half_width, half_height) = (lens.xmag.abs(), lens.ymag.abs());
        let (near, far) = (lens.znear, lens.zfar);
        let size = |half: f32| (1e-9..=1e12).contains(&half);
        let accepted = "from 1e-9 to 1e12 metres";
        self.is("orthographic.xmag", lens.xmag, size(half_width), accepted)?;
        self.is("orthographic.ymag", lens.ymag, size(half_height), accepted)?;
        let near_ok = (0.0..=MOST_NEAR_M).contains(&near);
        self.is("orthographic.znear", near, near_ok, "from 0 to 1e12 metres")?;
        let accepted = format!("above znear, {near} m, and at most 1e30 m");
        self.is("orthographic.zfar", far, far > near && far <= MOST_FAR_M, accepted)?;
        Ok((Lens::Orthographic { half_width, half_height }, near, Some(far)))
    }
}
