//! Errors before a frame.

use thiserror::Error;

use crate::ViewError;

/// Why a strategy cannot make lists. Errors come before the first pass of a frame; they never
/// become a wrong image.
#[derive(Clone, Debug, Error)]
#[non_exhaustive]
pub enum AssignError {
    /// wgpu finds no adapter.
    #[error(
        "no GPU adapter found ({looked_for}): install a Vulkan driver, or the software one (Debian: mesa-vulkan-drivers)"
    )]
    NoAdapter {
        /// The back ends that were searched.
        looked_for: String,
    },
    /// No adapter has that name.
    #[error("no adapter has {name:?} in its name: the adapters are {known}")]
    UnknownAdapter {
        /// The requested name, or part of it.
        name: String,
        /// The adapters' names.
        known: String,
    },
    /// The adapter refused a device.
    #[error("adapter {adapter} gives no device: {reason}")]
    NoDevice {
        /// The adapter's name.
        adapter: String,
        /// wgpu's reason.
        reason: String,
    },
    /// A parameter lies outside its range.
    #[error("{field} is {value}: it must be {accepted}")]
    Parameter {
        /// The parameter's name.
        field: String,
        /// The offending value.
        value: String,
        /// The accepted values.
        accepted: String,
    },
    /// The view is faulty.
    #[error(transparent)]
    View(#[from] ViewError),
    /// The strategy cannot serve what the frame asks for.
    #[error("{strategy} cannot serve {asked}: {reason}")]
    Unsupported {
        /// The strategy's id.
        strategy: String,
        /// What the frame asks for.
        asked: String,
        /// Why not.
        reason: String,
    },
    /// The frame lacks something that the strategy needs.
    #[error(
        "{strategy} needs {missing}, which the frame lacks: give it to the frame, as `Frame::with_depth` does for depth"
    )]
    Missing {
        /// The strategy's id.
        strategy: String,
        /// What is missing.
        missing: &'static str,
    },
    /// A frame read lights that the GPU should have ordered, and never did.
    #[error(
        "the frame before read lights that the GPU orders, but nothing ordered them: call `LightBuffer::record` in each \
         frame with new lights, before the strategy's `record`"
    )]
    LightsNotRecorded,
    /// A limit of the device is too small.
    #[error(
        "{strategy} needs the limit {limit} of {needs} or more, and the device has {has}: ask for it in `required_limits` \
         when opening the device"
    )]
    Limit {
        /// The strategy's id.
        strategy: String,
        /// The name of the field of `wgpu::Limits`.
        limit: &'static str,
        /// What the strategy needs.
        needs: u64,
        /// What the device has.
        has: u64,
    },
    /// An image of the frame is not what the strategy can read.
    #[error(
        "{strategy} reads {image} from a texture whose {field} is {value}: it must be {accepted}"
    )]
    Image {
        /// The strategy's id.
        strategy: String,
        /// What the image holds: `depth`, `normals`, `base colours`.
        image: &'static str,
        /// What is wrong with the texture.
        field: &'static str,
        /// The offending value.
        value: String,
        /// The accepted values.
        accepted: String,
    },
    /// A buffer is larger than the device can bind.
    #[error("{what} needs {bytes} bytes: this device can bind at most {limit}")]
    TooLarge {
        /// What the buffer holds.
        what: String,
        /// The requested size, bytes.
        bytes: u64,
        /// The device's limit, bytes.
        limit: u64,
    },
    /// The device has no memory left for a buffer.
    #[error("{what} needs {bytes} bytes: the device has too little free memory")]
    OutOfMemory {
        /// What the buffer holds.
        what: String,
        /// The requested size, bytes.
        bytes: u64,
    },
    /// A WESL module does not link or does not validate.
    #[error("shader {module}: {reason}")]
    Shader {
        /// The root module.
        module: String,
        /// The linker's message.
        reason: String,
    },
    /// The device was lost or a read-back failed.
    #[error("device: {0}")]
    Device(String),
}
