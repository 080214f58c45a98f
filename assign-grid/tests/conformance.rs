//! G keeps the contract's promises, and the suite rejects it with planted faults.

use assign::{
    AssignError, Assignment, CullSettings, Frame, Gpu, Light, LightBuffer, LightSource, Reuse,
    View,
    conformance::{self, faulty::Fault},
};
use assign_grid::{Grid, GridBox, HashedCells};
use glam::Vec3;

fn grid(
    counts: &str,
    grid_box: GridBox,
    settings: CullSettings,
) -> impl Fn(&Gpu) -> Result<Box<dyn Assignment>, AssignError> {
    move |gpu| Ok(Box::new(Grid::new(gpu, counts.parse()?, grid_box, settings)?))
}

fn conforms(counts: &str, grid_box: GridBox, settings: CullSettings) {
    let report = conformance::run(&grid(counts, grid_box, settings)).expect("conforms");
    println!("{report}");
}

#[test]
fn cells_of_the_positions_box_conform() {
    conforms("12x7x9", GridBox::Positions, CullSettings::default());
    conforms("23x1x5", GridBox::Positions, CullSettings::default());
    conforms("1x1x1", GridBox::Positions, CullSettings::default());
}

#[test]
fn cells_of_the_supports_box_conform() {
    conforms("12x7x9", GridBox::Supports, CullSettings::default());
}

#[test]
fn cells_of_the_surfaces_box_conform() {
    conforms("8x8x8", GridBox::Surfaces, CullSettings::default());
    conforms("3x17x2", GridBox::Surfaces, CullSettings::default());
}

#[test]
fn all_conform_through_the_hierarchy() {
    let settings = CullSettings { source: LightSource::Hierarchy, ..CullSettings::default() };
    conforms("8x8x8", GridBox::Positions, settings);
    conforms("8x8x8", GridBox::Surfaces, settings);
}

#[test]
fn look_ups_that_no_frame_stated_lose_no_light() {
    let visible = grid("8x8x8", GridBox::Visible, CullSettings::default());
    conformance::run_unstated(&visible).expect("conforms");
    let hashed = |gpu: &Gpu| -> Result<Box<dyn Assignment>, AssignError> {
        Ok(Box::new(HashedCells::new(gpu, 16, CullSettings::default())?))
    };
    conformance::run_unstated(&hashed).expect("conforms");
}

/// A grid that reuses its lists for some frames.
fn reused(frames: u32) -> impl Fn(&Gpu) -> Result<Box<dyn Assignment>, AssignError> {
    let make = grid("8x8x8", GridBox::Surfaces, CullSettings::default());
    move |gpu| Ok(Box::new(Reuse::new(make(gpu)?, frames)?))
}

#[test]
fn lists_of_one_frame_conform_and_kept_ones_miss_lights_that_move() {
    conformance::run(&reused(1)).expect("conforms");
    for case in ["33-lights", "overflow", "light-at-tile-corner"] {
        conformance::run_case(case, &reused(3)).expect(case);
    }
    let error = conformance::run_case("lights-move", &reused(3)).expect_err("stale lists");
    assert!(error.to_string().contains("missed pair"), "{error}");
    let gpu = Gpu::open(None).unwrap();
    assert!(Reuse::new(reused(1)(&gpu).unwrap(), 0).is_err());
    assert_eq!(reused(4)(&gpu).unwrap().id(), "G/8x8x8/surfaces/reuse4");
}

#[test]
fn boxes_of_surfaces_are_checked() {
    let gpu = Gpu::open(None).unwrap();
    let lights = LightBuffer::new(&gpu, &[Light::point(Vec3::ZERO, 2.0, Vec3::ONE)]).unwrap();
    let view = View::look_at(Vec3::ONE, Vec3::ZERO, 1.0, 0.1, [64, 48]);
    let frame = Frame::new(&view, &lights);
    let mut of_lights = grid("8x8x8", GridBox::Positions, CullSettings::default())(&gpu).unwrap();
    of_lights.prepare(&gpu, &frame).unwrap();
    let mut strategy = grid("8x8x8", GridBox::Surfaces, CullSettings::default())(&gpu).unwrap();
    assert_eq!(strategy.id(), "G/8x8x8/surfaces");
    let error = strategy.prepare(&gpu, &frame).unwrap_err().to_string();
    assert!(error.contains("needs surface_bounds"), "{error}");
    let nowhere = frame.with_surface_bounds(Vec3::NAN, Vec3::ONE);
    let error = strategy.prepare(&gpu, &nowhere).unwrap_err().to_string();
    assert!(error.contains("surface_bounds is"), "{error}");
    // Boxes apart from the lights, inside out, and infinite: any cells are right.
    for (min, max) in [
        (Vec3::splat(50.0), Vec3::splat(60.0)),
        (Vec3::INFINITY, Vec3::NEG_INFINITY),
        (Vec3::NEG_INFINITY, Vec3::INFINITY),
    ] {
        strategy.prepare(&gpu, &frame.with_surface_bounds(min, max)).unwrap();
    }
}

/// A strategy that lists every light for every sample would conform, so this test checks that lists
/// are short.
#[test]
fn lists_are_short() {
    let listed = |counts| {
        let make = grid(counts, GridBox::Positions, CullSettings::default());
        let case = conformance::run_case("mixed-kinds", &make).expect("conforms");
        case.listed_per_sample().expect("passed")
    };
    let (one, many) = (listed("1x1x1"), listed("16x16x16"));
    println!("{one:.1} in one cell, {many:.1} in many, of 600 lights");
    assert!(
        many < 300.0 && many < 0.6 * one,
        "lights per sample: {one} in one cell, {many} in many"
    );
}

#[test]
fn faults_are_rejected() {
    let make = grid("8x8x8", GridBox::Positions, CullSettings::default());
    assert_eq!(conformance::rejects_faults(&make).expect("rejects"), Fault::all(false));
}
