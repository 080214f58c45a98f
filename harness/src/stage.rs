//! The scene, lights and camera of a comparison, ready to draw.

use assign::{Gpu, LightBuffer, LightKind, Projection, View};
use glam::{Vec2, Vec3};
use scenes::{Aabb, Lens, LightSpec, Pose, Scene, scatter_lights};
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
    /// Where lights were scattered.
    pub light_box: Aabb,
    /// Lights of the scene's own among all that were handed over.
    pub own_lights: usize,
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
        let light_box = match args.light_box {
            LightBox::Core => scene.core_bounds,
            LightBox::Bounds => scene.bounds,
        };
        let mut lights = if args.no_own_lights { Vec::new() } else { scene.lights.clone() };
        let own_lights = lights.len();
        lights.extend(scatter_lights(&LightSpec {
            count: args.lights,
            seed: args.seed,
            radius_scale: radius_scale as f32,
            bounds: light_box,
            spot_share: args.spots as f32,
        })?);
        let view = view_of(&scene, args);
        Ok(Self {
            scene_hash: scene.hash(),
            radius_scale,
            light_box,
            own_lights,
            lights: LightBuffer::ordered(gpu, &lights, args.light_order)?,
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

/// Lights as large, against their scene, as lights of one metre are in a hall: a town under
/// lights of one metre is dark. Rooms and halls keep the comparison paper's radii.
fn radius_scale_of(diagonal_m: f32) -> f64 {
    let diagonal_m = f64::from(diagonal_m);
    (diagonal_m / diagonal_m.clamp(10.0, 60.0)).clamp(1e-6, 1e6)
}

/// The camera asked for, or the scene's: its path's first pose through its first camera's lens.
fn view_of(scene: &Scene, args: &CompareArgs) -> View {
    let pose = args.camera.map_or_else(
        || scene.path.pose(0, 1),
        |camera| Pose::new(Vec3::from(camera.eye), Vec3::from(camera.target)),
    );
    let lens = scene.cameras.first().map(|camera| camera.lens).filter(|_| args.camera.is_none());
    let fov_y = match lens {
        Some(Lens::Perspective { fov_y }) => fov_y,
        _ => FOV_Y,
    };
    let near = (scene.core_bounds.diagonal() * NEAR_SHARE).max(1e-6);
    let size = [args.size.width, args.size.height];
    let mut view = View {
        world_to_view: pose.world_to_view(),
        ..View::look_at(pose.eye, pose.target, fov_y, near, size)
    };
    if let Some(Lens::Orthographic { half_height, .. }) = lens {
        // The picture's own shape decides its width.
        let corner = Vec2::new(half_height * size[0] as f32 / size[1].max(1) as f32, half_height);
        view.projection = Projection::Orthographic { min: -corner, max: corner };
        let to_center = scene.bounds.center().distance(pose.eye);
        view.far_m = Some(to_center + scene.bounds.diagonal());
    }
    view
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn halls_keep_the_papers_radii_and_towns_get_larger_ones() {
        assert_eq!(radius_scale_of(28.9), 1.0);
        assert_eq!(radius_scale_of(600.0), 10.0);
        assert_eq!(radius_scale_of(1.0), 0.1);
        assert_eq!(radius_scale_of(0.0), 1e-6);
    }
}
