//! `lightbench truth`: what a view should look like, rendered on the CPU from the surfaces that the
//! GPU drew.

use std::time::Instant;

use indicatif::{ProgressBar, ProgressStyle};
use shading::{EDGE, HdrImage, luminance};

use crate::{
    checks::{check_writable, remove_stale},
    cli::TruthArgs,
    compare::Bench,
    error::HarnessError,
    results::{Results, Truth, TruthImage, TruthLevel, write_atomically},
};

/// A standard error of this share of the mean luminance is white.
const WHITE: f64 = 0.01;

/// Renders a truth image into its folder; returns what to print. `command` is the command line, for
/// provenance.
pub fn truth(args: &TruthArgs, command: Vec<String>) -> Result<String, HarnessError> {
    check_writable(&args.out)?;
    let mut bench = Bench::open(args.adapter.as_deref())?;
    let results = render(&mut bench, args, command)?;
    let data = args.out.join("results.json");
    results.write(&data)?;
    let summary = results.truth_image.as_ref().map(summary).unwrap_or_default();
    Ok(format!("{summary}data     {}\n", data.display()))
}

/// `truth    atrium, 3 lights, 640x360: standard error 0.03 % of the mean, 12.3 s`.
fn summary(image: &TruthImage) -> String {
    format!(
        "truth    {}, {} lights, {}x{}, {}, {} bounces: standard error {:.3} % of the mean, {:.1} s\n",
        image.scene,
        image.lights,
        image.width,
        image.height,
        if image.shadows { "shadows" } else { "no shadows" },
        image.bounces,
        image.standard_error * 100.0,
        image.seconds
    )
}

/// Renders a truth image into the folder of `args`; returns its results.
pub fn render(
    bench: &mut Bench,
    args: &TruthArgs,
    command: Vec<String>,
) -> Result<Results, HarnessError> {
    let _ = (bench, args, command);
    Err(crate::cli::CliError::new("no truth yet").into())
}
