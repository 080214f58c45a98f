//! Where shadow maps must show nothing: no surface shadows itself, and no light leaks through a wall.

use assign::{Light, View};
use glam::Vec3;
use scenes::{Material, Scene};
use shading::{
    HdrImage, ShadowModel,
    traced::{TracedScene, Transport, TruthSettings, truth_image},
};

use crate::{
    common::{
        self,
        quads::{grey, scene_of},
    },
    images, lamp, maps, spot,
};

const SIZE: [u32; 2] = [96, 64];

/// A box between two corners: six rectangles that face outwards, or inwards with `turned`.
pub(crate) fn walls_of(low: Vec3, high: Vec3, turned: bool) -> Vec<[Vec3; 3]> {
    let (center, half) = (0.5 * (low + high), 0.5 * (high - low));
    let axes = [Vec3::X, Vec3::Y, Vec3::Z];
    let wall = |axis: usize, sign: f32| {
        let outward = axes[axis] * sign;
        let normal = if turned { -outward } else { outward };
        let x = axes[(axis + 1) % 3];
        let y = normal.cross(x);
        [center + outward * half, x * half.dot(x.abs()), y * half.dot(y.abs())]
    };
    (0..3).flat_map(|axis| [wall(axis, 1.0), wall(axis, -1.0)]).collect()
}

pub(crate) fn room() -> Vec<[Vec3; 3]> {
    walls_of(Vec3::new(-3.0, 0.0, -3.0), Vec3::new(3.0, 3.0, 3.0), true)
}

pub(crate) fn scene(quads: &[[Vec3; 3]]) -> Scene {
    scene_of(quads, Material { double_sided: true, ..grey(0.5) }, vec![])
}

/// An empty room shadows nothing, for any texel, filter, light and slope: the image keeps its bits.
#[test]
fn no_surface_shadows_itself() {
    let gpu = common::gpu();
    let scene = scene(&room());
    let view = View::look_at(Vec3::new(2.5, 1.0, 2.5), Vec3::new(-1.0, 0.6, -1.0), 1.4, 0.05, SIZE);
    // Oblique to all walls, close to some of them.
    let at = Vec3::new(-1.3, 2.6, 0.7);
    let lights: [&[Light]; 4] = [
        &[lamp(at)],
        &[Light::point(at, 30.0, Vec3::ONE)],
        &[spot(at, 0.9), spot(at, 1.5)],
        &[
            lamp(Vec3::new(0.0, 0.1, 2.0)),
            Light::point(Vec3::new(2.9, 0.02, -2.9), 30.0, Vec3::ONE),
        ],
    ];
    for lights in lights {
        let models = [
            ShadowModel::None,
            maps(4, 32, 1),
            maps(9, 64, 25),
            maps(4, 128, 4),
            maps(4, 512, 1),
            maps(4, 512, 9),
        ];
        let (images, _) = images(&gpu, &scene, &view, lights, &models);
        assert!(images[0].pixels.iter().flatten().sum::<f32>() > 1.0);
        for (image, model) in images.iter().zip(models) {
            let difference = image.difference(&images[0]).unwrap();
            // A shader with shadows may round a last bit in another way.
            assert!(difference.max_rel < 1e-5, "{model}, {lights:?}: {difference:?}");
        }
    }
}

/// A column of 16 sides, 60 cm wide and as high as the room.
fn column(at: Vec3) -> Vec<[Vec3; 3]> {
    let side = |ix: u32| {
        let (sin, cos) = (std::f32::consts::TAU * ix as f32 / 16.0).sin_cos();
        let outward = Vec3::new(cos, 0.0, sin);
        let half_width = 0.3 * (std::f32::consts::PI / 16.0).tan();
        [at + outward * 0.3 + Vec3::Y * 1.5, Vec3::Y * 1.5, outward.cross(Vec3::Y) * half_width]
    };
    // They face the cross product of the edges: y x (outward x y) is outward.
    (0..16).map(side).collect()
}

/// Two boxes and a column in the room, and the camera on them.
pub(crate) fn boxes() -> Vec<[Vec3; 3]> {
    let mut quads = walls_of(Vec3::new(-2.0, 0.0, -1.5), Vec3::new(-1.2, 0.9, -0.6), false);
    quads.extend(walls_of(Vec3::new(0.5, 0.0, -2.0), Vec3::new(1.1, 1.4, -1.2), false));
    quads.extend(column(Vec3::new(-0.4, 0.0, -1.0)));
    quads
}

pub(crate) fn view_of_boxes(size: [u32; 2]) -> View {
    View::look_at(Vec3::new(0.4, 1.8, 2.8), Vec3::new(-0.4, 0.7, -1.0), 1.0, 0.05, size)
}

