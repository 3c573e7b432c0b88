//! PX4's interface: custom_mode contains the main mode in bits 16 to 23 and the sub mode in bits 24 to 31
//! (docs/src/reference/wire.md, "Autopilot interfaces"; recorded from a real PX4).

use super::definition::{COMMON_CAPABILITIES, Flavor, ModeRow, RefusalResults, TakeOffRule, named_mode};
use crate::autopilot::sensor_health::{MonitoredSensor, SensorChange, SensorFault};
use crate::autopilot::{AutopilotRequest, AutopilotStatus, Estimate, FlightMode};
use crate::endpoint::vehicle_link::calibration::CalibrationTexts;
use crate::endpoint::vehicle_link::params::param_view;
use spandrel_mavlink::dialect::{
    MavAutopilot, MavModeFlag as F, MavProtocolCapability, MavResult, MavSeverity, MavStandardMode as S, MavState, MavVtolState,
};

const BASE_MODE: F = F::MAV_MODE_FLAG_CUSTOM_MODE_ENABLED.union(F::MAV_MODE_FLAG_STABILIZE_ENABLED);
const MANUAL: F = BASE_MODE.union(F::MAV_MODE_FLAG_MANUAL_INPUT_ENABLED);
const AUTONOMOUS: F = BASE_MODE.union(F::MAV_MODE_FLAG_AUTO_ENABLED).union(F::MAV_MODE_FLAG_GUIDED_ENABLED);

/// Creates a row from main and sub mode.
pub(super) const fn row(
    mode: FlightMode,
    (main, sub): (u8, u8),
    name: &'static str,
    standard: S,
    auto: bool,
    selectable: bool,
) -> ModeRow {
    ModeRow {
        number: (main as u32) << 16 | (sub as u32) << 24,
        mode,
        request: AutopilotRequest::SetMode(mode),
        mode_without_sticks: None,
        only_if_requested: false,
        also_shown_for: &[],
        name,
        standard,
        base: if auto { AUTONOMOUS } else { MANUAL },
        auto,
        selectable,
        armable: true,
    }
}

const MODES: &[ModeRow] = &[
    row(FlightMode::Position, (3, 0), "Position", S::MAV_STANDARD_MODE_POSITION_HOLD, false, true),
    row(FlightMode::Altitude, (2, 0), "Altitude", S::MAV_STANDARD_MODE_ALTITUDE_HOLD, false, true),
    row(FlightMode::Stabilized, (7, 0), "Stabilized", S::MAV_STANDARD_MODE_NON_STANDARD, false, true),
    row(FlightMode::Hold, (4, 3), "Hold", S::MAV_STANDARD_MODE_NON_STANDARD, true, true),
    row(FlightMode::Takeoff, (4, 2), "Takeoff", S::MAV_STANDARD_MODE_TAKEOFF, true, true),
    row(FlightMode::Mission, (4, 4), "Mission", S::MAV_STANDARD_MODE_MISSION, true, true),
    row(FlightMode::Return, (4, 5), "Return", S::MAV_STANDARD_MODE_SAFE_RECOVERY, true, true)
        .also_showing(&[FlightMode::SmartReturn]),
    row(FlightMode::Land, (4, 6), "Land", S::MAV_STANDARD_MODE_LAND, true, true),
    row(FlightMode::Orbit, (3, 1), "Orbit", S::MAV_STANDARD_MODE_ORBIT, true, false),
    row(FlightMode::Offboard, (6, 0), "Offboard", S::MAV_STANDARD_MODE_NON_STANDARD, true, false),
    row(FlightMode::Follow, (4, 8), "Follow Me", S::MAV_STANDARD_MODE_NON_STANDARD, true, true),
    row(FlightMode::Acro, (5, 0), "Acro", S::MAV_STANDARD_MODE_NON_STANDARD, false, true),
];
/// Bits that encode the main and sub mode.
pub(super) const MODE_BITS: u32 = 0xFFFF_0000;

