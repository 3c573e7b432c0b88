//! One channel of the receiver: which signal of a satellite it tracks, and the errors of its measurements.

use super::antenna::{db_from_ratio, direct_cn0_db_hz};
use super::multipath;
use super::propagation::{Echo, Signals};
use spandrel_model::frames::{Enu, Ned, Vec3};
use spandrel_model::math;
use spandrel_model::time::SimTime;

/// Carrier-to-noise density below which a receiver loses a signal, dB Hz (estimate).
const MIN_CN0_DB_HZ: f64 = 25.0;
/// Time from the return of a signal until the receiver uses it again (u-blox M8 data sheet: reacquisition in 1 s).
const REACQUISITION_TIME: SimTime = SimTime::from_ms(1_000);
/// Time constant with which the carrier smooths the code, s (estimate).
const SMOOTHING_TIME_S: f64 = 20.0;

/// Signal that a channel tracks.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Track {
    Nothing,
    Direct,
    Echo,
}

/// State of a channel.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Channel {
    track: Track,
    usable_from: SimTime,
    path_error_m: f64,
}

/// Measurement of a channel.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Measurement {
    /// Carrier-to-noise density, dB Hz.
    pub(super) cn0_db_hz: f64,
    /// Error of the pseudorange due to reflections, m.
    pub(super) path_error_m: f64,
    /// Error of the rate of the pseudorange due to a reflection, m/s.
    pub(super) rate_error_m_s: f64,
}

impl Channel {
    /// Creates a channel that tracks its satellite as soon as a signal arrives.
    pub(super) fn new() -> Self {
        Self { track: Track::Nothing, usable_from: SimTime::ZERO, path_error_m: 0.0 }
    }

    /// Tracks a satellite's signals for one period; returns the measurement if the receiver can use it.
    pub(super) fn track(&mut self, signals: &Signals, receiver: &Receiver, period_s: f64) -> Option<Measurement> {
        let (track, measurement) = measure(signals, receiver);
        if self.track == Track::Nothing && track != Track::Nothing && receiver.now > SimTime::ZERO {
            self.usable_from = receiver.now + REACQUISITION_TIME;
        }
        let is_new = self.track != track;
        self.track = track;
        let measurement = measurement?;
        // Another signal has another phase of the carrier: the smoothing begins again.
        let keep = if is_new { 0.0 } else { math::exp(-period_s / SMOOTHING_TIME_S) };
        self.path_error_m = measurement.path_error_m + (self.path_error_m - measurement.path_error_m) * keep;
        let smoothed = Measurement { path_error_m: self.path_error_m, ..measurement };
        (receiver.now >= self.usable_from).then_some(smoothed)
    }
}

/// True motion of the receiver relative to a satellite.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Receiver {
    /// Unit vector to the satellite.
    pub(super) satellite: Vec3<Enu>,
    /// Velocity, m/s.
    pub(super) velocity_m_s: Vec3<Ned>,
    /// Time.
    pub(super) now: SimTime,
}

fn measure(signals: &Signals, receiver: &Receiver) -> (Track, Option<Measurement>) {
    let cn0_db_hz = direct_cn0_db_hz(receiver.satellite);
    if signals.direct {
        let error_m = |echo: &Echo| multipath::error_m(echo.amplitude, echo.reflection.extra_path_m);
        let path_error_m = signals.echoes.iter().map(error_m).sum();
        return (Track::Direct, Some(Measurement { cn0_db_hz, path_error_m, rate_error_m_s: 0.0 }));
    }
    match signals.strongest().map(|echo| (echo, cn0_db_hz + db_from_ratio(echo.amplitude))) {
        Some((echo, cn0_db_hz)) if cn0_db_hz >= MIN_CN0_DB_HZ => (Track::Echo, Some(measure_echo(echo, cn0_db_hz, receiver))),
        Some(_) | None => (Track::Nothing, None),
    }
}

/// Returns the measurement of a reflected signal alone: the pseudorange is too long by the extra path, and its rate by the
/// derivative of the extra path.
fn measure_echo(echo: &Echo, cn0_db_hz: f64, receiver: &Receiver) -> Measurement {
    let Echo { reflection, .. } = echo;
    let approach_m_s = receiver.velocity_m_s.enu().dot(reflection.normal);
    Measurement {
        cn0_db_hz,
        path_error_m: reflection.extra_path_m,
        rate_error_m_s: 2.0 * approach_m_s * reflection.cos_incidence,
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use spandrel_model::site::reflectors::{MirrorMaterial, Reflection};

    const PERIOD_S: f64 = 0.2;

    fn receiver(ms: i64) -> Receiver {
        Receiver { satellite: Vec3::new(0.0, 0.8, 0.6), velocity_m_s: Vec3::new(0.0, 0.0, -2.0), now: SimTime::from_ms(ms) }
    }

    fn echo(amplitude: f64) -> Echo {
        let reflection = Reflection {
            point_m: Vec3::zero(),
            normal: Vec3::new(0.0, 0.0, 1.0),
            cos_incidence: 0.6,
            extra_path_m: 12.0,
            zone_share: 1.0,
            material: MirrorMaterial::Water,
        };
        Echo { reflection, amplitude }
    }

    #[test]
    fn exact_hidden_satellite_with_an_echo_is_late_by_the_extra_path_and_its_rate() {
        let signals = Signals { direct: false, echoes: vec![echo(0.1), echo(0.5)] };
        let found = Channel::new().track(&signals, &receiver(0), PERIOD_S).expect("strong enough");
        // Climbing at 2 m/s, the extra path of 2 h sin(elevation) grows by 2.4 m/s.
        assert!((found.path_error_m - 12.0).abs() < 1e-12 && (found.rate_error_m_s - 2.4).abs() < 1e-12, "{found:?}");
        let direct = Channel::new().track(&Signals { direct: true, echoes: vec![] }, &receiver(0), PERIOD_S).expect("visible");
        assert!((direct.cn0_db_hz - found.cn0_db_hz - 6.0206).abs() < 1e-3, "{direct:?}");
        assert_eq!(Channel::new().track(&Signals { direct: false, echoes: vec![echo(0.05)] }, &receiver(0), PERIOD_S), None);
    }

    #[test]
    fn exact_hidden_satellite_is_used_again_a_second_after_it_returns() {
        let (open, hidden) = (Signals { direct: true, echoes: vec![] }, Signals { direct: false, echoes: vec![] });
        let mut channel = Channel::new();
        assert!(channel.track(&open, &receiver(0), PERIOD_S).is_some());
        assert!(channel.track(&hidden, &receiver(200), PERIOD_S).is_none());
        let used: Vec<bool> = (2..9).map(|k| channel.track(&open, &receiver(200 * k), PERIOD_S).is_some()).collect();
        assert_eq!(used, [false, false, false, false, false, true, true]);
    }

    #[test]
    fn exact_change_to_the_echo_is_a_jump_and_other_errors_are_smoothed() {
        let mut channel = Channel::new();
        let open = Signals { direct: true, echoes: vec![] };
        let (both, alone) =
            (Signals { direct: true, echoes: vec![echo(0.5)] }, Signals { direct: false, echoes: vec![echo(0.5)] });
        channel.track(&open, &receiver(0), PERIOD_S);
        let full_m = multipath::error_m(0.5, 12.0);
        let first = channel.track(&both, &receiver(200), PERIOD_S).expect("visible").path_error_m;
        assert!((first - full_m * (1.0 - math::exp(-0.01))).abs() < 1e-12, "{first} {full_m}");
        assert_eq!(channel.track(&alone, &receiver(400), PERIOD_S).expect("echo").path_error_m, 12.0);
    }
}
