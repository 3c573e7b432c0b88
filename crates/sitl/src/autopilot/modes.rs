//! What each mode wants of the velocity and attitude loops.

use super::core::Autopilot;
use super::fence::Refuge;
use super::mission::LeftCourse;
use super::pause::Pause;
use super::shaper::stopping_point;
use super::velocity::{Motion, Pull};
use super::{Landed, MissionStep, Mode, OffboardSetpoint, Turn};
use spandrel_model::frames::{Frd, Ned, Vec3};
use spandrel_model::time::SimTime;

/// The throttle stick is off its lower end (ArduPilot: RC3_DZ, 30 us).
const THROTTLE_UP: f64 = -0.94;

/// What a mode asks for.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Wanted {
    /// Motors at idle, on the ground.
    Rest,
    /// A velocity.
    Fly(Motion),
    /// A vertical velocity with roll and pitch given, rad.
    Level {
        /// Vertical velocity and heading.
        motion: Motion,
        /// Roll and pitch, rad.
        tilt: (f64, f64),
    },
    /// Attitude and thrust.
    Direct(Pull),
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
pub struct Course {
    /// Target of holds, go-to, take-off, landing, return, m.
    pub target_m: Vec3<Ned>,
    /// Wanted heading on arrival, rad.
    pub target_yaw_rad: Option<f64>,
    /// Speed of a go-to, m/s.
    pub speed_m_s: Option<f64>,
    /// Horizontal position lock of the position mode, m.
    pub lock_flat: Option<(f64, f64)>,
    /// Height lock, m down.
    pub lock_down: Option<f64>,
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
    pub refuge_m: Option<Vec3<Ned>>,
    /// The wait over home ends at this time.
    pub wait_until: Option<SimTime>,
    /// A commanded turn.
    pub turn: Option<Turn>,
    /// The pilot has turned the nose in GUIDED: it stays until something else is asked for.
    pub turned_by_pilot: bool,
    /// What is flown is paused.
    pub paused: Option<Pause>,
}

impl Mode {
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
    pub(super) fn enter(&mut self, mode: Mode, now: SimTime) {
        self.leave_mission(mode);
        // A failsafe that breaks a take-off off gives it back.
        if self.watch.intended != Mode::Takeoff {
            self.course.takeoff_up_m = None;
        }
        self.status.orbit = None;
        self.status.mode = mode;
        self.links.sticks_then = self.links.sticks;
        self.begin_course(now);
    }

    /// A mission that is left on its way goes on from here later.
    fn leave_mission(&mut self, next: Mode) {
        let in_air = matches!(self.status.landed, Landed::InAir | Landed::Landing);
        let flying = self.status.armed && in_air && self.estimate.position_valid;
        // On its way back to where it was left it has not begun the step again.
        let begun = self.mission.begun || self.mission.left_at.is_some();
        let under_way = self.status.mode == Mode::Mission && begun && self.mission.step().is_some();
        let left = flying && under_way && next != Mode::Mission;
        if left && self.mission.left_at.is_none() && self.mission.step().is_some_and(|step| step.goes_on()) {
            let Course { target_m, phase, refuge_m, .. } = self.course;
            let left_rad = self.status.orbit.map(|orbit| orbit.left_rad);
            self.mission.leave(self.estimate.position_m, LeftCourse { target_m, phase, refuge_m }, left_rad, self.last_step);
        }
        self.status.mission_paused = next != Mode::Mission && (left || self.status.mission_paused);
    }

    pub(super) fn begin_course(&mut self, now: SimTime) {
        let e = &self.estimate;
        let c = &mut self.course;
        c.target_m = stopping_point(&self.gains, e.position_m, e.velocity_m_s);
        c.target_yaw_rad = None;
        (c.turn, c.paused, c.turned_by_pilot) = (None, None, false);
        c.speed_m_s = None;
        c.lock_flat = None;
        c.lock_down = None;
        c.yaw_rad = e.attitude.yaw_rad();
        c.heading_free = true;
        c.phase = ReturnPhase::Climb;
        self.way = None;
        self.shaper.start(e.velocity_m_s);
        match self.status.mode {
            Mode::Takeoff => self.begin_takeoff(),
            Mode::Return => self.begin_return(),
            Mode::SmartReturn => self.begin_smart_return(),
            Mode::Follow => self.begin_follow(),
            Mode::Mission => {
                self.mission.begun = false;
                self.mission.lift_to = None;
                self.mission.wait_until = None;
                if !self.mission.skip(now) {
                    self.end_mission(now);
                }
            }
            _ => {}
        }
        if self.status.landed == Landed::Landing {
            self.status.landed = Landed::InAir;
        }
    }

    fn begin_takeoff(&mut self) {
        let up = self.above_ground(self.course.takeoff_up_m.unwrap_or_else(|| self.usual_takeoff_up_m()));
        let here = self.estimate.position_m;
        self.course.target_m = Vec3::new(here.north(), here.east(), (-up).min(here.down()));
    }

