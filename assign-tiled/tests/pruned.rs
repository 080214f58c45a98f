//! Tiles whose lists are pruned while they are read have shorter lists that still hold every light, and the suite
//! rejects them with each planted fault.

use assign::{
    AssignError, Assignment, BOUNDS_BOX_WESL, Bounds, CullSettings, Gpu, Keep, LightReader,
    LightSource, Storage, StrategyWesl, Touched,
    conformance::{self, Breach, Reworded, faulty::Fault, reword},
};
use assign_tiled::Tiled;

fn tiles(
    bounds: Bounds,
    source: LightSource,
    storage: Storage,
) -> impl Fn(&Gpu) -> Result<Box<dyn Assignment>, AssignError> {
    let settings = CullSettings { source, storage, ..CullSettings::default() };
    move |gpu| Ok(Box::new(Tiled::new(gpu, "28x28".parse()?, bounds, settings)?))
}

fn pruned(
    bounds: Bounds,
    source: LightSource,
) -> impl Fn(&Gpu) -> Result<Box<dyn Assignment>, AssignError> {
    tiles(bounds, source, Storage::PrunedLists)
}

#[test]
fn pruned_lists_conform() {
    // llvmpipe cannot read so many lights: see `LightReader::check_lights`.
    let may_refuse = &["65537-lights"];
    for (bounds, source) in
        [(Bounds::Implicit, LightSource::Linear), (Bounds::Explicit, LightSource::Hierarchy)]
    {
        conformance::run_allowing(&pruned(bounds, source), may_refuse).expect("conforms");
    }
}

#[test]
fn planted_faults_are_rejected() {
    let make = pruned(Bounds::Implicit, LightSource::Linear);
    let planted = conformance::rejects_faults(&make).expect("rejects");
    assert_eq!(planted, Fault::all(false));
}

#[test]
fn kept_and_touched_lists_are_pruned() {
    let make = pruned(Bounds::Explicit, LightSource::Hierarchy);
    let touched = |gpu: &Gpu| -> Result<Box<dyn Assignment>, AssignError> {
        Ok(Box::new(Touched::new(gpu, make(gpu)?)?))
    };
    let kept = |gpu: &Gpu| -> Result<Box<dyn Assignment>, AssignError> {
        Ok(Box::new(Keep::new(gpu, make(gpu)?, 3)?))
    };
    for case in ["33-lights", "light-count-changes", "gpu-order-some-move", "lights-from-gpu"] {
        conformance::run_case(case, &touched).expect(case);
        conformance::run_case(case, &kept).expect(case);
    }
}

/// The look-up that prunes.
const LOOK_UP: &str = include_str!("../../assign/src/shaders/look_up_walk.wesl");

#[test]
fn faults_of_the_look_up_are_rejected() {
    use Breach::MissedPair;
    // Lanes of another list take what was found for this one.
    let mixed = ["if !is_member {", "if items.next == items.end {"];
    // The box is that of one lane, on the path of lanes that are not side by side too.
    let small = ["box_of(GroupBounds(low, high))", "box_of(GroupBounds(position, position))"];
    // What misses one lane's turn counts for its neighbour.
    let shifted = ["1u << rank, is_miss", "2u << rank, is_miss"];
    for (part, case, breach) in [
        (mixed, "33-lights", MissedPair),
        (small, "33-lights", MissedPair),
        (shifted, "5000-lights", MissedPair),
    ] {
        let look_up = reword(LOOK_UP, part[0], part[1]);
        let make = |gpu: &Gpu| -> Result<Box<dyn Assignment>, AssignError> {
            let other = |wesl| StrategyWesl {
                reader: LightReader::Own(look_up),
                imports: &[("package::lane_bounds", BOUNDS_BOX_WESL)],
                flags: FLAGS,
                ..wesl
            };
            let inner = pruned(Bounds::Implicit, LightSource::Linear);
            Ok(Box::new(Reworded::new(inner(gpu)?, other)))
        };
        conformance::rejects_in(&format!("{part:?}"), case, breach, &make).expect("rejects");
    }
}

/// The flags of implicit tiles and of a look-up that prunes.
const FLAGS: &[(&str, bool)] = &[
    ("explicit_bounds", false),
    ("one_pass", false),
    ("halves", false),
    ("sliced", false),
    ("lane_bounds", true),
    ("subgroups", true),
    ("walk_nodes", false),
    ("listed", true),
];

#[test]
fn pruned_lists_are_shorter() {
    let listed = |storage| {
        let make = tiles(Bounds::Implicit, LightSource::Linear, storage);
        let report = conformance::run_case("depth-discontinuity", &make).expect("conforms");
        report.listed_per_sample().expect("passed")
    };
    let [whole, pruned] = [Storage::Lists, Storage::PrunedLists].map(listed);
    println!("{whole} lights per sample, pruned {pruned}");
    assert!(pruned < 0.6 * whole, "{pruned} of {whole}");
}
