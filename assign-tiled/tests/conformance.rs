//! Tiles pass the conformance suite, and the suite rejects them with each planted fault.

use assign::{
    AssignError, Assignment, Bounds, CullSettings, Frame, Gpu, LightBuffer, LightSource,
    SampleDomain, Storage, View,
    conformance::{self, faulty::Fault},
};
use assign_tiled::{TileDepths, Tiled};
use glam::Vec3;

fn tiled(
    depths: impl Into<TileDepths> + Copy,
    size: &str,
    settings: CullSettings,
) -> impl Fn(&Gpu) -> Result<Box<dyn Assignment>, AssignError> {
    move |gpu| Ok(Box::new(Tiled::new(gpu, size.parse()?, depths, settings)?))
}

fn conforms(depths: impl Into<TileDepths> + Copy, size: &str, settings: CullSettings) {
    let report = conformance::run(&tiled(depths, size, settings)).expect("conforms");
    println!("{report}");
}

#[test]
fn implicit_conforms() {
    conforms(Bounds::Implicit, "28x28", CullSettings::default());
    conforms(Bounds::Implicit, "13x9", CullSettings::default());
    conforms(Bounds::Implicit, "4096x4096", CullSettings::default());
}

#[test]
fn explicit_conforms() {
    conforms(Bounds::Explicit, "28x28", CullSettings::default());
    conforms(Bounds::Explicit, "13x9", CullSettings::default());
    conforms(Bounds::Explicit, "4096x4096", CullSettings::default());
}

#[test]
fn tiles_that_find_their_bounds_while_culling_conform() {
    for (size, source) in [("28x28", LightSource::Linear), ("13x9", LightSource::Hierarchy)] {
        let settings = CullSettings { source, ..CullSettings::default() };
        conforms(TileDepths::ExplicitAtOnce, size, settings);
    }
    let make = tiled(TileDepths::ExplicitAtOnce, "16x16", CullSettings::default());
    assert_eq!(conformance::rejects_faults(&make).expect("rejects"), Fault::all(false));
}

#[test]
fn halves_and_slices_conform() {
    for depths in [TileDepths::HalfZ, TileDepths::ModifiedHalfZ, TileDepths::Sliced] {
        conforms(depths, "28x28", CullSettings::default());
    }
    conforms(TileDepths::ModifiedHalfZ, "4096x4096", CullSettings::default());
    let source = LightSource::Hierarchy;
    let masks = CullSettings { source, storage: Storage::Masks, ..CullSettings::default() };
    conforms(TileDepths::ModifiedHalfZ, "13x9", masks);
    let tests = "sat-e+sat-v".parse().unwrap();
    conforms(TileDepths::Sliced, "13x9", CullSettings { tests, source, ..CullSettings::default() });
}

/// All kinds of tiles that the samples in them bound.
const EXPLICIT: [TileDepths; 5] = [
    TileDepths::Explicit,
    TileDepths::ExplicitAtOnce,
    TileDepths::HalfZ,
    TileDepths::ModifiedHalfZ,
    TileDepths::Sliced,
];

/// Tiles whose ranges begin at the near plane hold the lights of what lies in front of surfaces.
#[test]
fn explicit_tiles_conform_in_front_of_surfaces() {
    for depths in EXPLICIT {
        let make = tiled(depths, "16x16", CullSettings::default());
        conformance::run_in_front(&make).expect("conforms");
    }
}

/// Tiles whose depths are known before they are culled: all but T-E1.
const BEFORE_CULLING: [TileDepths; 5] = [
    TileDepths::Implicit,
    TileDepths::Explicit,
    TileDepths::HalfZ,
    TileDepths::ModifiedHalfZ,
    TileDepths::Sliced,
];

/// No buffer keeps the ranges of T-E1, so its look-ups cannot ask whether they hold a sample.
#[test]
fn look_ups_that_no_frame_stated_lose_no_light() {
    for depths in BEFORE_CULLING {
        let make = tiled(depths, "16x16", CullSettings::default());
        conformance::run_unstated(&make).expect("conforms");
    }
}

#[test]
fn other_unions_of_tests_conform() {
    for union in ["hs", "sat-n+sat-p", "hs+sat-e+sat-p+sat-v"] {
        let settings = CullSettings { tests: union.parse().unwrap(), ..CullSettings::default() };
        conforms(Bounds::Explicit, "28x28", settings);
    }
}

#[test]
fn both_conform_through_the_hierarchy() {
    let settings = CullSettings { source: LightSource::Hierarchy, ..CullSettings::default() };
    conforms(Bounds::Implicit, "28x28", settings);
    conforms(Bounds::Explicit, "28x28", settings);
}

