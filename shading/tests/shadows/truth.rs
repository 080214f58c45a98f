//! Images with shadow maps against the truth.

use assign::{Emitter, Light, View};
use glam::Vec3;
use scenes::{Material, Scene};
use shading::{
    HdrImage, ShadowModel,
    traced::{GBufferSamples, TracedScene, Transport, TruthSettings, truth_image},
};

use crate::{
    common::{
        self,
        quads::{grey, scene_of},
    },
    images, lamp, maps, off, spot,
};

const SIZE: [u32; 2] = [96, 64];

/// A floor, a wall, and two plates in the air, one of them turned away from the lights and the camera.
pub(crate) fn plates() -> Scene {
    let floor = [Vec3::ZERO, Vec3::Z * 4.0, Vec3::X * 4.0];
    let wall = [Vec3::new(0.0, 2.0, -3.0), Vec3::X * 4.0, Vec3::Y * 2.0];
    let plate = [Vec3::new(-0.4, 1.2, 0.0), Vec3::Z * 0.4, Vec3::X * 0.4];
    let away = [Vec3::new(1.0, 0.5, -1.0), Vec3::new(0.3, 0.1, 0.0), Vec3::Z * 0.3];
    scene_of(&[floor, wall, plate, away], Material { double_sided: true, ..grey(0.5) }, vec![])
}

pub(crate) fn view() -> View {
    View::look_at(Vec3::new(0.5, 2.2, 4.0), Vec3::new(0.0, 0.4, -0.5), 1.0, 0.1, SIZE)
}

fn truth(
    scene: &Scene,
    lights: &[Light],
    gbuffer: &GBufferSamples,
    transport: Transport,
) -> HdrImage {
    let traced = TracedScene::new(scene);
    let settings = TruthSettings { area_samples: 512, ..TruthSettings::new(transport) };
    let sample_of = |pixel| gbuffer.sample(pixel, &traced);
    truth_image(&traced, lights, SIZE, sample_of, settings, &|_, _| ()).radiance
}

/// An image times the ratio of two others.
pub(crate) fn shared(image: &HdrImage, part: &HdrImage, whole: &HdrImage) -> HdrImage {
    let ratio = |ix: usize, channel: usize| {
        let (part, whole) = (part.pixels[ix][channel], whole.pixels[ix][channel]);
        if whole > 0.0 { part / whole } else { 1.0 }
    };
    let pixels = image.pixels.iter().enumerate();
    let pixels = pixels.map(|(ix, pixel)| std::array::from_fn(|c| pixel[c] * ratio(ix, c)));
    HdrImage { pixels: pixels.collect(), ..*image }
}

/// More maps come closer to the exact share of each light, and no shadows are far from it.
#[test]
fn more_maps_come_closer_to_the_exact_share() {
    let gpu = common::gpu();
    let scene = plates();
    let lights = [lamp(Vec3::new(0.0, 2.2, 0.5))];
    let models = [1, 4, 9, 25, 81].map(|count| maps(count, 256, 1));
    let models: Vec<ShadowModel> = [ShadowModel::None].into_iter().chain(models).collect();
    let (images, gbuffer) = images(&gpu, &scene, &view(), &lights, &models);
    let of_scene = |transport| truth(&scene, &lights, &gbuffer, transport);
    let (whole, separated) = (of_scene(Transport::Unshadowed), of_scene(Transport::Separated));
    let direct = of_scene(Transport::Direct);
    // The exact share of what the pipeline shows without shadows: its model of area lights has errors of its own.
    let exact = shared(&images[0], &separated, &whole);
    let errors: Vec<f64> = images.iter().map(|image| off(image, &exact)).collect();
    println!("errors of {models:?}: {errors:.4?}, separation {:.4}", off(&separated, &direct));
    assert!(errors[0] > 0.03, "without shadows: {errors:?}");
    assert!(errors.is_sorted_by(|a, b| a > b), "{errors:?}");
    assert!(errors[5] < 0.1 * errors[0], "81 maps: {errors:?}");
    // Nearly matte surfaces hide little of the highlights.
    assert!(off(&separated, &direct) < 0.1 * errors[0]);
}

