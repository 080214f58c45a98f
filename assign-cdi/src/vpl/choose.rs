//! The passes `rsm-mips` and `vpl-choose`: from the map to VPLs.

use assign::{
    AssignError, Gpu, Passes, Shader, UNFILTERED, ViewUniform, entry, storage_entry, texture,
    texture_entry, uniform_entry,
};
use bytemuck::bytes_of;

use super::rsm::{Rsm, RsmUniform};
use crate::{
    PrefixSum,
    kernel::{self, workgroups},
};

/// The modules of both passes. The roots are `package::vpl_mips` and `package::vpl_choose`.
pub fn choose_shader() -> Shader<'static> {
    Shader::new(3)
        .module("package::vpl_rsm", include_str!("../shaders/vpl_rsm.wesl"))
        .module("package::vpl_mips", include_str!("../shaders/vpl_mips.wesl"))
        .module("package::vpl_choose", include_str!("../shaders/vpl_choose.wesl"))
}

/// Bytes from one level number to the next in the uniform buffer.
const LEVEL_STRIDE: u32 = 256;

/// Buffers of the chosen VPLs.
#[derive(Debug)]
pub(super) struct Chosen {
    pub(super) positions: wgpu::Buffer,
    pub(super) normals: wgpu::Buffer,
    pub(super) intensities: wgpu::Buffer,
}

/// Makes blocks from a map, and VPLs from the blocks.
#[derive(Debug)]
pub(super) struct Choose {
    reflect: wgpu::ComputePipeline,
    join: wgpu::ComputePipeline,
    flag: wgpu::ComputePipeline,
    write: wgpu::ComputePipeline,
    layouts: Layouts,
    view: wgpu::Buffer,
    rsm: wgpu::Buffer,
    level_numbers: wgpu::Buffer,
    prefix: PrefixSum,
    scratch: Option<Scratch>,
    groups: Option<Groups>,
    uniform: RsmUniform,
}

#[derive(Debug)]
struct Layouts {
    view: wgpu::BindGroupLayout,
    mips: wgpu::BindGroupLayout,
    level: wgpu::BindGroupLayout,
    choose: wgpu::BindGroupLayout,
}

/// Buffers whose size depends on the map.
#[derive(Debug)]
struct Scratch {
    blocks: wgpu::Buffer,
    representatives: wgpu::Buffer,
    flags: wgpu::Buffer,
    offsets: wgpu::Buffer,
}

#[derive(Debug)]
struct Groups {
    view: wgpu::BindGroup,
    mips: wgpu::BindGroup,
    level: wgpu::BindGroup,
    choose: wgpu::BindGroup,
}

impl Choose {
    pub(super) fn new(gpu: &Gpu) -> Result<Self, AssignError> {
        let shader = choose_shader();
        let mips = kernel::uncounted(gpu, &shader, "package::vpl_mips")?;
        let choose = kernel::uncounted(gpu, &shader, "package::vpl_choose")?;
        let layouts = Layouts::new(gpu);
        let view = &layouts.view;
        let mips_layouts = [view, &layouts.mips, &layouts.level];
        let choose_layouts = [view, &layouts.choose];
        let level_numbers = gpu.uniform("RSM levels", u64::from(LEVEL_STRIDE) * 16);
        for level in 0..16_u32 {
            let at = u64::from(level * LEVEL_STRIDE);
            gpu.queue.write_buffer(&level_numbers, at, bytes_of(&[level, 0, 0, 0]));
        }
        Ok(Self {
            reflect: kernel::pipeline(gpu, &mips, "reflect_texels", &mips_layouts),
            join: kernel::pipeline(gpu, &mips, "join_blocks", &mips_layouts),
            flag: kernel::pipeline(gpu, &choose, "flag_blocks", &choose_layouts),
            write: kernel::pipeline(gpu, &choose, "write_vpls", &choose_layouts),
            view: gpu.uniform("view of the RSM", size_of::<ViewUniform>() as u64),
            rsm: gpu.uniform("RSM", size_of::<RsmUniform>() as u64),
            level_numbers,
            prefix: PrefixSum::new(gpu)?,
            scratch: None,
            groups: None,
            uniform: RsmUniform::default(),
            layouts,
        })
    }

    /// Sizes buffers for the map, uploads its uniforms, and binds everything.
    pub(super) fn prepare(
        &mut self,
        gpu: &Gpu,
        rsm: &Rsm<'_>,
        uniform: RsmUniform,
        chosen: &Chosen,
    ) -> Result<(), AssignError> {
        let scratch = match self.scratch.take() {
            Some(scratch) if self.uniform.size == uniform.size => scratch,
            _ => {
                let scratch = Scratch::new(gpu, &uniform)?;
                self.prefix.prepare(gpu, &scratch.flags, uniform.index_count, &scratch.offsets)?;
                scratch
            }
        };
        gpu.queue.write_buffer(&self.view, 0, bytes_of(&rsm.view.uniform()));
        gpu.queue.write_buffer(&self.rsm, 0, bytes_of(&uniform));
        self.groups = Some(self.bind(gpu, rsm, &scratch, chosen));
        self.scratch = Some(scratch);
        self.uniform = uniform;
        Ok(())
    }

