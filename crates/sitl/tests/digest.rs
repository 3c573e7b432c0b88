//! Bit-exact determinism: the same flight produces the same result in two runs and when resumed from a snapshot taken
//! at any time. (`tests/clients/` compares debug and release builds through telemetry.)
#![allow(clippy::unwrap_used, reason = "a test")]

use spandrel_mavlink::codec::{Decoder, Encoder};
use spandrel_mavlink::dialect::{COMMAND_LONG_DATA, MANUAL_CONTROL_DATA, MavCmd, MavMessage};
use spandrel_model::scenario::{read, select_level};
use spandrel_model::time::SimTime;
use spandrel_sitl::sim::{Sim, SimEvent};
use spandrel_testkit::station::{GCS, Station};

const SEED: u64 = 7;
/// Interval between stick messages, ms.
const STICK_INTERVAL_MS: i64 = 40;
/// Stick inputs (forward, right, up from 0 to 1000) and their durations, ms: climb, fly sideways into the suspension
/// bridge's girder, fly away from it. Then the motors are stopped and the vehicle falls into the lake; after three
/// seconds there, the flight continues.
const SCRIPT: [(i64, [i16; 3]); 5] =
    [(4_000, [0, 0, 800]), (15_000, [0, -1000, 500]), (4_000, [0, 1000, 500]), (9_000, [0, 0, 500]), (5_000, [500, 0, 600])];
const STOP_BEFORE: usize = 3;
/// Command parameter that forces disarming in flight.
const FORCE_DISARM: f32 = 21_196.0;

/// Minimum interval between snapshots.
const MIN_SNAPSHOT_INTERVAL: SimTime = SimTime::from_ms(2_000);

/// Received datagrams with their times.
type Inputs = Vec<(SimTime, Vec<u8>)>;

fn inputs(mut at: SimTime) -> (Inputs, SimTime) {
    let (mut encoder, mut inputs) = (Encoder::new(255, 190), Inputs::new());
    for (k, (for_ms, [x, y, z])) in SCRIPT.into_iter().enumerate() {
        if k == STOP_BEFORE {
            let command = MavCmd::MAV_CMD_COMPONENT_ARM_DISARM;
            let stop =
                COMMAND_LONG_DATA { command, param2: FORCE_DISARM, target_system: 1, target_component: 1, ..Default::default() };
            inputs.push((at, encoder.encode(&MavMessage::COMMAND_LONG(stop))));
        }
        for _ in 0..for_ms / STICK_INTERVAL_MS {
            let sticks = MANUAL_CONTROL_DATA { target: 1, x, y, z, ..Default::default() };
            inputs.push((at, encoder.encode(&MavMessage::MANUAL_CONTROL(sticks))));
            at += SimTime::from_ms(STICK_INTERVAL_MS);
        }
    }
    (inputs, at)
}

/// Continues a flight with these inputs. After each event, calls `look` with the event and the vehicle.
fn fly(sim: &mut Sim, inputs: &Inputs, end: SimTime, mut look: impl FnMut(&SimEvent, &Sim)) {
    let left = inputs.iter().filter(|(at, _)| *at >= sim.now()).cloned().collect::<Inputs>();
    let times = left.iter().skip(1).map(|(at, _)| *at).chain([end]);
    for ((_, bytes), next) in left.iter().zip(times) {
        sim.handle_datagram(GCS, bytes);
        sim.handle_timeout(next);
        while sim.poll_transmit().is_some() {}
        while let Some(event) = sim.poll_event() {
            look(&event, sim);
        }
    }
}

fn hex(sim: &Sim) -> String {
    sim.digest().iter().map(|byte| format!("{byte:02x}")).collect()
}

