//! Lights that change in every frame: where they come from, and when they are sorted.

use std::sync::{
    Arc,
    atomic::{AtomicBool, Ordering},
};

use bytemuck::{bytes_of, pod_collect_to_vec, pod_read_unaligned};
use glam::Vec3;

use super::{
    decode,
    given::{Given, MAX_LIGHTS, Records},
    gpu_lights::{GpuLights, check_usage},
    recorded::RecordedLights,
    travel::Travel,
};
use crate::{
    AssignError, Gpu, Light, LightEmission, LightKinds, LightOrder, LightSphere, Passes,
    light_nodes::NODE_LIGHTS,
    light_sorter::{GivenBuffers, LightSorter, SlotState},
};

/// What the GPU found in the slots.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct SlotCounts {
    /// Lights that were given.
    pub given: u32,
    /// Slots in use: lights, and empty slots among them.
    pub slots: u32,
    /// Faulty lights, which light nothing.
    pub faulty: u32,
    /// Lights of intensity 0.
    pub dark: u32,
}

/// Where the lights come from.
#[derive(Debug)]
pub(super) enum Source {
    /// From the CPU, with what is on the GPU already.
    Cpu { uploaded: Records },
    /// From the renderer's own buffers.
    Gpu { count: wgpu::Buffer, count_offset: u64, bounds: (Vec3, Vec3), radius_max_m: f32 },
}

/// Lights that change in every frame.
#[derive(Debug)]
pub(super) struct Living {
    /// When the lights are sorted.
    order: LightOrder,
    /// How far they had moved at the last sort.
    sorted_at: Travel,
    /// Frames since the last sort; `None` if the next frame must sort.
    age: Option<u32>,
    /// Number of sorts so far.
    generation: u32,
    /// Whether the next frame must sort, whatever the age.
    is_expired: bool,
    /// Whether the sort of the last frame that sorts was recorded.
    is_sorted: AtomicBool,
    /// How far balls may reach beyond those of the last recorded frame, metres.
    reach_m: f32,
    /// Whether the lights were recorded since they were given.
    recorded: Arc<RecordedLights>,
    /// Number of lights at the last sort.
    sorted: u32,
    slots: u32,
    uploaded_bytes: u64,
    sorter: Option<(LightSorter, GivenBuffers)>,
    source: Option<Source>,
}

/// The capacity for few lights, unless the device has no room for it.
const LEAST_CAPACITY: u32 = 64;

/// Bytes whose change uploads all of them: one write per run of changed blocks.
const UPLOAD_BLOCK: usize = 1024;

impl Living {
    /// Lights that the GPU sorts; `None` for the orders of the CPU.
    pub(super) fn new(order: LightOrder) -> Result<Option<Self>, AssignError> {
        let (field, number) = match order {
            LightOrder::Gpu { every } => ("frames between two sorts of the lights", every),
            LightOrder::GpuGrown { percent } => ("growth of boxes, percent", percent),
            _ => return Ok(None),
        };
        if number == 0 {
            return Err(AssignError::Parameter {
                field: field.into(),
                value: "0".into(),
                accepted: "1 or more".into(),
            });
        }
        Ok(Some(Self {
            order,
            sorted_at: Travel::default(),
            age: None,
            generation: 0,
            is_expired: false,
            is_sorted: AtomicBool::new(false),
            reach_m: 0.0,
            recorded: Arc::default(),
            sorted: 0,
            slots: 0,
            uploaded_bytes: 0,
            sorter: None,
            source: None,
        }))
    }