/// All strategies walk through the hierarchy in the same way.
#[test]
fn a_hierarchy_of_three_levels_conforms_and_a_lost_box_is_rejected() {
    let settings = CullSettings { source: LightSource::Hierarchy, ..CullSettings::default() };
    let make = tiled(Bounds::Implicit, "16x16", settings);
    conformance::run_case("three-levels-of-nodes", &make).expect("conforms");
    conformance::rejects_fault(Fault::LostGrandparent, &make).expect("rejects");
}

#[test]
fn only_explicit_tiles_refuse_look_ups_at_any_depth() {
    let gpu = Gpu::open(None).unwrap();
    let lights = LightBuffer::new(&gpu, &[]).unwrap();
    let view = View::look_at(Vec3::ONE, Vec3::ZERO, 1.0, 0.1, [64, 48]);
    let frame = Frame::new(&view, &lights);
    let any = frame.sampled_at(SampleDomain::AnyDepth);
    let mut strategy = tiled(Bounds::Implicit, "28x28", CullSettings::default())(&gpu).unwrap();
    strategy.prepare(&gpu, &any).unwrap();
    strategy.prepare(&gpu, &frame.sampled_at(SampleDomain::InFront)).unwrap();
    let mut strategy = tiled(Bounds::Explicit, "28x28", CullSettings::default())(&gpu).unwrap();
    let refused = strategy.prepare(&gpu, &any).unwrap_err();
    assert!(matches!(refused, AssignError::Unsupported { .. }), "{refused}");
    let error = strategy.prepare(&gpu, &frame).unwrap_err().to_string();
    assert!(error.contains("needs depth"), "{error}");
}

/// A strategy that lists every light for every sample conforms too, so this test checks that lists are short.
#[test]
fn lists_are_short() {
    let listed_in = |case: &str, depths: TileDepths| {
        let make = tiled(depths, "16x16", CullSettings::default());
        let case = conformance::run_case(case, &make).expect("conforms");
        case.listed_per_sample().expect("passed")
    };
    let listed = |depths| listed_in("mixed-kinds", depths);
    let [implicit, explicit] = [TileDepths::Implicit, TileDepths::Explicit].map(listed);
    let [half, modified] = [TileDepths::HalfZ, TileDepths::ModifiedHalfZ].map(listed);
    // Only small lights fit between the surfaces of a tile.
    let [whole, sliced] = [TileDepths::Explicit, TileDepths::Sliced]
        .map(|depths| listed_in("depth-discontinuity", depths));
    println!("{whole:.1} and {sliced:.1} lights listed per sample");
    assert!(sliced < 0.8 * whole, "listed: {sliced} of {whole}");
    println!(
        "{implicit:.1}, {explicit:.1}, {half:.1} and {modified:.1} of 600 lights listed per sample"
    );
    assert!(modified < 0.98 * half && half < 0.9 * explicit, "listed: {half}, {modified}");
    assert!(
        implicit < 400.0 && explicit < 0.9 * implicit,
        "listed per sample: T-I {implicit}, T-E {explicit}"
    );
}

#[test]
fn faults_are_rejected() {
    for depths in BEFORE_CULLING {
        let make = tiled(depths, "16x16", CullSettings::default());
        assert_eq!(conformance::rejects_faults(&make).expect("rejects"), Fault::all(false));
    }
}

#[test]
fn tiles_without_surfaces_read_all_lights() {
    let gpu = Gpu::open(None).unwrap();
    let view = View::look_at(Vec3::ONE, Vec3::ZERO, 1.0, 0.1, [64, 48]);
    let light = assign::Light::point(Vec3::ZERO, 50.0, Vec3::ONE);
    let lights = LightBuffer::new(&gpu, &[light; 3]).unwrap();
    for depths in EXPLICIT {
        let mut strategy = tiled(depths, "16x16", CullSettings::default())(&gpu).unwrap();
        for (depth, occupied) in [(0.05, 12), (view.depth_clear(), 0), (0.05, 12)] {
            let depth = conformance::flat_depth(&gpu, [64, 48], depth);
            let frame = Frame::new(&view, &lights).with_depth(&depth);
            strategy.prepare(&gpu, &frame).unwrap();
            let mut encoder = gpu.device.create_command_encoder(&Default::default());
            strategy.record(&frame, &mut assign::EncoderPasses { encoder: &mut encoder });
            gpu.queue.submit([encoder.finish()]);
            let lists = strategy.lists().snapshot(&gpu).unwrap();
            let groups = strategy.lists().group_count();
            assert!((0..groups).all(|group| lists.list(group).unwrap().count == 3), "{lists:?}");
            // The far halves of flat tiles hold no sample.
            let read_all = (0..groups).filter(|group| lists.is_all_lights(*group)).count() as u32;
            assert_eq!(groups - read_all, occupied, "{depths:?}");
            assert_eq!(lists.counters.occupied_groups, occupied, "{depths:?}");
        }
    }
}
