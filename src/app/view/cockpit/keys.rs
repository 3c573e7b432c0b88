//! Keys of the window by the names that files of keys use.

use crate::view::flow::Press;
use std::collections::BTreeMap;
use winit::event::{ElementState, KeyEvent};
use winit::keyboard::{Key, NamedKey, PhysicalKey};

/// What a key does on a page. Held keys repeat where they move or type; what they do once is not done again on a page that comes meanwhile.
pub fn press(event: &KeyEvent) -> Option<Press> {
    if event.state != ElementState::Pressed {
        return None;
    }
    let press = meant(event)?;
    (!event.repeat || !matches!(press, Press::Enter | Press::Escape)).then_some(press)
}

fn meant(event: &KeyEvent) -> Option<Press> {
    Some(match &event.logical_key {
        Key::Named(NamedKey::ArrowUp) => Press::Up,
        Key::Named(NamedKey::ArrowDown | NamedKey::Tab) => Press::Down,
        Key::Named(NamedKey::ArrowLeft) => Press::Left,
        Key::Named(NamedKey::ArrowRight) => Press::Right,
        Key::Named(NamedKey::Enter) => Press::Enter,
        Key::Named(NamedKey::Escape) => Press::Escape,
        Key::Named(NamedKey::Backspace) => Press::Backspace,
        Key::Character(signs) => Press::Sign(signs.chars().next()?),
        _ => return None,
    })
}

/// A key that changed.
#[derive(Debug, Clone, PartialEq, Eq)]
pub enum Change {
    /// Down; not told again while it is held.
    Down(String),
    /// Up, by the name that it went down with.
    Up(String),
}

/// Which keys are down. A key that comes up while Shift is held has another sign than when it went down: the place on the keyboard tells.
#[derive(Debug, Default)]
pub struct Held(BTreeMap<String, String>);

impl Held {
    /// Takes an event of the window.
    pub fn take(&mut self, event: &KeyEvent) -> Option<Change> {
        let place = place(&event.physical_key);
        match event.state {
            ElementState::Pressed if event.repeat => None,
            ElementState::Pressed => {
                let name = name(&event.logical_key)?;
                self.0.insert(place, name.clone());
                Some(Change::Down(name))
            }
            ElementState::Released => self.0.remove(&place).map(Change::Up),
        }
    }

    /// All are up.
    pub fn let_go(&mut self) {
        self.0.clear();
    }

    /// True while a key of this name is down.
    pub fn is_down(&self, name: &str) -> bool {
        self.0.values().any(|held| held == name)
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
