//! Bins of normals on the adapter: every direction lies in a bin whose cone holds it, and the pass `bounds` puts
//! it into that bin however the G-buffer rounds it.

#![allow(clippy::unwrap_used, reason = "a test fails by panicking")]

use assign::{
    Gpu, Shader,
    conformance::{Bound, download, run_kernel, upload},
    kernel::Slot,
};
use assign_clustered::{BINS_WESL, NormalBinsUniform, Normals, SpecularCut};
use glam::Vec3;

const DRIVER: &str = "
import package::strategy::normal_bins::{
  bin_count, bin_of, bin_of_cell, cells_near, cone_of_bin, greatest_of, NORMAL_MIN,
};

// Pairs: a direction, and that direction as the G-buffer rounds it.
@group(2) @binding(0) var<storage, read> normals: array<vec4f>;
// The bin; whether its cone holds the direction; whether the rounded direction is gathered into it.
@group(2) @binding(1) var<storage, read_write> found: array<vec4u>;

@compute @workgroup_size(64)
fn find(@builtin(global_invocation_id) id: vec3u) {
  if id.x >= arrayLength(&found) {
    return;
  }
  let normal = normals[2u * id.x].xyz;
  let rounded = normals[2u * id.x + 1u].xyz;
  let bin = bin_of(normal);
  let cone = cone_of_bin(bin);
  let holds = dot(cone.axis, normal) >= cone.cos_half - 1.0e-6;
  var gathered = bin_count() == 1u;
  for (var axis = 0u; axis < 3u; axis++) {
    let cells = cells_near(rounded, axis);
    for (var y = cells.low.y; y < cells.end.y; y++) {
      for (var x = cells.low.x; x < cells.end.x; x++) {
        gathered = gathered || bin == bin_of_cell(axis, cells.backwards, vec2u(x, y));
      }
    }
  }
  gathered = gathered && greatest_of(rounded) >= 0.99 * NORMAL_MIN;
  found[id.x] = vec4u(bin, select(0u, 1u, holds), select(0u, 1u, gathered), 0u);
}
";

struct Finder {
    gpu: Gpu,
    module: wgpu::ShaderModule,
}

/// The bin of a direction, whether the bin's cone holds it, and whether its rounded form is gathered there.
type Found = (u32, bool, bool);

impl Finder {
    fn new() -> Self {
        let gpu = Gpu::open(None).unwrap_or_else(|e| panic!("this test runs shaders: {e}"));
        let facing = include_str!("../../assign/src/shaders/facing.wesl");
        let bounds = include_str!("../../assign/src/shaders/bounds_box.wesl");
        let module = Shader::new(1)
            .module("package::driver", DRIVER)
            .module("package::facing", facing)
            .module("package::bounds", bounds)
            .flag("lane_bounds", false)
            .strategy(BINS_WESL)
            .create(&gpu, "package::driver")
            .unwrap();
        Self { gpu, module }
    }

    /// Finds the bins of directions, each given with its rounded form.
    fn find(&self, bins: u32, normals: &[[Vec3; 2]]) -> Vec<Found> {
        let gpu = &self.gpu;
        let bins = NormalBinsUniform::new(Normals::Bins(bins), SpecularCut::None);
        let uniform = upload(gpu, "normal bins", &[bins]).unwrap();
        let vectors: Vec<[f32; 4]> =
            normals.iter().flatten().map(|v| v.extend(0.0).to_array()).collect();
        let input = upload(gpu, "normals", &vectors).unwrap();
        let output = upload(gpu, "found", &vec![[0_u32; 4]; normals.len()]).unwrap();
        let groups = [
            Bound::Nothing,
            Bound::Buffers(&[(6, Slot::Uniform, &uniform)]),
            Bound::Buffers(&[(0, Slot::Read, &input), (1, Slot::Write, &output)]),
        ];
        let workgroups = normals.len().div_ceil(64) as u32;
        run_kernel(gpu, &self.module, "find", &groups, workgroups);
        let found: Vec<[u32; 4]> = download(gpu, &output, normals.len()).unwrap();
        found
            .into_iter()
            .map(|[bin, holds, gathered, _]| (bin, holds == 1, gathered == 1))
            .collect()
    }
}

/// The worst rounding to half floats: mantissas are cut off, and subnormal numbers become 0.
fn cut_off(normal: Vec3) -> Vec3 {
    let cut = |x: f32| {
        let kept = f32::from_bits(x.to_bits() & !0x1fff);
        if kept.abs() < f32::powi(2.0, -14) { 0.0 } else { kept }
    };
    Vec3::new(cut(normal.x), cut(normal.y), cut(normal.z))
}

/// Directions on a lattice over the faces of the cube. Many lie next to a border between cells.
fn directions() -> Vec<Vec3> {
    let mut coordinates: Vec<f32> = (-20..=20).map(|i| i as f32 / 20.0).collect();
    for border in [-1.0_f32, -1.0 / 3.0, 0.0, 1.0 / 3.0, 1.0] {
        coordinates
            .extend([-2e-3, -1e-3, -1e-4, -1e-6, 1e-6, 1e-4, 1e-3, 2e-3].map(|d| border + d));
    }
    let mut all = Vec::new();
    for &u in &coordinates {
        for &v in &coordinates {
            for front in [-1.0, 1.0] {
                let corner = Vec3::new(front, u, v);
                all.extend([corner, Vec3::new(v, front, u), Vec3::new(u, v, front)]);
            }
        }
    }
    all.into_iter().map(Vec3::normalize).collect()
}

#[test]
fn every_direction_lies_in_a_bin_that_it_is_gathered_into() {
    let finder = Finder::new();
    let normals: Vec<[Vec3; 2]> = directions().into_iter().map(|n| [n, cut_off(n)]).collect();
    for bins in [1, 6, 24, 54] {
        let mut seen = vec![false; bins as usize];
        for ([normal, rounded], (bin, holds, gathered)) in
            normals.iter().zip(finder.find(bins, &normals))
        {
            assert!(bin < bins, "{normal} lies in bin {bin} of {bins}");
            assert!(holds, "{normal} lies outside the cone of bin {bin} of {bins}");
            assert!(gathered, "{normal} as {rounded} is not gathered into bin {bin} of {bins}");
            seen[bin as usize] = true;
        }
        assert!(seen.iter().all(|seen| *seen), "all of {bins} bins are used: {seen:?}");
    }
}

#[test]
fn directions_turned_by_more_than_the_slack_miss_their_bin() {
    let finder = Finder::new();
    let turned = |n: Vec3| [n, (n + 4e-3 * n.any_orthonormal_vector()).normalize()];
    let normals: Vec<[Vec3; 2]> = directions().into_iter().map(turned).collect();
    let missed = |bins| finder.find(bins, &normals).iter().filter(|found| !found.2).count();
    assert!(missed(6) > 0 && missed(54) > missed(6));
}
