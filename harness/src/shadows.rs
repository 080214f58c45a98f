//! The shadow maps of a stage.

use shading::{Cut, LightingOptions, OccluderDepth, ShadowFigures, ShadowModel};

use crate::{
    choice::Choice,
    cli::{CliError, LayerArgs, StageArgs},
    clock::PassClock,
    error::HarnessError,
    messages::say,
    results::{ShadowSetting, median},
    stage::Stage,
};

/// How often a GPU draws all maps again, to time it.
const REDRAWS: u32 = 7;

/// What shadow maps are cast for.
#[derive(Clone, Copy, Debug, Default)]
pub struct Casting {
    /// How light ends at the lights' ranges: what lies beyond hides nothing.
    pub cut: Cut,
    /// Whether strategies ask what hides lights from groups.
    pub finds_occluders: bool,
}

impl Stage {
    /// Makes shadow maps for its lights and draws them before all frames: lights and scene stand still. If asked to, it
    /// also finds what hides lights from groups, for strategies with `/occ`. Returns a warning if area lights got fewer maps than asked for.
    ///
    /// # Errors
    ///
    /// [`CliError`] in a scene with suns, and the errors of
    /// [`Renderer::cast_shadows`](shading::Renderer::cast_shadows).
    pub fn cast_shadows(
        &mut self,
        model: ShadowModel,
        Casting { cut, finds_occluders }: Casting,
    ) -> Result<Option<String>, HarnessError> {
        let specular_reach = self.specular_reach;
        let lit = LightingOptions { cut, specular_reach, ..LightingOptions::default() };
        self.renderer.cast_shadows_within(lit.ranges_lit());
        self.shadows = ShadowModel::None;
        if model.is_on() && !self.suns.is_empty() {
            let accepted = "none in a scene with suns, which have no shadow maps";
            return Err(CliError::out_of_range("--shadows", &model.to_string(), accepted).into());
        }
        self.shadow_draw_ms = None;
        let Some(figures) = self.draw_maps(model, finds_occluders)? else { return Ok(None) };
        self.shadows = model;
        let [width, height] = figures.atlas_px;
        say(format!(
            "shadows  {} maps with {} faces in an atlas of {width}x{height} texels ({} MiB), drawn once in {:.1} ms",
            figures.maps,
            figures.faces,
            figures.atlas_bytes().div_ceil(1 << 20),
            self.shadow_draw_ms.unwrap_or_default()
        ));
        let warning = figures.fell_back().then(|| {
            let warning = format!(
                "--shadows {model}: only {} maps for each area light fit an atlas of this device",
                figures.maps_per_area_light
            );
            say(format!("warning  {warning}"));
            warning
        });
        Ok(warning)
    }

    /// Makes the maps, draws them and times that: on a GPU the median of a few draws, on a software adapter the only
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
        let mut figures = self.renderer.cast_shadows_in(&self.lights, model, &mut clock)?;
        if finds_occluders {
            let farthest = OccluderDepth::Farthest;
            figures = Some(self.renderer.find_occluders_in(farthest, &mut clock)?);
        }
        let ms = |clock: &mut PassClock| -> Result<f64, HarnessError> {
            Ok(clock.finish()?.iter().map(|(_, ms)| ms).sum())
        };
        let mut draw_ms = ms(&mut clock)?;
        if !self.gpu.is_software() {
            let mut again = Vec::new();
            for _ in 0..REDRAWS {
                self.renderer.record_shadow_maps(&mut clock);
                again.push(ms(&mut clock)?);
            }
            draw_ms = median(&again);
        }
        self.shadow_draw_ms = Some(draw_ms);
        Ok(figures)
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
        })
    }
}

/// Refuses strategies that leave out hidden lights where no maps say which these are.
pub(crate) fn check_occlusion(model: ShadowModel, choices: &[Choice]) -> Result<(), CliError> {
    let hides = choices.iter().find(|choice| choice.leaves_out_hidden() && !model.is_on());
    hides.map_or(Ok(()), |choice| {
        let accepted = "combined with --shadows maps:N,PX: without shadow maps, /occ does not know what hides lights";
        Err(CliError::out_of_range("--strategies", choice.id().as_str(), accepted))
    })
}

/// Refuses shadows of lights without maps, and on what maps do not shade.
pub(crate) fn check_shadows(
    model: ShadowModel,
    stage: &StageArgs,
    layers: &LayerArgs,
) -> Result<(), CliError> {
    if !model.is_on() {
        return Ok(());
    }
    let refuse = |accepted| Err(CliError::out_of_range("--shadows", &model.to_string(), accepted));
    if *layers != LayerArgs::default() {
        return refuse("none with --transparent, --particles and --fog, which maps do not shade");
    }
    if stage.motion.motion.is_some() {
        return refuse("none with --motion, because maps are drawn once, before the frames");
    }
    if stage.bounce.vpls > 0 {
        return refuse("none with --vpls, whose lights the CPU does not know");
    }
    if stage.light_order().is_on_gpu() {
        return refuse("none with --light-order gpu, gpuN and gpuN%, which the CPU does not know");
    }
    Ok(())
}
