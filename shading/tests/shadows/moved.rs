//! Maps that follow lights which the CPU moves.

use assign::{
    Assignment, Bounds, CullSettings, EncoderPasses, Everything, Gpu, Light, LightBuffer,
    LightOrder, View,
};
use assign_clustered::{Clustered, Occupancy};
use glam::Vec3;
use shading::{
    HdrImage, Lighting, LightingOptions, Mode, OCCLUSION_TEST, OccluderDepth, Renderer,
    ShadingError, ShadowModel, record_before_lighting,
};

use crate::{common, draw, lamp, maps, spot};

/// The lights of a frame. In the third one, two are dark.
fn lights(frame: u32) -> Vec<Light> {
    let step = 0.3 * frame as f32;
    let mut lights = common::lights(16);
    for (ix, light) in lights.iter_mut().enumerate() {
        light.range_m += 1.5;
        light.position.x += step * if ix % 2 == 0 { 1.0 } else { -1.0 };
        if frame == 2 && ix < 2 {
            light.intensity = Vec3::ZERO;
        }
    }
    lights.push(lamp(Vec3::new(step - 0.5, 2.8, 0.0)));
    lights.push(spot(Vec3::new(0.5 - step, 2.5, 0.5), 0.8));
    lights
}

/// A method with its pipelines, which all frames share.
struct Method {
    strategy: Box<dyn Assignment>,
    lighting: Lighting,
}

impl Method {
    fn new(renderer: &Renderer, strategy: Box<dyn Assignment>, options: LightingOptions) -> Self {
        let lighting = Lighting::new(renderer, &*strategy, Mode::Deferred, options).unwrap();
        Self { strategy, lighting }
    }

    /// Draws a frame, with the maps of its lights in it.
    fn draw(
        &mut self,
        renderer: &mut Renderer,
        view: &View,
        lights: &LightBuffer,
    ) -> Result<HdrImage, ShadingError> {
        let gpu = renderer.gpu().clone();
        let mut encoder = gpu.device.create_command_encoder(&Default::default());
        let mut passes = EncoderPasses { encoder: &mut encoder };
        renderer.record_shadow_maps(&mut passes);
        if self.strategy.needs().occluders {
            renderer.record_occluders(&mut passes);
        }
        self.draw_with_old_maps(renderer, view, lights, encoder)
    }

    fn draw_with_old_maps(
        &mut self,
        renderer: &Renderer,
        view: &View,
        lights: &LightBuffer,
        mut encoder: wgpu::CommandEncoder,
    ) -> Result<HdrImage, ShadingError> {
        let gpu = renderer.gpu();
        let mut passes = EncoderPasses { encoder: &mut encoder };
        let frame = renderer.frame(view, lights);
        self.strategy.prepare(gpu, &frame)?;
        let strategy = &mut *self.strategy;
        record_before_lighting(renderer, Mode::Deferred, strategy, &frame, &mut passes);
        self.lighting.record(renderer, view, strategy, &mut passes)?;
        gpu.queue.submit([encoder.finish()]);
        HdrImage::read(gpu, renderer.targets(), view.viewport)
    }
}

fn clusters(gpu: &Gpu, settings: CullSettings) -> Box<dyn Assignment> {
    let size = "12x12x24".parse().unwrap();
    Box::new(Clustered::new(gpu, size, Bounds::Explicit, Occupancy::Sparse, settings).unwrap())
}

fn encoder(gpu: &Gpu) -> wgpu::CommandEncoder {
    gpu.device.create_command_encoder(&Default::default())
}

/// In each frame, all strategies show the image of maps that were cast for its lights alone.
#[test]
fn maps_that_follow_lights_show_what_maps_cast_for_them_show() {
    let gpu = common::gpu();
    let view = common::view([64, 40]);
    let model = maps(4, 64, 4);
    let buffer = |frame| LightBuffer::new(&gpu, &lights(frame)).unwrap();
    let first = buffer(0);
    let mut renderer = Renderer::new(&gpu, &common::showcase(), &view).unwrap();
    renderer.cast_shadows(&first, model).unwrap();
    renderer.find_occluders(OccluderDepth::Farthest).unwrap();
    renderer.prepare(&view, &first).unwrap();
    let kinds = first.kinds();
    let options = LightingOptions { kinds, shadows: model, ..LightingOptions::default() };
    let occlusion = CullSettings { occlusion: Some(OCCLUSION_TEST), ..CullSettings::default() };
    let mut methods = [
        Box::new(Everything::new(&gpu).unwrap()),
        clusters(&gpu, CullSettings::default()),
        clusters(&gpu, occlusion),
    ]
    .map(|strategy: Box<dyn Assignment>| Method::new(&renderer, strategy, options));
    let mut cast = Renderer::new(&gpu, &common::showcase(), &view).unwrap();
    let mut before: Option<HdrImage> = None;
    for frame in 0..3 {
        let lights = buffer(frame);
        renderer.move_shadows(&lights).unwrap();
        renderer.prepare(&view, &lights).unwrap();
        cast.cast_shadows(&lights, model).unwrap();
        cast.prepare(&view, &lights).unwrap();
        let mut everything = Everything::new(&gpu).unwrap();
        let expected = draw(&cast, &view, &lights, &mut everything, Mode::Deferred, model);
        let mut none: Option<HdrImage> = None;
        for method in &mut methods {
            // The first frame asks for a larger pool.
            method.draw(&mut renderer, &view, &lights).unwrap();
            let image = method.draw(&mut renderer, &view, &lights).unwrap();
            // With fewer lights the maps lie elsewhere in a smaller atlas, and the rasteriser rounds otherwise there.
            let most = if frame == 2 { 40 } else { 0 };
            let difference = image.difference(&expected).unwrap();
            let id = method.strategy.id();
            assert!(difference.differing_channels <= most, "{id}, frame {frame}: {difference:?}");
            let none = none.get_or_insert_with(|| image.clone());
            let difference = image.difference(none).unwrap();
            assert_eq!(difference.differing_channels, 0, "{id}, frame {frame}: {difference:?}");
        }
        if let Some(before) = before {
            let moved = expected.difference(&before).unwrap().differing_channels;
            assert!(moved > 2_000, "frame {frame} changes {moved} channels");
        }
        before = Some(expected);
    }
}

