//! Reads a telemetry log in chunks, which bounds memory use for logs of any length.

use super::sample::FrameHeader;
use super::tlog::{TIMESTAMP_LEN, TlogReader, TlogRecord, record_at};
use std::ops::ControlFlow;

/// Maximum length of a record: timestamp and a MAVLink 2 frame with maximum payload and signature (MAVLink guide,
/// "Serialization").
const MAX_RECORD_LEN: usize = TIMESTAMP_LEN + 10 + 255 + 2 + 13;

/// A telemetry log that can be read repeatedly.
pub trait TelemetryLog {
    /// Calls `take` with each complete record, in file order, until `take` returns `Break` or the log ends.
    ///
    /// # Errors
    /// Fails if the log cannot be read.
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

/// Returns whether the log contains at least one known message with a valid checksum.
///
/// # Errors
/// Fails if the log cannot be read.
pub fn contains_messages(log: &(impl TelemetryLog + ?Sized)) -> std::io::Result<bool> {
    let mut found = false;
    log.for_each_record(&mut |record| {
        found = FrameHeader::has_valid_checksum(record.frame);
        if found { ControlFlow::Break(()) } else { ControlFlow::Continue(()) }
    })?;
    Ok(found)
}

/// Splits chunks of a log into records, with the same rules as [`TlogReader`].
#[derive(Debug, Clone, Default)]
pub struct RecordSplitter {
    bytes: Vec<u8>,
    at: usize,
    /// Number of log bytes before `bytes`.
    before: u64,
    complete_bytes: u64,
    /// Whether the splitter is searching for the next record with a valid checksum after corrupt data.
    searching: bool,
}

impl RecordSplitter {
    /// Appends a chunk and calls `take` with the records that are known to be complete.
    pub fn feed(&mut self, piece: &[u8], take: &mut dyn FnMut(TlogRecord<'_>) -> ControlFlow<()>) -> ControlFlow<()> {
        self.bytes.drain(..self.at);
        self.before += self.at as u64;
        self.at = 0;
        self.bytes.extend_from_slice(piece);
        self.split(MAX_RECORD_LEN, take)
    }

    /// Calls `take` with the remaining records after the last chunk.
    pub fn end(&mut self, take: &mut dyn FnMut(TlogRecord<'_>) -> ControlFlow<()>) -> ControlFlow<()> {
        self.split(1, take)
    }

    /// Returns the log length in bytes, up to the end of the last complete record read so far.
    #[must_use]
    pub fn complete_bytes(&self) -> u64 {
        self.complete_bytes
    }

    /// Splits while at least `least` bytes remain. A shorter remainder might continue in the next chunk.
    fn split(&mut self, least: usize, take: &mut dyn FnMut(TlogRecord<'_>) -> ControlFlow<()>) -> ControlFlow<()> {
        let Self { bytes, at, before, complete_bytes, searching } = self;
        while bytes.len() - *at >= least {
            let good = if *searching { FrameHeader::has_valid_checksum } else { FrameHeader::is_plausible };
            match record_at(bytes, *at).filter(|(record, _)| good(record.frame)) {
                Some((record, end)) => {
                    *at = end;
                    *complete_bytes = *before + end as u64;
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
