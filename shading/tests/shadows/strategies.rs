//! All strategies show the same shadows, bit for bit.

use assign::{
    Assignment, Bounds, CullSettings, Emitter, EncoderPasses, Everything, Light, LightBuffer, Suns,
    View,
};
use assign_clustered::{Clustered, Occupancy};
use assign_model::PerModel;
use glam::Vec3;
use shading::{
    AreaModel, Cut, HdrImage, LightingOptions, Mode, RASTER_SPHERE_TOLERANCE, RasterSpheres,
    Renderer, ShadowModel, light_pixel,
};

use crate::{cast_rays_through, common, draw, lamp, maps};

/// Lights of all kinds.
fn lights() -> Vec<Light> {
    let mut lights = common::lights(30);
    lights.iter_mut().for_each(|light| light.range_m += 1.5);
    let both = Emitter::rectangle(Vec3::X * 0.3, Vec3::Y * 0.3).two_sided();
    lights.push(lamp(Vec3::new(0.5, 3.0, 0.0)));
    lights.push(Light::area(both, Vec3::new(-0.5, 1.3, -0.5), 4.0, Vec3::splat(2.0)));
    lights
}

#[test]
fn shadows_differ_in_no_bit_between_strategies() {
    let gpu = common::gpu();
    let view = common::view([96, 64]);
    let lights = LightBuffer::new(&gpu, &lights()).unwrap();
    let mut renderer = Renderer::new(&gpu, &common::showcase(), &view).unwrap();
    let model = maps(9, 64, 4);
    let figures = renderer.cast_shadows(&lights, model).unwrap().unwrap();
    assert_eq!((figures.maps, figures.fell_back()), (30 + 2 * 9, false));
    all_show_the_same(&mut renderer, &view, &lights, model, &[Mode::Deferred, Mode::Forward]);
    let model = ShadowModel::Pcss { maps: 1, px: 64, taps: 9 };
    renderer.cast_shadows(&lights, model).unwrap();
    all_show_the_same(&mut renderer, &view, &lights, model, &[Mode::Deferred]);
    let model = ShadowModel::Adaptive { px: 64, down: 4, most: 25 };
    renderer.cast_shadows(&lights, model).unwrap();
    renderer.prepare(&view, &lights).unwrap();
    renderer.settle_shadows(&view).unwrap();
    let maps = renderer.shadow_figures().unwrap().maps;
    assert!((30 + 2 * 4 + 1..30 + 2 * 25).contains(&maps), "{maps} maps");
    all_show_the_same(&mut renderer, &view, &lights, model, &[Mode::Deferred]);
    cast_rays_through(&mut renderer, &common::showcase(), 4, 32);
    let model = ShadowModel::Cdi { rays: 4 };
    let figures = renderer.cast_shadows(&lights, model).unwrap().unwrap();
    assert_eq!((figures.maps, figures.faces, figures.fell_back()), (30 + 2 * 4, 0, false));
    all_show_the_same(&mut renderer, &view, &lights, model, &[Mode::Deferred, Mode::Forward]);
}

/// Compares strategies with no culling, whose image shows the shadows.
fn all_show_the_same(
    renderer: &mut Renderer,
    view: &View,
    lights: &LightBuffer,
    model: ShadowModel,
    modes: &[Mode],
) {
    let gpu = renderer.gpu().clone();
    renderer.prepare(view, lights).unwrap();
    let clusters = |bounds, occupancy| -> Box<dyn Assignment> {
        let size = "16x16x16".parse().unwrap();
        let settings = CullSettings::default();
        Box::new(Clustered::new(&gpu, size, bounds, occupancy, settings).unwrap())
    };
    let per_model = PerModel::new(&gpu, None, CullSettings::default()).unwrap();
    let mut strategies = [
        clusters(Bounds::Implicit, Occupancy::Dense),
        clusters(Bounds::Explicit, Occupancy::Sparse),
        Box::new(per_model),
    ];
    for &mode in modes {
        let mut everything = Everything::new(&gpu).unwrap();
        let draw = |strategy: &mut dyn Assignment, shadows| {
            draw(renderer, view, lights, strategy, mode, shadows)
        };
        let none = draw(&mut everything, model);
        let plain = draw(&mut everything, ShadowModel::None);
        let changed = plain.difference(&none).unwrap().differing_channels;
        assert!(changed > 2_000, "{mode:?}: shadows change {changed} channels");
        for strategy in &mut strategies {
            // The first frame asks for a larger pool.
            draw(&mut **strategy, model);
            let image = draw(&mut **strategy, model);
            let difference = image.difference(&none).unwrap();
            assert_eq!(difference.differing_channels, 0, "{} {mode:?}", strategy.id());
        }
    }
}

/// Light volumes, and the lights of one pixel one by one, show the same shadows.
#[test]
fn light_volumes_and_single_lights_have_the_same_shadows() {
    let gpu = common::gpu();
    let view = common::view([96, 64]);
    let lights = LightBuffer::new(&gpu, &lights()).unwrap();
    let mut renderer = Renderer::new(&gpu, &common::showcase(), &view).unwrap();
    cast_rays_through(&mut renderer, &common::showcase(), 4, 32);
    for model in [maps(4, 64, 1), ShadowModel::Cdi { rays: 4 }] {
        renderer.cast_shadows(&lights, model).unwrap();
        renderer.prepare(&view, &lights).unwrap();
        compare_volumes_and_single_lights(&renderer, &view, &lights, model);
    }
}

fn compare_volumes_and_single_lights(
    renderer: &Renderer,
    view: &View,
    lights: &LightBuffer,
    model: ShadowModel,
) {
    let gpu = renderer.gpu();
    let kinds = lights.kinds();
    let mut everything = Everything::new(gpu).unwrap();
    let none = draw(renderer, view, lights, &mut everything, Mode::Deferred, model);
    let options = LightingOptions { kinds, shadows: model, ..LightingOptions::default() };
    let frame = renderer.frame(view, lights);
    let entries: Vec<u32> = (0..lights.count()).map(|light| light | 0xc000_0000).collect();
    let mut lit = 0;
    for pixel in [[20, 50], [48, 40], [60, 50], [70, 20]] {
        let found = light_pixel(renderer, &frame, options, pixel, &entries).unwrap().unwrap();
        let sum = found.radiance.iter().fold(Vec3::ZERO, |sum, one| sum + Vec3::from(*one));
        let sum = sum + Vec3::from_slice(&found.surface.emission[..3]);
        let shown = Vec3::from(none.pixels[(pixel[1] * 96 + pixel[0]) as usize]);
        assert!((sum - shown).abs().max_element() <= 1e-4 * shown.max_element(), "{sum} {shown}");
        lit += u32::from(shown.max_element() > 0.01);
    }
    assert!(lit > 2, "{lit} pixels are lit");
    let (area, cut) = (AreaModel::default(), Cut::default());
    let volumes = RasterSpheres::new(renderer, kinds, area, cut, Suns::default(), model).unwrap();
    let mut encoder = gpu.device.create_command_encoder(&Default::default());
    let mut passes = EncoderPasses { encoder: &mut encoder };
    renderer.record_depth(view, &mut passes);
    renderer.record_gbuffer(view, &mut passes);
    volumes.record(renderer, view, lights, &mut passes).unwrap();
    gpu.queue.submit([encoder.finish()]);
    let image = HdrImage::read(gpu, renderer.targets(), view.viewport).unwrap();
    let difference = image.difference(&none).unwrap();
    assert!(difference.max_rel < RASTER_SPHERE_TOLERANCE, "{difference:?}");
}
