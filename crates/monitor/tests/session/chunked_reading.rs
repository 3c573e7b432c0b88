//! Checks that reading a telemetry log in chunks yields the same records as reading it whole.

use spandrel_mavlink::codec::Encoder;
use spandrel_mavlink::dialect::{HEARTBEAT_DATA, MavMessage};
use spandrel_mavlink::telemetry::log_stream::RecordSplitter;
use spandrel_mavlink::telemetry::tlog::{TlogReader, TlogRecord, record};
use std::ops::ControlFlow;

/// Returns a log that contains damaged records and ends in the middle of a record.
fn damaged_log() -> Vec<u8> {
    let mut encoder = Encoder::new(1, 1);
    let mut bytes = Vec::new();
    for k in 0..40u32 {
        let message = MavMessage::HEARTBEAT(HEARTBEAT_DATA { custom_mode: 7 + k, ..HEARTBEAT_DATA::default() });
        bytes.extend(record(1_000 + u64::from(k), &encoder.encode(&message)));
        if k % 7 == 3 {
            let at = bytes.len() - 9;
            bytes[at] ^= 0x5A;
        }
        if k % 11 == 5 {
            bytes.extend([0xFD, 200, 1, 2, 3]);
        }
    }
    bytes.truncate(bytes.len() - 4);
    bytes
}

#[test]
fn exact_chunked_reading_matches_whole_log() {
    let log = damaged_log();
    let whole: Vec<(u64, Vec<u8>)> = TlogReader::new(&log).map(|r| (r.timestamp_us, r.frame.to_vec())).collect();
    assert!((20..40).contains(&whole.len()), "read {} records", whole.len());
    let mut reader = TlogReader::new(&log);
    while reader.next().is_some() {}
    for size in [1, 2, 7, 29, 300, 10_000] {
        let (mut splitter, mut found) = (RecordSplitter::default(), Vec::new());
        let mut take = |r: TlogRecord<'_>| {
            found.push((r.timestamp_us, r.frame.to_vec()));
            ControlFlow::Continue(())
        };
        for piece in log.chunks(size) {
            assert!(splitter.feed(piece, &mut take).is_continue());
        }
        assert!(splitter.end(&mut take).is_continue());
        assert_eq!(found, whole, "chunks of {size} bytes");
        assert_eq!(splitter.complete_bytes(), reader.complete_bytes() as u64, "chunks of {size} bytes");
    }
}
