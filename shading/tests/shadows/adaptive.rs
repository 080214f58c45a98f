//! Rectangles are divided where frames show bands, and nowhere else.

use assign::{Emitter, EncoderPasses, Everything, Gpu, Light, LightBuffer, View};
use glam::Vec3;
use scenes::{Material, Scene};
use shading::{HdrImage, Mode, Renderer, ShadowModel};

use crate::{
    common::{
        self,
        quads::{grey, scene_of},
    },
    draw, lamp, maps, off,
    truth::{plates, view},
};

fn adaptive(px: u32, down: u32, most: u32) -> ShadowModel {
    ShadowModel::Adaptive { px, down, most }
}

/// A renderer with the maps of a model, drawn for the view.
fn renderer_of(
    gpu: &Gpu,
    scene: &Scene,
    view: &View,
    lights: &LightBuffer,
    model: ShadowModel,
) -> Renderer {
    let mut renderer = Renderer::new(gpu, scene, view).unwrap();
    renderer.cast_shadows(lights, model).unwrap();
    renderer.prepare(view, lights).unwrap();
    renderer
}

fn shown(renderer: &Renderer, view: &View, lights: &LightBuffer) -> HdrImage {
    let model = renderer.shadow_figures().unwrap().model;
    let mut strategy = Everything::new(renderer.gpu()).unwrap();
    draw(renderer, view, lights, &mut strategy, Mode::Deferred, model)
}

fn differing(image: &HdrImage, other: &HdrImage) -> u64 {
    image.difference(other).unwrap().differing_channels
}

/// The lamp over the plates.
fn light() -> Light {
    lamp(Vec3::new(0.0, 2.2, 0.5))
}

#[test]
fn lights_get_maps_where_their_penumbrae_show_bands() {
    let gpu = common::gpu();
    let lights = LightBuffer::new(&gpu, &[light()]).unwrap();
    let view = view();
    // Without plates there is no penumbra.
    let floor = [Vec3::ZERO, Vec3::Z * 4.0, Vec3::X * 4.0];
    let empty = scene_of(&[floor], Material { double_sided: true, ..grey(0.5) }, vec![]);
    for (scene, has_bands) in [(empty, false), (plates(), true)] {
        let mut last = 0;
        for down in [16, 2, 1] {
            let model = adaptive(128, down, 289);
            let mut renderer = renderer_of(&gpu, &scene, &view, &lights, model);
            assert_eq!(renderer.shadow_figures().unwrap().maps, 4);
            let found = renderer.settle_shadows(&view).unwrap();
            let figures = renderer.shadow_figures().unwrap();
            assert_eq!(renderer.shadow_subdivision(), Some((vec![figures.maps], 0)));
            assert_eq!(figures.faces, 5 * figures.maps);
            assert!(found.is_settled && !figures.fell_back());
            println!("down {down}: {} maps after {} rounds", figures.maps, found.rounds);
            if has_bands {
                assert!(figures.maps >= last, "{} maps at 1/{down}", figures.maps);
                assert!(down > 1 || figures.maps > 25, "{} maps at 1/{down}", figures.maps);
                last = figures.maps;
            } else {
                assert_eq!(figures.maps, 4, "1/{down}");
                let fixed = renderer_of(&gpu, &scene, &view, &lights, maps(4, 128, 1));
                let [a, b] = [&renderer, &fixed].map(|one| shown(one, &view, &lights));
                assert_eq!(differing(&a, &b), 0);
            }
        }
    }
}

