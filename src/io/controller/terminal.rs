//! The terminal's keyboard as a controller. Terminals that report key releases (kitty keyboard protocol) work best; in
//! other terminals, keys count as released after a delay.

use crate::errors::AppError;
use crossterm::event::{
    self, DisableFocusChange, EnableFocusChange, Event, KeyCode, KeyEvent, KeyEventKind, KeyModifiers, KeyboardEnhancementFlags,
    PopKeyboardEnhancementFlags, PushKeyboardEnhancementFlags,
};
use crossterm::{execute, terminal};
use std::io::{IsTerminal, stderr, stdin};
use std::time::Duration;

/// A terminal key event.
#[derive(Debug, Clone, PartialEq, Eq)]
pub enum TerminalKey {
    /// Key pressed. Repeated while the key is held if the terminal does not distinguish presses from repetitions.
    Down(String),
    /// Key released, with its name.
    Up(String),
    /// The terminal lost focus, so it no longer receives key releases.
    FocusLost,
    /// Ctrl-C or Escape: quit.
    Quit,
}

/// A terminal in raw mode. Dropping this restores the previous mode.
#[derive(Debug)]
pub struct RawTerminal {
    features_enabled: bool,
    /// True if the terminal reports key releases.
    pub reports_releases: bool,
}

impl RawTerminal {
    /// Switches the terminal to raw mode.
    ///
    /// # Errors
    /// Returns an error if standard input is not a terminal.
    pub fn enter() -> Result<Self, AppError> {
        if !stdin().is_terminal() {
            return Err(AppError::failed("--keyboard needs a terminal, but standard input is not one"));
        }
        let failed = |error: std::io::Error| AppError::failed(format!("cannot read key presses from the terminal: {error}"));
        terminal::enable_raw_mode().map_err(failed)?;
        // The program queries the terminal's features on standard error; if standard error is a file, key releases are
        // not available.
        let features_enabled = stderr().is_terminal();
        let reports_releases = features_enabled && terminal::supports_keyboard_enhancement().unwrap_or(false);
        let taken = Self { features_enabled, reports_releases };
        if features_enabled {
            execute!(stderr(), EnableFocusChange).map_err(failed)?;
        }
        if reports_releases {
            let flags = KeyboardEnhancementFlags::REPORT_EVENT_TYPES
                | KeyboardEnhancementFlags::DISAMBIGUATE_ESCAPE_CODES
                | KeyboardEnhancementFlags::REPORT_ALL_KEYS_AS_ESCAPE_CODES;
            execute!(stderr(), PushKeyboardEnhancementFlags(flags)).map_err(failed)?;
        }
        Ok(taken)
    }

    /// Returns the next key event, if there is one.
    pub fn next(&self) -> Option<TerminalKey> {
        while event::poll(Duration::ZERO).unwrap_or(false) {
            if let Some(key) = event::read().ok().and_then(|event| parse_event(&event)) {
                return Some(key);
            }
        }
        None
    }
}

impl Drop for RawTerminal {
    fn drop(&mut self) {
        // The program is exiting, so errors are ignored.
        if self.reports_releases {
            let _ = execute!(stderr(), PopKeyboardEnhancementFlags);
        }
        if self.features_enabled {
            let _ = execute!(stderr(), DisableFocusChange);
        }
        let _ = terminal::disable_raw_mode();
    }
}

fn parse_event(event: &Event) -> Option<TerminalKey> {
    match event {
        Event::Key(key) => pressed(key),
        Event::FocusLost => Some(TerminalKey::FocusLost),
        _ => None,
    }
}

fn pressed(key: &KeyEvent) -> Option<TerminalKey> {
    let ctrl_c = key.code == KeyCode::Char('c') && key.modifiers.contains(KeyModifiers::CONTROL);
    if ctrl_c || key.code == KeyCode::Esc {
        return Some(TerminalKey::Quit);
    }
    match key.kind {
        KeyEventKind::Press => name(key.code).map(TerminalKey::Down),
        KeyEventKind::Repeat => None,
        KeyEventKind::Release => name(key.code).map(TerminalKey::Up),
    }
}

fn name(code: KeyCode) -> Option<String> {
    Some(match code {
        KeyCode::Char(' ') => "space".to_owned(),
        KeyCode::Char(c) => c.to_lowercase().to_string(),
        KeyCode::Up => "up".to_owned(),
        KeyCode::Down => "down".to_owned(),
        KeyCode::Left => "left".to_owned(),
        KeyCode::Right => "right".to_owned(),
        KeyCode::Enter => "enter".to_owned(),
        KeyCode::Tab => "tab".to_owned(),
        KeyCode::Backspace => "backspace".to_owned(),
        KeyCode::PageUp => "pageup".to_owned(),
        KeyCode::PageDown => "pagedown".to_owned(),
        _ => return None,
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn exact_repetitions_are_ignored_and_focus_loss_is_reported() {
        let key = |kind| Event::Key(KeyEvent::new_with_kind(KeyCode::Char('P'), KeyModifiers::NONE, kind));
        let told = [KeyEventKind::Press, KeyEventKind::Repeat, KeyEventKind::Release].map(|kind| parse_event(&key(kind)));
        assert_eq!(told, [Some(TerminalKey::Down("p".into())), None, Some(TerminalKey::Up("p".into()))]);
        assert_eq!([Event::FocusLost, Event::FocusGained].map(|event| parse_event(&event)), [Some(TerminalKey::FocusLost), None]);
        let end = KeyEvent::new(KeyCode::Char('c'), KeyModifiers::CONTROL);
        assert_eq!(parse_event(&Event::Key(end)), Some(TerminalKey::Quit));
    }
}
