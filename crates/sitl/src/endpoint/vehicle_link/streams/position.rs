//! Builders for position messages: estimate, target and home.

use super::super::snapshot::VehicleSnapshot;
use spandrel_mavlink::dialect::{
    ALTITUDE_DATA, GLOBAL_POSITION_INT_DATA, GPS_GLOBAL_ORIGIN_DATA, HOME_POSITION_DATA, LOCAL_POSITION_NED_DATA,
    MavEstimatorType, MavFrame, MavMessage, NAV_CONTROLLER_OUTPUT_DATA, ODOMETRY_DATA, ORBIT_EXECUTION_STATUS_DATA,
    POSITION_TARGET_GLOBAL_INT_DATA, POSITION_TARGET_LOCAL_NED_DATA, PositionTargetTypemask, VFR_HUD_DATA,
};
use spandrel_mavlink::units::{cm, deg_e7, heading_cdeg, mm};
use spandrel_model::frames::Vec3;
use spandrel_model::math;

pub(crate) fn local(v: &VehicleSnapshot) -> Option<MavMessage> {
    let [x, y, z] = v.local_from_site(v.estimate.position_m).array().map(|c| c as f32);
    let [vx, vy, vz] = v.estimate.velocity_m_s.array().map(|c| c as f32);
    v.estimate.attitude_valid.then(|| {
        MavMessage::LOCAL_POSITION_NED(LOCAL_POSITION_NED_DATA { time_boot_ms: v.clock.boot_time_ms(), x, y, z, vx, vy, vz })
    })
}

pub(crate) fn global(v: &VehicleSnapshot) -> Option<MavMessage> {
    if !v.estimate.position_valid {
        return None;
    }
    let geo = v.geo();
    let velocity = v.estimate.velocity_m_s;
    Some(MavMessage::GLOBAL_POSITION_INT(GLOBAL_POSITION_INT_DATA {
        time_boot_ms: v.clock.boot_time_ms(),
        lat: deg_e7(geo.latitude_deg),
        lon: deg_e7(geo.longitude_deg),
        alt: mm(geo.altitude_m),
        relative_alt: mm(v.height_above_home_m()),
        vx: cm(velocity.north()),
        vy: cm(velocity.east()),
        vz: cm(velocity.down()),
        hdg: heading_cdeg(v.estimate.attitude.yaw_rad()),
    }))
}

/// Sent only while orbiting.
pub(crate) fn orbit(v: &VehicleSnapshot) -> Option<MavMessage> {
    let orbit = v.status.orbit?;
    let center = v.plane.geo_from_enu(orbit.center_m.enu());
    Some(MavMessage::ORBIT_EXECUTION_STATUS(ORBIT_EXECUTION_STATUS_DATA {
        time_usec: v.clock.boot_time_us(),
        radius: (orbit.radius_m * orbit.speed_m_s.signum()) as f32,
        x: deg_e7(center.latitude_deg),
        y: deg_e7(center.longitude_deg),
        z: center.altitude_m as f32,
        frame: MavFrame::MAV_FRAME_GLOBAL,
    }))
}

/// Type mask that ignores everything except the position.
const POSITION_ONLY: PositionTargetTypemask = IGNORE_VELOCITY.union(IGNORE_ACCELERATION).union(IGNORE_HEADING);
const IGNORE_POSITION: PositionTargetTypemask = PositionTargetTypemask::POSITION_TARGET_TYPEMASK_X_IGNORE
    .union(PositionTargetTypemask::POSITION_TARGET_TYPEMASK_Y_IGNORE)
    .union(PositionTargetTypemask::POSITION_TARGET_TYPEMASK_Z_IGNORE);
const IGNORE_VELOCITY: PositionTargetTypemask = PositionTargetTypemask::POSITION_TARGET_TYPEMASK_VX_IGNORE
    .union(PositionTargetTypemask::POSITION_TARGET_TYPEMASK_VY_IGNORE)
    .union(PositionTargetTypemask::POSITION_TARGET_TYPEMASK_VZ_IGNORE);
const IGNORE_ACCELERATION: PositionTargetTypemask = PositionTargetTypemask::POSITION_TARGET_TYPEMASK_AX_IGNORE
    .union(PositionTargetTypemask::POSITION_TARGET_TYPEMASK_AY_IGNORE)
    .union(PositionTargetTypemask::POSITION_TARGET_TYPEMASK_AZ_IGNORE);
const IGNORE_HEADING: PositionTargetTypemask = PositionTargetTypemask::POSITION_TARGET_TYPEMASK_YAW_IGNORE
    .union(PositionTargetTypemask::POSITION_TARGET_TYPEMASK_YAW_RATE_IGNORE);

/// Undefined bits that ArduCopter sets in POSITION_TARGET_GLOBAL_INT.
const UNUSED_BITS: PositionTargetTypemask = PositionTargetTypemask::from_bits_retain(0xF000);

