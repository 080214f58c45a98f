//! `lightbench`: compare ways of assigning many lights to pixels.

use std::{
    io::{ErrorKind, Write},
    process::ExitCode,
};

use harness::{
    advise::advise,
    again::again,
    cdi::cdi,
    cli::{self, CliError, Invocation, Listing},
    compare::compare,
    error::HarnessError,
    fit_ltc::fit_ltc,
    registry::{STRATEGIES, StrategyEntry},
    study::study,
    truth::truth,
};

fn main() -> ExitCode {
    match run() {
        Ok(()) => ExitCode::SUCCESS,
        Err(error) => {
            // One line, whatever a file's text put into the message.
            eprintln!("lightbench: {}", CliError::new(error.to_string()));
            ExitCode::from(error.exit_code())
        }
    }
}

fn run() -> Result<(), HarnessError> {
    // Where the program lies on this machine says nothing to others.
    let arguments = std::env::args_os().skip(1).map(|word| word.to_string_lossy().into_owned());
    let command = std::iter::once("lightbench".to_owned()).chain(arguments).collect();
    let text = match cli::parse(std::env::args_os())? {
        Invocation::Show(text) => text,
        Invocation::List(Listing::Strategies) => strategies(),
        Invocation::List(Listing::Scenes) => scenes(),
        Invocation::List(Listing::Adapters) => adapters()?,
        Invocation::Compare(args) => compare(&args, command)?,
        Invocation::Study(args) => study(&args)?,
        Invocation::Report(args) => again(&args)?,
        Invocation::Advise(args) => advise(&args, command)?,
        Invocation::FitLtc(args) => fit_ltc(&args)?,
        Invocation::Truth(args) => truth(&args, command)?,
        Invocation::Cdi(args) => cdi(&args, command)?,
    };
    match std::io::stdout().lock().write_all(text.as_bytes()) {
        // Whoever read has read enough.
        Err(error) if error.kind() == ErrorKind::BrokenPipe => Ok(()),
        other => other.map_err(HarnessError::Output),
    }
}

fn strategies() -> String {
    let row = |entry: &StrategyEntry| {
        let id = entry.default_id();
        let mut row = format!("{id:<16} {}\n", entry.summary);
        if !entry.parameters.is_empty() {
            row += &format!("{:<16} parameters: {}\n", "", entry.parameters.join(" x "));
        }
        for axis in entry.axes {
            row += &format!("{:<16} /{}\n", "", axis.accepted());
        }
        row
    };
    STRATEGIES.iter().map(row).collect()
}

fn adapters() -> Result<String, HarnessError> {
    let row = |info: &wgpu::AdapterInfo| {
        format!("{} ({}, {:?})\n", info.name, info.backend, info.device_type)
    };
    Ok(assign::Gpu::adapters()?.iter().map(row).collect())
}

fn scenes() -> String {
    let row = |entry: &scenes::SceneEntry| format!("{:<16} {}\n", entry.id, entry.summary);
    let mut rows: String = scenes::list().iter().map(row).collect();
    rows += &format!("{:<16} any glTF 2.0 scene\n", "FILE.gltf|.glb");
    rows
}
