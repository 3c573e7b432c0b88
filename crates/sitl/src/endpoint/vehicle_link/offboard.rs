//! Offboard setpoints: converts each message to north, east, down, according to its frame and type mask. The rules are
//! PX4's (MAVLink common, POSITION_TARGET_TYPEMASK and ATTITUDE_TARGET_TYPEMASK).
#![allow(deprecated, reason = "clients still use superseded coordinate frames")]

use super::snapshot::VehicleSnapshot;
use crate::autopilot::{OffboardSetpoint, Tuning};
use spandrel_mavlink::dialect::{
    AttitudeTargetTypemask, MavFrame, PositionTargetTypemask, SET_ATTITUDE_TARGET_DATA, SET_POSITION_TARGET_GLOBAL_INT_DATA,
    SET_POSITION_TARGET_LOCAL_NED_DATA,
};
use spandrel_mavlink::units;
use spandrel_model::frames::{Rotation, Vec3};
use spandrel_model::math;

/// Maximum value of a field in m, m/s or m/s²; larger values are rejected.
const MAX_FIELD_VALUE: f32 = 1e5;
/// Maximum distance of a position from the origin, m.
const MAX_DISTANCE_M: f64 = 20_000.0;
/// Maximum rotation rate, rad/s.
const MAX_ANGULAR_RATE_RAD_S: f32 = 100.0;

/// A setpoint, or the reason for its rejection.
pub type SetpointResult = Result<OffboardSetpoint, &'static str>;

type AxisSetpoints = [Option<f64>; 3];

struct TypeMask {
    position: [bool; 3],
    velocity: [bool; 3],
    acceleration: [bool; 3],
    yaw: bool,
    yaw_rate: bool,
}

impl TypeMask {
    /// Reads the type mask: the fields to ignore.
    fn of(m: PositionTargetTypemask) -> Result<Self, &'static str> {
        use PositionTargetTypemask as P;
        let has = |flags: [P; 3]| flags.map(|f| m.contains(f));
        let acceleration = has([
            P::POSITION_TARGET_TYPEMASK_AX_IGNORE,
            P::POSITION_TARGET_TYPEMASK_AY_IGNORE,
            P::POSITION_TARGET_TYPEMASK_AZ_IGNORE,
        ]);
        if m.contains(P::POSITION_TARGET_TYPEMASK_FORCE_SET) && acceleration != [true; 3] {
            return Err("Setpoint rejected: force is not supported");
        }
        Ok(Self {
            position: has([
                P::POSITION_TARGET_TYPEMASK_X_IGNORE,
                P::POSITION_TARGET_TYPEMASK_Y_IGNORE,
                P::POSITION_TARGET_TYPEMASK_Z_IGNORE,
            ]),
            velocity: has([
                P::POSITION_TARGET_TYPEMASK_VX_IGNORE,
                P::POSITION_TARGET_TYPEMASK_VY_IGNORE,
                P::POSITION_TARGET_TYPEMASK_VZ_IGNORE,
            ]),
            acceleration,
            yaw: m.contains(P::POSITION_TARGET_TYPEMASK_YAW_IGNORE),
            yaw_rate: m.contains(P::POSITION_TARGET_TYPEMASK_YAW_RATE_IGNORE),
        })
    }
}

/// Returns the three axes; `None` for ignored ones. As in PX4, NaN counts as ignored.
fn axes(values: [f32; 3], ignored: [bool; 3]) -> Result<AxisSetpoints, &'static str> {
    let mut out = [None; 3];
    for k in 0..3 {
        if ignored[k] || values[k].is_nan() {
            continue;
        }
        if values[k].abs() > MAX_FIELD_VALUE {
            return Err("Setpoint rejected: out of range");
        }
        out[k] = Some(f64::from(values[k]));
    }
    Ok(out)
}

fn angle(value: f32, ignored: bool) -> Option<f64> {
    (!ignored && value.is_finite()).then(|| math::wrap_pi(f64::from(value)))
}

fn rate(value: f32, ignored: bool) -> Option<f64> {
    (!ignored && value.is_finite() && value.abs() <= MAX_ANGULAR_RATE_RAD_S).then(|| f64::from(value))
}

/// Requires at least one of position, velocity and acceleration.
fn require_setpoint(s: OffboardSetpoint) -> SetpointResult {
    let is_set = s.position_m.iter().chain(&s.velocity_m_s).chain(&s.acceleration_m_s2).any(Option::is_some);
    if is_set { Ok(s) } else { Err("Setpoint has no position, velocity or acceleration") }
}

