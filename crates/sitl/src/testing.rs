//! In-process vehicle for tests and scripts. It uses no sockets and no clock, runs as fast as the machine allows, and
//! produces identical results in every run.
//!
//! ```
//! use spandrel_model::shipped;
//! use spandrel_model::time::SimTime;
//! use spandrel_sitl::testing::Vehicle;
//!
//! # fn main() -> Result<(), Box<dyn std::error::Error>> {
//! let mut vehicle = Vehicle::builder().scenario(shipped::DRILL_HOVER).seed(7).build()?;
//! vehicle.arm(SimTime::from_s(30.0))?;
//! vehicle.take_off(5.0)?;
//! vehicle.run_until(|v| v.height_m() > 4.5, SimTime::from_s(20.0))?;
//! # Ok(())
//! # }
//! ```
//!
//! The harness controls the vehicle as a ground station would, with MAVLink frames through the same interface.
//! [`Vehicle::sim`] gives access to the simulator for further links, the true state and the digest.

use crate::endpoint::flavor::{Flavor, px4};
use crate::endpoint::{LinkId, LinkKind, Transmit};
use crate::sim::{Sim, SimConfig};
use spandrel_mavlink::codec::{Decoder, Encoder, ReceivedFrame};
use spandrel_mavlink::dialect::{MANUAL_CONTROL_DATA, MavCmd, MavMessage, MavModeFlag, MavResult};
use spandrel_mavlink::station;
use spandrel_model::frames::{Enu, Vec3};
use spandrel_model::scenario::{self, AfterCrash, Scenario};
use spandrel_model::site::Site;
use spandrel_model::time::SimTime;
use spandrel_model::toml::Problems;
use spandrel_model::{shipped, vehicle};
use std::collections::VecDeque;
use std::sync::Arc;

/// Link that the harness uses.
pub const STATION: LinkId = LinkId(1);
/// MAVLink system and component ID of the harness: the usual values for a ground station.
const STATION_ID: (u8, u8) = (255, 190);
/// Interval between checks of a condition.
const CHECK_INTERVAL: SimTime = SimTime::from_ms(20);
/// Maximum number of frames kept for [`Vehicle::last_message`]: about twenty seconds of all streams.
const MAX_KEPT_FRAMES: usize = 20_000;

/// An expected response or condition that did not occur.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
pub enum MissedExpectation {
    /// The command was not accepted.
    #[error("{command:?} was rejected with {result:?}; last status text: {last_status_text}")]
    Refused {
        /// The rejected command.
        command: MavCmd,
        /// The result that the vehicle returned.
        result: MavResult,
        /// The vehicle's latest status text.
        last_status_text: String,
    },
    /// No response within one second of simulation time.
    #[error("no response to {0:?}")]
    NoResponse(MavCmd),
    /// A condition was not met in time.
    #[error("condition not met within {limit_s} s of simulation time; last status text: {last_status_text}")]
    TimedOut {
        /// The time limit in whole seconds.
        limit_s: i64,
        /// The vehicle's latest status text.
        last_status_text: String,
    },
}

/// Builder for a [`Vehicle`]. Defaults: the hover drill, the phantom2 aircraft, seed 1, PX4.
#[derive(Debug, Clone)]
pub struct VehicleBuilder {
    scenario: String,
    vehicle: String,
    seed: u64,
    flavor: &'static Flavor,
    instance: u8,
    after_crash: Option<AfterCrash>,
}

impl Default for VehicleBuilder {
    fn default() -> Self {
        Self {
            scenario: shipped::DRILL_HOVER.to_owned(),
            vehicle: shipped::PHANTOM2.to_owned(),
            seed: 1,
            flavor: &px4::FLAVOR,
            instance: 0,
            after_crash: None,
        }
    }
}

impl VehicleBuilder {
    /// Sets the scenario from the text of a scenario file, for example one of [`shipped`]. Does not load height fields
    /// that it references.
    #[must_use]
    pub fn scenario(mut self, text: impl Into<String>) -> Self {
        self.scenario = text.into();
        self
    }

