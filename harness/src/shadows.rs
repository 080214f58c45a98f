//! The shadow maps of a stage, or the rays in place of them.

use std::time::Instant;

use assign::LightBuffer;
use assign_cdi::Storage;
use shading::{Cut, LightingOptions, OccluderDepth, ShadowFigures, ShadowModel};

use crate::{
    choice::Choice,
    cli::{CliError, DeepArgs, LayerArgs, StageArgs},
    clock::PassClock,
    deep::DeepChoice,
    error::HarnessError,
    messages::say,
    moving::Moving,
    results::{AdaptiveSetting, DeepImages, ShadowSetting, median},
    stage::Stage,
};

/// How often a GPU draws all maps again, and tests them for bands, to time it.
const REPEATS: u32 = 7;

/// What shadows are cast for, and by.
#[derive(Clone, Copy, Debug, Default)]
pub struct Casting<'a> {
    /// How light ends at the lights' ranges: what lies beyond hides nothing.
    pub cut: Cut,
    /// Whether strategies ask what hides lights from groups.
    pub finds_occluders: bool,
    /// The deep images that rays cross.
    pub images: Option<&'a DeepArgs>,
}

impl Stage {
    /// Makes shadow maps for its lights and draws them before all frames. If lights move, each frame draws the maps again
    /// ([`Painter`](crate::painter::Painter)), and the atlas has room for the lights of all frames. With an adaptive model, it
    /// draws the view until the maps have settled, so that all methods get the same maps. With rays, it builds deep images
    /// instead. If asked to, it also finds what hides lights from groups, for strategies with `/occ`. Returns warnings: if
    /// area lights got fewer maps than asked for, if the model is wrong for large triangles, and if rays meet alpha masks.
    ///
    /// # Errors
    ///
    /// Those of [`Renderer::cast_shadows`](shading::Renderer::cast_shadows) and
    /// [`Renderer::settle_shadows`](shading::Renderer::settle_shadows).
    pub fn cast_shadows(
        &mut self,
        model: ShadowModel,
        Casting { cut, finds_occluders, images }: Casting<'_>,
    ) -> Result<Vec<String>, HarnessError> {
        let specular_reach = self.specular_reach;
        let lit = LightingOptions { cut, specular_reach, ..LightingOptions::default() };
        self.renderer.cast_shadows_within(lit.ranges_lit());
        self.shadows = ShadowModel::None;
        if model.casts_rays() && !self.suns.is_empty() {
            let accepted = "none or one with maps in a scene with suns, to which no rays are cast";
            return Err(CliError::out_of_range("--shadows", &model.to_string(), accepted).into());
        }
        self.renderer.cast_shadows_of_suns(self.suns);
        (self.shadow_draw_ms, self.shadow_plan_ms) = (None, None);
        (self.shadow_rounds, self.shadow_images) = (None, None);
        let images = images.map(DeepChoice::of_shadows).filter(|_| model.casts_rays());
        if let Some(images) = images {
            let triangles = self.vpl_maker.triangles(&self.gpu, &self.scene)?;
            self.renderer.cast_rays_through(triangles, images.settings()?);
        }
        let Some(figures) = self.draw_maps(model, finds_occluders)? else { return Ok(Vec::new()) };
        let mut warnings = Vec::new();
        self.shadows = model;
        if let (Some(choice), Some(images)) = (images, self.renderer.shadow_images()) {
            return Ok(self.tell_images(figures, choice.figures(images)).into_iter().collect());
        }
        let [width, height] = figures.atlas_px;
        say(format!(
            "shadows  {} maps with {} faces in an atlas of {width}x{height} texels ({} MiB), drawn {} in {:.1} ms",
            figures.maps,
            figures.faces,
            figures.atlas_bytes().div_ceil(1 << 20),
            if self.moving.is_some() { "in every frame, now" } else { "once" },
            self.shadow_draw_ms.unwrap_or_default()
        ));
        if let Some(adaptive) = self.adaptive_setting() {
            let maps = adaptive.maps_of_rectangles.iter();
            say(format!(
                "shadows  {} to {} maps for each rectangle after {} frames, {} rectangles without room for more; the \
                 test for bands takes {:.2} ms",
                maps.clone().min().copied().unwrap_or_default(),
                maps.max().copied().unwrap_or_default(),
                adaptive.frames,
                adaptive.full_rectangles,
                adaptive.banding_ms.unwrap_or_default()
            ));
        }
        if model.is_curved() {
            let warning = format!(
                "--shadows {model}: paraboloids bend the edges of triangles. Shadows are wrong where triangles are \
                 large beside their distance from a light"
            );
            say(format!("warning  {warning}"));
            warnings.push(warning);
        }
        if figures.fell_back() {
            let only = if model.is_adaptive() { "at most" } else { "only" };
            let warning = format!(
                "--shadows {model}: {only} {} maps for each area light fit an atlas of this device",
                figures.maps_per_area_light
            );
            say(format!("warning  {warning}"));
            warnings.push(warning);
        }
        Ok(warnings)
    }

