//! The buffer of VPLs, from the map to the lights.

use std::mem::offset_of;

use assign::{
    AssignError, Gpu, GpuLights, Light, LightEmission, LightKinds, LightSphere, Passes, Readback,
};
use bytemuck::{Pod, Zeroable, pod_collect_to_vec};
use glam::Vec3;

use super::{
    choose::{Choose, Chosen},
    keep::{Keep, Kept},
    rsm::Rsm,
    settings::VplSettings,
};

/// The number of VPLs at each stage: `struct Counts` of `vpl_keep.wesl`. 16 bytes.
#[repr(C)]
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Pod, Zeroable)]
pub struct VplCounts {
    /// Chosen from the map, whether they fitted or not.
    pub chosen: u32,
    /// Kept as lights.
    pub kept: u32,
    /// Dropped because the range was too small.
    pub too_small: u32,
    /// Dropped or clamped because the range was too large or unknown.
    pub too_large: u32,
}

/// VPLs on the GPU. They are chosen from a reflective shadow map; the caller gives them ranges; then they are kept as
/// lights.
#[derive(Debug)]
pub struct VplBuffer {
    settings: VplSettings,
    choose: Choose,
    keep: Keep,
    chosen: Chosen,
    ranges_m: wgpu::Buffer,
    kept: Kept,
    counts: wgpu::Buffer,
    readback: Readback<VplCounts>,
    capacity: u32,
}

impl VplBuffer {
    /// Makes the kernels, and empty buffers.
    ///
    /// # Errors
    ///
    /// [`AssignError::Parameter`] if a setting is out of its range, and any error of the device.
    pub fn new(gpu: &Gpu, settings: VplSettings) -> Result<Self, AssignError> {
        settings.check()?;
        Ok(Self {
            settings,
            choose: Choose::new(gpu)?,
            keep: Keep::new(gpu)?,
            chosen: Chosen::new(gpu, 0)?,
            ranges_m: gpu.storage("VPL ranges", 0)?,
            kept: Kept::new(gpu, 0)?,
            counts: gpu.storage("VPL counts", size_of::<VplCounts>() as u64)?,
            readback: Readback::new(gpu, "VPL counts"),
            capacity: 0,
        })
    }

    /// Changes the settings. They apply from the next [`prepare`](Self::prepare) on.
    ///
    /// # Errors
    ///
    /// [`AssignError::Parameter`] if one is out of its range. Then the old settings stay.
    pub fn set_settings(&mut self, settings: VplSettings) -> Result<(), AssignError> {
        settings.check()?;
        self.settings = settings;
        Ok(())
    }

    /// The settings.
    pub fn settings(&self) -> &VplSettings {
        &self.settings
    }

    /// Sizes buffers and binds the map: outside the clock, before the passes of each frame. It may replace buffers, so
    /// bind them after it.
    ///
    /// # Errors
    ///
    /// [`AssignError::Parameter`] if the map's light is not a spot, if its view is not perspective, if it is larger than
    /// [`MAX_RSM_SIDE`](crate::MAX_RSM_SIDE), or if its textures are too small for the viewport. Also
    /// [`AssignError::View`], [`AssignError::TooLarge`] and [`AssignError::OutOfMemory`].
    pub fn prepare(&mut self, gpu: &Gpu, rsm: &Rsm<'_>) -> Result<(), AssignError> {
        self.readback.poll();
        let mut uniform = rsm.uniform()?;
        let texels = uniform.size[0] * uniform.size[1];
        let capacity = self.settings.limit.unwrap_or(texels).min(texels);
        uniform.capacity = capacity;
        uniform.spacing_m = self.settings.spacing_m;
        if capacity != self.capacity {
            let chosen = Chosen::new(gpu, capacity)?;
            let ranges_m = gpu.storage("VPL ranges", u64::from(capacity) * 4)?;
            let kept = Kept::new(gpu, capacity)?;
            (self.chosen, self.ranges_m, self.kept) = (chosen, ranges_m, kept);
            self.capacity = capacity;
        }
        self.choose.prepare(gpu, rsm, uniform, &self.chosen)?;
        let found = (&self.chosen, &self.ranges_m, &self.counts);
        self.keep.prepare(gpu, &self.settings, capacity, found, &self.kept)
    }

    /// Records `rsm-mips` and `vpl-choose`, which write positions, normals and intensities.
    pub fn record_choose(&self, passes: &mut dyn Passes) {
        self.choose.record(passes, &self.counts);
    }

    /// Records `vpl-keep`, which writes the lights. Call it after the pass that fills the ranges.
    pub fn record_keep(&mut self, passes: &mut dyn Passes) {
        self.keep.record(passes, &self.counts);
        self.readback.record(passes.encoder(), &self.counts, 0);
    }

    /// The most VPLs that fit: the length of every array.
    pub fn capacity(&self) -> u32 {
        self.capacity
    }

    /// `array<vec4f>`: world-space positions on surfaces, and in `w` the side of the square on the surface that a VPL
    /// stands for, metres. The first [`VplCounts::chosen`] are in use.
    pub fn positions(&self) -> &wgpu::Buffer {
        &self.chosen.positions
    }

