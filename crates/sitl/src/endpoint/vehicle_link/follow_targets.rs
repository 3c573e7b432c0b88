//! Positions of targets that the vehicle follows.

use super::VehicleLink;
use super::inbound::InboundMessage;
use crate::autopilot::follow::FollowTarget;
use spandrel_mavlink::dialect::{FOLLOW_TARGET_DATA, GLOBAL_POSITION_INT_DATA};
use spandrel_mavlink::units;
use spandrel_model::frames::{Ned, Vec3};

/// Handles a follow-me target's position (PX4, ArduPilot).
pub(super) fn follow_target(_: &mut VehicleLink, t: &FOLLOW_TARGET_DATA, a: &mut InboundMessage) {
    // Like PX4, accepts a velocity regardless of the capability bits (MAVSDK sets only the position bit), but ignores a
    // zero velocity without its bit.
    let given = t.est_capabilities & FOLLOW_VELOCITY != 0 || t.vel != [0.0; 3];
    let velocity = Some(t.vel.map(f64::from)).filter(|v| given && v.iter().all(|c| c.is_finite()));
    if t.est_capabilities & FOLLOW_POSITION != 0 {
        report_target(a, (t.lat, t.lon, f64::from(t.alt)), velocity.map(|[n, e, d]| Vec3::new(n, e, d)), None);
    }
}

/// Capability bits in FOLLOW_TARGET.est_capabilities.
const FOLLOW_POSITION: u8 = 1;
const FOLLOW_VELOCITY: u8 = 2;

/// Handles another vehicle's position for flavors that follow it (ArduPilot: FOLL_SYSID, 0 for any vehicle).
pub(super) fn other_position(v: &mut VehicleLink, p: &GLOBAL_POSITION_INT_DATA, a: &mut InboundMessage) {
    let Some(followed) = v.params.whole("FOLL_SYSID") else { return };
    if a.from.0 == v.system_id || (followed != 0 && i32::from(a.from.0) != followed) {
        return;
    }
    let velocity = Vec3::new(f64::from(p.vx), f64::from(p.vy), f64::from(p.vz)) * 0.01;
    let heading_rad = (p.hdg != u16::MAX).then(|| (f64::from(p.hdg) * 0.01).to_radians());
    report_target(a, (p.lat, p.lon, f64::from(p.alt) * 0.001), Some(velocity), heading_rad);
}

fn report_target(
    a: &mut InboundMessage,
    (lat, lon, alt_m): (i32, i32, f64),
    velocity_m_s: Option<Vec3<Ned>>,
    heading_rad: Option<f64>,
) {
    let Some(geo) = units::geo(lat, lon, alt_m).filter(|_| alt_m.is_finite()) else { return };
    let position_m = a.aircraft.plane.enu_from_geo(geo).ned();
    let velocity_m_s = velocity_m_s.unwrap_or_else(|| a.autopilot.target_velocity(position_m, a.now()));
    if position_m.norm() < MAX_DISTANCE_M && velocity_m_s.norm() < MAX_SPEED_M_S {
        a.autopilot.report_target(FollowTarget { position_m, velocity_m_s, heading_rad }, a.now());
    }
}

/// Maximum distance of a target from the origin, m, and maximum speed, m/s; targets beyond either limit are ignored.
const MAX_DISTANCE_M: f64 = 20_000.0;
const MAX_SPEED_M_S: f64 = 1_000.0;
