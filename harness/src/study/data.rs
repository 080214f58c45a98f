//! What the parts of the page ask of a study's records.

use super::job::Job;
use super::manifest::Done;
use crate::report::format::number;
use crate::results::{Record, Results};
use crate::{registry::STRATEGIES, report::colours::STRATEGY_COLOURS};

/// A record with the job that it comes from.
#[derive(Clone, Copy)]
pub(crate) struct Entry<'a> {
    pub(crate) job: &'a Job,
    pub(crate) record: &'a Record,
}

/// All records of a section that are there, in the order of its jobs.
pub(crate) fn entries<'a>(done: &'a Done, scene: &'a str, section: &'a str) -> Vec<Entry<'a>> {
    let of_job = |(job, results): (&'a Job, &'a Results)| {
        results.records.iter().map(move |record| Entry { job, record })
    };
    done.of(scene, section).flat_map(of_job).collect()
}

/// The records that rank strategies: those along the path at each count of lights that has them, and
/// those from the still camera at the other counts.
pub(crate) fn ranking<'a>(done: &'a Done, scene: &'a str) -> Vec<Entry<'a>> {
    let mut all = entries(done, scene, "path");
    let along = counts(&all);
    let still = entries(done, scene, "main").into_iter();
    all.extend(still.filter(|entry| !along.contains(&entry.record.setting.lights)));
    all
}

/// Poses along the path of which a record's times are means; 1 from a still camera.
pub(crate) fn poses(record: &Record) -> usize {
    match record.setting.along_path {
        true => record.times.frames as usize / record.laps().max(1) as usize,
        false => 1,
    }
}

/// The times of each lap along the path, pose by pose, ms.
pub(crate) fn laps(record: &Record) -> Vec<Vec<f64>> {
    record.frames_ms().chunks_exact(poses(record).max(1)).map(<[f64]>::to_vec).collect()
}

/// What a time is a mean of: `240 poses`, or `one pose`.
pub(crate) fn stand(record: &Record) -> String {
    match poses(record) {
        1 => "one pose".to_owned(),
        poses => format!("{} poses", number(poses as f64)),
    }
}

/// The records of one strategy, with its id, in the order of their lights.
pub(crate) type Line<'a> = (&'a str, Vec<&'a Record>);

/// The records of each strategy, in the order in which strategies first appear.
pub(crate) fn lines<'a>(entries: &[Entry<'a>]) -> Vec<Line<'a>> {
    let mut lines: Vec<Line<'a>> = Vec::new();
    for Entry { record, .. } in entries {
        match lines.iter_mut().find(|(id, _)| *id == record.strategy) {
            Some((_, records)) => records.push(record),
            None => lines.push((&record.strategy, vec![record])),
        }
    }
    for (_, records) in &mut lines {
        records.sort_by_key(|record| record.setting.lights);
    }
    lines
}

/// The counts of lights of records, ascending, each once.
pub(crate) fn counts(entries: &[Entry<'_>]) -> Vec<u64> {
    let mut counts: Vec<u64> = entries.iter().map(|entry| entry.record.setting.lights).collect();
    counts.sort_unstable();
    counts.dedup();
    counts
}

/// The count that a claim speaks of, where it was measured; else the nearest that was, by factor.
pub(crate) fn nearest_count(counts: &[u64], wanted: u64) -> Option<u64> {
    let factor = |count: &u64| ((*count).max(1) as f64 / wanted as f64).ln().abs();
    counts.iter().copied().min_by(|a, b| factor(a).total_cmp(&factor(b)))
}

/// Whether a count may speak for another: no more than twice or half as many.
pub(crate) fn is_near(count: u64, wanted: u64) -> bool {
    count <= 2 * wanted && wanted <= 2 * count
}

/// The id without parameters: `SC-E`.
pub(crate) fn family(id: &str) -> &str {
    id.split('/').next().unwrap_or(id)
}

/// The parameters of an id: `48x48x40`; empty where it has none.
pub(crate) fn parameters(id: &str) -> &str {
    let second = id.split('/').nth(1).unwrap_or_default();
    if second.starts_with(|c: char| c.is_ascii_digit()) { second } else { "" }
}

/// The family, for models the size of their parts, and what differs from the paper's strategy: the box of
/// a grid (`G/supports`), and tiles that are tested by half-spaces only (`T-I/hs`).
pub(crate) fn short(id: &str) -> String {
    match (family(id), parameters(id)) {
        ("M", size) if !size.is_empty() => format!("M/{size}"),
        ("G", _) => grid_box(id).map_or_else(|| "G".to_owned(), |name| format!("G/{name}")),
        ("T-I", _) if is_by_half_spaces(id) => "T-I/hs".to_owned(),
        (family, _) => family.to_owned(),
    }
}

/// Whether tiles are tested by half-spaces only, as earlier versions did under the paper's name.
fn is_by_half_spaces(id: &str) -> bool {
    id.split('/').any(|segment| segment == "hs")
}

/// What differs from the paper's strategy where a record stands in for it: `G over supports`, `T-I by HS
/// only`. `None` where it is the paper's.
pub(crate) fn stand_in(id: &str) -> Option<&'static str> {
    match family(id) {
        "G" if grid_box(id) == Some("supports") => Some("G over supports"),
        "T-I" if is_by_half_spaces(id) => Some("T-I by HS only"),
        _ => None,
    }
}

