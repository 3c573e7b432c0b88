//! The 20 by 20 error covariance, propagated through the few non-zero blocks of the transition matrix instead of full
//! matrix products.
//!
//! Errors are true minus estimated, in this order: position, velocity, attitude (a rotation vector in NED, applied after the
//! estimated attitude), gyroscope bias, accelerometer bias (both in body axes), offset of the GNSS height, barometer offset,
//! magnetometer bias (body axes).

use nalgebra::{Matrix3, Vector3};

/// Number of error states.
pub const STATE_COUNT: usize = 20;
/// Index of the position error.
pub const P: usize = 0;
/// Index of the velocity error.
pub const V: usize = 3;
/// Index of the attitude error.
pub const THETA: usize = 6;
/// Index of the gyroscope bias error.
pub const BG: usize = 9;
/// Index of the accelerometer bias error.
pub const BA: usize = 12;
/// Index of the error of the GNSS height offset.
pub const GNSS_HEIGHT: usize = 15;
/// Index of the barometer offset error.
pub const BARO: usize = 16;
/// Index of the magnetometer bias error; constant over a session.
pub const MAG: usize = 17;

/// Spectral densities of the process noise, in SI units per second.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct ProcessNoise {
    /// Accelerometer, (m/s²)²/Hz.
    pub accel: f64,
    /// Gyroscope, (rad/s)²/Hz.
    pub gyro: f64,
    /// Accelerometer bias walk, (m/s²)²/s.
    pub accel_walk: f64,
    /// Gyroscope bias walk, (rad/s)²/s.
    pub gyro_walk: f64,
    /// Variance of the GNSS height offset, m².
    pub gnss_height: f64,
    /// Time constant of the GNSS height offset, s.
    pub gnss_height_time_s: f64,
    /// Barometer walk, m²/s.
    pub baro_walk: f64,
}

/// Correction for each error state.
pub type StateCorrection = [f64; STATE_COUNT];

/// Row length, padded to a multiple of four so that loops over a row have no remainder. The padding stays zero.
const ROW_LENGTH: usize = STATE_COUNT.next_multiple_of(4);

/// Symmetric covariance matrix.
#[derive(Debug, Clone, PartialEq)]
pub struct Covariance {
    m: [[f64; ROW_LENGTH]; STATE_COUNT],
}

impl Covariance {
    /// Creates a diagonal covariance from variances.
    #[must_use]
    pub fn diagonal(variances: &[f64; STATE_COUNT]) -> Self {
        let mut m = [[0.0; ROW_LENGTH]; STATE_COUNT];
        for (i, v) in variances.iter().enumerate() {
            m[i][i] = *v;
        }
        Self { m }
    }

    /// Variance of one error state.
    #[must_use]
    pub fn variance(&self, i: usize) -> f64 {
        self.m[i][i]
    }

    /// Returns one element.
    #[must_use]
    pub fn at(&self, i: usize, j: usize) -> f64 {
        self.m[i][j]
    }

    /// Sets an element and its mirror.
    pub fn set(&mut self, i: usize, j: usize, value: f64) {
        self.m[i][j] = value;
        self.m[j][i] = value;
    }

    /// Resets `count` error states starting at `first` to one variance, uncorrelated with all other states.
    pub fn reset(&mut self, first: usize, count: usize, variance: f64) {
        for i in first..first + count {
            for j in 0..STATE_COUNT {
                self.set(i, j, 0.0);
            }
        }
        for i in first..first + count {
            self.m[i][i] = variance;
        }
    }

    /// Propagates the covariance by `dt_s`. `delta_velocity_m_s` is the velocity change from specific force in this step (NED),
    /// `attitude` the rotation matrix from body to NED, `shock_variance` the additional velocity variance for shocks, (m/s)².
    pub fn propagate(
        &mut self,
        attitude: &Matrix3<f64>,
        delta_velocity_m_s: &Vector3<f64>,
        dt_s: f64,
        noise: &ProcessNoise,
        shock_variance: f64,
    ) {
        let g = delta_velocity_m_s;
        // d(velocity)/d(attitude): rotation vector x velocity change.
        let a = [[0.0, g.z, -g.y], [-g.z, 0.0, g.x], [g.y, -g.x, 0.0]];
        let r = attitude * -dt_s;
        let b = [[r.m11, r.m12, r.m13], [r.m21, r.m22, r.m23], [r.m31, r.m32, r.m33]];
        self.rows(&a, &b, dt_s);
        self.columns(&a, &b, dt_s);
        let keep = 1.0 - dt_s / noise.gnss_height_time_s;
        self.scale(GNSS_HEIGHT, keep);
        for i in 0..3 {
            self.m[V + i][V + i] += noise.accel * dt_s + shock_variance;
            self.m[THETA + i][THETA + i] += noise.gyro * dt_s;
            self.m[BG + i][BG + i] += noise.gyro_walk * dt_s;
            self.m[BA + i][BA + i] += noise.accel_walk * dt_s;
        }
        self.m[GNSS_HEIGHT][GNSS_HEIGHT] += noise.gnss_height * (1.0 - keep * keep);
        self.m[BARO][BARO] += noise.baro_walk * dt_s;
        self.mirror();
    }

