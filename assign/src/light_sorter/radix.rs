//! The radix sort of many lights: `order/radix.wesl`.

use super::kernels::{LANES, frame_layout, order_shader};
use crate::{
    AssignError, Gpu, Shader,
    kernel::{MAX_WORKGROUPS, Slot, bind_buffers, layout, pipeline},
};

/// Values of a digit.
const DIGITS: u32 = 256;

/// The most lights whose blocks are small and whose counts need no pass of their own. They are
/// sorted by the upper 16 bits of their codes.
const FEW_BLOCKS: u32 = 65_536;

/// One pass over a digit.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) struct Digit {
    /// The digit's lowest bit.
    pub(super) shift: u32,
    /// Whether the pass makes the keys.
    pub(super) first: bool,
    /// Whether the pass writes the order.
    pub(super) last: bool,
    /// Whether there are more than [`FEW_BLOCKS`] lights.
    pub(super) many: bool,
}

impl Digit {
    /// The passes for at most `lights` lights.
    pub(super) fn all(lights: u32) -> Vec<Self> {
        let many = lights > FEW_BLOCKS;
        let shifts: &[u32] = if many { &[0, 8, 16] } else { &[8, 16] };
        let digit = |&shift| Self { shift, first: shift == shifts[0], last: shift == 16, many };
        shifts.iter().map(digit).collect()
    }

    /// The shader's modules.
    pub(super) fn shader(self) -> Shader<'static> {
        order_shader()
            .module("package::order_digit", format!("const SHIFT: u32 = {}u;\n", self.shift))
            .module("package::order_radix", include_str!("../shaders/order/radix.wesl"))
            .flag("first", self.first)
            .flag("last", self.last)
            .flag("many", self.many)
    }
}

/// Pipelines and buffers of the sort.
#[derive(Debug)]
pub(super) struct RadixSort {
    blocks: u32,
    passes: Vec<DigitPass>,
}

/// The kernels of one digit, from one buffer of items to the other.
#[derive(Debug)]
struct DigitPass {
    count: wgpu::ComputePipeline,
    sum: Option<wgpu::ComputePipeline>,
    place: wgpu::ComputePipeline,
    items: wgpu::BindGroup,
}

impl RadixSort {
    pub(super) fn new(gpu: &Gpu, capacity: u32) -> Result<Self, AssignError> {
        let rounds = if capacity > FEW_BLOCKS { 16 } else { 4 };
        let blocks = capacity.div_ceil(rounds * LANES);
        if blocks > MAX_WORKGROUPS {
            return Err(AssignError::Parameter {
                field: "lights that the GPU sorts".into(),
                value: capacity.to_string(),
                accepted: format!("at most {}", MAX_WORKGROUPS * rounds * LANES),
            });
        }
        let item_bytes = u64::from(capacity) * 8;
        let items =
            [gpu.storage("light keys", item_bytes)?, gpu.storage("light keys", item_bytes)?];
        let counts = gpu.storage("light digits", u64::from((blocks + 1) * DIGITS) * 4)?;
        let item_layout = layout(gpu, "light keys", wgpu::ShaderStages::COMPUTE, &[Slot::Write; 3]);
        let layouts = [&frame_layout(gpu), &item_layout];
        let mut passes = Vec::new();
        for (ix, digit) in Digit::all(capacity).into_iter().enumerate() {
            // SAFETY: every loop counts up to a fixed number or to the number of blocks.
            #[allow(unsafe_code, reason = "its loops end")]
            let module = unsafe { digit.shader().create_uncounted(gpu, "package::order_radix") }?;
            let entry = |entry_point| pipeline(gpu, &module, entry_point, &layouts);
            let (from, to) = (&items[ix % 2], &items[1 - ix % 2]);
            passes.push(DigitPass {
                count: entry("count_digits"),
                sum: digit.many.then(|| entry("sum_digits")),
                place: entry("move_items"),
                items: bind_buffers(gpu, &item_layout, &[from, to, &counts]),
            });
        }
        Ok(Self { blocks, passes })
    }

    /// Records the dispatches. Bind group 0 is set.
    pub(super) fn record(&self, pass: &mut wgpu::ComputePass<'_>) {
        for digit in &self.passes {
            pass.set_bind_group(1, &digit.items, &[]);
            pass.set_pipeline(&digit.count);
            pass.dispatch_workgroups(self.blocks, 1, 1);
            if let Some(sum) = &digit.sum {
                pass.set_pipeline(sum);
                pass.dispatch_workgroups(DIGITS, 1, 1);
            }
            pass.set_pipeline(&digit.place);
            pass.dispatch_workgroups(self.blocks, 1, 1);
        }
    }

    /// Number of blocks.
    pub(super) fn blocks(&self) -> u32 {
        self.blocks
    }
}
