//! The sort of up to 2,048 lights in one workgroup: `order/few.wesl`.

use super::kernels::{frame_layout, order_shader};
use crate::{AssignError, Gpu, Shader, kernel::pipeline};

/// The most lights: `MOST` of the shader.
pub(super) const MOST: u32 = 2048;

/// The shader's modules.
pub(super) fn shader() -> Shader<'static> {
    order_shader().module("package::order_few", include_str!("../shaders/order/few.wesl"))
}

/// The pipeline of the sort.
pub(super) fn sort_pipeline(gpu: &Gpu) -> Result<wgpu::ComputePipeline, AssignError> {
    // SAFETY: every loop counts up, doubles a number up to 2,048, or halves one until it is 0.
    #[allow(unsafe_code, reason = "its loops end")]
    let module = unsafe { shader().create_uncounted(gpu, "package::order_few") }?;
    Ok(pipeline(gpu, &module, "sort_few", &[&frame_layout(gpu)]))
}
