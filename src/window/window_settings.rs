//! The window's settings: those of the user and of the command line. Applies changes and saves them.

use crate::io::user_settings::{SettingsFile, UserSettings};
use spandrel_clients::rc::key;
use spandrel_clients::rc::keyboard::{KeyBindings, Rebinding, SoundPreferences};
use spandrel_text::{Language, text};
use spandrel_view::flow::{KeyFunction, SettingChange, SettingsStatus};
use spandrel_view::sound::SoundSettings;

/// Options on the command line that override the user's settings.
#[derive(Debug, Clone, Default)]
pub struct SettingsOverrides {
    /// Key bindings file and its contents.
    pub keys: Option<(String, KeyBindings)>,
    /// Name of the quality preset; `Some(None)` for auto.
    pub quality: Option<Option<&'static str>>,
    /// True if sound is off.
    pub no_sound: bool,
}

/// The window's settings.
#[derive(Debug, Clone)]
pub struct WindowSettings {
    file: SettingsFile,
    /// Settings in effect.
    current: UserSettings,
    /// Settings in the file, without the options on the command line.
    stored: UserSettings,
    /// Why the file cannot be used. It is kept until the user restores all defaults.
    invalid: Option<String>,
    keys_file: Option<String>,
}

impl WindowSettings {
    /// Reads the user's settings. If they are invalid, logs the problems and uses the defaults.
    pub fn load(file: SettingsFile, overrides: SettingsOverrides) -> Self {
        let (stored, invalid) = match file.load() {
            Ok(settings) => (settings, None),
            Err(error) => {
                tracing::warn!("{error}; using the default settings");
                (UserSettings::of_system(), Some(error.to_string()))
            }
        };
        let mut current = stored.clone();
        let mut keys_file = None;
        if let Some((path, keys)) = overrides.keys {
            (current.keys, keys_file) = (keys, Some(path));
        }
        current.quality = overrides.quality.unwrap_or(current.quality);
        current.keys.sounds.on &= !overrides.no_sound;
        Self { file, current, stored, invalid, keys_file }
    }

    /// Returns the language of the window.
    pub fn language(&self) -> Language {
        self.current.style.language
    }

    /// Returns the settings in effect.
    pub fn current(&self) -> &UserSettings {
        &self.current
    }

    /// Returns a message for the user about an invalid file.
    pub fn file_notice(&self) -> Option<String> {
        let language = self.language();
        self.invalid.as_ref().map(|why| text!(language, "window-settings-file-invalid", error = why.as_str()))
    }

    /// Returns the settings for the pages.
    pub fn status(&self) -> SettingsStatus {
        let (keys, language) = (&self.current.keys, self.language());
        let function = |(binding, title)| KeyFunction { binding, title, key: keys.label(binding, language) };
        SettingsStatus {
            style: self.current.style,
            quality: self.current.quality,
            is_sound_on: keys.sounds.on,
            sounds: sound_settings(keys.sounds),
            keys: KeyBindings::functions(language).map(function).collect(),
            fixed_keys: self.keys_file.clone(),
        }
    }

    /// Applies a change and saves it. Returns a message for the user, if there is something to say.
    pub fn apply(&mut self, change: &SettingChange) -> Option<String> {
        // The keys of a file on the command line stay.
        let keys = self.keys_file.as_ref().map(|_| self.current.keys.clone());
        let to_store = self.change_to_store(change);
        change_settings(&mut self.stored, &to_store);
        let words = change_settings(&mut self.current, change);
        if let Some(keys) = keys {
            let sounds = std::mem::replace(&mut self.current.keys, keys).sounds;
            self.current.keys.sounds = sounds;
        }
        if *change == SettingChange::RestoreAll {
            self.invalid = None;
        }
        self.save().or(words)
    }

    /// Returns the change without the values that options of the command line have set for this run.
    fn change_to_store(&self, change: &SettingChange) -> SettingChange {
        let SettingChange::Sounds(new) = change else { return change.clone() };
        let (stored, current) = (sound_settings(self.stored.keys.sounds), sound_settings(self.current.keys.sounds));
        let switch = |new, current, stored| if new == current { stored } else { new };
        SettingChange::Sounds(SoundSettings {
            propellers: switch(new.propellers, current.propellers, stored.propellers),
            warnings: switch(new.warnings, current.warnings, stored.warnings),
            speech: switch(new.speech, current.speech, stored.speech),
            volume: if new.volume == current.volume { stored.volume } else { new.volume },
        })
    }

    /// Turns sound on or off and saves it. Returns a message for the user if that fails.
    pub fn set_sound(&mut self, on: bool) -> Option<String> {
        (self.stored.keys.sounds.on, self.current.keys.sounds.on) = (on, on);
        self.save()
    }

    /// Saves the settings. Returns a message for the user if that fails.
    fn save(&self) -> Option<String> {
        if let Some(why) = &self.invalid {
            return Some(text!(self.language(), "window-settings-not-saved-invalid", error = why.as_str()));
        }
        let failed = self.file.save(&self.stored).err();
        failed.map(|error| text!(self.language(), "window-settings-not-saved", error = error.to_string()))
    }
}

/// Returns the sound settings without the switch.
pub fn sound_settings(sounds: SoundPreferences) -> SoundSettings {
    let SoundPreferences { on: _, propellers, warnings, speech, volume } = sounds;
    SoundSettings { propellers, warnings, speech, volume }
}

