//! The verdict of a scene's figures on a claim.

/// The verdict on a claim.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(crate) enum Verdict {
    /// The figures confirm it.
    Holds,
    /// The figures contradict it.
    Fails,
    /// The figures confirm a part of it, which the text names.
    Differs(String),
    /// The figures decide nothing; the text says why.
    Unknown(String),
}

impl Verdict {
    /// The figures that decide it are missing; `what` names them.
    pub(crate) fn unmeasured(what: &str) -> Self {
        Self::Unknown(format!("not measured: {what}"))
    }

    /// There are figures, but they cannot decide the claim; `why` says why.
    pub(crate) fn undecided(why: &str) -> Self {
        Self::Unknown(format!("not decided: {why}"))
    }

    /// Holds where all of the parts do, fails where none does.
    pub(crate) fn of_parts(good: usize, all: usize, what: &str) -> Self {
        match (good, all) {
            (_, 0) => Self::unmeasured(&format!("no {what}")),
            (good, all) if good == all => Self::Holds,
            (0, _) => Self::Fails,
            (good, all) => Self::Differs(format!("holds for {good} of {all} {what}")),
        }
    }

    /// Adds notes on what was not measured or what stands in for it; with a note, a claim cannot hold
    /// outright.
    pub(crate) fn qualified(self, notes: &[String]) -> Self {
        match self {
            Self::Holds if !notes.is_empty() => Self::Differs(notes.join("; ")),
            Self::Differs(why) if !notes.is_empty() => {
                Self::Differs(format!("{why}; {}", notes.join("; ")))
            }
            other => other,
        }
    }

    /// For the page's markup.
    pub(crate) fn id(&self) -> &'static str {
        match self {
            Self::Holds => "holds",
            Self::Fails => "fails",
            Self::Differs(_) => "differs",
            Self::Unknown(_) => "unknown",
        }
    }

    pub(crate) fn text(&self) -> String {
        match self {
            Self::Holds => "holds".to_owned(),
            Self::Fails => "does not hold".to_owned(),
            Self::Differs(why) => format!("differs: {why}"),
            Self::Unknown(why) => why.clone(),
        }
    }
}

/// The answer of one scene to a claim.
#[derive(Clone, Debug)]
pub(crate) struct Answer {
    /// Our figures.
    pub(crate) figure: String,
    pub(crate) verdict: Verdict,
}

impl Answer {
    /// An answer without figures; `what` was not measured.
    pub(crate) fn unknown(what: &str) -> Self {
        Self { figure: String::new(), verdict: Verdict::unmeasured(what) }
    }

    /// An answer without figures, and why figures would decide nothing.
    pub(crate) fn undecided(why: &str) -> Self {
        Self { figure: String::new(), verdict: Verdict::undecided(why) }
    }
}
