//! The options of `report`.

use std::path::PathBuf;

use clap::Args;

/// The options of `lightbench report`.
#[derive(Args, Clone, Debug, PartialEq)]
pub struct ReportArgs {
    /// A folder of a comparison or a study, or a file of results
    ///
    /// For a study in shards, give the folders of all its shards.
    #[arg(value_name = "DIR|FILE.json", required = true)]
    pub folders: Vec<PathBuf>,

    /// Folder for the report [default: the first folder; for FILE.json, a folder FILE beside it]
    #[arg(long, value_name = "DIR")]
    pub out: Option<PathBuf>,
}
