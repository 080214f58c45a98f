//! Rejects options that would change nothing.
//!
//! Whoever writes `--directions 8x8` without `--vpls` believes that deep images are built. An option
//! without effect is therefore an error that says what the option belongs to.

use clap::{ArgMatches, parser::ValueSource};

use super::{CdiArgs, CliError, CompareArgs, Invocation, StageArgs};
use crate::choice::Choice;

/// Options, when they change something, and what they belong to.
struct Rule<A> {
    /// Names on the command line, without dashes.
    options: &'static [&'static str],
    has_effect: fn(&A) -> bool,
    /// After "it must be given with".
    belongs_to: &'static str,
}

const STAGE: &[Rule<StageArgs>] = &[
    Rule {
        options: &["ranges", "vpl-spacing", "vpl-clamp", "keep-ranges"],
        has_effect: |args| args.bounce.vpls > 0,
        belongs_to: "--vpls N, N above 0",
    },
    Rule {
        options: &["directions", "spread", "deep-size", "oversampling", "build"],
        has_effect: |args| args.bounce.vpls > 0 && args.bounce.ranges.casts(),
        belongs_to: "--vpls N and --ranges that rays look for (average, maximum, random-discard or \
                     constant-discard): only these build deep images",
    },
    Rule {
        options: &["rays", "primary-ray"],
        has_effect: |args| args.bounce.vpls > 0 && args.bounce.ranges.casts(),
        belongs_to: "--vpls N and --ranges that rays look for (average, maximum, random-discard or \
                     constant-discard)",
    },
    Rule {
        options: &["range-scale", "correct-rays"],
        has_effect: |args| args.bounce.vpls > 0 && args.bounce.ranges.measures(),
        belongs_to: "--vpls N and --ranges average or maximum",
    },
    Rule {
        options: &["random-ranges"],
        has_effect: |args| args.bounce.vpls > 0 && args.bounce.ranges.draws(),
        belongs_to: "--vpls N and --ranges random or random-discard",
    },
    Rule {
        options: &["radius-scale", "radii", "light-box", "outlines", "diffuse-share"],
        has_effect: |args| !args.bounce.is_on(),
        belongs_to: "scattered lights, which neither --vpls nor --primary has",
    },
    Rule {
        options: &["outlines", "diffuse-share"],
        has_effect: |args| args.areas > 0.0,
        belongs_to: "--areas SHARE above 0: no scattered light is an area light",
    },
];

const CDI: &[Rule<CdiArgs>] = &[Rule {
    options: &["rays"],
    has_effect: |args| !args.casts.0.is_empty() || args.compared > 0,
    belongs_to: "--casts or --compared that cast rays",
}];

/// An error where an option that was given changes nothing.
pub(super) fn check(asked: &Invocation, matches: &ArgMatches) -> Result<(), CliError> {
    // The options of a command named, or those of the comparison that needs no name.
    let matches = matches.subcommand().map_or(matches, |(_, own)| own);
    match asked {
        Invocation::Compare(args) => {
            check_rules(STAGE, &args.stage, matches)?;
            check_strategies(args, matches)
        }
        Invocation::Advise(args) => check_rules(STAGE, &args.stage, matches),
        Invocation::Truth(args) => check_rules(STAGE, &args.stage, matches),
        Invocation::Cdi(args) => check_rules(CDI, args, matches),
        _ => Ok(()),
    }
}

fn check_rules<A>(rules: &[Rule<A>], args: &A, matches: &ArgMatches) -> Result<(), CliError> {
    for rule in rules.iter().filter(|rule| !(rule.has_effect)(args)) {
        if let Some(option) = rule.options.iter().find(|option| is_given(option, matches)) {
            let belongs_to = rule.belongs_to;
            return Err(without_effect(option, &format!("given with {belongs_to}")));
        }
    }
    Ok(())
}

/// Tests and source go to strategies that name none of their own.
fn check_strategies(args: &CompareArgs, matches: &ArgMatches) -> Result<(), CliError> {
    let takes = |option: &str| is_given(option, matches);
    if !["test", "source", "operations"].into_iter().any(takes) {
        return Ok(());
    }
    // What is wrong with an id is said where the strategies are chosen.
    let Ok(choices) = args.choices() else { return Ok(()) };
    type Applies = fn(&Choice) -> bool;
    let rules: [(&str, Applies, &str); 3] = [
        ("test", Choice::takes_tests, "tests frusta and names no tests of its own"),
        ("source", Choice::takes_source, "looks for lights and names no source of its own"),
        ("operations", Choice::has_groups, "has lists"),
    ];
    for (option, applies, what) in rules {
        if takes(option) && !choices.iter().any(applies) {
            let accepted = format!("given with a strategy that {what}: none of --strategies does");
            return Err(without_effect(option, &accepted));
        }
    }
    Ok(())
}

fn without_effect(option: &str, accepted: &str) -> CliError {
    CliError::new(format!("--{option} would change nothing: it must be {accepted}"))
}

/// Whether an option stands on the command line. Not every command has every option.
fn is_given(option: &str, matches: &ArgMatches) -> bool {
    let id = option.replace('-', "_");
    let is_known = matches.ids().any(|known| known.as_str() == id);
    is_known && matches.value_source(&id) == Some(ValueSource::CommandLine)
}
