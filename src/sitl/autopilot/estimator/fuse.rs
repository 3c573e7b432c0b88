//! Fusing one measurement after the other, each as a scalar; outliers are refused, but not for ever.

use super::Estimator;
use super::covariance::{BA, BARO, BG, Correction, DRIFT, FLOW, MAG, P, THETA, V};
use crate::base::frames::{Frd, Ned, Vec3};
use crate::base::math;
use crate::base::time::SimTime;
use crate::sitl::sensors::{FlowReading, GnssReading};

/// Measurements further off than this are refused, standard deviations.
const GATE: f64 = 5.0;
/// What the receiver claims beyond its open-sky error is mostly multipath, which lasts for seconds: its variance counts this many
/// times (about twice its time constant times the fix rate, halved because part of it is white).
const LASTING: f64 = 40.0;
/// Refused for this long, a source is believed again, s.
const REFUSED_S: f64 = 3.0;

impl Estimator {
    pub(super) fn fuse_gnss(&mut self, fix: &GnssReading, now: SimTime) {
        let n = self.noise;
        if !self.located {
            self.located = true;
            self.position_m = Vec3::new(fix.position_m.north(), fix.position_m.east(), self.position_m.down());
            self.covariance.reset(P, 2, 1e6);
        }
        let white = |claimed: f64, drift: f64, least: f64| {
            let excess = claimed * claimed - drift * drift - least * least;
            least * least + LASTING * excess.max(0.0)
        };
        let rh = white(fix.eph_m, n.gnss_drift_m[0], n.gnss_white_m[0]);
        let rv = white(fix.epv_m, n.gnss_drift_m[1], n.gnss_white_m[1]);
        let mut taken = true;
        for i in 0..3 {
            let expected = self.position_m.array()[i] + self.drift_m.array()[i];
            let variance = if i < 2 { rh } else { rv };
            let fused = self.fuse(&[(P + i, 1.0), (DRIFT + i, 1.0)], fix.position_m.array()[i] - expected, variance);
            taken &= fused || i == 2;
        }
        self.keep_position(taken, fix, now);
        let stretch = (rh.sqrt() / n.gnss_white_m[0].max(1e-6)).max(1.0);
        let variance = (n.gnss_velocity_m_s * stretch) * (n.gnss_velocity_m_s * stretch);
        let mut taken = true;
        for i in 0..3 {
            let innovation = fix.velocity_m_s.array()[i] - self.velocity_m_s.array()[i];
            taken &= self.fuse(&[(V + i, 1.0)], innovation, variance);
        }
        if taken {
            self.trust.velocity = now;
        } else if (now - self.trust.velocity).s() > REFUSED_S {
            self.velocity_m_s = fix.velocity_m_s;
            self.covariance.reset(V, 3, 4.0 * variance);
            self.trust.velocity = now;
        }
    }

    fn keep_position(&mut self, taken: bool, fix: &GnssReading, now: SimTime) {
        if taken {
            self.trust.position = now;
        } else if (now - self.trust.position).s() > REFUSED_S {
            self.position_m = Vec3::new(fix.position_m.north(), fix.position_m.east(), self.position_m.down());
            self.covariance.reset(P, 2, fix.eph_m * fix.eph_m);
            self.trust.position = now;
        }
    }

    pub(super) fn fuse_baro(&mut self, up_m: f64, now: SimTime) {
        let innovation = -up_m - (self.position_m.down() - self.baro_offset_m);
        let variance = self.noise.baro_m * self.noise.baro_m;
        if self.fuse(&[(P + 2, 1.0), (BARO, -1.0)], innovation, variance) {
            self.trust.height = now;
        } else if (now - self.trust.height).s() > REFUSED_S {
            self.position_m += Vec3::new(0.0, 0.0, innovation);
            self.covariance.reset(P + 2, 1, 1.0);
            self.trust.height = now;
        }
    }

