//! Sequential scalar fusion of measurements. Outliers are rejected. A source that keeps failing is dropped, and the filter is
//! reset to it only if no other source contradicts it.

use super::Estimator;
use super::checks::REJECTION_TIMEOUT_S;
use super::covariance::{BA, BARO, BG, GNSS_HEIGHT, MAG, P, StateCorrection, THETA, V};
use crate::sensors::{FlowReading, GnssReading};
use spandrel_model::frames::{Frd, Ned, Vec3};
use spandrel_model::math;
use spandrel_model::time::SimTime;

/// Innovation gate, standard deviations.
pub(super) const INNOVATION_GATE: f64 = 5.0;
/// Weight of the variance that the receiver states in excess of the open-sky error. The excess is mostly multipath, which lasts
/// for seconds. The weight is about twice its time constant (estimate: 8 s) times the fix rate, halved because part of the excess is
/// white noise.
const MULTIPATH_WEIGHT: f64 = 40.0;
/// Time after its last fusion for which optical flow counts as an independent velocity source, s.
const FLOW_VALIDITY_TIME_S: f64 = 1.0;
/// Time for which a fix counts as current, s (estimate: five fixes at the usual rate).
const FIX_VALIDITY_TIME_S: f64 = 1.0;
/// Offset of the GNSS height beyond which the barometer contradicts it, standard deviations.
const BARO_CONFLICT_SIGMAS: f64 = 4.0;
/// Deviation within which GNSS and filter agree on height, standard deviations.
const AGREEMENT_SIGMAS: f64 = 1.5;
/// Standard deviation of the barometer offset after a reset, m (estimate).
const RESET_BARO_OFFSET_SIGMA_M: f64 = 0.3;

/// Returns the variance that the receiver states in excess of its accuracy under an open sky, m².
fn excess_variance_m2(stated_m: f64, open_m: f64) -> f64 {
    (stated_m * stated_m - open_m * open_m).max(0.0)
}

/// Non-zero elements of the Jacobian of one measurement.
type MeasurementJacobian<'a> = &'a [(usize, f64)];

impl Estimator {
    pub(super) fn fuse_gnss(&mut self, fix: &GnssReading, now: SimTime) {
        if !self.global_position_known {
            self.global_position_known = true;
            self.position_m = Vec3::new(fix.position_m.north(), fix.position_m.east(), self.position_m.down());
            self.covariance.reset(P, 2, 1e6);
        }
        let [horizontal_m, vertical_m] = self.noise.gnss_m;
        let open_m2 = horizontal_m * horizontal_m;
        let horizontal_m2 = open_m2 + MULTIPATH_WEIGHT * excess_variance_m2(fix.eph_m, horizontal_m);
        self.fuse_fix(fix, horizontal_m2, now);
        // The slow part of the height's error is a state.
        let white_m = self.noise.gnss_height_white_m;
        self.fuse_fix_height(fix, white_m * white_m + MULTIPATH_WEIGHT * excess_variance_m2(fix.epv_m, vertical_m), now);
        let speed_m_s = self.noise.gnss_velocity_m_s;
        self.fuse_fix_velocity(fix, speed_m_s * speed_m_s * horizontal_m2 / open_m2.max(1e-12), now);
    }

    /// Offset of a fix from the filter, m.
    fn gnss_offset_m(&self, fix: &GnssReading) -> Vec3<Ned> {
        fix.position_m - self.position_m - Vec3::new(0.0, 0.0, self.gnss_height_offset_m)
    }

