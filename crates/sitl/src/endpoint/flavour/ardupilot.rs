//! ArduPilot's interface, as ArduCopter implements it (docs/src/reference/wire.md, "Autopilot interfaces"; recorded from a real
//! ArduCopter 4.7-dev, names of parameters as in 4.6).
#![allow(deprecated, reason = "ArduPilot names its encoding by the older capability")]

use super::px4::FORCE;
use super::{COMMON, Flavour, ModeRow, Refusals};
use crate::autopilot::senses::{Sensor, SensorChange, SensorFault};
use crate::autopilot::{Landed, Mode, Request};
use crate::endpoint::Context;
use crate::endpoint::calibration;
use crate::endpoint::commands::Command;
use crate::endpoint::params::face;
use crate::endpoint::view::View;
use spandrel_mavlink::dialect::{
    MavAutopilot, MavModeFlag as F, MavProtocolCapability, MavResult, MavSeverity, MavStandardMode as S, MavState, MavVtolState,
};

/// Copter's numbers of the modes that fly errands, hold for NAV_LOITER_UNLIM, and land by the mission's landing sequence.
const GUIDED: u32 = 4;
const LOITER: u32 = 5;
const AUTO_RTL: u32 = 27;
const BASE: F =
    F::MAV_MODE_FLAG_CUSTOM_MODE_ENABLED.union(F::MAV_MODE_FLAG_STABILIZE_ENABLED).union(F::MAV_MODE_FLAG_MANUAL_INPUT_ENABLED);
const PLACED: F = BASE.union(F::MAV_MODE_FLAG_GUIDED_ENABLED);

const fn row(number: u32, mode: Mode, name: &'static str, base: F) -> ModeRow {
    ModeRow {
        number,
        mode,
        request: Request::SetMode(mode),
        unattended: None,
        only_chosen: false,
        covers: &[],
        name,
        standard: S::MAV_STANDARD_MODE_NON_STANDARD,
        base,
        auto: false,
        selectable: true,
        armable: true,
    }
}

impl ModeRow {
    const fn not_armable(mut self) -> Self {
        self.armable = false;
        self
    }

    const fn only_chosen(mut self) -> Self {
        self.only_chosen = true;
        self
    }

    /// Holds while it is armed and no sticks are there, under its own number.
    const fn holds_unattended(mut self) -> Self {
        self.unattended = Some(Mode::Hold);
        self.covering(&[Mode::Hold])
    }

    const fn entered_by(mut self, request: Request) -> Self {
        self.request = request;
        self
    }
}

/// Order, numbers and names of ArduCopter's AVAILABLE_MODES (GCS_MAVLink_Copter.cpp, send_available_mode; mode.h), without the modes that are not
/// flown here. It names no standard modes and no properties. LOITER and POSHOLD fly alike.
const MODES: &[ModeRow] = &[
    row(AUTO_RTL, Mode::Mission, "AUTO RTL", PLACED).entered_by(Request::LandingSequence).not_armable().only_chosen(),
    row(3, Mode::Mission, "AUTO", PLACED).not_armable(),
    row(1, Mode::Acro, "ACRO", BASE),
    row(0, Mode::Stabilized, "STABILIZE", BASE),
    row(2, Mode::Altitude, "ALT_HOLD", BASE),
    row(7, Mode::Orbit, "CIRCLE", PLACED).entered_by(Request::CircleAhead).not_armable(),
    row(LOITER, Mode::Position, "LOITER", PLACED).holds_unattended(),
    row(GUIDED, Mode::Hold, "GUIDED", PLACED).covering(&[Mode::Takeoff, Mode::Offboard]).only_chosen(),
    row(9, Mode::Land, "LAND", PLACED).not_armable(),
    row(6, Mode::Return, "RTL", PLACED).not_armable(),
    row(16, Mode::Position, "POSHOLD", PLACED).holds_unattended(),
    // Armable, where ArduPilot's is not: without sticks the other modes by hand are armed into it, and a landing ends in it.
    row(17, Mode::Hold, "BRAKE", PLACED),
    row(21, Mode::SmartReturn, "SMARTRTL", PLACED).not_armable(),
    row(23, Mode::Follow, "FOLLOW", PLACED).not_armable(),
];

