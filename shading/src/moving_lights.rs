//! Lights that the GPU moves: no light crosses from the CPU after the first upload.
//!
//! [`Motion`] moves lights on the CPU, which then uploads them in every frame. Here the lights at
//! rest are uploaded once, and one pass per frame repeats the laws of motion for all lights:
//!
//! 1. [`MovingLights::prepare`] uploads 64 bytes: the rules of the motion and the frame's time.
//! 2. [`MovingLights::record`] records the pass `move`. One lane per light reads the light at rest
//!    and writes its records for that time.
//! 3. A [`LightBuffer`] takes the records ([`LightBuffer::update_from_gpu`]), sorts and boxes them.
//!
//! The pass reads 36 bytes per light and writes 32, besides the vectors of shapes that turn. It does
//! not depend on the frame before, so every time gives the same lights.
//!
//! # Accuracy
//!
//! The shader repeats the CPU's arithmetic, but a GPU may round a division differently. Then a light
//! is off by about `1e-7 * speed * time`, and a light that jumps or dies does so that much earlier or
//! later.

use assign::{
    Gpu, GpuLights, Light, LightBuffer, LightKinds, LightShape, MIN_RANGE_M, Passes, RejectedLight,
    Shader,
    kernel::{Slot, bind_buffers, layout, pipeline, workgroups},
};
use bytemuck::{Pod, Zeroable, bytes_of, cast_slice};
use glam::Vec3;
use scenes::{Motion, motion_constants};

use crate::ShadingError;

/// Lanes of a workgroup of `move_lights`.
const LANES: u32 = 64;

/// How much larger the ball of an area light may be once it is turned: rounding.
const TURNED_GROWTH: f32 = 1.0 + 1e-5;

/// The rules of a motion and a frame's time: `struct MotionRules`. 64 bytes.
#[repr(C)]
#[derive(Clone, Copy, Debug, Default, PartialEq, Pod, Zeroable)]
struct MotionUniform {
    /// Lowest corner of the box of the lights' positions, metres.
    min_world: [f32; 3],
    /// At 0, all lights stay as they are.
    speed_m_s: f32,
    /// Highest corner of that box, metres.
    max_world: [f32; 3],
    /// Diagonal of that box, metres.
    diagonal_m: f32,
    seed: u32,
    /// The law's place in [`MotionLaw::LIST`](scenes::MotionLaw::LIST).
    law: u32,
    light_count: u32,
    /// Whole seconds of the time.
    whole_s: u32,
    /// The rest of the time, 0 to below 1 second.
    part_s: f32,
    /// Pads to 64 bytes.
    padding: [u32; 3],
}

impl MotionUniform {
    fn new(motion: &Motion, light_count: u32) -> Self {
        let rules = motion.rules();
        Self {
            min_world: rules.min.to_array(),
            speed_m_s: rules.speed_m_s,
            max_world: rules.max.to_array(),
            diagonal_m: rules.diagonal_m,
            seed: rules.seed,
            law: motion.law() as u32,
            light_count,
            ..Self::default()
        }
    }

    fn at(self, time_s: f32) -> Self {
        let clock = Motion::clock(time_s);
        Self { whole_s: clock.whole_s, part_s: clock.part_s, ..self }
    }
}

/// The shader of the pass `move`.
fn moving_lights_shader() -> Shader<'static> {
    Shader::new(1)
        .module("package::motion_constants", motion_constants())
        .module("package::motion_law", include_str!("shaders/motion_law.wesl"))
        .module("package::moving_lights", include_str!("shaders/moving_lights.wesl"))
}

/// Lights that a kernel moves by a [`Motion`], in buffers on the GPU.
#[derive(Debug)]
pub struct MovingLights {
    rules: MotionUniform,
    rejected: Vec<RejectedLight>,
    kinds: LightKinds,
    bounds: (Vec3, Vec3),
    radius_max_m: f32,
    uniform: wgpu::Buffer,
    count: wgpu::Buffer,
    /// Spheres, emissions and shapes at rest, and the lights' indices in the renderer's list.
    rest: [wgpu::Buffer; 4],
    /// Spheres, emissions and shapes of the frame.
    moved: [wgpu::Buffer; 3],
    pipeline: wgpu::ComputePipeline,
    buffers: wgpu::BindGroup,
    /// Workgroups of the pass. Each strides over the lights that remain.
    workgroups: u32,
}

