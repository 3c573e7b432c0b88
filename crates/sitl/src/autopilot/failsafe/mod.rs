//! Failsafes: links, sensor health, geofence, battery, arming checks and stick takeover. They only return requests and
//! report events; the autopilot carries out the requests.

mod arming;
mod attitude_monitor;
mod battery;
pub mod fence;
pub mod fence_check;
pub mod input;
pub mod link_status;
pub mod losses;
pub mod operator_rules;
pub mod response;
pub mod sensor_health;

use self::arming::ArmingCheck;
use self::attitude_monitor::AttitudeMonitor;
use self::battery::BatteryMonitor;
use self::fence::Fence;
use self::fence_check::{FenceCheck, FenceMonitor};
use self::input::FailsafeInput;
use self::link_status::LinkStatus;
use self::losses::{Loss, LossMode, LossMonitor, LossResponse};
use self::response::FailsafeRequest;
use self::sensor_health::{SensorHealth, SensorStatus};
use super::estimator::RejectedSources;
use super::events::{EventQueue, Severity};
use super::flight_state::{FlightMode, LandedState};
use spandrel_model::time::SimTime;
use spandrel_model::vehicle::SensorSpec;

/// Interval between checks.
const PERIOD: SimTime = SimTime::from_ms(50);

/// State of all failsafes.
#[derive(Debug, Clone)]
pub struct Failsafe {
    /// Latest inputs from the links.
    pub links: LinkStatus,
    /// Health of the monitored sensors.
    pub sensors: SensorHealth,
    /// Geofence zones.
    pub fence: Fence,
    /// Events that the autopilot has not collected yet.
    pub events: EventQueue,
    fence_monitor: FenceMonitor,
    battery: BatteryMonitor,
    attitude: AttitudeMonitor,
    losses: LossMonitor,
    /// Time of the next check.
    due: SimTime,
}

impl Failsafe {
    /// Creates the failsafes for an aircraft with these sensors.
    #[must_use]
    pub fn new(sensors: &SensorSpec) -> Self {
        Self {
            links: LinkStatus::default(),
            sensors: SensorHealth::new(sensors),
            fence: Fence::default(),
            events: EventQueue::default(),
            fence_monitor: FenceMonitor::default(),
            battery: BatteryMonitor::default(),
            attitude: AttitudeMonitor::default(),
            losses: LossMonitor::default(),
            due: SimTime::ZERO,
        }
    }

    /// Starts a flight when the vehicle arms.
    pub fn begin_flight(&mut self) {
        self.losses.sticks_received = false;
        self.fence_monitor.begin_flight();
        self.attitude.begin_flight();
    }

    /// Ends a flight when the vehicle disarms.
    pub fn end_flight(&mut self) {
        self.attitude.end_flight();
    }

    /// Continues in the air after a respawn.
    pub fn continue_in_air(&mut self) {
        self.attitude.begin_flight();
    }

    /// Handles an intentional release of the sticks. `manual` is true if the requested mode is a manual mode.
    pub fn release_sticks(&mut self, manual: bool) {
        self.losses.sticks_received = false;
        if !manual {
            self.links.sticks_at = None;
        }
    }

    /// Returns the geofence state for telemetry.
    #[must_use]
    pub fn fence_state(&self) -> &fence::FenceState {
        &self.fence_monitor.state
    }

    /// Returns the sensor and control health for telemetry.
    #[must_use]
    pub fn health(&self) -> SensorStatus {
        self.sensors.status(self.attitude.tracks_attitude)
    }

