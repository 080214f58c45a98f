//! The property tests say what must hold *if* a light touches a group. Here we check that lights of
//! every kind often touch groups of every shape, and often miss them. Otherwise the property tests
//! would check nothing.

use proptest::strategy::{BoxedStrategy, Strategy, ValueTree};
use proptest::test_runner::TestRunner;

use crate::aims::{Kind, aim, witness};
use crate::cases::{aabb, frustum, oriented};
use crate::deterministic;
use crate::groups::Group;

/// The number of lights of a kind that are aimed at groups of a shape.
const PAIRS: usize = 1_500;

/// The share of lights that touch their group.
fn share(kind: Kind, groups: &BoxedStrategy<Group>) -> f64 {
    let mut runner = TestRunner::new(deterministic(1));
    let touches = (0..PAIRS).filter(|_| {
        let group = groups.new_tree(&mut runner).unwrap().current();
        let aim = aim(kind).new_tree(&mut runner).unwrap().current();
        witness(&group, &aim.light(&group)).is_some()
    });
    touches.count() as f64 / PAIRS as f64
}

#[test]
fn lights_of_every_kind_touch_groups_of_every_shape_or_miss_them() {
    for (name, groups) in
        [("frustum", frustum().boxed()), ("box", aabb().boxed()), ("oriented", oriented().boxed())]
    {
        for kind in [Kind::Point, Kind::Spot, Kind::Area] {
            let share = share(kind, &groups);
            println!("{name}, {kind:?}: {share:.3} touch");
            assert!((0.2..0.9).contains(&share), "{name}, {kind:?}: a share of {share} touches");
        }
    }
}
