//! Subcommand errors, with exit codes that scripts can rely on. Each error is reported once.

use spandrel_model::toml::Problems;
#[cfg(feature = "view")]
use spandrel_view::{gpu::GpuError, photo::PhotoError, video::VideoError};
use std::process::ExitCode;

/// Exit codes, listed at the end of every help text.
pub const EXIT_CODES: &str = "Exit codes: 0 success; 1 failure; 2 invalid arguments or files.";

/// A subcommand's error.
#[derive(Debug, Clone, PartialEq, Eq, thiserror::Error)]
pub enum AppError {
    /// Invalid arguments or files (exit code 2).
    #[error("{0}")]
    Wrong(String),
    /// The operation failed (exit code 1).
    #[error("{0}")]
    Failed(String),
}

impl AppError {
    /// Creates an error for invalid arguments or files.
    pub fn invalid(message: impl Into<String>) -> Self {
        Self::Wrong(message.into())
    }

    /// Creates an error for an operation that failed.
    pub fn failed(message: impl Into<String>) -> Self {
        Self::Failed(message.into())
    }

    /// Prints the error to standard error and returns the exit code.
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
            GpuError::TooLarge(..) => Self::invalid(format!("{error}: choose a smaller --size")),
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
