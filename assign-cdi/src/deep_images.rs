//! Compound deep images on the GPU: triangles fill them, rays read them.

mod ray_buffers;
mod settle;

use assign::{AssignError, Gpu, Passes, Readback, Shader};
use bytemuck::{Zeroable, bytes_of};

use crate::{
    Build, DeepImageCounters, DeepImageSettings, DeepImagesSnapshot, ImagesUniform, ListSort,
    PrefixSum, SortInput, Storage, Triangles,
    build_kernels::{BuildKernels, Finders, Samplers},
    deep_buffers::{DeepBuffers, LONGEST_AT},
    kernel::{self, Slot, workgroups},
    stages::{COUNT, FILL, LARGE_AT, Stages, at_once},
};

pub use ray_buffers::RayBuffers;

/// The module that casts rays. [`DeepImages::mount`] mounts it as `package::ray_cast`.
pub const RAY_CAST_WESL: &str = include_str!("shaders/ray_cast.wesl");

/// Lists up to this length are sorted without rounds of merges. Rounds take time and memory even if no list needs
/// them, so they are added only once a frame has had a longer list.
const SORTED_AT_LEAST: u32 = 2048;

/// Deep images of a scene from many directions.
#[derive(Debug)]
pub struct DeepImages {
    settings: DeepImageSettings,
    kernels: BuildKernels,
    buffers: DeepBuffers,
    uniform: wgpu::Buffer,
    space: ImagesUniform,
    /// The longest list that the sort is prepared for.
    sorted_longest: u32,
    stages: Stages,
    sums: PrefixSum,
    sort: ListSort,
    ray_layout: wgpu::BindGroupLayout,
    groups: Option<Groups>,
    readback: Readback<DeepImageCounters>,
}

#[derive(Debug)]
struct Groups {
    build: wgpu::BindGroup,
    stage: wgpu::BindGroup,
    plan: wgpu::BindGroup,
    draw: Option<[wgpu::BindGroup; 2]>,
    rays: wgpu::BindGroup,
}

impl DeepImages {
    /// Makes the kernels. Checks `settings`.
    pub fn new(gpu: &Gpu, settings: DeepImageSettings) -> Result<Self, AssignError> {
        settings.check()?;
        let slots = [Slot::Uniform, Slot::Read, Slot::Read, Slot::Read, Slot::Read];
        let rays = wgpu::ShaderStages::COMPUTE | wgpu::ShaderStages::FRAGMENT;
        Ok(Self {
            kernels: BuildKernels::new(gpu, &settings)?,
            buffers: DeepBuffers::new(gpu, &settings)?,
            uniform: gpu.uniform("deep images", size_of::<ImagesUniform>() as u64),
            space: ImagesUniform::zeroed(),
            sorted_longest: SORTED_AT_LEAST,
            stages: Stages::new(gpu, &settings)?,
            sums: PrefixSum::new(gpu)?,
            sort: ListSort::new(gpu)?,
            ray_layout: kernel::layout(gpu, "rays through deep images", rays, &slots),
            groups: None,
            readback: Readback::new(gpu, "deep image counters"),
            settings,
        })
    }

    /// Its settings.
    pub fn settings(&self) -> &DeepImageSettings {
        &self.settings
    }

    /// The place of the images of the last prepared frame in the world.
    pub fn space(&self) -> &ImagesUniform {
        &self.space
    }

    /// Sizes the buffers for a frame, grows them to what earlier frames asked for, and binds the
    /// triangles.
    pub fn prepare(&mut self, gpu: &Gpu, triangles: &Triangles<'_>) -> Result<(), AssignError> {
        self.readback.poll();
        let mut space = ImagesUniform::new(&self.settings, triangles)?;
        let asked = self.readback.latest().unwrap_or_default();
        let grown = self.buffers.prepare(gpu, &self.settings, triangles.count, asked)?;
        space.sample_capacity = self.buffers.sample_capacity;
        space.fragment_capacity = self.buffers.fragment_capacity;
        let is_longer = asked.longest > self.sorted_longest;
        if is_longer {
            // A quarter more, so that a scene in motion does not add rounds every frame.
            self.sorted_longest = asked.longest.saturating_add(asked.longest / 4);
        }
        space.sorted_longest = self.sorted_longest;
        self.space = space;
        gpu.queue.write_buffer(&self.uniform, 0, bytes_of(&space));
        let is_first = self.groups.is_none();
        if self.settings.storage == Storage::Arrays && (grown || is_longer || is_first) {
            self.prepare_lists(gpu)?;
        }
        self.groups = Some(self.bind(gpu, triangles.positions));
        Ok(())
    }

