//! The terminal's keyboard as a controller. Terminals that tell releases (kitty's protocol) fly best; in others a key lets go by itself.

use crate::app::errors::AppError;
use crossterm::event::{
    self, Event, KeyCode, KeyEventKind, KeyModifiers, KeyboardEnhancementFlags, PopKeyboardEnhancementFlags,
    PushKeyboardEnhancementFlags,
};
use crossterm::{execute, terminal};
use std::io::{IsTerminal, stderr, stdin};
use std::time::Duration;

/// What was done with a key.
#[derive(Debug, Clone, PartialEq, Eq)]
pub enum Key {
    /// Down, or repeated.
    Down(String),
    /// Up.
    Up(String),
    /// Ctrl-C or Escape: an end is wished.
    End,
}

/// A terminal that gives every key at once. Dropped, it is an ordinary one again.
#[derive(Debug)]
pub struct Terminal {
    /// The terminal tells when a key comes up.
    pub tells_releases: bool,
}

impl Terminal {
    /// Takes the terminal.
    ///
    /// # Errors
    /// When there is none.
    pub fn take() -> Result<Self, AppError> {
        if !stdin().is_terminal() {
            return Err(AppError::failed("--keyboard needs a terminal: standard input is none"));
        }
        let failed = |error: std::io::Error| AppError::failed(format!("the terminal gives no single keys: {error}"));
        terminal::enable_raw_mode().map_err(failed)?;
        let tells_releases = terminal::supports_keyboard_enhancement().unwrap_or(false);
        let taken = Self { tells_releases };
        if tells_releases {
            let flags = KeyboardEnhancementFlags::REPORT_EVENT_TYPES
                | KeyboardEnhancementFlags::DISAMBIGUATE_ESCAPE_CODES
                | KeyboardEnhancementFlags::REPORT_ALL_KEYS_AS_ESCAPE_CODES;
            execute!(stderr(), PushKeyboardEnhancementFlags(flags)).map_err(failed)?;
        }
        Ok(taken)
    }

    /// The next key, if there is one.
    pub fn next(&self) -> Option<Key> {
        while event::poll(Duration::ZERO).unwrap_or(false) {
            let Ok(Event::Key(key)) = event::read() else { continue };
            let ctrl_c = key.code == KeyCode::Char('c') && key.modifiers.contains(KeyModifiers::CONTROL);
            if ctrl_c || key.code == KeyCode::Esc {
                return Some(Key::End);
            }
            if let Some(name) = name(key.code) {
                return Some(if key.kind == KeyEventKind::Release { Key::Up(name) } else { Key::Down(name) });
            }
        }
        None
    }
}

impl Drop for Terminal {
    fn drop(&mut self) {
        // The program ends: there is nobody left to tell.
        if self.tells_releases {
            let _ = execute!(stderr(), PopKeyboardEnhancementFlags);
        }
        let _ = terminal::disable_raw_mode();
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
        KeyCode::PageUp => "pageup".to_owned(),
        KeyCode::PageDown => "pagedown".to_owned(),
        _ => return None,
    })
}
