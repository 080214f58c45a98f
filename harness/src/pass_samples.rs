//! Collects the times of passes, frame by frame.

use shading::Mode;

use crate::{
    clock::{FrameTimes, PassTime},
    results::{PassKind, PassTimes, Passes, Spans, pass_kind},
};

/// The times of every pass over the frames so far.
#[derive(Clone, Debug)]
pub struct PassSamples {
    mode: Mode,
    passes: Vec<(String, PassKind, Vec<f64>)>,
    frames: usize,
    /// `None` after a frame without spans.
    spans: Option<Spans>,
}

impl Default for PassSamples {
    fn default() -> Self {
        Self::new(Mode::Deferred)
    }
}

impl PassSamples {
    /// No frames yet. The mode decides which methods pay for a pass.
    pub fn new(mode: Mode) -> Self {
        Self { mode, passes: Vec::new(), frames: 0, spans: Some(Spans::default()) }
    }

    /// Adds a frame's times. A pass that is missing in a frame takes 0 ms.
    pub fn collect(&mut self, times: Vec<PassTime>) {
        for (name, ms) in times {
            match self.passes.iter_mut().find(|(known, ..)| *known == name) {
                Some((.., list)) => list.push(ms),
                None => {
                    let mut list = vec![0.0; self.frames];
                    list.push(ms);
                    let kind = pass_kind(&name, self.mode);
                    self.passes.push((name, kind, list));
                }
            }
        }
        self.frames += 1;
        for (.., list) in &mut self.passes {
            list.resize(self.frames, 0.0);
        }
    }

    /// Adds a frame's times, and its two spans if it has any.
    pub fn collect_frame(&mut self, times: FrameTimes) {
        let mode = self.mode;
        let is_billed =
            |name: &str| matches!(pass_kind(name, mode), PassKind::Assign | PassKind::Shade);
        match (&mut self.spans, times.span_ms(is_billed), times.span_ms(|_| true)) {
            (Some(spans), Some(billed), Some(frame)) => {
                spans.assign_and_shade_samples_ms.push(billed);
                spans.frame_samples_ms.push(frame);
            }
            _ => self.spans = None,
        }
        self.collect(times.passes);
    }

    /// The passes with their statistics.
    pub fn finish(self) -> Passes {
        self.finish_frames().0
    }

    /// The passes with their statistics, and the spans if every frame has them.
    pub fn finish_frames(self) -> (Passes, Option<Spans>) {
        let times = |(name, kind, samples)| (name, PassTimes::new(kind, samples));
        let spans = self.spans.filter(|spans| spans.frame_samples_ms.len() == self.frames);
        (self.passes.into_iter().map(times).collect(), spans)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn frame(intervals: Option<[f64; 2]>) -> FrameTimes {
        let passes = ["depth", "cull", "shade"].map(|name| (name.to_owned(), 1.0)).to_vec();
        let [cull, shade] = intervals.unwrap_or_default();
        let at = |name: &str, begin: f64| (name.to_owned(), [begin, begin + 1.0]);
        let all = vec![at("depth", 0.0), at("cull", cull), at("shade", shade)];
        FrameTimes { passes, intervals: intervals.map(|_| all) }
    }

    #[test]
    fn spans_are_stored_only_if_every_frame_has_them() {
        let mut samples = PassSamples::default();
        samples.collect_frame(frame(Some([1.5, 3.0])));
        samples.collect_frame(frame(Some([2.0, 3.0])));
        let (passes, spans) = samples.clone().finish_frames();
        let spans = spans.expect("two frames with spans");
        assert_eq!(spans.assign_and_shade_samples_ms, [2.5, 2.0]);
        assert_eq!(spans.frame_samples_ms, [4.0, 4.0]);
        assert_eq!(passes.per_frame_ms(None), [3.0, 3.0]);
        samples.collect_frame(frame(None));
        assert_eq!(samples.finish_frames().1, None);
    }

    #[test]
    fn a_method_pays_for_the_depth_pre_pass_in_a_mode_without_one() {
        let kind = |mode: Mode| {
            let mut samples = PassSamples::new(mode);
            samples.collect_frame(frame(Some([1.5, 3.0])));
            let (passes, spans) = samples.finish_frames();
            let spans = spans.expect("spans").assign_and_shade_samples_ms;
            (passes.get("depth").expect("depth").kind, spans)
        };
        assert_eq!(kind(Mode::Forward), (PassKind::Scene, vec![2.5]));
        assert_eq!(kind(Mode::ForwardNoPrepass), (PassKind::Assign, vec![4.0]));
    }
}
