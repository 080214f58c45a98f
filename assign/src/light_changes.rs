//! The lights that changed since the frame before, which the GPU finds.
//!
//! A light counts as changed if culling would test another volume in its slot: its ball, its kind, its
//! cone or its outline. Intensity does not count. For each change the GPU keeps two balls: the light's
//! ball before, and its ball now. A list can only differ from the one of the frame before if one of these
//! balls reaches its group. It does not matter why a slot changed: lights that moved, jumped, were born,
//! died or were sorted into other slots all leave such balls.

use bytemuck::{Pod, Zeroable};
use glam::Vec3;

use crate::{
    AssignError, FrameWrites, Gpu, KeptBindGroup, LightBuffer, LightKinds, Passes, Shader,
    entries::{entry, storage_entry},
    kernel::{Slot, layout, pipeline, workgroups},
};

/// Lanes of a workgroup: `find_changes`.
const LANES: u32 = 256;

/// What the CPU writes at the start of `struct Changes`.
#[repr(C)]
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Pod, Zeroable)]
struct ChangesHeader {
    ball_count: u32,
    slot_count: u32,
    light_count: u32,
    all_groups: u32,
}

impl ChangesHeader {
    /// Offset of the number of lights, bytes.
    const LIGHT_COUNT_AT: u64 = 8;
}

/// The changes of a frame's lights since the frame recorded before, and the boxes around all lights for
/// which the groups were laid out.
#[derive(Debug)]
pub struct LightChanges {
    /// Layout of bind group 0: the lights, where [`FrameBindings`](crate::FrameBindings) has them.
    light_layout: wgpu::BindGroupLayout,
    lights: KeptBindGroup,
    layout: wgpu::BindGroupLayout,
    changes: wgpu::Buffer,
    /// What culling reads of each slot: `array<Known>`.
    known: wgpu::Buffer,
    bound: KeptBindGroup,
    /// One per kind of lights that came up; that of the prepared frame comes first.
    kernels: Vec<Kernel>,
    writes: FrameWrites,
    workgroups: u32,
    /// The number of lights, if only the GPU knows it.
    live_count: Option<wgpu::Buffer>,
    /// Box around all supports.
    bounds: Option<(Vec3, Vec3)>,
    /// Box around all positions.
    position_bounds: Option<(Vec3, Vec3)>,
}

#[derive(Debug)]
struct Kernel {
    kinds: LightKinds,
    clear: wgpu::ComputePipeline,
    find: wgpu::ComputePipeline,
}

impl LightChanges {
    /// Two balls per changed light; beyond them all groups count as touched: `MOST_BALLS` of `changes.wesl`.
    pub const MOST_BALLS: u32 = 2048;

    /// Makes it without lights.
    pub(crate) fn new(gpu: &Gpu) -> Result<Self, AssignError> {
        let stages = wgpu::ShaderStages::COMPUTE;
        let lights = [1, 2, 3].map(|binding| storage_entry(binding, stages, true));
        let bytes = size_of::<ChangesHeader>() as u64 + u64::from(Self::MOST_BALLS) * 16;
        Ok(Self {
            light_layout: gpu.bind_group_layout("lights", &lights),
            lights: KeptBindGroup::default(),
            layout: layout(gpu, "light changes", stages, &[Slot::Write; 2]),
            changes: gpu.storage("light changes", bytes)?,
            known: gpu.storage("known lights", 0)?,
            bound: KeptBindGroup::default(),
            kernels: Vec::new(),
            writes: FrameWrites::new(gpu),
            workgroups: 0,
            live_count: None,
            bounds: None,
            position_bounds: None,
        })
    }

    /// Takes the lights of a frame for which groups are laid out anew.
    pub(crate) fn restart(&mut self, lights: &LightBuffer) {
        self.bounds = lights.bounds();
        self.position_bounds = lights.position_bounds();
    }

    /// Whether groups that were laid out for earlier lights serve these lights as well.
    pub(crate) fn serves(&self, lights: &LightBuffer) -> bool {
        match (self.bounds, lights.bounds()) {
            (Some((low, high)), Some(now)) => now.0.cmpge(low).all() && now.1.cmple(high).all(),
            (_, now) => now.is_none(),
        }
    }

