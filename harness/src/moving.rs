//! Lights that move: where they are in a frame, and what it costs to bring them to the GPU.

use std::{borrow::Cow, time::Instant};

use assign::{AssignError, EncoderPasses, Gpu, Light, LightBuffer, RejectedLight};
use glam::Vec3;
use scenes::{Aabb, LightAnimation, Motion, Scene};
use shading::MovingLights;

use crate::{
    cli::{CliError, MotionChoice, MovedBy, StageArgs},
    error::HarnessError,
    results::MotionSetting,
};

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
    law: Law,
    /// The frame that the lights show.
    frame: Option<u32>,
    /// The frame whose lights the buffer last took.
    shown: Option<u32>,
    /// Lights of each kind at rest.
    kinds: [u64; 8],
    /// Faulty lights at rest.
    rejected: Vec<RejectedLight>,
    /// The most lights that were left out in a frame.
    most_left_out: usize,
    mover: Mover,
}

/// Where a light is at a time.
enum Law {
    Motion(Motion),
    /// The animation of the scene's own lights, which come first, and the speed of its clock.
    File(Box<LightAnimation>, f32),
}

impl Law {
    fn lights_at(&self, rest: &[Light], time_s: f32, now: &mut Vec<Light>) {
        match self {
            Self::Motion(motion) => motion.lights_at(rest, time_s, now),
            Self::File(animation, speed) => {
                now.clear();
                now.extend_from_slice(rest);
                animation.pose_lights(time_s * speed, now);
            }
        }
    }
}

/// Who moves the lights.
enum Mover {
    Cpu {
        /// The lights at rest, and those of the last frame.
        rest: Vec<Light>,
        now: Vec<Light>,
        upload: Upload,
    },
    Gpu(Box<MovingLights>),
}

impl Moving {
    /// Lights that rest at `lights` and move as the arguments say; `None` if they stand still.
    pub fn new(
        gpu: &Gpu,
        args: &StageArgs,
        scene: &Scene,
        lights: Vec<Light>,
    ) -> Result<Option<Self>, HarnessError> {
        let Some(choice) = args.motion.motion else { return Ok(None) };
        let kinds = kinds_of(&lights);
        let rejected = rejected_of(&lights);
        let speed = args.motion.speed as f32;
        let law = match choice {
            MotionChoice::Law(law) => {
                Law::Motion(Motion::new(law, speed, args.seed, places_of(&lights))?)
            }
            MotionChoice::File => {
                let animation = scene.light_animation.clone().filter(|_| !args.no_own_lights);
                let missing = || {
                    let accepted = format!(
                        "one of the laws, because {} animates no light of its own",
                        scene.name
                    );
                    CliError::out_of_range("--motion", "file", &accepted)
                };
                Law::File(Box::new(animation.ok_or_else(missing)?), speed)
            }
        };
        let mover = match (args.motion.moved_by, &law) {
            (MovedBy::Cpu, _) => {
                Mover::Cpu { rest: lights, now: Vec::new(), upload: Upload::default() }
            }
            (MovedBy::Gpu, Law::Motion(motion)) => {
                Mover::Gpu(Box::new(MovingLights::new(gpu, motion, &lights)?))
            }
            (MovedBy::Gpu, Law::File(..)) => {
                let accepted = "cpu with --motion file: only the CPU plays a file's animation";
                return Err(CliError::out_of_range("--moved-by", "gpu", accepted).into());
            }
        };
        let most_left_out = rejected.len();
        Ok(Some(Self { law, frame: None, shown: None, kinds, rejected, most_left_out, mover }))
    }

