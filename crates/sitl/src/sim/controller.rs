//! The flight controller and its MAVLink interface: built in, or in another process.

use crate::autopilot::{Autopilot, LandedState};
use crate::backend::ExternalAutopilot;
use crate::endpoint::params::InstructorSettings;
use crate::endpoint::{Endpoint, FailureInjection, LinkId, Links, PayloadLink, RelayEndpoint, VehicleLink};
use spandrel_mavlink::contract::practice::PracticeRequest;
use spandrel_mavlink::dialect::MavSeverity;
use spandrel_model::time::SimTime;

/// The flight controller with the MAVLink interface that belongs to it.
#[derive(Debug, Clone)]
pub(super) enum Controller {
    /// The built-in autopilot.
    Builtin(Box<BuiltinController>),
    /// An autopilot in another process.
    External(Box<ExternalController>),
}

/// The built-in autopilot and the vehicle's whole MAVLink interface.
#[derive(Debug, Clone)]
pub(super) struct BuiltinController {
    pub autopilot: Autopilot,
    pub endpoint: Endpoint,
}

/// An external autopilot, and the interface of the equipment beside it.
#[derive(Debug, Clone)]
pub(super) struct ExternalController {
    pub autopilot: ExternalAutopilot,
    pub endpoint: RelayEndpoint,
}

impl Controller {
    /// Returns the vehicle's links.
    pub fn links(&self) -> &Links {
        match self {
            Self::Builtin(own) => &own.endpoint.links,
            Self::External(other) => &other.endpoint.links,
        }
    }

    /// Returns the vehicle's links, to change them.
    pub fn links_mut(&mut self) -> &mut Links {
        match self {
            Self::Builtin(own) => &mut own.endpoint.links,
            Self::External(other) => &mut other.endpoint.links,
        }
    }

    /// Returns the equipment interface.
    pub fn payload(&self) -> &PayloadLink {
        match self {
            Self::Builtin(own) => &own.endpoint.payload,
            Self::External(other) => &other.endpoint.payload,
        }
    }

    /// Returns the equipment interface, to change it.
    pub fn payload_mut(&mut self) -> &mut PayloadLink {
        match self {
            Self::Builtin(own) => &mut own.endpoint.payload,
            Self::External(other) => &mut other.endpoint.payload,
        }
    }

    /// Returns the built-in autopilot.
    pub fn builtin(&self) -> Option<&Autopilot> {
        match self {
            Self::Builtin(own) => Some(&own.autopilot),
            Self::External(_) => None,
        }
    }

    /// Returns the interface of the built-in autopilot.
    pub fn vehicle(&self) -> Option<&VehicleLink> {
        match self {
            Self::Builtin(own) => Some(&own.endpoint.vehicle),
            Self::External(_) => None,
        }
    }

    /// Returns the interface of the built-in autopilot, to change it.
    pub fn vehicle_mut(&mut self) -> Option<&mut VehicleLink> {
        match self {
            Self::Builtin(own) => Some(&mut own.endpoint.vehicle),
            Self::External(_) => None,
        }
    }

    /// Returns the external autopilot.
    pub fn external(&self) -> Option<&ExternalController> {
        match self {
            Self::Builtin(_) => None,
            Self::External(other) => Some(other),
        }
    }

    /// Returns the external autopilot, to change it.
    pub fn external_mut(&mut self) -> Option<&mut ExternalController> {
        match self {
            Self::Builtin(_) => None,
            Self::External(other) => Some(other),
        }
    }

    /// Returns whether the motors are armed.
    pub fn armed(&self) -> bool {
        match self {
            Self::Builtin(own) => own.autopilot.status().armed,
            Self::External(other) => other.endpoint.report.is_armed(),
        }
    }

    /// Returns whether the autopilot reports that the aircraft is in the air.
    pub fn is_flying(&self) -> bool {
        match self {
            Self::Builtin(own) => own.autopilot.status().landed == LandedState::InAir,
            Self::External(other) => other.endpoint.report.is_flying,
        }
    }

    /// Returns whether the autopilot reports that the aircraft stands on the ground or takes off.
    pub fn is_on_ground(&self) -> bool {
        match self {
            Self::Builtin(own) => matches!(own.autopilot.status().landed, LandedState::OnGround | LandedState::TakingOff),
            Self::External(other) => other.endpoint.report.is_on_ground == Some(true),
        }
    }

    /// Broadcasts a text with the next tick.
    pub fn push_text(&mut self, severity: MavSeverity, text: &str) {
        match self {
            Self::Builtin(own) => own.endpoint.vehicle.push_text(severity, text),
            Self::External(other) => other.endpoint.push_text(severity, text),
        }
    }

    /// Sets whether manual control reaches the autopilot.
    pub fn set_accepts_sticks(&mut self, accepts: bool) {
        match self {
            Self::Builtin(own) => own.endpoint.vehicle.accepts_sticks = accepts,
            Self::External(other) => other.endpoint.accepts_sticks = accepts,
        }
    }

    /// Removes and returns the next failure to inject.
    pub fn next_injection(&mut self) -> Option<FailureInjection> {
        match self {
            Self::Builtin(own) => own.endpoint.vehicle.next_injection(),
            Self::External(other) => other.endpoint.next_injection(),
        }
    }

    /// Removes and returns the next request to freeze, resume or rewind the flight.
    pub fn next_practice_request(&mut self) -> Option<PracticeRequest> {
        match self {
            Self::Builtin(own) => own.endpoint.vehicle.next_practice_request(),
            Self::External(other) => other.endpoint.next_practice_request(),
        }
    }

    /// Returns the number of parameter changes so far.
    pub fn parameter_changes(&self) -> u64 {
        match self {
            Self::Builtin(own) => own.endpoint.vehicle.parameter_changes(),
            Self::External(other) => other.endpoint.parameter_changes(),
        }
    }

    /// Returns the environment settings that parameters control.
    pub fn instructor_settings(&self) -> InstructorSettings {
        match self {
            Self::Builtin(own) => own.endpoint.vehicle.instructor_settings(),
            Self::External(other) => other.endpoint.instructor_settings(),
        }
    }

    /// Removes a link.
    pub fn close(&mut self, link: LinkId) {
        match self {
            Self::Builtin(own) => own.endpoint.close(link),
            Self::External(other) => other.endpoint.close(link),
        }
    }

    /// Scales the timeouts of clients that are not in lockstep.
    pub fn set_speed_factor(&mut self, factor: f64) {
        match self {
            Self::Builtin(own) => own.endpoint.set_speed_factor(factor, &mut own.autopilot),
            Self::External(other) => other.endpoint.set_speed_factor(factor),
        }
    }

    /// Returns the clock of the links. It also runs while simulation time is stopped for the start of an external autopilot.
    pub fn link_clock(&self, now: SimTime) -> SimTime {
        match self {
            Self::Builtin(_) => now,
            Self::External(other) => other.autopilot.clock(now),
        }
    }
}
