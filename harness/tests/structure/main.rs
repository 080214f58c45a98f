//! The structure of the sources: modules import each other in one direction, and files stay short.
//!
//! # The rule about imports
//!
//! Each Rust file below a crate's `src` is a module. Module A uses module B where A names an item of B by a
//! `use` line, by a path with `crate`, `super` or `self`, or by a name that `use other::*` gives it.
//! Re-exports are followed: `use crate::Pose` uses the file that defines `Pose`, not `lib.rs`. A circle is a
//! set of modules each of which uses all others of the set, directly or through others.
//!
//! A module may form a circle with its own parts: a parent may re-export or call its children, and a child
//! may use what its parent defines. All modules of such a circle lie below one of them, and without that
//! one they must have no circle. `lib.rs` and `main.rs` are roots of two crates. Code under `#[cfg(test)]`
//! does not count. Files are modules by their place: `#[path]` and `include!` are refused.

#![allow(clippy::unwrap_used, reason = "a helper of a test may fail it")]

mod circles;
mod counted;
mod module;
mod tokens;

use std::{
    fs,
    path::{Path, PathBuf},
};

use circles::Crate;

/// The most lines of a Rust or WESL file.
const MAX_LINES: usize = 400;

fn workspace() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).parent().unwrap().to_owned()
}

/// The workspace's crates: each folder with a `src`.
fn crates() -> Vec<(String, PathBuf)> {
    let folders = fs::read_dir(workspace()).unwrap().map(|entry| entry.unwrap().path());
    let mut crates: Vec<(String, PathBuf)> = folders
        .filter(|folder| folder.join("Cargo.toml").is_file() && folder.join("src").is_dir())
        .map(|folder| (folder.file_name().unwrap().to_string_lossy().into_owned(), folder))
        .collect();
    crates.sort();
    crates
}

/// The crate of these files: paths of modules, joined by `::`, and their sources.
fn crate_of(files: &[(&str, &str)]) -> Crate {
    let path = |name: &str| -> Vec<String> {
        name.split("::").filter(|part| !part.is_empty()).map(str::to_owned).collect()
    };
    let read = |(name, source): &(&str, &str)| (path(name), (*source).to_owned());
    let files: Vec<_> = files.iter().map(read).collect();
    Crate::from_files(&files)
}

fn edges(files: &[(&str, &str)]) -> Vec<String> {
    crate_of(files).edges_of_circles().iter().map(ToString::to_string).collect()
}

#[test]
fn no_two_modules_import_each_other() {
    let crates = crates();
    assert!(crates.len() >= 9, "found only {} crates", crates.len());
    let mut found = Vec::new();
    for (name, folder) in &crates {
        let read = Crate::read(&folder.join("src")).unwrap();
        assert!(!read.is_empty(), "{name}: neither lib.rs nor main.rs was found");
        for read in read {
            // One of every crate's imports is seen at least: a reader that sees nothing finds no circle.
            assert!(!read.edges().is_empty(), "{name}: no import was found");
            for edge in read.edges_of_circles() {
                found.push((name.clone(), edge.to_string()));
            }
        }
        for file in source_files(&folder.join("src")) {
            let source = fs::read_to_string(&file).unwrap();
            for hidden in ["#[path", "include!("] {
                assert!(!source.contains(hidden), "{}: {hidden} hides a module", file.display());
            }
        }
    }
    let lines: Vec<String> =
        found.iter().map(|(name, edge)| format!("    {name}: {edge}")).collect();
    assert!(lines.is_empty(), "imports that lie on a circle:\n{}", lines.join("\n"));
}

#[test]
fn a_planted_circle_is_found() {
    let circle = [
        ("", "mod a; mod b; mod c; pub use a::A;"),
        ("a", "use crate::b::B;\npub struct A;"),
        ("b", "pub struct B;\nfn f() { crate::c::g() }"),
        ("c", "use super::{A, b};\npub fn g() {}"),
    ];
    assert_eq!(edges(&circle), ["a -> b", "b -> c", "c -> a", "c -> b"]);
    let mut cut = circle;
    cut[3].1 = "pub fn g() {}";
    assert!(edges(&cut).is_empty());
}

#[test]
fn a_circle_through_a_parent_is_found() {
    let circle = [
        ("", "mod a; mod b;"),
        ("a", "mod x; pub struct A; pub fn f() { x::g() }"),
        ("a::x", "use crate::b::B; pub fn g() {}"),
        ("b", "use crate::a::A; pub struct B;"),
    ];
    assert_eq!(edges(&circle), ["a -> a::x", "a::x -> b", "b -> a"]);
    let mut cut = circle;
    cut[1].1 = "mod x; pub struct A;";
    assert!(edges(&cut).is_empty(), "a does not need its child");
    // A circle below a module that takes part itself.
    let below = [
        ("", "mod a;"),
        ("a", "mod x; mod y; pub struct A; pub fn f() { x::g() }"),
        ("a::x", "use super::A; use super::y::Y; pub fn g() {} pub struct X;"),
        ("a::y", "use super::x::X; pub struct Y;"),
    ];
    assert_eq!(edges(&below), ["a::x -> a::y", "a::y -> a::x"]);
}

