//! Shadows on glass, in fog and on particles.

use assign::{
    Assignment, Bounds, CullSettings, Everything, Light, LightBuffer, LightSource, View, fall_off,
};
use assign_clustered::{Clustered, Occupancy};
use glam::{DVec3, Vec3};
use scenes::{Material, Particle, Scene};
use shading::{
    HdrImage, LayerOptions, LayerSamples, LightBvh, Mode, OCCLUSION_TEST, OccluderDepth, Renderer,
    ShadowModel, traced::TracedScene, visit_layer_lists,
};

use crate::{
    common::{self, quads::grey},
    draw, lamp, maps, off,
    truth::{plates, view},
};

/// Plates, and a sheet in front of the wall. Its surface is as opaque as that of a wall if `alpha` is 1.
fn with_sheet(alpha: f32, is_blended: bool) -> Scene {
    let mut scene = plates();
    let sheet = [Vec3::new(-0.3, 0.7, -1.2), Vec3::X * 1.6, Vec3::Y * 0.7];
    let quad = common::quads::scene_of(&[sheet], grey(0.5), vec![]);
    let color = Vec3::splat(0.7).extend(alpha);
    let glass = Material { base_color: color, double_sided: true, ..grey(0.5) };
    let alpha_cutoff = is_blended.then_some(0.5);
    scene.materials.push(Material { is_blended, alpha_cutoff, ..glass });
    scene.meshes.push(scenes::Mesh { material: 1, ..quad.meshes[0].clone() });
    let mesh = scene.meshes.len() as u32 - 1;
    scene.instances.push(scenes::Instance { mesh, model: 0 });
    scene
}

fn layers(sheets: bool, fog_per_m: Option<f32>) -> LayerOptions {
    LayerOptions { sheets, fog_per_m, ..LayerOptions::default() }
}

fn image(
    scene: &Scene,
    view: &View,
    lights: &[Light],
    layers: &LayerOptions,
    model: ShadowModel,
) -> HdrImage {
    let gpu = common::gpu();
    let lights = LightBuffer::new(&gpu, lights).unwrap();
    let mut renderer = Renderer::new(&gpu, scene, view).unwrap();
    renderer.show_layers(layers).unwrap();
    renderer.cast_shadows(&lights, model).unwrap();
    renderer.prepare(view, &lights).unwrap();
    let mut everything = Everything::new(&gpu).unwrap();
    draw(&renderer, view, &lights, &mut everything, Mode::Forward, model)
}

/// A sheet that hides all behind it is lit as an opaque wall is, with its shadows. A clear one casts none.
#[test]
fn glass_is_shadowed_as_opaque_surfaces_are_and_casts_no_shadow() {
    let lights = [lamp(Vec3::new(0.0, 2.2, 0.5)), spot_on_sheet()];
    let none = LayerOptions::default();
    for model in [maps(9, 256, 1), maps(4, 256, 4)] {
        let wall = image(&with_sheet(1.0, false), &view(), &lights, &none, model);
        let glass = image(&with_sheet(1.0, true), &view(), &lights, &layers(true, None), model);
        let unshadowed =
            image(&with_sheet(1.0, true), &view(), &lights, &layers(true, None), ShadowModel::None);
        let clear = image(&with_sheet(0.0, true), &view(), &lights, &layers(true, None), model);
        let open = image(&plates(), &view(), &lights, &none, model);
        // Beside the sheet, its shadow differs: compare the pixels that it covers.
        let covered: Vec<usize> = (0..open.pixels.len())
            .filter(|ix| glass.pixels[*ix] != open.pixels[*ix] && is_sheet(*ix))
            .collect();
        assert!(covered.len() > 300, "{} pixels", covered.len());
        let only = |image: &HdrImage| HdrImage {
            pixels: covered.iter().map(|ix| image.pixels[*ix]).collect(),
            ..*image
        };
        let errors = [off(&only(&glass), &only(&wall)), off(&only(&unshadowed), &only(&wall))];
        println!("{model}: glass {errors:.6?} from a wall, clear {:.6}", off(&clear, &open));
        assert!(errors[0] < 1e-5 && errors[1] > 0.02, "{model}: {errors:?}");
        assert!(off(&clear, &open) < 1e-6, "{model}: a clear sheet casts a shadow");
        assert!(off(&wall, &open) > 0.02, "{model}: the wall changes nothing");
    }
}

