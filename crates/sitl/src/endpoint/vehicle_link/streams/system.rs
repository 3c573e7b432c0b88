//! Builders for messages with the overall vehicle state.
#![allow(deprecated, reason = "clients still request PROTOCOL_VERSION")]

use super::super::params::metadata;
use super::super::snapshot::VehicleSnapshot;
use crate::autopilot::fence::Breach;
use crate::autopilot::{FlightMode, LandedState};
use crate::endpoint::payload::streams::battery;
use spandrel_mavlink::dialect::{
    ACTUATOR_OUTPUT_STATUS_DATA, AUTOPILOT_VERSION_DATA, COMPONENT_INFORMATION_DATA, COMPONENT_METADATA_DATA, CURRENT_MODE_DATA,
    ESTIMATOR_STATUS_DATA, EXTENDED_SYS_STATE_DATA, EstimatorStatusFlags, FENCE_STATUS_DATA, FLIGHT_INFORMATION_DATA,
    FenceBreach, HEARTBEAT_DATA, MISSION_CURRENT_DATA, MavBatteryChargeState, MavLandedState, MavMessage, MavModeFlag,
    MavSysStatusSensor, MavSysStatusSensorExtended, MavType, MissionState, PROTOCOL_VERSION_DATA, SERVO_OUTPUT_RAW_DATA,
    SYS_STATUS_DATA, SYSTEM_TIME_DATA, VIBRATION_DATA, WIND_COV_DATA,
};
use spandrel_model::time::SimTime;

pub(crate) fn heartbeat(v: &VehicleSnapshot) -> Option<MavMessage> {
    let row = v.mode_row();
    let mut base = row.base;
    base.set(MavModeFlag::MAV_MODE_FLAG_SAFETY_ARMED, v.status.armed);
    Some(MavMessage::HEARTBEAT(HEARTBEAT_DATA {
        custom_mode: row.number,
        mavtype: MavType::MAV_TYPE_QUADROTOR,
        autopilot: v.flavor.autopilot,
        base_mode: base,
        system_status: (v.flavor.state)(v.estimate, v.status),
        mavlink_version: 3,
    }))
}

pub(crate) fn sys_status(v: &VehicleSnapshot) -> Option<MavMessage> {
    use MavSysStatusSensor as S;
    let mut present = S::MAV_SYS_STATUS_SENSOR_3D_GYRO
        | S::MAV_SYS_STATUS_SENSOR_3D_ACCEL
        | S::MAV_SYS_STATUS_SENSOR_3D_MAG
        | S::MAV_SYS_STATUS_SENSOR_ABSOLUTE_PRESSURE
        | S::MAV_SYS_STATUS_SENSOR_GPS
        | S::MAV_SYS_STATUS_SENSOR_ANGULAR_RATE_CONTROL
        | S::MAV_SYS_STATUS_SENSOR_ATTITUDE_STABILIZATION
        | S::MAV_SYS_STATUS_SENSOR_Z_ALTITUDE_CONTROL
        | S::MAV_SYS_STATUS_SENSOR_XY_POSITION_CONTROL
        | S::MAV_SYS_STATUS_SENSOR_MOTOR_OUTPUTS
        | S::MAV_SYS_STATUS_SENSOR_BATTERY
        | S::MAV_SYS_STATUS_AHRS
        | S::MAV_SYS_STATUS_PREARM_CHECK;
    if v.vehicle.sensors.flow_velocity_m_s > 0.0 {
        present |= S::MAV_SYS_STATUS_SENSOR_OPTICAL_FLOW;
    }
    if v.status.fence.set {
        present |= S::MAV_SYS_STATUS_GEOFENCE;
    }
    let enabled = present;
    if v.flavor.home_item {
        present |= S::MAV_SYS_STATUS_GEOFENCE;
    }
    // Reported as healthy even without a fence, because MAVProxy would interpret a missing flag as a breach.
    let mut health = present | S::MAV_SYS_STATUS_GEOFENCE;
    health.set(S::MAV_SYS_STATUS_GEOFENCE, v.status.fence.breach.is_none());
    let fix = v.readings.gnss.is_some_and(|g| g.fix >= 3);
    let works = v.status.health;
    health.set(S::MAV_SYS_STATUS_SENSOR_GPS, fix && works.gnss && v.estimate.position_valid);
    health.set(S::MAV_SYS_STATUS_AHRS, v.estimate.attitude_valid);
    health.set(S::MAV_SYS_STATUS_SENSOR_3D_MAG, works.compass);
    health.set(S::MAV_SYS_STATUS_SENSOR_ABSOLUTE_PRESSURE, works.barometer);
    health.set(S::MAV_SYS_STATUS_SENSOR_ATTITUDE_STABILIZATION, works.tracks_attitude);
    health.set(S::MAV_SYS_STATUS_PREARM_CHECK, v.status.armed || v.status.arming_blockers.is_empty());
    Some(MavMessage::SYS_STATUS(SYS_STATUS_DATA {
        onboard_control_sensors_present: present,
        onboard_control_sensors_enabled: enabled,
        onboard_control_sensors_health: health,
        load: 50,
        voltage_battery: (v.battery.voltage_v * 1000.0).round() as u16,
        current_battery: (v.battery.current_a * 100.0).round() as i16,
        battery_remaining: battery::percent(v.battery),
        onboard_control_sensors_present_extended: MavSysStatusSensorExtended::empty(),
        onboard_control_sensors_enabled_extended: MavSysStatusSensorExtended::empty(),
        onboard_control_sensors_health_extended: MavSysStatusSensorExtended::empty(),
        ..Default::default()
    }))
}

