//! Times of passes, frame by frame.

use crate::{
    clock::PassTime,
    results::{PassKind, PassTimes, Passes},
};

/// The times of every pass over the frames so far.
#[derive(Clone, Debug, Default)]
pub struct PassSamples {
    passes: Vec<(String, PassKind, Vec<f64>)>,
    frames: usize,
}

impl PassSamples {
    /// Adds a frame's times; a pass that a frame did without took 0 ms.
    pub fn collect(&mut self, times: Vec<PassTime>) {
        for (name, ms) in times {
            match self.passes.iter_mut().find(|(known, ..)| *known == name) {
                Some((.., list)) => list.push(ms),
                None => {
                    let mut list = vec![0.0; self.frames];
                    list.push(ms);
                    let kind = pass_kind(&name);
                    self.passes.push((name, kind, list));
                }
            }
        }
        self.frames += 1;
        for (.., list) in &mut self.passes {
            list.resize(self.frames, 0.0);
        }
    }

    /// The passes with their statistics.
    pub fn finish(self) -> Passes {
        let times = |(name, kind, samples)| (name, PassTimes::new(kind, samples));
        self.passes.into_iter().map(times).collect()
    }
}

/// Which bill a pass is on: what the pipeline does not know is a strategy's own.
pub fn pass_kind(name: &str) -> PassKind {
    match name {
        "depth" | "gbuffer" => PassKind::Scene,
        "shade" | "clay" => PassKind::Shade,
        _ => PassKind::Assign,
    }
}
