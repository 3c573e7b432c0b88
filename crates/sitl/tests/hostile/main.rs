//! Fuzzes the vehicle's endpoint with every message that it handles, with changed fields and a correct checksum, and
//! with bytes that are not messages at all. The vehicle is on the ground, in manual flight, in a mission, or following
//! external setpoints, as PX4 or as ArduPilot.
#![allow(clippy::unwrap_used, reason = "a test")]

mod driver;
mod mutate;
mod planted;
mod seeds;

use driver::{Coverage, Driver, Finding, STATION, TestVehicle, Vehicle};
use mavlink::Message;
use spandrel_mavlink::codec::Decoder;
use spandrel_mavlink::dialect::{MavCmd, MavMessage, MavResult};
use spandrel_model::random::RandomStream;
use spandrel_sitl::endpoint::HANDLED;
use spandrel_sitl::endpoint::flavor::ardupilot;
use spandrel_sitl::sim::Sim;
use spandrel_testkit::station::Station;

/// Number of datagrams in the whole run (requirement: 20,000).
const DATAGRAMS: usize = 40_000;
/// Number of datagrams before the vehicle restarts from one of the situations, so that most datagrams reach a vehicle
/// in flight.
const BATCH: usize = 400;

/// Returns the commands that the vehicle does not report as unsupported.
fn known_commands(sim: &Sim) -> Vec<u16> {
    let mut sim = sim.clone();
    let mut stream = RandomStream::new(1, "commands");
    let mut known = Vec::new();
    for number in 0..=u16::MAX {
        let mut payload = [0; 33];
        payload[28..30].copy_from_slice(&number.to_le_bytes());
        (payload[30], payload[31]) = (1, u8::from(number % 2 == 0));
        sim.handle_datagram(STATION, &mutate::frame(76, &payload, (255, 190), &mut stream));
        // One tick for each request, because the work per link per tick is limited.
        let next = sim.poll_timeout();
        sim.handle_timeout(next);
        while let Some(transmit) = sim.poll_transmit() {
            for frame in Decoder::new().datagram(&transmit.bytes) {
                let p = frame.payload(10);
                let unsupported = p[2] == MavResult::MAV_RESULT_UNSUPPORTED as u8;
                if frame.message_id == 77 && p[..2] == number.to_le_bytes() && !unsupported {
                    known.push(number);
                }
            }
        }
    }
    known
}

/// Returns the initial situations of the runs.
fn situations() -> Vec<Sim> {
    let mut ground = Station::new("drill-hover", 3);
    ground.run_ms(2_500);
    let flown = Station::airborne("drill-hover", 3);
    let mut mission = Station::airborne("drill-hover", 3);
    mission.sim.handle_datagram(STATION, &{
        let mut stream = RandomStream::new(2, "mission");
        let messages =
            [seeds::count(2), MavMessage::MISSION_ITEM_INT(seeds::item(0)), MavMessage::MISSION_ITEM_INT(seeds::item(1))];
        let frames = messages.iter().map(|m| mutate::frame(m.message_id(), &mutate::payload(m), (255, 190), &mut stream));
        frames.collect::<Vec<_>>().concat()
    });
    mission.command(1, MavCmd::MAV_CMD_DO_SET_MODE, [1.0, 4.0, 4.0, 0.0, 0.0, 0.0, 0.0]);
    let mut offboard = Station::airborne("drill-hover", 3);
    offboard.send(&seeds::messages(84)[0]);
    offboard.run_ms(1);
    offboard.command(1, MavCmd::MAV_CMD_DO_SET_MODE, [1.0, 6.0, 0.0, 0.0, 0.0, 0.0, 0.0]);
    let mut copter = Station::with_flavor(&ardupilot::FLAVOR, "drill-hover", 3);
    copter.run_ms(2_500);
    let mut guided = Station::with_flavor(&ardupilot::FLAVOR, "drill-hover", 3);
    guided.run_ms(2_500);
    for (command, p) in [
        (MavCmd::MAV_CMD_DO_SET_MODE, [1.0, 4.0, 0.0, 0.0, 0.0, 0.0, 0.0]),
        (MavCmd::MAV_CMD_COMPONENT_ARM_DISARM, [1.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0]),
        (MavCmd::MAV_CMD_NAV_TAKEOFF, [0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 4.0]),
    ] {
        assert_eq!(guided.command(1, command, p), MavResult::MAV_RESULT_ACCEPTED);
    }
    guided.run_ms(6_000);
    vec![ground.vehicle.sim, flown.vehicle.sim, mission.vehicle.sim, offboard.vehicle.sim, copter.vehicle.sim, guided.vehicle.sim]
}

