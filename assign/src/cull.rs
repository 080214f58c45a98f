//! The shared culling driver: lights against groups, lists in order.
//!
//! A strategy supplies a WESL module with `group_bounds(group)` and `group_of(sample)`, and the
//! resources it reads. The driver supplies the kernel (`cull.wesl`), the tests and the lists.

use crate::{
    AssignError, Frame, FrameBindings, Gpu, LightLists, Lookup, Passes, Shader,
    frame::{entry, storage_entry, uniform_entry},
};

/// Bind group of the lists inside the driver's own kernels.
const LISTS_GROUP: u32 = 1;

/// First binding of a strategy's own resources, in the kernel and in the look-up alike.
pub const FIRST_STRATEGY_BINDING: u32 = 4;

/// Workgroups a dispatch may have along one axis.
const MAX_DISPATCH: u32 = 65_535;

/// The shape of a strategy's groups, and with it the test.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum GroupShape {
    /// A pixel rectangle and a depth range: `bounds_frustum.wesl`.
    Frustum(FrustumTests),
    /// A box along the world's axes: `bounds_box.wesl`.
    Box,
    /// A box along axes of its own: `bounds_oriented_box.wesl`.
    OrientedBox,
}

/// Tests of a light against a frustum; a light must pass all. HS is always on.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct FrustumTests {
    /// The axis from the nearest corner to the light.
    pub sat_n: bool,
}

impl Default for FrustumTests {
    /// HS+SAT-N, the comparison paper's choice (Enhuber 2019, section 4.3.2).
    fn default() -> Self {
        Self { sat_n: true }
    }
}

/// What a strategy hands to [`Culler::new`].
#[derive(Clone, Copy, Debug)]
pub struct CullerDescriptor<'a> {
    /// The strategy's id, for labels and errors.
    pub label: &'a str,
    /// The shape of its groups.
    pub shape: GroupShape,
    /// WESL with `group_bounds(group: u32) -> GroupBounds` and `group_of(sample: ViewSample) -> u32`.
    pub module: &'static str,
    /// Layout of its resources, bindings from [`FIRST_STRATEGY_BINDING`], read-only.
    pub bindings: &'a [wgpu::BindGroupLayoutEntry],
}

/// The driver of one strategy.
#[derive(Debug)]
pub struct Culler {
    label: String,
    shape: GroupShape,
    module: &'static str,
    /// The kernel and whether it was made for spots.
    kernel: Option<(wgpu::ComputePipeline, bool)>,
    reset: Option<wgpu::ComputePipeline>,
    frame: FrameBindings,
    cull: ListsBindings,
    look_up: ListsBindings,
    lists: LightLists,
    /// Workgroups along x and y, one a group.
    dispatch: [u32; 2],
}

impl Culler {
    /// Makes the layouts; pipelines follow at the first [`prepare`](Self::prepare).
    pub fn new(gpu: &Gpu, descriptor: &CullerDescriptor<'_>) -> Result<Self, AssignError> {
        Ok(Self {
            label: descriptor.label.to_owned(),
            shape: descriptor.shape,
            module: descriptor.module,
            kernel: None,
            reset: None,
            frame: FrameBindings::new(gpu),
            cull: ListsBindings::new(cull_layout(gpu, descriptor.label, descriptor.bindings)),
            look_up: ListsBindings::new(lookup_layout(gpu, descriptor.label, descriptor.bindings)),
            lists: LightLists::new(gpu)?,
            dispatch: [0, 0],
        })
    }

