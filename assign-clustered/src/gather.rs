//! The pass `bounds`: which clusters hold samples, and the boxes around those samples and their
//! normals.

use assign::{
    AssignError, Bounds, FIRST_STRATEGY_BINDING, Frame, FrameBindings, Gpu, LiveGroups, Passes,
    Shader, View, entry, storage_entry, uniform_entry,
};

use crate::{BINS_WESL, EXPLICIT_WESL, GLOSSY_BINS_WESL, IMPLICIT_WESL, Normals, Occupancy};

/// Bind group of the pass's own resources, and of the clusters' uniform.
const GATHER_GROUP: u32 = 1;
const LIVE_GROUP: u32 = 2;

/// Width and height of the pixels that one workgroup reads: `BLOCK_PX` of `gather.wesl`.
const BLOCK_PX: u32 = 32;

/// Marks that one workgroup clears at least; more where the dispatch would be too wide.
const CLEARED: u64 = 256;
const MAX_DISPATCH: u64 = 65_535;

/// Reads the depth buffer once, and where asked to normals and base colours.
#[derive(Debug)]
pub(crate) struct Gather {
    words: u64,
    frame: FrameBindings,
    layout: wgpu::BindGroupLayout,
    bind_group: Option<wgpu::BindGroup>,
    live_bind_group: Option<wgpu::BindGroup>,
    live_layout: wgpu::BindGroupLayout,
    clear: wgpu::ComputePipeline,
    gather: wgpu::ComputePipeline,
    marks: wgpu::Buffer,
    live: LiveGroups,
    clear_workgroups: u32,
}

impl Gather {
    pub(crate) fn new(
        gpu: &Gpu,
        bounds: Bounds,
        occupancy: Occupancy,
        normals: Normals,
        glossy: bool,
    ) -> Result<Self, AssignError> {
        let stages = wgpu::ShaderStages::COMPUTE;
        let mut entries = vec![
            texture_entry(0, wgpu::TextureSampleType::Depth),
            storage_entry(1, stages, false),
            uniform_entry(FIRST_STRATEGY_BINDING, stages),
        ];
        if normals.is_some() {
            entries.push(texture_entry(2, TEXELS));
        }
        if glossy {
            entries.push(texture_entry(3, TEXELS));
        }
        let layout = gpu.bind_group_layout("gather", &entries);
        let live_layout = gpu.bind_group_layout("live groups", &[storage_entry(0, stages, false)]);
        let frame = FrameBindings::new(gpu);
        let shader = gather_shader(bounds, occupancy, normals, glossy);
        // SAFETY: loops count up to a constant, to the length of a buffer by a step of at least one
        // workgroup, or over slices, of which there are 1,024 at most, or over cells, of which an edge
        // has 3 at most.
        #[allow(unsafe_code, reason = "its loops end")]
        let module = unsafe { shader.create_uncounted(gpu, "package::gather") }?;
        let layouts = [Some(frame.layout()), Some(&layout), Some(&live_layout)];
        // The kernel writes the workgroup memory that it reads.
        let pipeline = |entry_point| gpu.compute_pipeline(&module, entry_point, &layouts, false);
        let (clear, gather) = (pipeline("clear"), pipeline("gather"));
        Ok(Self {
            words: match bounds {
                Bounds::Implicit => 1,
                Bounds::Explicit if glossy => 15,
                Bounds::Explicit if normals.is_some() => 12,
                Bounds::Explicit => 6,
            },
            frame,
            layout,
            bind_group: None,
            live_bind_group: None,
            live_layout,
            clear,
            gather,
            marks: gpu.storage("cluster marks", 0)?,
            live: LiveGroups::new(gpu)?,
            clear_workgroups: 0,
        })
    }