    fn fuse_fix(&mut self, fix: &GnssReading, variance: f64, now: SimTime) {
        let off = self.gnss_offset_m(fix).array();
        let fits = (0..2).all(|i| self.accepts(&[(P + i, 1.0)], off[i], variance));
        if self.checks.gnss.should_fuse(fits, now) {
            self.fuse(&[(P, 1.0)], off[0], variance);
            let off = self.gnss_offset_m(fix);
            self.fuse(&[(P + 1, 1.0)], off.east(), variance);
        }
        if fits {
            self.checks.gnss_offset_monitor.clear();
            return;
        }
        // If optical flow contradicts the jump, GNSS is wrong, unless the filter has lost its position. Without optical flow, the
        // filter accepts a constant offset but not noise.
        let off = self.gnss_offset_m(fix);
        let flat = Vec3::new(off.north(), off.east(), 0.0);
        let steady_s = self.checks.gnss_offset_monitor.record_offset(flat, INNOVATION_GATE * (2.0 * variance).sqrt(), now);
        let flow_is_fresh = (now - self.last_fused.flow).s() < FLOW_VALIDITY_TIME_S;
        if self.has_lost_position() || (steady_s > REJECTION_TIMEOUT_S && !flow_is_fresh) {
            self.reset_position(Vec3::new(fix.position_m.north(), fix.position_m.east(), self.position_m.down()));
            self.covariance.reset(P, 2, fix.eph_m * fix.eph_m);
            self.checks.gnss.clear();
            self.checks.gnss_offset_monitor.clear();
        }
    }

    /// Resets the position to the GNSS position.
    fn reset_position(&mut self, position_m: Vec3<Ned>) {
        self.position_reset_m = Some(self.position_reset_m.unwrap_or_default() + (position_m - self.position_m));
        self.position_m = position_m;
    }

    fn fuse_fix_height(&mut self, fix: &GnssReading, variance: f64, now: SimTime) {
        let slow = self.slow_height_error_m(fix, now);
        let slopes = [(P + 2, 1.0), (GNSS_HEIGHT, 1.0)];
        let off = self.gnss_offset_m(fix).down();
        let fits = self.accepts(&slopes, off, variance);
        if self.checks.gnss_height.should_fuse(fits, now) && !self.checks.gnss.dropped() {
            self.fuse(&slopes, off, variance);
            self.last_fused.height = now;
        }
        let apart = (fix.position_m.down() - self.position_m.down()).abs();
        if apart < AGREEMENT_SIGMAS * math::hypot(slow, variance.sqrt()) {
            self.ground.record_agreement(self.position_m.down(), fix.position_m.down());
        }
        // With another height reference, the GNSS height may have a permanent offset.
        let drifted = self.gnss_is_reference() && self.gnss_height_offset_m.abs() > BARO_CONFLICT_SIGMAS * slow;
        let contradicted = self.checks.gnss_height.dropped() || drifted;
        if contradicted && !self.checks.gnss.dropped() {
            self.resolve_height_conflict(fix, now);
        }
    }

    /// Slowly varying error of the GNSS height, m (1 sigma): its usual offset and recently reported multipath error.
    fn slow_height_error_m(&mut self, fix: &GnssReading, now: SimTime) -> f64 {
        let usual = self.noise.gnss_m[1];
        let since_s = self.latest_fix.map_or(0.0, |(_, at)| (now - at).s());
        self.latest_fix = Some((*fix, now));
        let keep = (1.0 - since_s / self.process.gnss_height_time_s).max(0.0);
        let claimed = excess_variance_m2(fix.epv_m, usual);
        self.multipath_variance_m2 = claimed.max(self.multipath_variance_m2 * keep);
        (usual * usual + self.multipath_variance_m2).sqrt()
    }

    /// Resolves a height conflict between GNSS and barometer with the range finder, or in favor of GNSS if the range finder
    /// cannot decide.
    fn resolve_height_conflict(&mut self, fix: &GnssReading, now: SimTime) {
        let alone = self.checks.baro.dropped();
        if alone && (now - self.last_fused.height).s() <= REJECTION_TIMEOUT_S {
            return;
        }
        let sides = || self.ground.agrees_with_filter(self.position_m.down(), fix.position_m.down());
        if !alone && (!self.gnss_is_reference() || sides()) {
            self.checks.gnss_height.reject();
            self.reset_gnss_height_offset();
            return;
        }
        self.checks.baro.reject();
        self.set_height(fix, now);
    }

