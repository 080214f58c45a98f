//! The pass `boxes`: copies lights to their slots and boxes them (`order/boxes.wesl`).

use super::{
    kernels::{BoxKernels, LANES, frame_layout},
    uniform::OrderUniform,
};
use crate::{
    AssignError, FrameWrites, Gpu, KeptBindGroup, LightKinds, Passes,
    entries::entry,
    kernel::{bind_buffers, workgroups},
    light_nodes::{LightNode, NodeLevels},
};

/// The buffers that the kernels of the order read besides their own.
#[derive(Clone, Copy, Debug)]
pub(crate) struct BoxInput<'a> {
    pub(crate) spheres: &'a wgpu::Buffer,
    pub(crate) emissions: &'a wgpu::Buffer,
    pub(crate) shapes: &'a wgpu::Buffer,
    /// [`SlotState`](super::SlotState).
    pub(crate) state: &'a wgpu::Buffer,
    /// The light of each slot: `array<u32>`.
    pub(crate) order: &'a wgpu::Buffer,
}

/// The records of the slots, the boxes over them, and the kernels that make both.
#[derive(Debug)]
pub(crate) struct BoxPass {
    pub(crate) capacity: u32,
    pub(crate) levels: NodeLevels,
    /// The kernels of the frame.
    kernels: BoxKernels,
    /// Those of every kind of lights that came up.
    known: Vec<BoxKernels>,
    pub(crate) spheres: wgpu::Buffer,
    pub(crate) emissions: wgpu::Buffer,
    pub(crate) nodes: wgpu::Buffer,
    uniform: wgpu::Buffer,
    /// Bind groups 0 and 1.
    frame: KeptBindGroup,
    boxes: wgpu::BindGroup,
}

impl BoxPass {
    /// Makes room for `capacity` lights.
    pub(crate) fn new(gpu: &Gpu, capacity: u32, kernels: BoxKernels) -> Result<Self, AssignError> {
        let levels = NodeLevels::over(capacity);
        let node_bytes = size_of::<LightNode>() as u64;
        let spheres = gpu.storage("light spheres", u64::from(capacity) * 16)?;
        // Lights with larger balls keep their emissions.
        let emission_count = if kernels.is_wide { 1 } else { u64::from(capacity) };
        let emissions = gpu.storage("light emissions", emission_count * 16)?;
        let nodes = gpu.storage("light nodes", u64::from(levels.total.max(1)) * node_bytes)?;
        let boxes = bind_buffers(gpu, &kernels.layout, &[&spheres, &emissions, &nodes]);
        let uniform = gpu.uniform("light order", size_of::<OrderUniform>() as u64);
        let frame = KeptBindGroup::default();
        let known = vec![kernels.clone()];
        Ok(Self {
            capacity,
            levels,
            kernels,
            known,
            spheres,
            emissions,
            nodes,
            uniform,
            frame,
            boxes,
        })
    }

    /// Has frames copy lights of some kinds from the given ones. Compiles the kernels the first time.
    pub(crate) fn compile(&mut self, gpu: &Gpu, kinds: LightKinds) -> Result<(), AssignError> {
        self.kernels = self.find(gpu, kinds)?;
        Ok(())
    }

    /// The kernels for some kinds of lights. They are compiled once.
    pub(crate) fn find(&mut self, gpu: &Gpu, kinds: LightKinds) -> Result<BoxKernels, AssignError> {
        if let Some(known) = self.known.iter().find(|kernels| kernels.kinds == kinds) {
            return Ok(known.clone());
        }
        let kernels = BoxKernels::in_order(gpu, kinds)?;
        self.known.push(kernels.clone());
        Ok(kernels)
    }

    /// Binds what the kernels read.
    pub(crate) fn bind(&mut self, gpu: &Gpu, input: BoxInput<'_>) {
        let BoxInput { spheres, emissions, shapes, state, order } = input;
        let buffers = [&self.uniform, spheres, emissions, shapes, state, order];
        let mut binding = 0..;
        let entries = buffers.map(|buffer| entry(binding.next().unwrap_or_default(), buffer));
        self.frame.bind(gpu, "light order", &frame_layout(gpu), &entries);
    }

    /// Bind group 0 of all kernels of the order.
    pub(crate) fn frame(&self) -> Option<&wgpu::BindGroup> {
        self.frame.get()
    }

    /// Uploads a frame's parameters through the queue.
    pub(crate) fn prepare(&self, gpu: &Gpu, frame: OrderUniform) {
        let frame = self.sized(frame);
        gpu.queue.write_buffer(&self.uniform, 0, bytemuck::bytes_of(&frame));
    }

    /// Uploads a frame's parameters where `writes` are recorded.
    pub(crate) fn prepare_in(
        &self,
        writes: &mut FrameWrites,
        frame: OrderUniform,
    ) -> Result<(), AssignError> {
        let frame = self.sized(frame);
        writes.write(&self.uniform, 0, bytemuck::bytes_of(&frame))
    }

    fn sized(&self, frame: OrderUniform) -> OrderUniform {
        OrderUniform {
            capacity: self.capacity,
            first_parent: self.levels.first_parent,
            first_grandparent: self.levels.first_grandparent,
            ..frame
        }
    }

    /// Records the pass.
    pub(crate) fn record(&self, name: &str, passes: &mut dyn Passes) {
        passes.compute(name, &mut |pass| {
            pass.set_bind_group(0, self.frame(), &[]);
            pass.set_bind_group(1, &self.boxes, &[]);
            let levels = [
                (&self.kernels.lights, self.capacity),
                (&self.kernels.parents, self.levels.nodes),
                (&self.kernels.grandparents, self.levels.first_grandparent - self.levels.nodes),
            ];
            for (pipeline, boxed) in levels.into_iter().take(self.levels.levels as usize) {
                pass.set_pipeline(pipeline);
                pass.dispatch_workgroups(workgroups(boxed.into(), LANES).max(1), 1, 1);
            }
        });
    }

    /// Bytes of its buffers.
    pub(crate) fn bytes(&self) -> u64 {
        let buffers = [&self.spheres, &self.emissions, &self.nodes, &self.uniform];
        buffers.into_iter().map(wgpu::Buffer::size).sum()
    }
}
