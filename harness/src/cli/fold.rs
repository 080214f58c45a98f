//! Shortens the help. clap puts the default of an option, and its values where nothing explains them, on lines of
//! their own, and an empty line before details.

use clap::{
    Arg, Command,
    builder::{PossibleValue, StyledStr},
};

/// Puts the default and the values of each option at the end of the first paragraph of its help.
pub(super) fn fold(command: Command) -> Command {
    command.mut_args(fold_option).mut_subcommands(fold)
}

fn fold_option(option: Arg) -> Arg {
    if !option.get_action().takes_values() {
        return option;
    }
    let mut notes = String::new();
    let defaults: Vec<_> =
        option.get_default_values().iter().map(|value| value.to_string_lossy()).collect();
    if !defaults.is_empty() {
        notes += &format!(" [default: {}]", defaults.join(" "));
    }
    let values = option.get_possible_values();
    // Values that are explained stand in a list.
    let is_bare = values.iter().all(|value| value.get_help().is_none());
    if is_bare && !values.is_empty() {
        let names: Vec<&str> = values.iter().map(PossibleValue::get_name).collect();
        notes += &format!(" [possible values: {}]", names.join(", "));
    }
    let text = |help: Option<&StyledStr>| {
        help.map(|help| StyledStr::from(with_notes(&help.to_string(), &notes)))
    };
    let (help, long_help) = (text(option.get_help()), text(option.get_long_help()));
    let mut option = option.hide_default_value(true).hide_possible_values(is_bare);
    if let Some(help) = help {
        option = option.help(help);
    }
    if let Some(long_help) = long_help {
        option = option.long_help(long_help);
    }
    option
}

/// A help with notes at the end of its first paragraph, and with its details right below. A default that depends
/// on something is written in the help, and joins the first paragraph where it starts the second.
fn with_notes(help: &str, notes: &str) -> String {
    let help = help.replacen("\n\n[default", " [default", 1);
    match help.split_once("\n\n") {
        Some((first, rest)) => format!("{first}{notes}\n{rest}"),
        None => help + notes,
    }
}
