//! The code of a position: the order of the lights.
//!
//! The box of all positions is halved along its longest side, bit by bit. Each bit of the code says in
//! which half the position lies, the first halving in the highest bit. So cells are nearly cubes
//! whatever the shape of the box, and a short code does. For a cube this is the Morton code. No side is
//! halved more than 8 times.
//!
//! Worked example: a box of 4 x 2 x 1 metres and a code of 4 bits. Its halvings are along x, then along
//! y (2 x 2 x 1 metres: the later of two equal sides), then x (2 x 1 x 1), then z (1 x 1 x 1). Its 16
//! cells measure 1 x 1 x 0.5 metres.

use glam::{UVec3, Vec3};

/// Halvings of one side at most.
const SIDE_BITS: u32 = 8;

/// The most bits of a code.
pub(super) const MAX_BITS: u32 = 3 * SIDE_BITS;

/// Bits of the code for at most `lights` lights: a cell of an evenly filled box holds up to 64 of them,
/// as many as a node.
pub(super) fn code_bits(lights: u32) -> u32 {
    match lights {
        0..=0x4000 => 8,
        0x4001..=0x40_0000 => 16,
        _ => MAX_BITS,
    }
}

/// How a position gives its code.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Code {
    /// Cells per metre along each axis; 0 for a side of no length.
    pub(super) cells_per_m: Vec3,
    /// For each bit of the code, from the lowest: the bit of the cell that it is, with 8 bits of the
    /// cell's x, then of y, then of z.
    pub(super) bits: [u32; MAX_BITS as usize],
}

impl Code {
    /// A code of `bits` bits for positions in a box.
    pub(super) fn in_box((low, high): (Vec3, Vec3), bits: u32) -> Self {
        let size = high - low;
        let mut side = size;
        // The axes of the halvings, and how often each axis is halved.
        let mut axes = Vec::new();
        let mut halvings = UVec3::ZERO;
        for _ in 0..bits {
            let open = (0..3).filter(|&axis| halvings[axis] < SIDE_BITS);
            let Some(axis) = open.max_by(|&a, &b| side[a].total_cmp(&side[b])) else { break };
            side[axis] *= 0.5;
            halvings[axis] += 1;
            axes.push(axis);
        }
        let per_m = |axis: usize| {
            // Below the number of cells, so that the highest corner is in the last one.
            let cells = ((1 << halvings[axis]) as f32).next_down();
            let per_m = cells / size[axis];
            if size[axis] > 0.0 && per_m.is_finite() { per_m } else { 0.0 }
        };
        let mut code = Self { cells_per_m: Vec3::from_array([0, 1, 2].map(per_m)), bits: [0; 24] };
        // The last halving along an axis is the lowest bit of its cell.
        let mut taken = UVec3::ZERO;
        for (bit, &axis) in code.bits.iter_mut().zip(axes.iter().rev()) {
            *bit = axis as u32 * SIDE_BITS + taken[axis];
            taken[axis] += 1;
        }
        code
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_worked_example() {
        let code = Code::in_box((Vec3::ZERO, Vec3::new(4.0, 2.0, 1.0)), 4);
        assert_eq!(code.bits[..4], [16, 0, 8, 1]);
        let cells = code.cells_per_m * Vec3::new(4.0, 2.0, 1.0);
        assert!(cells.abs_diff_eq(Vec3::new(4.0, 2.0, 2.0), 1e-5), "{cells}");
    }

    #[test]
    fn a_cube_has_the_morton_code() {
        let code = Code::in_box((Vec3::ZERO, Vec3::ONE), 24);
        for (bit, &from) in code.bits.iter().enumerate() {
            assert_eq!(from, bit as u32 % 3 * 8 + bit as u32 / 3);
        }
    }

    #[test]
    fn a_box_of_no_size_has_one_cell() {
        for high in [Vec3::ZERO, Vec3::new(1e-40, 0.0, 0.0)] {
            let code = Code::in_box((Vec3::ZERO, high), 16);
            assert_eq!(code.cells_per_m, Vec3::ZERO);
        }
    }

    #[test]
    fn no_side_is_halved_more_than_eight_times() {
        let code = Code::in_box((Vec3::ZERO, Vec3::new(1e6, 1.0, 1.0)), 16);
        let mut bits = code.bits[..16].to_vec();
        bits.sort_unstable();
        assert_eq!(bits, [0, 1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 16, 17, 18, 19]);
    }
}
