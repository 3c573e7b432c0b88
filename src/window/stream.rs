//! Streams the camera's view as H.264 over RTP. A separate thread encodes and sends frames, so a slow network or
//! encoder drops frames in the stream, but not in the window.

use crate::errors::AppError;
use crate::io::clock::Stopwatch;
use spandrel_model::time::SimTime;
use spandrel_sitl::endpoint::camera::stream::PORT;
use spandrel_view::live::VideoStatus;
use spandrel_view::picture::Picture;
use spandrel_view::video::rtp::RtpPacketizer;
use spandrel_view::video::{EncodedPicture, H264Encoder, PictureRate, VideoError};
use std::net::{Ipv4Addr, Ipv6Addr, SocketAddr, UdpSocket};
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::mpsc::{Receiver, SyncSender, TrySendError, sync_channel};
use std::thread::JoinHandle;
use std::time::Duration;

/// Bits per pixel (estimate: 2 Mbit/s at 720p25, which wireless networks can handle).
const BITS_PER_PIXEL: f64 = 0.1;
/// Number of frames between key frames. A receiver that joins the stream waits for the next key frame.
const KEY_FRAME_INTERVAL_FRAMES: u32 = 25;
/// Minimum interval between frames: 30 frames per second, typical of drone cameras (estimate;
/// docs/src/reference/wire.md, "Camera, gimbal and lamp"). The window may have a higher frame rate.
const MIN_FRAME_INTERVAL: Duration = Duration::from_nanos(33_000_000);

/// A video stream to one receiver.
pub struct StreamSender {
    /// Set to `None` to end the stream.
    pictures: Option<SyncSender<Picture>>,
    sender: Option<JoinHandle<StreamStatistics>>,
    /// True if the last frame could not be encoded.
    encoding_fails: Arc<AtomicBool>,
    stopwatch: Stopwatch,
    rate: PictureRate,
    last: Option<Stopwatch>,
}

/// Statistics about the stream.
#[derive(Debug, Clone, Copy, Default)]
struct StreamStatistics {
    pictures: u64,
    /// Total encoding time, measured as wall time.
    encoding: Duration,
}

impl StreamSender {
    /// Opens a stream to a receiver. Its random initial RTP values are derived from `seed`, which should differ between
    /// streams.
    ///
    /// # Errors
    /// Returns an error if the socket cannot be opened, or there is no route to the receiver.
    pub fn open(to: SocketAddr, seed: u64) -> Result<Self, AppError> {
        let socket = socket(to).map_err(|error| AppError::failed(format!("--stream {to}: {error}")))?;
        if to.port() != PORT {
            tracing::warn!("--stream {to}: the vehicle still announces port {PORT}; configure the other port in the receiver");
        }
        // The queue holds at most one frame while another frame is being encoded; further frames are dropped.
        let (pictures, wanted) = sync_channel(1);
        let encoding_fails = Arc::new(AtomicBool::new(false));
        let line = StreamDestination { socket, to, packets: RtpPacketizer::new(seed), watch: Stopwatch::start(), told: false };
        let sender = std::thread::spawn({
            let encoding_fails = Arc::clone(&encoding_fails);
            move || send(&wanted, line, &encoding_fails)
        });
        let (watch, rate) = (Stopwatch::start(), PictureRate::default());
        Ok(Self { pictures: Some(pictures), sender: Some(sender), encoding_fails, stopwatch: watch, rate, last: None })
    }

    /// Returns true if another frame is due.
    pub fn is_due(&self) -> bool {
        self.last.is_none_or(|last| last.elapsed() >= MIN_FRAME_INTERVAL)
    }

    /// Passes a frame to the encoder if it is ready. If encoding works, returns the stream's status once the frame rate
    /// is known.
    pub fn push(&mut self, picture: Picture) -> Option<VideoStatus> {
        let (width_px, height_px) = (picture.width, picture.height);
        self.last = Some(Stopwatch::start());
        match self.pictures.as_ref()?.try_send(picture) {
            Ok(()) => self.rate.count(SimTime::from_s(self.stopwatch.elapsed().as_secs_f64())),
            Err(TrySendError::Full(_)) => {}
            Err(TrySendError::Disconnected(_)) => return None,
        }
        if self.encoding_fails.load(Ordering::Relaxed) {
            return None;
        }
        Some(VideoStatus { width_px, height_px, rate_hz: self.rate.hz()?, bits_s: bit_rate((width_px, height_px)) })
    }
}

impl Drop for StreamSender {
    fn drop(&mut self) {
        drop(self.pictures.take());
        // A panic in the thread has already been reported.
        if let Some(Ok(sent)) = self.sender.take().map(JoinHandle::join) {
            let each_ms = 1e3 * sent.encoding.as_secs_f64() / (sent.pictures.max(1) as f64);
            tracing::info!("streamed {} frames, average encoding time {each_ms:.1} ms", sent.pictures);
        }
    }
}

