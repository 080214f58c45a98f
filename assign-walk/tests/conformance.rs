//! W and W1 keep the contract's promises, and the suite rejects look-ups with planted faults.

#![allow(clippy::unwrap_used, reason = "a test fails by panicking")]

use assign::{
    AssignError, Assignment, BOUNDS_BOX_WESL, Frame, Gpu, LightLists, LightReader, LightSource,
    Lookup, Needs, Passes, StrategyModule, StrategyWesl, Team,
    conformance::{self, Breach, ConformanceError},
};
use assign_walk::{Walk, walk_wesl};

fn walk(
    team: Team,
    source: LightSource,
) -> impl Fn(&Gpu) -> Result<Box<dyn Assignment>, AssignError> {
    move |gpu| Ok(Box::new(Walk::new(gpu, team, source)?))
}

/// Cases of more lights than llvmpipe's loops can read.
const LONG: &[&str] = &["65537-lights"];

fn conforms(team: Team, source: LightSource) {
    let report = conformance::run_allowing(&walk(team, source), LONG).expect("conforms");
    println!("{report}");
}

#[test]
fn subgroups_conform() {
    conforms(Team::Subgroup, LightSource::Linear);
}

#[test]
fn subgroups_conform_through_the_hierarchy() {
    conforms(Team::Subgroup, LightSource::Hierarchy);
}

#[test]
fn lanes_conform() {
    conforms(Team::Lane, LightSource::Hierarchy);
}

/// The look-up that W and W1 use.
const LOOK_UP: &str = include_str!("../../assign/src/shaders/look_up_walk.wesl");

/// A strategy whose look-up was altered.
struct Altered {
    inner: Walk,
    wesl: StrategyWesl<'static>,
}

impl Altered {
    /// Replaces a part of the look-up's text, which must be there.
    fn new(gpu: &Gpu, team: Team, source: LightSource, part: [&str; 2]) -> Self {
        assert!(LOOK_UP.contains(part[0]), "the look-up has no {:?}", part[0]);
        let flags = vec![
            ("lane_bounds", true),
            ("subgroups", team == Team::Subgroup),
            ("walk_nodes", source == LightSource::Hierarchy),
            ("listed", false),
        ];
        let wesl = StrategyWesl {
            imports: &[("package::lane_bounds", BOUNDS_BOX_WESL)],
            flags: flags.leak(),
            reader: LightReader::Own(LOOK_UP.replace(part[0], part[1]).leak()),
            ..walk_wesl(team, source)
        };
        Self { inner: Walk::new(gpu, team, source).unwrap(), wesl }
    }
}

impl Assignment for Altered {
    fn id(&self) -> String {
        self.inner.id()
    }
    fn needs(&self) -> Needs {
        self.inner.needs()
    }
    fn prepare(&mut self, gpu: &Gpu, frame: &Frame<'_>) -> Result<(), AssignError> {
        self.inner.prepare(gpu, frame)
    }
    fn record(&mut self, frame: &Frame<'_>, passes: &mut dyn Passes) {
        self.inner.record(frame, passes);
    }
    fn lookup(&self) -> Lookup<'_> {
        // SAFETY: the parts that tests replace leave the loops as they are.
        #[allow(unsafe_code, reason = "its loops end")]
        let module = unsafe { StrategyModule::new(self.wesl) };
        Lookup { module, ..self.inner.lookup() }
    }
    fn bind_group(&self) -> Option<&wgpu::BindGroup> {
        self.inner.bind_group()
    }
    fn lists(&self) -> &LightLists {
        self.inner.lists()
    }
    fn lists_mut(&mut self) -> &mut LightLists {
        self.inner.lists_mut()
    }
    fn memory_bytes(&self) -> u64 {
        self.inner.memory_bytes()
    }
}

/// Runs a case with an altered look-up. It must be rejected for `breach`.
fn rejects(team: Team, source: LightSource, part: [&str; 2], case: &str, breach: Breach) {
    let make = |gpu: &Gpu| -> Result<Box<dyn Assignment>, AssignError> {
        Ok(Box::new(Altered::new(gpu, team, source, part)))
    };
    match conformance::run_case(case, &make) {
        Err(error @ ConformanceError::Rejected(_)) => {
            let text = error.to_string();
            let named = format!("{breach:?}");
            assert!(is_named(&error, breach), "{part:?} must break {named}: {text}");
        }
        other => panic!("{part:?} in {case}: {other:?}"),
    }
}

fn is_named(error: &ConformanceError, breach: Breach) -> bool {
    let ConformanceError::Rejected(report) = error else { return false };
    report.cases.iter().any(|case| match &case.outcome {
        conformance::Outcome::Failed(violations) => violations.iter().any(|v| v.breach == breach),
        _ => false,
    })
}

#[test]
fn planted_faults_are_rejected() {
    use Breach::{MissedPair, NotAscending, Repeated};
    use LightSource::{Hierarchy, Linear};
    // A box around one lane's sample instead of all lanes'.
    let small = ["box_of(GroupBounds(low, high))", "box_of(GroupBounds(position, position))"];
    rejects(Team::Subgroup, Linear, small, "33-lights", MissedPair);
    rejects(Team::Subgroup, Hierarchy, small, "33-lights", MissedPair);
    // The last light of each batch is not tested.
    let last = ["if rank < count && hits", "if rank + 1u < count && hits"];
    rejects(Team::Subgroup, Linear, last, "33-lights", MissedPair);
    // Hits of other lanes are not shared.
    rejects(Team::Subgroup, Linear, ["subgroupOr(hit)", "hit"], "33-lights", MissedPair);
    // The last hit comes first.
    let reversed = [
        "(*cursor).lights.first + firstTrailingBit(found);",
        "(*cursor).lights.next - 1u - firstTrailingBit(found);",
    ];
    rejects(Team::Lane, Hierarchy, reversed, "31-lights", NotAscending);
    // A batch is tested twice.
    let twice = [
        "Items(items.next + count, items.end, items.next, found)",
        "Items(items.next + max(count, 2u) - 1u, items.end, items.next, found)",
    ];
    rejects(Team::Lane, Hierarchy, twice, "33-lights", Repeated);
    // A node's last lights are left out.
    let short = ["min(first + CHILDREN, total)", "min(first + CHILDREN - 1u, total)"];
    rejects(Team::Lane, Hierarchy, short, "5000-lights", MissedPair);
}
