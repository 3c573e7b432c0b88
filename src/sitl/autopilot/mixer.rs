//! From collective thrust and torque to motor commands. Where the rotors cannot give all of it, yaw goes first, then thrust gives
//! way so that roll and pitch stay.

use crate::sitl::physics::{Actuators, MAX_ROTORS};
use crate::vehicle::Vehicle;
use nalgebra::{DMatrix, Matrix4};

/// Share of a rotor's top thrust below which it is not driven in flight.
const LEAST_SHARE: f64 = 0.02;

/// Geometry of the rotors, solved once.
#[derive(Debug, Clone, PartialEq)]
pub struct Mixer {
    /// Thrust per rotor for unit collective, roll, pitch, yaw.
    columns: [[f64; MAX_ROTORS]; 4],
    count: usize,
    thrust_coefficient: f64,
    idle_rad_s: f64,
    max_rad_s: f64,
    top_n: f64,
}

impl Mixer {
    /// From the rotor geometry: the least-squares inverse of what thrusts do to the body.
    #[must_use]
    pub fn new(vehicle: &Vehicle) -> Self {
        let n = vehicle.rotors.len();
        let per_thrust = vehicle.rotor.torque_coefficient_n_m_s2 / vehicle.rotor.thrust_coefficient_n_s2;
        let mut b = DMatrix::zeros(4, n);
        for (k, rotor) in vehicle.rotors.iter().enumerate() {
            b[(0, k)] = 1.0;
            b[(1, k)] = -rotor.position_m.right();
            b[(2, k)] = rotor.position_m.forward();
            b[(3, k)] = rotor.spin * per_thrust;
        }
        let square: Matrix4<f64> = (&b * b.transpose()).fixed_view::<4, 4>(0, 0).into_owned();
        let inverse = square.try_inverse().unwrap_or_else(Matrix4::zeros);
        let spread = b.transpose() * inverse;
        let mut columns = [[0.0; MAX_ROTORS]; 4];
        for (axis, column) in columns.iter_mut().enumerate() {
            for (k, value) in column.iter_mut().enumerate().take(n) {
                *value = spread[(k, axis)];
            }
        }
        let r = &vehicle.rotor;
        Self {
            columns,
            count: n,
            thrust_coefficient: r.thrust_coefficient_n_s2,
            idle_rad_s: r.idle_speed_rad_s,
            max_rad_s: r.max_speed_rad_s,
            top_n: r.thrust_coefficient_n_s2 * r.max_speed_rad_s * r.max_speed_rad_s,
        }
    }

    /// Most collective thrust, N.
    #[must_use]
    pub fn top_n(&self) -> f64 {
        self.top_n * self.count as f64
    }

    /// Motor commands for a thrust (N) and torques about forward, right, down (N m).
    #[must_use]
    pub fn mix(&self, thrust_n: f64, torque_n_m: [f64; 3]) -> Actuators {
        let n = self.count;
        let mut tilt = [0.0; MAX_ROTORS];
        let mut yaw = [0.0; MAX_ROTORS];
        for k in 0..n {
            tilt[k] = self.columns[1][k] * torque_n_m[0] + self.columns[2][k] * torque_n_m[1];
            yaw[k] = self.columns[3][k] * torque_n_m[2];
        }
        let low = LEAST_SHARE * self.top_n;
        let room = self.top_n - low;
        let (tilt_low, tilt_high) = extremes(&tilt[..n]);
        let shrink = (room / (tilt_high - tilt_low).max(1e-12)).min(1.0);
        tilt.iter_mut().for_each(|t| *t *= shrink);
        // The collective moves so far that roll and pitch fit between the rotors' limits.
        let base = (thrust_n / n as f64).clamp(low - tilt_low * shrink, self.top_n - tilt_high * shrink);
        let mut share: f64 = 1.0;
        for k in 0..n {
            let at = base + tilt[k];
            let space = if yaw[k] > 0.0 { self.top_n - at } else { at - low };
            share = share.min(space.max(0.0) / yaw[k].abs().max(1e-12));
        }
        let mut out = Actuators { armed: true, ..Actuators::default() };
        for k in 0..n {
            let force = (base + tilt[k] + share * yaw[k]).max(0.0);
            let speed = (force / self.thrust_coefficient).sqrt();
            out.motors[k] = ((speed - self.idle_rad_s) / (self.max_rad_s - self.idle_rad_s)).clamp(0.0, 1.0);
        }
        out
    }
}

fn extremes(values: &[f64]) -> (f64, f64) {
    values.iter().fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), v| (low.min(*v), high.max(*v)))
}
