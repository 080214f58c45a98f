//! Totals and properties of a record.

use super::{Interval, PassKind, Record, Spans, mean, median, median_interval};
use crate::{schedule::frames_of_round, strategy::Role};

impl Record {
    /// Time of assigning and lighting together, ms: the time that strategies are compared by.
    pub fn assign_and_shade_ms(&self) -> f64 {
        self.times.assign_ms + self.times.shade_ms
    }

    /// Sets its times from passes and spans: medians, and means along a path.
    pub fn set_times(&mut self) {
        self.times.assign_ms = self.time_of(|_, kind| kind == PassKind::Assign);
        self.times.shade_ms = self.time_of(|_, kind| kind == PassKind::Shade);
        self.times.frame_ms = self.time_of(|_, _| true);
        let span = |samples: fn(&Spans) -> &[f64]| {
            let samples = samples(self.times.spans.as_ref()?);
            (!samples.is_empty()).then(|| self.middle_ms(samples))
        };
        [self.times.span_ms, self.times.frame_span_ms] = [
            span(|spans| &spans.assign_and_shade_samples_ms),
            span(|spans| &spans.frame_samples_ms),
        ];
    }

    /// The time of the selected passes, summed per frame, ms: median, or mean along a path. 0 without such a
    /// pass.
    pub fn time_of(&self, is_counted: impl Fn(&str, PassKind) -> bool) -> f64 {
        let samples = self.times.passes.per_frame_where(&is_counted);
        match self.times.passes.iter().any(|(name, times)| is_counted(name, times.kind)) {
            true => self.middle_ms(&samples),
            false => 0.0,
        }
    }

    /// The mean along a path, because its frames differ in their work; else the median.
    fn middle_ms(&self, samples: &[f64]) -> f64 {
        if self.setting.along_path { mean(samples) } else { median(samples) }
    }

    /// Assigning and lighting together, frame by frame, ms.
    pub fn frames_ms(&self) -> Vec<f64> {
        let [assign, shade] = [PassKind::Assign, PassKind::Shade]
            .map(|kind| self.times.passes.per_frame_ms(Some(kind)));
        let at = |list: &[f64], frame: usize| list.get(frame).copied().unwrap_or(0.0);
        (0..assign.len().max(shade.len())).map(|f| at(&assign, f) + at(&shade, f)).collect()
    }

    /// Laps of the camera along its path; 0 for a still camera.
    pub fn laps(&self) -> u32 {
        match (self.setting.along_path, self.setting.poses) {
            (false, _) => 0,
            (true, Some(poses @ 1..)) => (self.times.frames / poses).max(1),
            (true, _) => 1,
        }
    }

    /// The time of each round, assigning and lighting together, ms. For a still camera, the time of a round is
    /// the median of its frames. Along a path, a round is a lap, and its time is the mean over the poses.
    /// Intervals and comparisons of methods use these times, because frames of one round are not independent
    /// and poses are not repetitions.
    pub fn round_times_ms(&self) -> Vec<f64> {
        let frames = self.frames_ms();
        let count = u32::try_from(frames.len()).unwrap_or(u32::MAX);
        let rounds = if self.setting.along_path { self.laps() } else { self.times.rounds };
        let rounds = rounds.clamp(1, count.max(1));
        let time = if self.setting.along_path { mean } else { median };
        (0..rounds)
            .map(|round| {
                let range = frames_of_round(round, rounds, count);
                time(frames.get(range.start as usize..range.end as usize).unwrap_or(&[]))
            })
            .collect()
    }

    /// The time at each pose of the path, as a mean over the laps, ms. For a still camera, the time of each
    /// frame.
    pub fn pose_times_ms(&self) -> Vec<f64> {
        let frames = self.frames_ms();
        let poses = frames.len() / self.laps().max(1) as usize;
        if !self.setting.along_path || poses == 0 {
            return frames;
        }
        let at = |pose| frames.iter().copied().skip(pose).step_by(poses).collect::<Vec<f64>>();
        (0..poses).map(|pose| mean(&at(pose))).collect()
    }

    /// The confidence interval of [`assign_and_shade_ms`](Self::assign_and_shade_ms), from its rounds. Along a
    /// path, every lap has the same poses, so laps differ only by noise, and the interval is valid for these
    /// poses only. `None` for one round or lap.
    pub fn interval_ms(&self) -> Option<Interval> {
        median_interval(&self.round_times_ms())
    }

    /// Whether this is the strategy without culling.
    pub fn is_baseline(&self) -> bool {
        self.strategy.role() == Some(Role::Baseline)
    }

    /// Whether this is the control without lights.
    pub fn is_control(&self) -> bool {
        self.strategy.role() == Some(Role::Control)
    }

    /// Whether it culls lights before shading: true for all methods except no culling (with or without the
    /// early exit) and the control.
    pub fn culls(&self) -> bool {
        !self.is_baseline() && !self.is_control() && self.strategy.role() != Some(Role::EarlyExit)
    }

    /// Whether it is exact: no setting loses light, no loss is known, and the run tested it.
    pub fn is_exact(&self) -> bool {
        self.shows_no_loss() && self.lists.untested.is_none()
    }

    /// Why its run tested no method; `None` if it tested them, and for records older than this field.
    pub fn untested_words(&self) -> Option<&'static str> {
        self.lists.untested.map(|why| why.words(self.setting.lights, self.setting.along_path))
    }

    /// Whether no setting loses light and no loss is known, tested or not.
    pub fn shows_no_loss(&self) -> bool {
        !self.is_lossy && self.is_lossless()
    }

    /// Whether no measurement shows a loss: no missed pair, and no channel that differs by more than the method
    /// allows itself.
    pub fn is_lossless(&self) -> bool {
        let same = self.image.differing_channels.unwrap_or(0) == 0
            && self.image.max_abs_diff.unwrap_or(0.0) == 0.0;
        let tolerated = self.image.tolerance.is_some_and(|most| {
            self.image.max_rel_diff.is_some_and(|difference| difference <= most)
        });
        self.lists.missed_pairs.unwrap_or(0) == 0 && (same || tolerated)
    }
}
