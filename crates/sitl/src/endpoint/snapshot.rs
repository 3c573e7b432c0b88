//! What the endpoint may look at when it speaks: one instant of the vehicle.

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

/// Truth and estimate, set-points and counters at one instant.
#[derive(Debug, Clone, Copy)]
pub struct VehicleSnapshot<'a> {
    /// Simulation time.
    pub now: SimTime,
    /// When the autopilot's software started, simulation time.
    pub autopilot_booted: SimTime,
    /// UTC at simulation start, seconds since the Unix epoch.
    pub start_unix_s: i64,
    /// The aircraft.
    pub vehicle: &'a Vehicle,
    /// Local plane.
    pub plane: &'a LocalPlane,
    /// What the autopilot believes.
    pub estimate: &'a Estimate,
    /// What the autopilot says.
    pub status: &'a AutopilotStatus,
    /// The last of each reading.
    pub readings: &'a Readings,
    /// The truth.
    pub truth: &'a RigidState,
    /// Specific force, m/s², body axes.
    pub specific_force_m_s2: Vec3<Frd>,
    /// Battery.
    pub battery: &'a battery::BatteryState,
    /// Motor commands.
    pub actuators: &'a Actuators,
    /// Wind at the aircraft, m/s.
    pub wind_m_s: Vec3<Ned>,
    /// Counters and truths for the scoring.
    pub scoring: &'a ScoringTruth,
    /// Sticks as received, when they are fresh.
    pub sticks: Option<Sticks>,
    /// The same as channels 1 to 4 of a transmitter, microseconds.
    pub pulses_us: Option<[u16; 4]>,
    /// Channels 5 to 16, microseconds.
    pub aux_us: [u16; super::manual::AUX],
    /// What stands behind the link that is spoken to.
    pub link_kind: LinkKind,
    /// Gimbal.
    pub gimbal: GimbalState,
    /// Lamp.
    pub lamp: LampState,
    /// Camera.
    pub camera: CameraSummary,
    /// Plans.
    pub plans: PlanSummary,
    /// Whose interface is spoken.
    pub flavour: &'static Flavour,
    /// The flavour's number of the mode that was asked for last.
    pub requested_mode: u32,
    /// The geofence is switched on.
    pub fence_enabled: bool,
    /// MAVLink system id.
    pub system_id: u8,
    /// The flight of now, or the last.
    pub flight: FlightTimes,
}

/// When a flight began and ended, simulation time.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub struct FlightTimes {
    /// Which since the start, from 1; 0 before the first.
    pub number: u64,
    /// Motors armed.
    pub armed: Option<SimTime>,
    /// Left the ground.
    pub took_off: Option<SimTime>,
    /// Stood on it again.
    pub landed: Option<SimTime>,
}

impl FlightTimes {
    /// Follows what the autopilot says; `was_armed` is what it said before.
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

/// The camera's counters.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct CameraSummary {
    /// It says heartbeats as a component of its own.
    pub announced: bool,
    /// Pictures in the image log.
    pub pictures: usize,
    /// Seconds between pictures of a running series.
    pub interval_s: Option<f64>,
    /// A series by distance runs.
    pub series: bool,
    /// Mode.
    pub mode: CaptureMode,
    /// How long the running recording has run.
    pub recording: Option<SimTime>,
    /// What is on the card, MiB.
    pub used_mib: f64,
    /// Place in the zoom's range, 0 wide to 1 tele.
    pub zoom: f64,
    /// Rate of recordings, Mbit/s.
    pub video_mbit_s: u32,
    /// The live picture, while it runs.
    pub stream: Option<super::camera::stream::VideoStream>,
}

/// What is kept of plans.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub struct PlanSummary {
    /// Items of the mission.
    pub mission_items: u16,
    /// Ids of mission, fence and rally points, by which stations see whether theirs is the present one; 0 for none.
    pub ids: [u32; 3],
    /// Items of the wire's mission before the first that is flown: home.
    pub lead: u16,
}

/// What the scoring needs beside the motion (docs/src/reference/wire.md, "Scoring data").
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct ScoringTruth {
    /// What is touched.
    pub contact: ContactKind,
    /// Contact onsets so far.
    pub hits: i32,
    /// Times put back.
    pub respawns: i32,
    /// The last two times that traffic was stopped or let go, as the wire says them; 0 for never.
    pub traffic: [i32; 2],
    /// The session's seed.
    pub seed: i32,
    /// CRC of the scenario.
    pub scenario_crc: u32,
    /// Nearest surface to the drone's centre, m.
    pub clearance_m: f64,
    /// Ambient light at the drone, lux.
    pub lux: f64,
}