/// A subdivision that is even is that of fixed maps, and settled ones come close to the most.
#[test]
fn images_are_those_of_fixed_maps_as_far_as_the_subdivision_goes() {
    let gpu = common::gpu();
    let lights = LightBuffer::new(&gpu, &[light()]).unwrap();
    let (scene, view) = (plates(), view());
    // The first call divides evenly, at most as finely as 25 places allow.
    let mut even = renderer_of(&gpu, &scene, &view, &lights, adaptive(128, 1, 25));
    let mut encoder = gpu.device.create_command_encoder(&Default::default());
    let started = even.refine_shadows(&view, &mut EncoderPasses { encoder: &mut encoder });
    gpu.queue.submit([encoder.finish()]);
    let started = started.unwrap();
    assert_eq!((started.rounds, started.drawn), (0, 21), "4 of 25 maps are drawn already");
    let fixed = |count| {
        let fixed = renderer_of(&gpu, &scene, &view, &lights, maps(count, 128, 1));
        shown(&fixed, &view, &lights)
    };
    assert_eq!(differing(&shown(&even, &view, &lights), &fixed(25)), 0);
    let finest = fixed(289);
    let errors: Vec<f64> = [(16, 4), (2, 289), (1, 289)]
        .into_iter()
        .map(|(down, most)| {
            let model = adaptive(128, down, most);
            let mut renderer = renderer_of(&gpu, &scene, &view, &lights, model);
            renderer.settle_shadows(&view).unwrap();
            off(&shown(&renderer, &view, &lights), &finest)
        })
        .collect();
    let coarse = [4, 9].map(|count| off(&fixed(count), &finest));
    println!("against 289 maps: {errors:?}, 4 and 9 maps {coarse:?}");
    assert_eq!(errors[0], coarse[0], "at most 4 maps are the corners");
    assert!(errors.is_sorted_by(|a, b| a > b), "{errors:?}");
    assert!(errors[2] < 0.5 * coarse[1], "{errors:?}, 9 maps {}", coarse[1]);
}

/// Places whose points went serve others, and hold no depth of before.
#[test]
fn moved_cameras_reuse_places_and_draw_only_new_maps() {
    let gpu = common::gpu();
    let far = lamp(Vec3::new(1.5, 2.2, -1.0));
    let lights = LightBuffer::new(&gpu, &[light(), far]).unwrap();
    let (scene, first) = (plates(), view());
    // Nothing is there to see.
    let away = View::look_at(first.eye(), Vec3::new(0.5, 9.0, 9.0), 0.8, 0.1, [96, 64]);
    let mut renderer = renderer_of(&gpu, &scene, &first, &lights, adaptive(64, 1, 40));
    let size = renderer.shadow_figures().unwrap().atlas_px;
    let mut counts = Vec::new();
    for view in [first, away, first] {
        renderer.prepare(&view, &lights).unwrap();
        renderer.settle_shadows(&view).unwrap();
        counts.push(renderer.shadow_subdivision().unwrap().0);
    }
    // Drawing all maps again clears the whole atlas.
    let kept = shown(&renderer, &first, &lights);
    let mut encoder = gpu.device.create_command_encoder(&Default::default());
    renderer.record_shadow_maps(&mut EncoderPasses { encoder: &mut encoder });
    gpu.queue.submit([encoder.finish()]);
    assert_eq!(differing(&kept, &shown(&renderer, &first, &lights)), 0, "{counts:?}");
    println!("{counts:?}");
    assert!(counts[0].iter().chain(&counts[2]).all(|maps| (9..=40).contains(maps)), "{counts:?}");
    assert_eq!(counts[1], [4, 4]);
    assert_eq!(renderer.shadow_figures().unwrap().atlas_px, size);
}

