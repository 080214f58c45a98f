//! Compares the WESL tests on the adapter with the Rust mirror and with the exact oracle.

use assign::{
    Frame, FrameBindings, FrustumTests, Gpu, Light, LightBuffer, LightKinds, LightShape, Shader,
    conformance::{Bound, download, run_kernel, upload},
    kernel::Slot,
};
use proptest::strategy::{BoxedStrategy, Strategy, ValueTree};
use proptest::test_runner::TestRunner;

use crate::aims::{Kind, aim, witness};
use crate::cases::{aabb, frustum, oriented};
use crate::deterministic;
use crate::groups::{Bounds, Group, Shape, UNIONS, box_of, union};

/// Groups per permutation, each with its own view.
const GROUPS: usize = 80;
/// Lights aimed at each group.
const LIGHTS: usize = 32;
/// Vectors that describe a group for the shader.
const RECORD: usize = 5;

/// A kernel that tests every light against one group in one workgroup.
const DRIVER: &str = "
import package::lights::{volume_of_light, light_spheres};
import package::bounds::{load_bounds, reaches, reaches_box};
import package::strategy::group_bounds;

@group(1) @binding(1) var<storage, read_write> hits: array<u32>;
// Boxes around the lights: lowest and highest corner.
@group(1) @binding(2) var<storage, read> boxes: array<vec4f>;

@compute @workgroup_size(32)
fn test_group(@builtin(local_invocation_index) lane: u32) {
  load_bounds(group_bounds(0u), lane);
  let count = arrayLength(&light_spheres);
  for (var light = lane; light < count; light += 32u) {
    let hit = select(0u, 1u, reaches(volume_of_light(light)));
    let box_hit = select(0u, 2u, reaches_box(boxes[2u * light].xyz, boxes[2u * light + 1u].xyz));
    hits[light] = hit | box_hit;
  }
}
";

const FRUSTA: &str = "
import package::bounds::GroupBounds;
@group(1) @binding(0) var<storage, read> record: array<vec4f>;
fn group_bounds(group: u32) -> GroupBounds {
  return GroupBounds(record[0].xy, record[0].zw, record[1].x, record[1].y);
}
";

const BOXES: &str = "
import package::bounds::GroupBounds;
@group(1) @binding(0) var<storage, read> record: array<vec4f>;
fn group_bounds(group: u32) -> GroupBounds {
  return GroupBounds(record[0].xyz, record[1].xyz);
}
";

const ORIENTED: &str = "
import package::bounds::GroupBounds;
@group(1) @binding(0) var<storage, read> record: array<vec4f>;
fn group_bounds(group: u32) -> GroupBounds {
  return GroupBounds(record[0].xyz, record[1].xyz, record[2].xyz, record[3].xyz, record[4].xyz);
}
";

fn record(shape: &Shape) -> [[f32; 4]; RECORD] {
    let mut record = [[0.0; 4]; RECORD];
    match shape {
        Shape::Frustum { ndc_min, ndc_max, depth_min, depth_max } => {
            record[0] = [ndc_min.x, ndc_min.y, ndc_max.x, ndc_max.y];
            record[1] = [*depth_min, *depth_max, 0.0, 0.0];
        }
        Shape::Aabb { min_world, max_world } => {
            record[0] = min_world.extend(0.0).to_array();
            record[1] = max_world.extend(0.0).to_array();
        }
        Shape::Oriented { center_world, axes, half_extents_m } => {
            let vectors = [*center_world, axes[0], axes[1], axes[2], *half_extents_m];
            record = vectors.map(|v| v.extend(0.0).to_array());
        }
    }
    record
}

/// One linked permutation of the tests.
struct Tester {
    gpu: Gpu,
    module: wgpu::ShaderModule,
}

