//! The device. A program opens it once; everything that records passes shares it.

use std::{
    pin::pin,
    sync::Arc,
    task::{Context, Poll, Waker},
};

use crate::{AssignError, Hitches, Mapped, compiled::Compiled, hitches::Counted};

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
    pub(crate) counted: Arc<Counted>,
}

impl Gpu {
    /// Wraps a renderer's own device.
    pub fn new(device: wgpu::Device, queue: wgpu::Queue, info: wgpu::AdapterInfo) -> Self {
        Self { device, queue, info, compiled: Arc::default(), counted: Arc::default() }
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
        Counted::add(&self.counted.waits, 1);
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
        let device = (&self.device, &*self.counted);
        self.compiled.pipeline(device, module, entry_point, layouts, zero_memory)
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
            self.make_buffer(label, bytes.max(16).next_multiple_of(4), usage)
        })
    }

    /// Makes a buffer and counts it. Every buffer of a strategy goes through here.
    pub(crate) fn make_buffer(
        &self,
        label: &str,
        size: u64,
        usage: wgpu::BufferUsages,
    ) -> wgpu::Buffer {
        Counted::add(&self.counted.buffers, 1);
        self.device.create_buffer(&wgpu::BufferDescriptor {
            label: Some(label),
            size,
            usage,
            mapped_at_creation: false,
        })
    }

    /// Makes a bind group and counts it. What is bound in every frame goes through
    /// [`KeptBindGroup`](crate::KeptBindGroup), which makes a group only if what it binds changed.
    pub fn bind_group(
        &self,
        label: &str,
        layout: &wgpu::BindGroupLayout,
        entries: &[wgpu::BindGroupEntry<'_>],
    ) -> wgpu::BindGroup {
        Counted::add(&self.counted.bind_groups, 1);
        self.device.create_bind_group(&wgpu::BindGroupDescriptor {
            label: Some(label),
            layout,
            entries,
        })
    }

    /// Makes a render pipeline and counts it.
    pub fn render_pipeline(
        &self,
        descriptor: &wgpu::RenderPipelineDescriptor<'_>,
    ) -> wgpu::RenderPipeline {
        Counted::add(&self.counted.pipelines, 1);
        self.device.create_render_pipeline(descriptor)
    }

    /// Runs `make`, which allocates about `bytes` on the device. Returns an error if the device has
    /// no memory left.
    pub fn allocate<T>(
        &self,
        what: &str,
        bytes: u64,
        make: impl FnOnce() -> T,
    ) -> Result<T, AssignError> {
        match self.scoped(wgpu::ErrorFilter::OutOfMemory, make) {
            (made, None) => Ok(made),
            (_, Some(_)) => Err(AssignError::OutOfMemory { what: what.into(), bytes }),
        }
    }

    /// Runs `make`, and returns the device's error of a kind if there was one. It never waits.
    ///
    /// Native wgpu knows the error at once. A browser answers in a later frame, so on the web no error is caught here:
    /// it goes to the handler of [`wgpu::Device::on_uncaptured_error`].
    pub(crate) fn scoped<T>(
        &self,
        filter: wgpu::ErrorFilter,
        make: impl FnOnce() -> T,
    ) -> (T, Option<wgpu::Error>) {
        if cfg!(target_arch = "wasm32") {
            return (make(), None);
        }
        let scope = self.device.push_error_scope(filter);
        let made = make();
        let answer = pin!(scope.pop()).poll(&mut Context::from_waker(Waker::noop()));
        match answer {
            Poll::Ready(error) => (made, error),
            Poll::Pending => (made, None),
        }
    }

    /// A uniform buffer of `bytes`.
    pub fn uniform(&self, label: &str, bytes: u64) -> wgpu::Buffer {
        let usage = wgpu::BufferUsages::UNIFORM | wgpu::BufferUsages::COPY_DST;
        self.make_buffer(label, bytes, usage)
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
        let usage = wgpu::BufferUsages::MAP_READ | wgpu::BufferUsages::COPY_DST;
        self.allocate(label, bytes, || self.make_buffer(label, bytes, usage))
    }

    /// Maps a staging buffer after its copy was submitted, and returns its bytes.
    pub fn map(&self, staging: &wgpu::Buffer) -> Result<Vec<u8>, AssignError> {
        let (sender, receiver) = std::sync::mpsc::channel();
        let done = move |result| {
            // The receiver lives until the wait below returns.
            let _ = sender.send(result);
        };
        // A lost device refuses to map.
        let map = || self.counted.map(staging, None, done);
        if let (_, Some(error)) = self.scoped(wgpu::ErrorFilter::Validation, map) {
            return Err(AssignError::Device(error.to_string()));
        }
        self.wait()?;
        receiver
            .recv()
            .map_err(|e| AssignError::Device(e.to_string()))?
            .map_err(|e| AssignError::Device(e.to_string()))?;
        let view = staging.get_mapped_range(..).map_err(|e| AssignError::Device(e.to_string()))?;
        Ok(view.to_vec())
    }

    /// The maps so far, by this device and its clones.
    pub fn mapped(&self) -> Mapped {
        self.counted.mapped()
    }

    /// What was made and waited for so far, by this device and its clones.
    pub fn hitches(&self) -> Hitches {
        self.counted.hitches()
    }
}