    /// Brings the lights of a frame to the GPU. A kernel's work is submitted, off the clock.
    pub fn go_to(
        &mut self,
        gpu: &Gpu,
        frame: u32,
        buffer: &mut LightBuffer,
    ) -> Result<(), HarnessError> {
        if self.frame == Some(frame) {
            return Ok(());
        }
        let time_s = frame as f32 / FRAMES_PER_S;
        match &mut self.mover {
            Mover::Cpu { rest, now, upload } => {
                self.law.lights_at(rest, time_s, now);
                let began = Instant::now();
                buffer.update(gpu, now)?;
                // The copies run with the next submission.
                gpu.queue.submit([]);
                gpu.wait()?;
                let bytes = buffer.uploaded_bytes();
                *upload = Upload { ms: began.elapsed().as_secs_f64() * 1e3, bytes };
            }
            Mover::Gpu(lights) => {
                lights.prepare(gpu, time_s);
                let step_m = match (&self.law, self.shown) {
                    (Law::Motion(motion), Some(before)) => {
                        motion.farthest_ball_m(before as f32 / FRAMES_PER_S, time_s)
                    }
                    _ => None,
                };
                let mut encoder = gpu.device.create_command_encoder(&Default::default());
                lights.record(&mut EncoderPasses { encoder: &mut encoder });
                gpu.queue.submit([encoder.finish()]);
                buffer.update_from_gpu(gpu, &lights.lights_within(step_m))?;
            }
        }
        self.frame = Some(frame);
        self.shown = Some(frame);
        Ok(())
    }

    /// Has the next frame bring its lights to the GPU, also if it is the frame that is shown.
    pub fn forget_frame(&mut self) {
        self.frame = None;
    }

    /// The number of lights of each kind at rest, by the kind's number.
    pub fn kinds(&self) -> [u64; 8] {
        self.kinds
    }

    /// The faulty lights at rest.
    pub fn rejected(&self) -> &[RejectedLight] {
        &self.rejected
    }

    /// Counts the lights that are faulty in the frame that was drawn last. It waits for the GPU.
    pub fn count_left_out(&mut self, gpu: &Gpu, lights: &LightBuffer) -> Result<(), AssignError> {
        let left_out = match self.mover {
            Mover::Cpu { .. } => lights.rejected().len(),
            Mover::Gpu(_) => {
                let counts = lights.read_counts(gpu)?.unwrap_or_default();
                self.rejected.len() + counts.faulty as usize
            }
        };
        self.most_left_out = self.most_left_out.max(left_out);
        Ok(())
    }

    /// Says how many lights became faulty as they moved; `None` if no counted frame had one.
    pub fn left_out_note(&self) -> Option<String> {
        let words = match self.most_left_out - self.rejected.len() {
            0 => return None,
            1 => "1 light".to_owned(),
            count => format!("{count} lights"),
        };
        Some(format!("{words} became faulty in some frame of the motion, and lit nothing there"))
    }

    /// The lights at rest, all of which frames may light; `None` if only the GPU knows the moved ones.
    pub fn resting(&self) -> Option<&[Light]> {
        match &self.mover {
            Mover::Cpu { rest, .. } => Some(rest),
            Mover::Gpu(_) => None,
        }
    }

    /// The motion as results name it.
    pub fn setting(&self) -> MotionSetting {
        let (law, speed) = match &self.law {
            Law::Motion(motion) => (motion.law().name(), motion.speed_m_s()),
            Law::File(_, speed) => (MotionChoice::File.name(), *speed),
        };
        MotionSetting {
            law: law.to_owned(),
            speed_m_s: f64::from(speed),
            moved_by: match self.mover {
                Mover::Cpu { .. } => "cpu".to_owned(),
                Mover::Gpu(_) => "gpu".to_owned(),
            },
        }
    }

    /// The cost of the last frame's lights; `None` if no light crosses to the GPU.
    pub fn upload(&self) -> Option<Upload> {
        match self.mover {
            Mover::Cpu { upload, .. } => Some(upload),
            Mover::Gpu(_) => None,
        }
    }
}

/// The lights of the frame, in any order. Those that only the GPU knows are read back.
pub fn known_lights<'a>(
    gpu: &Gpu,
    lights: &'a LightBuffer,
) -> Result<Cow<'a, [Light]>, AssignError> {
    Ok(match lights.live_count() {
        Some(_) => Cow::Owned(lights_by_slot(gpu, lights)?),
        None => Cow::Borrowed(lights.lights()),
    })
}

/// The lights by slot. Lights that the GPU orders are ordered first.
pub fn lights_by_slot(gpu: &Gpu, lights: &LightBuffer) -> Result<Vec<Light>, AssignError> {
    order_off_clock(gpu, lights);
    lights.read(gpu)
}