/// Converts SET_POSITION_TARGET_LOCAL_NED. In body frames, velocity and acceleration rotate with the heading. A
/// position in a body frame is ignored (PX4) or relative to the vehicle (ArduPilot).
pub fn local(t: &SET_POSITION_TARGET_LOCAL_NED_DATA, view: &VehicleSnapshot) -> SetpointResult {
    use MavFrame as F;
    let mask = TypeMask::of(t.type_mask)?;
    let velocity_m_s = axes([t.vx, t.vy, t.vz], mask.velocity)?;
    let acceleration_m_s2 = axes([t.afx, t.afy, t.afz], mask.acceleration)?;
    let (yaw_rad, yaw_rate_rad_s) = (angle(t.yaw, mask.yaw), rate(t.yaw_rate, mask.yaw_rate));
    let fixed = OffboardSetpoint { velocity_m_s, acceleration_m_s2, yaw_rad, yaw_rate_rad_s, ..OffboardSetpoint::default() };
    match t.coordinate_frame {
        F::MAV_FRAME_LOCAL_NED => {
            let position_m = from_local(axes([t.x, t.y, t.z], mask.position)?, view);
            require_setpoint(OffboardSetpoint { position_m, ..fixed })
        }
        F::MAV_FRAME_LOCAL_OFFSET_NED if view.flavor.offsets => {
            let offset = axes([t.x, t.y, t.z], mask.position)?;
            require_setpoint(OffboardSetpoint { position_m: relative_to_vehicle(offset, view), ..fixed })
        }
        F::MAV_FRAME_BODY_NED | F::MAV_FRAME_BODY_OFFSET_NED | F::MAV_FRAME_BODY_FRD => {
            let heading = view.estimate.attitude.yaw_rad();
            let offsets = view.flavor.offsets && t.coordinate_frame != F::MAV_FRAME_BODY_FRD;
            let offset = if offsets { rotate_to_ned(axes([t.x, t.y, t.z], mask.position)?, heading)? } else { [None; 3] };
            require_setpoint(OffboardSetpoint {
                position_m: relative_to_vehicle(offset, view),
                velocity_m_s: rotate_to_ned(velocity_m_s, heading)?,
                acceleration_m_s2: rotate_to_ned(acceleration_m_s2, heading)?,
                yaw_rad: if offsets { yaw_rad.map(|yaw| math::wrap_pi(heading + yaw)) } else { yaw_rad },
                ..fixed
            })
        }
        _ => Err("Setpoint rejected: unsupported coordinate frame"),
    }
}

/// Converts a position from MAVLink's local frame to the site frame, axis by axis.
fn from_local(local_m: AxisSetpoints, view: &VehicleSnapshot) -> AxisSetpoints {
    let site_m = view.site_from_local(Vec3::assume(local_m.map(|axis| axis.unwrap_or(0.0)).into())).array();
    std::array::from_fn(|k| local_m[k].map(|_| site_m[k]))
}

/// Returns the position at an offset from the vehicle.
fn relative_to_vehicle(offset: AxisSetpoints, view: &VehicleSnapshot) -> AxisSetpoints {
    let here = view.estimate.position_m.array();
    std::array::from_fn(|k| offset[k].map(|offset| here[k] + offset))
}

/// Converts forward, right, down to north, east, down. Forward and right must be set together.
fn rotate_to_ned(frd: AxisSetpoints, heading: f64) -> Result<AxisSetpoints, &'static str> {
    let (s, c) = math::sin_cos(heading);
    match (frd[0], frd[1]) {
        (Some(f), Some(r)) => Ok([Some(c * f - s * r), Some(s * f + c * r), frd[2]]),
        (None, None) => Ok(frd),
        _ => Err("Setpoint rejected: forward or right is missing"),
    }
}