    pub(super) fn reset_gnss_height_offset(&mut self) {
        self.gnss_height_offset_m = 0.0;
        self.covariance.reset(GNSS_HEIGHT, 1, self.process.gnss_height);
    }

    /// Resets height and climb rate to the GNSS values.
    fn set_height(&mut self, fix: &GnssReading, now: SimTime) {
        self.reset_gnss_height_offset();
        let (p, v) = (self.position_m, self.velocity_m_s);
        self.position_m = Vec3::new(p.north(), p.east(), fix.position_m.down());
        self.velocity_m_s = Vec3::new(v.north(), v.east(), fix.velocity_m_s.down());
        self.covariance.reset(P + 2, 1, fix.epv_m * fix.epv_m);
        let speed = self.noise.gnss_velocity_m_s;
        self.covariance.reset(V + 2, 1, 4.0 * speed * speed);
        self.checks.gnss_height.clear();
        self.last_fused.height = now;
    }

    fn fuse_fix_velocity(&mut self, fix: &GnssReading, variance: f64, now: SimTime) {
        if self.checks.gnss.dropped() {
            return;
        }
        let mut taken = true;
        for i in 0..3 {
            let innovation = fix.velocity_m_s.array()[i] - self.velocity_m_s.array()[i];
            taken &= self.fuse(&[(V + i, 1.0)], innovation, variance);
        }
        self.checks.gnss_velocity.should_fuse(taken, now);
        if taken {
            self.last_fused.velocity = now;
        } else if (now - self.last_fused.velocity).s() > REJECTION_TIMEOUT_S {
            self.velocity_m_s = fix.velocity_m_s;
            self.covariance.reset(V, 3, 4.0 * variance);
            self.last_fused.velocity = now;
        }
    }

    pub(super) fn fuse_baro(&mut self, up_m: f64, now: SimTime) {
        let innovation = -up_m - (self.position_m.down() - self.baro_offset_m);
        let variance = self.noise.baro_m * self.noise.baro_m;
        let slopes = [(P + 2, 1.0), (BARO, -1.0)];
        let fits = self.accepts(&slopes, innovation, variance);
        if self.checks.baro.should_fuse(fits, now) {
            self.fuse(&slopes, innovation, variance);
            self.last_fused.height = now;
            self.height_reference.record_barometer_fusion(now);
        }
        if fits {
            self.checks.baro_offset_monitor.clear();
        } else {
            self.recover_height(innovation, now);
        }
    }

    /// Recovers when no height source agrees with the filter: resets to GNSS or, failing that, continues from the
    /// current height with the barometer if its offset is constant.
    fn recover_height(&mut self, innovation_m: f64, now: SimTime) {
        let tolerance_m = INNOVATION_GATE * (2.0 * self.noise.baro_m * self.noise.baro_m).sqrt();
        let steady_s = self.checks.baro_offset_monitor.record_offset(Vec3::new(0.0, 0.0, innovation_m), tolerance_m, now);
        if (now - self.last_fused.height).s() <= REJECTION_TIMEOUT_S {
            return;
        }
        match self.latest_fix {
            Some((fix, at)) if (now - at).s() < FIX_VALIDITY_TIME_S && !self.checks.gnss.dropped() => self.set_height(&fix, now),
            _ if steady_s > REJECTION_TIMEOUT_S => {
                self.baro_offset_m -= innovation_m;
                self.covariance.reset(BARO, 1, RESET_BARO_OFFSET_SIGMA_M * RESET_BARO_OFFSET_SIGMA_M);
                self.checks.baro.clear();
                self.checks.baro_offset_monitor.clear();
                self.last_fused.height = now;
            }
            _ => {}
        }
    }

