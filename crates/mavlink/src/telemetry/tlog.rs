//! The telemetry log: one record per MAVLink frame. A record consists of an 8-byte big-endian timestamp, µs since the Unix epoch,
//! and the unmodified frame. QGroundControl, Mission Planner and MAVProxy use the same format.
//!
//! A file may end at any byte, for example if the monitor was killed. All complete records are read, and the rest is
//! ignored. Corrupt data affects only the records that contain it.

use super::sample::FrameHeader;

/// Length of the timestamp before each frame, bytes.
pub const TIMESTAMP_LEN: usize = 8;

/// A record in a telemetry log.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct TlogRecord<'a> {
    /// Timestamp: session start plus simulation time, µs since the Unix epoch.
    pub timestamp_us: u64,
    /// MAVLink frame as received.
    pub frame: &'a [u8],
}

/// Encodes a record.
#[must_use]
pub fn record(timestamp_us: u64, frame: &[u8]) -> Vec<u8> {
    let mut bytes = Vec::with_capacity(TIMESTAMP_LEN + frame.len());
    bytes.extend_from_slice(&timestamp_us.to_be_bytes());
    bytes.extend_from_slice(frame);
    bytes
}

/// Reads the complete records of a log in file order.
#[derive(Debug, Clone)]
pub struct TlogReader<'a> {
    bytes: &'a [u8],
    at: usize,
    complete_bytes: usize,
    skipped: usize,
}

impl<'a> TlogReader<'a> {
    /// Creates a reader at the start of `bytes`.
    #[must_use]
    pub fn new(bytes: &'a [u8]) -> Self {
        Self { bytes, at: 0, complete_bytes: 0, skipped: 0 }
    }

    /// Returns the log length in bytes, up to the end of the last complete record read so far. A restarted monitor
    /// truncates the file to this length and continues.
    #[must_use]
    pub fn complete_bytes(&self) -> usize {
        self.complete_bytes
    }

    /// Returns the number of bytes read so far that are not part of any record.
    #[must_use]
    pub fn skipped(&self) -> usize {
        self.skipped
    }

    fn record_at(&self, at: usize) -> Option<(TlogRecord<'a>, usize)> {
        record_at(self.bytes, at)
    }

    /// Returns the offset of the next record after the current position with a valid checksum.
    fn resynchronize(&self) -> Option<usize> {
        (self.at + 1..self.bytes.len())
            .find(|at| self.record_at(*at).is_some_and(|(record, _)| FrameHeader::has_valid_checksum(record.frame)))
    }
}

/// Parses the record at offset `at`. Returns the record and its end offset.
pub(super) fn record_at(bytes: &[u8], at: usize) -> Option<(TlogRecord<'_>, usize)> {
    let stamp = bytes.get(at..at + TIMESTAMP_LEN)?;
    let rest = &bytes[at + TIMESTAMP_LEN..];
    let header = FrameHeader::peek(rest)?;
    let frame = rest.get(..header.total)?;
    let timestamp_us = stamp.iter().fold(0u64, |sum, byte| sum << 8 | u64::from(*byte));
    Some((TlogRecord { timestamp_us, frame }, at + TIMESTAMP_LEN + header.total))
}

impl<'a> Iterator for TlogReader<'a> {
    type Item = TlogRecord<'a>;

    fn next(&mut self) -> Option<TlogRecord<'a>> {
        if self.record_at(self.at).is_none() {
            let next = self.resynchronize()?;
            self.skipped += next - self.at;
            self.at = next;
        }
        let (record, end) = self.record_at(self.at)?;
        // After a corrupt length, a byte inside a record can look like the start of a frame. For known messages, the
        // checksum detects this.
        if !FrameHeader::is_plausible(record.frame) {
            let next = self.resynchronize()?;
            self.skipped += next - self.at;
            self.at = next;
            return self.next();
        }
        self.at = end;
        self.complete_bytes = end;
        Some(record)
    }
}

/// Returns the length of a log in bytes, up to the end of its last complete record. Truncate the file to this length
/// before appending to it.
#[must_use]
pub fn complete_len(bytes: &[u8]) -> usize {
    let mut reader = TlogReader::new(bytes);
    while reader.next().is_some() {}
    reader.complete_bytes()
}

/// Returns the Unix time of a log's first record in µs; `None` for an empty log.
#[must_use]
pub fn session_start_us(bytes: &[u8]) -> Option<u64> {
    TlogReader::new(bytes).next().map(|first| first.timestamp_us)
}

/// Returns the Unix time of simulation time zero in µs: the timestamp of the first truth message minus its simulation
/// time. `None` for a log without truth messages.
#[must_use]
pub fn simulation_zero_us(bytes: &[u8]) -> Option<u64> {
    TlogReader::new(bytes).find_map(|record| record_simulation_zero_us(&record))
}

/// Returns the Unix time of simulation time zero in µs, calculated from a single record: its timestamp minus its
/// simulation time. `None` if the record is not a truth message.
#[must_use]
pub fn record_simulation_zero_us(record: &TlogRecord<'_>) -> Option<u64> {
    let time = super::sample::truth_time(record.frame)?;
    Some(record.timestamp_us.saturating_sub(u64::try_from(time.us()).unwrap_or(0)))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::codec::Encoder;
    use crate::dialect::{HEARTBEAT_DATA, MavMessage};

    fn log(records: usize) -> (Vec<u8>, Vec<usize>) {
        let mut encoder = Encoder::new(1, 1);
        let mut bytes = Vec::new();
        let mut ends = vec![0];
        for k in 0..records {
            let message = MavMessage::HEARTBEAT(HEARTBEAT_DATA { custom_mode: 7 + k as u32, ..HEARTBEAT_DATA::default() });
            bytes.extend(record(1_000 + k as u64, &encoder.encode(&message)));
            ends.push(bytes.len());
        }
        (bytes, ends)
    }

    #[test]
    fn exact_truncated_log_keeps_complete_records() {
        let (bytes, ends) = log(6);
        for cut in 0..=bytes.len() {
            let whole = ends.iter().rposition(|end| *end <= cut).unwrap();
            assert_eq!(TlogReader::new(&bytes[..cut]).count(), whole, "cut at {cut}");
            assert_eq!(complete_len(&bytes[..cut]), ends[whole], "cut at {cut}");
        }
    }

    #[test]
    fn exact_corruption_loses_only_the_damaged_record() {
        let (bytes, ends) = log(6);
        for at in ends[2]..ends[3] {
            let mut damaged = bytes.clone();
            damaged[at] ^= 0xFF;
            let read = TlogReader::new(&damaged).count();
            assert!(read >= 5, "byte {at}: {read} records");
        }
    }

    #[test]
    fn exact_timestamps_round_trip() {
        let (bytes, _) = log(3);
        assert_eq!(TlogReader::new(&bytes).map(|r| r.timestamp_us).collect::<Vec<_>>(), [1_000, 1_001, 1_002]);
        assert_eq!(session_start_us(&bytes), Some(1_000));
    }
}
