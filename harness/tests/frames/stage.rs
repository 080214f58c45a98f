//! A small scene, its lights, and the strategies that are tested in it.

use assign::{Assignment, EncoderPasses, Gpu, Light, LightBuffer, LightShape, View};
use glam::Vec3;
use harness::{
    choice::Choice,
    strategy::{Method, Row, rows},
};
use scenes::{LightSpec, Scene, atrium, scatter_lights};
use shading::{HdrImage, Lighting, LightingOptions, Mode, Renderer, record_before_lighting};

/// Points on axes of the strategies that run other kernels or bind other resources than the defaults.
const MORE: [&str; 20] = [
    "SC-E/bvh",
    "SC-E/n24",
    "SC-E/n24/s0.001",
    "DC-E/mask",
    "DA-E/bvh",
    "T-E/tree",
    "T-E/scalar",
    "T-I/prune",
    "T-E/bvh/cap4",
    "T-25D/bvh",
    "HG/raster",
    "HC/bvh",
    "M/2/bvh",
    "G/visible",
    "G/frustum/bvh",
    "ZB/bvh",
    "SC-I/bvh/touched",
    "G/touched",
    "SC-E/keep4",
    "G/unordered",
];

/// A strategy, by its id.
pub(crate) struct Contender {
    pub(crate) id: String,
    pub(crate) strategy: Box<dyn Assignment>,
    pub(crate) early_exit: bool,
}

/// The strategy of an id, with lists; `None` if this device cannot run it.
pub(crate) fn contender(gpu: &Gpu, id: &str) -> Option<Contender> {
    match Choice::parse(id).expect("an id").make(gpu) {
        Ok(Method::Lists { strategy, early_exit, .. }) => {
            Some(Contender { id: id.to_owned(), strategy, early_exit })
        }
        Ok(_) => None,
        Err(error) => {
            println!("{id}: {error}");
            None
        }
    }
}

/// Every strategy of the registry that makes lists, at its default size and with further options.
pub(crate) fn contenders(gpu: &Gpu) -> impl Iterator<Item = Contender> + '_ {
    let ids = rows().map(Row::default_id).chain(MORE.map(str::to_owned));
    ids.filter_map(|id| contender(gpu, &id))
}

/// One of each kind of kernels and look-ups, for tests that draw on a software adapter.
const FEW: [&str; 16] = [
    "SC-E/bvh",
    "DA-E/bvh",
    "M/2/bvh",
    "T-25D/bvh",
    "HC/bvh",
    "T-E",
    "DC-I",
    "DC-E/mask",
    "HG",
    "HG/raster",
    "ZB",
    "G/visible",
    "SC-E/n24",
    "SC-I/bvh/touched",
    "SC-E/keep4",
    "W1",
];

/// The strategies that tests draw.
pub(crate) fn few(gpu: &Gpu) -> impl Iterator<Item = Contender> + '_ {
    FEW.into_iter().filter_map(|id| contender(gpu, id))
}

pub(crate) fn scene() -> Scene {
    atrium(1)
}

/// Point lights, and a spot at the end.
pub(crate) fn lights(scene: &Scene, count: u32) -> Vec<Light> {
    let mut lights = scatter_lights(&LightSpec::new(count, scene.bounds)).expect("lights");
    if let Some(last) = lights.last_mut() {
        let direction = Vec3::NEG_Y;
        last.shape = LightShape::Spot { direction, inner_angle: 0.3, outer_angle: 0.8 };
    }
    lights
}

/// A pose of the scene's camera path.
pub(crate) fn view(scene: &Scene, share: f32, size: [u32; 2]) -> View {
    let pose = scene.path.pose((share * 1000.0) as u32, 1000);
    View::look_at(pose.eye, pose.eye + pose.forward(), 1.0, 0.1, size)
}

/// Draws one frame of a strategy into an encoder, up to the lit image.
pub(crate) fn record_frame(
    renderer: &Renderer,
    (view, lights): (&View, &LightBuffer),
    strategy: &mut dyn Assignment,
    lighting: &Lighting,
    encoder: &mut wgpu::CommandEncoder,
) {
    let frame = renderer.frame(view, lights);
    strategy.prepare(renderer.gpu(), &frame).expect("prepares");
    let mut passes = EncoderPasses { encoder };
    record_before_lighting(renderer, Mode::Deferred, strategy, &frame, &mut passes);
    lighting.record(renderer, view, strategy, &mut passes).expect("lights");
}

/// The lighting pass for a strategy.
pub(crate) fn lighting(
    renderer: &Renderer,
    lights: &LightBuffer,
    contender: &Contender,
) -> Lighting {
    let exit_weight = if contender.early_exit { 0.0 } else { -1.0 };
    let options =
        LightingOptions { kinds: lights.kinds(), exit_weight, ..LightingOptions::default() };
    Lighting::new(renderer, contender.strategy.as_ref(), Mode::Deferred, options).expect("compiles")
}

/// The image of a renderer's view.
pub(crate) fn image(renderer: &Renderer, view: &View) -> HdrImage {
    HdrImage::read(renderer.gpu(), renderer.targets(), view.viewport).expect("reads")
}

/// The image without culling.
pub(crate) fn truth(renderer: &Renderer, view: &View, lights: &LightBuffer) -> HdrImage {
    let gpu = renderer.gpu();
    let mut none = contender(gpu, "None").expect("no culling");
    let lighting = lighting(renderer, lights, &none);
    let mut encoder = gpu.device.create_command_encoder(&Default::default());
    record_frame(renderer, (view, lights), none.strategy.as_mut(), &lighting, &mut encoder);
    gpu.queue.submit([encoder.finish()]);
    image(renderer, view)
}
