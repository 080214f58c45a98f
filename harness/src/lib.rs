//! `lightbench` as a library: its command line, its measurements, its results and its report.

#![deny(clippy::print_stdout, clippy::print_stderr)]

pub mod advise;
pub mod bench;
pub mod camera;
pub mod chart;
mod checks;
pub mod choice;
pub mod cli;
pub mod clock;
pub mod compare;
pub mod deep;
pub mod deep_image_run;
mod described;
mod digits;
pub mod drift;
pub mod error;
pub mod fit_ltc;
mod grouping;
pub mod image_errors;
pub mod interrupted;
pub mod list_lengths;
pub mod machine;
pub mod measure;
pub mod messages;
pub mod open_lights;
pub mod optics;
pub mod out_folder;
pub mod painter;
pub mod pass_samples;
pub mod pictures;
pub mod range_errors;
pub mod record;
pub mod report;
pub mod results;
pub mod schedule;
pub mod sight;
pub mod stage;
pub mod stored;
pub mod stored_report;
pub mod strategy;
pub mod study;
pub mod truth;
mod truth_level;
pub mod visible;
pub mod vpls;
