//! Maps that are paraboloids: as good as cubes where triangles are small, and wrong where they are large.

use assign::{Light, LightShape};
use glam::Vec3;
use scenes::{Material, Scene};
use shading::{
    ShadowModel,
    traced::{TracedScene, Transport, TruthSettings, truth_image},
};

use crate::{
    common::{
        self,
        quads::{grey, scene_of},
    },
    images, lamp, maps, off, spot,
    truth::view,
    walls::{boxes, dark_among_lit, view_of_boxes, walls_of},
};

/// Each rectangle as `side` x `side` rectangles.
fn divided(quads: &[[Vec3; 3]], side: u32) -> Vec<[Vec3; 3]> {
    let part = |[center, x, y]: &[Vec3; 3], i: u32, j: u32| {
        let place = |ix: u32| (2 * ix + 1) as f32 / side as f32 - 1.0;
        [*center + *x * place(i) + *y * place(j), *x / side as f32, *y / side as f32]
    };
    let parts = |quad| (0..side * side).map(move |ix| part(quad, ix % side, ix / side));
    quads.iter().flat_map(parts).collect()
}

fn scene(quads: &[[Vec3; 3]]) -> Scene {
    scene_of(quads, Material { double_sided: true, ..grey(0.5) }, vec![])
}

fn paraboloids(maps: u32, px: u32) -> ShadowModel {
    ShadowModel::Paraboloids { maps, px }
}

/// A floor, a wall and two plates.
fn quads() -> [[Vec3; 3]; 4] {
    let floor = [Vec3::ZERO, Vec3::Z * 4.0, Vec3::X * 4.0];
    let wall = [Vec3::new(0.0, 2.0, -3.0), Vec3::X * 4.0, Vec3::Y * 2.0];
    let plate = [Vec3::new(-0.4, 1.2, 0.0), Vec3::Z * 0.4, Vec3::X * 0.4];
    let away = [Vec3::new(1.0, 0.5, -1.0), Vec3::new(0.3, 0.1, 0.0), Vec3::Z * 0.3];
    [floor, wall, plate, away]
}

/// Where triangles are small, shadows are as near to the exact ones as those of cubes, for lights that need no paraboloid,
/// one and two. The same scene of a few large triangles is the control.
#[test]
fn paraboloids_are_right_where_triangles_are_small() {
    let gpu = common::gpu();
    let at = Vec3::new(0.0, 2.6, 0.5);
    let models = [ShadowModel::None, maps(1, 512, 1), paraboloids(1, 512)];
    for (name, light) in [
        ("point", Light::point(at, 30.0, Vec3::splat(4.0))),
        ("narrow spot", spot(at, 0.7)),
        ("wide spot", spot(at, 1.4)),
        ("virtual point light", Light::vpl(at, Vec3::NEG_Y, 30.0, Vec3::splat(4.0))),
    ] {
        let errors_of = |side: u32| {
            let scene = scene(&divided(&quads(), side));
            let (images, gbuffer) = images(&gpu, &scene, &view(), &[light], &models);
            let traced = TracedScene::new(&scene);
            let settings = TruthSettings::new(Transport::Direct);
            let sample_of = |pixel| gbuffer.sample(pixel, &traced);
            let truth = truth_image(&traced, &[light], [96, 64], sample_of, settings, &|_, _| ());
            images.iter().map(|image| off(image, &truth.radiance)).collect::<Vec<f64>>()
        };
        let (fine, coarse) = (errors_of(40), errors_of(1));
        println!("{name}: none, cube, paraboloid: {fine:.4?}; large triangles: {coarse:.4?}");
        assert!(fine[2] < 0.25 * fine[0] && fine[1] < 0.25 * fine[0], "{name}: {fine:?}");
        // The other lights look straight down, where the floor's edges bend least.
        if matches!(light.shape, LightShape::Point) {
            assert!(coarse[2] > 5.0 * fine[2], "{name}: {coarse:?}");
        }
    }
}

/// An empty room shadows nothing, at small triangles and at large ones: offsets hold on their planes.
#[test]
fn no_surface_shadows_itself_on_a_paraboloid() {
    let gpu = common::gpu();
    let room = walls_of(Vec3::new(-3.0, 0.0, -3.0), Vec3::new(3.0, 3.0, 3.0), true);
    let from = Vec3::new(2.5, 1.0, 2.5);
    let view = assign::View::look_at(from, Vec3::new(-1.0, 0.6, -1.0), 1.4, 0.05, [96, 64]);
    let at = Vec3::new(-1.3, 2.2, 0.7);
    for (side, light) in [(24, lamp(at)), (1, Light::point(at, 30.0, Vec3::ONE))] {
        let models = [ShadowModel::None, paraboloids(4, 64), paraboloids(1, 256)];
        let (images, _) = images(&gpu, &scene(&divided(&room, side)), &view, &[light], &models);
        for (image, model) in images.iter().zip(models).skip(1) {
            let difference = image.difference(&images[0]).unwrap();
            assert!(difference.max_rel < 1e-5, "{model}, {light:?}: {difference:?}");
        }
    }
}

/// Edges of boxes and of a column have no dark seams.
#[test]
fn paraboloids_leave_no_dark_seams_at_edges() {
    let gpu = common::gpu();
    let room = walls_of(Vec3::new(-3.0, 0.0, -3.0), Vec3::new(3.0, 3.0, 3.0), true);
    let scene = scene(&[divided(&room, 32), divided(&boxes(), 16)].concat());
    let size = [192, 128];
    let traced = TracedScene::new(&scene);
    for at in [Vec3::new(2.0, 2.5, 1.5), Vec3::new(-2.5, 2.8, 2.0)] {
        let light = Light::point(at, 30.0, Vec3::ONE);
        let models = [paraboloids(1, 256), paraboloids(1, 1024)];
        let (images, gbuffer) = images(&gpu, &scene, &view_of_boxes(size), &[light], &models);
        let sample_of = |pixel| gbuffer.sample(pixel, &traced);
        let settings = TruthSettings::new(Transport::Direct);
        let truth = truth_image(&traced, &[light], size, sample_of, settings, &|_, _| ()).radiance;
        for (image, model) in images.iter().zip(models) {
            let [open, dark] = dark_among_lit(image, &truth, size);
            println!("{model}, {at}: {dark} of {open} pixels");
            assert!(open > 5_000 && dark <= 3, "{model}, {at}: {dark} of {open} pixels");
        }
    }
}

/// A paraboloid takes a third of the texels of a cube.
#[test]
fn an_atlas_of_paraboloids_is_a_third_as_large() {
    let gpu = common::gpu();
    let lights: Vec<Light> =
        (0..12).map(|ix| Light::point(Vec3::Y * ix as f32, 9.0, Vec3::ONE)).collect();
    let lights = assign::LightBuffer::new(&gpu, &lights).unwrap();
    let mut renderer = shading::Renderer::new(&gpu, &common::showcase(), &view()).unwrap();
    let cube = renderer.cast_shadows(&lights, maps(1, 64, 1)).unwrap().unwrap();
    let curved = renderer.cast_shadows(&lights, paraboloids(1, 64)).unwrap().unwrap();
    assert_eq!((cube.faces, curved.faces), (72, 24));
    assert!(curved.atlas_bytes() * 5 < cube.atlas_bytes() * 2);
    let error = renderer.find_occluders(Default::default()).unwrap_err().to_string();
    assert!(error.contains("cannot serve shadow model maps:1,64,paraboloid"), "{error}");
}
