//! Percentage-closer soft shadows: penumbrae grow with the distance behind a wall, no surface shadows itself, and no light
//! passes a wall.

use assign::{Emitter, Light, View};
use glam::{DVec3, Vec3};
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
    images, lamp, maps, off,
    truth::{plates, view},
    walls::walls_of,
};

fn pcss(maps: u32, px: u32, taps: u32) -> ShadowModel {
    ShadowModel::Pcss { maps, px, taps }
}

fn scene(quads: &[[Vec3; 3]]) -> Scene {
    scene_of(quads, Material { double_sided: true, ..grey(0.5) }, vec![])
}

/// The width of the penumbra across z on the floor, metres, where x is within 10 cm: from 10 % of the light to 90 %.
fn width_at(x: f64, samples: &[(DVec3, f32)]) -> f64 {
    let near = |(at, _): &&(DVec3, f32)| (at.x - x).abs() < 0.1 && at.z.abs() < 2.0;
    let here: Vec<_> = samples.iter().filter(near).collect();
    let first = here.iter().filter(|s| s.1 > 0.1).map(|s| s.0.z).fold(f64::INFINITY, f64::min);
    let last = here.iter().filter(|s| s.1 < 0.9).map(|s| s.0.z).fold(-f64::INFINITY, f64::max);
    last - first
}

/// A panel shines past the edge of a wall. The penumbra is as wide as the panel is seen through the edge: its width times
/// the distance behind the wall over that before it.
#[test]
fn penumbrae_grow_with_the_distance_behind_a_wall() {
    let gpu = common::gpu();
    let floor = [Vec3::ZERO, Vec3::Z * 6.0, Vec3::X * 6.0];
    let wall = [Vec3::new(0.0, 1.5, -2.0), Vec3::Y * 1.5, Vec3::Z * 2.0];
    let panel = Emitter::rectangle(Vec3::Y * 0.05, Vec3::Z * 0.5);
    assert!(panel.normal().x > 0.9);
    let light = Light::area(panel, Vec3::new(-2.0, 0.8, 0.0), 30.0, Vec3::splat(4.0));
    let from = Vec3::new(1.3, 6.0, 0.01);
    let view = View::look_at(from, Vec3::new(1.3, 0.0, 0.0), 0.7, 0.1, [96, 96]);
    let models = [ShadowModel::None, pcss(1, 512, 49), maps(1, 512, 1)];
    let scene = scene(&[floor, wall]);
    let (images, gbuffer) = images(&gpu, &scene, &view, &[light], &models);
    let traced = TracedScene::new(&scene);
    let samples_of = |image: &HdrImage| -> Vec<(DVec3, f32)> {
        let of = |ix: usize| {
            let at = gbuffer.sample(ix, &traced)?.position;
            let whole = images[0].pixels[ix][0];
            (at.y.abs() < 1e-3 && whole > 0.0).then(|| (at, image.pixels[ix][0] / whole))
        };
        (0..image.pixels.len()).filter_map(of).collect()
    };
    let widths = |image| [0.4, 1.0, 2.0].map(|x| width_at(x, &samples_of(image)));
    let (soft, hard) = (widths(&images[1]), widths(&images[2]));
    println!("soft {soft:.3?}, hard {hard:.3?}");
    for (width, x) in soft.into_iter().zip([0.4, 1.0, 2.0]) {
        // 80 % of a ramp, between the middles of pixels of 5 cm.
        let expected = 0.8 * x / 2.0;
        let most_off = 0.06 + 0.25 * expected;
        assert!((width - expected).abs() < most_off, "at {x} m: {width}, not {expected}");
    }
    assert!(soft.is_sorted_by(|a, b| 1.4 * a < *b), "{soft:?}");
    assert!(hard[2] < 0.35 * soft[2], "{hard:?}, {soft:?}");
}

