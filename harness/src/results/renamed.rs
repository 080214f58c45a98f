//! Records of earlier versions, under the ids that say today what they were.
//!
//! Two ids have changed their meaning. `G/20x20x20` cut the box of the lights' supports, which is
//! `G/20x20x20/supports` now. `T-I/28x28` asked for HS+SAT-N, but stages had no far plane then, and
//! without far corners the shader ran HS alone: that is `T-I/28x28/hs`.

use serde_json::Value;

use super::{Record, Results};

impl Results {
    /// Gives every record the id that says what it was.
    pub(super) fn rename_records(&mut self) {
        self.records.iter_mut().for_each(Record::rename);
    }
}

impl Record {
    fn rename(&mut self) {
        let (parameter, was, is) = match self.strategy.split('/').next() {
            Some("G") => ("box", "lights", "supports"),
            Some("T-I") if self.planes.is_none() => ("tests", "hs+sat-n", "hs"),
            _ => return,
        };
        let known = self.strategy_parameters.get(parameter).and_then(Value::as_str);
        if known != Some(was) {
            return;
        }
        // The segment stands behind the family and its size, before source and knobs.
        let mut segments: Vec<&str> = self.strategy.split('/').collect();
        segments.retain(|segment| *segment != was);
        segments.insert(segments.len().min(2), is);
        self.strategy = segments.join("/").into();
        self.strategy_parameters.insert(parameter.to_owned(), is.into());
    }
}

#[cfg(test)]
mod tests {
    use super::super::{PlaneSource, Planes};
    use super::*;

    fn record(strategy: &str, parameter: &str, value: &str) -> Record {
        let example = include_str!("example.json");
        let results: Results = serde_json::from_str(example).unwrap();
        let mut record = results.records.into_iter().next().unwrap();
        record.strategy = strategy.into();
        record.strategy_parameters.insert(parameter.to_owned(), value.into());
        record.planes = None;
        record
    }

    fn renamed(mut record: Record) -> String {
        record.rename();
        let once = record.clone();
        record.rename();
        assert_eq!(record, once, "renaming again changes nothing");
        record.strategy.to_string()
    }

    #[test]
    fn a_grid_of_supports_is_called_so() {
        let name = |strategy, grid_box| renamed(record(strategy, "box", grid_box));
        assert_eq!(name("G/20x20x20", "lights"), "G/20x20x20/supports");
        assert_eq!(name("G/20x20x20/bvh/cap8", "lights"), "G/20x20x20/supports/bvh/cap8");
        assert_eq!(name("G/8x8x8/surfaces/bvh", "surfaces"), "G/8x8x8/surfaces/bvh");
        assert_eq!(name("G/20x20x20/bvh", "positions"), "G/20x20x20/bvh");
    }

    #[test]
    fn a_tile_without_a_far_plane_ran_hs_alone() {
        let old = || record("T-I/28x28/bvh", "tests", "hs+sat-n");
        assert_eq!(renamed(old()), "T-I/28x28/hs/bvh");
        assert_eq!(
            renamed(record("T-I/16x16/hs+sat-e", "tests", "hs+sat-e")),
            "T-I/16x16/hs+sat-e"
        );
        assert_eq!(renamed(record("T-E/28x28", "tests", "hs+sat-n")), "T-E/28x28");
        let planes = Planes {
            near_m: 0.1,
            near_from: PlaneSource::Scene,
            far_m: Some(40.0),
            far_from: PlaneSource::Scene,
        };
        assert_eq!(renamed(Record { planes: Some(planes), ..old() }), "T-I/28x28/bvh");
    }
}
