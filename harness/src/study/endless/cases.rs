//! What a study of polygon lights measured, by place, number of lights and setting, and what the paper
//! measured.

use assign_clustered::SpecularCut;

use crate::results::{Operations, Record};
use crate::strategy::{Role, StrategyId};
use crate::study::data::{Entry, entries};
use crate::study::manifest::Done;

/// The places of the camera: their sections, and what the page calls them.
pub(crate) const PLACES: [(&str, &str); 3] = [
    ("a", "Location A: near fragments"),
    ("b", "Location B: near fragments"),
    ("c", "Location C: mostly far fragments"),
];

/// Location A under ranges by the paper's own rule. No claim uses it.
pub(crate) const RULED: (&str, &str) =
    ("influence", "Location A: ranges from the paper\u{2019}s influence radius, with a hard cut");

/// Depth slices of the paper's clusters.
pub(crate) const PAPER_SLICES: u64 = 24;

/// Half as many, with which the paper compares them.
pub(crate) const HALF_SLICES: u64 = 12;

/// The clusters of all settings except the paper's.
pub(crate) const USUAL: &str = "48x48x40";

/// What specular light a setting leaves out on purpose.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) enum Cut {
    /// None.
    None,
    /// What stays below a radiance.
    Below(f32),
    /// What the paper's cone test does not pass, with a lobe of so many degrees.
    ConeTest(f32),
    /// All beyond the reach of diffuse light: the paper's `dif`.
    Diffuse,
}

/// A setting, read from its id.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Setting<'a> {
    /// The clusters: `48x48x40`; empty where there are none.
    pub(crate) grid: &'a str,
    /// The depth slices of the clusters.
    pub(crate) slices: Option<u64>,
    /// Normal cones that a cluster is split by; `None` where lights are assigned by position only.
    pub(crate) cones: Option<u32>,
    pub(crate) cut: Cut,
    /// Whether shading skips, at each sample, terms that add nothing there.
    pub(crate) exits: bool,
}

impl<'a> Setting<'a> {
    pub(crate) fn read(id: &'a StrategyId) -> Self {
        let options = id.options();
        Self {
            grid: id.size(),
            slices: id.sizes().find(|(name, _)| *name == "slices").and_then(|(_, n)| n.as_u64()),
            cones: options.normals.is_some().then(|| options.normals.bins()),
            cut: match options.specular {
                SpecularCut::None => Cut::None,
                SpecularCut::Below(radiance) => Cut::Below(radiance),
                SpecularCut::ReflectedCone(degrees) => Cut::ConeTest(degrees),
                SpecularCut::WhereDiffuse => Cut::Diffuse,
            },
            exits: !options.evaluates_all,
        }
    }

    /// Whether its number of cones is one of the paper's: 6, 24 or 54, or none, by position.
    pub(crate) fn is_of_the_paper(&self) -> bool {
        self.cones.is_none_or(|cones| [6, 24, 54].contains(&cones))
    }

    /// Whether it is position only, without a cut.
    pub(crate) fn is_position(&self) -> bool {
        self.cones.is_none() && self.cut == Cut::None
    }
}

/// `position`, `54 cones`, `54 cones, cut 0.01`, `6 cones, 45° test, 80x80x24, no early exit`.
pub(crate) fn setting(id: &StrategyId) -> String {
    if id.role() == Some(Role::Baseline) {
        return "no culling".to_owned();
    }
    let setting = Setting::read(id);
    let mut text = match setting.cones {
        None if setting.cut == Cut::Diffuse => "diffuse reach".to_owned(),
        None => "position".to_owned(),
        Some(1) => "1 cone".to_owned(),
        Some(cones) => format!("{cones} cones"),
    };
    match setting.cut {
        Cut::Below(radiance) => text += &format!(", cut {radiance}"),
        Cut::ConeTest(degrees) => text += &format!(", {degrees}\u{b0} test"),
        Cut::None | Cut::Diffuse => {}
    }
    if setting.grid != USUAL {
        text += &format!(", {}", setting.grid);
    }
    if !setting.exits {
        text += ", no early exit";
    }
    text
}

/// One place under one count of lights.
pub(crate) struct Case<'a> {
    /// The section of the place.
    pub(crate) place: &'static str,
    /// Lights.
    pub(crate) lights: u64,
    /// All settings, in the order of their job.
    pub(crate) entries: Vec<Entry<'a>>,
}

/// All cases that were measured at the paper's places: by place, and by lights.
pub(crate) fn cases<'a>(done: &'a Done, scene: &'a str) -> Vec<Case<'a>> {
    cases_at(done, scene, &PLACES)
}

