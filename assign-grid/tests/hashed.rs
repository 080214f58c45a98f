//! HC keeps the contract's promises, and the suite rejects it with planted faults.

#![allow(clippy::unwrap_used, reason = "a helper of a test may fail it")]

mod first_view;

use assign::{
    AssignError, Assignment, CullSettings, EncoderPasses, Frame, Gpu, Keep, Light, LightBuffer,
    LightSource, SampleDomain, Storage, StrategyWesl, Touched, View,
    conformance::{
        self, Breach, ConformanceError, Outcome, Reworded, faulty::Fault, flat_depth, reword,
    },
};
use assign_grid::{HashedCells, TableUse};
use first_view::FirstView;
use glam::Vec3;

fn hashed(
    cell_px: u32,
    source: LightSource,
) -> impl Fn(&Gpu) -> Result<Box<dyn Assignment>, AssignError> {
    let settings = CullSettings { source, ..CullSettings::default() };
    move |gpu| Ok(Box::new(HashedCells::new(gpu, cell_px, settings)?))
}

#[test]
fn hashed_cells_conform() {
    conformance::run(&hashed(8, LightSource::Linear)).expect("conforms");
    conformance::run(&hashed(24, LightSource::Hierarchy)).expect("conforms");
}

/// Cells so small that their keys or the precision of positions bound them, and one cell for all.
#[test]
fn the_smallest_and_the_largest_cells_conform() {
    for cell_px in [1, 16_384] {
        for case in ["33-lights", "far-from-origin", "orthographic-reversed", "thin-near-slices"] {
            conformance::run_case(case, &hashed(cell_px, LightSource::Linear)).expect(case);
        }
    }
}

#[test]
fn masks_conform() {
    let settings = CullSettings { storage: Storage::Masks, ..CullSettings::default() };
    let make = |gpu: &Gpu| -> Result<Box<dyn Assignment>, AssignError> {
        Ok(Box::new(HashedCells::new(gpu, 8, settings)?))
    };
    for case in ["33-lights", "5000-lights", "resize"] {
        conformance::run_case(case, &make).expect(case);
    }
}

#[test]
fn kept_and_touched_lists_conform() {
    let make = hashed(8, LightSource::Linear);
    let kept = |gpu: &Gpu| -> Result<Box<dyn Assignment>, AssignError> {
        Ok(Box::new(Keep::new(gpu, make(gpu)?, 3)?))
    };
    let touched = |gpu: &Gpu| -> Result<Box<dyn Assignment>, AssignError> {
        Ok(Box::new(Touched::new(gpu, make(gpu)?)?))
    };
    for case in ["33-lights", "lights-move", "camera-teleports", "gpu-order-some-move"] {
        conformance::run_case(case, &kept).expect(case);
        conformance::run_case(case, &touched).expect(case);
    }
}

#[test]
fn planted_faults_are_rejected() {
    let make = hashed(8, LightSource::Linear);
    for fault in Fault::all(false) {
        conformance::rejects_fault(fault, &make).unwrap_or_else(|error| panic!("{error}"));
    }
}

/// A table that was filled for another view serves its own cells, and no others.
#[test]
fn a_table_of_another_view_loses_no_light() {
    let first_view = |gpu: &Gpu| -> Result<Box<dyn Assignment>, AssignError> {
        Ok(Box::new(FirstView::new(hashed(8, LightSource::Linear)(gpu)?)))
    };
    conformance::run_case("camera-teleports", &first_view).expect("conforms");
}

#[test]
fn faults_of_the_look_up_are_rejected() {
    let rejects = |what: &str, part: &str, other: &str| {
        let reworded = |wesl: StrategyWesl<'static>| StrategyWesl {
            main: reword(wesl.main, part, other),
            ..wesl
        };
        let make = |gpu: &Gpu| -> Result<Box<dyn Assignment>, AssignError> {
            Ok(Box::new(Reworded::new(hashed(8, LightSource::Linear)(gpu)?, reworded)))
        };
        conformance::rejects_in(what, "5000-lights", Breach::MissedPair, &make).expect("rejects");
    };
    rejects("two cells share a slot", "if seen == key {", "if seen != NO_CELL {");
    rejects(
        "the cell beside",
        "key_of_cell(cells, sample.position_world, level)",
        "key_of_cell(cells, sample.position_world + edge_of_level(cells, level), level)",
    );
}

/// A strategy that reads all lights for every sample would conform, so this test checks that lists are short.
#[test]
fn lists_are_short() {
    let listed = |cell_px| {
        let make = hashed(cell_px, LightSource::Linear);
        let case = conformance::run_case("opaque-surfaces-only", &make).expect("conforms");
        case.listed_per_sample().expect("passed")
    };
    let [small, middle, large] = [4, 16, 4096].map(listed);
    println!("{small:.1}, {middle:.1} and {large:.1} of 300 lights per sample");
    assert!(small < middle && middle < 0.7 * large, "{small}, {middle}, {large}");
}

