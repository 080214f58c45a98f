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
    pub fn noop() -> Result<Self, AssignError> {
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
    let backends = wgpu::Backends::all() - wgpu::Backends::NOOP;
    let mut descriptor = wgpu::InstanceDescriptor::new_without_display_handle();
    descriptor.backends = backends;
    // GPU-based validation and debug layers would slow every measured pass.
    descriptor.flags = wgpu::InstanceFlags::empty();
    let instance = wgpu::Instance::new(descriptor);
    let mut adapters = pollster::block_on(instance.enumerate_adapters(backends));
    adapters.sort_by_key(|adapter| rank(adapter.get_info().device_type));
    if adapters.is_empty() {
        return Err(AssignError::NoAdapter { looked_for: "looked for Vulkan".into() });
    }
    Ok(adapters)
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
