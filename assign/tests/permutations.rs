//! Every permutation of the culling kernel links and validates, without a GPU.

use assign::{Culler, FrustumTests, GroupShape};

const GROUP_OF: &str = "
import package::sample::ViewSample;
fn group_of(sample: ViewSample) -> u32 {
  return 0u;
}
";

const SHAPES: [(GroupShape, &str); 4] = [
    (GroupShape::Frustum(FrustumTests { sat_n: false }), "vec2f(-1.0), vec2f(1.0), 1.0, 2.0"),
    (GroupShape::Frustum(FrustumTests { sat_n: true }), "vec2f(-1.0), vec2f(1.0), 1.0, 2.0"),
    (GroupShape::Box, "vec3f(0.0), vec3f(1.0)"),
    (
        GroupShape::OrientedBox,
        "vec3f(0.0), vec3f(1.0, 0.0, 0.0), vec3f(0.0, 1.0, 0.0), vec3f(0.0, 0.0, 1.0), vec3f(1.0)",
    ),
];

/// A strategy of one group with the given bounds.
fn strategy(bounds: &str) -> String {
    format!(
        "import package::bounds::GroupBounds;
        {GROUP_OF}
        fn group_bounds(group: u32) -> GroupBounds {{
          return GroupBounds({bounds});
        }}"
    )
}

fn validate(source: &str) -> Result<naga::Module, String> {
    let module = naga::front::wgsl::parse_str(source).map_err(|e| e.emit_to_string(source))?;
    // What WebGPU has without any optional feature.
    naga::valid::Validator::new(
        naga::valid::ValidationFlags::all(),
        naga::valid::Capabilities::empty(),
    )
    .validate(&module)
    .map_err(|e| e.emit_to_string(source))?;
    Ok(module)
}

#[test]
fn every_permutation_of_the_kernel_validates() {
    for (shape, bounds) in SHAPES {
        for spots in [false, true] {
            let what = format!("{shape:?}, spots {spots}");
            let source = Culler::kernel_source(shape, &strategy(bounds), spots)
                .unwrap_or_else(|e| panic!("{what}: {e}"));
            let module = validate(&source).unwrap_or_else(|e| panic!("{what}: {e}"));
            let mut entry_points: Vec<_> = module.entry_points.iter().map(|e| &e.name).collect();
            entry_points.sort();
            assert_eq!(entry_points, ["cull_groups", "reset"], "{what}");
            let reads_shapes = module
                .global_variables
                .iter()
                .any(|(_, v)| v.name.as_deref().is_some_and(|n| n.contains("light_shapes")));
            assert_eq!(reads_shapes, spots, "{what}");
        }
    }
}

/// Permutations differ where they should: the flags reach the module.
#[test]
fn flags_change_the_kernel() {
    let source =
        |shape, bounds, spots| Culler::kernel_source(shape, &strategy(bounds), spots).unwrap();
    let sources: Vec<String> = SHAPES
        .iter()
        .flat_map(|(shape, bounds)| [false, true].map(|spots| source(*shape, bounds, spots)))
        .collect();
    for (i, a) in sources.iter().enumerate() {
        assert!(sources[..i].iter().all(|b| a != b), "permutation {i}");
    }
}

#[test]
fn a_strategy_of_the_wrong_shape_is_rejected() {
    let boxes = strategy("vec3f(0.0), vec3f(1.0)");
    let shape = GroupShape::Frustum(FrustumTests::default());
    let linked = Culler::kernel_source(shape, &boxes, false).map_err(|e| e.to_string());
    assert!(linked.and_then(|source| validate(&source)).is_err());
}
