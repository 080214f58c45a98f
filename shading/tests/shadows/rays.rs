//! Rays through deep images in place of maps: against the truth, and where they must show nothing.

use assign::{Assignment, EncoderPasses, Everything, Light, LightBuffer, LightOrder, View};
use assign_cdi::{Build, DeepImageSettings, DeepImages, Directions, Spread, Storage};
use glam::Vec3;
use shading::{
    HdrImage, Lighting, LightingOptions, Mode, OccluderDepth, Renderer, ShadingError, ShadowModel,
    WorldTriangles, shadow_images, traced::Transport,
};

use crate::{
    cast_rays_through, common, images, lamp, off, spot,
    truth::{plates, shared, truth, view},
    walls::{room, scene, walls_of},
};

fn rays(rays: u32) -> ShadowModel {
    ShadowModel::Cdi { rays }
}

const NONE: ShadowModel = ShadowModel::None;

/// A floor, a wall and two plates: the more rays, the closer. The images without shadows are the control.
#[test]
fn rays_come_closer_to_the_truth_with_their_number() {
    let gpu = common::gpu();
    let scene = plates();
    let lights = [lamp(Vec3::new(0.0, 3.0, 0.0))];
    let models = [NONE, rays(1), rays(9), rays(16), rays(25)];
    let (images, gbuffer) = images(&gpu, &scene, &view(), &lights, &models);
    let of_scene = |transport| truth(&scene, &lights, &gbuffer, transport);
    let (whole, separated) = (of_scene(Transport::Unshadowed), of_scene(Transport::Separated));
    let exact = shared(&images[0], &separated, &whole);
    let errors: Vec<f64> = images.iter().map(|image| off(image, &exact)).collect();
    println!("errors of {models:?}: {errors:.4?}");
    assert!(errors[0] > 0.05, "without shadows: {errors:?}");
    assert!(errors.is_sorted_by(|a, b| a > b), "{errors:?}");
    assert!(errors[4] < 0.15 * errors[0], "25 rays: {errors:?}");
}

#[test]
fn lights_of_one_position_cast_shadows_up_to_the_pixel() {
    let gpu = common::gpu();
    let scene = plates();
    let at = Vec3::new(0.0, 3.0, 0.5);
    let lights = [
        Light::point(at, 30.0, Vec3::splat(4.0)),
        spot(at, 0.7),
        Light::vpl(at, Vec3::NEG_Y, 30.0, Vec3::splat(4.0)),
    ];
    for light in lights {
        let (images, gbuffer) = images(&gpu, &scene, &view(), &[light], &[NONE, rays(1)]);
        let direct = truth(&scene, &[light], &gbuffer, Transport::Direct);
        let errors = [off(&images[0], &direct), off(&images[1], &direct)];
        println!("{:?}: {errors:.4?}", light.shape);
        assert!(errors[0] > 0.03, "{:?}, without shadows: {errors:?}", light.shape);
        assert!(errors[1] < 0.12 * errors[0], "{:?}: {errors:?}", light.shape);
    }
}

fn lit(image: &HdrImage) -> usize {
    image.pixels.iter().filter(|pixel| pixel.iter().any(|channel| *channel > 0.0)).count()
}

/// The sum of a channel over that of another image.
fn share(image: &HdrImage, whole: &HdrImage) -> f64 {
    let sum = |image: &HdrImage| image.pixels.iter().map(|p| f64::from(p[0])).sum::<f64>();
    sum(image) / sum(whole)
}

/// An empty room loses no light but in corners, half a pixel wide: `rays.rs` says why.
#[test]
fn no_surface_shadows_itself() {
    let gpu = common::gpu();
    let eye = Vec3::new(2.5, 1.0, 2.5);
    let view = View::look_at(eye, Vec3::new(-1.0, 0.6, -1.0), 1.4, 0.05, [96, 64]);
    let at = Vec3::new(-1.3, 2.6, 0.7);
    let lights = [lamp(at), Light::point(at, 30.0, Vec3::ONE), spot(at, 0.9)];
    for light in lights {
        let (images, _) = images(&gpu, &scene(&room()), &view, &[light], &[NONE, rays(4)]);
        let error = off(&images[1], &images[0]);
        println!("{error:.5}: {:?}", light.shape);
        assert!(error < 0.005, "{light:?}: {error}");
    }
}

/// A wall of 2 cm, more than a pixel, divides a small room. The half without lamps stays dark, but for rays that pass the
/// wall's foot or run along it.
#[test]
fn a_wall_hides_a_light() {
    let gpu = common::gpu();
    let mut quads = walls_of(Vec3::new(-1.2, 0.0, -1.2), Vec3::new(1.2, 2.0, 1.2), true);
    quads.extend(walls_of(Vec3::new(-0.01, 0.0, -1.2), Vec3::new(0.01, 2.0, 1.2), false));
    let eye = Vec3::new(1.1, 0.9, 1.1);
    let view = View::look_at(eye, Vec3::new(0.1, 0.3, -0.2), 1.4, 0.05, [96, 64]);
    let at = Vec3::new(-0.6, 1.6, 0.1);
    for light in [lamp(at), Light::point(at, 30.0, Vec3::ONE), spot(at, 0.9)] {
        let (images, _) = images(&gpu, &scene(&quads), &view, &[light], &[NONE, rays(9)]);
        assert!(lit(&images[0]) > 1000, "without shadows the dark half is lit");
        let leaked = share(&images[1], &images[0]);
        println!("{leaked:.5} of the light in {} pixels: {:?}", lit(&images[1]), light.shape);
        assert!(leaked < 0.005, "{light:?}: {leaked}");
    }
}

