//! Capture timing: single images, time-lapse series and distance-triggered series.

use spandrel_model::frames::{Enu, Vec3};
use spandrel_model::time::SimTime;

/// Minimum distance between images in a series, m.
const MIN_DISTANCE_M: f64 = 0.1;
/// Minimum and maximum interval between images in a series, s.
const MIN_INTERVAL_S: f64 = 0.2;
const MAX_INTERVAL_S: f64 = 86_400.0;
/// Maximum accepted count and distance.
const MAX_PICTURES: f64 = 1e6;
const MAX_DISTANCE_M: f64 = 1e5;

/// The images that remain to be taken: single images and the current series.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct CaptureSeries {
    interval_s: Option<f64>,
    next: Option<SimTime>,
    left: Option<u32>,
    /// Distance between images, m, and the position of the last one.
    distance_trigger: Option<(f64, Vec3<Enu>)>,
    /// Number of single images still to be taken. Commands may arrive faster than images are taken, and none may be
    /// lost.
    pending_single_images: u32,
}

impl CaptureSeries {
    /// Returns the interval, in seconds, of a time-lapse series in progress.
    #[must_use]
    pub fn interval_s(&self) -> Option<f64> {
        self.interval_s
    }

    /// Checks whether a distance-triggered series is in progress.
    #[must_use]
    pub fn is_distance_triggered(&self) -> bool {
        self.distance_trigger.is_some()
    }

    /// Starts a series or takes one image. If `count` is 0, the series continues until it is stopped. Returns false if
    /// a value is invalid.
    pub fn start(&mut self, interval_s: f64, count: f64, now: SimTime) -> bool {
        if !(0.0..=MAX_PICTURES).contains(&count) || !(0.0..=MAX_INTERVAL_S).contains(&interval_s) {
            return false;
        }
        if count as u32 == 1 {
            self.pending_single_images = self.pending_single_images.saturating_add(1);
            return true;
        }
        self.interval_s = Some(interval_s.max(MIN_INTERVAL_S));
        self.left = (count as u32 > 0).then_some(count as u32);
        self.next = Some(now);
        true
    }

    /// Takes an image every `distance_m` meters, starting at `here`, and one immediately if `first` is set. A distance
    /// of 0 stops the series. Returns false if the value is invalid.
    pub fn start_distance_triggered_series(&mut self, distance_m: f64, first: bool, here: Vec3<Enu>, now: SimTime) -> bool {
        if !(0.0..=MAX_DISTANCE_M).contains(&distance_m) {
            return false;
        }
        self.distance_trigger = (distance_m > 0.0).then_some((distance_m.max(MIN_DISTANCE_M), here));
        if first && distance_m > 0.0 {
            self.next = Some(now);
        }
        true
    }

    /// Stops every series. Single images already accepted are still taken.
    pub fn stop(&mut self) {
        *self = Self { pending_single_images: self.pending_single_images, ..Self::default() };
    }

    /// Cancels everything, including single images.
    pub fn cancel(&mut self) {
        *self = Self::default();
    }

    /// Returns true if the next image should be captured; call [`CaptureSeries::taken`] after the capture.
    #[must_use]
    pub fn due(&self, now: SimTime, here: Vec3<Enu>) -> bool {
        let far = self.distance_trigger.is_some_and(|(distance_m, last)| (here - last).norm() >= distance_m);
        self.pending_single_images > 0 || far || self.next.is_some_and(|next| next <= now)
    }

    /// Records that the due image has been taken.
    pub fn taken(&mut self, now: SimTime, here: Vec3<Enu>) {
        if self.pending_single_images > 0 {
            self.pending_single_images -= 1;
            return;
        }
        if let Some((_, last)) = &mut self.distance_trigger {
            *last = here;
        }
        if self.next.is_some_and(|next| next <= now) {
            self.left = self.left.map(|left| left.saturating_sub(1));
            let goes_on = self.left != Some(0);
            self.interval_s = self.interval_s.filter(|_| goes_on);
            self.next = self.next.zip(self.interval_s).map(|(next, interval)| next + SimTime::from_s(interval));
            self.left = self.left.filter(|_| self.interval_s.is_some());
        }
    }
}
