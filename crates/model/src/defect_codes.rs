//! AASHTO MBEI defect codes and their names (docs/src/reference/domain.md, "Defects"), and defect sizes by condition
//! state (the limits are in "Condition states" on the same page; sizes without a limit there are estimates).
//! [`crate::elements`] lists the defect codes permitted on each element.

use crate::random::RandomStream;

/// Corrosion of steel.
pub const CORROSION: u32 = 1000;
/// Fatigue cracking of steel.
pub const FATIGUE: u32 = 1010;
/// Connection defects: loose or missing fasteners.
pub const CONNECTION: u32 = 1020;
/// Delamination, spalls and patched areas of concrete.
pub const SPALL: u32 = 1080;
/// Exposed reinforcing steel.
pub const REBAR: u32 = 1090;
/// Cracking of prestressed concrete.
pub const PSC_CRACK: u32 = 1110;
/// Efflorescence and rust staining.
pub const EFFLORESCENCE: u32 = 1120;
/// Cracking of reinforced concrete.
pub const CRACK: u32 = 1130;
/// Abrasion or wear of concrete.
pub const ABRASION: u32 = 1190;

/// Breakdown of the mortar of masonry.
pub const MORTAR: u32 = 1610;
/// Split or spalled stones or bricks of masonry.
pub const SPLIT_STONE: u32 = 1620;

/// All defect codes used in random placement, in ascending order.
pub const ALL: &[u32] =
    &[CORROSION, FATIGUE, CONNECTION, SPALL, REBAR, PSC_CRACK, EFFLORESCENCE, CRACK, ABRASION, MORTAR, SPLIT_STONE];

/// Returns true if a defect code represents a line defect (a crack), whose width must be resolved in a photo.
#[must_use]
pub fn is_line(kind: u32) -> bool {
    matches!(kind, FATIGUE | PSC_CRACK | CRACK)
}

/// Returns the display name of a defect code.
#[must_use]
pub fn defect_name(kind: u32) -> &'static str {
    match kind {
        CORROSION => "corrosion",
        FATIGUE => "fatigue cracking",
        CONNECTION => "connection",
        SPALL => "delamination or spall",
        REBAR => "exposed rebar",
        PSC_CRACK => "cracking (prestressed)",
        EFFLORESCENCE => "efflorescence or rust staining",
        CRACK => "cracking",
        ABRASION => "abrasion",
        MORTAR => "mortar breakdown",
        SPLIT_STONE => "split or spalled stone",
        _ => "defect",
    }
}

/// Size ranges of a defect code in one condition state.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct SizeRanges {
    /// Minimum and maximum length, m.
    pub length_m: (f64, f64),
    /// Minimum and maximum width: m for line defects, a fraction of the length for all others.
    pub width: (f64, f64),
}

/// Returns the size ranges of a defect code in a condition state (2 fair, 3 poor, 4 severe).
#[must_use]
pub fn size_ranges(kind: u32, condition_state: u8) -> SizeRanges {
    if condition_state >= 4 {
        return severe_size_ranges(kind);
    }
    let poor = condition_state >= 3;
    let (length_m, width) = match (kind, poor) {
        // The boundary between the condition states is 6 in (0.152 m).
        (SPALL, false) => ((0.10, 0.152), (0.6, 0.9)),
        (SPALL, true) => ((0.16, 0.80), (0.5, 0.9)),
        (REBAR, false) => ((0.15, 0.40), (0.15, 0.3)),
        (REBAR, true) => ((0.30, 0.90), (0.15, 0.4)),
        // 0.012 in (0.30 mm) and 0.05 in (1.27 mm).
        (CRACK, false) => ((0.40, 1.50), (0.000_30, 0.001_27)),
        (CRACK, true) => ((0.40, 2.00), (0.001_28, 0.003)),
        // 0.004 in and 0.009 in.
        (PSC_CRACK, false) => ((0.30, 1.00), (0.000_10, 0.000_23)),
        (PSC_CRACK, true) => ((0.30, 1.50), (0.000_24, 0.001)),
        (EFFLORESCENCE, false) => ((0.20, 0.80), (0.3, 0.6)),
        (EFFLORESCENCE, true) => ((0.40, 1.50), (0.3, 0.6)),
        (ABRASION, false) => ((0.20, 0.80), (0.4, 0.7)),
        (ABRASION, true) => ((0.40, 1.50), (0.4, 0.7)),
        (MORTAR, false) => ((0.40, 0.90), (0.4, 0.8)),
        (MORTAR, true) => ((0.60, 1.60), (0.4, 0.8)),
        (SPLIT_STONE, false) => ((0.15, 0.35), (0.6, 0.9)),
        (SPLIT_STONE, true) => ((0.25, 0.70), (0.6, 0.9)),
        (FATIGUE, false) => ((0.03, 0.15), (0.000_05, 0.000_2)),
        (FATIGUE, true) => ((0.05, 0.30), (0.000_1, 0.000_3)),
        (CONNECTION, false) => ((0.06, 0.20), (0.4, 0.8)),
        (CONNECTION, true) => ((0.08, 0.30), (0.4, 0.8)),
        (_, false) => ((0.08, 0.30), (0.3, 0.7)),
        (_, true) => ((0.15, 0.80), (0.3, 0.7)),
    };
    SizeRanges { length_m, width }
}

