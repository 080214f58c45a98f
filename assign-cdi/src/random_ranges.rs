//! Random ranges, as a comparison for ray casting (Archer et al. 2019, table 3).

use assign::{AssignError, Gpu, Passes, Shader};
use bytemuck::{Pod, Zeroable, bytes_of};

use crate::kernel::{self, Slot, workgroups};

/// What the kernel reads: `struct Random` of `random_ranges.wesl`.
#[repr(C)]
#[derive(Clone, Copy, Debug, Default, Pod, Zeroable)]
pub struct RandomUniform {
    /// Number of points.
    pub point_count: u32,
    /// Seed of the random numbers.
    pub seed: u32,
    /// Least range, metres.
    pub low_m: f32,
    /// Largest range, metres.
    pub high_m: f32,
    /// 1: a range that is [`f32::MAX`] stays.
    pub keeps_unknown: u32,
}

/// Draws ranges uniformly between two bounds. The same seed gives the same ranges. Equal bounds give every light the
/// same range.
#[derive(Debug)]
pub struct RandomRanges {
    pipeline: wgpu::ComputePipeline,
    layout: wgpu::BindGroupLayout,
    uniform: wgpu::Buffer,
    group: Option<wgpu::BindGroup>,
    count: u32,
    keeps_unknown: bool,
}

impl RandomRanges {
    /// Makes the kernel.
    pub fn new(gpu: &Gpu) -> Result<Self, AssignError> {
        let module = kernel::uncounted(gpu, &Self::shader(), "package::random_ranges")?;
        let slots = [Slot::Uniform, Slot::Write];
        let layout = kernel::layout(gpu, "random ranges", wgpu::ShaderStages::COMPUTE, &slots);
        Ok(Self {
            pipeline: kernel::pipeline(gpu, &module, "draw_ranges", &[&layout]),
            layout,
            uniform: gpu.uniform("random ranges", size_of::<RandomUniform>() as u64),
            group: None,
            count: 0,
            keeps_unknown: false,
        })
    }

    /// As [`new`](Self::new), but ranges that are [`f32::MAX`] before the pass stay. After ray casting these are the
    /// lights whose rays met nothing. The comparison then shows what the lengths of rays add to knowing which lights
    /// to drop.
    pub fn keeping_unknown(gpu: &Gpu) -> Result<Self, AssignError> {
        Ok(Self { keeps_unknown: true, ..Self::new(gpu)? })
    }

    /// The kernel's modules. The root is `package::random_ranges`.
    pub fn shader() -> Shader<'static> {
        Shader::new(3).module("package::random_ranges", include_str!("shaders/random_ranges.wesl"))
    }

    /// Binds `count` ranges, `array<f32>`. They are drawn from `low_m` to `high_m`.
    pub fn prepare(
        &mut self,
        gpu: &Gpu,
        ranges_m: &wgpu::Buffer,
        count: u32,
        (low_m, high_m): (f32, f32),
        seed: u32,
    ) -> Result<(), AssignError> {
        if !(low_m >= 0.0 && low_m <= high_m && high_m.is_finite()) {
            return Err(AssignError::Parameter {
                field: "bounds of random ranges".into(),
                value: format!("{low_m} to {high_m}"),
                accepted: "two finite numbers from 0 on, the lower first".into(),
            });
        }
        if ranges_m.size() < u64::from(count) * 4 {
            return Err(AssignError::Parameter {
                field: "buffer of ranges (ranges_m)".into(),
                value: format!("{} bytes", ranges_m.size()),
                accepted: format!("at least {} for {count} points", u64::from(count) * 4),
            });
        }
        let uniform = RandomUniform {
            point_count: count,
            seed,
            low_m,
            high_m,
            keeps_unknown: u32::from(self.keeps_unknown),
        };
        gpu.queue.write_buffer(&self.uniform, 0, bytes_of(&uniform));
        self.group = Some(kernel::bind_buffers(gpu, &self.layout, &[&self.uniform, ranges_m]));
        self.count = count;
        Ok(())
    }

    /// Records the pass `random-ranges`. Before [`prepare`](Self::prepare) it records nothing.
    pub fn record(&self, passes: &mut dyn Passes) {
        let Some(group) = &self.group else { return };
        passes.compute("random-ranges", &mut |pass| {
            pass.set_pipeline(&self.pipeline);
            pass.set_bind_group(0, group, &[]);
            pass.dispatch_workgroups(workgroups(u64::from(self.count), 256), 1, 1);
        });
    }
}
