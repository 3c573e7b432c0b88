//! Setpoints of each mode for the velocity and attitude loops.

use super::core::Autopilot;
use super::fence::RallyPoint;
use super::mission::SuspendedStep;
use super::pause::PausedAt;
use super::shaper::stopping_point;
use super::velocity::{AttitudeThrustSetpoint, VelocitySetpoint};
use super::{FlightMode, LandedState, MissionStep, OffboardSetpoint, TurnCommand};
use spandrel_model::frames::{Frd, Ned, Vec3};
use spandrel_model::time::SimTime;

/// Stick position above which the throttle counts as raised (ArduPilot: RC3_DZ, 30 us).
const THROTTLE_UP: f64 = -0.94;

/// Output of a mode.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Setpoint {
    /// Motors at idle, on the ground.
    Idle,
    /// Velocity.
    Velocity(VelocitySetpoint),
    /// Vertical velocity with fixed roll and pitch.
    Level {
        /// Vertical velocity and heading.
        motion: VelocitySetpoint,
        /// Roll and pitch, rad.
        tilt: (f64, f64),
    },
    /// Attitude and thrust.
    AttitudeThrust(AttitudeThrustSetpoint),
    /// Body rates and thrust.
    Spin {
        /// Body rates, rad/s.
        rates_rad_s: Vec3<Frd>,
        /// Collective thrust, N.
        thrust_n: f64,
    },
}

/// Phase of a return.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum ReturnPhase {
    /// Climbing to the return height.
    #[default]
    Climb,
    /// Flying to the destination.
    Cruise,
    /// Waiting over the destination.
    Wait,
    /// Holding over the destination instead of landing.
    Stay,
    /// Landing.
    Land,
}

/// State of navigation between ticks.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct NavigatorState {
    /// Target of hold, go-to, take-off, landing and return, m.
    pub target_m: Vec3<Ned>,
    /// Heading on arrival, rad.
    pub target_yaw_rad: Option<f64>,
    /// Speed of a go-to, m/s.
    pub speed_m_s: Option<f64>,
    /// Horizontal position lock of position mode, north and east, m.
    pub horizontal_lock: Option<(f64, f64)>,
    /// Height lock, m down.
    pub height_lock_down_m: Option<f64>,
    /// Heading setpoint, rad.
    pub yaw_rad: f64,
    /// Heading rate setpoint, rad/s.
    pub yaw_rate_rad_s: f64,
    /// Added to the heading rate setpoint while a turn is braked, rad/s.
    pub yaw_brake_rad_s: f64,
    /// Whether no heading is held: the nose turns at a rate, or has not come to rest since.
    pub heading_free: bool,
    /// Requested take-off height, m above the origin.
    pub takeoff_up_m: Option<f64>,
    /// Ground level at the last position on the ground, m down.
    pub ground_down_m: f64,
    /// Time of the last lift-off.
    pub left_ground: SimTime,
    /// Phase of a return.
    pub phase: ReturnPhase,
    /// Destination of a return, m.
    pub return_target_m: Option<Vec3<Ned>>,
    /// End of the wait over the destination.
    pub wait_until: Option<SimTime>,
    /// A commanded turn.
    pub turn: Option<TurnCommand>,
    /// Whether the pilot has turned the nose in GUIDED. The heading then stays until the next request.
    pub turned_by_pilot: bool,
    /// The pause, if the current mode is paused.
    pub paused: Option<PausedAt>,
}

impl FlightMode {
    /// Returns true if the sticks control the vehicle.
    #[must_use]
    pub fn is_manual(self) -> bool {
        matches!(self, Self::Stabilized | Self::Altitude | Self::Position | Self::Acro)
    }

    /// Returns true if the mode requires a horizontal position.
    #[must_use]
    pub fn needs_position(self) -> bool {
        !matches!(self, Self::Stabilized | Self::Altitude | Self::Acro | Self::Land | Self::Offboard)
    }
}

impl Autopilot {
    /// Starts or restarts a mode.
    pub(super) fn enter(&mut self, mode: FlightMode, now: SimTime) {
        self.suspend_mission(mode);
        // A failsafe that interrupts a take-off resumes it later.
        if self.failsafe.intended != FlightMode::Takeoff {
            self.navigator.takeoff_up_m = None;
        }
        self.status.orbit = None;
        self.status.mode = mode;
        self.links.sticks_then = self.links.sticks;
        self.begin_mode(now);
    }

