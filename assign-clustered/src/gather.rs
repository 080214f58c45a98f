//! The pass `bounds`: finds which clusters hold samples, and the boxes around those samples and their
//! normals.

use assign::{
    AssignError, Bounds, Frame, FrameBindings, FrameWrites, Gpu, KeptBindGroup, LiveGroups, Passes,
    Shader, UNFILTERED, entry, kernel, storage_entry, texture, texture_entry, uniform_entry,
};

use crate::{
    ClusterOptions, Occupancy,
    cluster_wesl::cluster_wesl,
    froxels::{FROXELS_BINDING, FroxelsUniform},
    normal_bins::BINS_BINDING,
};

/// Bind group of the pass's own resources, and of the uniforms of froxels and bins.
const GATHER_GROUP: u32 = 1;
/// Bind group of the live groups.
const LIVE_GROUP: u32 = 2;

/// Width and height of the block that one workgroup reads, pixels: `BLOCK_PX` of `gather.wesl`.
const BLOCK_PX: u32 = 32;

/// Words of the marks that one workgroup clears, at least. It clears more if the dispatch would be too wide.
const CLEARED: u32 = 256;

/// Reads the depth buffer once; also normals and base colours if it was made for them.
#[derive(Debug)]
pub(crate) struct Gather {
    /// [`marks_words`].
    words: u64,
    frame: FrameBindings,
    layout: wgpu::BindGroupLayout,
    bound: KeptBindGroup,
    bound_live: KeptBindGroup,
    live_layout: wgpu::BindGroupLayout,
    clear: wgpu::ComputePipeline,
    gather: wgpu::ComputePipeline,
    marks: wgpu::Buffer,
    live: LiveGroups,
    clear_workgroups: u32,
    /// Workgroups of `gather` along x and y.
    workgroups: [u32; 2],
    occupancy: Occupancy,
}

impl Gather {
    pub(crate) fn new(gpu: &Gpu, options: &ClusterOptions) -> Result<Self, AssignError> {
        let ClusterOptions { bounds, occupancy, normals, .. } = *options;
        let stages = wgpu::ShaderStages::COMPUTE;
        let mut entries = vec![
            texture_entry(0, stages, wgpu::TextureSampleType::Depth),
            uniform_entry(FROXELS_BINDING, stages),
        ];
        let per_tile = occupancy == Occupancy::DepthAware;
        // One workgroup per tile keeps marks to itself, and stores only boxes.
        let has_marks = !per_tile || bounds == Bounds::Explicit;
        if has_marks {
            entries.push(storage_entry(1, stages, false));
        }
        if options.reads_normals() {
            entries.push(texture_entry(2, stages, UNFILTERED));
        }
        if normals.is_some() {
            entries.push(uniform_entry(BINS_BINDING, stages));
        }
        if options.reads_materials() {
            entries.push(texture_entry(3, stages, UNFILTERED));
        }
        let layout = gpu.bind_group_layout("gather", &entries);
        let live_layout = gpu.bind_group_layout("live groups", &[storage_entry(0, stages, false)]);
        let frame = FrameBindings::new(gpu);
        let shader = gather_shader(options);
        // SAFETY: a loop counts up to a constant, or to the length of a buffer by a step of at least one
        // workgroup, or over slices, at most 1,024, or over cells along an edge, at most 3, or over the pixels of
        // a lane, at most 64 along each side.
        #[allow(unsafe_code, reason = "its loops end")]
        let module = unsafe { shader.create_uncounted(gpu, root(occupancy)) }?;
        let layouts = [frame.layout(), &layout, &live_layout];
        let pipeline = |entry_point| kernel::pipeline(gpu, &module, entry_point, &layouts);
        let (clear, gather) = (pipeline("clear"), pipeline("gather"));
        Ok(Self {
            words: if has_marks { marks_words(options).into() } else { 0 },
            frame,
            layout,
            bound: KeptBindGroup::default(),
            bound_live: KeptBindGroup::default(),
            live_layout,
            clear,
            gather,
            marks: gpu.storage("cluster marks", 0)?,
            live: LiveGroups::new(gpu)?,
            clear_workgroups: 0,
            workgroups: [0; 2],
            occupancy,
        })
    }

