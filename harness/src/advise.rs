//! `lightbench advise`: a short search for what to use.

use crate::{cli::AdviseArgs, error::HarnessError};

/// Searches, and says what to use.
pub fn advise(args: &AdviseArgs, command: Vec<String>) -> Result<String, HarnessError> {
    Ok(format!("{args:?} {command:?}"))
}
