//! DC-I, DC-E, SC-I, SC-E, DA-I and DA-E pass the conformance suite, and the suite rejects them with each planted fault.

#![allow(clippy::unwrap_used, reason = "a helper of a test may fail it")]

use assign::{
    AssignError, Assignment, Bounds, CullSettings, Gpu, LightSource,
    conformance::{self, faulty::Fault},
};
use assign_clustered::{ClusterOptions, Clustered, Normals, Occupancy, Slices};

const DC_I: (Bounds, Occupancy) = (Bounds::Implicit, Occupancy::Dense);
const DC_E: (Bounds, Occupancy) = (Bounds::Explicit, Occupancy::Dense);
const SC_I: (Bounds, Occupancy) = (Bounds::Implicit, Occupancy::Sparse);
const SC_E: (Bounds, Occupancy) = (Bounds::Explicit, Occupancy::Sparse);
const DA_I: (Bounds, Occupancy) = (Bounds::Implicit, Occupancy::DepthAware);
const DA_E: (Bounds, Occupancy) = (Bounds::Explicit, Occupancy::DepthAware);

fn clustered(
    (bounds, occupancy): (Bounds, Occupancy),
    size: &str,
    settings: CullSettings,
) -> impl Fn(&Gpu) -> Result<Box<dyn Assignment>, AssignError> {
    move |gpu| Ok(Box::new(Clustered::new(gpu, size.parse()?, bounds, occupancy, settings)?))
}

fn conforms(variant: (Bounds, Occupancy), size: &str, settings: CullSettings) {
    let report = conformance::run(&clustered(variant, size, settings)).expect("conforms");
    println!("{report}");
}

fn tests(union: &str) -> CullSettings {
    CullSettings { tests: union.parse().unwrap(), ..CullSettings::default() }
}

fn through_hierarchy() -> CullSettings {
    CullSettings { source: LightSource::Hierarchy, ..CullSettings::default() }
}

#[test]
fn dense_implicit_conforms() {
    conforms(DC_I, "32x32x8", CullSettings::default());
    conforms(DC_I, "13x9x5", CullSettings::default());
    conforms(DC_I, "4096x4096x1", CullSettings::default());
}

#[test]
fn dense_implicit_conforms_with_other_unions_of_tests() {
    conforms(DC_I, "32x32x8", tests("hs"));
    conforms(DC_I, "32x32x8", tests("sat-e+sat-n+sat-p"));
    conforms(DC_I, "32x32x8", tests("hs+sat-e+sat-p+sat-v"));
}

#[test]
fn dense_explicit_conforms() {
    conforms(DC_E, "32x32x8", CullSettings::default());
    conforms(DC_E, "13x9x40", CullSettings::default());
}

#[test]
fn sparse_implicit_conforms() {
    conforms(SC_I, "32x32x8", CullSettings::default());
    conforms(SC_I, "13x9x40", CullSettings::default());
}

#[test]
fn sparse_explicit_conforms() {
    conforms(SC_E, "32x32x8", CullSettings::default());
    conforms(SC_E, "13x9x40", CullSettings::default());
    conforms(SC_E, "3x3x200", CullSettings::default());
}

#[test]
fn depth_aware_clusters_conform() {
    conforms(DA_I, "32x32x8", CullSettings::default());
    conforms(DA_E, "32x32x8", CullSettings::default());
    conforms(DA_E, "13x9x40", CullSettings::default());
    conforms(DA_E, "1024x1024x128", CullSettings::default());
    conforms(DA_E, "3x3x128", CullSettings::default());
}

#[test]
fn depth_aware_clusters_refuse_what_a_workgroup_cannot_hold() {
    let gpu = Gpu::noop().unwrap();
    for (size, said) in [
        ("1025x8x8", "froxel tile size is 1025: it must be 1 to 1024 pixels"),
        ("8x8x129", "froxel slice count is 129: it must be 1 to 128"),
    ] {
        for variant in [DA_I, DA_E] {
            let error = clustered(variant, size, CullSettings::default())(&gpu).err().unwrap();
            assert!(error.to_string().contains(said), "{error}");
        }
    }
}

#[test]
fn other_slices_conform() {
    for (variant, slices) in [
        (DC_I, Slices::Even),
        (DC_I, Slices::Near(2.0)),
        (SC_E, Slices::Near(0.5)),
        (SC_E, Slices::Even),
        (DA_E, Slices::Near(0.5)),
        (DC_I, Slices::Cascaded(3)),
        (DC_E, Slices::Cascaded(2)),
        (SC_I, Slices::Cascaded(4)),
        (SC_E, Slices::Cascaded(3)),
    ] {
        let (bounds, occupancy) = variant;
        let make = move |gpu: &Gpu| -> Result<Box<dyn Assignment>, AssignError> {
            let (size, settings) = ("16x16x8".parse()?, CullSettings::default());
            let plain = ClusterOptions::new(size, bounds, occupancy, settings);
            Ok(Box::new(Clustered::with_options(gpu, ClusterOptions { slices, ..plain })?))
        };
        conformance::run(&make).expect("conforms");
    }
}

