//! Feeds arbitrary bytes to the codec and the monitor. Length bytes split the input into datagrams. The first byte of a
//! datagram determines whether the rest is fed in unchanged or as the payload of a message with a valid checksum.
//! Neither the codec nor the monitor may panic, and no decoded frame may be longer than its datagram.
#![no_main]

use mavlink::Message;
use spandrel_mavlink::codec::Decoder;
use spandrel_mavlink::dialect::MavMessage;
use spandrel_model::time::SimTime;
use spandrel_monitor::{Monitor, MonitorConfig, sidecar::build_site};
use std::sync::LazyLock;

static MONITOR: LazyLock<Monitor> = LazyLock::new(|| {
    let scenario = include_str!("../../scenarios/drill-hover.toml");
    let vehicle = include_str!("../../vehicle-params/phantom2.toml");
    Monitor::new(MonitorConfig {
        scenario: spandrel_model::scenario::read("drill-hover.toml", scenario, &|_| Err("none".into()))
            .expect("the shipped file must be valid"),
        vehicle: spandrel_model::vehicle::read("phantom2.toml", vehicle).expect("the shipped file must be valid"),
        trainee: "fuzz".into(),
        purpose: None,
        started_unix_us: 0,
        system_id: 1,
        seed: None,
        survey_builder: build_site,
    })
});

/// Creates a frame that the vehicle could send, with the given payload bytes.
fn build_frame(choice: u16, payload: &[u8]) -> Vec<u8> {
    let ids = MavMessage::all_ids();
    let id = ids[usize::from(choice) % ids.len()];
    let [a, b, c, _] = id.to_le_bytes();
    let mut out = vec![0xFD, payload.len() as u8, 0, 0, 0, 1, 1, a, b, c];
    out.extend(payload);
    out.extend(mavlink::calculate_crc(&out[1..], MavMessage::extra_crc(id)).to_le_bytes());
    out
}

libfuzzer_sys::fuzz_target!(|bytes: &[u8]| {
    let mut monitor = MONITOR.clone();
    let mut decoder = Decoder::new();
    let mut rest = bytes;
    while let [len, tail @ ..] = rest {
        let (datagram, after) = tail.split_at(usize::from(*len).min(tail.len()));
        rest = after;
        let datagram = match datagram {
            [kind, low, high, payload @ ..] if kind & 1 == 0 => &build_frame(u16::from_le_bytes([*low, *high]), payload),
            _ => datagram,
        };
        let whole: usize = decoder.datagram(datagram).iter().map(|frame| frame.bytes.len()).sum();
        assert!(whole <= datagram.len());
        monitor.handle_datagram(datagram);
    }
    monitor.handle_timeout(SimTime::from_s(1.0));
    while monitor.poll_transmit().is_some() || monitor.poll_record().is_some() {}
    monitor.close();
});
