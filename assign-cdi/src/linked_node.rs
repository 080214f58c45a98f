//! The nodes of linked lists of depths.

use bytemuck::{Pod, Zeroable};

/// A fragment of a linked list: `struct Node` of `build.wesl`, and `struct RayNode` of `ray_cast.wesl`.
#[repr(C)]
#[derive(Clone, Copy, Debug, Default, PartialEq, Pod, Zeroable)]
pub struct LinkedNode {
    /// Depth, metres from the near end of the image.
    pub depth_m: f32,
    /// Index of the next node plus one; 0 at the end.
    pub next: u32,
}
