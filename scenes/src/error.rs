//! What can go wrong, each in one line that names the file, the field, the value and what would
//! be accepted.

use std::path::PathBuf;

use thiserror::Error;

/// Why a scene or a set of lights could not be made.
#[derive(Debug, Error)]
pub enum SceneError {
    /// A file that the scene needs cannot be read.
    #[error("{}: cannot be read: {source}", file.display())]
    Read {
        /// The file that could not be read.
        file: PathBuf,
        /// What the system said.
        source: std::io::Error,
    },
    /// A file does not follow glTF 2.0.
    #[error("{}: {field} is {value}: it must be {accepted}", file.display())]
    Invalid {
        /// The scene's file.
        file: PathBuf,
        /// The offending field, as a JSON path where it has one.
        field: String,
        /// Its value.
        value: String,
        /// What would be accepted.
        accepted: String,
    },
    /// The file requires a glTF extension that this importer does not know.
    #[error("{}: extensionsRequired names {extension}: supported are {supported}", file.display())]
    Extension {
        /// The scene's file.
        file: PathBuf,
        /// The extension's name.
        extension: String,
        /// The extensions that would be accepted.
        supported: String,
    },
    /// An image does not decode.
    #[error("{}: {image} does not decode as PNG or JPEG: {reason}", file.display())]
    Image {
        /// The scene's file.
        file: PathBuf,
        /// Which image.
        image: String,
        /// What the decoder said.
        reason: String,
    },
    /// The scene has no triangles.
    #[error("{name}: scene has 0 triangles: it must have at least 1")]
    Empty {
        /// The scene's name or file.
        name: String,
    },
    /// A parameter lies outside its range.
    #[error("{field} is {value}: it must be {accepted}")]
    OutOfRange {
        /// The parameter.
        field: &'static str,
        /// Its value.
        value: String,
        /// What would be accepted.
        accepted: &'static str,
    },
    /// Neither the id of a scene nor a glTF file.
    #[error(
        "scene is \"{name}\": it must be a path that ends in .gltf or .glb, or one of {known}{nearest}"
    )]
    Unknown {
        /// What was asked for.
        name: String,
        /// The ids of all procedural scenes.
        known: String,
        /// The nearest ids, as "; nearest: a, b", or nothing.
        nearest: String,
    },
}
