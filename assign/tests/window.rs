//! The window and the fall-off in WESL, imported as a plugged-in renderer does, equal those in Rust.

#![allow(clippy::unwrap_used, reason = "a test fails by panicking")]

use assign::{
    Gpu, MIN_DISTANCE_2, Shader,
    conformance::{Bound, download, run_kernel, upload},
    fall_off,
    kernel::Slot,
    range_window,
};

const KERNEL: &str = "
import package::window::{MIN_DISTANCE_2, fall_off, range_window};

@group(0) @binding(0) var<storage, read> distances_m: array<f32>;
@group(0) @binding(1) var<storage, read_write> found: array<vec2f>;

@compute @workgroup_size(64)
fn evaluate(@builtin(global_invocation_id) thread: vec3u) {
  if thread.x < arrayLength(&distances_m) {
    let distance_2 = distances_m[thread.x] * distances_m[thread.x];
    found[thread.x] =
      vec2f(range_window(distance_2, RANGE_M), fall_off(distance_2, RANGE_M, MIN_DISTANCE_2));
  }
}
const RANGE_M: f32 = 2.0;
";

const RANGE_M: f64 = 2.0;

/// Window and fall-off at each distance.
fn on_the_gpu(gpu: &Gpu, hard_cut: bool, distances_m: &[f32]) -> Vec<[f32; 2]> {
    let module = Shader::new(1)
        .module("package::kernel", KERNEL)
        .flag("hard_cut", hard_cut)
        .create(gpu, "package::kernel")
        .unwrap();
    let input = upload(gpu, "distances", distances_m).unwrap();
    let output = upload(gpu, "found", &vec![[0.0_f32; 2]; distances_m.len()]).unwrap();
    let groups = [Bound::Buffers(&[(0, Slot::Read, &input), (1, Slot::Write, &output)])];
    run_kernel(gpu, &module, "evaluate", &groups, distances_m.len().div_ceil(64) as u32);
    download(gpu, &output, distances_m.len()).unwrap()
}

#[test]
fn wesl_window_and_fall_off_equal_rust() {
    let gpu = Gpu::open(None).unwrap_or_else(|e| panic!("this test runs shaders: {e}"));
    let distances_m: Vec<f32> = (0..=250).map(|ix| 0.01 * ix as f32).collect();
    let smooth = on_the_gpu(&gpu, false, &distances_m);
    let hard = on_the_gpu(&gpu, true, &distances_m);
    for ((&distance_m, smooth), hard) in distances_m.iter().zip(smooth).zip(hard) {
        let distance_2 = f64::from(distance_m).powi(2);
        let check = |what: &str, found: f32, expected: f64| {
            let error = (f64::from(found) - expected).abs();
            assert!(
                error <= 1e-5 * expected + 1e-6,
                "{what} at {distance_m} m: WESL {found}, Rust {expected}"
            );
        };
        check("window", smooth[0], range_window(distance_2, RANGE_M));
        check("fall-off", smooth[1], fall_off(distance_2, RANGE_M, MIN_DISTANCE_2));
        // At the range itself rounding decides on which side of the cut a sample lies.
        if (f64::from(distance_m) - RANGE_M).abs() > 1e-3 {
            let inside = if f64::from(distance_m) < RANGE_M { 1.0 } else { 0.0 };
            check("hard window", hard[0], inside);
            check("hard fall-off", hard[1], inside / distance_2.max(MIN_DISTANCE_2));
        }
    }
}
