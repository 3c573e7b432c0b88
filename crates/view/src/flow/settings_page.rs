//! Settings page and the list of keys, where each key can be changed.

use super::menu::{self, MenuAction, MenuRow, RowKind};
use super::settings::{KeyFunction, Setting, SettingChange, SettingsStatus};
use super::sheet::{PageWriter, SMALL_TEXT_SIZE, TEXT_SIZE, fitted};
use super::{KeyNames, Page, WindowFlow, WindowRequest};
use crate::hud::{DisplayStyle, DisplayUnits, HudColor, TextAlign, TextScale};
use crate::quality::PRESETS;
use crate::sound::SoundSettings;
use spandrel_text::{Language, text};

/// Step of the volume.
const VOLUME_STEP: f64 = 0.1;
/// Left margin.
const LEFT: f64 = 0.04;

impl WindowFlow {
    /// Updates the settings, including the key names in the pages' texts.
    pub fn update_settings(&mut self, settings: SettingsStatus) {
        self.names = KeyNames::new(settings.keys.iter().map(|function| (function.binding, function.key.clone())).collect());
        self.sound = settings.is_sound_on;
        self.settings = settings;
    }

    /// Returns the language, the units and the text size.
    #[must_use]
    pub fn style(&self) -> DisplayStyle {
        self.settings.style
    }

    /// Checks whether the next key is bound to the focused function.
    #[must_use]
    pub fn is_awaiting_key(&self) -> bool {
        self.awaited_key.is_some()
    }

    /// Binds a key, given by its name in configuration files, to the function that awaits one. Escape cancels. `None` is a key
    /// that has no name.
    pub fn bind_key(&mut self, key: Option<&str>) {
        let Some(index) = self.awaited_key else { return };
        match key {
            None => {
                self.notice = Some(text!(self.language(), "window-settings-key-unusable"));
                return;
            }
            Some("escape") => self.notice = Some(text!(self.language(), "window-settings-nothing-changed")),
            Some(key) => {
                self.notice = None;
                self.change(SettingChange::Key(index, key.to_owned()));
            }
        }
        self.awaited_key = None;
    }

    /// Starts to wait for a key for a function.
    pub(super) fn await_key(&mut self, index: usize) {
        if !self.are_keys_fixed() {
            self.awaited_key = Some(index);
        }
    }

    /// Checks whether a file on the command line sets the keys, and tells the user if so.
    fn are_keys_fixed(&mut self) -> bool {
        let file = self.settings.fixed_keys.as_ref();
        let words = file.map(|file| text!(self.language(), "window-settings-keys-fixed", file = file.as_str()));
        let are_fixed = words.is_some();
        if are_fixed {
            self.notice = words;
        }
        are_fixed
    }

    /// Restores the default keys.
    pub(super) fn restore_keys(&mut self) {
        if !self.are_keys_fixed() {
            self.change(SettingChange::RestoreKeys);
        }
    }

    /// Requests a change to a setting.
    pub(super) fn change(&mut self, change: SettingChange) {
        self.out.push_back(WindowRequest::ChangeSetting(change));
    }

    /// Selects the next or the previous value of a setting.
    pub(super) fn step_setting(&mut self, setting: Setting, on: bool) {
        let SettingsStatus { style, quality, sounds, .. } = self.settings;
        let change = match setting {
            Setting::Language => SettingChange::Style(DisplayStyle { language: next_language(style.language, on), ..style }),
            Setting::Units => {
                SettingChange::Style(DisplayStyle { units: neighbor(&DisplayUnits::ALL, style.units, on), ..style })
            }
            Setting::TextScale => {
                SettingChange::Style(DisplayStyle { text_scale: neighbor(&TextScale::ALL, style.text_scale, on), ..style })
            }
            Setting::Quality => SettingChange::Quality(neighbor(&quality_names(), quality, on)),
            Setting::Sound => return self.toggle_sound(),
            Setting::Volume => {
                let wanted = sounds.volume + if on { VOLUME_STEP } else { -VOLUME_STEP };
                // Whole steps, so that rounding errors do not add up.
                let volume = ((wanted / VOLUME_STEP).round() * VOLUME_STEP * 10.0).round() / 10.0;
                SettingChange::Sounds(SoundSettings { volume: volume.clamp(0.0, 1.0), ..sounds })
            }
            Setting::Propellers => SettingChange::Sounds(SoundSettings { propellers: !sounds.propellers, ..sounds }),
            Setting::WarningTones => SettingChange::Sounds(SoundSettings { warnings: !sounds.warnings, ..sounds }),
            Setting::Speech => SettingChange::Sounds(SoundSettings { speech: !sounds.speech, ..sounds }),
        };
        self.change(change);
    }

