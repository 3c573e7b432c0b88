//! Height reference selection. The other height sensors are assigned large, slowly varying errors, so that they
//! contribute only to fast changes. If the reference times out or contradicts the filter, GNSS takes over and the
//! height converges to it.

use super::Estimator;
use super::assumptions::BARO_START_OFFSET_M;
use super::checks::REJECTION_TIMEOUT_S;
use super::covariance::{BARO, P};
use super::fuse::INNOVATION_GATE;
use super::height_reference::HeightReference;
use spandrel_model::frames::Vec3;
use spandrel_model::time::SimTime;

/// Height uncertainty of a sensor that is not the reference, m (1 sigma; estimate: a pressure change of 1 hPa corresponds to 8
/// m).
const NON_REFERENCE_SIGMA_M: f64 = 10.0;
/// Height reference timeout, s (estimate: ten range finder readings at 10 Hz).
const REFERENCE_TIMEOUT_S: f64 = 1.0;
/// Roughness of the ground below the range finder, m (1 sigma; estimate: grass, gravel).
const GROUND_ROUGHNESS_M: f64 = 0.05;

impl Estimator {
    /// Returns true if GNSS is the configured reference.
    pub(super) fn gnss_is_reference(&self) -> bool {
        self.configured_reference == HeightReference::Gnss
    }

    /// Selects the configured reference while it works, and GNSS otherwise.
    pub(super) fn choose_reference(&mut self, now: SimTime) {
        let fresh = |at: Option<SimTime>| at.is_some_and(|at| (now - at).s() < REFERENCE_TIMEOUT_S);
        let works = match self.configured_reference {
            HeightReference::Barometer => fresh(self.height_reference.barometer) && !self.checks.baro.dropped(),
            HeightReference::RangeFinder => fresh(self.height_reference.range),
            HeightReference::Gnss => true,
        };
        let reference = if works { self.configured_reference } else { HeightReference::Gnss };
        if reference != self.height_reference.reference {
            self.height_reference.reference = reference;
            self.set_height_weights(reference);
            if self.gnss_is_reference() {
                self.move_height_to_gnss();
            } else if reference == HeightReference::Gnss {
                self.doubt_height();
            }
        }
    }

    /// Makes GNSS the reference: adds its estimated offset to the height and to the barometer offset.
    fn move_height_to_gnss(&mut self) {
        let step_m = self.gnss_height_offset_m;
        self.position_m += Vec3::new(0.0, 0.0, step_m);
        self.baro_offset_m += step_m;
        self.reset_gnss_height_offset();
        self.doubt_height();
    }

    /// Lets the height follow GNSS slowly after the configured reference was lost: from now on, it is no more certain than GNSS.
    fn doubt_height(&mut self) {
        let usual = self.noise.gnss_m[1];
        self.covariance.reset(P + 2, 1, usual * usual);
    }

    /// Sets the height error model of each sensor for the given reference. Does not change the height.
    fn set_height_weights(&mut self, reference: HeightReference) {
        let loose = NON_REFERENCE_SIGMA_M * NON_REFERENCE_SIGMA_M;
        let usual = self.noise.gnss_m[1] * self.noise.gnss_m[1];
        let loose_walk = loose / self.process.gnss_height_time_s;
        let start = BARO_START_OFFSET_M * BARO_START_OFFSET_M;
        let (gnss_height, walk, offset) = match reference {
            HeightReference::Gnss => (usual, self.noise.baro_walk, start),
            // The offset stays at its current value.
            HeightReference::Barometer => (loose, 0.0, 0.0),
            HeightReference::RangeFinder => (loose, loose_walk, start),
        };
        (self.process.gnss_height, self.process.baro_walk) = (gnss_height, walk);
        self.covariance.reset(BARO, 1, offset);
    }

    /// Corrects the height with the measured distance `below_m` to the ground. If the surface changes abruptly (an
    /// edge, a truck), keeps the height and adopts the new ground level.
    pub(super) fn correct_height_by_range(&mut self, below_m: f64, now: SimTime) {
        if self.configured_reference != HeightReference::RangeFinder || !below_m.is_finite() {
            self.height_reference.ground_down_m = None;
            return;
        }
        self.height_reference.range = Some(now);
        let down_m = self.position_m.down();
        let ground_m = *self.height_reference.ground_down_m.get_or_insert(down_m + below_m);
        let innovation_m = ground_m - below_m - down_m;
        let variance = self.noise.range_m * self.noise.range_m + GROUND_ROUGHNESS_M * GROUND_ROUGHNESS_M;
        let slopes = [(P + 2, 1.0)];
        let fits = self.accepts(&slopes, innovation_m, variance);
        if self.height_reference.check.should_fuse(fits, now) {
            self.fuse(&slopes, innovation_m, variance);
            self.last_fused.height = now;
        }
        if fits {
            self.height_reference.off.clear();
        } else if self.height_reference.off.record_offset(
            Vec3::new(0.0, 0.0, innovation_m),
            INNOVATION_GATE * (2.0 * variance).sqrt(),
            now,
        ) > REJECTION_TIMEOUT_S
        {
            self.height_reference.clear_ground_level();
        }
    }
}
