//! When two samples of the truth do not belong to one flight.
//!
//! A jump in time is a restart of the simulator: the clock runs back by more than [`RESTART_AFTER`] in [`RESTART_CONFIRM`] samples in a
//! row, so that one late datagram is none. A jump in place is an aircraft that was put back: nothing is drawn, measured or interpolated
//! between its two ends.

use spandrel_model::time::SimTime;

/// A clock that runs back by more than this is another simulator's, or a restarted one's.
pub const RESTART_AFTER: SimTime = SimTime::from_ms(1_000);
/// Samples in a row that must say so.
pub const RESTART_CONFIRM: usize = 3;
/// How far beyond flight a step may reach, m (estimate: a hover shaken by a gust through a second's silence moves less).
const SLACK_M: f64 = 1.5;
/// And how many times faster than at the faster of its two ends (estimate: no aircraft here gains so much within a gap).
const FACTOR: f64 = 4.0;

/// True when a step of `distance_m` within `span` is no flight. `fastest_m_s` is the speed at the faster of its two ends.
#[must_use]
pub fn is_jump(distance_m: f64, fastest_m_s: f64, span: SimTime) -> bool {
    distance_m > SLACK_M + FACTOR * fastest_m_s * span.s()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn exact_a_fast_flight_is_none_and_a_respawn_is_one() {
        let span = SimTime::from_ms(20);
        assert!(!is_jump(0.4, 20.0, span));
        assert!(!is_jump(1.6, 2.0, span));
        assert!(is_jump(1.7, 2.0, span));
        // A second of silence at 5 m/s.
        assert!(!is_jump(21.0, 5.0, SimTime::from_ms(1_000)));
        assert!(is_jump(22.0, 5.0, SimTime::from_ms(1_000)));
    }
}
