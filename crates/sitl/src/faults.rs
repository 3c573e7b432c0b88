//! Failures that an instructor injects (MAV_CMD_INJECT_FAILURE): sensors, motors, battery and manual control. They
//! corrupt sensor readings and actuator commands; the autopilot is not notified.

use super::physics::{Actuators, MAX_ROTORS};
use super::sensors::Readings;
use spandrel_model::frames::{Frd, Ned, Vec3};
use spandrel_model::math;
use spandrel_model::random::RandomStream;
use spandrel_model::time::SimTime;

/// Failing component, from MAVLink's FAILURE_UNIT.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub enum FailureUnit {
    /// Magnetometer (2).
    Magnetometer,
    /// Barometer (3).
    Barometer,
    /// GNSS receiver (4).
    Gnss,
    /// Optical flow (5).
    Flow,
    /// Range finders (7).
    Ranges,
    /// Battery (100).
    Battery,
    /// Motor (101).
    Motor,
    /// Manual control (104).
    Sticks,
}

/// Failure mode, from MAVLink's FAILURE_TYPE.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum FailureType {
    /// No output (1).
    Off,
    /// Repetition of the last value (2).
    Stuck,
    /// Random values (3).
    Garbage,
    /// Constant error (4).
    Wrong,
    /// One second on, one second off, repeatedly (7).
    Intermittent,
}

impl FailureUnit {
    /// Returns the unit for a MAVLink number, or `None` if it is not supported.
    #[must_use]
    pub fn from_number(n: i64) -> Option<Self> {
        Some(match n {
            2 => Self::Magnetometer,
            3 => Self::Barometer,
            4 => Self::Gnss,
            5 => Self::Flow,
            7 => Self::Ranges,
            100 => Self::Battery,
            101 => Self::Motor,
            104 => Self::Sticks,
            _ => return None,
        })
    }

    /// Returns true if this component supports the failure mode.
    fn supports(self, kind: FailureType) -> bool {
        match self {
            Self::Magnetometer | Self::Barometer | Self::Gnss | Self::Ranges => true,
            Self::Flow => matches!(kind, FailureType::Off | FailureType::Intermittent),
            Self::Battery | Self::Motor => kind == FailureType::Off,
            Self::Sticks => matches!(kind, FailureType::Off | FailureType::Intermittent),
        }
    }
}

impl FailureType {
    /// Returns the failure mode for a MAVLink number: `Some(None)` for 0 (no failure), `None` if it is not supported.
    #[must_use]
    pub fn from_number(n: i64) -> Option<Option<Self>> {
        Some(match n {
            0 => None,
            1 => Some(Self::Off),
            2 => Some(Self::Stuck),
            3 => Some(Self::Garbage),
            4 => Some(Self::Wrong),
            7 => Some(Self::Intermittent),
            _ => return None,
        })
    }
}

/// Constant position error, north and east, and constant height error, m (estimates: a multipath jump below a deck).
const POSITION_ERROR_M: f64 = 25.0;
const HEIGHT_ERROR_M: f64 = 8.0;
/// Height over which the air pressure falls by a factor of e, m (ISO 2533, at sea level).
const SCALE_HEIGHT_M: f64 = 8_434.5;
/// Standard deviations of garbage readings: position (m), height (m) and magnetic field (gauss).
const GARBAGE_POSITION_SIGMA_M: f64 = 30.0;
const GARBAGE_HEIGHT_SIGMA_M: f64 = 10.0;
const GARBAGE_FIELD_SIGMA_GAUSS: f64 = 0.5;
/// Factor applied to the reading of a faulty range finder.
const FAULTY_RANGE_FACTOR: f64 = 0.5;
/// Maximum charge left after a battery failure, 0 to 1.
const MAX_CHARGE_AFTER_FAILURE: f64 = 0.05;

/// All active failures.
#[derive(Debug, Clone)]
pub struct Faults {
    sensors: [Option<FailureType>; 5],
    motors: [bool; MAX_ROTORS],
    sticks: Option<FailureType>,
    held: Readings,
    stream: RandomStream,
}

impl Faults {
    /// Creates the state without failures.
    #[must_use]
    pub fn new(seed: u64) -> Self {
        Self {
            sensors: [None; 5],
            motors: [false; MAX_ROTORS],
            sticks: None,
            held: Readings::default(),
            stream: RandomStream::new(seed, "faults"),
        }
    }

    /// Injects a failure, or clears it with `None`. `instance` counts from 1; 0 selects all instances. Returns false if
    /// the failure is not supported.
    pub fn inject(&mut self, unit: FailureUnit, kind: Option<FailureType>, instance: usize, rotors: usize) -> bool {
        if kind.is_some_and(|kind| !unit.supports(kind)) {
            return false;
        }
        match unit {
            FailureUnit::Motor => {
                if instance > rotors {
                    return false;
                }
                let all = instance == 0;
                (0..rotors).filter(|k| all || k + 1 == instance).for_each(|k| self.motors[k] = kind.is_some());
            }
            FailureUnit::Sticks => self.sticks = kind,
            FailureUnit::Battery => {}
            FailureUnit::Magnetometer | FailureUnit::Barometer | FailureUnit::Gnss | FailureUnit::Flow | FailureUnit::Ranges => {
                self.sensors[sensor_index(unit)] = kind
            }
        }
        true
    }

