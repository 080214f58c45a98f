//! The lights of a stage: the scene's own, those of another file, and scattered ones.

use assign::{Light, LightShape, MAX_RANGE_M, MAX_SUNS, MIN_RANGE_M, Suns};
use glam::Vec3;
use scenes::{Aabb, LightSpec, Places, Scene, SceneError, close_ranges, scatter_lights};

use crate::{
    cli::{CliError, LightBox, StageArgs},
    error::HarnessError,
    open_lights::OpenLights,
};

/// The lights of a stage.
pub(crate) struct Lit {
    pub(crate) lights: Vec<Light>,
    pub(crate) suns: Suns,
    /// Where lights were scattered.
    pub(crate) bounds: Aabb,
    /// The number of the scene's own lights, which come first.
    pub(crate) own: usize,
    /// Warnings of the file of --lights-from.
    pub(crate) warnings: Vec<String>,
    /// Lights whose file gives no range.
    pub(crate) open: Option<OpenLights>,
}

impl Lit {
    /// The scene's own lights, those of --lights-from and the scattered ones, with their final ranges.
    pub(crate) fn new(
        scene: &Scene,
        radius_scale: f64,
        args: &StageArgs,
    ) -> Result<Self, HarnessError> {
        let bounds = match args.light_box {
            LightBox::Core | LightBox::Cylinders => scene.core_bounds,
            LightBox::Bounds => scene.bounds,
        };
        if args.bounce.is_on() {
            let (lights, suns) = (Vec::new(), Suns::default());
            return Ok(Self { lights, suns, bounds, own: 0, warnings: Vec::new(), open: None });
        }
        let (mut lights, mut suns, mut open) = match args.no_own_lights {
            true => (Vec::new(), Vec::new(), Vec::new()),
            false => (scene.lights.clone(), scene.suns.clone(), scene.open_lights.clone()),
        };
        let mut warnings = Vec::new();
        if let Some(file) = &args.lights_from {
            let origin = scene.origin / args.scene_scale;
            let opened = scenes::open_lights(file, origin);
            let mut other = opened.map_err(lights_from)?.scaled(args.scene_scale)?;
            if other.lights.is_empty() && other.suns.is_empty() {
                let accepted = "a file with lights (KHR_lights_punctual)";
                return Err(CliError::out_of_range("--lights-from", file, accepted).into());
            }
            // The size of the lit scene sets the ranges of lights without one.
            let first = lights.len() as u32;
            let closed = close_ranges(&mut other.lights, scene.core_bounds.diagonal());
            open.extend(closed.into_iter().map(|ix| first + ix));
            lights.extend(other.lights);
            warnings = other.warnings;
            suns.extend(other.suns);
            if suns.len() > MAX_SUNS {
                let message = format!(
                    "--lights-from is {file}: with the scene's there are {} directional lights, and at \
                     most {MAX_SUNS} are possible",
                    suns.len()
                );
                return Err(CliError::new(message).into());
            }
        }
        let own = lights.len();
        let copies_of = u64::from(args.replicate) * u64::from(args.replicate);
        // The scene's own lights are copied already.
        let total = u64::from(args.scattered()) * copies_of + lights.len() as u64;
        if total > u64::from(scenes::MAX_LIGHTS) {
            let message = format!(
                "--lights is {} and --replicate makes {copies_of} copies: with the scene's own lights there \
                 are {total}, and at most {} are possible",
                args.scattered(),
                scenes::MAX_LIGHTS
            );
            return Err(CliError::new(message).into());
        }
        let scattered = scatter_lights(&LightSpec {
            count: args.scattered(),
            seed: args.seed,
            radius_scale: radius_scale as f32,
            radii: args.radii,
            bounds,
            places: match args.light_box {
                LightBox::Cylinders => Places::Cylinders,
                LightBox::Core | LightBox::Bounds => Places::Box,
            },
            spot_share: args.spots as f32,
            area_share: args.areas as f32,
            outlines: args.outlines,
            diffuse_share: args.diffuse_share as f32,
        })?;
        lights.extend(copies(scene, args, &scattered));
        if let Some(threshold) = args.threshold {
            for light in &mut lights {
                light.range_m = Light::range_from_threshold(light.intensity, threshold as f32)
                    .clamp(MIN_RANGE_M, MAX_RANGE_M);
            }
        }
        if let Some(least) = args.influence {
            set_influence(&mut lights, least as f32);
        }
        let open = OpenLights::new(&lights, &open);
        Ok(Self { lights, suns: Suns::new(&suns)?, bounds, own, warnings, open })
    }
}

/// Gives area lights the range of the polygon-light paper's rule. Other lights keep their range.
fn set_influence(lights: &mut [Light], least: f32) {
    for light in lights {
        if let LightShape::Area(emitter) = &light.shape {
            let diffuse_m = Light::influence_radius(light.intensity, least);
            let range_m = diffuse_m / emitter.diffuse_share;
            light.range_m = range_m.clamp(MIN_RANGE_M, MAX_RANGE_M);
        }
    }
}

/// The scattered lights of all copies of the scene, copy by copy.
fn copies(scene: &Scene, args: &StageArgs, lights: &[Light]) -> Vec<Light> {
    let side = args.replicate;
    let step = (scene.bounds.max - scene.bounds.min) / side as f32;
    let offsets = (0..side).flat_map(|x| (0..side).map(move |z| (x as f32, z as f32)));
    let moved = |(x, z): (f32, f32)| {
        let by = Vec3::new(x * step.x, 0.0, z * step.z);
        lights.iter().map(move |light| Light { position: light.position + by, ..*light })
    };
    offsets.flat_map(moved).collect()
}

/// An error of `--lights-from` that names this option where it would name `scene`.
fn lights_from(error: SceneError) -> HarnessError {
    match error {
        SceneError::Unknown { .. } => {
            let message = error.to_string();
            let value = message.strip_prefix("scene").unwrap_or(&message);
            CliError::new(format!("--lights-from{value}")).into()
        }
        other => other.into(),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn influence_ends_diffuse_light_and_specular_light_goes_on() {
        let emitter = assign::Emitter::rectangle(Vec3::X, Vec3::Y).with_diffuse_share(0.5);
        let intensity = Vec3::new(1.0, 2.0, 3.0);
        let point = Light::point(Vec3::ZERO, 7.0, intensity);
        let mut lights = [point, Light::area(emitter, Vec3::ZERO, 7.0, intensity)];
        set_influence(&mut lights, 0.02);
        // sqrt(4.4 * (1 + 2 + 3) / (2 pi * 0.02)), by hand.
        assert_eq!(lights[0].range_m, 7.0);
        assert!((lights[1].diffuse_range_m() - 14.494).abs() < 1e-3, "{lights:?}");
        assert!((lights[1].range_m - 28.988).abs() < 2e-3, "{lights:?}");
    }
}