    /// Multiplies F by the matrix in place. Each row is written before its inputs change.
    fn rows(&mut self, a: &[[f64; 3]; 3], b: &[[f64; 3]; 3], dt_s: f64) {
        for i in 0..3 {
            let v = self.m[V + i];
            for (p, v) in self.m[P + i].iter_mut().zip(v) {
                *p += dt_s * v;
            }
        }
        for (i, (a, b)) in a.iter().zip(b).enumerate() {
            let mut row = self.m[V + i];
            for (j, (a, b)) in a.iter().zip(b).enumerate() {
                let (theta, bias) = (&self.m[THETA + j], &self.m[BA + j]);
                for ((v, t), c) in row.iter_mut().zip(theta).zip(bias) {
                    *v += a * t + b * c;
                }
            }
            self.m[V + i] = row;
        }
        for (i, b) in b.iter().enumerate() {
            let mut row = self.m[THETA + i];
            for (j, factor) in b.iter().enumerate() {
                for (t, c) in row.iter_mut().zip(&self.m[BG + j]) {
                    *t += factor * c;
                }
            }
            self.m[THETA + i] = row;
        }
    }

    /// Multiplies the matrix by F transposed in place. F has off-diagonal elements only in its first rows; the rows
    /// below them are mirrored afterward.
    fn columns(&mut self, a: &[[f64; 3]; 3], b: &[[f64; 3]; 3], dt_s: f64) {
        for row in &mut self.m[..BG] {
            for i in 0..3 {
                row[P + i] += dt_s * row[V + i];
            }
            for (i, (a, b)) in a.iter().zip(b).enumerate() {
                let theta = a[0] * row[THETA] + a[1] * row[THETA + 1] + a[2] * row[THETA + 2];
                let bias = b[0] * row[BA] + b[1] * row[BA + 1] + b[2] * row[BA + 2];
                row[V + i] += theta + bias;
            }
            for (i, b) in b.iter().enumerate() {
                row[THETA + i] += b[0] * row[BG] + b[1] * row[BG + 1] + b[2] * row[BG + 2];
            }
        }
    }

    fn scale(&mut self, i: usize, factor: f64) {
        for value in &mut self.m[i] {
            *value *= factor;
        }
        for row in &mut self.m {
            row[i] *= factor;
        }
    }

    /// Copies one triangle to the other so that rounding cannot make them diverge.
    fn mirror(&mut self) {
        for i in 1..STATE_COUNT {
            for j in 0..i {
                self.m[i][j] = self.m[j][i];
            }
        }
    }

    /// Returns true if a scalar measurement passes the gate; arguments as in [`Self::fuse`].
    #[must_use]
    pub fn accepts(&self, slopes: &[(usize, f64)], innovation: f64, variance: f64, gate: f64) -> bool {
        let product = |(i, a): &(usize, f64)| slopes.iter().map(|(j, b)| a * b * self.m[*i][*j]).sum::<f64>();
        let expected = variance + slopes.iter().map(product).sum::<f64>();
        expected > 0.0 && innovation.is_finite() && innovation * innovation <= gate * gate * expected
    }