    /// The next frame's lights, from the CPU.
    pub(super) fn update(
        &mut self,
        gpu: &Gpu,
        given: &Given,
        travel: Travel,
    ) -> Result<(), AssignError> {
        let records = Records::new(&given.lights);
        let count = given.lights.len() as u32;
        let [spheres, emissions, shapes] = records.bytes();
        let fits = self.sorter.as_ref().is_some_and(|(sorter, buffers)| {
            matches!(self.source, Some(Source::Cpu { .. }))
                && sorter.serves(count, buffers)
                && buffers.shapes.size() >= shapes.len() as u64
        });
        let mut known = Records::default();
        if fits {
            self.compile(gpu, given.kinds)?;
            if let Some(Source::Cpu { uploaded }) = self.source.take() {
                known = uploaded;
            }
        } else {
            let make = |capacity, bytes| make_sorter(gpu, capacity, bytes, given.kinds);
            // Room for a quarter more, so that a growing number does not replace buffers each frame; if
            // the device has no such room, only for what is needed.
            let roomy = (count + count / 4).max(LEAST_CAPACITY).min(MAX_LIGHTS as u32);
            let bytes = shapes.len() as u64;
            let made = make(roomy, bytes + bytes / 4).or_else(|_| make(count, bytes))?;
            self.sorter = Some(made);
            self.age = None;
        }
        let bounds = given.position_bounds.unwrap_or_default();
        let sorts = self.next_sorts(bounds, travel, count);
        if sorts {
            self.sorted = count;
        }
        self.slots = count.max(self.sorted);
        let Some((sorter, buffers)) = &self.sorter else { return Ok(()) };
        let [known_spheres, known_emissions, known_shapes] = known.bytes();
        self.uploaded_bytes = upload(gpu, &buffers.spheres, known_spheres, spheres)
            + upload(gpu, &buffers.emissions, known_emissions, emissions)
            + upload(gpu, &buffers.shapes, known_shapes, shapes);
        gpu.queue.write_buffer(sorter.state(), SlotState::GIVEN_AT, bytes_of(&count));
        // The CPU has checked the radii.
        sorter.prepare(gpu, bounds, [f32::MAX; 2], sorts);
        self.source = Some(Source::Cpu { uploaded: records });
        self.recorded.give();
        Ok(())
    }

    /// The next frame's lights, from the renderer's own buffers.
    pub(super) fn update_from_gpu(
        &mut self,
        gpu: &Gpu,
        lights: &GpuLights<'_>,
        travel: Travel,
    ) -> Result<(), AssignError> {
        lights.check(gpu)?;
        let buffers = GivenBuffers {
            spheres: lights.spheres.clone(),
            emissions: lights.emissions.clone(),
            shapes: lights.shapes.clone(),
        };
        let fits = self.sorter.as_ref().is_some_and(|(sorter, _)| {
            matches!(self.source, Some(Source::Gpu { .. }))
                && sorter.capacity() == lights.capacity
                && sorter.serves(lights.capacity, &buffers)
        });
        if !fits {
            let sorter = LightSorter::new(gpu, lights.capacity, lights.kinds, buffers.clone())?;
            self.sorter = Some((sorter, buffers));
            self.age = None;
        } else {
            self.compile(gpu, lights.kinds)?;
        }
        self.source = Some(Source::Gpu {
            count: lights.count.clone(),
            count_offset: lights.count_offset,
            bounds: lights.bounds,
            radius_max_m: lights.radius_max_m,
        });
        self.uploaded_bytes = 0;
        self.slots = lights.capacity;
        let sorts = self.next_sorts(lights.bounds, travel, lights.capacity);
        if self.recorded.is_recorded() {
            self.reach_m = 0.0;
        }
        self.reach_m = (self.reach_m + lights.step_max_m.unwrap_or(f32::MAX)).min(f32::MAX);
        if let Some((sorter, _)) = &self.sorter {
            let largest_m = [lights.radius_max_m, self.reach_m];
            sorter.prepare(gpu, lights.bounds, largest_m, sorts);
        }
        self.recorded.give();
        Ok(())
    }

    /// Has frames take lights of some kinds. Compiles their kernels the first time.
    pub(super) fn compile(&mut self, gpu: &Gpu, kinds: LightKinds) -> Result<(), AssignError> {
        self.sorter.as_mut().map_or(Ok(()), |(sorter, _)| sorter.compile(gpu, kinds))
    }

