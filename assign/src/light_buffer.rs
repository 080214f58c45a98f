//! Lights on the GPU: the sound lights in order, the hierarchy over them, and the faulty lights
//! that were omitted.

mod decode;
mod extent;
mod given;
mod gpu_lights;
mod living;
mod recorded;
mod travel;
mod wide;

#[cfg(feature = "build-time")]
use std::time::{Duration, Instant};

use bytemuck::cast_slice;

use crate::{
    AssignError, Gpu, Light, LightKinds, LightOrder, LightTraits, Passes, events,
    light_nodes::{LightNode, NodeLevels, nodes},
};
pub(crate) use given::Records;
use given::{Given, check_count};
pub use given::{MAX_LIGHTS, RejectedLight};
pub use gpu_lights::GpuLights;
use living::Living;
pub use living::SlotCounts;
pub(crate) use recorded::FrameLights;
pub use travel::Travel;
use wide::WideLights;

/// A frame's lights on the GPU: spheres and the hierarchy for culling, emissions and shapes for shading.
///
/// The buffer omits faulty lights and lights of intensity 0, unless it [keeps indices](Self::keep_indices), and sorts the
/// others by its [`LightOrder`]. A light's index is its place in that order, its *slot*.
///
/// - For lights that stand still, [`ordered`](Self::ordered) sorts them on the CPU, once.
/// - For lights that move, [`LightOrder::Gpu`] sorts and boxes them on the GPU. Call [`update`](Self::update) with each
///   frame's lights, and [`record`](Self::record) before all passes that read the lights.
/// - For lights that the renderer's own kernel writes, [`from_gpu`](Self::from_gpu) takes its buffers. Call
///   [`update_from_gpu`](Self::update_from_gpu) and `record` in each frame. No light crosses to the CPU.
#[derive(Debug)]
pub struct LightBuffer {
    order: LightOrder,
    given: Given,
    spheres: wgpu::Buffer,
    emissions: wgpu::Buffer,
    shapes: wgpu::Buffer,
    nodes: wgpu::Buffer,
    #[cfg(feature = "build-time")]
    build_time: Duration,
    keeps_indices: bool,
    living: Option<Living>,
    wide: Option<WideLights>,
    travel: Travel,
    /// Number of orders so far, for the orders of the CPU.
    generation: u32,
}

impl LightBuffer {
    /// Uploads `lights` in the order of the slice. Omits the lights that [`Light::check`] rejects.
    pub fn new(gpu: &Gpu, lights: &[Light]) -> Result<Self, AssignError> {
        Self::ordered(gpu, lights, LightOrder::Given)
    }

    /// Uploads `lights` sorted by `order`. Omits the lights that [`Light::check`] rejects.
    pub fn ordered(gpu: &Gpu, lights: &[Light], order: LightOrder) -> Result<Self, AssignError> {
        let mut buffer = Self::empty(gpu, order)?;
        buffer.update(gpu, lights)?;
        Ok(buffer)
    }

    /// Lights that the renderer's own kernel writes. The GPU sorts them in every `every`th frame.
    ///
    /// # Errors
    ///
    /// As [`update_from_gpu`](Self::update_from_gpu), and [`AssignError::Parameter`] if `every` is 0.
    pub fn from_gpu(gpu: &Gpu, lights: &GpuLights<'_>, every: u32) -> Result<Self, AssignError> {
        let mut buffer = Self::empty(gpu, LightOrder::Gpu { every })?;
        buffer.update_from_gpu(gpu, lights)?;
        Ok(buffer)
    }

    fn empty(gpu: &Gpu, order: LightOrder) -> Result<Self, AssignError> {
        let living = Living::new(order)?;
        Ok(Self {
            order,
            given: Given::default(),
            spheres: gpu.storage("light spheres", 0)?,
            emissions: gpu.storage("light emissions", 0)?,
            shapes: gpu.storage("light shapes", 0)?,
            nodes: gpu.storage("light nodes", size_of::<LightNode>() as u64)?,
            #[cfg(feature = "build-time")]
            build_time: Duration::ZERO,
            keeps_indices: false,
            living,
            wide: None,
            travel: Travel::default(),
            generation: 0,
        })
    }

