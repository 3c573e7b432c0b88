//! The drone's lamp: on, off, or blinking in response to a relay repeat command.

use super::changes::PayloadChange;
use mavlink::MessageData;
use spandrel_mavlink::dialect::ILLUMINATOR_STATUS_DATA;
use spandrel_model::time::SimTime;

/// Allowed number of cycles, and allowed cycle time, s.
const ALLOWED_CYCLES: std::ops::RangeInclusive<f64> = 1.0..=10_000.0;
const ALLOWED_CYCLE_S: std::ops::RangeInclusive<f64> = 0.04..=3_600.0;

/// Lamp state.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct LampState {
    /// Whether the lamp is on.
    pub on: bool,
    blinking: Option<BlinkSequence>,
}

/// Remaining toggles of a blink sequence.
#[derive(Debug, Clone, Copy, PartialEq)]
struct BlinkSequence {
    remaining_toggles: u32,
    half_period: SimTime,
    next: SimTime,
}

impl LampState {
    /// The lamp is off.
    pub const OFF: Self = Self { on: false, blinking: None };

    /// Switches the lamp on or off; ends a blink sequence.
    pub fn switch(&mut self, on: bool) {
        *self = Self { on, blinking: None };
    }

    /// Starting now, toggles the lamp and restores it `cycles` times, with a cycle time of `cycle_s` seconds. Returns
    /// false if a value is out of range.
    pub fn repeat(&mut self, cycles: f64, cycle_s: f64, now: SimTime) -> bool {
        let is_valid = ALLOWED_CYCLES.contains(&cycles) && ALLOWED_CYCLE_S.contains(&cycle_s);
        if is_valid {
            let left = 2 * cycles as u32;
            self.blinking =
                Some(BlinkSequence { remaining_toggles: left, half_period: SimTime::from_s(0.5 * cycle_s), next: now });
        }
        is_valid
    }

    /// Toggles the lamp when due, and reports the change.
    pub fn step(&mut self, now: SimTime, changes: &mut PayloadChange) {
        let Some(blinking) = self.blinking.as_mut().filter(|blinking| blinking.next <= now) else { return };
        self.on = !self.on;
        blinking.remaining_toggles -= 1;
        blinking.next += blinking.half_period;
        if blinking.remaining_toggles == 0 {
            self.blinking = None;
        }
        changes.add_message(ILLUMINATOR_STATUS_DATA::ID);
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn exact_blinking_toggles_the_requested_number_of_times_and_restores_the_state() {
        let mut lamp = LampState::OFF;
        lamp.switch(true);
        assert!(lamp.repeat(3.0, 0.2, SimTime::ZERO));
        let mut changes = Vec::new();
        for ms in 0..2_000 {
            let before = lamp.on;
            lamp.step(SimTime::from_ms(ms), &mut PayloadChange::default());
            if lamp.on != before {
                changes.push((ms, lamp.on));
            }
        }
        assert_eq!(changes, [(0, false), (100, true), (200, false), (300, true), (400, false), (500, true)]);
    }

    #[test]
    fn exact_invalid_blink_values_are_rejected_and_switching_ends_blinking() {
        let mut lamp = LampState::OFF;
        for (cycles, cycle_s) in [(0.0, 1.0), (1e9, 1.0), (1.0, 0.0), (1.0, f64::NAN), (f64::NAN, 1.0)] {
            assert!(!lamp.repeat(cycles, cycle_s, SimTime::ZERO), "{cycles} {cycle_s}");
        }
        assert!(lamp.repeat(5.0, 1.0, SimTime::ZERO));
        lamp.switch(false);
        lamp.step(SimTime::from_ms(600), &mut PayloadChange::default());
        assert_eq!(lamp, LampState::OFF);
    }
}
