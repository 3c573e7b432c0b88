//! Sensor health. A sensor that stops responding, repeats one reading or contradicts other sensors is reported, is not
//! used, and prevents arming.

use crate::autopilot::estimator::RejectedSources;
use crate::sensors::Readings;
use spandrel_model::time::SimTime;
use spandrel_model::vehicle;

/// Timeout for sensor readings, s (estimate: 25 compass or barometer readings).
const READING_TIMEOUT_S: f64 = 0.5;
/// Duration of identical readings after which a sensor counts as stuck, s (ArduPilot's barometer: 2 s; PX4: 100 equal
/// values, 2 s at 50 Hz).
const STUCK_TIMEOUT_S: f64 = 2.0;

/// Sensor and control health for telemetry.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct SensorStatus {
    /// Whether the compass is used.
    pub compass: bool,
    /// Whether the barometer is used.
    pub barometer: bool,
    /// Whether GNSS is used when it has a fix.
    pub gnss: bool,
    /// Whether the vehicle tracks its attitude setpoint.
    pub tracks_attitude: bool,
}

impl SensorStatus {
    /// All sensors and controls work.
    pub const ALL_GOOD: Self = Self { compass: true, barometer: true, gnss: true, tracks_attitude: true };
}

/// A monitored sensor.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum MonitoredSensor {
    /// Magnetometer.
    Compass,
    /// Barometer.
    Barometer,
    /// GNSS receiver.
    Gnss,
}

impl MonitoredSensor {
    fn name(self) -> &'static str {
        match self {
            Self::Compass => "Compass",
            Self::Barometer => "Barometer",
            Self::Gnss => "GNSS",
        }
    }
}

/// Reason why a sensor is not used.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum SensorFault {
    /// No readings.
    NoReadings,
    /// Identical readings, bit for bit.
    Stuck,
    /// Readings that contradict other sensors.
    Inconsistent,
}

/// A change in a sensor's health.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct SensorChange {
    /// The sensor whose health changed.
    pub sensor: MonitoredSensor,
    /// Its current fault; `None` if it works again.
    pub fault: Option<SensorFault>,
}

impl SensorChange {
    /// Returns the status text for the change.
    #[must_use]
    pub fn status_text(self) -> String {
        let name = self.sensor.name();
        match self.fault {
            Some(SensorFault::NoReadings) => format!("{name} lost: no readings"),
            Some(SensorFault::Stuck) => format!("{name} stuck: not used"),
            Some(SensorFault::Inconsistent) => format!("{name} inconsistent: not used"),
            None => format!("{name} recovered"),
        }
    }
}

/// Monitors the readings of one sensor. Timing starts with the first check.
#[derive(Debug, Clone, Copy, PartialEq)]
struct SensorMonitor<T> {
    /// Whether consecutive readings always differ because of sensor noise.
    noisy: bool,
    latest: Option<T>,
    received: Option<SimTime>,
    changed: Option<SimTime>,
    fault: Option<SensorFault>,
}

impl<T: Copy + PartialEq> SensorMonitor<T> {
    fn new(noisy: bool) -> Self {
        Self { noisy, latest: None, received: None, changed: None, fault: None }
    }

    /// Records a reading. Returns it if it is new, or `None` if it repeats the last one.
    fn accept(&mut self, reading: Option<T>, now: SimTime) -> Option<T> {
        let (received, changed) = (self.received.get_or_insert(now), self.changed.get_or_insert(now));
        let value = reading?;
        *received = now;
        if self.noisy && self.latest == Some(value) {
            return None;
        }
        *changed = now;
        self.latest = Some(value);
        Some(value)
    }

    /// Updates the fault. Returns true if it changed.
    fn update_fault(&mut self, may_be_silent: bool, dropped: bool, now: SimTime) -> bool {
        let since = |at: Option<SimTime>| at.map_or(0.0, |at| (now - at).s());
        let silent = !may_be_silent && since(self.received) > READING_TIMEOUT_S;
        let stuck = since(self.changed) - since(self.received) > STUCK_TIMEOUT_S;
        let fault = match (silent, stuck, dropped) {
            (true, ..) => Some(SensorFault::NoReadings),
            (_, true, _) => Some(SensorFault::Stuck),
            (.., true) => Some(SensorFault::Inconsistent),
            _ => None,
        };
        std::mem::replace(&mut self.fault, fault) != fault
    }
}

