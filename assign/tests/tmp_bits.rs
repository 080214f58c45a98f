use assign::{
    Gpu, Shader,
    conformance::{Bound, download, run_kernel, upload},
    kernel::Slot,
};
const OLD: &str = "
const MIN_DISTANCE_2: f32 = 1.0e-4;
@if(!hard_cut)
fn fall_off(distance_2: f32, range_m: f32, least_2: f32) -> f32 {
  let ratio_2 = distance_2 / (range_m * range_m);
  let window = max(0.0, 1.0 - ratio_2 * ratio_2);
  return window * window / max(distance_2, least_2);
}
@if(hard_cut)
fn fall_off(distance_2: f32, range_m: f32, least_2: f32) -> f32 {
  return select(0.0, 1.0 / max(distance_2, least_2), distance_2 < range_m * range_m);
}
@if(!hard_cut)
fn range_window(distance_2: f32, range_m: f32) -> f32 {
  let ratio_2 = distance_2 / (range_m * range_m);
  let window = max(0.0, 1.0 - ratio_2 * ratio_2);
  return window * window;
}
@if(hard_cut)
fn range_window(distance_2: f32, range_m: f32) -> f32 {
  return select(0.0, 1.0, distance_2 < range_m * range_m);
}";
const KERNEL: &str = "
import package::window::{MIN_DISTANCE_2, fall_off, range_window};
@group(0) @binding(0) var<storage, read> input: array<vec4f>;
@group(0) @binding(1) var<storage, read_write> found: array<vec2f>;
@compute @workgroup_size(64)
fn evaluate(@builtin(global_invocation_id) thread: vec3u) {
  if thread.x < arrayLength(&input) {
    let d = dot(input[thread.x].xyz, input[thread.x].xyz);
    let r = input[thread.x].w;
    found[thread.x] = vec2f(range_window(d, r) * r, r * fall_off(d, r, MIN_DISTANCE_2));
  }
}";
#[test]
fn bits() {
    let gpu = Gpu::open(None).unwrap();
    let mut x = 1u32;
    let mut next = || {
        x = x.wrapping_mul(1664525).wrapping_add(1013904223);
        (x >> 8) as f32 / 16777216.0
    };
    let input: Vec<[f32; 4]> = (0..200_000)
        .map(|_| [next() * 2.0, next() * 2.0, next() * 2.0, 0.1 + 4.0 * next()])
        .collect();
    for hard in [false, true] {
        let run = |old: bool| {
            let mut s = Shader::new(1).module("package::kernel", KERNEL).flag("hard_cut", hard);
            if old {
                s = s.module("package::window", OLD);
            }
            let m = s.create(&gpu, "package::kernel").unwrap();
            let i = upload(&gpu, "i", &input).unwrap();
            let o = upload(&gpu, "o", &vec![[0.0_f32; 2]; input.len()]).unwrap();
            run_kernel(
                &gpu,
                &m,
                "evaluate",
                &[Bound::Buffers(&[(0, Slot::Read, &i), (1, Slot::Write, &o)])],
                input.len().div_ceil(64) as u32,
            );
            download::<[u32; 2]>(&gpu, &o, input.len()).unwrap()
        };
        assert_eq!(run(true), run(false));
    }
}