/// Answers arrive frames later, and a frame that was never submitted has none.
#[test]
fn rounds_wait_for_no_one() {
    let gpu = common::gpu();
    let lights = LightBuffer::new(&gpu, &[light()]).unwrap();
    let (scene, view) = (plates(), view());
    let mut renderer = renderer_of(&gpu, &scene, &view, &lights, adaptive(64, 2, 81));
    let frame = |renderer: &mut Renderer, is_submitted: bool| {
        let mut encoder = gpu.device.create_command_encoder(&Default::default());
        let mut passes = EncoderPasses { encoder: &mut encoder };
        let found = renderer.refine_shadows(&view, &mut passes).unwrap();
        renderer.record_depth(&view, &mut passes);
        renderer.record_gbuffer(&view, &mut passes);
        let recorded = renderer.record_banding(&view, &mut passes).unwrap();
        if is_submitted {
            gpu.queue.submit([encoder.finish()]);
            gpu.wait().unwrap();
        }
        (found, recorded)
    };
    // The first frame draws the maps of the start, and is shown.
    assert!(frame(&mut renderer, true).1);
    let (found, recorded) = frame(&mut renderer, true);
    assert!(found.rounds == 1 && recorded, "{found:?}");
    // A round whose frame is dropped never answers. It is given up after some frames.
    let (found, _) = frame(&mut renderer, true);
    assert_eq!(found.rounds, 2);
    renderer.settle_shadows(&view).unwrap();
    let settled = renderer.shadow_figures();
    assert!(frame(&mut renderer, false).1);
    let waits = (0..40).position(|_| frame(&mut renderer, false).1);
    assert!(waits.is_some_and(|waits| waits > 1), "{waits:?}");
    renderer.settle_shadows(&view).unwrap();
    assert_eq!(renderer.shadow_figures(), settled);
}

/// Polygons keep the largest fixed number of maps, and points one. Both lie in the same atlas.
#[test]
fn other_lights_keep_their_maps() {
    let gpu = common::gpu();
    let corners = [(0.0, 0.0), (1.0, 0.0), (1.2, 1.0)].map(|(x, z)| Vec3::new(x, 2.0, z));
    let (polygon, middle) = Emitter::polygon(&corners).unwrap();
    let polygon = Light::area(polygon, middle, 20.0, Vec3::ONE);
    let point = Light::point(Vec3::new(-1.0, 2.0, 0.0), 20.0, Vec3::ONE);
    let lights = LightBuffer::new(&gpu, &[point, light(), polygon]).unwrap();
    let (scene, view) = (plates(), view());
    let mut renderer = renderer_of(&gpu, &scene, &view, &lights, adaptive(64, 1, 20));
    let figures = renderer.shadow_figures().unwrap();
    assert_eq!((figures.maps, figures.faces), (1 + 4 + 9, 6 + 5 * 4 + 5 * 9));
    renderer.settle_shadows(&view).unwrap();
    let figures = renderer.shadow_figures().unwrap();
    let (maps, _) = renderer.shadow_subdivision().unwrap();
    assert_eq!(figures.maps, 1 + maps[0] + 9);
    assert!(maps.len() == 1 && (5..=20).contains(&maps[0]), "{maps:?}");
}

#[test]
fn what_cannot_be_subdivided_is_refused() {
    let gpu = common::gpu();
    let (scene, view) = (plates(), view());
    let lights = LightBuffer::new(&gpu, &[light()]).unwrap();
    let model = adaptive(64, 2, 81);
    let mut renderer = renderer_of(&gpu, &scene, &view, &lights, model);
    renderer.sample_pixels(&view, 4).unwrap();
    let error = renderer.settle_shadows(&view).unwrap_err().to_string();
    assert!(
        error.starts_with("shadow model adaptive:64,2,81 cannot serve 4 samples per pixel"),
        "{error}"
    );
    renderer.sample_pixels(&view, 1).unwrap();
    renderer.settle_shadows(&view).unwrap();
    // The flags of a round have room for so many quads.
    let most_px = gpu.device.limits().max_texture_dimension_2d.min(1 << 15);
    let many = LightBuffer::new(&gpu, &vec![light(); 6554]).unwrap();
    if most_px >= 32 * 314 {
        let error = renderer.cast_shadows(&many, adaptive(32, 2, 4)).unwrap_err().to_string();
        assert!(
            error.contains("adaptive:32,2,4 for 6554 rectangles: it must be one for at most 6553"),
            "{error}"
        );
    }
}
