//! What the figures of a scene say of a claim.

/// What the figures say of a claim.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(in crate::report::study) enum Verdict {
    /// They bear it out.
    Holds,
    /// They contradict it.
    Fails,
    /// They bear a part of it out: which.
    Differs(String),
    /// They were not measured: what lacks.
    Unknown(String),
}

impl Verdict {
    /// Holds where all of the parts do, fails where none does.
    pub(in crate::report::study) fn of_parts(good: usize, all: usize, what: &str) -> Self {
        match (good, all) {
            (_, 0) => Self::Unknown(format!("no {what}")),
            (good, all) if good == all => Self::Holds,
            (0, _) => Self::Fails,
            (good, all) => Self::Differs(format!("{good} of {all} {what}")),
        }
    }

    /// For the page's markup.
    pub(in crate::report::study) fn id(&self) -> &'static str {
        match self {
            Self::Holds => "holds",
            Self::Fails => "fails",
            Self::Differs(_) => "differs",
            Self::Unknown(_) => "unknown",
        }
    }

    pub(in crate::report::study) fn text(&self) -> String {
        match self {
            Self::Holds => "holds".to_owned(),
            Self::Fails => "does not hold".to_owned(),
            Self::Differs(why) => format!("differs: {why}"),
            Self::Unknown(why) => format!("not measured: {why}"),
        }
    }
}

/// What one scene says of a claim.
#[derive(Clone, Debug)]
pub(in crate::report::study) struct Answer {
    /// Our figures.
    pub(in crate::report::study) figure: String,
    pub(in crate::report::study) verdict: Verdict,
}

impl Answer {
    pub(in crate::report::study) fn unknown(why: &str) -> Self {
        Self { figure: String::new(), verdict: Verdict::Unknown(why.to_owned()) }
    }
}