    /// Whether later [updates](Self::update) keep a place for every light of the renderer's list. Lights that are faulty
    /// or of intensity 0 then stay as lights of intensity 0 that reach a millionth of a metre, and [`lights`](Self::lights)
    /// has as many lights as the renderer's list, in its order unless this buffer has another. So a light's index in the
    /// renderer's own arrays, such as those of shadow maps, is [`given_index`](Self::given_index) of its slot, and with
    /// [`LightOrder::Given`] it is the slot itself. Without it the buffer omits these lights, and later lights move up.
    /// Either way [`rejected`](Self::rejected) names the faulty ones.
    pub fn keep_indices(&mut self, keep: bool) {
        self.keeps_indices = keep;
    }

    /// Compiles ahead what later updates with such lights need, if the GPU sorts them.
    ///
    /// # Errors
    ///
    /// [`AssignError::Shader`] if a kernel does not link.
    pub fn compile(&mut self, gpu: &Gpu, kinds: LightKinds) -> Result<(), AssignError> {
        match &mut self.living {
            Some(living) => living.compile_ahead(gpu, kinds),
            None => Ok(()),
        }
    }

    /// Replaces the lights, once per frame at most. Buffers grow as needed, so bind groups that hold
    /// them must be made again, as [`FrameBindings`](crate::FrameBindings) does. With
    /// [`LightOrder::Gpu`] it uploads only what changed. After an error, the old lights stay.
    pub fn update(&mut self, gpu: &Gpu, lights: &[Light]) -> Result<(), AssignError> {
        check_count(lights.len())?;
        let mut given = Given::new(lights, self.keeps_indices);
        events::rejected(&self.given.rejected, &given.rejected);
        if let Some(living) = &mut self.living {
            // After an error it only counts too much.
            self.travel.add(self.given.step_to(&given));
            living.update(gpu, &given, self.travel)?;
            self.given = given;
            self.take_living();
            return Ok(());
        }
        #[cfg(feature = "build-time")]
        let began = Instant::now();
        if self.order != LightOrder::Given {
            given.reorder(&self.order.indices(&given.lights));
        }
        let nodes = nodes(&given.lights);
        #[cfg(feature = "build-time")]
        let build_time = began.elapsed();
        let records = Records::new(&given.lights);
        // Makes all buffers before it changes any field, so that the old lights stay whole after an
        // error.
        let [sphere_bytes, emission_bytes, shape_bytes] = records.bytes();
        let node_bytes: &[u8] = cast_slice(&nodes);
        let larger = [
            fitting(gpu, &self.spheres, "light spheres", sphere_bytes)?,
            fitting(gpu, &self.emissions, "light emissions", emission_bytes)?,
            fitting(gpu, &self.shapes, "light shapes", shape_bytes)?,
            fitting(gpu, &self.nodes, "light nodes", node_bytes)?,
        ];
        [self.spheres, self.emissions, self.shapes, self.nodes] = larger;
        gpu.queue.write_buffer(&self.spheres, 0, sphere_bytes);
        gpu.queue.write_buffer(&self.emissions, 0, emission_bytes);
        gpu.queue.write_buffer(&self.shapes, 0, shape_bytes);
        gpu.queue.write_buffer(&self.nodes, 0, node_bytes);
        if self.given.indices != given.indices {
            self.generation = self.generation.wrapping_add(1);
        }
        self.travel.add(self.given.step_to(&given));
        self.given = given;
        #[cfg(feature = "build-time")]
        {
            self.build_time = build_time;
        }
        Ok(())
    }

    /// Takes the next frame's lights from the renderer's own buffers.
    ///
    /// # Errors
    ///
    /// [`AssignError::Parameter`] if a buffer is too small for the capacity, larger than the device
    /// can bind, no multiple of 4 bytes, or lacks the usage `STORAGE` (the count: `COPY_SRC`), or if
    /// the box or the largest radius is out of its range; and if this buffer was not made with
    /// [`LightOrder::Gpu`].
    pub fn update_from_gpu(
        &mut self,
        gpu: &Gpu,
        lights: &GpuLights<'_>,
    ) -> Result<(), AssignError> {
        let Some(living) = &mut self.living else {
            return Err(AssignError::Parameter {
                field: "light order".into(),
                value: self.order.to_string(),
                accepted: "gpu or gpuN, for lights in the renderer's own buffers".into(),
            });
        };
        self.travel.add(lights.step_m());
        living.update_from_gpu(gpu, lights, self.travel)?;
        self.given = Given { kinds: lights.kinds, ..Given::default() };
        self.take_living();
        Ok(())
    }