/// A panel stands on the floor, and a plate hides its upper half. Near the panel, the lower half gives most of the light, so
/// the share of the area would be far too small.
#[test]
fn hidden_parts_count_by_the_light_that_they_would_give() {
    let gpu = common::gpu();
    let floor = [Vec3::ZERO, Vec3::Z * 4.0, Vec3::X * 4.0];
    let plate = [Vec3::new(0.0, 1.6, -1.8), Vec3::X * 2.0, Vec3::Y * 0.6];
    let scene = scene_of(&[floor, plate], Material { double_sided: true, ..grey(0.5) }, vec![]);
    let panel = Emitter::rectangle(Vec3::X, Vec3::Y);
    let lights = [Light::area(panel, Vec3::new(0.0, 1.05, -2.0), 20.0, Vec3::splat(4.0))];
    let view = View::look_at(Vec3::new(0.0, 2.0, 4.0), Vec3::ZERO, 1.0, 0.1, SIZE);
    let models = [ShadowModel::None, maps(81, 512, 1)];
    let (images, gbuffer) = images(&gpu, &scene, &view, &lights, &models);
    let of_scene = |transport| truth(&scene, &lights, &gbuffer, transport);
    let (whole, direct) = (of_scene(Transport::Unshadowed), of_scene(Transport::Direct));
    let separated = of_scene(Transport::Separated);
    let exact = shared(&images[0], &direct, &whole);
    let errors = [off(&whole, &direct), off(&separated, &direct), off(&images[1], &exact)];
    println!("without shadows, separated, 81 maps: {errors:.4?}");
    assert!(errors[0] > 0.05, "{errors:?}");
    assert!(errors[1] < 0.08 * errors[0], "{errors:?}");
    assert!(errors[2] < 0.12 * errors[0], "{errors:?}");
}

/// One light of each kind with one position, spots with one face, five and six.
#[test]
fn lights_of_one_position_cast_exact_shadows_up_to_the_texel() {
    let gpu = common::gpu();
    let scene = plates();
    let at = Vec3::new(0.0, 3.0, 0.5);
    let vpl = Light::vpl(at, Vec3::NEG_Y, 30.0, Vec3::splat(4.0));
    let lights = [
        ("point", Light::point(at, 30.0, Vec3::splat(4.0))),
        ("narrow spot", spot(at, 0.7)),
        ("wide spot", spot(at, 1.4)),
        ("widest spot", spot(at, 2.5)),
        ("virtual point light", vpl),
    ];
    for (name, light) in lights {
        let models = [ShadowModel::None, maps(4, 256, 1), maps(4, 1024, 1)];
        let (images, gbuffer) = images(&gpu, &scene, &view(), &[light], &models);
        let direct = truth(&scene, &[light], &gbuffer, Transport::Direct);
        let errors: Vec<f64> = images.iter().map(|image| off(image, &direct)).collect();
        println!("{name}: {errors:.4?}");
        assert!(errors[0] > 0.02, "{name}, without shadows: {errors:?}");
        assert!(errors[1] < 0.1 * errors[0], "{name}: {errors:?}");
        assert!(errors[2] < 0.03 * errors[0], "{name}: {errors:?}");
    }
}

/// Light falls through the holes of alpha masks, and two-sided emitters, polygons, spheres and lines have maps.
#[test]
fn masks_keep_their_holes_and_emitters_have_any_outline() {
    let gpu = common::gpu();
    let scene = common::showcase();
    let both = Emitter::rectangle(Vec3::X * 0.3, Vec3::Y * 0.3).two_sided();
    let corners = [(-0.4, -0.3), (0.5, -0.2), (0.4, 0.4), (-0.2, 0.5)];
    let corners = corners.map(|(x, y)| Vec3::new(x - 1.5, y + 1.2, 0.7));
    // Counter-clockwise seen from the front: turned round, it faces the mask.
    let mut turned = corners;
    turned.reverse();
    let (polygon, middle) = Emitter::polygon(&turned).unwrap();
    let line = Emitter::line(Vec3::new(0.5, 0.1, 0.0), 0.05);
    let lights = [
        Light::area(both, Vec3::new(0.5, 1.3, -0.5), 20.0, Vec3::splat(2.0)),
        Light::area(polygon, middle, 20.0, Vec3::splat(3.0)),
        Light::area(Emitter::sphere(0.25), Vec3::new(0.5, 1.3, -0.5), 20.0, Vec3::splat(2.0)),
        Light::area(line, Vec3::new(-1.5, 1.2, 0.7), 20.0, Vec3::splat(3.0)),
        Light::point(Vec3::new(-1.5, 1.0, 0.5), 20.0, Vec3::splat(2.0)),
    ];
    let view = common::view(SIZE);
    for light in lights {
        let (images, gbuffer) =
            images(&gpu, &scene, &view, &[light], &[ShadowModel::None, maps(81, 256, 1)]);
        let whole = truth(&scene, &[light], &gbuffer, Transport::Unshadowed);
        let separated = truth(&scene, &[light], &gbuffer, Transport::Separated);
        let exact = shared(&images[0], &separated, &whole);
        let errors = [off(&images[0], &exact), off(&images[1], &exact)];
        println!("{errors:.4?}");
        assert!(errors[0] > 0.01, "{:?}, without shadows: {errors:?}", light.shape);
        assert!(errors[1] < 0.1 * errors[0], "{:?}: {errors:?}", light.shape);
    }
}
