//! Checks that results hold the records that their command asks for.
//!
//! A file that was edited by hand, or merged from others, may lack records of its command or hold one twice.
//! A study must not count it as done.

use super::{Record, Results, renamed::named_then};
use crate::{
    cli::{self, CompareArgs, Invocation},
    strategy::StrategyId,
};

/// The first record that is missing or superfluous; `None` if the results match their command.
pub(super) fn lack(results: &Results) -> Option<String> {
    for (ix, record) in results.records.iter().enumerate() {
        let same = |known: &&Record| {
            known.strategy == record.strategy && known.setting.mode == record.setting.mode
        };
        if results.records.iter().take(ix).any(|known| same(&known)) {
            return Some(format!("it holds {} twice", name(record)));
        }
    }
    // Commands of earlier versions may have options without effect, which are errors today.
    match cli::parse_stored(&results.command) {
        Ok(Invocation::Compare(args)) => lack_of_comparison(&args, &results.records),
        Ok(Invocation::Truth(_)) => {
            results.truth_image.is_none().then(|| "the truth image is missing".to_owned())
        }
        Ok(Invocation::Cdi(_)) => {
            results.deep_images.is_none().then(|| "the deep images are missing".to_owned())
        }
        _ if results.records.is_empty() => Some("it has no records".to_owned()),
        _ => None,
    }
}

fn lack_of_comparison(args: &CompareArgs, records: &[Record]) -> Option<String> {
    if records.is_empty() {
        return Some("it has no records".to_owned());
    }
    let Ok(asked) = args.choices() else { return None };
    // Unknown strategies come from another version, and cannot be compared.
    if records.iter().any(|record| !record.strategy.is_runnable()) {
        return None;
    }
    let mut is_asked = vec![false; records.len()];
    for &mode in args.mode.modes() {
        for choice in asked.iter().filter(|choice| choice.refuses_mode(mode).is_none()) {
            let find = |id: fn(&StrategyId) -> StrategyId| {
                let same = |record: &Record| {
                    record.setting.mode == mode && id(&record.strategy) == *choice.id()
                };
                records.iter().position(same)
            };
            // Commands of earlier versions use the ids of their version.
            match find(StrategyId::clone).or_else(|| find(named_then)) {
                Some(ix) => is_asked[ix] = true,
                // `all` leaves out strategies that cannot serve the scene. No culling serves every scene.
                None if !choice.is_named && !choice.is_reference() => {}
                None => return Some(format!("{} in {} is missing", choice.id(), mode.name())),
            }
        }
    }
    let extra = is_asked.iter().position(|is_asked| !is_asked)?;
    Some(format!("it holds {}, which its command does not ask for", name(&records[extra])))
}

fn name(record: &Record) -> String {
    format!("{} in {}", record.strategy, record.setting.mode.name())
}

#[cfg(test)]
mod tests {
    use super::*;

    fn results(line: &str, ids: &[&str]) -> Results {
        let mut results: Results = serde_json::from_str(include_str!("example.json")).unwrap();
        results.command = line.split(' ').map(str::to_owned).collect();
        let record = results.records[0].clone();
        let records = ids.iter().map(|id| Record { strategy: (*id).into(), ..record.clone() });
        results.records = records.collect();
        results
    }

    #[test]
    fn records_must_be_those_of_the_command() {
        let line = "lightbench compare --strategies None,sc-e/bvh,T-E/hs,T-E,M --mode deferred";
        let whole = ["None", "SC-E/48x48x40/bvh", "T-E/28x28/hs", "T-E/28x28", "M"];
        assert_eq!(lack(&results(line, &whole)), None);
        let lack_of = |ids: &[&str]| lack(&results(line, ids)).expect("a lack");
        assert!(lack_of(&[]).contains("no records"));
        assert!(lack_of(&whole[..4]).contains("M in deferred is missing"));
        assert!(lack_of(&whole[1..]).contains("None in deferred is missing"));
        assert!(lack_of(&[whole[0]; 5]).contains("holds None in deferred twice"));
        let other = ["None", "SC-E/48x48x40", "T-E/28x28/hs", "T-E/28x28", "M"];
        assert!(lack_of(&other).contains("SC-E/48x48x40/bvh in deferred is missing"));
        let more = [&whole[..], &["G/20x20x20"]].concat();
        assert!(lack_of(&more).contains("G/20x20x20 in deferred, which its command"));
        // Each mode has its records.
        let both = line.replace("deferred", "both");
        assert!(lack(&results(&both, &whole)).is_some());
        // Strategies that `all` means may be left out, and truths and deep images are no records.
        assert_eq!(lack(&results("lightbench --strategies all", &["None"])), None);
        assert!(lack(&results("lightbench --strategies all", &["SC-E/48x48x40"])).is_some());
        assert!(lack(&results("lightbench --strategies all --mode both", &["None"])).is_some());
        for command in ["truth", "cdi"] {
            let mut results = results(&format!("lightbench {command}"), &[]);
            assert_eq!(lack(&results), None);
            (results.truth_image, results.deep_images) = (None, None);
            assert!(lack(&results).is_some_and(|lack| lack.contains("missing")));
        }
        // A command of another version cannot be parsed, so its records count as complete.
        assert_eq!(lack(&results("lightbench compare --gone 1", &["None"])), None);
    }
}
