//! Returns: to home or a rally point, and back along the recorded path (ArduCopter's Smart RTL).

use super::Navigator;
use super::automatic::HEIGHT_TOLERANCE_M;
use super::home::RallyPoint;
use super::input::NavigatorInput;
use super::return_state::ReturnPhase;
use crate::autopilot::control::setpoint::Setpoint;
use crate::autopilot::events::Severity;
use crate::autopilot::flight_state::{FlightMode, LandedState};
use spandrel_model::frames::{Ned, Vec3};
use spandrel_model::time::SimTime;

/// Distance and speed below which the vehicle counts as above the destination, m and m/s.
const ARRIVAL_DISTANCE_M: f64 = 0.5;
const ARRIVAL_SPEED_M_S: f64 = 0.5;
/// Height above the takeoff point at which a Smart RTL begins its landing, m (ArduCopter: pre-land position).
const SMART_RETURN_LANDING_HEIGHT_M: f64 = 2.0;

impl Navigator {
    /// Starts a return to the nearest allowed destination.
    pub(super) fn begin_return(&mut self, input: &NavigatorInput) {
        let here = input.here();
        let home = self.nearest_return_destination(input);
        self.returning.target_m = Some(home);
        let away = (here - home).horizontal_norm();
        let rules = input.tuning.rules.return_rules;
        let by_rally = rules.uses_rally_height && self.home.position_m != Some(home);
        let up = -home.down() + if by_rally { 0.0 } else { self.return_height_over(away, input) };
        let near = away < rules.no_climb_distance_m;
        let phase = if near { ReturnPhase::Cruise } else { ReturnPhase::Climb };
        let down = if near { here.down() } else { (-up).min(here.down() - rules.min_climb_m) };
        self.returning.phase = phase;
        self.target_m = Vec3::new(here.north(), here.east(), down);
    }

    /// The nearest allowed return destination, or home if there is none.
    fn nearest_return_destination(&self, input: &NavigatorInput) -> Vec3<Ned> {
        let here = input.here();
        let home = self.home.position_m.unwrap_or(here);
        let allowed = input.tuning.rules.return_rules.places;
        let rally =
            self.home.rally_points.iter().filter(|_| allowed.rally).map(|rally_point: &RallyPoint| rally_point.position_m);
        let landing = self.mission.landing().filter(|_| allowed.mission_landing);
        let places = allowed.home.then_some(home).into_iter().chain(rally).chain(landing);
        let away = |place: &Vec3<Ned>| (*place - here).horizontal_norm();
        // If two destinations are equally near, the first one in the list is used, which is home.
        places.reduce(|best, place| if away(&place) < away(&best) { place } else { best }).unwrap_or(home)
    }

    /// Return height above the destination, m; lower within the cone around it.
    fn return_height_over(&self, away_m: f64, input: &NavigatorInput) -> f64 {
        let rules = input.tuning.rules.return_rules;
        if rules.cone_slope <= 0.0 {
            return input.tuning.return_height_m;
        }
        let least_m = rules.loiter_height_m.unwrap_or(0.0);
        (away_m * rules.cone_slope).max(least_m).min(input.tuning.return_height_m)
    }

    /// Flies to a return's destination, waits there and lands.
    pub(super) fn fly_return(&mut self, input: &NavigatorInput) -> Setpoint {
        let here = input.here();
        let home = self.returning.target_m.or(self.home.position_m).unwrap_or(here);
        match self.returning.phase {
            ReturnPhase::Climb => {
                if (self.target_m.down() - here.down()).abs() < HEIGHT_TOLERANCE_M {
                    self.returning.phase = ReturnPhase::Cruise;
                }
            }
            ReturnPhase::Cruise => {
                self.target_m = Vec3::new(home.north(), home.east(), self.target_m.down());
                let speed = input.estimate.velocity_m_s.horizontal_norm();
                if (here - home).horizontal_norm() < ARRIVAL_DISTANCE_M && speed < ARRIVAL_SPEED_M_S {
                    self.handle_arrival(home, input);
                }
            }
            ReturnPhase::Wait => self.wait_above_destination(home, input),
            ReturnPhase::Stay => {}
            ReturnPhase::Land => {
                self.target_m = home;
                return self.land(input);
            }
        }
        self.fly_to_target(input.tuning.rules.return_rules.speed_m_s.or(Some(self.cruise_m_s(input))), input)
    }

