//! `lightbench` as a library: its command line, its measurements, its results and its report.

pub mod advise;
pub mod again;
pub mod chart;
mod checks;
pub mod choice;
pub mod cli;
pub mod clock;
pub mod compare;
mod digits;
pub mod error;
pub mod errors;
pub mod fit_ltc;
pub mod list_lengths;
pub mod machine;
pub mod measure;
pub mod painter;
pub mod pictures;
pub mod record;
pub mod registry;
pub mod report;
pub mod results;
pub mod schedule;
pub mod stage;
pub mod stored;
pub mod study;
pub mod truth;
