//! Replays a recorded connection of a real PX4 (crates/sitl/tests/data/README.md).

use super::interface::Px4Interface;
use super::testing::{Bench, decoded, shipped};
use super::{RejectedCounts, receiver::Receiver};
use crate::backend::interface::SimulatorInterface;
use spandrel_mavlink::dialect::MavMessage;
use spandrel_model::time::SimTime;

const RECORDING: &[u8] = include_bytes!("../../../tests/data/px4-takeoff.bin");
const TO_PX4: u8 = 0;

/// Splits the recording into directions and bytes.
fn records() -> Vec<(u8, &'static [u8])> {
    let (mut rest, mut out) = (RECORDING, Vec::new());
    while let [direction, a, b, c, d, tail @ ..] = rest {
        let (bytes, after) = tail.split_at(u32::from_le_bytes([*a, *b, *c, *d]) as usize);
        out.push((*direction, bytes));
        rest = after;
    }
    out
}

/// Returns the time in the message that advances PX4's clock.
fn step_time(bytes: &[u8]) -> SimTime {
    let times = decoded(bytes).into_iter().filter_map(|message| match message {
        MavMessage::HIL_SENSOR(data) if data.id == 0 => Some(SimTime::from_us(data.time_usec as i64)),
        _ => None,
    });
    let times: Vec<SimTime> = times.collect();
    assert_eq!(times.len(), 1);
    times[0]
}

#[test]
fn wire_recorded_px4_answers_every_step_and_takes_off() {
    let bench = Bench::new();
    for chunk in [1, 7, 93, usize::MAX] {
        let mut px4 = Px4Interface::new(&shipped()[0], 250.0).unwrap();
        px4.connect();
        let (mut steps, mut waited) = (0, 0);
        for (direction, bytes) in records() {
            if direction == TO_PX4 {
                assert!(!px4.is_waiting(), "step {steps} has no answer");
                px4.send(&bench.step(step_time(bytes)));
                assert!(px4.poll_transmit().is_some());
                steps += 1;
                waited += usize::from(px4.is_waiting());
            } else {
                bytes.chunks(chunk.min(bytes.len())).for_each(|part| px4.receive(part));
            }
        }
        assert_eq!((steps, px4.poll_event(), px4.rejected()), (350, None, RejectedCounts::default()));
        // PX4 starts to answer after some periods, and then answers each.
        assert!(waited > 300, "{waited}");
        let actuators = px4.actuators();
        assert!(actuators.armed);
        assert!(actuators.motors[..4].iter().all(|motor| (0.1..0.8).contains(motor)), "{actuators:?}");
    }
}

#[test]
fn wire_recorded_answers_carry_the_time_of_their_readings() {
    let mut receiver = Receiver::default();
    let (mut last, mut answers, mut armed) = (SimTime::ZERO, 0, 0);
    for (direction, bytes) in records() {
        if direction == TO_PX4 {
            last = step_time(bytes);
            continue;
        }
        for answer in receiver.push(bytes) {
            assert!(answer.lockstep);
            assert_eq!(answer.time_us, last.us().unsigned_abs());
            answers += 1;
            armed += usize::from(answer.armed);
        }
    }
    assert!(answers > 300 && armed >= 150, "{answers} {armed}");
}
