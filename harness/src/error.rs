//! Everything that ends a run, with its exit code.

use assign::AssignError;
use scenes::SceneError;
use shading::ShadingError;
use thiserror::Error;

use crate::{
    cli::{BAD_INPUT, CliError},
    results::ResultsError,
};

/// Why a run ended; one line.
#[derive(Debug, Error)]
pub enum HarnessError {
    /// A value on the command line.
    #[error(transparent)]
    Cli(#[from] CliError),
    /// A scene or its lights.
    #[error(transparent)]
    Scene(#[from] SceneError),
    /// The pipeline.
    #[error(transparent)]
    Shading(#[from] ShadingError),
    /// A strategy or the device.
    #[error(transparent)]
    Assign(#[from] AssignError),
    /// Standard output refused what was written to it.
    #[error("standard output: {0}")]
    Output(std::io::Error),
    /// The results.
    #[error(transparent)]
    Results(#[from] ResultsError),
}

impl HarnessError {
    /// 2 where the input is at fault, else 1: the device failed.
    pub fn exit_code(&self) -> u8 {
        match self {
            Self::Output(_)
            | Self::Assign(AssignError::Device(_) | AssignError::Shader { .. })
            | Self::Shading(ShadingError::Assign(
                AssignError::Device(_) | AssignError::Shader { .. },
            )) => 1,
            _ => BAD_INPUT,
        }
    }
}