/// An empty room stays as it is without shadows, for wide filters on slanted and near surfaces, too.
#[test]
fn no_surface_shadows_itself_by_a_wide_filter() {
    let gpu = common::gpu();
    let scene = scene(&walls_of(Vec3::new(-3.0, 0.0, -3.0), Vec3::new(3.0, 3.0, 3.0), true));
    let view =
        View::look_at(Vec3::new(2.5, 1.0, 2.5), Vec3::new(-1.0, 0.6, -1.0), 1.4, 0.05, [96, 64]);
    let at = Vec3::new(-1.3, 2.2, 0.7);
    let two_sided = Emitter::rectangle(Vec3::X * 0.4, Vec3::Y * 0.4).two_sided();
    for light in [
        lamp(Vec3::new(-1.3, 2.6, 0.7)),
        lamp(Vec3::new(0.0, 0.2, 1.0)),
        Light::area(two_sided, at, 30.0, Vec3::ONE),
        Light::area(Emitter::sphere(0.3), at, 30.0, Vec3::ONE),
        Light::area(Emitter::line(Vec3::new(0.5, 0.1, 0.2), 0.05), at, 30.0, Vec3::ONE),
        Light::point(at, 30.0, Vec3::ONE),
    ] {
        let models = [ShadowModel::None, pcss(1, 64, 16), pcss(4, 128, 9), pcss(1, 512, 25)];
        let (images, _) = images(&gpu, &scene, &view, &[light], &models);
        assert!(images[0].pixels.iter().flatten().sum::<f32>() > 1.0);
        for (image, model) in images.iter().zip(models) {
            let difference = image.difference(&images[0]).unwrap();
            assert!(difference.max_rel < 1e-5, "{model}, {light:?}: {difference:?}");
        }
    }
}

/// A wall of 2 cm divides a room. A lamp that is narrow beside its distance from the wall lights nothing behind it.
#[test]
fn no_light_leaks_through_a_wall_by_a_wide_filter() {
    let gpu = common::gpu();
    let mut quads = walls_of(Vec3::new(-1.2, 0.0, -1.2), Vec3::new(1.2, 2.0, 1.2), true);
    quads.extend(walls_of(Vec3::new(-0.01, 0.0, -1.2), Vec3::new(0.01, 2.0, 1.2), false));
    let scene = scene(&quads);
    let view =
        View::look_at(Vec3::new(1.1, 0.9, 1.1), Vec3::new(0.1, 0.3, -0.2), 1.4, 0.05, [96, 64]);
    let small = Emitter::rectangle(Vec3::X * 0.15, Vec3::Z * 0.15);
    let light = Light::area(small, Vec3::new(-0.7, 1.6, 0.1), 30.0, Vec3::splat(4.0));
    let models = [ShadowModel::None, pcss(1, 512, 25), pcss(4, 512, 16)];
    let (images, _) = images(&gpu, &scene, &view, &[light], &models);
    let lit = |ix: usize| images[ix].pixels.iter().filter(|p| p.iter().any(|c| *c > 0.0)).count();
    assert!(lit(0) > 200, "without shadows the dark half is lit: {} pixels", lit(0));
    for (ix, model) in models.iter().enumerate().skip(1) {
        assert_eq!(lit(ix), 0, "pixels that light reaches: {model}");
    }
}

fn truth(scene: &Scene, light: &Light, gbuffer: &GBufferSamples, transport: Transport) -> HdrImage {
    let traced = TracedScene::new(scene);
    let settings = TruthSettings { area_samples: 256, ..TruthSettings::new(transport) };
    let sample_of = |pixel| gbuffer.sample(pixel, &traced);
    truth_image(&traced, &[*light], [96, 64], sample_of, settings, &|_, _| ()).radiance
}

/// One soft map is nearer to the truth than one hard map, for each outline, and several soft ones are nearer still.
#[test]
fn soft_maps_come_closer_to_the_truth_than_hard_ones() {
    let gpu = common::gpu();
    let scene = plates();
    let at = Vec3::new(0.0, 2.2, 0.5);
    for light in [
        lamp(at),
        Light::area(Emitter::sphere(0.4), at, 30.0, Vec3::splat(4.0)),
        Light::area(Emitter::line(Vec3::X * 0.5, 0.05), at, 30.0, Vec3::splat(4.0)),
    ] {
        let models = [ShadowModel::None, maps(1, 256, 1), pcss(1, 256, 25), pcss(4, 256, 25)];
        let (images, gbuffer) = images(&gpu, &scene, &view(), &[light], &models);
        let [whole, separated] = [Transport::Unshadowed, Transport::Separated]
            .map(|transport| truth(&scene, &light, &gbuffer, transport));
        // The exact share of what the pipeline shows without shadows.
        let exact = crate::truth::shared(&images[0], &separated, &whole);
        let errors: Vec<f64> = images.iter().map(|image| off(image, &exact)).collect();
        println!("{:?}: {errors:.4?}", light.shape);
        assert!(errors[2] < 0.75 * errors[1] && errors[3] < errors[2], "{errors:?}");
    }
}