/// Lights the sheet past a plate.
fn spot_on_sheet() -> Light {
    Light::point(Vec3::new(-0.4, 1.9, 0.6), 30.0, Vec3::ONE)
}

/// Whether the middle of a pixel shows the sheet.
fn is_sheet(pixel: usize) -> bool {
    let (origin, direction) = ray(&view(), pixel);
    let t = (-1.2 - origin.z) / direction.z;
    let at = origin + direction * t;
    t > 0.0 && (at.x + 0.3).abs() < 1.58 && (at.y - 0.7).abs() < 0.68
}

/// The ray through the middle of a pixel: unit direction.
fn ray(view: &View, pixel: usize) -> (DVec3, DVec3) {
    let [width, height] = [view.viewport.width, view.viewport.height];
    let (x, y) = (pixel as u32 % width, pixel as u32 / width);
    let ndc = [
        2.0 * (f64::from(x) + 0.5) / f64::from(width) - 1.0,
        1.0 - 2.0 * (f64::from(y) + 0.5) / f64::from(height),
    ];
    let clip = view.view_to_clip();
    let local =
        DVec3::new(ndc[0] / f64::from(clip.x_axis.x), ndc[1] / f64::from(clip.y_axis.y), -1.0);
    let to_world = view.world_to_view.inverse().as_dmat4();
    (view.eye().as_dvec3(), to_world.transform_vector3(local).normalize())
}

/// The light of a point that thick fog scatters, against exact rays along each view ray.
#[test]
fn fog_is_dark_where_exact_rays_are_blocked() {
    // A large plate between the light and the fog.
    let floor = [Vec3::ZERO, Vec3::Z * 4.0, Vec3::X * 4.0];
    let plate = [Vec3::new(-0.6, 2.6, -0.5), Vec3::Z * 0.9, Vec3::X * 0.9];
    let scene = common::quads::scene_of(
        &[floor, plate],
        Material { double_sided: true, ..grey(0.5) },
        vec![],
    );
    let traced = TracedScene::new(&scene);
    let light = Light::point(Vec3::new(-0.4, 4.0, -0.5), 9.0, Vec3::splat(20.0));
    let density = 0.2;
    let shown = |model| image(&scene, &view(), &[light], &layers(false, Some(density)), model);
    let black = |model| image(&scene, &view(), &[light], &layers(false, None), model);
    let exact = |has_shadows: bool| {
        let fog_of = |pixel: usize| {
            let (origin, direction) = ray(&view(), pixel);
            let end = traced.distance_m(origin, direction).unwrap_or(12.0).min(12.0);
            const STEPS: u32 = 400;
            let step = end / f64::from(STEPS);
            let at = |i: u32| (f64::from(i) + 0.5) * step;
            let sum: f64 = (0..STEPS)
                .map(|i| {
                    let place = origin + direction * at(i);
                    let offset = light.position.as_dvec3() - place;
                    let distance = offset.length();
                    let is_free = !has_shadows
                        || traced
                            .distance_m(place, offset / distance)
                            .is_none_or(|hit| hit >= distance);
                    let arrives =
                        if is_free { fall_off(distance * distance, 9.0, 1e-4) } else { 0.0 };
                    20.0 * arrives / (4.0 * std::f64::consts::PI)
                        * (-f64::from(density) * at(i)).exp()
                })
                .sum();
            [(sum * step * f64::from(density)) as f32; 3]
        };
        let pixels = (0..96 * 64).map(fog_of).collect();
        HdrImage { pixels, ..shown(ShadowModel::None) }
    };
    // What fog adds: the image less the dimmed surfaces behind it.
    let added = |model| {
        let (foggy, clear) = (shown(model), black(model));
        let pixels = (0..foggy.pixels.len()).map(|ix| {
            let (origin, direction) = ray(&view(), ix);
            let end = traced.distance_m(origin, direction).unwrap_or(f64::INFINITY);
            let through = (-f64::from(density) * end).exp() as f32;
            std::array::from_fn(|c| foggy.pixels[ix][c] - through * clear.pixels[ix][c])
        });
        HdrImage { pixels: pixels.collect(), ..foggy }
    };
    let (dark, bright) = (exact(true), exact(false));
    let model = maps(1, 256, 1);
    let errors = [
        off(&added(ShadowModel::None), &bright),
        off(&added(model), &dark),
        off(&added(ShadowModel::None), &dark),
    ];
    println!("fog without shadows, with them, and the control: {errors:.4?}");
    assert!(errors[2] > 0.05, "the plates shadow too little: {errors:?}");
    assert!(errors[1] < errors[0] + 0.25 * errors[2], "{errors:?}");
}