    /// Sets the aircraft from the text of a vehicle file.
    #[must_use]
    pub fn vehicle(mut self, text: impl Into<String>) -> Self {
        self.vehicle = text.into();
        self
    }

    /// Sets the seed for gusts, sensor noise, traffic and defects.
    #[must_use]
    pub fn seed(mut self, seed: u64) -> Self {
        self.seed = seed;
        self
    }

    /// Sets the emulated autopilot.
    #[must_use]
    pub fn flavor(mut self, flavor: &'static Flavor) -> Self {
        self.flavor = flavor;
        self
    }

    /// Sets the zero-based vehicle number. The MAVLink system ID is one higher.
    #[must_use]
    pub fn instance(mut self, instance: u8) -> Self {
        self.instance = instance;
        self
    }

    /// Overrides the scenario's action after a crash.
    #[must_use]
    pub fn after_crash(mut self, rule: AfterCrash) -> Self {
        self.after_crash = Some(rule);
        self
    }

    /// Builds the vehicle on its landing pad with motors off.
    ///
    /// # Errors
    /// Returns all problems in the scenario or, if the scenario is valid, in the vehicle, each with its line and key.
    pub fn build(self) -> Result<Vehicle, Problems> {
        let job = scenario::read("scenario.toml", &self.scenario, &|file| {
            Err(format!("{file}: the builder does not load referenced files"))
        })?;
        let aircraft = vehicle::read("vehicle.toml", &self.vehicle)?;
        Ok(self.build_from(job, aircraft))
    }

    /// Builds the vehicle on its landing pad, with motors off, from a parsed scenario and aircraft. Ignores the texts
    /// set in the builder.
    #[must_use]
    pub fn build_from(self, job: Scenario, aircraft: vehicle::Vehicle) -> Vehicle {
        let site = Arc::new(Site::build(&job, self.seed));
        let config = SimConfig {
            scenario: Arc::new(job),
            vehicle: Arc::new(aircraft),
            seed: self.seed,
            instance: self.instance,
            flavor: self.flavor,
            after_crash: self.after_crash,
        };
        let pad_height_m = config.scenario.ground_team.pad_m.up();
        let mut sim = Sim::new(config, site);
        sim.open_link(STATION, LinkKind::GroundStation, false);
        Vehicle {
            sim,
            flavor: self.flavor,
            system_id: self.instance + 1,
            pad_height_m,
            encoder: Encoder::new(STATION_ID.0, STATION_ID.1),
            decoder: Decoder::new(),
            received: Vec::new(),
            others: VecDeque::new(),
        }
    }
}

/// A simulated vehicle and the ground station that controls it.
#[derive(Debug, Clone)]
pub struct Vehicle {
    /// The simulator: further links, true state, failures, digest.
    pub sim: Sim,
    /// Encoder of the harness. Change its system or component ID to simulate another sender on the same link.
    pub encoder: Encoder,
    /// Received frames, oldest first; only the most recent ones are kept.
    pub received: Vec<ReceivedFrame>,
    flavor: &'static Flavor,
    system_id: u8,
    pad_height_m: f64,
    decoder: Decoder,
    others: VecDeque<Transmit>,
}

impl Vehicle {
    /// Returns a builder with the default settings.
    #[must_use]
    pub fn builder() -> VehicleBuilder {
        VehicleBuilder::default()
    }

    /// Returns the simulator without its ground station. Closes the station's link.
    #[must_use]
    pub fn into_sim(mut self) -> Sim {
        self.sim.close_link(STATION);
        self.sim
    }

    /// Returns the next datagram for any link except the harness link.
    pub fn poll_transmit(&mut self) -> Option<Transmit> {
        self.others.pop_front()
    }

    /// Returns the current simulation time.
    #[must_use]
    pub fn now(&self) -> SimTime {
        self.sim.now()
    }

