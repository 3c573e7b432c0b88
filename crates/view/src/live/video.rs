//! Status of the camera view's video stream.

use spandrel_mavlink::dialect::{MavMessage, VIDEO_STREAM_STATUS_DATA, VideoStreamStatusFlags};

/// An active stream of the camera view.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct VideoStatus {
    /// Picture width, px.
    pub width_px: u32,
    /// Picture height, px.
    pub height_px: u32,
    /// Picture rate, Hz.
    pub rate_hz: f64,
    /// Bit rate, bit/s.
    pub bits_s: u32,
}

impl VideoStatus {
    /// Returns the status message for the vehicle; `runs` is false if the stream has ended.
    pub(super) fn status(&self, runs: bool) -> MavMessage {
        let side = |px: u32| u16::try_from(px).unwrap_or(u16::MAX);
        let running = VideoStreamStatusFlags::VIDEO_STREAM_STATUS_FLAGS_RUNNING;
        MavMessage::VIDEO_STREAM_STATUS(VIDEO_STREAM_STATUS_DATA {
            framerate: self.rate_hz as f32,
            bitrate: self.bits_s,
            flags: if runs { running } else { VideoStreamStatusFlags::empty() },
            resolution_h: side(self.width_px),
            resolution_v: side(self.height_px),
            stream_id: 1,
            ..VIDEO_STREAM_STATUS_DATA::default()
        })
    }
}
