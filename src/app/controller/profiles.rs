//! Calibration profiles on disk: one file per kind of device.

use crate::app::errors::AppError;
use crate::app::files;
use crate::app::session_folder::replace;
use crate::rc::{Device, Profile};
use std::path::PathBuf;

/// The folder of profiles.
#[derive(Debug, Clone)]
pub struct Profiles(PathBuf);

impl Profiles {
    /// This folder, or the user's own (`$XDG_CONFIG_HOME` or `~/.config`, below `spandrel/controllers`).
    ///
    /// # Errors
    /// When no folder is named and the user has no home.
    pub fn at(folder: Option<PathBuf>) -> Result<Self, AppError> {
        let home = || std::env::var_os("HOME").map(|home| PathBuf::from(home).join(".config"));
        let config = std::env::var_os("XDG_CONFIG_HOME").filter(|at| !at.is_empty()).map(PathBuf::from);
        let usual = || config.or_else(home).map(|config| config.join("spandrel").join("controllers"));
        folder.or_else(usual).map(Self).ok_or_else(|| AppError::wrong("no home folder is known: name a folder with --profiles"))
    }

    /// Where a device's profile lies.
    pub fn path(&self, device: &Device) -> PathBuf {
        let harmless = |c: char| if c.is_ascii_alphanumeric() { c.to_ascii_lowercase() } else { '-' };
        let name: String = format!("{}-{}", device.name, device.id).chars().map(harmless).collect();
        self.0.join(format!("{name}.toml"))
    }

    /// A device's profile, when it has one.
    ///
    /// # Errors
    /// When the file cannot be read or is wrong.
    pub fn find(&self, device: &Device) -> Result<Option<Profile>, AppError> {
        let path = self.path(device);
        if path.exists() { read(&path).map(Some) } else { Ok(None) }
    }

    /// Keeps a profile; the old one stays until the new one is whole.
    ///
    /// # Errors
    /// When it cannot be written.
    pub fn keep(&self, profile: &Profile) -> Result<PathBuf, AppError> {
        let path = self.path(&profile.device);
        std::fs::create_dir_all(&self.0).map_err(|error| AppError::failed(format!("{}: {error}", self.0.display())))?;
        replace(&path, profile.write().as_bytes())?;
        Ok(path)
    }
}

/// Reads a profile.
///
/// # Errors
/// When the file cannot be read or is wrong: everything that is wrong with it.
pub fn read(path: &std::path::Path) -> Result<Profile, AppError> {
    Ok(Profile::read(&path.display().to_string(), &files::read(path)?)?)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::rc::StickMode;
    use crate::rc::axis::Axis;
    use crate::rc::profile::WAYS;

    #[test]
    fn exact_a_profile_outlives_the_program_and_a_broken_one_is_told() {
        let folder = tempfile::tempdir().unwrap();
        let profiles = Profiles::at(Some(folder.path().join("deep"))).unwrap();
        let device = Device { name: "../Odd/Näme".into(), id: "1:2".into() };
        assert_eq!(profiles.find(&device).unwrap(), None);
        let axis = |axis| Axis { axis, low: -1.0, centre: 0.0, high: 1.0, dead_band: 0.05, expo: 0.3 };
        let ways = WAYS.iter().zip(0..).map(|((_, way, _), n)| (*way, axis(n))).collect();
        let profile = Profile { device: device.clone(), mode: StickMode::Four, ways, buttons: [].into() };
        let path = profiles.keep(&profile).unwrap();
        assert_eq!(path.parent(), Some(folder.path().join("deep").as_path()), "no name leaves the folder");
        assert_eq!(profiles.find(&device).unwrap(), Some(profile));
        std::fs::write(&path, "format = 9\n").unwrap();
        let told = profiles.find(&device).unwrap_err().to_string();
        assert!(told.contains(".toml:1: format = 9"), "{told}");
    }
}