/// Returns the size ranges of a defect code in condition state 4. The manual has no measures for it: it is what warrants a structural
/// review. All values are estimates: beyond the sizes of condition state 3, or in their upper half.
fn severe_size_ranges(kind: u32) -> SizeRanges {
    let (length_m, width) = match kind {
        SPALL => ((0.50, 1.20), (0.5, 0.9)),
        REBAR => ((0.50, 1.20), (0.25, 0.45)),
        CRACK => ((0.80, 2.50), (0.003_5, 0.008)),
        PSC_CRACK => ((0.60, 2.00), (0.001_2, 0.003)),
        EFFLORESCENCE => ((0.80, 2.00), (0.3, 0.6)),
        ABRASION => ((0.80, 2.00), (0.4, 0.7)),
        MORTAR => ((0.90, 2.00), (0.4, 0.8)),
        SPLIT_STONE => ((0.40, 0.90), (0.6, 0.9)),
        FATIGUE => ((0.20, 0.50), (0.000_3, 0.001)),
        CONNECTION => ((0.16, 0.40), (0.4, 0.8)),
        _ => ((0.35, 1.20), (0.3, 0.7)),
    };
    SizeRanges { length_m, width }
}

/// Returns the size ranges of a pattern of cracks (map cracking) in a condition state. The manual rates the width and the density of the
/// cracks, not the size of the pattern, so that all values are estimates.
#[must_use]
pub fn map_crack_size_ranges(condition_state: u8) -> SizeRanges {
    let length_m = match condition_state {
        0..=2 => (0.40, 0.80),
        3 => (0.50, 1.20),
        4.. => (0.80, 1.60),
    };
    SizeRanges { length_m, width: (0.6, 0.9) }
}

/// Returns the size ranges of a fatigue crack that a cause places. Long cracks open under the dead load (estimate; the manual rates whether
/// a crack is arrested, not its size).
#[must_use]
pub fn open_fatigue_size_ranges(condition_state: u8) -> SizeRanges {
    let (length_m, width) = match condition_state {
        0..=2 => ((0.05, 0.15), (0.000_2, 0.000_6)),
        3 => ((0.08, 0.30), (0.000_4, 0.001)),
        4.. => ((0.20, 0.50), (0.000_8, 0.002)),
    };
    SizeRanges { length_m, width }
}

/// Minimum length of a defect whose size follows from its predicted detection, m: the median of the detection curve for
/// trained inspectors (docs/src/reference/domain.md, "Human detection performance").
const MIN_TARGET_LENGTH_M: f64 = 0.026;
/// Minimum and maximum width of a crack in reinforced concrete whose size follows from its predicted detection, m
/// (estimate: from below the 0.012 in that AASHTO MBEI calls insignificant to above the 0.05 in of condition state 3).
const TARGET_CRACK_WIDTH_M: (f64, f64) = (0.000_2, 0.002);
/// Boundary between the condition states 2 and 3 of a spall, m: 6 in.
pub const SPALL_BOUNDARY_M: f64 = 0.1524;
/// Boundary between the condition states 2 and 3 of a crack in reinforced concrete, m: 0.05 in.
const CRACK_BOUNDARY_M: f64 = 0.001_27;

/// Returns the sizes among which a defect's predicted detection selects: down to the median length of the detection curve,
/// and up to the largest random defect.
#[must_use]
pub fn target_size_ranges(kind: u32) -> SizeRanges {
    let (fair, poor) = (size_ranges(kind, 2), size_ranges(kind, 3));
    let width =
        if kind == CRACK { TARGET_CRACK_WIDTH_M } else { (fair.width.0.min(poor.width.0), fair.width.1.max(poor.width.1)) };
    SizeRanges { length_m: (MIN_TARGET_LENGTH_M, poor.length_m.1), width }
}

/// Returns the condition state that follows from a defect's size, m; `None` if the size does not determine it.
#[must_use]
pub fn condition_state(kind: u32, length_m: f64, width_m: f64) -> Option<u8> {
    let poor = match kind {
        SPALL => length_m > SPALL_BOUNDARY_M,
        CRACK => width_m > CRACK_BOUNDARY_M,
        _ => return None,
    };
    Some(if poor { 3 } else { 2 })
}

/// Draws a random length and width, m, both scaled by `factor`.
pub fn draw_size(kind: u32, condition_state: u8, factor: f64, stream: &mut RandomStream) -> (f64, f64) {
    let s = size_ranges(kind, condition_state);
    let length = stream.range(s.length_m.0, s.length_m.1);
    let width = stream.range(s.width.0, s.width.1);
    (length * factor, if is_line(kind) { width } else { width * length } * factor)
}
