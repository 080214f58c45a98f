use assign::{Light, LightShape, storage_entry};
use glam::{DVec2, DVec3, Vec3};
use rand::{RngExt, SeedableRng};
use rand_pcg::Pcg64Mcg;

use super::*;
use crate::{
    ShadowModel,
    shadows::{SunnyScene, plan::Plan},
};

/// The rules of `pyramid.wesl`.
fn origin([width, height]: [u32; 2], level: u32) -> [u32; 2] {
    if level == 0 { [0, 0] } else { [width, height - (height >> (level - 1))] }
}

#[test]
fn levels_lie_apart_inside_their_texture_and_its_size_tells_that_of_the_first() {
    for base in [[16, 16], [16, 32], [25, 75], [99, 17], [1000, 333], [8192, 8191]] {
        let [width, height] = texture_size(base);
        assert_eq!((2 * width).div_ceil(3), base[0], "{base:?}");
        let mut end = 0;
        for (level, [w, h]) in (0..).zip(level_sizes(base)) {
            let [x, y] = origin(base, level);
            assert!(x + w <= width && y + h <= height, "{base:?}: level {level}");
            assert_eq!([w, h], base.map(|side| side >> level));
            if level > 0 {
                assert!(x >= base[0] && y >= end, "{base:?}: level {level} begins at {y}");
                end = y + h;
            }
        }
    }
}

/// Computes the footprint of a box on face 0, for the light of slot 0.
const KERNEL: &str = "
import package::occlusion::{caster_of, footprint};

@group(0) @binding(0) var<storage, read> boxes: array<vec4f>;
@group(0) @binding(1) var<storage, read_write> found: array<vec4i>;

@compute @workgroup_size(64)
fn find(@builtin(global_invocation_id) thread: vec3u) {
  let low = boxes[2u * thread.x].xyz;
  let high = boxes[2u * thread.x + 1u].xyz;
  let nearest = max(max(low, -high), vec3f(0.0));
  let light = caster_of(0u);
  let read = footprint(0u, light, low.xy, high.xy, nearest.xy, vec2f(low.z, high.z));
  found[2u * thread.x] = vec4i(read.first, read.last);
  found[2u * thread.x + 1u] = vec4i(i32(read.kind), bitcast<vec3i>(vec3f(read.least, light.deepest, light.px)));
}";

/// No test needs the group.
const NO_BOUNDS: &str =
    "fn group_range(axis: vec3f, origin: vec3f) -> vec2f { return vec2f(0.0); }";

/// The footprints of boxes: corners of the rectangle, kind, least depth, and depth of a sample over that of its look-up.
fn footprints(gpu: &Gpu, plan: &Plan, boxes: &[[Vec3; 2]]) -> Vec<([i32; 4], i32, f32, f32)> {
    let corners: Vec<[f32; 4]> =
        boxes.iter().flatten().map(|corner| corner.extend(0.0).to_array()).collect();
    let buffer = |label: &str, bytes: &[u8]| {
        let made = gpu.storage(label, bytes.len() as u64).expect("a buffer");
        gpu.queue.write_buffer(&made, 0, bytes);
        made
    };
    let asked = buffer("boxes", bytemuck::cast_slice(&corners));
    let records = buffer("records", bytemuck::cast_slice(&plan.records));
    let bytes = 32 * boxes.len() as u64;
    let found = gpu.storage("footprints", bytes).expect("a buffer");
    let stages = wgpu::ShaderStages::COMPUTE;
    let entries = [storage_entry(0, stages, true), storage_entry(1, stages, false)];
    let layout = gpu.bind_group_layout("boxes", &entries);
    let none = gpu.bind_group_layout("none", &[]);
    let records_layout = gpu.bind_group_layout("records", &[storage_entry(4, stages, true)]);
    let shader = Shader::new(1)
        .module("package::bounds", NO_BOUNDS)
        .module("package::occlusion", include_str!("../../shaders/occlusion.wesl"))
        .module(PYRAMID.0, PYRAMID.1)
        .module("package::find", KERNEL);
    let module = shader.create(gpu, "package::find").expect("links");
    let layouts = [Some(&layout), Some(&none), Some(&records_layout)];
    let pipeline = gpu.compute_pipeline(&module, "find", &layouts, true);
    let group = gpu.bind_group("boxes", &layout, &[entry(0, &asked), entry(1, &found)]);
    let records = gpu.bind_group("records", &records_layout, &[entry(4, &records)]);
    let mut encoder = gpu.device.create_command_encoder(&Default::default());
    let mut pass = encoder.begin_compute_pass(&Default::default());
    pass.set_pipeline(&pipeline);
    pass.set_bind_group(0, &group, &[]);
    pass.set_bind_group(2, &records, &[]);
    pass.dispatch_workgroups((boxes.len() as u32).div_ceil(64), 1, 1);
    drop(pass);
    gpu.queue.submit([encoder.finish()]);
    let bytes = gpu.read(&found, bytes).expect("reads");
    let words: Vec<i32> = bytemuck::pod_collect_to_vec(&bytes);
    let number = |word: i32| f32::from_bits(word as u32);
    words
        .chunks_exact(8)
        .map(|w| ([w[0], w[1], w[2], w[3]], w[4], number(w[5]), number(w[6])))
        .collect()
}