/// Converts SET_POSITION_TARGET_GLOBAL_INT. Terrain altitudes are treated as relative to home: the vehicle has no
/// terrain database.
pub fn global(t: &SET_POSITION_TARGET_GLOBAL_INT_DATA, view: &VehicleSnapshot) -> SetpointResult {
    use MavFrame as F;
    let mask = TypeMask::of(t.type_mask)?;
    let origin = view.plane.origin();
    let home_up = view.status.home_m.map_or(0.0, |h| -h.down());
    let over = match t.coordinate_frame {
        F::MAV_FRAME_GLOBAL | F::MAV_FRAME_GLOBAL_INT => 0.0,
        F::MAV_FRAME_GLOBAL_RELATIVE_ALT
        | F::MAV_FRAME_GLOBAL_RELATIVE_ALT_INT
        | F::MAV_FRAME_GLOBAL_TERRAIN_ALT
        | F::MAV_FRAME_GLOBAL_TERRAIN_ALT_INT => origin.altitude_m + home_up,
        _ => return Err("Setpoint rejected: unsupported coordinate frame"),
    };
    let mut position_m = [None; 3];
    if !mask.position[2] && !t.alt.is_nan() {
        position_m[2] = Some(origin.altitude_m - over - f64::from(t.alt)).filter(|d| d.abs() < MAX_DISTANCE_M);
        if position_m[2].is_none() {
            return Err("Setpoint rejected: out of range");
        }
    }
    if !mask.position[0] || !mask.position[1] {
        let geo = units::geo(t.lat_int, t.lon_int, origin.altitude_m).ok_or("Setpoint rejected: out of range")?;
        let place = view.plane.enu_from_geo(geo);
        if place.norm() > MAX_DISTANCE_M {
            return Err("Setpoint rejected: out of range");
        }
        (position_m[0], position_m[1]) = (Some(place.north()), Some(place.east()));
    }
    require_setpoint(OffboardSetpoint {
        position_m,
        velocity_m_s: axes([t.vx, t.vy, t.vz], mask.velocity)?,
        acceleration_m_s2: axes([t.afx, t.afy, t.afz], mask.acceleration)?,
        yaw_rad: angle(t.yaw, mask.yaw),
        yaw_rate_rad_s: rate(t.yaw_rate, mask.yaw_rate),
        ..OffboardSetpoint::default()
    })
}

/// Converts SET_ATTITUDE_TARGET: an attitude with a yaw rate, or body rates if the attitude is ignored, and a thrust
/// from 0 to 1. If thrust is interpreted as climb rate (`GUID_OPTIONS`), 0.5 holds altitude, and 0 and 1 are the
/// vertical speeds of automatic modes.
pub fn attitude(t: &SET_ATTITUDE_TARGET_DATA, tuning: &Tuning) -> SetpointResult {
    use AttitudeTargetTypemask as A;
    let has = |flag: A| t.type_mask.contains(flag);
    if has(A::ATTITUDE_TARGET_TYPEMASK_THRUST_BODY_SET) {
        return Err("Setpoint rejected: only body-z thrust is supported");
    }
    if has(A::ATTITUDE_TARGET_TYPEMASK_THROTTLE_IGNORE) || !t.thrust.is_finite() {
        return Err("Setpoint rejected: no thrust");
    }
    let thrust = f64::from(t.thrust);
    let climb_m_s = tuning.rules.guided.thrust_is_climb_rate.then(|| {
        let share = 2.0 * (thrust.clamp(0.0, 1.0) - 0.5);
        share * if share > 0.0 { tuning.climb_m_s } else { tuning.descend_m_s }
    });
    let yaw_rate_rad_s = rate(t.body_yaw_rate, has(A::ATTITUDE_TARGET_TYPEMASK_BODY_YAW_RATE_IGNORE));
    if !has(A::ATTITUDE_TARGET_TYPEMASK_ATTITUDE_IGNORE) {
        let attitude = Rotation::from_wxyz(t.q.map(f64::from)).ok_or("Setpoint rejected: invalid attitude")?;
        return Ok(OffboardSetpoint {
            attitude: Some((attitude, thrust)),
            yaw_rate_rad_s,
            climb_m_s,
            ..OffboardSetpoint::default()
        });
    }
    let roll = rate(t.body_roll_rate, has(A::ATTITUDE_TARGET_TYPEMASK_BODY_ROLL_RATE_IGNORE));
    let pitch = rate(t.body_pitch_rate, has(A::ATTITUDE_TARGET_TYPEMASK_BODY_PITCH_RATE_IGNORE));
    if roll.or(pitch).or(yaw_rate_rad_s).is_none() {
        return Err("Setpoint rejected: no attitude or rates");
    }
    let still = |axis: Option<f64>| axis.unwrap_or(0.0);
    let rates = Vec3::new(still(roll), still(pitch), still(yaw_rate_rad_s));
    Ok(OffboardSetpoint { rates: Some((rates, thrust)), climb_m_s, ..OffboardSetpoint::default() })
}