pub(crate) fn battery(v: &VehicleSnapshot) -> Option<MavMessage> {
    let state = match v.battery.remaining_pct() {
        p if p < v.status.battery_critical_pct => MavBatteryChargeState::MAV_BATTERY_CHARGE_STATE_CRITICAL,
        p if p < v.status.battery_low_pct => MavBatteryChargeState::MAV_BATTERY_CHARGE_STATE_LOW,
        _ => MavBatteryChargeState::MAV_BATTERY_CHARGE_STATE_OK,
    };
    Some(battery::status(&v.vehicle.battery, v.battery, state))
}

pub(crate) fn system_time(v: &VehicleSnapshot) -> Option<MavMessage> {
    Some(MavMessage::SYSTEM_TIME(SYSTEM_TIME_DATA {
        time_unix_usec: v.clock.unix_time_us(),
        time_boot_ms: v.clock.boot_time_ms(),
    }))
}

pub(crate) fn extended_state(v: &VehicleSnapshot) -> Option<MavMessage> {
    let landed_state = match v.status.landed {
        LandedState::OnGround => MavLandedState::MAV_LANDED_STATE_ON_GROUND,
        LandedState::TakingOff => MavLandedState::MAV_LANDED_STATE_TAKEOFF,
        // As in PX4 and ArduPilot, the state lasts until the takeoff height is reached.
        LandedState::InAir if v.status.climbing_out => MavLandedState::MAV_LANDED_STATE_TAKEOFF,
        LandedState::InAir => MavLandedState::MAV_LANDED_STATE_IN_AIR,
        LandedState::Landing => MavLandedState::MAV_LANDED_STATE_LANDING,
    };
    let vtol_state = v.flavor.vtol_state;
    Some(MavMessage::EXTENDED_SYS_STATE(EXTENDED_SYS_STATE_DATA { vtol_state, landed_state }))
}

pub(crate) fn servos(v: &VehicleSnapshot) -> Option<MavMessage> {
    let pwm = |k: usize| if v.actuators.armed { 1000 + (v.actuators.motors[k] * 1000.0) as u16 } else { 900 };
    // The lamp as a servo output; see DO_SET_SERVO.
    let lamp = if v.lamp.on { 1900 } else { 1100 };
    Some(MavMessage::SERVO_OUTPUT_RAW(SERVO_OUTPUT_RAW_DATA {
        time_usec: v.clock.boot_time_us() as u32,
        servo1_raw: pwm(0),
        servo2_raw: pwm(1),
        servo3_raw: pwm(2),
        servo4_raw: pwm(3),
        servo9_raw: if v.vehicle.lamp.luminous_flux_lm > 0.0 { lamp } else { 0 },
        ..Default::default()
    }))
}

