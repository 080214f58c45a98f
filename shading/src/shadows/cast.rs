//! A renderer with shadow maps, or with rays in place of them.

use std::sync::Arc;

use assign::{AssignError, EncoderPasses, LightBuffer, Passes, Suns};
use assign_cdi::{DeepImageSettings, DeepImages};

use super::{Asked, OccluderDepth, ShadowFigures, ShadowMaps, SunnyScene, rays::ShadowRays};
use crate::{Renderer, ShadingError, ShadowModel, WorldTriangles, bound_shadows::BoundShadows};

impl Renderer {
    /// Makes shadow maps for lights that stand still, and draws them, in a submission of its own. It holds for frames
    /// that are prepared afterwards, with [`Lighting`](crate::Lighting) that is made afterwards. Frames with other
    /// lights are refused until it is called again, or [`move_shadows`](Self::move_shadows). [`ShadowModel::None`] removes the
    /// maps.
    ///
    /// With [`ShadowModel::Cdi`] there are no maps: it places points on the lights, and builds deep images of the scene
    /// ([`cast_rays_through`](Self::cast_rays_through)). All else holds alike, but suns cast no
    /// shadows then, and are refused.
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
        self.shadows.ranges = ranges;
    }

    /// Sets what the rays of [`ShadowModel::Cdi`] are cast through, for shadows that are cast afterwards: deep images of
    /// these triangles, which must be those of the scene. [`shadow_images`](crate::shadow_images) are the settings to begin
    /// with. Alpha masks are solid.
    pub fn cast_rays_through(&mut self, triangles: Arc<WorldTriangles>, images: DeepImageSettings) {
        self.shadows.solid = Some((triangles, images));
    }

    /// Has maps that are cast afterwards shadow suns, too: each gets one map of the whole scene, with as many texels as a
    /// face of a light's map. [`LightingOptions::suns`](crate::LightingOptions::suns) must then be these.
    pub fn cast_shadows_of_suns(&mut self, suns: Suns) {
        self.shadows.suns = suns;
    }

    /// [`cast_shadows`](Self::cast_shadows), but records the pass `shadow-maps` into `passes`. The caller submits them
    /// before the first frame that reads the maps, and can time them.
    ///
    /// With [`ShadowModel::Cdi`], deep images are built until they fit, in submissions of their own. It then records
    /// the passes of [`DeepImages::record`] that build them once more.
    ///
    /// # Errors
    ///
    /// Those of [`cast_shadows`](Self::cast_shadows). With [`ShadowModel::Cdi`] also [`AssignError::Parameter`] before
    /// [`cast_rays_through`](Self::cast_rays_through) and for faulty settings, and [`AssignError::TooLarge`] if the images
    /// do not fit.
    pub fn cast_shadows_in(
        &mut self,
        lights: &LightBuffer,
        model: ShadowModel,
        passes: &mut dyn Passes,
    ) -> Result<Option<ShadowFigures>, ShadingError> {
        // The old atlas makes room for the new one.
        self.shadows.clear();
        if !model.is_on() {
            return Ok(None);
        }
        if model.casts_rays() {
            let Some((triangles, images)) = &self.shadows.solid else {
                return Err(AssignError::Parameter {
                    field: "shadow model".into(),
                    value: model.to_string(),
                    accepted: "none or one with maps before Renderer::cast_rays_through".into(),
                }
                .into());
            };
            let asked = (model, self.shadows.ranges);
            let rays = ShadowRays::new(&self.gpu, lights, asked, (triangles, *images))?;
            self.shadows.rays = Some(rays);
        } else {
            let asked = Asked {
                model,
                ranges: self.shadows.ranges,
                only_opaque: self.layer_kinds().sheets,
                sunny: SunnyScene { suns: self.shadows.suns, bounds: self.surface_bounds },
            };
            let maps = ShadowMaps::new(&self.gpu, &self.scene, &self.frame, lights, asked)?;
            self.shadows.maps = Some(maps);
        }
        self.record_shadow_maps(passes);
        Ok(self.shadow_figures())
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
        let model = self.shadow_figures().map_or(ShadowModel::None, |figures| figures.model);
        let Some(maps) = &mut self.shadows.maps else {
            return Err(AssignError::Parameter {
                field: "shadow model".into(),
                value: model.to_string(),
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
    /// passes. [`Lighting`](crate::Lighting) stays the same. Returns whether the maps moved: not without shadows, and not if
    /// no light has changed.
    ///
    /// The atlas keeps its size. Cast shadows for as many lights as any frame has.
    ///
    /// # Errors
    ///
    /// [`AssignError::Unsupported`] for lights that the GPU moves, makes or orders, for models that frames subdivide, and
    /// for rays. [`AssignError::Parameter`] if the lights need a larger atlas than those for which shadows were cast. The maps then
    /// stay as they are.
    pub fn move_shadows(&mut self, lights: &LightBuffer) -> Result<bool, ShadingError> {
        let Self { gpu, shadows, .. } = self;
        if let Some(rays) = shadows.rays.as_ref().filter(|rays| rays.lights() != lights.lights()) {
            return Err(AssignError::Unsupported {
                strategy: format!("shadow model {}", rays.figures().model),
                asked: "lights that move".into(),
                reason: "the points of its rays stay: cast shadows again, or use maps:N,PX".into(),
            }
            .into());
        }
        shadows.maps.as_mut().map_or(Ok(false), |maps| maps.follow(gpu, lights))
    }

    /// Records the pass `shadow-maps`, which draws all maps again. With rays, it records the passes that build the deep images
    /// again. Nothing without shadows.
    pub fn record_shadow_maps(&mut self, passes: &mut dyn Passes) {
        let Self { scene, scene_group, shadows, .. } = self;
        if let Some(maps) = &mut shadows.maps {
            maps.record(scene, scene_group, passes);
        }
        if let Some(rays) = &mut shadows.rays {
            rays.record(passes);
        }
    }

    /// Records the pass `occluders`, which finds again what hides lights from groups, after `shadow-maps`; nothing without
    /// [`find_occluders`](Self::find_occluders).
    pub fn record_occluders(&mut self, passes: &mut dyn Passes) {
        if let Some(maps) = &mut self.shadows.maps {
            maps.record_occluders(passes);
        }
    }

    /// Refuses shaders that read other shadows than the renderer's, and maps that were not drawn for the present lights.
    /// `asks_occluders`: lists were made by what hides lights.
    pub(crate) fn check_bound_shadows(
        &self,
        bound: Option<&BoundShadows>,
        asks_occluders: bool,
    ) -> Result<(), ShadingError> {
        let is_current = match bound {
            None => true,
            Some(BoundShadows::Maps(bound)) => self.shadows.maps.as_ref().is_some_and(|maps| {
                maps.is_drawn()
                    && maps.bound().is_same(bound)
                    && (!asks_occluders || maps.has_occluders())
            }),
            Some(BoundShadows::Rays(bound)) => {
                self.shadows.rays.as_ref().is_some_and(|rays| rays.bound().is_same(bound))
            }
        };
        if is_current { Ok(()) } else { Err(ShadingError::StaleShadows) }
    }

    /// What was made for the present shadows; `None` without any.
    pub fn shadow_figures(&self) -> Option<ShadowFigures> {
        let maps = self.shadows.maps.as_ref().map(ShadowMaps::figures);
        maps.or_else(|| self.shadows.rays.as_ref().map(ShadowRays::figures))
    }

    /// The deep images that rays of shadows cross; `None` without rays.
    pub fn shadow_images(&self) -> Option<&DeepImages> {
        self.shadows.rays.as_ref().map(ShadowRays::images)
    }

    /// The number of maps of each rectangle, in the order of the lights' slots, and how many rectangles have no places
    /// for more; `None` if frames do not subdivide them.
    pub fn shadow_subdivision(&self) -> Option<(Vec<u32>, u32)> {
        self.shadows.maps.as_ref()?.subdivision()
    }
}