    /// Fuses one scalar measurement. `slopes` lists the non-zero partial derivatives with respect to the errors, and
    /// `innovation` is measured minus expected. Returns `None`, without changing the covariance, if the innovation
    /// exceeds `gate` standard deviations.
    pub fn fuse(&mut self, slopes: &[(usize, f64)], innovation: f64, variance: f64, gate: f64) -> Option<StateCorrection> {
        let mut ph = [0.0; ROW_LENGTH];
        for (index, slope) in slopes {
            for (sum, value) in ph.iter_mut().zip(&self.m[*index]) {
                *sum += slope * value;
            }
        }
        let expected: f64 = variance + slopes.iter().map(|(index, slope)| slope * ph[*index]).sum::<f64>();
        if !(expected > 0.0 && innovation.is_finite() && innovation * innovation <= gate * gate * expected) {
            return None;
        }
        let inverse = 1.0 / expected;
        for i in 0..STATE_COUNT {
            let gain = ph[i] * inverse;
            for (value, other) in self.m[i].iter_mut().zip(&ph) {
                *value -= gain * other;
            }
        }
        let step = innovation * inverse;
        Some(std::array::from_fn(|i| ph[i] * step))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use nalgebra::SMatrix;

    type SquareMatrix = SMatrix<f64, STATE_COUNT, STATE_COUNT>;
    /// Rounding error of sums of terms of order one, dimensionless.
    const ROUNDING_TOLERANCE: f64 = 1e-12;

    fn full(c: &Covariance) -> SquareMatrix {
        SquareMatrix::from_fn(|i, j| c.m[i][j])
    }

    fn sample_covariance() -> Covariance {
        let root = SquareMatrix::from_fn(|i, j| ((i * 7 + j * 13) % 11) as f64 / 11.0 - 0.4);
        let m = root * root.transpose();
        let mut c = Covariance::diagonal(&[0.0; STATE_COUNT]);
        for i in 0..STATE_COUNT {
            for j in 0..STATE_COUNT {
                c.m[i][j] = m[(i.min(j), i.max(j))];
            }
        }
        c
    }

    #[test]
    fn exact_sparse_propagation_matches_full_product() {
        let noise = ProcessNoise {
            accel: 0.1,
            gyro: 0.2,
            accel_walk: 0.3,
            gyro_walk: 0.4,
            gnss_height: 0.5,
            gnss_height_time_s: 50.0,
            baro_walk: 0.8,
        };
        let dt = 0.01;
        let r = *nalgebra::Rotation3::from_euler_angles(0.3, -0.2, 1.1).matrix();
        let g = Vector3::new(0.02, -0.05, -0.1);
        let mut f = SquareMatrix::identity();
        let cross = Matrix3::new(0.0, g.z, -g.y, -g.z, 0.0, g.x, g.y, -g.x, 0.0);
        for i in 0..3 {
            f[(P + i, V + i)] = dt;
            for j in 0..3 {
                f[(V + i, THETA + j)] = cross[(i, j)];
                f[(V + i, BA + j)] = -dt * r[(i, j)];
                f[(THETA + i, BG + j)] = -dt * r[(i, j)];
            }
        }
        f[(GNSS_HEIGHT, GNSS_HEIGHT)] = 1.0 - dt / 50.0;
        let mut c = sample_covariance();
        let mut expected = f * full(&c) * f.transpose();
        let keep: f64 = 1.0 - dt / 50.0;
        for i in 0..3 {
            expected[(V + i, V + i)] += 0.1 * dt + 0.001;
            expected[(THETA + i, THETA + i)] += 0.2 * dt;
            expected[(BG + i, BG + i)] += 0.4 * dt;
            expected[(BA + i, BA + i)] += 0.3 * dt;
        }
        expected[(GNSS_HEIGHT, GNSS_HEIGHT)] += 0.5 * (1.0 - keep * keep);
        expected[(BARO, BARO)] += 0.8 * dt;
        c.propagate(&r, &g, dt, &noise, 0.001);
        assert!((full(&c) - expected).abs().max() < ROUNDING_TOLERANCE);
    }

    #[test]
    fn exact_scalar_fusion_matches_textbook_update() {
        let mut c = sample_covariance();
        let before = full(&c);
        let mut h = SMatrix::<f64, 1, STATE_COUNT>::zeros();
        h[(0, P)] = 1.0;
        h[(0, GNSS_HEIGHT)] = 0.5;
        let s = (h * before * h.transpose())[(0, 0)] + 0.2;
        let k = before * h.transpose() / s;
        let dx = c.fuse(&[(P, 1.0), (GNSS_HEIGHT, 0.5)], 0.3, 0.2, 5.0).unwrap_or([0.0; STATE_COUNT]);
        assert!((full(&c) - (SquareMatrix::identity() - k * h) * before).abs().max() < ROUNDING_TOLERANCE);
        assert!((0..STATE_COUNT).all(|i| (dx[i] - k[(i, 0)] * 0.3).abs() < ROUNDING_TOLERANCE));
    }

    #[test]
    fn exact_outlier_leaves_covariance_unchanged() {
        let mut c = sample_covariance();
        let before = c.clone();
        assert!(c.fuse(&[(P, 1.0)], 1e6, 0.2, 5.0).is_none());
        assert_eq!(c, before);
    }
}
