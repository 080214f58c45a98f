//! W and W1 keep the contract's promises, and the suite rejects look-ups with planted faults.

use assign::{
    AssignError, Assignment, BOUNDS_BOX_WESL, Gpu, LightReader, LightSource, StrategyWesl, Team,
    conformance::{self, Breach, Reworded, reword},
};
use assign_walk::Walk;

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

/// Replaces a part of the look-up's text. A case must reject it for `breach`.
fn rejects(team: Team, source: LightSource, part: [&str; 2], case: &str, breach: Breach) {
    let look_up = reword(LOOK_UP, part[0], part[1]);
    let flags = vec![
        ("lane_bounds", true),
        ("subgroups", team == Team::Subgroup),
        ("walk_nodes", source == LightSource::Hierarchy),
        ("listed", false),
    ];
    let flags: &[(&str, bool)] = flags.leak();
    let make = |gpu: &Gpu| -> Result<Box<dyn Assignment>, AssignError> {
        let other = |wesl| StrategyWesl {
            imports: &[("package::lane_bounds", BOUNDS_BOX_WESL)],
            flags,
            reader: LightReader::Own(look_up),
            ..wesl
        };
        Ok(Box::new(Reworded::new(walk(team, source)(gpu)?, other)))
    };
    conformance::rejects_in(&format!("{part:?}"), case, breach, &make).expect("rejects");
}

#[test]
fn planted_faults_are_rejected() {
    use Breach::{MissedPair, NotAscending, Repeated};
    use LightSource::{Hierarchy, Linear};
    // A box around one lane's sample instead of all lanes'.
    let small = ["box_of(GroupBounds(low, high))", "box_of(GroupBounds(position, position))"];
    rejects(Team::Subgroup, Linear, small, "33-lights", MissedPair);
    rejects(Team::Subgroup, Hierarchy, small, "33-lights", MissedPair);
    // The last light of each batch is lost.
    let last = ["is_miss = rank < count &&", "is_miss = rank + 1u == count ||"];
    rejects(Team::Subgroup, Linear, last, "33-lights", MissedPair);
    // What misses counts as what hits.
    rejects(Team::Subgroup, Linear, ["~misses)", "misses)"], "33-lights", MissedPair);
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