#[test]
fn rays_are_refused_without_finished_images_of_the_scene() {
    let gpu = common::gpu();
    let view = common::view([32, 32]);
    let scene = common::showcase();
    let light = lamp(Vec3::new(0.0, 3.0, 0.0));
    let lights = LightBuffer::new(&gpu, &[light]).unwrap();
    let mut renderer = Renderer::new(&gpu, &scene, &view).unwrap();
    let refused = |renderer: &mut Renderer, lights: &LightBuffer| {
        let error = renderer.cast_shadows(lights, rays(4)).unwrap_err().to_string();
        assert!(renderer.shadow_figures().is_none() && renderer.shadow_images().is_none());
        error
    };
    let error = refused(&mut renderer, &lights);
    let expected = "shadow model is cdi:4: it must be none or one with maps before Renderer::cast_rays_through";
    assert_eq!(error, expected);
    let directions = Directions::new(Spread::Squares, 4, 4).unwrap();
    let good = shadow_images(directions, 64);
    let triangles = std::sync::Arc::new(WorldTriangles::new(&gpu, &scene).unwrap());
    let mut refused_with = |settings: DeepImageSettings| {
        renderer.cast_rays_through(triangles.clone(), settings);
        refused(&mut renderer, &lights)
    };
    let linked = Storage::LinkedLists;
    let error = refused_with(DeepImageSettings { storage: linked, ..good });
    assert!(error.starts_with("storage of deep images is LinkedLists: it must be "), "{error}");
    // Images that overflow are used for nothing.
    let error = refused_with(DeepImageSettings { most_fragments: 500, ..good });
    assert!(error.contains("deep images of ") && error.contains("2000"), "{error}");
    let error = refused_with(DeepImageSettings {
        build: Build::PerDirection { coverage: Default::default(), at_once: 17 },
        ..good
    });
    assert!(error.contains("it must be 1 to 16"), "{error}");

    cast_rays_through(&mut renderer, &scene, 4, 64);
    let figures = renderer.cast_shadows(&lights, rays(16)).unwrap().unwrap();
    assert_eq!((figures.maps_per_area_light, figures.maps, figures.atlas_px), (16, 16, [0, 0]));
    assert_eq!(Some(figures.image_bytes), renderer.shadow_images().map(DeepImages::bytes));
    renderer.prepare(&view, &lights).unwrap();
    let moved = LightBuffer::new(&gpu, &[lamp(Vec3::new(0.1, 3.0, 0.0))]).unwrap();
    let error = renderer.prepare(&view, &moved).unwrap_err();
    assert!(matches!(error, ShadingError::StaleShadows), "{error}");
    let error = renderer.move_shadows(&moved).unwrap_err().to_string();
    assert!(error.contains("shadow model cdi:16 cannot serve lights that move"), "{error}");
    // A pass reads the points and the images for which it was created.
    let mut strategy = Everything::new(&gpu).unwrap();
    let options =
        LightingOptions { kinds: lights.kinds(), shadows: rays(16), ..LightingOptions::default() };
    let lighting = Lighting::new(&renderer, &strategy, Mode::Deferred, options).unwrap();
    let mut record = |renderer: &Renderer, lights: &LightBuffer| {
        let mut encoder = gpu.device.create_command_encoder(&Default::default());
        strategy.prepare(&gpu, &renderer.frame(&view, lights)).unwrap();
        let mut passes = EncoderPasses { encoder: &mut encoder };
        lighting.record(renderer, &view, &strategy, &mut passes)
    };
    renderer.prepare(&view, &lights).unwrap();
    assert!(record(&renderer, &lights).is_ok());
    renderer.cast_shadows(&moved, rays(16)).unwrap();
    renderer.prepare(&view, &moved).unwrap();
    assert!(matches!(record(&renderer, &moved), Err(ShadingError::StaleShadows)));
    // Only maps say what hides lights from groups.
    let error = renderer.find_occluders(OccluderDepth::Farthest).unwrap_err().to_string();
    assert!(error.starts_with("shadow model is cdi:16: it must be a model with maps"), "{error}");
    let ordered = LightBuffer::ordered(&gpu, &[light], LightOrder::Gpu { every: 1 }).unwrap();
    let error = refused(&mut renderer, &ordered);
    assert!(error.contains("shadow model cdi:4 cannot serve lights that the GPU"), "{error}");
}