    /// Returns the rows of the settings page.
    pub(super) fn settings_rows(&self) -> Vec<MenuRow> {
        self.explained_settings().into_iter().map(|(row, _)| row).collect()
    }

    /// Returns the rows of the settings page, each with an explanation.
    fn explained_settings(&self) -> Vec<(MenuRow, String)> {
        let language = self.language();
        let SettingsStatus { style, quality, .. } = &self.settings;
        let row = |setting: Setting, label: String, value: String| MenuRow::choice(MenuAction::Setting(setting), label, value);
        let mut rows = vec![
            (
                row(Setting::Language, text!(language, "window-settings-language"), language.name().to_owned()),
                text!(language, "window-settings-language-about"),
            ),
            (
                MenuRow::button(MenuAction::Keys, text!(language, "window-settings-keys")),
                text!(language, "window-settings-keys-about"),
            ),
            (
                row(Setting::Units, text!(language, "window-settings-units"), style.units.title(language)),
                text!(language, "window-settings-units-about"),
            ),
            (
                row(Setting::TextScale, text!(language, "window-settings-text-size"), format!("{}%", style.text_scale.pct())),
                text!(language, "window-settings-text-size-about"),
            ),
            (
                row(Setting::Quality, text!(language, "window-settings-picture"), quality_title(*quality, language)),
                text!(language, "window-settings-picture-about"),
            ),
        ];
        rows.extend(self.explained_sounds());
        rows.extend([
            (
                MenuRow::button(MenuAction::RestoreSettings, text!(language, "window-settings-restore")),
                text!(language, "window-settings-restore-about"),
            ),
            (MenuRow::button(MenuAction::Back, text!(language, "window-back")), text!(language, "window-settings-back-about")),
        ]);
        rows
    }

    /// Returns the rows about sound, each with an explanation.
    fn explained_sounds(&self) -> [(MenuRow, String); 5] {
        let (language, sounds) = (self.language(), &self.settings.sounds);
        let on_off = |on: bool| if on { text!(language, "window-on") } else { text!(language, "window-off") };
        let row = |setting: Setting, label: String, value: String| MenuRow::choice(MenuAction::Setting(setting), label, value);
        [
            (
                row(Setting::Sound, text!(language, "window-settings-sound"), on_off(self.sound)),
                text!(language, "window-settings-sound-about"),
            ),
            (
                row(Setting::Volume, text!(language, "window-settings-volume"), format!("{:.0}%", 100.0 * sounds.volume)),
                text!(language, "window-settings-volume-about"),
            ),
            (
                row(Setting::Propellers, text!(language, "window-settings-propellers"), on_off(sounds.propellers)),
                text!(language, "window-settings-propellers-about"),
            ),
            (
                row(Setting::WarningTones, text!(language, "window-settings-warnings"), on_off(sounds.warnings)),
                text!(language, "window-settings-warnings-about"),
            ),
            (
                row(Setting::Speech, text!(language, "window-settings-speech"), on_off(sounds.speech)),
                text!(language, "window-settings-speech-about"),
            ),
        ]
    }

    /// Returns the rows of the list of keys.
    pub(super) fn key_rows(&self) -> Vec<MenuRow> {
        let language = self.language();
        let row = |(index, function): (usize, &KeyFunction)| {
            let awaited = self.awaited_key == Some(index);
            let value = if awaited { text!(language, "window-settings-press-key") } else { function.key.clone() };
            MenuRow { kind: RowKind::KeyBinding, ..MenuRow::choice(MenuAction::Key(index), function.title.clone(), value) }
        };
        let mut rows: Vec<MenuRow> = self.settings.keys.iter().enumerate().map(row).collect();
        rows.push(MenuRow::button(MenuAction::RestoreKeys, text!(language, "window-settings-restore-keys")));
        rows.push(MenuRow::button(MenuAction::Back, text!(language, "window-back")));
        rows
    }

