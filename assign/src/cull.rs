//! The shared culling driver: it tests lights against groups and writes ordered lists.
//!
//! A strategy supplies a WESL module with `group_bounds(group)` and `group_of(sample)`, and the
//! resources that the module reads. The driver supplies the kernel (`cull.wesl`), the tests and the
//! lists.

use crate::{
    AreaBounds, AssignError, CullSettings, Facing, Frame, FrameBindings, Gpu, GroupShape, Groups,
    LightLists, LightSource, LightTraits, ListsBindings, Lookup, Passes, Shader, StrategyModule,
    StrategyWesl,
    entries::{entry, storage_entry},
    kernel::MAX_WORKGROUPS,
};

/// Bind group of the lists inside the driver's own kernels.
const LISTS_GROUP: u32 = 1;

/// Bind group of the kernel's input: live groups and light nodes.
const SOURCE_GROUP: u32 = 2;

/// What a strategy hands to [`Culler::new`].
#[derive(Clone, Copy, Debug)]
pub struct CullerDescriptor<'a> {
    /// The strategy's id, for labels and errors.
    pub label: &'a str,
    /// The shape of its groups.
    pub shape: GroupShape,
    /// The user's settings.
    pub settings: CullSettings,
    /// Whether only [`Groups::Live`] get a list.
    pub sparse: bool,
    /// What the strategy knows about the directions in which its groups' surfaces face.
    pub facing: Facing,
    /// WESL with `group_bounds(group: u32) -> GroupBounds` and `group_of(sample: ViewSample) -> u32`.
    pub module: StrategyModule,
    /// Layout of the strategy's read-only resources. Bindings start at
    /// [`FIRST_STRATEGY_BINDING`](crate::FIRST_STRATEGY_BINDING).
    pub bindings: &'a [wgpu::BindGroupLayoutEntry],
}

/// The driver of one strategy.
#[derive(Debug)]
pub struct Culler {
    variant: Variant,
    module: StrategyModule,
    kernel: Option<Kernel>,
    frame: FrameBindings,
    cull: ListsBindings,
    look_up: ListsBindings,
    source_layout: wgpu::BindGroupLayout,
    source: Option<wgpu::BindGroup>,
    lists: LightLists,
    dispatch: Dispatch,
    /// The number of lights, if only the GPU knows it.
    live_count: Option<wgpu::Buffer>,
    /// Bytes of the light hierarchy, if the driver uses it.
    hierarchy_bytes: u64,
}

/// What the kernel is compiled for, besides the kinds of lights.
#[derive(Clone, Copy, Debug)]
struct Variant {
    shape: GroupShape,
    settings: CullSettings,
    sparse: bool,
    facing: Facing,
}

#[derive(Debug)]
struct Kernel {
    pipeline: wgpu::ComputePipeline,
    traits: LightTraits,
}

#[derive(Debug)]
enum Dispatch {
    Workgroups(u32),
    Indirect(wgpu::Buffer),
}

impl Variant {
    fn check(self, strategy: &str) -> Result<(), AssignError> {
        if self.facing != Facing::Unknown && self.shape != GroupShape::Box {
            return Err(AssignError::Unsupported {
                strategy: strategy.into(),
                asked: format!("facing {:?} with groups of shape {:?}", self.facing, self.shape),
                reason: "only groups of shape Box can know normals".into(),
            });
        }
        Ok(())
    }
}

impl Culler {
    /// Makes the layouts. The first `prepare` makes the pipelines: see [`prepare`](Self::prepare).
    pub fn new(gpu: &Gpu, descriptor: &CullerDescriptor<'_>) -> Result<Self, AssignError> {
        let CullerDescriptor { label, shape, settings, sparse, facing, module, bindings } =
            *descriptor;
        let variant = Variant { shape, settings, sparse, facing };
        variant.check(label)?;
        Ok(Self {
            variant,
            module,
            kernel: None,
            frame: FrameBindings::new(gpu),
            cull: ListsBindings::of_kernel(gpu, label, bindings),
            look_up: ListsBindings::of_look_up(gpu, label, bindings),
            source_layout: source_layout(gpu, variant),
            source: None,
            lists: LightLists::new(gpu)?,
            dispatch: Dispatch::Workgroups(0),
            live_count: None,
            hierarchy_bytes: 0,
        })
    }

