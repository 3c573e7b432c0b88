//! The camera's view as H.264 over RTP, encoded and sent in a thread of its own: a slow network or encoder costs pictures of the stream, none
//! of the window.

use crate::app::clock::Stopwatch;
use crate::app::errors::AppError;
use crate::app::net::Hub;
use crate::view::live::Video;
use crate::view::picture::Picture;
use crate::view::video::Encoder;
use crate::view::video::rtp::Packets;
use std::net::{IpAddr, SocketAddr};
use std::sync::mpsc::{Receiver, SyncSender, sync_channel};
use std::time::Duration;

/// Bits for a pixel of a picture (estimate: 720p25 then has 2 Mbit/s, which wireless networks carry).
const BITS_PX: f64 = 0.1;
/// A receiver that begins in the middle waits this many pictures at most.
const KEY_EVERY: u32 = 25;
/// The rate is measured over this much wall time.
const MEASURED_OVER: Duration = Duration::from_secs(2);

/// A stream of pictures to somebody.
pub struct Stream {
    pictures: SyncSender<Picture>,
    rate_hz: f64,
    since: Stopwatch,
    count: u32,
}

impl Stream {
    /// Opens a stream to a receiver.
    ///
    /// # Errors
    /// When no socket can be opened.
    pub fn open(listen: IpAddr, to: SocketAddr) -> Result<Self, AppError> {
        let mut hub = Hub::new();
        let socket = hub.bind(listen, 0, "--listen")?;
        // One waits while one is encoded; a third comes too late to be worth it.
        let (pictures, wanted) = sync_channel(1);
        std::thread::spawn(move || send(&wanted, |packet| hub.send(socket, to, packet)));
        Ok(Self { pictures, rate_hz: 0.0, since: Stopwatch::start(), count: 0 })
    }

    /// Hands a picture on, if the encoder has time for it, and says what the stream is like.
    pub fn push(&mut self, picture: Picture) -> Video {
        let (width_px, height_px) = (picture.width, picture.height);
        self.count += u32::from(self.pictures.try_send(picture).is_ok());
        let elapsed = self.since.elapsed();
        if elapsed >= MEASURED_OVER {
            self.rate_hz = f64::from(self.count) / elapsed.as_secs_f64();
            (self.count, self.since) = (0, Stopwatch::start());
        }
        Video { width_px, height_px, rate_hz: self.rate_hz, bits_s: bits_s((width_px, height_px)) }
    }
}

fn bits_s((width, height): (u32, u32)) -> u32 {
    (BITS_PX * f64::from(width) * f64::from(height) * f64::from(KEY_EVERY)) as u32
}

/// Encodes and sends until the window is closed.
fn send(wanted: &Receiver<Picture>, mut out: impl FnMut(&[u8])) {
    let (watch, mut packets) = (Stopwatch::start(), Packets::new(u32::from_be_bytes(*b"span")));
    let mut encoder: Option<(Encoder, (u32, u32))> = None;
    while let Ok(picture) = wanted.recv() {
        let size = (picture.width, picture.height);
        if encoder.as_ref().is_none_or(|(_, of)| *of != size) {
            encoder = Encoder::new(size, f64::from(KEY_EVERY), bits_s(size), KEY_EVERY)
                .inspect_err(|error| tracing::warn!("no stream: {error}"))
                .ok()
                .map(|made| (made, size));
        }
        let Some((encoder, _)) = &mut encoder else { continue };
        match encoder.encode(&picture) {
            Ok(encoded) => {
                for packet in packets.picture(&encoded.units, watch.elapsed().as_secs_f64()) {
                    out(&packet);
                }
            }
            Err(error) => tracing::warn!("a picture is missing in the stream: {error}"),
        }
    }
}
