//! Records of schema 1, under the ids that say today what they were.
//!
//! Two ids have changed their meaning. `G/20x20x20` cut the box of the lights' supports, which is
//! `G/20x20x20/supports` now. `T-I/28x28` asked for HS+SAT-N, but stages had no far plane then, and
//! without far corners the shader ran HS only: that is `T-I/28x28/hs`.

use std::collections::BTreeMap;

use assign::FrustumTests;
use assign_grid::GridBox;
use serde_json::Value;

use super::Setting;
use crate::strategy::{Options, StrategyId};

/// An id that has changed its meaning.
struct Renaming {
    family: &'static str,
    /// The parameter that tells an old record, and its value.
    told_by: (&'static str, &'static str),
    /// Whether the setting lets the record be an old one.
    may_be_old: fn(&Setting) -> bool,
    /// Names what the record was.
    to_today: fn(&mut Options),
    /// Undoes that.
    to_then: fn(&mut Options),
}

const RENAMINGS: [Renaming; 2] = [
    Renaming {
        family: "G",
        told_by: ("box", "lights"),
        may_be_old: |_| true,
        to_today: |options| options.grid_box = GridBox::Supports,
        to_then: |options| options.grid_box = GridBox::default(),
    },
    Renaming {
        family: "T-I",
        told_by: ("tests", "hs+sat-n"),
        may_be_old: |setting| setting.planes.is_none(),
        to_today: |options| options.tests = Some(HS),
        to_then: |options| options.tests = None,
    },
];

const HS: FrustumTests =
    FrustumTests { hs: true, sat_e: false, sat_n: false, sat_p: false, sat_v: false };

/// The id that says today what a record of schema 1 was.
pub(super) fn named_today(
    id: &str,
    parameters: &BTreeMap<String, Value>,
    setting: &Setting,
) -> StrategyId {
    let id = StrategyId::read(id);
    let is_old = |renaming: &&Renaming| {
        let (name, value) = renaming.told_by;
        let has_value = parameters.get(name).and_then(Value::as_str) == Some(value);
        renaming.family == id.family() && has_value && (renaming.may_be_old)(setting)
    };
    let renaming = RENAMINGS.iter().find(is_old);
    renaming.and_then(|renaming| id.with(renaming.to_today).ok()).unwrap_or(id)
}

/// The id under which an old command asked for what is called `id` today: its own where it kept it.
pub(super) fn named_then(id: &StrategyId) -> StrategyId {
    let renaming = RENAMINGS.iter().find(|renaming| renaming.family == id.family());
    let renaming = renaming.filter(|_| id.stand_in().is_some());
    renaming.and_then(|renaming| id.with(renaming.to_then).ok()).unwrap_or_else(|| id.clone())
}

#[cfg(test)]
mod tests {
    use super::super::{PlaneSource, Planes, Results};
    use super::*;

    fn renamed(id: &str, parameter: &str, value: &str, planes: Option<Planes>) -> String {
        let results: Results = serde_json::from_str(include_str!("example.json")).unwrap();
        let mut setting = results.records[0].setting.clone();
        setting.planes = planes;
        let parameters = [(parameter.to_owned(), value.into())].into();
        let today = named_today(id, &parameters, &setting);
        assert_eq!(named_then(&today), StrategyId::read(id), "the old command asked for {id}");
        today.to_string()
    }

    #[test]
    fn a_stored_grid_of_supports_gets_its_new_id() {
        let name = |id, grid_box| renamed(id, "box", grid_box, None);
        assert_eq!(name("G/20x20x20", "lights"), "G/20x20x20/supports");
        assert_eq!(name("G/20x20x20/bvh/cap8", "lights"), "G/20x20x20/supports/bvh/cap8");
        assert_eq!(name("G/8x8x8/surfaces/bvh", "surfaces"), "G/8x8x8/surfaces/bvh");
        assert_eq!(name("G/20x20x20/bvh", "positions"), "G/20x20x20/bvh");
    }

    #[test]
    fn a_tile_without_a_far_plane_ran_hs_only() {
        let name = |id, tests| renamed(id, "tests", tests, None);
        assert_eq!(name("T-I/28x28/bvh", "hs+sat-n"), "T-I/28x28/hs/bvh");
        assert_eq!(name("T-I/16x16/hs+sat-e", "hs+sat-e"), "T-I/16x16/hs+sat-e");
        assert_eq!(name("T-E/28x28", "hs+sat-n"), "T-E/28x28");
        let planes = Planes {
            near_m: 0.1,
            near_from: PlaneSource::Scene,
            far_m: Some(40.0),
            far_from: PlaneSource::Scene,
        };
        assert_eq!(renamed("T-I/28x28/bvh", "tests", "hs+sat-n", Some(planes)), "T-I/28x28/bvh");
    }
}