/// Opens a socket that sends only to this address.
fn socket(to: SocketAddr) -> std::io::Result<UdpSocket> {
    let any =
        if to.is_ipv4() { SocketAddr::from((Ipv4Addr::UNSPECIFIED, 0)) } else { SocketAddr::from((Ipv6Addr::UNSPECIFIED, 0)) };
    let socket = UdpSocket::bind(any)?;
    socket.connect(to)?;
    Ok(socket)
}

fn bit_rate((width, height): (u32, u32)) -> u32 {
    (BITS_PER_PIXEL * f64::from(width) * f64::from(height) * f64::from(KEY_FRAME_INTERVAL_FRAMES)) as u32
}

/// Where the packets are sent.
struct StreamDestination {
    socket: UdpSocket,
    to: SocketAddr,
    packets: RtpPacketizer,
    watch: Stopwatch,
    /// True once lost packets have been logged.
    told: bool,
}

impl StreamDestination {
    /// Sends an encoded frame with the current time.
    fn send(&mut self, units: &[Vec<u8>]) {
        for packet in self.packets.picture(units, self.watch.elapsed().as_secs_f64()) {
            // The receiver may not be listening yet.
            if let Err(error) = self.socket.send(&packet)
                && error.kind() != std::io::ErrorKind::ConnectionRefused
                && !std::mem::replace(&mut self.told, true)
            {
                tracing::warn!("lost stream packets to {}: {error}", self.to);
            }
        }
    }
}

/// An encoder for frames of varying size.
#[derive(Default)]
struct ResizingEncoder(Option<(H264Encoder, (u32, u32))>);

impl ResizingEncoder {
    fn encode(&mut self, picture: &Picture) -> Result<EncodedPicture, VideoError> {
        let size = (picture.width, picture.height);
        let (mut encoder, of) = match self.0.take().filter(|(_, of)| *of == size) {
            Some(made) => made,
            None => {
                (H264Encoder::new(size, f64::from(KEY_FRAME_INTERVAL_FRAMES), bit_rate(size), KEY_FRAME_INTERVAL_FRAMES)?, size)
            }
        };
        let encoded = encoder.encode(picture);
        self.0 = Some((encoder, of));
        encoded
    }
}

/// The last reported error.
#[derive(Debug, Default)]
struct LastError(Option<VideoError>);

impl LastError {
    /// Returns an error only if it differs from the last one. After a success, returns the same error again.
    fn new_error(&mut self, wrong: Option<VideoError>) -> Option<&VideoError> {
        if self.0 == wrong {
            return None;
        }
        self.0 = wrong;
        self.0.as_ref()
    }
}

/// Encodes and sends frames until the window is closed.
fn send(wanted: &Receiver<Picture>, mut line: StreamDestination, encoding_fails: &AtomicBool) -> StreamStatistics {
    let (mut encoder, mut complaint, mut sent) = (ResizingEncoder::default(), LastError::default(), StreamStatistics::default());
    while let Ok(picture) = wanted.recv() {
        let began = Stopwatch::start();
        let encoded = encoder.encode(&picture);
        encoding_fails.store(encoded.is_err(), Ordering::Relaxed);
        if let Some(error) = complaint.new_error(encoded.as_ref().err().cloned()) {
            tracing::warn!("the stream is missing frames: {error}");
        }
        if let Ok(encoded) = encoded {
            sent.encoding += began.elapsed();
            sent.pictures += u64::from(!encoded.units.is_empty());
            line.send(&encoded.units);
        }
    }
    sent
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn exact_errors_are_reported_once_until_they_change() {
        let (odd, even) = (VideoError::Encoder("odd".into()), VideoError::Encoder("even".into()));
        let mut complaint = LastError::default();
        let told = [Some(&odd), Some(&odd), Some(&even), None, None, Some(&even)]
            .map(|wrong| complaint.new_error(wrong.cloned()).cloned());
        assert_eq!(told, [Some(odd.clone()), None, Some(even.clone()), None, None, Some(even.clone())]);
    }

    #[test]
    fn exact_each_frame_size_gets_a_new_encoder() {
        let grey = |width, height| Picture { width, height, rgba: vec![90; 4 * (width * height) as usize] };
        let mut encoder = ResizingEncoder::default();
        let keys =
            [(64, 48), (64, 48), (96, 64), (95, 64), (96, 64)].map(|(w, h)| encoder.encode(&grey(w, h)).map(|one| one.key).ok());
        assert_eq!(keys, [Some(true), Some(false), Some(true), None, Some(true)], "each size starts with a key frame");
    }
}
