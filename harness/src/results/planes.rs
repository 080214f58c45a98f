//! The near and the far plane of a record's camera.

use serde::{Deserialize, Serialize};

/// Near and far plane of the view that the record's `eye` and `forward` tell.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct Planes {
    /// View depth of the near plane, metres.
    pub near_m: f64,
    /// What says where it is.
    pub near_from: PlaneSource,
    /// View depth of the far plane, metres; `null`: infinitely far.
    #[serde(default)]
    pub far_m: Option<f64>,
    /// What says where it is.
    pub far_from: PlaneSource,
}

/// What says where a plane is.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum PlaneSource {
    /// An option of the command line.
    Option,
    /// The camera of the scene's file.
    File,
    /// The size of the scene, or the nearest surface in view where that is nearer; of the far plane, the
    /// scene's bounds as seen from the eye.
    Scene,
}
