//! Compares `assign::intersect` with exact geometry in f64, and the WESL tests with both.
//!
//! A loose test is allowed and measured. A tight test is a failure.

#![allow(clippy::unwrap_used, reason = "a test fails by panicking")]

mod aims;
mod areas;
mod balls;
mod cases;
mod facing;
mod groups;
mod oracle;
mod pairs;
mod premises;
mod rates;
mod spots;
mod wesl;

use proptest::test_runner::{Config, RngSeed};

/// A configuration that draws the same cases on every run.
fn deterministic(cases: u32) -> Config {
    Config { cases, rng_seed: RngSeed::Fixed(2019), failure_persistence: None, ..Config::default() }
}
