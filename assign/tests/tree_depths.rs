//! The codes of depths in trees ascend with the depths, and tell those apart that differ by a thousandth.

#![allow(clippy::unwrap_used, reason = "a test fails by panicking")]

use assign::{
    Gpu, Shader,
    conformance::{Bound, LinkedModule, download, run_kernel, upload},
    kernel::Slot,
};

const KERNEL: &str = "
import package::tree_depths::{depth_code, holds_code, interval_between, join_intervals, RUN};
@group(0) @binding(0) var<storage, read> depths: array<f32>;
@group(0) @binding(1) var<storage, read_write> codes: array<u32>;
// For each depth, whether the interval to the next one holds it, and whether the joint interval of the first
// depth and of this one does.
@group(0) @binding(2) var<storage, read_write> held: array<u32>;
@compute @workgroup_size(RUN) fn encode(@builtin(global_invocation_id) id: vec3u) {
  let count = arrayLength(&depths);
  for (var i = id.x; i < count; i += RUN) {
    let code = depth_code(depths[i]);
    codes[i] = code;
    let interval = interval_between(depths[i], depths[min(i + 1u, count - 1u)]);
    let whole = join_intervals(interval, interval_between(depths[0], depths[0]));
    held[i] = select(0u, 1u, holds_code(interval, code)) + select(0u, 2u, holds_code(whole, code));
  }
}";

#[test]
fn codes_ascend_with_depths() {
    let gpu = Gpu::open(None).unwrap();
    let shader = Shader::new(1).module("package::codes", KERNEL);
    let linked = LinkedModule::new("codes", &shader.link("package::codes").unwrap());
    assert_eq!(linked.constant("RUN"), 8, "`RUN` of `trees.rs`");
    let module = shader.create(&gpu, "package::codes").unwrap();
    let far = 1.1e6_f32;
    let mut depths = vec![f32::MIN, -1.0, -1e-6, -0.0, 0.0, 1e-20, 1e-4];
    depths.extend((0..40_000).map(|ix| 2.5e-4 * (1.000_55_f32).powi(ix)).take_while(|d| *d < far));
    depths.extend([far, 1e9, f32::MAX]);
    let buffer = upload(&gpu, "depths", &depths).unwrap();
    let [codes, held] = ["codes", "held"].map(|name| {
        let zero = vec![0_u32; depths.len()];
        upload(&gpu, name, &zero).unwrap()
    });
    let bound = [(0, Slot::Read, &buffer), (1, Slot::Write, &codes), (2, Slot::Write, &held)];
    run_kernel(&gpu, &module, "encode", &[Bound::Buffers(&bound)], 1);
    let codes: Vec<u32> = download(&gpu, &codes, depths.len()).unwrap();
    let held: Vec<u32> = download(&gpu, &held, depths.len()).unwrap();
    assert!(codes.is_sorted());
    assert_eq!((codes[0], codes[codes.len() - 1]), (0, 0xffff));
    // Depths that are a thousandth apart, inside the range.
    for (ix, pair) in depths.windows(3).enumerate().skip(8) {
        assert!(pair[2] > 1e6 || codes[ix] < codes[ix + 2], "{pair:?} have one code");
    }
    assert!(held.iter().all(|both| *both == 3), "a depth lies outside its own interval");
}
