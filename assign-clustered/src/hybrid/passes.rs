//! The passes of HG: what they bind, and the order in which they run.

use assign::{
    AssignError, DepthImage, Frame, FrameBindings, Gpu, LightKinds, LightLists, ListsBindings,
    Passes, SampleDomain, entry, kernel, storage_entry, uniform_entry,
};

use super::{
    buffers::{Buffers, Sizes},
    parts::HybridParts,
    scatter::{Scatter, ScatterPipeline},
    shader::{HybridShader, LISTS_GROUP},
};
use crate::froxels::{FROXELS_BINDING, FroxelsUniform};

/// Bindings of the cells in bind group [`LISTS_GROUP`].
const MASKS: u32 = FROXELS_BINDING + 1;
const CURSORS: u32 = FROXELS_BINDING + 2;
const UNSORTED: u32 = FROXELS_BINDING + 3;
const PARTS: u32 = FROXELS_BINDING + 4;

/// Everything between the depth buffer and the lists.
#[derive(Debug)]
pub(crate) struct HybridPasses {
    frame: FrameBindings,
    /// The cells without the lists: what `occupancy` and `scatter` read and write.
    cells_layout: wgpu::BindGroupLayout,
    cells_bind_group: Option<wgpu::BindGroup>,
    lists: ListsBindings,
    occupancy: Occupancy,
    depth_bind_group: Option<wgpu::BindGroup>,
    /// The live cells: first as `clear` and `reserve_lists` write them, then as `sort` reads them.
    live_layouts: [wgpu::BindGroupLayout; 2],
    live_bind_groups: Option<[wgpu::BindGroup; 2]>,
    clear: wgpu::ComputePipeline,
    reserve: wgpu::ComputePipeline,
    sort: wgpu::ComputePipeline,
    scatter: Scatter,
    /// The kinds of lights that it is compiled for, and the pipeline.
    scatter_pipeline: Option<(LightKinds, ScatterPipeline)>,
    buffers: Buffers,
    sizes: Sizes,
}

impl HybridPasses {
    pub(crate) fn new(gpu: &Gpu, scatter: Scatter) -> Result<Self, AssignError> {
        let stages = wgpu::ShaderStages::COMPUTE;
        let frame = FrameBindings::new(gpu);
        let uniform_stages = scatter.uniform_stages();
        let uniforms = [uniform_entry(3, uniform_stages), uniform_entry(PARTS, uniform_stages)];
        let cells = cells_entries(uniform_stages, scatter.stages());
        let cells_layout = gpu.bind_group_layout("hybrid cells", &[&uniforms, &cells[..]].concat());
        let live_layouts = [false, true].map(|read_only| {
            gpu.bind_group_layout("hybrid live", &[storage_entry(0, stages, read_only)])
        });
        let bound_lists =
            ListsBindings::of_kernel(gpu, "hybrid lists", &cells_entries(stages, stages));
        let kinds = LightKinds::default();
        let reserve = HybridShader::Reserve.create(gpu, kinds)?;
        let sort = HybridShader::Sort.create(gpu, kinds)?;
        let [written, read_only] = &live_layouts;
        let reserve_groups = [None, Some(bound_lists.layout()), Some(written)];
        let sort_groups = [None, Some(bound_lists.layout()), Some(read_only)];
        Ok(Self {
            occupancy: Occupancy::new(gpu, false, [frame.layout(), &cells_layout])?,
            clear: kernel::pipeline(gpu, &reserve, "clear", &reserve_groups),
            reserve: kernel::pipeline(gpu, &reserve, "reserve_lists", &reserve_groups),
            sort: kernel::pipeline(gpu, &sort, "sort_lists", &sort_groups),
            frame,
            cells_layout,
            cells_bind_group: None,
            lists: bound_lists,
            depth_bind_group: None,
            live_layouts,
            live_bind_groups: None,
            scatter,
            scatter_pipeline: None,
            buffers: Buffers::new(gpu)?,
            sizes: Sizes::default(),
        })
    }

    /// Sizes buffers for the cells and for the prepared lists, and binds them: outside the clock. `depth` is
    /// `None` if lists serve any depth.
    pub(crate) fn prepare(
        &mut self,
        gpu: &Gpu,
        frame: &Frame<'_>,
        froxels: &FroxelsUniform,
        uniform: &wgpu::Buffer,
        lists: &LightLists,
        depth: Option<&DepthImage>,
    ) -> Result<(), AssignError> {
        self.frame.update(gpu, frame)?;
        if let Some(depth) = depth
            && depth.is_multisampled() != self.occupancy.multisampled
        {
            let layouts = [self.frame.layout(), &self.cells_layout];
            self.occupancy = Occupancy::new(gpu, depth.is_multisampled(), layouts)?;
        }
        let parts = HybridParts::new(froxels);
        self.buffers.grow(gpu, froxels, parts, lists)?;
        self.bind(gpu, uniform, lists, depth);
        self.sizes = Sizes::new(frame, froxels, parts, &self.buffers);
        let kinds = frame.lights.kinds();
        if self.scatter_pipeline.as_ref().is_none_or(|(known, _)| *known != kinds) {
            let layouts = [self.frame.layout(), &self.cells_layout];
            let pipeline = ScatterPipeline::new(gpu, self.scatter, kinds, layouts)?;
            self.scatter_pipeline = Some((kinds, pipeline));
        }
        if let Some((_, pipeline)) = &mut self.scatter_pipeline {
            pipeline.resize(gpu, froxels);
        }
        Ok(())
    }

