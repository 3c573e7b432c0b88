//! Keys of the window by the names that files of keys use.

use spandrel_view::flow::KeyPress;
use std::collections::{BTreeMap, BTreeSet};
use winit::event::{ElementState, KeyEvent};
use winit::keyboard::{Key, NamedKey, PhysicalKey};

/// What a key does on a page. Held keys repeat where they move or type; what they do once is not done again on a page that comes meanwhile.
pub fn press(event: &KeyEvent) -> Option<KeyPress> {
    if event.state != ElementState::Pressed {
        return None;
    }
    let press = key_name(event)?;
    (!event.repeat || !matches!(press, KeyPress::Enter | KeyPress::Escape)).then_some(press)
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
        Key::Character(signs) => KeyPress::Sign(signs.chars().next()?),
        _ => return None,
    })
}

/// A key that changed.
#[derive(Debug, Clone, PartialEq, Eq)]
pub enum KeyChange {
    /// Down; not told again while it is held.
    Down(String),
    /// Up, by the name that it went down with.
    Up(String),
}

/// Which keys are down, and which were down already when the window came to the front: these were pressed for somebody else, and do nothing
/// until they come up. A key that comes up while Shift is held has another sign than when it went down: the place on the keyboard tells.
#[derive(Debug, Default)]
pub struct HeldKeys {
    names: BTreeMap<String, String>,
    others: BTreeSet<String>,
}

impl HeldKeys {
    /// A key that was pressed for somebody else. `generated`: the window system tells of a key that was down already.
    pub fn pressed_elsewhere(&mut self, event: &KeyEvent, made_up: bool) -> bool {
        self.elsewhere(place(&event.physical_key), event.state, made_up)
    }

    fn elsewhere(&mut self, place: String, state: ElementState, made_up: bool) -> bool {
        match state {
            ElementState::Pressed if made_up => {
                self.others.insert(place);
                true
            }
            // While it is held it repeats, and the first time is not told to be a repetition.
            ElementState::Pressed => self.others.contains(&place),
            ElementState::Released => self.others.remove(&place),
        }
    }

    /// Takes an event of the window.
    pub fn take(&mut self, event: &KeyEvent) -> Option<KeyChange> {
        let place = place(&event.physical_key);
        match event.state {
            ElementState::Pressed if event.repeat => None,
            ElementState::Pressed => {
                let name = name(&event.logical_key)?;
                self.names.insert(place, name.clone());
                Some(KeyChange::Down(name))
            }
            ElementState::Released => self.names.remove(&place).map(KeyChange::Up),
        }
    }

    /// All are up.
    pub fn let_go(&mut self) {
        *self = Self::default();
    }

    /// True while a key of this name is down.
    pub fn is_down(&self, name: &str) -> bool {
        self.names.values().any(|held| held == name)
    }
}

fn place(key: &PhysicalKey) -> String {
    format!("{key:?}")
}

/// A key by the name that files of keys use.
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
    fn exact_a_key_that_was_down_before_the_window_had_it_does_nothing_until_it_comes_up() {
        let mut held = HeldKeys::default();
        let mut told = |state, made_up| held.elsewhere("w".into(), state, made_up);
        assert!(told(Pressed, true) && told(Pressed, false), "made up, then its first repetition");
        assert!(told(Released, false) && !told(Pressed, false) && !told(Released, false), "then it is a key as any other");
        held.elsewhere("w".into(), Pressed, true);
        held.let_go();
        assert!(!held.elsewhere("w".into(), Pressed, false));
    }
}