/// Sends the motor outputs as pulse widths, microseconds.
pub(crate) fn outputs(v: &VehicleSnapshot) -> Option<MavMessage> {
    let rotors = v.vehicle.rotors.len().min(v.actuators.motors.len());
    let mut actuator = [0.0; 32];
    for (slot, motor) in actuator.iter_mut().zip(&v.actuators.motors[..rotors]) {
        *slot = if v.actuators.armed { (1000.0 + 1000.0 * motor) as f32 } else { 900.0 };
    }
    Some(MavMessage::ACTUATOR_OUTPUT_STATUS(ACTUATOR_OUTPUT_STATUS_DATA {
        time_usec: v.clock.boot_time_us(),
        active: rotors as u32,
        actuator,
    }))
}

pub(crate) fn estimator(v: &VehicleSnapshot) -> Option<MavMessage> {
    let mut flags = EstimatorStatusFlags::empty();
    flags.set(EstimatorStatusFlags::ESTIMATOR_ATTITUDE, v.estimate.attitude_valid);
    for flag in [
        EstimatorStatusFlags::ESTIMATOR_VELOCITY_HORIZ,
        EstimatorStatusFlags::ESTIMATOR_VELOCITY_VERT,
        EstimatorStatusFlags::ESTIMATOR_POS_HORIZ_ABS,
        EstimatorStatusFlags::ESTIMATOR_POS_VERT_ABS,
    ] {
        flags.set(flag, v.estimate.position_valid);
    }
    Some(MavMessage::ESTIMATOR_STATUS(ESTIMATOR_STATUS_DATA {
        time_usec: v.clock.boot_time_us(),
        pos_horiz_accuracy: v.estimate.horizontal_m as f32,
        pos_vert_accuracy: v.estimate.vertical_m as f32,
        flags,
        ..Default::default()
    }))
}

pub(crate) fn wind(v: &VehicleSnapshot) -> Option<MavMessage> {
    let [x, y, z] = v.wind_m_s.array().map(|c| c as f32);
    Some(MavMessage::WIND_COV(WIND_COV_DATA {
        time_usec: v.clock.boot_time_us(),
        wind_x: x,
        wind_y: y,
        wind_z: z,
        wind_alt: v.geo().altitude_m as f32,
        ..Default::default()
    }))
}

pub(crate) fn vibration(v: &VehicleSnapshot) -> Option<MavMessage> {
    Some(MavMessage::VIBRATION(VIBRATION_DATA { time_usec: v.clock.boot_time_us(), ..Default::default() }))
}

pub(crate) fn mission_current(v: &VehicleSnapshot) -> Option<MavMessage> {
    let flying = v.status.mode == FlightMode::Mission;
    let state = match (v.status.mode, v.status.mission_finished) {
        _ if v.plans.mission_items == 0 => MissionState::MISSION_STATE_NO_MISSION,
        (_, true) => MissionState::MISSION_STATE_COMPLETE,
        (FlightMode::Mission, _) if v.status.armed && !v.status.mission_paused => MissionState::MISSION_STATE_ACTIVE,
        _ if v.status.mission_paused => MissionState::MISSION_STATE_PAUSED,
        _ => MissionState::MISSION_STATE_NOT_STARTED,
    };
    // When the mission is complete, the last item remains current.
    let item = (v.status.mission_current as u16).min(v.plans.mission_items.saturating_sub(1));
    Some(MavMessage::MISSION_CURRENT(MISSION_CURRENT_DATA {
        seq: if v.plans.mission_items == 0 { 0 } else { v.plans.lead } + item,
        total: v.plans.mission_items,
        mission_state: state,
        // 1 means in mission mode, and 2 means not in mission mode.
        mission_mode: if flying { 1 } else { 2 },
        mission_id: v.plans.ids[0],
        fence_id: v.plans.ids[1],
        rally_points_id: v.plans.ids[2],
    }))
}