    /// Binds counts, offsets and fragments for the scan and the sort.
    fn prepare_lists(&mut self, gpu: &Gpu) -> Result<(), AssignError> {
        let pixels = self.settings.pixel_count();
        let buffers = &self.buffers;
        self.sums.prepare(gpu, &buffers.counts, pixels, &buffers.offsets)?;
        self.sort.prepare(
            gpu,
            &SortInput {
                offsets: &buffers.offsets,
                entries: &buffers.fragments,
                list_count: pixels,
                entry_count: buffers.fragment_capacity,
                longest: self.sorted_longest,
            },
        )
    }

    fn bind(&self, gpu: &Gpu, positions: &wgpu::Buffer) -> Groups {
        let b = &self.buffers;
        let build = [
            &self.uniform,
            &b.frames,
            positions,
            &b.header,
            &b.samples,
            &b.large,
            &b.counts,
            &b.offsets,
            &b.fragments,
        ];
        let plan =
            [&self.uniform, &self.stages.plan, &b.header, &b.offsets, &self.stages.dispatches];
        let draw = match &self.kernels.finders {
            Finders::SinglePass { samplers: Samplers::Fragment(draw), .. } => Some([
                kernel::bind_buffers(gpu, &draw.read_layout, &[&self.uniform, positions]),
                kernel::bind_buffers(gpu, &draw.write_layout, &[&b.header, &b.samples]),
            ]),
            _ => None,
        };
        let starts = match self.settings.storage {
            Storage::Arrays => &b.offsets,
            Storage::LinkedLists => &b.counts,
        };
        let rays = [&self.uniform, &b.frames, &b.header, starts, &b.fragments];
        Groups {
            build: kernel::bind_buffers(gpu, &self.kernels.build_layout, &build),
            stage: kernel::bind_entries(gpu, &self.kernels.stage_layout, &[self.stages.entry()]),
            plan: kernel::bind_buffers(gpu, &self.kernels.plan_layout, &plan),
            draw,
            rays: kernel::bind_buffers(gpu, &self.ray_layout, &rays),
        }
    }

    /// Records the build of a frame: those of the passes `cdi-samples`, `cdi-count`, `cdi-scan`, `cdi-fill` and
    /// `cdi-sort` that the settings ask for. Before [`prepare`](Self::prepare) it records nothing.
    pub fn record(&mut self, passes: &mut dyn Passes) {
        let Some(groups) = &self.groups else { return };
        let encoder = passes.encoder();
        encoder.clear_buffer(&self.buffers.header, 0, None);
        encoder.clear_buffer(&self.buffers.counts, 0, None);
        self.record_samples(groups, passes);
        match self.settings.storage {
            Storage::LinkedLists => {
                passes.compute("cdi-fill", &mut |pass| {
                    self.before_stages(groups, pass);
                    self.put(groups, pass, FILL);
                    if matches!(self.settings.build, Build::PerDirection { .. }) {
                        self.run_plan(groups, pass, &self.kernels.check_links);
                    }
                });
            }
            Storage::Arrays => {
                passes.compute("cdi-count", &mut |pass| {
                    self.before_stages(groups, pass);
                    self.put(groups, pass, COUNT);
                });
                passes.compute("cdi-scan", &mut |pass| {
                    self.sums.dispatch(pass);
                    if matches!(self.settings.build, Build::PerDirection { .. }) {
                        self.run_plan(groups, pass, &self.kernels.check_total);
                    }
                });
                passes.compute("cdi-fill", &mut |pass| self.put(groups, pass, FILL));
                self.sort.record(passes, "cdi-sort");
                let encoder = passes.encoder();
                let (from, to) = (self.sort.work(), &self.buffers.header);
                encoder.copy_buffer_to_buffer(from, ListSort::LONGEST_AT, to, LONGEST_AT, 4);
            }
        }
        self.readback.record(passes.encoder(), &self.buffers.header, 0);
    }

    fn triangle_groups(&self) -> u32 {
        workgroups(u64::from(self.space.triangle_count), 256)
    }

    fn record_samples(&self, groups: &Groups, passes: &mut dyn Passes) {
        let Finders::SinglePass { samplers, .. } = &self.kernels.finders else { return };
        match (samplers, &groups.draw) {
            (Samplers::Compute { small, large }, _) => {
                passes.compute("cdi-samples", &mut |pass| {
                    pass.set_bind_group(0, &groups.build, &[]);
                    pass.set_pipeline(small);
                    pass.dispatch_workgroups(self.triangle_groups(), 1, 1);
                    self.run_plan(groups, pass, &self.kernels.plan_large);
                    pass.set_bind_group(0, &groups.build, &[]);
                    pass.set_pipeline(large);
                    pass.dispatch_workgroups_indirect(&self.stages.dispatches, LARGE_AT);
                });
            }
            (Samplers::Fragment(draw), Some(bound)) => {
                let attachment = wgpu::RenderPassColorAttachment {
                    view: &draw.target,
                    depth_slice: None,
                    resolve_target: None,
                    ops: wgpu::Operations {
                        load: wgpu::LoadOp::Clear(wgpu::Color::BLACK),
                        store: wgpu::StoreOp::Discard,
                    },
                };
                let descriptor = wgpu::RenderPassDescriptor {
                    color_attachments: &[Some(attachment)],
                    ..Default::default()
                };
                passes.render("cdi-samples", &descriptor, &mut |pass| {
                    pass.set_pipeline(&draw.pipeline);
                    pass.set_bind_group(0, &bound[0], &[]);
                    pass.set_bind_group(1, &bound[1], &[]);
                    pass.draw(0..self.space.triangle_count.saturating_mul(3), 0..1);
                });
            }
            (Samplers::Fragment(_), None) => {}
        }
    }