/// Random look-ups from random boxes read no texel outside the footprint of their box, at no less depth than it says: for a
/// point and a spot, small and large maps, without and with a filter.
#[test]
fn look_ups_stay_inside_the_footprint_of_their_box() {
    let gpu = Gpu::open(None).expect("an adapter");
    let mut rng = Pcg64Mcg::seed_from_u64(1);
    let shape = LightShape::Spot { direction: Vec3::Z, inner_angle: 0.1, outer_angle: 1.0 };
    let point = Light::point(Vec3::ZERO, 8.0, Vec3::ONE);
    for (light, tangent) in [(point, 1.0), (Light { shape, ..point }, 1.0_f64.tan())] {
        for (px, taps) in [(32, 25), (128, 1), (512, 9)] {
            let model = ShadowModel::Maps { maps: 1, px, taps };
            let plan = Plan::new(&[light], SunnyScene::default(), model, 4096).expect("a plan");
            let boxes: Vec<[Vec3; 2]> = (0..512)
                .map(|_| {
                    let mut number = || rng.random::<f32>();
                    let center =
                        Vec3::new(6.0 * number() - 3.0, 6.0 * number() - 3.0, 4.0 * number() - 0.5);
                    let half = Vec3::new(number(), number(), number()).powf(3.0);
                    [center - half, center + half]
                })
                .collect();
            let found = footprints(&gpu, &plan, &boxes);
            let texel = f64::from(f32::from_bits(plan.records[0][2])) * tangent;
            let reach = f64::from(f32::from_bits(plan.records[0][3])) * texel;
            let side = f64::from(taps.isqrt());
            let mut read = 0;
            for (bounds, (rectangle, kind, least, deepest)) in boxes.iter().zip(found) {
                let [low, high] = bounds.map(Vec3::as_dvec3);
                for _ in 0..40 {
                    let mut number = || rng.random::<f64>();
                    let at = low + (high - low) * DVec3::new(number(), number(), number());
                    let normal = DVec3::new(number(), number(), number()) * 2.0 - 1.0;
                    let normal = normal.normalize_or(DVec3::NEG_Z);
                    // Only samples on this face that face the light look it up.
                    if at.x.abs().max(at.y.abs()) > tangent * at.z
                        || at.z <= 0.0
                        || normal.dot(at) >= 0.0
                    {
                        continue;
                    }
                    read += 1;
                    assert_ne!(kind, 0, "{bounds:?} does not touch the face, {at} does");
                    if kind == 2 {
                        continue;
                    }
                    let across = reach * normal.truncate().length();
                    let moved = at + normal * (at.z * across / (1.0 - normal.z * across));
                    let compared = f64::from(least / deepest);
                    assert!(moved.z >= compared, "{at} moves to {moved}, nearer than {compared}");
                    let corner = 0.5 * f64::from(px) - 0.5 * (side - 1.0);
                    let first = (moved.truncate() / moved.z / texel + corner).floor();
                    let last = first + (side - 1.0);
                    let most = DVec2::splat(f64::from(px) - 1.0);
                    let [first, last] =
                        [first, last].map(|px| px.clamp(DVec2::ZERO, most).as_ivec2());
                    let is_inside = first.x >= rectangle[0]
                        && first.y >= rectangle[1]
                        && last.x <= rectangle[2]
                        && last.y <= rectangle[3];
                    assert!(is_inside, "{at} reads {first} to {last}, the box {rectangle:?}");
                }
            }
            assert!(read > 1000, "{read} look-ups");
        }
    }
}