/// All cases of some places.
pub(crate) fn cases_at<'a>(
    done: &'a Done,
    scene: &'a str,
    places: &[(&'static str, &'static str)],
) -> Vec<Case<'a>> {
    let mut cases: Vec<Case<'a>> = Vec::new();
    for &(place, _) in places {
        for entry in entries(done, scene, place) {
            let lights = entry.record.setting.lights;
            match cases.iter_mut().find(|case| case.place == place && case.lights == lights) {
                Some(case) => case.entries.push(entry),
                None => cases.push(Case { place, lights, entries: vec![entry] }),
            }
        }
    }
    cases
}

impl<'a> Case<'a> {
    /// All records that cull, in the order of their job.
    pub(crate) fn culled(&self) -> impl Iterator<Item = &'a Record> {
        self.entries.iter().map(|entry| entry.record).filter(|record| record.culls())
    }

    /// The record of one setting.
    pub(crate) fn find(&self, wanted: impl Fn(&Setting<'_>) -> bool) -> Option<&'a Record> {
        self.culled().find(|record| wanted(&Setting::read(&record.strategy)))
    }

    /// The record by position only, with the usual clusters and the early exit where it is there.
    pub(crate) fn position(&self) -> Option<&'a Record> {
        let is_usual = |setting: &Setting<'_>| setting.grid == USUAL && setting.exits;
        let any = |setting: &Setting<'_>| setting.is_position();
        self.find(|setting| setting.is_position() && is_usual(setting)).or_else(|| self.find(any))
    }

    /// The record of no culling.
    pub(crate) fn none(&self) -> Option<&'a Record> {
        self.entries.iter().map(|entry| entry.record).find(|record| record.is_baseline())
    }

    /// `A 2016`: for charts and figures.
    pub(crate) fn name(&self) -> String {
        let place = match self.place {
            "influence" => "A, paper\u{2019}s ranges,".to_owned(),
            place => place.to_uppercase(),
        };
        format!("{place} {}", self.lights)
    }
}

/// Terms that would be seen and that the lists name; of files that do not tell, those of all listed lights.
pub(crate) fn seen(operations: &Operations) -> u64 {
    operations.perceptible_listed.unwrap_or(operations.perceptible)
}

/// Terms that would be seen and that a setting loses against position; and whether it may lose more, for
/// its file counts both terms of every listed light.
pub(crate) fn lost(operations: &Operations, position: &Operations) -> (u64, bool) {
    let lost = seen(position).saturating_sub(seen(operations));
    (lost, operations.perceptible_listed.is_none())
}

/// A kind of row of the paper.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Kind {
    /// By position, its `1`.
    Position,
    Cones(u32),
    /// Its `dif`.
    Diffuse,
}

impl Kind {
    /// The paper's row that a setting stands beside: cones by its test, and without a loss.
    fn beside(setting: &Setting<'_>) -> Option<Self> {
        match (setting.cones, setting.cut) {
            (None, Cut::None) => Some(Self::Position),
            (None, Cut::Diffuse) => Some(Self::Diffuse),
            (Some(cones), Cut::None | Cut::ConeTest(_)) => Some(Self::Cones(cones)),
            _ => None,
        }
    }
}