/// Pixels around which the truth is lit, two to each side, and those of them that an image shows dark.
pub(crate) fn dark_among_lit(image: &HdrImage, truth: &HdrImage, size: [u32; 2]) -> [usize; 2] {
    let lit = |image: &HdrImage, x: u32, y: u32| image.pixels[(y * size[0] + x) as usize][0] > 0.0;
    let is_lit_around =
        |x: u32, y: u32| (y - 2..=y + 2).all(|y| (x - 2..=x + 2).all(|x| lit(truth, x, y)));
    let inside = (2..size[1] - 2).flat_map(|y| (2..size[0] - 2).map(move |x| (x, y)));
    let open: Vec<(u32, u32)> = inside.filter(|&(x, y)| is_lit_around(x, y)).collect();
    [open.len(), open.iter().filter(|&&(x, y)| !lit(image, x, y)).count()]
}

/// Edges of boxes and columns have no dark seams: where the truth is lit in a neighbourhood of two pixels, so is the
/// image.
#[test]
fn edges_have_no_dark_seams() {
    let gpu = common::gpu();
    let scene = scene(&[room(), boxes()].concat());
    let size = [192, 128];
    let view = view_of_boxes(size);
    let traced = TracedScene::new(&scene);
    for at in [Vec3::new(2.0, 2.5, 1.5), Vec3::new(-2.5, 2.8, 2.0), Vec3::new(-0.4, 1.0, 2.5)] {
        let light = Light::point(at, 30.0, Vec3::ONE);
        let models = [
            ShadowModel::None,
            maps(1, 64, 1),
            maps(1, 256, 1),
            maps(1, 256, 25),
            maps(1, 1024, 1),
        ];
        let (images, gbuffer) = images(&gpu, &scene, &view, &[light], &models);
        let sample_of = |pixel| gbuffer.sample(pixel, &traced);
        let settings = TruthSettings::new(Transport::Direct);
        let truth = truth_image(&traced, &[light], size, sample_of, settings, &|_, _| ()).radiance;
        for (image, model) in images.iter().zip(models).skip(1) {
            let [open, dark] = dark_among_lit(image, &truth, size);
            println!("{model}, {at}: {dark} of {open} pixels");
            assert!(open > 5_000 && dark <= 3, "{model}, {at}: {dark} of {open} pixels");
        }
    }
}

/// A wall of 2 cm divides a small room. No light reaches the half without lamps. At 512 texels, two texels are narrower than
/// the wall up to 2.5 m from a light, and the room ends before.
#[test]
fn no_light_leaks_through_a_wall_of_two_centimetres() {
    let gpu = common::gpu();
    let mut quads = walls_of(Vec3::new(-1.2, 0.0, -1.2), Vec3::new(1.2, 2.0, 1.2), true);
    quads.extend(walls_of(Vec3::new(-0.01, 0.0, -1.2), Vec3::new(0.01, 2.0, 1.2), false));
    let view = View::look_at(Vec3::new(1.1, 0.9, 1.1), Vec3::new(0.1, 0.3, -0.2), 1.4, 0.05, SIZE);
    let at = Vec3::new(-0.6, 1.6, 0.1);
    let lights = [
        lamp(at),
        Light::point(at, 30.0, Vec3::ONE),
        spot(at, 0.9),
        Light::point(Vec3::new(-0.2, 1.99, 0.0), 30.0, Vec3::ONE),
        Light::point(Vec3::new(-1.1, 0.05, 1.1), 30.0, Vec3::ONE),
    ];
    for light in lights {
        let models = [ShadowModel::None, maps(4, 512, 1), maps(25, 512, 1)];
        let (images, _) = images(&gpu, &scene(&quads), &view, &[light], &models);
        let lit = |ix: usize| {
            images[ix].pixels.iter().filter(|pixel| pixel.iter().any(|c| *c > 0.0)).count()
        };
        assert!(lit(0) > 200, "without shadows the dark half is lit: {} pixels", lit(0));
        for (ix, model) in models.iter().enumerate().skip(1) {
            assert_eq!(lit(ix), 0, "pixels that light reaches: {model}, {light:?}");
        }
    }
}

/// A box on the floor is dark where it touches the floor.
#[test]
fn shadows_reach_their_casters() {
    let gpu = common::gpu();
    let mut quads = room();
    quads.extend(walls_of(Vec3::new(-0.5, 0.0, -0.5), Vec3::new(0.5, 1.0, 0.5), false));
    // Straight down on the edge between floor and box: 64 pixels for 20 cm.
    let eye = Vec3::new(0.55, 0.2, 0.0);
    let view = View::look_at(eye, Vec3::new(0.55, 0.0, 0.0), 0.927, 0.01, [64, 64]);
    let light = Light::point(Vec3::new(-1.5, 2.0, 0.0), 30.0, Vec3::ONE);
    let models = [ShadowModel::None, maps(1, 512, 1)];
    let (images, _) = images(&gpu, &scene(&quads), &view, &[light], &models);
    let lit = |ix: usize| images[ix].pixels.iter().filter(|p| p[0] > 0.0).count();
    assert!(lit(0) > 1000, "{}", lit(0));
    assert_eq!(lit(1), 0, "the foot of the box is in its shadow");
}
