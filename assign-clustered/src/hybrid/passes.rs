//! The passes of HG: what they bind, and the order in which they run.

use assign::{
    AssignError, DepthImage, DepthKernels, Frame, FrameBindings, Gpu, KeptBindGroup, LightKinds,
    LightLists, ListsBindings, Passes, SampleDomain, entry, kernel, storage_entry, uniform_entry,
};

use super::{
    buffers::{Buffers, Sizes},
    parts::HybridParts,
    scatter::{Scatter, ScatterPipeline, Target},
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
    bound_cells: KeptBindGroup,
    lists: ListsBindings,
    occupancy: DepthKernels<Occupancy>,
    bound_depth: KeptBindGroup,
    /// The live cells: first as `clear` and `reserve_lists` write them, then as `sort` reads them.
    live_layouts: [wgpu::BindGroupLayout; 2],
    bound_live: [KeptBindGroup; 2],
    clear: wgpu::ComputePipeline,
    reserve: wgpu::ComputePipeline,
    sort: wgpu::ComputePipeline,
    scatter: Scatter,
    /// One pipeline per kind of lights that came up, and the place of that of the prepared frame.
    scatter_pipelines: Vec<(LightKinds, ScatterPipeline)>,
    scatter_pipeline: usize,
    /// What the rasteriser draws to.
    target: Target,
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
            occupancy: DepthKernels::new(Occupancy::new(
                gpu,
                false,
                [frame.layout(), &cells_layout],
            )?),
            clear: kernel::pipeline(gpu, &reserve, "clear", &reserve_groups),
            reserve: kernel::pipeline(gpu, &reserve, "reserve_lists", &reserve_groups),
            sort: kernel::pipeline(gpu, &sort, "sort_lists", &sort_groups),
            frame,
            cells_layout,
            bound_cells: KeptBindGroup::default(),
            lists: bound_lists,
            bound_depth: KeptBindGroup::default(),
            live_layouts,
            bound_live: Default::default(),
            scatter,
            scatter_pipelines: Vec::new(),
            scatter_pipeline: 0,
            target: Target::new(gpu),
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
        lists: &mut LightLists,
        depth: Option<&DepthImage>,
    ) -> Result<(), AssignError> {
        self.frame.update_in(gpu, frame, lists.writes_mut())?;
        if let Some(depth) = depth {
            let layouts = [self.frame.layout(), &self.cells_layout];
            self.occupancy.choose(depth, || Occupancy::new(gpu, true, layouts))?;
        }
        let parts = HybridParts::new(froxels);
        self.buffers.grow(gpu, froxels, parts, lists)?;
        self.bind(gpu, uniform, lists, depth);
        self.sizes = Sizes::new(frame, froxels, parts, &self.buffers);
        self.scatter_pipeline = self.compile(gpu, frame.lights.kinds())?;
        if self.scatter == Scatter::Raster {
            self.target.resize(gpu, [froxels.counts[0], froxels.counts[1]]);
        }
        Ok(())
    }

    /// Compiles the pipeline for kinds of lights the first time. Returns its place.
    pub(crate) fn compile(&mut self, gpu: &Gpu, kinds: LightKinds) -> Result<usize, AssignError> {
        if let Some(place) = self.scatter_pipelines.iter().position(|(known, _)| *known == kinds) {
            return Ok(place);
        }
        let layouts = [self.frame.layout(), &self.cells_layout];
        let pipeline = ScatterPipeline::new(gpu, self.scatter, kinds, layouts)?;
        self.scatter_pipelines.push((kinds, pipeline));
        Ok(self.scatter_pipelines.len() - 1)
    }

    /// Shares the pipelines of the same passes for another view.
    pub(crate) fn share(&mut self, other: &Self) {
        self.scatter_pipelines = other.scatter_pipelines.clone();
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
        self.bound_cells.bind(gpu, "hybrid cells", &self.cells_layout, &cells);
        for (bound, layout) in self.bound_live.iter_mut().zip(&self.live_layouts) {
            bound.bind(gpu, "hybrid live", layout, &[entry(0, live.buffer())]);
        }
        if let Some(depth) = depth {
            let layout = &self.occupancy.chosen().layout;
            self.bound_depth.bind(gpu, "hybrid depth", layout, &[depth.entry(0)]);
        }
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
                pass.set_bind_group(2, self.bound_depth.get(), &[]);
                pass.set_pipeline(&self.occupancy.chosen().pipeline);
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
            pass.set_bind_group(2, self.bound_live[1].get(), &[]);
            pass.set_pipeline(&self.sort);
            pass.dispatch_workgroups_indirect(self.buffers.live.buffer(), 0);
        });
    }

    /// Bytes of its buffers.
    pub(crate) fn bytes(&self) -> u64 {
        let target = if self.scatter == Scatter::Raster { self.target.bytes() } else { 0 };
        self.buffers.bytes() + self.frame.bytes() + target
    }

    /// The pass that adds lights to cells. It counts them first, and places them after `reserve`.
    fn add_lights(&self, name: &str, frame: &Frame<'_>, passes: &mut dyn Passes) {
        if let Some((_, pipeline)) = self.scatter_pipelines.get(self.scatter_pipeline) {
            let bound = [self.frame.bind_group(), self.bound_cells.get()];
            let lights = frame.lights.count();
            pipeline.record(name, lights, self.sizes.scatter, (bound, &self.target), passes);
        }
    }

    fn bind_cells(&self, pass: &mut wgpu::ComputePass<'_>) {
        pass.set_bind_group(0, self.frame.bind_group(), &[]);
        pass.set_bind_group(LISTS_GROUP, self.bound_cells.get(), &[]);
    }

    fn bind_lists(&self, pass: &mut wgpu::ComputePass<'_>) {
        pass.set_bind_group(LISTS_GROUP, self.lists.bind_group(), &[]);
        pass.set_bind_group(2, self.bound_live[0].get(), &[]);
    }
}

/// The kernel that reads the depth buffer.
#[derive(Debug)]
struct Occupancy {
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
        Ok(Self { layout, pipeline })
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
