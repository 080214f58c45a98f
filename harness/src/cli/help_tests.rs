//! The size and the order of the help.

use clap::{Arg, Command, CommandFactory};

use super::{Cli, Invocation, parse};

/// The most lines of a short help: a tall terminal.
const MAX_SHORT_LINES: usize = 60;

/// The most lines of the short help that a newcomer sees first.
const MAX_FIRST_LINES: usize = 50;

/// The program and its commands, each with the words that call it.
fn commands() -> Vec<(String, Command)> {
    let mut program = Cli::command();
    program.build();
    let commands = program.get_subcommands().map(|command| (command.get_name().into(), command));
    let mut commands: Vec<(String, Command)> =
        commands.map(|(name, command)| (name, command.clone())).collect();
    commands.push((String::new(), program));
    commands
}

/// The options of a command without -h and -V.
fn options(command: &Command) -> impl Iterator<Item = &Arg> {
    command.get_opts().chain(command.get_arguments().filter(|arg| {
        arg.get_long().is_some_and(|long| !["help", "version"].contains(&long))
            && !arg.get_action().takes_values()
    }))
}

#[test]
fn the_short_help_of_every_command_fits_a_screen() {
    for (name, command) in commands() {
        let help = command.term_width(100).render_help().to_string();
        let lines = help.lines().count();
        let most = if name.is_empty() { MAX_FIRST_LINES } else { MAX_SHORT_LINES };
        assert!(lines <= most, "`lightbench {name} -h` has {lines} lines:\n{help}");
        for line in help.lines() {
            assert!(line.chars().count() <= 100, "`lightbench {name} -h` has a long line:\n{line}");
        }
    }
}

#[test]
fn options_that_the_short_help_hides_stand_under_headings() {
    for (name, command) in commands() {
        let mut hidden = 0;
        for option in options(&command) {
            let has_heading = option.get_help_heading().is_some();
            let is_hidden = option.is_hide_short_help_set();
            assert!(has_heading || !is_hidden, "`lightbench {name}`: {option} has no heading");
            hidden += usize::from(is_hidden);
        }
        if hidden > 0 {
            let short = command.get_after_help().map(ToString::to_string).unwrap_or_default();
            assert!(short.contains("--help shows all"), "`lightbench {name} -h`: {short:?}");
        }
    }
}

#[test]
fn everyday_options_come_first_in_the_help() {
    for line in ["--help", "compare --help"] {
        let words = std::iter::once("lightbench").chain(line.split(' '));
        let Ok(Invocation::Show(help)) = parse(words) else { panic!("`{line}` shows no help") };
        let place = |word: &str| help.find(word).unwrap_or_else(|| panic!("{word} is missing"));
        let everyday = ["--scene <", "--lights <", "--size", "--strategies", "--mode", "--out"];
        assert!(everyday.is_sorted_by_key(|option| place(&format!("\n      {option}"))), "{help}");
        for heading in ["Scene and camera:", "Scattered lights:", "Timing:", "Deep images"] {
            assert!(place("\n      --out <") < place(heading), "{heading} stands before --out");
        }
    }
}
