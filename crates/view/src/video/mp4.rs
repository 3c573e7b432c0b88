//! MP4 file written as pictures arrive: media data first, index at the end.

use super::{EncodedPicture, VideoError};
use shiguredo_mp4::boxes::{Avc1Box, AvccBox, SampleEntry, VisualSampleEntryFields};
use shiguredo_mp4::mux::{Mp4FileMuxer, Sample};
use shiguredo_mp4::{TrackKind, Uint};
use std::num::NonZeroU32;

/// Ticks per second of the file's time base.
const TICKS_PER_S: u32 = 90_000;
/// NAL unit types (H.264, table 7-1).
const SPS: u8 = 7;
const PPS: u8 = 8;

/// Bytes to write at an offset in the file.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Mp4Chunk {
    /// Offset in the file, bytes.
    pub at: u64,
    /// Bytes to write at the offset.
    pub bytes: Vec<u8>,
}

/// An MP4 file in progress.
pub struct Mp4Writer {
    muxer: Mp4FileMuxer,
    size_px: (u32, u32),
    track_started: bool,
    end: u64,
    ticks: u64,
    pictures: u64,
    rate_hz: f64,
}

impl Mp4Writer {
    /// Creates a file for pictures of a fixed size and rate (Hz). Returns it with the first bytes to write.
    ///
    /// # Errors
    /// Returns an error if the file format cannot represent the size or rate.
    pub fn new(size_px: (u32, u32), rate_hz: f64) -> Result<(Self, Mp4Chunk), VideoError> {
        let muxer = Mp4FileMuxer::new().map_err(|error| VideoError::File(error.to_string()))?;
        let head = muxer.initial_boxes_bytes().to_vec();
        let end = head.len() as u64;
        let file = Self { muxer, size_px, track_started: false, end, ticks: 0, pictures: 0, rate_hz };
        Ok((file, Mp4Chunk { at: 0, bytes: head }))
    }

    /// Adds a picture.
    ///
    /// # Errors
    /// Returns an error if the file format cannot represent the picture.
    pub fn push(&mut self, encoded: &EncodedPicture) -> Result<Mp4Chunk, VideoError> {
        let mut bytes = Vec::new();
        for unit in encoded.units.iter().filter(|unit| !is_parameter(unit)) {
            bytes.extend((unit.len() as u32).to_be_bytes());
            bytes.extend(unit);
        }
        self.pictures += 1;
        // Uses integer ticks without drift: picture n ends at n / rate.
        let until = (self.pictures as f64 / self.rate_hz * f64::from(TICKS_PER_S)).round() as u64;
        let sample = Sample {
            track_kind: TrackKind::Video,
            sample_entry: (!self.track_started).then(|| sample_entry(&encoded.units, self.size_px)).transpose()?,
            keyframe: encoded.key,
            timescale: NonZeroU32::new(TICKS_PER_S).unwrap_or(NonZeroU32::MIN),
            duration: (until - self.ticks) as u32,
            composition_time_offset: None,
            data_offset: self.end,
            data_size: bytes.len(),
        };
        self.muxer.append_sample(&sample).map_err(|error| VideoError::File(error.to_string()))?;
        (self.track_started, self.ticks) = (true, until);
        let piece = Mp4Chunk { at: self.end, bytes };
        self.end += piece.bytes.len() as u64;
        Ok(piece)
    }

    /// Returns the chunks that contain the index and complete the file.
    ///
    /// # Errors
    /// Returns an error if the index cannot be built.
    pub fn finish(mut self) -> Result<Vec<Mp4Chunk>, VideoError> {
        let closed = self.muxer.finalize().map_err(|error| VideoError::File(error.to_string()))?;
        Ok(closed.offset_and_bytes_pairs().map(|(at, bytes)| Mp4Chunk { at, bytes: bytes.to_vec() }).collect())
    }
}

fn kind(unit: &[u8]) -> u8 {
    unit.first().map_or(0, |head| head & 0x1F)
}

fn is_parameter(unit: &[u8]) -> bool {
    matches!(kind(unit), SPS | PPS)
}

/// Returns the decoder configuration that a player needs before the first picture.
fn sample_entry(units: &[Vec<u8>], (width, height): (u32, u32)) -> Result<SampleEntry, VideoError> {
    let of = |wanted: u8| units.iter().filter(|unit| kind(unit) == wanted).cloned().collect::<Vec<_>>();
    let (sps_list, pps_list) = (of(SPS), of(PPS));
    let Some([_, profile, compatibility, level, ..]) = sps_list.first().map(Vec::as_slice) else {
        return Err(VideoError::File("the first picture has no parameter sets".into()));
    };
    let side = |px: u32| u16::try_from(px).map_err(|_| VideoError::File(format!("{px} px is too large")));
    Ok(SampleEntry::Avc1(Avc1Box {
        visual: VisualSampleEntryFields {
            data_reference_index: VisualSampleEntryFields::DEFAULT_DATA_REFERENCE_INDEX,
            width: side(width)?,
            height: side(height)?,
            horizresolution: VisualSampleEntryFields::DEFAULT_HORIZRESOLUTION,
            vertresolution: VisualSampleEntryFields::DEFAULT_VERTRESOLUTION,
            frame_count: VisualSampleEntryFields::DEFAULT_FRAME_COUNT,
            compressorname: VisualSampleEntryFields::NULL_COMPRESSORNAME,
            depth: VisualSampleEntryFields::DEFAULT_DEPTH,
        },
        avcc_box: AvccBox {
            avc_profile_indication: *profile,
            profile_compatibility: *compatibility,
            avc_level_indication: *level,
            length_size_minus_one: Uint::new(3),
            sps_list,
            pps_list,
            chroma_format: None,
            bit_depth_luma_minus8: None,
            bit_depth_chroma_minus8: None,
            sps_ext_list: Vec::new(),
        },
        unknown_boxes: Vec::new(),
    }))
}