    /// Sizes the lists and binds the strategy's resources. No clock counts it.
    pub fn prepare(
        &mut self,
        gpu: &Gpu,
        frame: &Frame<'_>,
        groups: Groups<'_>,
        resources: &[wgpu::BindGroupEntry<'_>],
    ) -> Result<(), AssignError> {
        self.frame.update(gpu, frame)?;
        self.lists.prepare(gpu, frame.lights, groups.count())?;
        self.cull.bind(gpu, &self.lists, resources);
        self.look_up.bind(gpu, &self.lists, resources);
        self.bind_source(gpu, frame, groups);
        let traits = frame.lights.traits();
        if self.kernel.as_ref().is_none_or(|kernel| kernel.traits != traits) {
            self.kernel = Some(self.compile(gpu, traits)?);
        }
        self.live_count = frame.lights.live_count().cloned();
        Ok(())
    }

    fn bind_source(&mut self, gpu: &Gpu, frame: &Frame<'_>, groups: Groups<'_>) {
        let mut entries = Vec::new();
        self.dispatch = match groups {
            Groups::All(count) => Dispatch::Workgroups(count.min(MAX_WORKGROUPS)),
            Groups::Live { live, .. } => {
                entries.push(entry(0, live.buffer()));
                Dispatch::Indirect(live.buffer().clone())
            }
        };
        if self.reads_hierarchy() {
            entries.push(entry(1, frame.lights.nodes()));
            self.hierarchy_bytes = frame.lights.nodes().size();
        }
        self.source = Some(gpu.device.create_bind_group(&wgpu::BindGroupDescriptor {
            label: Some("cull source"),
            layout: &self.source_layout,
            entries: &entries,
        }));
    }

    /// The kernel's linked WGSL for a scene with such lights.
    pub fn kernel_source<'a>(
        shape: GroupShape,
        settings: CullSettings,
        sparse: bool,
        wesl: impl Into<StrategyWesl<'a>>,
        lights: impl Into<LightTraits>,
    ) -> Result<String, AssignError> {
        let variant = Variant { shape, settings, sparse, facing: Facing::Unknown };
        kernel_shader(variant, wesl.into(), lights.into()).link("package::cull")
    }

    /// The kernel's linked WGSL for live groups that are boxes and know how their surfaces face.
    pub fn facing_kernel_source<'a>(
        settings: CullSettings,
        facing: Facing,
        wesl: impl Into<StrategyWesl<'a>>,
        lights: impl Into<LightTraits>,
    ) -> Result<String, AssignError> {
        let variant = Variant { shape: GroupShape::Box, settings, sparse: true, facing };
        kernel_shader(variant, wesl.into(), lights.into()).link("package::cull")
    }

    fn compile(&self, gpu: &Gpu, traits: LightTraits) -> Result<Kernel, AssignError> {
        let shader = kernel_shader(self.variant, self.module.wesl(), traits);
        // SAFETY: every loop of the driver ends. A loop counts up without wrapping to a fixed
        // number, at most a buffer's length; or tests the next of finitely many nodes; or clears
        // one bit of a word per round; or tries to take entries from a pool that only fills up.
        // Such a try fails only because another lane succeeded, or spuriously a few times at most.
        // The strategy's author guarantees the same for its module.
        #[allow(unsafe_code, reason = "its loops end")]
        let module = unsafe { shader.create_uncounted(gpu, "package::cull") }?;
        let layouts =
            [Some(self.frame.layout()), Some(self.cull.layout()), Some(&self.source_layout)];
        // The kernel writes workgroup memory before it reads it.
        let pipeline = gpu.compute_pipeline(&module, "cull_groups", &layouts, false);
        Ok(Kernel { pipeline, traits })
    }

    /// Records the pass `cull`, which a clock times. Call it after [`prepare`](Self::prepare).
    pub fn record(&mut self, passes: &mut dyn Passes) {
        let Some(kernel) = &self.kernel else {
            return;
        };
        self.lists.record_reset(passes.encoder(), self.live_count.as_ref());
        passes.compute("cull", &mut |pass| {
            pass.set_bind_group(0, self.frame.bind_group(), &[]);
            pass.set_bind_group(LISTS_GROUP, self.cull.bind_group(), &[]);
            pass.set_bind_group(SOURCE_GROUP, self.source.as_ref(), &[]);
            pass.set_pipeline(&kernel.pipeline);
            match &self.dispatch {
                Dispatch::Workgroups(count) => pass.dispatch_workgroups(*count, 1, 1),
                Dispatch::Indirect(live) => pass.dispatch_workgroups_indirect(live, 0),
            }
        });
        self.lists.record_readback(passes.encoder());
    }

    /// Whether the driver reads the hierarchy over the lights.
    pub fn reads_hierarchy(&self) -> bool {
        self.variant.settings.source == LightSource::Hierarchy
    }

    /// How shading finds a sample's group.
    pub fn lookup(&self) -> Lookup<'_> {
        Lookup { module: self.module, layout: self.look_up.layout() }
    }

    /// The look-up's bind group; `None` before the first [`prepare`](Self::prepare).
    pub fn bind_group(&self) -> Option<&wgpu::BindGroup> {
        self.look_up.bind_group()
    }

    /// The lists.
    pub fn lists(&self) -> &LightLists {
        &self.lists
    }

    /// The lists, so that a caller can limit their pool.
    pub fn lists_mut(&mut self) -> &mut LightLists {
        &mut self.lists
    }

    /// Bytes of the driver's buffers, and of the light hierarchy if the driver uses it. The
    /// strategy's own resources are not included. See
    /// [`Assignment::memory_bytes`](crate::Assignment::memory_bytes).
    pub fn memory_bytes(&self) -> u64 {
        self.frame.bytes() + self.lists.memory_bytes() + self.hierarchy_bytes
    }
}

