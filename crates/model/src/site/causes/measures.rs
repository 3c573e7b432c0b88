//! Condition states of defects with causes, and the sizes that the manual assigns to them (docs/src/reference/domain.md, "Condition states").

use super::place::Place;
use crate::defect_codes::{self, CRACK, FATIGUE, PSC_CRACK, SPALL, SizeRanges};
use crate::random::RandomStream;

/// Condition states with their frequencies (estimate: severe defects are rare, because bridges with them are repaired).
const STATES: [(u8, f64); 3] = [(2, 0.45), (3, 0.40), (4, 0.15)];

/// Condition state, length and width, m, of a defect.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Measure {
    pub(super) condition_state: u8,
    pub(super) length_m: f64,
    pub(super) width_m: f64,
}

/// Draws the condition state and the size of a defect, scaled by `factor` as far as the manual's limits of its condition state permit.
/// `None` if no size of this state fits into the place.
pub(super) fn draw(place: &Place, factor: f64, stream: &mut RandomStream) -> Option<Measure> {
    let (state_draw, length_draw, width_draw) = (stream.uniform(), stream.uniform(), stream.uniform());
    let condition_state = state(state_draw);
    let ranges = size_ranges(place, condition_state);
    let between = |(low, high): (f64, f64), t: f64| low + (high - low) * t;
    let limit_m = length_limit_m(place.kind, condition_state);
    let high_m = (ranges.length_m.1 * factor).min(limit_m.1).min(place.max_length_m);
    let low_m = (ranges.length_m.0 * factor).max(limit_m.0);
    if high_m < low_m {
        return None;
    }
    let length_m = between((low_m, high_m), length_draw);
    if place.line {
        let scale = if matches!(place.kind, CRACK | PSC_CRACK) { 1.0 } else { factor };
        return Some(Measure { condition_state, length_m, width_m: between(ranges.width, width_draw) * scale });
    }
    let width_m = (between(ranges.width, width_draw) * length_m).min(place.max_width_m);
    Some(Measure { condition_state, length_m, width_m })
}

fn state(draw: f64) -> u8 {
    let mut sum = 0.0;
    for (state, frequency) in STATES {
        sum += frequency;
        if draw < sum {
            return state;
        }
    }
    STATES[STATES.len() - 1].0
}

fn size_ranges(place: &Place, condition_state: u8) -> SizeRanges {
    match place.kind {
        CRACK | PSC_CRACK if !place.line => defect_codes::map_crack_size_ranges(condition_state),
        FATIGUE => defect_codes::open_fatigue_size_ranges(condition_state),
        kind => defect_codes::size_ranges(kind, condition_state),
    }
}

/// Returns the limits of a length that the manual sets for a condition state, m; otherwise unlimited.
fn length_limit_m(kind: u32, condition_state: u8) -> (f64, f64) {
    match (kind, condition_state) {
        (SPALL, 0..=2) => (0.0, defect_codes::SPALL_BOUNDARY_M),
        (SPALL, _) => (defect_codes::SPALL_BOUNDARY_M, f64::INFINITY),
        _ => (0.0, f64::INFINITY),
    }
}
