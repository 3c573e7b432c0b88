//! Vehicles with planted faults, each triggered by one rare value of one field. A fuzzer that does not find these
//! faults is useless.

use super::driver::{TestVehicle, Vehicle};
use spandrel_mavlink::codec::{Decoder, Encoder};
use spandrel_mavlink::dialect::*;

#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Fault {
    /// The last sequence number causes an out-of-bounds index.
    Index,
    /// A NaN in a setpoint gets into the state.
    NanState,
    /// The lowest parameter index causes endless responses.
    Flood,
    /// An infinite command parameter makes the vehicle unresponsive.
    Unresponsive,
}

/// All faults, each with part of the message that must be reported.
pub const FAULTS: [(Fault, &str); 4] = [
    (Fault::Index, "panic: item 65535"),
    (Fault::NanState, "NaN or infinity in"),
    (Fault::Flood, "responses to"),
    (Fault::Unresponsive, "no more responses"),
];

pub struct FaultyVehicle {
    vehicle: Vehicle,
    fault: Fault,
    has_nan: bool,
    extra_responses: usize,
}

impl FaultyVehicle {
    pub fn new(vehicle: Vehicle, fault: Fault) -> Self {
        Self { vehicle, fault, has_nan: false, extra_responses: 0 }
    }

    fn apply(&mut self, message: &MavMessage) {
        match (self.fault, message) {
            (Fault::Index, MavMessage::MISSION_ITEM_INT(item)) if item.seq == u16::MAX => panic!("item {} of a plan", item.seq),
            (Fault::NanState, MavMessage::SET_POSITION_TARGET_LOCAL_NED(t)) if t.x.is_nan() => self.has_nan = true,
            (Fault::Flood, MavMessage::PARAM_REQUEST_READ(r)) if r.param_index == i16::MIN => self.extra_responses = 10_000,
            (Fault::Unresponsive, MavMessage::COMMAND_LONG(c)) if c.param1 == f32::INFINITY => self.has_nan = true,
            _ => {}
        }
    }
}

impl TestVehicle for FaultyVehicle {
    fn receive(&mut self, bytes: &[u8]) {
        if self.fault == Fault::Unresponsive && self.has_nan {
            return;
        }
        for frame in Decoder::new().datagram(bytes) {
            if let Some(message) = &frame.message {
                self.apply(message);
            }
        }
        self.vehicle.receive(bytes);
    }

    fn look(&mut self) {
        self.vehicle.look();
    }

    fn tick(&mut self) {
        self.vehicle.tick();
    }

    fn drain(&mut self) -> Vec<Vec<u8>> {
        let mut out = self.vehicle.drain();
        let mut encoder = Encoder::new(1, 1);
        if self.fault == Fault::NanState && self.has_nan {
            let x = f32::NAN;
            out.push(encoder.encode(&MavMessage::LOCAL_POSITION_NED(LOCAL_POSITION_NED_DATA { x, ..Default::default() })));
        }
        let answer = MavMessage::PARAM_VALUE(PARAM_VALUE_DATA::default());
        out.extend((0..std::mem::take(&mut self.extra_responses)).map(|_| encoder.encode(&answer)));
        out
    }

    fn all_finite(&self) -> bool {
        self.vehicle.all_finite()
    }
}
