//! What the kernels of the order read and keep: `order_frame.wesl`.

use bytemuck::{Pod, Zeroable};

/// A frame's parameters: `struct Order`. 64 bytes.
#[repr(C)]
#[derive(Clone, Copy, Debug, Default, PartialEq, Pod, Zeroable)]
pub(crate) struct OrderUniform {
    /// Lowest corner of the box that holds all positions, metres.
    pub(crate) low_world: [f32; 3],
    /// Cells of the Morton code per metre.
    pub(crate) cells_per_m: f32,
    /// Highest corner of that box, metres.
    pub(crate) high_world: [f32; 3],
    /// The largest radius of a light's ball, metres.
    pub(crate) radius_max_m: f32,
    /// The most lights.
    pub(crate) capacity: u32,
    /// Blocks of the radix sort.
    pub(crate) blocks: u32,
    /// 1 if this frame sorts the lights.
    pub(crate) sorts: u32,
    /// Place of the first node of level 2.
    pub(crate) first_parent: u32,
    /// Place of the first node of level 3.
    pub(crate) first_grandparent: u32,
    /// Pads to 64 bytes.
    pub(crate) padding: [u32; 3],
}

impl OrderUniform {
    /// Parameters for lights in a box of positions.
    pub(crate) fn in_box(
        (low, high): (glam::Vec3, glam::Vec3),
        radius_max_m: f32,
        sorts: bool,
    ) -> Self {
        let side_m = (high - low).max_element();
        let cells_per_m = if side_m > 0.0 { 255.999 / side_m } else { 0.0 };
        Self {
            low_world: low.to_array(),
            cells_per_m: if cells_per_m.is_finite() { cells_per_m } else { 0.0 },
            high_world: high.to_array(),
            radius_max_m,
            sorts: sorts.into(),
            ..Self::default()
        }
    }
}

/// What outlives a frame: `struct State`. 20 bytes.
#[repr(C)]
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Pod, Zeroable)]
pub(crate) struct SlotState {
    /// Slots in use.
    pub(crate) slots: u32,
    /// Number of the given lights.
    pub(crate) given: u32,
    /// Number of lights when they were last sorted.
    pub(crate) sorted: u32,
    /// Faulty lights.
    pub(crate) faulty: u32,
    /// Lights of intensity 0.
    pub(crate) dark: u32,
}

impl SlotState {
    /// Offset of the number of given lights, bytes.
    pub(crate) const GIVEN_AT: u64 = 4;
    /// Offset of the counts of faulty and dark lights, bytes.
    pub(crate) const COUNTS_AT: u64 = 12;
}