/// A row of the paper: a place, its lights, what it is, operations of both terms, assignment and shading,
/// ms.
type Row = (&'static str, u64, Kind, Option<u64>, f64, f64);

/// Swarbrick 2025, table D.1: a GTX 1060 at 1280x720, clusters of 16 x 9 x 24.
const PAPER: [Row; 25] = [
    ("a", 126, Kind::Position, Some(65_936_949), 0.43, 105.55),
    ("a", 126, Kind::Cones(6), Some(51_355_552), 2.8, 88.7),
    ("a", 126, Kind::Cones(24), Some(53_645_586), 11.0, 85.7),
    ("a", 126, Kind::Cones(54), Some(47_590_904), 24.75, 73.0),
    ("a", 126, Kind::Diffuse, Some(42_893_462), 0.43, 59.6),
    ("a", 2_016, Kind::Position, Some(70_101_700), 1.60, 119.7),
    ("a", 2_016, Kind::Cones(6), Some(51_519_648), 8.15, 84.0),
    ("a", 2_016, Kind::Cones(24), Some(55_694_960), 32.2, 95.5),
    ("a", 2_016, Kind::Cones(54), Some(48_230_849), 72.2, 80.45),
    ("a", 2_016, Kind::Diffuse, Some(42_915_180), 1.5, 65.45),
    ("b", 126, Kind::Position, Some(60_767_215), 0.43, 84.3),
    ("b", 126, Kind::Cones(6), Some(56_786_818), 2.8, 77.0),
    ("b", 126, Kind::Cones(24), Some(58_069_784), 10.0, 81.16),
    ("b", 126, Kind::Cones(54), Some(54_220_412), 26.6, 76.0),
    ("b", 126, Kind::Diffuse, Some(52_208_794), 0.43, 66.9),
    ("b", 2_016, Kind::Position, Some(65_528_147), 1.68, 99.5),
    ("b", 2_016, Kind::Cones(6), Some(57_228_839), 11.1, 83.36),
    // As printed: operations of this row are those of the first, and its times nearly so.
    ("b", 2_016, Kind::Cones(24), Some(65_528_147), 1.5, 98.7),
    ("b", 2_016, Kind::Cones(54), Some(55_243_963), 73.0, 81.0),
    ("b", 2_016, Kind::Diffuse, Some(52_544_704), 1.52, 73.29),
    ("c", 2_016, Kind::Position, None, 1.54, 295.0),
    ("c", 2_016, Kind::Cones(6), Some(132_055_610), 8.6, 273.0),
    ("c", 2_016, Kind::Cones(24), None, 32.5, 328.0),
    ("c", 2_016, Kind::Cones(54), Some(131_789_980), 71.4, 303.5),
    ("c", 2_016, Kind::Diffuse, None, 1.61, 260.0),
];

/// What the paper measured: operations of both terms, assignment and shading, ms.
pub(crate) struct Published {
    pub(crate) listed: Option<u64>,
    pub(crate) assign_ms: f64,
    pub(crate) shade_ms: f64,
}

/// The paper's row of a place, its lights and a setting.
pub(crate) fn paper(place: &str, lights: u64, setting: &Setting<'_>) -> Option<Published> {
    let kind = Kind::beside(setting)?;
    let row = PAPER.iter().find(|row| (row.0, row.1, row.2) == (place, lights, kind))?;
    Some(Published { listed: row.3, assign_ms: row.4, shade_ms: row.5 })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn settings_are_read_from_ids() {
        let id = StrategyId::read;
        let cut = id("SC-E/48x48x40/bvh/n54/s0.001");
        let read = Setting::read(&cut);
        assert_eq!((read.cones, read.cut), (Some(54), Cut::Below(0.001)));
        assert_eq!(setting(&cut), "54 cones, cut 0.001");
        let plain = id("SC-E/48x48x40/bvh");
        let expected = Setting {
            grid: "48x48x40",
            slices: Some(40),
            cones: None,
            cut: Cut::None,
            exits: true,
        };
        assert_eq!(Setting::read(&plain), expected);
        assert_eq!(
            (setting(&plain).as_str(), setting(&id("None")).as_str()),
            ("position", "no culling")
        );
        assert_eq!(setting(&id("SC-E/48x48x40/n1")), "1 cone");
        let published = id("SC-E/80x80x24/n6/cone45/bvh/no-exit");
        assert_eq!(setting(&published), "6 cones, 45\u{b0} test, 80x80x24, no early exit");
        assert_eq!(setting(&id("SC-E/48x48x40/dif/bvh")), "diffuse reach");
        assert!(
            Setting::read(&published).is_of_the_paper() && Setting::read(&plain).is_of_the_paper()
        );
        let one = id("SC-E/48x48x40/n1");
        assert!(!Setting::read(&one).is_of_the_paper(), "the paper has no one cone");
    }

    #[test]
    fn the_papers_rows_are_there_once() {
        for (ix, row) in PAPER.iter().enumerate() {
            let same = |other: &&Row| (other.0, other.1, other.2) == (row.0, row.1, row.2);
            assert_eq!(PAPER.iter().position(|other| same(&other)), Some(ix));
        }
        // 54 cones leave out four fifths of what 23,043,487 outer operations are by position.
        let listed = |id| {
            paper("a", 126, &Setting::read(&StrategyId::read(id)))
                .and_then(|row| row.listed)
                .unwrap()
        };
        let [position, cones, inner] =
            ["SC-E/48x48x40", "SC-E/48x48x40/n54/cone45", "SC-E/48x48x40/dif"].map(listed);
        let share = (cones - inner) as f64 / (position - inner) as f64;
        assert!((share - 0.204).abs() < 1e-3, "{share}");
    }
}
