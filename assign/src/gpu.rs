//! The device. A program opens it once; everything that records passes shares it.

use std::sync::{
    Arc,
    atomic::{AtomicU64, Ordering},
};

use crate::{AssignError, compiled::Compiled};

/// A device with its queue and the description of its adapter. Clones share the device.
#[derive(Clone, Debug)]
pub struct Gpu {
    /// The device.
    pub device: wgpu::Device,
    /// Its queue.
    pub queue: wgpu::Queue,
    /// Its adapter.
    pub info: wgpu::AdapterInfo,
    pub(crate) compiled: Arc<Compiled>,
    mapped: Arc<MapCounter>,
}

/// How often the CPU mapped buffers to read them.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Mapped {
    /// Number of maps.
    pub maps: u64,
    /// Bytes of all of them.
    pub bytes: u64,
}

#[derive(Debug, Default)]
struct MapCounter {
    maps: AtomicU64,
    bytes: AtomicU64,
}

/// Features that the device uses if the adapter has them: GPU time, blending of light volumes in f32,
/// and operations of the lanes that run in step.
const OPTIONAL_FEATURES: wgpu::Features = wgpu::Features::TIMESTAMP_QUERY
    .union(wgpu::Features::FLOAT32_BLENDABLE)
    .union(wgpu::Features::SUBGROUP);

impl Gpu {
    /// Wraps a renderer's own device.
    pub fn new(device: wgpu::Device, queue: wgpu::Queue, info: wgpu::AdapterInfo) -> Self {
        Self { device, queue, info, compiled: Arc::default(), mapped: Arc::default() }
    }

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

    /// Whether passes run on the CPU. Its timestamps are meaningless.
    pub fn is_software(&self) -> bool {
        self.info.device_type == wgpu::DeviceType::Cpu
    }

    /// Whether shaders may use subgroup operations.
    pub fn has_subgroups(&self) -> bool {
        self.device.features().contains(wgpu::Features::SUBGROUP)
    }

    /// The most loop rounds that one invocation may take in total on this adapter; `None` if there
    /// is no limit.
    ///
    /// llvmpipe silently ends an invocation's loops after 65,535 rounds. With more lights, its
    /// image of no culling is wrong.
    pub fn max_loop_rounds(&self) -> Option<u32> {
        self.info.name.contains("llvmpipe").then_some(65_535)
    }

    /// Blocks until the device has finished all submitted work.
    pub fn wait(&self) -> Result<(), AssignError> {
        self.device
            .poll(wgpu::PollType::wait_indefinitely())
            .map(|_| ())
            .map_err(|e| AssignError::Device(e.to_string()))
    }

    /// The largest storage buffer that a shader can bind, bytes.
    pub fn max_storage_bytes(&self) -> u64 {
        let limits = self.device.limits();
        limits.max_storage_buffer_binding_size.min(limits.max_buffer_size)
    }

    /// The layout of a bind group. Equal entries share one layout.
    pub fn bind_group_layout(
        &self,
        label: &str,
        entries: &[wgpu::BindGroupLayoutEntry],
    ) -> wgpu::BindGroupLayout {
        self.compiled.layout(&self.device, label, entries)
    }

    /// The compute pipeline of an entry point over bind groups 0, 1, and so on. It is compiled once
    /// if `module` comes from [`Shader`](crate::Shader) and the layouts from
    /// [`bind_group_layout`](Self::bind_group_layout). With `zero_memory`, workgroup memory starts
    /// as zero. Kernels that write before they read do not need it.
    pub fn compute_pipeline(
        &self,
        module: &wgpu::ShaderModule,
        entry_point: &str,
        layouts: &[Option<&wgpu::BindGroupLayout>],
        zero_memory: bool,
    ) -> wgpu::ComputePipeline {
        self.compiled.pipeline(&self.device, module, entry_point, layouts, zero_memory)
    }

    /// A storage buffer of `bytes`, at least 16, which can be copied from and to.
    pub fn storage(&self, label: &str, bytes: u64) -> Result<wgpu::Buffer, AssignError> {
        let copies = wgpu::BufferUsages::COPY_SRC | wgpu::BufferUsages::COPY_DST;
        self.buffer(label, bytes, wgpu::BufferUsages::STORAGE | copies)
    }

