//! The language that the user has chosen for this program, in which it shows the window and writes reports.

use super::system_language::system_language;
use spandrel_text::Language;

/// Returns the language in the window's settings, or that of the operating system if there are no valid settings.
#[cfg(feature = "view")]
pub fn user_language() -> Language {
    let settings = super::user_settings::SettingsFile::of_user().load();
    settings.map_or_else(|_| system_language(), |settings| settings.style.language)
}

/// Returns the language of the operating system: this build has no window, and therefore no settings.
#[cfg(not(feature = "view"))]
pub fn user_language() -> Language {
    system_language()
}
