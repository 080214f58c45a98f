//! What a strategy did in a scenario, in one word.

use crate::report::error_words;
use crate::report::format::{difference, number};
use crate::results::Record;

/// From the best to the worst.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub(crate) enum Outcome {
    /// Nothing could be tested, because the scenario has no lit sample.
    Untested,
    /// Refused before the first frame, with a reason.
    Refused,
    /// No missed pair, and the image of no culling in every bit (or within the tolerance that the row states).
    Exact,
    /// The method states a loss, and the image shows one.
    Lossy,
    /// It loses light, or differs from no culling, and promises not to. Also: it fails on purpose, and did.
    Wrong,
}

impl Outcome {
    /// All, from the best to the worst.
    pub(crate) const ALL: [Self; 5] =
        [Self::Untested, Self::Refused, Self::Exact, Self::Lossy, Self::Wrong];

    /// The outcome of a record.
    pub(crate) fn of(record: &Record) -> Self {
        match record {
            _ if !record.is_lossless() && record.is_lossy => Self::Lossy,
            _ if !record.is_lossless() => Self::Wrong,
            _ if record.lists.untested.is_some() => Self::Untested,
            _ => Self::Exact,
        }
    }

    /// The style class, and the word.
    pub(crate) fn name(self) -> &'static str {
        match self {
            Self::Untested => "untested",
            Self::Refused => "refused",
            Self::Exact => "exact",
            Self::Lossy => "lossy",
            Self::Wrong => "wrong",
        }
    }

    /// A sign that tells it without colour.
    pub(crate) fn sign(self) -> &'static str {
        match self {
            Self::Untested => "\u{25cb}",
            Self::Refused => "\u{2013}",
            Self::Exact => "\u{2713}",
            Self::Lossy => "\u{2248}",
            Self::Wrong => "\u{2717}",
        }
    }

    /// What it means.
    pub(crate) fn meaning(self) -> &'static str {
        match self {
            Self::Untested => "no light reaches a visible sample, so nothing was tested",
            Self::Refused => "refused before the first frame, with the reason",
            Self::Exact => {
                "every image is that of no culling in every bit (of rasterised light volumes, within 0.1 %), and where lists \
                 were checked, which is in still frames, no (light, sample) pair is missed"
            }
            Self::Lossy => "the method states that it loses light, and it did",
            Self::Wrong => {
                "light is lost, or the image differs, and the method promises that it does not, or fails on purpose"
            }
        }
    }
}

/// What a record shows, in words.
pub(crate) fn words(record: &Record) -> String {
    match Outcome::of(record) {
        Outcome::Untested => record.untested_words().unwrap_or_default().to_owned(),
        Outcome::Lossy | Outcome::Wrong => loss_words(record),
        Outcome::Exact | Outcome::Refused => exact_words(record),
    }
}

fn exact_words(record: &Record) -> String {
    let mut words = Vec::new();
    words.push(match record.lists.checked_pairs {
        Some(pairs) => format!("0 of {} pairs missed", number(pairs as f64)),
        None => "lists not checked".to_owned(),
    });
    match record.image.differing_channels {
        Some(0) => words.push("0 channels differ".to_owned()),
        Some(_) => words.push(format!(
            "differs by at most {} of a channel\u{2019}s value, which is allowed",
            difference(record.image.max_rel_diff.unwrap_or(0.0))
        )),
        None => {}
    }
    words.join(", ")
}

fn loss_words(record: &Record) -> String {
    let mut words = Vec::new();
    if let Some(missed) = record.lists.missed_pairs.filter(|missed| *missed > 0) {
        let checked = record.lists.checked_pairs.unwrap_or(0);
        words.push(format!("{} of {} pairs missed", number(missed as f64), number(checked as f64)));
    }
    if let Some(channels) = record.image.differing_channels {
        words.push(format!("{} channels differ", number(channels as f64)));
    }
    words.push(error_words(record));
    words.retain(|words| !words.is_empty());
    words.join(", ")
}