/// A pause must not change the flight, and heartbeats must continue during the pause: one heartbeat per call on the
/// link, one text at the beginning, and no ground truth.
#[test]
fn flight_pause_does_not_change_the_flight_and_heartbeats_continue() {
    let start = Station::airborne("drill-hover", SEED).vehicle.sim;
    let end = start.now() + SimTime::from_ms(3_000);
    let sticks = MANUAL_CONTROL_DATA { target: 1, x: 300, y: -200, z: 600, ..Default::default() };
    let mut encoder = Encoder::new(255, 190);
    let inputs: Inputs = (0..60)
        .map(|k| (start.now() + SimTime::from_ms(50 * k), encoder.encode(&MavMessage::MANUAL_CONTROL(sticks.clone()))))
        .collect();
    let mut through = start.clone();
    fly(&mut through, &inputs, end, |_, _| {});
    let mut paused = start;
    let (middle, (first, second)) = (inputs[30].0, inputs.split_at(30));
    fly(&mut paused, &first.to_vec(), middle, |_, _| {});
    let mut messages = Vec::new();
    for k in 0..100 {
        paused.pause(k == 0);
        let bytes: Vec<u8> =
            std::iter::from_fn(|| paused.poll_transmit()).filter(|t| t.link == GCS).flat_map(|t| t.bytes).collect();
        messages
            .extend(Decoder::new().datagram(&bytes).into_iter().filter_map(|frame| Some((frame.component_id, frame.message?))));
    }
    assert_eq!(paused.now(), middle);
    let beats = |component: u8| messages.iter().filter(|(c, m)| *c == component && matches!(m, MavMessage::HEARTBEAT(_))).count();
    assert_eq!((beats(1), beats(100)), (100, 0), "only the autopilot must send heartbeats, because the camera is not used");
    let words =
        messages.iter().filter(|(_, m)| matches!(m, MavMessage::STATUSTEXT(t) if t.text.to_str() == Ok("Simulation paused")));
    assert_eq!(words.count(), 1);
    assert!(messages.iter().all(|(_, m)| matches!(m, MavMessage::HEARTBEAT(_) | MavMessage::STATUSTEXT(_))), "{messages:?}");
    paused.resume();
    fly(&mut paused, &second.to_vec(), end, |_, _| {});
    assert_eq!(hex(&paused), hex(&through));
}

#[test]
fn flight_same_inputs_give_identical_results_despite_wind_collision_and_respawn() {
    let start = Station::airborne("two-bridges", SEED).vehicle.sim;
    let (inputs, end) = inputs(start.now());
    let (mut crashes, mut respawns, mut snapshots) = (0, 0, vec![start.clone()]);
    let mut first = start;
    fly(&mut first, &inputs, end, |event, sim| {
        crashes += usize::from(matches!(event, SimEvent::Crash { .. }));
        respawns += usize::from(*event == SimEvent::Respawn);
        // A snapshot taken right after an event reveals any state that it omits.
        if snapshots.last().is_none_or(|last| sim.now() >= last.now() + MIN_SNAPSHOT_INTERVAL) {
            snapshots.push(sim.clone());
        }
    });
    assert!(crashes > 0 && respawns > 0, "{crashes} collisions, {respawns} respawns");
    let mut second = Station::airborne("two-bridges", SEED).vehicle.sim;
    fly(&mut second, &inputs, end, |_, _| {});
    assert_eq!(hex(&second), hex(&first), "a second run must give the same result");
    for mut snapshot in snapshots {
        let from = snapshot.now();
        fly(&mut snapshot, &inputs, end, |_, _| {});
        assert_eq!(hex(&snapshot), hex(&first), "from a snapshot at {from}");
    }
    let mut other = Station::airborne("two-bridges", SEED + 1).vehicle.sim;
    fly(&mut other, &inputs, end, |_, _| {});
    assert_ne!(hex(&other), hex(&first), "another seed must give a different result");
}

/// At its standard level, a drill with difficulty levels flies like the same file without them. Other levels differ.
#[test]
fn flight_standard_level_does_not_change_the_flight() {
    let levels = spandrel_model::shipped::DRILL_HOVER;
    let digest = |text: &str| {
        let drill = read("drill-hover.toml", text, &|file| Err(file.to_owned())).unwrap();
        let mut station = Station::of(drill, "phantom2", SEED);
        station.climb_manually();
        hex(&station.vehicle.sim)
    };
    let (plain, _) = levels.split_once("# [easiest, hardest]").unwrap();
    assert_eq!([digest(levels), digest(&select_level(levels, 5))], [digest(plain), digest(plain)]);
    assert_ne!(digest(&select_level(levels, 6)), digest(plain));
}
