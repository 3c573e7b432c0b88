//! RADIO_STATUS in the scale of SiK telemetry radios, which ground stations show.

use crate::dialect::{MavMessage, RADIO_STATUS_DATA};

/// Value per dB, and the signal at the value 0, dBm (documentation of the SiK radios: signal = value / 1.9 - 127).
const SCALE: (f64, f64) = (1.9, -127.0);
/// Largest value; 255 stands for an unknown one.
const MAX_VALUE: f64 = 254.0;

/// Returns a signal strength in the radio's scale.
#[must_use]
pub fn value_of_dbm(signal_dbm: f64) -> u8 {
    let (per_db, at_zero_dbm) = SCALE;
    (per_db * (signal_dbm - at_zero_dbm)).round().clamp(0.0, MAX_VALUE) as u8
}

/// Returns the signal strength of a value, dBm; `None` if it is unknown.
#[must_use]
pub fn dbm_of_value(value: u8) -> Option<f64> {
    let (per_db, at_zero_dbm) = SCALE;
    (value != u8::MAX).then_some(f64::from(value) / per_db + at_zero_dbm)
}

/// Encodes the state of a link that is equally strong in both directions: signal and noise, dBm, and the number of intervals without data so
/// far.
#[must_use]
pub fn message(signal_dbm: f64, noise_dbm: f64, silent_intervals: u32) -> MavMessage {
    let (signal, noise) = (value_of_dbm(signal_dbm), value_of_dbm(noise_dbm));
    MavMessage::RADIO_STATUS(RADIO_STATUS_DATA {
        rssi: signal,
        remrssi: signal,
        noise,
        remnoise: noise,
        // Percentage of the buffer that is free.
        txbuf: 100,
        rxerrors: u16::try_from(silent_intervals).unwrap_or(u16::MAX),
        fixed: 0,
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn exact_values_follow_the_documented_scale() {
        assert_eq!([-127.0, -100.0, -60.0, 20.0, f64::NEG_INFINITY].map(value_of_dbm), [0, 51, 127, 254, 0]);
        assert_eq!(dbm_of_value(u8::MAX), None);
        // Rounding to whole values.
        assert!((dbm_of_value(value_of_dbm(-80.0)).unwrap() + 80.0).abs() <= 0.5 / 1.9);
    }

    #[test]
    fn wire_status_has_the_same_signal_at_both_ends() {
        let MavMessage::RADIO_STATUS(status) = message(-60.0, -104.0, 70_000) else { panic!("another message") };
        assert_eq!((status.rssi, status.remrssi, status.noise, status.remnoise), (127, 127, 44, 44));
        assert_eq!((status.txbuf, status.rxerrors), (100, u16::MAX));
    }
}