/// A table that is too small loses no light: some samples read all lights. Which ones depends on the order in
/// which cells come, so lists may differ from frame to frame.
#[test]
fn a_full_table_loses_no_light() {
    let make = |gpu: &Gpu| -> Result<Box<dyn Assignment>, AssignError> {
        let mut cells = HashedCells::new(gpu, 8, CullSettings::default())?;
        cells.limit_table(16);
        Ok(Box::new(cells))
    };
    let violations = match conformance::run_case("opaque-surfaces-only", &make) {
        Ok(_) => Vec::new(),
        Err(ConformanceError::Rejected(report)) => {
            match report.cases.into_iter().next().unwrap().outcome {
                Outcome::Failed(violations) => violations,
                outcome => panic!("{outcome:?}"),
            }
        }
        Err(error) => panic!("{error}"),
    };
    let is_allowed = |breach| matches!(breach, Breach::Unstable | Breach::Counters);
    assert!(violations.iter().all(|violation| is_allowed(violation.breach)), "{violations:?}");
}

/// Draws a wall `wall_m` metres before the eye, and returns how full the table was.
fn table_use(gpu: &Gpu, cells: &mut HashedCells, wall_m: f32) -> TableUse {
    let view = View::look_at(Vec3::ZERO, Vec3::NEG_Z, 1.0, 0.125, [256, 192]);
    let light = Light::point(Vec3::new(0.0, 0.0, -4.0), 50.0, Vec3::ONE);
    let lights = LightBuffer::new(gpu, &[light; 3]).unwrap();
    let depth = flat_depth(gpu, [256, 192], 0.125 / wall_m);
    let frame = Frame::new(&view, &lights).with_depth(&depth);
    for _ in 0..2 {
        cells.prepare(gpu, &frame).unwrap();
        let mut encoder = gpu.device.create_command_encoder(&Default::default());
        cells.record(&frame, &mut EncoderPasses { encoder: &mut encoder });
        gpu.queue.submit([encoder.finish()]);
        gpu.wait().unwrap();
    }
    // The counters of the last frame arrive.
    for _ in 0..2 {
        cells.prepare(gpu, &frame).unwrap();
        gpu.wait().unwrap();
    }
    let counters = cells.lists().snapshot(gpu).unwrap().counters;
    let table_use = cells.table_use().unwrap();
    assert_eq!(counters.occupied_groups, table_use.filled, "a list for each cell");
    table_use
}

#[test]
fn samples_at_a_border_have_the_cells_on_both_sides() {
    let gpu = Gpu::open(None).unwrap();
    let mut cells = HashedCells::new(&gpu, 24, CullSettings::default()).unwrap();
    let inside = table_use(&gpu, &mut cells, 4.01);
    let between = table_use(&gpu, &mut cells, 4.0);
    assert!(between.filled > 3 * inside.filled / 2, "{inside:?} inside cells, {between:?} between");
    assert_eq!((inside.lost, between.lost), (0, 0));
}

#[test]
fn cells_without_a_slot_are_counted() {
    let gpu = Gpu::open(None).unwrap();
    let mut cells = HashedCells::new(&gpu, 8, CullSettings::default()).unwrap();
    cells.limit_table(9);
    let full = table_use(&gpu, &mut cells, 4.01);
    assert_eq!((full.slots, full.filled), (16, 16), "{full:?}");
    assert!(full.lost > 0, "{full:?}");
    cells.limit_table(u32::MAX);
    let large = table_use(&gpu, &mut cells, 4.01);
    assert!(large.lost == 0 && large.filled > 16, "{large:?}");
}

#[test]
fn frames_and_parameters_are_checked() {
    let gpu = Gpu::open(None).unwrap();
    for bad in [0, 16_385] {
        let error = HashedCells::new(&gpu, bad, CullSettings::default()).unwrap_err().to_string();
        assert!(error.contains("cell edge is") && error.contains("1 to 16384 pixels"), "{error}");
    }
    let mut cells = hashed(48, LightSource::Hierarchy)(&gpu).unwrap();
    assert_eq!(cells.id(), "HC/48/bvh");
    assert!(cells.needs().depth && cells.needs().hierarchy && cells.is_view_bound());
    let lights = LightBuffer::new(&gpu, &[]).unwrap();
    let view = View::look_at(Vec3::ONE, Vec3::ZERO, 1.0, 0.1, [64, 48]);
    let frame = Frame::new(&view, &lights);
    let error = cells.prepare(&gpu, &frame).unwrap_err().to_string();
    assert!(error.contains("needs depth"), "{error}");
    let error = cells.prepare(&gpu, &frame.sampled_at(SampleDomain::AnyDepth)).unwrap_err();
    assert!(matches!(error, AssignError::Unsupported { .. }), "{error}");
}
