//! Vibration of the rotors, as the inertial sensors measure it: the imbalance of each rotor turns with it, and the frame answers
//! with broadband noise. Both grow with the square of the rotor speed.

use super::readings::ImuReading;
use crate::physics::MAX_ROTORS;
use spandrel_model::frames::{Frd, Vec3};
use spandrel_model::math;
use spandrel_model::random::RandomStream;
use spandrel_model::time::SimTime;
use spandrel_model::vehicle::Vehicle;

/// Share of the vibration at the rotor frequencies, as amplitude (estimate: the peaks dominate in spectra of flight logs). The
/// broadband share accounts for the remaining variance.
const HARMONIC_SHARE: f64 = 0.8;
/// Broadband share: `HARMONIC_SHARE`² + `BROADBAND_SHARE`² = 1.
const BROADBAND_SHARE: f64 = 0.6;

/// Vibration since the last sample of the inertial sensors.
#[derive(Debug, Clone, PartialEq)]
pub struct RotorVibration {
    stream: RandomStream,
    /// Standard deviations per axis in a hover: m/s², rad/s.
    accel_m_s2: f64,
    gyro_rad_s: f64,
    hover_rad_s: f64,
    spins: Vec<f64>,
    phases_rad: [f64; MAX_ROTORS],
    /// Sine and cosine of each phase.
    phases_sin_cos: [(f64, f64); MAX_ROTORS],
    turned_rad: [f64; MAX_ROTORS],
    /// Integral of the squared rotor speeds over time, rad²/s.
    squared_speed_time: [f64; MAX_ROTORS],
    time_s: f64,
    /// Vibration in the latest reading.
    latest: ImuReading,
}

/// Mean of cosine and sine of a rotor's angle over a sample, times the strength of its vibration.
#[derive(Debug, Clone, Copy)]
struct RotorSample {
    cos: f64,
    sin: f64,
    strength: f64,
    spin: f64,
}

impl RotorSample {
    const NONE: Self = Self { cos: 0.0, sin: 0.0, strength: 0.0, spin: 0.0 };
}

impl RotorVibration {
    /// Returns `None` if the aircraft file has no vibration.
    #[must_use]
    pub fn of(vehicle: &Vehicle, seed: u64) -> Option<Self> {
        let sensors = &vehicle.sensors;
        let mut stream = RandomStream::new(seed, "imu.vibration");
        let phases_rad = [(); MAX_ROTORS].map(|()| stream.uniform() * math::TAU);
        let is_on = sensors.accel_vibration_m_s2 > 0.0 || sensors.gyro_vibration_rad_s > 0.0;
        is_on.then(|| Self {
            stream,
            accel_m_s2: sensors.accel_vibration_m_s2,
            gyro_rad_s: sensors.gyro_vibration_rad_s,
            hover_rad_s: vehicle.hover_rotor_rad_s(),
            spins: vehicle.rotors.iter().map(|rotor| rotor.spin).collect(),
            phases_rad,
            phases_sin_cos: phases_rad.map(math::sin_cos),
            turned_rad: [0.0; MAX_ROTORS],
            squared_speed_time: [0.0; MAX_ROTORS],
            time_s: 0.0,
            latest: ImuReading::ZERO,
        })
    }

    /// Turns the rotors by one physics step.
    pub fn advance(&mut self, rotor_rad_s: &[f64; MAX_ROTORS], dt: SimTime) {
        let dt_s = dt.s();
        for ((turned, squared), speed) in self.turned_rad.iter_mut().zip(&mut self.squared_speed_time).zip(rotor_rad_s) {
            *turned += speed * dt_s;
            *squared += speed * speed * dt_s;
        }
        self.time_s += dt_s;
    }

    /// Adds the mean vibration since the last call to a reading.
    pub fn add_to(&mut self, reading: &mut ImuReading) {
        if self.time_s <= 0.0 {
            return;
        }
        let mut rotors = [RotorSample::NONE; MAX_ROTORS];
        let rotors = &mut rotors[..self.spins.len().min(MAX_ROTORS)];
        rotors.iter_mut().enumerate().for_each(|(i, rotor)| *rotor = self.take_rotor(i));
        self.time_s = 0.0;
        let count = rotors.len().max(1) as f64;
        // The rotors' phases are independent, and a sine of amplitude 1 has the variance 1/2.
        let harmonic = HARMONIC_SHARE * (2.0 / count).sqrt();
        let broadband = BROADBAND_SHARE * rotors.iter().map(|rotor| rotor.strength).sum::<f64>() / count;
        let sum = |axis: fn(&RotorSample) -> f64| rotors.iter().map(|rotor| rotor.strength * axis(rotor)).sum::<f64>();
        let turning = Vec3::new(sum(|r| r.cos), sum(|r| r.spin * r.sin), sum(|r| r.sin));
        let rocking = Vec3::new(sum(|r| r.spin * r.sin), sum(|r| -r.cos), sum(|r| r.cos));
        let [noise_accel, noise_gyro] = self.noise();
        self.latest = ImuReading {
            specific_force_m_s2: (turning * harmonic + noise_accel * broadband) * self.accel_m_s2,
            rates_rad_s: (rocking * harmonic + noise_gyro * broadband) * self.gyro_rad_s,
        };
        *reading = *reading + self.latest;
    }