/// POSITION_TARGET_LOCAL_NED as in PX4: the target position. ArduCopter sends it only in GUIDED, with the fields of the
/// last setpoint.
pub(crate) fn local_target(v: &VehicleSnapshot) -> Option<MavMessage> {
    if v.flavor.goto_mode.is_some() {
        return guided_target(v);
    }
    let mask = IGNORE_VELOCITY | IGNORE_ACCELERATION | PositionTargetTypemask::POSITION_TARGET_TYPEMASK_YAW_RATE_IGNORE;
    let place = v.local_from_site(v.status.target_m?).array();
    Some(target_message(v, mask, [place, [0.0; 3], [0.0; 3]]))
}

/// Selects position, velocity and acceleration by ArduCopter's rules: position alone, all three, velocity and
/// acceleration, or acceleration alone; `None` for attitude setpoints.
fn guided_target(v: &VehicleSnapshot) -> Option<MavMessage> {
    if v.flavor.goto_mode != Some(v.flavor.row_of(v.status.mode, v.requested_mode).number) {
        return None;
    }
    let place = || Some(v.local_from_site(v.status.target_m?).array());
    let still = [0.0; 3];
    let Some(setpoint) = v.status.setpoint else {
        return Some(target_message(v, POSITION_ONLY, [place()?, still, still]));
    };
    if setpoint.attitude.is_some() || setpoint.rates.is_some() {
        return None;
    }
    let has_any = |axes: [Option<f64>; 3]| axes.iter().any(Option::is_some);
    let number = |axes: [Option<f64>; 3]| axes.map(|axis| axis.unwrap_or(0.0));
    let (velocity, acceleration) = (number(setpoint.velocity_m_s), number(setpoint.acceleration_m_s2));
    let moves = has_any(setpoint.velocity_m_s) || has_any(setpoint.acceleration_m_s2);
    let (mask, parts) = match (has_any(setpoint.position_m), moves) {
        (true, false) => (POSITION_ONLY, [place()?, still, still]),
        (true, true) => (IGNORE_HEADING, [place()?, velocity, acceleration]),
        _ if has_any(setpoint.velocity_m_s) => (IGNORE_POSITION | IGNORE_HEADING, [still, velocity, acceleration]),
        _ => (IGNORE_POSITION | IGNORE_VELOCITY | IGNORE_HEADING, [still, still, acceleration]),
    };
    Some(target_message(v, mask, parts))
}

/// Builds the message from position, velocity and acceleration in MAVLink's local frame.
fn target_message(v: &VehicleSnapshot, type_mask: PositionTargetTypemask, parts: [[f64; 3]; 3]) -> MavMessage {
    let [[x, y, z], [vx, vy, vz], [afx, afy, afz]] = parts.map(|part| part.map(|c| c as f32));
    MavMessage::POSITION_TARGET_LOCAL_NED(POSITION_TARGET_LOCAL_NED_DATA {
        time_boot_ms: v.clock.boot_time_ms(),
        x,
        y,
        z,
        vx,
        vy,
        vz,
        afx,
        afy,
        afz,
        type_mask,
        coordinate_frame: MavFrame::MAV_FRAME_LOCAL_NED,
        ..Default::default()
    })
}

/// The target position, above mean sea level. Not sent for velocity and acceleration setpoints.
pub(crate) fn global_target(v: &VehicleSnapshot) -> Option<MavMessage> {
    let placed = v.status.setpoint.is_none_or(|s| s.position_m.iter().any(Option::is_some) && s.velocity_m_s == [None; 3]);
    let flies_itself = !v.status.mode.is_manual();
    let geo = v.plane.geo_from_enu(v.status.target_m.filter(|_| placed && flies_itself)?.enu());
    Some(MavMessage::POSITION_TARGET_GLOBAL_INT(POSITION_TARGET_GLOBAL_INT_DATA {
        time_boot_ms: v.clock.boot_time_ms(),
        lat_int: deg_e7(geo.latitude_deg),
        lon_int: deg_e7(geo.longitude_deg),
        alt: geo.altitude_m as f32,
        type_mask: POSITION_ONLY | UNUSED_BITS,
        coordinate_frame: MavFrame::MAV_FRAME_GLOBAL,
        ..Default::default()
    }))
}

pub(crate) fn altitude(v: &VehicleSnapshot) -> Option<MavMessage> {
    let [_, _, local_down] = v.local_from_site(v.estimate.position_m).array();
    let up = -v.estimate.position_m.down();
    let amsl = v.plane.origin().altitude_m + up;
    let below = v.readings.range_down_m.filter(|r| r.is_finite());
    v.estimate.attitude_valid.then(|| {
        MavMessage::ALTITUDE(ALTITUDE_DATA {
            time_usec: v.clock.boot_time_us(),
            altitude_monotonic: amsl as f32,
            altitude_amsl: amsl as f32,
            altitude_local: -local_down as f32,
            altitude_relative: v.height_above_home_m() as f32,
            altitude_terrain: f32::NAN,
            bottom_clearance: below.map_or(f32::NAN, |r| r as f32),
        })
    })
}

