//! What can go wrong before a frame.

use thiserror::Error;

use crate::ViewError;

/// Why lists cannot be made. Raised before the first pass of a frame, never as a wrong image.
#[derive(Clone, Debug, Error)]
pub enum AssignError {
    /// No adapter that wgpu can drive.
    #[error(
        "no GPU adapter found ({looked_for}): install a Vulkan driver, or the software one (Debian: mesa-vulkan-drivers)"
    )]
    NoAdapter {
        /// What was looked for.
        looked_for: String,
    },
    /// No adapter of that name.
    #[error("there is no adapter called {name:?}: the known names are {known}")]
    UnknownAdapter {
        /// The name, or part of it, asked for.
        name: String,
        /// The adapters' names.
        known: String,
    },
    /// The adapter refused a device.
    #[error("adapter {adapter} opens no device: {reason}")]
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
        /// What would be accepted.
        accepted: String,
    },
    /// The view cannot be used.
    #[error(transparent)]
    View(#[from] ViewError),
    /// The strategy cannot serve what the frame asks for.
    #[error("{strategy} cannot serve {asked}: {reason}")]
    Unsupported {
        /// The strategy's id.
        strategy: String,
        /// What the frame asked for.
        asked: String,
        /// Why not.
        reason: String,
    },
    /// The renderer left out something the strategy needs.
    #[error("{strategy} needs {missing}, which the frame lacks")]
    Missing {
        /// The strategy's id.
        strategy: String,
        /// What is missing.
        missing: &'static str,
    },
    /// A buffer would exceed the device's limit.
    #[error("{what} needs {bytes} bytes: this device can bind at most {limit}")]
    TooLarge {
        /// What the buffer holds.
        what: String,
        /// The size asked for, bytes.
        bytes: u64,
        /// The device's limit, bytes.
        limit: u64,
    },
    /// The device has no memory left for a buffer.
    #[error("{what} needs {bytes} bytes: the device has too little free memory")]
    OutOfMemory {
        /// What the buffer holds.
        what: String,
        /// The size asked for, bytes.
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