    /// Handles arrival above the return target: waits there or lands.
    fn handle_arrival(&mut self, home: Vec3<Ned>, input: &NavigatorInput) {
        let rules = input.tuning.rules.return_rules;
        let waits = rules.wait_s != 0.0 || rules.final_height_m > 0.0;
        let place = if self.home.position_m == Some(home) { "Home" } else { "Rally point" };
        self.events.push(Severity::Info, format!("{place} reached, {}", if waits { "waiting" } else { "landing" }));
        self.returning.phase = if waits { ReturnPhase::Wait } else { ReturnPhase::Land };
        self.returning.wait_until = None;
        if let Some(height_m) = rules.loiter_height_m.filter(|_| waits) {
            let down = input.here().down().max(home.down() - height_m);
            self.target_m = Vec3::new(home.north(), home.east(), down);
        }
    }

    /// Waits above the destination for the configured time.
    fn wait_above_destination(&mut self, home: Vec3<Ned>, input: &NavigatorInput) {
        let rules = input.tuning.rules.return_rules;
        if rules.turns_to_takeoff_heading {
            self.heading.target_rad = self.home.arming_yaw_rad;
        }
        if (self.target_m.down() - input.here().down()).abs() > HEIGHT_TOLERANCE_M || rules.wait_s < 0.0 {
            return;
        }
        let until = *self.returning.wait_until.get_or_insert(input.last_step + SimTime::from_s(rules.wait_s));
        if input.last_step < until {
            return;
        }
        if rules.final_height_m > 0.0 {
            self.returning.phase = ReturnPhase::Stay;
            let down = input.here().down().max(home.down() - rules.final_height_m);
            self.target_m = Vec3::new(home.north(), home.east(), down);
            self.events.push(Severity::Info, "Holding at final altitude");
        } else {
            self.returning.phase = ReturnPhase::Land;
            self.events.push(Severity::Info, "Landing");
        }
    }

    /// Starts a return along the recorded path.
    pub(super) fn begin_smart_return(&mut self) {
        self.flown_path.simplify_for_return();
        self.returning.phase = ReturnPhase::Cruise;
    }

    /// Records the path in flight.
    pub fn record_path(&mut self, input: &NavigatorInput) {
        let flying = input.armed && self.landed(input) == LandedState::InAir;
        if flying && input.estimate.position_valid && self.modes.active != FlightMode::SmartReturn {
            self.flown_path.record(input.here());
        }
    }

    /// Flies back point by point and lands at the takeoff point.
    pub(super) fn retrace_path(&mut self, input: &NavigatorInput) -> Setpoint {
        if self.returning.phase == ReturnPhase::Land {
            return self.land(input);
        }
        let here = input.here();
        let Some((next, last)) = self.flown_path.next_return_point(here) else { return self.fly_to_target(None, input) };
        self.target_m = if last { next - Vec3::new(0.0, 0.0, SMART_RETURN_LANDING_HEIGHT_M) } else { next };
        let left = self.target_m - here;
        let slow = input.estimate.velocity_m_s.norm() < ARRIVAL_SPEED_M_S;
        if last && left.norm() < ARRIVAL_DISTANCE_M && slow {
            self.returning.phase = ReturnPhase::Land;
            self.target_m = next;
            self.events.push(Severity::Info, "Takeoff point reached, landing");
        }
        self.fly_to_target(None, input)
    }
}