impl MovingLights {
    /// Uploads the lights at rest, and compiles the kernel. Omits the lights that [`Light::check`]
    /// rejects ([`rejected`](Self::rejected)). A light moves as [`Motion::light_at`] moves it, by its index in `lights`. Until the
    /// first [`prepare`](Self::prepare) the time is 0.
    ///
    /// # Errors
    ///
    /// [`ShadingError::Assign`] if there are too many lights for the device.
    pub fn new(gpu: &Gpu, motion: &Motion, lights: &[Light]) -> Result<Self, ShadingError> {
        let resting = LightBuffer::new(gpu, lights)?;
        let count = resting.count();
        let indices: Vec<u32> = (0..count).filter_map(|ix| resting.given_index(ix)).collect();
        let given = gpu.storage("moving light indices", u64::from(count) * 4)?;
        gpu.queue.write_buffer(&given, 0, cast_slice(&indices));
        let rest = [
            resting.spheres().clone(),
            resting.emissions().clone(),
            resting.shapes().clone(),
            given,
        ];
        let moved = [
            gpu.storage("moving light spheres", rest[0].size())?,
            gpu.storage("moving light emissions", rest[1].size())?,
            gpu.storage("moving light shapes", rest[2].size())?,
        ];
        // The kernel writes only the shape vectors that turn.
        let mut encoder = gpu.device.create_command_encoder(&Default::default());
        encoder.copy_buffer_to_buffer(&rest[2], 0, &moved[2], 0, rest[2].size());
        gpu.queue.submit([encoder.finish()]);
        let uniform = gpu.uniform("motion", size_of::<MotionUniform>() as u64);
        let count_buffer = gpu.storage("moving light count", 4)?;
        gpu.queue.write_buffer(&count_buffer, 0, bytes_of(&count));

        let module = moving_lights_shader().create(gpu, "package::moving_lights")?;
        let slots = [&[Slot::Uniform][..], &[Slot::Read; 4], &[Slot::Write; 3]].concat();
        let layout = layout(gpu, "moving lights", wgpu::ShaderStages::COMPUTE, &slots);
        let bound: Vec<_> = [&uniform].into_iter().chain(&rest).chain(&moved).collect();
        let moving = Self {
            rules: MotionUniform::new(motion, count),
            rejected: resting.rejected().to_vec(),
            kinds: resting.kinds(),
            bounds: bounds_of(motion, &resting),
            radius_max_m: radius_max_m(resting.lights()),
            pipeline: pipeline(gpu, &module, "move_lights", &[&layout]),
            buffers: bind_buffers(gpu, &layout, &bound),
            workgroups: workgroups(count.into(), LANES),
            count: count_buffer,
            uniform,
            rest,
            moved,
        };
        moving.prepare(gpu, 0.0);
        Ok(moving)
    }

    /// Sets the time of the next frame, 0 to [`MAX_TIME_S`](scenes::MAX_TIME_S). Call it once per
    /// submission.
    pub fn prepare(&self, gpu: &Gpu, time_s: f32) {
        gpu.queue.write_buffer(&self.uniform, 0, bytes_of(&self.rules.at(time_s)));
    }

    /// Records the pass `move`, which writes the records of every light. Call it before
    /// [`LightBuffer::record`].
    pub fn record(&self, passes: &mut dyn Passes) {
        passes.compute("move", &mut |pass| {
            pass.set_pipeline(&self.pipeline);
            pass.set_bind_group(0, &self.buffers, &[]);
            pass.dispatch_workgroups(self.workgroups, 1, 1);
        });
    }

