//! The pass `bounds`: finds which clusters hold samples, and the boxes around those samples and their
//! normals.

use assign::{
    AssignError, Bounds, DepthBindGroups, DepthImage, DepthKernels, Frame, FrameBindings,
    FrameWrites, Gpu, KeptBindGroup, LiveGroups, Passes, Shader, UNFILTERED, entry, kernel,
    storage_entry, texture, texture_entry, uniform_entry,
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

/// Binding of the records of lists in [`GATHER_GROUP`].
const LISTS_BINDING: u32 = 7;

/// Width and height of the block that one workgroup reads, pixels: `BLOCK_PX` of `gather.wesl`.
const BLOCK_PX: u32 = 32;

/// Words of the marks that one workgroup clears, at least. It clears more if the dispatch would be too wide.
const CLEARED: u32 = 256;

/// Reads the depth buffer once; also normals and base colours if it was made for them.
#[derive(Debug)]
pub(crate) struct Gather {
    options: ClusterOptions,
    /// [`marks_words`].
    words: u64,
    frame: FrameBindings,
    kernels: DepthKernels<Kernels>,
    /// Of the depth buffer, and of each layer.
    bound: DepthBindGroups,
    bound_live: KeptBindGroup,
    live_layout: wgpu::BindGroupLayout,
    marks: wgpu::Buffer,
    live: LiveGroups,
    clear_workgroups: u32,
    /// Workgroups of `gather` along x and y.
    workgroups: [u32; 2],
}

/// The kernels for depth with one or with several samples per pixel.
#[derive(Debug)]
struct Kernels {
    layout: wgpu::BindGroupLayout,
    clear: wgpu::ComputePipeline,
    gather: wgpu::ComputePipeline,
}

impl Kernels {
    fn new(
        gpu: &Gpu,
        options: &ClusterOptions,
        multisampled: bool,
        [frame, live]: [&wgpu::BindGroupLayout; 2],
    ) -> Result<Self, AssignError> {
        let stages = wgpu::ShaderStages::COMPUTE;
        let mut entries = vec![
            DepthImage::layout(0, stages, multisampled),
            uniform_entry(FROXELS_BINDING, stages),
        ];
        if has_marks(options) {
            entries.push(storage_entry(1, stages, false));
        }
        if options.reads_normals() {
            entries.push(texture_entry(2, stages, UNFILTERED));
        }
        if options.normals.is_some() {
            entries.push(uniform_entry(BINS_BINDING, stages));
        }
        if options.reads_materials() {
            entries.push(texture_entry(3, stages, UNFILTERED));
        }
        if options.occupancy.is_sparse() {
            entries.push(storage_entry(LISTS_BINDING, stages, false));
        }
        let layout = gpu.bind_group_layout("gather", &entries);
        let shader = gather_shader(options, multisampled);
        // SAFETY: a loop counts up to a constant, or to the length of a buffer by a step of at least one
        // workgroup, or over slices, at most 1,024, or over cells along an edge, at most 3, or over the pixels of
        // a lane, at most 64 along each side, or over the samples of a pixel.
        #[allow(unsafe_code, reason = "its loops end")]
        let module = unsafe { shader.create_uncounted(gpu, root(options.occupancy)) }?;
        let layouts = [frame, &layout, live];
        let pipeline = |entry_point| kernel::pipeline(gpu, &module, entry_point, &layouts);
        let (clear, gather) = (pipeline("clear"), pipeline("gather"));
        Ok(Self { layout, clear, gather })
    }
}

impl Gather {
    pub(crate) fn new(gpu: &Gpu, options: &ClusterOptions) -> Result<Self, AssignError> {
        let stages = wgpu::ShaderStages::COMPUTE;
        let live_layout = gpu.bind_group_layout("live groups", &[storage_entry(0, stages, false)]);
        let frame = FrameBindings::new(gpu);
        Ok(Self {
            options: *options,
            words: if has_marks(options) { marks_words(options).into() } else { 0 },
            kernels: DepthKernels::new(Kernels::new(
                gpu,
                options,
                false,
                [frame.layout(), &live_layout],
            )?),
            frame,
            bound: DepthBindGroups::default(),
            bound_live: KeptBindGroup::default(),
            live_layout,
            marks: gpu.storage("cluster marks", 0)?,
            live: LiveGroups::new(gpu)?,
            clear_workgroups: 0,
            workgroups: [0; 2],
        })
    }

    /// Sizes buffers for `count` groups, and compiles for the depth buffer: outside the clock.
    pub(crate) fn prepare(
        &mut self,
        gpu: &Gpu,
        frame: &Frame<'_>,
        depth: &DepthImage,
        froxels: &FroxelsUniform,
        count: u32,
        writes: &mut FrameWrites,
    ) -> Result<(), AssignError> {
        self.frame.update_in(gpu, frame, writes)?;
        let layouts = [self.frame.layout(), &self.live_layout];
        let make = || Kernels::new(gpu, &self.options, true, layouts);
        self.kernels.choose(depth, make)?;
        let marks = u64::from(count) * self.words;
        if self.marks.size() < marks * 4 {
            self.marks = gpu.storage("cluster marks", marks * 4)?;
        }
        // The kernel clears the whole buffer, which may have grown for a larger view.
        let blocks = |pixels: u32| pixels.div_ceil(BLOCK_PX);
        (self.clear_workgroups, self.workgroups) = match self.options.occupancy {
            Occupancy::DepthAware => (1, [froxels.counts[0], froxels.counts[1]]),
            Occupancy::Dense | Occupancy::Sparse => (
                kernel::workgroups(self.marks.size() / 4, CLEARED),
                [frame.view.viewport.width, frame.view.viewport.height].map(blocks),
            ),
        };
        self.live.prepare(gpu, count)?;
        let live = [entry(0, self.live.buffer())];
        self.bound_live.bind(gpu, "live groups", &self.live_layout, &live);
        Ok(())
    }

    /// Binds the images, the uniforms of froxels and of bins, and the records of the prepared lists: outside the
    /// clock. Only clusters that are split by normals have bins.
    pub(crate) fn bind(
        &mut self,
        gpu: &Gpu,
        images: &Images<'_>,
        uniforms: (&wgpu::Buffer, Option<&wgpu::Buffer>),
        lists: &wgpu::Buffer,
    ) {
        let mut shared = vec![entry(FROXELS_BINDING, uniforms.0)];
        if self.words > 0 {
            shared.push(entry(1, &self.marks));
        }
        shared.extend(images.normals.map(|view| texture(2, view)));
        shared.extend(uniforms.1.map(|bins| entry(BINS_BINDING, bins)));
        shared.extend(images.base_color.map(|view| texture(3, view)));
        if self.options.occupancy.is_sparse() {
            shared.push(entry(LISTS_BINDING, lists));
        }
        let layout = &self.kernels.chosen().layout;
        self.bound.bind(gpu, "gather", layout, &images.depths, &shared);
    }

    /// Records the pass `bounds`: inside the clock.
    pub(crate) fn record(&self, passes: &mut dyn Passes) {
        let kernels = self.kernels.chosen();
        passes.compute("bounds", &mut |pass| {
            pass.set_bind_group(0, self.frame.bind_group(), &[]);
            pass.set_bind_group(GATHER_GROUP, self.bound.groups().next(), &[]);
            pass.set_bind_group(LIVE_GROUP, self.bound_live.get(), &[]);
            pass.set_pipeline(&kernels.clear);
            pass.dispatch_workgroups(self.clear_workgroups, 1, 1);
            pass.set_pipeline(&kernels.gather);
            for depth in self.bound.groups() {
                pass.set_bind_group(GATHER_GROUP, depth, &[]);
                pass.dispatch_workgroups(self.workgroups[0], self.workgroups[1], 1);
            }
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

/// Whether the pass keeps marks of groups. One workgroup per tile keeps them to itself, and stores only boxes.
fn has_marks(options: &ClusterOptions) -> bool {
    options.occupancy != Occupancy::DepthAware || options.bounds == Bounds::Explicit
}

/// What the pass reads.
#[derive(Debug)]
pub(crate) struct Images<'a> {
    /// The depth buffer, and then those of layers.
    pub(crate) depths: Vec<DepthImage>,
    /// Present if the strategy was made with normals or with a specular reach.
    pub(crate) normals: Option<&'a wgpu::TextureView>,
    /// Present if it was made with a specular threshold or with a specular reach.
    pub(crate) base_color: Option<&'a wgpu::TextureView>,
}

/// The pass's shader.
fn gather_shader<'a>(options: &ClusterOptions, multisampled: bool) -> Shader<'a> {
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
        .flag("multisampled", multisampled)
}

/// The module with the pass's entry points.
fn root(occupancy: Occupancy) -> &'static str {
    match occupancy {
        Occupancy::DepthAware => "package::gather_tiles",
        Occupancy::Dense | Occupancy::Sparse => "package::gather",
    }
}

/// The linked WGSL of the pass, for tests of layout and validity.
pub fn gather_source(options: &ClusterOptions, multisampled: bool) -> Result<String, AssignError> {
    gather_shader(options, multisampled).link(root(options.occupancy))
}
