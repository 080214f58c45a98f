//! The records of the survey by renderer and method, and what several parts say together.

use crate::report::format::significant;
use crate::results::Record;
use crate::strategy::Role;
use crate::study::culling::jobs::CLUSTERS;
use crate::study::data::{counts, entries};
use crate::study::manifest::Done;

/// The sections of the study: how pixels are lit.
const MODES: [&str; 2] = ["deferred", "forward"];

/// The records of one renderer.
pub(crate) struct Mode<'a> {
    pub(crate) name: &'static str,
    pub(crate) records: Vec<&'a Record>,
    pub(crate) counts: Vec<u64>,
}

impl<'a> Mode<'a> {
    /// Both renderers, where they were measured.
    pub(crate) fn all(done: &'a Done, scene: &'a str) -> Vec<Self> {
        let mode = |name: &'static str| {
            let entries = entries(done, scene, name);
            let counts = counts(&entries);
            let times = entries.iter().map(|entry| entry.record);
            Self { name, records: times.filter(|r| r.times.frame_ms.is_finite()).collect(), counts }
        };
        MODES.into_iter().map(mode).filter(|mode| !mode.records.is_empty()).collect()
    }

    pub(crate) fn most(&self) -> u64 {
        self.counts.last().copied().unwrap_or(0)
    }

    /// Counts of at least one light.
    pub(crate) fn lit(&self) -> impl Iterator<Item = u64> + '_ {
        self.counts.iter().copied().filter(|count| *count > 0)
    }

    pub(crate) fn at(&self, lights: u64, is_it: impl Fn(&Record) -> bool) -> Option<&'a Record> {
        self.records.iter().copied().find(|record| record.setting.lights == lights && is_it(record))
    }

    /// At the most lights.
    pub(crate) fn last(&self, is_it: impl Fn(&Record) -> bool) -> Option<&'a Record> {
        self.at(self.most(), is_it)
    }

    /// What lights cost: the frame at the most lights less that without a light, ms.
    pub(crate) fn growth(&self, is_it: impl Fn(&Record) -> bool + Copy) -> Option<f64> {
        let frames = (self.last(is_it)?.times.frame_ms, self.at(0, is_it)?.times.frame_ms);
        (self.most() > 0).then_some(frames.0 - frames.1)
    }
}

pub(crate) fn none(record: &Record) -> bool {
    record.is_baseline()
}

pub(crate) fn bounding_sphere(record: &Record) -> bool {
    record.strategy.role() == Some(Role::EarlyExit)
}

pub(crate) fn raster_sphere(record: &Record) -> bool {
    record.strategy.shade_rasterises()
}

pub(crate) fn is_cluster(record: &Record) -> bool {
    record.strategy.row().is_some_and(|row| row.family == CLUSTERS)
}

/// The paper's clusters, whose lists end at the cap.
pub(crate) fn capped(record: &Record) -> bool {
    is_cluster(record) && record.strategy.knob().is_some()
}

/// The same with whole lists.
pub(crate) fn whole(record: &Record) -> bool {
    is_cluster(record) && record.strategy.knob().is_none()
}

/// The methods of the survey that cull.
pub(crate) fn of_the_survey(record: &Record) -> bool {
    bounding_sphere(record) || raster_sphere(record) || capped(record)
}

pub(crate) fn timed(record: &Record) -> String {
    format!("{} {} ms", record.strategy, significant(record.times.frame_ms))
}
