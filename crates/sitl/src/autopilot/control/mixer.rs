//! Control allocation: converts torque and thrust to motor commands, based on the rotor geometry. On saturation, it
//! reduces yaw first, then collective thrust, then roll and pitch proportionally.

use crate::physics::{Actuators, MAX_ROTORS};
use nalgebra::{Matrix4, Vector4};
use spandrel_model::frames::{Frd, Vec3};
use spandrel_model::math::GRAVITY_M_S2;
use spandrel_model::vehicle::Vehicle;

/// Demand from the attitude loops.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct TorqueThrustSetpoint {
    /// Torque about the body axes, N m.
    pub torque_n_m: Vec3<Frd>,
    /// Collective thrust, N.
    pub thrust_n: f64,
}

/// Allocated fractions of the demand.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct AllocationStatus {
    /// Allocated fraction of the roll and pitch torque, 0 to 1.
    pub tilt: f64,
    /// Allocated fraction of the yaw torque, 0 to 1.
    pub yaw: f64,
}

impl AllocationStatus {
    /// The entire demand was allocated.
    pub const FULLY_ALLOCATED: Self = Self { tilt: 1.0, yaw: 1.0 };
}

/// Rotor geometry and motor model. The estimated rotor speeds and the filtered yaw torque are its only state.
#[derive(Debug, Clone, PartialEq)]
pub struct Mixer {
    count: usize,
    /// Thrust of each rotor per unit of roll torque, pitch torque, yaw torque and collective thrust.
    columns: [[f64; 4]; MAX_ROTORS],
    thrust_coefficient: f64,
    idle_rad_s: f64,
    max_rad_s: f64,
    time_constant_s: f64,
    lead: f64,
    /// Rotor inertia divided by the slope of its drag torque at hover, s.
    spin_time_s: f64,
    speeds: [f64; MAX_ROTORS],
    yaw_torque_n_m: f64,
}

impl Mixer {
    /// Creates a mixer for an aircraft. `lead` compensates for motor lag.
    #[must_use]
    pub fn new(vehicle: &Vehicle, lead: f64) -> Self {
        let count = vehicle.rotors.len().min(MAX_ROTORS);
        let r = &vehicle.rotor;
        let reach = r.torque_coefficient_n_m_s2 / r.thrust_coefficient_n_s2;
        let effect: Vec<Vector4<f64>> = vehicle
            .rotors
            .iter()
            .take(count)
            .map(|rotor| Vector4::new(-rotor.position_m.right(), rotor.position_m.forward(), rotor.spin * reach, 1.0))
            .collect();
        let gram = effect.iter().fold(Matrix4::zeros(), |sum, e| sum + e * e.transpose());
        // Without an inverse (collinear rotors or identical spin directions), only collective thrust can be controlled.
        let inverse =
            gram.try_inverse().unwrap_or_else(|| Matrix4::from_diagonal(&Vector4::new(0.0, 0.0, 0.0, 1.0 / count as f64)));
        let each_n = vehicle.mass_kg * GRAVITY_M_S2 / count as f64;
        let hover = (each_n / r.thrust_coefficient_n_s2).sqrt();
        let mut columns = [[0.0; 4]; MAX_ROTORS];
        for (column, e) in columns.iter_mut().zip(&effect) {
            let c = inverse * e;
            *column = [c.x, c.y, c.z, c.w];
        }
        Self {
            count,
            columns,
            thrust_coefficient: r.thrust_coefficient_n_s2,
            idle_rad_s: r.idle_speed_rad_s,
            max_rad_s: r.max_speed_rad_s,
            time_constant_s: r.time_constant_s,
            lead,
            spin_time_s: r.inertia_kg_m2 / (2.0 * r.torque_coefficient_n_m_s2 * hover).max(1e-9),
            speeds: [0.0; MAX_ROTORS],
            yaw_torque_n_m: 0.0,
        }
    }