#[test]
fn cascades_of_odd_tiles_conform_and_their_faults_are_rejected() {
    let cascaded = |variant: (Bounds, Occupancy), size: &'static str, count| {
        let (bounds, occupancy) = variant;
        move |gpu: &Gpu| -> Result<Box<dyn Assignment>, AssignError> {
            let settings = CullSettings::default();
            let plain = ClusterOptions::new(size.parse()?, bounds, occupancy, settings);
            let slices = Slices::Cascaded(count);
            Ok(Box::new(Clustered::with_options(gpu, ClusterOptions { slices, ..plain })?))
        }
    };
    conformance::run(&cascaded(DC_I, "7x5x11", 4)).expect("conforms");
    conformance::run(&cascaded(SC_E, "7x5x11", 2)).expect("conforms");
    let make = cascaded(SC_I, "16x16x8", 2);
    assert_eq!(conformance::rejects_faults(&make).expect("rejects"), Fault::all(false));
    // Near clusters are joined, so there are fewer, and lists are longer.
    let listed = |count| {
        let make = cascaded(DC_I, "16x16x16", count);
        conformance::run_case("mixed-kinds", &make).expect("conforms").listed_per_sample().unwrap()
    };
    let (two, four) = (listed(2), listed(4));
    assert!(two < four, "{two}, {four}");
    let gpu = Gpu::noop().unwrap();
    for (variant, size, count, said) in [
        (DC_I, "8x8x8", 1, "number of cascades is 1, of 8 slices: it must be 2 to 4"),
        (DC_I, "8x8x8", 5, "number of cascades is 5"),
        (DC_I, "8x8x2", 3, "number of cascades is 3, of 2 slices"),
        (DA_E, "8x8x8", 2, "cascades join tiles"),
    ] {
        let error = cascaded(variant, size, count)(&gpu).err().unwrap().to_string();
        assert!(error.contains(said), "{error}");
    }
}

#[test]
fn one_sparse_cluster_conforms() {
    for variant in [SC_I, SC_E] {
        let make = clustered(variant, "4096x4096x1", CullSettings::default());
        conformance::run_case("33-lights", &make).expect("conforms");
    }
}

fn split(
    size: &str,
    bins: u32,
    settings: CullSettings,
) -> impl Fn(&Gpu) -> Result<Box<dyn Assignment>, AssignError> {
    move |gpu| {
        let (size, normals) = (size.parse()?, Normals::Bins(bins));
        let (bounds, occupancy) = SC_E;
        let plain = ClusterOptions::new(size, bounds, occupancy, settings);
        Ok(Box::new(Clustered::with_options(gpu, ClusterOptions { normals, ..plain })?))
    }
}

#[test]
fn clusters_split_by_normals_conform() {
    for bins in [1, 6, 54] {
        let strategy = split("48x48x40", bins, CullSettings::default());
        println!("{}", conformance::run(&strategy).expect("conforms"));
    }
}

#[test]
fn clusters_split_by_normals_conform_through_the_hierarchy() {
    conformance::run(&split("16x16x8", 24, through_hierarchy())).expect("conforms");
}

#[test]
fn only_sparse_explicit_clusters_can_be_split() {
    let gpu = Gpu::noop().unwrap();
    for (bounds, occupancy) in [DC_I, DC_E, SC_I, SC_E, DA_I, DA_E] {
        let size = "32x32x8".parse().unwrap();
        let make = |bins| {
            let settings = CullSettings::default();
            let plain = ClusterOptions::new(size, bounds, occupancy, settings);
            Clustered::with_options(&gpu, ClusterOptions { normals: Normals::Bins(bins), ..plain })
        };
        if (bounds, occupancy) == SC_E {
            assert_eq!(make(6).unwrap().id(), "SC-E/32x32x8/n6");
            let error = make(7).unwrap_err().to_string();
            assert!(error.contains("1, 6, 24 or 54"), "{error}");
        } else {
            let error = make(6).unwrap_err().to_string();
            assert!(error.contains("only sparse clusters with explicit bounds"), "{error}");
        }
    }
}

#[test]
fn all_conform_through_the_hierarchy() {
    for variant in [DC_I, DC_E, SC_I, SC_E, DA_I, DA_E] {
        conforms(variant, "48x48x16", through_hierarchy());
    }
}

