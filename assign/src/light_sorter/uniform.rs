//! What the kernels of the order read and keep: `order_frame.wesl`.

use bytemuck::{Pod, Zeroable};

use super::code::{Code, MAX_BITS, code_bits};

/// A frame's parameters: `struct Order`. 160 bytes.
#[repr(C)]
#[derive(Clone, Copy, Debug, Default, PartialEq, Pod, Zeroable)]
pub(crate) struct OrderUniform {
    /// Lowest corner of the box that holds all positions, metres.
    pub(crate) low_world: [f32; 3],
    /// The largest radius of a light's ball, metres.
    pub(crate) radius_max_m: f32,
    /// Highest corner of that box, metres.
    pub(crate) high_world: [f32; 3],
    /// The most lights.
    pub(crate) capacity: u32,
    /// Cells of the code per metre.
    pub(crate) cells_per_m: [f32; 3],
    /// Blocks of the sort.
    pub(crate) blocks: u32,
    /// 1 if this frame sorts the lights.
    pub(crate) sorts: u32,
    /// Place of the first node of level 2.
    pub(crate) first_parent: u32,
    /// Place of the first node of level 3.
    pub(crate) first_grandparent: u32,
    /// How far a light's ball may reach beyond its ball before, metres.
    pub(crate) reach_m: f32,
    /// The bits of the code, as [`Code::bits`].
    pub(crate) code_bits: [u32; MAX_BITS as usize],
}

impl OrderUniform {
    /// Parameters for at most `capacity` lights in a box of positions.
    pub(crate) fn in_box(
        bounds: (glam::Vec3, glam::Vec3),
        radius_max_m: f32,
        sorts: bool,
        capacity: u32,
    ) -> Self {
        let code = Code::in_box(bounds, code_bits(capacity));
        Self {
            low_world: bounds.0.to_array(),
            high_world: bounds.1.to_array(),
            radius_max_m,
            capacity,
            cells_per_m: code.cells_per_m.to_array(),
            sorts: sorts.into(),
            reach_m: f32::MAX,
            code_bits: code.bits,
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
