//! Starts a real PostgreSQL server as an unprivileged user in a temporary folder. It listens on a Unix socket in that
//! folder, and on a TCP port only if a test requests one.

use std::os::unix::fs::{PermissionsExt, chown};
use std::path::{Path, PathBuf};
use std::process::{Child, Command, Stdio};

/// Debian's `nobody` and `nogroup`, because PostgreSQL does not run as root.
const NOBODY: u32 = 65_534;

/// PostgreSQL's default port, which is also part of its socket's name.
const DEFAULT_PORT: u16 = 5432;

/// A temporary PostgreSQL server.
pub struct PostgresServer {
    process: Child,
    folder: tempfile::TempDir,
}

impl PostgresServer {
    /// Starts a server without a TCP port.
    pub fn start() -> Self {
        Self::with(DEFAULT_PORT, &["listen_addresses=".to_owned()])
    }

    /// Starts a server on one of this machine's ports, with additional settings (`name=value`).
    pub fn start_on_port(port: u16, settings: &[String]) -> Self {
        let here = ["listen_addresses=127.0.0.1".to_owned(), format!("port={port}")];
        Self::with(port, &[&here, settings].concat())
    }

    fn with(port: u16, settings: &[String]) -> Self {
        let bin_folder = bin_folder();
        let folder = tempfile::tempdir().unwrap();
        std::fs::set_permissions(folder.path(), std::fs::Permissions::from_mode(0o755)).unwrap();
        let (home, data) = (folder.path().join("run"), folder.path().join("run/data"));
        std::fs::create_dir(&home).unwrap();
        if is_root() {
            chown(&home, Some(NOBODY), Some(NOBODY)).unwrap();
        }
        let at = |path: &Path| path.display().to_string();
        let made = unprivileged_command(&bin_folder.join("initdb"))
            .args(["-D", &at(&data), "-U", "spandrel", "-A", "trust", "-E", "UTF8", "--no-locale", "--no-sync"])
            .current_dir(&home)
            .output()
            .unwrap();
        assert!(made.status.success(), "initdb: {}", String::from_utf8_lossy(&made.stderr));
        let log = std::fs::File::create(folder.path().join("log.txt")).unwrap();
        let process = unprivileged_command(&bin_folder.join("postgres"))
            .args(["-D", &at(&data), "-k", &at(&home), "-c", "fsync=off", "-c", "max_connections=60"])
            .args(settings.iter().flat_map(|setting| ["-c", setting.as_str()]))
            .current_dir(&home)
            .stdout(Stdio::null())
            .stderr(log)
            .spawn()
            .unwrap();
        let mut server = Self { process, folder };
        // pg_isready connects to the server and waits for a response.
        let place = ["-h".to_owned(), at(&home), "-p".to_owned(), port.to_string()];
        let ready = || Command::new(bin_folder.join("pg_isready")).args(&place).args(["-t", "1"]).output().unwrap().status;
        while !ready().success() {
            if let Some(status) = server.process.try_wait().unwrap() {
                let said = std::fs::read_to_string(server.folder.path().join("log.txt")).unwrap_or_default();
                panic!("PostgreSQL exited ({status}): {said}");
            }
        }
        server
    }

    /// Returns the URL of the socket in the server's folder.
    pub fn url(&self) -> String {
        format!("postgres://spandrel@localhost/postgres?host={}", self.folder.path().join("run").display())
    }
}

impl Drop for PostgresServer {
    fn drop(&mut self) {
        // pg_ctl stops the server's child processes first; killing the server would leave them running.
        let data = self.folder.path().join("run/data").display().to_string();
        let stopped = unprivileged_command(&bin_folder().join("pg_ctl"))
            .args(["stop", "-D", &data, "-m", "fast", "-s"])
            .current_dir("/")
            .status();
        if !stopped.is_ok_and(|status| status.success()) {
            let _ = self.process.kill();
        }
        let _ = self.process.wait();
    }
}

/// Returns the folder of the PostgreSQL executables: Debian's location, or a folder in the PATH.
fn bin_folder() -> PathBuf {
    let versions = std::fs::read_dir("/usr/lib/postgresql").into_iter().flatten().flatten();
    let mut found: Vec<PathBuf> =
        versions.map(|entry| entry.path().join("bin")).filter(|bin| bin.join("postgres").is_file()).collect();
    found.sort();
    let path = std::env::var_os("PATH").unwrap_or_default();
    found.extend(std::env::split_paths(&path).filter(|bin| bin.join("initdb").is_file()));
    found.into_iter().next().expect("PostgreSQL is not installed; tools/test installs it (Debian: apt-get install postgresql)")
}

fn is_root() -> bool {
    Command::new("id").arg("-u").output().is_ok_and(|told| told.stdout == b"0\n")
}

fn unprivileged_command(program: &Path) -> Command {
    if !is_root() {
        return Command::new(program);
    }
    let mut command = Command::new("setpriv");
    command.args(["--reuid", &NOBODY.to_string(), "--regid", &NOBODY.to_string(), "--clear-groups", "--"]).arg(program);
    command
}

/// Changes a file's owner to the user that runs PostgreSQL, and makes the file readable only by that user. PostgreSQL
/// rejects private keys with other permissions.
pub fn set_owner_to_postgres(file: &Path) {
    std::fs::set_permissions(file, std::fs::Permissions::from_mode(0o600)).unwrap();
    if is_root() {
        chown(file, Some(NOBODY), Some(NOBODY)).unwrap();
    }
}