    /// Sizes buffers for `count` groups and binds them: outside the clock. `uniforms` are those of froxels and
    /// of bins; only clusters that are split by normals have the latter.
    pub(crate) fn prepare(
        &mut self,
        gpu: &Gpu,
        frame: &Frame<'_>,
        images: Images<'_>,
        (froxels, uniforms): (&FroxelsUniform, (&wgpu::Buffer, Option<&wgpu::Buffer>)),
        count: u32,
        writes: &mut FrameWrites,
    ) -> Result<(), AssignError> {
        self.frame.update_in(gpu, frame, writes)?;
        let marks = u64::from(count) * self.words;
        if self.marks.size() < marks * 4 {
            self.marks = gpu.storage("cluster marks", marks * 4)?;
        }
        // The kernel clears the whole buffer, which may have grown for a larger view.
        let blocks = |pixels: u32| pixels.div_ceil(BLOCK_PX);
        (self.clear_workgroups, self.workgroups) = match self.occupancy {
            Occupancy::DepthAware => (1, [froxels.counts[0], froxels.counts[1]]),
            Occupancy::Dense | Occupancy::Sparse => (
                kernel::workgroups(self.marks.size() / 4, CLEARED),
                [frame.view.viewport.width, frame.view.viewport.height].map(blocks),
            ),
        };
        self.live.prepare(gpu, count)?;
        let mut entries = vec![texture(0, images.depth), entry(FROXELS_BINDING, uniforms.0)];
        if self.words > 0 {
            entries.push(entry(1, &self.marks));
        }
        entries.extend(images.normals.map(|view| texture(2, view)));
        entries.extend(uniforms.1.map(|bins| entry(BINS_BINDING, bins)));
        entries.extend(images.base_color.map(|view| texture(3, view)));
        self.bound.bind(gpu, "gather", &self.layout, &entries);
        let live = [entry(0, self.live.buffer())];
        self.bound_live.bind(gpu, "live groups", &self.live_layout, &live);
        Ok(())
    }

    /// Records the pass `bounds`: inside the clock.
    pub(crate) fn record(&self, passes: &mut dyn Passes) {
        passes.compute("bounds", &mut |pass| {
            pass.set_bind_group(0, self.frame.bind_group(), &[]);
            pass.set_bind_group(GATHER_GROUP, self.bound.get(), &[]);
            pass.set_bind_group(LIVE_GROUP, self.bound_live.get(), &[]);
            pass.set_pipeline(&self.clear);
            pass.dispatch_workgroups(self.clear_workgroups, 1, 1);
            pass.set_pipeline(&self.gather);
            pass.dispatch_workgroups(self.workgroups[0], self.workgroups[1], 1);
        });
    }

    /// Bytes of its buffers.
    pub(crate) fn bytes(&self) -> u64 {
        self.marks.size() + self.live.bytes() + self.frame.bytes()
    }

    /// The groups that hold samples.
    pub(crate) fn live(&self) -> &LiveGroups {
        &self.live
    }

    /// What it found in each group: `marks.wesl` says what the words hold.
    pub(crate) fn marks(&self) -> &wgpu::Buffer {
        &self.marks
    }
}

/// Words of the marks per group: `WORDS` of `marks.wesl`.
pub fn marks_words(options: &ClusterOptions) -> u32 {
    match options.bounds {
        Bounds::Implicit => 1,
        Bounds::Explicit if options.cut.is_glossy() => 15,
        Bounds::Explicit if options.normals.is_some() => 12,
        Bounds::Explicit if options.reach.is_some() => 7,
        Bounds::Explicit => 6,
    }
}

/// What the pass reads.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Images<'a> {
    pub(crate) depth: &'a wgpu::TextureView,
    /// Present if the strategy was made with normals or with a specular reach.
    pub(crate) normals: Option<&'a wgpu::TextureView>,
    /// Present if it was made with a specular threshold or with a specular reach.
    pub(crate) base_color: Option<&'a wgpu::TextureView>,
}

/// The pass's shader.
fn gather_shader<'a>(options: &ClusterOptions) -> Shader<'a> {
    let occupancy = options.occupancy;
    let source = match occupancy {
        Occupancy::DepthAware => include_str!("shaders/gather_tiles.wesl"),
        Occupancy::Dense | Occupancy::Sparse => include_str!("shaders/gather.wesl"),
    };
    Shader::new(GATHER_GROUP)
        .module(root(occupancy), source)
        .module("package::live", LiveGroups::WESL)
        .strategy(cluster_wesl(options))
        .flag("sparse", occupancy == Occupancy::Sparse)
}

/// The module with the pass's entry points.
fn root(occupancy: Occupancy) -> &'static str {
    match occupancy {
        Occupancy::DepthAware => "package::gather_tiles",
        Occupancy::Dense | Occupancy::Sparse => "package::gather",
    }
}

/// The linked WGSL of the pass, for tests of layout and validity.
pub fn gather_source(options: &ClusterOptions) -> Result<String, AssignError> {
    gather_shader(options).link(root(options.occupancy))
}
