//! The virtual point lights of a stage, which stand for the light that surfaces reflect.
//!
//! [`Bounce`] makes them on the GPU. The order of the lights (`--light-order`) decides what happens then:
//!
//! - `gpu`, the default: every frame makes them anew, and they stay on the GPU. From the reflective shadow
//!   map to the image, a frame is one submission.
//! - The orders of the CPU: they are made once, read back, ordered, and uploaded, before the frames. Making
//!   them is timed by itself.

mod bounce;
mod ranges;

use std::{sync::Arc, time::Instant};

use assign::{Gpu, Light, LightBuffer, LightOrder};
use assign_cdi::Primary;
use scenes::Scene;
use shading::{Renderer, WorldTriangles};

pub use bounce::{Bounce, all_texels};
pub use ranges::points_of;

use crate::{
    cli::{StageArgs, name_of},
    clock::PassClock,
    drift::WarmUp,
    error::HarnessError,
    moving::order_off_clock,
    pass_samples::PassSamples,
    results::{self, Passes, Vpls, median},
};
use ranges::drawn_span;

/// Frames to time: on a GPU, and on a software adapter.
const FRAMES: [u32; 2] = [32, 1];

/// How often the way of the lights over the CPU is timed, likewise.
const READ_BACKS: [u32; 2] = [8, 1];

/// Makes virtual point lights. Keeps the scene's triangles between calls.
#[derive(Default)]
pub struct VplMaker {
    triangles: Option<Arc<WorldTriangles>>,
}

/// Lights, and figures about making them.
pub struct Made {
    /// The lights.
    pub lights: LightBuffer,
    /// What makes them anew in every frame, if the GPU orders them.
    pub bounce: Option<Bounce>,
    /// Times and counts of making them.
    pub figures: Vpls,
    /// Lights that the GPU found faulty, which light nothing.
    pub faulty: u32,
}

impl VplMaker {
    /// The scene's triangles. It must be the same in every call.
    pub fn triangles(
        &mut self,
        gpu: &Gpu,
        scene: &Scene,
    ) -> Result<Arc<WorldTriangles>, HarnessError> {
        let known = match self.triangles.take() {
            Some(known) => known,
            None => Arc::new(WorldTriangles::new(gpu, scene)?),
        };
        Ok(Arc::clone(self.triangles.insert(known)))
    }

    /// Turns the light of `primary` that surfaces reflect into virtual point lights. The scene must be the
    /// same in every call.
    ///
    /// # Errors
    ///
    /// The light has no shadow map, the deep images do not fit, or the device fails.
    pub fn make(
        &mut self,
        gpu: &Gpu,
        scene: &Scene,
        renderer: &Renderer,
        primary: Light,
        args: &StageArgs,
    ) -> Result<Made, HarnessError> {
        let casts = args.bounce.ranges.casts();
        let order = args.light_order();
        // A sample may be lit by all lights that fit, and a software adapter ends long loops.
        let limit = gpu.max_loop_rounds().filter(|_| order.is_on_gpu());
        let triangles = if casts { Some(self.triangles(gpu, scene)?) } else { None };
        let mut bounce = Bounce::new(gpu, (scene, renderer), primary, args, limit, triangles)?;
        let passes = if order.is_on_gpu() {
            bounce.run(gpu)?;
            Passes::default()
        } else {
            time(gpu, &mut bounce)?
        };
        let counts = bounce.vpls().read_counts(gpu)?;
        let known = bounce.vpls().read(gpu)?;
        let sum: f64 = known.iter().map(|light| f64::from(light.range_m)).sum();
        let set = bounce.vpls().settings();
        let mut figures = Vpls {
            rsm_px: args.bounce.vpls,
            ranges: name_of(&args.bounce.ranges),
            rays: if casts { args.bounce.rays } else { 0 },
            is_reflected: casts && args.bounce.primary_ray == Primary::Reflected,
            is_corrected: casts && args.bounce.correct_rays,
            range_scale: f64::from(set.range_scale),
            given_ranges_m: drawn_span(scene, &args.bounce).map(|span| [span.low_m, span.high_m]),
            has_fresnel: true,
            build_errors: results::Errors::new(),
            spacing_m: f64::from(set.spacing_m),
            clamp_m: f64::from(set.min_distance_m),
            candidates: u64::from(counts.chosen),
            too_small: u64::from(counts.too_small),
            too_large: u64::from(counts.too_large),
            kept: u64::from(counts.kept),
            mean_range_m: if known.is_empty() { 0.0 } else { sum / known.len() as f64 },
            deep: bounce.deep(args),
            passes,
            read_back_ms: None,
        };
        if !order.is_on_gpu() {
            let (lights, read_back_ms) = read_back(gpu, &bounce, order)?;
            figures.read_back_ms = Some(read_back_ms);
            return Ok(Made { lights, bounce: None, figures, faulty: 0 });
        }
        let mut lights = LightBuffer::ordered(gpu, &[], order)?;
        lights.update_from_gpu(gpu, &bounce.lights())?;
        order_off_clock(gpu, &lights);
        let faulty = lights.read_counts(gpu)?.map_or(0, |counts| counts.faulty);
        Ok(Made { lights, bounce: Some(bounce), figures, faulty })
    }
}

/// Makes the lights again and again, each pass on the clock.
fn time(gpu: &Gpu, bounce: &mut Bounce) -> Result<Passes, HarnessError> {
    let kind = usize::from(gpu.is_software());
    let mut samples = PassSamples::default();
    let mut clock = PassClock::new(gpu);
    let mut warm_up = WarmUp::new(gpu.is_software());
    let mut timed = 0;
    while timed < FRAMES[kind] {
        bounce.prepare(gpu)?;
        bounce.record(&mut clock)?;
        let times = clock.finish()?;
        // A software adapter has no clock to raise, so its first frame counts.
        if gpu.is_software() || warm_up.is_warm() {
            samples.collect(times);
            timed += 1;
        } else {
            warm_up.feed(times.iter().map(|(_, ms)| ms).sum());
        }
    }
    Ok(samples.finish())
}

/// Reads the lights back, orders them on the CPU, and uploads them; returns how long that takes, ms.
fn read_back(
    gpu: &Gpu,
    bounce: &Bounce,
    order: LightOrder,
) -> Result<(LightBuffer, f64), HarnessError> {
    let once = || -> Result<(LightBuffer, f64), HarnessError> {
        let began = Instant::now();
        let lights = LightBuffer::ordered(gpu, &bounce.vpls().read(gpu)?, order)?;
        // The copies run with the next submission.
        gpu.queue.submit([]);
        gpu.wait()?;
        Ok((lights, began.elapsed().as_secs_f64() * 1e3))
    };
    let (lights, first_ms) = once()?;
    let mut times_ms = vec![first_ms];
    for _ in 1..READ_BACKS[usize::from(gpu.is_software())] {
        times_ms.push(once()?.1);
    }
    Ok((lights, median(&times_ms)))
}
