//! The live picture: the vehicle draws none itself. Whoever draws and sends it tells by VIDEO_STREAM_STATUS, and the camera announces that stream
//! for as long as it is told of.

use super::super::Endpoint;
use super::super::inbound::InboundMessage;
use super::super::streams::{AUTOPILOT, CAMERA};
use mavlink::MessageData;
use spandrel_mavlink::dialect::{VIDEO_STREAM_INFORMATION_DATA, VIDEO_STREAM_STATUS_DATA, VideoStreamStatusFlags};
use spandrel_model::time::SimTime;

/// A stream that is not told of for so long, s of its sender's time, has ended: it is told of every second.
const LASTS_S: f64 = 3.5;
/// Where ground stations listen for it, UDP (docs/src/reference/wire.md, "Camera, gimbal and lamp"): nobody can tell the vehicle
/// another port, for VIDEO_STREAM_STATUS has no place for it.
pub const PORT: u16 = 5600;
/// Largest rate that is believed, Hz.
const RATE_MAX_HZ: f32 = 240.0;

/// What runs.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct VideoStream {
    /// Width, px.
    pub width_px: u16,
    /// Height, px.
    pub height_px: u16,
    /// Pictures a second.
    pub rate_hz: f32,
    /// Bits a second.
    pub bits_s: u32,
}

/// The last word of who sends it, and until when it holds.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct StreamReport(Option<(VideoStream, SimTime)>);

impl StreamReport {
    /// The stream, while it is told of.
    #[must_use]
    pub fn running(&self, now: SimTime) -> Option<VideoStream> {
        self.0.filter(|(_, until)| now <= *until).map(|(stream, _)| stream)
    }
}

/// VIDEO_STREAM_STATUS of the first stream, of anybody but the vehicle's own components.
pub(in super::super) fn status(e: &mut Endpoint, m: &VIDEO_STREAM_STATUS_DATA, a: &mut InboundMessage) {
    let own = a.from.0 == e.system_id && matches!(a.from.1, AUTOPILOT | CAMERA);
    let sound = m.framerate.is_finite() && (0.0..=RATE_MAX_HZ).contains(&m.framerate) && m.resolution_h > 0 && m.resolution_v > 0;
    if own || m.stream_id != 1 || !sound {
        return;
    }
    let before = e.payload.camera.stream.running(a.view.now);
    let runs = m.flags.contains(VideoStreamStatusFlags::VIDEO_STREAM_STATUS_FLAGS_RUNNING);
    let stream = VideoStream { width_px: m.resolution_h, height_px: m.resolution_v, rate_hz: m.framerate, bits_s: m.bitrate };
    // Who sends it lives in wall time, as clients do.
    let until = a.view.now + SimTime::from_s(LASTS_S * e.speed_factor);
    e.payload.camera.stream = StreamReport(runs.then_some((stream, until)));
    // Ground stations open the picture when they hear that it runs, and shape it by the size that they hear.
    let size = |stream: VideoStream| (stream.width_px, stream.height_px);
    if before.map(size) != runs.then(|| size(stream)) {
        e.payload.changes.add_message(VIDEO_STREAM_INFORMATION_DATA::ID);
        e.payload.changes.add_message(VIDEO_STREAM_STATUS_DATA::ID);
    }
}
