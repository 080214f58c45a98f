//! Who leads a comparison, with the limits of that lead: ties, too few rounds, lights that must stand still.

use assign::LightOrder;

use super::comparison::Comparison;
use super::format::significant;
use super::living;
use super::rank::{Ranked, Ratio, SURE, few_listed, first};
use crate::results::Record;

/// What makes a rank unsure.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Doubt {
    /// Nothing: there are enough rounds, or there is only one strategy.
    None,
    /// This number of rounds or laps is too small.
    FewRounds(usize, &'static str),
    /// There are no rounds to pair, so the times alone decide.
    NoRounds,
}

/// The strategies that share the first rank.
pub(crate) struct Lead<'a> {
    /// Their records, fastest first.
    pub(crate) records: Vec<&'a Record>,
    /// Their names, with marks.
    names: Vec<String>,
    /// How many strategies were ranked.
    ranked: usize,
    doubt: Doubt,
}

impl<'a> Lead<'a> {
    /// Of ranked records; `None` where there is none.
    pub(crate) fn from_ranks(ranked: &[Ranked<'a>]) -> Option<Self> {
        let mut records = first(ranked);
        let leader = *records.first()?;
        let other = ranked.iter().map(|ranked| ranked.record).find(|r| !std::ptr::eq(*r, leader));
        let doubt = match other.map(|other| Ratio::between(other, leader)) {
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
        let lead = Self::from_ranks(&comparison.ranks())?;
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
        few_listed(self.names.clone())
    }

    /// `A is fastest`, or `A and B tie for fastest`.
    pub(crate) fn is_fastest(&self) -> String {
        let verb = if self.is_tie() { "tie for fastest" } else { "is fastest" };
        format!("{} {verb}", self.names())
    }

    /// What the id of a single leader means, for a headline; empty where several tie.
    pub(crate) fn meaning(&self) -> String {
        let Some(row) = self.leader().strategy.row().filter(|_| !self.is_tie()) else {
            return String::new();
        };
        let source = match needs_built_hierarchy(self.leader()) {
            true => {
                " /bvh means that the strategy reads a hierarchy over the lights, which is built once, before \
                 the first frame."
            }
            false => "",
        };
        format!(" {} means \u{201c}{}\u{201d}.{source}", row.family, row.name)
    }

    /// Why the lead is not sure, to follow its sentence; empty where it is sure.
    pub(crate) fn doubt(&self) -> String {
        match self.doubt {
            Doubt::None => String::new(),
            Doubt::FewRounds(count, word) => {
                format!(" ({count} {word} are too few to rank {} strategies)", self.ranked)
            }
            Doubt::NoRounds => " (ranked by time only: too few rounds to test ties)".to_owned(),
        }
    }

    /// Whether all of them need lights that stand still.
    pub(crate) fn all_need_still_lights(&self) -> bool {
        self.built().count() == self.records.len()
    }

    /// How the lights move, or that some of them, but not all, need lights that stand still; empty otherwise.
    pub(crate) fn lights_of_some(&self) -> String {
        if let Some(motion) = &self.leader().setting.motion {
            return format!(" (lights move: {})", motion.law);
        }
        match self.built().next() {
            Some(_) if !self.all_need_still_lights() => {
                " (ids with /bvh: only if no light moves)".to_owned()
            }
            _ => String::new(),
        }
    }

    /// How the lights move, or which of them need lights that stand still, to follow the names; empty where
    /// neither is to be said.
    pub(crate) fn lights(&self) -> String {
        match self.all_need_still_lights() {
            true => " if no light moves".to_owned(),
            false => self.lights_of_some(),
        }
    }

    /// Sentences on what moving lights cost the leader, or on the hierarchy that some of them read; `None`
    /// where there is neither.
    pub(crate) fn cost_of_lights(&self) -> Option<String> {
        if let Some(words) = living::motion_words(&self.leader().setting) {
            let cost = living::cost_words(self.leader());
            return Some(format!("The lights move: {words}. {cost}"));
        }
        let time = match self.built().next()?.times.light_build_ms {
            Some(build) => {
                format!("Building it takes {} ms, which no time here includes", significant(build))
            }
            None => "No time here includes building it".to_owned(),
        };
        Some(format!(
            "The hierarchy over the lights (/bvh) is built once, before the first frame, so it is valid only \
             while no light moves. {time}."
        ))
    }

    /// Those that read a hierarchy which was built before the first frame.
    fn built(&self) -> impl Iterator<Item = &'a Record> {
        self.records.iter().copied().filter(|record| needs_built_hierarchy(record))
    }
}

/// Whether a strategy reads a hierarchy over the lights that was built before the first frame. Its time then
/// holds for still lights only. The hierarchy over lights that move is made anew in every frame, on the clock.
pub fn needs_built_hierarchy(record: &Record) -> bool {
    let setting = &record.setting;
    let is_on_gpu = setting.order().is_some_and(LightOrder::is_on_gpu);
    record.strategy.reads_hierarchy() && setting.motion.is_none() && !is_on_gpu
}

/// The least and the greatest of a figure over some records, as text: `15.9 to 16.1`. `None` if the figure is
/// missing from a record.
pub(crate) fn span(records: &[&Record], figure: impl Fn(&Record) -> Option<f64>) -> Option<String> {
    let figures: Option<Vec<f64>> = records.iter().map(|record| figure(record)).collect();
    let figures = figures?;
    let least = significant(figures.iter().copied().fold(f64::INFINITY, f64::min));
    let most = significant(figures.iter().copied().fold(f64::NEG_INFINITY, f64::max));
    Some(if least == most { least } else { format!("{least} to {most}") })
}