    /// Sizes the lists and binds the strategy's resources: outside the clock.
    pub fn prepare(
        &mut self,
        gpu: &Gpu,
        frame: &Frame<'_>,
        group_count: u32,
        resources: &[wgpu::BindGroupEntry<'_>],
    ) -> Result<(), AssignError> {
        self.frame.update(gpu, frame)?;
        let rows = group_count.div_ceil(MAX_DISPATCH);
        self.dispatch = [group_count.div_ceil(rows.max(1)), rows];
        self.lists.prepare(gpu, frame.lights.count(), group_count)?;
        let counters = entry(2, self.lists.counters());
        let uniform = entry(3, self.lists.uniform());
        let kernel_entries = [&[counters, uniform], resources].concat();
        self.cull.bind(gpu, &self.lists, &kernel_entries);
        self.look_up.bind(gpu, &self.lists, resources);
        let spots = frame.lights.has_spots();
        if self.kernel.as_ref().is_none_or(|(_, made_for)| *made_for != spots) {
            self.compile(gpu, spots)?;
        }
        Ok(())
    }

    /// The linked WGSL of the kernel, for a scene with or without spots.
    pub fn kernel_source(
        shape: GroupShape,
        module: &str,
        spots: bool,
    ) -> Result<String, AssignError> {
        kernel_shader(shape, module, spots).link("package::cull")
    }

    fn compile(&mut self, gpu: &Gpu, spots: bool) -> Result<(), AssignError> {
        let module =
            kernel_shader(self.shape, self.module, spots).create(&gpu.device, "package::cull")?;
        let layout = gpu.device.create_pipeline_layout(&wgpu::PipelineLayoutDescriptor {
            label: Some(&self.label),
            bind_group_layouts: &[Some(self.frame.layout()), Some(self.cull.layout())],
            immediate_size: 0,
        });
        let pipeline = |entry_point| {
            gpu.device.create_compute_pipeline(&wgpu::ComputePipelineDescriptor {
                label: Some(&self.label),
                layout: Some(&layout),
                module: &module,
                entry_point: Some(entry_point),
                compilation_options: wgpu::PipelineCompilationOptions {
                    // The kernel writes what it reads.
                    zero_initialize_workgroup_memory: false,
                    ..Default::default()
                },
                cache: None,
            })
        };
        self.kernel = Some((pipeline("cull_groups"), spots));
        self.reset = Some(pipeline("reset"));
        Ok(())
    }

    /// Records the pass `cull`: inside the clock, after [`prepare`](Self::prepare).
    pub fn record(&mut self, passes: &mut dyn Passes) {
        let (Some((kernel, _)), Some(reset)) = (&self.kernel, &self.reset) else {
            return;
        };
        passes.compute("cull", &mut |pass| {
            pass.set_bind_group(0, self.frame.bind_group(), &[]);
            pass.set_bind_group(LISTS_GROUP, self.cull.bind_group(), &[]);
            pass.set_pipeline(reset);
            pass.dispatch_workgroups(1, 1, 1);
            pass.set_pipeline(kernel);
            pass.dispatch_workgroups(self.dispatch[0], self.dispatch[1], 1);
        });
        self.lists.record_readback(passes.encoder());
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

    /// The lists, to limit their pool.
    pub fn lists_mut(&mut self) -> &mut LightLists {
        &mut self.lists
    }
}

fn kernel_shader<'a>(shape: GroupShape, module: &'a str, spots: bool) -> Shader<'a> {
    let (bounds, sat_n) = match shape {
        GroupShape::Frustum(tests) => (include_str!("shaders/bounds_frustum.wesl"), tests.sat_n),
        GroupShape::Box => (include_str!("shaders/bounds_box.wesl"), false),
        GroupShape::OrientedBox => (include_str!("shaders/bounds_oriented_box.wesl"), false),
    };
    Shader::new(LISTS_GROUP)
        .module("package::cull", include_str!("shaders/cull.wesl"))
        .module("package::bounds", bounds)
        .module("package::strategy", module)
        .flag("sat_n", sat_n)
        .flag("spots", spots)
}

/// Lists and a strategy's resources in one bind group.
#[derive(Debug)]
pub(crate) struct ListsBindings {
    layout: wgpu::BindGroupLayout,
    bind_group: Option<wgpu::BindGroup>,
}

impl ListsBindings {
    pub(crate) fn new(layout: wgpu::BindGroupLayout) -> Self {
        Self { layout, bind_group: None }
    }

    pub(crate) fn bind(
        &mut self,
        gpu: &Gpu,
        lists: &LightLists,
        resources: &[wgpu::BindGroupEntry<'_>],
    ) {
        let both = [entry(0, lists.lists()), entry(1, lists.entries())];
        self.bind_group = Some(gpu.device.create_bind_group(&wgpu::BindGroupDescriptor {
            label: Some("lists"),
            layout: &self.layout,
            entries: &[&both, resources].concat(),
        }));
    }

    pub(crate) fn layout(&self) -> &wgpu::BindGroupLayout {
        &self.layout
    }

    pub(crate) fn bind_group(&self) -> Option<&wgpu::BindGroup> {
        self.bind_group.as_ref()
    }
}

/// Layout of the look-up: lists and entries, then the strategy's resources.
pub(crate) fn lookup_layout(
    gpu: &Gpu,
    label: &str,
    bindings: &[wgpu::BindGroupLayoutEntry],
) -> wgpu::BindGroupLayout {
    let stages = wgpu::ShaderStages::COMPUTE | wgpu::ShaderStages::FRAGMENT;
    let both = [storage_entry(0, stages, true), storage_entry(1, stages, true)];
    gpu.device.create_bind_group_layout(&wgpu::BindGroupLayoutDescriptor {
        label: Some(label),
        entries: &[&both, bindings].concat(),
    })
}

/// Layout of the kernel: lists, entries, counters, parameters, then the strategy's resources.
fn cull_layout(
    gpu: &Gpu,
    label: &str,
    bindings: &[wgpu::BindGroupLayoutEntry],
) -> wgpu::BindGroupLayout {
    let stages = wgpu::ShaderStages::COMPUTE;
    let own = [
        storage_entry(0, stages, false),
        storage_entry(1, stages, false),
        storage_entry(2, stages, false),
        uniform_entry(3, stages),
    ];
    gpu.device.create_bind_group_layout(&wgpu::BindGroupLayoutDescriptor {
        label: Some(label),
        entries: &[&own, bindings].concat(),
    })
}
