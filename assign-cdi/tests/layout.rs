//! Every kernel links and validates without a GPU, and every struct shared by Rust and WESL has one layout.

#![allow(clippy::unwrap_used, reason = "a helper of a test may fail it")]

use assign::{Shader, conformance::LinkedModule, struct_layout};
use assign_cdi::{
    BUILD_ROOTS, Build, Coverage, DeepImageCounters, DeepImageSettings, Directions, DispatchSizes,
    ImagesUniform, LinkedNode, ListSort, PlanUniform, PrefixSum, Primary, RandomRanges,
    RandomUniform, RangeCaster, RangeRule, RangesUniform, RoundUniform, ScanUniform, SortUniform,
    SortWork, Spread, StageUniform, Storage, build_shader,
};

/// A root, linked and validated with what WebGPU has without any optional feature.
fn validated(shader: &Shader<'_>, root: &str) -> LinkedModule {
    let linked = LinkedModule::new(root, &shader.link(root).unwrap());
    // WebGPU's default limits.
    for entry_point in &linked.module().entry_points {
        assert!(entry_point.workgroup_size.iter().product::<u32>() <= 256, "{root}");
    }
    let shared = linked.workgroup_bytes();
    assert!(shared <= 16_384, "{root}: {shared} bytes of workgroup memory");
    linked
}

fn all_settings() -> Vec<DeepImageSettings> {
    let mut all = Vec::new();
    for spread in [Spread::StacksAndSlices, Spread::Squares] {
        for storage in [Storage::Arrays, Storage::LinkedLists] {
            for coverage in [Coverage::Centres, Coverage::Conservative] {
                all.push(DeepImageSettings {
                    directions: Directions::new(spread, 4, 8).unwrap(),
                    build: Build::PerDirection { coverage, at_once: 1 },
                    storage,
                    ..Default::default()
                });
            }
        }
    }
    all
}

#[test]
fn kernels_validate() {
    for settings in all_settings() {
        for root in BUILD_ROOTS {
            validated(&build_shader(&settings), root);
        }
        for primary in [Primary::Normal, Primary::Reflected, Primary::Given] {
            for is_corrected in [false, true] {
                let rule = RangeRule { primary, is_corrected, ..RangeRule::default() };
                validated(&RangeCaster::shader(&settings, rule), "package::ranges");
            }
        }
    }
    validated(&ListSort::shader(), "package::sort_short");
    validated(&ListSort::shader(), "package::sort_long");
    validated(&PrefixSum::shader(), "package::prefix_sum");
    validated(&RandomRanges::shader(), "package::random_ranges");
}

/// Asserts that a WESL struct is laid out as a Rust one.
macro_rules! assert_same {
    ($module:expr, $wesl:literal, $($rust:tt)+) => {
        assert_eq!($module.layout_of($wesl), struct_layout!($($rust)+), "WESL, then Rust: {}", $wesl);
    };
}

#[test]
fn structs_have_one_layout_in_wesl_and_rust() {
    let settings = DeepImageSettings::default();
    let build = build_shader(&settings);
    let samples = validated(&build, "package::from_samples");
    assert_same!(samples, "Images", ImagesUniform: centre_world, radius_m, footprint_m, size_px,
        direction_count, triangle_count, sample_capacity, fragment_capacity, cell_m, side_cells,
        half_box_m, sorted_longest);
    assert_same!(samples, "Counting", DeepImageCounters: sample_count, fragment_count, large_count,
        rejected_count, is_overflowed, longest);
    assert_same!(samples, "Stage", StageUniform: first_direction, mode);
    let plan = validated(&build, "package::plan");
    assert_same!(plan, "Dispatches", DispatchSizes: samples, large);
    assert_same!(plan, "Plan", PlanUniform: directions_at_once);
    let ranges = RangeCaster::shader(&settings, RangeRule::default());
    let ranges = validated(&ranges, "package::ranges");
    assert_same!(ranges, "Header", DeepImageCounters: sample_count, fragment_count, large_count,
        rejected_count, is_overflowed, longest);
    assert_same!(ranges, "Ranges", RangesUniform: point_count, ray_count, is_maximum, light_world, rays);
    let random = validated(&RandomRanges::shader(), "package::random_ranges");
    assert_same!(random, "Random", RandomUniform: point_count, seed, low_m, high_m, keeps_unknown);
    let scan = validated(&PrefixSum::shader(), "package::prefix_sum");
    assert_same!(scan, "Scan", ScanUniform: in_count, out_count, has_bases);
    let long = validated(&ListSort::shader(), "package::sort_long");
    assert_same!(long, "Sort", SortUniform: list_count, entry_count, part_capacity,
        block_capacity);
    assert_same!(long, "Round", RoundUniform: run_log2, is_odd);
    assert_same!(long, "WorkHeader", SortWork: part_groups, part_count, block_groups, block_count,
        longest);
    assert_eq!(std::mem::offset_of!(SortWork, longest) as u64, ListSort::LONGEST_AT);
}

/// The build writes linked lists; rays and the CPU read them.
#[test]
fn linked_nodes_have_one_layout() {
    let settings = DeepImageSettings { storage: Storage::LinkedLists, ..Default::default() };
    let build = validated(&build_shader(&settings), "package::from_samples");
    assert_same!(build, "Node", LinkedNode: depth_m, next);
    let ranges = RangeCaster::shader(&settings, RangeRule::default());
    let rays = validated(&ranges, "package::ranges");
    assert_same!(rays, "RayNode", LinkedNode: depth_m, next);
}

/// The CPU writes frames of directions as three columns of 16 bytes.
#[test]
fn direction_frames_are_three_columns() {
    let module = validated(&build_shader(&DeepImageSettings::default()), "package::from_samples");
    let frame = module.layout_of("DirectionFrame");
    assert_eq!((frame.fields, frame.bytes), (vec![("axes".to_owned(), 0)], 48));
}
