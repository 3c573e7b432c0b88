//! The simulator's side of PX4's simulator interface.

use super::flow_message::FlowIntegrator;
use super::range_messages::RangeFinders;
use super::receiver::{Answer, Receiver, RejectedCounts};
use super::{gnss_message, sensor_messages};
use crate::backend::interface::{InterfaceEvent, SimulatorInterface, StepInput};
use crate::physics::Actuators;
use spandrel_mavlink::codec::Encoder;
use spandrel_mavlink::dialect::MavMessage;
use spandrel_model::time::{Schedule, SimTime};
use spandrel_model::vehicle::Vehicle;
use std::collections::VecDeque;

/// Rates at which PX4 can take sensor readings, Hz. PX4's own simulations use the first.
pub const RATES_HZ: [f64; 3] = [250.0, 500.0, 1000.0];
/// System and component ID of the simulator. PX4 ignores them.
const SIMULATOR_ID: (u8, u8) = (1, 200);
/// Rate of the true state in PX4's log, Hz.
const TRUTH_RATE_HZ: f64 = 25.0;

/// Problems already reported on this connection.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
struct Reported {
    counts: RejectedCounts,
    time: bool,
}

/// Encoder, decoder and lockstep state of one connection to PX4.
#[derive(Debug, Clone, PartialEq)]
pub struct Px4Interface {
    rate_hz: f64,
    rotor_count: usize,
    ranges: RangeFinders,
    encoder: Encoder,
    receiver: Receiver,
    rejected_commands: u64,
    reported: Reported,
    flow: FlowIntegrator,
    truth_due: Schedule,
    last_sent_us: u64,
    answered: bool,
    waiting: bool,
    actuators: Actuators,
    transmit: Option<Vec<u8>>,
    events: VecDeque<InterfaceEvent>,
}

impl Px4Interface {
    /// Creates the interface. `None` if `rate_hz` is not one of [`RATES_HZ`].
    #[must_use]
    pub fn new(vehicle: &Vehicle, rate_hz: f64) -> Option<Self> {
        RATES_HZ.contains(&rate_hz).then(|| Self {
            rate_hz,
            rotor_count: vehicle.rotors.len(),
            ranges: RangeFinders::new(&vehicle.sensors),
            encoder: Encoder::new(SIMULATOR_ID.0, SIMULATOR_ID.1),
            receiver: Receiver::default(),
            rejected_commands: 0,
            reported: Reported::default(),
            flow: FlowIntegrator::new(vehicle.sensors.flow_velocity_m_s),
            truth_due: Schedule::new(SimTime::ZERO, TRUTH_RATE_HZ),
            last_sent_us: 0,
            answered: false,
            waiting: false,
            actuators: Actuators::default(),
            transmit: None,
            events: VecDeque::new(),
        })
    }

    /// Returns how much data was ignored since the last [`SimulatorInterface::connect`].
    #[must_use]
    pub fn rejected(&self) -> RejectedCounts {
        let (bytes, messages) = self.receiver.rejected();
        RejectedCounts { bytes, messages, commands: self.rejected_commands }
    }

    /// Applies one answer. It ends the wait even if its motor commands are invalid, because PX4 does not repeat it. An answer to
    /// earlier readings does not.
    fn apply(&mut self, answer: &Answer) {
        self.answered = true;
        if !answer.lockstep || answer.time_us >= self.last_sent_us {
            self.waiting = false;
        }
        match answer.actuators(self.rotor_count) {
            Some(actuators) => self.actuators = actuators,
            None => self.rejected_commands += 1,
        }
    }

    /// Reports each kind of invalid data when it occurs first.
    fn report_rejected(&mut self) {
        let (now, before) = (self.rejected(), self.reported.counts);
        let first = |now: u64, before: u64| now > 0 && before == 0;
        if first(now.bytes, before.bytes) || first(now.messages, before.messages) || first(now.commands, before.commands) {
            self.reported.counts = now;
            self.events.push_back(InterfaceEvent::Rejected(now.description()));
        }
    }

