//! MCAP recordings, and the recovery of truncated ones.
//!
//! The program writes a complete chunk after every 16 KiB or one second of flight; if it is killed, only the last chunk
//! is lost. A file without a footer can be read up to its last complete chunk.

use base64::Engine;
use base64::engine::general_purpose::STANDARD;
use mcap::records::MessageHeader;
use mcap::{MAGIC, McapError, McapResult, MessageStream, WriteOptions, Writer};
use spandrel_model::foxglove::{CHANNELS, ChannelMessage};
use std::collections::BTreeMap;
use std::io::{Seek, Write};

/// Chunk size, bytes.
const CHUNK_BYTES: u64 = 16 * 1024;
/// Maximum flight time per chunk, ns.
const FLUSH_INTERVAL_NS: u64 = 1_000_000_000;

fn options() -> WriteOptions {
    // Without seeking, the library writes a chunk only once its length is known.
    WriteOptions::new().compression(None).library("spandrel").chunk_size(Some(CHUNK_BYTES)).disable_seeking(true)
}

/// An unfinished recording.
pub struct McapRecording<W: Write + Seek> {
    writer: Writer<W>,
    channels: Vec<u16>,
    sequences: Vec<u32>,
    last_flush_ns: u64,
}

impl<W: Write + Seek> std::fmt::Debug for McapRecording<W> {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.debug_struct("Recording").field("sequences", &self.sequences).finish_non_exhaustive()
    }
}

impl<W: Write + Seek> McapRecording<W> {
    /// Starts a file and writes all schemas and channels.
    ///
    /// # Errors
    /// Returns an error if the disk cannot be written.
    pub fn begin(to: W) -> McapResult<Self> {
        let mut writer = options().create(to)?;
        let mut channels = Vec::new();
        for channel in &CHANNELS {
            let schema = writer.add_schema(channel.schema, "jsonschema", channel.json_schema().as_bytes())?;
            channels.push(writer.add_channel(schema, channel.topic, "json", &BTreeMap::new())?);
        }
        Ok(Self { writer, channels, sequences: vec![0; CHANNELS.len()], last_flush_ns: 0 })
    }

    /// Adds a message.
    ///
    /// # Errors
    /// Returns an error if the disk cannot be written.
    pub fn write(&mut self, message: &ChannelMessage) -> McapResult<()> {
        let topic = message.topic as usize;
        let at = message.unix_ns;
        let header =
            MessageHeader { channel_id: self.channels[topic], sequence: self.sequences[topic], log_time: at, publish_time: at };
        self.sequences[topic] = self.sequences[topic].wrapping_add(1);
        self.writer.write_to_known_channel(&header, message.json.as_bytes())?;
        if at.saturating_sub(self.last_flush_ns) >= FLUSH_INTERVAL_NS {
            self.last_flush_ns = at;
            self.writer.flush()?;
        }
        Ok(())
    }

    /// Writes the file's index and footer.
    ///
    /// # Errors
    /// Returns an error if the disk cannot be written.
    pub fn end(mut self) -> McapResult<W> {
        self.writer.finish()?;
        Ok(self.writer.into_inner())
    }
}

/// Encodes bytes as base64.
#[must_use]
pub fn base64(bytes: &[u8]) -> String {
    STANDARD.encode(bytes)
}

/// Recovery result.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct RecoveryResult {
    /// The complete recovered file.
    pub bytes: Vec<u8>,
    /// Number of messages in the file.
    pub messages: usize,
    /// Reason why reading stopped, if the file was truncated.
    pub truncation_reason: Option<String>,
}

/// Reads as much of a file as possible and rewrites that part with an index and a footer.
///
/// # Errors
/// Returns an error if it is not an MCAP file.
pub fn recover(file: &[u8]) -> McapResult<RecoveryResult> {
    if !file.starts_with(MAGIC) {
        return Err(McapError::BadMagic);
    }
    let mut writer = options().create(std::io::Cursor::new(Vec::new()))?;
    let mut messages = 0;
    let mut truncation_reason = None;
    for message in MessageStream::new_with_options(file, mcap::read::Options::IgnoreEndMagic.into())? {
        match message {
            Ok(message) => {
                writer.write(&message)?;
                messages += 1;
            }
            Err(error) => {
                truncation_reason = Some(error.to_string());
                break;
            }
        }
    }
    writer.finish()?;
    Ok(RecoveryResult { bytes: writer.into_inner().into_inner(), messages, truncation_reason })
}

#[cfg(test)]
mod tests {
    use super::*;
    use spandrel_model::foxglove;
    use std::io::Cursor;

    const START_NS: u64 = 1_700_000_000_000_000_000;
    const STEP_NS: u64 = 10_000_000;

    fn recorded(messages: u64) -> Vec<u8> {
        let mut recording = McapRecording::begin(Cursor::new(Vec::new())).unwrap();
        for k in 0..messages {
            recording.write(&foxglove::log(START_NS + k * STEP_NS, 6, &format!("message {k}"))).unwrap();
        }
        recording.end().unwrap().into_inner()
    }

    fn status_texts(file: &[u8]) -> Vec<String> {
        let text = |m: mcap::Message| {
            serde_json::from_slice::<serde_json::Value>(&m.data).unwrap()["message"].as_str().unwrap().to_owned()
        };
        MessageStream::new(file).unwrap().map(|m| text(m.unwrap())).collect()
    }

    #[test]
    fn exact_recordings_round_trip_with_an_index() {
        let file = recorded(2_000);
        let expected: Vec<_> = (0..2_000).map(|k| format!("message {k}")).collect();
        assert_eq!(status_texts(&file), expected);
        let summary = mcap::Summary::read(&file).unwrap().unwrap();
        assert_eq!(summary.stats.unwrap().message_count, 2_000);
        assert!(summary.chunk_indexes.len() >= 20, "small chunks: {}", summary.chunk_indexes.len());
        assert_eq!(recover(&file).unwrap().truncation_reason, None);
    }

    /// No matter where the file is truncated, only the chunk that was being written is lost.
    #[test]
    fn exact_truncated_files_are_recovered_to_the_last_complete_chunk() {
        let file = recorded(600);
        let summary = mcap::Summary::read(&file).unwrap().unwrap();
        let count = |chunk| summary.stream_chunk(&file, chunk).unwrap().count();
        let chunks: Vec<_> =
            summary.chunk_indexes.iter().map(|c| ((c.chunk_start_offset + c.chunk_length) as usize, count(c))).collect();
        let last = chunks.last().unwrap().0;
        for cut in (0..last + 40).step_by(997).chain([last - 1, last]) {
            let cut = cut.min(file.len());
            let whole: usize = chunks.iter().filter(|(end, _)| *end <= cut).map(|(_, messages)| messages).sum();
            match recover(&file[..cut]) {
                Ok(recovered) => {
                    let read = status_texts(&recovered.bytes);
                    let expected: Vec<_> = (0..read.len()).map(|k| format!("message {k}")).collect();
                    assert_eq!(read, expected, "cut at {cut}");
                    assert_eq!(read.len(), recovered.messages);
                    assert!(read.len() >= whole, "{} messages of {whole} in whole chunks at {cut}", read.len());
                    mcap::Summary::read(&recovered.bytes).unwrap().unwrap();
                }
                Err(error) => assert!(cut < 8, "cut at {cut}: {error}"),
            }
        }
        assert!(recover(b"no such file").is_err());
    }
}