    fn bind(
        &mut self,
        gpu: &Gpu,
        uniform: &wgpu::Buffer,
        lists: &LightLists,
        depth: Option<&DepthImage>,
    ) {
        let Buffers { parts, masks, cursors, unsorted, live } = &self.buffers;
        let cells = [
            entry(FROXELS_BINDING, uniform),
            entry(MASKS, masks),
            entry(CURSORS, cursors),
            entry(UNSORTED, unsorted),
        ];
        self.lists.bind(gpu, lists, &cells);
        let uniforms = [entry(3, lists.uniform()), entry(PARTS, parts)];
        let cells = [&uniforms, &cells[..]].concat();
        self.cells_bind_group = Some(kernel::bind_entries(gpu, &self.cells_layout, &cells));
        let [written, read] = &self.live_layouts;
        self.live_bind_groups =
            Some([written, read].map(|layout| kernel::bind_buffers(gpu, layout, &[live.buffer()])));
        self.depth_bind_group =
            depth.map(|depth| kernel::bind_entries(gpu, &self.occupancy.layout, &[depth.entry(0)]));
    }

    /// Records the passes: inside the clock, after [`prepare`](Self::prepare).
    pub(crate) fn record(&self, frame: &Frame<'_>, passes: &mut dyn Passes) {
        let sizes = self.sizes;
        let reads_depth = frame.samples == SampleDomain::OpaqueSurfaces;
        passes.compute("occupancy", &mut |pass| {
            self.bind_lists(pass);
            pass.set_pipeline(&self.clear);
            pass.dispatch_workgroups(sizes.clear, 1, 1);
            if reads_depth {
                self.bind_cells(pass);
                pass.set_bind_group(2, self.depth_bind_group.as_ref(), &[]);
                pass.set_pipeline(&self.occupancy.pipeline);
                pass.dispatch_workgroups(sizes.blocks[0], sizes.blocks[1], 1);
            }
        });
        self.add_lights("count", frame, passes);
        passes.compute("reserve", &mut |pass| {
            self.bind_lists(pass);
            pass.set_pipeline(&self.reserve);
            pass.dispatch_workgroups(sizes.reserve, 1, 1);
        });
        self.add_lights("fill", frame, passes);
        passes.compute("sort", &mut |pass| {
            self.bind_lists(pass);
            pass.set_bind_group(2, self.live_bind_groups.as_ref().map(|[_, read]| read), &[]);
            pass.set_pipeline(&self.sort);
            pass.dispatch_workgroups_indirect(self.buffers.live.buffer(), 0);
        });
    }

    /// Bytes of its buffers.
    pub(crate) fn bytes(&self) -> u64 {
        let target = self.scatter_pipeline.as_ref().map_or(0, |(_, pipeline)| pipeline.bytes());
        self.buffers.bytes() + self.frame.bytes() + target
    }

    /// The pass that adds lights to cells. It counts them first, and places them after `reserve`.
    fn add_lights(&self, name: &str, frame: &Frame<'_>, passes: &mut dyn Passes) {
        if let Some((_, pipeline)) = &self.scatter_pipeline {
            let bound = [self.frame.bind_group(), self.cells_bind_group.as_ref()];
            pipeline.record(name, frame.lights.count(), self.sizes.scatter, bound, passes);
        }
    }

    fn bind_cells(&self, pass: &mut wgpu::ComputePass<'_>) {
        pass.set_bind_group(0, self.frame.bind_group(), &[]);
        pass.set_bind_group(LISTS_GROUP, self.cells_bind_group.as_ref(), &[]);
    }

    fn bind_lists(&self, pass: &mut wgpu::ComputePass<'_>) {
        pass.set_bind_group(LISTS_GROUP, self.lists.bind_group(), &[]);
        let live = self.live_bind_groups.as_ref().map(|[written, _]| written);
        pass.set_bind_group(2, live, &[]);
    }
}

/// The kernel that reads the depth buffer.
#[derive(Debug)]
struct Occupancy {
    multisampled: bool,
    layout: wgpu::BindGroupLayout,
    pipeline: wgpu::ComputePipeline,
}

impl Occupancy {
    fn new(
        gpu: &Gpu,
        multisampled: bool,
        [frame, cells]: [&wgpu::BindGroupLayout; 2],
    ) -> Result<Self, AssignError> {
        let entries = [DepthImage::layout(0, wgpu::ShaderStages::COMPUTE, multisampled)];
        let layout = gpu.bind_group_layout("hybrid depth", &entries);
        let shader = HybridShader::Occupancy { multisampled };
        let module = shader.create(gpu, LightKinds::default())?;
        let pipeline = kernel::pipeline(gpu, &module, "occupancy", &[frame, cells, &layout]);
        Ok(Self { multisampled, layout, pipeline })
    }
}

/// The cells besides their uniforms: what `occupancy` and the scatter passes read and write.
fn cells_entries(
    uniform: wgpu::ShaderStages,
    storage: wgpu::ShaderStages,
) -> [wgpu::BindGroupLayoutEntry; 4] {
    [
        uniform_entry(FROXELS_BINDING, uniform),
        storage_entry(MASKS, storage, false),
        storage_entry(CURSORS, storage, false),
        storage_entry(UNSORTED, storage, false),
    ]
}