/// PX4's interface (docs/src/reference/wire.md, "Autopilot interfaces"). Reports a development version so that ground
/// stations do not offer an update.
pub static FLAVOR: Flavor = Flavor {
    name: "px4",
    autopilot: MavAutopilot::MAV_AUTOPILOT_PX4,
    software_version: 1 << 24 | 16 << 16,
    capabilities: COMMON_CAPABILITIES.union(MavProtocolCapability::MAV_PROTOCOL_CAPABILITY_PARAM_ENCODE_BYTEWISE),
    modes: MODES,
    mode_bits: MODE_BITS,
    custom_mode: main_and_sub,
    custom_flag: false,
    state,
    goto_mode: None,
    take_off: TakeOffRule::AboveSeaLevel,
    force: &[FORCE_VALUE],
    // PX4's navigator uses the altitude without checking the frame. MAVSDK's gimbal plugin relies on it: it sends
    // altitudes above mean sea level in a home-relative frame.
    roi_altitude_above_sea_level: true,
    refusals: REFUSALS,
    arming_check_prefix: None,
    prearm_reason_prefix: "Preflight Fail: ",
    sensor_text: sensor_failure_text,
    mode_rejection_text: named_mode,
    banner: &[],
    sends_message_after_ack: false,
    streams_on_request_only: false,
    groups: GROUPS,
    ardupilot_dialect: false,
    calibration: CalibrationTexts::Px4,
    shell: true,
    events: true,
    terrain: false,
    loiter_mode: None,
    offsets: false,
    pauses: false,
    vtol_state: MavVtolState::MAV_VTOL_STATE_UNDEFINED,
    splines: false,
    zero_means_current_position: false,
    home_item: false,
    uses_float_items: false,
    params: &param_view::PX4,
    tune: |_| {},
};

/// Magic value that forces arming or disarming (MAVLink common, COMPONENT_ARM_DISARM param2).
pub(super) const FORCE_VALUE: f64 = 21196.0;
/// Results that PX4 sends for rejected requests.
pub(super) const REFUSALS: RefusalResults = RefusalResults {
    temporary_rejection: MavResult::MAV_RESULT_TEMPORARILY_REJECTED,
    denied: MavResult::MAV_RESULT_DENIED,
    unknown_mode: MavResult::MAV_RESULT_DENIED,
    message: MavResult::MAV_RESULT_DENIED,
    interval: MavResult::MAV_RESULT_FAILED,
};
/// Message groups of the superseded REQUEST_DATA_STREAM.
pub(super) const GROUPS: &[(u8, &[u32])] = &[
    (1, &[24, 29, 105]),
    (2, &[1, 147, 230, 42, 24]),
    (3, &[65, 36]),
    (6, &[33, 32]),
    (10, &[30, 31]),
    (11, &[74]),
    (12, &[2, 242, 231]),
];

/// Converts the main and sub mode of DO_SET_MODE; returns an invalid mode for values other than small integers.
pub(super) fn main_and_sub(main: f64, sub: f64) -> u32 {
    let byte = |value: f64| if (0.0..256.0).contains(&value) { Some(value as u32) } else { None };
    match (byte(main), byte(sub)) {
        (Some(main), Some(sub)) => main << 16 | sub << 24,
        _ => u32::MAX,
    }
}

pub(super) fn state(_: &Estimate, status: &AutopilotStatus) -> MavState {
    match (&status.failsafe, status.armed) {
        (Some(_), _) => MavState::MAV_STATE_CRITICAL,
        (None, true) => MavState::MAV_STATE_ACTIVE,
        (None, false) => MavState::MAV_STATE_STANDBY,
    }
}

/// Returns PX4's text for a failed sensor, with type and reason ("BARO #0 failed: STALE!"); a missing sensor gets the
/// default text.
fn sensor_failure_text(change: SensorChange) -> Option<(MavSeverity, String)> {
    let reason = match change.fault? {
        SensorFault::NoReadings => return None,
        SensorFault::Stuck => "STALE",
        SensorFault::Inconsistent => "INCONSISTENT",
    };
    let kind = match change.sensor {
        MonitoredSensor::Compass => "MAG",
        MonitoredSensor::Barometer => "BARO",
        MonitoredSensor::Gnss => "GPS",
    };
    Some((MavSeverity::MAV_SEVERITY_EMERGENCY, format!("{kind} #0 failed: {reason}!")))
}
