//! Bits of the monitor's `cues`: the feedback that is on.

/// Battery is yellow.
pub const BATTERY_YELLOW: i32 = 1;
/// Battery is red.
pub const BATTERY_RED: i32 = 1 << 1;
/// Faster than the speed limit.
pub const SPEEDING: i32 = 1 << 2;
/// Off the path, but near it.
pub const OFF_PATH: i32 = 1 << 3;
/// Closer to a surface than the task allows.
pub const TOO_CLOSE: i32 = 1 << 4;
/// Something was hit.
pub const CRASH: i32 = 1 << 5;

/// All cues with their names, the most serious first.
pub const ALL: [(i32, &str); 6] = [
    (CRASH, "crash"),
    (TOO_CLOSE, "too close"),
    (SPEEDING, "speeding"),
    (OFF_PATH, "off path"),
    (BATTERY_RED, "battery red"),
    (BATTERY_YELLOW, "battery yellow"),
];
