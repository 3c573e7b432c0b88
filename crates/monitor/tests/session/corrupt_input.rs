//! Robustness against corrupt input: flipped bits, truncated frames, and modified fields with a valid checksum.

use crate::live::new_monitor;
use spandrel_mavlink::dialect::MavMessage;
use spandrel_model::random::RandomStream;
use spandrel_model::time::SimTime;
use spandrel_monitor::assess_log;
use spandrel_testkit::job::*;

/// Number of datagrams per run.
const DATAGRAMS_PER_RUN: usize = 20_000;

/// Changes some payload bytes of a MAVLink 2 frame and recomputes its checksum.
fn mutate_fields(frame: &mut [u8], stream: &mut RandomStream) {
    use mavlink::Message;
    let end = 10 + usize::from(frame[1]);
    for _ in 0..=stream.below(3) {
        let at = 10 + stream.below(end - 10);
        frame[at] = stream.bits() as u8;
    }
    let id = u32::from_le_bytes([frame[7], frame[8], frame[9], 0]);
    let crc = mavlink::calculate_crc(&frame[1..end], MavMessage::extra_crc(id));
    frame[end..end + 2].copy_from_slice(&crc.to_le_bytes());
}

fn mutate_bytes(frame: &mut Vec<u8>, stream: &mut RandomStream) {
    let at = stream.below(frame.len());
    match stream.below(3) {
        0 => frame[at] ^= 1 << stream.below(8),
        1 => frame.truncate(at),
        _ => frame.insert(at, stream.bits() as u8),
    }
}

fn sample() -> Tape {
    let mut tape = Tape::new();
    tape.fly((0.0, 0.0, 10.0), 4.0);
    tape.gimbal(0.3);
    tape.lamp(true);
    tape.clearance(2.0);
    tape.snapshot(1);
    tape.contact(1);
    tape.fly((20.0, 0.0, 10.0), 8.0);
    tape.int("hits", 3);
    tape.int("respawns", 1);
    tape
}

#[test]
fn prop_monitor_survives_corrupt_datagrams() {
    let tape = sample();
    let mut stream = RandomStream::new(3, "hostile");
    let mut sent = 0;
    while sent < DATAGRAMS_PER_RUN {
        let mut monitor = new_monitor(one_task());
        for datagram in &tape.datagrams {
            let mut datagram = datagram.clone();
            match stream.below(4) {
                0 => mutate_bytes(&mut datagram, &mut stream),
                1 => mutate_fields(&mut datagram, &mut stream),
                _ => {}
            }
            monitor.handle_datagram(&datagram);
            sent += 1;
        }
        monitor.handle_timeout(SimTime::from_ms(100));
        monitor.close();
        assert!(monitor.finished().is_some());
    }
}

#[test]
fn prop_scorer_survives_corrupt_logs() {
    let log = sample().log(1);
    let mut stream = RandomStream::new(4, "hostile log");
    let mut scored = 0;
    for _ in 0..100 {
        let mut log = log.clone();
        for _ in 0..=stream.below(20) {
            let at = stream.below(log.len());
            log[at] = stream.bits() as u8;
        }
        scored += usize::from(assess_log(&log, &one_task(), &vehicle(), test_survey).is_ok());
    }
    assert!(scored > 50, "most damage should cost one record, not the session: {scored} of 100 logs scored");
}
