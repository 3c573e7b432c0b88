//! The live video stream. The vehicle does not render it: the process that renders and sends the video reports it with
//! VIDEO_STREAM_STATUS, and the camera announces the stream for as long as the reports continue.

use super::super::Endpoint;
use super::super::inbound::InboundMessage;
use super::super::streams::{AUTOPILOT, CAMERA};
use mavlink::MessageData;
use spandrel_mavlink::dialect::{VIDEO_STREAM_INFORMATION_DATA, VIDEO_STREAM_STATUS_DATA, VideoStreamStatusFlags};
use spandrel_model::time::SimTime;

/// Timeout of a stream's reports, s of the sender's time; reports arrive every second.
const LASTS_S: f64 = 3.5;
/// UDP port that ground stations receive the video on (docs/src/reference/wire.md, "Camera, gimbal and lamp"). It is fixed
/// because VIDEO_STREAM_STATUS has no field for it.
pub const PORT: u16 = 5600;
/// Maximum accepted frame rate, Hz.
const RATE_MAX_HZ: f32 = 240.0;

/// A running video stream.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct VideoStream {
    /// Width, px.
    pub width_px: u16,
    /// Height, px.
    pub height_px: u16,
    /// Frame rate, Hz.
    pub rate_hz: f32,
    /// Bit rate, bit/s.
    pub bits_s: u32,
}

/// The last report of the stream's sender and the time at which it expires.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct StreamReport(Option<(VideoStream, SimTime)>);

impl StreamReport {
    /// Returns the stream, unless its reports have timed out.
    #[must_use]
    pub fn running(&self, now: SimTime) -> Option<VideoStream> {
        self.0.filter(|(_, until)| now <= *until).map(|(stream, _)| stream)
    }
}

/// Handles VIDEO_STREAM_STATUS for stream 1 from any sender other than the vehicle's own components.
pub(in super::super) fn status(e: &mut Endpoint, m: &VIDEO_STREAM_STATUS_DATA, a: &mut InboundMessage) {
    let own = a.from.0 == e.system_id && matches!(a.from.1, AUTOPILOT | CAMERA);
    let sound = m.framerate.is_finite() && (0.0..=RATE_MAX_HZ).contains(&m.framerate) && m.resolution_h > 0 && m.resolution_v > 0;
    if own || m.stream_id != 1 || !sound {
        return;
    }
    let before = e.payload.camera.stream.running(a.view.now);
    let runs = m.flags.contains(VideoStreamStatusFlags::VIDEO_STREAM_STATUS_FLAGS_RUNNING);
    let stream = VideoStream { width_px: m.resolution_h, height_px: m.resolution_v, rate_hz: m.framerate, bits_s: m.bitrate };
    // The sender runs in wall time, as clients do.
    let until = a.view.now + SimTime::from_s(LASTS_S * e.speed_factor);
    e.payload.camera.stream = StreamReport(runs.then_some((stream, until)));
    // Ground stations open the video when the stream is announced, and use the announced size.
    let size = |stream: VideoStream| (stream.width_px, stream.height_px);
    if before.map(size) != runs.then(|| size(stream)) {
        e.payload.changes.add_message(VIDEO_STREAM_INFORMATION_DATA::ID);
        e.payload.changes.add_message(VIDEO_STREAM_STATUS_DATA::ID);
    }
}
