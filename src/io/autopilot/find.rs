//! Finds an autopilot's program: from the command line, an environment variable, or the search path.

use super::config::AutopilotKind;
use crate::errors::AppError;
use std::ffi::OsString;
use std::path::{Path, PathBuf};

/// An autopilot's program.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct AutopilotProgram {
    /// The executable.
    pub binary: PathBuf,
    /// PX4's `etc` folder with its startup scripts.
    pub etc: Option<PathBuf>,
}

impl AutopilotKind {
    fn option(self) -> &'static str {
        match self {
            Self::Px4 => "--px4",
            Self::ArduPilot => "--ardupilot",
        }
    }

    fn variable(self) -> &'static str {
        match self {
            Self::Px4 => "SPANDREL_PX4",
            Self::ArduPilot => "SPANDREL_ARDUPILOT",
        }
    }

    fn binary_name(self) -> &'static str {
        match self {
            Self::Px4 => "px4",
            Self::ArduPilot => "arducopter",
        }
    }

    /// Returns the places of the program in a build or source folder.
    fn places(self) -> &'static [&'static str] {
        match self {
            Self::Px4 => &["bin/px4", "build/px4_sitl_default/bin/px4"],
            Self::ArduPilot => &["arducopter", "bin/arducopter", "build/sitl/bin/arducopter"],
        }
    }

    /// Returns how a user gets the program.
    fn instructions(self) -> &'static str {
        match self {
            Self::Px4 => {
                "build PX4 with `make px4_sitl_default` in its source folder, then specify that folder (docs: \"Fly with PX4 or \
                 ArduPilot\")"
            }
            Self::ArduPilot => {
                "build ArduPilot with `./waf configure --board sitl && ./waf copter` in its source folder, then specify that \
                 folder (docs: \"Fly with PX4 or ArduPilot\")"
            }
        }
    }
}

/// Finds the program.
///
/// # Errors
/// Returns an error that explains how to get the program if it cannot be found.
pub fn find(kind: AutopilotKind, given: Option<&Path>) -> Result<AutopilotProgram, AppError> {
    let variable = std::env::var_os(kind.variable()).filter(|text| !text.is_empty());
    find_in(kind, given, variable, std::env::var_os("PATH"))
}

fn find_in(
    kind: AutopilotKind,
    given: Option<&Path>,
    variable: Option<OsString>,
    search_path: Option<OsString>,
) -> Result<AutopilotProgram, AppError> {
    let named = given.map(|path| (kind.option(), path.to_owned()));
    if let Some((source, path)) = named.or_else(|| variable.map(|path| (kind.variable(), PathBuf::from(path)))) {
        let binary = in_place(kind, &path).ok_or_else(|| {
            let places = kind.places().join(", ");
            AppError::invalid(format!(
                "{source} {}: neither {} nor a folder with one of {places}: {}",
                path.display(),
                kind.binary_name(),
                kind.instructions()
            ))
        })?;
        return with_scripts(kind, binary);
    }
    let folders = search_path.iter().flat_map(std::env::split_paths);
    let found = folders.map(|folder| folder.join(kind.binary_name())).find(|binary| binary.is_file());
    found.ok_or_else(|| not_found(kind)).and_then(|binary| with_scripts(kind, binary))
}

fn not_found(kind: AutopilotKind) -> AppError {
    AppError::invalid(format!(
        "{} was not found: it is not on the search path, and neither {} nor {} specifies it; {}",
        kind.name(),
        kind.option(),
        kind.variable(),
        kind.instructions()
    ))
}

/// Returns the program at a path: the executable itself, or one of its places in a folder.
fn in_place(kind: AutopilotKind, path: &Path) -> Option<PathBuf> {
    let candidates = std::iter::once(path.to_owned()).chain(kind.places().iter().map(|place| path.join(place)));
    candidates.filter(|binary| binary.is_file()).find_map(|binary| std::fs::canonicalize(binary).ok())
}

/// Adds PX4's startup scripts, which its build puts beside the `bin` folder.
fn with_scripts(kind: AutopilotKind, binary: PathBuf) -> Result<AutopilotProgram, AppError> {
    if kind == AutopilotKind::ArduPilot {
        return Ok(AutopilotProgram { binary, etc: None });
    }
    let binary = std::fs::canonicalize(&binary).unwrap_or(binary);
    let etc = binary.parent().and_then(Path::parent).map(|build| build.join("etc"));
    match etc.filter(|etc| etc.join("init.d-posix/rcS").is_file()) {
        Some(etc) => Ok(AutopilotProgram { binary, etc: Some(etc) }),
        None => Err(AppError::invalid(format!(
            "{}: PX4's startup script etc/init.d-posix/rcS is not in the folder above; use the px4 of a complete SITL build",
            binary.display()
        ))),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A folder that looks like PX4's build folder.
    fn px4_build(folder: &Path) -> PathBuf {
        std::fs::create_dir_all(folder.join("bin")).unwrap();
        std::fs::create_dir_all(folder.join("etc/init.d-posix")).unwrap();
        std::fs::write(folder.join("bin/px4"), "").unwrap();
        std::fs::write(folder.join("etc/init.d-posix/rcS"), "").unwrap();
        folder.join("bin/px4")
    }

    #[test]
    fn exact_program_is_found_by_option_variable_and_search_path_in_this_order() {
        let temp = tempfile::tempdir().unwrap();
        let folder = std::fs::canonicalize(temp.path()).unwrap();
        let [a, b, c] = ["a", "b", "c"].map(|name| folder.join(name));
        let [in_a, in_b, in_c] = [&a, &b, &c].map(|folder| px4_build(folder));
        let found = |given: Option<&Path>, variable: Option<&Path>, path: Option<&Path>| {
            let text = |path: &Path| path.as_os_str().to_owned();
            find_in(AutopilotKind::Px4, given, variable.map(text), path.map(text)).map(|program| program.binary)
        };
        let bin = c.join("bin");
        assert_eq!(found(Some(&a), Some(&b), Some(&bin)), Ok(in_a));
        assert_eq!(found(None, Some(&in_b), Some(&bin)), Ok(in_b.clone()));
        assert_eq!(found(None, None, Some(&bin)), Ok(in_c));
        let missing = found(None, None, None).unwrap_err().to_string();
        assert!(missing.contains("SPANDREL_PX4") && missing.contains("make px4_sitl_default"), "{missing}");
    }

    #[test]
    fn exact_wrong_places_are_named() {
        let temp = tempfile::tempdir().unwrap();
        let told = find_in(AutopilotKind::ArduPilot, Some(temp.path()), None, None).unwrap_err().to_string();
        assert!(told.starts_with("--ardupilot") && told.contains("build/sitl/bin/arducopter"), "{told}");
        std::fs::create_dir_all(temp.path().join("bin")).unwrap();
        std::fs::write(temp.path().join("bin/px4"), "").unwrap();
        let told = find_in(AutopilotKind::Px4, Some(temp.path()), None, None).unwrap_err().to_string();
        assert!(told.contains("etc/init.d-posix/rcS"), "{told}");
    }
}
