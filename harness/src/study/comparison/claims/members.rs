//! What was measured of each strategy of the paper, by family.

use super::pairs::{Member, Pairs};
use crate::strategy::StrategyId;
use crate::study::claims::order::Order;

/// Figures of the strategies that a claim is about.
pub(crate) struct Members<'a, T> {
    /// The lights and the poses of the figures.
    pub(crate) basis: String,
    /// The paper's own strategy comes before what stands in for it.
    pub(crate) all: Vec<(&'a StrategyId, T)>,
}

impl<'a, T> Members<'a, T> {
    pub(crate) fn new(basis: String, mut all: Vec<(&'a StrategyId, T)>) -> Self {
        all.sort_by_key(|(id, _)| id.stand_in().is_some());
        Self { basis, all }
    }

    fn find(&self, family: &str) -> Option<&(&'a StrategyId, T)> {
        self.all.iter().find(|(id, _)| id.family() == family)
    }

    /// The figures of a family.
    pub(crate) fn get(&self, family: &str) -> Option<&T> {
        self.find(family).map(|(_, figures)| figures)
    }

    /// What was measured of a family.
    pub(crate) fn member(&self, family: &str) -> Member {
        Member::from_id(self.find(family).map(|(id, _)| *id))
    }

    /// What stands in for one of some families.
    pub(crate) fn stand_in(&self, families: &[&str]) -> Option<&'static str> {
        families.iter().find_map(|family| self.find(family)?.0.stand_in())
    }

    /// Which of two families has the lesser figure; `None` where one was not measured.
    pub(crate) fn order(
        &self,
        less: &str,
        more: &str,
        order: impl Fn(&T, &T) -> Order,
    ) -> Option<Order> {
        Some(order(self.get(less)?, self.get(more)?))
    }

    /// All pairs of families across the groups of a chain.
    pub(crate) fn pairs(&self, chain: &[&[&str]], order: impl Fn(&T, &T) -> Order) -> Pairs {
        let member = |family: &str| self.member(family);
        Pairs::of_chain(chain, member, |less, more| self.order(less, more, &order))
    }

    /// `T-I 0.0461, G/supports 0.0485`: the families that are there by a figure, least first.
    pub(crate) fn ascending(
        &self,
        families: &[&str],
        figure: fn(&T) -> f64,
        show: fn(f64) -> String,
    ) -> String {
        let known = families.iter().filter_map(|family| self.find(family));
        let mut all: Vec<(String, f64)> =
            known.map(|(id, figures)| (id.short(), figure(figures))).collect();
        all.sort_by(|a, b| a.1.total_cmp(&b.1));
        let shown = all.iter().map(|(name, figure)| format!("{name} {}", show(*figure)));
        shown.collect::<Vec<_>>().join(", ")
    }
}
