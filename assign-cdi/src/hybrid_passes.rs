//! The passes of the hybrid-lighting grid: their shaders, pipelines and buffers.

use assign::{
    AssignError, Frame, FrameBindings, Gpu, LightKinds, LightLists, ListsBindings, LiveGroups,
    Passes, SampleDomain, Shader, entry, storage_entry, uniform_entry,
};

use crate::hybrid_cells::CellsUniform;

/// Bind group of the cells, and of the lists.
const LISTS_GROUP: u32 = 1;
const CELLS: u32 = assign::FIRST_STRATEGY_BINDING;
const MASKS: u32 = CELLS + 1;
const CURSORS: u32 = CELLS + 2;
const UNSORTED: u32 = CELLS + 3;

/// Workgroups that a dispatch may have along one axis; each takes more where there are more.
const MAX_DISPATCH: u32 = 65_535;
/// Cells that a workgroup of `clear` and `reserve_lists` takes at once: `LANES` of
/// `hybrid_reserve.wesl`.
const CELLS_AT_ONCE: u32 = 256;
/// Lights that a workgroup of `scatter` takes at once: `WORKGROUP / LANES` of `hybrid_scatter.wesl`.
const LIGHTS_AT_ONCE: u32 = 4;
/// Width and height of the pixels that one workgroup reads: `BLOCK_PX` of `hybrid_occupancy.wesl`.
const BLOCK_PX: u32 = 32;

/// A shader of the grid, linked for a scene with lights of these kinds.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum HybridShader {
    /// Which cells hold samples.
    Occupancy,
    /// Lights to cells: counts, then places.
    Scatter,
    /// Clears, and reserves the lists' places.
    Reserve,
    /// Sorts the lists.
    Sort,
}

impl HybridShader {
    /// All of them.
    pub const ALL: [Self; 4] = [Self::Occupancy, Self::Scatter, Self::Reserve, Self::Sort];

    /// Its linked WGSL, for tests of layout and validity.
    pub fn source(self, kinds: LightKinds) -> Result<String, AssignError> {
        self.shader(kinds).link(self.root())
    }

    fn root(self) -> &'static str {
        match self {
            Self::Occupancy => "package::hybrid_occupancy",
            Self::Scatter => "package::hybrid_scatter",
            Self::Reserve => "package::hybrid_reserve",
            Self::Sort => "package::hybrid_sort",
        }
    }

    fn shader(self, kinds: LightKinds) -> Shader<'static> {
        let shader = Shader::new(LISTS_GROUP)
            .module("package::strategy", include_str!("shaders/hybrid_cells.wesl"))
            .light_kinds(kinds);
        match self {
            Self::Occupancy => {
                shader.module(self.root(), include_str!("shaders/hybrid_occupancy.wesl"))
            }
            Self::Scatter => shader
                .module(self.root(), include_str!("shaders/hybrid_scatter.wesl"))
                .module("package::hybrid_outline", include_str!("shaders/hybrid_outline.wesl")),
            Self::Reserve => shader
                .module(self.root(), include_str!("shaders/hybrid_reserve.wesl"))
                .module("package::live", LiveGroups::WESL)
                // A lane a cell.
                .flag("lanes_reserve", true),
            Self::Sort => shader.module(self.root(), include_str!("shaders/hybrid_sort.wesl")),
        }
    }

    fn create(self, gpu: &Gpu, kinds: LightKinds) -> Result<wgpu::ShaderModule, AssignError> {
        // SAFETY: loops count up, without wrapping, to a constant, to the length of a buffer, to a
        // number of lights, tiles, slices or entries, each no greater than the length of a buffer,
        // clear a bit of a word a round, or end once the cursor, which only grows, leaves no room, or
        // no other lane moved it between look and exchange.
        #[allow(unsafe_code, reason = "its loops end")]
        unsafe {
            self.shader(kinds).create_uncounted(gpu, self.root())
        }
    }
}

/// Everything between the depth buffer and the lists.
#[derive(Debug)]
pub(crate) struct HybridPasses {
    frame: FrameBindings,
    /// Cells without lists: what `occupancy` and `scatter` read and write.
    cells_layout: wgpu::BindGroupLayout,
    cells_bind_group: Option<wgpu::BindGroup>,
    kernel: ListsBindings,
    depth_layout: wgpu::BindGroupLayout,
    depth_bind_group: Option<wgpu::BindGroup>,
    /// Live cells, as `clear` and `reserve_lists` write them and as `sort` reads them.
    live_layouts: [wgpu::BindGroupLayout; 2],
    live_bind_groups: Option<[wgpu::BindGroup; 2]>,
    occupancy: wgpu::ComputePipeline,
    clear: wgpu::ComputePipeline,
    reserve: wgpu::ComputePipeline,
    sort: wgpu::ComputePipeline,
    /// Compiled for kinds of lights.
    scatter: Option<(LightKinds, wgpu::ComputePipeline)>,
    buffers: Buffers,
    sizes: Sizes,
}

