//! `lightbench fit-ltc`: linearly transformed cosines fitted anew, and how good they are.

use indicatif::{ProgressBar, ProgressStyle};
use shading::ltc::{Accuracy, FitReport, POLYNOMIAL_COMPONENTS, generate};

use crate::{cli::FitLtcArgs, error::HarnessError};

/// Fits, writes the files if there is a folder for them, and returns what to print.
///
/// # Errors
///
/// [`HarnessError::Shading`] where a file cannot be written.
pub fn fit_ltc(args: &FitLtcArgs) -> Result<String, HarnessError> {
    let style = ProgressStyle::with_template("{bar:30} {pos}/{len} lobes, {eta} left")
        .unwrap_or_else(|_| ProgressStyle::default_bar());
    let bar = ProgressBar::new(2 * (args.size * args.size) as u64).with_style(style);
    let report = generate(args.out.as_deref(), args.size, |lobes| bar.inc(lobes as u64))?;
    bar.finish_and_clear();
    Ok(text_of(&report))
}

fn text_of(report: &FitReport) -> String {
    let mut text = String::from("Specular error over random rectangles, relative:\n");
    let rows =
        [("table", report.table), ("Hammon's", report.hammon), ("polynomials", report.polynomial)];
    for (name, accuracy) in rows {
        let Accuracy { median, bias, p95 } = accuracy;
        text += &format!(
            "  {name:<12} median {:.1} %, mean {:+.1} %, p95 {:.0} %\n",
            100.0 * median,
            100.0 * bias,
            100.0 * p95
        );
    }
    text += "Root mean square error of the polynomials:\n";
    for (name, error) in POLYNOMIAL_COMPONENTS.iter().zip(report.rms_errors) {
        text += &format!("  {name:<12} {error:.4}\n");
    }
    text + &format!(
        "Largest difference to the table in use:\n  {:<12} {:.1e}\n  {:<12} {:.1e}\n",
        "A, B", report.difference.integrals, "covered", report.difference.covered
    )
}
