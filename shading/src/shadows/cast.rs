//! A renderer with shadow maps.

use assign::{AssignError, EncoderPasses, LightBuffer, Passes, Suns};

use super::{Asked, OccluderDepth, ShadowFigures, ShadowMaps, SunnyScene};
use crate::{Renderer, ShadingError, ShadowModel, bound_maps::BoundMaps};

impl Renderer {
    /// Makes shadow maps for lights that stand still, and draws them, in a submission of its own. It holds for frames
    /// that are prepared afterwards, with [`Lighting`](crate::Lighting) that is made afterwards. Frames with other
    /// lights are refused until it is called again, or [`move_shadows`](Self::move_shadows). [`ShadowModel::None`] removes the
    /// maps.
    ///
    /// Returns what was made; `None` without shadows. If the maps that the model asks for do not fit the largest atlas
    /// of the device, all area lights get fewer, and [`ShadowFigures::fell_back`] says so.
    ///
    /// # Errors
    ///
    /// [`AssignError::Unsupported`](assign::AssignError::Unsupported) for lights that the GPU moves, makes or orders,
    /// [`AssignError::Parameter`](assign::AssignError::Parameter) for faulty models and if not even one map for each
    /// light fits, and [`AssignError::OutOfMemory`](assign::AssignError::OutOfMemory). The renderer then has no maps.
    pub fn cast_shadows(
        &mut self,
        lights: &LightBuffer,
        model: ShadowModel,
    ) -> Result<Option<ShadowFigures>, ShadingError> {
        let mut encoder = self.gpu.device.create_command_encoder(&Default::default());
        let mut passes = EncoderPasses { encoder: &mut encoder };
        let figures = self.cast_shadows_in(lights, model, &mut passes)?;
        self.gpu.queue.submit([encoder.finish()]);
        Ok(figures)
    }

    /// Has maps that are cast afterwards leave out what lies beyond so many ranges of its light: it hides no sample within
    /// them. 1 serves lights that end at their range, and [`LightingOptions::ranges_lit`](crate::LightingOptions::ranges_lit)
    /// says what other options need. Without this call, maps hold all that a face sees. Images are the same.
    pub fn cast_shadows_within(&mut self, ranges: f32) {
        self.shadow_ranges = ranges;
    }

    /// Has maps that are cast afterwards shadow suns, too: each gets one map of the whole scene, with as many texels as a
    /// face of a light's map. [`LightingOptions::suns`](crate::LightingOptions::suns) must then be these.
    pub fn cast_shadows_of_suns(&mut self, suns: Suns) {
        self.shadow_suns = suns;
    }

    /// [`cast_shadows`](Self::cast_shadows), but records the pass `shadow-maps` into `passes`. The caller submits them
    /// before the first frame that reads the maps, and can time them.
    ///
    /// # Errors
    ///
    /// Those of [`cast_shadows`](Self::cast_shadows).
    pub fn cast_shadows_in(
        &mut self,
        lights: &LightBuffer,
        model: ShadowModel,
        passes: &mut dyn Passes,
    ) -> Result<Option<ShadowFigures>, ShadingError> {
        // The old atlas makes room for the new one.
        self.shadows = None;
        if !model.is_on() {
            return Ok(None);
        }
        let asked = Asked {
            model,
            ranges: self.shadow_ranges,
            only_opaque: self.layer_kinds().sheets,
            sunny: SunnyScene { suns: self.shadow_suns, bounds: self.surface_bounds },
        };
        let maps = ShadowMaps::new(&self.gpu, &self.scene, &self.frame, lights, asked)?;
        let figures = maps.figures();
        self.shadows = Some(maps);
        self.record_shadow_maps(passes);
        Ok(Some(figures))
    }

    /// Finds what hides lights from whole groups, for strategies with [`CullSettings::occlusion`](assign::CullSettings):
    /// records the pass `occluders` into `passes`, after those of [`cast_shadows_in`](Self::cast_shadows_in).
    /// [`frame`](Self::frame) hands it over from then on, until shadows are cast again.
    ///
    /// # Errors
    ///
    /// [`AssignError::Parameter`] without shadow maps, [`AssignError::Unsupported`] for [`ShadowModel::Pcss`] and
    /// [`ShadowModel::Paraboloids`], and
    /// [`AssignError::OutOfMemory`].
    pub fn find_occluders_in(
        &mut self,
        kept: OccluderDepth,
        passes: &mut dyn Passes,
    ) -> Result<ShadowFigures, ShadingError> {
        let Some(maps) = &mut self.shadows else {
            return Err(AssignError::Parameter {
                field: "shadow model".into(),
                value: ShadowModel::None.to_string(),
                accepted: "a model with maps, cast before Renderer::find_occluders".into(),
            }
            .into());
        };
        let model = maps.figures().model;
        if model.is_soft() || model.is_curved() {
            return Err(AssignError::Unsupported {
                strategy: "the test of what hides lights".into(),
                asked: format!("shadow model {model}"),
                reason: "it knows which texels flat faces with small filters read".into(),
            }
            .into());
        }
        maps.make_pyramid(&self.gpu, kept)?;
        maps.record_occluders(passes);
        Ok(maps.figures())
    }

