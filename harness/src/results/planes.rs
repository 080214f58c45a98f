//! The near and the far plane of a record's camera.

use serde::{Deserialize, Serialize};

/// Near and far plane of the view that the record's `eye` and `forward` describe.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct Planes {
    /// View depth of the near plane, metres.
    pub near_m: f64,
    /// The source of this depth.
    pub near_from: PlaneSource,
    /// View depth of the far plane, metres; `null`: infinitely far.
    #[serde(default)]
    pub far_m: Option<f64>,
    /// The source of this depth.
    pub far_from: PlaneSource,
}

/// The source of a plane's depth.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum PlaneSource {
    /// An option of the command line.
    Option,
    /// The camera of the scene's file.
    File,
    /// The scene. Its size, or the nearest visible surface, sets the near plane. Its bounds, seen from the eye,
    /// set the far plane.
    Scene,
}
