//! The same flight gives the same bits: in two runs and from a snapshot taken anywhere. (Debug and release builds are compared over the
//! wire, in `tests/clients/`.)

#[path = "../wire/station.rs"]
#[expect(dead_code, reason = "only its take-off is flown here")]
mod station;

use spandrel::base::time::SimTime;
use spandrel::mav::codec::Encoder;
use spandrel::mav::dialect::{COMMAND_LONG_DATA, MANUAL_CONTROL_DATA, MavCmd, MavMessage};
use spandrel::sitl::sim::{Sim, SimEvent};
use station::{GCS, Station};

const SEED: u64 = 7;
/// Sticks arrive this often, ms.
const PERIOD_MS: i64 = 40;
/// How long which sticks (forward, right, up from 0 to 1000) are held, ms: higher, sideways into the suspension bridge's girder, away
/// from it; then the motors are stopped, and after a fall into the lake and three seconds there it flies on.
const SCRIPT: [(i64, [i16; 3]); 5] =
    [(4_000, [0, 0, 800]), (15_000, [0, -1000, 500]), (4_000, [0, 1000, 500]), (9_000, [0, 0, 500]), (5_000, [500, 0, 600])];
const STOP_BEFORE: usize = 3;
/// The number that stops motors in the air.
const FORCE: f32 = 21_196.0;

/// Snapshots are taken this far apart at least.
const APART: SimTime = SimTime::from_ms(2_000);

/// When which bytes come in.
type Inputs = Vec<(SimTime, Vec<u8>)>;

fn inputs(mut at: SimTime) -> (Inputs, SimTime) {
    let (mut encoder, mut inputs) = (Encoder::new(255, 190), Inputs::new());
    for (k, (for_ms, [x, y, z])) in SCRIPT.into_iter().enumerate() {
        if k == STOP_BEFORE {
            let command = MavCmd::MAV_CMD_COMPONENT_ARM_DISARM;
            let stop = COMMAND_LONG_DATA { command, param2: FORCE, target_system: 1, target_component: 1, ..Default::default() };
            inputs.push((at, encoder.encode(&MavMessage::COMMAND_LONG(stop))));
        }
        for _ in 0..for_ms / PERIOD_MS {
            let sticks = MANUAL_CONTROL_DATA { target: 1, x, y, z, ..Default::default() };
            inputs.push((at, encoder.encode(&MavMessage::MANUAL_CONTROL(sticks))));
            at += SimTime::from_ms(PERIOD_MS);
        }
    }
    (inputs, at)
}

/// Flies on from where the vehicle is; hands out what happened and the vehicle right after.
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

#[test]
fn flight_the_same_inputs_give_the_same_bits_through_wind_collision_and_being_put_back() {
    let start = Station::airborne("two-bridges", SEED).sim;
    let (inputs, end) = inputs(start.now());
    let (mut crashes, mut respawns, mut snapshots) = (0, 0, vec![start.clone()]);
    let mut first = start;
    fly(&mut first, &inputs, end, |event, sim| {
        crashes += usize::from(matches!(event, SimEvent::Crash { .. }));
        respawns += usize::from(*event == SimEvent::Respawn);
        // Right after something happened is where forgotten state would show.
        if snapshots.last().is_none_or(|last| sim.now() >= last.now() + APART) {
            snapshots.push(sim.clone());
        }
    });
    assert!(crashes > 0 && respawns > 0, "{crashes} collisions, put back {respawns} times");
    let mut second = Station::airborne("two-bridges", SEED).sim;
    fly(&mut second, &inputs, end, |_, _| {});
    assert_eq!(hex(&second), hex(&first), "a second run");
    for mut snapshot in snapshots {
        let from = snapshot.now();
        fly(&mut snapshot, &inputs, end, |_, _| {});
        assert_eq!(hex(&snapshot), hex(&first), "from a snapshot at {from}");
    }
    let mut other = Station::airborne("two-bridges", SEED + 1).sim;
    fly(&mut other, &inputs, end, |_, _| {});
    assert_ne!(hex(&other), hex(&first), "another seed");
}
