//! Any bytes as datagrams (a length byte before each) to the codec and the monitor: never a panic, and every good frame is whole.
#![no_main]

use spandrel::base::time::SimTime;
use spandrel::mav::codec::Decoder;
use spandrel::monitor::{Monitor, MonitorConfig, watch::build_site};
use std::sync::LazyLock;

static MONITOR: LazyLock<Monitor> = LazyLock::new(|| {
    let scenario = include_str!("../../scenarios/drill-hover.toml");
    let vehicle = include_str!("../../vehicle-params/phantom2.toml");
    Monitor::new(MonitorConfig {
        scenario: spandrel::scenario::read("drill-hover.toml", scenario, &|_| Err("none".into())).expect("shipped"),
        vehicle: spandrel::vehicle::read("phantom2.toml", vehicle).expect("shipped"),
        trainee: "fuzz".into(),
        started_unix_us: 0,
        system_id: 1,
        seed: None,
        build: build_site,
    })
});

libfuzzer_sys::fuzz_target!(|bytes: &[u8]| {
    let mut monitor = MONITOR.clone();
    let mut decoder = Decoder::new();
    let mut rest = bytes;
    while let [len, tail @ ..] = rest {
        let (datagram, after) = tail.split_at(usize::from(*len).min(tail.len()));
        rest = after;
        let whole: usize = decoder.datagram(datagram).iter().map(|frame| frame.bytes.len()).sum();
        assert!(whole <= datagram.len());
        monitor.handle_datagram(datagram);
    }
    monitor.handle_timeout(SimTime::from_s(1.0));
    while monitor.poll_transmit().is_some() || monitor.poll_record().is_some() {}
    monitor.close();
});
