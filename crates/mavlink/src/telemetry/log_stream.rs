//! A telemetry log that arrives in pieces: a log of any length is read in bounded memory.

use super::sample::FrameHeader;
use super::tlog::{STAMP_BYTES, TlogReader, TlogRecord, record_at};
use std::ops::ControlFlow;

/// Longest record: stamp, and a MAVLink 2 frame with the largest payload and a signature (MAVLink guide, "Serialization").
const RECORD_MOST: usize = STAMP_BYTES + 10 + 255 + 2 + 13;

/// A telemetry log that can be read more than once.
pub trait TelemetryLog {
    /// Calls `take` with each whole record in file order, until it breaks or the log ends.
    ///
    /// # Errors
    /// When the log cannot be read.
    fn for_each_record(&self, take: &mut dyn FnMut(TlogRecord<'_>) -> ControlFlow<()>) -> std::io::Result<()>;
}

impl TelemetryLog for [u8] {
    fn for_each_record(&self, take: &mut dyn FnMut(TlogRecord<'_>) -> ControlFlow<()>) -> std::io::Result<()> {
        let _ = TlogReader::new(self).try_for_each(take);
        Ok(())
    }
}

impl TelemetryLog for Vec<u8> {
    fn for_each_record(&self, take: &mut dyn FnMut(TlogRecord<'_>) -> ControlFlow<()>) -> std::io::Result<()> {
        self.as_slice().for_each_record(take)
    }
}

/// Splits pieces of a log into records, by the same rules as [`TlogReader`].
#[derive(Debug, Clone, Default)]
pub struct RecordSplitter {
    bytes: Vec<u8>,
    at: usize,
    /// Bytes of the log before `bytes`.
    before: u64,
    end_of_whole: u64,
    /// Damage was met: the next record is the next one with a right checksum.
    searching: bool,
}

impl RecordSplitter {
    /// Takes the next piece and hands out the records that it completes.
    pub fn feed(&mut self, piece: &[u8], take: &mut dyn FnMut(TlogRecord<'_>) -> ControlFlow<()>) -> ControlFlow<()> {
        self.bytes.drain(..self.at);
        self.before += self.at as u64;
        self.at = 0;
        self.bytes.extend_from_slice(piece);
        self.split(RECORD_MOST, take)
    }

    /// Hands out the last records: the log has ended.
    pub fn end(&mut self, take: &mut dyn FnMut(TlogRecord<'_>) -> ControlFlow<()>) -> ControlFlow<()> {
        self.split(1, take)
    }

    /// Length of the log up to the end of its last whole record so far, bytes.
    #[must_use]
    pub fn end_of_whole(&self) -> u64 {
        self.end_of_whole
    }

    /// Splits while `least` bytes are left: with fewer a record might go on in the next piece.
    fn split(&mut self, least: usize, take: &mut dyn FnMut(TlogRecord<'_>) -> ControlFlow<()>) -> ControlFlow<()> {
        let Self { bytes, at, before, end_of_whole, searching } = self;
        while bytes.len() - *at >= least {
            let good = if *searching { FrameHeader::verified } else { FrameHeader::is_plausible };
            match record_at(bytes, *at).filter(|(record, _)| good(record.frame)) {
                Some((record, end)) => {
                    *at = end;
                    *end_of_whole = *before + end as u64;
                    *searching = false;
                    take(record)?;
                }
                None => {
                    *searching = true;
                    *at += 1;
                }
            }
        }
        ControlFlow::Continue(())
    }
}
