//! The scene, lights and camera of a comparison, ready to draw.

use assign::{Gpu, Light, LightBuffer, LightKind, View};
use glam::Vec3;
use scenes::{Lens, LightSpec, Pose, Scene, scatter_lights};
use shading::Renderer;

use crate::{
    cli::{CompareArgs, LightBox},
    error::HarnessError,
};

/// Vertical field of view where the scene names none, radians.
const FOV_Y: f32 = 60.0 * std::f32::consts::PI / 180.0;

/// The near plane as a share of the scene's size: 5 cm in a hall of 25 m.
const NEAR_SHARE: f32 = 0.002;

/// What all strategies of a run share.
pub struct Stage {
    /// The scene.
    pub scene: Scene,
    /// Its content hash.
    pub scene_hash: String,
    /// Factor on the radii of the scattered lights.
    pub radius_scale: f64,
    /// The lights, faulty ones left out.
    pub lights: LightBuffer,
    /// The camera.
    pub view: View,
    /// The pipeline.
    pub renderer: Renderer,
}

impl Stage {
    /// Opens the scene, scatters the lights and uploads both.
    pub fn new(gpu: &Gpu, args: &CompareArgs) -> Result<Self, HarnessError> {
        let scene = scenes::open(&args.scene)?;
        let radius_scale =
            args.radius_scale.unwrap_or_else(|| radius_scale_of(scene.core_bounds.diagonal()));
        let scene = scene.scaled(args.scene_scale as f32)?;
        let lights = lights_of(&scene, radius_scale, args)?;
        let view = view_of(&scene, args);
        Ok(Self {
            scene_hash: scene.hash(),
            radius_scale,
            lights: LightBuffer::new(gpu, &lights)?,
            renderer: Renderer::new(gpu, &scene, &view)?,
            scene,
            view,
        })
    }

    /// Lights of each kind, by name.
    pub fn light_kinds(&self) -> [(&'static str, u64); 2] {
        let count = |kind| self.lights.lights().iter().filter(|l| l.kind() == kind).count() as u64;
        [("point", count(LightKind::Point)), ("spot", count(LightKind::Spot))]
    }
}

/// Lights as large, against their scene, as lights of one metre are against a hall of 30 m: a
/// town under lights of one metre is dark. Rooms and halls keep the comparison paper's radii.
fn radius_scale_of(diagonal_m: f32) -> f64 {
    if (10.0..=100.0).contains(&diagonal_m) {
        1.0
    } else {
        f64::from(diagonal_m / 30.0).clamp(1e-6, 1e6)
    }
}

fn lights_of(
    scene: &Scene,
    radius_scale: f64,
    args: &CompareArgs,
) -> Result<Vec<Light>, HarnessError> {
    let mut lights = if args.no_own_lights { Vec::new() } else { scene.lights.clone() };
    lights.extend(scatter_lights(&LightSpec {
        count: args.lights,
        seed: args.seed,
        radius_scale: radius_scale as f32,
        bounds: match args.light_box {
            LightBox::Core => scene.core_bounds,
            LightBox::Bounds => scene.bounds,
        },
        spot_share: args.spots as f32,
    })?);
    Ok(lights)
}

/// The camera asked for, or the scene's: its path's first pose through its first camera's lens.
fn view_of(scene: &Scene, args: &CompareArgs) -> View {
    let pose = args.camera.map_or_else(
        || scene.path.pose(0, 1),
        |camera| Pose::new(Vec3::from(camera.eye), Vec3::from(camera.target)),
    );
    let fov_y = scene
        .cameras
        .iter()
        .find_map(|camera| match camera.lens {
            Lens::Perspective { fov_y } => Some(fov_y),
            Lens::Orthographic { .. } => None,
        })
        .unwrap_or(FOV_Y);
    let near = (scene.core_bounds.diagonal() * NEAR_SHARE).max(1e-6);
    let size = [args.size.width, args.size.height];
    View {
        world_to_view: pose.world_to_view(),
        ..View::look_at(pose.eye, pose.target, fov_y, near, size)
    }
}
