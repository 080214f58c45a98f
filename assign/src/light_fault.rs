//! Why a light cannot be used.

use thiserror::Error;

/// Why a light cannot be used. Such a light is left out and counted, never uploaded.
#[derive(Clone, Copy, Debug, PartialEq, Error)]
#[non_exhaustive]
pub enum LightFault {
    /// A field is NaN or infinite.
    #[error("{field} is {value}: it must be finite")]
    NotFinite {
        /// The field's name.
        field: &'static str,
        /// The offending value.
        value: f32,
    },
    /// A field lies outside its accepted range.
    #[error("{field} is {value}: it must be {accepted}")]
    OutOfRange {
        /// The field's name.
        field: &'static str,
        /// The offending value.
        value: f32,
        /// What is accepted.
        accepted: &'static str,
    },
}

impl LightFault {
    /// What [`Light::check`](crate::Light::check) says of a light of intensity 0, which lights nothing. A
    /// [`LightBuffer`](crate::LightBuffer) that keeps indices does not count it as faulty.
    pub const DARK: Self =
        Self::OutOfRange { field: "intensity", value: 0.0, accepted: "above 0 in some channel" };
}