    /// Returns the latest message for which `pick` returns a value.
    pub fn last_message<T>(&self, pick: impl Fn(&MavMessage) -> Option<T>) -> Option<T> {
        self.received.iter().rev().filter_map(|frame| frame.message.as_ref()).find_map(pick)
    }

    /// Returns the vehicle's latest status text; empty before the first one.
    #[must_use]
    pub fn status_texts(&self) -> String {
        let text =
            |m: &MavMessage| if let MavMessage::STATUSTEXT(t) = m { t.text.to_str().ok().map(str::to_owned) } else { None };
        self.last_message(text).unwrap_or_default()
    }

    /// Returns true if the autopilot's latest heartbeat reports armed. Heartbeats arrive once per second, so this changes up to
    /// a second after [`Self::arm`] returns.
    #[must_use]
    pub fn armed(&self) -> bool {
        let beats = self.received.iter().rev().filter(|frame| frame.component_id == 1);
        let armed = |frame: &ReceivedFrame| match &frame.message {
            Some(MavMessage::HEARTBEAT(beat)) => Some(beat.base_mode.contains(MavModeFlag::MAV_MODE_FLAG_SAFETY_ARMED)),
            _ => None,
        };
        beats.into_iter().find_map(armed).unwrap_or(false)
    }

    /// Returns the true position in the scenario's frame, in meters.
    #[must_use]
    pub fn position_m(&self) -> Vec3<Enu> {
        self.sim.truth().rigid.position_m.enu()
    }

    /// Returns the true height above the landing pad, in meters.
    #[must_use]
    pub fn height_m(&self) -> f64 {
        self.position_m().up() - self.pad_height_m
    }

    /// Sends a message as the ground station. The vehicle processes it at the next tick.
    pub fn send(&mut self, message: &MavMessage) {
        let bytes = self.encoder.encode(message);
        self.sim.handle_datagram(STATION, &bytes);
    }

    /// Advances simulation time. With a lockstep link, it stops when the peer must respond; [`Sim::waiting`] then returns true.
    pub fn run(&mut self, time: SimTime) {
        self.sim.handle_timeout(self.sim.now() + time);
        while let Some(transmit) = self.sim.poll_transmit() {
            if transmit.link == STATION {
                self.received.extend(self.decoder.datagram(&transmit.bytes));
            } else {
                self.others.push_back(transmit);
            }
        }
        if self.received.len() > 2 * MAX_KEPT_FRAMES {
            self.received.drain(..self.received.len() - MAX_KEPT_FRAMES);
        }
    }

    /// Runs until a condition is met and returns the elapsed time.
    ///
    /// # Errors
    /// Returns an error if the condition was not met in time.
    pub fn run_until(&mut self, mut holds: impl FnMut(&Self) -> bool, limit: SimTime) -> Result<SimTime, MissedExpectation> {
        let start = self.now();
        while !holds(self) {
            if self.now() - start >= limit {
                return Err(MissedExpectation::TimedOut { limit_s: limit.ms() / 1000, last_status_text: self.status_texts() });
            }
            self.run(CHECK_INTERVAL);
        }
        Ok(self.now() - start)
    }

    /// Sends a command to the autopilot. Missing parameters are 0.
    ///
    /// # Errors
    /// Returns an error if the command was rejected or there was no response within one second.
    pub fn command(&mut self, command: MavCmd, params: &[f32]) -> Result<(), MissedExpectation> {
        self.request(command, &MavMessage::COMMAND_LONG(station::command(self.system_id, 1, command, station::params(params))))
    }

