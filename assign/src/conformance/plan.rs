//! What a case draws: stages with their lights, one after the other.

use super::{
    stage::{Rng, Stage, room},
    views::{self, SIZE},
};
use crate::{Light, View};

/// A stage with its lights.
#[derive(Clone, Debug)]
pub(super) struct Lit {
    pub(super) stage: Stage,
    pub(super) lights: Vec<Light>,
    /// Whether look-ups are only on opaque surfaces.
    pub(super) opaque_only: bool,
}

/// What a case draws.
pub(super) enum Plan {
    /// One stage.
    Still(Lit),
    /// Several stages in sequence with one instance.
    Sequence(Vec<Lit>),
    /// Lights that change in every frame, which the GPU sorts.
    Living(Living),
    /// A pool that is far too small, then a sufficient one.
    Overflow(Lit),
    /// A stage without and with faulty lights, and the faulty lights' indices.
    Quarantine { clean: Lit, dirty: Box<Lit>, bad: Vec<usize> },
}

/// Frames of lights that the GPU sorts.
pub(super) struct Living {
    /// Each frame's lights, faulty ones among them, with one instance.
    pub(super) frames: Vec<Lit>,
    /// The number of faulty lights of each frame.
    pub(super) bad: usize,
    /// The lights are sorted in every `every`th frame.
    pub(super) every: u32,
    /// Whether the lights are written into buffers of the renderer's own, which the CPU never reads.
    pub(super) from_gpu: bool,
}

pub(super) fn default_view() -> View {
    views::sized(SIZE)
}

/// `view` of a room.
pub(super) fn in_room(rng: &mut Rng, view: &View) -> Stage {
    let port = view.viewport;
    let target = [port.x + port.width, port.y + port.height];
    Stage::new(*view, target, &room(rng, 1.0), 1_000)
}
