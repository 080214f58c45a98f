//! What a renderer holds for the shadows of its lights.

use std::sync::Arc;

use assign::{LightBuffer, Occluders, Suns};
use assign_cdi::DeepImageSettings;

use super::{ShadowMaps, rays::ShadowRays};
use crate::{ShadingError, WorldTriangles, bound_shadows::BoundShadows};

/// Maps or rays, and what the next of them are made for.
#[derive(Debug)]
pub(crate) struct Shadows {
    pub(super) maps: Option<ShadowMaps>,
    /// In place of maps.
    pub(super) rays: Option<ShadowRays>,
    /// The triangles that rays meet, and the deep images to make of them.
    pub(super) solid: Option<(Arc<WorldTriangles>, DeepImageSettings)>,
    /// How far from their lights samples may lie that shadow maps serve, in ranges of the lights.
    pub(super) ranges: f32,
    /// The suns that get shadow maps.
    pub(super) suns: Suns,
}

impl Default for Shadows {
    fn default() -> Self {
        let suns = Suns::default();
        Self { maps: None, rays: None, solid: None, ranges: f32::INFINITY, suns }
    }
}

impl Shadows {
    /// Removes what was made.
    pub(crate) fn clear(&mut self) {
        (self.maps, self.rays) = (None, None);
    }

    /// Refuses lights other than those that the shadows were made for.
    pub(crate) fn check_lights(&self, lights: &LightBuffer) -> Result<(), ShadingError> {
        let made = [
            self.maps.as_ref().map(|maps| &maps.lights[..]),
            self.rays.as_ref().map(ShadowRays::lights),
        ];
        let is_known = !lights.order().is_on_gpu() && lights.live_count().is_none();
        let is_same = |made: &[assign::Light]| is_known && lights.lights() == made;
        if made.into_iter().flatten().all(is_same) {
            Ok(())
        } else {
            Err(ShadingError::StaleShadows)
        }
    }

    /// What hides lights from groups; `None` if it was not asked for.
    pub(crate) fn occluders(&self) -> Option<Occluders<'_>> {
        self.maps.as_ref()?.occluders()
    }

    /// What lighting reads.
    pub(crate) fn bound(&self) -> Option<BoundShadows> {
        let maps = self.maps.as_ref().map(|maps| BoundShadows::Maps(maps.bound().clone()));
        maps.or_else(|| Some(BoundShadows::Rays(self.rays.as_ref()?.bound().clone())))
    }

    /// The most rounds of loops that a ray takes; 0 without rays.
    pub(crate) fn ray_rounds(&self) -> u64 {
        self.rays.as_ref().map_or(0, ShadowRays::rounds)
    }
}
