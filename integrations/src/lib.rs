//! What the examples of this crate draw, so that each example holds only a renderer and its light assignment.

mod device;
mod scene;
mod target;

pub use device::open_device;
pub use scene::{Vertex, lights_at, scene, split_screen};
pub use target::{DEPTH_FORMAT, Target};