    fn bind(&self, gpu: &Gpu, rsm: &Rsm<'_>, scratch: &Scratch, chosen: &Chosen) -> Groups {
        let level = wgpu::BindGroupEntry {
            binding: 0,
            resource: wgpu::BindingResource::Buffer(wgpu::BufferBinding {
                buffer: &self.level_numbers,
                offset: 0,
                size: wgpu::BufferSize::new(16),
            }),
        };
        let map = [entry(0, &self.rsm), texture(1, rsm.depth), texture(2, rsm.normals)];
        let mips = [
            texture(3, rsm.base_color),
            entry(4, &scratch.blocks),
            entry(5, &scratch.representatives),
        ];
        let choose = [
            entry(3, &scratch.blocks),
            entry(4, &scratch.representatives),
            entry(5, &scratch.flags),
            entry(6, &scratch.offsets),
            entry(7, &chosen.positions),
            entry(8, &chosen.normals),
            entry(9, &chosen.intensities),
        ];
        let with_map = |others: &[wgpu::BindGroupEntry<'_>], layout| {
            let entries: Vec<_> = map.iter().chain(others).cloned().collect();
            kernel::bind_entries(gpu, layout, &entries)
        };
        Groups {
            view: kernel::bind_buffers(gpu, &self.layouts.view, &[&self.view]),
            mips: with_map(&mips, &self.layouts.mips),
            level: kernel::bind_entries(gpu, &self.layouts.level, &[level]),
            choose: with_map(&choose, &self.layouts.choose),
        }
    }

    /// Records both passes, and copies the number of chosen VPLs to the start of `counts`. Before
    /// [`prepare`](Self::prepare) it records nothing.
    pub(super) fn record(&self, passes: &mut dyn Passes, counts: &wgpu::Buffer) {
        let (Some(groups), Some(scratch)) = (&self.groups, &self.scratch) else { return };
        passes.compute("rsm-mips", &mut |pass| self.dispatch_mips(pass, groups));
        passes.compute("vpl-choose", &mut |pass| {
            let indices = workgroups(u64::from(self.uniform.index_count), 256);
            pass.set_bind_group(0, &groups.view, &[]);
            pass.set_bind_group(1, &groups.choose, &[]);
            pass.set_pipeline(&self.flag);
            pass.dispatch_workgroups(indices, 1, 1);
            self.prefix.dispatch(pass);
            pass.set_bind_group(0, &groups.view, &[]);
            pass.set_bind_group(1, &groups.choose, &[]);
            pass.set_pipeline(&self.write);
            pass.dispatch_workgroups(indices, 1, 1);
        });
        let last = u64::from(self.uniform.index_count) * 4;
        passes.encoder().copy_buffer_to_buffer(&scratch.offsets, last, counts, 0, 4);
    }

    fn dispatch_mips(&self, pass: &mut wgpu::ComputePass<'_>, groups: &Groups) {
        pass.set_bind_group(0, &groups.view, &[]);
        pass.set_bind_group(1, &groups.mips, &[]);
        for level in 0..self.uniform.level_count {
            let [columns, rows] = self.uniform.blocks_of(level).map(|side| side.div_ceil(8));
            pass.set_pipeline(if level == 0 { &self.reflect } else { &self.join });
            pass.set_bind_group(2, &groups.level, &[level * LEVEL_STRIDE]);
            pass.dispatch_workgroups(columns, rows, 1);
        }
    }

    /// Bytes of its buffers on the GPU.
    pub(super) fn bytes(&self) -> u64 {
        let sized = self.scratch.as_ref().map_or(0, |scratch| {
            [&scratch.blocks, &scratch.representatives, &scratch.flags, &scratch.offsets]
                .map(wgpu::Buffer::size)
                .iter()
                .sum()
        });
        sized + self.view.size() + self.rsm.size() + self.level_numbers.size() + self.prefix.bytes()
    }
}

impl Scratch {
    fn new(gpu: &Gpu, uniform: &RsmUniform) -> Result<Self, AssignError> {
        let (blocks, indices) = (u64::from(uniform.block_count()), u64::from(uniform.index_count));
        Ok(Self {
            blocks: gpu.storage("RSM blocks", blocks * 16)?,
            representatives: gpu.storage("RSM representatives", blocks * 4)?,
            flags: gpu.storage("VPL flags", indices * 4)?,
            offsets: gpu.storage("VPL offsets", (indices + 1) * 4)?,
        })
    }
}

impl Layouts {
    fn new(gpu: &Gpu) -> Self {
        let stages = wgpu::ShaderStages::COMPUTE;
        let map = [
            uniform_entry(0, stages),
            texture_entry(1, stages, wgpu::TextureSampleType::Depth),
            texture_entry(2, stages, UNFILTERED),
        ];
        let mips = [
            texture_entry(3, stages, UNFILTERED),
            storage_entry(4, stages, false),
            storage_entry(5, stages, false),
        ];
        let choose =
            [(3, true), (4, true), (5, false), (6, true), (7, false), (8, false), (9, false)]
                .map(|(binding, read_only)| storage_entry(binding, stages, read_only));
        let layout = |label, others: &[wgpu::BindGroupLayoutEntry]| {
            let entries: Vec<_> = map.iter().chain(others).copied().collect();
            gpu.bind_group_layout(label, &entries)
        };
        Self {
            view: kernel::layout(gpu, "view of the RSM", stages, &[kernel::Slot::Uniform]),
            mips: layout("RSM mips", &mips),
            level: kernel::layout(gpu, "RSM level", stages, &[kernel::Slot::UniformAt]),
            choose: layout("VPL choice", &choose),
        }
    }
}
