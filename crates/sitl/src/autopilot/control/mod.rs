//! Control: converts setpoints to motor commands with the velocity, attitude and rate loops and the mixer, and detects
//! takeoff and landing.

pub mod airframe;
mod attitude;
pub mod gains;
pub mod landed;
mod mixer;
pub mod setpoint;
pub mod shaper;
pub mod velocity;

use self::airframe::Airframe;
use self::attitude::{AttitudeLoop, limit_rates};
use self::gains::Gains;
use self::landed::LandingDetector;
use self::mixer::{AllocationStatus, Mixer, TorqueThrustSetpoint};
use self::setpoint::Setpoint;
use self::velocity::{AttitudeThrustSetpoint, VelocityLoop};
use super::estimator::estimate::Estimate;
use crate::physics::Actuators;
use crate::sensors::BatteryReading;
use spandrel_model::frames::{Frd, Ned, Rotation, Vec3};
use spandrel_model::time::SimTime;
use spandrel_model::vehicle::Vehicle;

/// Minimum voltage fraction that the mixer compensates for.
const MIN_VOLTAGE_FRACTION: f64 = 0.6;

/// Inputs for one tick.
#[derive(Debug, Clone, Copy)]
pub struct ControlInput<'a> {
    /// Estimated state.
    pub estimate: &'a Estimate,
    /// Aircraft properties.
    pub airframe: &'a Airframe,
    /// Latest battery reading.
    pub battery: Option<BatteryReading>,
    /// Heading rate feedforward, rad/s.
    pub yaw_rate_rad_s: f64,
    /// Time of this tick.
    pub now: SimTime,
    /// Time since the last tick, s.
    pub dt_s: f64,
}

/// State of the control loops.
#[derive(Debug, Clone)]
pub struct Control {
    /// Gains of all control loops.
    pub gains: Gains,
    /// Takeoff and landing detection.
    pub landing: LandingDetector,
    /// Attitude setpoint.
    pub attitude_target: Rotation<Frd, Ned>,
    /// Collective thrust setpoint, 0 to 1.
    pub thrust: f64,
    /// Cosine of the angle between desired and estimated thrust directions.
    pub attitude_error_cosine: f64,
    velocity_loop: VelocityLoop,
    attitude_loop: AttitudeLoop,
    mixer: Mixer,
    allocation: AllocationStatus,
}

impl Control {
    /// Creates the control loops for an aircraft on the ground.
    #[must_use]
    pub fn new(vehicle: &Vehicle) -> Self {
        let gains = Gains::new(vehicle);
        Self {
            gains,
            landing: LandingDetector::default(),
            attitude_target: Rotation::identity(),
            thrust: 0.0,
            attitude_error_cosine: 1.0,
            velocity_loop: VelocityLoop::default(),
            attitude_loop: AttitudeLoop::default(),
            mixer: Mixer::new(vehicle, gains.lead),
            allocation: AllocationStatus::FULLY_ALLOCATED,
        }
    }

    /// Starts a flight on the ground when the vehicle arms.
    pub fn begin_flight(&mut self, now: SimTime) {
        self.landing.arm(now);
        self.attitude_error_cosine = 1.0;
    }

    /// Resets the integrals of all loops.
    pub fn reset(&mut self) {
        self.velocity_loop.reset();
        self.attitude_loop.reset();
        self.allocation = AllocationStatus::FULLY_ALLOCATED;
    }

    /// Stops the motors.
    pub fn stop_motors(&mut self) -> Actuators {
        self.mixer.stop()
    }

    /// Keeps the motors stopped while disarmed.
    pub fn keep_motors_stopped(&mut self, estimate: &Estimate) -> Actuators {
        self.clear_targets(estimate);
        self.mixer.stop()
    }

    fn clear_targets(&mut self, estimate: &Estimate) {
        self.thrust = 0.0;
        self.attitude_target = estimate.attitude;
    }

