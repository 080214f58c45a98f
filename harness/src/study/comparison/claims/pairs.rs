//! Pairs of strategies that the paper orders, and what they come to together.

use crate::report::rank::listed;
use crate::strategy::StrategyId;
use crate::study::claims::Verdict;
use crate::study::claims::order::Order;

/// Figures up to this factor apart are called alike; the paper draws bars and gives no bound.
pub(crate) const ALIKE: f64 = 1.5;

/// Names in a figure: more than this many pairs are counted and not named.
const MOST_NAMED: usize = 6;

/// What was measured of a strategy of the paper.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Member {
    /// Nothing.
    Missing,
    /// The paper's strategy.
    Measured,
    /// Another in its place: what differs.
    StandIn(&'static str),
}

impl Member {
    /// By the id of the record, where there is one.
    pub(crate) fn from_id(id: Option<&StrategyId>) -> Self {
        match id {
            None => Self::Missing,
            Some(id) => id.stand_in().map_or(Self::Measured, Self::StandIn),
        }
    }
}

/// Pairs of strategies of which the paper says which is less.
#[derive(Default)]
pub(crate) struct Pairs {
    good: usize,
    ties: Vec<String>,
    unsure: Vec<String>,
    reversed: Vec<String>,
    /// Reversed pairs of which both are the paper's strategies.
    reversed_in_earnest: usize,
    missing: Vec<String>,
    stand_ins: Vec<&'static str>,
}

impl Pairs {
    /// Every strategy of a group against every one of the groups after it; `order` compares two, and says
    /// nothing where one of them was not measured.
    pub(crate) fn of_chain(
        chain: &[&[&str]],
        member: impl Fn(&str) -> Member,
        order: impl Fn(&str, &str) -> Option<Order>,
    ) -> Self {
        let mut pairs = Self::default();
        for (ix, group) in chain.iter().enumerate() {
            for less in *group {
                for more in chain.iter().skip(ix + 1).flat_map(|group| group.iter()) {
                    pairs.compare([*less, *more], &member, &order);
                }
            }
        }
        pairs
    }

    /// Adds a pair of strategies, of which one may be missing: the first should be less.
    pub(crate) fn compare(
        &mut self,
        names: [&str; 2],
        member: impl Fn(&str) -> Member,
        order: impl Fn(&str, &str) -> Option<Order>,
    ) {
        let mut is_in_earnest = true;
        for name in names {
            match member(name) {
                Member::Missing if self.missing.iter().all(|known| known != name) => {
                    self.missing.push(name.to_owned());
                }
                Member::StandIn(what) => {
                    is_in_earnest = false;
                    if !self.stand_ins.contains(&what) {
                        self.stand_ins.push(what);
                    }
                }
                _ => {}
            }
        }
        if let Some(order) = order(names[0], names[1]) {
            self.reversed_in_earnest += usize::from(is_in_earnest && order == Order::More);
            self.push(names[0], names[1], order);
        }
    }

    /// Adds a pair of the paper's: `less` should be less than `more`.
    pub(crate) fn add(&mut self, less: &str, more: &str, order: Order) {
        self.reversed_in_earnest += usize::from(order == Order::More);
        self.push(less, more, order);
    }

    fn push(&mut self, less: &str, more: &str, order: Order) {
        match order {
            Order::Less => self.good += 1,
            Order::Tie => self.ties.push(format!("{less} and {more}")),
            Order::Unsure => self.unsure.push(format!("{less} and {more}")),
            Order::More => self.reversed.push(format!("{more} before {less}")),
        }
    }

    fn all(&self) -> usize {
        self.good + self.ties.len() + self.unsure.len() + self.reversed.len()
    }

    /// Holds where every pair is as the paper has it, fails where every one is reversed. Neither where a
    /// strategy was not measured or another stands in for it.
    pub(crate) fn verdict(&self) -> Verdict {
        let all = self.all();
        if all == 0 {
            return Verdict::unmeasured(&match self.missing.is_empty() {
                true => "two of the strategies".to_owned(),
                false => listed(&self.missing),
            });
        }
        if self.reversed_in_earnest == all {
            return Verdict::Fails;
        }
        let mut parts = Vec::new();
        if self.good < all {
            parts.push(match (all, self.unsure.len(), self.ties.len()) {
                (1, 1, _) => "too few laps for so small a difference".to_owned(),
                (1, _, 1) => "a tie".to_owned(),
                (all, 0, _) => format!("holds for {} of {all} pairs", self.good),
                (all, unsure, _) => {
                    format!("holds for {} of {all} pairs, too few laps for {unsure}", self.good)
                }
            });
        }
        self.decided_by(parts)
    }