/// Health of all monitored sensors.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct SensorHealth {
    compass: SensorMonitor<[f64; 3]>,
    barometer: SensorMonitor<f64>,
    gnss: SensorMonitor<[f64; 6]>,
}

impl SensorHealth {
    /// Creates monitors without readings.
    #[must_use]
    pub fn new(sensors: &vehicle::SensorSpec) -> Self {
        Self {
            compass: SensorMonitor::new(sensors.mag_noise_gauss > 0.0),
            barometer: SensorMonitor::new(sensors.baro_noise_m > 0.0),
            gnss: SensorMonitor::new(sensors.gnss_horizontal_noise_m > 0.0),
        }
    }

    /// Returns the readings that the estimator may use.
    pub fn filter(&mut self, readings: &Readings, now: SimTime) -> Readings {
        let mut out = *readings;
        if self.compass.accept(readings.mag_gauss.map(|m| m.array()), now).is_none() {
            out.mag_gauss = None;
        }
        out.baro_up_m = self.barometer.accept(readings.baro_up_m, now);
        let fix = readings.gnss.filter(|fix| fix.fix >= 3);
        let values = fix.map(|fix| {
            let ([a, b, c], [d, e, f]) = (fix.position_m.array(), fix.velocity_m_s.array());
            [a, b, c, d, e, f]
        });
        if self.gnss.accept(values, now).is_none() {
            out.gnss = out.gnss.filter(|fix| fix.fix < 3);
        }
        out
    }

    /// Updates the faults. Returns the sensors that have failed or recovered.
    pub fn changes(&mut self, dropped: RejectedSources, now: SimTime) -> Vec<SensorChange> {
        let mut out = Vec::new();
        let mut note = |changed: bool, sensor, fault| {
            if changed {
                out.push(SensorChange { sensor, fault });
            }
        };
        note(self.compass.update_fault(false, dropped.compass, now), MonitoredSensor::Compass, self.compass.fault);
        note(self.barometer.update_fault(false, dropped.barometer, now), MonitoredSensor::Barometer, self.barometer.fault);
        note(self.gnss.update_fault(true, dropped.gnss, now), MonitoredSensor::Gnss, self.gnss.fault);
        out
    }

    /// Returns the health for telemetry.
    #[must_use]
    pub fn status(&self, tracks_attitude: bool) -> SensorStatus {
        SensorStatus {
            compass: self.compass.fault.is_none(),
            barometer: self.barometer.fault.is_none(),
            gnss: self.gnss.fault.is_none(),
            tracks_attitude,
        }
    }

    /// Returns the reasons to deny arming because of sensor faults.
    #[must_use]
    pub fn arming_refusals(&self) -> Vec<String> {
        let all = [
            (MonitoredSensor::Compass, self.compass.fault),
            (MonitoredSensor::Barometer, self.barometer.fault),
            (MonitoredSensor::Gnss, self.gnss.fault),
        ];
        all.into_iter().filter_map(|(sensor, fault)| Some(arming_refusal(sensor, fault?))).collect()
    }
}

fn arming_refusal(sensor: MonitoredSensor, fault: SensorFault) -> String {
    let fault = match fault {
        SensorFault::NoReadings => "missing",
        SensorFault::Stuck => "stuck",
        SensorFault::Inconsistent => "inconsistent",
    };
    format!("{} {fault}", sensor.name())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn exact_repeated_values_are_ignored_and_become_a_fault_after_2_s() {
        let mut watched = SensorMonitor::new(true);
        let mut feed = |value: f64, from_ms: i64, until_ms: i64| {
            let mut used = 0;
            for ms in (from_ms..until_ms).step_by(20) {
                let now = SimTime::from_ms(ms);
                used += usize::from(watched.accept(Some(value), now).is_some());
                watched.update_fault(false, false, now);
            }
            (used, watched.fault)
        };
        assert_eq!(feed(1.0, 0, 2_000), (1, None));
        assert_eq!(feed(1.0, 2_000, 2_100), (0, Some(SensorFault::Stuck)));
        assert_eq!(feed(1.5, 2_100, 2_120), (1, None));
    }

    #[test]
    fn exact_noiseless_sensor_may_repeat_values() {
        let mut watched = SensorMonitor::new(false);
        let used = (0..500).filter(|k| watched.accept(Some(1.0), SimTime::from_ms(20 * k)).is_some()).count();
        watched.update_fault(false, false, SimTime::from_ms(10_000));
        assert_eq!((used, watched.fault), (500, None));
    }
}