    /// Compiles kernels for other kinds of lights than those of the frame.
    pub(super) fn compile_ahead(
        &mut self,
        gpu: &Gpu,
        kinds: LightKinds,
    ) -> Result<(), AssignError> {
        self.sorter.as_mut().map_or(Ok(()), |(sorter, _)| sorter.compile_ahead(gpu, kinds))
    }

    /// Whether the next frame sorts `lights` lights in a box. It does so when it is time, and if the frame
    /// that should have sorted was never recorded.
    fn next_sorts(&mut self, bounds: (Vec3, Vec3), travel: Travel, lights: u32) -> bool {
        let is_sorted = *self.is_sorted.get_mut();
        let is_expired = std::mem::take(&mut self.is_expired);
        let next = match self.age {
            Some(age) if is_sorted && !is_expired => age.wrapping_add(1),
            _ => 0,
        };
        let is_time = match self.order {
            LightOrder::Gpu { every } => next % every == 0,
            LightOrder::GpuGrown { percent } => {
                // Both ends of a box move.
                let growth_m = 2.0 * (travel.metres - self.sorted_at.metres);
                travel.jumps != self.sorted_at.jumps
                    || growth_m > f64::from(percent) * 0.01 * box_side_m(bounds, lights)
            }
            _ => false,
        };
        let sorts = next == 0 || is_time;
        self.age = Some(if sorts { 0 } else { next });
        if sorts {
            self.generation = self.generation.wrapping_add(1);
            self.sorted_at = travel;
            *self.is_sorted.get_mut() = false;
        }
        sorts
    }

    /// Has the next frame sort. This frame stays as it is.
    pub(super) fn expire(&mut self) {
        self.is_expired = true;
    }

    /// Records `order`, if this frame sorts, and `boxes`.
    pub(super) fn record(&self, passes: &mut dyn Passes) {
        let Some((sorter, _)) = &self.sorter else { return };
        if let Some(Source::Gpu { count, count_offset, .. }) = &self.source {
            let encoder = passes.encoder();
            let at = SlotState::GIVEN_AT;
            encoder.copy_buffer_to_buffer(count, *count_offset, sorter.state(), at, 4);
        }
        let sorts = self.age == Some(0);
        sorter.record(sorts, passes);
        self.recorded.record();
        if sorts {
            self.is_sorted.store(true, Ordering::Relaxed);
        }
    }

    /// The sorter and the shapes.
    pub(super) fn buffers(&self) -> Option<(&LightSorter, &wgpu::Buffer)> {
        self.sorter.as_ref().map(|(sorter, given)| (sorter, &given.shapes))
    }

    pub(super) fn recorded(&self) -> &Arc<RecordedLights> {
        &self.recorded
    }

    pub(super) fn source(&self) -> Option<&Source> {
        self.source.as_ref()
    }

    pub(super) fn slots(&self) -> u32 {
        self.slots
    }

    pub(super) fn generation(&self) -> u32 {
        self.generation
    }

    pub(super) fn uploaded_bytes(&self) -> u64 {
        self.uploaded_bytes
    }

    /// Bytes of its buffers, without those of the renderer.
    pub(super) fn bytes(&self) -> u64 {
        let Some((sorter, given)) = &self.sorter else { return 0 };
        let uploaded = match self.source {
            Some(Source::Cpu { .. }) => {
                given.spheres.size() + given.emissions.size() + given.shapes.size()
            }
            _ => 0,
        };
        sorter.bytes() + uploaded
    }

    pub(super) fn live_count(&self) -> Option<&wgpu::Buffer> {
        match (&self.source, &self.sorter) {
            (Some(Source::Gpu { .. }), Some((sorter, _))) => Some(sorter.state()),
            _ => None,
        }
    }

