//! A strategy with the pipelines that draw its frames.

use assign::{Assignment, Gpu, LightBuffer, Passes};
use shading::{Cut, Lighting, LightingOptions, Mode, RasterSpheres, record_before_lighting};

use crate::{
    error::HarnessError, moving::order_off_clock, prefixed::Prefixed, stage::Stage,
    strategy::Method, vpls::Bounce,
};

/// A strategy with the pipelines that draw its frames.
pub enum Painter<'a> {
    /// Lists, and lighting by them.
    Lists {
        /// The strategy.
        strategy: &'a mut dyn Assignment,
        /// Lighting with its look-up.
        lighting: Box<Lighting>,
        /// The number of the frame, if it draws at random: its seed.
        frame_ix: Option<u32>,
    },
    /// Light volumes.
    RasterSphere(Box<RasterSpheres>),
    /// Surfaces without lights.
    Clay,
}

impl<'a> Painter<'a> {
    /// Compiles the pipelines that `method` needs in one mode.
    pub fn new(
        stage: &Stage,
        method: &'a mut Method,
        mode: Mode,
        cut: Cut,
    ) -> Result<Self, HarnessError> {
        let kinds = stage.lights.kinds();
        Ok(match method {
            Method::Lists { strategy, early_exit, stochastic, is_random } => {
                let exit_weight = if *early_exit { 0.0 } else { LightingOptions::EVALUATE_ALL };
                let options = LightingOptions {
                    kinds,
                    exit_weight,
                    cut,
                    area: stage.area_model,
                    compensation: stage.compensation,
                    stochastic: *stochastic,
                    specular_reach: stage.specular_reach,
                    area_lod: stage.area_lod,
                    suns: stage.suns,
                    shadows: stage.shadows,
                };
                let lighting = Lighting::new(&stage.renderer, strategy.as_ref(), mode, options)?;
                let frame_ix = is_random.then_some(0);
                Self::Lists { strategy: strategy.as_mut(), lighting: Box::new(lighting), frame_ix }
            }
            Method::RasterSphere => Self::RasterSphere(Box::new(raster_spheres(stage, cut)?)),
            Method::Clay => Self::Clay,
        })
    }

    /// Whether it makes lists, whose pool may have to grow.
    pub fn has_groups(&self) -> bool {
        match self {
            Self::Lists { strategy, .. } => strategy.lists().group_count() > 0,
            Self::RasterSphere(_) | Self::Clay => false,
        }
    }

    /// Expires lists that are reused over frames, so that the next frame makes new ones.
    pub fn expire(&mut self) {
        if let Self::Lists { strategy, .. } = self {
            strategy.lists_mut().expire();
        }
    }

    /// Prepares and records one frame. Returns whether all lists of the previous frame did fit.
    pub fn draw(
        &mut self,
        gpu: &Gpu,
        stage: &mut Stage,
        mode: Mode,
        passes: &mut dyn Passes,
    ) -> Result<bool, HarnessError> {
        let fitted = self.prepare(gpu, stage)?;
        self.record(gpu, stage, mode, passes)?;
        Ok(fitted)
    }

    /// Allocates and uploads what a frame needs, off the clock. Returns whether all lists of the previous frame
    /// did fit.
    pub fn prepare(&mut self, gpu: &Gpu, stage: &mut Stage) -> Result<bool, HarnessError> {
        let Stage { renderer, view, lights, bounce, .. } = stage;
        if let (Some(bounce), Self::Lists { .. } | Self::RasterSphere(_)) = (bounce, &self) {
            bounce.prepare(gpu)?;
        }
        let Self::Lists { strategy, frame_ix, .. } = self else { return Ok(true) };
        if let Some(frame_ix) = frame_ix {
            renderer.reseed(view, lights, *frame_ix)?;
            *frame_ix = frame_ix.wrapping_add(1);
        }
        strategy.prepare(gpu, &renderer.frame(view, lights))?;
        // These are the counters of the previous frame; `prepare` grew the pool to what it asked for.
        Ok(strategy.lists().stats().is_none_or(|c| c.overflowed_groups == 0))
    }

    /// Records one frame: the shadow maps of lights that move, the lights, geometry, the strategy's passes, lighting. It submits nothing, except to
    /// order lights off the clock that no frame makes.
    pub fn record(
        &mut self,
        gpu: &Gpu,
        stage: &mut Stage,
        mode: Mode,
        passes: &mut dyn Passes,
    ) -> Result<(), HarnessError> {
        let moves = stage.moving.is_some();
        let Stage { renderer, view, lights, bounce, .. } = stage;
        match self {
            Self::Lists { strategy, lighting, .. } => {
                if moves {
                    renderer.record_shadow_maps(passes);
                }
                if moves && strategy.needs().occluders {
                    renderer.record_occluders(passes);
                }
                record_lights(gpu, lights, bounce, strategy.needs().hierarchy, passes)?;
                let frame = renderer.frame(view, lights);
                record_before_lighting(renderer, mode, *strategy, &frame, passes);
                lighting.record(renderer, view, *strategy, passes)?;
            }
            Self::RasterSphere(spheres) => {
                if moves {
                    renderer.record_shadow_maps(passes);
                }
                record_lights(gpu, lights, bounce, false, passes)?;
                renderer.record_depth(view, passes);
                match mode {
                    Mode::DeferredIds => renderer.record_gbuffer_with_ids(view, passes),
                    _ => renderer.record_gbuffer(view, passes),
                }
                spheres.record(renderer, view, lights, passes)?;
            }
            Self::Clay => {
                renderer.record_depth(view, passes);
                renderer.record_clay(view, passes);
            }
        }
        Ok(())
    }
}

/// Makes the lights and has the GPU order them, if it does so in every frame. Only methods that read the
/// hierarchy need the order, and only they pay for it. All methods read the lights in the same order, so that
/// their images can be compared bit for bit. So the others order them too: off the clock, or as part of making
/// the lights, because lights that this frame makes can be ordered only within it.
fn record_lights(
    gpu: &Gpu,
    lights: &LightBuffer,
    bounce: &mut Option<Bounce>,
    is_billed: bool,
    passes: &mut dyn Passes,
) -> Result<(), HarnessError> {
    if let Some(bounce) = bounce {
        bounce.record(passes)?;
    }
    match (lights.order().is_on_gpu(), is_billed) {
        (true, true) => lights.record(passes),
        (true, false) if bounce.is_some() => lights.record(&mut Prefixed::new("vpl-", passes)),
        (true, false) => order_off_clock(gpu, lights),
        (false, _) => {}
    }
    Ok(())
}

/// Light volumes.
pub(crate) fn raster_spheres(stage: &Stage, cut: Cut) -> Result<RasterSpheres, HarnessError> {
    let Stage { renderer, lights, area_model, suns, shadows, .. } = stage;
    Ok(RasterSpheres::new(renderer, lights.kinds(), *area_model, cut, *suns, *shadows)?)
}
