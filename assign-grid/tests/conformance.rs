//! G keeps the contract, and the suite would notice if it did not.

use assign::{
    AssignError, Assignment, CullSettings, Gpu, LightSource,
    conformance::{self, faulty::Fault},
};
use assign_grid::{Grid, GridBox};

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
fn cells_of_the_lights_box_conform() {
    conforms("12x7x9", GridBox::Lights, CullSettings::default());
    conforms("23x1x5", GridBox::Lights, CullSettings::default());
    conforms("1x1x1", GridBox::Lights, CullSettings::default());
}

#[test]
fn cells_of_the_surfaces_box_conform() {
    conforms("8x8x8", GridBox::Surfaces, CullSettings::default());
}

#[test]
fn all_conform_through_the_hierarchy() {
    let settings = CullSettings { source: LightSource::Hierarchy, ..CullSettings::default() };
    conforms("8x8x8", GridBox::Lights, settings);
}

#[test]
fn faults_are_rejected() {
    let make = grid("8x8x8", GridBox::Lights, CullSettings::default());
    assert_eq!(conformance::rejects_faults(&make).expect("rejects"), Fault::ALL);
}
