//! A strategy with the pipelines that draw its frames.

use assign::{Assignment, Gpu, LightBuffer, Passes};
use shading::{Cut, Lighting, LightingOptions, Mode, RasterSpheres, record_before_lighting};

use crate::{error::HarnessError, moving::order_off_clock, stage::Stage, strategy::Method};

/// A strategy with the pipelines that draw its frames.
pub enum Painter<'a> {
    /// Lists, and lighting by them.
    Lists {
        /// The strategy.
        strategy: &'a mut dyn Assignment,
        /// Lighting with its look-up.
        lighting: Lighting,
    },
    /// Light volumes.
    RasterSphere(RasterSpheres),
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
            Method::Lists { strategy, early_exit } => {
                let exit_weight = if *early_exit { 0.0 } else { LightingOptions::EVALUATE_ALL };
                let options = LightingOptions {
                    kinds,
                    exit_weight,
                    cut,
                    area: stage.area_model,
                    compensation: stage.compensation,
                    suns: stage.suns,
                };
                let lighting = Lighting::new(&stage.renderer, strategy.as_ref(), mode, options)?;
                Self::Lists { strategy: strategy.as_mut(), lighting }
            }
            Method::RasterSphere => Self::RasterSphere(raster_spheres(stage, cut)?),
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

    /// Records one frame: geometry, the strategy's passes, lighting. Returns whether all lists of the previous
    /// frame did fit.
    pub fn draw(
        &mut self,
        gpu: &Gpu,
        stage: &Stage,
        mode: Mode,
        passes: &mut dyn Passes,
    ) -> Result<bool, HarnessError> {
        let Stage { renderer, view, lights, .. } = stage;
        match self {
            Self::Lists { strategy, lighting } => {
                let frame = renderer.frame(view, lights);
                strategy.prepare(gpu, &frame)?;
                order_lights(gpu, lights, strategy.needs().hierarchy, passes);
                record_before_lighting(renderer, mode, *strategy, &frame, passes);
                lighting.record(renderer, view, *strategy, passes)?;
                // These are the counters of the previous frame; `prepare` grew the pool to what it asked for.
                Ok(strategy.lists().stats().is_none_or(|c| c.overflowed_groups == 0))
            }
            Self::RasterSphere(spheres) => {
                order_lights(gpu, lights, false, passes);
                renderer.record_depth(view, passes);
                match mode {
                    Mode::DeferredIds => renderer.record_gbuffer_with_ids(view, passes),
                    _ => renderer.record_gbuffer(view, passes),
                }
                spheres.record(renderer, view, lights, passes)?;
                Ok(true)
            }
            Self::Clay => {
                renderer.record_depth(view, passes);
                renderer.record_clay(view, passes);
                Ok(true)
            }
        }
    }
}

/// Has the GPU order the lights, if it does so in every frame. Only methods that read the hierarchy need it, and
/// only they pay for it. For the others it runs off the clock: all methods read the lights in the same order,
/// so that their images can be compared bit for bit.
fn order_lights(gpu: &Gpu, lights: &LightBuffer, is_billed: bool, passes: &mut dyn Passes) {
    match (lights.order().is_on_gpu(), is_billed) {
        (true, true) => lights.record(passes),
        (true, false) => order_off_clock(gpu, lights),
        (false, _) => {}
    }
}

/// Light volumes.
pub(crate) fn raster_spheres(stage: &Stage, cut: Cut) -> Result<RasterSpheres, HarnessError> {
    let Stage { renderer, lights, area_model, suns, .. } = stage;
    Ok(RasterSpheres::new(renderer, lights.kinds(), *area_model, cut, *suns)?)
}