#[derive(Debug)]
struct Buffers {
    masks: wgpu::Buffer,
    cursors: wgpu::Buffer,
    unsorted: wgpu::Buffer,
    live: LiveGroups,
}

/// Workgroups of the dispatches of a frame.
#[derive(Clone, Copy, Debug, Default)]
struct Sizes {
    clear: u32,
    blocks: [u32; 2],
    scatter: [u32; 2],
    reserve: u32,
}

impl HybridPasses {
    pub(crate) fn new(gpu: &Gpu) -> Result<Self, AssignError> {
        let stages = wgpu::ShaderStages::COMPUTE;
        let cells = [
            uniform_entry(CELLS, stages),
            storage_entry(MASKS, stages, false),
            storage_entry(CURSORS, stages, false),
            storage_entry(UNSORTED, stages, false),
        ];
        let with_cull = [&[uniform_entry(3, stages)], &cells[..]].concat();
        let frame = FrameBindings::new(gpu);
        let cells_layout = layout(gpu, "hybrid cells", &with_cull);
        let depth_layout = layout(gpu, "hybrid depth", &[depth_entry()]);
        let live_layouts = [false, true]
            .map(|read_only| layout(gpu, "hybrid live", &[storage_entry(0, stages, read_only)]));
        let kernel = ListsBindings::of_kernel(gpu, "hybrid lists", &cells);
        let kinds = LightKinds::default();
        let read = HybridShader::Occupancy.create(gpu, kinds)?;
        let reserve = HybridShader::Reserve.create(gpu, kinds)?;
        let sort = HybridShader::Sort.create(gpu, kinds)?;
        let of_depth = [Some(frame.layout()), Some(&cells_layout), Some(&depth_layout)];
        let [written, read_only] = &live_layouts;
        let of_lists = [None, Some(kernel.layout()), Some(written)];
        let of_sort = [None, Some(kernel.layout()), Some(read_only)];
        Ok(Self {
            occupancy: pipeline(gpu, &of_depth, &read, "occupancy"),
            clear: pipeline(gpu, &of_lists, &reserve, "clear"),
            reserve: pipeline(gpu, &of_lists, &reserve, "reserve_lists"),
            sort: pipeline(gpu, &of_sort, &sort, "sort_lists"),
            frame,
            cells_layout,
            cells_bind_group: None,
            kernel,
            depth_layout,
            depth_bind_group: None,
            live_layouts,
            live_bind_groups: None,
            scatter: None,
            buffers: Buffers {
                masks: gpu.storage("cell masks", 0)?,
                cursors: gpu.storage("cell cursors", 0)?,
                unsorted: gpu.storage("unsorted entries", 0)?,
                live: LiveGroups::new(gpu)?,
            },
            sizes: Sizes::default(),
        })
    }

    /// Sizes buffers for the cells, and for lists that were prepared, and binds them: outside the
    /// clock. `depth` is `None` where lists are made for any depth.
    pub(crate) fn prepare(
        &mut self,
        gpu: &Gpu,
        frame: &Frame<'_>,
        cells: &CellsUniform,
        uniform: &wgpu::Buffer,
        lists: &LightLists,
        depth: Option<&wgpu::TextureView>,
    ) -> Result<(), AssignError> {
        self.frame.update(gpu, frame)?;
        self.buffers.fit(gpu, cells, lists)?;
        self.bind(gpu, uniform, lists, depth);
        self.sizes = Sizes::new(frame, cells, &self.buffers);
        let kinds = frame.lights.kinds();
        if self.scatter.as_ref().is_none_or(|(known, _)| *known != kinds) {
            let module = HybridShader::Scatter.create(gpu, kinds)?;
            let layouts = [Some(self.frame.layout()), Some(&self.cells_layout)];
            self.scatter = Some((kinds, pipeline(gpu, &layouts, &module, "scatter")));
        }
        Ok(())
    }

    fn bind(
        &mut self,
        gpu: &Gpu,
        uniform: &wgpu::Buffer,
        lists: &LightLists,
        depth: Option<&wgpu::TextureView>,
    ) {
        let Buffers { masks, cursors, unsorted, live } = &self.buffers;
        let cells = [
            entry(CELLS, uniform),
            entry(MASKS, masks),
            entry(CURSORS, cursors),
            entry(UNSORTED, unsorted),
        ];
        self.kernel.bind(gpu, lists, &cells);
        let with_cull = [&[entry(3, lists.uniform())], &cells[..]].concat();
        self.cells_bind_group =
            Some(bind_group(gpu, "hybrid cells", &self.cells_layout, &with_cull));
        let live = [entry(0, live.buffer())];
        let [written, read] = &self.live_layouts;
        self.live_bind_groups =
            Some([written, read].map(|layout| bind_group(gpu, "hybrid live", layout, &live)));
        self.depth_bind_group = depth.map(|view| {
            let resource = wgpu::BindingResource::TextureView(view);
            let entries = [wgpu::BindGroupEntry { binding: 0, resource }];
            bind_group(gpu, "hybrid depth", &self.depth_layout, &entries)
        });
    }

