//! Lights that move: where they are in a frame, and what it costs to bring them to the GPU.

use std::time::Instant;

use assign::{AssignError, Gpu, Light, LightBuffer};
use glam::Vec3;
use scenes::{Aabb, Motion};

use crate::{cli::StageArgs, error::HarnessError, results::MotionSetting};

/// Frames per second of the lights' clock.
const FRAMES_PER_S: f32 = 60.0;

/// What a frame's lights cost on their way from the CPU to the GPU.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Upload {
    /// Time to check and convert the lights, to compare them with the frame before, and to copy what changed,
    /// until the GPU has it: wall clock, ms.
    pub ms: f64,
    /// Bytes that were copied.
    pub bytes: u64,
}

/// Lights that move by a law.
pub struct Moving {
    motion: Motion,
    /// The lights at rest.
    lights: Vec<Light>,
    /// The lights of the last frame.
    now: Vec<Light>,
    /// The frame that `now` shows.
    frame: Option<u32>,
    upload: Upload,
}

impl Moving {
    /// Lights that rest at `lights` and move as the arguments say; `None` if they stand still.
    pub fn new(args: &StageArgs, lights: Vec<Light>) -> Result<Option<Self>, HarnessError> {
        let Some(law) = args.motion.motion else { return Ok(None) };
        let mut bounds = Aabb::EMPTY;
        for light in lights.iter().filter(|light| light.check().is_ok()) {
            bounds = bounds.extended(light.position);
        }
        if bounds.is_empty() {
            bounds = bounds.extended(Vec3::ZERO);
        }
        let motion = Motion::new(law, args.motion.speed as f32, args.seed, bounds)?;
        let upload = Upload::default();
        Ok(Some(Self { motion, lights, now: Vec::new(), frame: None, upload }))
    }

    /// Brings the lights of a frame to the GPU.
    pub fn go_to(
        &mut self,
        gpu: &Gpu,
        frame: u32,
        buffer: &mut LightBuffer,
    ) -> Result<(), HarnessError> {
        if self.frame == Some(frame) {
            return Ok(());
        }
        self.motion.lights_at(&self.lights, frame as f32 / FRAMES_PER_S, &mut self.now);
        let began = Instant::now();
        buffer.update(gpu, &self.now)?;
        // The copies run with the next submission.
        gpu.queue.submit([]);
        gpu.wait()?;
        let bytes = buffer.uploaded_bytes();
        self.upload = Upload { ms: began.elapsed().as_secs_f64() * 1e3, bytes };
        self.frame = Some(frame);
        Ok(())
    }

    /// The motion as results name it.
    pub fn setting(&self) -> MotionSetting {
        MotionSetting {
            law: self.motion.law().to_string(),
            speed_m_s: f64::from(self.motion.speed_m_s()),
            moved_by: "cpu".to_owned(),
        }
    }

    /// The law.
    pub fn motion(&self) -> &Motion {
        &self.motion
    }

    /// The cost of the last frame's lights; `None` if no light crosses to the GPU.
    pub fn upload(&self) -> Option<Upload> {
        Some(self.upload)
    }
}

/// The lights by slot. Lights that the GPU orders are ordered first.
pub fn lights_by_slot(gpu: &Gpu, lights: &LightBuffer) -> Result<Vec<Light>, AssignError> {
    let mut encoder = gpu.device.create_command_encoder(&Default::default());
    lights.record(&mut assign::EncoderPasses { encoder: &mut encoder });
    gpu.queue.submit([encoder.finish()]);
    lights.read(gpu)
}
