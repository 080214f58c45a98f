//! `lightbench`: compare ways of assigning many lights to pixels.

use std::process::ExitCode;

use harness::{
    cli::{self, Invocation, Listing},
    compare::compare,
    error::HarnessError,
    registry::STRATEGIES,
};

fn main() -> ExitCode {
    match run() {
        Ok(()) => ExitCode::SUCCESS,
        Err(error) => {
            eprintln!("lightbench: {error}");
            ExitCode::from(error.exit_code())
        }
    }
}

fn run() -> Result<(), HarnessError> {
    let command: Vec<String> =
        std::env::args_os().map(|argument| argument.to_string_lossy().into_owned()).collect();
    match cli::parse(std::env::args_os())? {
        Invocation::Show(text) => print!("{text}"),
        Invocation::List(Listing::Strategies) => list_strategies(),
        Invocation::List(Listing::Scenes) => list_scenes(),
        Invocation::List(Listing::Adapters) => list_adapters()?,
        Invocation::Compare(args) => compare(&args, command)?,
    }
    Ok(())
}

fn list_strategies() {
    for entry in STRATEGIES {
        let id = if entry.default.is_empty() {
            entry.family.to_owned()
        } else {
            format!("{}/{}", entry.family, entry.default)
        };
        println!("{id:<16} {}", entry.summary);
        if !entry.parameters.is_empty() {
            println!("{:<16} parameters: {}", "", entry.parameters.join(" x "));
        }
    }
}

fn list_adapters() -> Result<(), HarnessError> {
    for info in assign::Gpu::adapters()? {
        println!("{} ({}, {:?})", info.name, info.backend, info.device_type);
    }
    Ok(())
}

fn list_scenes() {
    for entry in scenes::list() {
        println!("{:<16} {}", entry.id, entry.summary);
    }
    println!("{:<16} any glTF 2.0 scene", "FILE.gltf|.glb");
}
