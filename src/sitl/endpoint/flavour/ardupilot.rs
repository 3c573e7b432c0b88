//! ArduPilot's interface, as ArduCopter speaks it (autopilots.md; read off a real ArduCopter 4.7-dev, names of parameters as in 4.6).
#![allow(deprecated, reason = "ArduPilot names its encoding by the older capability")]

use super::px4::FORCE;
use super::{COMMON, Flavour, ModeRow, Refusals};
use crate::mav::dialect::{MavAutopilot, MavModeFlag as F, MavProtocolCapability, MavResult, MavStandardMode as S, MavState};
use crate::sitl::autopilot::{Landed, Mode};
use crate::sitl::endpoint::Context;
use crate::sitl::endpoint::commands::Command;
use crate::sitl::endpoint::params::face;
use crate::sitl::endpoint::view::View;

/// Copter's number of the mode that flies errands.
const GUIDED: u32 = 4;
const BASE: F =
    F::MAV_MODE_FLAG_CUSTOM_MODE_ENABLED.union(F::MAV_MODE_FLAG_STABILIZE_ENABLED).union(F::MAV_MODE_FLAG_MANUAL_INPUT_ENABLED);
const PLACED: F = BASE.union(F::MAV_MODE_FLAG_GUIDED_ENABLED);

const fn row(number: u32, mode: Mode, name: &'static str, standard: S, base: F) -> ModeRow {
    ModeRow { number, mode, covers: &[], name, standard, base, auto: false, selectable: true, armable: true }
}

impl ModeRow {
    const fn by_itself(mut self) -> Self {
        self.auto = true;
        self
    }

    const fn not_armable(mut self) -> Self {
        self.armable = false;
        self
    }

    const fn covering(mut self, modes: &'static [Mode]) -> Self {
        self.covers = modes;
        self
    }

    const fn unoffered(mut self) -> Self {
        self.selectable = false;
        self
    }
}

/// Copter's numbers, with the names that QGroundControl knows them by. LOITER and POSHOLD are the same to us.
const MODES: &[ModeRow] = &[
    row(0, Mode::Stabilized, "Stabilize", S::MAV_STANDARD_MODE_NON_STANDARD, BASE),
    row(2, Mode::Altitude, "Altitude Hold", S::MAV_STANDARD_MODE_ALTITUDE_HOLD, BASE),
    row(5, Mode::Position, "Loiter", S::MAV_STANDARD_MODE_POSITION_HOLD, PLACED),
    row(16, Mode::Position, "Position Hold", S::MAV_STANDARD_MODE_NON_STANDARD, PLACED),
    // Armable, where ArduPilot's is not: without sticks the modes by hand are armed into it, and a landing ends in it.
    row(17, Mode::Hold, "Brake", S::MAV_STANDARD_MODE_NON_STANDARD, PLACED).by_itself(),
    row(GUIDED, Mode::Hold, "Guided", S::MAV_STANDARD_MODE_NON_STANDARD, PLACED)
        .by_itself()
        .covering(&[Mode::Takeoff, Mode::Offboard]),
    row(3, Mode::Mission, "Auto", S::MAV_STANDARD_MODE_MISSION, PLACED).by_itself().not_armable(),
    row(6, Mode::Return, "RTL", S::MAV_STANDARD_MODE_SAFE_RECOVERY, PLACED).by_itself().not_armable(),
    row(9, Mode::Land, "Land", S::MAV_STANDARD_MODE_LAND, PLACED).by_itself().not_armable(),
    row(7, Mode::Orbit, "Circle", S::MAV_STANDARD_MODE_ORBIT, PLACED).by_itself().not_armable().unoffered(),
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
    mode_words: |row, why| format!("Mode change to {} failed: {why}", row.name.to_uppercase()),
    banner: &[
        concat!("ArduCopter V4.6.0-dev (Spandrel ", env!("CARGO_PKG_VERSION"), ")"),
        "Spandrel speaks as ArduPilot does; it is not it",
        "Frame: QUAD/X",
    ],
    asks_first: true,
    groups: &[
        (1, &[27, 105, 29]),
        (2, &[1, 62, 42, 24, 162]),
        (3, &[36, 65]),
        (6, &[33, 32]),
        (10, &[30]),
        (11, &[74]),
        (12, &[2, 147, 231, 241, 230, 132, 285]),
    ],
    splines: true,
    home_item: true,
    float_items: true,
    params: &face::COPTER,
    tune: |tuning| {
        tuning.setpoints_end = true;
        tuning.arm_throttle_down = true;
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
