//! The autopilot object: its public interface and the control step.

use super::attitude::{AttitudeLoop, within_limits};
use super::estimator::Estimator;
use super::failsafe::FailsafeState;
use super::fence::{Fence, FenceState, RallyPoint};
use super::follow::Follower;
use super::gains::Gains;
use super::landed::LandingDetector;
use super::link_status::LinkStatus;
use super::mission::{DeferredFields, Mission};
use super::mixer::{AllocationStatus, Mixer, TorqueThrustSetpoint};
use super::modes::{NavigatorState, Setpoint};
use super::operator_rules::{FlightEnvelope, JOB_BATTERY};
use super::orbit::Orbit;
use super::sensor_health::{SensorChange, SensorHealth, SensorStatus};
use super::shaper::MotionShaper;
use super::smart_return::FlownPath;
use super::trajectory::Trajectory;
use super::velocity::{AttitudeThrustSetpoint, VelocityLoop, VelocitySetpoint};
use super::{AutopilotStatus, Estimate, FlightMode, LandedState, MissionStep, OffboardSetpoint, Sticks, Tuning};
use crate::physics::Actuators;
use crate::sensors::{BatteryReading, Readings};
use spandrel_model::frames::{Frd, Ned, Rotation, Vec3};
use spandrel_model::geodesy::Geo;
use spandrel_model::scenario::{BatteryModel, SessionRules};
use spandrel_model::time::SimTime;
use spandrel_model::vehicle::{FlightLimits, Vehicle};

/// Rate of the control loops, Hz.
pub const CONTROL_HZ: f64 = 400.0;
/// Thrust ramp time at take-off, s.
const SPOOL_UP_S: f64 = 0.6;
/// Minimum voltage fraction that the mixer compensates for.
const VOLTAGE_SHARE_MIN: f64 = 0.6;

/// Severity of an event.
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
    /// Returns the severity number of syslog and MAVLink.
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
    /// The sensor change that caused the event. Emulated autopilots can use their own text for it.
    pub sensor: Option<SensorChange>,
}

/// Properties of the aircraft other than the gains.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Airframe {
    pub mass_kg: f64,
    pub limits: FlightLimits,
    pub full_v: f64,
    /// Whether voltage sag affects the motors.
    pub voltage_sags: bool,
    /// Height of the center of mass above ground on the landing gear, m.
    pub standing_m: f64,
}

/// Latest readings of the sensors that are not fused.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub(super) struct UnfusedReadings {
    pub battery: Option<BatteryReading>,
    pub range_down_m: Option<f64>,
    pub range_up_m: Option<f64>,
}

/// The built-in autopilot. Plain data, so a clone is a snapshot.
#[derive(Debug, Clone)]
pub struct Autopilot {
    /// Settings of the operator. They can be changed between any two steps.
    pub tuning: Tuning,
    pub(super) gains: Gains,
    pub(super) airframe: Airframe,
    pub(super) estimator: Estimator,
    pub(super) estimate: Estimate,
    pub(super) velocity_loop: VelocityLoop,
    pub(super) attitude_loop: AttitudeLoop,
    pub(super) mixer: Mixer,
    pub(super) allocation: AllocationStatus,
    pub(super) shaper: MotionShaper,
    pub(super) navigator: NavigatorState,
    pub(super) mission: Mission,
    /// Trajectory through the mission's waypoints, while one is active.
    pub(super) trajectory: Option<Trajectory>,
    pub(super) fence: Fence,
    pub(super) orbit: Option<Orbit>,
    /// The path recorded since take-off.
    pub(super) flown_path: FlownPath,
    /// Follow mode target and state.
    pub(super) follower: Follower,
    /// Position at which automatic modes point the nose, m.
    pub(super) look_at_m: Option<Vec3<Ned>>,
    /// Commanded cruise speed for this flight, m/s.
    pub(super) commanded_m_s: Option<f64>,
    /// Whether a command set home. Arming then keeps it.
    pub(super) home_is_set: bool,
    /// Rally points to return to in addition to home.
    pub(super) rally_points: Vec<RallyPoint>,
    pub(super) links: LinkStatus,
    pub(super) unfused: UnfusedReadings,
    pub(super) sensor_health: SensorHealth,
    pub(super) failsafe: FailsafeState,
    pub(super) landing_detector: LandingDetector,
    pub(super) status: AutopilotStatus,
    pub(super) events: Vec<AutopilotEvent>,
    pub(super) last_step: SimTime,
}

