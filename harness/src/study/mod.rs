//! Studies: lists of comparisons, each a job of its own. A study goes on where it was interrupted, and can
//! be split over machines.
//!
//! A job is a `lightbench compare`, `truth` or `cdi` command. Its folder, `jobs/NAME`, holds what that
//! command writes. A job is done where its `results.json` is there, is whole, and holds all records of its
//! command. `study.json` beside `jobs` lists all jobs, also those of other shards.
//!
//! Each study is a folder here that holds its jobs, its page and its claims, and one row of data that names them,
//! a `Study` (`slice.rs`). Adding a study takes its folder, its `mod` line below, and its place in
//! `list.rs`. Everything else asks the list: the command line, the report and the tests of all pages.

mod against_truth;
mod area;
mod cdi;
mod claims;
mod comparison;
mod culling;
mod data;
mod endless;
mod engines;
mod gloss;
mod job;
mod list;
mod living;
mod manifest;
mod motion;
mod page;
mod report;
mod run;
mod scene;
mod shadows;
mod slice;
mod stability;

pub use against_truth::{MODELS, TRUTH, truth_of};
pub use area::BOUNDS;
pub use job::{Job, Settings};
pub use list::studies;
pub use manifest::{Done, Manifest};
pub use report::{check_study, claims_markdown, complete, write_study};
pub use run::study;
pub use scene::StudyScene;
