//! Bit flags in the monitor's `cues` value, one for each active cue.

/// The battery level is in the yellow range.
pub const BATTERY_YELLOW: i32 = 1;
/// The battery level is in the red range.
pub const BATTERY_RED: i32 = 1 << 1;
/// The speed is above the limit.
pub const SPEEDING: i32 = 1 << 2;
/// The drone is off the path, but still close enough to be in the task.
pub const OFF_PATH: i32 = 1 << 3;
/// The clearance is below the task's limit.
pub const TOO_CLOSE: i32 = 1 << 4;
/// The aircraft is, or recently was, in contact with an object.
pub const CRASH: i32 = 1 << 5;

/// All cues with their names, most serious first.
pub const ALL: [(i32, &str); 6] = [
    (CRASH, "crash"),
    (TOO_CLOSE, "too close"),
    (SPEEDING, "speeding"),
    (OFF_PATH, "off path"),
    (BATTERY_RED, "battery red"),
    (BATTERY_YELLOW, "battery yellow"),
];