#[test]
fn only_dense_implicit_clusters_serve_look_ups_at_any_depth() {
    for (variant, served) in
        [(DC_I, true), (DC_E, false), (SC_I, false), (SC_E, false), (DA_E, false)]
    {
        let gpu = Gpu::open(None).unwrap();
        let mut strategy = clustered(variant, "32x32x8", CullSettings::default())(&gpu).unwrap();
        let lights = assign::LightBuffer::new(&gpu, &[]).unwrap();
        let view = assign::View::look_at(glam::Vec3::ONE, glam::Vec3::ZERO, 1.0, 0.1, [64, 48]);
        let frame = assign::Frame::new(&view, &lights);
        let any = frame.sampled_at(assign::SampleDomain::AnyDepth);
        match strategy.prepare(&gpu, &any) {
            Ok(()) => assert!(served),
            Err(error) => {
                assert!(!served && matches!(error, AssignError::Unsupported { .. }), "{error}");
                // Without a depth buffer it refuses too.
                let error = strategy.prepare(&gpu, &frame).unwrap_err().to_string();
                assert!(error.contains("needs depth"), "{error}");
            }
        }
    }
}

/// A strategy that lists every light for every sample conforms too, so this test checks that lists are short.
#[test]
fn lists_are_short() {
    let listed = |variant| {
        let make = clustered(variant, "16x16x16", CullSettings::default());
        let case = conformance::run_case("mixed-kinds", &make).expect("conforms");
        case.listed_per_sample().expect("passed")
    };
    let [dense, dense_boxes, sparse, sparse_boxes] = [DC_I, DC_E, SC_I, SC_E].map(listed);
    let [aware, aware_boxes] = [DA_I, DA_E].map(listed);
    println!(
        "{dense:.1}, {dense_boxes:.1}, {sparse:.1} and {sparse_boxes:.1} of 600 lights per sample"
    );
    // Dense and sparse clusters with the same bounds list the same lights.
    assert!((dense_boxes / sparse_boxes - 1.0).abs() < 1e-9, "{dense_boxes}, {sparse_boxes}");
    assert!((aware_boxes / sparse_boxes - 1.0).abs() < 1e-9, "{aware_boxes}, {sparse_boxes}");
    assert!((aware / sparse - 1.0).abs() < 1e-9, "{aware}, {sparse}");
    assert!(sparse < 250.0 && sparse_boxes < 0.95 * sparse, "{sparse}, {sparse_boxes}");
}

#[test]
fn faults_are_rejected() {
    for variant in [DC_I, DC_E, SC_I, SC_E, DA_I, DA_E] {
        let make = clustered(variant, "16x16x8", CullSettings::default());
        assert_eq!(conformance::rejects_faults(&make).expect("rejects"), Fault::all(false));
    }
    for bins in [1, 6] {
        let make = split("16x16x8", bins, CullSettings::default());
        assert_eq!(conformance::rejects_faults(&make).expect("rejects"), Fault::all(true));
    }
}

/// Small groups show an emitter that is a little too small.
#[test]
fn tight_emitters_are_rejected() {
    let make = clustered(SC_E, "2x2x128", CullSettings::default());
    conformance::run_case("area-lights-grazing", &make).expect("conforms");
    conformance::rejects_fault(Fault::TightEmitter, &make).expect("rejects");
}

/// Counters are those of the frame, whether earlier frames held nothing or everything.
#[test]
fn counters_restart_even_if_nothing_is_in_view() {
    let gpu = Gpu::open(None).unwrap();
    let view = assign::View::look_at(glam::Vec3::ONE, glam::Vec3::ZERO, 1.0, 0.1, [64, 48]);
    let light = assign::Light::point(glam::Vec3::ZERO, 50.0, glam::Vec3::ONE);
    let lights = assign::LightBuffer::new(&gpu, &[light; 3]).unwrap();
    let [wall, nothing] =
        [0.05, view.depth_clear()].map(|depth| conformance::flat_depth(&gpu, [64, 48], depth));
    for variant in [DC_E, SC_I, SC_E, DA_I, DA_E] {
        let mut strategy = clustered(variant, "16x16x8", CullSettings::default())(&gpu).unwrap();
        let mut draw = |depth: &wgpu::TextureView| {
            let frame = assign::Frame::new(&view, &lights).with_depth(depth);
            strategy.prepare(&gpu, &frame).unwrap();
            let mut encoder = gpu.device.create_command_encoder(&Default::default());
            strategy.record(&frame, &mut assign::EncoderPasses { encoder: &mut encoder });
            gpu.queue.submit([encoder.finish()]);
            strategy.lists().snapshot(&gpu).unwrap().counters
        };
        let walls = [&wall, &wall, &wall].map(&mut draw);
        assert_eq!(walls[0].occupied_groups, 12, "{variant:?}: one slice of 4 x 3 tiles");
        assert!(walls.iter().all(|counters| *counters == walls[0]), "{variant:?}: {walls:?}");
        for _ in 0..3 {
            assert_eq!(draw(&nothing), assign::Counters::default(), "{variant:?}");
        }
        assert_eq!(draw(&wall), walls[0], "{variant:?}");
    }
}
