//! The size and the order of the help.

use clap::{Arg, Command};

use super::{Invocation, definition, parse};

/// The most lines of the short help of a command: a tall terminal.
const MAX_SHORT_LINES: usize = 60;

/// The most lines of the short help of the program, which newcomers see first.
const MAX_FIRST_LINES: usize = 50;

/// The most lines of the long help of `compare`, which has the most options.
const MAX_LONG_LINES: usize = 396;

/// The most columns of a line of help.
const MAX_COLUMNS: usize = 100;

/// The program and its commands, each with its name; the program has none.
fn commands() -> Vec<(String, Command)> {
    let mut program = definition();
    program.build();
    let commands = program.get_subcommands().map(|command| (command.get_name(), command));
    let mut commands: Vec<(String, Command)> =
        commands.map(|(name, command)| (name.to_owned(), command.clone())).collect();
    commands.push((String::new(), program));
    commands
}

/// Faults in the size of a command's short help.
fn size_faults(command: Command, most_lines: usize) -> Vec<String> {
    let help = command.term_width(MAX_COLUMNS).render_help().to_string();
    let count = help.lines().count();
    let is_long = |line: &&str| line.chars().count() > MAX_COLUMNS;
    let mut faults: Vec<String> =
        help.lines().filter(is_long).map(|line| format!("a long line: {line}")).collect();
    if count > most_lines {
        faults.push(format!("{count} lines:\n{help}"));
    }
    faults
}

/// Options that the short help hides and that have no heading, and a short help that hides options without
/// saying so.
fn heading_faults(command: &Command) -> Vec<String> {
    let hidden: Vec<&Arg> =
        command.get_arguments().filter(|arg| arg.is_hide_short_help_set()).collect();
    let mut faults: Vec<String> = hidden
        .iter()
        .filter(|arg| arg.get_help_heading().is_none())
        .map(|arg| format!("{arg} has no heading"))
        .collect();
    let end = command.get_after_help().map(ToString::to_string).unwrap_or_default();
    if !hidden.is_empty() && !end.contains("--help shows all options") {
        faults.push(format!("the end does not name --help: {end:?}"));
    }
    faults
}

#[test]
fn the_short_help_of_every_command_fits_a_screen() {
    for (name, command) in commands() {
        let most = if name.is_empty() { MAX_FIRST_LINES } else { MAX_SHORT_LINES };
        assert_eq!(size_faults(command, most), [""; 0], "`lightbench {name} -h`");
    }
}

#[test]
fn defaults_take_no_lines_of_their_own() {
    let Ok(Invocation::Show(help)) = parse(["lightbench", "compare", "--help"]) else {
        panic!("no help")
    };
    let lines: Vec<&str> = help.lines().map(str::trim).collect();
    let is_apart = |pair: &&[&str]| pair[0].is_empty() && pair[1].starts_with("[default: ");
    assert_eq!(lines.windows(2).find(is_apart), None);
    assert!(help.contains("each side 1 to 16,384 [default: 640x360]\n"), "{help}");
    let count = lines.len();
    assert!(count <= MAX_LONG_LINES, "{count} lines:\n{help}");
}

#[test]
fn options_that_the_short_help_hides_stand_under_headings() {
    for (name, command) in commands() {
        assert_eq!(heading_faults(&command), [""; 0], "`lightbench {name} -h`");
    }
    let (_, compare) = commands().into_iter().find(|(name, _)| name == "compare").expect("compare");
    assert!(compare.get_arguments().filter(|arg| arg.is_hide_short_help_set()).count() > 40);
}

#[test]
fn both_checks_find_a_planted_fault() {
    let hidden = Arg::new("rare").long("rare").hide_short_help(true);
    let mut planted = Command::new("planted").arg(hidden);
    planted.build();
    assert_eq!(heading_faults(&planted).len(), 2);
    let word = "x".repeat(MAX_COLUMNS + 1);
    let planted = Command::new("planted").about(word);
    assert_eq!(size_faults(planted, 1).len(), 2);
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