impl Tester {
    fn new(
        gpu: &Gpu,
        bounds: &str,
        strategy: &str,
        tests: FrustumTests,
        kinds: LightKinds,
    ) -> Self {
        let module = Shader::new(2)
            .module("package::driver", DRIVER)
            .module("package::bounds", bounds)
            .module("package::strategy", strategy)
            .flag("depth_mask", false)
            .flag("lane_bounds", false)
            .flag("hs", tests.hs)
            .flag("sat_e", tests.sat_e)
            .flag("sat_n", tests.sat_n)
            .flag("sat_p", tests.sat_p)
            .flag("sat_v", tests.sat_v)
            .flag("rect", false)
            .light_kinds(kinds)
            .create(gpu, "package::driver")
            .unwrap();
        Self { gpu: gpu.clone(), module }
    }

    /// For each light, whether it reaches the group, and whether its box does.
    fn run(&self, frame: &mut FrameBindings, group: &Group, lights: &[Light]) -> Vec<(bool, bool)> {
        let gpu = &self.gpu;
        let light_buffer = LightBuffer::new(gpu, lights).unwrap();
        assert!(light_buffer.rejected().is_empty());
        frame.update(gpu, &Frame::new(&group.view, &light_buffer)).unwrap();
        let record = upload(gpu, "record", &record(&group.shape)).unwrap();
        let corners: Vec<[f32; 4]> = lights
            .iter()
            .map(box_of)
            .flat_map(|(min, max)| [min.extend(0.0).to_array(), max.extend(0.0).to_array()])
            .collect();
        let boxes = upload(gpu, "boxes", &corners).unwrap();
        let hits = upload(gpu, "hits", &vec![0_u32; lights.len()]).unwrap();
        let groups = [
            Bound::Group(frame.layout(), frame.bind_group().unwrap()),
            Bound::Buffers(&[
                (0, Slot::Read, &record),
                (1, Slot::Write, &hits),
                (2, Slot::Read, &boxes),
            ]),
        ];
        run_kernel(gpu, &self.module, "test_group", &groups, 1);
        let hits: Vec<u32> = download(gpu, &hits, lights.len()).unwrap();
        hits.into_iter().map(|hit| (hit & 1 != 0, hit & 2 != 0)).collect()
    }
}

/// The share of pairs in which shader and mirror may differ by more than the slack's rounding. The
/// causes are axes along edges that are shorter than their corners' rounding, and axes between
/// nearest points that the search has not found yet.
const BEYOND_ROUNDING: f64 = 0.02;

/// The result of comparing one permutation.
#[derive(Debug, Default)]
struct Tally {
    pairs: usize,
    hits: usize,
    disagreements: usize,
    /// Disagreements that rounding of the slack does not explain.
    beyond_rounding: usize,
}

/// Both sides round, so they may differ if the gap is within rounding of the slack. In these pairs
/// the mirror itself gives different answers with 0.5 and with 1.5 times the slack.
fn compare(
    tester: &Tester,
    groups: &BoxedStrategy<Group>,
    tests: FrustumTests,
    kinds: LightKinds,
) -> Tally {
    let mut tally = Tally::default();
    let mut frame = FrameBindings::new(&tester.gpu);
    let mut runner = TestRunner::new(deterministic(1));
    for _ in 0..GROUPS {
        let group = groups.new_tree(&mut runner).unwrap().current();
        let mut light = |i| {
            // Scenes with spots or area lights have point lights too.
            let kind = match i % 4 {
                1 if kinds.spots => Kind::Spot,
                3 if kinds.curved => Kind::Curved,
                2 | 3 if kinds.areas => Kind::Area,
                2 | 3 if kinds.spots => Kind::Spot,
                _ => Kind::Point,
            };
            let aim = aim(kind).new_tree(&mut runner).unwrap();
            aim.current().light(&group)
        };
        let bounds = group.bounds();
        let mut lights: Vec<Light> = (0..LIGHTS).map(&mut light).collect();
        for i in 0..LIGHTS {
            lights.extend(on_the_edge(&bounds, &lights[i], tests));
        }
        for (light, wesl) in lights.iter().zip(tester.run(&mut frame, &group, &lights)) {
            tally.pairs += 1;
            tally.hits += usize::from(wesl.0);
            if bounds.reaches(light, tests) != wesl.0 {
                tally.disagreements += 1;
                let with_slack = |factor| bounds.with_slack(factor).reaches(light, tests);
                // An edge of a thin slice may be shorter than its corners' rounding, so its
                // direction is arbitrary, but it is still a valid axis. The same holds for the axis
                // between nearest points before the search has converged.
                let is_area = matches!(light.shape, LightShape::Area(_));
                let is_rounding = with_slack(0.5) != with_slack(1.5);
                tally.beyond_rounding += usize::from(!is_rounding);
                assert!(
                    tests.sat_e || is_area || is_rounding,
                    "WESL and Rust differ by more than rounding; WESL has {wesl:?}: {group:?} {light:?}"
                );
            }
            let reached = witness(&group, light).is_some();
            assert!(
                wesl.0 || !reached,
                "the WESL test misses a light that reaches: {group:?} {light:?}"
            );
            assert!(
                wesl.1 || !reached,
                "the WESL test misses a box with a light that reaches: {group:?} {light:?}"
            );
        }
    }
    tally
}