    /// Sizes buffers for `count` groups and binds them: outside the clock.
    pub(crate) fn prepare(
        &mut self,
        gpu: &Gpu,
        frame: &Frame<'_>,
        images: Images<'_>,
        clusters: &wgpu::Buffer,
        count: u32,
    ) -> Result<(), AssignError> {
        self.frame.update(gpu, frame)?;
        let marks = u64::from(count) * self.words;
        if self.marks.size() < marks * 4 {
            self.marks = gpu.storage("cluster marks", marks * 4)?;
        }
        // The kernel clears the whole buffer, which may be that of a larger view.
        self.clear_workgroups = (self.marks.size() / 4).div_ceil(CLEARED).min(MAX_DISPATCH) as u32;
        self.live.prepare(gpu, count)?;
        let texture = |binding, view| wgpu::BindGroupEntry {
            binding,
            resource: wgpu::BindingResource::TextureView(view),
        };
        let mut entries = vec![
            texture(0, images.depth),
            entry(1, &self.marks),
            entry(FIRST_STRATEGY_BINDING, clusters),
        ];
        entries.extend(images.normals.map(|view| texture(2, view)));
        entries.extend(images.base_color.map(|view| texture(3, view)));
        self.bind_group = Some(gpu.device.create_bind_group(&wgpu::BindGroupDescriptor {
            label: Some("gather"),
            layout: &self.layout,
            entries: &entries,
        }));
        self.live_bind_group = Some(gpu.device.create_bind_group(&wgpu::BindGroupDescriptor {
            label: Some("live groups"),
            layout: &self.live_layout,
            entries: &[entry(0, self.live.buffer())],
        }));
        Ok(())
    }

    /// Records the pass `bounds`: inside the clock.
    pub(crate) fn record(&self, view: &View, passes: &mut dyn Passes) {
        passes.compute("bounds", &mut |pass| {
            pass.set_bind_group(0, self.frame.bind_group(), &[]);
            pass.set_bind_group(GATHER_GROUP, self.bind_group.as_ref(), &[]);
            pass.set_bind_group(LIVE_GROUP, self.live_bind_group.as_ref(), &[]);
            pass.set_pipeline(&self.clear);
            pass.dispatch_workgroups(self.clear_workgroups, 1, 1);
            pass.set_pipeline(&self.gather);
            let blocks = |pixels: u32| pixels.div_ceil(BLOCK_PX);
            pass.dispatch_workgroups(blocks(view.viewport.width), blocks(view.viewport.height), 1);
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

    /// Explicit bounds: words of each group, see `gather.wesl`.
    pub(crate) fn marks(&self) -> &wgpu::Buffer {
        &self.marks
    }
}

/// What the pass reads.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Images<'a> {
    pub(crate) depth: &'a wgpu::TextureView,
    /// Where the strategy was made with normals.
    pub(crate) normals: Option<&'a wgpu::TextureView>,
    /// Where it was made with a specular threshold.
    pub(crate) base_color: Option<&'a wgpu::TextureView>,
}

const TEXELS: wgpu::TextureSampleType = wgpu::TextureSampleType::Float { filterable: false };

fn texture_entry(binding: u32, sample_type: wgpu::TextureSampleType) -> wgpu::BindGroupLayoutEntry {
    wgpu::BindGroupLayoutEntry {
        binding,
        visibility: wgpu::ShaderStages::COMPUTE,
        ty: wgpu::BindingType::Texture {
            sample_type,
            view_dimension: wgpu::TextureViewDimension::D2,
            multisampled: false,
        },
        count: None,
    }
}

/// The pass's shader.
fn gather_shader<'a>(
    bounds: Bounds,
    occupancy: Occupancy,
    normals: Normals,
    glossy: bool,
) -> Shader<'a> {
    let strategy = match bounds {
        Bounds::Implicit => IMPLICIT_WESL,
        Bounds::Explicit if glossy => GLOSSY_BINS_WESL,
        Bounds::Explicit if normals.is_some() => BINS_WESL,
        Bounds::Explicit => EXPLICIT_WESL,
    };
    Shader::new(GATHER_GROUP)
        .module("package::gather", include_str!("shaders/gather.wesl"))
        .module("package::live", LiveGroups::WESL)
        .module("package::strategy", strategy)
        .flag("explicit_bounds", bounds == Bounds::Explicit)
        .flag("sparse", occupancy == Occupancy::Sparse)
        .flag("normals", normals.is_some())
        .flag("glossy", glossy)
}

/// The linked WGSL of the pass, for tests of layout and validity.
pub fn gather_source(
    bounds: Bounds,
    occupancy: Occupancy,
    normals: Normals,
    glossy: bool,
) -> Result<String, AssignError> {
    gather_shader(bounds, occupancy, normals, glossy).link("package::gather")
}
