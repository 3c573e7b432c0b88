//! A read-only snapshot of the vehicle at one instant, used to build messages.

use super::flavor::{Flavor, ModeRow};
use super::flight_times::FlightTimes;
use super::manual::AUX_CHANNEL_COUNT;
use super::mission::PlanSummary;
use crate::autopilot::{AutopilotStatus, Estimate, Sticks};
use crate::endpoint::clock::VehicleClock;
use crate::endpoint::link::LinkKind;
use crate::endpoint::payload::camera::CameraSummary;
use crate::endpoint::payload::gimbal::GimbalState;
use crate::endpoint::payload::lamp::LampState;
use crate::endpoint::payload::{Payload, ScoringTruth};
use crate::physics::{Actuators, BatteryState, RigidState};
use crate::sensors::Readings;
use spandrel_model::frames::{Frd, LocalNed, Ned, Vec3};
use spandrel_model::geodesy::{Geo, LocalPlane};
use spandrel_model::vehicle::{Camera, Vehicle};

/// Ground truth, estimate, setpoints and counters at one instant.
#[derive(Debug, Clone, Copy)]
pub struct VehicleSnapshot<'a> {
    /// The time on the clocks of the receiving link.
    pub clock: VehicleClock,
    /// The aircraft's specification.
    pub vehicle: &'a Vehicle,
    /// Local tangent plane.
    pub plane: &'a LocalPlane,
    /// State estimate.
    pub estimate: &'a Estimate,
    /// Autopilot status.
    pub status: &'a AutopilotStatus,
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
    /// Stick positions as received; `None` after the timeout.
    pub sticks: Option<Sticks>,
    /// The same positions as transmitter channels 1 to 4, microseconds.
    pub pulses_us: Option<[u16; 4]>,
    /// Channels 5 to 16, microseconds.
    pub aux_pulses_us: [u16; AUX_CHANNEL_COUNT],
    /// Gimbal state.
    pub gimbal: GimbalState,
    /// Lamp state.
    pub lamp: LampState,
    /// Camera state.
    pub camera: CameraSummary,
    /// Plan summary.
    pub plans: PlanSummary,
    /// Autopilot flavor.
    pub flavor: &'static Flavor,
    /// The flavor's number for the last requested mode.
    pub requested_mode: u32,
    /// Whether the geofence is enabled.
    pub fence_enabled: bool,
    /// MAVLink system ID.
    pub system_id: u8,
    /// Times of the current or last flight.
    pub flight: FlightTimes,
}

impl VehicleSnapshot<'_> {
    /// Returns the mode as shown to clients.
    #[must_use]
    pub fn mode_row(&self) -> &'static ModeRow {
        self.flavor.row_of(self.status.mode, self.requested_mode)
    }

    /// Returns the estimated geographic position.
    #[must_use]
    pub fn geo(&self) -> Geo {
        self.plane.geo_from_enu(self.estimate.position_m.enu())
    }

    /// Returns the true geographic position.
    #[must_use]
    pub fn true_geo(&self) -> Geo {
        self.plane.geo_from_enu(self.truth.position_m.enu())
    }

    /// Converts a position from the site frame to MAVLink's local frame, whose origin is where the estimator was
    /// initialized.
    #[must_use]
    pub fn local_from_site(&self, site_m: Vec3<Ned>) -> Vec3<LocalNed> {
        // FRAME: both frames have the same axes; only the origins differ.
        Vec3::assume((site_m - self.estimate.local_origin_m).raw())
    }

    /// Converts a position from MAVLink's local frame to the site frame.
    #[must_use]
    pub fn site_from_local(&self, local_m: Vec3<LocalNed>) -> Vec3<Ned> {
        // FRAME: the axes are the same, as above.
        self.estimate.local_origin_m + Vec3::assume(local_m.raw())
    }

    /// Returns the origin of MAVLink's local frame, or `None` before the first fix.
    #[must_use]
    pub fn local_origin(&self) -> Option<Geo> {
        self.estimate.local_origin_set.then(|| self.plane.geo_from_enu(self.estimate.local_origin_m.enu()))
    }

    /// Returns a copy with the current payload state.
    #[must_use]
    pub fn with_payload(&self, payload: &Payload) -> Self {
        Self { gimbal: payload.gimbal, lamp: payload.lamp, camera: payload.camera.summary(self.clock.now), ..*self }
    }

    /// Returns a copy for another kind of link.
    #[must_use]
    pub fn for_link(&self, to: LinkKind) -> Self {
        Self { clock: self.clock.for_link(to), ..*self }
    }

    /// Returns the camera at its current focal length.
    #[must_use]
    pub fn camera_now(&self) -> Camera {
        self.camera.lens(&self.vehicle.camera)
    }

    /// Returns the height above home in meters.
    #[must_use]
    pub fn height_above_home_m(&self) -> f64 {
        let home = self.status.home_m.map_or(0.0, |h| h.down());
        home - self.estimate.position_m.down()
    }
}
