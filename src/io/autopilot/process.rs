//! The process of an autopilot. It ends with its owner, and its output goes to a file.

use super::config::AutopilotKind;
use super::find::AutopilotProgram;
use crate::errors::AppError;
use spandrel_sitl::backend::launch::{Launch, LaunchFile};
use std::fs::{File, OpenOptions};
use std::path::{Path, PathBuf};
use std::process::{Child, Command, ExitStatus, Stdio};

/// File for the output of the process, in its working directory.
pub const OUTPUT_FILE: &str = "output.log";

/// A running autopilot.
#[derive(Debug)]
pub struct AutopilotProcess {
    child: Child,
}

impl AutopilotProcess {
    /// Starts the process in its working directory, for the first time or again.
    ///
    /// # Errors
    /// Returns an error if a file cannot be written or the process cannot be started.
    pub fn start(
        kind: AutopilotKind,
        program: &AutopilotProgram,
        launch: &Launch,
        folder: &Path,
        is_first: bool,
    ) -> Result<Self, AppError> {
        let output = output_file(folder)?;
        let errors = output.try_clone().map_err(|error| AppError::failed(format!("{}: {error}", folder.display())))?;
        let child =
            command(program, launch, folder, is_first).stdin(Stdio::null()).stdout(output).stderr(errors).spawn().map_err(
                |error| AppError::failed(format!("cannot start {} ({}): {error}", kind.name(), program.binary.display())),
            )?;
        tracing::info!(
            "started {} (process {}); its output goes to {}",
            kind.name(),
            child.id(),
            folder.join(OUTPUT_FILE).display()
        );
        Ok(Self { child })
    }

    /// Returns the exit status, if the process has exited.
    pub fn exit_status(&mut self) -> Option<ExitStatus> {
        self.child.try_wait().ok().flatten()
    }

    /// Ends the process. Autopilots ignore SIGTERM while they wait for the simulator, and they have no state worth saving.
    pub fn end(&mut self) {
        // Both calls fail only if the process has just exited.
        let _ = self.child.kill();
        let _ = self.child.wait();
    }
}

impl Drop for AutopilotProcess {
    fn drop(&mut self) {
        if self.exit_status().is_none() {
            self.end();
        }
    }
}

/// Writes the files that the process reads.
///
/// # Errors
/// Returns an error that names the file.
pub fn write_files(launch: &Launch, folder: &Path) -> Result<(), AppError> {
    let failed = |path: &Path, error: std::io::Error| AppError::failed(format!("{}: {error}", path.display()));
    std::fs::create_dir_all(folder).map_err(|error| failed(folder, error))?;
    for LaunchFile { name, text, executable } in &launch.files {
        let path = folder.join(name);
        std::fs::write(&path, text).map_err(|error| failed(&path, error))?;
        if *executable {
            make_executable(&path).map_err(|error| failed(&path, error))?;
        }
    }
    Ok(())
}

#[cfg(unix)]
fn make_executable(path: &Path) -> std::io::Result<()> {
    use std::os::unix::fs::PermissionsExt;
    std::fs::set_permissions(path, std::fs::Permissions::from_mode(0o755))
}

#[cfg(not(unix))]
fn make_executable(_path: &Path) -> std::io::Result<()> {
    Ok(())
}

fn output_file(folder: &Path) -> Result<File, AppError> {
    let path = folder.join(OUTPUT_FILE);
    let opened = OpenOptions::new().create(true).append(true).open(&path);
    opened.map_err(|error| AppError::failed(format!("{}: {error}", path.display())))
}

/// Returns the command. The working directory and the program's folder come first on the search path, because PX4's startup script
/// finds our scripts and its own commands there.
fn command(program: &AutopilotProgram, launch: &Launch, folder: &Path, is_first: bool) -> Command {
    let mut command = ends_with_owner(&program.binary);
    command.args(launch.args(is_first));
    if let Some(etc) = &program.etc {
        command.arg(etc);
    }
    command.current_dir(folder).envs(launch.environment.iter().map(|(name, value)| (name, value)));
    if let Some(path) = search_path(program, folder) {
        command.env("PATH", path);
    }
    command
}

/// Returns a command whose process the kernel ends when the calling thread has ended, even if the thread was killed. Otherwise, PX4 would
/// run on and keep a core busy. Elsewhere than on Linux, or without util-linux's setpriv, returns the plain command.
fn ends_with_owner(binary: &Path) -> Command {
    const OPTIONS: [&str; 3] = ["--pdeathsig", "KILL", "--"];
    let setpriv = || {
        let mut command = Command::new("setpriv");
        command.args(OPTIONS);
        command
    };
    let probe = setpriv().arg("true").stdin(Stdio::null()).stdout(Stdio::null()).stderr(Stdio::null()).status();
    if !cfg!(target_os = "linux") || !probe.is_ok_and(|status| status.success()) {
        return Command::new(binary);
    }
    let mut command = setpriv();
    command.arg(binary);
    command
}

/// Returns the search path for the process.
pub fn search_path(program: &AutopilotProgram, folder: &Path) -> Option<std::ffi::OsString> {
    let folder = std::fs::canonicalize(folder).unwrap_or_else(|_| folder.to_owned());
    let own = [Some(folder), program.binary.parent().map(PathBuf::from)].into_iter().flatten();
    let inherited = std::env::var_os("PATH").unwrap_or_default();
    std::env::join_paths(own.chain(std::env::split_paths(&inherited))).ok()
}
