//! Errors of the command line, one line each.

use clap::{
    builder::PossibleValue,
    error::{ContextKind, ContextValue, ErrorKind},
};
use thiserror::Error;

use super::names::did_you_mean;
use crate::visible::visible;

/// The exit code of bad input.
pub const BAD_INPUT: u8 = 2;

/// Bad input: one line that names the option, the value and the accepted values.
#[derive(Clone, Debug, PartialEq, Eq, Error)]
#[error("{message}")]
pub struct CliError {
    message: String,
}

impl CliError {
    /// An error of one line. Line breaks and other control characters are escaped.
    pub fn new(message: impl AsRef<str>) -> Self {
        Self { message: visible(message.as_ref()).into_owned() }
    }

    /// `--option has no effect here: it needs ...`.
    pub fn without_effect(option: &str, needs: &str) -> Self {
        Self::new(format!("--{option} has no effect here: it needs {needs}"))
    }

    /// `option is value: it must be accepted`.
    pub fn out_of_range(option: &str, value: &str, accepted: &str) -> Self {
        Self::new(format!("{option} is {}: it must be {accepted}", shown(value)))
    }

    /// `there is no strategy called name`, with the nearest known names, or with all of them where none
    /// is near.
    pub fn unknown(what: &str, name: &str, known: &[&str]) -> Self {
        let hint = did_you_mean(name, known);
        let hint = if hint.is_empty() {
            format!(": the known names are {}", known.join(", "))
        } else {
            hint
        };
        Self::new(format!("there is no {what} called {}{hint}", shown(name)))
    }

    /// [`BAD_INPUT`].
    pub fn exit_code(&self) -> u8 {
        BAD_INPUT
    }

    pub(super) fn from_clap(error: &clap::Error, program: &clap::Command) -> Self {
        let text = |kind| match error.get(kind) {
            Some(ContextValue::String(text)) => Some(text.clone()),
            Some(ContextValue::Strings(texts)) if !texts.is_empty() => Some(texts.join(", ")),
            _ => None,
        };
        // `--frames <N>` is an option and its placeholder. The message shows only the option.
        let option = text(ContextKind::InvalidArg).map(|arg| match arg.split_once(' ') {
            Some((option, _)) => option.to_owned(),
            None => arg,
        });
        let option = option.as_deref().unwrap_or("the command line");
        let value = text(ContextKind::InvalidValue).unwrap_or_default();
        let suggested = |kind| text(kind).map(|name| format!(": did you mean {name}?"));
        match error.kind() {
            ErrorKind::ValueValidation => {
                let accepted = std::error::Error::source(error).map(ToString::to_string);
                Self::out_of_range(option, &value, &accepted.unwrap_or_default())
            }
            ErrorKind::InvalidValue if value.is_empty() => Self::new(format!(
                "{option} needs a value{}",
                one_of(&text(ContextKind::ValidValue))
            )),
            ErrorKind::InvalidValue => {
                let valid = text(ContextKind::ValidValue).unwrap_or_default();
                Self::out_of_range(option, &value, &format!("one of {valid}"))
            }
            ErrorKind::UnknownArgument => Self::new(format!(
                "there is no option called {option}{}",
                suggested(ContextKind::SuggestedArg)
                    .unwrap_or_else(|| ": `lightbench --help` lists all options".to_owned())
            )),
            ErrorKind::InvalidSubcommand => {
                let name = text(ContextKind::InvalidSubcommand).unwrap_or_default();
                let known: Vec<&str> =
                    program.get_subcommands().map(clap::Command::get_name).collect();
                Self::unknown("command", &name, &known)
            }
            ErrorKind::MissingRequiredArgument => Self::new(missing(option, program)),
            ErrorKind::ArgumentConflict => Self::new(conflict(error, option, program)),
            ErrorKind::TooManyValues | ErrorKind::WrongNumberOfValues => {
                Self::new(format!("{option} takes one value"))
            }
            _ => {
                let rendered = error.to_string();
                let first = rendered.lines().next().unwrap_or_default();
                Self::new(first.strip_prefix("error: ").unwrap_or(first))
            }
        }
    }
}

fn one_of(valid: &Option<String>) -> String {
    valid.as_ref().map(|valid| format!(": one of {valid}")).unwrap_or_default()
}

/// Names a missing argument of a command and what it accepts, or a missing option.
fn missing(option: &str, program: &clap::Command) -> String {
    for command in program.get_subcommands() {
        if let Some(argument) = command.get_positionals().find(|arg| arg.to_string() == option) {
            let name = command.get_name();
            let values = argument.get_possible_values();
            let values: Vec<&str> = values.iter().map(PossibleValue::get_name).collect();
            return match argument.get_help() {
                Some(help) if values.is_empty() => format!("{name} needs {option}: {help}"),
                _ => format!("{name} needs {option}: one of {}", values.join(", ")),
            };
        }
    }
    match option {
        "--pixel" => {
            "explain needs --pixel X,Y: a pixel of the image, from the upper left corner".to_owned()
        }
        "--vpls" => "options of virtual point lights need --vpls N".to_owned(),
        _ => format!("{option} is missing"),
    }
}

/// Names two options that exclude each other, or an option that stands before a command.
fn conflict(error: &clap::Error, option: &str, program: &clap::Command) -> String {
    let bare = |text: &String| text.split([' ', '=']).next().unwrap_or_default().to_owned();
    let others: Vec<String> = match error.get(ContextKind::PriorArg) {
        Some(ContextValue::String(other)) => vec![bare(other)],
        Some(ContextValue::Strings(others)) => others.iter().map(bare).collect(),
        _ => Vec::new(),
    };
    if let Some(ContextValue::String(command)) = error.get(ContextKind::InvalidSubcommand) {
        return before_command(&others, command, program);
    }
    if others.iter().any(|other| other == option) {
        return format!("{option} is given twice: it must be given once");
    }
    match others.split_last() {
        None => format!("{option} cannot be combined with the other options"),
        Some((last, [])) => format!("{option} and {last} cannot be combined"),
        Some((last, first)) => {
            format!("{option} can be combined neither with {} nor with {last}", first.join(", "))
        }
    }
}

/// Options that stand before a command: the command lacks one of them, or they must stand after it.
fn before_command(options: &[String], command: &str, program: &clap::Command) -> String {
    let known = program.find_subcommand(command);
    let has = |option: &&String| {
        let name = option.trim_start_matches('-');
        known.is_some_and(|known| known.get_arguments().any(|arg| arg.get_long() == Some(name)))
    };
    if let Some(unknown) = options.iter().find(|option| !has(option)) {
        return format!(
            "{command} has no option {unknown}: `lightbench help {command}` lists its options"
        );
    }
    let options = options.join(" ");
    format!("options must stand after the command: `lightbench {command} {options} ...`")
}

fn shown(value: &str) -> &str {
    if value.trim().is_empty() { "empty" } else { value }
}
