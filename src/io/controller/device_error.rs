//! Why no controller can be opened.

use crate::errors::AppError;

/// Why no controller can be opened.
#[derive(Debug, Clone, PartialEq, Eq, thiserror::Error)]
pub enum DeviceError {
    /// No device is connected.
    #[cfg(feature = "gamepad")]
    #[error("no gamepad or transmitter is connected; use --keyboard to fly without one")]
    NotConnected,
    /// None of the connected devices has the requested name or ID.
    #[cfg(feature = "gamepad")]
    #[error("no device matches '{wanted}' (connected: {})", listed(.connected))]
    NoMatch {
        /// Requested name or ID.
        wanted: String,
        /// Names and IDs of the connected devices.
        connected: Vec<String>,
    },
    /// Several connected devices match.
    #[cfg(feature = "gamepad")]
    #[error("more than one device matches: choose one with --device (connected: {})", listed(.connected))]
    Ambiguous {
        /// Names and IDs of the connected devices.
        connected: Vec<String>,
    },
    /// The system does not give access to devices.
    #[cfg(feature = "gamepad")]
    #[error("cannot access gamepads and transmitters on this machine: {0}")]
    NoAccess(String),
    /// The program was built without support for devices.
    #[cfg(not(feature = "gamepad"))]
    #[error(
        "{wanted}this build does not support gamepads (build with --features gamepad, which needs libudev-dev on Debian and Ubuntu); use --keyboard to fly without one"
    )]
    Unsupported {
        /// Requested name or ID with a colon, or nothing.
        wanted: String,
    },
}

/// Lists names for the command line.
#[cfg(feature = "gamepad")]
fn listed(names: &[String]) -> String {
    if names.is_empty() { "none".to_owned() } else { names.join(", ") }
}

impl From<DeviceError> for AppError {
    fn from(error: DeviceError) -> Self {
        let words = error.to_string();
        match error {
            #[cfg(feature = "gamepad")]
            DeviceError::Ambiguous { .. } => Self::invalid(words),
            #[cfg(feature = "gamepad")]
            DeviceError::NotConnected | DeviceError::NoMatch { .. } | DeviceError::NoAccess(_) => Self::failed(words),
            #[cfg(not(feature = "gamepad"))]
            DeviceError::Unsupported { .. } => Self::failed(words),
        }
    }
}

#[cfg(feature = "gamepad")]
#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn exact_errors_name_the_connected_devices() {
        let none = DeviceError::NoMatch { wanted: "Pad".into(), connected: Vec::new() };
        assert_eq!(none.to_string(), "no device matches 'Pad' (connected: none)");
        let both = DeviceError::Ambiguous { connected: vec!["'A' (1:2)".into(), "'B' (3:4)".into()] };
        assert!(both.to_string().ends_with("(connected: 'A' (1:2), 'B' (3:4))"));
        assert!(matches!(AppError::from(both), AppError::Wrong(_)) && matches!(AppError::from(none), AppError::Failed(_)));
    }
}
