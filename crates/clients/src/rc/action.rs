//! Actions of buttons and keys.

use spandrel_text::{Language, text};

/// A controller action other than a stick movement.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub enum ControllerAction {
    /// Toggles the lamp.
    Lamp,
    /// Takes a picture.
    Snapshot,
    /// Arms the motors.
    Arm,
    /// Disarms the motors on the ground.
    Disarm,
    /// Takes off to the takeoff altitude.
    TakeOff,
    /// Lands at the current position.
    Land,
    /// Returns to launch and lands.
    Return,
    /// Holds the current position.
    Hold,
    /// Selects position mode, where the sticks command velocity.
    Position,
    /// Tilts the camera up by one step.
    GimbalUp,
    /// Tilts the camera down by one step.
    GimbalDown,
    /// Zooms the camera in by one step.
    CameraZoomIn,
    /// Zooms the camera out by one step.
    CameraZoomOut,
    /// Freezes the flight, or continues it. In practice only.
    Freeze,
    /// Rewinds the flight by 10 s. In practice only.
    Rewind,
    /// Selects the next response to the sticks.
    StickResponse,
}

/// All actions and their names in configuration files.
pub const ALL: [(&str, ControllerAction); 16] = [
    ("lamp", ControllerAction::Lamp),
    ("snapshot", ControllerAction::Snapshot),
    ("arm", ControllerAction::Arm),
    ("disarm", ControllerAction::Disarm),
    ("take_off", ControllerAction::TakeOff),
    ("land", ControllerAction::Land),
    ("return", ControllerAction::Return),
    ("hold", ControllerAction::Hold),
    ("position", ControllerAction::Position),
    ("gimbal_up", ControllerAction::GimbalUp),
    ("gimbal_down", ControllerAction::GimbalDown),
    ("camera_zoom_in", ControllerAction::CameraZoomIn),
    ("camera_zoom_out", ControllerAction::CameraZoomOut),
    ("freeze", ControllerAction::Freeze),
    ("rewind", ControllerAction::Rewind),
    ("stick_response", ControllerAction::StickResponse),
];

impl ControllerAction {
    /// Returns the action's name in configuration files.
    #[must_use]
    pub fn name(self) -> &'static str {
        ALL.iter().find(|(_, action)| *action == self).map_or("", |(name, _)| name)
    }

    /// Returns what the action does, for display.
    #[must_use]
    pub fn title(self, language: Language) -> String {
        match self {
            Self::Lamp => text!(language, "keys-lamp"),
            Self::Snapshot => text!(language, "keys-snapshot"),
            Self::Arm => text!(language, "keys-arm"),
            Self::Disarm => text!(language, "keys-disarm"),
            Self::TakeOff => text!(language, "keys-take-off"),
            Self::Land => text!(language, "keys-land"),
            Self::Return => text!(language, "keys-return"),
            Self::Hold => text!(language, "keys-hold"),
            Self::Position => text!(language, "keys-position"),
            Self::GimbalUp => text!(language, "keys-gimbal-up"),
            Self::GimbalDown => text!(language, "keys-gimbal-down"),
            Self::CameraZoomIn => text!(language, "keys-camera-zoom-in"),
            Self::CameraZoomOut => text!(language, "keys-camera-zoom-out"),
            Self::Freeze => text!(language, "keys-freeze"),
            Self::Rewind => text!(language, "keys-rewind"),
            Self::StickResponse => text!(language, "keys-stick-response"),
        }
    }

    /// Returns the same in fewer words.
    #[must_use]
    pub fn short_title(self, language: Language) -> String {
        match self {
            Self::Lamp => text!(language, "keys-short-lamp"),
            Self::Snapshot => text!(language, "keys-short-snapshot"),
            Self::Arm => text!(language, "keys-short-arm"),
            Self::Disarm => text!(language, "keys-short-disarm"),
            Self::TakeOff => text!(language, "keys-short-take-off"),
            Self::Land => text!(language, "keys-short-land"),
            Self::Return => text!(language, "keys-short-return"),
            Self::Hold => text!(language, "keys-short-hold"),
            Self::Position => text!(language, "keys-short-position"),
            Self::GimbalUp => text!(language, "keys-short-gimbal-up"),
            Self::GimbalDown => text!(language, "keys-short-gimbal-down"),
            Self::CameraZoomIn => text!(language, "keys-short-camera-zoom-in"),
            Self::CameraZoomOut => text!(language, "keys-short-camera-zoom-out"),
            Self::Freeze => text!(language, "keys-short-freeze"),
            Self::Rewind => text!(language, "keys-short-rewind"),
            Self::StickResponse => text!(language, "keys-short-stick-response"),
        }
    }

    /// Checks whether the action is a single step that users usually repeat.
    #[must_use]
    pub fn is_repeatable(self) -> bool {
        matches!(self, Self::GimbalUp | Self::GimbalDown | Self::CameraZoomIn | Self::CameraZoomOut)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn exact_action_names_are_unique() {
        let names: std::collections::BTreeSet<_> = ALL.iter().map(|(_, action)| action.name()).collect();
        assert_eq!(names.len(), ALL.len());
        assert!(!names.contains(""));
    }
}