    /// Has the maps look from where lights are that have moved, and times that: wall clock, until the GPU has it.
    pub(crate) fn move_shadows(&mut self) -> Result<(), HarnessError> {
        if self.renderer.shadow_figures().is_none() {
            return Ok(());
        }
        let began = Instant::now();
        let has_moved = self.renderer.move_shadows(&self.lights)?;
        // The copies run with the next submission.
        self.gpu.queue.submit([]);
        self.gpu.wait()?;
        // Another visit to the same lights plans nothing, and has the time of the first.
        if has_moved || self.shadow_plan_ms.is_none() {
            self.shadow_plan_ms = Some(began.elapsed().as_secs_f64() * 1e3);
        }
        Ok(())
    }

    /// The lights for which the atlas has room: those of all frames, if they move.
    fn lights_of_all_frames(&self) -> Result<Option<LightBuffer>, HarnessError> {
        let resting = self.moving.as_ref().and_then(Moving::resting);
        let order = self.lights.order();
        Ok(resting.map(|all| LightBuffer::ordered(&self.gpu, all, order)).transpose()?)
    }

    /// Says what rays cross, and keeps it. Returns a warning if the scene has alpha masks.
    fn tell_images(&mut self, figures: ShadowFigures, images: DeepImages) -> Option<String> {
        say(format!(
            "shadows  rays to {0} points of lights through {1} images of {2}x{2} pixels of {3:.3} m ({4} MiB), built once in \
             {5:.1} ms",
            figures.maps,
            images.directions(),
            images.size_px,
            images.footprint_m,
            images.bytes.div_ceil(1 << 20),
            self.shadow_draw_ms.unwrap_or_default()
        ));
        self.shadow_images = Some(images);
        let has_holes = self.scene.materials.iter().any(|one| one.alpha_cutoff.is_some());
        has_holes.then(|| {
            let model = figures.model;
            let warning = format!(
                "--shadows {model}: rays take alpha masks as solid, so their holes cast shadows too"
            );
            say(format!("warning  {warning}"));
            warning
        })
    }

    /// Makes the maps, draws them and times that: on a GPU the median of a few draws, on a software adapter a single
    /// one.
    fn draw_maps(
        &mut self,
        model: ShadowModel,
        finds_occluders: bool,
    ) -> Result<Option<ShadowFigures>, HarnessError> {
        if !model.is_on() {
            return Ok(self.renderer.cast_shadows(&self.lights, model)?);
        }
        let mut clock = PassClock::new(&self.gpu);
        if let Some(all) = self.lights_of_all_frames()? {
            self.renderer.cast_shadows(&all, model)?;
            self.move_shadows()?;
            self.renderer.record_shadow_maps(&mut clock);
        } else {
            self.renderer.cast_shadows_in(&self.lights, model, &mut clock)?;
        }
        if finds_occluders {
            self.renderer.find_occluders_in(OccluderDepth::Farthest, &mut clock)?;
        }
        let ms = |clock: &mut PassClock| -> Result<f64, HarnessError> {
            Ok(clock.finish()?.iter().map(|(_, ms)| ms).sum())
        };
        let first_ms = ms(&mut clock)?;
        let repeats = if self.gpu.is_software() { 1 } else { REPEATS };
        if model.is_adaptive() {
            self.settle_shadows(&mut clock, repeats)?;
        }
        let mut all_ms = Vec::new();
        if model.is_adaptive() || !self.gpu.is_software() {
            for _ in 0..repeats {
                self.renderer.record_shadow_maps(&mut clock);
                self.renderer.record_occluders(&mut clock);
                all_ms.push(ms(&mut clock)?);
            }
        } else {
            all_ms.push(first_ms);
        }
        self.shadow_draw_ms = Some(median(&all_ms));
        Ok(self.renderer.shadow_figures())
    }

