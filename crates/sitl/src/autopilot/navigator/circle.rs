//! Flies circles around a point.

use super::Navigator;
use super::input::NavigatorInput;
use super::orbit::{Orbit, OrbitRequest, OrbitYaw};
use crate::autopilot::control::setpoint::Setpoint;
use crate::autopilot::control::shaper::stopping_point;
use crate::autopilot::events::Severity;
use crate::autopilot::flight_state::FlightMode;
use crate::autopilot::request::RequestOutcome;
use spandrel_model::frames::{Ned, Vec3};
use spandrel_model::math;

/// Gain on the distance error from the circle, 1/s (estimate: much slower than the velocity loop).
const RADIAL_GAIN_PER_S: f64 = 0.6;
/// Integral gain on the remaining distance error, 1/s² (estimate: damping ratio 0.8 with the gain above), and its
/// limit, m/s.
const INTEGRAL_GAIN_PER_S2: f64 = 0.14;
const MAX_INWARD_SPEED_M_S: f64 = 2.0;
/// Fraction of the available acceleration that a circle may use.
const CIRCLE_ACCELERATION_FRACTION: f64 = 0.5;
/// Allowed orbit radii, m.
const RADIUS_LIMITS_M: std::ops::RangeInclusive<f64> = 1.0..=1_000.0;
/// Default orbit speed, m/s.
const DEFAULT_SPEED_M_S: f64 = 2.0;

impl Navigator {
    /// Starts a circle.
    pub(super) fn request_orbit(&mut self, request: OrbitRequest, input: &NavigatorInput) -> RequestOutcome {
        if !input.is_flying() {
            return RequestOutcome::TemporarilyRejected("Not flying".into());
        }
        if !input.estimate.position_valid {
            return RequestOutcome::TemporarilyRejected("No position estimate".into());
        }
        let here = input.here();
        let before = self
            .orbit
            .map_or((input.tuning.rules.orbit_radius_m, DEFAULT_SPEED_M_S), |orbit| (orbit.radius_m, orbit.speed_m_s.abs()));
        let radius = request.radius_m.unwrap_or(before.0);
        if !RADIUS_LIMITS_M.contains(&radius.abs()) {
            return RequestOutcome::Denied(format!(
                "Orbit radius out of range ({} to {} m)",
                RADIUS_LIMITS_M.start(),
                RADIUS_LIMITS_M.end()
            ));
        }
        let yaw = request
            .yaw
            .or(self.orbit.filter(|_| self.modes.active == FlightMode::Orbit).map(|orbit| orbit.yaw))
            .unwrap_or_default();
        let top = self.max_circle_speed(radius.abs(), input);
        let speed = request.speed_m_s.unwrap_or(before.1);
        if !speed.is_finite() || speed == 0.0 {
            return RequestOutcome::Denied("Orbit speed out of range".into());
        }
        let (n, e) = request.center_m.unwrap_or((here.north(), here.east()));
        let center_m = Vec3::new(n, e, request.up_m.map_or(here.down(), |up| -up));
        if self.fence_check(input).circle_leaves_fence(center_m, radius.abs()) {
            return RequestOutcome::Denied("Orbit leaves geofence".into());
        }
        let signed = speed.abs().min(top) * radius.signum() * speed.signum();
        let left_rad = if request.arc_rad > 0.0 { request.arc_rad } else { f64::INFINITY };
        self.orbit = Some(Orbit {
            center_m,
            radius_m: radius.abs(),
            speed_m_s: signed,
            yaw,
            remaining_arc_rad: left_rad,
            inward_speed_m_s: 0.0,
        });
        self.modes.intended = FlightMode::Orbit;
        self.modes.overridden = false;
        self.enter(FlightMode::Orbit, input);
        RequestOutcome::Accepted
    }

    /// Starts a circle ahead of the nose. On the ground, only changes the mode.
    pub(super) fn request_circle_ahead(&mut self, input: &NavigatorInput) -> RequestOutcome {
        if !input.is_flying() {
            (self.modes.intended, self.orbit) = (FlightMode::Orbit, None);
            self.enter(FlightMode::Orbit, input);
            return RequestOutcome::Accepted;
        }
        let radius = input.tuning.rules.orbit_radius_m.abs().clamp(*RADIUS_LIMITS_M.start(), *RADIUS_LIMITS_M.end());
        let rest = stopping_point(input.gains, input.here(), input.estimate.velocity_m_s);
        let (s, c) = math::sin_cos(input.estimate.attitude.yaw_rad());
        let rate = input.tuning.circle_rate_rad_s;
        self.request_orbit(
            OrbitRequest {
                center_m: Some((rest.north() + radius * c, rest.east() + radius * s)),
                up_m: Some(-rest.down()),
                radius_m: Some(radius),
                speed_m_s: Some(rate * radius),
                yaw: Some(OrbitYaw::Center),
                arc_rad: 0.0,
            },
            input,
        )
    }

