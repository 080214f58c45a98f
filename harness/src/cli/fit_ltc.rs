//! The options of `fit-ltc`.

use std::path::PathBuf;

use clap::Args;

use super::values;

/// The options of `lightbench fit-ltc`.
#[derive(Args, Clone, Debug, PartialEq, Eq)]
pub struct FitLtcArgs {
    /// Folder for the table and the polynomials [default: write none, only compare]
    #[arg(long, value_name = "DIR")]
    pub out: Option<PathBuf>,

    /// Roughnesses to fit, and view angles per roughness, 2 to 1,024
    #[arg(long, value_name = "N", default_value = "64", allow_hyphen_values = true, value_parser = values::table_size)]
    pub size: usize,
}
