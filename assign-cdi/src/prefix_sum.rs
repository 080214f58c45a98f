//! Exclusive prefix sums of counts: the offset at which each list begins.
//!
//! First it sums blocks of 2048 counts. Then it scans these sums in the same way, level by level. Last it scans each
//! block, starting from the block's offset. Every run gives the same result.
//!
//! Worked example: counts 2, 5 and 3 give offsets 0, 2 and 7, and the total 10.

use assign::{AssignError, Gpu, Passes, Shader};
use bytemuck::{Pod, Zeroable, bytes_of};

use crate::kernel::{self, Slot};

/// Values per block: `BLOCK` of `prefix_sum.wesl`.
const BLOCK: u32 = 2048;
/// The most values, since a dispatch has at most 65,535 workgroups.
const MOST: u32 = 65_535 * BLOCK - 1;

/// A level as the kernels read it: `struct Scan` of `prefix_sum.wesl`.
#[repr(C)]
#[derive(Clone, Copy, Debug, Default, Pod, Zeroable)]
pub struct ScanUniform {
    /// Values to read. Values after these count as zero.
    pub in_count: u32,
    /// Sums to write.
    pub out_count: u32,
    /// 1: each block starts from its entry of `bases`. 0: each block starts from zero.
    pub has_bases: u32,
}

/// Sums counts up to each of them.
#[derive(Debug)]
pub struct PrefixSum {
    sum: wgpu::ComputePipeline,
    scan: wgpu::ComputePipeline,
    layout: wgpu::BindGroupLayout,
    levels: Vec<Level>,
    bytes: u64,
}

/// One level: the counts themselves, then the sums of their blocks, and so on.
#[derive(Debug)]
struct Level {
    blocks: u32,
    /// Writes the sums of blocks. `None` at the top level, which is one block.
    sum: Option<wgpu::BindGroup>,
    scan: wgpu::BindGroup,
}

impl PrefixSum {
    /// Makes the kernels.
    pub fn new(gpu: &Gpu) -> Result<Self, AssignError> {
        let module = kernel::uncounted(gpu, &Self::shader(), "package::prefix_sum")?;
        let slots = [Slot::Uniform, Slot::Read, Slot::Read, Slot::Write];
        let layout = kernel::layout(gpu, "prefix sum", wgpu::ShaderStages::COMPUTE, &slots);
        Ok(Self {
            sum: kernel::pipeline(gpu, &module, "sum_blocks", &[&layout]),
            scan: kernel::pipeline(gpu, &module, "scan_blocks", &[&layout]),
            layout,
            levels: Vec::new(),
            bytes: 0,
        })
    }

    /// The kernels' modules. The root is `package::prefix_sum`.
    pub fn shader() -> Shader<'static> {
        Shader::new(3).module("package::prefix_sum", include_str!("shaders/prefix_sum.wesl"))
    }

    /// Binds `count` counts and `count + 1` offsets, two buffers of `u32`. `offsets[i]` becomes the sum of the counts
    /// before `i`, and `offsets[count]` the sum of all. Sums beyond 32 bits stay at [`u32::MAX`].
    pub fn prepare(
        &mut self,
        gpu: &Gpu,
        counts: &wgpu::Buffer,
        count: u32,
        offsets: &wgpu::Buffer,
    ) -> Result<(), AssignError> {
        if count > MOST {
            return Err(AssignError::Parameter {
                field: "number of values of a prefix sum".into(),
                value: count.to_string(),
                accepted: format!("at most {MOST}"),
            });
        }
        self.levels.clear();
        self.bytes = 0;
        let none = gpu.storage("no bases", 4)?;
        // For each level: the values, their number, the number of results, and the buffer of results.
        let (mut values, mut in_count, mut out_count) = (counts.clone(), count, count + 1);
        let mut results = offsets.clone();
        loop {
            let blocks = out_count.div_ceil(BLOCK);
            let is_top = blocks == 1;
            let make = |label, is_made: bool| {
                gpu.storage(label, if is_made { u64::from(blocks) * 4 } else { 4 })
            };
            let sums = make("block sums", !is_top)?;
            let bases = make("block bases", !is_top)?;
            self.bytes += sums.size() + bases.size();
            let group = |has_bases: u32, bases: &wgpu::Buffer, to: &wgpu::Buffer| {
                let uniform = gpu.uniform("prefix sum", 16);
                let scan = ScanUniform { in_count, out_count, has_bases };
                gpu.queue.write_buffer(&uniform, 0, bytes_of(&scan));
                kernel::bind_buffers(gpu, &self.layout, &[&uniform, &values, bases, to])
            };
            self.levels.push(Level {
                blocks,
                sum: (!is_top).then(|| group(0, &none, &sums)),
                scan: group(u32::from(!is_top), &bases, &results),
            });
            if is_top {
                return Ok(());
            }
            (values, in_count, out_count, results) = (sums, blocks, blocks, bases);
        }
    }

    /// Records the sum as one pass.
    pub fn record(&self, passes: &mut dyn Passes, name: &str) {
        passes.compute(name, &mut |pass| self.dispatch(pass));
    }

    /// Records the sum into an open pass.
    pub fn dispatch(&self, pass: &mut wgpu::ComputePass<'_>) {
        pass.set_pipeline(&self.sum);
        for level in &self.levels {
            if let Some(sum) = &level.sum {
                pass.set_bind_group(0, sum, &[]);
                pass.dispatch_workgroups(level.blocks, 1, 1);
            }
        }
        pass.set_pipeline(&self.scan);
        for level in self.levels.iter().rev() {
            pass.set_bind_group(0, &level.scan, &[]);
            pass.dispatch_workgroups(level.blocks, 1, 1);
        }
    }

    /// Bytes of its own buffers on the GPU.
    pub fn bytes(&self) -> u64 {
        self.bytes
    }
}
