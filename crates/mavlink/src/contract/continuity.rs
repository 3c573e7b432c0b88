//! Detects whether two truth messages belong to different flights.
//!
//! A time jump means that the simulator was restarted. The clock must be more than [`RESTART_THRESHOLD`] behind in
//! [`RESTART_CONFIRM_COUNT`] consecutive messages, so a single late datagram does not count as a restart. A position
//! jump means that the aircraft was respawned. Nothing is drawn, measured or interpolated across it.

use spandrel_model::time::SimTime;

/// Minimum backward clock jump that indicates a different or restarted simulator.
pub const RESTART_THRESHOLD: SimTime = SimTime::from_ms(1_000);
/// Number of consecutive truth messages required to confirm a restart.
pub const RESTART_CONFIRM_COUNT: usize = 3;
/// Constant part of the jump threshold, m (estimate: farther than a gust moves a hovering aircraft during one second
/// without data).
const JUMP_MARGIN_M: f64 = 1.5;
/// Multiplier for the higher of the two speeds in the jump threshold (estimate: no supported aircraft accelerates that
/// much within a gap).
const JUMP_SPEED_FACTOR: f64 = 4.0;

/// Returns whether `distance_m` is too far for the aircraft to have flown within `span`. `fastest_m_s` is the higher of
/// the speeds at both ends.
#[must_use]
pub fn is_jump(distance_m: f64, fastest_m_s: f64, span: SimTime) -> bool {
    distance_m > JUMP_MARGIN_M + JUMP_SPEED_FACTOR * fastest_m_s * span.s()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn exact_only_respawns_count_as_jumps() {
        let span = SimTime::from_ms(20);
        assert!(!is_jump(0.4, 20.0, span));
        assert!(!is_jump(1.6, 2.0, span));
        assert!(is_jump(1.7, 2.0, span));
        // One second without data at 5 m/s.
        assert!(!is_jump(21.0, 5.0, SimTime::from_ms(1_000)));
        assert!(is_jump(22.0, 5.0, SimTime::from_ms(1_000)));
    }
}
