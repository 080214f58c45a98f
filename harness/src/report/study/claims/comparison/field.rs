//! The paper's strategies at one count of lights, and the order that the paper gives them.

use super::super::super::super::format::{number, significant};
use super::super::super::super::rank::listed;
use super::super::super::data::{
    Entry, counts, family, is_near, is_of_the_paper, nearest_count, ranking, stand,
};
use super::super::super::order::Order;
use super::super::{Answer, Verdict};
use crate::results::Record;
use crate::study::Done;

/// Names in a figure: more than this many pairs are counted and not named.
const MOST_NAMED: usize = 6;

/// Records of the paper's strategies under the same lights, exact ones only.
pub(super) struct Field<'a> {
    pub(super) lights: u64,
    records: Vec<&'a Record>,
}

impl<'a> Field<'a> {
    /// The records at the count of lights of a claim: path means where the study has them.
    pub(super) fn at(done: &'a Done, scene: &'a str, wanted: u64) -> Result<Self, Answer> {
        let all: Vec<Entry<'_>> = ranking(done, scene)
            .into_iter()
            .filter(|entry| is_of_the_paper(entry.record) && entry.record.is_exact())
            .filter(|entry| entry.record.assign_and_shade_ms().is_finite())
            .collect();
        let Some(lights) = nearest_count(&counts(&all), wanted) else {
            return Err(Answer::unknown("the ranking along the path"));
        };
        if !is_near(lights, wanted) {
            let why = format!("measured at {} lights only", number(lights as f64));
            return Err(Answer::unknown(&why));
        }
        let records = all.iter().map(|entry| entry.record).filter(|r| r.lights == lights).collect();
        Ok(Self { lights, records })
    }

    /// The record of a family.
    pub(super) fn of(&self, name: &str) -> Option<&'a Record> {
        self.records.iter().copied().find(|record| family(&record.strategy) == name)
    }

    /// `at 10,000 lights, means of 240 poses`; poses of single strategies stand beside them.
    pub(super) fn basis(&self) -> String {
        let most = self.records.iter().max_by_key(|record| record.frames);
        let stand = most.map_or_else(String::new, |record| stand(record));
        let mean = if stand == "one pose" { "" } else { "means of " };
        format!("at {} lights, {mean}{stand}", number(self.lights as f64))
    }

    /// The times of families, fastest first: `T-I 0.0461, G 0.0485 ms`.
    pub(super) fn times(&self, families: &[&str]) -> String {
        let mut all: Vec<&Record> = families.iter().filter_map(|name| self.of(name)).collect();
        all.sort_by(|a, b| a.assign_and_shade_ms().total_cmp(&b.assign_and_shade_ms()));
        let time = |record: &&Record| {
            format!("{} {}", family(&record.strategy), significant(record.assign_and_shade_ms()))
        };
        all.iter().map(time).collect::<Vec<_>>().join(", ") + " ms"
    }
}

/// Pairs of strategies of which the paper says which is less.
#[derive(Default)]
pub(super) struct Pairs {
    good: usize,
    ties: Vec<String>,
    other_way: Vec<String>,
}

impl Pairs {
    /// Every strategy of a group against every one of the groups behind it; `order` compares two, and
    /// says nothing where one of them was not measured.
    pub(super) fn of_chain(
        chain: &[&[&str]],
        mut order: impl FnMut(&str, &str) -> Option<Order>,
    ) -> Self {
        let mut pairs = Self::default();
        for (ix, group) in chain.iter().enumerate() {
            for less in *group {
                for more in chain.iter().skip(ix + 1).flat_map(|group| group.iter()) {
                    if let Some(order) = order(less, more) {
                        pairs.add(less, more, order);
                    }
                }
            }
        }
        pairs
    }

    /// Adds a pair: `less` should be less than `more`.
    pub(super) fn add(&mut self, less: &str, more: &str, order: Order) {
        match order {
            Order::Less => self.good += 1,
            Order::Tie => self.ties.push(format!("{less} and {more}")),
            Order::More => self.other_way.push(format!("{more} before {less}")),
        }
    }

    fn all(&self) -> usize {
        self.good + self.ties.len() + self.other_way.len()
    }

    /// Holds where every pair is as the paper has it, fails where every one is the other way.
    pub(super) fn verdict(&self) -> Verdict {
        match self.all() {
            0 => Verdict::Unknown("two of the strategies".to_owned()),
            all if self.other_way.len() == all => Verdict::Fails,
            all if self.good == all => Verdict::Holds,
            1 => Verdict::Differs("a tie".to_owned()),
            all => Verdict::Differs(format!("{} of {all} pairs", self.good)),
        }
    }

    /// Of one strategy that should be first: it is not where another is before it.
    pub(super) fn leader_verdict(&self) -> Verdict {
        match (self.other_way.is_empty(), self.ties.is_empty()) {
            (false, _) => Verdict::Fails,
            (true, false) => Verdict::Differs("a tie".to_owned()),
            (true, true) => self.verdict(),
        }
    }

    /// The pairs that are not as the paper has them, as further parts of a figure.
    pub(super) fn exceptions(&self) -> String {
        let said = |what: &str, pairs: &[String]| match pairs.len() {
            0 => String::new(),
            1..=MOST_NAMED => format!("; {what}: {}", listed(pairs)),
            many => format!("; {what}: {many} pairs"),
        };
        said("the other way", &self.other_way) + &said("ties", &self.ties)
    }
}

/// Whether times come in the paper's order, all pairs across its groups. Where the chain is one strategy
/// before all others, whether it leads.
pub(super) fn ordered(done: &Done, scene: &str, wanted: u64, chain: &[&[&str]]) -> Answer {
    let field = match Field::at(done, scene, wanted) {
        Ok(field) => field,
        Err(answer) => return answer,
    };
    let order = |less: &str, more: &str| Some(Order::of_times(field.of(less)?, field.of(more)?));
    let pairs = Pairs::of_chain(chain, order);
    let families: Vec<&str> = chain.concat();
    let figure = format!("{}: {}{}", field.basis(), field.times(&families), pairs.exceptions());
    let is_leader = matches!(chain, [[_], _]);
    let verdict = if is_leader { pairs.leader_verdict() } else { pairs.verdict() };
    Answer { figure, verdict }
}
