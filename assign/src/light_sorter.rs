//! Lights that move: the GPU orders and boxes them in every frame.
//!
//! The lights come as they are given: records in buffers, in any order. Two passes make of them what
//! strategies read.
//!
//! 1. `order` sorts the lights by the Morton code of their positions, 8 bits per axis. Its result is
//!    the light of every *slot*. The sort is stable and gives the same order on every run. Up to 2,048
//!    lights take one workgroup ([bitonic sort](few)). More take a radix sort: two passes over the
//!    upper 16 bits up to 65,536 lights, and three over all 24 bits beyond.
//! 2. `boxes` copies the lights to their slots and boxes every 64 slots, every 64 of these boxes, and
//!    every 64 of those ([`NodeLevels`]).
//!
//! **The order may be stale.** A light's slot only decides how small the boxes are. So `order` may
//! skip frames: `boxes` reads the lights' current records in the order of the last sort, and lists
//! stay complete. If the number of lights changes without a sort, new lights take the slots behind
//! the sorted ones, and slots whose light is gone stay empty.
//!
//! **Faulty lights.** `boxes` checks every record, as [`Light::check`](crate::Light::check) does on
//! the CPU, and counts the faulty ones. Their slots are empty: they hold a light of radius 1e-6 and
//! intensity 0.
//!
//! **Cost.** The sort reads and writes 8 bytes per light and pass, and the boxes read and write 32
//! bytes per light. Few lights cost the time of a few dispatches.
//!
//! Where it fails: many lights in a small part of the box share few codes, since a code has 256 steps
//! along the longest side of the box. Their boxes are then larger than they could be.

#[cfg(all(test, feature = "conformance"))]
mod digit_sums;
mod few;
mod kernels;
mod radix;
mod uniform;

use crate::{
    AssignError, Gpu, LightKinds, Passes,
    kernel::{bind_buffers, workgroups},
    light_nodes::{LightNode, NodeLevels},
};
use kernels::{BoxKernels, frame_layout};
pub(crate) use uniform::{OrderUniform, SlotState};

/// The records of lights as they are given, on the GPU.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct GivenBuffers {
    pub(crate) spheres: wgpu::Buffer,
    pub(crate) emissions: wgpu::Buffer,
    pub(crate) shapes: wgpu::Buffer,
}

/// Sorts and boxes lights on the GPU.
#[derive(Debug)]
pub(crate) struct LightSorter {
    capacity: u32,
    levels: NodeLevels,
    given: GivenBuffers,
    kernels: BoxKernels,
    uniform: wgpu::Buffer,
    state: wgpu::Buffer,
    order: wgpu::Buffer,
    spheres: wgpu::Buffer,
    emissions: wgpu::Buffer,
    nodes: wgpu::Buffer,
    sort: Sort,
    /// Bind group 0 of all kernels, and bind group 1 of the boxes.
    frame: wgpu::BindGroup,
    boxes: wgpu::BindGroup,
}

/// The sort for a number of lights.
#[derive(Debug)]
enum Sort {
    Few(wgpu::ComputePipeline),
    Radix(radix::RadixSort),
}

