//! ZB passes the conformance suite, and the suite rejects it with each planted fault.

use assign::{
    AssignError, Assignment, CullSettings, Gpu, Keep, LightKinds, LightReader, LightSource, Shader,
    StrategyWesl, Touched,
    conformance::{self, Breach, LinkedModule, Reworded, faulty::Fault, reword},
};
use assign_clustered::{Z_BINS_WESL, ZBins};

fn z_bins(
    size: &str,
    source: LightSource,
) -> impl Fn(&Gpu) -> Result<Box<dyn Assignment>, AssignError> {
    let settings = CullSettings { source, ..CullSettings::default() };
    move |gpu| Ok(Box::new(ZBins::new(gpu, size.parse()?, settings)?))
}

#[test]
fn z_bins_conform() {
    conformance::run(&z_bins("16x16x24", LightSource::Linear)).expect("conforms");
    conformance::run(&z_bins("13x9x7", LightSource::Hierarchy)).expect("conforms");
}

#[test]
fn kept_and_touched_masks_conform() {
    let make = z_bins("16x16x24", LightSource::Hierarchy);
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

#[test]
fn planted_faults_are_rejected() {
    let make = z_bins("16x16x24", LightSource::Linear);
    let planted = conformance::rejects_faults(&make).expect("rejects");
    let is_left_out = |fault: &Fault| !planted.contains(fault);
    let mut left_out = Fault::all(false).into_iter().filter(is_left_out);
    assert!(left_out.all(Fault::needs_entries), "{planted:?}");
}

/// The look-up of masks, and its flags for both masks of a sample.
const LOOK_UP: &str = include_str!("../../assign/src/shaders/look_up_mask.wesl");
const FLAGS: &[(&str, bool)] = &[("both_masks", true), ("subgroups", false)];

#[test]
fn faults_of_the_look_up_are_rejected() {
    let slice = |wesl: StrategyWesl<'static>| StrategyWesl {
        // Each sample reads the slice behind its own.
        main: reword(
            wesl.main,
            "slice_of(sample.depth_view);",
            "min(slice_of(sample.depth_view) + 1u, froxels.counts.z - 1u);",
        ),
        ..wesl
    };
    let word = |wesl| StrategyWesl {
        // The second half of each node is lost.
        reader: LightReader::Own(reword(LOOK_UP, "word_at(cursor, 2u * own + 1u)", "0u")),
        flags: FLAGS,
        ..wesl
    };
    let first = |wesl| StrategyWesl {
        // The lights of the slice are not asked.
        reader: LightReader::Own(reword(
            LOOK_UP,
            "list_of(second_group_of(sample))",
            "list_of(0u)",
        )),
        flags: FLAGS,
        ..wesl
    };
    let rejects = |what: &str, other: &dyn Fn(StrategyWesl<'static>) -> StrategyWesl<'static>| {
        let make = |gpu: &Gpu| -> Result<Box<dyn Assignment>, AssignError> {
            Ok(Box::new(Reworded::new(z_bins("16x16x24", LightSource::Linear)(gpu)?, other)))
        };
        conformance::rejects_in(what, "5000-lights", Breach::MissedPair, &make).expect("rejects");
    };
    rejects("the slice behind", &slice);
    rejects("half of each node", &word);
    rejects("the mask of another slice", &first);
}

#[test]
fn the_look_up_validates() {
    let reader = "
import package::look_up::{next_light, open_lights};
import package::sample::sample_at;
@group(2) @binding(0) var<storage, read_write> sums: array<u32>;
@compute @workgroup_size(64) fn count(@builtin(global_invocation_id) id: vec3u) {
  var cursor = open_lights(sample_at(vec2f(id.xy), 0.5, vec3f(0.0), 0u));
  while next_light(&cursor) {
    sums[id.x] += cursor.entry;
  }
}";
    for kinds in LightKinds::ALL {
        let shader = Shader::new(1).module("package::reader", reader).strategy(Z_BINS_WESL);
        let source = shader.light_kinds(kinds).link("package::reader").expect("links");
        LinkedModule::new(&format!("{kinds:?}"), &source);
    }
}
