//! A captured image and its CAMERA_IMAGE_CAPTURED message.

use crate::endpoint::snapshot::VehicleSnapshot;
use spandrel_mavlink::dialect::{CAMERA_IMAGE_CAPTURED_DATA, MavBool, MavMessage};
use spandrel_mavlink::units::{deg_e7, mm};

/// One captured image, with all the fields of its message so that it can be sent again.
#[derive(Debug, Clone, PartialEq)]
pub struct CaptureRecord {
    message: CAMERA_IMAGE_CAPTURED_DATA,
}

impl CaptureRecord {
    /// Creates the record of an image taken now.
    #[must_use]
    pub fn of(v: &VehicleSnapshot) -> Self {
        let geo = v.geo();
        Self {
            message: CAMERA_IMAGE_CAPTURED_DATA {
                time_utc: v.unix_us(),
                time_boot_ms: v.sim_ms(),
                lat: deg_e7(geo.latitude_deg),
                lon: deg_e7(geo.longitude_deg),
                alt: mm(geo.altitude_m),
                relative_alt: mm(v.over_home_m()),
                q: v.camera_attitude().map(|c| c as f32),
                image_index: v.camera.pictures as i32,
                camera_id: 0,
                capture_result: MavBool::MAV_BOOL_TRUE,
                file_url: "".into(),
            },
        }
    }

    /// Returns the CAMERA_IMAGE_CAPTURED message.
    #[must_use]
    pub fn message(&self) -> MavMessage {
        MavMessage::CAMERA_IMAGE_CAPTURED(self.message.clone())
    }

    /// Creates an empty record with this index, for tests.
    #[cfg(test)]
    pub(super) fn numbered(index: usize) -> Self {
        Self { message: CAMERA_IMAGE_CAPTURED_DATA { image_index: index as i32, ..Default::default() } }
    }
}
