//! The camera's view as H.264 over RTP, encoded and sent in a thread of its own: a slow network or encoder costs pictures of the stream, none
//! of the window.

use crate::app::clock::Stopwatch;
use crate::app::errors::AppError;
use crate::base::time::SimTime;
use crate::view::live::Video;
use crate::view::picture::Picture;
use crate::view::video::rtp::Packets;
use crate::view::video::{Encoder, Rate};
use std::net::{Ipv4Addr, Ipv6Addr, SocketAddr, UdpSocket};
use std::sync::mpsc::{Receiver, SyncSender, sync_channel};
use std::thread::JoinHandle;
use std::time::Duration;

/// Bits for a pixel of a picture (estimate: 720p25 then has 2 Mbit/s, which wireless networks carry).
const BITS_PX: f64 = 0.1;
/// A receiver that begins in the middle waits this many pictures at most.
const KEY_EVERY: u32 = 25;
/// Least time between two pictures: 30 a second, as drones' cameras send (domain.md 3); a window may be drawn more often.
const LEAST: Duration = Duration::from_nanos(33_000_000);

/// A stream of pictures to somebody.
pub struct Stream {
    /// Taken when the stream ends.
    pictures: Option<SyncSender<Picture>>,
    sender: Option<JoinHandle<Sent>>,
    watch: Stopwatch,
    rate: Rate,
    last: Option<Stopwatch>,
}

/// What went out.
#[derive(Debug, Clone, Copy, Default)]
struct Sent {
    pictures: u64,
    /// Wall time of encoding, all pictures together.
    encoding: Duration,
}

impl Stream {
    /// Opens a stream to a receiver.
    ///
    /// # Errors
    /// When no socket can be opened, or nothing leads to the receiver.
    pub fn open(to: SocketAddr) -> Result<Self, AppError> {
        let socket = socket(to).map_err(|error| AppError::failed(format!("--stream {to}: {error}")))?;
        // One waits while one is encoded; a third comes too late to be worth it.
        let (pictures, wanted) = sync_channel(1);
        let sender = std::thread::spawn(move || send(&wanted, &socket, to));
        Ok(Self { pictures: Some(pictures), sender: Some(sender), watch: Stopwatch::start(), rate: Rate::default(), last: None })
    }

    /// Whether it is time for another picture.
    pub fn is_due(&self) -> bool {
        self.last.is_none_or(|last| last.elapsed() >= LEAST)
    }

    /// Hands a picture on, if the encoder has time for it, and says what the stream is like, once there is more than one picture of it.
    pub fn push(&mut self, picture: Picture) -> Option<Video> {
        let (width_px, height_px) = (picture.width, picture.height);
        self.last = Some(Stopwatch::start());
        if self.pictures.as_ref().is_some_and(|pictures| pictures.try_send(picture).is_ok()) {
            self.rate.count(SimTime::from_s(self.watch.elapsed().as_secs_f64()));
        }
        Some(Video { width_px, height_px, rate_hz: self.rate.hz()?, bits_s: bits_s((width_px, height_px)) })
    }
}

impl Drop for Stream {
    fn drop(&mut self) {
        drop(self.pictures.take());
        // A sender that panicked has nothing to tell.
        if let Some(Ok(sent)) = self.sender.take().map(JoinHandle::join) {
            let each_ms = 1e3 * sent.encoding.as_secs_f64() / (sent.pictures.max(1) as f64);
            tracing::info!("{} pictures streamed, encoded in {each_ms:.1} ms each", sent.pictures);
        }
    }
}

/// A socket that only sends, and only there.
fn socket(to: SocketAddr) -> std::io::Result<UdpSocket> {
    let any =
        if to.is_ipv4() { SocketAddr::from((Ipv4Addr::UNSPECIFIED, 0)) } else { SocketAddr::from((Ipv6Addr::UNSPECIFIED, 0)) };
    let socket = UdpSocket::bind(any)?;
    socket.connect(to)?;
    Ok(socket)
}

fn bits_s((width, height): (u32, u32)) -> u32 {
    (BITS_PX * f64::from(width) * f64::from(height) * f64::from(KEY_EVERY)) as u32
}

/// Encodes and sends until the window is closed.
fn send(wanted: &Receiver<Picture>, socket: &UdpSocket, to: SocketAddr) -> Sent {
    let (watch, mut packets) = (Stopwatch::start(), Packets::new(u32::from_be_bytes(*b"span")));
    let mut encoder: Option<(Encoder, (u32, u32))> = None;
    let (mut sent, mut told) = (Sent::default(), false);
    while let Ok(picture) = wanted.recv() {
        let (began, size) = (Stopwatch::start(), (picture.width, picture.height));
        if encoder.as_ref().is_none_or(|(_, of)| *of != size) {
            encoder = Encoder::new(size, f64::from(KEY_EVERY), bits_s(size), KEY_EVERY)
                .inspect_err(|error| tracing::warn!("no stream: {error}"))
                .ok()
                .map(|made| (made, size));
        }
        let Some((encoder, _)) = &mut encoder else { continue };
        let encoded = match encoder.encode(&picture) {
            Ok(encoded) => encoded,
            Err(error) => {
                tracing::warn!("a picture is missing in the stream: {error}");
                continue;
            }
        };
        sent.encoding += began.elapsed();
        sent.pictures += u64::from(!encoded.units.is_empty());
        for packet in packets.picture(&encoded.units, watch.elapsed().as_secs_f64()) {
            // Nobody listens yet: a player may come later.
            if let Err(error) = socket.send(&packet)
                && error.kind() != std::io::ErrorKind::ConnectionRefused
                && !told
            {
                told = true;
                tracing::warn!("the stream to {to} loses packets: {error}");
            }
        }
    }
    sent
}
