//! Shadows of suns: near the exact ones, without false shadows and leaks, and the same in all methods.

use assign::{
    Assignment, Bounds, CullSettings, EncoderPasses, Everything, Gpu, Light, LightBuffer, Sun,
    Suns, View,
};
use assign_clustered::{Clustered, Occupancy};
use glam::Vec3;
use scenes::{Aabb, Material, Scene};
use shading::{
    AreaModel, Cut, HdrImage, LayerOptions, LightingOptions, Mode, RASTER_SPHERE_TOLERANCE,
    RasterSpheres, Renderer, ShadowModel,
    traced::{GBufferSamples, TracedScene, Transport, TruthSettings, truth_image},
};

use crate::{
    common::{
        self,
        quads::{grey, scene_of},
    },
    draw_with, maps, off,
    truth::{plates, view},
    walls::{boxes, dark_among_lit, view_of_boxes, walls_of},
};

fn bounded(scene: Scene, half: f32) -> Scene {
    let bounds = Aabb::new(Vec3::splat(-half), Vec3::splat(half));
    Scene { bounds, core_bounds: bounds, ..scene }
}

fn suns(directions: &[Vec3]) -> Suns {
    let sun = |d: &Vec3| Sun { direction: d.normalize(), irradiance: Vec3::splat(2.0) };
    Suns::new(&directions.iter().map(sun).collect::<Vec<_>>()).unwrap()
}

/// The renderer of a scene whose suns and lights have maps.
fn cast(
    gpu: &Gpu,
    scene: &Scene,
    lights: &LightBuffer,
    suns: Suns,
    model: ShadowModel,
) -> Renderer {
    let mut renderer = Renderer::new(gpu, scene, &view()).unwrap();
    renderer.cast_shadows_of_suns(suns);
    renderer.cast_shadows(lights, model).unwrap();
    renderer
}

/// The images under suns alone, and the G-buffer.
fn images(
    scene: &Scene,
    view: &View,
    suns: Suns,
    models: &[ShadowModel],
) -> (Vec<HdrImage>, GBufferSamples) {
    let gpu = common::gpu();
    let lights = LightBuffer::new(&gpu, &[]).unwrap();
    let mut renderer = cast(&gpu, scene, &lights, suns, ShadowModel::None);
    let mut everything = Everything::new(&gpu).unwrap();
    let images = models.iter().map(|&shadows| {
        renderer.cast_shadows(&lights, shadows).unwrap();
        renderer.prepare(view, &lights).unwrap();
        let options = LightingOptions { suns, shadows, ..LightingOptions::default() };
        draw_with(&renderer, view, &lights, &mut everything, Mode::Deferred, options)
    });
    (images.collect(), GBufferSamples::read(&renderer, view).unwrap())
}

#[test]
fn shadows_of_suns_are_exact_up_to_the_texel() {
    let scene = bounded(plates(), 5.0);
    let suns = suns(&[Vec3::new(0.1, -1.0, 0.2), Vec3::new(-0.6, -0.5, -0.3)]);
    let models = [ShadowModel::None, maps(1, 256, 1), maps(1, 2048, 1), maps(1, 1024, 9)];
    let (images, gbuffer) = images(&scene, &view(), suns, &models);
    let traced = TracedScene::new(&scene);
    let settings = TruthSettings { suns, ..TruthSettings::new(Transport::Direct) };
    let sample_of = |pixel| gbuffer.sample(pixel, &traced);
    let truth = truth_image(&traced, &[], [96, 64], sample_of, settings, &|_, _| ()).radiance;
    let errors: Vec<f64> = images.iter().map(|image| off(image, &truth)).collect();
    println!("{models:?}: {errors:.4?}");
    assert!(errors[0] > 0.02, "without shadows: {errors:?}");
    assert!(errors[1] < 0.3 * errors[0] && errors[2] < 0.05 * errors[0], "{errors:?}");
    assert!(errors[3] < 0.25 * errors[0], "{errors:?}");
}

/// An open court has no false shadows, whatever the slope, the texel and the filter, and a wall of 10 cm has no leak.
#[test]
fn suns_shadow_no_surface_by_itself_and_pass_no_wall() {
    // The court's floor and two walls, all of which face the suns.
    let mut quads = walls_of(Vec3::new(-3.0, 0.0, -3.0), Vec3::new(3.0, 3.0, 3.0), true);
    quads = [3, 1, 5].map(|ix| quads[ix]).to_vec();
    let scene = |quads: &[[Vec3; 3]]| {
        bounded(scene_of(quads, Material { double_sided: true, ..grey(0.5) }, vec![]), 4.0)
    };
    let at =
        View::look_at(Vec3::new(2.6, 1.6, 2.8), Vec3::new(-1.0, 0.6, -1.0), 1.2, 0.05, [96, 64]);
    let slopes = suns(&[
        Vec3::new(-0.3, -0.5, -0.4),
        Vec3::new(-1.0, -0.02, -0.3),
        Vec3::new(-0.05, -1.0, -0.9),
    ]);
    let models =
        [ShadowModel::None, maps(1, 32, 1), maps(1, 64, 25), maps(1, 256, 4), maps(1, 2048, 1)];
    let (open, _) = images(&scene(&quads), &at, slopes, &models);
    assert!(open[0].pixels.iter().flatten().sum::<f32>() > 1.0);
    for (image, model) in open.iter().zip(models) {
        let difference = image.difference(&open[0]).unwrap();
        assert!(difference.max_rel < 1e-5, "{model}: {difference:?}");
    }
    // A closed box around the camera, 10 cm thick.
    let mut closed = walls_of(Vec3::new(-3.0, 0.0, -3.0), Vec3::new(3.0, 3.0, 3.0), true);
    closed.extend(walls_of(Vec3::new(-3.1, -0.1, -3.1), Vec3::new(3.1, 3.1, 3.1), false));
    let (dark, _) = images(&scene(&closed), &at, slopes, &[ShadowModel::None, maps(1, 512, 1)]);
    let lit = |ix: usize| dark[ix].pixels.iter().filter(|pixel| pixel[0] > 0.0).count();
    assert!(lit(0) > 1_000, "without shadows: {}", lit(0));
    assert_eq!(lit(1), 0, "light leaks into a closed box");
}

