//! Reports from the process that renders and sends the video.

use super::PayloadLink;
use super::camera::stream::{StreamReport, VideoStream};
use super::inbound::PayloadMessage;
use mavlink::MessageData;
use spandrel_mavlink::dialect::{VIDEO_STREAM_INFORMATION_DATA, VIDEO_STREAM_STATUS_DATA, VideoStreamStatusFlags};
use spandrel_model::time::SimTime;

/// Timeout for a stream's reports, in seconds of the sender's time; reports arrive every second.
const REPORT_TIMEOUT_S: f64 = 3.5;
/// Maximum accepted frame rate, Hz.
const MAX_FRAME_RATE_HZ: f32 = 240.0;

/// Handles VIDEO_STREAM_STATUS for stream 1 from any sender other than the vehicle's own components.
pub(super) fn status(p: &mut PayloadLink, m: &VIDEO_STREAM_STATUS_DATA, a: &mut PayloadMessage) {
    let own = a.from.0 == a.links.system_id() && a.links.is_own(a.from.1);
    let valid =
        m.framerate.is_finite() && (0.0..=MAX_FRAME_RATE_HZ).contains(&m.framerate) && m.resolution_h > 0 && m.resolution_v > 0;
    if own || m.stream_id != 1 || !valid {
        return;
    }
    let now = a.input.clock.now;
    let camera = &mut p.equipment.camera;
    let before = camera.stream.running(now);
    let runs = m.flags.contains(VideoStreamStatusFlags::VIDEO_STREAM_STATUS_FLAGS_RUNNING);
    let stream =
        VideoStream { width_px: m.resolution_h, height_px: m.resolution_v, rate_hz: m.framerate, bit_rate_bits_s: m.bitrate };
    // The sender uses wall time, like other clients.
    let until = now + SimTime::from_s(REPORT_TIMEOUT_S * p.speed_factor);
    camera.stream = StreamReport::new(runs.then_some(stream), until);
    // Ground stations open the video when the stream is announced, and use the announced size.
    let size = |stream: VideoStream| (stream.width_px, stream.height_px);
    if before.map(size) != runs.then(|| size(stream)) {
        p.equipment.changes.add_message(VIDEO_STREAM_INFORMATION_DATA::ID);
        p.equipment.changes.add_message(VIDEO_STREAM_STATUS_DATA::ID);
    }
}