    /// Draws the view until its maps have settled, and times the test for bands as a frame afterwards makes it.
    fn settle_shadows(&mut self, clock: &mut PassClock, repeats: u32) -> Result<(), HarnessError> {
        self.prepare()?;
        let settled = self.renderer.settle_shadows(&self.view)?;
        let mut all_ms = Vec::new();
        for _ in 0..repeats {
            self.renderer.refine_shadows(&self.view, clock)?;
            let is_tested = self.renderer.record_banding(&self.view, clock)?;
            let passes = clock.finish()?;
            if is_tested {
                all_ms.push(passes.iter().map(|(_, ms)| ms).sum());
            }
        }
        let banding_ms = (!all_ms.is_empty()).then(|| median(&all_ms));
        self.shadow_rounds = Some((settled.rounds, banding_ms));
        Ok(())
    }

    /// How its frames subdivided the rectangles, if they did.
    fn adaptive_setting(&self) -> Option<AdaptiveSetting> {
        let (frames, banding_ms) = self.shadow_rounds?;
        let (maps_of_rectangles, full_rectangles) = self.renderer.shadow_subdivision()?;
        Some(AdaptiveSetting { maps_of_rectangles, full_rectangles, frames, banding_ms })
    }

    /// Its shadow maps, as records store them.
    pub fn shadow_setting(&self) -> Option<ShadowSetting> {
        self.renderer.shadow_figures().map(|figures| ShadowSetting {
            model: figures.model.to_string(),
            maps_per_area_light: figures.maps_per_area_light,
            maps: figures.maps,
            faces: figures.faces,
            atlas_px: figures.atlas_px,
            occluder_bytes: Some(figures.occluder_bytes).filter(|bytes| *bytes > 0),
            draw_ms: self.shadow_draw_ms,
            adaptive: self.adaptive_setting(),
            deep: self.shadow_images.clone(),
        })
    }
}

/// The pass of the CPU that plans the maps of lights that move.
pub(crate) const PLAN_PASS: &str = "shadow-plan";

/// Refuses strategies that leave out hidden lights where no maps say which these are.
pub(crate) fn check_occlusion(model: ShadowModel, choices: &[Choice]) -> Result<(), CliError> {
    let has_maps = matches!(model, ShadowModel::Maps { .. });
    let hides = choices.iter().find(|choice| choice.leaves_out_hidden() && !has_maps);
    hides.map_or(Ok(()), |choice| {
        let accepted = "combined with --shadows maps:N,PX: only maps that stay, and of which a look-up reads a few texels, \
                        say what hides lights from a group";
        Err(CliError::out_of_range("--strategies", choice.id().as_str(), accepted))
    })
}

/// Refuses shadows of lights without maps, and on what maps do not shade. Adaptive maps follow one view (`is_path`:
/// the camera moves), by its G-buffer, which several samples per pixel have not.
pub(crate) fn check_shadows(
    model: ShadowModel,
    stage: &StageArgs,
    layers: &LayerArgs,
    (is_path, samples): (bool, u32),
) -> Result<(), CliError> {
    if !model.is_on() {
        return Ok(());
    }
    let refuse = |accepted| Err(CliError::out_of_range("--shadows", &model.to_string(), accepted));
    if model.casts_rays() {
        if stage.motion.motion.is_some() {
            return refuse("none with --motion, or one with maps, which follow lights");
        }
        if stage.bounce.vpls > 0 {
            return refuse("none with --vpls, or one with maps");
        }
        if *layers != LayerArgs::default() {
            return refuse("none with --transparent, --particles and --fog, or one with maps");
        }
        let images = DeepChoice::of_shadows(&stage.bounce.deep);
        let settings = images.settings().map_err(|error| CliError::new(error.to_string()))?;
        if settings.storage == Storage::LinkedLists {
            let accepted = "another build with --shadows cdi:N, whose rays search sorted lists";
            return Err(CliError::out_of_range("--build", "linked-lists", accepted));
        }
    }
    if model.is_adaptive() && is_path {
        return refuse("none or maps:N,PX with --path, because adaptive maps settle in one view");
    }
    if model.is_adaptive() && samples > 1 {
        return refuse("none or maps:N,PX with --msaa 4, because adaptive maps read a G-buffer");
    }
    if model.is_adaptive() && stage.motion.motion.is_some() {
        return refuse(
            "none or maps:N,PX with --motion, because adaptive maps settle under still lights",
        );
    }
    if stage.motion.is_on_gpu() {
        return refuse("none with --moved-by gpu, whose lights the CPU does not know");
    }
    if stage.bounce.vpls > 0 && stage.light_order().is_on_gpu() {
        return refuse(
            "none with --vpls, whose lights the CPU does not know (unless --light-order given, morton or bvh reads them back)",
        );
    }
    if stage.light_order().is_on_gpu() {
        return refuse(
            "none with --light-order gpu, gpuN and gpuN%, which the CPU does not know (the default with --motion is \
             gpu: give another one, such as --light-order given)",
        );
    }
    Ok(())
}
