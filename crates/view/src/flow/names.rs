//! Display names of the key bindings and of a controller's sticks and buttons, for use in texts.

use super::ControllerStatus;
use spandrel_text::{Language, MessageId, text};
use std::collections::BTreeMap;

/// Display names of keys, by the binding's name in key files.
#[derive(Debug, Clone, PartialEq, Eq, Default)]
pub struct KeyNames(BTreeMap<&'static str, String>);

impl KeyNames {
    /// Creates the names from a map of bindings to display names.
    #[must_use]
    pub fn new(keys: BTreeMap<&'static str, String>) -> Self {
        Self(keys)
    }

    /// Returns the name of a binding's key; for unknown bindings, the binding in braces.
    #[must_use]
    pub fn name(&self, binding: &str) -> String {
        self.0.get(binding).cloned().unwrap_or_else(|| format!("{{{binding}}}"))
    }

    /// Returns a message whose variables are bindings, with the names of their keys.
    #[must_use]
    pub fn fill(&self, language: Language, id: MessageId) -> String {
        id.fill(language, &|binding| self.name(binding))
    }
}

/// Names of what the trainee flies with: the keys, or a controller's sticks and buttons.
#[derive(Debug, Clone, Copy)]
pub struct ControlNames<'a> {
    keys: &'a KeyNames,
    controller: Option<&'a ControllerStatus>,
    language: Language,
}

impl<'a> ControlNames<'a> {
    /// Creates the names for a calibrated and connected controller, or else for the keys.
    #[must_use]
    pub fn new(keys: &'a KeyNames, controller: &'a ControllerStatus, language: Language) -> Self {
        Self { keys, controller: Some(controller).filter(|controller| controller.calibrated && !controller.lost), language }
    }

    /// Returns whether the trainee flies with sticks.
    #[must_use]
    pub fn has_sticks(&self) -> bool {
        self.controller.is_some()
    }

    /// Returns the name of a binding's button or key, or of the stick for `throttle`, `yaw`, `pitch` and `roll`.
    #[must_use]
    pub fn name(&self, binding: &str) -> String {
        let Some(controller) = self.controller else { return self.keys.name(binding) };
        let left_modes = match binding {
            "throttle" => [2, 4],
            "yaw" => [1, 2],
            "pitch" => [1, 3],
            "roll" => [3, 4],
            _ => {
                let button = controller.buttons.iter().find(|(bound, _)| *bound == binding);
                // The keys work beside the controller.
                return button.map_or_else(|| self.keys.name(binding), |(_, name)| name.clone());
            }
        };
        if left_modes.contains(&controller.mode) {
            text!(self.language, "window-controls-left-stick")
        } else {
            text!(self.language, "window-controls-right-stick")
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn exact_a_controller_names_sticks_by_their_mode_and_buttons_by_their_function() {
        let keys = KeyNames::new([("arm", "1".to_owned()), ("land", "L".to_owned())].into());
        let buttons = vec![("arm", "your button “arm”".to_owned())];
        let status = |mode| ControllerStatus { calibrated: true, mode, buttons: buttons.clone(), ..ControllerStatus::default() };
        let sides = |mode| {
            let status = status(mode);
            let names = ControlNames::new(&keys, &status, Language::English);
            ["throttle", "yaw", "pitch", "roll"].map(|axis| names.name(axis).chars().next())
        };
        let side = |letters: &str| [0, 1, 2, 3].map(|k| letters.chars().nth(k));
        assert_eq!([1, 2, 3, 4].map(sides), ["rllr", "llrr", "rrll", "lrrl"].map(side));
        let there = status(2);
        let names = ControlNames::new(&keys, &there, Language::English);
        assert_eq!(["arm", "land"].map(|binding| names.name(binding)), ["your button “arm”", "L"]);
        let lost = ControllerStatus { lost: true, ..status(2) };
        let names = ControlNames::new(&keys, &lost, Language::English);
        assert!(!names.has_sticks() && names.name("arm") == "1", "only the keys are left");
    }
}