    /// Suspends an interrupted mission so that it can continue from here.
    fn suspend_mission(&mut self, next: FlightMode) {
        let in_air = matches!(self.status.landed, LandedState::InAir | LandedState::Landing);
        let flying = self.status.armed && in_air && self.estimate.position_valid;
        // While it returns to the route, the mission has not restarted the item.
        let begun = self.mission.begun || self.mission.left_at.is_some();
        let under_way = self.status.mode == FlightMode::Mission && begun && self.mission.step().is_some();
        let left = flying && under_way && next != FlightMode::Mission;
        if left && self.mission.left_at.is_none() && self.mission.step().is_some_and(|step| step.continues()) {
            let NavigatorState { target_m, phase, return_target_m: refuge_m, .. } = self.navigator;
            let left_rad = self.status.orbit.map(|orbit| orbit.left_rad);
            self.mission.suspend_at(
                self.estimate.position_m,
                SuspendedStep { target_m, phase, refuge_m },
                left_rad,
                self.last_step,
            );
        }
        self.status.mission_paused = next != FlightMode::Mission && (left || self.status.mission_paused);
    }

    pub(super) fn begin_mode(&mut self, now: SimTime) {
        let e = &self.estimate;
        let c = &mut self.navigator;
        c.target_m = stopping_point(&self.gains, e.position_m, e.velocity_m_s);
        c.target_yaw_rad = None;
        (c.turn, c.paused, c.turned_by_pilot) = (None, None, false);
        c.speed_m_s = None;
        c.horizontal_lock = None;
        c.height_lock_down_m = None;
        c.yaw_rad = e.attitude.yaw_rad();
        c.heading_free = true;
        c.phase = ReturnPhase::Climb;
        self.trajectory = None;
        self.shaper.start(e.velocity_m_s);
        match self.status.mode {
            FlightMode::Takeoff => self.begin_takeoff(),
            FlightMode::Return => self.begin_return(),
            FlightMode::SmartReturn => self.begin_smart_return(),
            FlightMode::Follow => self.begin_follow(),
            FlightMode::Mission => {
                self.mission.begun = false;
                self.mission.lift_to = None;
                self.mission.wait_until = None;
                if !self.mission.skip(now) {
                    self.end_mission(now);
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
        if self.status.landed == LandedState::Landing {
            self.status.landed = LandedState::InAir;
        }
    }

    fn begin_takeoff(&mut self) {
        let up = self.above_ground(self.navigator.takeoff_up_m.unwrap_or_else(|| self.default_takeoff_up_m()));
        let here = self.estimate.position_m;
        self.navigator.target_m = Vec3::new(here.north(), here.east(), (-up).min(here.down()));
    }

    /// Default take-off height, m above the origin.
    pub(super) fn default_takeoff_up_m(&self) -> f64 {
        self.status.home_m.map_or(0.0, |h| -h.down()) + self.tuning.takeoff_height_m
    }

    /// The nearest allowed destination of a return; home if there is none.
    fn nearest_rally_point(&self) -> Vec3<Ned> {
        let here = self.estimate.position_m;
        let home = self.status.home_m.unwrap_or(here);
        let allowed = self.tuning.rules.homeward.places;
        let rally = self.rally_points.iter().filter(|_| allowed.rally).map(|refuge: &RallyPoint| refuge.place_m);
        let landing = self.mission.landing().filter(|_| allowed.mission_landing);
        let places = allowed.home.then_some(home).into_iter().chain(rally).chain(landing);
        let away = |place: &Vec3<Ned>| (*place - here).horizontal_norm();
        // Of two equally near destinations the first one, home, is used.
        places.reduce(|best, place| if away(&place) < away(&best) { place } else { best }).unwrap_or(home)
    }

    pub(super) fn begin_return(&mut self) {
        let here = self.estimate.position_m;
        let home = self.nearest_rally_point();
        self.navigator.return_target_m = Some(home);
        let away = (here - home).horizontal_norm();
        let rules = self.tuning.rules.homeward;
        let by_rally = rules.rally_height && self.status.home_m != Some(home);
        let up = -home.down() + if by_rally { 0.0 } else { self.return_height_over(away) };
        let near = away < rules.near_m;
        let phase = if near { ReturnPhase::Cruise } else { ReturnPhase::Climb };
        let down = if near { here.down() } else { (-up).min(here.down() - rules.climb_min_m) };
        self.navigator.phase = phase;
        self.navigator.target_m = Vec3::new(here.north(), here.east(), down);
    }

    /// Return height above the destination, m; lower within the cone around it.
    fn return_height_over(&self, away_m: f64) -> f64 {
        let rules = self.tuning.rules.homeward;
        if rules.cone_slope <= 0.0 {
            return self.tuning.return_height_m;
        }
        let least_m = rules.wait_height_m.unwrap_or(0.0);
        (away_m * rules.cone_slope).max(least_m).min(self.tuning.return_height_m)
    }

    /// Returns true if the mode commands a take-off from the ground.
    pub(super) fn wants_to_fly(&self, now: SimTime) -> bool {
        match self.status.mode {
            FlightMode::Stabilized | FlightMode::Altitude | FlightMode::Position | FlightMode::Acro => {
                self.links.sticks.up > 0.1 && self.links.sticks_fresh(self.tuning.manual_timeout_s(), now)
            }
            FlightMode::Takeoff => true,
            FlightMode::Mission => {
                use MissionStep as S;
                let least = if self.tuning.mission_mode_stays { THROTTLE_UP } else { 0.1 };
                let raised = self.links.sticks.up > least && self.links.sticks_fresh(self.tuning.manual_timeout_s(), now);
                let go = self.tuning.rules.mission_starts_armed || self.failsafe.mission_started || raised;
                go && matches!(self.mission.step(), Some(S::Takeoff { .. } | S::Waypoint { .. } | S::Circle { .. } | S::Near(_)))
            }
            FlightMode::Offboard => self.links.offboard.is_some_and(|(s, _)| is_upward(&s, self.estimate.position_m.down())),
            FlightMode::Hold
            | FlightMode::Land
            | FlightMode::Return
            | FlightMode::Orbit
            | FlightMode::SmartReturn
            | FlightMode::Follow => false,
        }
    }

    pub(super) fn setpoint(&mut self, now: SimTime, dt_s: f64) -> Setpoint {
        self.status.target_m = None;
        self.status.setpoint = self.setpoint_flown(now);
        self.status.climbing_out = false;
        if self.status.landed == LandedState::OnGround {
            return Setpoint::Idle;
        }
        let blind = !self.estimate.position_valid;
        if let Some(pause) = self.navigator.paused.filter(|_| !blind) {
            return self.hold_paused(pause, dt_s);
        }
        match self.status.mode {
            FlightMode::Stabilized => self.stabilized(dt_s),
            FlightMode::Acro => self.acro(),
            FlightMode::Position if !blind => self.position(dt_s),
            FlightMode::Altitude | FlightMode::Position => self.altitude(dt_s),
            FlightMode::Land => self.land(dt_s),
            FlightMode::Offboard => self.fly_setpoint(now, dt_s),
            _ if blind => self.descend_without_position(dt_s),
            FlightMode::Hold => self.go(self.navigator.speed_m_s, dt_s),
            FlightMode::Orbit => self.fly_orbit(now, dt_s),
            FlightMode::Takeoff => self.take_off(now, dt_s),
            FlightMode::Return => self.go_home(dt_s),
            FlightMode::SmartReturn => self.retrace_path(dt_s),
            FlightMode::Follow => self.follow_target(now, dt_s),
            FlightMode::Mission => self.fly_mission(now, dt_s),
        }
    }
}

/// Returns true if an external setpoint leads up from the ground.
fn is_upward(s: &OffboardSetpoint, down_m: f64) -> bool {
    s.position_m[2].is_some_and(|d| d < down_m - 0.3)
        || s.velocity_m_s[2].is_some_and(|v| v < -0.1)
        || s.acceleration_m_s2[2].is_some_and(|a| a < -0.1)
        || s.attitude.is_some_and(|(_, thrust)| thrust > 0.3)
        || s.rates.is_some_and(|(_, thrust)| thrust > 0.3)
}