    /// Only the component that turns with the heading is used, so that a bent field never tilts the horizon.
    pub(super) fn fuse_mag(&mut self, gauss: Vec3<Frd>, share: f64, now: SimTime) {
        let field = self.field_gauss;
        let across = Vec3::<Ned>::new(-field.east(), field.north(), 0.0).unit();
        let gauss = gauss - self.mag_bias;
        let innovation = (self.attitude * gauss - field).dot(across);
        let lever = across.cross(field);
        let bias = self.attitude.inverse() * across;
        let slopes = [
            (THETA, lever.north()),
            (THETA + 1, lever.east()),
            (THETA + 2, lever.down()),
            (MAG, bias.forward()),
            (MAG + 1, bias.right()),
            (MAG + 2, bias.down()),
        ];
        let variance = self.noise.mag_gauss * self.noise.mag_gauss * share;
        if self.fuse(&slopes, innovation, variance) {
            self.trust.heading = now;
        } else if (now - self.trust.heading).s() > REFUSED_S {
            let measured = self.attitude * gauss;
            let error = math::atan2(field.east(), field.north()) - math::atan2(measured.east(), measured.north());
            self.turn(Vec3::new(0.0, 0.0, math::wrap_pi(error)));
            self.covariance.reset(THETA + 2, 1, 0.1);
            self.trust.heading = now;
        }
    }

    pub(super) fn fuse_flow(&mut self, reading: &FlowReading, now: SimTime) {
        let nose = self.attitude * Vec3::<Frd>::new(1.0, 0.0, 0.0);
        let level = nose.horizontal_norm().max(1e-6);
        let (c, s) = (nose.north() / level, nose.east() / level);
        let v = self.velocity_m_s;
        let (forward, right) = (c * v.north() + s * v.east(), c * v.east() - s * v.north());
        let k = self.flow_scale;
        // A nose that is up or down turns its heading with the tilt error too.
        let steep = -nose.down() / level;
        let turns = |share: f64| [(THETA, share * steep * c), (THETA + 1, share * steep * s), (THETA + 2, share)];
        let variance = self.noise.flow_m_s * self.noise.flow_m_s / reading.quality.clamp(0.1, 1.0);
        let [n, e, d] = turns(k * right);
        let slopes = [(V, k * c), (V + 1, k * s), n, e, d, (FLOW, forward)];
        let a = self.fuse(&slopes, reading.forward_m_s - k * forward, variance);
        let [n, e, d] = turns(-k * forward);
        let slopes = [(V, -k * s), (V + 1, k * c), n, e, d, (FLOW, right)];
        let b = self.fuse(&slopes, reading.right_m_s - k * right, variance);
        if a && b {
            self.trust.velocity = now;
        } else if (now - self.trust.velocity).s() > REFUSED_S {
            let (f, r) = (reading.forward_m_s / k, reading.right_m_s / k);
            self.velocity_m_s = Vec3::new(c * f - s * r, s * f + c * r, v.down());
            self.covariance.reset(V, 2, 4.0 * variance);
            self.trust.velocity = now;
        }
    }

    fn fuse(&mut self, slopes: &[(usize, f64)], innovation: f64, variance: f64) -> bool {
        match self.covariance.fuse(slopes, innovation, variance, GATE) {
            Some(correction) => {
                self.correct(&correction);
                true
            }
            None => false,
        }
    }

    fn correct(&mut self, d: &Correction) {
        self.position_m += Vec3::new(d[P], d[P + 1], d[P + 2]);
        self.velocity_m_s += Vec3::new(d[V], d[V + 1], d[V + 2]);
        self.turn(Vec3::new(d[THETA], d[THETA + 1], d[THETA + 2]));
        self.gyro_bias += Vec3::new(d[BG], d[BG + 1], d[BG + 2]);
        self.accel_bias += Vec3::new(d[BA], d[BA + 1], d[BA + 2]);
        self.drift_m += Vec3::new(d[DRIFT], d[DRIFT + 1], d[DRIFT + 2]);
        self.baro_offset_m += d[BARO];
        self.flow_scale += d[FLOW];
        self.mag_bias += Vec3::new(d[MAG], d[MAG + 1], d[MAG + 2]);
    }

    /// Turns the believed attitude by a small rotation vector in NED.
    fn turn(&mut self, by_rad: Vec3<Ned>) {
        self.attitude = self.attitude.turned_by(self.attitude.inverse() * by_rad);
    }
}
