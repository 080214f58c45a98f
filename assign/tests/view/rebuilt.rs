//! Shaders rebuild view depths from clip depths: with the bits of the plain formula, or on an oblique near plane.

use assign::{
    Frame, FrameBindings, Gpu, LightBuffer, Shader, View,
    conformance::{Bound, download, run_kernel, upload},
    kernel::Slot,
};
use glam::DVec2;
use proptest::{
    strategy::{Strategy, ValueTree},
    test_runner::{Config, RngAlgorithm, TestRng, TestRunner},
};

use crate::views::{oblique, plain, window_of};

/// Per pixel and clip depth: the view depth of `sample_at`, and that of the formula of a plain near plane.
const KERNEL: &str = "
import package::sample::sample_at;
import package::view::view;
@group(1) @binding(0) var<storage, read> samples: array<vec4f>;
@group(1) @binding(1) var<storage, read_write> depths: array<vec2f>;
@compute @workgroup_size(64) fn rebuild(@builtin(global_invocation_id) id: vec3u) {
  if id.x >= arrayLength(&samples) { return; }
  let at = samples[id.x];
  let m = view.view_to_clip;
  let over = m[3].z - at.z * m[3].w;
  let under = m[2].z - at.z * m[2].w;
  var plain = over / under;
  if under == 0.0 { plain = abs(over) * 16777216.0; }
  depths[id.x] = vec2f(sample_at(at.xy, at.z, vec3f(0.0), 0u).depth_view, plain);
}";

struct Rebuilder {
    gpu: Gpu,
    module: wgpu::ShaderModule,
    lights: LightBuffer,
    frame: FrameBindings,
}

impl Rebuilder {
    fn new() -> Self {
        let gpu = Gpu::open(None).unwrap();
        let shader = Shader::new(2).module("package::rebuild", KERNEL);
        let module = shader.create(&gpu, "package::rebuild").unwrap();
        let lights = LightBuffer::new(&gpu, &[]).unwrap();
        let frame = FrameBindings::new(&gpu);
        Self { gpu, module, lights, frame }
    }

    fn run(&mut self, view: &View, samples: &[[f32; 4]]) -> Vec<[f32; 2]> {
        let gpu = &self.gpu;
        self.frame.update(gpu, &Frame::new(view, &self.lights)).unwrap();
        let given = upload(gpu, "samples", samples).unwrap();
        let depths = upload(gpu, "depths", &vec![[0.0_f32; 2]; samples.len()]).unwrap();
        let groups = [
            Bound::Group(self.frame.layout(), self.frame.bind_group().unwrap()),
            Bound::Buffers(&[(0, Slot::Read, &given), (1, Slot::Write, &depths)]),
        ];
        run_kernel(gpu, &self.module, "rebuild", &groups, samples.len().div_ceil(64) as u32);
        download(gpu, &depths, samples.len()).unwrap()
    }
}

fn drawn<S: Strategy>(strategy: &S, count: usize) -> Vec<S::Value> {
    let rng = TestRng::from_seed(RngAlgorithm::ChaCha, &[7; 32]);
    let mut runner = TestRunner::new_with_rng(Config::default(), rng);
    (0..count).map(|_| strategy.new_tree(&mut runner).unwrap().current()).collect()
}

/// Pixels all over the viewport, with clip depths from 0 to 1 and both ends.
fn samples(view: &View) -> Vec<[f32; 4]> {
    let port = view.viewport;
    (0..128_u32)
        .map(|ix| {
            let [u, v, w] =
                [0.618_034, 0.754_878, 0.569_84].map(|step| (f64::from(ix) * step).fract() as f32);
            let at = |first: u32, size: u32, share: f32| {
                first as f32 + (share * size as f32).floor().min(size as f32 - 1.0) + 0.5
            };
            let depth = match ix % 8 {
                0 => 0.0,
                1 => 1.0,
                2 => w * w * w * w * w,
                _ => w,
            };
            [at(port.x, port.width, u), at(port.y, port.height, v), depth, 0.0]
        })
        .collect()
}

/// Images of plain near planes keep their bits.
#[test]
fn plain_near_planes_keep_their_bits() {
    let mut rebuilder = Rebuilder::new();
    for view in drawn(&plain(), 40) {
        for (sample, [found, wanted]) in
            samples(&view).iter().zip(rebuilder.run(&view, &samples(&view)))
        {
            assert_eq!(found.to_bits(), wanted.to_bits(), "{sample:?} in {view:?}");
        }
    }
}

/// On an oblique near plane the depths are those of the inverse projection, and the plain formula's are not.
#[test]
fn oblique_near_planes_give_the_depths_of_the_inverse_projection() {
    let mut rebuilder = Rebuilder::new();
    let (mut checked, mut plain_is_off) = (0, 0);
    for (view, _) in drawn(&oblique(), 40) {
        let samples = samples(&view);
        let from_clip = view.view_to_clip().as_dmat4().inverse();
        let tilt = view.uniform().depth_tilt.map(f32::abs);
        for (sample, [found, plain]) in samples.iter().zip(rebuilder.run(&view, &samples)) {
            let [x, y, depth_clip, _] = sample.map(f64::from);
            let port = view.viewport;
            let uv = (DVec2::new(x, y) - DVec2::new(port.x.into(), port.y.into()))
                / DVec2::new(port.width.into(), port.height.into());
            let [min, max] = window_of(&view);
            let window = min + (max - min) * DVec2::new(uv.x, 1.0 - uv.y);
            let Some((near_m, far_m)) = view.shown_m(window) else { continue };
            let point = from_clip.project_point3(glam::DVec3::new(
                2.0 * uv.x - 1.0,
                1.0 - 2.0 * uv.y,
                depth_clip,
            ));
            let wanted = -point.z;
            if !(near_m * 0.999..=far_m.min(1e4) * 1.001).contains(&wanted) {
                continue;
            }
            // Rounding of the tilt, at the pixel's distance from the origin of the target.
            let row = view.view_to_clip().row(2).as_dvec4();
            let size = 1.0
                + row.z.abs().min(1e9)
                + f64::from(tilt[0]) * x
                + f64::from(tilt[1]) * y
                + f64::from(tilt[2]);
            let allowed = match view.projection {
                assign::Projection::Perspective { .. } => {
                    wanted * (1e-6 + 8.0 * f64::from(f32::EPSILON) * size * wanted / row.w.abs())
                }
                assign::Projection::Orthographic { .. } => {
                    wanted * 1e-6
                        + 8.0 * f64::from(f32::EPSILON) * (size + row.w.abs()) / row.z.abs()
                }
            };
            let off = (f64::from(found) - wanted).abs();
            assert!(
                off <= allowed,
                "{sample:?}: {found}, {wanted}: off {off}, allowed {allowed}: {view:?}"
            );
            assert!(found >= view.nearest_rebuilt_m(), "{found} {view:?}");
            assert!(
                view.farthest_rebuilt_m().is_none_or(|end_m| found <= end_m),
                "{found} {view:?}"
            );
            checked += 1;
            let is_off = (f64::from(plain) - wanted).abs() > 10.0 * allowed;
            plain_is_off += usize::from(is_off || !plain.is_finite());
        }
    }
    assert!(checked > 500 && plain_is_off * 10 > checked * 8, "{plain_is_off} of {checked}");
}
