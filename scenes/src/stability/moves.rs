//! How time runs in a scenario, and the camera's paths.

use glam::Vec3;

use crate::{CameraPath, Lens, Pose};

/// How time runs in a scenario.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Move {
    /// The camera moves forward and sideways by less than a pixel per frame.
    Dolly,
    /// The camera turns by less than a pixel per frame.
    Rotation,
    /// The camera shows one of several poses in each frame, in turn.
    Teleport,
    /// The lights move by a law of [`MotionLaw`](crate::MotionLaw), named as `--motion` names it.
    Lights(&'static str),
}

impl Move {
    /// Its name; for lights, the name of the law.
    pub const fn name(self) -> &'static str {
        match self {
            Self::Dolly => "dolly",
            Self::Rotation => "rotation",
            Self::Teleport => "teleport",
            Self::Lights(law) => law,
        }
    }
}

/// The step of a frame, in pixels of an image with [`LINES`] lines. At 1,080 lines it is three quarters of a
/// pixel.
const STEP_PX: f32 = 0.25;

/// See [`STEP_PX`].
const LINES: f32 = 360.0;

/// The direction of a dolly: right, up, forward. It has length 1.
const DOLLY: Vec3 = Vec3::new(0.8, 0.0, 0.6);

/// The path of a move from a pose. `focus_m` is the distance at which a dolly moves the image by the step, and
/// `cuts` are the poses between which the camera jumps.
pub(super) fn path(
    way: Option<Move>,
    start: Pose,
    lens: Lens,
    focus_m: f32,
    cuts: &[Pose],
) -> CameraPath {
    let (height_m, turn) = match lens {
        Lens::Perspective { fov_y } => (2.0 * (0.5 * fov_y).tan() * focus_m, fov_y),
        Lens::Orthographic { half_height, .. } => (2.0 * half_height, 1.0),
    };
    match way {
        Some(Move::Dolly) => {
            let to_world = start.world_to_view().inverse();
            let along = to_world.transform_vector3(DOLLY * Vec3::new(1.0, 1.0, -1.0));
            CameraPath::steps(start, along * (height_m * STEP_PX / LINES), 0.0)
        }
        Some(Move::Rotation) => CameraPath::steps(start, Vec3::ZERO, turn * STEP_PX / LINES),
        Some(Move::Teleport) => CameraPath::cuts(cuts.to_vec(), start),
        Some(Move::Lights(_)) | None => CameraPath::still(start),
    }
}

/// The moves that an id may name, in words.
pub(super) fn accepted(ways: impl Iterator<Item = Move>) -> String {
    let names: Vec<&str> = ways.map(Move::name).collect();
    match names.as_slice() {
        [] => "left out, because its camera does not move".to_owned(),
        [only] => format!("{only}, or left out"),
        [first @ .., last] => format!("{} or {last}, or left out", first.join(", ")),
    }
}
