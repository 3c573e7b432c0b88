//! The autopilot as one object: what the outside calls, and one control step.

use super::attitude::{AttitudeLoop, within_limits};
use super::estimator::Estimator;
use super::fence::{Fence, FenceState, Refuge};
use super::follow::Follower;
use super::gains::Gains;
use super::landed::GroundContact;
use super::link::Links;
use super::mission::{Mission, Unnamed};
use super::mixer::{Demand, Given, Mixer};
use super::modes::{Course, Wanted};
use super::operator_rules::{Envelope, JOB_BATTERY};
use super::orbit::Orbit;
use super::senses::{Health, Senses, SensorChange};
use super::shaper::Shaper;
use super::smart_return::Trail;
use super::supervise::Watch;
use super::trajectory::Trajectory;
use super::velocity::{Motion, Pull, VelocityLoop};
use super::{Estimate, Landed, MissionStep, Mode, OffboardSetpoint, Status, Sticks, Tuning};
use crate::physics::Actuators;
use crate::sensors::{BatteryReading, Readings};
use spandrel_model::frames::{Frd, Ned, Rotation, Vec3};
use spandrel_model::geodesy::Geo;
use spandrel_model::scenario::{BatteryModel, Rules};
use spandrel_model::time::SimTime;
use spandrel_model::vehicle::{FlightLimits, Vehicle};

/// Rate of the control loops, Hz.
pub const CONTROL_HZ: f64 = 400.0;
/// Thrust comes up within this time at take-off, s.
const SPOOL_UP_S: f64 = 0.6;
/// Lowest voltage share that the mixer makes up for.
const VOLTAGE_SHARE_MIN: f64 = 0.6;

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

impl Severity {
    /// The number of syslog and MAVLink.
    #[must_use]
    pub fn number(self) -> u8 {
        match self {
            Self::Critical => 2,
            Self::Warning => 4,
            Self::Info => 6,
        }
    }
}

/// Something that people should read.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Event {
    /// Gravity.
    pub severity: Severity,
    /// Words.
    pub text: String,
    /// The sensor's change that the words announce; a flavour has words of its own for it.
    pub sensor: Option<SensorChange>,
}

/// What the autopilot knows of its aircraft beyond the gains.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Airframe {
    pub mass_kg: f64,
    pub limits: FlightLimits,
    pub full_v: f64,
    /// The voltage's sag reaches the motors.
    pub sags: bool,
    /// Height of the centre over the ground when standing, m.
    pub standing_m: f64,
}

/// The latest of the sensors that are not fused.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub(super) struct Seen {
    pub battery: Option<BatteryReading>,
    pub range_down_m: Option<f64>,
    pub range_up_m: Option<f64>,
}

/// The built-in autopilot: plain data, so that a clone is a snapshot.
#[derive(Debug, Clone)]
pub struct Autopilot {
    /// What an operator may change; write freely between steps.
    pub tuning: Tuning,
    pub(super) gains: Gains,
    pub(super) airframe: Airframe,
    pub(super) estimator: Estimator,
    pub(super) estimate: Estimate,
    pub(super) velocity_loop: VelocityLoop,
    pub(super) attitude_loop: AttitudeLoop,
    pub(super) mixer: Mixer,
    pub(super) given: Given,
    pub(super) shaper: Shaper,
    pub(super) course: Course,
    pub(super) mission: Mission,
    /// The planned way through the mission's waypoints, while one is flown.
    pub(super) way: Option<Trajectory>,
    pub(super) fence: Fence,
    pub(super) orbit: Option<Orbit>,
    /// The path flown since take-off.
    pub(super) trail: Trail,
    /// The target that is followed.
    pub(super) follower: Follower,
    /// Automatic modes turn towards this place, m.
    pub(super) look_at_m: Option<Vec3<Ned>>,
    /// Cruise speed of a command, for this flight, m/s.
    pub(super) commanded_m_s: Option<f64>,
    /// Home was put where it is by a command: arming leaves it there.
    pub(super) home_is_set: bool,
    /// Places to return to beside home.
    pub(super) refuges: Vec<Refuge>,
    pub(super) links: Links,
    pub(super) seen: Seen,
    pub(super) senses: Senses,
    pub(super) watch: Watch,
    pub(super) contact: GroundContact,
    pub(super) status: Status,
    pub(super) events: Vec<Event>,
    pub(super) last_step: SimTime,
}

