//! The groups that a changed light touches, which the GPU finds (`touched.wesl`).

use crate::{
    AssignError, Gpu, Groups, KeptBindGroup, LightChanges, LiveGroups, Passes, Shader,
    entries::{entry, storage_entry},
    kernel::{MAX_WORKGROUPS, pipeline},
};

/// The groups that get new lists when only some lights changed.
#[derive(Debug)]
pub(crate) struct TouchedGroups {
    touched: LiveGroups,
    layout: wgpu::BindGroupLayout,
    start: wgpu::ComputePipeline,
    touch: wgpu::ComputePipeline,
    bound: KeptBindGroup,
    dispatch: Dispatch,
}

/// How many workgroups a kernel over groups has.
#[derive(Clone, Debug)]
pub(crate) enum Dispatch {
    /// A number that the CPU knows.
    Workgroups(u32),
    /// As many as the live groups need: [`LiveGroups`].
    Indirect(wgpu::Buffer),
}

impl Dispatch {
    /// One workgroup per group.
    pub(crate) fn over(groups: Groups<'_>) -> Self {
        match groups {
            Groups::All(count) => Self::Workgroups(count.min(MAX_WORKGROUPS)),
            Groups::Live { live, .. } => Self::Indirect(live.buffer().clone()),
        }
    }

    /// Records it.
    pub(crate) fn record(&self, pass: &mut wgpu::ComputePass<'_>) {
        match self {
            Self::Workgroups(count) => pass.dispatch_workgroups(*count, 1, 1),
            Self::Indirect(live) => pass.dispatch_workgroups_indirect(live, 0),
        }
    }
}

impl TouchedGroups {
    /// Compiles the kernels. `shader` is the culling kernel's, for points; `layouts` are those of the frame
    /// and of the lists.
    pub(crate) fn new(
        gpu: &Gpu,
        shader: Shader<'_>,
        layouts: [&wgpu::BindGroupLayout; 2],
        sparse: bool,
    ) -> Result<Self, AssignError> {
        let stages = wgpu::ShaderStages::COMPUTE;
        let mut entries = vec![storage_entry(0, stages, false), storage_entry(1, stages, false)];
        if sparse {
            entries.push(storage_entry(2, stages, true));
        }
        let layout = gpu.bind_group_layout("touched groups", &entries);
        let shader = touched_shader(shader);
        // SAFETY: a loop counts up to the number of groups or of balls by a step of at least one.
        #[allow(unsafe_code, reason = "its loops end")]
        let module = unsafe { shader.create_uncounted(gpu, "package::touched") }?;
        let layouts = [layouts[0], layouts[1], &layout];
        let kernel = |entry_point| pipeline(gpu, &module, entry_point, &layouts);
        Ok(Self {
            touched: LiveGroups::new(gpu)?,
            start: kernel("start_update"),
            touch: kernel("touch_groups"),
            layout,
            bound: KeptBindGroup::default(),
            dispatch: Dispatch::Workgroups(0),
        })
    }

    /// Makes room for all groups and binds what the kernels read.
    pub(crate) fn prepare(
        &mut self,
        gpu: &Gpu,
        changes: &LightChanges,
        groups: Groups<'_>,
    ) -> Result<(), AssignError> {
        self.touched.prepare(gpu, groups.count())?;
        let mut entries = vec![entry(0, self.touched.buffer()), entry(1, changes.buffer())];
        if let Groups::Live { live, .. } = groups {
            entries.push(entry(2, live.buffer()));
        }
        self.bound.bind(gpu, "touched groups", &self.layout, &entries);
        self.dispatch = Dispatch::over(groups);
        Ok(())
    }

    /// Records the pass `touch`. Bind groups 0 and 1 are those of the culling kernel.
    pub(crate) fn record(&self, groups: [Option<&wgpu::BindGroup>; 2], passes: &mut dyn Passes) {
        passes.compute("touch", &mut |pass| {
            pass.set_bind_group(0, groups[0], &[]);
            pass.set_bind_group(1, groups[1], &[]);
            pass.set_bind_group(2, self.bound.get(), &[]);
            pass.set_pipeline(&self.start);
            pass.dispatch_workgroups(1, 1, 1);
            pass.set_pipeline(&self.touch);
            self.dispatch.record(pass);
        });
    }

    /// The touched groups.
    pub(crate) fn groups(&self) -> &LiveGroups {
        &self.touched
    }
}

/// The shader of the kernels, from that of the culling kernel.
pub(crate) fn touched_shader(shader: Shader<'_>) -> Shader<'_> {
    shader
        .module("package::changes", include_str!("shaders/changes.wesl"))
        .module("package::live", LiveGroups::WESL)
        .module("package::touched", include_str!("shaders/touched.wesl"))
}
