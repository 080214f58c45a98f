//! The shared culling driver: it tests lights against groups and writes ordered lists.
//!
//! A strategy supplies a WESL module with `group_bounds(group)` and `group_of(sample)`, and the
//! resources that the module reads. The driver supplies the kernel (`cull.wesl`), the tests and the
//! lists.

use crate::{
    AreaBounds, AssignError, CullSettings, DepthImage, Facing, Frame, FrameBindings, Gpu,
    GroupShape, Groups, LightKinds, LightLists, LightSource, LightTraits, ListsBindings, Lookup,
    Passes, Shader, Storage, StrategyModule, StrategyWesl,
    entries::{entry, storage_entry},
    touched_groups::{Dispatch, TouchedGroups, touched_shader},
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
    label: String,
    variant: Variant,
    module: StrategyModule,
    kernel: Option<Kernel>,
    frame: FrameBindings,
    cull: ListsBindings,
    look_up: ListsBindings,
    source: Option<Source>,
    lists: LightLists,
    /// Finds the groups to cull in frames with [`Frame::changes`].
    touched: Option<TouchedGroups>,
    /// Whether the prepared frame culls only these.
    is_update: bool,
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
    sparse: bool,
}

/// The kernel's input, and its workgroups.
#[derive(Debug)]
struct Source {
    bind_group: wgpu::BindGroup,
    dispatch: Dispatch,
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
        // What the others leave out of lists, they mark in an entry's flags.
        if !matches!(self.facing, Facing::Unknown | Facing::Horizon)
            && self.settings.storage.is_mask()
        {
            return Err(AssignError::Unsupported {
                strategy: strategy.into(),
                asked: "bit masks with a specular cut".into(),
                reason: "a bit cannot say which terms of a light to leave out".into(),
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
        let reader = module.wesl().reader.of_storage(settings.storage);
        reader.check(gpu, label)?;
        Ok(Self {
            label: label.to_owned(),
            variant,
            module: module.read_by(reader),
            kernel: None,
            frame: FrameBindings::new(gpu),
            cull: ListsBindings::of_kernel(gpu, label, bindings),
            look_up: ListsBindings::of_look_up(gpu, label, bindings),
            source: None,
            lists: LightLists::stored_as(gpu, settings.storage)?,
            touched: None,
            is_update: false,
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
        self.module.wesl().reader.check_lights(gpu, &self.label, frame.lights.count())?;
        self.is_update = frame.changes.is_some();
        if self.is_update {
            self.lists.prepare_update(gpu, frame.lights);
        } else {
            self.lists.prepare(gpu, frame.lights, groups.count())?;
        }
        self.cull.bind(gpu, &self.lists, resources);
        self.look_up.bind(gpu, &self.lists, resources);
        let source = match frame.changes {
            None => self.bind_source(gpu, frame, groups)?,
            Some(changes) => {
                let mut touched = match self.touched.take() {
                    Some(touched) => touched,
                    None => self.compile_touched(gpu)?,
                };
                touched.prepare(gpu, changes, groups)?;
                let live = touched.groups();
                let source =
                    self.bind_source(gpu, frame, Groups::Live { count: groups.count(), live })?;
                self.touched = Some(touched);
                source
            }
        };
        self.source = Some(source);
        let sparse = self.variant.sparse || self.is_update;
        if self.reads_hierarchy() {
            self.hierarchy_bytes = frame.lights.nodes().size();
        }
        let traits = frame.lights.traits();
        let fits = |kernel: &Kernel| kernel.traits == traits && kernel.sparse == sparse;
        if !self.kernel.as_ref().is_some_and(fits) {
            self.kernel = Some(self.compile(gpu, traits, sparse)?);
        }
        self.live_count = frame.lights.live_count().cloned();
        Ok(())
    }

    fn bind_source(
        &self,
        gpu: &Gpu,
        frame: &Frame<'_>,
        groups: Groups<'_>,
    ) -> Result<Source, AssignError> {
        let mut depth = None;
        let mut entries = Vec::new();
        if let Groups::Live { live, .. } = groups {
            entries.push(entry(0, live.buffer()));
        }
        if self.reads_hierarchy() {
            entries.push(entry(1, frame.lights.nodes()));
        }
        if self.module.wesl().finds_bounds_by_lanes() {
            entries.push(depth.insert(frame.depth_image(&self.label)?).entry(2));
        }
        let layout = self.source_layout(gpu, matches!(groups, Groups::Live { .. }));
        let bind_group = gpu.device.create_bind_group(&wgpu::BindGroupDescriptor {
            label: Some("cull source"),
            layout: &layout,
            entries: &entries,
        });
        Ok(Source { bind_group, dispatch: Dispatch::over(groups) })
    }

    /// Layout of the kernel's input: the groups if not all are culled, light nodes if there is a hierarchy, the
    /// depth buffer if lanes find bounds.
    fn source_layout(&self, gpu: &Gpu, sparse: bool) -> wgpu::BindGroupLayout {
        let stages = wgpu::ShaderStages::COMPUTE;
        let mut entries = Vec::new();
        if sparse {
            entries.push(storage_entry(0, stages, true));
        }
        if self.reads_hierarchy() {
            entries.push(storage_entry(1, stages, true));
        }
        if self.module.wesl().finds_bounds_by_lanes() {
            entries.push(DepthImage::layout(2, stages, false));
        }
        gpu.bind_group_layout("cull source", &entries)
    }

    fn compile_touched(&self, gpu: &Gpu) -> Result<TouchedGroups, AssignError> {
        // Changed lights are balls.
        let shader = kernel_shader(self.variant, self.module.wesl(), LightKinds::default().into());
        let layouts = [self.frame.layout(), self.cull.layout()];
        TouchedGroups::new(gpu, shader, layouts, self.variant.sparse)
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

    /// The linked WGSL of the kernels that find the groups touched by changed lights.
    pub fn touched_source<'a>(
        shape: GroupShape,
        settings: CullSettings,
        sparse: bool,
        wesl: impl Into<StrategyWesl<'a>>,
    ) -> Result<String, AssignError> {
        let variant = Variant { shape, settings, sparse, facing: Facing::Unknown };
        touched_shader(kernel_shader(variant, wesl.into(), LightKinds::default().into()))
            .link("package::touched")
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

    fn compile(&self, gpu: &Gpu, traits: LightTraits, sparse: bool) -> Result<Kernel, AssignError> {
        let variant = Variant { sparse, ..self.variant };
        let shader = kernel_shader(variant, self.module.wesl(), traits);
        // SAFETY: every loop of the driver ends. A loop counts up without wrapping to a fixed
        // number, at most a buffer's length; or tests the next of finitely many nodes; or clears
        // one bit of a word per round; or tries to take entries from a pool that only fills up.
        // Such a try fails only because another lane succeeded, or spuriously a few times at most.
        // The strategy's author guarantees the same for its module.
        #[allow(unsafe_code, reason = "its loops end")]
        let module = unsafe { shader.create_uncounted(gpu, "package::cull") }?;
        let source = self.source_layout(gpu, sparse);
        let layouts = [Some(self.frame.layout()), Some(self.cull.layout()), Some(&source)];
        // The kernel writes workgroup memory before it reads it.
        let pipeline = gpu.compute_pipeline(&module, "cull_groups", &layouts, false);
        Ok(Kernel { pipeline, traits, sparse })
    }

    /// Records the pass `cull`, which a clock times, and in frames with [`Frame::changes`] the pass `touch`
    /// before it. Call it after [`prepare`](Self::prepare).
    pub fn record(&mut self, passes: &mut dyn Passes) {
        let (Some(kernel), Some(source)) = (&self.kernel, &self.source) else {
            return;
        };
        let groups = [self.frame.bind_group(), self.cull.bind_group()];
        match &self.touched {
            Some(touched) if self.is_update => {
                self.lists.record_light_count(passes.encoder(), self.live_count.as_ref());
                touched.record(groups, passes);
            }
            _ => self.lists.record_reset(passes.encoder(), self.live_count.as_ref()),
        }
        passes.compute("cull", &mut |pass| {
            pass.set_bind_group(0, groups[0], &[]);
            pass.set_bind_group(LISTS_GROUP, groups[1], &[]);
            pass.set_bind_group(SOURCE_GROUP, &source.bind_group, &[]);
            pass.set_pipeline(&kernel.pipeline);
            source.dispatch.record(pass);
        });
        self.lists.record_readback(passes.encoder());
    }

    /// Whether the driver reads the hierarchy over the lights.
    pub fn reads_hierarchy(&self) -> bool {
        self.variant.settings.source == LightSource::Hierarchy
    }

    /// How shading finds a sample's group.
    pub fn lookup(&self) -> Lookup<'_> {
        // The lanes that cull a group find its bounds, and no buffer keeps them.
        let shape = (!self.module.wesl().finds_bounds_by_lanes()).then_some(self.variant.shape);
        Lookup { module: self.module, layout: self.look_up.layout(), shape }
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
        let touched = self.touched.as_ref().map_or(0, |touched| touched.groups().bytes());
        self.frame.bytes() + self.lists.memory_bytes() + self.hierarchy_bytes + touched
    }
}

fn kernel_shader<'a>(variant: Variant, wesl: StrategyWesl<'a>, lights: LightTraits) -> Shader<'a> {
    let tests = variant.settings.tests;
    let is_hierarchy = variant.settings.source == LightSource::Hierarchy;
    let levels = if is_hierarchy { lights.levels } else { 0 };
    Shader::new(LISTS_GROUP)
        .module("package::cull", include_str!("shaders/cull.wesl"))
        .module("package::walk", include_str!("shaders/walk.wesl"))
        .module("package::tree", include_str!("shaders/tree.wesl"))
        .module("package::terms", include_str!("shaders/terms.wesl"))
        .module("package::facing", include_str!("shaders/facing.wesl"))
        .strategy(wesl)
        .group_bounds(variant.shape)
        .module("package::gloss", include_str!("shaders/gloss.wesl"))
        .module("package::reflected", include_str!("shaders/reflected.wesl"))
        .flag("bounds_by_lanes", wesl.finds_bounds_by_lanes())
        .flag("facing", matches!(variant.facing, Facing::Horizon | Facing::HorizonAndGloss))
        .flag("reflected", variant.facing == Facing::ReflectedCone)
        .flag("where_diffuse", variant.facing == Facing::WhereDiffuse)
        .flag("gloss", variant.facing == Facing::HorizonAndGloss)
        .flag("hs", tests.hs)
        .flag("sat_e", tests.sat_e)
        .flag("sat_n", tests.sat_n)
        .flag("sat_p", tests.sat_p)
        .flag("sat_v", tests.sat_v)
        .flag("rect", variant.settings.screen_rectangle)
        .flag("hierarchy", is_hierarchy)
        .flag("parents", levels > 1)
        .flag("grandparents", levels > 2)
        .flag("area_balls", variant.settings.area_bounds == AreaBounds::Ball)
        .flag("sparse", variant.sparse)
        .flag("masks", variant.settings.storage.is_mask())
        .flag("trees", variant.settings.storage == Storage::Trees)
        .light_kinds(lights.kinds)
}
