//! The autopilot as one object: what the outside calls, and one control step.

use super::{Estimate, MissionStep, OffboardSetpoint, Outcome, Request, Status, Sticks, Tuning};
use crate::base::frames::{Frd, Ned, Rotation, Vec3};
use crate::base::geodesy::Geo;
use crate::base::time::SimTime;
use crate::scenario::Rules;
use crate::sitl::physics::Actuators;
use crate::sitl::sensors::Readings;
use crate::vehicle::Vehicle;

/// How grave an event's text is.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub enum Severity {
    /// As MAV_SEVERITY_CRITICAL.
    Critical,
    /// As MAV_SEVERITY_WARNING.
    Warning,
    /// As MAV_SEVERITY_INFO.
    Info,
}

/// Something that people should read.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Event {
    /// Gravity.
    pub severity: Severity,
    /// Words, at most 50 bytes (one STATUSTEXT).
    pub text: String,
}

/// The built-in autopilot: plain data, so that a clone is a snapshot.
#[derive(Debug, Clone)]
pub struct Autopilot {
    /// What an operator may change; write freely between steps.
    pub tuning: Tuning,
    estimate: Estimate,
    status: Status,
    events: Vec<Event>,
}

#[allow(unused_variables)]
impl Autopilot {
    /// Boots on the ground. `origin` is where the local frame lies (for the magnetic model).
    #[must_use]
    pub fn new(vehicle: &Vehicle, rules: &Rules, origin: Geo, tuning: Tuning) -> Self {
        unimplemented!("lands next")
    }

    /// Asks for something; the answer comes at once.
    pub fn request(&mut self, request: Request, now: SimTime) -> Outcome {
        Outcome::Unsupported
    }

    /// The pilot's sticks, as often as they come.
    pub fn sticks(&mut self, sticks: Sticks, now: SimTime) {}

    /// An external set-point.
    pub fn offboard(&mut self, setpoint: OffboardSetpoint, now: SimTime) {}

    /// A ground station's heartbeat has come.
    pub fn ground_station_alive(&mut self, now: SimTime) {}

    /// Replaces the mission; the first item becomes current.
    pub fn set_mission(&mut self, steps: Vec<MissionStep>) {}

    /// Jumps to a mission item; false when there is none.
    pub fn set_mission_current(&mut self, index: usize) -> bool {
        false
    }

    /// One step at the control rate (400 Hz), with what the sensors gave since the last.
    pub fn step(&mut self, readings: &Readings, now: SimTime) -> Actuators {
        Actuators::default()
    }

    /// The vehicle was put back in the air by hand: estimator and controllers start there, armed, holding.
    pub fn respawn(&mut self, position_m: Vec3<Ned>, velocity_m_s: Vec3<Ned>, attitude: Rotation<Frd, Ned>, now: SimTime) {}

    /// What the estimator believes.
    #[must_use]
    pub fn estimate(&self) -> &Estimate {
        &self.estimate
    }

    /// What the autopilot tells the world.
    #[must_use]
    pub fn status(&self) -> &Status {
        &self.status
    }

    /// Events since the last call, in order.
    pub fn drain_events(&mut self) -> Vec<Event> {
        std::mem::take(&mut self.events)
    }

    /// Mission items reached since the last call, in order, for MISSION_ITEM_REACHED.
    pub fn drain_reached(&mut self) -> Vec<usize> {
        self.status.mission_reached.take().into_iter().collect()
    }
}
