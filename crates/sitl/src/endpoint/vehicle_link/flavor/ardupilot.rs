//! ArduPilot's interface, as implemented by ArduCopter (docs/src/reference/wire.md, "Autopilot interfaces"; recorded
//! from a real ArduCopter 4.7-dev, parameter names as in 4.6).
#![allow(deprecated, reason = "ArduPilot reports its encoding with the older capability flag")]

use super::definition::{COMMON_CAPABILITIES, Flavor, ModeRow, RefusalResults, TakeOffRule};
use super::px4::FORCE_VALUE;
use crate::autopilot::sensor_health::{MonitoredSensor, SensorChange, SensorFault};
use crate::autopilot::{AutopilotRequest, AutopilotStatus, Estimate, FlightMode, LandedState};
use crate::endpoint::vehicle_link::calibration::CalibrationTexts;
use crate::endpoint::vehicle_link::params::param_view;
use spandrel_mavlink::dialect::{
    MavAutopilot, MavModeFlag as F, MavProtocolCapability, MavResult, MavSeverity, MavStandardMode as S, MavState, MavVtolState,
};

/// Copter's mode numbers: the mode for go-to commands, the mode for NAV_LOITER_UNLIM, and the mode that flies the
/// mission's landing sequence.
const GUIDED: u32 = 4;
const LOITER: u32 = 5;
const AUTO_RTL: u32 = 27;
const BASE_MODE: F =
    F::MAV_MODE_FLAG_CUSTOM_MODE_ENABLED.union(F::MAV_MODE_FLAG_STABILIZE_ENABLED).union(F::MAV_MODE_FLAG_MANUAL_INPUT_ENABLED);
const POSITION_CONTROLLED: F = BASE_MODE.union(F::MAV_MODE_FLAG_GUIDED_ENABLED);

const fn row(number: u32, mode: FlightMode, name: &'static str, base: F) -> ModeRow {
    ModeRow {
        number,
        mode,
        request: AutopilotRequest::SetMode(mode),
        mode_without_sticks: None,
        only_if_requested: false,
        also_shown_for: &[],
        name,
        standard: S::MAV_STANDARD_MODE_NON_STANDARD,
        base,
        auto: false,
        selectable: true,
        armable: true,
    }
}

impl ModeRow {
    const fn without_arming(mut self) -> Self {
        self.armable = false;
        self
    }

    const fn only_if_requested(mut self) -> Self {
        self.only_if_requested = true;
        self
    }

    /// Makes the vehicle hold position while it is armed without stick input, but still report this mode number.
    const fn hold_without_sticks(mut self) -> Self {
        self.mode_without_sticks = Some(FlightMode::Hold);
        self.also_showing(&[FlightMode::Hold])
    }

    const fn entered_by(mut self, request: AutopilotRequest) -> Self {
        self.request = request;
        self
    }
}

/// Order, numbers and names of ArduCopter's AVAILABLE_MODES (GCS_MAVLink_Copter.cpp, send_available_mode; mode.h),
/// without the modes that this vehicle does not support. ArduCopter reports no standard modes and no properties. LOITER
/// and POSHOLD behave the same.
const MODES: &[ModeRow] = &[
    row(AUTO_RTL, FlightMode::Mission, "AUTO RTL", POSITION_CONTROLLED)
        .entered_by(AutopilotRequest::LandingSequence)
        .without_arming()
        .only_if_requested(),
    row(3, FlightMode::Mission, "AUTO", POSITION_CONTROLLED).without_arming(),
    row(1, FlightMode::Acro, "ACRO", BASE_MODE),
    row(0, FlightMode::Stabilized, "STABILIZE", BASE_MODE),
    row(2, FlightMode::Altitude, "ALT_HOLD", BASE_MODE),
    row(7, FlightMode::Orbit, "CIRCLE", POSITION_CONTROLLED).entered_by(AutopilotRequest::CircleAhead).without_arming(),
    row(LOITER, FlightMode::Position, "LOITER", POSITION_CONTROLLED).hold_without_sticks(),
    row(GUIDED, FlightMode::Hold, "GUIDED", POSITION_CONTROLLED)
        .also_showing(&[FlightMode::Takeoff, FlightMode::Offboard])
        .only_if_requested(),
    row(9, FlightMode::Land, "LAND", POSITION_CONTROLLED).without_arming(),
    row(6, FlightMode::Return, "RTL", POSITION_CONTROLLED).without_arming(),
    row(16, FlightMode::Position, "POSHOLD", POSITION_CONTROLLED).hold_without_sticks(),
    // Unlike in ArduPilot, the vehicle can be armed in this mode: without stick input, the other manual modes switch to
    // it on arming, and it is the final mode after a landing.
    row(17, FlightMode::Hold, "BRAKE", POSITION_CONTROLLED),
    row(21, FlightMode::SmartReturn, "SMARTRTL", POSITION_CONTROLLED).without_arming(),
    row(23, FlightMode::Follow, "FOLLOW", POSITION_CONTROLLED).without_arming(),
];

