//! Selects and groups the records of a study for its page and its claims.

use super::job::Job;
use super::manifest::Done;
use crate::grouping::grouped_by;
use crate::report::format::number;
use crate::report::raster;
use crate::results::{Machine, Record, Results};
use crate::strategy::StrategyId;

/// A record with the job that it comes from.
#[derive(Clone, Copy)]
pub(crate) struct Entry<'a> {
    pub(crate) job: &'a Job,
    pub(crate) record: &'a Record,
    /// Where it was measured.
    machine: &'a Machine,
}

impl<'a> Entry<'a> {
    /// A record of a job that ran on a machine.
    pub(crate) fn new(job: &'a Job, record: &'a Record, machine: &'a Machine) -> Self {
        Self { job, record, machine }
    }
}

impl Entry<'_> {
    /// ` \u{2020}` where rasterisation limits its times, else nothing.
    pub(crate) fn mark(&self) -> &'static str {
        raster::mark(self.machine, self.record)
    }
}

/// ` \u{2020}` where rasterisation limits the times of a strategy among some entries, else nothing.
pub(crate) fn mark(entries: &[Entry<'_>], id: &StrategyId) -> &'static str {
    let same = entries.iter().filter(|entry| entry.record.strategy == *id);
    same.map(Entry::mark).max().unwrap_or_default()
}

/// The name of a strategy in a table of entries, with its mark.
pub(crate) fn marked_name(entries: &[Entry<'_>], id: &StrategyId) -> String {
    format!("{id}{}", mark(entries, id))
}

/// All records of a section that are there, in the order of its jobs.
pub(crate) fn entries<'a>(done: &'a Done, scene: &'a str, section: &'a str) -> Vec<Entry<'a>> {
    let of_job = |(job, results): (&'a Job, &'a Results)| {
        let machine = &results.machine;
        results.records.iter().map(move |record| Entry { job, record, machine })
    };
    done.section(scene, section).flat_map(of_job).collect()
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

/// The poses that a time averages: `240 poses`, or `one pose`.
pub(crate) fn stand(record: &Record) -> String {
    match poses(record) {
        1 => "one pose".to_owned(),
        poses => format!("{} poses", number(poses as f64)),
    }
}

/// What a time stands for: `means of 240 poses`, or `one pose`.
pub(crate) fn means(record: &Record) -> String {
    let mean = if poses(record) > 1 { "means of " } else { "" };
    mean.to_owned() + &stand(record)
}

/// The records of one strategy, with its id, in the order of their lights.
pub(crate) type Line<'a> = (&'a StrategyId, Vec<&'a Record>);

/// The records of each strategy, in the order in which strategies first appear.
pub(crate) fn lines<'a>(entries: &[Entry<'a>]) -> Vec<Line<'a>> {
    let mut lines = grouped_by(entries.iter().map(|entry| (&entry.record.strategy, entry.record)));
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

/// The intersection tests of a record, where it has any.
pub(crate) fn tests(record: &Record) -> Option<String> {
    record.strategy.tests().map(|tests| tests.to_string())
}

/// Whether the comparison paper has what a record measured: a strategy of its own without a lossy knob,
/// or what earlier versions measured in its place (see [`StrategyId::stand_in`]).
pub(crate) fn is_of_the_paper(record: &Record) -> bool {
    record.strategy.is_of_the_paper() && !record.is_lossy
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_nearest_count_is_so_by_factor() {
        assert_eq!(nearest_count(&[100, 500], 10_000), Some(500));
        assert_eq!(nearest_count(&[0, 10, 1_000], 100), Some(10));
        assert_eq!(nearest_count(&[], 100), None);
    }
}
