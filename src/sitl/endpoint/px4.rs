//! PX4's numbers for modes: custom_mode is main mode in bits 16 to 23, sub mode in bits 24 to 31 (mavlink.md; read off a real PX4).

use crate::mav::dialect::MavStandardMode;
use crate::sitl::autopilot::Mode;

/// One mode as clients know it.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct ModeRow {
    /// Ours.
    pub mode: Mode,
    /// Main mode.
    pub main: u8,
    /// Sub mode.
    pub sub: u8,
    /// Display name.
    pub name: &'static str,
    /// The standard mode that it is.
    pub standard: MavStandardMode,
    /// Flies by itself.
    pub auto: bool,
    /// Offered in menus.
    pub selectable: bool,
}

const fn row(
    mode: Mode,
    main: u8,
    sub: u8,
    name: &'static str,
    standard: MavStandardMode,
    auto: bool,
    selectable: bool,
) -> ModeRow {
    ModeRow { mode, main, sub, name, standard, auto, selectable }
}

use MavStandardMode as S;

/// All modes, in the order of AVAILABLE_MODES.
pub const MODES: [ModeRow; 10] = [
    row(Mode::Position, 3, 0, "Position", S::MAV_STANDARD_MODE_POSITION_HOLD, false, true),
    row(Mode::Altitude, 2, 0, "Altitude", S::MAV_STANDARD_MODE_ALTITUDE_HOLD, false, true),
    row(Mode::Stabilized, 7, 0, "Stabilized", S::MAV_STANDARD_MODE_NON_STANDARD, false, true),
    row(Mode::Hold, 4, 3, "Hold", S::MAV_STANDARD_MODE_NON_STANDARD, true, true),
    row(Mode::Takeoff, 4, 2, "Takeoff", S::MAV_STANDARD_MODE_TAKEOFF, true, true),
    row(Mode::Mission, 4, 4, "Mission", S::MAV_STANDARD_MODE_MISSION, true, true),
    row(Mode::Return, 4, 5, "Return", S::MAV_STANDARD_MODE_SAFE_RECOVERY, true, true),
    row(Mode::Land, 4, 6, "Land", S::MAV_STANDARD_MODE_LAND, true, true),
    row(Mode::Orbit, 3, 1, "Orbit", S::MAV_STANDARD_MODE_ORBIT, true, false),
    row(Mode::Offboard, 6, 0, "Offboard", S::MAV_STANDARD_MODE_NON_STANDARD, true, false),
];

impl ModeRow {
    /// HEARTBEAT.custom_mode.
    #[must_use]
    pub fn custom_mode(&self) -> u32 {
        u32::from(self.main) << 16 | u32::from(self.sub) << 24
    }
}

/// The row of a mode.
#[must_use]
pub fn row_of(mode: Mode) -> &'static ModeRow {
    MODES.iter().find(|r| r.mode == mode).unwrap_or(&MODES[3])
}

/// From main and sub mode; a main mode of 4 with sub mode 0 is none.
#[must_use]
pub fn from_numbers(main: u32, sub: u32) -> Option<Mode> {
    MODES.iter().find(|r| u32::from(r.main) == main && u32::from(r.sub) == sub).map(|r| r.mode)
}

/// From HEARTBEAT.custom_mode.
#[must_use]
pub fn from_custom_mode(custom_mode: u32) -> Option<Mode> {
    from_numbers(custom_mode >> 16 & 0xff, custom_mode >> 24 & 0xff)
}
