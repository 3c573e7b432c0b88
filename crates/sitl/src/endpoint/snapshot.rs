//! A read-only snapshot of the vehicle at one instant, from which messages are built.

use super::LinkKind;
use super::camera::CaptureMode;
use super::flavour::{Flavour, ModeRow};
use super::gimbal::GimbalState;
use super::lamp::LampState;
use super::payload::Payload;
use crate::autopilot::{AutopilotStatus, Estimate, LandedState, Sticks};
use crate::physics::{Actuators, RigidState, battery};
use crate::sensors::Readings;
use spandrel_mavlink::contract::contact::ContactKind;
use spandrel_model::frames::{Frd, LocalNed, Ned, Rotation, Vec3};
use spandrel_model::geodesy::{Geo, LocalPlane};
use spandrel_model::time::SimTime;
use spandrel_model::vehicle::{Camera, Vehicle};

/// Ground truth, estimate, setpoints and counters at one instant.
#[derive(Debug, Clone, Copy)]
pub struct VehicleSnapshot<'a> {
    /// Simulation time.
    pub now: SimTime,
    /// Simulation time at which the autopilot booted.
    pub autopilot_booted: SimTime,
    /// UTC at simulation start, s since the Unix epoch.
    pub start_unix_s: i64,
    /// The aircraft.
    pub vehicle: &'a Vehicle,
    /// Local tangent plane.
    pub plane: &'a LocalPlane,
    /// State estimate.
    pub estimate: &'a Estimate,
    /// Status of the autopilot.
    pub status: &'a AutopilotStatus,
    /// Latest sensor readings.
    pub readings: &'a Readings,
    /// True state.
    pub truth: &'a RigidState,
    /// Specific force, m/s², body axes.
    pub specific_force_m_s2: Vec3<Frd>,
    /// Battery state.
    pub battery: &'a battery::BatteryState,
    /// Motor commands.
    pub actuators: &'a Actuators,
    /// Wind at the aircraft, m/s.
    pub wind_m_s: Vec3<Ned>,
    /// Counters and ground truth for scoring.
    pub scoring: &'a ScoringTruth,
    /// Stick positions as received; `None` after the timeout.
    pub sticks: Option<Sticks>,
    /// The same as transmitter channels 1 to 4, microseconds.
    pub pulses_us: Option<[u16; 4]>,
    /// Channels 5 to 16, microseconds.
    pub aux_us: [u16; super::manual::AUX],
    /// Kind of link that the message is built for.
    pub link_kind: LinkKind,
    /// Gimbal state.
    pub gimbal: GimbalState,
    /// Lamp state.
    pub lamp: LampState,
    /// Camera state.
    pub camera: CameraSummary,
    /// Plan summary.
    pub plans: PlanSummary,
    /// Autopilot flavour.
    pub flavour: &'static Flavour,
    /// The flavour's number of the last requested mode.
    pub requested_mode: u32,
    /// Whether the geofence is enabled.
    pub fence_enabled: bool,
    /// MAVLink system ID.
    pub system_id: u8,
    /// Times of the current or last flight.
    pub flight: FlightTimes,
}

/// Start and end of a flight, simulation time.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub struct FlightTimes {
    /// Flight number since the start, from 1; 0 before the first flight.
    pub number: u64,
    /// Time of arming.
    pub armed: Option<SimTime>,
    /// Time of takeoff.
    pub took_off: Option<SimTime>,
    /// Time of landing.
    pub landed: Option<SimTime>,
}

impl FlightTimes {
    /// Updates the times from the autopilot's status; `was_armed` is the previous armed state.
    pub fn update(&mut self, was_armed: bool, status: &AutopilotStatus, now: SimTime) {
        if status.armed && !was_armed {
            *self = Self { number: self.number + 1, armed: Some(now), ..Self::default() };
        }
        let grounded = status.landed == LandedState::OnGround;
        if status.armed && !grounded {
            self.took_off.get_or_insert(now);
            self.landed = None;
        } else if grounded && self.took_off.is_some() {
            self.landed.get_or_insert(now);
        }
    }
}

/// Summary of the camera's state.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct CameraSummary {
    /// Whether the camera sends heartbeats as a separate component.
    pub announced: bool,
    /// Number of images in the image log.
    pub pictures: usize,
    /// Interval of a running time-lapse series, s.
    pub interval_s: Option<f64>,
    /// Whether a distance-triggered series is running.
    pub series: bool,
    /// Capture mode.
    pub mode: CaptureMode,
    /// Duration of the running recording.
    pub recording: Option<SimTime>,
    /// Used storage, MiB.
    pub used_mib: f64,
    /// Zoom position, 0 wide to 1 tele.
    pub zoom: f64,
    /// Video bit rate, Mbit/s.
    pub video_mbit_s: u32,
    /// The running video stream.
    pub stream: Option<super::camera::stream::VideoStream>,
}

