//! Subcommand errors, with exit codes that scripts can rely on. Each error is reported once.

use spandrel_model::toml::Problems;
#[cfg(feature = "view")]
use spandrel_view::{gpu::GpuError, photo::PhotoError, video::VideoError};
use std::process::ExitCode;

/// Exit codes, listed at the end of every help text.
pub const EXIT_CODES: &str = "Exit codes: 0 success; 1 failure; 2 invalid arguments or files.";
/// Exit codes of subcommands that can run an external autopilot.
pub const AUTOPILOT_EXIT_CODES: &str = "Exit codes: 0 success; 1 failure; 2 invalid arguments or files. With an external autopilot: 3 it \
     did not connect or start; 4 it stopped answering; 5 it exited.";

/// Failure of an external autopilot.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum AutopilotFailure {
    /// It did not connect, or did not answer after it had connected (exit code 3).
    NoAnswer,
    /// It stopped answering (exit code 4).
    Silent,
    /// Its process exited or its connection closed (exit code 5).
    Exited,
}

impl AutopilotFailure {
    /// Returns the exit code.
    pub fn exit_code(self) -> u8 {
        match self {
            Self::NoAnswer => 3,
            Self::Silent => 4,
            Self::Exited => 5,
        }
    }

    /// Returns the failure that a child process reported with its exit code.
    pub fn of_exit_code(code: Option<i32>) -> Option<Self> {
        let all = [Self::NoAnswer, Self::Silent, Self::Exited];
        all.into_iter().find(|failure| code == Some(i32::from(failure.exit_code())))
    }
}

/// A subcommand's error.
#[derive(Debug, Clone, PartialEq, Eq, thiserror::Error)]
pub enum AppError {
    /// Invalid arguments or files (exit code 2).
    #[error("{0}")]
    Wrong(String),
    /// The operation failed (exit code 1).
    #[error("{0}")]
    Failed(String),
    /// An external autopilot failed (exit codes 3 to 5).
    #[error("{1}")]
    Autopilot(AutopilotFailure, String),
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
            Self::Autopilot(failure, message) => (failure.exit_code(), message),
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
