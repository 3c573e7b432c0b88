//! Circling a point, and pointing the nose at one.

use super::core::{Autopilot, Severity};
use super::modes::Setpoint;
use super::shaper::stopping_point;
use super::{FlightMode, LandedState, RequestOutcome};
use spandrel_model::frames::{Ned, Vec3};
use spandrel_model::math;
use spandrel_model::time::SimTime;

/// Rate at which the distance error to the circle is corrected, 1/s (estimate: much slower than the velocity loop).
const CLOSE_IN_PER_S: f64 = 0.6;
/// Integral gain on the remaining distance error, 1/s² (estimate: damping ratio 0.8 with the rate above), and its limit, m/s.
const TRIM_PER_S2: f64 = 0.14;
const TRIM_MAX_M_S: f64 = 2.0;
/// Fraction of the available acceleration that circling may use.
const TURN_SHARE: f64 = 0.5;
/// Allowed radii, m.
const RADII_M: std::ops::RangeInclusive<f64> = 1.0..=1_000.0;
/// Distance below which the heading to a point is not updated, m.
const TOO_NEAR_M: f64 = 0.5;
/// Default speed, m/s.
const SPEED_M_S: f64 = 2.0;

/// Heading on a circle, numbered as MAVLink's ORBIT_YAW_BEHAVIOUR.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum OrbitYaw {
    /// Toward the center (0).
    #[default]
    Centre,
    /// Heading at the start (1), or uncontrolled (2).
    Keep,
    /// Tangential to the circle (3).
    Tangent,
    /// Controlled by the yaw stick (4).
    Stick,
}

impl OrbitYaw {
    /// Returns the behavior for a command value, or `None` if it is unknown.
    #[must_use]
    pub fn from_number(n: i64) -> Option<Self> {
        [Self::Centre, Self::Keep, Self::Keep, Self::Tangent, Self::Stick].get(usize::try_from(n).ok()?).copied()
    }
}

/// An active circle.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Orbit {
    /// Center and height of the circle, m.
    pub centre_m: Vec3<Ned>,
    /// Radius, m.
    pub radius_m: f64,
    /// Tangential speed, m/s; clockwise from above is positive.
    pub speed_m_s: f64,
    /// Heading behavior.
    pub yaw: OrbitYaw,
    /// Remaining arc, rad; infinite for an endless circle.
    pub left_rad: f64,
    /// Learned inward speed that keeps the vehicle on the circle, m/s.
    pub trim_m_s: f64,
}

/// A requested circle.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct OrbitRequest {
    /// Center, north and east, m; `None` uses the current position.
    pub centre_m: Option<(f64, f64)>,
    /// Height above the origin, m.
    pub up_m: Option<f64>,
    /// Radius, m; negative for counterclockwise.
    pub radius_m: Option<f64>,
    /// Speed, m/s.
    pub speed_m_s: Option<f64>,
    /// Heading behavior. `None` keeps that of the active circle, or points toward the center.
    pub yaw: Option<OrbitYaw>,
    /// Arc to fly, rad; 0 for an endless circle.
    pub arc_rad: f64,
}

impl Autopilot {
    pub(super) fn request_orbit(&mut self, wish: OrbitRequest, now: SimTime) -> RequestOutcome {
        if !self.status.armed || self.status.landed == LandedState::OnGround {
            return RequestOutcome::TemporarilyRejected("Not flying".into());
        }
        if !self.estimate.position_valid {
            return RequestOutcome::TemporarilyRejected("No position estimate".into());
        }
        let here = self.estimate.position_m;
        let before =
            self.orbit.map_or((self.tuning.rules.orbit_radius_m, SPEED_M_S), |orbit| (orbit.radius_m, orbit.speed_m_s.abs()));
        let radius = wish.radius_m.unwrap_or(before.0);
        if !RADII_M.contains(&radius.abs()) {
            return RequestOutcome::Denied(format!("Orbit radius out of range ({} to {} m)", RADII_M.start(), RADII_M.end()));
        }
        let yaw =
            wish.yaw.or(self.orbit.filter(|_| self.status.mode == FlightMode::Orbit).map(|orbit| orbit.yaw)).unwrap_or_default();
        let top = self.max_speed_on(radius.abs());
        let speed = wish.speed_m_s.unwrap_or(before.1);
        if !speed.is_finite() || speed == 0.0 {
            return RequestOutcome::Denied("Orbit speed out of range".into());
        }
        let (n, e) = wish.centre_m.unwrap_or((here.north(), here.east()));
        let centre_m = Vec3::new(n, e, wish.up_m.map_or(here.down(), |up| -up));
        if let Some(refusal) = self.ring_refusal(centre_m, radius.abs()) {
            return refusal;
        }
        let signed = speed.abs().min(top) * radius.signum() * speed.signum();
        let left_rad = if wish.arc_rad > 0.0 { wish.arc_rad } else { f64::INFINITY };
        self.orbit = Some(Orbit { centre_m, radius_m: radius.abs(), speed_m_s: signed, yaw, left_rad, trim_m_s: 0.0 });
        self.failsafe.intended = FlightMode::Orbit;
        self.failsafe.overridden = false;
        self.enter(FlightMode::Orbit, now);
        RequestOutcome::Accepted
    }

