//! The program with closed pipes, full disks and odd arguments.

use std::{
    fs::File,
    process::{Command, Output, Stdio},
};

fn lightbench(arguments: &[&str]) -> Command {
    let mut command = Command::new(env!("CARGO_BIN_EXE_lightbench"));
    command.args(arguments).stdout(Stdio::piped()).stderr(Stdio::piped());
    command
}

/// Runs the program with both output pipes closed.
fn run_unread(mut command: Command) -> Output {
    let mut child = command.spawn().expect("lightbench starts");
    drop(child.stdout.take());
    drop(child.stderr.take());
    child.wait_with_output().expect("lightbench ends")
}

/// A file on a disk that is always full.
fn full() -> Stdio {
    File::options().write(true).open("/dev/full").expect("/dev/full exists on Linux").into()
}

const BAD: &[&str] = &["--lights", "-1"];
const LIST: &[&str] = &["list", "strategies"];

#[test]
fn closed_output_pipes_do_not_end_a_run() {
    let folder = tempfile::tempdir().expect("a folder");
    let out = folder.path().join("out");
    let small = ["--size", "16x9", "--lights", "1", "--strategies", "None", "--truth", "none"];
    let timed = ["--frames", "1", "--warmup", "0", "--pictures", "none"];
    let out = ["--out", out.to_str().expect("UTF-8")];
    let run = [&small[..], &timed, &out].concat();
    // Every line that the program writes meets a closed pipe, and the run still succeeds.
    assert_eq!(run_unread(lightbench(&run)).status.code(), Some(0));
    assert!(folder.path().join("out/results.json").is_file());
    assert_eq!(run_unread(lightbench(LIST)).status.code(), Some(0));
    assert_eq!(run_unread(lightbench(BAD)).status.code(), Some(2));
    assert_eq!(run_unread(lightbench(&["--help"])).status.code(), Some(0));
}

#[test]
fn a_full_disk_is_an_error_without_a_panic() {
    let output_of = |mut command: Command| command.output().expect("lightbench ends");
    let mut listing = lightbench(LIST);
    listing.stdout(full());
    let output = output_of(listing);
    let stderr = String::from_utf8_lossy(&output.stderr);
    assert_eq!(output.status.code(), Some(1), "{stderr}");
    assert!(stderr.starts_with("lightbench: cannot write to standard output: "), "{stderr}");
    assert_eq!(stderr.lines().count(), 1);
    let mut bad = lightbench(BAD);
    bad.stderr(full());
    assert_eq!(output_of(bad).status.code(), Some(2));
    let mut both = lightbench(LIST);
    both.stdout(full()).stderr(full());
    assert_eq!(output_of(both).status.code(), Some(1));
}

#[test]
fn control_characters_in_arguments_do_not_reach_the_terminal() {
    let folder = tempfile::tempdir().expect("a folder");
    let out = folder.path().to_str().expect("UTF-8");
    let odd = "\u{1b}]0;title\u{7}\u{9b}2J\u{202e}.gltf";
    for arguments in [["--scene", odd, "--out", out], ["--strategies", odd, "--out", out]] {
        let output = lightbench(&arguments).output().expect("lightbench ends");
        let stderr = String::from_utf8_lossy(&output.stderr);
        assert_eq!(output.status.code(), Some(2));
        assert!(!stderr.contains(['\u{1b}', '\u{7}', '\u{9b}', '\u{202e}']), "{stderr:?}");
    }
}