/// Summary of the stored plans.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub struct PlanSummary {
    /// Number of mission items.
    pub mission_items: u16,
    /// IDs of mission, fence and rally points, by which stations detect changes; 0 for an empty plan.
    pub ids: [u32; 3],
    /// Number of leading items of a transferred mission that are not flown (home).
    pub lead: u16,
}

/// Scoring data besides the motion (docs/src/reference/wire.md, "Scoring data").
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct ScoringTruth {
    /// Kind of contact.
    pub contact: ContactKind,
    /// Number of contacts so far.
    pub hits: i32,
    /// Number of respawns.
    pub respawns: i32,
    /// The last two traffic changes, encoded as on the wire; 0 for never.
    pub traffic: [i32; 2],
    /// The session's seed.
    pub seed: i32,
    /// CRC of the scenario.
    pub scenario_crc: u32,
    /// Distance to the nearest surface from the drone's center, m.
    pub clearance_m: f64,
    /// Ambient light at the drone, lux.
    pub lux: f64,
}

impl VehicleSnapshot<'_> {
    /// Returns the mode as shown to clients.
    #[must_use]
    pub fn mode_row(&self) -> &'static ModeRow {
        self.flavour.row_of(self.status.mode, self.requested_mode)
    }

    /// Converts a time to the autopilot's clock, which restarts with the autopilot. Payload processes receive simulation time, so
    /// that scores use a single clock.
    #[must_use]
    pub fn since_boot(&self, at: SimTime) -> SimTime {
        if self.link_kind == LinkKind::Payload { at } else { at.saturating_sub(self.autopilot_booted) }
    }

    /// Returns the time since the autopilot booted, ms, modulo 2^32 as in MAVLink's field.
    #[must_use]
    pub fn boot_ms(&self) -> u32 {
        self.since_boot(self.now).ms() as u32
    }

    /// Returns the time since the autopilot booted, microseconds.
    #[must_use]
    pub fn boot_us(&self) -> u64 {
        self.since_boot(self.now).us().max(0).cast_unsigned()
    }

    /// Returns the time since simulation start, ms, modulo 2^32: the clock of the camera and the scoring data, unaffected by
    /// autopilot reboots.
    #[must_use]
    pub fn sim_ms(&self) -> u32 {
        self.now.ms() as u32
    }

    /// Returns the time since simulation start, microseconds.
    #[must_use]
    pub fn sim_us(&self) -> u64 {
        self.now.us().max(0).cast_unsigned()
    }

    /// Returns the time since the Unix epoch, microseconds.
    #[must_use]
    pub fn unix_us(&self) -> u64 {
        (self.start_unix_s * 1_000_000 + self.now.us()).max(0).cast_unsigned()
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

    /// Converts a position from the site frame to MAVLink's local frame, which originates where the estimator was initialized.
    #[must_use]
    pub fn local_from_site(&self, site_m: Vec3<Ned>) -> Vec3<LocalNed> {
        // FRAME: both frames have the same axes; only the origins differ.
        Vec3::assume((site_m - self.estimate.local_origin_m).raw())
    }

    /// Converts a position from MAVLink's local frame to the site frame.
    #[must_use]
    pub fn site_from_local(&self, local_m: Vec3<LocalNed>) -> Vec3<Ned> {
        // FRAME: as above.
        self.estimate.local_origin_m + Vec3::assume(local_m.raw())
    }

    /// Returns the origin of MAVLink's local frame; `None` before the first fix.
    #[must_use]
    pub fn local_origin(&self) -> Option<Geo> {
        self.estimate.local_origin_set.then(|| self.plane.geo_from_enu(self.estimate.local_origin_m.enu()))
    }

    /// Returns a copy with the current payload state.
    #[must_use]
    pub fn with_payload(&self, payload: &Payload) -> Self {
        Self { gimbal: payload.gimbal, lamp: payload.lamp, camera: payload.camera.summary(self.now), ..*self }
    }

    /// Returns a copy for another kind of link.
    #[must_use]
    pub fn for_link(&self, to: LinkKind) -> Self {
        Self { link_kind: to, ..*self }
    }

    /// Returns the camera at its current focal length.
    #[must_use]
    pub fn camera_now(&self) -> Camera {
        let camera = &self.vehicle.camera;
        camera.zoomed(1.0 + self.camera.zoom * (camera.zoom_max - 1.0))
    }

    /// Returns the camera's attitude as a quaternion from body to north-east-down, w first. The gimbal keeps roll level and
    /// follows the heading.
    #[must_use]
    pub fn camera_attitude(&self) -> [f64; 4] {
        let looking: Rotation<Frd, Ned> = Rotation::from_euler(0.0, self.gimbal.pitch_rad, self.estimate.attitude.yaw_rad());
        looking.wxyz()
    }

    /// Returns the height above home, m.
    #[must_use]
    pub fn over_home_m(&self) -> f64 {
        let home = self.status.home_m.map_or(0.0, |h| h.down());
        home - self.estimate.position_m.down()
    }
}
