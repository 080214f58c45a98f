//! Errors of shading.

use std::path::PathBuf;

use assign::{AssignError, LightKinds};
use thiserror::Error;

use crate::layers::LayerKinds;

/// Why a scene cannot be drawn, or an image not written.
#[derive(Debug, Error)]
pub enum ShadingError {
    /// An error of the contract.
    #[error(transparent)]
    Assign(#[from] AssignError),
    /// The image size lies outside what the device draws.
    #[error("size is {width}x{height}: it must be 1 to {limit} pixels on each side on this device")]
    Size {
        /// Width asked for, pixels.
        width: u32,
        /// Height asked for, pixels.
        height: u32,
        /// The device's limit, pixels.
        limit: u32,
    },
    /// A texture exceeds what the device holds.
    #[error(
        "image {name} is {width}x{height}: this device allows at most {limit} pixels on each side"
    )]
    Texture {
        /// The image's name.
        name: String,
        /// Its width, pixels.
        width: u32,
        /// Its height, pixels.
        height: u32,
        /// The device's limit, pixels.
        limit: u32,
    },
    /// Two images of different sizes cannot be compared.
    #[error("an image of {}x{} pixels cannot be compared with one of {}x{}", left[0], left[1], right[0], right[1])]
    Mismatch {
        /// Width and height of the first, pixels.
        left: [u32; 2],
        /// Width and height of the second, pixels.
        right: [u32; 2],
    },
    /// The prepared lights are of a kind for which the lighting pass was not compiled.
    #[error(
        "the lighting pass was compiled for {made:?}, but the lights are {lights:?}: create a new pass"
    )]
    Kinds {
        /// The kinds that the pass was compiled for.
        made: LightKinds,
        /// The kinds of the prepared lights.
        lights: LightKinds,
    },
    /// Depth or winding runs otherwise in the view than in the one that a lighting pass was compiled for.
    #[error(
        "the lighting pass was compiled for another direction of depth, or for a view that is not mirrored \
         alike: create a new pass"
    )]
    Orientation,
    /// The renderer draws other layers than those for which the lighting pass was compiled.
    #[error(
        "the lighting pass was compiled for {made:?}, but the renderer draws {drawn:?}: create a new pass"
    )]
    Layers {
        /// The layers that the pass was compiled for.
        made: LayerKinds,
        /// The layers of the renderer.
        drawn: LayerKinds,
    },
    /// The prepared lights are not those that shadow maps were drawn for.
    #[error(
        "the shadows were cast for other lights, or maps were not drawn: cast them again with Renderer::cast_shadows, and \
         create a new pass. If lights with maps move, call Renderer::move_shadows before Renderer::prepare, and record the maps in each \
         frame (Renderer::record_shadow_maps, record_occluders)"
    )]
    StaleShadows,
    /// Shadow maps that frames subdivide did not come to rest.
    #[error(
        "the shadow maps still changed after {frames} frames of the same view, which must not happen"
    )]
    RestlessShadows {
        /// Frames that were drawn.
        frames: u32,
    },
    /// A sample's look-up returned another number of lights than before.
    #[error(
        "two look-ups of the same frame returned different lights: {strategy} must return the same"
    )]
    Unsteady {
        /// The strategy's id.
        strategy: String,
    },
    /// A table of linearly transformed cosines is not valid.
    #[error("LTC table: {field} is {value}: it must be {accepted}")]
    LtcTable {
        /// The faulty field.
        field: &'static str,
        /// Its value.
        value: String,
        /// What is accepted.
        accepted: String,
    },
    /// A file could not be read.
    #[error("{path}: cannot be read: {reason}")]
    Read {
        /// The file.
        path: PathBuf,
        /// The reason.
        reason: String,
    },
    /// A file could not be written.
    #[error("{path}: cannot be written: {reason}")]
    Write {
        /// The file.
        path: PathBuf,
        /// The reason.
        reason: String,
    },
}
