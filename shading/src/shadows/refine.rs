//! A renderer whose shadow maps follow what it draws.

use assign::{EncoderPasses, Passes, View};

use super::{ShadowMaps, ShadowRefinement, banding::Drawn};
use crate::{Renderer, ShadingError};

/// Frames in which maps must have settled. Each node of a tree changes at most once while the view stands still, and a
/// tree has 85 nodes with children.
const MOST_FRAMES: u32 = 200;

impl Renderer {
    /// Subdivides lights by what a frame has shown: takes the bands that
    /// [`record_banding`](Self::record_banding) has found, divides and merges quads, and records the pass `shadow-maps`
    /// for the maps of new points. Maps of other points stay. The first call divides all rectangles evenly instead, by
    /// their size in the view. Does nothing with other models than
    /// [`ShadowModel::Adaptive`](crate::ShadowModel::Adaptive).
    ///
    /// Call it before the passes of each frame that shades, and submit them in this order: maps in commands that are
    /// dropped are never drawn. It does not wait. Answers that are still on their way are taken by a later call.
    ///
    /// # Errors
    ///
    /// [`AssignError::OutOfMemory`](assign::AssignError::OutOfMemory) and
    /// [`AssignError::TooLarge`](assign::AssignError::TooLarge). The renderer then has no maps.
    pub fn refine_shadows(
        &mut self,
        view: &View,
        passes: &mut dyn Passes,
    ) -> Result<ShadowRefinement, ShadingError> {
        let Some(maps) = &mut self.shadows.maps else { return Ok(ShadowRefinement::default()) };
        let found = maps.refine(view, &self.scene, &self.scene_group, passes);
        if found.is_err() {
            // The trees know of maps that are not drawn.
            self.shadows.maps = None;
        }
        found
    }

    /// Records the pass `shadow-banding` after depth and G-buffer of the prepared view: it looks for bands in the
    /// penumbrae of all quads. Records nothing while the answers of an earlier frame are on their way, and where no
    /// quad could change.
    ///
    /// Returns whether it recorded.
    ///
    /// # Errors
    ///
    /// [`AssignError::Unsupported`](assign::AssignError::Unsupported) with several samples per pixel, which have no
    /// G-buffer.
    pub fn record_banding(
        &mut self,
        view: &View,
        passes: &mut dyn Passes,
    ) -> Result<bool, ShadingError> {
        self.check_banding()?;
        self.targets.check_holds(view.viewport)?;
        let Self { gpu, frame, targets, shadows, .. } = self;
        let drawn = Drawn { gpu, frame, targets, viewport: view.viewport };
        shadows.maps.as_mut().map_or(Ok(false), |maps| maps.record_banding(drawn, passes))
    }

    /// Draws depth and G-buffer of the prepared view until the maps of all lights have settled. All images of this
    /// view then have the same maps. Blocks.
    ///
    /// # Errors
    ///
    /// Those of [`refine_shadows`](Self::refine_shadows) and [`record_banding`](Self::record_banding), and
    /// [`ShadingError::RestlessShadows`] if the maps keep changing.
    pub fn settle_shadows(&mut self, view: &View) -> Result<ShadowRefinement, ShadingError> {
        self.check_banding()?;
        if !self.has_adaptive_shadows() {
            return Ok(ShadowRefinement::default());
        }
        let gpu = self.gpu.clone();
        for _ in 0..MOST_FRAMES {
            let mut encoder = gpu.device.create_command_encoder(&Default::default());
            let mut passes = EncoderPasses { encoder: &mut encoder };
            let mut found = self.refine_shadows(view, &mut passes)?;
            if !found.is_settled {
                self.record_depth(view, &mut passes);
                self.record_gbuffer(view, &mut passes);
                self.record_banding(view, &mut passes)?;
                found.is_settled = !self.shadows.maps.as_ref().is_some_and(ShadowMaps::has_tests);
            }
            gpu.queue.submit([encoder.finish()]);
            gpu.wait()?;
            if found.is_settled {
                return Ok(found);
            }
        }
        Err(ShadingError::RestlessShadows { frames: MOST_FRAMES })
    }

    fn has_adaptive_shadows(&self) -> bool {
        self.shadows.maps.as_ref().is_some_and(ShadowMaps::is_adaptive)
    }

    /// Refuses several samples per pixel.
    fn check_banding(&self) -> Result<(), ShadingError> {
        match &self.shadows.maps {
            Some(maps) if maps.is_adaptive() => {
                let model = maps.figures().model;
                Ok(self.check_one_sample(&format!("shadow model {model}"))?)
            }
            _ => Ok(()),
        }
    }
}
