//! What a study of polygon lights measured, by place, number of lights and number of cones, and what the
//! paper measured.

use super::data::{Entry, entries};
use crate::results::{Operations, Record};
use crate::study::Done;

/// The places of the camera: their sections, and what the page calls them.
pub(super) const PLACES: [(&str, &str); 3] = [
    ("a", "Location A: near fragments"),
    ("b", "Location B: near fragments"),
    ("c", "Location C: mostly far fragments"),
];

/// The normal cones that a cluster is split by; `None` where lights are assigned by position alone.
pub(super) fn cones(id: &str) -> Option<u32> {
    id.split('/').skip(1).find_map(|segment| segment.strip_prefix('n')?.parse().ok())
}

/// The radiance below which specular light is left out, as the id has it.
pub(super) fn cut(id: &str) -> Option<&str> {
    let number = |text: &&str| text.parse::<f64>().is_ok();
    id.split('/').skip(1).find_map(|segment| segment.strip_prefix('s').filter(number))
}

/// `position`, `54 cones` or `54 cones, cut 0.01`.
pub(super) fn setting(id: &str) -> String {
    let Some(cones) = cones(id) else {
        return if id == crate::results::BASELINE { "no culling" } else { "position" }.to_owned();
    };
    let plural = if cones == 1 { "" } else { "s" };
    let cut = cut(id).map_or_else(String::new, |cut| format!(", cut {cut}"));
    format!("{cones} cone{plural}{cut}")
}

/// One place under one count of lights.
pub(super) struct Case<'a> {
    /// The section of the place.
    pub(super) place: &'static str,
    /// Lights.
    pub(super) lights: u64,
    /// All settings, in the order of their job.
    pub(super) entries: Vec<Entry<'a>>,
}

/// All cases that were measured: by place, and by lights.
pub(super) fn cases<'a>(done: &'a Done, scene: &'a str) -> Vec<Case<'a>> {
    let mut cases: Vec<Case<'a>> = Vec::new();
    for (place, _) in PLACES {
        for entry in entries(done, scene, place) {
            let lights = entry.record.lights;
            match cases.iter_mut().find(|case| case.place == place && case.lights == lights) {
                Some(case) => case.entries.push(entry),
                None => cases.push(Case { place, lights, entries: vec![entry] }),
            }
        }
    }
    cases
}

impl<'a> Case<'a> {
    /// The records of a number of cones.
    pub(super) fn of(&self, wanted: Option<u32>) -> impl Iterator<Item = &'a Record> {
        let culls = self.entries.iter().map(|entry| entry.record).filter(|record| record.culls());
        culls.filter(move |record| cones(&record.strategy) == wanted)
    }

    /// The record by position alone.
    pub(super) fn position(&self) -> Option<&'a Record> {
        self.of(None).next()
    }

    /// `a 2016`: for charts and figures.
    pub(super) fn name(&self) -> String {
        format!("{} {}", self.place.to_uppercase(), self.lights)
    }
}

/// Operations of both terms.
pub(super) fn listed(operations: &Operations) -> u64 {
    operations.diffuse + operations.specular
}

/// A row of the paper: a place, its lights, the cones (none is by position alone), operations of both
/// terms, assignment and shading, ms.
type Row = (&'static str, u64, Option<u32>, Option<u64>, f64, f64);

/// Swarbrick 2025, table D.1: a GTX 1060 at 1280x720, clusters of 16 x 9 x 24.
const PAPER: [Row; 20] = [
    ("a", 126, None, Some(65_936_949), 0.43, 105.55),
    ("a", 126, Some(6), Some(51_355_552), 2.8, 88.7),
    ("a", 126, Some(24), Some(53_645_586), 11.0, 85.7),
    ("a", 126, Some(54), Some(47_590_904), 24.75, 73.0),
    ("a", 2_016, None, Some(70_101_700), 1.60, 119.7),
    ("a", 2_016, Some(6), Some(51_519_648), 8.15, 84.0),
    ("a", 2_016, Some(24), Some(55_694_960), 32.2, 95.5),
    ("a", 2_016, Some(54), Some(48_230_849), 72.2, 80.45),
    ("b", 126, None, Some(60_767_215), 0.43, 84.3),
    ("b", 126, Some(6), Some(56_786_818), 2.8, 77.0),
    ("b", 126, Some(24), Some(58_069_784), 10.0, 81.16),
    ("b", 126, Some(54), Some(54_220_412), 26.6, 76.0),
    ("b", 2_016, None, Some(65_528_147), 1.68, 99.5),
    ("b", 2_016, Some(6), Some(57_228_839), 11.1, 83.36),
    // As printed: operations and times of this row are those of the first.
    ("b", 2_016, Some(24), Some(65_528_147), 1.5, 98.7),
    ("b", 2_016, Some(54), Some(55_243_963), 73.0, 81.0),
    ("c", 2_016, None, None, 1.54, 295.0),
    ("c", 2_016, Some(6), Some(132_055_610), 8.6, 273.0),
    ("c", 2_016, Some(24), None, 32.5, 328.0),
    ("c", 2_016, Some(54), Some(131_789_980), 71.4, 303.5),
];

/// What the paper measured: operations of both terms, assignment and shading, ms.
pub(super) struct Paper {
    pub(super) listed: Option<u64>,
    pub(super) assign_ms: f64,
    pub(super) shade_ms: f64,
}

/// The paper's row of a place, its lights and a number of cones.
pub(super) fn paper(place: &str, lights: u64, wanted: Option<u32>) -> Option<Paper> {
    let row = PAPER.iter().find(|row| (row.0, row.1, row.2) == (place, lights, wanted))?;
    Some(Paper { listed: row.3, assign_ms: row.4, shade_ms: row.5 })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn settings_are_read_from_ids() {
        let id = "SC-E/48x48x40/bvh/n54/s0.001";
        assert_eq!((cones(id), cut(id)), (Some(54), Some("0.001")));
        assert_eq!(setting(id), "54 cones, cut 0.001");
        let plain = "SC-E/48x48x40/bvh";
        assert_eq!((cones(plain), cut(plain)), (None, None));
        assert_eq!((setting(plain).as_str(), setting("None").as_str()), ("position", "no culling"));
        assert_eq!(setting("SC-E/48x48x40/bvh/n1"), "1 cone");
        assert_eq!(cones("None"), None);
    }

    #[test]
    fn the_papers_rows_are_there_once() {
        for (ix, row) in PAPER.iter().enumerate() {
            let same = |other: &&Row| (other.0, other.1, other.2) == (row.0, row.1, row.2);
            assert_eq!(PAPER.iter().position(|other| same(&other)), Some(ix));
        }
        // 54 cones leave out four fifths of what 23,043,487 outer operations are by position.
        let [position, cones] = [None, Some(54)].map(|n| paper("a", 126, n).unwrap());
        let inner = 42_893_462;
        let share =
            (cones.listed.unwrap() - inner) as f64 / (position.listed.unwrap() - inner) as f64;
        assert!((share - 0.204).abs() < 1e-3, "{share}");
    }
}