    /// Sizes the dispatches of the stages; per direction, it lists the large triangles first.
    fn before_stages(&self, groups: &Groups, pass: &mut wgpu::ComputePass<'_>) {
        match &self.kernels.finders {
            Finders::SinglePass { .. } => {
                self.run_plan(groups, pass, &self.kernels.plan_samples);
            }
            Finders::PerDirection { find_large, .. } => {
                pass.set_pipeline(find_large);
                pass.set_bind_group(0, &groups.build, &[]);
                pass.dispatch_workgroups(self.triangle_groups(), 1, 1);
                self.run_plan(groups, pass, &self.kernels.plan_large);
            }
        }
    }

    /// Counts the fragments of all directions, or writes them.
    fn put(&self, groups: &Groups, pass: &mut wgpu::ComputePass<'_>, mode: u32) {
        pass.set_bind_group(0, &groups.build, &[]);
        match &self.kernels.finders {
            Finders::SinglePass { spread, .. } => {
                pass.set_pipeline(spread);
                for offset in self.stages.offsets(mode) {
                    pass.set_bind_group(1, &groups.stage, &[offset]);
                    pass.dispatch_workgroups_indirect(&self.stages.dispatches, 0);
                }
            }
            Finders::PerDirection { small, large, .. } => {
                for offset in self.stages.offsets(mode) {
                    pass.set_bind_group(1, &groups.stage, &[offset]);
                    pass.set_pipeline(small);
                    pass.dispatch_workgroups(self.triangle_groups(), at_once(&self.settings), 1);
                    pass.set_pipeline(large);
                    pass.dispatch_workgroups_indirect(&self.stages.dispatches, LARGE_AT);
                }
            }
        }
    }

    fn run_plan(
        &self,
        groups: &Groups,
        pass: &mut wgpu::ComputePass<'_>,
        pipeline: &wgpu::ComputePipeline,
    ) {
        pass.set_pipeline(pipeline);
        pass.set_bind_group(0, &groups.plan, &[]);
        pass.dispatch_workgroups(1, 1, 1);
    }

    /// The newest counters that were read back, which may be a few frames old.
    pub fn stats(&self) -> Option<DeepImageCounters> {
        self.readback.latest()
    }

    /// Whether everything fitted in the newest frame whose counters were read back. If not, the lengths of its rays
    /// are unknown, and the next [`prepare`](Self::prepare) makes room.
    pub fn is_complete(&self) -> Option<bool> {
        let stats = self.readback.latest()?;
        Some(stats.is_overflowed == 0 && stats.longest <= self.sorted_longest)
    }

    /// Reads back the lists of the last submitted frame. It blocks.
    pub fn snapshot(&self, gpu: &Gpu) -> Result<DeepImagesSnapshot, AssignError> {
        DeepImagesSnapshot::read(gpu, &self.settings, &self.buffers)
    }

    /// Bytes of all its buffers on the GPU.
    pub fn bytes(&self) -> u64 {
        let small = self.uniform.size() + self.stages.bytes();
        small + self.buffers.bytes() + self.sums.bytes() + self.sort.bytes()
    }

    /// Layout of [`bind_group`](Self::bind_group), for compute and fragment shaders. It holds the images' uniform,
    /// the frames of directions, the counters, the starts of lists, and the fragments.
    pub fn layout(&self) -> &wgpu::BindGroupLayout {
        &self.ray_layout
    }

    /// The bind group that rays read. `None` before [`prepare`](Self::prepare), which replaces it every time.
    pub fn bind_group(&self) -> Option<&wgpu::BindGroup> {
        self.groups.as_ref().map(|groups| &groups.rays)
    }

    /// Mounts `package::ray_cast`, `package::segment` and what they import. [`bind_group`](Self::bind_group) is then
    /// bind group `group`.
    pub fn mount<'a>(settings: &DeepImageSettings, shader: Shader<'a>, group: u32) -> Shader<'a> {
        Self::mount_at(settings, shader, (group, 0))
    }
}
