//! From the primary light's view to virtual point lights with ranges, on the GPU.

use std::sync::Arc;

use assign::{EncoderPasses, Gpu, GpuLights, Light, LightBuffer, Passes, View};
use assign_cdi::{Rsm, VplBuffer, VplSettings};
use glam::Vec3;
use scenes::Scene;
use shading::{Renderer, WorldTriangles, rsm_view};

use super::ranges::{Ranges, settings};
use crate::{cli::StageArgs, deep::DeepChoice, error::HarnessError, prefixed::Prefixed, results};

/// Half the width of the middle of a scene, as a share of the width of its core.
const MIDDLE_SHARE: f32 = 0.25;

/// How much larger than the scene the box of its lights is, as a share of the scene's diagonal: positions
/// come from rounded depths.
const BOX_SLACK: f32 = 1e-3;

/// The smallest enlargement of that box, metres.
const LEAST_BOX_SLACK_M: f32 = 1e-3;

/// One bounce of the primary light: everything that makes virtual point lights in a frame.
///
/// A frame takes these passes, all of which one encoder can hold:
///
/// 1. `rsm-depth`, `rsm-gbuffer`: the reflective shadow map.
/// 2. `rsm-mips`, `vpl-choose`: lights from its pixels.
/// 3. `cdi-*`: deep images and the ranges that rays find in them; or `random-ranges`.
/// 4. `vpl-keep`: the lights whose range is neither too small nor too large.
pub struct Bounce {
    map: Renderer,
    view: View,
    primary: Light,
    vpls: VplBuffer,
    ranges: Ranges,
    /// A box around the lights: lowest and highest corner.
    bounds: (Vec3, Vec3),
}

impl Bounce {
    /// Makes room for the lights of a map as the arguments say, at most `limit`, and draws nothing yet.
    pub(super) fn new(
        gpu: &Gpu,
        (scene, renderer): (&Scene, &Renderer),
        primary: Light,
        args: &StageArgs,
        limit: Option<u32>,
        triangles: Option<Arc<WorldTriangles>>,
    ) -> Result<Self, HarnessError> {
        let (low, high) = (scene.bounds.min, scene.bounds.max);
        let view = rsm_view(&primary, args.bounce.vpls, (low, high))?;
        let map = map_of(gpu, renderer, &view, primary)?;
        let settings = VplSettings { limit, ..settings(scene, &args.bounce) };
        let mut vpls = VplBuffer::new(gpu, settings)?;
        vpls.prepare(gpu, &rsm_of(&map, &view, &primary))?;
        let ranges = Ranges::new(gpu, scene, args, &vpls, (triangles, primary.position))?;
        let slack_m = (BOX_SLACK * scene.bounds.diagonal()).max(LEAST_BOX_SLACK_M);
        Ok(Self { map, view, primary, vpls, ranges, bounds: (low - slack_m, high + slack_m) })
    }

    /// Allocates and uploads what a frame needs, off the clock. Call it before each frame.
    pub fn prepare(&mut self, gpu: &Gpu) -> Result<(), HarnessError> {
        self.vpls.prepare(gpu, &rsm_of(&self.map, &self.view, &self.primary))?;
        self.ranges.prepare(gpu, &self.vpls)
    }

    /// Records the passes of a frame.
    pub fn record(&mut self, passes: &mut dyn Passes) -> Result<(), HarnessError> {
        record_map(&self.map, &self.view, &self.vpls, passes);
        self.ranges.record(passes)?;
        self.vpls.record_keep(passes);
        Ok(())
    }

    /// Makes the lights once, off the clock.
    pub(super) fn run(&mut self, gpu: &Gpu) -> Result<(), HarnessError> {
        self.prepare(gpu)?;
        let mut encoder = gpu.device.create_command_encoder(&Default::default());
        self.record(&mut EncoderPasses { encoder: &mut encoder })?;
        gpu.queue.submit([encoder.finish()]);
        Ok(())
    }

    /// The lights, as a [`LightBuffer`] takes them. They stay on the GPU.
    pub fn lights(&self) -> GpuLights<'_> {
        self.vpls.gpu_lights(self.bounds)
    }

    /// The buffers of the lights.
    pub fn vpls(&self) -> &VplBuffer {
        &self.vpls
    }

    /// What is stored of its deep images, if rays are cast.
    pub(super) fn deep(&self, args: &StageArgs) -> Option<results::DeepImages> {
        let choice = DeepChoice::of_ranges(&args.bounce.deep);
        self.ranges.deep().map(|images| choice.figures(images))
    }
}

/// Draws the scene of `renderer` as the primary light sees it.
fn map_of(
    gpu: &Gpu,
    renderer: &Renderer,
    view: &View,
    primary: Light,
) -> Result<Renderer, HarnessError> {
    let mut map = renderer.beside(view)?;
    map.prepare(view, &LightBuffer::new(gpu, &[primary])?)?;
    Ok(map)
}

/// The map that virtual point lights come from.
fn rsm_of<'a>(map: &'a Renderer, view: &'a View, light: &'a Light) -> Rsm<'a> {
    let targets = map.targets();
    Rsm {
        depth: &targets.depth,
        normals: &targets.normal,
        base_color: &targets.base_color,
        view,
        light,
    }
}

/// Draws the map and chooses lights from its pixels.
fn record_map(map: &Renderer, view: &View, vpls: &VplBuffer, passes: &mut dyn Passes) {
    let mut named = Prefixed::new("rsm-", passes);
    map.record_depth(view, &mut named);
    map.record_gbuffer(view, &mut named);
    vpls.record_choose(passes);
}

/// Draws the map once and makes a light of each texel that shows a surface, with position and normal. If
/// `is_middle`, the map shows the middle of the scene, so that almost every texel shows a surface.
///
/// # Errors
///
/// The light has no shadow map, or the device fails.
pub fn all_texels(
    gpu: &Gpu,
    scene: &Scene,
    renderer: &Renderer,
    primary: Light,
    (size_px, is_middle): (u32, bool),
) -> Result<VplBuffer, HarnessError> {
    let mut view = rsm_view(&primary, size_px, (scene.bounds.min, scene.bounds.max))?;
    let (centre, half) = (scene.core_bounds.center(), MIDDLE_SHARE * scene.core_bounds.size());
    // A spot of the scene may point elsewhere.
    if let (true, Ok(middle)) =
        (is_middle, rsm_view(&primary, size_px, (centre - half, centre + half)))
    {
        view.projection = middle.projection;
    }
    let map = map_of(gpu, renderer, &view, primary)?;
    let mut vpls = VplBuffer::new(gpu, VplSettings::default())?;
    vpls.prepare(gpu, &rsm_of(&map, &view, &primary))?;
    let mut encoder = gpu.device.create_command_encoder(&Default::default());
    record_map(&map, &view, &vpls, &mut EncoderPasses { encoder: &mut encoder });
    gpu.queue.submit([encoder.finish()]);
    gpu.wait()?;
    Ok(vpls)
}
