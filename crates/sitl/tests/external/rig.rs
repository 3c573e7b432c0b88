//! A vehicle that is flown by the small autopilot, with a ground station and a payload process.

use crate::fake_px4::FakePx4;
use mavlink::MessageData;
use spandrel_mavlink::codec::{Decoder, Encoder, ReceivedFrame};
use spandrel_mavlink::dialect::*;
use spandrel_mavlink::station;
use spandrel_model::scenario::{AfterCrash, Scenario};
use spandrel_model::site::Site;
use spandrel_model::time::SimTime;
use spandrel_model::{shipped, vehicle};
use spandrel_sitl::backend::px4::Px4Interface;
use spandrel_sitl::endpoint::flavor::px4;
use spandrel_sitl::endpoint::params::param_view;
use spandrel_sitl::endpoint::relay::RelayRules;
use spandrel_sitl::endpoint::{LinkId, LinkKind};
use spandrel_sitl::sim::{AutopilotState, Sim, SimConfig, SimEvent};
use std::collections::BTreeMap;
use std::sync::Arc;

pub const AUTOPILOT: LinkId = LinkId(9);
pub const STATION: LinkId = LinkId(1);
pub const MONITOR: LinkId = LinkId(2);
/// Maximum number of exchanges before a test gives up: two minutes on the autopilot's clock.
const MAX_EXCHANGES: usize = 30_000;

/// The vehicle and its peers.
pub struct Rig {
    pub sim: Sim,
    pub px4: FakePx4,
    station: Encoder,
    pub heard: BTreeMap<LinkId, Vec<ReceivedFrame>>,
    pub events: Vec<SimEvent>,
}

fn job() -> Scenario {
    spandrel_model::scenario::read("drill-hover.toml", shipped::DRILL_HOVER, &|_| Err("none".into())).unwrap()
}

impl Rig {
    /// Creates a vehicle whose autopilot has not connected.
    pub fn new(after_crash: AfterCrash) -> Self {
        Self::with_stick_sender(after_crash, None)
    }

    /// Creates a vehicle whose autopilot has not connected and takes sticks only from this sender.
    pub fn with_stick_sender(after_crash: AfterCrash, stick_sender: Option<(u8, u8)>) -> Self {
        Self::with_scenario(job(), shipped::PHANTOM2, after_crash, stick_sender)
    }

    /// Creates a vehicle of another aircraft file, whose autopilot is ready.
    pub fn with_aircraft(text: &str) -> Self {
        let mut rig = Self::with_scenario(job(), text, AfterCrash::Continue, None);
        rig.start();
        rig
    }

    /// Creates a vehicle in a changed job, whose autopilot is ready.
    pub fn with_job(after_crash: AfterCrash, change: impl FnOnce(&mut Scenario)) -> Self {
        let mut scenario = job();
        change(&mut scenario);
        let mut rig = Self::with_scenario(scenario, shipped::PHANTOM2, after_crash, None);
        rig.start();
        rig
    }

    fn with_scenario(scenario: Scenario, aircraft: &str, after_crash: AfterCrash, stick_sender: Option<(u8, u8)>) -> Self {
        let vehicle = Arc::new(vehicle::read("aircraft.toml", aircraft).unwrap());
        let site = Arc::new(Site::build(&scenario, 1));
        let interface = Box::new(Px4Interface::new(&vehicle, 250.0).unwrap());
        let rules = RelayRules { params: &param_view::PX4, restarts_by_process: true, roi_above_sea_level: true, stick_sender };
        let (scenario, after_crash) = (Arc::new(scenario), Some(after_crash));
        let config = SimConfig { scenario, vehicle, seed: 1, instance: 0, flavor: &px4::FLAVOR, after_crash };
        let mut sim = Sim::with_external_autopilot(config, site, interface, rules);
        sim.open_link(AUTOPILOT, LinkKind::Autopilot, false);
        sim.open_link(STATION, LinkKind::GroundStation, false);
        sim.open_link(MONITOR, LinkKind::Payload, false);
        Self { sim, px4: FakePx4::new(1), station: Encoder::new(255, 190), heard: BTreeMap::new(), events: Vec::new() }
    }