impl Autopilot {
    /// Boots on the ground. `origin` is where the local frame lies (for the magnetic model).
    #[must_use]
    pub fn new(vehicle: &Vehicle, rules: &Rules, origin: Geo, mut tuning: Tuning) -> Self {
        if rules.low_battery_return {
            tuning.rules.responses.battery = JOB_BATTERY;
        }
        let gains = Gains::new(vehicle);
        let battery = &vehicle.battery;
        let standing_m = vehicle.hull.feet_m.iter().map(|f| f.down()).fold(vehicle.hull.body_half_extent_m[2], f64::max);
        let estimator = Estimator::new(&vehicle.sensors, origin);
        Self {
            tuning,
            gains,
            airframe: Airframe {
                mass_kg: vehicle.mass_kg,
                limits: vehicle.limits,
                full_v: f64::from(battery.cells) * battery.ocv_cell_v[10],
                sags: rules.battery == BatteryModel::Physical,
                standing_m,
            },
            estimate: estimator.estimate(),
            estimator,
            velocity_loop: VelocityLoop::default(),
            attitude_loop: AttitudeLoop::default(),
            mixer: Mixer::new(vehicle, gains.lead),
            given: Given { tilt: 1.0, yaw: 1.0 },
            shaper: Shaper::default(),
            course: Course::default(),
            mission: Mission::default(),
            way: None,
            fence: Fence::default(),
            orbit: None,
            trail: Trail::default(),
            follower: Follower::default(),
            look_at_m: None,
            commanded_m_s: None,
            home_is_set: false,
            refuges: Vec::new(),
            links: Links::default(),
            seen: Seen::default(),
            senses: Senses::new(&vehicle.sensors),
            watch: Watch::default(),
            contact: GroundContact::default(),
            status: boot_status(),
            events: Vec::new(),
            last_step: SimTime::ZERO,
        }
    }

    /// The tuning that goes with a job's rules: battery thresholds come from there.
    #[must_use]
    pub fn tuning_for(rules: &Rules) -> Tuning {
        Tuning { battery_low_pct: rules.low_battery_pct, battery_critical_pct: rules.critical_battery_pct, ..Tuning::default() }
    }

    /// Armed with no sticks coming in.
    #[must_use]
    pub fn is_unattended(&self, now: SimTime) -> bool {
        self.status.armed && !self.links.sticks_fresh(self.tuning.manual_patience_s(), now)
    }

    /// The pilot's sticks, as often as they come. Values beyond [-1, 1] are limited, not-a-numbers are centred.
    pub fn sticks(&mut self, sticks: Sticks, now: SimTime) {
        self.links.take_sticks(sticks, self.tuning.stick_deadband, now);
        self.take_over(now);
    }

    /// Whether the sticks come in the mode that flies errands: there the yaw stick turns the nose and takes nothing over.
    pub fn note_errands(&mut self, flown: bool) {
        self.links.guided = flown;
    }

    /// The sticks were let go of on purpose: that is no loss.
    pub fn let_go_of_sticks(&mut self) {
        self.watch.sticks_seen = false;
        if !self.watch.intended.is_manual() {
            self.links.sticks_at = None;
        }
    }

    /// The limits of the airframe itself, where the parameters leave them alone.
    #[must_use]
    pub fn airframe_envelope(&self) -> Envelope {
        let (limits, automatic) = (&self.airframe.limits, self.airframe_auto_limits());
        Envelope {
            manual_m_s: limits.forward_m_s,
            manual_up_m_s: limits.climb_m_s,
            manual_down_m_s: limits.descend_m_s,
            manual_yaw_rad_s: limits.yaw_rate_rad_s,
            manual_tilt_rad: self.gains.tilt_rad,
            acceleration_m_s2: automatic.horizontal_m_s2,
            climb_acceleration_m_s2: automatic.vertical_m_s2,
            landing_m_s: limits.descend_m_s,
        }
    }

    /// An external set-point.
    pub fn offboard(&mut self, setpoint: OffboardSetpoint, now: SimTime) {
        self.links.offboard = Some((setpoint, now));
        self.course.turned_by_pilot = false;
    }

    /// A ground station's heartbeat has come.
    pub fn ground_station_alive(&mut self, now: SimTime) {
        self.links.ground_station = Some(now);
    }

    /// Replaces the mission; the first item becomes current.
    pub fn set_mission(&mut self, steps: Vec<MissionStep>) {
        self.mission = Mission::new(steps);
        self.look_at_m = None;
        self.status.mission_current = 0;
        self.status.mission_finished = false;
        self.status.mission_paused = false;
        if self.status.mode == Mode::Mission {
            self.enter(Mode::Hold, self.last_step);
            self.watch.intended = Mode::Hold;
        }
    }

    /// Replaces the rally points: a return goes to the nearest of them and home.
    pub fn set_refuges(&mut self, refuges: Vec<Refuge>) {
        self.refuges = refuges;
    }