    /// Returns the state of charge after a battery failure, 0 to 1.
    #[must_use]
    pub fn charge(charge: f64) -> f64 {
        charge.min(MAX_CHARGE_AFTER_FAILURE)
    }

    /// Returns true if manual control input reaches the autopilot at this time.
    #[must_use]
    pub fn passes_manual_control(&self, now: SimTime) -> bool {
        match self.sticks {
            Some(FailureType::Intermittent) => !is_silent(now),
            Some(_) => false,
            None => true,
        }
    }

    /// Stores the latest reading of every sensor that is not stuck.
    fn store_latest_readings(&mut self, fresh: &Readings) {
        let before = self.held;
        let stuck = |unit| self.sensors[sensor_index(unit)] == Some(FailureType::Stuck);
        let [mag, baro, gnss, flow, ranges] =
            [FailureUnit::Magnetometer, FailureUnit::Barometer, FailureUnit::Gnss, FailureUnit::Flow, FailureUnit::Ranges]
                .map(stuck);
        let held = &mut self.held;
        held.update_latest(fresh);
        if mag {
            held.mag_gauss = before.mag_gauss;
        }
        if baro {
            held.baro_up_m = before.baro_up_m;
            held.pressure_pa = before.pressure_pa;
        }
        if gnss {
            held.gnss = before.gnss;
        }
        if flow {
            held.flow = before.flow;
        }
        if ranges {
            held.range_down_m = before.range_down_m;
            held.range_up_m = before.range_up_m;
            held.range_around_m = before.range_around_m;
        }
    }

    /// Applies the active failures to new readings.
    pub fn corrupt_readings(&mut self, fresh: &mut Readings, now: SimTime) {
        if self.sensors.iter().all(Option::is_none) {
            self.held.update_latest(fresh);
            return;
        }
        let kinds = self.sensors;
        self.store_latest_readings(fresh);
        let held = self.held;
        let noise = |stream: &mut RandomStream, scale: f64| stream.normal3().map(|x| x * scale);
        if let Some(kind) = kinds[sensor_index(FailureUnit::Gnss)]
            && let Some(fix) = &mut fresh.gnss
        {
            let [n, e, d] = match kind {
                FailureType::Wrong => [POSITION_ERROR_M, POSITION_ERROR_M, 0.0],
                FailureType::Garbage => noise(&mut self.stream, GARBAGE_POSITION_SIGMA_M),
                FailureType::Off | FailureType::Stuck | FailureType::Intermittent => [0.0; 3],
            };
            fix.position_m += Vec3::<Ned>::new(n, e, d);
            // A receiver without a signal still reports that it has no fix.
            if kind == FailureType::Off || (kind == FailureType::Intermittent && is_silent(now)) {
                (fix.fix, fix.satellites) = (0, 0);
            }
            if kind == FailureType::Stuck {
                fresh.gnss = held.gnss;
            }
        }
        if let Some(kind) = kinds[sensor_index(FailureUnit::Barometer)] {
            let rise = match kind {
                FailureType::Wrong => HEIGHT_ERROR_M,
                FailureType::Garbage => self.stream.normal() * GARBAGE_HEIGHT_SIGMA_M,
                FailureType::Off | FailureType::Stuck | FailureType::Intermittent => 0.0,
            };
            fresh.baro_up_m = faulty_reading(kind, fresh.baro_up_m.map(|up| up + rise), held.baro_up_m, now);
            let pressure_pa = fresh.pressure_pa.map(|pressure_pa| pressure_pa * math::exp(-rise / SCALE_HEIGHT_M));
            fresh.pressure_pa = faulty_reading(kind, pressure_pa, held.pressure_pa, now);
        }
        if let Some(kind) = kinds[sensor_index(FailureUnit::Magnetometer)] {
            let turned = |field: Vec3<Frd>, [x, y, z]: [f64; 3]| match kind {
                // Rotated by 90 degrees, as if by a magnet near the sensor.
                FailureType::Wrong => Vec3::new(-field.right(), field.forward(), field.down()),
                FailureType::Off | FailureType::Stuck | FailureType::Garbage | FailureType::Intermittent => {
                    field + Vec3::new(x, y, z)
                }
            };
            let scale = if kind == FailureType::Garbage { GARBAGE_FIELD_SIGMA_GAUSS } else { 0.0 };
            let spoilt = fresh.mag_gauss.map(|field| turned(field, noise(&mut self.stream, scale)));
            fresh.mag_gauss = faulty_reading(kind, spoilt, held.mag_gauss, now);
        }
        if let Some(kind) = kinds[sensor_index(FailureUnit::Flow)] {
            fresh.flow = faulty_reading(kind, fresh.flow, held.flow, now);
        }
        if let Some(kind) = kinds[sensor_index(FailureUnit::Ranges)] {
            let factor = match kind {
                FailureType::Wrong => FAULTY_RANGE_FACTOR,
                FailureType::Garbage => 0.2 + self.stream.uniform(),
                FailureType::Off | FailureType::Stuck | FailureType::Intermittent => 1.0,
            };
            fresh.range_down_m = faulty_reading(kind, fresh.range_down_m.map(|m| m * factor), held.range_down_m, now);
            fresh.range_up_m = faulty_reading(kind, fresh.range_up_m.map(|m| m * factor), held.range_up_m, now);
            fresh.range_around_m =
                faulty_reading(kind, fresh.range_around_m.map(|all| all.map(|m| m * factor)), held.range_around_m, now);
        }
    }

