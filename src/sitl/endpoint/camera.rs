//! The camera component: pictures, their geotags, picture series.

use super::view::{CameraSummary, View};
use crate::base::frames::{Enu, Rotation, Vec3};
use crate::base::time::SimTime;
use crate::mav::dialect::{CAMERA_IMAGE_CAPTURED_DATA, MavBool, MavMessage};
use crate::mav::units::{deg_e7, mm};

/// One picture: everything that its message says, so that it can be said again.
#[derive(Debug, Clone, PartialEq)]
pub struct Shot {
    message: CAMERA_IMAGE_CAPTURED_DATA,
}

/// The camera's state.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct CameraState {
    /// Pictures taken.
    pub shots: Vec<Shot>,
    /// Seconds between pictures of a running series.
    pub interval_s: Option<f64>,
    next: Option<SimTime>,
    left: Option<u32>,
    /// A picture every so many metres, and where the last one was.
    by_distance: Option<(f64, Vec3<Enu>)>,
    /// A single picture beside a running series.
    once: bool,
}

/// A memory card of 32 GB, MiB.
pub const CARD_MIB: f32 = 30_517.0;
/// One picture, MiB (estimate: 12 MP JPEG).
pub const PICTURE_MIB: f32 = 6.0;
/// Pictures that the card holds.
pub const MOST_SHOTS: usize = (CARD_MIB / PICTURE_MIB) as usize;
/// The shortest way between pictures of a series, m.
const LEAST_WAY_M: f64 = 0.1;
/// The shortest and the longest time between pictures of a series, s.
const LEAST_INTERVAL_S: f64 = 0.2;
const LONGEST_INTERVAL_S: f64 = 86_400.0;

impl CameraState {
    /// The counters.
    #[must_use]
    pub fn summary(&self) -> CameraSummary {
        CameraSummary { pictures: self.shots.len(), interval_s: self.interval_s, series: self.by_distance.is_some() }
    }

    /// Starts a series or takes one picture: `count` 0 means until stopped. False when the numbers make no sense.
    pub fn start(&mut self, interval_s: f64, count: f64, now: SimTime) -> bool {
        let whole = (0.0..=1e6).contains(&count);
        if !whole || !(0.0..=LONGEST_INTERVAL_S).contains(&interval_s) || self.full() {
            return false;
        }
        let single = count as u32 == 1;
        if single && self.interval_s.is_some() && self.next.is_some() {
            self.once = true;
            return true;
        }
        self.interval_s = (!single).then_some(interval_s.max(LEAST_INTERVAL_S));
        self.left = (count as u32 > 0).then_some(count as u32);
        self.next = Some(now);
        true
    }

    /// A picture every `way_m` from `here` on, and one now if asked for; 0 ends it. False when the numbers make no sense.
    pub fn start_by_distance(&mut self, way_m: f64, first: bool, here: Vec3<Enu>, now: SimTime) -> bool {
        if !(0.0..=1e5).contains(&way_m) || (self.full() && way_m > 0.0) {
            return false;
        }
        self.by_distance = (way_m > 0.0).then_some((way_m.max(LEAST_WAY_M), here));
        if first && way_m > 0.0 {
            self.next = Some(now);
        }
        true
    }

    /// No picture fits on the card any more.
    #[must_use]
    pub fn full(&self) -> bool {
        self.shots.len() >= MOST_SHOTS
    }

    /// Ends a series.
    pub fn stop(&mut self) {
        (self.interval_s, self.next, self.left, self.by_distance) = (None, None, None, None);
        self.once = false;
    }

    /// True when a picture is due at `now`; call [`CameraState::take`] then.
    #[must_use]
    pub fn due(&self, now: SimTime, here: Vec3<Enu>) -> bool {
        let far = self.by_distance.is_some_and(|(way_m, last)| (here - last).norm() >= way_m);
        !self.full() && (self.once || far || self.next.is_some_and(|next| next <= now))
    }

    /// The picture that is due. A full card ends every series.
    pub fn take(&mut self, shot: Shot, now: SimTime, here: Vec3<Enu>) -> MavMessage {
        let message = MavMessage::CAMERA_IMAGE_CAPTURED(shot.message.clone());
        self.shots.push(shot);
        if std::mem::take(&mut self.once) {
            return message;
        }
        if let Some((_, last)) = &mut self.by_distance {
            *last = here;
        }
        if self.next.is_some_and(|next| next <= now) {
            self.left = self.left.map(|left| left.saturating_sub(1));
            let goes_on = self.left != Some(0);
            self.interval_s = self.interval_s.filter(|_| goes_on);
            self.next = self.next.zip(self.interval_s).map(|(next, interval)| next + SimTime::from_s(interval));
            self.left = self.left.filter(|_| self.interval_s.is_some());
        }
        if self.full() {
            self.stop();
        }
        message
    }

    /// A picture's message again.
    #[must_use]
    pub fn again(&self, index: i64) -> Option<MavMessage> {
        let shot = self.shots.get(usize::try_from(index).ok()?)?;
        Some(MavMessage::CAMERA_IMAGE_CAPTURED(shot.message.clone()))
    }
}

impl Shot {
    /// A picture of this instant.
    #[must_use]
    pub fn of(v: &View) -> Self {
        let geo = v.geo();
        let attitude = Rotation::from_euler(0.0, v.gimbal.pitch_rad, v.estimate.attitude.yaw_rad());
        Self {
            message: CAMERA_IMAGE_CAPTURED_DATA {
                time_utc: v.unix_us(),
                time_boot_ms: v.boot_ms(),
                lat: deg_e7(geo.latitude_deg),
                lon: deg_e7(geo.longitude_deg),
                alt: mm(geo.altitude_m),
                relative_alt: mm(v.over_home_m()),
                q: attitude.wxyz().map(|c| c as f32),
                image_index: v.camera.pictures as i32,
                camera_id: 0,
                capture_result: MavBool::MAV_BOOL_TRUE,
                file_url: "".into(),
            },
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn exact_a_full_card_ends_a_series_and_every_picture_has_its_own_index() {
        let (mut camera, mut now) = (CameraState::default(), SimTime::ZERO);
        let here = Vec3::zero();
        assert!(camera.start(1.0, 0.0, now));
        while camera.due(now, here) {
            let image_index = camera.summary().pictures as i32;
            let shot = Shot { message: CAMERA_IMAGE_CAPTURED_DATA { image_index, ..Default::default() } };
            camera.take(shot, now, here);
            now += SimTime::from_s(1.0);
        }
        assert_eq!(camera.shots.len(), MOST_SHOTS);
        assert!(camera.shots.iter().enumerate().all(|(k, shot)| shot.message.image_index == k as i32));
        let left_mib = CARD_MIB - PICTURE_MIB * MOST_SHOTS as f32;
        assert!((0.0..PICTURE_MIB).contains(&left_mib), "the storage that is told agrees: {left_mib}");
        assert!(camera.full() && camera.summary().interval_s.is_none());
        assert!(!camera.start(0.0, 1.0, now) && !camera.start_by_distance(5.0, false, here, now));
    }
}
