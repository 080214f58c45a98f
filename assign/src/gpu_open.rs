//! Opening a device. A renderer that has one hands it to [`Gpu::new`].
//!
//! Everything here waits for the system. A web page, where nothing may wait, opens its device itself.

use crate::{AssignError, Gpu};

/// Features that the device uses if the adapter has them: GPU time, blending of light volumes in f32,
/// and operations of the lanes that run in step.
const OPTIONAL_FEATURES: wgpu::Features = wgpu::Features::TIMESTAMP_QUERY
    .union(wgpu::Features::FLOAT32_BLENDABLE)
    .union(wgpu::Features::SUBGROUP);

impl Gpu {
    /// Opens the first adapter in this order: discrete, integrated, virtual, software. If `name` is
    /// given, only adapters whose name contains it are considered, ignoring case.
    ///
    /// The device has WebGPU's default limits, buffers as large as the adapter allows, and
    /// timestamp queries if the adapter has them.
    ///
    /// # Errors
    ///
    /// [`AssignError::Parameter`] if the program enables no back end of wgpu,
    /// [`AssignError::NoAdapter`], [`AssignError::UnknownAdapter`] or [`AssignError::NoDevice`].
    pub fn open(name: Option<&str>) -> Result<Self, AssignError> {
        let adapters = enumerate()?;
        let wanted = name.unwrap_or_default().to_lowercase();
        let found = adapters.iter().map(|a| a.get_info().name).collect::<Vec<_>>().join(", ");
        let adapter = adapters
            .iter()
            .find(|a| a.get_info().name.to_lowercase().contains(&wanted))
            .ok_or_else(|| AssignError::UnknownAdapter {
                name: name.unwrap_or_default().to_owned(),
                known: found,
            })?;
        Self::from_adapter(adapter)
    }

    /// Every adapter that can be opened, in the order in which [`open`](Self::open) prefers them.
    pub fn adapters() -> Result<Vec<wgpu::AdapterInfo>, AssignError> {
        Ok(enumerate()?.iter().map(wgpu::Adapter::get_info).collect())
    }

    /// A device of wgpu's noop back end, which checks every call and runs none.
    ///
    /// # Errors
    ///
    /// [`AssignError::Parameter`] if the program does not enable wgpu's feature `noop`.
    pub fn noop() -> Result<Self, AssignError> {
        compiled_back_ends(wgpu::Backends::NOOP, "noop")?;
        let mut descriptor = wgpu::InstanceDescriptor::new_without_display_handle();
        descriptor.backends = wgpu::Backends::NOOP;
        descriptor.backend_options.noop.enable = true;
        let instance = wgpu::Instance::new(descriptor);
        let adapter =
            pollster::block_on(instance.request_adapter(&wgpu::RequestAdapterOptions::default()))
                .map_err(|e| AssignError::NoAdapter { looked_for: format!("noop: {e}") })?;
        Self::from_adapter(&adapter)
    }

    fn from_adapter(adapter: &wgpu::Adapter) -> Result<Self, AssignError> {
        let info = adapter.get_info();
        let available = adapter.limits();
        let limits = wgpu::Limits {
            max_buffer_size: available.max_buffer_size,
            max_storage_buffer_binding_size: available.max_storage_buffer_binding_size,
            max_texture_dimension_2d: available.max_texture_dimension_2d,
            // A G-buffer with every image takes 36 bytes per sample; WebGPU's default is 32.
            max_color_attachment_bytes_per_sample: available.max_color_attachment_bytes_per_sample,
            // Lights and lists take up to six of WebGPU's eight storage buffers.
            max_storage_buffers_per_shader_stage: available
                .max_storage_buffers_per_shader_stage
                .min(16),
            ..wgpu::Limits::default()
        };
        let (device, queue) = pollster::block_on(adapter.request_device(&wgpu::DeviceDescriptor {
            label: Some("lightbench"),
            required_features: adapter.features() & OPTIONAL_FEATURES,
            required_limits: limits,
            ..Default::default()
        }))
        .map_err(|e| AssignError::NoDevice { adapter: info.name.clone(), reason: e.to_string() })?;
        Ok(Self::new(device, queue, info))
    }
}

/// All adapters, fastest kind first; at least one.
fn enumerate() -> Result<Vec<wgpu::Adapter>, AssignError> {
    let any = wgpu::Backends::all() - wgpu::Backends::NOOP;
    let backends = compiled_back_ends(any, "vulkan, metal, dx12 or gles")?;
    let mut descriptor = wgpu::InstanceDescriptor::new_without_display_handle();
    descriptor.backends = backends;
    // GPU-based validation and debug layers would slow every measured pass.
    descriptor.flags = wgpu::InstanceFlags::empty();
    let instance = wgpu::Instance::new(descriptor);
    let mut adapters = pollster::block_on(instance.enumerate_adapters(backends));
    adapters.sort_by_key(|adapter| rank(adapter.get_info().device_type));
    if adapters.is_empty() {
        let names: Vec<&str> = backends.iter_names().map(|(name, _)| name).collect();
        return Err(AssignError::NoAdapter {
            looked_for: format!("looked for {}", names.join(", ")),
        });
    }
    Ok(adapters)
}

/// Those of the wanted back ends that the program is compiled with; at least one. wgpu panics without any.
fn compiled_back_ends(
    wanted: wgpu::Backends,
    features: &str,
) -> Result<wgpu::Backends, AssignError> {
    let compiled = wanted & wgpu::Instance::enabled_backend_features();
    if compiled.is_empty() {
        return Err(AssignError::Parameter {
            field: "back end of wgpu".into(),
            value: "none".into(),
            accepted: format!("{features}, a feature of wgpu that the program enables"),
        });
    }
    Ok(compiled)
}

fn rank(device_type: wgpu::DeviceType) -> u32 {
    match device_type {
        wgpu::DeviceType::DiscreteGpu => 0,
        wgpu::DeviceType::IntegratedGpu => 1,
        wgpu::DeviceType::VirtualGpu => 2,
        wgpu::DeviceType::Other => 3,
        wgpu::DeviceType::Cpu => 4,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_program_without_a_back_end_gets_an_error() {
        let noop = compiled_back_ends(wgpu::Backends::all(), "noop").expect("tests enable noop");
        assert!(noop.contains(wgpu::Backends::NOOP));
        // No native program has it.
        let missing = compiled_back_ends(wgpu::Backends::BROWSER_WEBGPU, "vulkan or metal");
        assert_eq!(
            missing.map_err(|e| e.to_string()),
            Err("back end of wgpu is none: it must be vulkan or metal, a feature of wgpu that the program enables".into())
        );
    }
}
