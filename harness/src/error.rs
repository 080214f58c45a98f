//! Errors that end a run, with their exit codes.

use std::io::ErrorKind;

use assign::AssignError;
use scenes::SceneError;
use shading::ShadingError;
use thiserror::Error;

use crate::{
    cli::{BAD_INPUT, CliError},
    results::ResultsError,
};

/// The error that ended a run, as one line.
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
    /// Writing to standard output failed.
    #[error("cannot write to standard output: {0}")]
    Output(std::io::Error),
    /// What a soak found.
    #[error("{0}")]
    Finding(String),
    /// The results.
    #[error(transparent)]
    Results(#[from] ResultsError),
}

impl HarnessError {
    /// 2 for bad input; 1 if the machine lacks something or failed, and for a finding.
    pub fn exit_code(&self) -> u8 {
        let is_machine_fault = match self {
            Self::Output(_) | Self::Finding(_) => true,
            Self::Assign(error) | Self::Shading(ShadingError::Assign(error)) => {
                is_device_fault(error)
            }
            Self::Results(ResultsError::Write { source, .. }) => is_full(source.kind()),
            _ => false,
        };
        if is_machine_fault { 1 } else { BAD_INPUT }
    }
}

/// Whether the device failed, so that no other input would help.
fn is_device_fault(error: &AssignError) -> bool {
    matches!(
        error,
        AssignError::NoAdapter { .. }
            | AssignError::NoDevice { .. }
            | AssignError::OutOfMemory { .. }
            | AssignError::Shader { .. }
            | AssignError::Device(_)
    )
}

/// Whether the disk or the quota is full.
fn is_full(kind: ErrorKind) -> bool {
    use ErrorKind::{FileTooLarge, OutOfMemory, QuotaExceeded, StorageFull, WriteZero};
    matches!(kind, StorageFull | QuotaExceeded | FileTooLarge | OutOfMemory | WriteZero)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn faults_of_the_machine_exit_with_1_and_bad_input_with_2() {
        let written = |kind: ErrorKind| {
            let error = ResultsError::Write { path: "x".into(), source: kind.into() };
            HarnessError::from(error).exit_code()
        };
        assert_eq!(written(ErrorKind::StorageFull), 1);
        assert_eq!(written(ErrorKind::QuotaExceeded), 1);
        assert_eq!(written(ErrorKind::NotADirectory), 2);
        assert_eq!(written(ErrorKind::PermissionDenied), 2);
        let none = || AssignError::NoAdapter { looked_for: String::new() };
        assert_eq!(HarnessError::from(none()).exit_code(), 1);
        assert_eq!(HarnessError::from(ShadingError::from(none())).exit_code(), 1);
        let unknown = AssignError::UnknownAdapter { name: "x".into(), known: "y".into() };
        assert_eq!(HarnessError::from(unknown).exit_code(), 2);
    }
}