    /// Height of a take-off that names none, m up about the origin.
    pub(super) fn usual_takeoff_up_m(&self) -> f64 {
        self.status.home_m.map_or(0.0, |h| -h.down()) + self.tuning.takeoff_height_m
    }

    /// The nearest of the places that a return may go to; home where there is none.
    fn nearest_refuge(&self) -> Vec3<Ned> {
        let here = self.estimate.position_m;
        let home = self.status.home_m.unwrap_or(here);
        let allowed = self.tuning.rules.homeward.places;
        let rally = self.refuges.iter().filter(|_| allowed.rally).map(|refuge: &Refuge| refuge.place_m);
        let landing = self.mission.landing().filter(|_| allowed.mission_landing);
        let places = allowed.home.then_some(home).into_iter().chain(rally).chain(landing);
        let away = |place: &Vec3<Ned>| (*place - here).horizontal_norm();
        // Of two that are as near the first counts: home.
        places.reduce(|best, place| if away(&place) < away(&best) { place } else { best }).unwrap_or(home)
    }

    pub(super) fn begin_return(&mut self) {
        let here = self.estimate.position_m;
        let home = self.nearest_refuge();
        self.course.refuge_m = Some(home);
        let away = (here - home).horizontal_norm();
        let rules = self.tuning.rules.homeward;
        let by_rally = rules.rally_height && self.status.home_m != Some(home);
        let up = -home.down() + if by_rally { 0.0 } else { self.return_height_over(away) };
        let near = away < rules.near_m;
        let phase = if near { ReturnPhase::Cruise } else { ReturnPhase::Climb };
        let down = if near { here.down() } else { (-up).min(here.down() - rules.climb_min_m) };
        self.course.phase = phase;
        self.course.target_m = Vec3::new(here.north(), here.east(), down);
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
            Mode::Stabilized | Mode::Altitude | Mode::Position | Mode::Acro => {
                self.links.sticks.up > 0.1 && self.links.sticks_fresh(self.tuning.manual_patience_s(), now)
            }
            Mode::Takeoff => true,
            Mode::Mission => {
                use MissionStep as S;
                let least = if self.tuning.mission_mode_stays { THROTTLE_UP } else { 0.1 };
                let raised = self.links.sticks.up > least && self.links.sticks_fresh(self.tuning.manual_patience_s(), now);
                let go = self.tuning.rules.mission_starts_armed || self.watch.mission_started || raised;
                go && matches!(self.mission.step(), Some(S::Takeoff { .. } | S::Waypoint { .. } | S::Circle { .. } | S::Near(_)))
            }
            Mode::Offboard => self.links.offboard.is_some_and(|(s, _)| rises(&s, self.estimate.position_m.down())),
            Mode::Hold | Mode::Land | Mode::Return | Mode::Orbit | Mode::SmartReturn | Mode::Follow => false,
        }
    }

    pub(super) fn wanted(&mut self, now: SimTime, dt_s: f64) -> Wanted {
        self.status.target_m = None;
        self.status.setpoint = self.setpoint_flown(now);
        self.status.climbing_out = false;
        if self.status.landed == Landed::OnGround {
            return Wanted::Rest;
        }
        let blind = !self.estimate.position_valid;
        if let Some(pause) = self.course.paused.filter(|_| !blind) {
            return self.hold_paused(pause, dt_s);
        }
        match self.status.mode {
            Mode::Stabilized => self.stabilized(dt_s),
            Mode::Acro => self.acro(),
            Mode::Position if !blind => self.position(dt_s),
            Mode::Altitude | Mode::Position => self.altitude(dt_s),
            Mode::Land => self.land(dt_s),
            Mode::Offboard => self.fly_setpoint(now, dt_s),
            _ if blind => self.sink_blind(dt_s),
            Mode::Hold => self.go(self.course.speed_m_s, dt_s),
            Mode::Orbit => self.fly_orbit(now, dt_s),
            Mode::Takeoff => self.take_off(now, dt_s),
            Mode::Return => self.go_home(dt_s),
            Mode::SmartReturn => self.fly_trail_back(dt_s),
            Mode::Follow => self.follow_target(now, dt_s),
            Mode::Mission => self.fly_mission(now, dt_s),
        }
    }
}

/// An external set-point that leads up from where the vehicle stands.
fn rises(s: &OffboardSetpoint, down_m: f64) -> bool {
    s.position_m[2].is_some_and(|d| d < down_m - 0.3)
        || s.velocity_m_s[2].is_some_and(|v| v < -0.1)
        || s.acceleration_m_s2[2].is_some_and(|a| a < -0.1)
        || s.attitude.is_some_and(|(_, thrust)| thrust > 0.3)
        || s.rates.is_some_and(|(_, thrust)| thrust > 0.3)
}
