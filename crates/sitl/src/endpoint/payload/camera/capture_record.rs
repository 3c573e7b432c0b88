//! A captured image and its CAMERA_IMAGE_CAPTURED message.

use spandrel_mavlink::dialect::{CAMERA_IMAGE_CAPTURED_DATA, MavMessage};

/// A captured image, with all fields of its message so that the message can be resent.
#[derive(Debug, Clone, PartialEq)]
pub struct CaptureRecord {
    message: CAMERA_IMAGE_CAPTURED_DATA,
}

impl CaptureRecord {
    /// Creates an image's record.
    #[must_use]
    pub fn new(message: CAMERA_IMAGE_CAPTURED_DATA) -> Self {
        Self { message }
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