    /// Returns the reason for the active failsafe.
    #[must_use]
    pub fn active(&self) -> Option<&'static str> {
        self.losses.active
    }

    /// Reports sensors that have failed or recovered.
    pub fn check_sensors(&mut self, dropped: RejectedSources, now: SimTime) {
        for change in self.sensors.changes(dropped, now) {
            let severity = if change.fault.is_some() { Severity::Critical } else { Severity::Info };
            self.events.push_sensor_change(severity, change);
        }
    }

    /// Returns true once per check interval.
    pub fn is_due(&mut self, now: SimTime) -> bool {
        let due = now >= self.due;
        if due {
            self.due = now + PERIOD;
        }
        due
    }

    /// Warns about a low battery. Returns the battery failsafe request.
    pub fn check_battery(&mut self, input: &FailsafeInput) -> Option<FailsafeRequest> {
        self.battery.check(input, &mut self.events)
    }

    /// Updates the geofence state.
    pub fn update_fence(&mut self, input: &FailsafeInput) {
        self.fence_monitor.update_active_limits(&FenceCheck::new(&self.fence, input.tuning, input.flight.home_m));
    }

    /// Returns the geofence action request on a breach.
    pub fn enforce_fence(&mut self, input: &FailsafeInput) -> Option<FailsafeRequest> {
        let fence = FenceCheck::new(&self.fence, input.tuning, input.flight.home_m);
        self.fence_monitor.enforce(&fence, input, &mut self.events)
    }

    /// Checks that the vehicle tracks its attitude setpoint.
    pub fn check_attitude_tracking(&mut self, input: &FailsafeInput) -> Option<FailsafeRequest> {
        self.attitude.check_tracking(input, &mut self.events)
    }

    /// Checks for a crash.
    pub fn check_crash(&mut self, input: &FailsafeInput) -> Option<FailsafeRequest> {
        self.attitude.check_crash(input, &mut self.events)
    }

    /// Checks for one loss.
    pub fn check_loss(&mut self, loss: Loss, input: &FailsafeInput) -> Option<LossResponse> {
        self.losses.check(loss, &self.links, input)
    }

    /// Reports the start or end of a failsafe after all losses have been checked. Returns the mode change request.
    pub fn finish_loss_checks(&mut self, flown: Option<LossMode>, input: &FailsafeInput) -> Option<FailsafeRequest> {
        self.losses.finish_checks(flown, input, &mut self.events)
    }

    /// Clears the failsafes while disarmed. Returns the reasons why pre-arm checks failed.
    pub fn check_on_ground(&mut self, input: &FailsafeInput) -> Vec<String> {
        self.losses.reset();
        self.arming_check(input).prearm_blockers()
    }

    /// Returns the conditions that currently prevent arming.
    #[must_use]
    pub fn arming_reasons(&self, input: &FailsafeInput) -> Vec<String> {
        self.arming_check(input).reasons()
    }

    fn arming_check<'a>(&'a self, input: &'a FailsafeInput<'a>) -> ArmingCheck<'a> {
        let (links, sensors, fence) = (&self.links, &self.sensors, &self.fence);
        ArmingCheck { input, links, sensors, fence, fence_set: self.fence_monitor.state.set }
    }

    /// Returns a request to switch to manual control when the sticks move in an automatic mode.
    pub fn check_stick_takeover(&mut self, input: &FailsafeInput) -> Option<FailsafeRequest> {
        let (flight, rules) = (&input.flight, &input.tuning.rules.responses);
        let offboard = flight.intended == FlightMode::Offboard;
        let automatic = !offboard && !flight.intended.is_manual();
        let allowed = automatic && input.tuning.stick_takeover || offboard && rules.takeover_in_offboard;
        let flying = flight.armed && matches!(flight.landed, LandedState::InAir | LandedState::Landing);
        let moved = || self.links.moved_from(&flight.sticks_at_mode_start, rules.takeover_deflection);
        if !allowed || !flying || flight.overridden || !moved() {
            return None;
        }
        let mission = flight.mode == FlightMode::Mission;
        let text = if mission { "Mission paused: pilot took over with sticks" } else { "Pilot took over with sticks" };
        self.events.push(Severity::Info, text);
        Some(FailsafeRequest::SetMode { mode: FlightMode::Position, ends_override: false })
    }
}