/// Fuzzes the situations in turn, with a new copy for each batch, until an invariant is violated.
fn run(seed: u64, wrap: impl Fn(Vehicle) -> Box<dyn TestVehicle>) -> Result<Coverage, Finding> {
    let situations = situations();
    let mut numbers = known_commands(&situations[0]);
    // A command that only one flavor handles: ArduPilot's DO_SEND_BANNER.
    numbers.push(42_428);
    assert!(numbers.len() > 40, "{numbers:?}");
    let stream = RandomStream::new(seed, "endpoint under fire");
    let mut driver = Driver { stream, numbers: &numbers, coverage: Coverage::default() };
    for batch in 0..DATAGRAMS / BATCH {
        let mut subject = wrap(Vehicle::new(situations[batch % situations.len()].clone()));
        driver.send_datagrams(subject.as_mut(), BATCH)?;
    }
    Ok(driver.coverage)
}

#[test]
fn prop_every_handled_message_has_a_valid_seed() {
    for id in HANDLED {
        let good = seeds::messages(*id);
        assert!(!good.is_empty(), "message {id} is handled but not fuzzed: add a valid message to seeds.rs");
        assert!(good.iter().all(|m| m.message_id() == *id));
    }
    let double = HANDLED.iter().enumerate().find(|(k, id)| HANDLED[..*k].contains(id));
    assert_eq!(double, None, "a message is handled twice");
}

#[test]
fn prop_no_datagram_violates_the_invariants() {
    let seed = std::env::var("SPANDREL_FUZZ_SEED").ok().and_then(|text| text.parse().ok()).unwrap_or(7);
    let coverage =
        run(seed, |vehicle| Box::new(vehicle)).unwrap_or_else(|found| panic!("{}: {:02x?}", found.what, found.datagram));
    assert!(coverage.datagrams >= 20_000);
    // The test would be pointless if the datagrams had no effect.
    assert!(coverage.commands_accepted.len() > 35, "{:?}", coverage.commands_accepted);
    assert!(coverage.plans_accepted > 500, "{}", coverage.plans_accepted);
    assert!(
        coverage.parameter_values > 1_000 && coverage.refusals > 5_000,
        "{} {}",
        coverage.parameter_values,
        coverage.refusals
    );
    assert!(coverage.file_data > 50, "{}", coverage.file_data);
    assert!(coverage.modes.len() >= 6, "{:x?}", coverage.modes);
    for id in [0, 22, 44, 47, 51, 73, 77, 110, 111, 118, 120, 253, 345, 263, 435] {
        assert!(coverage.answers.contains_key(&id), "message {id} was never sent");
    }
}

#[test]
fn prop_invalid_bytes_are_counted() {
    let mut sim = situations().remove(1);
    let mut stream = RandomStream::new(5, "noise");
    let numbers = [400u16];
    let mut expected = sim.bad_bytes();
    for _ in 0..2_000 {
        let datagram = mutate::datagram(&numbers, &mut stream);
        let mut decoder = Decoder::new();
        let good: usize = decoder.datagram(&datagram).iter().map(|f| f.bytes.len()).sum();
        assert_eq!(good as u64 + decoder.bad_bytes(), datagram.len() as u64);
        expected += decoder.bad_bytes();
        sim.handle_datagram(STATION, &datagram);
        let next = sim.poll_timeout();
        sim.handle_timeout(next);
    }
    assert_eq!(sim.bad_bytes(), expected);
}

/// Without a reader, the queued output must stay within a bound.
#[test]
fn prop_output_queue_is_bounded() {
    const MAX_BYTES: usize = 4_000 * 1_400 + 300_000;
    let mut sim = situations().remove(1);
    let modes = seeds::messages(76).pop().unwrap();
    let mut stream = RandomStream::new(6, "flood");
    let datagram: Vec<u8> = (0..40).flat_map(|_| mutate::frame(76, &mutate::payload(&modes), (255, 190), &mut stream)).collect();
    for _ in 0..2_000 {
        sim.handle_datagram(STATION, &datagram);
        let until = sim.poll_timeout();
        sim.handle_timeout(until);
    }
    let waiting: usize = std::iter::from_fn(|| sim.poll_transmit()).map(|t| t.bytes.len()).sum();
    assert!(waiting < MAX_BYTES, "{waiting} bytes");
}

#[test]
fn prop_fuzzer_finds_planted_faults() {
    // The planted faults panic on purpose.
    std::panic::set_hook(Box::new(|_| {}));
    for (fault, needle) in planted::FAULTS {
        // Each fault affects one value of one field of one message among dozens, so more than one run may be needed.
        let found = (11..15).find_map(|seed| run(seed, |vehicle| Box::new(planted::FaultyVehicle::new(vehicle, fault))).err());
        let found = found.unwrap_or_else(|| panic!("{fault:?} was not found"));
        assert!(found.what.contains(needle), "{fault:?}: {}", found.what);
    }
}