/// The box of a grid, where it is not that of the lights' positions: `supports` or `surfaces`.
fn grid_box(id: &str) -> Option<&str> {
    id.split('/').find(|segment| ["supports", "surfaces"].contains(segment))
}

/// Whether it finds lights through the hierarchy.
pub(crate) fn is_bvh(id: &str) -> bool {
    id.split('/').any(|segment| segment == "bvh")
}

/// The lossy knob of an id: `cap8`, `reuse4`, `s0.001`, `cone45`, `dif`.
pub(crate) fn knob(id: &str) -> Option<&str> {
    let number = |text: &str| !text.is_empty() && text.bytes().all(|b| b.is_ascii_digit());
    let is_knob = |segment: &&str| {
        let is_threshold = |text: &str| text.parse::<f32>().is_ok();
        *segment == "dif"
            || ["cap", "reuse", "cone"]
                .iter()
                .any(|knob| segment.strip_prefix(knob).is_some_and(number))
            || segment.strip_prefix('s').is_some_and(is_threshold)
    };
    id.split('/').skip(1).find(is_knob)
}

/// The intersection tests of a record, where it has any.
pub(crate) fn tests(record: &Record) -> Option<&str> {
    record.strategy_parameters.get("tests").and_then(|tests| tests.as_str())
}

/// The class that colours a strategy: the same for a family in every chart of a study.
pub(crate) fn class(id: &str) -> String {
    let family = family(id);
    let cutting = || STRATEGIES.iter().filter(|entry| !entry.axes.is_empty());
    match cutting().position(|entry| entry.family == family) {
        Some(ix) => format!("strategy-{}", ix % STRATEGY_COLOURS),
        // These have no groups: None and Clay are grey, as in every chart.
        None => match family {
            "Sphere" => "strategy-6",
            "RasterSphere" => "strategy-7",
            _ => "strategy-none",
        }
        .to_owned(),
    }
}

/// Whether the comparison paper has a strategy: those that cut samples into groups, from the list of
/// all lights, and models whole; not the grid of hybrid lighting, nor a grid over the surfaces. What
/// earlier versions measured in place of a strategy counts too: see [`stand_in`].
pub(crate) fn is_of_the_paper(record: &Record) -> bool {
    let id = record.strategy.as_str();
    let is_parted = family(id) == "M" && !parameters(id).is_empty();
    let is_other = family(id) == "HG" || grid_box(id) == Some("surfaces");
    let is_plain = !is_bvh(id) && !is_parted && !record.is_lossy && !is_other;
    is_plain && STRATEGIES.iter().any(|entry| entry.family == family(id) && !entry.axes.is_empty())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn ids_are_taken_apart() {
        assert_eq!(family("SC-E/48x48x40/bvh/cap8"), "SC-E");
        assert_eq!(parameters("SC-E/48x48x40/bvh"), "48x48x40");
        assert_eq!((parameters("M/bvh"), parameters("M/2/bvh")), ("", "2"));
        assert_eq!(
            (short("M/2/bvh"), short("M/bvh"), short("T-E/28x28")),
            ("M/2".into(), "M".into(), "T-E".into())
        );
        assert_eq!(short("G/20x20x20/bvh"), "G");
        assert_eq!(short("G/20x20x20/supports/bvh"), "G/supports");
        assert_eq!(
            (short("T-I/28x28/hs/bvh"), short("T-I/28x28")),
            ("T-I/hs".into(), "T-I".into())
        );
        assert_eq!(stand_in("G/20x20x20/supports"), Some("G over supports"));
        assert_eq!(stand_in("T-I/28x28/hs"), Some("T-I by HS only"));
        assert_eq!((stand_in("G/20x20x20"), stand_in("SC-I/48x48x40/hs")), (None, None));
        assert_eq!(knob("T-E/28x28/bvh/cap16"), Some("cap16"));
        assert_eq!(knob("T-E/28x28/reuse2"), Some("reuse2"));
        assert_eq!(knob("SC-E/48x48x40/n24/s0.001/bvh"), Some("s0.001"));
        assert_eq!(knob("SC-E/48x48x40/n24/cone45/bvh"), Some("cone45"));
        assert_eq!(knob("T-E/28x28/bvh"), None);
        assert_eq!(knob("T-I/28x28/sat-n"), None);
        assert!(is_bvh("M/bvh") && !is_bvh("M/2"));
    }

    #[test]
    fn every_family_with_groups_has_a_colour_of_its_own() {
        let families = STRATEGIES.iter().filter(|entry| !entry.axes.is_empty());
        let mut classes: Vec<String> = families.map(|entry| class(entry.family)).collect();
        let count = classes.len();
        classes.sort();
        classes.dedup();
        assert_eq!(classes.len(), count);
        assert_eq!(class("None"), "strategy-none");
    }

    #[test]
    fn the_nearest_count_is_so_by_factor() {
        assert_eq!(nearest_count(&[100, 500], 10_000), Some(500));
        assert_eq!(nearest_count(&[0, 10, 1_000], 100), Some(10));
        assert_eq!(nearest_count(&[], 100), None);
    }
}