    /// Tracks a setpoint for one tick.
    pub fn track(&mut self, setpoint: Setpoint, input: &ControlInput) -> Actuators {
        let (gains, mass_kg) = (&self.gains, input.airframe.mass_kg);
        match setpoint {
            Setpoint::Idle => {
                self.clear_targets(input.estimate);
                self.mixer.idle(input.dt_s)
            }
            Setpoint::Velocity(motion) => {
                self.landing.descent_rate_m_s = motion.velocity_m_s.down();
                let target = self.velocity_loop.fly(gains, mass_kg, input.estimate, &motion, input.dt_s);
                self.run_attitude_loop(&target, input)
            }
            Setpoint::Level { motion, tilt } => {
                self.landing.descent_rate_m_s = motion.velocity_m_s.down();
                self.velocity_loop.reset_horizontal();
                let target = self.velocity_loop.fly_level(gains, mass_kg, input.estimate, &motion, tilt, input.dt_s);
                self.run_attitude_loop(&target, input)
            }
            Setpoint::AttitudeThrust { target, descent_rate_m_s: descent_m_s } => {
                self.landing.descent_rate_m_s = descent_m_s;
                self.run_attitude_loop(&target, input)
            }
            Setpoint::Rates { rates_rad_s, thrust_n, descent_rate_m_s: descent_m_s } => {
                self.landing.descent_rate_m_s = descent_m_s;
                self.run_rate_loop(rates_rad_s, thrust_n, input)
            }
            Setpoint::RatesAndClimb { rates_rad_s, motion, descent_rate_m_s: descent_m_s } => {
                self.landing.descent_rate_m_s = descent_m_s;
                let level = self.velocity_loop.fly_level(gains, mass_kg, input.estimate, &motion, (0.0, 0.0), input.dt_s);
                self.run_rate_loop(rates_rad_s, level.thrust_n, input)
            }
        }
    }

    fn run_attitude_loop(&mut self, target: &AttitudeThrustSetpoint, input: &ControlInput) -> Actuators {
        let thrust_n = self.ramp_thrust(target.thrust_n, input.now);
        self.attitude_target = target.attitude;
        self.attitude_error_cosine = thrust_direction_cosine(input.estimate.attitude, target.attitude);
        let torque_n_m = self.attitude_loop.torque(
            &self.gains,
            input.estimate,
            target.attitude,
            input.yaw_rate_rad_s,
            self.allocation,
            input.dt_s,
        );
        self.mix(&TorqueThrustSetpoint { torque_n_m, thrust_n }, input)
    }

    fn run_rate_loop(&mut self, rates_rad_s: Vec3<Frd>, thrust_n: f64, input: &ControlInput) -> Actuators {
        let thrust_n = self.ramp_thrust(thrust_n, input.now);
        self.attitude_target = input.estimate.attitude;
        self.attitude_error_cosine = 1.0;
        let rates = limit_rates(&self.gains, rates_rad_s);
        let torque_n_m = self.attitude_loop.rate_torque(&self.gains, input.estimate, rates, self.allocation, input.dt_s);
        self.mix(&TorqueThrustSetpoint { torque_n_m, thrust_n }, input)
    }

    /// Ramps the thrust up at takeoff and down after touchdown.
    fn ramp_thrust(&mut self, thrust_n: f64, now: SimTime) -> f64 {
        let spool = self.landing.spool_up_fraction(now);
        let thrust_n = thrust_n.min(self.gains.thrust_max_n * spool) * self.landing.thrust_fraction();
        self.thrust = thrust_n / self.gains.thrust_max_n;
        thrust_n
    }

    fn mix(&mut self, demand: &TorqueThrustSetpoint, input: &ControlInput) -> Actuators {
        let (actuators, allocation) = self.mixer.mix(demand, battery_voltage_fraction(input), input.dt_s);
        self.allocation = allocation;
        actuators
    }
}

/// Battery voltage as a fraction of the full-charge voltage.
fn battery_voltage_fraction(input: &ControlInput) -> f64 {
    match input.battery {
        Some(b) if input.airframe.models_voltage_sag => {
            (b.voltage_v / input.airframe.full_battery_v).clamp(MIN_VOLTAGE_FRACTION, 1.0)
        }
        _ => 1.0,
    }
}

/// Cosine of the angle between the thrust directions of two attitudes.
fn thrust_direction_cosine(a: Rotation<Frd, Ned>, b: Rotation<Frd, Ned>) -> f64 {
    let z = Vec3::<Frd>::new(0.0, 0.0, 1.0);
    (a * z).dot(b * z)
}
