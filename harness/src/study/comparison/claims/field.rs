//! The paper's strategies at one count of lights, and their times.

use crate::report::format::{number, significant};
use crate::results::Record;
use crate::study::claims::order::Order;
use crate::study::claims::{Answer, Verdict};
use crate::study::comparison::claims::members::Members;
use crate::study::comparison::claims::pairs::Pairs;
use crate::study::data::{Entry, counts, is_near, is_of_the_paper, means, nearest_count, ranking};
use crate::study::manifest::Done;

/// Exact records of the paper's strategies under the same lights.
pub(crate) struct Field<'a> {
    pub(crate) lights: u64,
    pub(crate) records: Members<'a, &'a Record>,
}

impl<'a> Field<'a> {
    /// The records at the count of lights of a claim: path means where the study has them.
    pub(crate) fn at(done: &'a Done, scene: &'a str, wanted: u64) -> Result<Self, Answer> {
        let all: Vec<Entry<'_>> = ranking(done, scene)
            .into_iter()
            .filter(|entry| is_of_the_paper(entry.record) && entry.record.is_exact())
            .filter(|entry| entry.record.assign_and_shade_ms().is_finite())
            .collect();
        let lights = count_near(&all, wanted, "the ranking along the path")?;
        let records = all.iter().map(|entry| entry.record).filter(|r| r.setting.lights == lights);
        let records = records.map(|record| (&record.strategy, record)).collect();
        let mut records: Members<'a, &'a Record> = Members::new(String::new(), records);
        // Poses of single strategies stand beside them.
        let most = records.all.iter().max_by_key(|(_, record)| record.times.frames);
        let means = most.map_or_else(String::new, |(_, record)| means(record));
        records.basis = format!("at {} lights, {means}", number(lights as f64));
        Ok(Self { lights, records })
    }

    /// The records of two families.
    pub(crate) fn both(&self, families: [&str; 2]) -> Option<[&'a Record; 2]> {
        let [first, second] = families.map(|family| self.records.get(family).copied());
        Some([first?, second?])
    }

    /// The times of families, fastest first: `T-I 0.0461, G/supports 0.0485 ms`.
    pub(crate) fn times(&self, families: &[&str]) -> String {
        self.records.ascending(families, |r| r.assign_and_shade_ms(), significant) + " ms"
    }
}

/// The count of lights that may speak for the one of a claim; `what` names what was not measured.
pub(crate) fn count_near(all: &[Entry<'_>], wanted: u64, what: &str) -> Result<u64, Answer> {
    let Some(lights) = nearest_count(&counts(all), wanted) else {
        return Err(Answer::unknown(what));
    };
    if !is_near(lights, wanted) {
        let why = format!("only {} lights were measured", number(lights as f64));
        return Err(Answer::undecided(&why));
    }
    Ok(lights)
}

/// The verdict on a chain of groups. Where the chain is one strategy before all others, whether it leads.
pub(crate) fn chain_verdict(chain: &[&[&str]], pairs: &Pairs) -> Verdict {
    match chain {
        [[_], _] => pairs.leader_verdict(),
        _ => pairs.verdict(),
    }
}

/// Whether times come in the paper's order, all pairs across its groups.
pub(crate) fn ordered(done: &Done, scene: &str, wanted: u64, chain: &[&[&str]]) -> Answer {
    let field = match Field::at(done, scene, wanted) {
        Ok(field) => field,
        Err(answer) => return answer,
    };
    let pairs = field.records.pairs(chain, |less, more| Order::of_times(less, more));
    let times = field.times(&chain.concat());
    let figure = format!("{}: {times}{}", field.records.basis, pairs.exceptions());
    Answer { figure, verdict: chain_verdict(chain, &pairs) }
}