/// ArduPilot's interface. Reports a development version of the series that the parameter names come from.
pub static FLAVOR: Flavor = Flavor {
    name: "ardupilot",
    autopilot: MavAutopilot::MAV_AUTOPILOT_ARDUPILOTMEGA,
    software_version: 4 << 24 | 6 << 16,
    capabilities: COMMON_CAPABILITIES.union(MavProtocolCapability::MAV_PROTOCOL_CAPABILITY_PARAM_FLOAT),
    modes: MODES,
    mode_bits: u32::MAX,
    custom_mode: |number, _| if (0.0..256.0).contains(&number) { number as u32 } else { u32::MAX },
    custom_flag: true,
    state,
    goto_mode: Some(GUIDED),
    take_off: TakeOffRule::AboveHomeInGuided,
    // The second value is ArduPilot's magic number for arming.
    force: &[FORCE_VALUE, 2989.0],
    roi_altitude_above_sea_level: false,
    refusals: RefusalResults {
        temporary_rejection: MavResult::MAV_RESULT_FAILED,
        denied: MavResult::MAV_RESULT_FAILED,
        unknown_mode: MavResult::MAV_RESULT_FAILED,
        message: MavResult::MAV_RESULT_FAILED,
        interval: MavResult::MAV_RESULT_DENIED,
    },
    arming_check_prefix: Some("Arm: "),
    prearm_reason_prefix: "PreArm: ",
    sensor_text: sensor_failure_text,
    mode_rejection_text: |row, why| format!("Mode change to {} failed: {why}", row.name.to_uppercase()),
    banner: &[
        concat!("ArduCopter V4.6.0-dev (Spandrel ", env!("CARGO_PKG_VERSION"), ")"),
        "Spandrel emulation of ArduPilot, not ArduPilot",
        "Frame: QUAD/X",
    ],
    sends_message_after_ack: true,
    streams_on_request_only: true,
    groups: &[
        (1, &[27, 105, 29]),
        (2, &[1, 125, 152, 62, 42, 24, 162, 87]),
        (3, &[36, 65]),
        (6, &[33, 32]),
        (10, &[30, 164]),
        (11, &[74]),
        (12, &[163, 2, 168, 193, 147, 231, 241, 230, 132, 285]),
    ],
    ardupilot_dialect: true,
    calibration: CalibrationTexts::ArduPilot,
    shell: false,
    events: false,
    terrain: true,
    loiter_mode: Some(LOITER),
    offsets: true,
    pauses: true,
    vtol_state: MavVtolState::MAV_VTOL_STATE_MC,
    splines: true,
    zero_means_current_position: true,
    home_item: true,
    uses_float_items: true,
    params: &param_view::COPTER,
    tune: |tuning| {
        tuning.setpoint_end_is_normal = true;
        tuning.takeoff_at_climb_speed = true;
        tuning.arming_depends_on_mode = true;
        tuning.stays_in_mission_mode = true;
        tuning.first_item = 1;
        tuning.fence_switch_persists = true;
    },
};

/// Reports "boot" until the attitude is valid, "critical" during a failsafe, and "active" from takeoff to landing.
fn state(estimate: &Estimate, status: &AutopilotStatus) -> MavState {
    if !estimate.attitude_valid {
        MavState::MAV_STATE_BOOT
    } else if status.failsafe.is_some() {
        MavState::MAV_STATE_CRITICAL
    } else if status.armed && status.landed != LandedState::OnGround {
        MavState::MAV_STATE_ACTIVE
    } else {
        MavState::MAV_STATE_STANDBY
    }
}

/// Returns ArduCopter's text: it reports a GNSS receiver that contradicts the estimator as a glitch, and barometer and
/// compass by instance, as in its checks.
fn sensor_failure_text(change: SensorChange) -> Option<(MavSeverity, String)> {
    let text = match (change.sensor, change.fault) {
        (_, Some(SensorFault::NoReadings)) => return None,
        (MonitoredSensor::Gnss, Some(_)) => "GPS Glitch or Compass error",
        (MonitoredSensor::Gnss, None) => "Glitch cleared",
        (MonitoredSensor::Compass, Some(_)) => "Compass 1 not healthy",
        (MonitoredSensor::Barometer, Some(_)) => "Baro 1 not healthy",
        (_, None) => return None,
    };
    Some((MavSeverity::MAV_SEVERITY_CRITICAL, text.to_owned()))
}
