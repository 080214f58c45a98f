//! `--mode`: one way to light pixels, or several one after another.

use clap::builder::TypedValueParser;
use shading::Mode;

use super::named::named;

/// Each mode, with its line of help.
pub(super) const MODES: [(Mode, &str); 4] = [
    (Mode::Deferred, "From a G-buffer, in a compute pass"),
    (Mode::Forward, "In the fragment shader that draws the surfaces"),
    (Mode::DeferredIds, "From a G-buffer that also holds the model of each pixel"),
    (
        Mode::ForwardNoPrepass,
        "As forward, without a depth pre-pass; a strategy that reads depth draws one and pays for it",
    ),
];

/// The modes to run.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Modes {
    /// One mode.
    One(Mode),
    /// Deferred and forward.
    Both,
    /// The three frames of a renderer.
    Frames,
    /// Every mode.
    All,
}

impl Modes {
    /// The modes to run, in order.
    pub fn modes(self) -> &'static [Mode] {
        const ALL: &[Mode] = &Mode::ALL;
        match self {
            Self::One(mode) => ALL.chunks(1).find(|one| one.contains(&mode)).unwrap_or_default(),
            Self::Both => &[Mode::Deferred, Mode::Forward],
            Self::Frames => &[Mode::ForwardNoPrepass, Mode::Forward, Mode::DeferredIds],
            Self::All => ALL,
        }
    }

    /// The name on the command line.
    pub fn name(self) -> &'static str {
        match self {
            Self::One(mode) => mode.name(),
            Self::Both => "both",
            Self::Frames => "frames",
            Self::All => "all",
        }
    }

    pub(super) fn parser() -> impl TypedValueParser<Value = Self> {
        let single = MODES.map(|(mode, help)| (Self::One(mode), help));
        let several = [
            (Self::Both, "Deferred, then forward"),
            (
                Self::Frames,
                "The three frames of a renderer: forward-no-prepass, forward and deferred-ids",
            ),
            (Self::All, "All four modes"),
        ];
        named(single.into_iter().chain(several), Self::name)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_mode_can_be_named() {
        for mode in Mode::ALL {
            assert!(MODES.iter().any(|(known, _)| *known == mode), "{mode:?}");
            assert_eq!(Modes::One(mode).modes(), [mode]);
        }
    }
}