    /// `array<vec4f>`: unit normals on the light's side; zero after the last one in use.
    pub fn normals(&self) -> &wgpu::Buffer {
        &self.chosen.normals
    }

    /// `array<vec4f>`: radiant intensities along the normals, linear RGB.
    pub fn intensities(&self) -> &wgpu::Buffer {
        &self.chosen.intensities
    }

    /// `array<f32>`: the caller fills it with distances to surfaces, metres. [`f32::MAX`] is an unknown distance.
    pub fn ranges_m(&self) -> &wgpu::Buffer {
        &self.ranges_m
    }

    /// `array<LightSphere>` of the kept lights. The first [`VplCounts::kept`] are in use.
    pub fn spheres(&self) -> &wgpu::Buffer {
        &self.kept.spheres
    }

    /// `array<LightEmission>` of the kept lights.
    pub fn emissions(&self) -> &wgpu::Buffer {
        &self.kept.emissions
    }

    /// `array<vec4f>`, two per light: the shapes that the emissions' indices point to.
    pub fn shapes(&self) -> &wgpu::Buffer {
        &self.kept.shapes
    }

    /// The kept lights for [`LightBuffer::from_gpu`](assign::LightBuffer::from_gpu), which needs no read-back. Call it
    /// after [`prepare`](Self::prepare).
    ///
    /// `bounds` is the box of the surfaces that the map shows: lowest and highest corner, world space, metres. Make it a
    /// little larger, because positions come from rounded depths. A light outside is faulty.
    pub fn gpu_lights(&self, bounds: (Vec3, Vec3)) -> GpuLights<'_> {
        GpuLights {
            spheres: &self.kept.spheres,
            emissions: &self.kept.emissions,
            shapes: &self.kept.shapes,
            count: &self.counts,
            count_offset: offset_of!(VplCounts, kept) as u64,
            capacity: self.capacity,
            kinds: LightKinds { spots: true, ..LightKinds::default() },
            bounds,
            radius_max_m: self.settings.max_range_m,
            step_max_m: None,
        }
    }

    /// [`VplCounts`] on the GPU.
    pub fn counts(&self) -> &wgpu::Buffer {
        &self.counts
    }

    /// The newest counts that were read back, without waiting. They are at least one frame old. `None` before the first.
    pub fn latest_counts(&self) -> Option<VplCounts> {
        self.readback.latest()
    }

    /// The counts of the last submitted frame. It blocks.
    ///
    /// # Errors
    ///
    /// [`AssignError::Device`], [`AssignError::OutOfMemory`], and [`AssignError::Parameter`] if more VPLs were chosen
    /// than [`VplSettings::limit`] allows.
    pub fn read_counts(&self, gpu: &Gpu) -> Result<VplCounts, AssignError> {
        let bytes = gpu.read(&self.counts, size_of::<VplCounts>() as u64)?;
        let counts: VplCounts = bytemuck::pod_read_unaligned(&bytes);
        if counts.chosen > self.capacity {
            return Err(AssignError::Parameter {
                field: "limit of VPLs".into(),
                value: self.capacity.to_string(),
                accepted: format!("at least {}, the number of VPLs chosen", counts.chosen),
            });
        }
        Ok(counts)
    }

    /// The kept lights on the CPU, in their order, for tests and figures. It blocks.
    ///
    /// # Errors
    ///
    /// As [`read_counts`](Self::read_counts).
    pub fn read(&self, gpu: &Gpu) -> Result<Vec<Light>, AssignError> {
        let kept = u64::from(self.read_counts(gpu)?.kept);
        let spheres: Vec<LightSphere> = pod_collect_to_vec(&gpu.read(self.spheres(), kept * 16)?);
        let emissions: Vec<LightEmission> =
            pod_collect_to_vec(&gpu.read(self.emissions(), kept * 16)?);
        let shapes: Vec<[f32; 4]> = pod_collect_to_vec(&gpu.read(self.shapes(), kept * 32)?);
        let records = spheres.iter().zip(&emissions);
        Ok(records
            .map(|(sphere, emission)| Light::from_record(sphere, emission, &shapes))
            .collect())
    }

    /// Bytes of its buffers on the GPU.
    pub fn bytes(&self) -> u64 {
        let buffers = [
            &self.chosen.positions,
            &self.chosen.normals,
            &self.chosen.intensities,
            &self.ranges_m,
            &self.kept.spheres,
            &self.kept.emissions,
            &self.kept.shapes,
            &self.counts,
        ];
        let bytes: u64 = buffers.map(wgpu::Buffer::size).iter().sum();
        bytes + self.choose.bytes() + self.keep.bytes()
    }
}

impl Chosen {
    fn new(gpu: &Gpu, capacity: u32) -> Result<Self, AssignError> {
        let array = |label| gpu.storage(label, u64::from(capacity) * 16);
        Ok(Self {
            positions: array("VPL positions")?,
            normals: array("VPL normals")?,
            intensities: array("VPL intensities")?,
        })
    }
}