/// ArduPilot's interface. The version is a development one of the series whose parameter names are used.
pub static FLAVOUR: Flavour = Flavour {
    name: "ardupilot",
    autopilot: MavAutopilot::MAV_AUTOPILOT_ARDUPILOTMEGA,
    software_version: 4 << 24 | 6 << 16,
    capabilities: COMMON.union(MavProtocolCapability::MAV_PROTOCOL_CAPABILITY_PARAM_FLOAT),
    modes: MODES,
    mode_bits: u32::MAX,
    custom_mode: |number, _| if (0.0..256.0).contains(&number) { number as u32 } else { u32::MAX },
    custom_flag: true,
    state,
    errands: Some(GUIDED),
    take_off: from_guided,
    // The second is ArduPilot's own for arming.
    force: &[FORCE, 2989.0],
    looks_over_sea: false,
    refusals: Refusals {
        for_now: MavResult::MAV_RESULT_FAILED,
        denied: MavResult::MAV_RESULT_FAILED,
        no_mode: MavResult::MAV_RESULT_FAILED,
        message: MavResult::MAV_RESULT_FAILED,
        interval: MavResult::MAV_RESULT_DENIED,
    },
    arm_words: Some("Arm: "),
    check_words: "PreArm: ",
    sensor_words,
    mode_words: |row, why| format!("Mode change to {} failed: {why}", row.name.to_uppercase()),
    banner: &[
        concat!("ArduCopter V4.6.0-dev (Spandrel ", env!("CARGO_PKG_VERSION"), ")"),
        "Spandrel speaks as ArduPilot does; it is not it",
        "Frame: QUAD/X",
    ],
    answers_after_acknowledgement: true,
    asks_first: true,
    groups: &[
        (1, &[27, 105, 29]),
        (2, &[1, 125, 152, 62, 42, 24, 162, 87]),
        (3, &[36, 65]),
        (6, &[33, 32]),
        (10, &[30, 164]),
        (11, &[74]),
        (12, &[163, 2, 168, 193, 147, 231, 241, 230, 132, 285]),
    ],
    dialect_of_ardupilot: true,
    calibration: calibration::Words::ArduPilot,
    shell: false,
    events: false,
    loiters: Some(LOITER),
    offsets: true,
    pauses: true,
    vtol_state: MavVtolState::MAV_VTOL_STATE_MC,
    splines: true,
    zero_is_here: true,
    home_item: true,
    float_items: true,
    params: &face::COPTER,
    tune: |tuning| {
        tuning.setpoints_end = true;
        tuning.takeoff_at_climb_speed = true;
        tuning.arms_by_mode = true;
        tuning.mission_mode_stays = true;
        tuning.first_item = 1;
        tuning.fence_switch_stays = true;
    },
};

/// Booting until the attitude is known, critical in a failsafe, active from lift-off to touch-down.
fn state(v: &View) -> MavState {
    if !v.estimate.attitude_valid {
        MavState::MAV_STATE_BOOT
    } else if v.status.failsafe.is_some() {
        MavState::MAV_STATE_CRITICAL
    } else if v.status.armed && v.status.landed != Landed::OnGround {
        MavState::MAV_STATE_ACTIVE
    } else {
        MavState::MAV_STATE_STANDBY
    }
}

/// Only from the ground, in GUIDED, with the motors armed; parameter 7 is over home.
fn from_guided(c: &Command, x: &mut Context) -> Result<Option<f64>, MavResult> {
    const FAILED: MavResult = MavResult::MAV_RESULT_FAILED;
    const HIGHEST_M: f64 = 500.0;
    let status = x.autopilot.status();
    let why = if !x.in_errands() {
        Some("Take-off needs mode Guided")
    } else if !status.armed {
        Some("Take-off needs armed motors")
    } else if status.landed != Landed::OnGround {
        Some("Take-off: in the air already")
    } else {
        None
    };
    if let Some(why) = why {
        x.tell(why);
        return Err(FAILED);
    }
    // COMMAND_LONG has no frame; COMMAND_INT must say that the height counts from home.
    if c.whole && c.over_home() != Some(true) {
        return Err(MavResult::MAV_RESULT_DENIED);
    }
    let height = c.given(6).filter(|height| *height > 0.0 && *height <= HIGHEST_M);
    if height.is_none() {
        x.tell("Take-off height: above 0, at most 500 m over home");
    }
    height.map(Some).ok_or(FAILED)
}

/// ArduCopter announces a receiver that contradicts the filter as a glitch; barometer and compass by number, as its checks name them.
fn sensor_words(change: SensorChange) -> Option<(MavSeverity, String)> {
    let text = match (change.sensor, change.fault) {
        (_, Some(SensorFault::Silent)) => return None,
        (Sensor::Gnss, Some(_)) => "GPS Glitch or Compass error",
        (Sensor::Gnss, None) => "Glitch cleared",
        (Sensor::Compass, Some(_)) => "Compass 1 not healthy",
        (Sensor::Barometer, Some(_)) => "Baro 1 not healthy",
        (_, None) => return None,
    };
    Some((MavSeverity::MAV_SEVERITY_CRITICAL, text.to_owned()))
}
