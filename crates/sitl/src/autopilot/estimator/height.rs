//! The sensor whose slow changes the height follows: the errors of the others count as large and slow, so that they give the fast changes
//! alone. A reference that falls silent or contradicts the filter gives way to GNSS, to which the height then glides.

use super::Estimator;
use super::checks::{InnovationCheck, REFUSED_S, RejectionMonitor};
use super::covariance::{BARO, P};
use super::fuse::GATE;
use crate::autopilot::operator_rules::HeightReference;
use crate::sensors::baro;
use spandrel_model::frames::Vec3;
use spandrel_model::time::SimTime;

/// What the height of a sensor that is no reference may be off, m (1 sigma; estimate: a change of the weather by 1 hPa is 8 m).
const LOOSE_M: f64 = 10.0;
/// A reference that is silent for longer counts as gone, s (estimate: ten readings of a range finder at 10 Hz).
const SILENT_S: f64 = 1.0;
/// The ground's roughness below the range finder, m (1 sigma; estimate: grass, gravel).
const ROUGH_M: f64 = 0.05;

/// What the height follows now.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Followed {
    reference: HeightReference,
    /// Where the ground lies by the range finder, m down.
    ground_down_m: Option<f64>,
    barometer: Option<SimTime>,
    range: Option<SimTime>,
    check: InnovationCheck,
    off: RejectionMonitor,
}

impl Followed {
    /// The barometer was fused.
    pub fn note_barometer(&mut self, now: SimTime) {
        self.barometer = Some(now);
    }

    /// The vehicle was put elsewhere: the ground is another one.
    pub fn forget_ground(&mut self) {
        (self.ground_down_m, self.check, self.off) = (None, InnovationCheck::default(), RejectionMonitor::default());
    }
}

impl Estimator {
    /// Whether GNSS is the wanted reference.
    pub(super) fn follows_gnss(&self) -> bool {
        self.wanted_reference == HeightReference::Gnss
    }

    /// The wanted reference, while it works.
    pub(super) fn choose_reference(&mut self, now: SimTime) {
        let fresh = |at: Option<SimTime>| at.is_some_and(|at| (now - at).s() < SILENT_S);
        let works = match self.wanted_reference {
            HeightReference::Barometer => fresh(self.followed.barometer) && !self.checks.baro.dropped(),
            HeightReference::RangeFinder => fresh(self.followed.range),
            HeightReference::Gnss => true,
        };
        let reference = if works { self.wanted_reference } else { HeightReference::Gnss };
        if reference != self.followed.reference {
            self.followed.reference = reference;
            self.weigh_heights(reference);
            if self.follows_gnss() {
                self.move_height_to_gnss();
            }
        }
    }

    /// GNSS is the reference from now on: what it was believed to be off goes into the height, and the barometer's offset takes the step along.
    fn move_height_to_gnss(&mut self) {
        let step_m = self.drift_m.down();
        self.position_m += Vec3::new(0.0, 0.0, step_m);
        self.baro_offset_m += step_m;
        self.forget_height_drift();
        let usual = self.noise.gnss_drift_m[1];
        self.covariance.reset(P + 2, 1, usual * usual);
    }

    /// Sets how far and how fast each sensor's height may be off. The height itself stays.
    fn weigh_heights(&mut self, reference: HeightReference) {
        let loose = LOOSE_M * LOOSE_M;
        let usual = self.noise.gnss_drift_m[1] * self.noise.gnss_drift_m[1];
        let loose_walk = loose / self.process.drift_time_s;
        let start = baro::START_OFFSET_M * baro::START_OFFSET_M;
        let (drift, walk, offset) = match reference {
            HeightReference::Gnss => (usual, self.noise.baro_walk, start),
            // Its offset is what it is now.
            HeightReference::Barometer => (loose, 0.0, 0.0),
            HeightReference::RangeFinder => (loose, loose_walk, start),
        };
        (self.process.drift[2], self.process.baro_walk) = (drift, walk);
        self.covariance.reset(BARO, 1, offset);
    }

    /// Height by the range finder, `below_m` over the ground. After a step of the ground (an edge, a truck) it follows the new ground from the
    /// height that it has.
    pub(super) fn follow_range(&mut self, below_m: f64, now: SimTime) {
        if self.wanted_reference != HeightReference::RangeFinder || !below_m.is_finite() {
            self.followed.ground_down_m = None;
            return;
        }
        self.followed.range = Some(now);
        let down_m = self.position_m.down();
        let ground_m = *self.followed.ground_down_m.get_or_insert(down_m + below_m);
        let innovation_m = ground_m - below_m - down_m;
        let variance = self.noise.range_m * self.noise.range_m + ROUGH_M * ROUGH_M;
        let slopes = [(P + 2, 1.0)];
        let fits = self.accepts(&slopes, innovation_m, variance);
        if self.followed.check.admits(fits, now) {
            self.fuse(&slopes, innovation_m, variance);
            self.trust.height = now;
        }
        if fits {
            self.followed.off.forget();
        } else if self.followed.off.hold_s(Vec3::new(0.0, 0.0, innovation_m), GATE * (2.0 * variance).sqrt(), now) > REFUSED_S {
            self.followed.forget_ground();
        }
    }
}
