//! The shared culling driver: it tests lights against groups and writes ordered lists.
//!
//! A strategy supplies a WESL module with `group_bounds(group)` and `group_of(sample)`, and the
//! resources that the module reads. The driver supplies the kernel (`cull.wesl`), the tests and the
//! lists.

use crate::{
    AssignError, CullSettings, DepthImage, Facing, Frame, FrameBindings, FrameWrites, Gpu,
    GroupShape, Groups, KeptBindGroup, LightKinds, LightLists, LightSource, LightTraits,
    ListsBindings, Lookup, Passes, StrategyModule,
    cull_kernel::{KernelKey, Kernels, LISTS_GROUP, Variant},
    entries::{UNFILTERED, entry, storage_entry, texture, texture_entry},
    limits::{check_limits, storage_buffer_limits},
    touched_groups::{Dispatch, TouchedGroups},
};

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
    kernels: Kernels,
    /// What the prepared frame runs.
    kernel: Option<wgpu::ComputePipeline>,
    frame: FrameBindings,
    cull: ListsBindings,
    look_up: ListsBindings,
    source: KeptBindGroup,
    /// The same for frames that cull only touched groups.
    touched_source: KeptBindGroup,
    dispatch: Dispatch,
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

impl Culler {
    /// What the driver's kernels need of a device, for a strategy with such read-only resources. A strategy offers it
    /// for its options, so that a renderer can ask for it before it opens a device.
    pub fn required_limits(
        bindings: &[wgpu::BindGroupLayoutEntry],
        sparse: bool,
        settings: CullSettings,
    ) -> wgpu::Limits {
        let is_storage = |entry: &&wgpu::BindGroupLayoutEntry| {
            matches!(
                entry.ty,
                wgpu::BindingType::Buffer { ty: wgpu::BufferBindingType::Storage { .. }, .. }
            )
        };
        let strategy = bindings.iter().filter(is_storage).count() as u32;
        let hierarchy = settings.source == LightSource::Hierarchy;
        // Three for the lights, records and entries.
        let occlusion = settings.occlusion.is_some();
        let optional: u32 = [sparse, hierarchy, occlusion].into_iter().map(u32::from).sum();
        storage_buffer_limits(5 + strategy + optional)
    }

    /// Makes the layouts. [`compile`](Self::compile) makes the pipelines, or else the first frame that needs them.
    ///
    /// # Errors
    ///
    /// [`AssignError::Limit`] on a device with less than the [required limits](Self::required_limits), and
    /// [`AssignError::Unsupported`] for settings that exclude each other.
    pub fn new(gpu: &Gpu, descriptor: &CullerDescriptor<'_>) -> Result<Self, AssignError> {
        let CullerDescriptor { label, shape, settings, sparse, facing, module, bindings } =
            *descriptor;
        let variant = Variant { shape, settings, sparse, facing };
        variant.check(label)?;
        check_limits(gpu, label, &Self::required_limits(bindings, sparse, settings))?;
        let reader = module.wesl().reader.of_storage(settings.storage);
        reader.check(gpu, label)?;
        Ok(Self {
            label: label.to_owned(),
            variant,
            module: module.read_by(reader),
            kernels: Kernels::default(),
            kernel: None,
            frame: FrameBindings::new(gpu),
            cull: ListsBindings::of_kernel(gpu, label, bindings),
            look_up: ListsBindings::of_look_up(gpu, label, bindings),
            source: KeptBindGroup::default(),
            touched_source: KeptBindGroup::default(),
            dispatch: Dispatch::Workgroups(0),
            lists: LightLists::stored_as(gpu, settings.storage)?,
            touched: None,
            is_update: false,
            live_count: None,
            hierarchy_bytes: 0,
        })
    }

    /// Shares the kernels of the same strategy's driver for another view, and takes the limits of its lists.
    pub fn share(&mut self, other: &Self) {
        self.kernels = other.kernels.clone();
        self.lists.limit_as(&other.lists);
    }

    /// Compiles ahead what frames with such lights need. Without it the first such frame compiles, and is late.
    ///
    /// # Errors
    ///
    /// [`AssignError::Shader`] if the strategy's module does not link.
    pub fn compile(&mut self, gpu: &Gpu, traits: LightTraits) -> Result<(), AssignError> {
        let sparse = self.variant.sparse;
        let levels = if self.reads_hierarchy() { traits.levels.max(1) } else { 1 };
        for levels in 1..=levels {
            let traits = LightTraits { levels, ..traits };
            self.find_kernel(gpu, traits, sparse)?;
            if self.lists.leaves_room() {
                self.find_kernel(gpu, traits, true)?;
            }
        }
        if self.lists.leaves_room() && self.touched.is_none() {
            self.touched = Some(self.compile_touched(gpu)?);
        }
        Ok(())
    }

