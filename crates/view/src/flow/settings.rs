//! The user's settings, as the pages show them, and changes to them.

use crate::hud::DisplayStyle;
use crate::sound::SoundSettings;

/// A setting with a choice of values.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Setting {
    /// Language of all texts.
    Language,
    /// Units of lengths and speeds.
    Units,
    /// Text size.
    TextScale,
    /// Picture quality.
    Quality,
    /// Sound on or off.
    Sound,
    /// Volume.
    Volume,
    /// Propeller sound on or off.
    Propellers,
    /// Warning tones on or off.
    WarningTones,
    /// Spoken warnings on or off.
    Speech,
}

/// A function with its key.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct KeyFunction {
    /// Name of the binding in configuration files.
    pub binding: &'static str,
    /// Description of the function.
    pub title: String,
    /// Display name of its key.
    pub key: String,
}

/// The user's settings, as the pages show them.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct SettingsStatus {
    /// Units and text size.
    pub style: DisplayStyle,
    /// Name of the quality preset; `None` chooses one that suits the computer.
    pub quality: Option<&'static str>,
    /// Whether sound is on.
    pub is_sound_on: bool,
    /// Sound settings.
    pub sounds: SoundSettings,
    /// Functions and their keys, in the order of display.
    pub keys: Vec<KeyFunction>,
    /// File on the command line that fixes the keys.
    pub fixed_keys: Option<String>,
}

/// A change to a setting.
#[derive(Debug, Clone, PartialEq)]
pub enum SettingChange {
    /// Units and text size.
    Style(DisplayStyle),
    /// Name of the quality preset; `None` chooses one that suits the computer.
    Quality(Option<&'static str>),
    /// Sound settings.
    Sounds(SoundSettings),
    /// Give a key to the function with this index.
    Key(usize, String),
    /// Restore the default keys.
    RestoreKeys,
    /// Restore all default settings.
    RestoreAll,
}
