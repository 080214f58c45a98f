//! The paper's strategies at one count of lights, and their times.

use crate::report::format::{number, significant};
use crate::results::Record;
use crate::study::claims::Answer;
use crate::study::claims::order::Order;
use crate::study::comparison::claims::pairs::{Member, Pairs};
use crate::study::data::{Entry, counts, is_near, is_of_the_paper, nearest_count, ranking, stand};
use crate::study::manifest::Done;

/// Records of the paper's strategies under the same lights, exact ones only.
pub(crate) struct Field<'a> {
    pub(crate) lights: u64,
    records: Vec<&'a Record>,
}

impl<'a> Field<'a> {
    /// The records at the count of lights of a claim: path means where the study has them.
    pub(crate) fn at(done: &'a Done, scene: &'a str, wanted: u64) -> Result<Self, Answer> {
        let all: Vec<Entry<'_>> = ranking(done, scene)
            .into_iter()
            .filter(|entry| is_of_the_paper(entry.record) && entry.record.is_exact())
            .filter(|entry| entry.record.assign_and_shade_ms().is_finite())
            .collect();
        let Some(lights) = nearest_count(&counts(&all), wanted) else {
            return Err(Answer::unknown("the ranking along the path"));
        };
        if !is_near(lights, wanted) {
            let why = format!("only {} lights were measured", number(lights as f64));
            return Err(Answer::undecided(&why));
        }
        let own = all.iter().map(|entry| entry.record).filter(|r| r.setting.lights == lights);
        let mut records: Vec<&Record> = own.collect();
        // The paper's own strategy comes before what stands in for it.
        records.sort_by_key(|record| record.strategy.stand_in().is_some());
        Ok(Self { lights, records })
    }

    /// The record of a family.
    pub(crate) fn of(&self, name: &str) -> Option<&'a Record> {
        self.records.iter().copied().find(|record| record.strategy.family() == name)
    }

    /// What was measured of a family.
    pub(crate) fn member(&self, name: &str) -> Member {
        Member::of(self.of(name).map(|record| &record.strategy))
    }

    /// `at 10,000 lights, means of 240 poses`; poses of single strategies stand beside them.
    pub(crate) fn basis(&self) -> String {
        let most = self.records.iter().max_by_key(|record| record.times.frames);
        let stand = most.map_or_else(String::new, |record| stand(record));
        let mean = if stand == "one pose" { "" } else { "means of " };
        format!("at {} lights, {mean}{stand}", number(self.lights as f64))
    }

    /// The times of families, fastest first: `T-I 0.0461, G/supports 0.0485 ms`.
    pub(crate) fn times(&self, families: &[&str]) -> String {
        let mut all: Vec<&Record> = families.iter().filter_map(|name| self.of(name)).collect();
        all.sort_by(|a, b| a.assign_and_shade_ms().total_cmp(&b.assign_and_shade_ms()));
        let time = |record: &&Record| {
            format!("{} {}", record.strategy.short(), significant(record.assign_and_shade_ms()))
        };
        all.iter().map(time).collect::<Vec<_>>().join(", ") + " ms"
    }
}

/// Whether times come in the paper's order, all pairs across its groups. Where the chain is one strategy
/// before all others, whether it leads.
pub(crate) fn ordered(done: &Done, scene: &str, wanted: u64, chain: &[&[&str]]) -> Answer {
    let field = match Field::at(done, scene, wanted) {
        Ok(field) => field,
        Err(answer) => return answer,
    };
    let order = |less: &str, more: &str| Some(Order::of_times(field.of(less)?, field.of(more)?));
    let pairs = Pairs::of_chain(chain, |name| field.member(name), order);
    let families: Vec<&str> = chain.concat();
    let figure = format!("{}: {}{}", field.basis(), field.times(&families), pairs.exceptions());
    let is_leader = matches!(chain, [[_], _]);
    let verdict = if is_leader { pairs.leader_verdict() } else { pairs.verdict() };
    Answer { figure, verdict }
}
