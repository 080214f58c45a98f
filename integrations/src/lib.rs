//! What the examples of this crate draw, so that each example holds only a renderer and its light assignment.

mod device;
mod draw;
mod scene;
mod target;

pub use device::open_device;
pub use draw::Draw;
pub use scene::{Shot, Vertex, lights_at, scene, split_screen};
pub use target::{DEPTH_FORMAT, Target};
