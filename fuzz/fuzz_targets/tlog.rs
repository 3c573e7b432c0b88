//! Feeds arbitrary bytes to the scorer as a telemetry log. It must return a score or an error and never panic.
#![no_main]

use spandrel_model::{scenario::Scenario, vehicle::Vehicle};
use spandrel_monitor::{assess_log, sidecar::build_site};
use std::sync::LazyLock;

static JOB: LazyLock<(Scenario, Vehicle)> = LazyLock::new(|| {
    let scenario = include_str!("../../scenarios/drill-hover.toml");
    let vehicle = include_str!("../../vehicle-params/phantom2.toml");
    let read = spandrel_model::scenario::read("drill-hover.toml", scenario, &|_| Err("none".into()));
    (read.expect("the shipped file must be valid"), spandrel_model::vehicle::read("phantom2.toml", vehicle).expect("shipped"))
});

libfuzzer_sys::fuzz_target!(|log: &[u8]| {
    let (scenario, vehicle) = &*JOB;
    let _ = assess_log(log, scenario, vehicle, build_site);
});