impl Autopilot {
    /// Starts the autopilot on the ground. `origin` is the origin of the local frame, used for the magnetic model.
    #[must_use]
    pub fn new(vehicle: &Vehicle, rules: &SessionRules, origin: Geo, mut tuning: Tuning) -> Self {
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
                voltage_sags: rules.battery == BatteryModel::Physical,
                standing_m,
            },
            estimate: estimator.estimate(),
            estimator,
            velocity_loop: VelocityLoop::default(),
            attitude_loop: AttitudeLoop::default(),
            mixer: Mixer::new(vehicle, gains.lead),
            allocation: AllocationStatus { tilt: 1.0, yaw: 1.0 },
            shaper: MotionShaper::default(),
            navigator: NavigatorState::default(),
            mission: Mission::default(),
            trajectory: None,
            fence: Fence::default(),
            orbit: None,
            flown_path: FlownPath::default(),
            follower: Follower::default(),
            look_at_m: None,
            commanded_m_s: None,
            home_is_set: false,
            rally_points: Vec::new(),
            links: LinkStatus::default(),
            unfused: UnfusedReadings::default(),
            sensor_health: SensorHealth::new(&vehicle.sensors),
            failsafe: FailsafeState::default(),
            landing_detector: LandingDetector::default(),
            status: boot_status(),
            events: Vec::new(),
            last_step: SimTime::ZERO,
        }
    }

    /// Returns the settings for the rules of a scenario, which define the battery thresholds.
    #[must_use]
    pub fn tuning_for(rules: &SessionRules) -> Tuning {
        Tuning { battery_low_pct: rules.low_battery_pct, battery_critical_pct: rules.critical_battery_pct, ..Tuning::default() }
    }

    /// Returns true if the vehicle is armed and receives no stick input.
    #[must_use]
    pub fn is_unattended(&self, now: SimTime) -> bool {
        self.status.armed && !self.links.sticks_fresh(self.tuning.manual_timeout_s(), now)
    }

    /// Processes the pilot's stick input. Values are clamped to -1 to 1; NaN is treated as centered.
    pub fn sticks(&mut self, sticks: Sticks, now: SimTime) {
        self.links.take_sticks(sticks, self.tuning.stick_deadband, now);
        self.check_stick_takeover(now);
    }

    /// Sets whether stick input arrives in guided mode, where the yaw stick turns the nose and does not take over.
    pub fn note_errands(&mut self, flown: bool) {
        self.links.guided = flown;
    }

    /// Handles an intentional release of the sticks, which does not trigger a failsafe.
    pub fn release_sticks(&mut self) {
        self.failsafe.sticks_seen = false;
        if !self.failsafe.intended.is_manual() {
            self.links.sticks_at = None;
        }
    }

    /// The limits of the airframe without parameter overrides.
    #[must_use]
    pub fn airframe_envelope(&self) -> FlightEnvelope {
        let (limits, automatic) = (&self.airframe.limits, self.airframe_auto_limits());
        FlightEnvelope {
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

    /// Processes an external setpoint.
    pub fn offboard(&mut self, setpoint: OffboardSetpoint, now: SimTime) {
        self.links.offboard = Some((setpoint, now));
        self.navigator.turned_by_pilot = false;
    }

    /// Records a heartbeat from a ground station.
    pub fn ground_station_alive(&mut self, now: SimTime) {
        self.links.ground_station = Some(now);
    }

    /// Replaces the mission. The first item becomes current.
    pub fn set_mission(&mut self, steps: Vec<MissionStep>) {
        self.mission = Mission::new(steps);
        self.look_at_m = None;
        self.status.mission_current = 0;
        self.status.mission_finished = false;
        self.status.mission_paused = false;
        if self.status.mode == FlightMode::Mission {
            self.enter(FlightMode::Hold, self.last_step);
            self.failsafe.intended = FlightMode::Hold;
        }
    }

    /// Replaces the rally points. A return uses the nearest one or home.
    pub fn set_rally_points(&mut self, refuges: Vec<RallyPoint>) {
        self.rally_points = refuges;
    }

    /// Marks the mission items whose heights are relative to home. Call immediately after the mission is set, with heights
    /// computed from home at that time.
    pub fn set_home_relative_steps(&mut self, over_home: Vec<bool>) {
        self.mission.set_home_relative(over_home);
    }

    /// Sets the fields that mission items take from the vehicle position when they start. Call immediately after the mission is
    /// set.
    pub fn set_deferred_fields(&mut self, unnamed: Vec<DeferredFields>) {
        self.mission.set_deferred(unnamed);
    }

    /// Jumps to a mission item. With `anew`, resets the mission's progress. Returns false if the item does not exist.
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

    /// Runs one control step (400 Hz) with the readings since the last step.
    pub fn step(&mut self, readings: &Readings, now: SimTime) -> Actuators {
        let dt_s = (now - self.last_step).s().clamp(0.0, 0.05);
        self.last_step = now;
        self.estimator.no_aid_s = self.tuning.rules.no_aid_s;
        self.estimator.wanted_reference = self.tuning.rules.height_reference;
        let readings = &self.sensor_health.filter(readings, now);
        self.estimator.set_parked(!self.status.armed);
        self.estimator.step(readings, now);
        self.estimate = self.estimator.estimate();
        self.follow_place_step();
        self.store_unfused(readings);
        self.check_sensors(now);
        self.run_failsafes(now);
        self.status.intended = self.failsafe.intended;
        let t = &self.tuning;
        (self.status.battery_low_pct, self.status.battery_critical_pct) = (t.battery_low_pct, t.battery_critical_pct);
        if !self.status.armed {
            self.status.thrust = 0.0;
            self.status.attitude_target = self.estimate.attitude;
            return self.mixer.stop();
        }
        self.update_landed_state(now, dt_s);
        if !self.status.armed {
            return self.mixer.stop();
        }
        self.record_path();
        let wanted = self.setpoint(now, dt_s);
        self.track_setpoint(wanted, now, dt_s)
    }

    fn store_unfused(&mut self, readings: &Readings) {
        let seen = &mut self.unfused;
        seen.battery = readings.battery.or(seen.battery);
        seen.range_down_m = readings.range_down_m.or(seen.range_down_m);
        seen.range_up_m = readings.range_up_m.or(seen.range_up_m);
    }

    fn track_setpoint(&mut self, wanted: Setpoint, now: SimTime, dt_s: f64) -> Actuators {
        let pull = match wanted {
            Setpoint::Idle => {
                self.status.thrust = 0.0;
                self.status.attitude_target = self.estimate.attitude;
                return self.mixer.idle(dt_s);
            }
            Setpoint::Velocity(motion) => {
                self.landing_detector.wanted_down_m_s = motion.velocity_m_s.down();
                self.velocity_loop.fly(&self.gains, self.airframe.mass_kg, &self.estimate, &motion, dt_s)
            }
            Setpoint::Level { motion, tilt } => {
                self.landing_detector.wanted_down_m_s = motion.velocity_m_s.down();
                self.hold_tilt(&motion, tilt, dt_s)
            }
            Setpoint::AttitudeThrust(pull) => pull,
            Setpoint::Spin { rates_rad_s, thrust_n } => return self.run_rate_loop(rates_rad_s, thrust_n, now, dt_s),
        };
        self.run_attitude_loop(&pull, now, dt_s)
    }

    fn hold_tilt(&mut self, motion: &VelocitySetpoint, tilt: (f64, f64), dt_s: f64) -> AttitudeThrustSetpoint {
        self.velocity_loop.reset_horizontal();
        self.velocity_loop.fly_level(&self.gains, self.airframe.mass_kg, &self.estimate, motion, tilt, dt_s)
    }

    fn run_attitude_loop(&mut self, pull: &AttitudeThrustSetpoint, now: SimTime, dt_s: f64) -> Actuators {
        let thrust_n = self.ramp_thrust(pull.thrust_n, now);
        self.status.attitude_target = pull.attitude;
        self.failsafe.attitude_error_cosine = thrust_cosine(self.estimate.attitude, pull.attitude);
        let (g, feed) = (&self.gains, self.navigator.yaw_rate_rad_s + self.navigator.yaw_brake_rad_s);
        let torque_n_m = self.attitude_loop.torque(g, &self.estimate, pull.attitude, feed, self.allocation, dt_s);
        self.mix(&TorqueThrustSetpoint { torque_n_m, thrust_n }, dt_s)
    }

    fn run_rate_loop(&mut self, rates_rad_s: Vec3<Frd>, thrust_n: f64, now: SimTime, dt_s: f64) -> Actuators {
        let thrust_n = self.ramp_thrust(thrust_n, now);
        self.status.attitude_target = self.estimate.attitude;
        self.failsafe.attitude_error_cosine = 1.0;
        let rates = within_limits(&self.gains, rates_rad_s);
        let torque_n_m = self.attitude_loop.rate_torque(&self.gains, &self.estimate, rates, self.allocation, dt_s);
        self.mix(&TorqueThrustSetpoint { torque_n_m, thrust_n }, dt_s)
    }

    /// Ramps the thrust up at take-off and down after touchdown.
    fn ramp_thrust(&mut self, thrust_n: f64, now: SimTime) -> f64 {
        let spool = ((now - self.navigator.left_ground).s() / SPOOL_UP_S).clamp(0.0, 1.0);
        let thrust_n = thrust_n.min(self.gains.thrust_max_n * spool) * self.landing_detector.thrust_share();
        self.status.thrust = thrust_n / self.gains.thrust_max_n;
        thrust_n
    }

    fn mix(&mut self, demand: &TorqueThrustSetpoint, dt_s: f64) -> Actuators {
        let (actuators, given) = self.mixer.mix(demand, self.voltage_share(), dt_s);
        self.allocation = given;
        actuators
    }

    fn voltage_share(&self) -> f64 {
        match self.unfused.battery {
            Some(b) if self.airframe.voltage_sags => (b.voltage_v / self.airframe.full_v).clamp(VOLTAGE_SHARE_MIN, 1.0),
            _ => 1.0,
        }
    }

    /// Continues after a respawn in the air: resets estimator and controllers to this state, armed. A manual mode is kept;
    /// otherwise the mode is Hold.
    pub fn respawn(&mut self, position_m: Vec3<Ned>, velocity_m_s: Vec3<Ned>, attitude: Rotation<Frd, Ned>, now: SimTime) {
        self.estimator.reinitialise(position_m, velocity_m_s, attitude, now);
        self.estimate = self.estimator.estimate();
        self.status.armed = true;
        self.status.landed = LandedState::InAir;
        self.landing_detector = LandingDetector::default();
        self.failsafe.upset_since = None;
        // The vehicle is in the air, so its next landing counts.
        self.failsafe.flown = true;
        self.status.health.tracks_attitude = true;
        self.flown_path.truncate_to(position_m);
        let mode = if self.failsafe.intended.is_manual() { self.failsafe.intended } else { FlightMode::Hold };
        self.reset_loops();
        self.navigator.left_ground = now - SimTime::from_s(SPOOL_UP_S);
        self.failsafe.intended = mode;
        self.enter(mode, now);
        self.push_event(Severity::Warning, "Respawned at last safe hover");
    }

    pub(super) fn reset_loops(&mut self) {
        self.velocity_loop.reset();
        self.attitude_loop.reset();
        self.shaper.start(self.estimate.velocity_m_s);
        self.allocation = AllocationStatus { tilt: 1.0, yaw: 1.0 };
    }

    pub(super) fn push_event(&mut self, severity: Severity, text: impl Into<String>) {
        self.events.push(AutopilotEvent { severity, text: text.into(), sensor: None });
    }

    /// Returns the current estimate.
    #[must_use]
    pub fn estimate(&self) -> &Estimate {
        &self.estimate
    }

    /// Returns the estimator, for covariance and bias telemetry.
    #[must_use]
    pub fn estimator(&self) -> &Estimator {
        &self.estimator
    }

    /// Time of the last step.
    #[must_use]
    pub fn now(&self) -> SimTime {
        self.last_step
    }

    /// Cruise speed of missions, returns and go-to, m/s: the commanded speed or else the parameter.
    pub(super) fn cruise_m_s(&self) -> f64 {
        self.commanded_m_s.unwrap_or(self.tuning.cruise_m_s).min(self.tuning.horizontal_speed_max_m_s)
    }

    /// Returns the status for telemetry.
    #[must_use]
    pub fn status(&self) -> &AutopilotStatus {
        &self.status
    }

    /// Returns and clears the events since the last call, in order.
    pub fn drain_events(&mut self) -> Vec<AutopilotEvent> {
        std::mem::take(&mut self.events)
    }

    /// Returns and clears the mission items reached since the last call, in order, for MISSION_ITEM_REACHED and payload items.
    pub fn drain_reached(&mut self) -> Vec<usize> {
        self.status.mission_reached = None;
        std::mem::take(&mut self.mission.reached)
    }
}

fn boot_status() -> AutopilotStatus {
    AutopilotStatus {
        armed: false,
        mode: FlightMode::Position,
        intended: FlightMode::Position,
        battery_low_pct: 0.0,
        battery_critical_pct: 0.0,
        landed: LandedState::OnGround,
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
        health: SensorStatus::GOOD,
    }
}

/// Cosine of the angle between the thrust directions of two attitudes.
fn thrust_cosine(a: Rotation<Frd, Ned>, b: Rotation<Frd, Ned>) -> f64 {
    let z = Vec3::<Frd>::new(0.0, 0.0, 1.0);
    (a * z).dot(b * z)
}