    /// Names the mission's steps whose heights count from home; given right after the mission, with the home of that moment in them.
    pub fn hang_mission_on_home(&mut self, over_home: Vec<bool>) {
        self.mission.hang_on_home(over_home);
    }

    /// Names what steps of the mission take from where the vehicle is when they begin; given right after the mission.
    pub fn leave_mission_open(&mut self, unnamed: Vec<Unnamed>) {
        self.mission.leave_open(unnamed);
    }

    /// Jumps to a mission item, with `anew` as if nothing had been flown before it; false when there is none.
    pub fn set_mission_current(&mut self, index: usize, anew: bool) -> bool {
        let known = self.mission.jump(index);
        if known {
            if anew {
                self.mission.forget();
            }
            self.status.mission_current = index;
            self.status.mission_finished = false;
            self.status.mission_paused = false;
        }
        known
    }

    /// One step at the control rate (400 Hz), with what the sensors gave since the last.
    pub fn step(&mut self, readings: &Readings, now: SimTime) -> Actuators {
        let dt_s = (now - self.last_step).s().clamp(0.0, 0.05);
        self.last_step = now;
        self.estimator.no_aid_s = self.tuning.rules.no_aid_s;
        self.estimator.wanted_reference = self.tuning.rules.height_reference;
        let readings = &self.senses.screen(readings, now);
        self.estimator.set_parked(!self.status.armed);
        self.estimator.step(readings, now);
        self.estimate = self.estimator.estimate();
        self.follow_place_step();
        self.see(readings);
        self.watch_sensors(now);
        self.supervise(now);
        self.status.intended = self.watch.intended;
        let t = &self.tuning;
        (self.status.battery_low_pct, self.status.battery_critical_pct) = (t.battery_low_pct, t.battery_critical_pct);
        if !self.status.armed {
            self.status.thrust = 0.0;
            self.status.attitude_target = self.estimate.attitude;
            return self.mixer.stop();
        }
        self.watch_ground(now, dt_s);
        if !self.status.armed {
            return self.mixer.stop();
        }
        self.record_trail();
        let wanted = self.wanted(now, dt_s);
        self.drive(wanted, now, dt_s)
    }

    fn see(&mut self, readings: &Readings) {
        let seen = &mut self.seen;
        seen.battery = readings.battery.or(seen.battery);
        seen.range_down_m = readings.range_down_m.or(seen.range_down_m);
        seen.range_up_m = readings.range_up_m.or(seen.range_up_m);
    }

    fn drive(&mut self, wanted: Wanted, now: SimTime, dt_s: f64) -> Actuators {
        let pull = match wanted {
            Wanted::Rest => {
                self.status.thrust = 0.0;
                self.status.attitude_target = self.estimate.attitude;
                return self.mixer.idle(dt_s);
            }
            Wanted::Fly(motion) => {
                self.contact.wanted_down_m_s = motion.velocity_m_s.down();
                self.velocity_loop.fly(&self.gains, self.airframe.mass_kg, &self.estimate, &motion, dt_s)
            }
            Wanted::Level { motion, tilt } => {
                self.contact.wanted_down_m_s = motion.velocity_m_s.down();
                self.level(&motion, tilt, dt_s)
            }
            Wanted::Direct(pull) => pull,
            Wanted::Spin { rates_rad_s, thrust_n } => return self.spin_rotors(rates_rad_s, thrust_n, now, dt_s),
        };
        self.turn_rotors(&pull, now, dt_s)
    }

    fn level(&mut self, motion: &Motion, tilt: (f64, f64), dt_s: f64) -> Pull {
        self.velocity_loop.reset_horizontal();
        self.velocity_loop.fly_level(&self.gains, self.airframe.mass_kg, &self.estimate, motion, tilt, dt_s)
    }

    fn turn_rotors(&mut self, pull: &Pull, now: SimTime, dt_s: f64) -> Actuators {
        let thrust_n = self.eased(pull.thrust_n, now);
        self.status.attitude_target = pull.attitude;
        self.watch.aim_cosine = alignment(self.estimate.attitude, pull.attitude);
        let (g, feed) = (&self.gains, self.course.yaw_rate_rad_s + self.course.yaw_brake_rad_s);
        let torque_n_m = self.attitude_loop.torque(g, &self.estimate, pull.attitude, feed, self.given, dt_s);
        self.mix(&Demand { torque_n_m, thrust_n }, dt_s)
    }

    fn spin_rotors(&mut self, rates_rad_s: Vec3<Frd>, thrust_n: f64, now: SimTime, dt_s: f64) -> Actuators {
        let thrust_n = self.eased(thrust_n, now);
        self.status.attitude_target = self.estimate.attitude;
        self.watch.aim_cosine = 1.0;
        let rates = within_limits(&self.gains, rates_rad_s);
        let torque_n_m = self.attitude_loop.rate_torque(&self.gains, &self.estimate, rates, self.given, dt_s);
        self.mix(&Demand { torque_n_m, thrust_n }, dt_s)
    }

