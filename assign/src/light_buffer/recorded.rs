//! Finds frames that read lights which the GPU orders, but never ordered.

use std::sync::{
    Arc,
    atomic::{AtomicU64, Ordering},
};

use crate::AssignError;

/// How often lights were given, and which of these lights were recorded last.
#[derive(Debug, Default)]
pub(crate) struct RecordedLights {
    given: AtomicU64,
    recorded: AtomicU64,
}

impl RecordedLights {
    /// New lights were given.
    pub(crate) fn give(&self) {
        self.given.fetch_add(1, Ordering::Relaxed);
    }

    /// Their passes were recorded.
    pub(crate) fn record(&self) {
        self.recorded.store(self.given.load(Ordering::Relaxed), Ordering::Relaxed);
    }

    /// Whether the lights that were given last were recorded.
    pub(crate) fn is_recorded(&self) -> bool {
        self.has_recorded(self.given.load(Ordering::Relaxed))
    }

    /// Whether the lights of this number, or later ones, were recorded.
    fn has_recorded(&self, given: u64) -> bool {
        self.recorded.load(Ordering::Relaxed) >= given
    }
}

/// The lights of one frame.
#[derive(Debug)]
pub(crate) struct FrameLights {
    lights: Arc<RecordedLights>,
    given: u64,
}

impl FrameLights {
    /// The lights as they are given now.
    pub(crate) fn of(lights: &Arc<RecordedLights>) -> Self {
        Self { lights: lights.clone(), given: lights.given.load(Ordering::Relaxed) }
    }

    /// Checks that these lights, or later ones, were recorded.
    pub(crate) fn check(&self) -> Result<(), AssignError> {
        let is_recorded = self.lights.has_recorded(self.given);
        if is_recorded { Ok(()) } else { Err(AssignError::LightsNotRecorded) }
    }
}
