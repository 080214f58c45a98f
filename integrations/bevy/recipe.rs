//! Clusters in bevy's renderer: where `prepare`, `record` and the look-up go. It serves one camera.
//!
//! The README beside this file says what each step does. Nothing here is compiled by lightbench's own tests.

use assign::{
    Assignment, Bounds, CullSettings, EncoderPasses, Frame, FrameBindings, Gpu, Light,
    LightBuffer, View, ViewError, Viewport,
};
use assign_clustered::{Clustered, Occupancy};
use bevy::{
    core_pipeline::{Core3d, Core3dSystems, prepass::ViewPrepassTextures},
    pbr::ExtractedPointLight,
    prelude::*,
    render::{
        Render, RenderApp, RenderStartup, RenderSystems,
        renderer::{RenderAdapterInfo, RenderContext, RenderDevice, RenderQueue, ViewQuery},
        view::ExtractedView,
    },
};

/// Adds the lists of lights to the renderer.
pub struct ClustersPlugin;

impl Plugin for ClustersPlugin {
    fn build(&self, app: &mut App) {
        let Some(render_app) = app.get_sub_app_mut(RenderApp) else { return };
        render_app
            .add_systems(RenderStartup, start)
            .add_systems(Render, prepare.in_set(RenderSystems::PrepareBindGroups))
            .add_systems(
                Core3d,
                record.after(Core3dSystems::Prepass).before(Core3dSystems::MainPass),
            );
    }
}

/// The strategy, the lights and the bind group of both.
#[derive(Resource)]
pub struct Clusters {
    gpu: Gpu,
    lights: LightBuffer,
    /// The view and the lights. A material's bind group takes its `bind_entries`.
    pub bindings: FrameBindings,
    /// Its `lookup` gives the text for a material's shader, and the entries of its bind group.
    pub strategy: Clustered,
}

/// Wraps bevy's device, once.
fn start(
    mut commands: Commands,
    device: Res<RenderDevice>,
    queue: Res<RenderQueue>,
    info: Res<RenderAdapterInfo>,
) -> Result {
    let gpu = Gpu::new(device.wgpu_device().clone(), (**queue).clone(), (**info).clone());
    let strategy = Clustered::new(
        &gpu,
        "48x48x40".parse()?,
        Bounds::Explicit,
        Occupancy::Sparse,
        CullSettings::default(),
    )?;
    let lights = LightBuffer::new(&gpu, &[])?;
    let bindings = FrameBindings::new(&gpu);
    commands.insert_resource(Clusters { gpu, lights, bindings, strategy });
    Ok(())
}

/// Uploads the lights and sizes the buffers. It runs after the textures of the prepass were made.
fn prepare(
    mut clusters: ResMut<Clusters>,
    cameras: Query<(&ExtractedView, &ViewPrepassTextures)>,
    points: Query<&ExtractedPointLight>,
) -> Result {
    let Ok((camera, textures)) = cameras.single() else { return Ok(()) };
    let Some(depth) = textures.depth_only_view() else { return Ok(()) };
    let Clusters { gpu, lights, bindings, strategy } = &mut *clusters;
    lights.update(gpu, &points.iter().map(light).collect::<Vec<_>>())?;
    let view = view(camera)?;
    let frame = Frame::new(&view, lights).with_depth(depth);
    bindings.update(gpu, &frame)?;
    strategy.prepare(gpu, &frame)?;
    Ok(())
}

/// Records the passes that make the lists: after the prepass, whose depth they read, and before the main pass.
fn record(
    mut clusters: ResMut<Clusters>,
    camera: ViewQuery<(&ExtractedView, &ViewPrepassTextures)>,
    mut context: RenderContext,
) {
    let (camera, textures) = camera.into_inner();
    let Some(depth) = textures.depth_only_view() else { return };
    let Clusters { lights, strategy, .. } = &mut *clusters;
    let Ok(view) = view(camera) else { return };
    let frame = Frame::new(&view, lights).with_depth(depth);
    strategy.record(&frame, &mut EncoderPasses { encoder: context.command_encoder() });
}

/// The camera, from bevy's own matrices. `prepare` reports what is no view, and `record` skips it.
fn view(camera: &ExtractedView) -> Result<View, ViewError> {
    let [x, y, width, height] = camera.viewport.to_array();
    View::from_matrices(
        camera.world_from_view.to_matrix().inverse(),
        camera.clip_from_view,
        Viewport { x, y, width, height },
    )
}

/// A point light. Intensities stay in bevy's unit, because the material's shader reads them.
fn light(point: &ExtractedPointLight) -> Light {
    let color = Vec3::new(point.color.red, point.color.green, point.color.blue);
    Light::point(point.transform.translation(), point.range, color * point.intensity)
}