    /// The moved lights, as [`LightBuffer::from_gpu`] takes them. Dead lights have intensity 0, so
    /// that the number of lights stays the same.
    pub fn lights(&self) -> GpuLights<'_> {
        let [spheres, emissions, shapes] = &self.moved;
        GpuLights {
            spheres,
            emissions,
            shapes,
            count: &self.count,
            count_offset: 0,
            capacity: self.rules.light_count,
            kinds: self.kinds,
            bounds: self.bounds,
            radius_max_m: self.radius_max_m,
            step_max_m: None,
        }
    }

    /// The moved lights, whose balls are those of an earlier time, moved by at most so many metres
    /// ([`Motion::farthest_ball_m`]).
    pub fn lights_within(&self, step_max_m: Option<f32>) -> GpuLights<'_> {
        GpuLights { step_max_m, ..self.lights() }
    }

    /// The faulty lights that were omitted, by their indices in the renderer's list. Lights that
    /// become faulty as they move are counted by [`LightBuffer::read_counts`].
    pub fn rejected(&self) -> &[RejectedLight] {
        &self.rejected
    }

    /// Bytes of all its buffers.
    pub fn bytes(&self) -> u64 {
        let lights = self.rest.iter().chain(&self.moved);
        lights.chain([&self.uniform, &self.count]).map(wgpu::Buffer::size).sum()
    }
}

/// A box that holds all positions in every frame. Lights that stay may lie outside the motion's box.
fn bounds_of(motion: &Motion, resting: &LightBuffer) -> (Vec3, Vec3) {
    let reach = motion.reach();
    match resting.position_bounds() {
        Some((low, high)) if motion.speed_m_s() == 0.0 => (reach.min.min(low), reach.max.max(high)),
        _ => (reach.min, reach.max),
    }
}

/// The largest radius of a light's ball in any frame, metres.
fn radius_max_m(lights: &[Light]) -> f32 {
    let radius_m = |light: &Light| match light.shape {
        LightShape::Area(_) => light.radius_m() * TURNED_GROWTH,
        LightShape::Point | LightShape::Spot { .. } | LightShape::Vpl { .. } => light.radius_m(),
    };
    lights.iter().map(radius_m).fold(MIN_RANGE_M, f32::max)
}

#[cfg(test)]
mod tests {
    use assign::{EncoderPasses, conformance::LinkedModule, struct_layout};
    use scenes::{Aabb, LightSpec, MotionLaw, scatter_lights};

    use super::*;

    #[test]
    fn the_uniform_is_laid_out_as_in_wesl() {
        let source = moving_lights_shader().link("package::moving_lights").expect("links");
        let module = LinkedModule::new("moving lights", &source);
        let rust = struct_layout!(MotionUniform: min_world, speed_m_s, max_world, diagonal_m, seed,
            law, light_count, whole_s, part_s);
        assert_eq!(module.layout_of("MotionRules"), rust, "WESL, then Rust");
        assert_eq!(module.used_bindings(), (0..8).map(|binding| (0, binding)).collect());
        assert_eq!(module.constant("LANES"), LANES);
        assert_eq!(module.constant("MAX_VERTICES") as usize, assign::MAX_VERTICES);
    }

    #[test]
    fn one_workgroup_strides_over_all_lights() {
        let gpu = Gpu::open(None).expect("an adapter: scripts/test installs the software one");
        let bounds = Aabb::new(Vec3::splat(-5.0), Vec3::splat(5.0));
        let lights = scatter_lights(&LightSpec::new(300, bounds)).expect("valid");
        let motion = Motion::new(MotionLaw::Drift, 1.0, 1, bounds).expect("valid");
        let moved = |most: u32| {
            let mut moving = MovingLights::new(&gpu, &motion, &lights).expect("fits");
            moving.workgroups = moving.workgroups.min(most);
            let mut encoder = gpu.device.create_command_encoder(&Default::default());
            moving.record(&mut EncoderPasses { encoder: &mut encoder });
            gpu.queue.submit([encoder.finish()]);
            gpu.read(moving.lights().spheres, 300 * 16).expect("readable")
        };
        assert_eq!(moved(1), moved(u32::MAX));
        assert!(moved(1).chunks(16).all(|sphere| sphere.iter().any(|&byte| byte != 0)));
    }
}