pub(crate) fn home(v: &VehicleSnapshot) -> Option<MavMessage> {
    let home = v.status.home_m?;
    let geo = v.plane.geo_from_enu(home.enu());
    let [x, y, z] = v.local_from_site(home).array().map(|c| c as f32);
    Some(MavMessage::HOME_POSITION(HOME_POSITION_DATA {
        latitude: deg_e7(geo.latitude_deg),
        longitude: deg_e7(geo.longitude_deg),
        altitude: mm(geo.altitude_m),
        x,
        y,
        z,
        q: [1.0, 0.0, 0.0, 0.0],
        approach_z: 0.0,
        time_usec: v.clock.boot_time_us(),
        ..Default::default()
    }))
}

pub(crate) fn origin(v: &VehicleSnapshot) -> Option<MavMessage> {
    let geo = v.local_origin()?;
    Some(MavMessage::GPS_GLOBAL_ORIGIN(GPS_GLOBAL_ORIGIN_DATA {
        latitude: deg_e7(geo.latitude_deg),
        longitude: deg_e7(geo.longitude_deg),
        altitude: mm(geo.altitude_m),
        time_usec: v.clock.boot_time_us(),
    }))
}

pub(crate) fn odometry(v: &VehicleSnapshot) -> Option<MavMessage> {
    let [x, y, z] = v.local_from_site(v.estimate.position_m).array().map(|c| c as f32);
    let body: Vec3<_> = v.estimate.attitude.inverse() * v.estimate.velocity_m_s;
    let w = v.estimate.rates_rad_s;
    let mut pose_covariance = [f32::NAN; 21];
    pose_covariance[0] = (0.5 * v.estimate.horizontal_m * v.estimate.horizontal_m) as f32;
    Some(MavMessage::ODOMETRY(ODOMETRY_DATA {
        time_usec: v.clock.boot_time_us(),
        x,
        y,
        z,
        q: v.estimate.attitude.wxyz().map(|c| c as f32),
        vx: body.forward() as f32,
        vy: body.right() as f32,
        vz: body.down() as f32,
        rollspeed: w.forward() as f32,
        pitchspeed: w.right() as f32,
        yawspeed: w.down() as f32,
        pose_covariance,
        velocity_covariance: [f32::NAN; 21],
        frame_id: MavFrame::MAV_FRAME_LOCAL_NED,
        child_frame_id: MavFrame::MAV_FRAME_BODY_FRD,
        reset_counter: ((v.scoring.respawns + v.scoring.rewinds).wrapping_add(v.status.position_resets.cast_signed()) & 0xff)
            as u8,
        estimator_type: MavEstimatorType::MAV_ESTIMATOR_TYPE_AUTOPILOT,
        quality: 100,
    }))
}

pub(crate) fn hud(v: &VehicleSnapshot) -> Option<MavMessage> {
    let e = v.estimate;
    let heading = e.attitude.yaw_rad().to_degrees().rem_euclid(360.0);
    Some(MavMessage::VFR_HUD(VFR_HUD_DATA {
        airspeed: (e.velocity_m_s - v.wind_m_s).norm() as f32,
        groundspeed: e.velocity_m_s.horizontal_norm() as f32,
        alt: (v.plane.origin().altitude_m - e.position_m.down()) as f32,
        climb: -e.velocity_m_s.down() as f32,
        heading: (heading.round() as i16) % 360,
        throttle: (v.status.thrust * 100.0).clamp(0.0, 100.0) as u16,
    }))
}

/// The navigation controller's output and the distance to the target; the distance is zero without a target.
pub(crate) fn navigation(v: &VehicleSnapshot) -> Option<MavMessage> {
    let here = v.estimate.position_m;
    let left = v.status.target_m.map_or(Vec3::zero(), |target| target - here);
    let bearing = |east: f64, north: f64| math::atan2(east, north).to_degrees().round() as i16;
    let (roll, pitch, yaw) = v.status.attitude_target.euler();
    Some(MavMessage::NAV_CONTROLLER_OUTPUT(NAV_CONTROLLER_OUTPUT_DATA {
        nav_roll: roll.to_degrees() as f32,
        nav_pitch: pitch.to_degrees() as f32,
        alt_error: -left.down() as f32,
        nav_bearing: yaw.to_degrees().round() as i16,
        target_bearing: bearing(left.east(), left.north()),
        wp_dist: left.horizontal_norm().round().clamp(0.0, 65_535.0) as u16,
        ..Default::default()
    }))
}
