//! Heading setpoint, and turns commanded by stick, by rate or to a heading.

use super::input::NavigatorInput;
use crate::autopilot::estimator::estimate::Estimate;
use crate::autopilot::flight_state::FlightMode;
use crate::autopilot::request::TurnCommand;
use spandrel_model::math;

/// Time to build up full yaw rate, s.
const YAW_RATE_RAMP_TIME_S: f64 = 0.3;
/// Time constant of the end of a change of the yaw rate, s: about the lag of the motors, whose torque would otherwise turn the nose back.
const YAW_RAMP_END_TIME_S: f64 = 0.06;
/// Remaining change of the yaw rate that is made at once, rad/s: a twentieth of a degree per second.
const YAW_RATE_ROUNDING_RAD_S: f64 = 0.001;
/// Maximum lead of the heading setpoint over the actual heading, rad.
const MAX_YAW_LEAD_RAD: f64 = 0.6;
/// Yaw rate above which the rate is controlled instead of the heading, rad/s, and the maximum lead in that case, rad.
const TURNING_YAW_RATE_RAD_S: f64 = 0.1;
const MAX_TURNING_LEAD_RAD: f64 = 0.08;
/// Yaw rate below which the heading is captured, rad/s. With the yaw loop's lag of a few tenths of a second, the
/// heading then moves by less than half a degree.
const HEADING_CAPTURE_RATE_RAD_S: f64 = 0.02;
/// Time constant of the filter of the yaw rate for the capture, s: the rotors shake the gyroscope by more than the capture rate.
const CAPTURE_FILTER_S: f64 = 0.1;
/// Fraction of the full yaw rate used in automatic modes, and the gain on heading errors, 1/s.
const AUTO_YAW_RATE_FRACTION: f64 = 0.7;
const AUTO_YAW_GAIN: f64 = 1.5;
/// Remaining turn below which the shorter direction is always used, rad (5 degrees; estimate: more than the heading
/// overshoot).
const SHORTEST_TURN_RAD: f64 = 0.087;

/// Heading setpoint and commanded turns.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Heading {
    /// Heading setpoint, rad.
    pub yaw_rad: f64,
    /// Heading to turn to, rad.
    pub target_rad: Option<f64>,
    /// Heading rate setpoint, rad/s.
    rate_rad_s: f64,
    /// Addition to the heading rate setpoint while a turn slows down, rad/s.
    braking_yaw_rate_rad_s: f64,
    /// Yaw rate without the rotors' vibration, rad/s.
    turning_rad_s: f64,
    /// Whether heading hold is off: a rate is commanded, or the rotation has not stopped since.
    heading_hold_off: bool,
    /// A commanded turn.
    turn: Option<TurnCommand>,
    /// Whether the pilot has turned the nose in GUIDED. If so, the heading stays unchanged until the next request.
    turned_by_pilot: bool,
}

impl Heading {
    /// Starts a mode at the given heading, rad, and yaw rate, rad/s, without a target heading.
    pub fn begin_mode(&mut self, yaw_rad: f64, turning_rad_s: f64) {
        self.turning_rad_s = turning_rad_s;
        (self.target_rad, self.turn, self.turned_by_pilot) = (None, None, false);
        (self.yaw_rad, self.heading_hold_off) = (yaw_rad, true);
    }

    /// Heading rate feedforward, rad/s.
    #[must_use]
    pub fn feedforward_rad_s(&self) -> f64 {
        self.rate_rad_s + self.braking_yaw_rate_rad_s
    }

    /// Stops the rate setpoint.
    pub fn stop(&mut self) {
        self.rate_rad_s = 0.0;
    }

    /// Starts a commanded turn.
    pub fn command(&mut self, turn: TurnCommand) {
        (self.target_rad, self.turn) = (Some(turn.yaw_rad), Some(turn));
    }

    /// Returns control of the heading from the pilot in GUIDED to setpoints and commands.
    pub fn end_pilot_turn(&mut self) {
        self.turned_by_pilot = false;
    }

    /// Turns at the rate of the yaw stick.
    pub fn turn_by_stick(&mut self, input: &NavigatorInput) {
        let response = input.tuning.stick_response;
        let airframe_rad_s = input.airframe.limits.yaw_rate_rad_s.min(input.tuning.rules.envelope.manual_yaw_rate_rad_s);
        let max_rad_s = airframe_rad_s.min(response.limits().yaw_rate_rad_s);
        self.turn_at(response.speed_fraction(input.links.sticks.yaw) * max_rad_s, input);
    }

