//! The pass `vpl-keep`: from VPLs with ranges to lights.

use assign::{AssignError, Gpu, LightEmission, LightSphere, Passes, Shader};
use bytemuck::{Pod, Zeroable, bytes_of};

use super::{
    choose::Chosen,
    settings::{Large, VplSettings},
};
use crate::{
    PrefixSum,
    kernel::{self, Slot, workgroups},
};

/// The modules of the pass. The root is `package::vpl_keep`.
pub fn keep_shader() -> Shader<'static> {
    Shader::new(3).module("package::vpl_keep", include_str!("../shaders/vpl_keep.wesl"))
}

/// What the kernels read: `struct Keep` of `vpl_keep.wesl`. 24 bytes.
#[repr(C)]
#[derive(Clone, Copy, Debug, Default, PartialEq, Pod, Zeroable)]
pub struct KeepUniform {
    /// The light's range = this factor times the distance found.
    pub range_scale: f32,
    /// Lights of smaller range are dropped, metres.
    pub min_range_m: f32,
    /// Lights of larger range are dropped or clamped to it, metres.
    pub max_range_m: f32,
    /// Square of the minimum distance of the lights, square metres.
    pub min_distance_2: f32,
    /// The most VPLs that fit.
    pub capacity: u32,
    /// 1: larger ranges are clamped. 0: their lights are dropped.
    pub clamps: u32,
}

/// Buffers of the kept lights.
#[derive(Debug)]
pub(super) struct Kept {
    pub(super) spheres: wgpu::Buffer,
    pub(super) emissions: wgpu::Buffer,
    pub(super) shapes: wgpu::Buffer,
}

impl Kept {
    pub(super) fn new(gpu: &Gpu, capacity: u32) -> Result<Self, AssignError> {
        let bytes = |each: usize| u64::from(capacity) * each as u64;
        Ok(Self {
            spheres: gpu.storage("VPL spheres", bytes(size_of::<LightSphere>()))?,
            emissions: gpu.storage("VPL emissions", bytes(size_of::<LightEmission>()))?,
            shapes: gpu.storage("VPL shapes", bytes(32))?,
        })
    }
}

/// Makes lights from VPLs with ranges.
#[derive(Debug)]
pub(super) struct Keep {
    flag: wgpu::ComputePipeline,
    write: wgpu::ComputePipeline,
    layouts: [wgpu::BindGroupLayout; 3],
    /// An empty bind group: group 1 of `write`.
    empty: wgpu::BindGroup,
    uniform: wgpu::Buffer,
    prefix: PrefixSum,
    flags: wgpu::Buffer,
    offsets: wgpu::Buffer,
    groups: Option<[wgpu::BindGroup; 3]>,
    capacity: u32,
}

impl Keep {
    pub(super) fn new(gpu: &Gpu) -> Result<Self, AssignError> {
        let module = kernel::uncounted(gpu, &keep_shader(), "package::vpl_keep")?;
        let stages = wgpu::ShaderStages::COMPUTE;
        let layout = |slots: &[Slot]| kernel::layout(gpu, "VPLs kept", stages, slots);
        let (read, write) = (Slot::Read, Slot::Write);
        let layouts = [
            layout(&[Slot::Uniform, read]),
            layout(&[write, write]),
            layout(&[read, read, read, read, write, write, write]),
        ];
        let [ranges, flags, lights] = &layouts;
        // Flags and lights together would exceed WebGPU's eight storage buffers.
        let empty = kernel::layout(gpu, "empty", stages, &[]);
        Ok(Self {
            flag: kernel::pipeline(gpu, &module, "flag_kept", &[ranges, flags]),
            write: kernel::pipeline(gpu, &module, "write_lights", &[ranges, &empty, lights]),
            empty: kernel::bind_buffers(gpu, &empty, &[]),
            uniform: gpu.uniform("VPLs kept", size_of::<KeepUniform>() as u64),
            prefix: PrefixSum::new(gpu)?,
            flags: gpu.storage("VPLs kept: flags", 4)?,
            offsets: gpu.storage("VPLs kept: offsets", 8)?,
            groups: None,
            capacity: 0,
            layouts,
        })
    }

    /// Sizes its buffers, uploads the settings, and binds all.
    pub(super) fn prepare(
        &mut self,
        gpu: &Gpu,
        settings: &VplSettings,
        capacity: u32,
        (chosen, ranges_m, counts): (&Chosen, &wgpu::Buffer, &wgpu::Buffer),
        kept: &Kept,
    ) -> Result<(), AssignError> {
        if self.capacity != capacity {
            self.groups = None;
            self.flags = gpu.storage("VPLs kept: flags", u64::from(capacity) * 4)?;
            self.offsets = gpu.storage("VPLs kept: offsets", (u64::from(capacity) + 1) * 4)?;
            self.prefix.prepare(gpu, &self.flags, capacity, &self.offsets)?;
            self.capacity = capacity;
        }
        let uniform = KeepUniform {
            range_scale: settings.range_scale,
            min_range_m: settings.min_range_m,
            max_range_m: settings.max_range_m,
            min_distance_2: settings.min_distance_m * settings.min_distance_m,
            capacity,
            clamps: u32::from(settings.large == Large::Clamp),
        };
        gpu.queue.write_buffer(&self.uniform, 0, bytes_of(&uniform));
        let [ranges_layout, flags_layout, lights_layout] = &self.layouts;
        let lights = [
            &self.offsets,
            &chosen.positions,
            &chosen.normals,
            &chosen.intensities,
            &kept.spheres,
            &kept.emissions,
            &kept.shapes,
        ];
        self.groups = Some([
            kernel::bind_buffers(gpu, ranges_layout, &[&self.uniform, ranges_m]),
            kernel::bind_buffers(gpu, flags_layout, &[&self.flags, counts]),
            kernel::bind_buffers(gpu, lights_layout, &lights),
        ]);
        Ok(())
    }

    /// Records the pass, which fills the last three numbers of `counts`. Before [`prepare`](Self::prepare) it records
    /// nothing.
    pub(super) fn record(&self, passes: &mut dyn Passes, counts: &wgpu::Buffer) {
        let Some([ranges, flags, lights]) = &self.groups else { return };
        passes.encoder().clear_buffer(counts, 4, Some(12));
        passes.compute("vpl-keep", &mut |pass| {
            let groups = workgroups(u64::from(self.capacity), 256);
            pass.set_bind_group(0, ranges, &[]);
            pass.set_bind_group(1, flags, &[]);
            pass.set_pipeline(&self.flag);
            pass.dispatch_workgroups(groups, 1, 1);
            self.prefix.dispatch(pass);
            pass.set_bind_group(0, ranges, &[]);
            pass.set_bind_group(1, &self.empty, &[]);
            pass.set_bind_group(2, lights, &[]);
            pass.set_pipeline(&self.write);
            pass.dispatch_workgroups(groups, 1, 1);
        });
        let last = u64::from(self.capacity) * 4;
        passes.encoder().copy_buffer_to_buffer(&self.offsets, last, counts, 4, 4);
    }

    /// Bytes of its own buffers on the GPU.
    pub(super) fn bytes(&self) -> u64 {
        self.uniform.size() + self.flags.size() + self.offsets.size() + self.prefix.bytes()
    }
}
