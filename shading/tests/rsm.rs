//! Reflective shadow maps: a second view beside the first, and the triangles in world space.

#![allow(dead_code, reason = "the common module serves several tests")]
#![allow(clippy::unwrap_used, reason = "a helper of a test may fail it")]
mod common;

use assign::{EncoderPasses, Gpu, LightBuffer, View};
use glam::Vec3;
use scenes::{TownSize, primary_light, town};
use shading::{HdrImage, Renderer, WorldTriangles, rsm_view};

/// The control: geometry and normals, without lights.
fn clay(gpu: &Gpu, renderer: &mut Renderer, view: &View, lights: &LightBuffer) -> HdrImage {
    renderer.prepare(view, lights).unwrap();
    let mut encoder = gpu.device.create_command_encoder(&Default::default());
    let mut passes = EncoderPasses { encoder: &mut encoder };
    renderer.record_depth(view, &mut passes);
    renderer.record_gbuffer(view, &mut passes);
    renderer.record_clay(view, &mut passes);
    gpu.queue.submit([encoder.finish()]);
    HdrImage::read(gpu, renderer.targets(), view.viewport).unwrap()
}

/// What a renderer draws beside another is what it draws alone, and the first is not disturbed.
#[test]
fn a_second_view_beside_the_first() {
    let gpu = common::gpu();
    let scene = common::showcase();
    let lights = LightBuffer::new(&gpu, &[]).unwrap();
    let first = common::view([64, 64]);
    let light = primary_light(&scene);
    let second = rsm_view(&light, 64, (scene.bounds.min, scene.bounds.max)).unwrap();
    let mut renderer = Renderer::new(&gpu, &scene, &first).unwrap();
    let mut beside = renderer.beside(&second).unwrap();
    let mut alone = Renderer::new(&gpu, &scene, &second).unwrap();
    let before = clay(&gpu, &mut renderer, &first, &lights);
    let map = clay(&gpu, &mut beside, &second, &lights);
    assert!(map.pixels == clay(&gpu, &mut alone, &second, &lights).pixels);
    assert!(before.pixels == clay(&gpu, &mut renderer, &first, &lights).pixels);
    assert!(map.pixels != before.pixels);
    let drawn = map.pixels.iter().filter(|pixel| **pixel != [0.0; 3]).count();
    assert!(drawn * 8 > 64 * 64, "{drawn} pixels");
}

#[test]
fn world_triangles_are_the_scenes() {
    let gpu = common::gpu();
    let scene = town(1, TownSize::Small);
    let triangles = WorldTriangles::new(&gpu, &scene).unwrap();
    let expected: Vec<[Vec3; 3]> = scene.world_triangles().collect();
    let bytes = gpu.read(&triangles.positions, expected.len() as u64 * 36).unwrap();
    let positions: Vec<[Vec3; 3]> = bytemuck::pod_collect_to_vec(&bytes);
    assert_eq!(triangles.count as usize, expected.len());
    assert!(positions == expected);
    let (low, high) = triangles.bounds_world;
    assert!(low.abs_diff_eq(scene.bounds.min, 1.0) && high.abs_diff_eq(scene.bounds.max, 1.0));
    let inside = |p: &Vec3| p.cmpge(low).all() && p.cmple(high).all();
    assert!(positions.iter().flatten().all(inside));
}
