//! What a strategy needs of a device, and the check that a device has it.

use crate::{AssignError, Gpu};

/// The limits of kernels with so many storage buffers. All else is what the weakest devices with compute shaders have.
pub fn storage_buffer_limits(storage_buffers: u32) -> wgpu::Limits {
    wgpu::Limits {
        max_storage_buffers_per_shader_stage: storage_buffers,
        // What WebGPU promises.
        max_compute_workgroup_storage_size: 16_384,
        ..wgpu::Limits::downlevel_defaults()
    }
}

/// Checks that a device has the limits that a strategy needs, besides the sizes of buffers: those are checked when a
/// buffer is made. `strategy` is its id.
///
/// # Errors
///
/// [`AssignError::Limit`] with the first limit that is too small.
pub fn check_limits(gpu: &Gpu, strategy: &str, needed: &wgpu::Limits) -> Result<(), AssignError> {
    let has = gpu.device.limits();
    let mut missing = None;
    let needed =
        wgpu::Limits { max_buffer_size: 0, max_storage_buffer_binding_size: 0, ..needed.clone() };
    needed.check_limits_with_fail_fn(&has, true, |limit, needs, has| {
        missing = Some(AssignError::Limit { strategy: strategy.into(), limit, needs, has });
    });
    missing.map_or(Ok(()), Err)
}
