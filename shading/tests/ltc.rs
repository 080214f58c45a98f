//! Linearly transformed cosines against the BRDF's true integral, and their WESL.

#![allow(clippy::unwrap_used, reason = "a helper of a test may fail it")]

use assign::{EncoderPasses, Gpu, Passes, entry};
use bytemuck::pod_collect_to_vec;
use shading::ltc::{Accuracy, LTC_POLYNOMIAL_WESL, Polynomial, Table, accuracy_cases};

/// Median error of the published fit over its own rectangles.
const PUBLISHED: f64 = 0.042;

#[test]
fn the_median_error_near_the_mirror_direction_is_that_of_the_published_fit() {
    let cases = accuracy_cases(1500, 1);
    let table = Table::ggx().unwrap();
    let fitted = Accuracy::of(&cases, |roughness, cos| table.look_up(roughness, cos));
    println!("table: {fitted:.4?}");
    assert!(fitted.median < PUBLISHED && fitted.bias.abs() < 0.1, "{fitted:?}");
    let polynomial = Polynomial::ggx();
    let smooth = Accuracy::of(&cases, |roughness, cos| polynomial.entry(roughness, cos));
    println!("polynomials: {smooth:.4?}");
    assert!(smooth.median < fitted.median + 0.005, "{smooth:?}");
    // Lobes of a slightly higher roughness, or of another view, do not pass.
    let rougher = Accuracy::of(&cases, |roughness, cos| table.look_up(roughness + 0.02, cos));
    let turned = Accuracy::of(&cases, |roughness, cos| table.look_up(roughness, cos + 0.05));
    assert!(rougher.median > PUBLISHED && turned.median > PUBLISHED, "{rougher:?}, {turned:?}");
}

/// What the WESL module gives for each pair of roughness and y.
fn on_the_gpu(places: &[[f32; 2]]) -> Vec<[[f32; 4]; 2]> {
    let gpu = Gpu::open(None).expect("an adapter: scripts/test installs the software one");
    let source = format!(
        "{LTC_POLYNOMIAL_WESL}
        @group(0) @binding(0) var<storage, read_write> places: array<vec2f>;
        @group(0) @binding(1) var<storage, read_write> entries: array<array<vec4f, 2>>;
        @compute @workgroup_size(64) fn main(@builtin(global_invocation_id) id: vec3u) {{
          if id.x < arrayLength(&places) {{
            entries[id.x] = ltc_entry_polynomial(places[id.x].x, places[id.x].y);
          }}
        }}"
    );
    let module = gpu.device.create_shader_module(wgpu::ShaderModuleDescriptor {
        label: Some("polynomials"),
        source: wgpu::ShaderSource::Wgsl(source.into()),
    });
    let pipeline = gpu.device.create_compute_pipeline(&wgpu::ComputePipelineDescriptor {
        label: Some("polynomials"),
        layout: None,
        module: &module,
        entry_point: Some("main"),
        compilation_options: Default::default(),
        cache: None,
    });
    let inputs = gpu.storage("places", size_of_val(places) as u64).unwrap();
    gpu.queue.write_buffer(&inputs, 0, bytemuck::cast_slice(places));
    let bytes = places.len() as u64 * 32;
    let outputs = gpu.storage("entries", bytes).unwrap();
    let group = gpu.device.create_bind_group(&wgpu::BindGroupDescriptor {
        label: Some("polynomials"),
        layout: &pipeline.get_bind_group_layout(0),
        entries: &[entry(0, &inputs), entry(1, &outputs)],
    });
    let mut encoder = gpu.device.create_command_encoder(&Default::default());
    EncoderPasses { encoder: &mut encoder }.compute("polynomials", &mut |pass| {
        pass.set_pipeline(&pipeline);
        pass.set_bind_group(0, &group, &[]);
        pass.dispatch_workgroups((places.len() as u32).div_ceil(64), 1, 1);
    });
    gpu.queue.submit([encoder.finish()]);
    pod_collect_to_vec(&gpu.read(&outputs, bytes).unwrap())
}

#[test]
fn the_polynomials_wesl_is_their_rust() {
    let at = |step: u32| step as f32 / 30.0;
    let places: Vec<_> = (0..31 * 31).map(|ix| [at(ix % 31), at(ix / 31)]).collect();
    let polynomial = Polynomial::ggx();
    for ([x, y], found) in places.iter().zip(on_the_gpu(&places)) {
        let expected = polynomial.entry(f64::from(*x), 1.0 - f64::from(y * y));
        let pairs = found.concat().into_iter().zip([expected.inverse, expected.integrals].concat());
        let off = pairs.map(|(a, b)| (a - b).abs()).fold(0.0, f32::max);
        assert!(off < 1e-4, "{x}, {y}: {found:?}, {expected:?}");
    }
}