    /// Computes motor commands for a demand. `voltage_fraction` is battery voltage divided by full voltage; motors turn
    /// more slowly at lower voltage.
    pub fn mix(&mut self, demand: &TorqueThrustSetpoint, voltage_fraction: f64, dt_s: f64) -> (Actuators, AllocationStatus) {
        let top = (self.max_rad_s * voltage_fraction).max(self.idle_rad_s + 1.0);
        let low = self.thrust_coefficient * self.idle_rad_s * self.idle_rad_s;
        let high = self.thrust_coefficient * top * top;
        let demand = TorqueThrustSetpoint { torque_n_m: self.compensate_rotor_spin(demand.torque_n_m, dt_s), ..*demand };
        let (thrusts, allocated) = self.allocate(&demand, low, high);
        let mut out = Actuators { armed: true, ..Actuators::default() };
        for (i, thrust) in thrusts.iter().enumerate().take(self.count) {
            let wanted = (thrust / self.thrust_coefficient).max(0.0).sqrt();
            let compensated = self.speeds[i] + self.lead * (wanted - self.speeds[i]);
            out.motors[i] = ((compensated - self.idle_rad_s) / (top - self.idle_rad_s)).clamp(0.0, 1.0);
            let driven = self.idle_rad_s + out.motors[i] * (top - self.idle_rad_s);
            // Implicit step of the first-order lag: stable for any ratio of step to lag.
            self.speeds[i] += (driven - self.speeds[i]) * dt_s / (dt_s + self.time_constant_s);
        }
        (out, allocated)
    }

    /// Compensates for rotor inertia. An accelerating rotor applies torque immediately through its inertia and
    /// permanently through its drag. Filtering the yaw torque with a lag makes the total torque follow the demand.
    fn compensate_rotor_spin(&mut self, torque: Vec3<Frd>, dt_s: f64) -> Vec3<Frd> {
        self.yaw_torque_n_m += (torque.down() - self.yaw_torque_n_m) * dt_s / (dt_s + self.spin_time_s);
        Vec3::new(torque.forward(), torque.right(), self.yaw_torque_n_m)
    }

    /// Sets all motors to idle.
    pub fn idle(&mut self, dt_s: f64) -> Actuators {
        for speed in &mut self.speeds {
            *speed += (self.idle_rad_s - *speed) * dt_s / (dt_s + self.time_constant_s);
        }
        Actuators { motors: [0.0; MAX_ROTORS], armed: true }
    }

    /// Stops all motors.
    pub fn stop(&mut self) -> Actuators {
        self.speeds = [0.0; MAX_ROTORS];
        self.yaw_torque_n_m = 0.0;
        Actuators::default()
    }

