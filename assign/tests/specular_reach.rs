//! The reach of specular terms in WESL equals that in Rust, and the bound from what a G-buffer rounds is no shorter.

#![allow(clippy::unwrap_used, reason = "a test fails by panicking")]

use assign::{
    Gpu, Shader,
    conformance::{Bound, download, run_kernel, upload},
    kernel::Slot,
    specular_reach,
};

const KERNEL: &str = "
import package::specular_reach::{specular_reach, specular_reach_bound};

// Roughness, reflectance, cosine to the eye, and the most ranges.
@group(0) @binding(0) var<storage, read> surfaces: array<vec4f>;
@group(0) @binding(1) var<storage, read_write> reaches: array<vec2f>;

@compute @workgroup_size(64)
fn evaluate(@builtin(global_invocation_id) thread: vec3u) {
  if thread.x < arrayLength(&surfaces) {
    let s = surfaces[thread.x];
    reaches[thread.x] =
      vec2f(specular_reach(s.x, s.y, s.z, s.w), specular_reach_bound(s.x, s.y, s.z, s.w));
  }
}
";

const MOST: f32 = 1e6;

/// Surfaces from polished to rough, from all sides.
fn surfaces() -> Vec<[f32; 4]> {
    let steps = |count: u32| (0..=count).map(move |ix| ix as f32 / count as f32);
    let mut all = Vec::new();
    for roughness in steps(40) {
        for f0 in [0.0, 0.02, 0.04, 0.1, 0.3, 0.7, 1.0] {
            // Denser towards grazing angles.
            all.extend(steps(30).map(|x| [roughness, f0, x * x, MOST]));
        }
    }
    all
}

/// The reach and its bound for each surface.
fn on_the_gpu(surfaces: &[[f32; 4]]) -> Vec<[f32; 2]> {
    let gpu = Gpu::open(None).unwrap_or_else(|e| panic!("this test runs shaders: {e}"));
    let shader = Shader::new(1).module("package::kernel", KERNEL);
    let module = shader.create(&gpu, "package::kernel").unwrap();
    let input = upload(&gpu, "surfaces", surfaces).unwrap();
    let output = upload(&gpu, "reaches", &vec![[0.0_f32; 2]; surfaces.len()]).unwrap();
    let groups = [Bound::Buffers(&[(0, Slot::Read, &input), (1, Slot::Write, &output)])];
    run_kernel(&gpu, &module, "evaluate", &groups, surfaces.len().div_ceil(64) as u32);
    download(&gpu, &output, surfaces.len()).unwrap()
}

fn exact([roughness, f0, cos_v, most]: [f32; 4]) -> f64 {
    specular_reach(roughness.into(), f0.into(), cos_v.into(), most.into())
}

#[test]
fn wesl_equals_rust() {
    let surfaces = surfaces();
    for (surface, [reach, _]) in surfaces.iter().zip(on_the_gpu(&surfaces)) {
        let expected = exact(*surface);
        let error = (f64::from(reach) / expected - 1.0).abs();
        assert!(error < 1e-4, "{surface:?}: WESL {reach}, Rust {expected}");
    }
}

/// A surface with the errors that a G-buffer may make: a half float's step of roughness, half a step of eight bits of
/// sRGB near white, and a half float's step of a normal.
fn rounded([roughness, f0, cos_v, most]: [f32; 4], by: [f32; 3]) -> [f32; 4] {
    let step = 2.0_f32.powi(-10);
    [
        roughness * (1.0 + by[0] * step),
        (f0 + by[1] * 0.0045).clamp(0.0, 1.0),
        (cos_v + by[2] * step).clamp(0.0, 1.0),
        most,
    ]
}

#[test]
fn a_bound_from_a_rounded_surface_is_no_shorter() {
    let exact_surfaces = surfaces();
    let mut without_slack = 0;
    for bits in 0..8 {
        let by = [0, 1, 2].map(|bit| if bits >> bit & 1 == 0 { -1.0 } else { 1.0 });
        let drawn: Vec<[f32; 4]> = exact_surfaces.iter().map(|s| rounded(*s, by)).collect();
        for (surface, [reach, bound]) in exact_surfaces.iter().zip(on_the_gpu(&drawn)) {
            let needed = exact(*surface);
            assert!(
                f64::from(bound) >= needed,
                "{surface:?} rounded by {by:?}: {bound} < {needed}"
            );
            // It is not much longer, but where a small cosine leaves much of the angle open.
            let [_, f0, cos_v, _] = *surface;
            if f0 >= 0.04 && cos_v > 0.05 {
                assert!(f64::from(bound) < 1.25 * needed, "{surface:?}: {bound}, {needed}");
            }
            without_slack += usize::from(f64::from(reach) < needed);
        }
    }
    assert!(without_slack > 1_000, "{without_slack}: the reach of a rounded surface is no bound");
}
