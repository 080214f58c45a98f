//! Records the commit and the compiler that the program was built from.

use std::process::Command;

/// What the program is built from, relative to the workspace.
const SOURCES: [&str; 12] = [
    "assign",
    "assign-cdi",
    "assign-clustered",
    "assign-grid",
    "assign-model",
    "assign-tiled",
    "assign-walk",
    "scenes",
    "shading",
    "harness",
    "Cargo.toml",
    "Cargo.lock",
];

fn main() {
    println!("cargo:rerun-if-changed=../.git/HEAD");
    println!("cargo:rerun-if-changed=../.git/index");
    println!("cargo:rerun-if-changed=../.git/logs/HEAD");
    for source in SOURCES {
        println!("cargo:rerun-if-changed=../{source}");
    }
    let mut commit = output("git", &["rev-parse", "--short=12", "HEAD"]);
    let sources = SOURCES.map(|source| format!(":/{source}"));
    let mut status = vec!["status", "--porcelain", "--"];
    status.extend(sources.iter().map(String::as_str));
    let changed = output("git", &status);
    if !commit.is_empty() && !changed.is_empty() {
        commit.push_str("-dirty");
    }
    println!("cargo:rustc-env=LIGHTBENCH_COMMIT={commit}");
    let rustc = std::env::var("RUSTC").unwrap_or_else(|_| "rustc".into());
    println!("cargo:rustc-env=LIGHTBENCH_RUSTC={}", output(&rustc, &["--version"]));
}

/// What a command prints; empty where it fails.
fn output(program: &str, arguments: &[&str]) -> String {
    Command::new(program)
        .args(arguments)
        .output()
        .ok()
        .filter(|output| output.status.success())
        .map(|output| String::from_utf8_lossy(&output.stdout).trim().to_owned())
        .unwrap_or_default()
}
