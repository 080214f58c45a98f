//! Parses the words of a command line into an [`Invocation`].

use std::ffi::OsString;

use clap::{ArgMatches, FromArgMatches, error::ErrorKind};

use super::{Cli, CliError, Command, Invocation, definition, effect};

/// Parses a command line. The first word is the program's name.
///
/// # Errors
///
/// A [`CliError`] of one line for anything unknown, missing, out of range or without effect.
pub fn parse<I, T>(arguments: I) -> Result<Invocation, CliError>
where
    I: IntoIterator<Item = T>,
    T: Into<OsString> + Clone,
{
    let (invocation, matches) = parse_words(arguments)?;
    if let Some(matches) = matches {
        effect::check(&invocation, &matches)?;
    }
    Ok(invocation)
}

/// Parses the command line of stored results.
///
/// Earlier versions accepted options without effect, so this does too: the command is only reported, not
/// run.
///
/// # Errors
///
/// As [`parse`], except for options without effect.
pub fn parse_stored<I, T>(arguments: I) -> Result<Invocation, CliError>
where
    I: IntoIterator<Item = T>,
    T: Into<OsString> + Clone,
{
    parse_words(arguments).map(|(invocation, _)| invocation)
}

/// The invocation, and the options as given; `None` for help.
fn parse_words<I, T>(arguments: I) -> Result<(Invocation, Option<ArgMatches>), CliError>
where
    I: IntoIterator<Item = T>,
    T: Into<OsString> + Clone,
{
    let shown = |error: clap::Error| match error.kind() {
        ErrorKind::DisplayHelp | ErrorKind::DisplayVersion => {
            Ok((Invocation::Show(error.render().to_string()), None))
        }
        _ => Err(CliError::from_clap(&error, &definition())),
    };
    let matches = match definition().try_get_matches_from(arguments) {
        Ok(matches) => matches,
        Err(error) => return shown(error),
    };
    let cli = match Cli::from_arg_matches(&matches) {
        Ok(cli) => cli,
        Err(error) => return shown(error),
    };
    let mut invocation = match cli.command {
        Some(Command::List { what }) => Invocation::List(what),
        Some(Command::Compare(args)) => Invocation::Compare(args),
        Some(Command::Explain(args)) => Invocation::Explain(args),
        Some(Command::Soak(args)) => Invocation::Soak(args),
        Some(Command::Study(args)) => Invocation::Study(args),
        Some(Command::Report(args)) => Invocation::Report(args),
        Some(Command::Advise(args)) => Invocation::Advise(args),
        Some(Command::FitLtc(args)) => Invocation::FitLtc(args),
        Some(Command::Truth(args)) => Invocation::Truth(args),
        Some(Command::Cdi(args)) => Invocation::Cdi(args),
        None => Invocation::Compare(cli.compare),
    };
    match &mut invocation {
        Invocation::Compare(args) => args.layers.add_those_of(&args.stage.scene),
        Invocation::Explain(args) => args.layers.add_those_of(&args.stage.scene),
        _ => {}
    }
    Ok((invocation, Some(matches)))
}
