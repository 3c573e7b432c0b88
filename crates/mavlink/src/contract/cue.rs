//! Bit flags of the monitor's `cues` value: the active cues.

/// Battery level is yellow.
pub const BATTERY_YELLOW: i32 = 1;
/// Battery level is red.
pub const BATTERY_RED: i32 = 1 << 1;
/// Above the speed limit.
pub const SPEEDING: i32 = 1 << 2;
/// Off the path, but within the off-path band.
pub const OFF_PATH: i32 = 1 << 3;
/// Closer to a surface than the minimum distance of the task.
pub const TOO_CLOSE: i32 = 1 << 4;
/// The aircraft hit something.
pub const CRASH: i32 = 1 << 5;

/// All cues and their names, the most serious first.
pub const ALL: [(i32, &str); 6] = [
    (CRASH, "crash"),
    (TOO_CLOSE, "too close"),
    (SPEEDING, "speeding"),
    (OFF_PATH, "off path"),
    (BATTERY_RED, "battery red"),
    (BATTERY_YELLOW, "battery yellow"),
];
