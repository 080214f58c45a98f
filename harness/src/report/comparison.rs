//! Records that may be compared with one another.

use super::rank::{Ranked, ranks};
use super::raster;
use crate::results::{Machine, Record, Results};
use crate::strategy::EARLY_EXIT;

/// The records of one scene, camera path, image size, set of lights with its motion and order, and mode. Only
/// strategies differ.
pub(crate) struct Comparison<'a> {
    /// The records with their indices in [`Results::records`], in the order of the run.
    pub(crate) records: Vec<(usize, &'a Record)>,
    /// Where they were measured.
    pub(crate) machine: &'a Machine,
    /// The command line of their run.
    pub(crate) command: &'a [String],
}

/// All comparisons of a run, in the order in which they first appear.
pub(crate) fn comparisons(results: &Results) -> Vec<Comparison<'_>> {
    let mut all: Vec<Comparison<'_>> = Vec::new();
    for entry in results.records.iter().enumerate() {
        match all.iter_mut().find(|known| comparable(known.first(), entry.1)) {
            Some(known) => known.records.push(entry),
            None => all.push(Comparison {
                records: vec![entry],
                machine: &results.machine,
                command: &results.command,
            }),
        }
    }
    all
}

fn comparable(a: &Record, b: &Record) -> bool {
    let key = |r: &Record| {
        (
            (
                r.setting.scene_scale.to_bits(),
                r.setting.radius_scale.to_bits(),
                r.setting.seed,
                r.setting.lights,
            ),
            (r.setting.mode, r.setting.width, r.setting.height),
        )
    };
    let is_same_scene =
        a.setting.scene == b.setting.scene && a.setting.scene_hash == b.setting.scene_hash;
    let is_same_motion =
        a.setting.motion == b.setting.motion && a.setting.light_order == b.setting.light_order;
    is_same_scene
        && is_same_motion
        && a.setting.layers == b.setting.layers
        && a.setting.msaa == b.setting.msaa
        && a.setting.path_hash == b.setting.path_hash
        && key(a) == key(b)
}

impl<'a> Comparison<'a> {
    /// The first record: it speaks for the scene, the lights and the mode.
    pub(crate) fn first(&self) -> &'a Record {
        // A comparison is made around a record and never loses one.
        self.records[0].1
    }

    /// The records, in the order of the run.
    pub(crate) fn all(&self) -> impl Iterator<Item = &'a Record> {
        self.records.iter().map(|(_, record)| *record)
    }

    /// A record's name, with a mark if rasterisation limits its times on a chip that is weak at it.
    pub(crate) fn name(&self, record: &Record) -> String {
        format!("{}{}", record.strategy, raster::mark(self.machine, record))
    }

    /// The record without culling.
    pub(crate) fn baseline(&self) -> Option<&'a Record> {
        self.all().find(|record| record.is_baseline())
    }

    /// How many times as fast as no culling, by assign + shade.
    pub(crate) fn speedup(&self, record: &Record) -> Option<f64> {
        self.speedup_over(self.baseline()?, record)
    }

    /// How many times as fast as another record, by assign + shade.
    pub(crate) fn speedup_over(&self, other: &Record, record: &Record) -> Option<f64> {
        if record.is_control() {
            return None;
        }
        let ratio = other.assign_and_shade_ms() / record.assign_and_shade_ms();
        ratio.is_finite().then_some(ratio)
    }

    /// How many times as fast as no culling with an early exit; only of strategies with lists.
    pub(crate) fn speedup_over_exit(&self, record: &Record) -> Option<f64> {
        if !record.culls() || record.lists.listed_per_sample.is_none() {
            return None;
        }
        self.speedup_over(self.record_of(EARLY_EXIT)?, record)
    }

    /// The rank of a record by assign + shade: see [`ranks`].
    pub(crate) fn rank(&self, record: &Record) -> Option<f64> {
        let ranked = self.ranks();
        let place = ranked.iter().find(|ranked| std::ptr::eq(ranked.record, record));
        place.map(|ranked| f64::from(ranked.rank))
    }

    /// The records that cull without a loss, by rank.
    pub(crate) fn ranks(&self) -> Vec<Ranked<'a>> {
        ranks(self.all())
    }

    /// The record of a strategy.
    pub(crate) fn record_of(&self, strategy: &str) -> Option<&'a Record> {
        self.all().find(|record| record.strategy == strategy)
    }

    /// The ideal time, ms: what no culling would need, at its own rate, if it evaluated only the lights
    /// that reach each sample.
    pub(crate) fn ideal_ms(&self, record: &Record) -> Option<f64> {
        let baseline = self.baseline()?;
        let ideal = baseline.times.shade_ms * record.lists.contributing_per_sample?
            / baseline.setting.lights as f64;
        ideal.is_finite().then_some(ideal)
    }

    /// Efficiency = ideal time / (assign + shade).
    pub(crate) fn efficiency(&self, record: &Record) -> Option<f64> {
        if record.is_control() {
            return None;
        }
        let share = self.ideal_ms(record)? / record.assign_and_shade_ms();
        share.is_finite().then_some(share)
    }

    /// The fastest strategy that culls, lossless ones first.
    pub(crate) fn fastest(&self) -> Option<&'a Record> {
        let candidates = |lossless: bool| {
            self.all()
                .filter(|record| record.culls() && !record.is_lossy)
                .filter(move |record| record.is_lossless() || !lossless)
                .filter(|record| record.assign_and_shade_ms().is_finite())
                .min_by(|a, b| a.assign_and_shade_ms().total_cmp(&b.assign_and_shade_ms()))
        };
        candidates(true).or_else(|| candidates(false))
    }
}