    /// A buffer of `bytes`, at least 16, for the given uses. Its size is limited to what a shader
    /// can bind as storage.
    pub fn buffer(
        &self,
        label: &str,
        bytes: u64,
        usage: wgpu::BufferUsages,
    ) -> Result<wgpu::Buffer, AssignError> {
        let limit = self.max_storage_bytes();
        if bytes > limit {
            return Err(AssignError::TooLarge { what: label.into(), bytes, limit });
        }
        self.allocate(label, bytes, || {
            self.device.create_buffer(&wgpu::BufferDescriptor {
                label: Some(label),
                size: bytes.max(16).next_multiple_of(4),
                usage,
                mapped_at_creation: false,
            })
        })
    }

    /// Runs `make`, which allocates about `bytes` on the device. Returns an error if the device has
    /// no memory left.
    pub fn allocate<T>(
        &self,
        what: &str,
        bytes: u64,
        make: impl FnOnce() -> T,
    ) -> Result<T, AssignError> {
        let scope = self.device.push_error_scope(wgpu::ErrorFilter::OutOfMemory);
        let made = make();
        match pollster::block_on(scope.pop()) {
            None => Ok(made),
            Some(_) => Err(AssignError::OutOfMemory { what: what.into(), bytes }),
        }
    }

    /// A uniform buffer of `bytes`.
    pub fn uniform(&self, label: &str, bytes: u64) -> wgpu::Buffer {
        self.device.create_buffer(&wgpu::BufferDescriptor {
            label: Some(label),
            size: bytes,
            usage: wgpu::BufferUsages::UNIFORM | wgpu::BufferUsages::COPY_DST,
            mapped_at_creation: false,
        })
    }

    /// Reads `bytes` from the start of a buffer. Blocks until the device has written them.
    pub fn read(&self, buffer: &wgpu::Buffer, bytes: u64) -> Result<Vec<u8>, AssignError> {
        let size = bytes.next_multiple_of(4);
        if size == 0 {
            return Ok(Vec::new());
        }
        let staging = self.staging("read-back", size)?;
        let mut encoder = self.device.create_command_encoder(&Default::default());
        encoder.copy_buffer_to_buffer(buffer, 0, &staging, 0, size);
        self.queue.submit([encoder.finish()]);
        self.map(&staging)
    }

    /// A buffer for copies that [`map`](Self::map) reads.
    pub fn staging(&self, label: &str, bytes: u64) -> Result<wgpu::Buffer, AssignError> {
        self.allocate(label, bytes, || {
            self.device.create_buffer(&wgpu::BufferDescriptor {
                label: Some(label),
                size: bytes,
                usage: wgpu::BufferUsages::MAP_READ | wgpu::BufferUsages::COPY_DST,
                mapped_at_creation: false,
            })
        })
    }

    /// Maps a staging buffer after its copy was submitted, and returns its bytes.
    pub fn map(&self, staging: &wgpu::Buffer) -> Result<Vec<u8>, AssignError> {
        let (sender, receiver) = std::sync::mpsc::channel();
        self.begin_map(staging, move |result| {
            // The receiver lives until the wait below returns.
            let _ = sender.send(result);
        });
        self.wait()?;
        receiver
            .recv()
            .map_err(|e| AssignError::Device(e.to_string()))?
            .map_err(|e| AssignError::Device(e.to_string()))?;
        let view = staging.get_mapped_range(..).map_err(|e| AssignError::Device(e.to_string()))?;
        Ok(view.to_vec())
    }

    /// Begins to map a whole staging buffer for reading, and counts the map. Every map goes through here.
    pub(crate) fn begin_map(
        &self,
        staging: &wgpu::Buffer,
        done: impl FnOnce(Result<(), wgpu::BufferAsyncError>) + Send + 'static,
    ) {
        self.mapped.maps.fetch_add(1, Ordering::Relaxed);
        self.mapped.bytes.fetch_add(staging.size(), Ordering::Relaxed);
        staging.map_async(wgpu::MapMode::Read, .., done);
    }

    /// The maps so far, by this device and its clones.
    pub fn mapped(&self) -> Mapped {
        Mapped {
            maps: self.mapped.maps.load(Ordering::Relaxed),
            bytes: self.mapped.bytes.load(Ordering::Relaxed),
        }
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
