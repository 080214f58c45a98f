//! Who leads a comparison, said with its limits: a tie is called a tie, and a lead that too few
//! rounds show is called that.

use super::comparison::Comparison;
use super::format::significant;
use super::rank::{Ranked, Ratio, SURE, first, listed};
use crate::results::Record;

/// The segment of an id that says that lights come through the hierarchy.
const HIERARCHY: &str = "bvh";

/// The most names in a sentence; of more, all but [`NAMED`] are counted.
const ALL_NAMED: usize = 4;
/// The names that stand before `and 5 others`.
const NAMED: usize = 3;

/// What keeps a rank from being sure.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Doubt {
    /// Nothing: there are rounds enough, or there is one method.
    None,
    /// So many rounds or laps are too few.
    FewRounds(usize, &'static str),
    /// There are no rounds to pair: only times rank.
    NoRounds,
}

/// The methods that share the first rank.
pub(crate) struct Lead<'a> {
    /// Those methods, fastest first.
    pub(crate) records: Vec<&'a Record>,
    /// Their names, with marks.
    names: Vec<String>,
    /// How many methods were ranked.
    ranked: usize,
    doubt: Doubt,
}

impl<'a> Lead<'a> {
    /// Of ranked records; `None` where there is none.
    pub(crate) fn of(ranked: &[Ranked<'a>]) -> Option<Self> {
        let mut records = first(ranked);
        let leader = *records.first()?;
        let other = ranked.iter().map(|ranked| ranked.record).find(|r| !std::ptr::eq(*r, leader));
        let doubt = match other.map(|other| Ratio::of(other, leader)) {
            None => Doubt::None,
            Some(None) => Doubt::NoRounds,
            Some(Some(ratio)) if ratio.coverage < SURE => {
                let word = if leader.setting.along_path { "laps" } else { "rounds" };
                Doubt::FewRounds(leader.round_times_ms().len(), word)
            }
            Some(Some(_)) => Doubt::None,
        };
        if doubt != Doubt::None {
            records.truncate(1);
        }
        let names = records.iter().map(|record| record.strategy.to_string()).collect();
        Some(Self { records, names, ranked: ranked.len(), doubt })
    }

    /// Of a comparison, whose names carry marks.
    pub(crate) fn of_comparison(comparison: &Comparison<'a>) -> Option<Self> {
        let lead = Self::of(&comparison.ranks())?;
        let names = lead.records.iter().map(|record| comparison.name(record)).collect();
        Some(Self { names, ..lead })
    }

    /// The fastest of them.
    pub(crate) fn leader(&self) -> &'a Record {
        // A lead is made around a record.
        self.records[0]
    }

    /// Whether several share the first rank.
    pub(crate) fn is_tie(&self) -> bool {
        self.records.len() > 1
    }

    /// `A`, `A and B`, `A, B, C and 5 others`.
    pub(crate) fn names(&self) -> String {
        let mut names = self.names.clone();
        if names.len() > ALL_NAMED {
            let others = names.len() - NAMED;
            names.truncate(NAMED);
            names.push(format!("{others} others"));
        }
        listed(&names)
    }

    /// `A is fastest`, or `A and B tie for fastest`.
    pub(crate) fn is_fastest(&self) -> String {
        let verb = if self.is_tie() { "tie for fastest" } else { "is fastest" };
        format!("{} {verb}", self.names())
    }

    /// As [`is_fastest`](Self::is_fastest), with all that limits it but figures: for a headline.
    pub(crate) fn headline(&self) -> String {
        let built = self.records.iter().filter(|record| needs_built_hierarchy(record)).count();
        let still = match built {
            0 => "",
            _ if built == self.records.len() => " (still lights only)",
            _ => " (those with /bvh for still lights only)",
        };
        format!("{}{still}{}", self.is_fastest(), self.doubt())
    }

    /// Why the lead is not sure, to follow its sentence; empty where it is.
    pub(crate) fn doubt(&self) -> String {
        match self.doubt {
            Doubt::None => String::new(),
            Doubt::FewRounds(count, word) => {
                format!(" ({count} {word} are too few to rank {} methods)", self.ranked)
            }
            Doubt::NoRounds => " (ranked by time only; too few rounds to test ties)".to_owned(),
        }
    }

    /// Which of them need lights that stand still, to follow the names; empty where none does.
    pub(crate) fn still_lights(&self) -> String {
        let built: Vec<&Record> =
            self.records.iter().copied().filter(|r| needs_built_hierarchy(r)).collect();
        let Some(one) = built.first() else { return String::new() };
        let time = one
            .times
            .light_build_ms
            .map_or_else(String::new, |build| format!(" built in {} ms", significant(build)));
        match built.len() == self.records.len() {
            true if built.len() == 1 => {
                format!(" (still lights only: uses a hierarchy{time}, not counted in this time)")
            }
            true => format!(
                " (still lights only: they use a hierarchy{time}, not counted in these times)"
            ),
            false => format!(
                " (those with /{HIERARCHY} for still lights only: they use a hierarchy{time}, not \
                 counted in these times)"
            ),
        }
    }
}

/// Whether a method reads a hierarchy over the lights that was built beforehand: its time holds for
/// lights that stand still.
pub fn needs_built_hierarchy(record: &Record) -> bool {
    record.strategy.is_bvh()
}

/// The least and the greatest of a figure over some records, as text: `15.9 to 16.1`. `None` where
/// one lacks it.
pub(crate) fn span(records: &[&Record], figure: impl Fn(&Record) -> Option<f64>) -> Option<String> {
    let figures: Option<Vec<f64>> = records.iter().map(|record| figure(record)).collect();
    let figures = figures?;
    let least = significant(figures.iter().copied().fold(f64::INFINITY, f64::min));
    let most = significant(figures.iter().copied().fold(f64::NEG_INFINITY, f64::max));
    Some(if least == most { least } else { format!("{least} to {most}") })
}
