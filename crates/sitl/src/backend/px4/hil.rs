//! Hardware in the loop: the simulator's side of PX4's interface on a flight controller's serial link. The flight controller has
//! its own clock and runs in real time, so nothing waits for its answers.

use super::flow_message::FlowIntegrator;
use super::hil_plan::{ExtraSensors, HilPlan};
use super::range_messages::RangeFinders;
use super::receiver::{Answer, Receiver};
use super::{gnss_message, sensor_messages};
use crate::backend::interface::{InterfaceEvent, SimulatorInterface, StepInput};
use crate::physics::Actuators;
use crate::sensors::Readings;
use spandrel_mavlink::codec::Encoder;
use spandrel_mavlink::dialect::MavMessage;
use spandrel_model::time::SimTime;
use spandrel_model::vehicle::Vehicle;
use std::collections::VecDeque;

/// Component ID of the readings. It differs from the component that sends ordinary messages, so that each has its own sequence
/// numbers.
const READINGS_COMPONENT: u8 = 200;
/// Age of the latest motor commands at which the motors stop. Speed controllers of real motors stop when their input signal is lost
/// for about this time, so a flight controller that hangs or loses its cable drops the aircraft here too (estimate: the timeouts of
/// common speed controllers are 0.25 to 1 s).
pub const COMMAND_TIMEOUT: SimTime = SimTime::from_ms(500);

/// Encoder and decoder of a flight controller's link.
#[derive(Debug, Clone, PartialEq)]
pub struct Px4HilInterface {
    plan: HilPlan,
    rotor_count: usize,
    ranges: RangeFinders,
    encoder: Encoder,
    receiver: Receiver,
    flow: FlowIntegrator,
    last_sent: Option<SimTime>,
    answered: bool,
    /// Whether motor commands have arrived since the latest readings.
    has_new_commands: bool,
    /// Time of the latest readings before which motor commands arrived.
    commanded_at: SimTime,
    is_stale: bool,
    reported_invalid: bool,
    actuators: Actuators,
    transmit: Option<Vec<u8>>,
    events: VecDeque<InterfaceEvent>,
}

impl Px4HilInterface {
    /// Creates the interface for a serial link of `capacity_bytes_s` bytes/s. `None` if the link is too slow to fly with.
    #[must_use]
    pub fn new(vehicle: &Vehicle, system_id: u8, capacity_bytes_s: f64) -> Option<Self> {
        let plan = HilPlan::new(capacity_bytes_s, &vehicle.sensors)?;
        Some(Self {
            plan,
            rotor_count: vehicle.rotors.len(),
            ranges: RangeFinders::new(&vehicle.sensors),
            encoder: Encoder::new(system_id, READINGS_COMPONENT),
            receiver: Receiver::default(),
            flow: FlowIntegrator::new(vehicle.sensors.flow_velocity_m_s),
            last_sent: None,
            answered: false,
            has_new_commands: false,
            commanded_at: SimTime::ZERO,
            is_stale: false,
            reported_invalid: false,
            actuators: Actuators::default(),
            transmit: None,
            events: VecDeque::new(),
        })
    }

    /// Returns the rates and sensors that fit into the link.
    #[must_use]
    pub fn plan(&self) -> HilPlan {
        self.plan
    }

    /// Encodes the readings of a step. The inertial reading comes first, because PX4 stamps each message when it arrives, and the
    /// messages after it would delay it.
    fn encode(&mut self, step: &StepInput<'_>, time_us: u64) -> Vec<u8> {
        let mut messages = vec![sensor_messages::primary(step, time_us)];
        messages.extend(step.fresh.gnss.map(|gnss| gnss_message::message(&gnss, step)));
        let ranges = match self.plan.extra {
            ExtraSensors::None => Readings::default(),
            ExtraSensors::Below => Readings { range_down_m: step.fresh.range_down_m, ..Readings::default() },
            ExtraSensors::All => *step.fresh,
        };
        // Milliseconds since start wrap after 49 days, as on every MAVLink link.
        messages.extend(self.ranges.messages(&ranges, (time_us / 1000) as u32));
        if let Some(flow) = step.fresh.flow.filter(|_| self.plan.extra != ExtraSensors::None) {
            messages.extend(self.flow.message(&flow, step, time_us));
        }
        messages.iter().flat_map(|message| self.encoder.encode(message)).collect()
    }

    fn apply(&mut self, answer: &Answer) {
        self.answered = true;
        match answer.actuators(self.rotor_count) {
            Some(actuators) => {
                self.actuators = actuators;
                self.has_new_commands = true;
            }
            None if !std::mem::replace(&mut self.reported_invalid, true) => {
                let text = "the flight controller sent motor commands that are not finite numbers; they were ignored";
                self.events.push_back(InterfaceEvent::Rejected(text.to_owned()));
            }
            None => {}
        }
    }

    /// Stops the motors if the latest motor commands are too old.
    fn check_age(&mut self, now: SimTime) {
        if std::mem::take(&mut self.has_new_commands) || !self.answered {
            self.commanded_at = now;
            self.is_stale = false;
            return;
        }
        if now.saturating_sub(self.commanded_at) < COMMAND_TIMEOUT || self.is_stale {
            return;
        }
        self.is_stale = true;
        self.actuators = Actuators::default();
        let text = format!("no motor commands from the flight controller for {} s; the motors stop", COMMAND_TIMEOUT.s());
        self.events.push_back(InterfaceEvent::Warning(text));
    }
}

impl SimulatorInterface for Px4HilInterface {
    fn rate_hz(&self) -> f64 {
        self.plan.rate_hz
    }

    fn runs_in_real_time(&self) -> bool {
        true
    }

    fn connect(&mut self) {
        self.receiver = Receiver::default();
        self.flow.restart();
        self.last_sent = None;
        self.answered = false;
        self.has_new_commands = false;
        self.is_stale = false;
        self.reported_invalid = false;
        self.actuators = Actuators::default();
        self.transmit = None;
    }

    fn send(&mut self, step: &StepInput<'_>) {
        self.check_age(step.now);
        let since = self.last_sent.map_or(SimTime::period(self.plan.rate_hz), |last| step.now.saturating_sub(last));
        self.flow.advance(step, since);
        self.last_sent = Some(step.now);
        let bytes = self.encode(step, u64::try_from(step.now.us()).unwrap_or(0));
        self.transmit.get_or_insert_default().extend(bytes);
    }

    fn receive(&mut self, bytes: &[u8]) {
        for answer in self.receiver.push(bytes) {
            self.apply(&answer);
        }
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
        false
    }

    fn actuators(&self) -> Actuators {
        self.actuators
    }
}