    /// Reports once that readings could not be sent because their time does not increase.
    fn report_time(&mut self, now: SimTime) {
        if !std::mem::replace(&mut self.reported.time, true) {
            let text = format!(
                "PX4's clock must start after 0 and never stop or go back: readings at {} us after {} us were not sent",
                now.us(),
                self.last_sent_us
            );
            self.events.push_back(InterfaceEvent::Rejected(text));
        }
    }

    /// Encodes all messages of a step. PX4 stamps each message with its clock, which only HIL_SENSOR 0 advances, so everything that
    /// the control step needs comes before it. The other inertial sensors follow: if PX4 flies with one of them, a message before
    /// HIL_SENSOR 0 would start the control step of the previous time, and its answer could be lost.
    fn encode(&mut self, step: &StepInput<'_>, time_us: u64) -> Vec<u8> {
        let mut messages = Vec::new();
        if self.truth_due.fire(step.now) {
            messages.push(sensor_messages::truth(step, time_us));
        }
        messages.extend(step.fresh.gnss.map(|gnss| gnss_message::message(&gnss, step)));
        // Milliseconds since start wrap after 49 days, as on every MAVLink link.
        messages.extend(self.ranges.messages(step.fresh, (time_us / 1000) as u32));
        if let Some(flow) = step.fresh.flow {
            messages.extend(self.flow.message(&flow, step, time_us));
        }
        messages.push(sensor_messages::primary(step, time_us));
        for (id, imu) in step.imus.iter().enumerate().skip(1) {
            messages.push(MavMessage::HIL_SENSOR(sensor_messages::inertial(imu, id as u8, time_us)));
        }
        messages.iter().flat_map(|message| self.encoder.encode(message)).collect()
    }
}

impl SimulatorInterface for Px4Interface {
    fn rate_hz(&self) -> f64 {
        self.rate_hz
    }

    fn connect(&mut self) {
        let total = self.rejected();
        if total != self.reported.counts {
            self.events.push_back(InterfaceEvent::Rejected(total.description()));
        }
        self.receiver = Receiver::default();
        self.rejected_commands = 0;
        self.reported = Reported::default();
        self.flow.restart();
        self.truth_due = Schedule::new(SimTime::ZERO, TRUTH_RATE_HZ);
        self.last_sent_us = 0;
        (self.answered, self.waiting) = (false, false);
        self.actuators = Actuators::default();
        self.transmit = None;
    }

    fn send(&mut self, step: &StepInput<'_>) {
        let time_us = u64::try_from(step.now.us()).unwrap_or(0);
        if time_us <= self.last_sent_us {
            self.report_time(step.now);
            return;
        }
        let period_us = (1e6 / self.rate_hz) as u64;
        let elapsed_us = if self.last_sent_us == 0 { period_us } else { time_us - self.last_sent_us };
        self.flow.advance(step, SimTime::from_us(i64::try_from(elapsed_us).unwrap_or(0)));
        let bytes = self.encode(step, time_us);
        // A caller that has not fetched the previous step yet still gets the bytes in order.
        self.transmit.get_or_insert_default().extend(bytes);
        self.last_sent_us = time_us;
        self.waiting = self.answered;
    }

    fn receive(&mut self, bytes: &[u8]) {
        for answer in self.receiver.push(bytes) {
            self.apply(&answer);
        }
        self.report_rejected();
    }

    fn poll_transmit(&mut self) -> Option<Vec<u8>> {
        self.transmit.take()
    }

    fn poll_message(&mut self) -> Option<MavMessage> {
        None
    }

    fn poll_event(&mut self) -> Option<InterfaceEvent> {
        self.events.pop_front()
    }

    fn has_answered(&self) -> bool {
        self.answered
    }

    fn is_waiting(&self) -> bool {
        self.waiting
    }

    fn actuators(&self) -> Actuators {
        self.actuators
    }
}