    /// Maximum speed on a circle, m/s.
    fn max_circle_speed(&self, radius_m: f64, input: &NavigatorInput) -> f64 {
        let turn = (CIRCLE_ACCELERATION_FRACTION * input.gains.acceleration_m_s2 * radius_m).sqrt();
        turn.min(input.tuning.horizontal_speed_max_m_s).min(input.airframe.limits.forward_m_s)
    }

    /// Flies the active circle, then holds.
    pub(super) fn fly_orbit(&mut self, input: &NavigatorInput) -> Setpoint {
        let Some(wanted) = self.circle(input) else { return self.fly_to_target(None, input) };
        if self.orbit.is_some_and(|orbit| orbit.remaining_arc_rad <= 0.0) {
            self.events.push(Severity::Info, "Orbit finished");
            self.modes.intended = FlightMode::Hold;
            self.enter(FlightMode::Hold, input);
        }
        wanted
    }

    /// Starts a mission circle at mission speed, with the nose toward its center or the region of interest.
    pub(super) fn begin_circle(&mut self, center_m: Vec3<Ned>, radius_m: f64, turns: f64, input: &NavigatorInput) {
        let speed = self.mission.speed_m_s.unwrap_or(self.cruise_m_s(input)).min(self.max_circle_speed(radius_m.abs(), input));
        let speed_m_s = speed * radius_m.signum();
        let left_rad = self.mission.suspended_arc_rad.take().unwrap_or(turns * 2.0 * math::PI);
        self.orbit = Some(Orbit {
            center_m,
            radius_m: radius_m.abs(),
            speed_m_s,
            yaw: OrbitYaw::Center,
            remaining_arc_rad: left_rad,
            inward_speed_m_s: 0.0,
        });
        self.target_m = center_m;
    }

    /// Flies the active circle. Returns `None` if there is none.
    pub(super) fn circle(&mut self, input: &NavigatorInput) -> Option<Setpoint> {
        let mut orbit = self.orbit?;
        let here = input.here();
        let out = Vec3::<Ned>::new(here.north() - orbit.center_m.north(), here.east() - orbit.center_m.east(), 0.0);
        let distance = out.norm();
        let away = if distance > 1e-3 { out.unit() } else { Vec3::new(1.0, 0.0, 0.0) };
        let along = Vec3::<Ned>::new(-away.east(), away.north(), 0.0);
        let error = distance - orbit.radius_m;
        let cruise = self.cruise_m_s(input).min(input.airframe.limits.forward_m_s);
        // Far from the circle, the vehicle flies toward it; on the circle, along it.
        let on_it = (1.0 - error.abs() / orbit.radius_m.max(2.0)).clamp(0.0, 1.0);
        let flat = along * (orbit.speed_m_s * on_it)
            - away * (RADIAL_GAIN_PER_S * error + orbit.inward_speed_m_s).clamp(-cruise, cruise);
        let climb = RADIAL_GAIN_PER_S * (orbit.center_m.down() - here.down());
        let velocity_m_s = Vec3::new(flat.north(), flat.east(), climb.clamp(-input.tuning.climb_m_s, input.tuning.descend_m_s));
        match orbit.yaw {
            OrbitYaw::Center => self.heading.turn_to(
                self.region_of_interest_heading_rad(input).or(heading(away * -1.0)),
                self.modes.active,
                input,
            ),
            OrbitYaw::Tangent => self.heading.turn_to(heading(along * orbit.speed_m_s.signum()), self.modes.active, input),
            OrbitYaw::Keep => self.heading.turn_to(None, self.modes.active, input),
            OrbitYaw::Stick => self.heading.turn_by_stick(input),
        }
        self.shaper.advance(velocity_m_s, &self.auto_limits(input), input.dt_s);
        self.report.target_m = Some(orbit.center_m);
        self.report.orbit = Some(orbit);
        if error.abs() < 0.3 * orbit.radius_m {
            orbit.inward_speed_m_s = (orbit.inward_speed_m_s + INTEGRAL_GAIN_PER_S2 * error * input.dt_s)
                .clamp(-MAX_INWARD_SPEED_M_S, MAX_INWARD_SPEED_M_S);
            orbit.remaining_arc_rad -= orbit.speed_m_s.abs() * input.dt_s / orbit.radius_m;
            self.orbit = Some(orbit);
        }
        Some(Setpoint::Velocity(self.motion(self.shaper.velocity_m_s)))
    }
}

/// Heading of a direction, rad.
fn heading(direction: Vec3<Ned>) -> Option<f64> {
    Some(math::atan2(direction.east(), direction.north()))
}