impl VehicleSnapshot<'_> {
    /// The mode as clients see it.
    #[must_use]
    pub fn mode_row(&self) -> &'static ModeRow {
        self.flavour.row_of(self.status.mode, self.requested_mode)
    }

    /// A time on the autopilot's clock, which starts again with the autopilot. A sidecar gets simulation time: its scores have one clock.
    #[must_use]
    pub fn since_boot(&self, at: SimTime) -> SimTime {
        if self.link_kind == LinkKind::Payload { at } else { at.saturating_sub(self.autopilot_booted) }
    }

    /// Milliseconds since the autopilot's start, modulo 2^32 as MAVLink's field has it.
    #[must_use]
    pub fn boot_ms(&self) -> u32 {
        self.since_boot(self.now).ms() as u32
    }

    /// Microseconds since the autopilot's start.
    #[must_use]
    pub fn boot_us(&self) -> u64 {
        self.since_boot(self.now).us().max(0).cast_unsigned()
    }

    /// Milliseconds since simulation start, modulo 2^32: the clock of the camera and of the scoring's values, which no restart of the autopilot
    /// sets back.
    #[must_use]
    pub fn sim_ms(&self) -> u32 {
        self.now.ms() as u32
    }

    /// Microseconds since simulation start.
    #[must_use]
    pub fn sim_us(&self) -> u64 {
        self.now.us().max(0).cast_unsigned()
    }

    /// Microseconds since the Unix epoch.
    #[must_use]
    pub fn unix_us(&self) -> u64 {
        (self.start_unix_s * 1_000_000 + self.now.us()).max(0).cast_unsigned()
    }

    /// Estimated geographic position.
    #[must_use]
    pub fn geo(&self) -> Geo {
        self.plane.geo_from_enu(self.estimate.position_m.enu())
    }

    /// True geographic position.
    #[must_use]
    pub fn true_geo(&self) -> Geo {
        self.plane.geo_from_enu(self.truth.position_m.enu())
    }

    /// A position of the site frame in MAVLink's local frame, whose origin is where the estimator was initialized.
    #[must_use]
    pub fn local_from_site(&self, site_m: Vec3<Ned>) -> Vec3<LocalNed> {
        // FRAME: both frames have the same axes; only the origins differ.
        Vec3::assume((site_m - self.estimate.local_origin_m).raw())
    }

    /// A position of MAVLink's local frame in the site frame.
    #[must_use]
    pub fn site_from_local(&self, local_m: Vec3<LocalNed>) -> Vec3<Ned> {
        // FRAME: as above.
        self.estimate.local_origin_m + Vec3::assume(local_m.raw())
    }

    /// Where MAVLink's local frame has its origin; `None` before the first fixes.
    #[must_use]
    pub fn local_origin(&self) -> Option<Geo> {
        self.estimate.local_origin_set.then(|| self.plane.geo_from_enu(self.estimate.local_origin_m.enu()))
    }

    /// The same instant with the payload as it is now.
    #[must_use]
    pub fn with_payload(&self, payload: &Payload) -> Self {
        Self { gimbal: payload.gimbal, lamp: payload.lamp, camera: payload.camera.summary(self.now), ..*self }
    }

    /// The same instant for another kind of link.
    #[must_use]
    pub fn for_link(&self, to: LinkKind) -> Self {
        Self { link_kind: to, ..*self }
    }

    /// The camera at its present focal length.
    #[must_use]
    pub fn camera_now(&self) -> Camera {
        let camera = &self.vehicle.camera;
        camera.zoomed(1.0 + self.camera.zoom * (camera.zoom_max - 1.0))
    }

    /// Where the camera looks, body to north-east-down, w first: the gimbal keeps roll level and follows the heading.
    #[must_use]
    pub fn camera_attitude(&self) -> [f64; 4] {
        let looking: Rotation<Frd, Ned> = Rotation::from_euler(0.0, self.gimbal.pitch_rad, self.estimate.attitude.yaw_rad());
        looking.wxyz()
    }

    /// Height over home, m.
    #[must_use]
    pub fn over_home_m(&self) -> f64 {
        let home = self.status.home_m.map_or(0.0, |h| h.down());
        home - self.estimate.position_m.down()
    }
}
