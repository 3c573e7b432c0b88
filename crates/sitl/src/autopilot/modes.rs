//! What each mode wants of the velocity and attitude loops.

use super::core::Autopilot;
use super::fence::RallyPoint;
use super::mission::SuspendedStep;
use super::pause::PausedAt;
use super::shaper::stopping_point;
use super::velocity::{AttitudeThrustSetpoint, VelocitySetpoint};
use super::{FlightMode, LandedState, MissionStep, OffboardSetpoint, TurnCommand};
use spandrel_model::frames::{Frd, Ned, Vec3};
use spandrel_model::time::SimTime;

/// The throttle stick is off its lower end (ArduPilot: RC3_DZ, 30 us).
const THROTTLE_UP: f64 = -0.94;

/// What a mode asks for.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Setpoint {
    /// Motors at idle, on the ground.
    Idle,
    /// A velocity.
    Velocity(VelocitySetpoint),
    /// A vertical velocity with roll and pitch given, rad.
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

/// Where a return stands.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum ReturnPhase {
    /// Up to the return height.
    #[default]
    Climb,
    /// Over to home.
    Cruise,
    /// Waiting over home.
    Wait,
    /// Staying over home instead of landing.
    Stay,
    /// Down.
    Land,
}

/// What the guidance remembers from tick to tick.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct NavigatorState {
    /// Target of holds, go-to, take-off, landing, return, m.
    pub target_m: Vec3<Ned>,
    /// Wanted heading on arrival, rad.
    pub target_yaw_rad: Option<f64>,
    /// Speed of a go-to, m/s.
    pub speed_m_s: Option<f64>,
    /// Horizontal position lock of the position mode, m.
    pub horizontal_lock: Option<(f64, f64)>,
    /// Height lock, m down.
    pub height_lock_down_m: Option<f64>,
    /// Wanted heading, rad.
    pub yaw_rad: f64,
    /// Wanted heading rate, rad/s.
    pub yaw_rate_rad_s: f64,
    /// Added to the wanted heading rate while a turn is braked, rad/s.
    pub yaw_brake_rad_s: f64,
    /// No heading is held: the nose turns at a rate, or has not come to rest since.
    pub heading_free: bool,
    /// Asked take-off height, m up about the origin.
    pub takeoff_up_m: Option<f64>,
    /// Height of the ground where it last stood, m down.
    pub ground_down_m: f64,
    /// When it last left the ground.
    pub left_ground: SimTime,
    /// Phase of a return.
    pub phase: ReturnPhase,
    /// Where a return goes, m.
    pub return_target_m: Option<Vec3<Ned>>,
    /// The wait over home ends at this time.
    pub wait_until: Option<SimTime>,
    /// A commanded turn.
    pub turn: Option<TurnCommand>,
    /// The pilot has turned the nose in GUIDED: it stays until something else is asked for.
    pub turned_by_pilot: bool,
    /// What is flown is paused.
    pub paused: Option<PausedAt>,
}

impl FlightMode {
    /// Sticks fly.
    #[must_use]
    pub fn is_manual(self) -> bool {
        matches!(self, Self::Stabilized | Self::Altitude | Self::Position | Self::Acro)
    }

    /// Cannot be flown without horizontal position.
    #[must_use]
    pub fn needs_position(self) -> bool {
        !matches!(self, Self::Stabilized | Self::Altitude | Self::Acro | Self::Land | Self::Offboard)
    }
}

impl Autopilot {
    /// Begins a mode (again).
    pub(super) fn enter(&mut self, mode: FlightMode, now: SimTime) {
        self.suspend_mission(mode);
        // A failsafe that breaks a take-off off gives it back.
        if self.failsafe.intended != FlightMode::Takeoff {
            self.navigator.takeoff_up_m = None;
        }
        self.status.orbit = None;
        self.status.mode = mode;
        self.links.sticks_then = self.links.sticks;
        self.begin_mode(now);
    }

    /// A mission that is left on its way goes on from here later.
    fn suspend_mission(&mut self, next: FlightMode) {
        let in_air = matches!(self.status.landed, LandedState::InAir | LandedState::Landing);
        let flying = self.status.armed && in_air && self.estimate.position_valid;
        // On its way back to where it was left it has not begun the step again.
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
            _ => {}
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

    /// Height of a take-off that names none, m up about the origin.
    pub(super) fn default_takeoff_up_m(&self) -> f64 {
        self.status.home_m.map_or(0.0, |h| -h.down()) + self.tuning.takeoff_height_m
    }

    /// The nearest of the places that a return may go to; home where there is none.
    fn nearest_rally_point(&self) -> Vec3<Ned> {
        let here = self.estimate.position_m;
        let home = self.status.home_m.unwrap_or(here);
        let allowed = self.tuning.rules.homeward.places;
        let rally = self.rally_points.iter().filter(|_| allowed.rally).map(|refuge: &RallyPoint| refuge.place_m);
        let landing = self.mission.landing().filter(|_| allowed.mission_landing);
        let places = allowed.home.then_some(home).into_iter().chain(rally).chain(landing);
        let away = |place: &Vec3<Ned>| (*place - here).horizontal_norm();
        // Of two that are as near the first counts: home.
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

    /// Height of a return over its place, m: less within the cone around the place.
    fn return_height_over(&self, away_m: f64) -> f64 {
        let rules = self.tuning.rules.homeward;
        if rules.cone_slope <= 0.0 {
            return self.tuning.return_height_m;
        }
        let least_m = rules.wait_height_m.unwrap_or(0.0);
        (away_m * rules.cone_slope).max(least_m).min(self.tuning.return_height_m)
    }

    /// Standing on the ground, the mode wants to leave it.
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

/// An external set-point that leads up from where the vehicle stands.
fn is_upward(s: &OffboardSetpoint, down_m: f64) -> bool {
    s.position_m[2].is_some_and(|d| d < down_m - 0.3)
        || s.velocity_m_s[2].is_some_and(|v| v < -0.1)
        || s.acceleration_m_s2[2].is_some_and(|a| a < -0.1)
        || s.attitude.is_some_and(|(_, thrust)| thrust > 0.3)
        || s.rates.is_some_and(|(_, thrust)| thrust > 0.3)
}
