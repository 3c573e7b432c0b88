//! The simulator's side of the JSON interface.

use super::sensor_errors::SensorErrors;
use super::sensor_messages::{self, SensorInfo};
use super::servo_packet::ServoPacket;
use super::state_line;
use crate::backend::interface::{InterfaceEvent, SimulatorInterface, StepInput};
use crate::backend::launch::LaunchSettings;
use crate::physics::Actuators;
use spandrel_mavlink::dialect::MavMessage;
use spandrel_model::time::SimTime;
use spandrel_model::vehicle::Vehicle;
use std::collections::VecDeque;

/// Maximum number of queued MAVLink messages; the oldest ones are dropped if the caller does not collect them.
const MAX_MESSAGES: usize = 64;
/// Pulse width at and below which a motor is off, us.
const MOTOR_OFF_US: u16 = 1000;
/// Width of the pulse range, us.
const PULSE_RANGE_US: f64 = 1000.0;

/// The simulator's side of ArduPilot's JSON interface.
///
/// ArduPilot sends a servo packet and waits for one state. A packet with a new frame number is the answer to the state sent before.
/// If a reply is lost, ArduPilot sends the same packet again after about a second; it then gets the same reply, and the
/// simulation does not advance. A lower frame number means that ArduPilot restarted.
///
/// Timestamps count from the first state after a connection or a restart, because ArduPilot's clock starts at 0 and must not jump.
#[derive(Debug, Clone)]
pub struct ArduPilotInterface {
    rate_hz: f64,
    rotors: usize,
    info: SensorInfo,
    errors: SensorErrors,
    /// Number of the latest frame, and its motor commands.
    frame: Option<u32>,
    actuators: Actuators,
    /// Reply to the latest frame, once it was sent.
    reply: Option<Vec<u8>>,
    /// Time that corresponds to timestamp 0.
    epoch: Option<SimTime>,
    transmit: VecDeque<Vec<u8>>,
    messages: VecDeque<MavMessage>,
    events: VecDeque<InterfaceEvent>,
    rejected: u64,
}

impl ArduPilotInterface {
    /// Creates the interface for one aircraft.
    #[must_use]
    pub fn new(vehicle: &Vehicle, settings: &LaunchSettings) -> Self {
        Self {
            rate_hz: settings.rate_hz,
            rotors: vehicle.rotors.len(),
            info: SensorInfo::new(vehicle),
            errors: SensorErrors::new(settings.instance.saturating_add(1)),
            frame: None,
            actuators: Actuators::default(),
            reply: None,
            epoch: None,
            transmit: VecDeque::new(),
            messages: VecDeque::new(),
            events: VecDeque::new(),
            rejected: 0,
        }
    }

    /// Forgets the process that was connected.
    fn start_anew(&mut self) {
        self.frame = None;
        self.actuators = Actuators::default();
        self.reply = None;
        self.epoch = None;
        self.transmit.clear();
        self.messages.clear();
        self.errors.start_anew();
    }

    /// Takes the motor commands of a new frame.
    fn accept(&mut self, packet: &ServoPacket) {
        self.frame = Some(packet.frame_count);
        self.actuators = actuators(packet, self.rotors);
        self.reply = None;
    }

    /// Reports the first rejected datagram and then each power of ten.
    fn reject(&mut self, reason: String) {
        self.rejected += 1;
        if self.rejected == 1 {
            self.events.push_back(InterfaceEvent::Rejected(reason));
        } else if is_power_of_ten(self.rejected) {
            self.events.push_back(InterfaceEvent::Rejected(format!("{reason}; {} datagrams rejected so far", self.rejected)));
        }
    }

    fn queue_message(&mut self, message: MavMessage) {
        if self.messages.len() == MAX_MESSAGES {
            self.messages.pop_front();
        }
        self.messages.push_back(message);
    }
}

impl SimulatorInterface for ArduPilotInterface {
    fn rate_hz(&self) -> f64 {
        self.rate_hz
    }

    fn connect(&mut self) {
        self.start_anew();
    }

    fn send(&mut self, step: &StepInput<'_>) {
        if self.is_waiting() {
            return;
        }
        let period = SimTime::period(self.rate_hz);
        let epoch = *self.epoch.get_or_insert(step.now - period);
        let elapsed = step.now - epoch;
        let reply = state_line::encode(step, elapsed.ns());
        self.transmit.push_back(reply.clone());
        self.reply = Some(reply);
        for message in sensor_messages::encode(step, &self.info, elapsed) {
            self.queue_message(message);
        }
        for message in self.errors.update(step) {
            self.queue_message(message);
        }
    }

    fn receive(&mut self, bytes: &[u8]) {
        let packet = match ServoPacket::decode(bytes) {
            Ok(packet) => packet,
            Err(reason) => return self.reject(reason),
        };
        match self.frame {
            Some(frame) if packet.frame_count == frame => self.transmit.extend(self.reply.clone()),
            Some(frame) if packet.frame_count < frame => {
                self.start_anew();
                self.events.push_back(InterfaceEvent::Restarted);
                self.accept(&packet);
            }
            Some(_) | None => self.accept(&packet),
        }
    }

    fn poll_transmit(&mut self) -> Option<Vec<u8>> {
        self.transmit.pop_front()
    }

    fn poll_message(&mut self) -> Option<MavMessage> {
        self.messages.pop_front()
    }

    fn poll_event(&mut self) -> Option<InterfaceEvent> {
        self.events.pop_front()
    }

    fn has_answered(&self) -> bool {
        self.frame.is_some()
    }

    /// Before the first packet, this is true: ArduPilot's address is not known yet.
    fn is_waiting(&self) -> bool {
        self.frame.is_none() || self.reply.is_some()
    }

    fn actuators(&self) -> Actuators {
        self.actuators
    }
}

/// Converts pulse widths to motor commands. The first outputs are the motors, in the aircraft's rotor order.
fn actuators(packet: &ServoPacket, rotors: usize) -> Actuators {
    let mut out = Actuators::default();
    for (command, pwm) in out.motors.iter_mut().zip(packet.pwm_us).take(rotors) {
        *command = (f64::from(pwm.saturating_sub(MOTOR_OFF_US)) / PULSE_RANGE_US).min(1.0);
        out.armed |= pwm > MOTOR_OFF_US;
    }
    out
}

fn is_power_of_ten(n: u64) -> bool {
    let mut rest = n;
    while rest >= 10 && rest.is_multiple_of(10) {
        rest /= 10;
    }
    rest == 1
}