    fn allocate(&self, demand: &TorqueThrustSetpoint, low: f64, high: f64) -> ([f64; MAX_ROTORS], AllocationStatus) {
        let t = demand.torque_n_m;
        let mut tilt = [0.0; MAX_ROTORS];
        let mut yaw = [0.0; MAX_ROTORS];
        let (mut lowest, mut highest): (f64, f64) = (0.0, 0.0);
        for i in 0..self.count {
            let c = &self.columns[i];
            tilt[i] = c[0] * t.forward() + c[1] * t.right();
            yaw[i] = c[2] * t.down();
            lowest = lowest.min(tilt[i]);
            highest = highest.max(tilt[i]);
        }
        let tilt_share = ((high - low) / (highest - lowest).max(1e-9)).min(1.0);
        // Adjusts the collective thrust to leave headroom for roll and pitch. The shift is the same for all rotors that
        // have an equal share of the collective thrust.
        let each = self.columns[0][3].max(1e-6);
        let room = (low - lowest * tilt_share, high - highest * tilt_share);
        let common = (demand.thrust_n * each).max(room.0).min(room.1) / each;
        let mut out = [0.0; MAX_ROTORS];
        let mut yaw_share: f64 = 1.0;
        for i in 0..self.count {
            out[i] = common * self.columns[i][3] + tilt[i] * tilt_share;
            let room = if yaw[i] > 0.0 { high - out[i] } else { out[i] - low };
            yaw_share = yaw_share.min((room / yaw[i].abs().max(1e-9)).max(0.0));
        }
        for i in 0..self.count {
            out[i] = (out[i] + yaw[i] * yaw_share).clamp(low, high);
        }
        (out, AllocationStatus { tilt: tilt_share, yaw: yaw_share })
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::autopilot::testing::vehicle_with;
    use crate::sensors::tests::error_free_sensors;

    /// Rounding error of about a dozen products, N and N m.
    const ROUNDING_TOLERANCE: f64 = 1e-10;

    fn wrench(vehicle: &Vehicle, thrusts: &[f64; MAX_ROTORS]) -> [f64; 4] {
        let reach = vehicle.rotor.torque_coefficient_n_m_s2 / vehicle.rotor.thrust_coefficient_n_s2;
        vehicle.rotors.iter().zip(thrusts).fold([0.0; 4], |s, (r, t)| {
            [s[0] - r.position_m.right() * t, s[1] + r.position_m.forward() * t, s[2] + r.spin * reach * t, s[3] + t]
        })
    }

    fn limits(v: &Vehicle) -> (f64, f64) {
        let k = v.rotor.thrust_coefficient_n_s2;
        (k * v.rotor.idle_speed_rad_s * v.rotor.idle_speed_rad_s, k * v.rotor.max_speed_rad_s * v.rotor.max_speed_rad_s)
    }

    #[test]
    fn exact_moderate_demand_is_fully_allocated() {
        let v = vehicle_with(error_free_sensors());
        let (low, high) = limits(&v);
        let demand = TorqueThrustSetpoint { torque_n_m: Vec3::new(0.1, -0.2, 0.03), thrust_n: 13.0 };
        let (thrusts, given) = Mixer::new(&v, 2.0).allocate(&demand, low, high);
        let got = wrench(&v, &thrusts);
        for (got, wanted) in got.iter().zip([0.1, -0.2, 0.03, 13.0]) {
            assert!((got - wanted).abs() < ROUNDING_TOLERANCE, "{got} {wanted}");
        }
        assert_eq!(given, AllocationStatus { tilt: 1.0, yaw: 1.0 });
    }

    #[test]
    fn prop_yaw_is_reduced_before_roll_and_pitch() {
        let v = vehicle_with(error_free_sensors());
        let (low, high) = limits(&v);
        let demand = TorqueThrustSetpoint { torque_n_m: Vec3::new(1.0, 0.0, 2.0), thrust_n: 20.0 };
        let (thrusts, given) = Mixer::new(&v, 2.0).allocate(&demand, low, high);
        let got = wrench(&v, &thrusts);
        assert!((got[0] - 1.0).abs() < ROUNDING_TOLERANCE && got[1].abs() < ROUNDING_TOLERANCE, "{got:?}");
        assert!(given.yaw < 1.0 && got[2] > 0.0 && got[2] < 2.0, "{got:?}");
        assert!(thrusts.iter().take(4).all(|t| *t >= low - ROUNDING_TOLERANCE && *t <= high + ROUNDING_TOLERANCE));
    }

    #[test]
    fn prop_full_thrust_keeps_roll_authority() {
        let v = vehicle_with(error_free_sensors());
        let (low, high) = limits(&v);
        let demand = TorqueThrustSetpoint { torque_n_m: Vec3::new(0.5, 0.5, 0.0), thrust_n: 1e3 };
        let (thrusts, _) = Mixer::new(&v, 2.0).allocate(&demand, low, high);
        let got = wrench(&v, &thrusts);
        assert!((got[0] - 0.5).abs() < ROUNDING_TOLERANCE && (got[1] - 0.5).abs() < ROUNDING_TOLERANCE, "{got:?}");
    }
}
