//! `lightbench` as a library: its command line, its measurements, its results and its report.

pub mod choice;
pub mod cli;
pub mod clock;
pub mod compare;
pub mod error;
pub mod list_lengths;
pub mod machine;
pub mod measure;
pub mod registry;
pub mod report;
pub mod results;
pub mod stage;
