//! Settings page and the list of keys, where each key can be changed.

use super::menu::{self, MenuAction, MenuRow, RowKind};
use super::settings::{KeyFunction, Setting, SettingChange, SettingsStatus};
use super::sheet::{PageWriter, SMALL_TEXT_SIZE, TEXT_SIZE};
use super::{KeyNames, Page, WindowFlow, WindowRequest};
use crate::hud::{DisplayStyle, DisplayUnits, HudColor, TextAlign, TextScale};
use crate::quality::PRESETS;
use crate::sound::SoundSettings;

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

    /// Returns the units and the text size.
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
                self.notice = Some("This key cannot be used. Press another one, or Esc to cancel.".to_owned());
                return;
            }
            Some("escape") => self.notice = Some("Nothing changed.".to_owned()),
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
        let words = file.map(|file| format!("The keys come from {file} (option --keys). Change them there."));
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
    fn explained_settings(&self) -> Vec<(MenuRow, &'static str)> {
        let SettingsStatus { style, quality, sounds, .. } = &self.settings;
        let on_off = |on: bool| if on { "on" } else { "off" }.to_owned();
        let row = |setting: Setting, label: &str, value: String| MenuRow::choice(MenuAction::Setting(setting), label, value);
        vec![
            (MenuRow::button(MenuAction::Keys, "Keys"), "See which key does what, and choose other keys."),
            (
                row(Setting::Units, "Units", style.units.title().to_owned()),
                "Units on the screen. Reports and files always use metric units.",
            ),
            (
                row(Setting::TextScale, "Text size", format!("{}%", style.text_scale.pct())),
                "Size of all words and numbers. At large sizes, the flight display leaves out the less important values, and long \
                 pages scroll with Page up, Page down or the mouse wheel.",
            ),
            (
                row(Setting::Quality, "Picture", quality.unwrap_or("auto").to_owned()),
                "Detail of the pictures. Auto is high with a graphics card and low without. A change takes effect in the next \
                 flight.",
            ),
            (row(Setting::Sound, "Sound", on_off(self.sound)), "All sound on or off."),
            (
                row(Setting::Volume, "Volume", format!("{:.0}%", 100.0 * sounds.volume)),
                "Volume of the propellers and the warning tones.",
            ),
            (
                row(Setting::Propellers, "Propellers", on_off(sounds.propellers)),
                "Propeller sound. It gets quieter as the drone flies away.",
            ),
            (
                row(Setting::WarningTones, "Warnings", on_off(sounds.warnings)),
                "A tone for each warning. A warning is always on the screen as well.",
            ),
            (row(Setting::Speech, "Speech", on_off(sounds.speech)), "Warnings are spoken, if spd-say or espeak-ng is installed."),
            (MenuRow::button(MenuAction::RestoreSettings, "Restore all defaults"), "Resets all settings and keys."),
            (MenuRow::button(MenuAction::Back, "Back (Esc)"), "All changes are saved."),
        ]
    }

    /// Returns the rows of the list of keys.
    pub(super) fn key_rows(&self) -> Vec<MenuRow> {
        let row = |(index, function): (usize, &KeyFunction)| {
            let awaited = self.awaited_key == Some(index);
            let value = if awaited { "press a key".to_owned() } else { function.key.clone() };
            MenuRow { kind: RowKind::KeyBinding, ..MenuRow::choice(MenuAction::Key(index), &function.title, value) }
        };
        let mut rows: Vec<MenuRow> = self.settings.keys.iter().enumerate().map(row).collect();
        rows.push(MenuRow::button(MenuAction::RestoreKeys, "Restore default keys"));
        rows.push(MenuRow::button(MenuAction::Back, "Back (Esc)"));
        rows
    }

    /// Draws the settings page.
    pub(super) fn draw_settings(&self, pen: &mut PageWriter, rows: &[MenuRow]) {
        let whole = pen.width - 2.0 * LEFT;
        pen.title((LEFT, 0.08), whole, "Settings");
        let width = if pen.is_narrow() { whole } else { 0.5 * pen.width };
        let bottom = menu::draw(pen, (LEFT, 0.15), width, rows, self.focus);
        let (x, y) = if pen.is_narrow() { (LEFT, bottom + 0.03) } else { (LEFT + width + 0.06, 0.17) };
        if let Some((row, explanation)) = self.explained_settings().into_iter().nth(self.focus) {
            pen.text((x, y), TextAlign::Left, TEXT_SIZE, HudColor::Yellow, row.label);
            let width = pen.width - LEFT - x;
            let y = pen.lines((x, y + 0.052), width, SMALL_TEXT_SIZE, HudColor::White, explanation);
            let help = "Up/down select, left/right change, Enter confirm; or click.";
            pen.lines((x, y + 0.03), width, SMALL_TEXT_SIZE, HudColor::Gray, help);
        }
    }

    /// Draws the list of keys.
    pub(super) fn draw_keys(&self, pen: &mut PageWriter, rows: &[MenuRow]) {
        let whole = pen.width - 2.0 * LEFT;
        pen.title((LEFT, 0.06), whole, "Keys");
        let help = if self.is_awaiting_key() {
            "Press the new key. Esc cancels."
        } else {
            "Enter or click a row, then press the new key. F11 always switches to full screen."
        };
        let y = pen.lines((LEFT, 0.13), whole, SMALL_TEXT_SIZE, HudColor::Gray, help);
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

/// Returns the value after or before one in a list, or the same at the end of the list.
fn neighbor<T: Copy + PartialEq>(values: &[T], value: T, on: bool) -> T {
    let at = values.iter().position(|known| *known == value).unwrap_or_default();
    let wanted = if on { at + 1 } else { at.saturating_sub(1) };
    values.get(wanted).copied().unwrap_or(value)
}