impl LightSorter {
    /// Makes room for `capacity` lights of some kinds, whose records are in `given`.
    pub(crate) fn new(
        gpu: &Gpu,
        capacity: u32,
        kinds: LightKinds,
        given: GivenBuffers,
    ) -> Result<Self, AssignError> {
        let levels = NodeLevels::over(capacity);
        let bytes = |each: usize| u64::from(capacity) * each as u64;
        let kernels = BoxKernels::new(gpu, kinds)?;
        let uniform = gpu.uniform("light order", size_of::<OrderUniform>() as u64);
        let state = gpu.storage("light slots", size_of::<SlotState>() as u64)?;
        // Until the first sort, no slot has a light.
        let fresh = SlotState { sorted: capacity, ..SlotState::default() };
        gpu.queue.write_buffer(&state, 0, bytemuck::bytes_of(&fresh));
        let order = gpu.storage("light order", bytes(4))?;
        let spheres = gpu.storage("light spheres", bytes(16))?;
        let emissions = gpu.storage("light emissions", bytes(16))?;
        let node_bytes = u64::from(levels.total) * size_of::<LightNode>() as u64;
        let nodes = gpu.storage("light nodes", node_bytes.max(size_of::<LightNode>() as u64))?;
        let sort = if capacity <= few::MOST {
            Sort::Few(few::sort_pipeline(gpu)?)
        } else {
            Sort::Radix(radix::RadixSort::new(gpu, capacity)?)
        };
        let GivenBuffers { spheres: given_spheres, emissions: given_emissions, shapes } = &given;
        let frame = [&uniform, given_spheres, given_emissions, shapes, &state, &order];
        let frame = bind_buffers(gpu, &frame_layout(gpu), &frame);
        let boxes = bind_buffers(gpu, &kernels.layout, &[&spheres, &emissions, &nodes]);
        Ok(Self {
            capacity,
            levels,
            given,
            kernels,
            uniform,
            state,
            order,
            spheres,
            emissions,
            nodes,
            sort,
            frame,
            boxes,
        })
    }

    /// Whether the sorter serves these lights.
    pub(crate) fn serves(&self, capacity: u32, kinds: LightKinds, given: &GivenBuffers) -> bool {
        capacity <= self.capacity && self.kernels.kinds == kinds && self.given == *given
    }

    /// Uploads a frame's parameters.
    pub(crate) fn prepare(&self, gpu: &Gpu, mut frame: OrderUniform) {
        frame.capacity = self.capacity;
        frame.first_parent = self.levels.first_parent;
        frame.first_grandparent = self.levels.first_grandparent;
        frame.blocks = match &self.sort {
            Sort::Few(_) => 1,
            Sort::Radix(sort) => sort.blocks(),
        };
        gpu.queue.write_buffer(&self.uniform, 0, bytemuck::bytes_of(&frame));
    }

    /// Records `order`, if this frame `sorts`, and `boxes`.
    pub(crate) fn record(&self, sorts: bool, passes: &mut dyn Passes) {
        // The counts of faulty and dark lights.
        passes.encoder().clear_buffer(&self.state, SlotState::COUNTS_AT, Some(8));
        if sorts {
            passes.compute("order", &mut |pass| {
                pass.set_bind_group(0, &self.frame, &[]);
                match &self.sort {
                    Sort::Few(sort) => {
                        pass.set_pipeline(sort);
                        pass.dispatch_workgroups(1, 1, 1);
                    }
                    Sort::Radix(sort) => sort.record(pass),
                }
            });
        }
        passes.compute("boxes", &mut |pass| {
            pass.set_bind_group(0, &self.frame, &[]);
            pass.set_bind_group(1, &self.boxes, &[]);
            let levels = [
                (&self.kernels.lights, self.capacity),
                (&self.kernels.parents, self.levels.nodes),
                (&self.kernels.grandparents, self.levels.first_grandparent - self.levels.nodes),
            ];
            for (pipeline, boxed) in levels.into_iter().take(self.levels.levels as usize) {
                pass.set_pipeline(pipeline);
                pass.dispatch_workgroups(workgroups(boxed.into(), kernels::LANES).max(1), 1, 1);
            }
        });
    }

    /// The most lights.
    pub(crate) fn capacity(&self) -> u32 {
        self.capacity
    }

    /// The levels of its hierarchy.
    pub(crate) fn levels(&self) -> NodeLevels {
        self.levels
    }

    /// The records of the slots, and the hierarchy over them.
    pub(crate) fn ordered(&self) -> [&wgpu::Buffer; 3] {
        [&self.spheres, &self.emissions, &self.nodes]
    }

    /// The light of each slot: `array<u32>`.
    pub(crate) fn order(&self) -> &wgpu::Buffer {
        &self.order
    }

    /// [`SlotState`].
    pub(crate) fn state(&self) -> &wgpu::Buffer {
        &self.state
    }
}