#[test]
fn maps_that_were_not_drawn_again_are_refused() {
    let gpu = common::gpu();
    let view = common::view([32, 20]);
    let model = maps(4, 64, 1);
    let [first, second] = [0, 1].map(|frame| LightBuffer::new(&gpu, &lights(frame)).unwrap());
    let mut renderer = Renderer::new(&gpu, &common::showcase(), &view).unwrap();
    renderer.cast_shadows(&first, model).unwrap();
    renderer.find_occluders(OccluderDepth::Farthest).unwrap();
    renderer.prepare(&view, &first).unwrap();
    let options =
        LightingOptions { kinds: first.kinds(), shadows: model, ..LightingOptions::default() };
    let occlusion = CullSettings { occlusion: Some(OCCLUSION_TEST), ..CullSettings::default() };
    let mut plain = Method::new(&renderer, Box::new(Everything::new(&gpu).unwrap()), options);
    let mut hiding = Method::new(&renderer, clusters(&gpu, occlusion), options);
    let is_stale =
        |drawn: Result<HdrImage, ShadingError>| matches!(drawn, Err(ShadingError::StaleShadows));
    assert!(plain.draw_with_old_maps(&renderer, &view, &first, encoder(&gpu)).is_ok());
    assert!(hiding.draw_with_old_maps(&renderer, &view, &first, encoder(&gpu)).is_ok());
    renderer.move_shadows(&second).unwrap();
    renderer.prepare(&view, &second).unwrap();
    assert!(is_stale(plain.draw_with_old_maps(&renderer, &view, &second, encoder(&gpu))));
    // What hides lights is found after the maps are drawn.
    let mut commands = encoder(&gpu);
    renderer.record_shadow_maps(&mut EncoderPasses { encoder: &mut commands });
    assert!(is_stale(hiding.draw_with_old_maps(&renderer, &view, &second, commands)));
    assert!(plain.draw(&mut renderer, &view, &second).is_ok());
    assert!(hiding.draw(&mut renderer, &view, &second).is_ok());
    // Other maps than those that the pass reads.
    renderer.cast_shadows(&second, model).unwrap();
    assert!(is_stale(plain.draw_with_old_maps(&renderer, &view, &second, encoder(&gpu))));
}

#[test]
fn lights_that_maps_cannot_follow_are_refused() {
    let gpu = common::gpu();
    let view = common::view([32, 20]);
    let mut renderer = Renderer::new(&gpu, &common::showcase(), &view).unwrap();
    let first = LightBuffer::new(&gpu, &lights(0)).unwrap();
    renderer.move_shadows(&first).unwrap();
    renderer.cast_shadows(&first, maps(4, 64, 1)).unwrap();
    let figures = renderer.shadow_figures();
    let twice = LightBuffer::new(&gpu, &[lights(0), lights(1)].concat()).unwrap();
    let error = renderer.move_shadows(&twice).unwrap_err().to_string();
    assert!(error.starts_with("lights with shadow maps is 36 with "), "{error}");
    assert!(error.contains("Renderer::cast_shadows for all lights of all frames"), "{error}");
    assert_eq!(renderer.shadow_figures(), figures);
    let ordered = LightBuffer::ordered(&gpu, &lights(1), LightOrder::Gpu { every: 1 }).unwrap();
    let error = renderer.move_shadows(&ordered).unwrap_err().to_string();
    assert!(error.contains("cannot serve lights that the GPU"), "{error}");
    renderer.prepare(&view, &first).unwrap();
    let adaptive = ShadowModel::Adaptive { px: 64, down: 4, most: 9 };
    renderer.cast_shadows(&first, adaptive).unwrap();
    let moved = LightBuffer::new(&gpu, &lights(1)).unwrap();
    let error = renderer.move_shadows(&moved).unwrap_err().to_string();
    assert!(error.contains("adaptive:64,4,9 cannot serve lights that move"), "{error}");
}