    /// Draws the settings page.
    pub(super) fn draw_settings(&self, pen: &mut PageWriter, rows: &[MenuRow]) {
        let whole = pen.width - 2.0 * LEFT;
        pen.title((LEFT, 0.08), whole, &text!(self.language(), "window-settings-title"));
        let width = if pen.is_narrow() { whole } else { 0.5 * pen.width };
        let bottom = menu::draw(pen, (LEFT, 0.135), width, rows, self.focus);
        let (x, y) = if pen.is_narrow() { (LEFT, bottom + 0.03) } else { (LEFT + width + 0.06, 0.155) };
        if let Some((row, explanation)) = self.explained_settings().into_iter().nth(self.focus) {
            let width = pen.width - LEFT - x;
            pen.text((x, y), TextAlign::Left, fitted(&row.label, TEXT_SIZE, width), HudColor::Yellow, row.label);
            let y = pen.lines((x, y + 0.052), width, SMALL_TEXT_SIZE, HudColor::White, &explanation);
            let help = text!(self.language(), "window-help");
            pen.lines((x, y + 0.03), width, SMALL_TEXT_SIZE, HudColor::Gray, &help);
        }
    }

    /// Draws the list of keys.
    pub(super) fn draw_keys(&self, pen: &mut PageWriter, rows: &[MenuRow]) {
        let whole = pen.width - 2.0 * LEFT;
        let language = self.language();
        pen.title((LEFT, 0.06), whole, &text!(language, "window-settings-keys"));
        let help = if self.is_awaiting_key() {
            text!(language, "window-settings-keys-awaiting")
        } else {
            text!(language, "window-settings-keys-help")
        };
        let y = pen.lines((LEFT, 0.13), whole, SMALL_TEXT_SIZE, HudColor::Gray, &help);
        menu::draw_columns(pen, (LEFT, y - 0.012), whole, rows, self.focus);
    }

    /// Returns whether the page belongs to the settings, and if so, whether a flight is paused behind it.
    pub(super) fn settings_origin(&self) -> Option<bool> {
        match self.page {
            Page::Settings { in_flight } | Page::Keys { in_flight } => Some(in_flight),
            Page::Opening
            | Page::Start
            | Page::Controls
            | Page::Calibrating
            | Page::Tutorial(..)
            | Page::Briefing
            | Page::Waiting
            | Page::Flight
            | Page::Paused
            | Page::ConfirmEnd
            | Page::Results
            | Page::School => None,
        }
    }
}

fn quality_names() -> Vec<Option<&'static str>> {
    std::iter::once(None).chain(PRESETS.iter().map(|preset| Some(preset.name))).collect()
}

/// Returns the title of a quality preset, or of the automatic choice.
pub(super) fn quality_title(quality: Option<&str>, language: Language) -> String {
    match quality {
        None => text!(language, "window-settings-auto"),
        Some("low") => text!(language, "window-settings-low"),
        Some("medium") => text!(language, "window-settings-medium"),
        Some("high") => text!(language, "window-settings-high"),
        Some("ultra") => text!(language, "window-settings-ultra"),
        Some(other) => other.to_owned(),
    }
}

/// Returns the next or the previous language. After the last one comes the first one, so that users who cannot read the others
/// find theirs with one key.
fn next_language(language: Language, on: bool) -> Language {
    let count = Language::ALL.len();
    let at = Language::ALL.iter().position(|known| *known == language).unwrap_or_default();
    Language::ALL[(at + if on { 1 } else { count - 1 }) % count]
}

/// Returns the value after or before one in a list, or the same at the end of the list.
fn neighbor<T: Copy + PartialEq>(values: &[T], value: T, on: bool) -> T {
    let at = values.iter().position(|known| *known == value).unwrap_or_default();
    let wanted = if on { at + 1 } else { at.saturating_sub(1) };
    values.get(wanted).copied().unwrap_or(value)
}
