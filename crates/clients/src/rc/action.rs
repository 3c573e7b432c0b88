//! What a button or a key does.

/// A wish that is no stick.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub enum ControllerAction {
    /// The lamp on, or off when it is on.
    Lamp,
    /// A picture.
    Snapshot,
    /// Motors may turn.
    Arm,
    /// Motors stop, on the ground.
    Disarm,
    /// Up to the take-off height.
    TakeOff,
    /// Down, here.
    Land,
    /// Home, and down there.
    Return,
    /// Stay here.
    Hold,
    /// The sticks command velocity.
    Position,
    /// The camera up by a step.
    GimbalUp,
    /// The camera down by a step.
    GimbalDown,
    /// The camera sees nearer by a step.
    CameraZoomIn,
    /// The camera sees wider by a step.
    CameraZoomOut,
}

/// All actions with their names in files.
pub const ALL: [(&str, ControllerAction); 13] = [
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
];

impl ControllerAction {
    /// Its name in files.
    #[must_use]
    pub fn name(self) -> &'static str {
        ALL.iter().find(|(_, action)| *action == self).map_or("", |(name, _)| name)
    }

    /// It moves something by a step, and is meant to be asked for several times.
    #[must_use]
    pub fn is_repeatable(self) -> bool {
        matches!(self, Self::GimbalUp | Self::GimbalDown | Self::CameraZoomIn | Self::CameraZoomOut)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn exact_every_action_has_a_name_of_its_own() {
        let names: std::collections::BTreeSet<_> = ALL.iter().map(|(_, action)| action.name()).collect();
        assert_eq!(names.len(), ALL.len());
        assert!(!names.contains(""));
    }
}