/// Glass, particles and fog with shadows keep their bits in every strategy, also in one that leaves hidden lights out.
#[test]
fn layers_with_shadows_differ_in_no_bit_between_strategies() {
    let gpu = common::gpu();
    let mut lights = common::lights(24);
    lights.iter_mut().for_each(|light| light.range_m += 1.0);
    lights.push(lamp(Vec3::new(0.5, 2.6, 0.0)));
    let lights = LightBuffer::new(&gpu, &lights).unwrap();
    let mut renderer = Renderer::new(&gpu, &with_sheet(0.4, true), &view()).unwrap();
    let particle = |x: f32| Particle {
        position: Vec3::new(x, 0.8, 0.5 * x),
        radius_m: 0.4,
        color: Vec3::ONE,
        opacity: 0.6,
    };
    let particles = (-3..4).map(|ix| particle(0.5 * ix as f32)).collect();
    let options = LayerOptions { sheets: true, particles, fog_per_m: Some(0.15) };
    renderer.show_layers(&options).unwrap();
    let model = maps(4, 64, 1);
    renderer.cast_shadows(&lights, model).unwrap();
    renderer.find_occluders(OccluderDepth::Farthest).unwrap();
    let view = view();
    renderer.prepare(&view, &lights).unwrap();
    let occlusion = CullSettings { occlusion: Some(OCCLUSION_TEST), ..CullSettings::default() };
    let tree = CullSettings { source: LightSource::Hierarchy, ..CullSettings::default() };
    let clusters = |settings| {
        let size = "12x12x24".parse().unwrap();
        Clustered::new(&gpu, size, Bounds::Implicit, Occupancy::Dense, settings).unwrap()
    };
    let mut everything = Everything::new(&gpu).unwrap();
    for (mode, first) in [(Mode::Deferred, 0), (Mode::Forward, 2)] {
        let show = |strategy: &mut dyn Assignment, model| {
            draw(&renderer, &view, &lights, strategy, mode, model);
            draw(&renderer, &view, &lights, strategy, mode, model)
        };
        let none = show(&mut everything, model);
        let plain = show(&mut everything, ShadowModel::None);
        let changed = plain.difference(&none).unwrap().differing_channels;
        assert!(changed > 3_000, "{mode:?}: shadows change {changed} channels");
        let mut listed = Vec::new();
        for settings in &[CullSettings::default(), tree, occlusion][first..] {
            let mut strategy = clusters(*settings);
            let difference = show(&mut strategy, model).difference(&none).unwrap();
            assert_eq!(difference.differing_channels, 0, "{} {mode:?}", strategy.id());
            let frame = renderer.frame(&view, &lights);
            let samples = LayerSamples::capture(&renderer, &frame).unwrap();
            let snapshot = strategy.lists().snapshot(&gpu).unwrap();
            let bvh = LightBvh::new(lights.lights());
            let mut entries = 0;
            visit_layer_lists(
                &renderer,
                &strategy,
                &frame,
                &snapshot,
                &samples,
                &mut |some, lists| {
                    entries += bvh.check(some, lists, false).listed;
                },
            )
            .unwrap();
            listed.push(entries);
        }
        println!("{mode:?}: pairs of layers {listed:?}");
        assert!(first > 0 || listed[2] < listed[0], "no light was hidden from layers: {listed:?}");
    }
}
