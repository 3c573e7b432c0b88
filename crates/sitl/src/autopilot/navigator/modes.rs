//! Mode changes, and the setpoint of each mode.

use super::input::NavigatorInput;
use super::mission::SuspendedStep;
use super::mission_step::MissionStep;
use super::return_state::ReturnPhase;
use super::{Navigator, StickLocks, heading};
use crate::autopilot::control::landed::FlightPhase;
use crate::autopilot::control::setpoint::Setpoint;
use crate::autopilot::control::shaper::stopping_point;
use crate::autopilot::external_input::OffboardSetpoint;
use crate::autopilot::flight_state::FlightMode;
use spandrel_model::frames::Vec3;

/// Stick position above which the throttle counts as raised (ArduPilot: RC3_DZ, 30 us).
const RAISED_THROTTLE_THRESHOLD: f64 = -0.94;

impl Navigator {
    /// Starts or restarts a mode. Suspends an interrupted mission.
    pub(super) fn enter(&mut self, mode: FlightMode, input: &NavigatorInput) {
        self.suspend_mission(mode, input);
        // If a failsafe interrupts a takeoff, the takeoff resumes later.
        if self.modes.intended != FlightMode::Takeoff {
            self.commanded.takeoff_target_height_m = None;
        }
        self.report.orbit = None;
        self.modes.active = mode;
        self.modes.sticks_at_start = input.links.sticks;
        self.begin_mode(input);
    }

    /// Suspends an interrupted mission so that it can continue from here.
    fn suspend_mission(&mut self, next: FlightMode, input: &NavigatorInput) {
        let in_air = input.phase == FlightPhase::InAir;
        let flying = input.armed && in_air && input.estimate.position_valid;
        // During the flight back to the route, the mission has not restarted the item yet.
        let begun = self.mission.item_started || self.mission.interruption_point_m.is_some();
        let under_way = self.modes.active == FlightMode::Mission && begun && self.mission.step().is_some();
        let left = flying && under_way && next != FlightMode::Mission;
        if left && self.mission.interruption_point_m.is_none() && self.mission.step().is_some_and(|step| step.continues()) {
            let arc_rad = self.report.orbit.map(|orbit| orbit.remaining_arc_rad);
            let step =
                SuspendedStep { target_m: self.target_m, phase: self.returning.phase, return_target_m: self.returning.target_m };
            self.mission.suspend_at(input.here(), step, arc_rad, input.last_step);
        }
        self.mission_status.paused = next != FlightMode::Mission && (left || self.mission_status.paused);
    }

    /// Starts the active mode at the current position.
    pub(super) fn begin_mode(&mut self, input: &NavigatorInput) {
        let e = input.estimate;
        self.target_m = stopping_point(input.gains, e.position_m, e.velocity_m_s);
        self.heading.begin_mode(e.attitude.yaw_rad(), heading::yaw_rate_rad_s(e));
        self.paused = None;
        self.speed_m_s = None;
        self.locks = StickLocks::default();
        self.returning.phase = ReturnPhase::Climb;
        self.trajectory = None;
        self.shaper.start(e.velocity_m_s);
        match self.modes.active {
            FlightMode::Takeoff => self.begin_takeoff(input),
            FlightMode::Return => self.begin_return(input),
            FlightMode::SmartReturn => self.begin_smart_return(),
            FlightMode::Follow => self.follower.begin(),
            FlightMode::Mission => {
                self.mission.item_started = false;
                self.mission.initial_climb_target_m = None;
                self.mission.wait_until = None;
                if !self.mission.skip(input.now) {
                    self.end_mission(input);
                }
            }
            FlightMode::Stabilized
            | FlightMode::Altitude
            | FlightMode::Position
            | FlightMode::Hold
            | FlightMode::Land
            | FlightMode::Offboard
            | FlightMode::Orbit
            | FlightMode::Acro => {}
        }
        self.descends_to_land = false;
    }

    fn begin_takeoff(&mut self, input: &NavigatorInput) {
        let up = self.raise_to_min_takeoff_height(
            self.commanded.takeoff_target_height_m.unwrap_or_else(|| self.default_takeoff_height_m(input)),
            input,
        );
        let here = input.here();
        self.target_m = Vec3::new(here.north(), here.east(), (-up).min(here.down()));
    }

    /// Returns true if the mode commands a takeoff from the ground.
    pub fn commands_takeoff(&self, input: &NavigatorInput) -> bool {
        match self.modes.active {
            FlightMode::Stabilized | FlightMode::Altitude | FlightMode::Position | FlightMode::Acro => {
                input.links.sticks.up > 0.1 && input.has_recent_sticks()
            }
            FlightMode::Takeoff => true,
            FlightMode::Mission => {
                use MissionStep as S;
                let least = if input.tuning.stays_in_mission_mode { RAISED_THROTTLE_THRESHOLD } else { 0.1 };
                let raised = input.links.sticks.up > least && input.has_recent_sticks();
                let go = input.tuning.rules.mission_takes_off_after_arming || self.mission_status.started || raised;
                go && matches!(self.mission.step(), Some(S::Takeoff { .. } | S::Waypoint { .. } | S::Circle { .. } | S::Near(_)))
            }
            FlightMode::Offboard => input.links.offboard.is_some_and(|(s, _)| is_upward(&s, input.here().down())),
            FlightMode::Hold
            | FlightMode::Land
            | FlightMode::Return
            | FlightMode::Orbit
            | FlightMode::SmartReturn
            | FlightMode::Follow => false,
        }
    }

    /// Returns the setpoint of the active mode.
    pub fn setpoint(&mut self, input: &NavigatorInput) -> Setpoint {
        self.report.target_m = None;
        self.report.setpoint = self.active_setpoint(input);
        self.report.climbing_out = false;
        if input.phase == FlightPhase::OnGround {
            return Setpoint::Idle;
        }
        let blind = !input.estimate.position_valid;
        if let Some(pause) = self.paused.filter(|_| !blind) {
            return self.hold_paused(pause, input);
        }
        match self.modes.active {
            FlightMode::Stabilized => self.stabilized(input),
            FlightMode::Acro => self.acro(input),
            FlightMode::Position if !blind => self.position(input),
            FlightMode::Altitude | FlightMode::Position => self.altitude(input),
            FlightMode::Land => self.land(input),
            FlightMode::Offboard => self.fly_setpoint(input),
            _ if blind => self.descend_without_position(input),
            FlightMode::Hold => self.fly_to_target(self.speed_m_s, input),
            FlightMode::Orbit => self.fly_orbit(input),
            FlightMode::Takeoff => self.take_off(input),
            FlightMode::Return => self.fly_return(input),
            FlightMode::SmartReturn => self.retrace_path(input),
            FlightMode::Follow => self.follow_target(input),
            FlightMode::Mission => self.fly_mission(input),
        }
    }
}

/// Returns true if an external setpoint commands a climb from the ground.
fn is_upward(s: &OffboardSetpoint, down_m: f64) -> bool {
    s.position_m[2].is_some_and(|d| d < down_m - 0.3)
        || s.velocity_m_s[2].is_some_and(|v| v < -0.1)
        || s.acceleration_m_s2[2].is_some_and(|a| a < -0.1)
        || s.attitude.is_some_and(|(_, thrust)| thrust > 0.3)
        || s.rates.is_some_and(|(_, thrust)| thrust > 0.3)
}
