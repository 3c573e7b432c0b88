//! The camera component: pictures, their geotags, picture series.

use super::view::{CameraSummary, View};
use crate::base::frames::Rotation;
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
    /// Items of the uploaded mission (MISSION_CURRENT wants the number).
    pub mission_items: u16,
    next: Option<SimTime>,
    left: Option<u32>,
}

/// Pictures that a card holds.
const MOST_SHOTS: usize = 5_000;
/// The shortest time between pictures of a series, s.
const LEAST_INTERVAL_S: f64 = 0.2;

impl CameraState {
    /// The counters.
    #[must_use]
    pub fn summary(&self) -> CameraSummary {
        CameraSummary { pictures: self.shots.len(), interval_s: self.interval_s, mission_items: self.mission_items }
    }

    /// Starts a series or takes one picture: `count` 0 means until stopped. False when the numbers make no sense.
    pub fn start(&mut self, interval_s: f64, count: f64, now: SimTime) -> bool {
        let whole = count.is_finite() && (0.0..=1e6).contains(&count);
        if !whole || !interval_s.is_finite() || interval_s < 0.0 || self.shots.len() >= MOST_SHOTS {
            return false;
        }
        let single = count as u32 == 1;
        self.interval_s = (!single).then_some(interval_s.max(LEAST_INTERVAL_S));
        self.left = (count as u32 > 0).then_some(count as u32);
        self.next = Some(now);
        true
    }

    /// Ends a series.
    pub fn stop(&mut self) {
        (self.interval_s, self.next, self.left) = (None, None, None);
    }

    /// True when a picture is due at `now`; call [`CameraState::take`] then.
    #[must_use]
    pub fn due(&self, now: SimTime) -> bool {
        self.next.is_some_and(|next| next <= now)
    }

    /// The picture that is due.
    pub fn take(&mut self, shot: Shot) -> MavMessage {
        let message = MavMessage::CAMERA_IMAGE_CAPTURED(shot.message.clone());
        if self.shots.len() < MOST_SHOTS {
            self.shots.push(shot);
        }
        self.left = self.left.map(|left| left.saturating_sub(1));
        match self.interval_s {
            Some(interval) if self.left != Some(0) => self.next = self.next.map(|n| n + SimTime::from_s(interval)),
            _ => self.stop(),
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