    /// Of one strategy that should be first: it is not where another is before it.
    pub(crate) fn leader_verdict(&self) -> Verdict {
        if self.reversed_in_earnest > 0 {
            return Verdict::Fails;
        }
        if self.all() == 0 {
            return self.verdict();
        }
        let parts = [
            (&self.reversed, "not first"),
            (&self.unsure, "too few laps for so small a difference"),
            (&self.ties, "a tie"),
        ];
        let part = parts.iter().find(|(pairs, _)| !pairs.is_empty());
        self.decided_by(part.map(|(_, what)| (*what).to_owned()).into_iter().collect())
    }

    /// Holds where no part speaks against it, and the paper's strategies were all measured.
    fn decided_by(&self, mut parts: Vec<String>) -> Verdict {
        if !self.stand_ins.is_empty() {
            parts.push(format!("with {}", listed(&self.stand_ins)));
        }
        if !self.missing.is_empty() {
            parts.push(format!("{} not measured", listed(&self.missing)));
        }
        match parts.is_empty() {
            true => Verdict::Holds,
            false => Verdict::Differs(parts.join("; ")),
        }
    }

    /// The pairs that are not as the paper has them, as further parts of a figure.
    pub(crate) fn exceptions(&self) -> String {
        let told = |what: &str, pairs: &[String]| match pairs.len() {
            0 => String::new(),
            1..=MOST_NAMED => format!("; {what}: {}", listed(pairs)),
            many => format!("; {what}: {many} pairs"),
        };
        told("measured in the opposite order", &self.reversed)
            + &told("ties", &self.ties)
            + &told("too few laps to order", &self.unsure)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const CHAIN: [&[&str]; 2] = [&["A"], &["B", "C"]];

    fn judged(orders: [Option<Order>; 2], members: [Member; 3]) -> Pairs {
        let ix = |name: &str| ["A", "B", "C"].iter().position(|known| *known == name).unwrap_or(0);
        Pairs::of_chain(&CHAIN, |name| members[ix(name)], |_, more| orders[ix(more) - 1])
    }

    #[test]
    fn what_was_not_measured_bars_a_claim_from_holding() {
        use Member::{Measured, Missing};
        let pairs = judged([Some(Order::Less), None], [Measured, Measured, Missing]);
        assert_eq!(pairs.verdict(), Verdict::Differs("C not measured".to_owned()));
        assert_eq!(pairs.leader_verdict(), pairs.verdict());
        let whole = judged([Some(Order::Less); 2], [Measured; 3]);
        assert_eq!((whole.verdict(), whole.leader_verdict()), (Verdict::Holds, Verdict::Holds));
        let nothing = judged([None; 2], [Missing, Measured, Measured]);
        assert_eq!(nothing.verdict(), Verdict::Unknown("not measured: A".to_owned()));
    }

    #[test]
    fn what_stands_in_for_the_papers_strategy_neither_proves_nor_refutes() {
        use Member::{Measured, StandIn};
        let members = [Measured, StandIn("B over supports"), Measured];
        let with = |what: &str| Verdict::Differs(format!("{what}with B over supports"));
        assert_eq!(judged([Some(Order::Less); 2], members).verdict(), with(""));
        let one = judged([Some(Order::More), Some(Order::Less)], members);
        assert_eq!(one.leader_verdict(), with("not first; "));
        let both = judged([Some(Order::Less), Some(Order::More)], members);
        assert_eq!(both.leader_verdict(), Verdict::Fails);
    }

    #[test]
    fn few_laps_decide_nothing_where_times_are_near() {
        let mut pairs = Pairs::default();
        pairs.add("A", "B", Order::Unsure);
        let few = Verdict::Differs("too few laps for so small a difference".to_owned());
        assert_eq!((pairs.verdict(), pairs.leader_verdict()), (few.clone(), few));
        pairs.add("A", "C", Order::Less);
        let part = Verdict::Differs("holds for 1 of 2 pairs, too few laps for 1".to_owned());
        assert_eq!(pairs.verdict(), part);
        assert!(pairs.exceptions().contains("too few laps to order: A and B"));
    }
}
