//! The simulated aircraft as seen by the interface, independent of the autopilot.

use super::clock::VehicleClock;
use super::payload::{HazardTruth, ScoringTruth};
use super::practice::PracticeState;
use crate::physics::{Actuators, BatteryState, RigidState};
use crate::sensors::Readings;
use spandrel_model::frames::{Frd, Ned, Vec3};
use spandrel_model::geodesy::LocalPlane;
use spandrel_model::site::Site;
use spandrel_model::vehicle::Vehicle;

/// State of the physics, the sensors and the site at one instant.
#[derive(Debug, Clone, Copy)]
pub struct SimulatedAircraft<'a> {
    /// The time on each clock.
    pub clock: VehicleClock,
    /// The aircraft's specification.
    pub vehicle: &'a Vehicle,
    /// Local tangent plane.
    pub plane: &'a LocalPlane,
    /// The site.
    pub site: &'a Site,
    /// Latest sensor readings.
    pub readings: &'a Readings,
    /// True state of the aircraft.
    pub truth: &'a RigidState,
    /// Specific force, m/s², body axes.
    pub specific_force_m_s2: Vec3<Frd>,
    /// Battery state.
    pub battery: &'a BatteryState,
    /// Motor commands.
    pub actuators: &'a Actuators,
    /// Wind at the aircraft, m/s.
    pub wind_m_s: Vec3<Ned>,
    /// Counters and ground truth for scoring.
    pub scoring: &'a ScoringTruth,
    /// State of the hazards that the job simulates.
    pub hazards: HazardTruth,
    /// Whether the flight can be frozen and rewound.
    pub practice: PracticeState,
}
