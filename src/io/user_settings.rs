//! The user's settings of the window: keys, language, units, text size, picture quality and sound, in one file in the user's
//! configuration folder.

use super::files;
use super::replace::replace;
use super::system_language::system_language;
use super::user_folder;
use crate::errors::AppError;
use spandrel_clients::rc::keyboard::KeyBindings;
use spandrel_model::toml::{Problems, Reader, Section};
use spandrel_text::Language;
use spandrel_view::hud::{DisplayStyle, DisplayUnits, TextScale};
use spandrel_view::quality::{PRESETS, Quality};
use std::fmt::Write;
use std::path::{Path, PathBuf};

/// Newest supported format version.
const FORMAT: i64 = 1;
/// Name of the file in the configuration folder.
const FILE_NAME: &str = "settings.toml";
/// Name of the choice of a quality that suits the computer.
const AUTO: &str = "auto";

/// The user's settings.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct UserSettings {
    /// Keys and sound.
    pub keys: KeyBindings,
    /// Language, units and text size.
    pub style: DisplayStyle,
    /// Name of the quality preset; `None` chooses one that suits the computer.
    pub quality: Option<&'static str>,
}

impl UserSettings {
    /// Parses a settings file; omitted keys have their defaults. `file` is the name used in error messages.
    ///
    /// # Errors
    /// Reports all errors in the file, each with its line, key, value, and allowed range.
    pub fn read(file: &str, text: &str) -> Result<Self, Problems> {
        let mut r = Reader::new(file, text);
        let settings = r.parse().map(|document| {
            let mut root = r.root(&document);
            r.integer(&mut root, "format", (1, FORMAT), None);
            let keys = KeyBindings::read_tables(&mut r, &mut root);
            let mut display = r.section(&mut root, "display");
            let units = DisplayUnits::ALL.map(|units| (units.word(), units));
            let style = DisplayStyle {
                language: language(&mut r, &mut display),
                units: r.keyword(&mut display, "units", &units, Some(0)),
                text_scale: text_scale(&mut r, &mut display),
            };
            let presets = PRESETS.iter().map(|preset| (preset.name, Some(preset.name)));
            let qualities: Vec<_> = std::iter::once((AUTO, None)).chain(presets).collect();
            let quality = r.keyword(&mut display, "quality", &qualities, Some(0));
            r.finish(&display);
            r.finish(&root);
            Self { keys, style, quality }
        });
        match settings {
            Some(settings) if r.problems.is_empty() => Ok(settings),
            _ => Err(Problems(r.problems)),
        }
    }

    /// Returns the default settings in the language of the system.
    pub fn of_system() -> Self {
        Self { style: DisplayStyle { language: system_language(), ..DisplayStyle::default() }, ..Self::default() }
    }

    /// Returns the settings as a TOML file.
    pub fn write(&self) -> String {
        let mut text = format!("# Written by the settings page of the window.\nformat = {FORMAT}\n{}", self.keys.write_tables());
        let _ = write!(
            text,
            "\n[display]\nlanguage = \"{}\"\nunits = \"{}\"\ntext_scale_pct = {}\nquality = \"{}\"\n",
            self.style.language.tag(),
            self.style.units.word(),
            self.style.text_scale.pct(),
            self.quality.unwrap_or(AUTO)
        );
        text
    }

    /// Returns the quality preset; `None` chooses one that suits the computer.
    pub fn quality_preset(&self) -> Option<Quality> {
        self.quality.and_then(Quality::by_name)
    }
}

/// Reads the language; the default is the language of the system.
fn language(r: &mut Reader, display: &mut Section) -> Language {
    let languages: Vec<_> = Language::ALL.into_iter().chain([Language::Pseudo]).map(|one| (one.tag(), one)).collect();
    let default = languages.iter().position(|(_, one)| *one == system_language());
    r.keyword(display, "language", &languages, default)
}

fn text_scale(r: &mut Reader, display: &mut Section) -> TextScale {
    const KEY: &str = "text_scale_pct";
    let [smallest, .., largest] = TextScale::ALL;
    let pct = r.integer(display, KEY, (smallest.pct(), largest.pct()), Some(TextScale::default().pct()));
    TextScale::ALL.into_iter().find(|scale| scale.pct() == pct).unwrap_or_else(|| {
        let allowed = TextScale::ALL.map(|scale| scale.pct().to_string()).join(", ");
        r.add_problem(display, KEY, &pct.to_string(), &allowed, "unknown size");
        TextScale::default()
    })
}

/// Where the settings are stored; `None` if the user has no home folder. Without it, the settings last until the window closes.
#[derive(Debug, Clone, Default)]
pub struct SettingsFile(Option<PathBuf>);

impl SettingsFile {
    /// Uses `spandrel/settings.toml` in the user's configuration folder.
    pub fn of_user() -> Self {
        Self(user_folder::config().map(|folder| folder.join(FILE_NAME)))
    }

    /// Uses this file.
    #[cfg(test)]
    pub fn at(path: PathBuf) -> Self {
        Self(Some(path))
    }

