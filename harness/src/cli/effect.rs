//! Rejects options that would change nothing.
//!
//! A user who writes `--directions 8x8` without `--vpls` expects deep images, but none are built. An option
//! without effect is therefore an error, which names the options that it needs.

use clap::{ArgMatches, parser::ValueSource};

use super::{
    CdiArgs, CliError, CompareArgs, ExplainArgs, Invocation, RangeChoice, StageArgs, StudyArgs,
};

/// Options, when they have an effect, and what they need.
struct Rule<A> {
    /// Names on the command line, without dashes.
    options: &'static [&'static str],
    has_effect: fn(&A) -> bool,
    /// The options that they need. The error puts it after "it needs".
    needs: &'static str,
}

const CASTING: &str = "--vpls N above 0 and a rule of --ranges that casts rays: average, maximum, \
                        random-discard or constant-discard";

const CASTING_ANY: &str = "--shadows cdi:N, or --vpls N above 0 and a rule of --ranges that casts rays: average, \
                           maximum, random-discard or constant-discard";

const SPEED: &[&str] = &["speed", "moved-by"];
const MOTION: &str = "--motion LAW";

const STAGE: &[Rule<StageArgs>] = &[
    Rule {
        options: &["ranges", "vpl-spacing", "vpl-clamp", "keep-ranges"],
        has_effect: |args| args.bounce.vpls > 0,
        needs: "--vpls N above 0",
    },
    Rule { options: &["rays", "primary-ray"], has_effect: casts_ranges, needs: CASTING },
    Rule {
        options: &["range-scale", "correct-rays"],
        has_effect: |args| args.bounce.vpls > 0 && args.bounce.ranges.measures(),
        needs: "--vpls N above 0 and --ranges average or maximum",
    },
    Rule {
        options: &["random-ranges"],
        has_effect: |args| args.bounce.vpls > 0 && args.bounce.ranges.draws(),
        needs: "--vpls N above 0 and --ranges random or random-discard",
    },
    Rule {
        options: &["constant-range"],
        has_effect: |args| args.bounce.ranges == RangeChoice::ConstantDiscard,
        needs: "--vpls N above 0 and --ranges constant-discard",
    },
    Rule {
        options: &["keep-ranges"],
        has_effect: |args| args.bounce.ranges != RangeChoice::Infinite,
        needs: "a rule of --ranges other than infinite",
    },
    Rule {
        options: &["radius-scale", "radii", "light-box", "outlines", "diffuse-share"],
        has_effect: |args| !args.bounce.is_on(),
        needs: "scattered lights, which --vpls and --primary replace",
    },
    Rule {
        options: &["motion"],
        has_effect: |args| !args.bounce.is_on(),
        needs: "lights that can move: --vpls and --primary replace them",
    },
    Rule { options: SPEED, has_effect: |args| args.motion.motion.is_some(), needs: MOTION },
    Rule {
        options: &["outlines", "diffuse-share"],
        has_effect: |args| args.areas > 0.0,
        needs: "--areas SHARE above 0, because no scattered light is an area light",
    },
];

const DEEP: &[&str] = &["directions", "spread", "deep-size", "oversampling", "build"];

const DEEP_RANGES: &[Rule<StageArgs>] =
    &[Rule { options: DEEP, has_effect: casts_ranges, needs: CASTING }];

const DEEP_COMPARE: &[Rule<CompareArgs>] = &[Rule {
    options: DEEP,
    has_effect: |args| args.shadows.casts_rays() || casts_ranges(&args.stage),
    needs: CASTING_ANY,
}];

const DEEP_EXPLAIN: &[Rule<ExplainArgs>] = &[Rule {
    options: DEEP,
    has_effect: |args| args.shadows.casts_rays() || casts_ranges(&args.stage),
    needs: CASTING_ANY,
}];

fn casts_ranges(args: &StageArgs) -> bool {
    args.bounce.vpls > 0 && args.bounce.ranges.casts()
}

const EXPLAIN: &[Rule<ExplainArgs>] = &[
    Rule { options: &["frames"], has_effect: |args| args.path, needs: "--path" },
    Rule {
        options: &["frame"],
        has_effect: |args| args.path || args.stage.motion.motion.is_some(),
        needs: "--path or --motion LAW, because all frames are the same",
    },
];

const CDI: &[Rule<CdiArgs>] = &[Rule {
    options: &["rays"],
    has_effect: |args| !args.casts.0.is_empty() || args.compared > 0,
    needs: "--casts or --compared to cast rays",
}];

const STUDY: &[Rule<StudyArgs>] =
    &[Rule { options: SPEED, has_effect: |args| args.motion.motion.is_some(), needs: MOTION }];

/// Refuses an option that was given and has no effect.
pub(super) fn check(asked: &Invocation, matches: &ArgMatches) -> Result<(), CliError> {
    // Options stand after the name of the command, or alone where `compare` is not named.
    let matches = matches.subcommand().map_or(matches, |(_, options)| options);
    match asked {
        Invocation::Compare(args) => {
            check_rules(DEEP_COMPARE, args, matches)?;
            check_rules(STAGE, &args.stage, matches)
        }
        Invocation::Explain(args) => {
            check_rules(EXPLAIN, args, matches)?;
            check_rules(DEEP_EXPLAIN, args, matches)?;
            check_rules(STAGE, &args.stage, matches)
        }
        Invocation::Advise(args) => check_stage(&args.stage, matches),
        Invocation::Truth(args) => check_stage(&args.stage, matches),
        Invocation::Study(args) => check_rules(STUDY, args, matches),
        Invocation::Cdi(args) => check_rules(CDI, args, matches),
        _ => Ok(()),
    }
}

/// Of commands whose deep images only find ranges.
fn check_stage(args: &StageArgs, matches: &ArgMatches) -> Result<(), CliError> {
    check_rules(DEEP_RANGES, args, matches)?;
    check_rules(STAGE, args, matches)
}

fn check_rules<A>(rules: &[Rule<A>], args: &A, matches: &ArgMatches) -> Result<(), CliError> {
    for rule in rules.iter().filter(|rule| !(rule.has_effect)(args)) {
        if let Some(option) = rule.options.iter().find(|option| is_given(option, matches)) {
            return Err(CliError::without_effect(option, rule.needs));
        }
    }
    Ok(())
}

/// Whether an option stands on the command line. Not every command has every option.
fn is_given(option: &str, matches: &ArgMatches) -> bool {
    let id = option.replace('-', "_");
    let is_known = matches.ids().any(|known| known.as_str() == id);
    is_known && matches.value_source(&id) == Some(ValueSource::CommandLine)
}