fn kernel_shader<'a>(variant: Variant, wesl: StrategyWesl<'a>, lights: LightTraits) -> Shader<'a> {
    let bounds = match variant.shape {
        GroupShape::Frustum => include_str!("shaders/bounds_frustum.wesl"),
        GroupShape::Box => include_str!("shaders/bounds_box.wesl"),
        GroupShape::OrientedBox => include_str!("shaders/bounds_oriented_box.wesl"),
    };
    let tests = variant.settings.tests;
    let is_hierarchy = variant.settings.source == LightSource::Hierarchy;
    let levels = if is_hierarchy { lights.levels } else { 0 };
    Shader::new(LISTS_GROUP)
        .module("package::cull", include_str!("shaders/cull.wesl"))
        .module("package::walk", include_str!("shaders/walk.wesl"))
        .module("package::terms", include_str!("shaders/terms.wesl"))
        .module("package::bounds", bounds)
        .module("package::facing", include_str!("shaders/facing.wesl"))
        .strategy(wesl)
        .module("package::gloss", include_str!("shaders/gloss.wesl"))
        .module("package::reflected", include_str!("shaders/reflected.wesl"))
        .flag("facing", matches!(variant.facing, Facing::Horizon | Facing::HorizonAndGloss))
        .flag("reflected", variant.facing == Facing::ReflectedCone)
        .flag("where_diffuse", variant.facing == Facing::WhereDiffuse)
        .flag("gloss", variant.facing == Facing::HorizonAndGloss)
        .flag("hs", tests.hs)
        .flag("sat_e", tests.sat_e)
        .flag("sat_n", tests.sat_n)
        .flag("sat_p", tests.sat_p)
        .flag("sat_v", tests.sat_v)
        .flag("hierarchy", is_hierarchy)
        .flag("parents", levels > 1)
        .flag("grandparents", levels > 2)
        .flag("area_balls", variant.settings.area_bounds == AreaBounds::Ball)
        .flag("sparse", variant.sparse)
        .light_kinds(lights.kinds)
}

/// Layout of the kernel's input: live groups if sparse, light nodes if there is a hierarchy.
fn source_layout(gpu: &Gpu, variant: Variant) -> wgpu::BindGroupLayout {
    let stages = wgpu::ShaderStages::COMPUTE;
    let mut entries = Vec::new();
    if variant.sparse {
        entries.push(storage_entry(0, stages, true));
    }
    if variant.settings.source == LightSource::Hierarchy {
        entries.push(storage_entry(1, stages, true));
    }
    gpu.bind_group_layout("cull source", &entries)
}
