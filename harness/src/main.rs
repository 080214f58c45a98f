//! `lightbench`: compare ways of assigning many lights to pixels.

#![deny(clippy::print_stdout, clippy::print_stderr)]

use std::{path::Path, process::ExitCode};

use harness::{
    advise::advise,
    cli::{self, Invocation, Listing},
    compare::compare,
    deep_image_run::cdi,
    error::HarnessError,
    explain::explain,
    fit_ltc::fit_ltc,
    interrupted,
    messages::{print, say_error},
    scenarios,
    soak::soak_alone,
    stored_report::report_stored,
    strategy::{self, engines},
    study::{studies, study},
    truth::truth,
};

fn main() -> ExitCode {
    quiet_loader();
    interrupted::watch();
    match run() {
        Ok(()) => ExitCode::SUCCESS,
        Err(error) => {
            say_error(&error);
            ExitCode::from(error.exit_code())
        }
    }
}

fn run() -> Result<(), HarnessError> {
    // The results name the program without its path on this machine.
    let arguments = std::env::args_os().skip(1).map(|word| word.to_string_lossy().into_owned());
    let command = std::iter::once("lightbench".to_owned()).chain(arguments).collect();
    let invocation = cli::parse(std::env::args_os())?;
    set_interrupt_message(&invocation);
    let text = match invocation {
        Invocation::Show(text) => text,
        Invocation::List(Listing::Strategies) => strategy::list(),
        Invocation::List(Listing::Engines) => engines::list(),
        Invocation::List(Listing::Scenes) => scenes(),
        Invocation::List(Listing::Scenarios) => scenarios::list(),
        Invocation::List(Listing::Adapters) => adapters()?,
        Invocation::List(Listing::Studies) => {
            studies().map(|(name, answers)| format!("{name:<16} {answers}\n")).collect()
        }
        Invocation::Compare(args) => compare(&args, command)?,
        Invocation::Explain(args) => explain(&args)?,
        Invocation::Soak(args) => soak_alone(&args)?,
        Invocation::Study(args) => study(&args, &command)?,
        Invocation::Report(args) => report_stored(&args)?,
        Invocation::Advise(args) => advise(&args, command)?,
        Invocation::FitLtc(args) => fit_ltc(&args)?,
        Invocation::Truth(args) => truth(&args, command)?,
        Invocation::Cdi(args) => cdi(&args, command)?,
    };
    print(&text)
}

/// Sets the message of an interrupted run.
fn set_interrupt_message(invocation: &Invocation) {
    let lost = |out: &Path| {
        let out = out.display();
        format!("{out} has no results of this run; the same command starts again")
    };
    interrupted::when_interrupted(match invocation {
        Invocation::Study(args) => format!(
            "{} keeps the finished jobs; the same command runs the remaining ones",
            args.folder().display()
        ),
        Invocation::Compare(args) => lost(&args.out),
        Invocation::Advise(args) => lost(&args.out),
        Invocation::Truth(args) => lost(&args.out),
        Invocation::Cdi(args) => lost(&args.out),
        Invocation::Report(_)
        | Invocation::FitLtc(_)
        | Invocation::Explain(_)
        | Invocation::Soak(_) => "the same command starts again".into(),
        Invocation::List(_) | Invocation::Show(_) => return,
    });
}

/// Keeps the Vulkan loader quiet. One of its layers asks for a Wayland display, and the Wayland library
/// prints an error if this variable is not set. The value here is not a folder, so the library finds nothing.
#[cfg(target_os = "linux")]
fn quiet_loader() {
    const NAME: &str = "XDG_RUNTIME_DIR";
    let is_set = std::env::var_os(NAME).is_some_and(|folder| Path::new(&folder).is_absolute());
    if !is_set {
        // SAFETY: no other thread runs yet, so none can read the environment.
        #[expect(unsafe_code, reason = "the loader reads the environment of this process")]
        unsafe {
            std::env::set_var(NAME, "/dev/null");
        }
    }
}

/// Other systems have no such loader.
#[cfg(not(target_os = "linux"))]
fn quiet_loader() {}

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
    rows += &format!(
        "{:<16} a scene in which methods fail: lightbench list scenarios\n",
        "stability:NAME"
    );
    rows
}
