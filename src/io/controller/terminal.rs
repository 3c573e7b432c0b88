//! The terminal's keyboard as a controller. Terminals that tell releases (kitty's protocol) fly best; in others a key lets go by itself.

use crate::errors::AppError;
use crossterm::event::{
    self, DisableFocusChange, EnableFocusChange, Event, KeyCode, KeyEvent, KeyEventKind, KeyModifiers, KeyboardEnhancementFlags,
    PopKeyboardEnhancementFlags, PushKeyboardEnhancementFlags,
};
use crossterm::{execute, terminal};
use std::io::{IsTerminal, stderr, stdin};
use std::time::Duration;

/// What was done with a key.
#[derive(Debug, Clone, PartialEq, Eq)]
pub enum TerminalKey {
    /// Down; again while it is held where the terminal does not tell a press from its repetition.
    Down(String),
    /// Up.
    Up(String),
    /// The terminal lost the focus: who has it now hears the keys come up.
    LetGo,
    /// Ctrl-C or Escape: an end is wished.
    End,
}

/// A terminal that gives every key at once. Dropped, it is an ordinary one again.
#[derive(Debug)]
pub struct RawTerminal {
    asked: bool,
    /// The terminal tells when a key comes up.
    pub tells_releases: bool,
}

impl RawTerminal {
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
        // The terminal is asked on standard error: where that is a file it hears nothing, and tells no releases.
        let asked = stderr().is_terminal();
        let tells_releases = asked && terminal::supports_keyboard_enhancement().unwrap_or(false);
        let taken = Self { asked, tells_releases };
        if asked {
            execute!(stderr(), EnableFocusChange).map_err(failed)?;
        }
        if tells_releases {
            let flags = KeyboardEnhancementFlags::REPORT_EVENT_TYPES
                | KeyboardEnhancementFlags::DISAMBIGUATE_ESCAPE_CODES
                | KeyboardEnhancementFlags::REPORT_ALL_KEYS_AS_ESCAPE_CODES;
            execute!(stderr(), PushKeyboardEnhancementFlags(flags)).map_err(failed)?;
        }
        Ok(taken)
    }

    /// The next key, if there is one.
    pub fn next(&self) -> Option<TerminalKey> {
        while event::poll(Duration::ZERO).unwrap_or(false) {
            if let Some(key) = event::read().ok().and_then(|event| parse_escape(&event)) {
                return Some(key);
            }
        }
        None
    }
}

impl Drop for RawTerminal {
    fn drop(&mut self) {
        // The program ends: there is nobody left to tell.
        if self.tells_releases {
            let _ = execute!(stderr(), PopKeyboardEnhancementFlags);
        }
        if self.asked {
            let _ = execute!(stderr(), DisableFocusChange);
        }
        let _ = terminal::disable_raw_mode();
    }
}

fn parse_escape(event: &Event) -> Option<TerminalKey> {
    match event {
        Event::Key(key) => pressed(key),
        Event::FocusLost => Some(TerminalKey::LetGo),
        _ => None,
    }
}

fn pressed(key: &KeyEvent) -> Option<TerminalKey> {
    let ctrl_c = key.code == KeyCode::Char('c') && key.modifiers.contains(KeyModifiers::CONTROL);
    if ctrl_c || key.code == KeyCode::Esc {
        return Some(TerminalKey::End);
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
    fn exact_a_key_that_repeats_is_pressed_once_and_lost_focus_releases() {
        let key = |kind| Event::Key(KeyEvent::new_with_kind(KeyCode::Char('P'), KeyModifiers::NONE, kind));
        let told = [KeyEventKind::Press, KeyEventKind::Repeat, KeyEventKind::Release].map(|kind| parse_escape(&key(kind)));
        assert_eq!(told, [Some(TerminalKey::Down("p".into())), None, Some(TerminalKey::Up("p".into()))]);
        assert_eq!([Event::FocusLost, Event::FocusGained].map(|event| parse_escape(&event)), [Some(TerminalKey::LetGo), None]);
        let end = KeyEvent::new(KeyCode::Char('c'), KeyModifiers::CONTROL);
        assert_eq!(parse_escape(&Event::Key(end)), Some(TerminalKey::End));
    }
}
