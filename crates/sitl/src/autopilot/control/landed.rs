//! Takeoff and landing detection from the estimate and the range finder. A landing is a commanded descent without
//! movement, with a surface directly below.

use crate::autopilot::estimator::estimate::Estimate;
use spandrel_model::frames::{Frd, Vec3};
use spandrel_model::time::SimTime;

/// Vertical speed below which the vehicle counts as stopped during a commanded descent, m/s, and the minimum duration,
/// s.
const STOPPED_SPEED_M_S: f64 = 0.2;
const STOPPED_DURATION_S: f64 = 0.3;
/// Minimum commanded descent rate, m/s.
const MIN_DESCENT_RATE_M_S: f64 = 0.25;
/// Time over which the thrust fades out after ground contact, s. After that, the landing is complete.
const THRUST_FADE_TIME_S: f64 = 0.5;
/// Margin above the range finder reading on the ground within which the vehicle still counts as on the ground, m.
const RANGE_MARGIN_M: f64 = 0.35;
/// Minimum tilt cosine on the ground (40 degrees).
const MIN_TILT_COSINE: f64 = 0.766;
/// Height (m) or climb rate (m/s) above which the vehicle counts as off the ground.
const OFF_GROUND_HEIGHT_M: f64 = 0.35;
const OFF_GROUND_CLIMB_RATE_M_S: f64 = 0.4;
/// Time without a takeoff command after which a vehicle still on the ground abandons the takeoff, s.
const TAKEOFF_TIMEOUT_S: f64 = 1.0;
/// Thrust ramp time at takeoff, s.
const SPOOL_UP_TIME_S: f64 = 0.6;

/// Flight phase.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum FlightPhase {
    /// On the ground.
    #[default]
    OnGround,
    /// Spooling up and lifting off.
    TakingOff,
    /// Flying.
    InAir,
}

/// A flight phase change, or expiry of the automatic disarm timeout.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum PhaseChange {
    /// The motors spool up for a takeoff.
    LiftingOff,
    /// The vehicle is off the ground.
    TakenOff,
    /// The takeoff was abandoned before liftoff.
    TakeoffAbandoned,
    /// The vehicle has landed.
    Landed,
    /// The vehicle has been armed on the ground for longer than the automatic disarm timeout.
    GroundTimeout {
        /// Whether the vehicle has flown since arming.
        flown: bool,
    },
}

/// Inputs for one tick.
#[derive(Debug, Clone, Copy)]
pub struct LandingInput<'a> {
    /// Estimated state.
    pub estimate: &'a Estimate,
    /// Downward range finder reading, m.
    pub range_down_m: Option<f64>,
    /// Height of the center of mass above the ground when the vehicle stands on its landing gear, m.
    pub resting_height_m: f64,
    /// Whether the mode commands a takeoff.
    pub takeoff_commanded: bool,
    /// Time on the ground after which the vehicle disarms, before and after a flight, s; 0 or less disables this.
    pub ground_time_limits_s: [f64; 2],
    /// Time of this tick.
    pub now: SimTime,
    /// Time since the last tick, s.
    pub dt_s: f64,
}

/// State of takeoff and landing detection.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct LandingDetector {
    /// Flight phase.
    pub phase: FlightPhase,
    /// Time at which the vehicle was last armed on the ground or touched down.
    pub on_ground_since: SimTime,
    /// Ground level where the vehicle last stood on the ground, m down.
    pub ground_down_m: f64,
    /// Commanded descent rate, m/s.
    pub descent_rate_m_s: f64,
    /// Whether the vehicle has flown since arming.
    flown: bool,
    /// Time of the last liftoff.
    liftoff_started: SimTime,
    stopped_time_s: f64,
    fade_time_s: f64,
    takeoff_wait_time_s: f64,
}

impl LandingDetector {
    /// Starts a flight on the ground when the vehicle arms.
    pub fn arm(&mut self, now: SimTime) {
        (self.phase, self.on_ground_since, self.flown) = (FlightPhase::OnGround, now, false);
    }

    /// Ends the flight when the vehicle disarms.
    pub fn disarm(&mut self) {
        (self.phase, self.flown) = (FlightPhase::OnGround, false);
        self.clear_timers();
    }

