//! What the kernels of the order share, and those that copy lights to their slots and box them.

use crate::{
    AssignError, Gpu, LightKinds, Shader,
    kernel::{Slot, layout, pipeline},
};

/// Lanes of a workgroup.
pub(super) const LANES: u32 = 256;

/// The layout of bind group 0: the parameters, the given lights, the state and the order.
pub(super) fn frame_layout(gpu: &Gpu) -> wgpu::BindGroupLayout {
    let slots = [Slot::Uniform, Slot::Read, Slot::Read, Slot::Read, Slot::Write, Slot::Write];
    layout(gpu, "light order", wgpu::ShaderStages::COMPUTE, &slots)
}

/// The modules that the kernels share.
pub(super) fn order_shader() -> Shader<'static> {
    Shader::new(1).module("package::order_frame", include_str!("../shaders/order/frame.wesl"))
}

/// The shader of the boxes.
fn boxes_shader(kinds: LightKinds, is_wide: bool) -> Shader<'static> {
    order_shader()
        .module("package::order_fault", include_str!("../shaders/order/fault.wesl"))
        .module("package::order_boxes", include_str!("../shaders/order/boxes.wesl"))
        .flag("wide", is_wide)
        .light_kinds(kinds)
}

/// The pipelines of the pass `boxes` for some kinds of lights.
#[derive(Clone, Debug)]
pub(crate) struct BoxKernels {
    pub(crate) kinds: LightKinds,
    pub(super) is_wide: bool,
    /// Layout of bind group 1: ordered spheres and emissions, and nodes.
    pub(super) layout: wgpu::BindGroupLayout,
    pub(super) lights: wgpu::ComputePipeline,
    pub(super) parents: wgpu::ComputePipeline,
    pub(super) grandparents: wgpu::ComputePipeline,
}

impl BoxKernels {
    /// Kernels that copy given lights to their slots.
    pub(crate) fn in_order(gpu: &Gpu, kinds: LightKinds) -> Result<Self, AssignError> {
        Self::new(gpu, kinds, false)
    }

    /// Kernels that copy lights from slot to slot with larger balls.
    pub(crate) fn wide(gpu: &Gpu) -> Result<Self, AssignError> {
        Self::new(gpu, LightKinds::default(), true)
    }

    fn new(gpu: &Gpu, kinds: LightKinds, is_wide: bool) -> Result<Self, AssignError> {
        let slots = [Slot::Write; 3];
        let layout = layout(gpu, "light boxes", wgpu::ShaderStages::COMPUTE, &slots);
        let shader = boxes_shader(kinds, is_wide);
        // SAFETY: every loop counts up in steps of at least one, or halves a number until it is 0.
        #[allow(unsafe_code, reason = "its loops end")]
        let module = unsafe { shader.create_uncounted(gpu, "package::order_boxes") }?;
        let layouts = [&frame_layout(gpu), &layout];
        let entry = |entry_point| pipeline(gpu, &module, entry_point, &layouts);
        Ok(Self {
            kinds,
            is_wide,
            lights: entry("box_lights"),
            parents: entry("box_parents"),
            grandparents: entry("box_grandparents"),
            layout,
        })
    }
}