    /// Uses the living lights' buffers as this buffer's.
    fn take_living(&mut self) {
        let Some((sorter, shapes)) = self.living.as_ref().and_then(Living::buffers) else { return };
        let [spheres, emissions, nodes] = sorter.ordered();
        self.spheres = spheres.clone();
        self.emissions = emissions.clone();
        self.nodes = nodes.clone();
        self.shapes = shapes.clone();
    }

    /// Has the next frame sort the lights, whatever the age of their order.
    pub fn expire_order(&mut self) {
        if let Some(living) = &mut self.living {
            living.expire();
        }
    }

    /// Records the passes `order`, if the frame sorts the lights, and `boxes` of
    /// [`LightOrder::Gpu`]; nothing for other orders.
    ///
    /// Call it in each frame with new lights, whatever the strategy [needs](crate::Needs): `boxes`
    /// also copies the lights to the buffers that every strategy and shading read. Without it, these
    /// buffers keep the lights of an earlier frame.
    ///
    /// - Record it outside of any other pass, because it also copies and clears buffers.
    /// - Record it after [`update`](Self::update) or [`update_from_gpu`](Self::update_from_gpu), into an encoder that is
    ///   submitted before the next update. Updates write through the queue, so each takes effect at the start of the next
    ///   submission, and of two updates before one submission only the second does.
    /// - Record it before the passes that read the lights, and after those of the renderer's kernel
    ///   that write them and their number: in the same encoder, or in encoders that are submitted in
    ///   this order.
    ///
    /// A frame may record it more than once: the result is the same.
    pub fn record(&self, passes: &mut dyn Passes) {
        if let Some(living) = &self.living {
            living.record(passes);
        }
        if let Some(wide) = &self.wide {
            wide.record(passes);
        }
    }

    /// This frame's lights, if the GPU orders them.
    pub(crate) fn frame_lights(&self) -> Option<FrameLights> {
        self.living.as_ref().map(|living| FrameLights::of(living.recorded()))
    }

    /// Number of slots that strategies see: the accepted lights. With [`LightOrder::Gpu`] there may be empty slots among
    /// them, and for lights from the GPU it is the most lights that fit.
    pub fn count(&self) -> u32 {
        match (&self.living, &self.wide) {
            (Some(living), _) => living.slots(),
            (None, Some(wide)) => wide.slots(),
            (None, None) => self.given.lights.len() as u32,
        }
    }

    /// The number of slots in use, a `u32` at the start of this buffer, if only the GPU knows it.
    /// It may be copied from.
    pub fn live_count(&self) -> Option<&wgpu::Buffer> {
        let wide = || self.wide.as_ref().and_then(WideLights::live_count);
        self.living.as_ref().and_then(Living::live_count).or_else(wide)
    }

    /// The accepted lights that the CPU knows. Their order is that of the slots, except with
    /// [`LightOrder::Gpu`]: then it is the renderer's. Empty for lights from the GPU.
    pub fn lights(&self) -> &[Light] {
        &self.given.lights
    }

    /// The lights by slot, as the GPU holds them. For the orders of the CPU this is
    /// [`lights`](Self::lights). With [`LightOrder::Gpu`] it blocks, and must follow the submission
    /// of [`record`](Self::record); empty slots have a light of intensity 0.
    ///
    /// # Errors
    ///
    /// [`AssignError::Parameter`] for spots or area lights from the GPU if the renderer's buffer of
    /// [`shapes`](GpuLights::shapes) lacks the usage `COPY_SRC`.
    pub fn read(&self, gpu: &Gpu) -> Result<Vec<Light>, AssignError> {
        match &self.living {
            None => Ok(self.given.lights.clone()),
            Some(living) => living.read(gpu, &self.given),
        }
    }

