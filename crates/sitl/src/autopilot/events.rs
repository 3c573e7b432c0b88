//! Events that the autopilot reports to the operator.

use super::failsafe::sensor_health::SensorChange;

/// Severity of an event.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub enum Severity {
    /// Same as MAV_SEVERITY_CRITICAL.
    Critical,
    /// Same as MAV_SEVERITY_WARNING.
    Warning,
    /// Same as MAV_SEVERITY_INFO.
    Info,
}

impl Severity {
    /// Returns the severity number that syslog and MAVLink use.
    #[must_use]
    pub fn number(self) -> u8 {
        match self {
            Self::Critical => 2,
            Self::Warning => 4,
            Self::Info => 6,
        }
    }
}

/// An event to report to the operator.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct AutopilotEvent {
    /// Severity of the event.
    pub severity: Severity,
    /// Status text.
    pub text: String,
    /// The sensor change that caused the event. Emulated autopilots can report it with their own text.
    pub sensor: Option<SensorChange>,
}

/// Events in the order in which they occurred.
#[derive(Debug, Clone, PartialEq, Eq, Default)]
pub struct EventQueue(Vec<AutopilotEvent>);

impl EventQueue {
    /// Adds an event.
    pub fn push(&mut self, severity: Severity, text: impl Into<String>) {
        self.0.push(AutopilotEvent { severity, text: text.into(), sensor: None });
    }

    /// Adds an event about a sensor.
    pub fn push_sensor_change(&mut self, severity: Severity, change: SensorChange) {
        self.0.push(AutopilotEvent { severity, text: change.status_text(), sensor: Some(change) });
    }

    /// Moves all events from another queue to the end of this one.
    pub fn append(&mut self, other: &mut Self) {
        self.0.append(&mut other.0);
    }

    /// Returns and clears the events.
    pub fn drain(&mut self) -> Vec<AutopilotEvent> {
        std::mem::take(&mut self.0)
    }
}
