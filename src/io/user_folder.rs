//! The user's folder for configuration files.

use std::ffi::OsString;
use std::path::PathBuf;

/// Returns the user's configuration folder of this program: `spandrel` in `$XDG_CONFIG_HOME` or `~/.config`. `None` if the
/// user has no home folder.
pub fn config() -> Option<PathBuf> {
    config_in(std::env::var_os("XDG_CONFIG_HOME"), std::env::var_os("HOME"))
}

/// Returns the configuration folder, based on these two environment variables.
fn config_in(config: Option<OsString>, home: Option<OsString>) -> Option<PathBuf> {
    let known = |place: Option<OsString>| place.filter(|place| !place.is_empty()).map(PathBuf::from);
    let config = known(config).or_else(|| known(home).map(|home| home.join(".config")));
    config.map(|config| config.join("spandrel"))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn exact_folder_follows_the_environment() {
        let place = |config: &str, home: &str| config_in(Some(config.into()), Some(home.into()));
        assert_eq!(place("/c", "/home/a"), Some("/c/spandrel".into()));
        assert_eq!(place("", "/home/a"), Some("/home/a/.config/spandrel".into()));
        assert_eq!((place("", ""), config_in(None, None)), (None, None), "empty variables are ignored");
    }
}
