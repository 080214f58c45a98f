//! Every permutation of the culling kernel links and validates, without a GPU.

#![allow(clippy::unwrap_used, reason = "a helper of a test may fail it")]

use assign::{
    AreaBounds, CullSettings, Culler, GroupShape, LightChanges, LightKinds, LightSource, Storage,
    Unordered, conformance::LinkedModule,
};

const GROUP_OF: &str = "
import package::sample::ViewSample;
fn group_of(sample: ViewSample) -> u32 {
  return 0u;
}
";

const FRUSTUM: (GroupShape, &str) = (GroupShape::Frustum, "vec2f(-1.0), vec2f(1.0), 1.0, 2.0");
const BOXES: [(GroupShape, &str); 2] = [
    (GroupShape::Box, "vec3f(0.0), vec3f(1.0)"),
    (
        GroupShape::OrientedBox,
        "vec3f(0.0), vec3f(1.0, 0.0, 0.0), vec3f(0.0, 1.0, 0.0), vec3f(0.0, 0.0, 1.0), vec3f(1.0)",
    ),
];

/// A shape with its bounds, its settings, and whether only live groups are culled.
type Permutation = (GroupShape, &'static str, CullSettings, bool);

fn settings(tests: &str, source: LightSource) -> CullSettings {
    CullSettings { tests: tests.parse().unwrap(), source, ..CullSettings::default() }
}

/// Every non-empty subset of the frustum tests, and the boxes, from both light sources, for all and
/// for live groups.
fn permutations() -> Vec<Permutation> {
    let names = ["hs", "sat-e", "sat-n", "sat-p", "sat-v"];
    let union = |bits: usize| {
        let chosen = (0..names.len()).filter(|i| bits >> i & 1 == 1).map(|i| names[i]);
        chosen.collect::<Vec<_>>().join("+")
    };
    let mut all = Vec::new();
    for source in [LightSource::Linear, LightSource::Hierarchy] {
        for sparse in [false, true] {
            for bits in 1..1 << names.len() {
                all.push((FRUSTUM.0, FRUSTUM.1, settings(&union(bits), source), sparse));
            }
            for (shape, bounds) in BOXES {
                all.push((shape, bounds, settings("hs", source), sparse));
            }
        }
    }
    let masks = CullSettings { storage: Storage::Masks, ..settings("hs", LightSource::Hierarchy) };
    for sparse in [false, true] {
        let linear = CullSettings { source: LightSource::Linear, ..masks };
        all.extend([masks, linear].map(|masks| (FRUSTUM.0, FRUSTUM.1, masks, sparse)));
        for settings in [masks, settings("hs+sat-n", LightSource::Linear)] {
            let bounds = "vec2f(-1.0), vec2f(1.0), 1.0, 2.0, 5u";
            all.push((GroupShape::MaskedFrustum, bounds, settings, sparse));
        }
        all.extend(BOXES.map(|(shape, bounds)| (shape, bounds, masks, sparse)));
        let trees = CullSettings { storage: Storage::Trees, ..masks };
        all.push((FRUSTUM.0, FRUSTUM.1, trees, sparse));
        all.extend(BOXES.map(|(shape, bounds)| (shape, bounds, trees, sparse)));
    }
    all
}

/// A strategy with one group of the given bounds.
fn strategy(bounds: &str) -> String {
    format!(
        "import package::bounds::GroupBounds;
        {GROUP_OF}
        fn group_bounds(group: u32) -> GroupBounds {{
          return GroupBounds({bounds});
        }}"
    )
}

#[test]
fn every_permutation_of_the_kernel_validates() {
    for (shape, bounds, settings, sparse) in permutations() {
        for kinds in LightKinds::ALL {
            let what = format!("{shape:?}, {settings:?}, sparse {sparse}, {kinds:?}");
            let source =
                Culler::kernel_source(shape, settings, sparse, strategy(bounds).as_str(), kinds)
                    .unwrap_or_else(|e| panic!("{what}: {e}"));
            let linked = LinkedModule::new(&what, &source);
            let module = linked.module();
            let mut entry_points: Vec<_> = module.entry_points.iter().map(|e| &e.name).collect();
            entry_points.sort();
            assert_eq!(entry_points, ["cull_groups"], "{what}");
            let reads = |name: &str| {
                let is_named = |n: &str| n.contains(name);
                let mut variables = module.global_variables.iter();
                variables.any(|(_, v)| v.name.as_deref().is_some_and(is_named))
            };
            assert_eq!(reads("light_shapes"), kinds.spots || kinds.areas, "{what}");
            assert_eq!(reads("light_nodes"), settings.source == LightSource::Hierarchy, "{what}");
            let reads_live = source.contains("live.count") || source.contains("live_live.count");
            assert_eq!(reads_live, sparse, "{what}");
        }
    }
}

/// The kernels that find touched groups link for every shape, test and occupancy.
#[test]
fn every_kernel_of_touched_groups_validates() {
    for (shape, bounds, settings, sparse) in permutations() {
        let what = format!("{shape:?}, {settings:?}, sparse {sparse}");
        let source = Culler::touched_source(shape, settings, sparse, strategy(bounds).as_str())
            .unwrap_or_else(|e| panic!("{what}: {e}"));
        let linked = LinkedModule::new(&what, &source);
        let mut entry_points: Vec<_> =
            linked.module().entry_points.iter().map(|e| &e.name).collect();
        entry_points.sort();
        assert_eq!(entry_points, ["start_update", "touch_groups"], "{what}");
        assert_eq!(source.contains("groups.count"), sparse, "{what}");
    }
    for kinds in LightKinds::ALL {
        let source = LightChanges::kernel_source(kinds).unwrap();
        let module = LinkedModule::new("the kernel of light changes", &source);
        let plain = kinds == LightKinds::default();
        assert_eq!(module.constant("MOST_BALLS"), LightChanges::MOST_BALLS);
        let bytes = module.layout_of("Known").bytes;
        assert_eq!(bytes, if plain { 16 } else { 80 }, "{kinds:?}");
    }
}

/// The flawed test of a rectangle links for every kind of light, and only shapes that are frusta have it.
#[test]
fn the_flawed_test_of_a_rectangle_validates() {
    let frustum = (FRUSTUM.0, FRUSTUM.1, true);
    let masked = (GroupShape::MaskedFrustum, "vec2f(-1.0), vec2f(1.0), 1.0, 2.0, 5u", true);
    for (shape, bounds, has_test) in [frustum, masked, (BOXES[0].0, BOXES[0].1, false)] {
        for kinds in LightKinds::ALL {
            let settings = CullSettings { screen_rectangle: true, ..CullSettings::default() };
            let what = format!("{shape:?}, {kinds:?}");
            let source =
                Culler::kernel_source(shape, settings, false, strategy(bounds).as_str(), kinds)
                    .unwrap_or_else(|e| panic!("{what}: {e}"));
            LinkedModule::new(&what, &source);
            assert_eq!(source.contains("rectangle_misses"), has_test, "{what}");
        }
    }
}

#[test]
fn the_kernel_that_shuffles_lists_validates() {
    let source = Unordered::kernel_source().unwrap();
    let linked = LinkedModule::new("the kernel that shuffles lists", &source);
    let entry_points: Vec<_> = linked.module().entry_points.iter().map(|e| &e.name).collect();
    assert_eq!(entry_points, ["shuffle_lists"]);
}

/// The pool has 2^30 entries, and each of 65,535 workgroups adds one list of up to `CAREFUL`
/// entries.
#[test]
fn reservations_at_once_cannot_wrap_the_cursor() {
    let (_, bounds, settings, sparse) = permutations()[0];
    let strategy = strategy(bounds);
    let kinds = LightKinds::default();
    let source =
        Culler::kernel_source(FRUSTUM.0, settings, sparse, strategy.as_str(), kinds).unwrap();
    let careful = LinkedModule::new("the culling kernel", &source).constant("CAREFUL");
    let most = 65_535 * u64::from(careful) + (1 << 30);
    assert!(careful > 0 && most < 1 << 32, "CAREFUL is {careful}: the cursor may reach {most}");
}

/// A workgroup holds the summary of a bit mask.
#[test]
fn masks_hold_a_million_lights() {
    let settings = CullSettings { storage: Storage::Masks, ..CullSettings::default() };
    let strategy = strategy(FRUSTUM.1);
    let kinds = LightKinds::default();
    let source =
        Culler::kernel_source(FRUSTUM.0, settings, false, strategy.as_str(), kinds).unwrap();
    let summary = LinkedModule::new("the culling kernel", &source).constant("MOST_SUMMARY");
    // 32 nodes of 64 lights per word.
    assert_eq!(summary * 32 * 64, 1 << 20);
}

/// The setting for area lights changes only the kernels of scenes with area lights.
#[test]
fn area_bounds_change_only_kernels_with_area_lights() {
    let boxes = BOXES.map(|(shape, bounds)| (shape, bounds, CullSettings::default(), true));
    for (shape, bounds, settings, sparse) in boxes.into_iter().chain([permutations()[0]]) {
        for kinds in LightKinds::ALL {
            let source = |area_bounds| {
                let settings = CullSettings { area_bounds, ..settings };
                let linked = Culler::kernel_source(
                    shape,
                    settings,
                    sparse,
                    strategy(bounds).as_str(),
                    kinds,
                );
                let source = linked.unwrap();
                LinkedModule::new("the culling kernel", &source);
                source
            };
            let differs = source(AreaBounds::Ball) != source(AreaBounds::Outline);
            assert_eq!(differs, kinds.areas, "{shape:?}, {kinds:?}");
        }
    }
}

/// Every flag changes the linked kernel.
#[test]
fn flags_change_the_kernel() {
    let mut sources = Vec::new();
    for (shape, bounds, settings, sparse) in permutations() {
        for kinds in LightKinds::ALL {
            let module = strategy(bounds);
            sources.push(
                Culler::kernel_source(shape, settings, sparse, module.as_str(), kinds).unwrap(),
            );
        }
    }
    let count = sources.len();
    sources.sort();
    sources.dedup();
    assert_eq!(sources.len(), count);
}

#[test]
fn a_strategy_of_the_wrong_shape_is_rejected() {
    let boxes = strategy(BOXES[0].1);
    let settings = CullSettings::default();
    let linked = Culler::kernel_source(
        GroupShape::Frustum,
        settings,
        false,
        boxes.as_str(),
        LightKinds::default(),
    );
    let validate = |source: String| LinkedModule::validate("boxes as frusta", &source);
    assert!(linked.map_err(|e| e.to_string()).and_then(validate).is_err());
}