    /// Sizes and binds its buffers. No clock counts it.
    pub(crate) fn prepare(&mut self, gpu: &Gpu, lights: &LightBuffer) -> Result<(), AssignError> {
        let (slots, kinds) = (lights.count(), lights.kinds());
        let entries =
            [entry(1, lights.spheres()), entry(2, lights.emissions()), entry(3, lights.shapes())];
        self.lights.bind(gpu, "lights", &self.light_layout, &entries);
        // `struct Known`; a shader that binds the buffer needs room for one.
        let of_slot = if kinds == LightKinds::default() { 16 } else { 80 };
        let bytes = u64::from(slots.max(1)) * of_slot;
        if self.known.size() < bytes {
            self.known = gpu.storage("known lights", bytes)?;
        }
        self.compile(gpu, kinds)?;
        self.live_count = lights.live_count().cloned();
        let header =
            ChangesHeader { slot_count: slots, light_count: slots, ..ChangesHeader::default() };
        self.writes.write(&self.changes, 0, bytemuck::bytes_of(&header))?;
        let buffers = [entry(0, &self.changes), entry(1, &self.known)];
        self.bound.bind(gpu, "light changes", &self.layout, &buffers);
        self.workgroups = workgroups(slots.into(), LANES);
        Ok(())
    }

    /// Compiles the kernels for kinds of lights, unless they are compiled, and has the next frame use them.
    pub(crate) fn compile(&mut self, gpu: &Gpu, kinds: LightKinds) -> Result<(), AssignError> {
        if let Some(place) = self.kernels.iter().position(|kernel| kernel.kinds == kinds) {
            self.kernels[..=place].rotate_right(1);
            return Ok(());
        }
        // SAFETY: its loop counts up to the number of slots by a step of at least one workgroup.
        #[allow(unsafe_code, reason = "its loop ends")]
        let module = unsafe { shader(kinds).create_uncounted(gpu, "package::light_changes") }?;
        let layouts = [&self.light_layout, &self.layout];
        let entry = |entry_point| pipeline(gpu, &module, entry_point, &layouts);
        let kernel = Kernel { kinds, clear: entry("clear_changes"), find: entry("find_changes") };
        self.kernels.insert(0, kernel);
        Ok(())
    }

    /// The kernels' linked WGSL for lights of these kinds.
    pub fn kernel_source(kinds: LightKinds) -> Result<String, AssignError> {
        shader(kinds).link("package::light_changes")
    }

    /// Records the pass `changes`. Call it after the light buffer's passes of the frame.
    pub(crate) fn record(&mut self, passes: &mut dyn Passes) {
        let Some(kernel) = self.kernels.first() else { return };
        self.writes.record(passes.encoder());
        if let Some(count) = &self.live_count {
            let at = ChangesHeader::LIGHT_COUNT_AT;
            passes.encoder().copy_buffer_to_buffer(count, 0, &self.changes, at, 4);
        }
        passes.compute("changes", &mut |pass| {
            pass.set_bind_group(0, self.lights.get(), &[]);
            pass.set_bind_group(1, self.bound.get(), &[]);
            pass.set_pipeline(&kernel.clear);
            pass.dispatch_workgroups(1, 1, 1);
            pass.set_pipeline(&kernel.find);
            pass.dispatch_workgroups(self.workgroups, 1, 1);
        });
    }

    /// The box around all supports for which the groups were laid out. It holds those of the frame's lights.
    pub(crate) fn bounds(&self) -> Option<(Vec3, Vec3)> {
        self.bounds
    }

    /// The box around the positions of the lights for which the groups were laid out.
    pub(crate) fn position_bounds(&self) -> Option<(Vec3, Vec3)> {
        self.position_bounds
    }

    /// The balls: `struct Changes`.
    pub(crate) fn buffer(&self) -> &wgpu::Buffer {
        &self.changes
    }

    /// Bytes of its buffers.
    pub(crate) fn bytes(&self) -> u64 {
        self.changes.size() + self.known.size() + self.writes.bytes()
    }
}

fn shader(kinds: LightKinds) -> Shader<'static> {
    Shader::new(1)
        .module("package::changes", include_str!("shaders/changes.wesl"))
        .module("package::light_changes", include_str!("shaders/light_changes.wesl"))
        .light_kinds(kinds)
}
