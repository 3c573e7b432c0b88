//! Child processes of `train` and `demo`: this same program with another subcommand. Each hangs on a leash (its standard input): when
//! the parent ends, in whatever way, the leash ends and the child finishes.

use super::clock::Stopwatch;
use crate::errors::AppError;
use serde_json::Value;
use std::io::{BufRead, BufReader, Write};
use std::process::{ChildStdin, Command, ExitStatus, Stdio};
use std::sync::mpsc::{Receiver, RecvTimeoutError, channel};
use std::time::Duration;

/// A child has this long to open its sockets and build its site on a busy machine.
const START_LIMIT: Duration = Duration::from_secs(60);
/// A child has this long to finish cleanly.
const END_LIMIT: Duration = Duration::from_secs(10);
/// Between two looks at a child that is ending.
const LOOK: Duration = Duration::from_millis(20);

/// A running child.
#[derive(Debug)]
pub struct Child {
    name: &'static str,
    process: std::process::Child,
    stdin: Option<ChildStdin>,
    lines: Receiver<String>,
}

impl Child {
    /// Starts `spandrel SUBCOMMAND ARGS`.
    ///
    /// # Errors
    /// If it cannot be started.
    pub fn start(name: &'static str, args: &[String]) -> Result<Self, AppError> {
        Self::start_sibling(name, args, &[])
    }

    /// Starts it with further variables in its environment.
    ///
    /// # Errors
    /// If it cannot be started.
    pub fn start_sibling(name: &'static str, args: &[String], environment: &[(&str, String)]) -> Result<Self, AppError> {
        let failed = |error: std::io::Error| AppError::failed(format!("cannot start the {name}: {error}"));
        let program = std::env::current_exe().map_err(failed)?;
        let mut process = Command::new(program)
            .arg(name)
            .args(args)
            .args(["--announce", "--leash"])
            .envs(environment.iter().map(|(key, value)| (key, value)))
            .stdin(Stdio::piped())
            .stdout(Stdio::piped())
            .spawn()
            .map_err(failed)?;
        let leash = process.stdin.take();
        let (sender, lines) = channel();
        if let Some(stdout) = process.stdout.take() {
            std::thread::spawn(move || {
                for line in BufReader::new(stdout).lines().map_while(Result::ok) {
                    // The parent may have stopped listening; the pipe is emptied all the same.
                    let _ = sender.send(line);
                }
            });
        }
        Ok(Self { name, process, stdin: leash, lines })
    }

    /// Waits for the line that announces ports and places.
    ///
    /// # Errors
    /// When the child ends first, or says something else.
    pub fn announced(&mut self) -> Result<Value, AppError> {
        let name = self.name;
        let line = self.lines.recv_timeout(START_LIMIT).map_err(|error| match self.ended_after(error) {
            Some(status) => {
                let why = format!("the {name} did not start ({status}); its message is in the terminal");
                if status.code() == Some(2) { AppError::wrong(why) } else { AppError::failed(why) }
            }
            None => AppError::failed(format!("the {name} has not started after {} s", START_LIMIT.as_secs())),
        })?;
        serde_json::from_str(&line).map_err(|error| AppError::failed(format!("the {name} announced '{line}': {error}")))
    }

    /// How it ended that has not announced anything.
    fn ended_after(&mut self, error: RecvTimeoutError) -> Option<ExitStatus> {
        match error {
            RecvTimeoutError::Timeout => self.ended(),
            // Its output ends a moment before the process does.
            RecvTimeoutError::Disconnected => self.finish(),
        }
    }

    /// A further line of its results, if there is one by now.
    pub fn line(&self) -> Option<String> {
        self.lines.try_recv().ok()
    }

    /// Says a line to it. One that has ended, or that has been asked to finish, hears nothing: that is told elsewhere.
    pub fn send_line(&mut self, line: &str) {
        let told = self.stdin.as_mut().map(|leash| writeln!(leash, "{line}").and_then(|()| leash.flush()));
        if let Some(Err(error)) = told {
            tracing::debug!("the {} does not hear '{line}': {error}", self.name);
        }
    }

    /// How it ended, if it has.
    pub fn ended(&mut self) -> Option<ExitStatus> {
        self.process.try_wait().ok().flatten()
    }

    /// Asks it to finish.
    pub fn detach(&mut self) {
        self.stdin = None;
    }

    /// Asks it to finish and waits; a child that does not is ended.
    pub fn finish(&mut self) -> Option<ExitStatus> {
        self.detach();
        let watch = Stopwatch::start();
        while watch.elapsed() < END_LIMIT {
            if let Some(status) = self.ended() {
                return Some(status);
            }
            std::thread::sleep(LOOK);
        }
        tracing::warn!("the {} does not finish and is ended", self.name);
        // Both fail only when it has just ended by itself.
        let _ = self.process.kill();
        self.process.wait().ok()
    }
}

impl Drop for Child {
    fn drop(&mut self) {
        if self.ended().is_none() {
            self.finish();
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn exact_a_child_that_does_not_start_is_reported_and_where_its_message_is() {
        // The tests' own program knows no --announce: it says so, and ends.
        let mut child = Child::start("view", &[]).unwrap();
        let told = child.announced().unwrap_err().to_string();
        assert!(told.starts_with("the view did not start (") && told.ends_with("its message is in the terminal"), "{told}");
    }
}
