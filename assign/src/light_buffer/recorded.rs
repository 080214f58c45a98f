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
        let recorded = self.lights.recorded.load(Ordering::Relaxed);
        if recorded >= self.given { Ok(()) } else { Err(AssignError::LightsNotRecorded) }
    }
}