    /// Stops failed motors.
    pub fn stop_motors(&self, actuators: &mut Actuators) {
        for (command, failed) in actuators.motors.iter_mut().zip(self.motors) {
            if failed {
                *command = 0.0;
            }
        }
    }
}

fn sensor_index(sensor: FailureUnit) -> usize {
    match sensor {
        FailureUnit::Magnetometer => 0,
        FailureUnit::Barometer => 1,
        FailureUnit::Gnss => 2,
        FailureUnit::Flow => 3,
        FailureUnit::Ranges | FailureUnit::Battery | FailureUnit::Motor | FailureUnit::Sticks => 4,
    }
}

fn is_silent(now: SimTime) -> bool {
    now.ms().rem_euclid(2_000) >= 1_000
}

/// Applies a failure to one reading. Returns `None` if no reading is due.
fn faulty_reading<T: Copy>(kind: FailureType, fresh: Option<T>, held: Option<T>, now: SimTime) -> Option<T> {
    match kind {
        FailureType::Off => None,
        FailureType::Stuck => fresh.and(held),
        FailureType::Intermittent if is_silent(now) => None,
        FailureType::Garbage | FailureType::Wrong | FailureType::Intermittent => fresh,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn is_corrupted(kind: FailureType, ms: i64) -> Option<f64> {
        let mut faults = Faults::new(1);
        let reading = |up| Readings { baro_up_m: Some(up), ..Readings::default() };
        faults.corrupt_readings(&mut reading(3.0), SimTime::ZERO);
        assert!(faults.inject(FailureUnit::Barometer, Some(kind), 0, 4));
        let mut fresh = reading(5.0);
        faults.corrupt_readings(&mut fresh, SimTime::from_ms(ms));
        fresh.baro_up_m
    }

    #[test]
    fn exact_each_failure_type_corrupts_readings() {
        assert_eq!(is_corrupted(FailureType::Off, 0), None);
        assert_eq!(is_corrupted(FailureType::Stuck, 0), Some(3.0));
        assert_eq!(is_corrupted(FailureType::Wrong, 0), Some(5.0 + HEIGHT_ERROR_M));
        assert_eq!(
            (is_corrupted(FailureType::Intermittent, 500), is_corrupted(FailureType::Intermittent, 1_500)),
            (Some(5.0), None)
        );
        assert!(is_corrupted(FailureType::Garbage, 0).is_some_and(|up| up != 5.0));
    }

    #[test]
    fn exact_stuck_sensor_keeps_its_last_reading_despite_other_failures() {
        let mut faults = Faults::new(1);
        let reading = |up| Readings { baro_up_m: Some(up), ..Readings::default() };
        faults.corrupt_readings(&mut reading(3.0), SimTime::ZERO);
        faults.inject(FailureUnit::Magnetometer, Some(FailureType::Wrong), 0, 4);
        faults.corrupt_readings(&mut reading(50.0), SimTime::from_ms(60_000));
        faults.inject(FailureUnit::Barometer, Some(FailureType::Stuck), 0, 4);
        for ms in [60_010, 90_000] {
            let mut fresh = reading(70.0);
            faults.corrupt_readings(&mut fresh, SimTime::from_ms(ms));
            assert_eq!(fresh.baro_up_m, Some(50.0));
        }
    }

    #[test]
    fn exact_unsupported_failures_are_rejected_and_motors_count_from_one() {
        let mut faults = Faults::new(1);
        assert!(!faults.inject(FailureUnit::Motor, Some(FailureType::Stuck), 1, 4));
        assert!(!faults.inject(FailureUnit::Motor, Some(FailureType::Off), 5, 4));
        assert!(faults.inject(FailureUnit::Motor, Some(FailureType::Off), 2, 4));
        let mut actuators = Actuators { motors: [0.5; MAX_ROTORS], armed: true };
        faults.stop_motors(&mut actuators);
        assert_eq!(actuators.motors[..3], [0.5, 0.0, 0.5]);
        assert!(faults.inject(FailureUnit::Motor, None, 0, 4));
        let mut again = Actuators { motors: [0.5; MAX_ROTORS], armed: true };
        faults.stop_motors(&mut again);
        assert_eq!(again.motors[1], 0.5);
    }
}
