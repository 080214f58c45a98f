//! A method with the pipelines that draw with it.

use assign::{Assignment, Gpu, Passes};
use shading::{Cut, Lighting, LightingOptions, Mode, RasterSpheres, record_before_lighting};

use crate::{error::HarnessError, stage::Stage, strategy::Method};

/// A method with the pipelines that draw with it.
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
    /// Surfaces alone.
    Clay,
}

impl<'a> Painter<'a> {
    /// Compiles what `method` needs in one mode.
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

    /// Whether lists are made, whose pool may have to grow.
    pub fn has_groups(&self) -> bool {
        match self {
            Self::Lists { strategy, .. } => strategy.lists().group_count() > 0,
            Self::RasterSphere(_) | Self::Clay => false,
        }
    }

    /// Has lists that are kept over frames made anew.
    pub fn expire(&mut self) {
        if let Self::Lists { strategy, .. } = self {
            strategy.lists_mut().expire();
        }
    }

    /// Records one frame: geometry, the strategy's passes, lighting. Returns whether no list of
    /// the frame before overflowed.
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
                record_before_lighting(renderer, mode, *strategy, &frame, passes);
                lighting.record(renderer, view, *strategy, passes)?;
                // The counters of the frame before: this one grew the pool to what it asked for.
                Ok(strategy.lists().stats().is_none_or(|c| c.overflowed_groups == 0))
            }
            Self::RasterSphere(spheres) => {
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

/// Light volumes.
pub(crate) fn raster_spheres(stage: &Stage, cut: Cut) -> Result<RasterSpheres, HarnessError> {
    let Stage { renderer, lights, area_model, suns, .. } = stage;
    Ok(RasterSpheres::new(renderer, lights.kinds(), *area_model, cut, *suns)?)
}
