//! The error for a field of a file.

use std::path::Path;

use crate::SceneError;

/// The error for a field with a value that is not accepted.
pub(super) fn invalid(
    path: &Path,
    field: impl Into<String>,
    value: impl ToString,
    accepted: impl Into<String>,
) -> SceneError {
    SceneError::Invalid {
        file: path.into(),
        field: field.into(),
        value: value.to_string(),
        accepted: accepted.into(),
    }
}