pub(crate) fn fence(v: &VehicleSnapshot) -> Option<MavMessage> {
    // ArduPilot does not report a disabled fence.
    if v.flavor.home_item && !v.fence_enabled {
        return None;
    }
    let fence = &v.status.fence;
    let breach_type = match fence.breach {
        None => FenceBreach::FENCE_BREACH_NONE,
        Some(Breach::Floor) => FenceBreach::FENCE_BREACH_MINALT,
        Some(Breach::Height) => FenceBreach::FENCE_BREACH_MAXALT,
        Some(Breach::Boundary) => FenceBreach::FENCE_BREACH_BOUNDARY,
    };
    Some(MavMessage::FENCE_STATUS(FENCE_STATUS_DATA {
        breach_time: fence.at.ms() as u32,
        breach_count: fence.count,
        breach_status: u8::from(fence.breach.is_some()),
        breach_type,
        ..Default::default()
    }))
}

pub(crate) fn current_mode(v: &VehicleSnapshot) -> Option<MavMessage> {
    let row = v.mode_row();
    let acts = v.status.failsafe.is_some();
    let intended = if acts { v.flavor.row_of(v.status.intended, v.requested_mode) } else { row };
    Some(MavMessage::CURRENT_MODE(CURRENT_MODE_DATA {
        custom_mode: row.number,
        intended_custom_mode: intended.number,
        standard_mode: row.standard,
    }))
}

/// Identifiers "SP" and "TR" (trainer); they are not registered USB IDs.
const VENDOR_ID: u16 = 0x5350;
const PRODUCT_ID: u16 = 0x5452;
/// The first simulated board; not in the registered board lists.
const BOARD_VERSION: u32 = 1 << 8;

pub(crate) fn version(v: &VehicleSnapshot) -> Option<MavMessage> {
    Some(MavMessage::AUTOPILOT_VERSION(AUTOPILOT_VERSION_DATA {
        capabilities: v.flavor.capabilities,
        uid: 0x5350_414e_4452_454c + u64::from(v.scoring.seed.unsigned_abs()) + (u64::from(v.system_id) << 32),
        vendor_id: VENDOR_ID,
        product_id: PRODUCT_ID,
        board_version: BOARD_VERSION,
        flight_sw_version: v.flavor.software_version,
        middleware_sw_version: v.flavor.software_version,
        ..Default::default()
    }))
}

/// Sends the parameter metadata's location.
pub(crate) fn metadata(v: &VehicleSnapshot) -> Option<MavMessage> {
    let general = &metadata::files(v.flavor.params).general;
    let uri = general.uri.as_str().into();
    Some(MavMessage::COMPONENT_METADATA(COMPONENT_METADATA_DATA {
        time_boot_ms: v.clock.boot_time_ms(),
        file_crc: general.crc,
        uri,
    }))
}

/// The same location for older clients.
pub(crate) fn information(v: &VehicleSnapshot) -> Option<MavMessage> {
    let general = &metadata::files(v.flavor.params).general;
    Some(MavMessage::COMPONENT_INFORMATION(COMPONENT_INFORMATION_DATA {
        time_boot_ms: v.clock.boot_time_ms(),
        general_metadata_file_crc: general.crc,
        general_metadata_uri: general.uri.as_str().into(),
        ..Default::default()
    }))
}

pub(crate) fn protocol(_: &VehicleSnapshot) -> Option<MavMessage> {
    Some(MavMessage::PROTOCOL_VERSION(PROTOCOL_VERSION_DATA {
        version: 200,
        min_version: 100,
        max_version: 200,
        ..Default::default()
    }))
}

pub(crate) fn flight(v: &VehicleSnapshot) -> Option<MavMessage> {
    let us = |at: Option<SimTime>| at.map_or(0, |at| v.clock.since_boot(at).us().max(1).cast_unsigned());
    // Times since boot and a counter, despite the field names (MAVLink common).
    Some(MavMessage::FLIGHT_INFORMATION(FLIGHT_INFORMATION_DATA {
        arming_time_utc: us(v.flight.armed),
        takeoff_time_utc: us(v.flight.took_off_at),
        flight_uuid: v.flight.number,
        time_boot_ms: v.clock.boot_time_ms(),
        landing_time: v.flight.landed.map_or(0, |at| v.clock.since_boot(at).ms() as u32),
    }))
}
