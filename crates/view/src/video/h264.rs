//! H.264 encoding with Cisco's OpenH264.

use super::VideoError;
use crate::picture::Picture;
use openh264::OpenH264API;
use openh264::encoder::{BitRate, EncoderConfig, FrameRate, FrameType, IntraFramePeriod, RateControlMode, UsageType, VuiConfig};
use openh264::formats::{RgbaSliceU8, YUVBuffer};

/// An encoded picture.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct EncodedPicture {
    /// Network abstraction layer (NAL) units without start codes.
    pub units: Vec<Vec<u8>>,
    /// Whether it is a key frame, decodable without earlier pictures.
    pub key: bool,
}

/// Encodes pictures of a fixed size to H.264.
pub struct H264Encoder {
    encoder: openh264::encoder::Encoder,
    size_px: (u32, u32),
}

impl H264Encoder {
    /// Creates an encoder for the given picture size (px, even), picture rate (Hz), and bit rate (bit/s). Every
    /// `key_every`-th picture is a key frame.
    ///
    /// # Errors
    /// Returns an error if the encoder rejects the parameters.
    pub fn new(size_px: (u32, u32), rate_hz: f64, bits_s: u32, key_every: u32) -> Result<Self, VideoError> {
        if size_px.0 % 2 == 1 || size_px.1 % 2 == 1 {
            return Err(VideoError::Encoder(format!("{} x {} px: width and height must be even", size_px.0, size_px.1)));
        }
        let config = EncoderConfig::new()
            .bitrate(BitRate::from_bps(bits_s))
            .max_frame_rate(FrameRate::from_hz(rate_hz as f32))
            .rate_control_mode(RateControlMode::Bitrate)
            .usage_type(UsageType::CameraVideoRealTime)
            .intra_frame_period(IntraFramePeriod::from_num_frames(key_every))
            // Does not skip frames, because reviewers may need the one that shows the defect.
            .skip_frames(false)
            .vui(VuiConfig::bt601());
        let refused = |error: openh264::Error| VideoError::Encoder(error.to_string());
        let encoder = openh264::encoder::Encoder::with_api_config(OpenH264API::from_source(), config).map_err(refused)?;
        Ok(Self { encoder, size_px })
    }

    /// Encodes the next picture.
    ///
    /// # Errors
    /// Returns an error if the picture's size differs from the encoder's, or if the encoder fails.
    pub fn encode(&mut self, picture: &Picture) -> Result<EncodedPicture, VideoError> {
        if (picture.width, picture.height) != self.size_px {
            return Err(VideoError::Encoder("picture size differs from the video size".into()));
        }
        let source = RgbaSliceU8::new(&picture.rgba, (picture.width as usize, picture.height as usize));
        let yuv = YUVBuffer::from_rgba8_source(source);
        let stream = self.encoder.encode(&yuv).map_err(|error| VideoError::Encoder(error.to_string()))?;
        let layers = (0..stream.num_layers()).filter_map(|k| stream.layer(k));
        let mut units = Vec::new();
        for layer in layers {
            units.extend((0..layer.nal_count()).filter_map(|k| layer.nal_unit(k)).map(|unit| without_start_code(unit).to_vec()));
        }
        Ok(EncodedPicture { units, key: matches!(stream.frame_type(), FrameType::IDR | FrameType::I) })
    }
}

/// Returns a NAL unit without its start code. Annex B units start with 00 00 01 or 00 00 00 01.
fn without_start_code(unit: &[u8]) -> &[u8] {
    unit.strip_prefix(&[0, 0, 0, 1]).or_else(|| unit.strip_prefix(&[0, 0, 1])).unwrap_or(unit)
}