    /// Returns the file's path.
    pub fn path(&self) -> Option<&Path> {
        self.0.as_deref()
    }

    /// Reads the settings. Without a file, returns the defaults.
    ///
    /// # Errors
    /// Returns an error if the file cannot be read or is invalid; all problems are listed.
    pub fn load(&self) -> Result<UserSettings, AppError> {
        match self.path().filter(|path| path.exists()) {
            Some(path) => Ok(UserSettings::read(&path.display().to_string(), &files::read(path)?)?),
            None => Ok(UserSettings::of_system()),
        }
    }

    /// Saves the settings. The old file remains until the new one is complete.
    ///
    /// # Errors
    /// Returns an error if there is no folder, or it cannot be written.
    pub fn save(&self, settings: &UserSettings) -> Result<(), AppError> {
        let path = self.path().ok_or_else(|| AppError::failed("no home folder found"))?;
        if let Some(folder) = path.parent() {
            std::fs::create_dir_all(folder).map_err(|error| AppError::failed(format!("{}: {error}", folder.display())))?;
        }
        replace(path, settings.write().as_bytes())
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use spandrel_clients::rc::keyboard::SoundPreferences;

    /// Returns settings that differ from the defaults in everything, `k` selects among the values.
    fn settings(k: usize) -> UserSettings {
        let mut keys = KeyBindings::default();
        let names: Vec<&str> = KeyBindings::functions(Language::English).map(|(name, _)| name).collect();
        keys.rebind(names[k % names.len()], ["x", "ü", "\"", "space"][k % 4]);
        keys.sounds = SoundPreferences {
            on: k.is_multiple_of(2),
            speech: k.is_multiple_of(3),
            volume: 0.1 * (k % 11) as f64,
            ..keys.sounds
        };
        let style =
            DisplayStyle { language: Language::ALL[k % 3], units: DisplayUnits::ALL[k % 2], text_scale: TextScale::ALL[k % 4] };
        UserSettings {
            keys,
            style,
            quality: std::iter::once(None).chain(PRESETS.iter().map(|preset| Some(preset.name))).nth(k % 5).flatten(),
        }
    }

    #[test]
    fn prop_settings_survive_writing_and_reading() {
        for k in 0..100 {
            let wanted = settings(k);
            assert_eq!(UserSettings::read("settings.toml", &wanted.write()).as_ref(), Ok(&wanted), "{k}:\n{}", wanted.write());
        }
        assert_eq!(UserSettings::read("settings.toml", "format = 1\n"), Ok(UserSettings::of_system()), "all keys are optional");
    }

    #[test]
    fn exact_invalid_settings_are_reported_with_file_line_key_value_and_allowed_values() {
        let text = "format = 1\n[display]\nunits = \"imperial\"\ntext_scale_pct = 130\nquality = \"best\"\nfont = 3\n[sound]\nvolume = 2\n\
                    [actions]\nlamp = \"w\"\nland = \"F5\"\n";
        let told = UserSettings::read("settings.toml", text).unwrap_err().to_string();
        for part in [
            "settings.toml:3: display.units = \"imperial\": unknown keyword (allowed: metric, us)",
            "settings.toml:4: display.text_scale_pct = 130: unknown size (allowed: 100, 125, 150, 200)",
            "settings.toml:5: display.quality = \"best\": unknown keyword (allowed: auto, low, medium, high, ultra)",
            "settings.toml:6: display.font",
            "settings.toml:8: sound.volume = 2",
            "settings.toml:10: actions.lamp = w: already bound to up",
            "settings.toml:11: actions.land = f5: unknown key",
        ] {
            assert!(told.contains(part), "{part}:\n{told}");
        }
        let newer = UserSettings::read("settings.toml", "format = 2\n").unwrap_err().to_string();
        assert!(newer.contains("settings.toml:1: format = 2"), "{newer}");
        assert!(UserSettings::read("settings.toml", "format = ").unwrap_err().to_string().contains("TOML 1.0"));
    }

    #[test]
    fn exact_settings_are_stored_in_the_configuration_folder() {
        let folder = tempfile::tempdir().unwrap();
        let file = SettingsFile(Some(folder.path().join("deep").join(FILE_NAME)));
        assert_eq!(file.load().unwrap(), UserSettings::of_system());
        file.save(&settings(3)).unwrap();
        assert_eq!(file.load().unwrap(), settings(3));
        let names: Vec<_> =
            std::fs::read_dir(folder.path().join("deep")).unwrap().map(|entry| entry.unwrap().file_name()).collect();
        assert_eq!(names, [FILE_NAME], "no temporary file remains");
        std::fs::write(file.path().unwrap(), "format = 9\n").unwrap();
        assert!(file.load().unwrap_err().to_string().contains("settings.toml:1: format = 9"));
        let nowhere = SettingsFile::default();
        assert_eq!(nowhere.load().unwrap(), UserSettings::of_system());
        assert_eq!(nowhere.save(&settings(1)).unwrap_err().to_string(), "no home folder found");
    }
}