    /// Starts a circle ahead of the nose. On the ground, changes only the mode.
    pub(super) fn request_circle_ahead(&mut self, now: SimTime) -> RequestOutcome {
        if !self.status.armed || self.status.landed == LandedState::OnGround {
            (self.failsafe.intended, self.orbit) = (FlightMode::Orbit, None);
            self.enter(FlightMode::Orbit, now);
            return RequestOutcome::Accepted;
        }
        let radius = self.tuning.rules.orbit_radius_m.abs().clamp(*RADII_M.start(), *RADII_M.end());
        let rest = stopping_point(&self.gains, self.estimate.position_m, self.estimate.velocity_m_s);
        let (s, c) = math::sin_cos(self.estimate.attitude.yaw_rad());
        let rate = self.tuning.circle_rate_rad_s;
        self.request_orbit(
            OrbitRequest {
                centre_m: Some((rest.north() + radius * c, rest.east() + radius * s)),
                up_m: Some(-rest.down()),
                radius_m: Some(radius),
                speed_m_s: Some(rate * radius),
                yaw: Some(OrbitYaw::Centre),
                arc_rad: 0.0,
            },
            now,
        )
    }

    fn max_speed_on(&self, radius_m: f64) -> f64 {
        let turn = (TURN_SHARE * self.gains.acceleration_m_s2 * radius_m).sqrt();
        turn.min(self.tuning.horizontal_speed_max_m_s).min(self.airframe.limits.forward_m_s)
    }

    pub(super) fn fly_orbit(&mut self, now: SimTime, dt_s: f64) -> Setpoint {
        let Some(wanted) = self.circle(dt_s) else { return self.go(None, dt_s) };
        if self.orbit.is_some_and(|orbit| orbit.left_rad <= 0.0) {
            self.push_event(Severity::Info, "Orbit finished");
            self.failsafe.intended = FlightMode::Hold;
            self.enter(FlightMode::Hold, now);
        }
        wanted
    }

    /// Starts a mission circle at mission speed, with the nose toward its center or the region of interest.
    pub(super) fn begin_circle(&mut self, centre_m: Vec3<Ned>, radius_m: f64, turns: f64) {
        let speed = self.mission.speed_m_s.unwrap_or(self.cruise_m_s()).min(self.max_speed_on(radius_m.abs()));
        let speed_m_s = speed * radius_m.signum();
        let left_rad = self.mission.left_rad.take().unwrap_or(turns * 2.0 * math::PI);
        self.orbit =
            Some(Orbit { centre_m, radius_m: radius_m.abs(), speed_m_s, yaw: OrbitYaw::Centre, left_rad, trim_m_s: 0.0 });
        self.navigator.target_m = centre_m;
    }

    /// Flies the active circle. Returns `None` without one.
    pub(super) fn circle(&mut self, dt_s: f64) -> Option<Setpoint> {
        let mut orbit = self.orbit?;
        let here = self.estimate.position_m;
        let out = Vec3::<Ned>::new(here.north() - orbit.centre_m.north(), here.east() - orbit.centre_m.east(), 0.0);
        let distance = out.norm();
        let away = if distance > 1e-3 { out.unit() } else { Vec3::new(1.0, 0.0, 0.0) };
        let along = Vec3::<Ned>::new(-away.east(), away.north(), 0.0);
        let error = distance - orbit.radius_m;
        let cruise = self.cruise_m_s().min(self.airframe.limits.forward_m_s);
        // Far from the circle, the heading of travel is toward it; on the circle, along it.
        let on_it = (1.0 - error.abs() / orbit.radius_m.max(2.0)).clamp(0.0, 1.0);
        let flat = along * (orbit.speed_m_s * on_it) - away * (CLOSE_IN_PER_S * error + orbit.trim_m_s).clamp(-cruise, cruise);
        let climb = CLOSE_IN_PER_S * (orbit.centre_m.down() - here.down());
        let wish = Vec3::new(flat.north(), flat.east(), climb.clamp(-self.tuning.climb_m_s, self.tuning.descend_m_s));
        match orbit.yaw {
            OrbitYaw::Centre => self.turn_to(self.look_rad().or(heading(away * -1.0)), dt_s),
            OrbitYaw::Tangent => self.turn_to(heading(along * orbit.speed_m_s.signum()), dt_s),
            OrbitYaw::Keep => self.turn_to(None, dt_s),
            OrbitYaw::Stick => self.stick_yaw(dt_s),
        }
        self.shaper.advance(wish, &self.auto_limits(), dt_s);
        self.status.target_m = Some(orbit.centre_m);
        self.status.orbit = Some(orbit);
        if error.abs() < 0.3 * orbit.radius_m {
            orbit.trim_m_s = (orbit.trim_m_s + TRIM_PER_S2 * error * dt_s).clamp(-TRIM_MAX_M_S, TRIM_MAX_M_S);
            orbit.left_rad -= orbit.speed_m_s.abs() * dt_s / orbit.radius_m;
            self.orbit = Some(orbit);
        }
        Some(Setpoint::Velocity(self.motion(self.shaper.velocity_m_s)))
    }

    /// Heading toward the region of interest, rad. `None` without one or directly above it.
    pub(super) fn look_rad(&self) -> Option<f64> {
        let to = self.look_at_m? - self.estimate.position_m;
        (to.horizontal_norm() > TOO_NEAR_M).then(|| heading(to)).flatten()
    }
}

fn heading(way: Vec3<Ned>) -> Option<f64> {
    Some(math::atan2(way.east(), way.north()))
}
