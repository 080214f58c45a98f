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
// Range, metres, and the least squared distance, square metres.
@group(0) @binding(2) var<uniform> parameters: vec4f;

@compute @workgroup_size(64)
fn evaluate(@builtin(global_invocation_id) thread: vec3u) {
  if thread.x < arrayLength(&distances_m) {
    let distance_2 = distances_m[thread.x] * distances_m[thread.x];
    let least_2 = max(parameters.y, MIN_DISTANCE_2);
    found[thread.x] =
      vec2f(range_window(distance_2, parameters.x), fall_off(distance_2, parameters.x, least_2));
  }
}
";

/// Ranges, metres, and least squared distances, square metres: a point light's, and one as a VPL has it.
const PARAMETERS: [(f64, f64); 2] = [(2.0, MIN_DISTANCE_2), (0.75, 0.25)];

/// The largest difference between WESL and Rust, from the value in Rust.
fn tolerance(expected: f64) -> f64 {
    1e-5 * expected + 1e-6
}

/// Window and fall-off at each distance.
fn on_the_gpu(
    gpu: &Gpu,
    flag: Option<&str>,
    (range_m, least_2): (f64, f64),
    distances_m: &[f32],
) -> Vec<[f32; 2]> {
    let shader = Shader::new(1).module("package::kernel", KERNEL);
    let shader = flag.into_iter().fold(shader, |shader, flag| shader.flag(flag, true));
    let module = shader.create(gpu, "package::kernel").unwrap();
    let input = upload(gpu, "distances", distances_m).unwrap();
    let output = upload(gpu, "found", &vec![[0.0_f32; 2]; distances_m.len()]).unwrap();
    let parameters = [range_m as f32, least_2 as f32, 0.0, 0.0];
    let parameters = upload(gpu, "parameters", &parameters).unwrap();
    let groups = [Bound::Buffers(&[
        (0, Slot::Read, &input),
        (1, Slot::Write, &output),
        (2, Slot::Uniform, &parameters),
    ])];
    run_kernel(gpu, &module, "evaluate", &groups, distances_m.len().div_ceil(64) as u32);
    download(gpu, &output, distances_m.len()).unwrap()
}

#[test]
fn wesl_window_and_fall_off_equal_rust() {
    let gpu = Gpu::open(None).unwrap_or_else(|e| panic!("this test runs shaders: {e}"));
    let distances_m: Vec<f32> = (0..=250).map(|ix| 0.01 * ix as f32).collect();
    for (range_m, least_2) in PARAMETERS {
        let found = [None, Some("hard_cut"), Some("no_cut")]
            .map(|flag| on_the_gpu(&gpu, flag, (range_m, least_2), &distances_m));
        let [smooth, hard, endless] = found;
        let windowed = distances_m.iter().zip(smooth);
        for (((&distance_m, smooth), hard), endless) in windowed.zip(hard).zip(endless) {
            let distance_m = f64::from(distance_m);
            let distance_2 = distance_m.powi(2);
            let check = |what: &str, found: f32, expected: f64| {
                assert!(
                    (f64::from(found) - expected).abs() <= tolerance(expected),
                    "{what} of range {range_m} m at {distance_m} m: WESL {found}, Rust {expected}"
                );
            };
            check("window", smooth[0], range_window(distance_2, range_m));
            check("fall-off", smooth[1], fall_off(distance_2, range_m, least_2));
            check("endless window", endless[0], 1.0);
            check("endless fall-off", endless[1], 1.0 / distance_2.max(least_2));
            // At the range itself rounding decides on which side of the cut a sample lies.
            if (distance_m - range_m).abs() > 1e-3 {
                let inside = if distance_m < range_m { 1.0 } else { 0.0 };
                check("hard window", hard[0], inside);
                check("hard fall-off", hard[1], inside / distance_2.max(least_2));
            }
        }
    }
}

/// The tolerance tells the window from the hard cut and from a window 0.1 % wider, and one least distance from
/// the other.
#[test]
fn the_tolerance_rejects_another_window_or_least_distance() {
    let [(range_m, least_2), (_, other_least_2)] = PARAMETERS;
    // At 0.4 m.
    let distance_2 = 0.16;
    let expected = fall_off(distance_2, range_m, least_2);
    for wrong in [
        1.0 / distance_2,
        fall_off(distance_2, range_m, other_least_2),
        fall_off(distance_2, 1.001 * range_m, least_2),
    ] {
        let error = (wrong - expected).abs();
        assert!(error > tolerance(expected), "{wrong} passes for {expected}");
    }
}