/// Edges of boxes and of a column have no dark seams.
#[test]
fn suns_leave_no_dark_seams_at_edges() {
    let floor = [Vec3::ZERO, Vec3::Z * 3.0, Vec3::X * 3.0];
    let quads = [vec![floor], boxes()].concat();
    let scene =
        bounded(scene_of(&quads, Material { double_sided: true, ..grey(0.5) }, vec![]), 3.0);
    let size = [192, 128];
    let models = [maps(1, 64, 1), maps(1, 256, 1), maps(1, 256, 25), maps(1, 1024, 1)];
    for direction in [Vec3::new(-0.5, -0.8, -0.6), Vec3::new(0.7, -0.3, -0.5)] {
        let suns = suns(&[direction]);
        let (images, gbuffer) = images(&scene, &view_of_boxes(size), suns, &models);
        let traced = TracedScene::new(&scene);
        let settings = TruthSettings { suns, ..TruthSettings::new(Transport::Direct) };
        let sample_of = |pixel| gbuffer.sample(pixel, &traced);
        let truth = truth_image(&traced, &[], size, sample_of, settings, &|_, _| ()).radiance;
        for (image, model) in images.iter().zip(models) {
            let [open, dark] = dark_among_lit(image, &truth, size);
            println!("{model}, {direction}: {dark} of {open} pixels");
            assert!(open > 3_000 && dark <= 3, "{model}, {direction}: {dark} of {open} pixels");
        }
    }
}

/// Suns and lights together, on surfaces and in fog, in clusters, without culling and in light volumes.
#[test]
fn all_methods_show_the_same_shadows_of_suns() {
    let gpu = common::gpu();
    let scene = bounded(plates(), 5.0);
    let suns = suns(&[Vec3::new(0.1, -1.0, 0.2), Vec3::new(-0.6, -0.5, -0.3)]);
    let lights = [
        Light::point(Vec3::new(0.5, 2.0, 0.0), 6.0, Vec3::ONE),
        Light::point(Vec3::new(-1.5, 1.0, 0.5), 2.0, Vec3::ONE),
    ];
    let lights = LightBuffer::new(&gpu, &lights).unwrap();
    let view = view();
    for fog_per_m in [None, Some(0.15)] {
        let model = maps(1, 128, 4);
        let mut renderer = cast(&gpu, &scene, &lights, suns, model);
        renderer.show_layers(&LayerOptions { fog_per_m, ..LayerOptions::default() }).unwrap();
        renderer.prepare(&view, &lights).unwrap();
        let figures = renderer.shadow_figures().unwrap();
        assert_eq!((figures.maps, figures.faces), (4, 2 + 2 * 6));
        let shadowed = LightingOptions {
            kinds: lights.kinds(),
            suns,
            shadows: model,
            ..LightingOptions::default()
        };
        let draw = |strategy: &mut dyn Assignment, options| {
            draw_with(&renderer, &view, &lights, strategy, Mode::Deferred, options)
        };
        let mut everything = Everything::new(&gpu).unwrap();
        let none = draw(&mut everything, shadowed);
        let size = "12x12x24".parse().unwrap();
        let settings = CullSettings::default();
        let mut clusters =
            Clustered::new(&gpu, size, Bounds::Implicit, Occupancy::Dense, settings).unwrap();
        // After the first frame, lists have all the memory that they need.
        draw(&mut clusters, shadowed);
        let image = draw(&mut clusters, shadowed);
        assert_eq!(image.difference(&none).unwrap().differing_channels, 0);
        let plain = LightingOptions { shadows: ShadowModel::None, ..shadowed };
        let plain = draw(&mut everything, plain);
        let changed = plain.difference(&none).unwrap().differing_channels;
        assert!(changed > 1_000, "shadows change {changed} channels");
        if fog_per_m.is_some() {
            continue;
        }
        let volumes = RasterSpheres::new(
            &renderer,
            lights.kinds(),
            AreaModel::default(),
            Cut::default(),
            suns,
            model,
        )
        .unwrap();
        let mut encoder = gpu.device.create_command_encoder(&Default::default());
        let mut passes = EncoderPasses { encoder: &mut encoder };
        renderer.record_depth(&view, &mut passes);
        renderer.record_gbuffer(&view, &mut passes);
        volumes.record(&renderer, &view, &lights, &mut passes).unwrap();
        gpu.queue.submit([encoder.finish()]);
        let image = HdrImage::read(&gpu, renderer.targets(), view.viewport).unwrap();
        assert!(image.difference(&none).unwrap().max_rel < RASTER_SPHERE_TOLERANCE);
    }
}
