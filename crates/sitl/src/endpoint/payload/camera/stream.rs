//! The live video stream. The vehicle does not render it. Another process renders and sends the video, and reports the
//! stream with VIDEO_STREAM_STATUS. The camera announces the stream as long as these reports continue.

use spandrel_model::time::SimTime;

/// UDP port on which ground stations receive the video (docs/src/reference/wire.md, "Camera, gimbal and lamp"). It is
/// fixed because VIDEO_STREAM_STATUS has no field for it.
pub const PORT: u16 = 5600;
/// An active video stream.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct VideoStream {
    /// Width, px.
    pub width_px: u16,
    /// Height, px.
    pub height_px: u16,
    /// Frame rate, Hz.
    pub rate_hz: f32,
    /// Bit rate, bit/s.
    pub bit_rate_bits_s: u32,
}

/// The last report from the stream's sender, and the time at which it expires.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct StreamReport(Option<(VideoStream, SimTime)>);

impl StreamReport {
    /// Creates a report that expires at `until`; `None` if the stream was stopped.
    #[must_use]
    pub fn new(stream: Option<VideoStream>, until: SimTime) -> Self {
        Self(stream.map(|stream| (stream, until)))
    }

    /// Returns the stream, unless its reports have timed out.
    #[must_use]
    pub fn running(&self, now: SimTime) -> Option<VideoStream> {
        self.0.filter(|(_, until)| now <= *until).map(|(stream, _)| stream)
    }
}