    /// Creates a vehicle whose autopilot is ready.
    pub fn ready(after_crash: AfterCrash) -> Self {
        let mut rig = Self::new(after_crash);
        rig.start();
        rig
    }

    /// Connects a new process and waits until it is ready.
    pub fn start(&mut self) {
        self.connect();
        self.exchange_until(|rig| matches!(rig.sim.autopilot_state(), Some(AutopilotState::Running { .. })));
        self.say(&station::heartbeat());
    }

    /// Connects a new process.
    pub fn connect(&mut self) {
        self.px4 = FakePx4::new(1);
        self.sim.connect_autopilot();
        let greeting = self.px4.greeting();
        self.sim.handle_autopilot_bytes(&greeting);
    }

    /// Sends a message from the ground station.
    pub fn say(&mut self, message: &MavMessage) {
        let bytes = self.station.encode(message);
        self.sim.handle_datagram(STATION, &bytes);
    }

    /// Sends a command from the ground station.
    pub fn command(&mut self, component: u8, command: MavCmd, params: &[f32]) {
        self.say(&MavMessage::COMMAND_LONG(station::command(1, component, command, station::params(params))));
    }

    /// Exchanges everything that is due once.
    pub fn exchange(&mut self) {
        let until = self.sim.now() + SimTime::from_ms(4);
        self.sim.handle_timeout(until);
        while let Some(bytes) = self.sim.poll_autopilot_transmit() {
            let answer = self.px4.simulator(&bytes);
            self.sim.handle_autopilot_bytes(&answer);
        }
        for datagram in self.px4.take_mavlink() {
            self.sim.handle_datagram(AUTOPILOT, &datagram);
        }
        while let Some(transmit) = self.sim.poll_transmit() {
            if transmit.link == AUTOPILOT {
                self.px4.mavlink(&transmit.bytes);
            }
            self.heard.entry(transmit.link).or_default().extend(Decoder::new().datagram(&transmit.bytes));
        }
        self.events.extend(std::iter::from_fn(|| self.sim.poll_event()));
    }

    /// Exchanges until a condition is met.
    pub fn exchange_until(&mut self, condition: impl Fn(&Self) -> bool) {
        for _ in 0..MAX_EXCHANGES {
            if condition(self) {
                return;
            }
            self.exchange();
        }
        panic!("the condition was not met; simulation time {}, events {:?}", self.sim.now(), self.events);
    }

    /// Exchanges for a simulation time.
    pub fn run_s(&mut self, s: f64) {
        let end = self.sim.now() + SimTime::from_s(s);
        self.exchange_until(|rig| rig.sim.now() >= end);
    }

    /// Moves the throttle stick: 0 to 1000, centered at 500.
    pub fn throttle(&mut self, z: i16) {
        self.say(&MavMessage::MANUAL_CONTROL(MANUAL_CONTROL_DATA { target: 1, z, ..Default::default() }));
    }

    /// Arms and climbs to a height.
    pub fn take_off(&mut self, height_m: f64) {
        let start_m = self.height_m();
        self.command(1, MavCmd::MAV_CMD_COMPONENT_ARM_DISARM, &[1.0]);
        self.exchange_until(|rig| rig.sim.armed());
        self.throttle(1000);
        self.exchange_until(|rig| rig.height_m() > start_m + height_m);
    }

    /// Returns the height above the origin.
    pub fn height_m(&self) -> f64 {
        self.sim.truth().rigid.position_m.enu().up()
    }

    /// Returns the frames that a peer has received with this message.
    pub fn heard(&self, link: LinkId, id: u32) -> Vec<&ReceivedFrame> {
        self.heard.get(&link).into_iter().flatten().filter(|frame| frame.message_id == id).collect()
    }

    /// Returns the sender and the result of the last acknowledgment of a command at the ground station.
    pub fn last_ack(&self, command: MavCmd) -> Option<(u8, MavResult)> {
        let acks = self.heard(STATION, COMMAND_ACK_DATA::ID).into_iter().rev();
        acks.filter_map(|frame| match &frame.message {
            Some(MavMessage::COMMAND_ACK(ack)) if ack.command == command => Some((frame.component_id, ack.result)),
            _ => None,
        })
        .next()
    }
}
