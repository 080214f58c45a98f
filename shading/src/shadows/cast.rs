//! A renderer with shadow maps, or with rays in place of them.

use std::sync::Arc;

use assign::{AssignError, EncoderPasses, LightBuffer, Passes};
use assign_cdi::{DeepImageSettings, DeepImages};

use super::{OccluderDepth, ShadowFigures, ShadowMaps, rays::ShadowRays};
use crate::{Renderer, ShadingError, ShadowModel, WorldTriangles};

impl Renderer {
    /// Makes shadow maps for lights that stand still, and draws them, in a submission of its own. It holds for frames
    /// that are prepared afterwards, with [`Lighting`](crate::Lighting) that is made afterwards. Frames with other
    /// lights are refused until it is called again. [`ShadowModel::None`] removes the maps.
    ///
    /// With [`ShadowModel::Cdi`] there are no maps: it places points on the lights, and builds deep images of the scene
    /// ([`cast_rays_through`](Self::cast_rays_through)). All else holds alike.
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
        (self.shadows.maps, self.shadows.rays) = (None, None);
        if !model.is_on() {
            return Ok(None);
        }
        let asked = (model, self.shadows.ranges);
        if model.casts_rays() {
            let Some((triangles, images)) = &self.shadows.solid else {
                return Err(AssignError::Parameter {
                    field: "shadow model".into(),
                    value: model.to_string(),
                    accepted: "none or one with maps before Renderer::cast_rays_through".into(),
                }
                .into());
            };
            let rays = ShadowRays::new(&self.gpu, lights, asked, (triangles, *images))?;
            self.shadows.rays = Some(rays);
        } else {
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
    /// [`AssignError::Parameter`] without shadow maps, and [`AssignError::OutOfMemory`].
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
        maps.make_pyramid(&self.gpu, kept)?.record(passes);
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

    /// Records the pass `shadow-maps`, which draws all maps again, and the pass `occluders` if these
    /// were asked for. With rays, it records the passes that build the deep images again. Nothing without shadows.
    pub fn record_shadow_maps(&mut self, passes: &mut dyn Passes) {
        if let Some(maps) = &self.shadows.maps {
            maps.record(&self.scene, &self.scene_group, passes);
        }
        if let Some(rays) = &mut self.shadows.rays {
            rays.record(passes);
        }
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