    /// What the GPU found in the slots in the last submitted [`record`](Self::record). It blocks.
    /// `None` for the orders of the CPU.
    pub fn read_counts(&self, gpu: &Gpu) -> Result<Option<SlotCounts>, AssignError> {
        self.living.as_ref().map(|living| living.read_counts(gpu)).transpose()
    }

    /// The index in the renderer's list of one of [`lights`](Self::lights); `None` if there is no
    /// such light.
    pub fn given_index(&self, light: u32) -> Option<u32> {
        self.given.indices.get(light as usize).copied()
    }

    /// The order of the lights.
    pub fn order(&self) -> LightOrder {
        self.order
    }

    /// How long the CPU took to sort the lights and to build the hierarchy over them.
    #[cfg(feature = "build-time")]
    pub fn build_time(&self) -> Duration {
        self.build_time
    }

    /// Changes with every new order of the lights. Lists of an earlier order name other lights.
    pub fn order_generation(&self) -> u32 {
        self.living.as_ref().map_or(self.generation, Living::generation)
    }

    /// How far the lights have moved since the buffer was made.
    pub fn travel(&self) -> Travel {
        self.travel
    }

    /// Bytes that the last [`update`](Self::update) uploaded with [`LightOrder::Gpu`].
    pub fn uploaded_bytes(&self) -> u64 {
        self.living.as_ref().map_or(0, Living::uploaded_bytes)
    }

    /// Bytes of its buffers on the GPU. Those of the renderer ([`from_gpu`](Self::from_gpu)) are not
    /// included.
    pub fn memory_bytes(&self) -> u64 {
        if let Some(living) = &self.living {
            return living.bytes();
        }
        if let Some(wide) = &self.wide {
            return wide.bytes();
        }
        let buffers = [&self.spheres, &self.emissions, &self.shapes, &self.nodes];
        buffers.into_iter().map(wgpu::Buffer::size).sum()
    }

    /// The lights that the last [`update`](Self::update) rejected: faulty ones, and without [kept
    /// indices](Self::keep_indices) also those of intensity 0.
    pub fn rejected(&self) -> &[RejectedLight] {
        &self.given.rejected
    }

    /// The kinds of the accepted lights. Shaders are compiled for them.
    pub fn kinds(&self) -> LightKinds {
        self.given.kinds
    }

    /// What culling kernels are compiled for.
    pub fn traits(&self) -> LightTraits {
        LightTraits { kinds: self.kinds(), levels: self.levels().levels }
    }

    /// The levels of the hierarchy.
    pub(crate) fn levels(&self) -> NodeLevels {
        NodeLevels::over(self.capacity())
    }

    /// The most lights for which there is room in the hierarchy.
    fn capacity(&self) -> u32 {
        let living =
            self.living.as_ref().and_then(Living::buffers).map(|(sorter, _)| sorter.capacity());
        living.or(self.wide.as_ref().map(WideLights::capacity)).unwrap_or_else(|| self.count())
    }

    /// The spheres: `array<LightSphere>`.
    pub fn spheres(&self) -> &wgpu::Buffer {
        &self.spheres
    }

    /// The emissions: `array<LightEmission>`.
    pub fn emissions(&self) -> &wgpu::Buffer {
        &self.emissions
    }

    /// The shapes: `array<vec4f>`.
    pub fn shapes(&self) -> &wgpu::Buffer {
        &self.shapes
    }

    /// The hierarchy: `array<LightNode>`, one box per 64 lights, then one per 64 boxes, and so on.
    pub fn nodes(&self) -> &wgpu::Buffer {
        &self.nodes
    }
}

/// The buffer if `bytes` fit into it, else a larger one.
fn fitting(
    gpu: &Gpu,
    buffer: &wgpu::Buffer,
    label: &str,
    bytes: &[u8],
) -> Result<wgpu::Buffer, AssignError> {
    if bytes.len() as u64 > buffer.size() {
        gpu.storage(label, bytes.len() as u64)
    } else {
        Ok(buffer.clone())
    }
}
