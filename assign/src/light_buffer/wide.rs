//! Lights whose balls are larger than the lights' own, in the same slots.

use glam::Vec3;

use super::{LightBuffer, Living};
use crate::{
    AssignError, FrameWrites, Gpu, LightKinds, Passes,
    light_sorter::{BoxInput, BoxKernels, BoxPass, OrderUniform, SlotState},
};

/// Larger balls over the slots of another buffer, and the boxes around them.
#[derive(Debug)]
pub(super) struct WideLights {
    slots: u32,
    live_count: Option<wgpu::Buffer>,
    /// The number of slots, where only the CPU knows it.
    state: wgpu::Buffer,
    /// Bound in place of an order, which the kernel does not read.
    order: wgpu::Buffer,
    boxes: BoxPass,
}

impl WideLights {
    fn new(gpu: &Gpu, capacity: u32) -> Result<Self, AssignError> {
        Ok(Self {
            slots: 0,
            live_count: None,
            state: gpu.storage("light slots", size_of::<SlotState>() as u64)?,
            order: gpu.storage("no light order", 4)?,
            boxes: BoxPass::new(gpu, capacity, BoxKernels::wide(gpu)?)?,
        })
    }

    /// Records the pass `widen`.
    pub(super) fn record(&self, passes: &mut dyn Passes) {
        self.boxes.record("widen", passes);
    }

    pub(super) fn slots(&self) -> u32 {
        self.slots
    }

    pub(super) fn live_count(&self) -> Option<&wgpu::Buffer> {
        self.live_count.as_ref()
    }

    pub(super) fn capacity(&self) -> u32 {
        self.boxes.capacity
    }

    pub(super) fn bytes(&self) -> u64 {
        self.state.size() + self.boxes.bytes()
    }
}

impl LightBuffer {
    /// Takes the slots of another buffer, whose lights' balls are grown by `reach_m`. Cones and outlines
    /// become balls. After `writes` are recorded, [`record`](Self::record) makes them from what the other buffer holds on the GPU.
    pub(crate) fn update_wide(
        &mut self,
        gpu: &Gpu,
        source: &LightBuffer,
        reach_m: f32,
        writes: &mut FrameWrites,
    ) -> Result<(), AssignError> {
        let capacity = source.capacity();
        let mut wide = match self.wide.take() {
            Some(wide) if wide.capacity() == capacity => wide,
            _ => WideLights::new(gpu, capacity)?,
        };
        wide.slots = source.count();
        wide.live_count = source.live_count().cloned();
        let state = match source.living.as_ref().and_then(Living::buffers) {
            Some((sorter, _)) => sorter.state().clone(),
            None => {
                let slots = SlotState { slots: source.count(), ..SlotState::default() };
                writes.write(&wide.state, 0, bytemuck::bytes_of(&slots))?;
                wide.state.clone()
            }
        };
        let LightBuffer { spheres, emissions, shapes, .. } = source;
        let order = &wide.order;
        wide.boxes.bind(gpu, BoxInput { spheres, emissions, shapes, state: &state, order });
        wide.boxes.prepare_in(writes, OrderUniform { reach_m, ..OrderUniform::default() })?;
        self.spheres = wide.boxes.spheres.clone();
        self.nodes = wide.boxes.nodes.clone();
        self.emissions = emissions.clone();
        self.shapes = shapes.clone();
        let grown = |bounds: Option<(Vec3, Vec3)>| bounds.map(|(l, h)| (l - reach_m, h + reach_m));
        self.given.kinds = LightKinds::default();
        self.given.bounds = grown(source.bounds());
        self.given.position_bounds = grown(source.position_bounds());
        self.wide = Some(wide);
        Ok(())
    }
}
