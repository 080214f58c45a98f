//! `assign::intersect` against exact geometry in f64, and the WESL tests against both.
//!
//! Loose is allowed and measured, tight is a failure.

#![allow(clippy::unwrap_used, reason = "a test fails by panicking")]

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

/// The same cases on every run.
fn deterministic(cases: u32) -> Config {
    Config { cases, rng_seed: RngSeed::Fixed(2019), failure_persistence: None, ..Config::default() }
}