    pub(super) fn read_counts(&self, gpu: &Gpu) -> Result<SlotCounts, AssignError> {
        let Some((sorter, _)) = &self.sorter else { return Ok(SlotCounts::default()) };
        let state = gpu.read(sorter.state(), size_of::<SlotState>() as u64)?;
        let SlotState { slots, given, faulty, dark, .. } = pod_read_unaligned(&state);
        Ok(SlotCounts { given, slots, faulty, dark })
    }

    /// The lights by slot. `given` has those that the CPU knows.
    pub(super) fn read(&self, gpu: &Gpu, given: &Given) -> Result<Vec<Light>, AssignError> {
        let Some((sorter, buffers)) = &self.sorter else { return Ok(Vec::new()) };
        let slots = self.read_counts(gpu)?.slots;
        if matches!(self.source, Some(Source::Cpu { .. })) {
            let order: Vec<u32> =
                pod_collect_to_vec(&gpu.read(sorter.order(), u64::from(slots) * 4)?);
            let light = |&ix: &u32| given.lights.get(ix as usize).copied().unwrap_or(decode::EMPTY);
            return Ok(order.iter().map(light).collect());
        }
        let shapes: Vec<Vec3x4> = if given.kinds == LightKinds::default() {
            Vec::new()
        } else {
            let read_back = wgpu::BufferUsages::COPY_SRC;
            check_usage("shapes", &buffers.shapes, read_back, ", to read the lights back")?;
            pod_collect_to_vec(&gpu.read(&buffers.shapes, buffers.shapes.size())?)
        };
        let [spheres, emissions, _] = sorter.ordered();
        let spheres: Vec<LightSphere> =
            pod_collect_to_vec(&gpu.read(spheres, u64::from(slots) * 16)?);
        let emissions: Vec<LightEmission> =
            pod_collect_to_vec(&gpu.read(emissions, u64::from(slots) * 16)?);
        let records = spheres.iter().zip(&emissions);
        Ok(records
            .map(|(sphere, emission)| Light::from_record(sphere, emission, &shapes))
            .collect())
    }
}

/// The side of a cube that holds as many of the lights as a node, if they fill their box evenly, metres.
fn box_side_m((low, high): (Vec3, Vec3), lights: u32) -> f64 {
    let volume: f64 = (high - low).as_dvec3().element_product();
    (volume * NODE_LIGHTS as f64 / f64::from(lights.max(1))).cbrt()
}

/// A sorter with buffers for lights from the CPU.
fn make_sorter(
    gpu: &Gpu,
    capacity: u32,
    shape_bytes: u64,
    kinds: LightKinds,
) -> Result<(LightSorter, GivenBuffers), AssignError> {
    let buffers = GivenBuffers {
        spheres: gpu.storage("given light spheres", u64::from(capacity) * 16)?,
        emissions: gpu.storage("given light emissions", u64::from(capacity) * 16)?,
        shapes: gpu.storage("given light shapes", shape_bytes)?,
    };
    Ok((LightSorter::new(gpu, capacity, kinds, buffers.clone())?, buffers))
}

/// A shape vector.
type Vec3x4 = [f32; 4];

/// Uploads the blocks of `bytes` that differ from `known`. Returns how many bytes it uploaded.
fn upload(gpu: &Gpu, buffer: &wgpu::Buffer, known: &[u8], bytes: &[u8]) -> u64 {
    let mut uploaded = 0;
    let mut write = |begin: usize, end: usize| {
        if begin < end {
            gpu.queue.write_buffer(buffer, begin as u64, &bytes[begin..end]);
            uploaded += (end - begin) as u64;
        }
    };
    // The run of changed blocks that is not written yet.
    let mut run = 0..0;
    for begin in (0..bytes.len()).step_by(UPLOAD_BLOCK) {
        let end = (begin + UPLOAD_BLOCK).min(bytes.len());
        if known.get(begin..end) == Some(&bytes[begin..end]) {
            write(run.start, run.end);
            run = end..end;
        } else {
            run = if run.end == begin { run.start..end } else { begin..end };
        }
    }
    write(run.start, run.end);
    uploaded
}