/// Lights with the range at which the mirror's answer changes, to one unit in the last place, and
/// with ranges just below and above.
fn on_the_edge(bounds: &Bounds, light: &Light, tests: FrustumTests) -> Vec<Light> {
    let at = |range_m: f32| Light { range_m, ..*light };
    let reaches = |range_m: f32| bounds.reaches(&at(range_m), tests);
    let (mut low, mut high) = (1e-4_f32, light.range_m);
    if reaches(low) || !reaches(high) {
        return vec![];
    }
    while low.next_up() < high {
        let middle = 0.5 * (low + high);
        if reaches(middle) {
            high = middle;
        } else {
            low = middle;
        }
    }
    let beside = [1.0 - 1e-5, 1.0 + 1e-5].map(|factor| at(high * factor));
    [vec![at(low), at(high)], beside.to_vec()].concat()
}

/// Compares every permutation of one shape. `unions` are the unions of tests that the shape
/// supports.
fn check(bounds: &str, strategy: &str, groups: &BoxedStrategy<Group>, unions: &[&str]) {
    let gpu = Gpu::open(None).unwrap_or_else(|e| panic!("this test runs shaders: {e}"));
    // Curved emitters are tested among all other kinds.
    let kinds = LightKinds::ALL.into_iter().filter(|kinds| kinds.spots || !kinds.curved);
    for kinds in kinds {
        for tests in unions {
            let tester = Tester::new(&gpu, bounds, strategy, union(tests), kinds);
            let tally = compare(&tester, groups, union(tests), kinds);
            println!("{}, {tests}, {kinds:?}: {tally:?}", gpu.info.name);
            // Both answers are common. Two lights in five lie on the edge, where rounding decides.
            // On llvmpipe up to 16 % of all pairs differ.
            let share = |count: usize| count as f64 / tally.pairs as f64;
            assert!((0.3..0.95).contains(&share(tally.hits)), "share of hits: {tally:?}");
            assert!(share(tally.disagreements) < 0.25, "share of disagreements: {tally:?}");
            assert!(share(tally.beyond_rounding) < BEYOND_ROUNDING, "beyond rounding: {tally:?}");
        }
    }
}

#[test]
fn wesl_frustum_agrees_with_rust_and_is_never_tight() {
    let bounds = include_str!("../../src/shaders/bounds_frustum.wesl");
    check(bounds, FRUSTA, &frustum().boxed(), &UNIONS);
}

#[test]
fn wesl_box_agrees_with_rust_and_is_never_tight() {
    let bounds = include_str!("../../src/shaders/bounds_box.wesl");
    check(bounds, BOXES, &aabb().boxed(), &["hs"]);
}

#[test]
fn wesl_oriented_box_agrees_with_rust_and_is_never_tight() {
    let bounds = include_str!("../../src/shaders/bounds_oriented_box.wesl");
    check(bounds, ORIENTED, &oriented().boxed(), &["hs"]);
}
