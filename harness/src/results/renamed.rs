//! What earlier versions stored, in the words of today.
//!
//! Ids that have changed their meaning stand in their rows of the registry, as [`StandIn`]s. A row says what
//! its old id meant, and how it turns into the id of today and back.

use std::collections::BTreeMap;

use serde_json::Value;

use super::{Mode, Setting};
use crate::strategy::{StandIn, StrategyId, row};

/// The id that says today what a record of schema 1 was.
pub(super) fn named_today(
    id: &str,
    parameters: &BTreeMap<String, Value>,
    setting: &Setting,
) -> StrategyId {
    let id = StrategyId::read(id);
    let is_old = |stand_in: &&StandIn| {
        let (name, value) = stand_in.told_by;
        let has_value = parameters.get(name).and_then(Value::as_str) == Some(value);
        has_value && (setting.planes.is_none() || !stand_in.needs_no_planes)
    };
    let stand_in = id.row().and_then(|row| row.stand_ins.iter().find(is_old));
    stand_in.and_then(|stand_in| id.with(stand_in.to_today).ok()).unwrap_or(id)
}

/// The id under which an old command asked for what is called `id` today: its own where it kept it.
pub(super) fn named_then(id: &StrategyId) -> StrategyId {
    let then = id.row_of_stand_in().and_then(|stand_in| id.with(stand_in.to_then).ok());
    then.unwrap_or_else(|| id.clone())
}

/// What a warning of earlier versions says today: `RasterSphere has no mode forward` gave no reason. `None`
/// where the warning stays as it is.
pub(super) fn warned_today(warning: &str) -> Option<String> {
    let (family, mode) = warning.split_once(" has no mode ")?;
    row(family)?.refusal(Mode::ALL.into_iter().find(|known| known.name() == mode)?)
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
    fn an_old_warning_gets_its_reason() {
        let today =
            "RasterSphere cannot run in mode forward, because light volumes read a G-buffer.";
        assert_eq!(warned_today("RasterSphere has no mode forward").as_deref(), Some(today));
        for other in [today, "Gone has no mode forward", "None has no mode forward"] {
            assert_eq!(warned_today(other), None);
        }
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
