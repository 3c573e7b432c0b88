//! Calibration profiles on disk: one file per device model.

use crate::errors::AppError;
use crate::io::files;
use crate::io::replace::replace;
use crate::io::user_folder;
use spandrel_clients::rc::{ControllerProfile, Device};
use std::path::{Path, PathBuf};

const NO_HOME_FOLDER_MESSAGE: &str = "no home folder found: specify a profile folder with --profiles";

/// Profile folder; `None` if the user has no home folder. Without this folder, devices have no profiles, but everything
/// else works.
#[derive(Debug, Clone, Default)]
pub struct ProfileFolder(Option<PathBuf>);

impl ProfileFolder {
    /// Uses this folder, or the user's default folder (`spandrel/controllers` in `$XDG_CONFIG_HOME` or `~/.config`).
    pub fn at(folder: Option<PathBuf>) -> Self {
        Self(folder.or_else(|| user_folder::config().map(|folder| folder.join("controllers"))))
    }

    /// Returns the profile folder.
    ///
    /// # Errors
    /// Returns an error if no folder was specified and the user has no home folder.
    pub fn folder(&self) -> Result<&Path, AppError> {
        self.0.as_deref().ok_or_else(|| AppError::invalid(NO_HOME_FOLDER_MESSAGE))
    }

    /// Returns the path of a device's profile.
    pub fn path(&self, device: &Device) -> Option<PathBuf> {
        self.0.as_ref().map(|folder| folder.join(profile_path(device)))
    }

    /// Returns the reason why a device has no profile.
    pub fn missing_reason(&self, device: &Device) -> String {
        self.path(device).map_or(NO_HOME_FOLDER_MESSAGE.to_owned(), |path| format!("no {}", path.display()))
    }

    /// Returns a device's profile, if it has one.
    ///
    /// # Errors
    /// Returns an error if the file cannot be read or is invalid.
    pub fn find(&self, device: &Device) -> Result<Option<ControllerProfile>, AppError> {
        self.path(device).filter(|path| path.exists()).map(|path| read(&path)).transpose()
    }

    /// Saves a profile. The old profile remains until the new one is complete.
    ///
    /// # Errors
    /// Returns an error if there is no folder, or it cannot be written.
    pub fn save(&self, profile: &ControllerProfile) -> Result<PathBuf, AppError> {
        let folder = self.folder()?;
        let path = folder.join(profile_path(&profile.device));
        std::fs::create_dir_all(folder).map_err(|error| AppError::failed(format!("{}: {error}", folder.display())))?;
        replace(&path, profile.write().as_bytes())?;
        Ok(path)
    }
}

fn profile_path(device: &Device) -> String {
    let harmless = |c: char| if c.is_ascii_alphanumeric() { c.to_ascii_lowercase() } else { '-' };
    let name: String = format!("{}-{}", device.name, device.id).chars().map(harmless).collect();
    format!("{name}.toml")
}

/// Reads a profile from a file.
///
/// # Errors
/// Returns an error if the file cannot be read or is invalid; all problems are listed.
pub fn read(path: &Path) -> Result<ControllerProfile, AppError> {
    Ok(ControllerProfile::read(&path.display().to_string(), &files::read(path)?)?)
}

#[cfg(test)]
mod tests {
    use super::*;
    use spandrel_clients::rc::StickMode;
    use spandrel_clients::rc::axis::AxisCalibration;
    use spandrel_clients::rc::profile::STICK_AXES;

    fn profile(device: &Device) -> ControllerProfile {
        let axis = |axis| AxisCalibration { axis, low: -1.0, centre: 0.0, high: 1.0, dead_band: 0.05, expo: 0.3 };
        let ways = STICK_AXES.iter().zip(0..).map(|((_, way), n)| (*way, axis(n))).collect();
        ControllerProfile { device: device.clone(), mode: StickMode::Four, axes: ways, buttons: [].into() }
    }

    #[test]
    fn exact_profiles_are_saved_and_invalid_ones_reported() {
        let folder = tempfile::tempdir().unwrap();
        let profiles = ProfileFolder::at(Some(folder.path().join("deep")));
        let device = Device { name: "../Odd/Näme".into(), id: "1:2".into() };
        assert_eq!(profiles.find(&device).unwrap(), None);
        let profile = profile(&device);
        let path = profiles.save(&profile).unwrap();
        assert_eq!(path.parent(), Some(folder.path().join("deep").as_path()), "names cannot leave the folder");
        assert_eq!(profiles.find(&device).unwrap(), Some(profile));
        std::fs::write(&path, "format = 9\n").unwrap();
        let told = profiles.find(&device).unwrap_err().to_string();
        assert!(told.contains(".toml:1: format = 9"), "{told}");
    }

    #[test]
    fn exact_saving_fails_without_home_folder() {
        let device = Device { name: "Pad".into(), id: "1:2".into() };
        let nowhere = ProfileFolder::default();
        assert_eq!((nowhere.find(&device).unwrap(), nowhere.path(&device)), (None, None));
        for told in [nowhere.save(&profile(&device)).unwrap_err().to_string(), nowhere.missing_reason(&device)] {
            assert_eq!(told, "no home folder found: specify a profile folder with --profiles");
        }
    }
}
