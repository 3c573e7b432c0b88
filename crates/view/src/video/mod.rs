//! Video: H.264 in RTP packets, or in an MP4 file with chapters. This module only produces bytes; the caller sends or
//! writes them.

mod h264;
mod mp4;
mod rate;
pub mod rtp;
pub mod webvtt;

pub use h264::{EncodedPicture, H264Encoder};
pub use mp4::{Mp4Chunk, Mp4Writer};
pub use rate::PictureRate;

/// Errors that occur when video is encoded or written.
#[derive(Debug, Clone, PartialEq, Eq, thiserror::Error)]
pub enum VideoError {
    /// The encoder rejected the input or failed.
    #[error("the video encoder failed: {0}")]
    Encoder(String),
    /// The file format cannot represent the data.
    #[error("cannot write the video file: {0}")]
    File(String),
}

#[cfg(test)]
mod tests;
