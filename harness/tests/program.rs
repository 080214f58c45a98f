//! The program and the streams that it writes to, as a shell connects them.

use std::{
    fs::File,
    process::{Command, Output, Stdio},
};

fn lightbench(arguments: &[&str]) -> Command {
    let mut command = Command::new(env!("CARGO_BIN_EXE_lightbench"));
    command.args(arguments).stdout(Stdio::piped()).stderr(Stdio::piped());
    command
}

/// Runs it with nobody at the other end of a stream.
fn unread(mut command: Command) -> Output {
    let mut child = command.spawn().expect("starts");
    drop(child.stdout.take());
    drop(child.stderr.take());
    child.wait_with_output().expect("ends")
}

/// A disk that is always full.
fn full() -> Stdio {
    File::options().write(true).open("/dev/full").expect("Linux has it").into()
}

const BAD: &[&str] = &["--lights", "-1"];
const LIST: &[&str] = &["list", "strategies"];

#[test]
fn nobody_need_read_what_it_says() {
    let folder = tempfile::tempdir().expect("a folder");
    let out = folder.path().join("out");
    let small = ["--size", "16x9", "--lights", "1", "--strategies", "None", "--truth", "none"];
    let timed = ["--frames", "1", "--warmup", "0", "--pictures", "none"];
    let out = ["--out", out.to_str().expect("UTF-8")];
    let run = [&small[..], &timed, &out].concat();
    // Every line that it says meets a closed pipe, and the run ends well all the same.
    assert_eq!(unread(lightbench(&run)).status.code(), Some(0));
    assert!(folder.path().join("out/results.json").is_file());
    assert_eq!(unread(lightbench(LIST)).status.code(), Some(0));
    assert_eq!(unread(lightbench(BAD)).status.code(), Some(2));
    assert_eq!(unread(lightbench(&["--help"])).status.code(), Some(0));
}

#[test]
fn a_full_disk_behind_a_stream_is_no_panic() {
    let ended = |mut command: Command| command.output().expect("ends");
    let mut listing = lightbench(LIST);
    listing.stdout(full());
    let output = ended(listing);
    let stderr = String::from_utf8_lossy(&output.stderr);
    assert_eq!(output.status.code(), Some(1), "{stderr}");
    assert!(stderr.starts_with("lightbench: standard output: "), "{stderr}");
    assert_eq!(stderr.lines().count(), 1);
    let mut bad = lightbench(BAD);
    bad.stderr(full());
    assert_eq!(ended(bad).status.code(), Some(2));
    let mut both = lightbench(LIST);
    both.stdout(full()).stderr(full());
    assert_eq!(ended(both).status.code(), Some(1));
}

#[test]
fn names_from_the_command_line_cannot_drive_a_terminal() {
    let folder = tempfile::tempdir().expect("a folder");
    let out = folder.path().to_str().expect("UTF-8");
    let odd = "\u{1b}]0;title\u{7}\u{9b}2J\u{202e}.gltf";
    for arguments in [["--scene", odd, "--out", out], ["--strategies", odd, "--out", out]] {
        let output = lightbench(&arguments).output().expect("ends");
        let stderr = String::from_utf8_lossy(&output.stderr);
        assert_eq!(output.status.code(), Some(2));
        assert!(!stderr.contains(['\u{1b}', '\u{7}', '\u{9b}', '\u{202e}']), "{stderr:?}");
    }
}