    /// Fuses only the component that depends on heading, so that a disturbed field cannot tilt the attitude estimate.
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
        let fits = self.accepts(&slopes, innovation, variance);
        if self.checks.mag.should_fuse(fits, now) {
            self.fuse(&slopes, innovation, variance);
        }
        if fits {
            self.last_fused.heading = now;
        } else if (now - self.last_fused.heading).s() > REJECTION_TIMEOUT_S
            && (self.motors_off || self.checks.gnss_velocity.dropped())
        {
            // In flight, the gyroscopes are the better heading source unless the velocities contradict the heading too.
            let measured = self.attitude * gauss;
            let error = math::atan2(field.east(), field.north()) - math::atan2(measured.east(), measured.north());
            self.turn(Vec3::new(0.0, 0.0, math::wrap_pi(error)));
            self.covariance.reset(THETA + 2, 1, 0.1);
            self.checks.mag.clear();
            self.last_fused.heading = now;
        }
    }

    pub(super) fn fuse_flow(&mut self, reading: &FlowReading, now: SimTime) {
        let nose = self.attitude * Vec3::<Frd>::new(1.0, 0.0, 0.0);
        let level = nose.horizontal_norm().max(1e-6);
        let (c, s) = (nose.north() / level, nose.east() / level);
        let v = self.velocity_m_s;
        let (forward, right) = (c * v.north() + s * v.east(), c * v.east() - s * v.north());
        // With the nose pitched up or down, the tilt error affects the heading too.
        let steep = -nose.down() / level;
        let turns = |share: f64| [(THETA, share * steep * c), (THETA + 1, share * steep * s), (THETA + 2, share)];
        let variance = self.noise.flow_variance(v.horizontal_norm()) / reading.quality.clamp(0.1, 1.0);
        let [n, e, d] = turns(right);
        let a = self.fuse(&[(V, c), (V + 1, s), n, e, d], reading.forward_m_s - forward, variance);
        let [n, e, d] = turns(-forward);
        let b = self.fuse(&[(V, -s), (V + 1, c), n, e, d], reading.right_m_s - right, variance);
        if a && b {
            self.last_fused.velocity = now;
            self.last_fused.flow = now;
        } else if (now - self.last_fused.velocity).s() > REJECTION_TIMEOUT_S {
            let (f, r) = (reading.forward_m_s, reading.right_m_s);
            self.velocity_m_s = Vec3::new(c * f - s * r, s * f + c * r, v.down());
            self.covariance.reset(V, 2, 4.0 * variance);
            self.last_fused.velocity = now;
        }
    }

    pub(super) fn accepts(&self, slopes: MeasurementJacobian, innovation: f64, variance: f64) -> bool {
        self.covariance.accepts(slopes, innovation, variance, INNOVATION_GATE)
    }

    pub(super) fn fuse(&mut self, slopes: MeasurementJacobian, innovation: f64, variance: f64) -> bool {
        match self.covariance.fuse(slopes, innovation, variance, INNOVATION_GATE) {
            Some(correction) => {
                self.correct(&correction);
                true
            }
            None => false,
        }
    }

    fn correct(&mut self, d: &StateCorrection) {
        self.position_m += Vec3::new(d[P], d[P + 1], d[P + 2]);
        self.velocity_m_s += Vec3::new(d[V], d[V + 1], d[V + 2]);
        self.turn(Vec3::new(d[THETA], d[THETA + 1], d[THETA + 2]));
        self.gyro_bias += Vec3::new(d[BG], d[BG + 1], d[BG + 2]);
        self.accel_bias += Vec3::new(d[BA], d[BA + 1], d[BA + 2]);
        self.gnss_height_offset_m += d[GNSS_HEIGHT];
        self.baro_offset_m += d[BARO];
        self.mag_bias += Vec3::new(d[MAG], d[MAG + 1], d[MAG + 2]);
    }

    /// Rotates the estimated attitude by a small rotation vector in NED.
    fn turn(&mut self, by_rad: Vec3<Ned>) {
        self.attitude = self.attitude.rotated_by(self.attitude.inverse() * by_rad);
    }
}
