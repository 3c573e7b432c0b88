//! Decodes what PX4 sends on the simulator interface: motor commands, and nothing else of interest.

use crate::physics::Actuators;
use spandrel_mavlink::codec::{Decoder, ReceivedFrame};
use spandrel_mavlink::dialect::{COMMAND_LONG_DATA, HEARTBEAT_DATA, HIL_ACTUATOR_CONTROLS_DATA};

use mavlink::MessageData;

/// ID of the message with the motor commands.
pub const MOTOR_COMMANDS_ID: u32 = HIL_ACTUATOR_CONTROLS_DATA::ID;
/// Number of outputs in HIL_ACTUATOR_CONTROLS.
const OUTPUT_COUNT: usize = 16;
/// Length of HIL_ACTUATOR_CONTROLS, and the positions of its fields.
const LENGTH: usize = 81;
const FLAGS_AT: usize = 8;
const CONTROLS_AT: usize = 16;
const MODE_AT: usize = 80;
/// Flag of a PX4 that was built for lockstep.
const LOCKSTEP_FLAG: u64 = 1;
/// Mode bit of armed motors.
const ARMED_BIT: u8 = 128;

/// One HIL_ACTUATOR_CONTROLS message.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Answer {
    /// PX4's time, us. In lockstep, this is the time of the sensor readings that it answers.
    pub time_us: u64,
    /// Whether PX4 runs in lockstep.
    pub lockstep: bool,
    /// Whether the motors are armed.
    pub armed: bool,
    /// Outputs, 0 to 1 for motors.
    pub controls: [f32; OUTPUT_COUNT],
}

impl Answer {
    /// Decodes the message from its payload. The dialect's type would reject messages with flags that it does not know.
    fn read(payload: &[u8]) -> Option<Self> {
        let mut controls = [0.0; OUTPUT_COUNT];
        for (control, bytes) in controls.iter_mut().zip(payload.get(CONTROLS_AT..MODE_AT)?.chunks_exact(4)) {
            *control = f32::from_le_bytes(bytes.try_into().ok()?);
        }
        Some(Self {
            time_us: u64::from_le_bytes(payload.get(..FLAGS_AT)?.try_into().ok()?),
            lockstep: u64::from_le_bytes(payload.get(FLAGS_AT..CONTROLS_AT)?.try_into().ok()?) & LOCKSTEP_FLAG != 0,
            armed: payload.get(MODE_AT)? & ARMED_BIT != 0,
            controls,
        })
    }

    /// Returns the motor commands for an aircraft with `rotor_count` rotors. `None` if one of them is not a finite number.
    pub(super) fn actuators(&self, rotor_count: usize) -> Option<Actuators> {
        let controls = &self.controls[..rotor_count.min(self.controls.len())];
        if controls.iter().any(|control| !control.is_finite()) {
            return None;
        }
        let mut actuators = Actuators { armed: self.armed, ..Actuators::default() };
        if self.armed {
            for (motor, control) in actuators.motors.iter_mut().zip(controls) {
                *motor = f64::from(*control).clamp(0.0, 1.0);
            }
        }
        Some(actuators)
    }
}

/// Data that the interface ignored since the last connection.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub struct RejectedCounts {
    /// Bytes that did not belong to a MAVLink message.
    pub bytes: u64,
    /// Messages of a type that does not belong on this interface.
    pub messages: u64,
    /// Motor commands that were not finite numbers.
    pub commands: u64,
}

impl RejectedCounts {
    /// Describes the counts for the log.
    pub(super) fn description(&self) -> String {
        format!(
            "PX4's simulator connection: ignored {} invalid bytes, {} unexpected messages and {} motor commands that are not \
             finite numbers",
            self.bytes, self.messages, self.commands
        )
    }
}

/// Decoder of one connection.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Receiver {
    decoder: Decoder,
    unexpected: u64,
}

impl Default for Receiver {
    fn default() -> Self {
        Self { decoder: Decoder::for_known_messages(), unexpected: 0 }
    }
}

impl Receiver {
    /// Decodes any part of the byte stream and returns the complete answers in it.
    pub(super) fn push(&mut self, bytes: &[u8]) -> Vec<Answer> {
        let frames = self.decoder.push(bytes);
        frames.iter().filter_map(|frame| self.accept(frame)).collect()
    }

    fn accept(&mut self, frame: &ReceivedFrame) -> Option<Answer> {
        match frame.message_id {
            MOTOR_COMMANDS_ID => Answer::read(&frame.payload(LENGTH)),
            // PX4 announces itself with a heartbeat and requests the true state. Neither needs a reply.
            HEARTBEAT_DATA::ID | COMMAND_LONG_DATA::ID => None,
            _ => {
                self.unexpected += 1;
                None
            }
        }
    }

    /// Returns the number of invalid bytes and of messages that do not belong here.
    pub(super) fn rejected(&self) -> (u64, u64) {
        (self.decoder.bad_bytes(), self.unexpected)
    }
}
