//! Child processes of `train` and `demo`. Each one runs the same program with another subcommand. The parent owns the
//! write end of each child's standard input; when the parent exits for any reason, the pipe closes and the child shuts
//! down (`--leash`).

use super::clock::Stopwatch;
use crate::errors::{AppError, AutopilotFailure};
use serde_json::Value;
use std::io::{BufRead, BufReader, Write};
use std::process::{ChildStdin, Command, ExitStatus, Stdio};
use std::sync::mpsc::{Receiver, RecvTimeoutError, channel};
use std::time::Duration;

/// Time limit for a child to open its sockets and load its site on a busy machine.
const START_TIMEOUT: Duration = Duration::from_secs(60);
/// Time limit for a child to shut down cleanly. On a busy machine, the monitor needs more than ten seconds to write its report.
const SHUTDOWN_TIMEOUT: Duration = Duration::from_secs(60);
/// Interval between checks of a child that is shutting down.
const CHECK_INTERVAL: Duration = Duration::from_millis(20);

/// Returns the error for a child that exited early. The failure of an external autopilot keeps its exit code.
pub fn early_exit(name: &str, status: ExitStatus) -> AppError {
    match AutopilotFailure::of_exit_code(status.code()) {
        Some(failure) => {
            AppError::Autopilot(failure, format!("the {name} stopped because the autopilot failed; see its message above"))
        }
        None => AppError::failed(format!("the {name} exited early ({status})")),
    }
}

/// A running child process.
#[derive(Debug)]
pub struct Child {
    name: &'static str,
    process: std::process::Child,
    stdin: Option<ChildStdin>,
    lines: Receiver<String>,
}

impl Child {
    /// Starts `spandrel NAME ARGS`.
    ///
    /// # Errors
    /// Returns an error if the process cannot be started.
    pub fn start(name: &'static str, args: &[String]) -> Result<Self, AppError> {
        let failed = |error: std::io::Error| AppError::failed(format!("cannot start the {name}: {error}"));
        let program = std::env::current_exe().map_err(failed)?;
        let mut process = Command::new(program)
            .arg(name)
            .args(args)
            .args(["--announce", "--leash"])
            .stdin(Stdio::piped())
            .stdout(Stdio::piped())
            .spawn()
            .map_err(failed)?;
        let leash = process.stdin.take();
        let (sender, lines) = channel();
        if let Some(stdout) = process.stdout.take() {
            std::thread::spawn(move || {
                for line in BufReader::new(stdout).lines().map_while(Result::ok) {
                    // Keep draining the pipe after the parent has stopped reading, so that the child does not block.
                    let _ = sender.send(line);
                }
            });
        }
        Ok(Self { name, process, stdin: leash, lines })
    }

    /// Waits for the JSON line that announces the child's ports and paths.
    ///
    /// # Errors
    /// Returns an error if the child exits first, or prints anything else.
    pub fn read_announcement(&mut self) -> Result<Value, AppError> {
        let name = self.name;
        let line = self.lines.recv_timeout(START_TIMEOUT).map_err(|error| match self.early_exit_status(error) {
            Some(status) => {
                let why = format!("the {name} did not start ({status}); see its message in the terminal");
                if status.code() == Some(2) { AppError::invalid(why) } else { AppError::failed(why) }
            }
            None => AppError::failed(format!("the {name} has not started after {} s", START_TIMEOUT.as_secs())),
        })?;
        serde_json::from_str(&line)
            .map_err(|error| AppError::failed(format!("the {name} printed an invalid startup line '{line}': {error}")))
    }

    /// Returns the exit status of a child that exited before announcing its ports.
    fn early_exit_status(&mut self, error: RecvTimeoutError) -> Option<ExitStatus> {
        match error {
            RecvTimeoutError::Timeout => self.exit_status(),
            // The child's output closes slightly before the process exits.
            RecvTimeoutError::Disconnected => self.finish(),
        }
    }

    /// Returns the next line of the child's output, if one has arrived.
    pub fn try_read_line(&self) -> Option<String> {
        self.lines.try_recv().ok()
    }

    /// Sends a line to the child. If the child has exited or is shutting down, the line has no effect; the exit is
    /// reported elsewhere.
    pub fn send_line(&mut self, line: &str) {
        let told = self.stdin.as_mut().map(|leash| writeln!(leash, "{line}").and_then(|()| leash.flush()));
        if let Some(Err(error)) = told {
            tracing::debug!("cannot send '{line}' to the {}: {error}", self.name);
        }
    }

    /// Returns the exit status, if the child has exited.
    pub fn exit_status(&mut self) -> Option<ExitStatus> {
        self.process.try_wait().ok().flatten()
    }

    /// Closes the child's standard input, which makes the child shut down.
    pub fn close_stdin(&mut self) {
        self.stdin = None;
    }

    /// Asks the child to shut down and waits for it; kills it after the time limit.
    pub fn finish(&mut self) -> Option<ExitStatus> {
        self.close_stdin();
        let watch = Stopwatch::start();
        while watch.elapsed() < SHUTDOWN_TIMEOUT {
            if let Some(status) = self.exit_status() {
                return Some(status);
            }
            std::thread::sleep(CHECK_INTERVAL);
        }
        tracing::warn!("the {} did not exit in time and was killed", self.name);
        // Both calls fail only if the child has just exited.
        let _ = self.process.kill();
        self.process.wait().ok()
    }
}

impl Drop for Child {
    fn drop(&mut self) {
        if self.exit_status().is_none() {
            self.finish();
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn exact_child_startup_failure_is_reported() {
        // The test executable does not accept `--announce`: it prints an error and exits.
        let mut child = Child::start("view", &[]).unwrap();
        let told = child.read_announcement().unwrap_err().to_string();
        assert!(told.starts_with("the view did not start (") && told.ends_with("see its message in the terminal"), "{told}");
    }
}