/// Changes settings. Returns a message for the user, if there is something to say.
fn change_settings(settings: &mut UserSettings, change: &SettingChange) -> Option<String> {
    match change {
        SettingChange::Style(style) => settings.style = *style,
        SettingChange::Quality(quality) => settings.quality = *quality,
        SettingChange::Sounds(SoundSettings { propellers, warnings, speech, volume }) => {
            settings.keys.sounds = SoundPreferences {
                on: settings.keys.sounds.on,
                propellers: *propellers,
                warnings: *warnings,
                speech: *speech,
                volume: *volume,
            };
        }
        SettingChange::Key(index, key) => return rebind(&mut settings.keys, *index, key, settings.style.language),
        SettingChange::RestoreKeys => {
            settings.keys.restore_keys();
            return Some(text!(settings.style.language, "window-settings-keys-restored"));
        }
        SettingChange::RestoreAll => {
            *settings = UserSettings::of_system();
            return Some(text!(settings.style.language, "window-settings-all-restored"));
        }
    }
    None
}

fn rebind(keys: &mut KeyBindings, index: usize, key: &str, language: Language) -> Option<String> {
    let (name, title) = KeyBindings::functions(language).nth(index)?;
    let label = key::label(&key.to_lowercase(), language);
    Some(match keys.rebind(name, key) {
        Rebinding::Done => text!(language, "window-settings-key-set", key = label, function = title),
        Rebinding::Exchanged(other) => {
            let other_title = KeyBindings::functions(language).find(|(binding, _)| *binding == other);
            text!(
                language,
                "window-settings-key-exchanged",
                key = label,
                function = title,
                other = other_title.map_or(String::new(), |found| found.1),
                other_key = keys.label(other, language)
            )
        }
        Rebinding::Refused => text!(language, "window-settings-key-refused", key = key, allowed = key::allowed(language)),
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use spandrel_view::hud::{DisplayStyle, DisplayUnits, TextScale};

    fn index(name: &str) -> usize {
        KeyBindings::functions(Language::English).position(|(binding, _)| binding == name).unwrap()
    }

    fn file(folder: &tempfile::TempDir) -> SettingsFile {
        SettingsFile::at(folder.path().join("settings.toml"))
    }

    #[test]
    fn exact_changes_are_applied_saved_and_named() {
        let folder = tempfile::tempdir().unwrap();
        let mut settings = WindowSettings::load(file(&folder), SettingsOverrides::default());
        let told = settings.apply(&SettingChange::Key(index("lamp"), "y".into()));
        assert_eq!(told.as_deref(), Some("Y: lamp."));
        let told = settings.apply(&SettingChange::Key(index("lamp"), "l".into()));
        assert_eq!(told.as_deref(), Some("L: lamp. The key was taken: land now has Y."));
        let told = settings.apply(&SettingChange::Key(index("lamp"), "f5".into()));
        assert!(told.is_some_and(|words| words.contains("'f5' cannot be used (allowed: one character")));
        let style = DisplayStyle { units: DisplayUnits::UsCustomary, text_scale: TextScale::Double, ..DisplayStyle::default() };
        assert_eq!(settings.apply(&SettingChange::Style(style)), None);
        assert_eq!(settings.set_sound(false), None);
        let again = WindowSettings::load(file(&folder), SettingsOverrides::default());
        assert_eq!(again.current(), settings.current());
        assert_eq!(
            (again.current().keys.of("lamp"), again.current().style, again.status().is_sound_on),
            (Some("l"), style, false)
        );
        settings.apply(&SettingChange::RestoreKeys);
        assert_eq!((settings.current().keys.of("lamp"), settings.current().style), (Some("b"), style), "only the keys");
        settings.apply(&SettingChange::RestoreAll);
        assert_eq!(file(&folder).load().unwrap(), UserSettings::default());
    }

    #[test]
    fn exact_options_on_the_command_line_override_the_settings_without_being_saved() {
        let folder = tempfile::tempdir().unwrap();
        let mut keys = KeyBindings::default();
        keys.rebind("lamp", "x");
        let overrides =
            SettingsOverrides { keys: Some(("keys.toml".into(), keys)), quality: Some(Some("ultra")), no_sound: true };
        let mut settings = WindowSettings::load(file(&folder), overrides);
        let shown = settings.status();
        assert_eq!((shown.quality, shown.is_sound_on, shown.fixed_keys.as_deref()), (Some("ultra"), false, Some("keys.toml")));
        settings.apply(&SettingChange::RestoreAll);
        assert_eq!(settings.current().keys.of("lamp"), Some("x"), "the file on the command line decides");
        let style = DisplayStyle { text_scale: TextScale::Large, ..DisplayStyle::default() };
        let overrides = SettingsOverrides { quality: Some(Some("ultra")), ..SettingsOverrides::default() };
        let mut settings = WindowSettings::load(file(&folder), overrides);
        settings.apply(&SettingChange::Style(style));
        assert_eq!(file(&folder).load().unwrap(), UserSettings { style, ..UserSettings::default() });
    }

    #[test]
    fn exact_an_invalid_file_is_kept_until_all_defaults_are_restored() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("settings.toml");
        std::fs::write(&path, "format = 1\n[display]\nunits = \"feet\"\n").unwrap();
        let mut settings = WindowSettings::load(file(&folder), SettingsOverrides::default());
        let why = "settings.toml:3: display.units = \"feet\": unknown keyword (allowed: metric, us)";
        assert!(settings.file_notice().is_some_and(|words| words.contains(why)));
        let told = settings.apply(&SettingChange::Quality(Some("low"))).unwrap();
        assert!(told.starts_with("Not saved") && told.contains(why), "{told}");
        assert_eq!(settings.current().quality, Some("low"), "it still takes effect");
        assert!(std::fs::read_to_string(&path).unwrap().contains("feet"));
        assert_eq!(settings.apply(&SettingChange::RestoreAll).as_deref(), Some("All settings have their defaults."));
        assert_eq!((settings.file_notice(), file(&folder).load().unwrap()), (None, UserSettings::default()));
    }
}