    /// Turns at a rate, rad/s. At zero rate, the heading is captured where the nose stops; capturing it earlier would
    /// make the nose swing back.
    pub fn turn_at(&mut self, rate_rad_s: f64, input: &NavigatorInput) {
        let turning_rad_s = yaw_rate_rad_s(input.estimate);
        self.turning_rad_s += (turning_rad_s - self.turning_rad_s) * (input.dt_s / (CAPTURE_FILTER_S + input.dt_s));
        if rate_rad_s != 0.0 {
            self.heading_hold_off = true;
        } else if self.turning_rad_s.abs() < HEADING_CAPTURE_RATE_RAD_S && self.rate_rad_s.abs() < HEADING_CAPTURE_RATE_RAD_S {
            self.heading_hold_off = false;
        }
        let before = self.rate_rad_s;
        self.advance(rate_rad_s, input);
        if rate_rad_s == 0.0 && self.heading_hold_off {
            self.yaw_rad = input.estimate.attitude.yaw_rad();
            // The rate loop lags by the inverse of its gain. With this lead, the rotation slows down as planned.
            let braking = if input.dt_s > 0.0 { (self.rate_rad_s - before) / input.dt_s } else { 0.0 };
            self.braking_yaw_rate_rad_s = braking / input.gains.yaw_rate;
        }
    }

    /// Advances the heading setpoint at a rate that builds up gradually, rad/s.
    fn advance(&mut self, rate_rad_s: f64, input: &NavigatorInput) {
        let left = rate_rad_s - self.rate_rad_s;
        let max_step = input.airframe.limits.yaw_rate_rad_s / YAW_RATE_RAMP_TIME_S * input.dt_s;
        let ending = left * input.dt_s / (YAW_RAMP_END_TIME_S + input.dt_s);
        self.braking_yaw_rate_rad_s = 0.0;
        self.rate_rad_s += if left.abs() < YAW_RATE_ROUNDING_RAD_S { left } else { ending.clamp(-max_step, max_step) };
        let nose = input.estimate.attitude.yaw_rad();
        let max_lead = if self.rate_rad_s.abs() > TURNING_YAW_RATE_RAD_S { MAX_TURNING_LEAD_RAD } else { MAX_YAW_LEAD_RAD };
        let lead = math::wrap_pi(self.yaw_rad + self.rate_rad_s * input.dt_s - nose).clamp(-max_lead, max_lead);
        self.yaw_rad = math::wrap_pi(nose + lead);
    }

    /// Applies the yaw stick in GUIDED (ArduCopter, unless `GUID_OPTIONS` disables it). Returns false if the stick does not
    /// control the heading.
    pub fn turn_by_pilot(&mut self, mode: FlightMode, input: &NavigatorInput) -> bool {
        let guided = input.links.guided && matches!(mode, FlightMode::Hold | FlightMode::Takeoff | FlightMode::Offboard);
        let enabled = guided && input.tuning.rules.guided.yaw_stick_enabled;
        let fresh = input.links.has_recent_sticks(input.tuning.manual_timeout_s(), input.last_step);
        if enabled && fresh && input.links.sticks.yaw != 0.0 {
            (self.target_rad, self.turn, self.turned_by_pilot) = (None, None, true);
            self.turn_by_stick(input);
        } else if self.turned_by_pilot {
            self.turn_at(0.0, input);
        }
        self.turned_by_pilot
    }

    /// Turns to a heading, rad; `None` stops the turn. In GUIDED, the yaw stick has priority.
    pub fn turn_to(&mut self, yaw_rad: Option<f64>, mode: FlightMode, input: &NavigatorInput) {
        if self.turn_by_pilot(mode, input) {
            return;
        }
        let full_rad_s = input.airframe.limits.yaw_rate_rad_s;
        let turn = self.turn.filter(|turn| yaw_rad == Some(turn.yaw_rad));
        let Some(yaw_rad) = yaw_rad else {
            self.turn_at(0.0, input);
            return;
        };
        let limit =
            turn.and_then(|turn| turn.rate_rad_s).map_or(AUTO_YAW_RATE_FRACTION * full_rad_s, |rate| rate.min(full_rad_s));
        let left = math::wrap_pi(yaw_rad - self.yaw_rad);
        let left = turn.map_or(left, |turn| self.remaining_turn(turn, left));
        self.heading_hold_off = false;
        self.advance((AUTO_YAW_GAIN * left).clamp(-limit, limit), input);
    }

    /// Remaining turn in the commanded direction, rad. Close to the target heading, the shorter direction applies.
    fn remaining_turn(&mut self, turn: TurnCommand, left: f64) -> f64 {
        let long_way = turn.clockwise.is_some_and(|clockwise| clockwise != (left > 0.0));
        if left.abs() < SHORTEST_TURN_RAD {
            self.turn = Some(TurnCommand { clockwise: None, ..turn });
            return left;
        }
        if long_way { left - 2.0 * math::PI * left.signum() } else { left }
    }
}

/// Rate of the heading, rad/s.
pub(super) fn yaw_rate_rad_s(estimate: &Estimate) -> f64 {
    (estimate.attitude * estimate.rates_rad_s).down()
}
