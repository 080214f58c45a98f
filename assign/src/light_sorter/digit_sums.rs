//! Tests the sums of the radix sort's digits alone. A sort needs more than a million lights to have more
//! blocks than a workgroup has lanes.

use bytemuck::bytes_of;

use super::{radix::Digit, uniform::OrderUniform};
use crate::{
    Gpu,
    conformance::{Bound, download, run_kernel, upload},
    kernel::Slot,
};

const DIGITS: usize = 256;

#[test]
fn digits_are_summed_over_the_blocks_before() {
    let gpu = Gpu::open(None).expect("an adapter: scripts/test installs the software one");
    let digit = Digit { shift: 0, first: true, last: false, many: true };
    let module = digit.shader().create(&gpu, "package::order_radix").expect("links");
    // Each lane sums one block up to 256 blocks, and two or three beyond.
    for blocks in [1, 255, 256, 257, 300, 600] {
        let counts: Vec<u32> = (0..(blocks + 1) * DIGITS).map(|ix| ix as u32 * 7 % 61).collect();
        let mut expected = counts.clone();
        for digit in 0..DIGITS {
            let mut before = 0;
            for place in digit * blocks..(digit + 1) * blocks {
                before += std::mem::replace(&mut expected[place], before);
            }
            expected[DIGITS * blocks + digit] = before;
        }
        let frame = OrderUniform { blocks: blocks as u32, ..OrderUniform::default() };
        let uniform = upload(&gpu, "light order", bytes_of(&frame)).expect("fits");
        let summed = upload(&gpu, "light digits", &counts).expect("fits");
        let groups = [
            Bound::Buffers(&[(0, Slot::Uniform, &uniform)]),
            Bound::Buffers(&[(2, Slot::Write, &summed)]),
        ];
        run_kernel(&gpu, &module, "sum_digits", &groups, DIGITS as u32);
        let summed: Vec<u32> = download(&gpu, &summed, counts.len()).expect("readable");
        assert_eq!(summed, expected, "{blocks} blocks");
    }
}
