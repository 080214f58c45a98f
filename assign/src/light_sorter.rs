//! Lights that move: the GPU orders and boxes them in every frame.
//!
//! The lights come as they are given: records in buffers, in any order. Two passes make of them what
//! strategies read.
//!
//! 1. `order` sorts the lights by the [code](code) of their positions. Its result is the light of every
//!    *slot*. The radix sort takes 8 bits per pass, and it is stable and gives the same order on every
//!    run. Up to 16,384 lights take one pass, up to 4,194,304 two passes, and more take three.
//! 2. `boxes` copies the lights to their slots and boxes every 64 slots, every 64 of these boxes, and
//!    every 64 of those ([`NodeLevels`](crate::light_nodes::NodeLevels)).
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
//! Where it fails: many lights in a small part of the box share few codes, for the code's cells are of
//! one size. Their boxes are then larger than they could be.

mod boxes;
mod code;
mod kernels;
mod radix;
mod uniform;

use glam::Vec3;

use crate::{AssignError, Gpu, LightKinds, Passes};
pub(crate) use boxes::{BoxInput, BoxPass};
pub(crate) use kernels::BoxKernels;
use radix::RadixSort;
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
    given: GivenBuffers,
    state: wgpu::Buffer,
    order: wgpu::Buffer,
    sort: RadixSort,
    boxes: BoxPass,
}

impl LightSorter {
    /// Makes room for `capacity` lights of some kinds, whose records are in `given`.
    pub(crate) fn new(
        gpu: &Gpu,
        capacity: u32,
        kinds: LightKinds,
        given: GivenBuffers,
    ) -> Result<Self, AssignError> {
        let state = gpu.storage("light slots", size_of::<SlotState>() as u64)?;
        // Until the first sort, no slot has a light.
        let fresh = SlotState { sorted: capacity, ..SlotState::default() };
        gpu.queue.write_buffer(&state, 0, bytemuck::bytes_of(&fresh));
        let order = gpu.storage("light order", u64::from(capacity) * 4)?;
        let sort = RadixSort::new(gpu, capacity)?;
        let mut boxes = BoxPass::new(gpu, capacity, BoxKernels::in_order(gpu, kinds)?)?;
        let GivenBuffers { spheres, emissions, shapes } = &given;
        boxes.bind(gpu, BoxInput { spheres, emissions, shapes, state: &state, order: &order });
        Ok(Self { given, state, order, sort, boxes })
    }

    /// Whether the sorter serves these lights.
    pub(crate) fn serves(&self, capacity: u32, given: &GivenBuffers) -> bool {
        capacity <= self.capacity() && self.given == *given
    }

    /// Has frames take lights of some kinds. Compiles their kernels the first time.
    pub(crate) fn compile(&mut self, gpu: &Gpu, kinds: LightKinds) -> Result<(), AssignError> {
        self.boxes.compile(gpu, kinds)
    }

    /// Compiles kernels for other kinds of lights than those of the frame.
    pub(crate) fn compile_ahead(
        &mut self,
        gpu: &Gpu,
        kinds: LightKinds,
    ) -> Result<(), AssignError> {
        self.boxes.find(gpu, kinds).map(|_| ())
    }

    /// Uploads the parameters of a frame whose positions are in a box. Balls may reach `reach_m` beyond
    /// those of the frame before.
    pub(crate) fn prepare(
        &self,
        gpu: &Gpu,
        bounds: (Vec3, Vec3),
        [radius_max_m, reach_m]: [f32; 2],
        sorts: bool,
    ) {
        let blocks = self.sort.blocks();
        let frame = OrderUniform::in_box(bounds, radius_max_m, sorts, self.capacity());
        self.boxes.prepare(gpu, OrderUniform { blocks, reach_m, ..frame });
    }

    /// Records `order`, if this frame `sorts`, and `boxes`.
    pub(crate) fn record(&self, sorts: bool, passes: &mut dyn Passes) {
        // The counts of faulty and dark lights.
        passes.encoder().clear_buffer(&self.state, SlotState::COUNTS_AT, Some(8));
        if sorts {
            passes.compute("order", &mut |pass| {
                pass.set_bind_group(0, self.boxes.frame(), &[]);
                self.sort.record(pass);
            });
        }
        self.boxes.record("boxes", passes);
    }

    /// The most lights.
    pub(crate) fn capacity(&self) -> u32 {
        self.boxes.capacity
    }

    /// The records of the slots, and the hierarchy over them.
    pub(crate) fn ordered(&self) -> [&wgpu::Buffer; 3] {
        [&self.boxes.spheres, &self.boxes.emissions, &self.boxes.nodes]
    }

    /// The light of each slot: `array<u32>`.
    pub(crate) fn order(&self) -> &wgpu::Buffer {
        &self.order
    }

    /// Bytes of its buffers, without the given lights.
    pub(crate) fn bytes(&self) -> u64 {
        self.state.size() + self.order.size() + self.boxes.bytes() + self.sort.bytes()
    }

    /// [`SlotState`].
    pub(crate) fn state(&self) -> &wgpu::Buffer {
        &self.state
    }
}
