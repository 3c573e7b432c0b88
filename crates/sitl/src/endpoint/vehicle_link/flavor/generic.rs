//! A generic MAVLink interface without an autopilot's dialect. It offers MAVLink's standard modes where they exist. The
//! standard does not define custom mode numbers, so this interface uses PX4's, which many SDKs and recorders assume.

use super::definition::{COMMON_CAPABILITIES, Flavor, ModeRow, TakeOffRule, named_mode};
use super::px4::{self, row};
use crate::autopilot::FlightMode;
use crate::endpoint::vehicle_link::calibration::CalibrationTexts;
use crate::endpoint::vehicle_link::params::param_view;
use spandrel_mavlink::dialect::{MavAutopilot, MavProtocolCapability, MavStandardMode as S, MavVtolState};

const MODES: &[ModeRow] = &[
    row(FlightMode::Position, (3, 0), "Position hold", S::MAV_STANDARD_MODE_POSITION_HOLD, false, true),
    row(FlightMode::Altitude, (2, 0), "Altitude hold", S::MAV_STANDARD_MODE_ALTITUDE_HOLD, false, true),
    row(FlightMode::Takeoff, (4, 2), "Take-off", S::MAV_STANDARD_MODE_TAKEOFF, true, true),
    row(FlightMode::Mission, (4, 4), "Mission", S::MAV_STANDARD_MODE_MISSION, true, true),
    row(FlightMode::Return, (4, 5), "Safe recovery", S::MAV_STANDARD_MODE_SAFE_RECOVERY, true, true)
        .also_showing(&[FlightMode::SmartReturn]),
    row(FlightMode::Land, (4, 6), "Land", S::MAV_STANDARD_MODE_LAND, true, true),
    row(FlightMode::Orbit, (3, 1), "Orbit", S::MAV_STANDARD_MODE_ORBIT, true, false),
    row(FlightMode::Hold, (4, 3), "Hold", S::MAV_STANDARD_MODE_NON_STANDARD, true, false).also_showing(&[FlightMode::Follow]),
    row(FlightMode::Stabilized, (7, 0), "Stabilized", S::MAV_STANDARD_MODE_NON_STANDARD, false, false)
        .also_showing(&[FlightMode::Acro]),
    row(FlightMode::Offboard, (6, 0), "Offboard", S::MAV_STANDARD_MODE_NON_STANDARD, true, false),
];

/// The generic interface.
pub static FLAVOR: Flavor = Flavor {
    name: "generic",
    autopilot: MavAutopilot::MAV_AUTOPILOT_GENERIC,
    software_version: VERSION,
    capabilities: COMMON_CAPABILITIES.union(MavProtocolCapability::MAV_PROTOCOL_CAPABILITY_PARAM_ENCODE_BYTEWISE),
    modes: MODES,
    mode_bits: px4::MODE_BITS,
    custom_mode,
    custom_flag: false,
    state: px4::state,
    goto_mode: None,
    take_off: TakeOffRule::AboveSeaLevel,
    force: &[px4::FORCE_VALUE],
    roi_altitude_above_sea_level: false,
    refusals: px4::REFUSALS,
    arming_check_prefix: None,
    prearm_reason_prefix: "Preflight Fail: ",
    sensor_text: |_| None,
    mode_rejection_text: named_mode,
    banner: &[],
    sends_message_after_ack: false,
    streams_on_request_only: false,
    groups: px4::GROUPS,
    ardupilot_dialect: false,
    calibration: CalibrationTexts::Px4,
    shell: false,
    events: false,
    terrain: true,
    loiter_mode: None,
    offsets: false,
    pauses: false,
    vtol_state: MavVtolState::MAV_VTOL_STATE_UNDEFINED,
    splines: false,
    zero_means_current_position: false,
    home_item: false,
    uses_float_items: false,
    params: &param_view::GENERIC,
    tune: |_| {},
};

/// This software's major and minor version.
const VERSION: u32 = digits(env!("CARGO_PKG_VERSION_MAJOR")) << 24 | digits(env!("CARGO_PKG_VERSION_MINOR")) << 16;

const fn digits(text: &str) -> u32 {
    let (bytes, mut at, mut value) = (text.as_bytes(), 0, 0);
    while at < bytes.len() {
        value = 10 * value + (bytes[at] - b'0') as u32;
        at += 1;
    }
    value
}

/// Returns the custom mode. According to the standard, parameter 2 is the complete custom mode; SDKs that assume PX4
/// send main and sub mode instead.
fn custom_mode(main: f64, sub: f64) -> u32 {
    if (256.0..4_294_967_296.0).contains(&main) { main as u32 } else { px4::main_and_sub(main, sub) }
}