/// Has the GPU order the lights, off the clock, if it is the GPU that does so.
pub fn order_off_clock(gpu: &Gpu, lights: &LightBuffer) {
    let mut encoder = gpu.device.create_command_encoder(&Default::default());
    lights.record(&mut EncoderPasses { encoder: &mut encoder });
    gpu.queue.submit([encoder.finish()]);
}

/// Bytes of what the GPU needs to order lights in every frame: the sort, and the copies of the lights in their
/// order. Without the hierarchy, which strategies count, and without the lights as they were given, which every
/// method needs. 0 if the CPU orders the lights.
pub fn order_bytes(lights: &LightBuffer) -> u64 {
    if !lights.order().is_on_gpu() {
        return 0;
    }
    // Lights from the CPU lie there twice: as given and in their order, but for their shapes.
    let given = match lights.live_count() {
        Some(_) => 0,
        None => [lights.spheres(), lights.emissions(), lights.shapes()]
            .map(wgpu::Buffer::size)
            .iter()
            .sum(),
    };
    lights.memory_bytes().saturating_sub(lights.nodes().size() + given)
}

/// The box around the positions of the sound lights; the origin without any.
fn places_of(lights: &[Light]) -> Aabb {
    let sound = lights.iter().filter(|light| light.check().is_ok());
    let bounds = Aabb::from_points(sound.map(|light| light.position));
    if bounds.is_empty() { bounds.extended(Vec3::ZERO) } else { bounds }
}

/// The faulty lights, with their places.
fn rejected_of(lights: &[Light]) -> Vec<RejectedLight> {
    let rejected = |(index, light): (usize, &Light)| {
        light.check().err().map(|fault| RejectedLight { index, fault })
    };
    lights.iter().enumerate().filter_map(rejected).collect()
}

/// The number of sound lights of each kind, by the kind's number.
pub(crate) fn kinds_of(lights: &[Light]) -> [u64; 8] {
    let mut kinds = [0; 8];
    for light in lights.iter().filter(|light| light.check().is_ok()) {
        kinds[light.kind() as usize] += 1;
    }
    kinds
}

#[cfg(test)]
mod tests {
    use assign::GpuLights;
    use scenes::{LightSpec, MotionLaw, scatter_lights};

    use super::*;

    #[test]
    fn lights_that_become_faulty_on_the_gpu_are_noted() {
        let gpu = Gpu::open(None).expect("an adapter: scripts/test installs the software one");
        let bounds = Aabb::new(Vec3::splat(-5.0), Vec3::splat(5.0));
        let mut lights = scatter_lights(&LightSpec::new(20, bounds)).expect("valid");
        lights[3].range_m = f32::NAN;
        let motion = Motion::new(MotionLaw::Drift, 1.0, 1, bounds).expect("valid");
        let mover = MovingLights::new(&gpu, &motion, &lights).expect("fits");
        // A box that holds no light.
        let away = (Vec3::splat(100.0), Vec3::splat(101.0));
        let buffers = [mover.lights(), GpuLights { bounds: away, ..mover.lights() }]
            .map(|given| LightBuffer::from_gpu(&gpu, &given, 1).expect("fits"));
        let mut encoder = gpu.device.create_command_encoder(&Default::default());
        mover.record(&mut EncoderPasses { encoder: &mut encoder });
        gpu.queue.submit([encoder.finish()]);
        let mut moving = Moving {
            law: Law::Motion(motion),
            shown: None,
            frame: None,
            kinds: kinds_of(&lights),
            rejected: rejected_of(&lights),
            most_left_out: 1,
            mover: Mover::Gpu(Box::new(mover)),
        };
        assert_eq!(moving.rejected()[0].index, 3);
        let expected = "19 lights became faulty in some frame of the motion, and lit nothing there";
        // The count of a later frame does not hide that of an earlier one.
        for (buffer, note) in [(0, None), (1, Some(expected)), (0, Some(expected))] {
            order_off_clock(&gpu, &buffers[buffer]);
            moving.count_left_out(&gpu, &buffers[buffer]).expect("readable");
            assert_eq!(moving.left_out_note().as_deref(), note);
        }
    }
}