    /// Returns the vibration in the latest reading.
    #[must_use]
    pub fn latest(&self) -> ImuReading {
        self.latest
    }

    /// Returns the sample of one rotor and starts the next one.
    fn take_rotor(&mut self, index: usize) -> RotorSample {
        let (start, turned) = (self.phases_rad[index], self.turned_rad[index]);
        let end = start + turned;
        let ((sin_start, cos_start), (sin_end, cos_end)) = (self.phases_sin_cos[index], math::sin_cos(end));
        let (cos, sin) =
            if turned > 0.0 { ((sin_end - sin_start) / turned, (cos_start - cos_end) / turned) } else { (cos_start, sin_start) };
        let strength = self.squared_speed_time[index] / self.time_s / (self.hover_rad_s * self.hover_rad_s);
        let phase = math::wrap_pi(end);
        self.phases_rad[index] = phase;
        // The sine of a wrapped angle can differ in the last bit.
        self.phases_sin_cos[index] = if phase == end { (sin_end, cos_end) } else { math::sin_cos(phase) };
        (self.turned_rad[index], self.squared_speed_time[index]) = (0.0, 0.0);
        RotorSample { cos, sin, strength, spin: self.spins[index] }
    }

    /// Returns two vectors of independent standard normal values.
    fn noise(&mut self) -> [Vec3<Frd>; 2] {
        [(); 2].map(|()| {
            let [x, y, z] = self.stream.normal3();
            Vec3::new(x, y, z)
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const VEHICLE: &str = include_str!("../../../../vehicle-params/phantom2.toml");
    const STEP: SimTime = SimTime::from_ms(1);

    fn shaking(accel_m_s2: f64, gyro_rad_s: f64) -> Vehicle {
        let mut vehicle = spandrel_model::vehicle::read("phantom2.toml", VEHICLE).unwrap();
        vehicle.sensors.accel_vibration_m_s2 = accel_m_s2;
        vehicle.sensors.gyro_vibration_rad_s = gyro_rad_s;
        vehicle
    }

    /// Returns the standard deviation of each axis over 20 s at a rotor speed relative to hover: accelerometer, then gyroscope.
    fn deviations(vehicle: &Vehicle, speed: f64) -> [f64; 6] {
        const SAMPLES: usize = 20_000;
        let mut vibration = RotorVibration::of(vehicle, 3).unwrap();
        let hover = vehicle.hover_rotor_rad_s();
        // Different speeds of the rotors, as in flight, so that their phases are independent.
        let rotors = [0.97, 0.99, 1.01, 1.03].map(|factor| factor * speed * hover);
        let mut squares = [0.0; 6];
        for _ in 0..SAMPLES {
            let mut all = [0.0; MAX_ROTORS];
            all[..4].copy_from_slice(&rotors);
            vibration.advance(&all, STEP);
            let mut reading = ImuReading::ZERO;
            vibration.add_to(&mut reading);
            let values = reading.specific_force_m_s2.array().into_iter().chain(reading.rates_rad_s.array());
            squares.iter_mut().zip(values).for_each(|(square, value)| *square += value * value);
        }
        squares.map(|square| (square / SAMPLES as f64).sqrt())
    }

    #[test]
    fn exact_vibration_in_a_hover_has_the_deviation_of_the_file_and_grows_with_the_square_of_the_speed() {
        // The mean over a sample of 1 ms reduces a sine of about 90 Hz by 1.3%. Twenty thousand samples have a standard error of 0.5%.
        const TOLERANCE: f64 = 0.04;
        let vehicle = shaking(1.5, 0.05);
        for (speed, factor) in [(1.0, 1.0), (0.5, 0.25)] {
            let got = deviations(&vehicle, speed);
            for (axis, value) in got.into_iter().enumerate() {
                let expected = factor * if axis < 3 { 1.5 } else { 0.05 };
                assert!((value / expected - 1.0).abs() < TOLERANCE, "axis {axis} at {speed}: {value}, not {expected}");
            }
        }
    }

    #[test]
    fn exact_rotors_at_rest_do_not_vibrate() {
        let mut vibration = RotorVibration::of(&shaking(1.5, 0.05), 3).unwrap();
        vibration.advance(&[0.0; MAX_ROTORS], STEP);
        let mut reading = ImuReading::ZERO;
        vibration.add_to(&mut reading);
        assert_eq!(reading, ImuReading::ZERO);
    }

    #[test]
    fn regress_aircraft_without_vibration_have_none() {
        assert_eq!(RotorVibration::of(&shaking(0.0, 0.0), 3), None);
    }
}
