//! What a family refuses before the first frame, and why.

use shading::Mode;

/// Modes in which a family cannot light pixels.
#[derive(Clone, Copy, Debug)]
pub struct Refusal {
    /// The modes.
    pub modes: &'static [Mode],
    /// The reason, to follow "because".
    pub why: &'static str,
}
