//! Exceptions that other work still removes. Empty both lists, then delete this file.

/// Imports that lie on a circle: crate, and user -> used.
pub(crate) const WAITING: &[(&str, &str)] = &[
    ("assign", "compiled -> shader"),
    ("assign", "cull -> cull_settings"),
    ("assign", "cull_settings -> cull"),
    ("assign", "emitter -> light"),
    ("assign", "gpu -> compiled"),
    ("assign", "light -> emitter"),
    ("assign", "shader -> compiled"),
    ("assign", "shader -> gpu"),
    ("assign-cdi", "deep_buffers -> snapshot"),
    ("assign-cdi", "snapshot -> deep_buffers"),
    ("assign-clustered", "clustered -> gather"),
    ("assign-clustered", "gather -> clustered"),
    ("assign-tiled", "tile_bounds -> tiled"),
    ("assign-tiled", "tiled -> tile_bounds"),
];

/// Files of more than 400 lines.
pub(crate) const LONG: &[&str] = &[];