    fn request(&mut self, command: MavCmd, message: &MavMessage) -> Result<(), MissedExpectation> {
        let before = self.received.len();
        self.send(message);
        let answer = |heard: &[ReceivedFrame]| {
            heard.iter().find_map(|frame| match &frame.message {
                Some(MavMessage::COMMAND_ACK(ack)) if ack.command == command => Some(ack.result),
                _ => None,
            })
        };
        let limit = self.now() + SimTime::from_ms(1_000);
        while self.now() < limit {
            self.run(SimTime::from_ms(1));
            match answer(self.received.get(before..).unwrap_or(&self.received)) {
                None | Some(MavResult::MAV_RESULT_IN_PROGRESS) => {}
                Some(MavResult::MAV_RESULT_ACCEPTED) => return Ok(()),
                Some(result) => {
                    return Err(MissedExpectation::Refused { command, result, last_status_text: self.status_texts() });
                }
            }
        }
        Err(MissedExpectation::NoResponse(command))
    }

    /// Arms as soon as the vehicle allows it.
    ///
    /// # Errors
    /// Returns the last rejection if the vehicle did not arm within the limit.
    pub fn arm(&mut self, limit: SimTime) -> Result<(), MissedExpectation> {
        let end = self.now() + limit;
        loop {
            let result = self.command(MavCmd::MAV_CMD_COMPONENT_ARM_DISARM, &[1.0]);
            if result.is_ok() || self.now() >= end {
                return result;
            }
            self.run(SimTime::from_ms(500));
        }
    }

    /// Takes off to a height above the landing pad, m. ArduCopter takes off in GUIDED mode.
    ///
    /// # Errors
    /// Returns an error if the command was rejected.
    pub fn take_off(&mut self, height_m: f64) -> Result<(), MissedExpectation> {
        if let Some(guided) = self.flavor.goto_mode {
            self.command(MavCmd::MAV_CMD_DO_SET_MODE, &[1.0, guided as f32])?;
            return self.command(MavCmd::MAV_CMD_NAV_TAKEOFF, &[0.0, 0.0, 0.0, 0.0, 0.0, 0.0, height_m as f32]);
        }
        let place_m = self.position_m() + Vec3::new(0.0, 0.0, height_m - self.height_m());
        let command = MavCmd::MAV_CMD_NAV_TAKEOFF;
        self.request(command, &self.command_at(command, place_m, [0.0, 0.0, 0.0, f32::NAN]))
    }

    /// Flies to a position in the scenario's frame, m, and holds there.
    ///
    /// # Errors
    /// Returns an error if the command was rejected.
    pub fn go_to(&mut self, position_m: Vec3<Enu>) -> Result<(), MissedExpectation> {
        let command = MavCmd::MAV_CMD_DO_REPOSITION;
        // Bit 0 of parameter 2 requests a change to a mode that can fly there.
        self.request(command, &self.command_at(command, position_m, [-1.0, 1.0, 0.0, f32::NAN]))
    }

    /// Lands at the current position.
    ///
    /// # Errors
    /// Returns an error if the command was rejected.
    pub fn land(&mut self) -> Result<(), MissedExpectation> {
        self.command(MavCmd::MAV_CMD_NAV_LAND, &[0.0, 0.0, 0.0, f32::NAN])
    }

    /// Sends one stick input: forward, right and yaw from -1 to 1, up from 0 to 1, where 0.5 holds the height. Send it
    /// at 2 Hz or faster.
    pub fn sticks(&mut self, forward: f64, right: f64, up: f64, yaw: f64) {
        let axis = |share: f64| (1000.0 * share.clamp(-1.0, 1.0)).round() as i16;
        self.send(&MavMessage::MANUAL_CONTROL(MANUAL_CONTROL_DATA {
            target: self.system_id,
            x: axis(forward),
            y: axis(right),
            z: axis(up),
            r: axis(yaw),
            ..MANUAL_CONTROL_DATA::default()
        }));
    }

    /// Returns a command to the autopilot at a position in the scenario's frame, in meters.
    fn command_at(&self, command: MavCmd, position_m: Vec3<Enu>, params: [f32; 4]) -> MavMessage {
        let place = self.sim.site().plane().geo_from_enu(position_m);
        MavMessage::COMMAND_INT(station::command_at(self.system_id, 1, command, params, place))
    }
}