    /// [`find_occluders_in`](Self::find_occluders_in), in a submission of its own.
    ///
    /// # Errors
    ///
    /// Those of [`find_occluders_in`](Self::find_occluders_in).
    pub fn find_occluders(&mut self, kept: OccluderDepth) -> Result<ShadowFigures, ShadingError> {
        let mut encoder = self.gpu.device.create_command_encoder(&Default::default());
        let figures = self.find_occluders_in(kept, &mut EncoderPasses { encoder: &mut encoder })?;
        self.gpu.queue.submit([encoder.finish()]);
        Ok(figures)
    }

    /// Moves the maps with their lights, for frames whose lights are no longer those of
    /// [`cast_shadows`](Self::cast_shadows). It plans the maps on the CPU and uploads their places, through the queue: call it
    /// once per submission, before [`prepare`](Self::prepare). Then record [`record_shadow_maps`](Self::record_shadow_maps),
    /// and [`record_occluders`](Self::record_occluders) for strategies that ask what hides lights, before the strategy's
    /// passes. [`Lighting`](crate::Lighting) stays the same. Does nothing without maps, and if no light has changed.
    ///
    /// The atlas keeps its size. Cast shadows for as many lights as any frame has.
    ///
    /// # Errors
    ///
    /// [`AssignError::Unsupported`] for lights that the GPU moves, makes or orders, and for models that frames subdivide.
    /// [`AssignError::Parameter`] if the lights need a larger atlas than those for which shadows were cast. The maps then
    /// stay as they are.
    pub fn move_shadows(&mut self, lights: &LightBuffer) -> Result<(), ShadingError> {
        let Self { gpu, shadows, .. } = self;
        shadows.as_mut().map_or(Ok(()), |maps| maps.follow(gpu, lights))
    }

    /// Records the pass `shadow-maps`, which draws all maps again; nothing without maps.
    pub fn record_shadow_maps(&mut self, passes: &mut dyn Passes) {
        let Self { scene, scene_group, shadows, .. } = self;
        if let Some(maps) = shadows {
            maps.record(scene, scene_group, passes);
        }
    }

    /// Records the pass `occluders`, which finds again what hides lights from groups, after `shadow-maps`; nothing without
    /// [`find_occluders`](Self::find_occluders).
    pub fn record_occluders(&mut self, passes: &mut dyn Passes) {
        if let Some(maps) = &mut self.shadows {
            maps.record_occluders(passes);
        }
    }

    /// Refuses shaders that read other maps than the renderer's, and maps that were not drawn for the present lights.
    /// `asks_occluders`: lists were made by what hides lights.
    pub(crate) fn check_maps(
        &self,
        bound: Option<&BoundMaps>,
        asks_occluders: bool,
    ) -> Result<(), ShadingError> {
        let Some(bound) = bound else { return Ok(()) };
        let is_current = self.shadows.as_ref().is_some_and(|maps| {
            maps.is_drawn()
                && maps.bound().is_same(bound)
                && (!asks_occluders || maps.has_occluders())
        });
        if is_current { Ok(()) } else { Err(ShadingError::StaleShadows) }
    }

    /// What was made for the present shadows; `None` without any.
    pub fn shadow_figures(&self) -> Option<ShadowFigures> {
        self.shadows.as_ref().map(ShadowMaps::figures)
    }

    /// The number of maps of each rectangle, in the order of the lights' slots, and how many rectangles have no places
    /// for more; `None` if frames do not subdivide them.
    pub fn shadow_subdivision(&self) -> Option<(Vec<u32>, u32)> {
        self.shadows.as_ref()?.subdivision()
    }

    /// The maps as lighting reads them.
    pub(crate) fn shadow_maps(&self) -> Option<&BoundMaps> {
        self.shadows.as_ref().map(ShadowMaps::bound)
    }
}
