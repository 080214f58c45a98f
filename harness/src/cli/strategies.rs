//! The strategies that a command line asks for.

use super::{CliError, CompareArgs, ExplainArgs, Size, Strategies};
use crate::{
    choice::Choice,
    strategy::{IdError, default_ids, engines, rows},
};

/// Names every strategy, at its default parameters.
pub const ALL: &str = "all";

impl CompareArgs {
    /// All strategies that the command line asks for, in its order.
    ///
    /// # Errors
    ///
    /// An id that is not understood, and options that contradict it.
    pub fn choices(&self) -> Result<Vec<Choice>, CliError> {
        let asked = asked(&self.strategies, self.stage.size)?;
        let mut choices = Vec::new();
        for choice in asked {
            // A strategy that takes no source is there once.
            let count = if choice.takes_source() { usize::MAX } else { 1 };
            for source in self.sources().iter().take(count) {
                choices.push(choice.with(self.test, Some(*source))?);
            }
        }
        Ok(choices)
    }
}

impl ExplainArgs {
    /// All strategies that the command line asks for, in its order.
    ///
    /// # Errors
    ///
    /// An id that is not understood.
    pub fn choices(&self) -> Result<Vec<Choice>, CliError> {
        asked(&self.strategies, self.stage.size)
    }
}

/// The strategies that a list of ids names, on images of a size.
fn asked(strategies: &Strategies, size: Size) -> Result<Vec<Choice>, CliError> {
    let size = [size.width, size.height];
    let mut asked = Vec::new();
    // Nobody named those that are compared where none are.
    let is_named = strategies.0.join(",") != default_ids();
    for id in &strategies.0 {
        if let Some(ids) = engines::expand(id, size) {
            let ids = ids.map_err(|known| {
                let known: Vec<&str> = known.iter().map(String::as_str).collect();
                CliError::unknown("engine", id, &known)
            })?;
            for id in ids {
                asked.push(Choice::parse(&id)?);
            }
        } else if id.eq_ignore_ascii_case(ALL) {
            for row in rows() {
                let mut choice = Choice::parse(row.family)?;
                choice.is_named = false;
                asked.push(choice);
            }
        } else {
            let mut choice = Choice::parse(id)?;
            choice.is_named = is_named;
            asked.push(choice);
        }
    }
    Ok(asked)
}

impl From<IdError> for CliError {
    fn from(error: IdError) -> Self {
        match error {
            IdError::Unknown { id } => {
                let families = rows().map(|row| row.family);
                let known: Vec<&str> = families.chain([ALL]).collect();
                Self::unknown("strategy", &id, &known)
            }
            IdError::Segment { id, reason } => Self::new(format!("--strategies {id}: {reason}")),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{
        cli::{Invocation, parse},
        strategy::Axis,
    };

    fn choices(line: &[&str]) -> Result<Vec<String>, CliError> {
        let line = [&["lightbench"], line].concat();
        let Ok(Invocation::Compare(args)) = parse(line) else { panic!("not understood") };
        Ok(args.choices()?.iter().map(|choice| choice.id().to_string()).collect())
    }

    fn asked(line: &[&str]) -> Vec<String> {
        choices(line).unwrap()
    }

    #[test]
    fn options_apply_where_the_id_says_nothing() {
        let ids = ["--strategies", "T-I/hs,T-E,DC-E,None", "--test", "hs+sat-p", "--source", "bvh"];
        let expected = ["T-I/28x28/hs/bvh", "T-E/28x28/hs+sat-p/bvh", "DC-E/64x64x40/bvh", "None"];
        assert_eq!(asked(&ids), expected);
        let named = ["--strategies", "T-E/hs+sat-n/linear", "--test", "hs", "--source", "bvh"];
        assert_eq!(asked(&named), ["T-E/28x28"]);
    }

    #[test]
    fn all_names_every_row_and_both_sources_double_it() {
        let count = rows().count();
        assert_eq!(asked(&["--strategies", "all"]).len(), count);
        let both = asked(&["--strategies", "all", "--source", "both"]);
        let with_source = rows().filter(|row| row.has_axis(Axis::Source)).count();
        assert_eq!(both.len(), count + with_source);
        assert!(both.contains(&"SC-E/48x48x40/bvh".to_owned()), "{both:?}");
    }

    #[test]
    fn engines_stand_for_the_ids_of_their_defaults() {
        let small = ["--size", "960x540", "--strategies", "SC-E/bvh,engine:babylon"];
        assert_eq!(asked(&small), ["SC-E/48x48x40/bvh", "ZB/15x9x16"]);
        let unknown = choices(&["--strategies", "engine:doom"]).expect_err("an error").to_string();
        assert!(unknown.contains("engine:doom") && unknown.contains("engine:godot"), "{unknown}");
    }

    #[test]
    fn unknown_families_and_contradictions_are_errors() {
        let error = |line: &[&str]| choices(line).expect_err("an error").to_string();
        let unknown = error(&["--strategies", "DCI"]);
        assert!(
            unknown.contains("no strategy called DCI") && unknown.contains("DC-I"),
            "{unknown}"
        );
        let ball = error(&["--strategies", "SC-E/ball", "--source", "bvh"]);
        assert!(ball.contains("\"ball\"") && ball.contains("\"bvh\""), "{ball}");
    }
}