    /// Continues in the air at full thrust after a respawn. Marks the vehicle as having flown.
    pub fn continue_in_air(&mut self, now: SimTime) {
        (self.phase, self.flown) = (FlightPhase::InAir, true);
        self.liftoff_started = now - SimTime::from_s(SPOOL_UP_TIME_S);
        self.clear_timers();
    }

    fn clear_timers(&mut self) {
        (self.descent_rate_m_s, self.stopped_time_s, self.fade_time_s, self.takeoff_wait_time_s) = (0.0, 0.0, 0.0, 0.0);
    }

    /// Returns the available fraction of the maximum thrust while the motors spool up, 0 to 1.
    #[must_use]
    pub fn spool_up_fraction(&self, now: SimTime) -> f64 {
        ((now - self.liftoff_started).s() / SPOOL_UP_TIME_S).clamp(0.0, 1.0)
    }

    /// Returns the remaining thrust fraction as the thrust fades out after ground contact, 0 to 1.
    #[must_use]
    pub fn thrust_fraction(&self) -> f64 {
        1.0 - self.fade_time_s / THRUST_FADE_TIME_S
    }

    /// Advances by one tick while armed. Returns the phase change, if any.
    pub fn update(&mut self, input: &LandingInput) -> Option<PhaseChange> {
        match self.phase {
            FlightPhase::OnGround => self.update_on_ground(input),
            FlightPhase::TakingOff if self.has_left_ground(input.estimate) => {
                self.phase = FlightPhase::InAir;
                Some(PhaseChange::TakenOff)
            }
            FlightPhase::TakingOff => self.wait_for_liftoff(input),
            FlightPhase::InAir => self.detect_landing(input),
        }
    }

    fn has_left_ground(&self, estimate: &Estimate) -> bool {
        let up = self.ground_down_m - estimate.position_m.down();
        up > OFF_GROUND_HEIGHT_M || (up > 0.5 * OFF_GROUND_HEIGHT_M && estimate.velocity_m_s.down() < -OFF_GROUND_CLIMB_RATE_M_S)
    }

    fn update_on_ground(&mut self, input: &LandingInput) -> Option<PhaseChange> {
        if input.takeoff_commanded {
            self.phase = FlightPhase::TakingOff;
            self.liftoff_started = input.now;
            self.ground_down_m = input.estimate.position_m.down();
            self.clear_timers();
            self.flown = true;
            return Some(PhaseChange::LiftingOff);
        }
        let flown = self.flown;
        let limit_s = input.ground_time_limits_s[usize::from(flown)];
        let timeout = limit_s > 0.0 && (input.now - self.on_ground_since).s() > limit_s;
        timeout.then_some(PhaseChange::GroundTimeout { flown })
    }

    fn wait_for_liftoff(&mut self, input: &LandingInput) -> Option<PhaseChange> {
        if input.takeoff_commanded {
            self.takeoff_wait_time_s = 0.0;
            return None;
        }
        self.takeoff_wait_time_s += input.dt_s;
        (self.takeoff_wait_time_s > TAKEOFF_TIMEOUT_S).then(|| {
            self.touch_down(input.now);
            PhaseChange::TakeoffAbandoned
        })
    }

    fn detect_landing(&mut self, input: &LandingInput) -> Option<PhaseChange> {
        let estimate = input.estimate;
        let upright = (estimate.attitude * Vec3::<Frd>::new(0.0, 0.0, 1.0)).down();
        let near = input.range_down_m.is_none_or(|range| range * upright < input.resting_height_m + RANGE_MARGIN_M);
        let still = estimate.velocity_m_s.down().abs() < STOPPED_SPEED_M_S;
        let commanded = self.descent_rate_m_s > MIN_DESCENT_RATE_M_S;
        if !(near && still && commanded && upright > MIN_TILT_COSINE) {
            self.stopped_time_s = 0.0;
            self.fade_time_s = (self.fade_time_s - input.dt_s).max(0.0);
            return None;
        }
        self.stopped_time_s += input.dt_s;
        if self.stopped_time_s > STOPPED_DURATION_S {
            self.fade_time_s = (self.fade_time_s + input.dt_s).min(THRUST_FADE_TIME_S);
        }
        (self.fade_time_s >= THRUST_FADE_TIME_S).then(|| {
            self.touch_down(input.now);
            PhaseChange::Landed
        })
    }

    fn touch_down(&mut self, now: SimTime) {
        (self.phase, self.on_ground_since) = (FlightPhase::OnGround, now);
        self.clear_timers();
    }
}
