//! Moving pictures: H.264, alone in RTP packets or with chapters in an MP4 file. Bytes only; who sends and writes them is elsewhere.

mod h264;
mod mp4;
mod rate;
pub mod rtp;
pub mod webvtt;

pub use h264::{EncodedPicture, H264Encoder};
pub use mp4::{Mp4Chunk, Mp4Writer};
pub use rate::PictureRate;

/// Why there is no video.
#[derive(Debug, Clone, PartialEq, Eq, thiserror::Error)]
pub enum VideoError {
    /// The encoder will not.
    #[error("the video encoder refuses: {0}")]
    Encoder(String),
    /// The file's structure will not hold it.
    #[error("the video file cannot be written: {0}")]
    File(String),
}

#[cfg(test)]
mod tests;