    /// Records the passes: inside the clock. Nothing before the first `prepare`.
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
                pass.set_pipeline(&self.occupancy);
                pass.dispatch_workgroups(sizes.blocks[0], sizes.blocks[1], 1);
            }
        });
        self.add_lights("count", passes);
        passes.compute("reserve", &mut |pass| {
            self.bind_lists(pass);
            pass.set_pipeline(&self.reserve);
            pass.dispatch_workgroups(sizes.reserve, 1, 1);
        });
        self.add_lights("fill", passes);
        passes.compute("sort", &mut |pass| {
            self.bind_lists(pass);
            pass.set_bind_group(2, self.live_bind_groups.as_ref().map(|[_, read]| read), &[]);
            pass.set_pipeline(&self.sort);
            pass.dispatch_workgroups_indirect(self.buffers.live.buffer(), 0);
        });
    }

    /// Bytes of its buffers.
    pub(crate) fn bytes(&self) -> u64 {
        let Buffers { masks, cursors, unsorted, live } = &self.buffers;
        masks.size() + cursors.size() + unsorted.size() + live.bytes() + self.frame.bytes()
    }

    /// The pass that counts, and that places once places are reserved.
    fn add_lights(&self, name: &str, passes: &mut dyn Passes) {
        let Some((_, scatter)) = &self.scatter else {
            return;
        };
        let [workgroups, parts] = self.sizes.scatter;
        passes.compute(name, &mut |pass| {
            self.bind_cells(pass);
            pass.set_pipeline(scatter);
            pass.dispatch_workgroups(workgroups, parts, 1);
        });
    }

    fn bind_cells(&self, pass: &mut wgpu::ComputePass<'_>) {
        pass.set_bind_group(0, self.frame.bind_group(), &[]);
        pass.set_bind_group(LISTS_GROUP, self.cells_bind_group.as_ref(), &[]);
    }

    fn bind_lists(&self, pass: &mut wgpu::ComputePass<'_>) {
        pass.set_bind_group(LISTS_GROUP, self.kernel.bind_group(), &[]);
        let live = self.live_bind_groups.as_ref().map(|[written, _]| written);
        pass.set_bind_group(2, live, &[]);
    }
}

impl Buffers {
    fn fit(
        &mut self,
        gpu: &Gpu,
        cells: &CellsUniform,
        lists: &LightLists,
    ) -> Result<(), AssignError> {
        let masks = u64::from(cells.tile_count()) * u64::from(cells.mask_words) * 4;
        let cursors = u64::from(cells.cell_count()) * 4;
        for (buffer, label, bytes) in [
            (&mut self.masks, "cell masks", masks),
            (&mut self.cursors, "cell cursors", cursors),
            (&mut self.unsorted, "unsorted entries", lists.entries().size()),
        ] {
            if buffer.size() < bytes {
                *buffer = gpu.storage(label, bytes)?;
            }
        }
        self.live.prepare(gpu, cells.cell_count())?;
        Ok(())
    }
}

impl Sizes {
    fn new(frame: &Frame<'_>, cells: &CellsUniform, buffers: &Buffers) -> Self {
        // `clear` clears whole buffers, which may be those of a larger view.
        let words = (buffers.cursors.size().max(buffers.masks.size()) / 4) as u32;
        let workgroups = |items: u32, at_once: u32| items.div_ceil(at_once).min(MAX_DISPATCH);
        let viewport = frame.view.viewport;
        Self {
            clear: workgroups(words, CELLS_AT_ONCE),
            blocks: [viewport.width.div_ceil(BLOCK_PX), viewport.height.div_ceil(BLOCK_PX)],
            scatter: [workgroups(frame.lights.count(), LIGHTS_AT_ONCE), cells.part_count()],
            reserve: workgroups(cells.cell_count(), CELLS_AT_ONCE),
        }
    }
}

fn depth_entry() -> wgpu::BindGroupLayoutEntry {
    wgpu::BindGroupLayoutEntry {
        binding: 0,
        visibility: wgpu::ShaderStages::COMPUTE,
        ty: wgpu::BindingType::Texture {
            sample_type: wgpu::TextureSampleType::Depth,
            view_dimension: wgpu::TextureViewDimension::D2,
            multisampled: false,
        },
        count: None,
    }
}

fn layout(gpu: &Gpu, label: &str, entries: &[wgpu::BindGroupLayoutEntry]) -> wgpu::BindGroupLayout {
    gpu.bind_group_layout(label, entries)
}

fn bind_group(
    gpu: &Gpu,
    label: &str,
    layout: &wgpu::BindGroupLayout,
    entries: &[wgpu::BindGroupEntry<'_>],
) -> wgpu::BindGroup {
    gpu.device.create_bind_group(&wgpu::BindGroupDescriptor { label: Some(label), layout, entries })
}

fn pipeline(
    gpu: &Gpu,
    layouts: &[Option<&wgpu::BindGroupLayout>],
    module: &wgpu::ShaderModule,
    entry_point: &str,
) -> wgpu::ComputePipeline {
    // The kernels write the workgroup memory that they read.
    gpu.compute_pipeline(module, entry_point, layouts, false)
}