#[test]
fn a_circle_through_a_glob_is_found() {
    let circle = [
        ("", "mod c;"),
        ("c", "mod a; mod b; pub use b::B;"),
        ("c::a", "use super::*; pub struct A(B);"),
        ("c::b", "use super::a::A; pub struct B;"),
    ];
    assert_eq!(edges(&circle), ["c::a -> c::b", "c::b -> c::a"]);
    let mut cut = circle;
    cut[2].1 = "use super::*; pub struct A(u32);";
    assert!(edges(&cut).is_empty(), "c::a does not name B");
}

#[test]
fn a_planted_circle_on_disk_is_found() {
    let folder = tempfile::tempdir().unwrap();
    let write = |file: &str, source: &str| fs::write(folder.path().join(file), source).unwrap();
    fs::create_dir(folder.path().join("inner")).unwrap();
    write("outer.rs", "use crate::inner::leaf::Leaf; pub struct Outer;");
    write("inner/mod.rs", "pub mod leaf;");
    write("inner/leaf.rs", "use crate::Outer; pub struct Leaf;");
    // A re-export of `lib.rs` is followed where `main.rs` stands beside it.
    write("lib.rs", "mod inner; mod outer; pub use outer::Outer;");
    write("main.rs", "fn main() {}");
    let edges_of = |read: &Crate| -> Vec<String> {
        read.edges_of_circles().iter().map(ToString::to_string).collect()
    };
    let crates = Crate::read(folder.path()).unwrap();
    assert_eq!(crates.len(), 2, "lib.rs and main.rs");
    assert_eq!(edges_of(&crates[0]), ["inner::leaf -> outer", "outer -> inner::leaf"]);
}

#[test]
fn parents_tests_comments_and_text_make_no_circle() {
    let parent = [
        ("", "mod a;"),
        ("a", "mod child; pub use child::Child; pub struct Parent; fn f() { child::g() }"),
        ("a::child", "use super::Parent; pub struct Child; pub fn g() {}"),
    ];
    assert!(edges(&parent).is_empty());
    for silent in [
        "#[cfg(test)]\nmod tests { use crate::a::A; fn f() { crate::a::A; } }",
        "#[cfg(test)] mod tests;",
        "// use crate::a::A;\n/* use crate::a::A; /* nested */ crate::a::A */",
        "const TEXT: &str = \"crate::a::A\"; const RAW: &str = r#\"\" crate::a::A \"#;",
        "fn f<'a>(c: &'a char) -> bool { *c == '\"' || *c == '\\'' } pub(in crate::a) struct B2;",
    ] {
        let source = format!("{silent}\npub struct B;");
        let files = [
            ("", "mod a; mod b;"),
            ("a", "use crate::b::B; pub struct A;"),
            ("b", source.as_str()),
            ("b::tests", "use crate::a::A;"),
        ];
        let loud = format!("{source}\nuse crate::a::A;");
        let tests = if silent.ends_with("mod tests;") { 4 } else { 3 };
        assert!(edges(&files[..tests]).is_empty(), "{silent}");
        // The same file with a real import after it: nothing of it is passed over.
        assert_eq!(edges(&[files[0], files[1], ("b", &loud)]).len(), 2, "{silent}");
    }
}

#[test]
fn no_source_file_is_too_long() {
    let (mut long, mut count) = (Vec::new(), 0);
    for (_, folder) in crates() {
        for file in source_files(&folder) {
            count += 1;
            let lines = fs::read_to_string(&file).unwrap().lines().count();
            let name = file.strip_prefix(workspace()).unwrap().display().to_string();
            if lines > MAX_LINES {
                long.push(format!("{name}: {lines} lines"));
            }
        }
    }
    assert!(count > 300, "found only {count} files");
    assert!(long.is_empty(), "at most {MAX_LINES} lines are accepted: {long:#?}");
}

/// Ways of wgpu to map a buffer for reading.
const MAPS: [&str; 3] = ["map_async", "map_buffer_on_submit", "DownloadBuffer"];

/// All maps go through one function, which counts them (`Gpu::mapped`).
#[test]
fn buffers_are_mapped_in_one_place() {
    let mut places = Vec::new();
    for (_, folder) in crates() {
        // This test names them too.
        for file in source_files(&folder).iter().filter(|file| !file.ends_with(file!())) {
            let source = fs::read_to_string(file).unwrap();
            let name = file.strip_prefix(workspace()).unwrap().display().to_string();
            let found = MAPS.iter().flat_map(|way| source.matches(way));
            places.extend(found.map(|way| format!("{way} in {name}")));
        }
    }
    let counted =
        ["map_async", "map_buffer_on_submit"].map(|way| format!("{way} in assign/src/hitches.rs"));
    assert_eq!(places, counted);
}

/// The Rust and WESL files of a crate, build outputs left out.
fn source_files(folder: &Path) -> Vec<PathBuf> {
    let mut files = Vec::new();
    for entry in fs::read_dir(folder).unwrap() {
        let path = entry.unwrap().path();
        let name = path.file_name().unwrap().to_string_lossy().into_owned();
        if path.is_dir() && name != "target" && !name.starts_with('.') {
            files.extend(source_files(&path));
        } else if path.extension().is_some_and(|e| e == "rs" || e == "wesl") {
            files.push(path);
        }
    }
    files
}
