//! Aircraft state used by the equipment and the scoring feed. It comes from sensors, physics and the state that any
//! autopilot reports, so the payload interface also works with another autopilot.

use super::components::PayloadComponents;
use super::hazard_truth::HazardTruth;
use super::scoring_truth::ScoringTruth;
use crate::endpoint::clock::VehicleClock;
use crate::physics::{BatteryState, RigidState};
use spandrel_model::frames::{Frd, Ned, Rotation, Vec3};
use spandrel_model::geodesy::{Geo, LocalPlane};
use spandrel_model::site::Site;
use spandrel_model::vehicle::Vehicle;

/// The aircraft at one instant.
#[derive(Debug, Clone, Copy)]
pub struct PayloadInput<'a> {
    /// The time on each clock.
    pub clock: VehicleClock,
    /// The aircraft's specification.
    pub vehicle: &'a Vehicle,
    /// Local tangent plane.
    pub plane: &'a LocalPlane,
    /// The site.
    pub site: &'a Site,
    /// Estimated position, site frame, m.
    pub position_m: Vec3<Ned>,
    /// Estimated attitude.
    pub attitude: Rotation<Frd, Ned>,
    /// Home position, site frame, m; `None` before it is set.
    pub home_m: Option<Vec3<Ned>>,
    /// Whether the altitude of a region-of-interest command is above mean sea level, regardless of its frame.
    pub roi_above_sea_level: bool,
    /// Stick positions as received: forward, right, up, yaw, -1 to 1; `None` after the timeout.
    pub sticks: Option<[f64; 4]>,
    /// True state of the aircraft.
    pub truth: &'a RigidState,
    /// Specific force, m/s², body axes.
    pub specific_force_m_s2: Vec3<Frd>,
    /// Wind at the aircraft, m/s.
    pub wind_m_s: Vec3<Ned>,
    /// Counters and ground truth for scoring.
    pub scoring: &'a ScoringTruth,
    /// State of the hazards that the job simulates.
    pub hazards: HazardTruth,
    /// True state of the battery.
    pub battery: &'a BatteryState,
    /// Component IDs of the equipment.
    pub components: PayloadComponents,
}

impl PayloadInput<'_> {
    /// Returns the estimated heading, rad.
    #[must_use]
    pub fn heading_rad(&self) -> f64 {
        self.attitude.yaw_rad()
    }

    /// Returns the estimated geographic position.
    #[must_use]
    pub fn geo(&self) -> Geo {
        self.plane.geo_from_enu(self.position_m.enu())
    }

    /// Returns the true geographic position.
    #[must_use]
    pub fn true_geo(&self) -> Geo {
        self.plane.geo_from_enu(self.truth.position_m.enu())
    }

    /// Returns the height of home above the site's origin in meters; 0 before home is set.
    #[must_use]
    pub fn home_height_m(&self) -> f64 {
        self.home_m.map_or(0.0, |home| -home.down())
    }

    /// Returns the height above home in meters.
    #[must_use]
    pub fn height_above_home_m(&self) -> f64 {
        self.home_m.map_or(0.0, |home| home.down()) - self.position_m.down()
    }
}
