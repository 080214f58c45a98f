//! What may make a frame late is counted: strategies make pipelines, bind groups and buffers only through `assign::Gpu`,
//! and wait only there. No clock is read, because a web page has none of that kind.

use std::fs;

use crate::{crates, source_files};

/// Calls that are not counted, or wait.
const WORDS: [&str; 9] = [
    ".create_bind_group(",
    ".create_compute_pipeline(",
    ".create_render_pipeline(",
    ".create_buffer(",
    ".create_buffer_init(",
    ".create_shader_module",
    "block_on(",
    "PollType",
    "Instant::now(",
];

/// The files that may, and what: each counts what it makes, or a renderer need not call it.
const ALLOWED: [(&str, &str); 8] = [
    ("assign/src/gpu.rs", ".create_bind_group("),
    ("assign/src/gpu.rs", ".create_render_pipeline("),
    ("assign/src/gpu.rs", ".create_buffer("),
    ("assign/src/gpu.rs", "PollType"),
    ("assign/src/gpu_open.rs", "block_on("),
    ("assign/src/compiled.rs", ".create_compute_pipeline("),
    ("assign/src/shader.rs", ".create_shader_module"),
    // With the feature `build-time`.
    ("assign/src/light_buffer.rs", "Instant::now("),
];

/// The forbidden words of a source, without its tests.
fn forbidden(path: &str, source: &str) -> Vec<&'static str> {
    let code = source.split("#[cfg(test)]").next().unwrap_or_default();
    let is_forbidden =
        |word: &&'static str| code.contains(*word) && !ALLOWED.contains(&(path, *word));
    WORDS.into_iter().filter(is_forbidden).collect()
}

#[test]
fn strategies_make_and_wait_only_through_the_counted_functions() {
    let mut files = 0;
    for (name, folder) in crates().into_iter().filter(|(name, _)| name.starts_with("assign")) {
        for file in source_files(&folder.join("src")) {
            let path = file.strip_prefix(&folder).unwrap().to_string_lossy().replace('\\', "/");
            // The suite draws surfaces; it is for tests.
            if !path.ends_with(".rs") || path.contains("/conformance") {
                continue;
            }
            let path = format!("{name}/{path}");
            let source = fs::read_to_string(&file).unwrap();
            let found = forbidden(&path, &source);
            assert!(found.is_empty(), "{path} calls {found:?}: use the functions of `assign::Gpu`");
            files += 1;
        }
    }
    assert!(files > 80, "{files} files");
    for (path, word) in ALLOWED {
        let source = fs::read_to_string(crate::workspace().join(path)).unwrap();
        assert!(source.contains(word), "{path} does not call {word} any more");
    }
}

#[test]
fn a_planted_call_is_found() {
    let planted = "fn f(gpu: &Gpu) { gpu.device.create_bind_group(&d); }";
    assert_eq!(forbidden("assign/src/lists.rs", planted), [".create_bind_group("]);
    assert!(forbidden("assign/src/gpu.rs", planted).is_empty());
    let in_tests = "#[cfg(test)]\nmod tests { fn f() { pollster::block_on(x); } }";
    assert!(forbidden("assign/src/lists.rs", in_tests).is_empty());
}