    /// Sizes the lists and binds the strategy's resources. No clock counts it.
    pub fn prepare(
        &mut self,
        gpu: &Gpu,
        frame: &Frame<'_>,
        groups: Groups<'_>,
        resources: &[wgpu::BindGroupEntry<'_>],
    ) -> Result<(), AssignError> {
        self.frame.update_in(gpu, frame, self.lists.writes_mut())?;
        self.module.wesl().reader.check_lights(gpu, &self.label, frame.lights.count())?;
        self.is_update = frame.changes.is_some();
        if self.is_update {
            self.lists.prepare_update(frame.lights)?;
        } else {
            self.lists.prepare(gpu, frame.lights, groups.count())?;
        }
        self.cull.bind(gpu, &self.lists, resources);
        self.look_up.bind(gpu, &self.lists, resources);
        let traits = frame.lights.traits();
        // An update of all lists is as likely as the first frame that makes only some.
        if self.lists.leaves_room() {
            self.compile(gpu, traits)?;
        }
        match frame.changes {
            None => self.bind_source(gpu, frame, groups)?,
            Some(changes) => {
                let mut touched = match self.touched.take() {
                    Some(touched) => touched,
                    None => self.compile_touched(gpu)?,
                };
                touched.prepare(gpu, changes, groups)?;
                let live = touched.groups();
                self.bind_source(gpu, frame, Groups::Live { count: groups.count(), live })?;
                self.touched = Some(touched);
            }
        }
        if self.reads_hierarchy() {
            self.hierarchy_bytes = frame.lights.nodes().size();
        }
        let sparse = self.variant.sparse || self.is_update;
        self.kernel = Some(self.find_kernel(gpu, traits, sparse)?);
        self.live_count = frame.lights.live_count().cloned();
        Ok(())
    }

    fn bind_source(
        &mut self,
        gpu: &Gpu,
        frame: &Frame<'_>,
        groups: Groups<'_>,
    ) -> Result<(), AssignError> {
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
        if self.reads_occluders() {
            let missing = "occluders";
            let occluders = frame
                .occluders
                .ok_or_else(|| AssignError::Missing { strategy: self.label.clone(), missing })?;
            entries.extend([texture(3, occluders.depths), entry(4, occluders.records)]);
        }
        let layout = self.source_layout(gpu, matches!(groups, Groups::Live { .. }));
        let bound = if self.is_update { &mut self.touched_source } else { &mut self.source };
        bound.bind(gpu, "cull source", &layout, &entries);
        self.dispatch = Dispatch::over(groups);
        Ok(())
    }

    /// Layout of the kernel's input: the groups if not all are culled, light nodes if there is a hierarchy, the
    /// depth buffer if lanes find bounds, occluders if lists leave out hidden lights.
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
        if self.reads_occluders() {
            entries.extend([texture_entry(3, stages, UNFILTERED), storage_entry(4, stages, true)]);
        }
        gpu.bind_group_layout("cull source", &entries)
    }

    fn compile_touched(&self, gpu: &Gpu) -> Result<TouchedGroups, AssignError> {
        // Changed lights are balls.
        let shader = self.variant.shader(self.module.wesl(), LightKinds::default().into());
        let layouts = [self.frame.layout(), self.cull.layout()];
        TouchedGroups::new(gpu, shader, layouts, self.variant.sparse)
    }

    /// The kernel for lights of such traits. It is compiled once.
    fn find_kernel(
        &mut self,
        gpu: &Gpu,
        traits: LightTraits,
        sparse: bool,
    ) -> Result<wgpu::ComputePipeline, AssignError> {
        // Without a hierarchy its levels do not matter.
        let levels = if self.reads_hierarchy() { traits.levels } else { 0 };
        let key = KernelKey { kinds: traits.kinds, levels, sparse };
        if let Some(kernel) = self.kernels.find(key) {
            return Ok(kernel);
        }
        let source = self.source_layout(gpu, sparse);
        let layouts = [Some(self.frame.layout()), Some(self.cull.layout()), Some(&source)];
        let variant = Variant { sparse, ..self.variant };
        let kernel = variant.compile(gpu, self.module.wesl(), traits, &layouts)?;
        self.kernels.insert(key, kernel.clone());
        Ok(kernel)
    }

    /// What the strategy uploads for a frame: see [`LightLists::writes_mut`].
    pub fn writes_mut(&mut self) -> &mut FrameWrites {
        self.lists.writes_mut()
    }

    /// Records the frame's writes. A strategy calls it before its own passes, if it has any.
    pub fn record_writes(&mut self, passes: &mut dyn Passes) {
        self.lists.record_writes(passes.encoder());
    }

    /// Records the pass `cull`, which a clock times, and in frames with [`Frame::changes`] the pass `touch`
    /// before it. Call it after [`prepare`](Self::prepare).
    pub fn record(&mut self, passes: &mut dyn Passes) {
        let bound = if self.is_update { &self.touched_source } else { &self.source };
        let (Some(kernel), Some(source)) = (&self.kernel, bound.get()) else { return };
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
            pass.set_bind_group(SOURCE_GROUP, source, &[]);
            pass.set_pipeline(kernel);
            self.dispatch.record(pass);
        });
        self.lists.record_readback(passes.encoder());
    }

    /// Whether the driver reads the hierarchy over the lights.
    pub fn reads_hierarchy(&self) -> bool {
        self.variant.settings.source == LightSource::Hierarchy
    }

    /// Whether lists leave out lights that the frame's occluders hide.
    pub fn reads_occluders(&self) -> bool {
        self.variant.settings.occlusion.is_some()
    }

    /// How shading finds a sample's group.
    pub fn lookup(&self) -> Lookup<'_> {
        // The lanes that cull a group find its bounds, and no buffer keeps them.
        let shape = (!self.module.wesl().finds_bounds_by_lanes()).then_some(self.variant.shape);
        Lookup { module: self.module, bindings: &self.look_up, shape }
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
