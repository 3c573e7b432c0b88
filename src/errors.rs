//! Errors of a run: reported once, with an exit code that scripts can rely on.

use spandrel_model::toml::Problems;
#[cfg(feature = "view")]
use spandrel_view::{gpu::GpuError, photo::PhotoError, video::VideoError};
use std::process::ExitCode;

/// Shown under every help text.
pub const EXIT_CODES: &str = "Exit codes: 0 done; 1 the thing asked for failed; 2 the arguments or a file are wrong.";

/// Error of a subcommand.
#[derive(Debug, Clone, PartialEq, Eq, thiserror::Error)]
pub enum AppError {
    /// Arguments or a file are wrong (exit code 2).
    #[error("{0}")]
    Wrong(String),
    /// The thing asked for failed (exit code 1).
    #[error("{0}")]
    Failed(String),
}

impl AppError {
    /// Arguments or a file are wrong.
    pub fn wrong(message: impl Into<String>) -> Self {
        Self::Wrong(message.into())
    }

    /// The thing asked for failed.
    pub fn failed(message: impl Into<String>) -> Self {
        Self::Failed(message.into())
    }

    /// Logs the error on standard error and returns the exit code.
    pub(super) fn report(&self) -> ExitCode {
        let (code, message) = match self {
            Self::Wrong(message) => (2, message),
            Self::Failed(message) => (1, message),
        };
        eprintln!("spandrel: {message}");
        ExitCode::from(code)
    }
}

impl From<Problems> for AppError {
    fn from(problems: Problems) -> Self {
        Self::Wrong(problems.to_string())
    }
}

#[cfg(feature = "view")]
impl From<GpuError> for AppError {
    fn from(error: GpuError) -> Self {
        match error {
            GpuError::TooLarge(..) => Self::wrong(format!("{error}: give a smaller --size")),
            GpuError::NoDevice(_) | GpuError::Failed(_) => Self::failed(error.to_string()),
        }
    }
}

#[cfg(feature = "view")]
impl From<PhotoError> for AppError {
    fn from(error: PhotoError) -> Self {
        Self::failed(error.to_string())
    }
}

#[cfg(feature = "view")]
impl From<VideoError> for AppError {
    fn from(error: VideoError) -> Self {
        Self::failed(error.to_string())
    }
}