    /// Thrust comes up at take-off and fades out on the ground.
    fn eased(&mut self, thrust_n: f64, now: SimTime) -> f64 {
        let spool = ((now - self.course.left_ground).s() / SPOOL_UP_S).clamp(0.0, 1.0);
        let thrust_n = thrust_n.min(self.gains.thrust_max_n * spool) * self.contact.thrust_share();
        self.status.thrust = thrust_n / self.gains.thrust_max_n;
        thrust_n
    }

    fn mix(&mut self, demand: &Demand, dt_s: f64) -> Actuators {
        let (actuators, given) = self.mixer.mix(demand, self.voltage_share(), dt_s);
        self.given = given;
        actuators
    }

    fn voltage_share(&self) -> f64 {
        match self.seen.battery {
            Some(b) if self.airframe.sags => (b.voltage_v / self.airframe.full_v).clamp(VOLTAGE_SHARE_MIN, 1.0),
            _ => 1.0,
        }
    }

    /// The vehicle was put back in the air by hand: estimator and controllers start there, armed, and hold. The mode stays the pilot's
    /// where he has one, else Hold.
    pub fn respawn(&mut self, position_m: Vec3<Ned>, velocity_m_s: Vec3<Ned>, attitude: Rotation<Frd, Ned>, now: SimTime) {
        self.estimator.reinitialise(position_m, velocity_m_s, attitude, now);
        self.estimate = self.estimator.estimate();
        self.status.armed = true;
        self.status.landed = Landed::InAir;
        self.contact = GroundContact::default();
        self.watch.upset_since = None;
        // It is in the air: its next landing is one.
        self.watch.flown = true;
        self.status.health.obeys = true;
        self.trail.cut_back_to(position_m);
        let mode = if self.watch.intended.is_manual() { self.watch.intended } else { Mode::Hold };
        self.reset_loops();
        self.course.left_ground = now - SimTime::from_s(SPOOL_UP_S);
        self.watch.intended = mode;
        self.enter(mode, now);
        self.say(Severity::Warning, "Put back at the last safe hover");
    }

    pub(super) fn reset_loops(&mut self) {
        self.velocity_loop.reset();
        self.attitude_loop.reset();
        self.shaper.start(self.estimate.velocity_m_s);
        self.given = Given { tilt: 1.0, yaw: 1.0 };
    }

    pub(super) fn say(&mut self, severity: Severity, text: impl Into<String>) {
        self.events.push(Event { severity, text: text.into(), sensor: None });
    }

    /// What the estimator believes.
    #[must_use]
    pub fn estimate(&self) -> &Estimate {
        &self.estimate
    }

    /// The filter itself, for covariance and bias telemetry.
    #[must_use]
    pub fn estimator(&self) -> &Estimator {
        &self.estimator
    }

    /// When it last stepped.
    #[must_use]
    pub fn now(&self) -> SimTime {
        self.last_step
    }

    /// Speed of missions, returns and go-to: a command's, else the parameter's, m/s.
    pub(super) fn cruise_m_s(&self) -> f64 {
        self.commanded_m_s.unwrap_or(self.tuning.cruise_m_s).min(self.tuning.horizontal_speed_max_m_s)
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

    /// Mission items reached since the last call, in order, for MISSION_ITEM_REACHED and for payload steps.
    pub fn drain_reached(&mut self) -> Vec<usize> {
        self.status.mission_reached = None;
        std::mem::take(&mut self.mission.reached)
    }
}

fn boot_status() -> Status {
    Status {
        armed: false,
        mode: Mode::Position,
        intended: Mode::Position,
        battery_low_pct: 0.0,
        battery_critical_pct: 0.0,
        landed: Landed::OnGround,
        climbing_out: false,
        arming_reasons: vec!["Booting".into()],
        failsafe: None,
        home_m: None,
        target_m: None,
        setpoint: None,
        attitude_target: Rotation::identity(),
        thrust: 0.0,
        mission_current: 0,
        mission_reached: None,
        mission_finished: false,
        mission_paused: false,
        fence: FenceState::default(),
        orbit: None,
        position_resets: 0,
        health: Health::GOOD,
    }
}

/// Cosine of the angle between two attitudes' thrust directions.
fn alignment(a: Rotation<Frd, Ned>, b: Rotation<Frd, Ned>) -> f64 {
    let z = Vec3::<Frd>::new(0.0, 0.0, 1.0);
    (a * z).dot(b * z)
}
