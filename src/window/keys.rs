//! The window's keys, with the names used in key binding files.

use spandrel_view::flow::KeyPress;
use std::collections::{BTreeMap, BTreeSet};
use winit::event::{ElementState, KeyEvent};
use winit::keyboard::{Key, NamedKey, PhysicalKey};

/// Converts a key press to its action on a page. Held keys repeat movement and typing, but not Enter and Escape,
/// because these would also act on the next page.
pub fn press(event: &KeyEvent) -> Option<KeyPress> {
    if event.state != ElementState::Pressed {
        return None;
    }
    let press = key_name(event)?;
    (!event.repeat || !matches!(press, KeyPress::Enter | KeyPress::Escape)).then_some(press)
}

/// Returns by how many pages a key press scrolls down; negative: up.
pub fn scrolled_pages(event: &KeyEvent) -> Option<f64> {
    match (&event.logical_key, event.state) {
        (Key::Named(NamedKey::PageDown), ElementState::Pressed) => Some(1.0),
        (Key::Named(NamedKey::PageUp), ElementState::Pressed) => Some(-1.0),
        _ => None,
    }
}

/// Checks whether a key press switches between a window and the full screen: F11, as in other programs.
pub fn is_full_screen_key(event: &KeyEvent) -> bool {
    event.state == ElementState::Pressed && !event.repeat && event.logical_key == Key::Named(NamedKey::F11)
}

fn key_name(event: &KeyEvent) -> Option<KeyPress> {
    Some(match &event.logical_key {
        Key::Named(NamedKey::ArrowUp) => KeyPress::Up,
        Key::Named(NamedKey::ArrowDown | NamedKey::Tab) => KeyPress::Down,
        Key::Named(NamedKey::ArrowLeft) => KeyPress::Left,
        Key::Named(NamedKey::ArrowRight) => KeyPress::Right,
        Key::Named(NamedKey::Enter) => KeyPress::Enter,
        Key::Named(NamedKey::Escape) => KeyPress::Escape,
        Key::Named(NamedKey::Backspace) => KeyPress::Backspace,
        Key::Character(signs) => KeyPress::Char(signs.chars().next()?),
        _ => return None,
    })
}

/// A key that was pressed or released.
#[derive(Debug, Clone, PartialEq, Eq)]
pub enum KeyChange {
    /// Pressed; not reported again while the key is held.
    Down(String),
    /// Released; contains the name that the key had when it was pressed.
    Up(String),
}

/// Pressed keys, and keys that were already pressed when the window gained focus. The latter were meant for another
/// window and do nothing until released. Physical keys identify the keys, because the symbol may differ between press
/// and release (Shift).
#[derive(Debug, Default)]
pub struct HeldKeys {
    names: BTreeMap<String, String>,
    foreign_keys: BTreeSet<String>,
}

impl HeldKeys {
    /// Returns true if a key press was meant for another window. `is_synthetic` is true if the window system generated the
    /// event for a key that was already pressed.
    pub fn pressed_elsewhere(&mut self, event: &KeyEvent, is_synthetic: bool) -> bool {
        self.update_foreign_keys(key_id(&event.physical_key), event.state, is_synthetic)
    }

    fn update_foreign_keys(&mut self, physical_key_id: String, state: ElementState, is_synthetic: bool) -> bool {
        match state {
            ElementState::Pressed if is_synthetic => {
                self.foreign_keys.insert(physical_key_id);
                true
            }
            // A held key repeats, and the first repetition is not marked as one.
            ElementState::Pressed => self.foreign_keys.contains(&physical_key_id),
            ElementState::Released => self.foreign_keys.remove(&physical_key_id),
        }
    }

    /// Handles a key event.
    pub fn handle(&mut self, event: &KeyEvent) -> Option<KeyChange> {
        let physical_key_id = key_id(&event.physical_key);
        match event.state {
            ElementState::Pressed if event.repeat => None,
            ElementState::Pressed => {
                let name = name(&event.logical_key)?;
                self.names.insert(physical_key_id, name.clone());
                Some(KeyChange::Down(name))
            }
            ElementState::Released => self.names.remove(&physical_key_id).map(KeyChange::Up),
        }
    }

    /// Clears all pressed keys.
    pub fn clear(&mut self) {
        *self = Self::default();
    }

    /// Returns true while a key with this name is pressed.
    pub fn is_down(&self, name: &str) -> bool {
        self.names.values().any(|held| held == name)
    }
}

fn key_id(key: &PhysicalKey) -> String {
    format!("{key:?}")
}

/// Returns the name of a key in key binding files.
pub fn name(key: &Key) -> Option<String> {
    Some(match key {
        Key::Character(sign) => sign.to_lowercase(),
        Key::Named(NamedKey::ArrowUp) => "up".to_owned(),
        Key::Named(NamedKey::ArrowDown) => "down".to_owned(),
        Key::Named(NamedKey::ArrowLeft) => "left".to_owned(),
        Key::Named(NamedKey::ArrowRight) => "right".to_owned(),
        Key::Named(NamedKey::Space) => "space".to_owned(),
        Key::Named(NamedKey::Enter) => "enter".to_owned(),
        Key::Named(NamedKey::PageUp) => "pageup".to_owned(),
        Key::Named(NamedKey::PageDown) => "pagedown".to_owned(),
        Key::Named(NamedKey::Tab) => "tab".to_owned(),
        Key::Named(NamedKey::Escape) => "escape".to_owned(),
        Key::Named(NamedKey::Backspace) => "backspace".to_owned(),
        _ => return None,
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use ElementState::{Pressed, Released};

    #[test]
    fn exact_keys_pressed_for_another_window_are_ignored_until_released() {
        let mut held = HeldKeys::default();
        let mut told = |state, is_synthetic| held.update_foreign_keys("w".into(), state, is_synthetic);
        assert!(told(Pressed, true) && told(Pressed, false), "synthetic, then its first repetition");
        assert!(told(Released, false) && !told(Pressed, false) && !told(Released, false), "then a normal key");
        held.update_foreign_keys("w".into(), Pressed, true);
        held.clear();
        assert!(!held.update_foreign_keys("w".into(), Pressed, false));
    }
}
