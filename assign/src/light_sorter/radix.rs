//! The radix sort: `order/radix.wesl`.

use super::{
    code::code_bits,
    kernels::{LANES, frame_layout, order_shader},
};
use crate::{
    AssignError, Gpu, Shader,
    kernel::{MAX_WORKGROUPS, Slot, bind_buffers, layout, pipeline},
};

/// Values of a digit, and its bits.
const DIGITS: u32 = 256;
const DIGIT_BITS: u32 = 8;

/// How the lights are cut into blocks.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) struct Blocks {
    /// Rounds of a block: each sorts as many lights as a workgroup has lanes.
    pub(super) rounds: u32,
    pub(super) counting: Counting,
}

/// How a block finds the places of its digits.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Counting {
    /// It adds up the counts of all blocks.
    Together,
    /// A pass of its own has added up the counts.
    Summed,
}

impl Blocks {
    /// The blocks for at most `lights` lights.
    pub(super) fn over(lights: u32) -> Self {
        match lights {
            0..=0x4000 => Self { rounds: 1, counting: Counting::Together },
            0x4001..=0x2_0000 => Self { rounds: 4, counting: Counting::Together },
            _ => Self { rounds: 8, counting: Counting::Summed },
        }
    }

    /// Their number.
    fn count(self, lights: u32) -> u32 {
        lights.div_ceil(self.rounds * LANES).max(1)
    }
}

/// One pass over a digit.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) struct Digit {
    /// Bits of the code.
    bits: u32,
    /// The digit's lowest bit.
    shift: u32,
    blocks: Blocks,
}

impl Digit {
    /// The passes for at most `lights` lights.
    pub(super) fn all(lights: u32) -> Vec<Self> {
        let (bits, blocks) = (code_bits(lights), Blocks::over(lights));
        let digit = |shift| Self { bits, shift, blocks };
        (0..bits).step_by(DIGIT_BITS as usize).map(digit).collect()
    }

    /// The shader's modules.
    pub(super) fn shader(self) -> Shader<'static> {
        let first = self.shift == 0;
        let last = self.shift + DIGIT_BITS == self.bits;
        let Self { bits, shift, blocks } = self;
        let rounds = blocks.rounds;
        order_shader()
            .module("package::order_bits", format!("const BITS: u32 = {bits}u;\n"))
            .module("package::order_key", include_str!("../shaders/order/key.wesl"))
            .module(
                "package::order_digit",
                format!("const SHIFT: u32 = {shift}u;\nconst ROUNDS: u32 = {rounds}u;\n"),
            )
            .module("package::order_radix", include_str!("../shaders/order/radix.wesl"))
            .flag("first", first)
            .flag("last", last)
            .flag("only", first && last)
            .flag("summed", blocks.counting == Counting::Summed)
    }
}

/// Pipelines and buffers of the sort.
#[derive(Debug)]
pub(super) struct RadixSort {
    blocks: u32,
    passes: Vec<DigitPass>,
    /// Bytes of its buffers.
    bytes: u64,
}

/// The kernels of one digit, from one buffer of items to the other.
#[derive(Debug)]
struct DigitPass {
    /// In the order of their dispatches, with the number of workgroups.
    kernels: Vec<(wgpu::ComputePipeline, u32)>,
    items: wgpu::BindGroup,
}

impl RadixSort {
    pub(super) fn new(gpu: &Gpu, capacity: u32) -> Result<Self, AssignError> {
        let cut = Blocks::over(capacity);
        let blocks = cut.count(capacity);
        if blocks > MAX_WORKGROUPS {
            return Err(AssignError::Parameter {
                field: "lights that the GPU sorts".into(),
                value: capacity.to_string(),
                accepted: format!("at most {}", MAX_WORKGROUPS * cut.rounds * LANES),
            });
        }
        let digits = Digit::all(capacity);
        // A single pass reads no items and writes none.
        let item_bytes = if digits.len() > 1 { u64::from(capacity) * 8 } else { 0 };
        let items =
            [gpu.storage("light keys", item_bytes)?, gpu.storage("light keys", item_bytes)?];
        let counts = gpu.storage("light digits", u64::from((blocks + 1) * DIGITS) * 4)?;
        let item_layout = layout(gpu, "light keys", wgpu::ShaderStages::COMPUTE, &[Slot::Write; 3]);
        let layouts = [&frame_layout(gpu), &item_layout];
        let mut passes = Vec::new();
        for (ix, digit) in digits.into_iter().enumerate() {
            // SAFETY: every loop counts up to a fixed number or to the number of blocks.
            #[allow(unsafe_code, reason = "its loops end")]
            let module = unsafe { digit.shader().create_uncounted(gpu, "package::order_radix") }?;
            let kernel = |entry_point, workgroups| {
                (pipeline(gpu, &module, entry_point, &layouts), workgroups)
            };
            let count = || kernel("count_digits", blocks);
            let kernels = match cut.counting {
                Counting::Together => vec![count(), kernel("move_items", blocks)],
                Counting::Summed => {
                    vec![count(), kernel("sum_digits", DIGITS), kernel("move_items", blocks)]
                }
            };
            let (from, to) = (&items[ix % 2], &items[1 - ix % 2]);
            let items = bind_buffers(gpu, &item_layout, &[from, to, &counts]);
            passes.push(DigitPass { kernels, items });
        }
        let bytes = items.iter().map(wgpu::Buffer::size).sum::<u64>() + counts.size();
        Ok(Self { blocks, passes, bytes })
    }

    /// Records the dispatches. Bind group 0 is set.
    pub(super) fn record(&self, pass: &mut wgpu::ComputePass<'_>) {
        for digit in &self.passes {
            pass.set_bind_group(1, &digit.items, &[]);
            for (pipeline, workgroups) in &digit.kernels {
                pass.set_pipeline(pipeline);
                pass.dispatch_workgroups(*workgroups, 1, 1);
            }
        }
    }

    /// Number of blocks.
    pub(super) fn blocks(&self) -> u32 {
        self.blocks
    }

    /// Bytes of its buffers.
    pub(super) fn bytes(&self) -> u64 {
        self.bytes
    }
}
