//! A ground station and a monitor link for an in-process vehicle, without sockets or a clock.

use crate::shipped;
use spandrel_mavlink::codec::{Decoder, Encoder, ReceivedFrame};
use spandrel_mavlink::dialect::{MANUAL_CONTROL_DATA, MavCmd, MavMessage, MavParamType, MavResult, PARAM_SET_DATA};
use spandrel_mavlink::station;
use spandrel_model::geodesy::Geo;
use spandrel_model::scenario::{AfterCrash, Scenario};
use spandrel_model::time::SimTime;
use spandrel_sitl::endpoint::LinkId;
use spandrel_sitl::endpoint::flavor::{self, Flavor};
use spandrel_sitl::testing::{STATION, Vehicle};
use std::ops::{Deref, DerefMut};

/// The ground station's link.
pub const GCS: LinkId = STATION;

/// Returns command parameters; missing ones are 0.
pub fn p(values: &[f32]) -> [f32; 7] {
    station::params(values)
}

/// Returns command parameters with only the first one set.
pub fn one(value: f32) -> [f32; 7] {
    p(&[value])
}

/// Wrapper of [`Vehicle`] for tests: panics if a deadline is missed or a response is not immediate.
#[derive(Debug, Clone)]
pub struct Station {
    pub vehicle: Vehicle,
    /// Decoder for the datagrams of all links.
    decoder: Decoder,
}

impl Deref for Station {
    type Target = Vehicle;
    fn deref(&self) -> &Vehicle {
        &self.vehicle
    }
}

impl DerefMut for Station {
    fn deref_mut(&mut self) -> &mut Vehicle {
        &mut self.vehicle
    }
}

impl Station {
    pub fn new(scenario_name: &str, seed: u64) -> Self {
        Self::of(shipped::scenario(scenario_name), "phantom2", seed)
    }

    /// Creates a station for a custom job and aircraft.
    pub fn of(scenario: Scenario, vehicle: &str, seed: u64) -> Self {
        Self::start(&flavor::px4::FLAVOR, scenario, vehicle, (seed, 0), None)
    }

    /// Creates a station for another emulated autopilot.
    pub fn with_flavor(flavor: &'static Flavor, scenario_name: &str, seed: u64) -> Self {
        Self::start(flavor, shipped::scenario(scenario_name), "phantom2", (seed, 0), None)
    }

    /// Creates a station for one of several vehicles.
    pub fn with_instance(scenario_name: &str, seed: u64, instance: u8) -> Self {
        Self::start(&flavor::px4::FLAVOR, shipped::scenario(scenario_name), "phantom2", (seed, instance), None)
    }

    /// Creates a station with a crash rule that overrides the one in the scenario.
    pub fn with_crash_rule(scenario_name: &str, seed: u64, rule: Option<AfterCrash>) -> Self {
        Self::start(&flavor::px4::FLAVOR, shipped::scenario(scenario_name), "phantom2", (seed, 0), rule)
    }

    fn start(
        flavor: &'static Flavor,
        scenario: Scenario,
        vehicle: &str,
        (seed, instance): (u64, u8),
        after_crash: Option<AfterCrash>,
    ) -> Self {
        let mut builder = Vehicle::builder().flavor(flavor).seed(seed).instance(instance);
        if let Some(rule) = after_crash {
            builder = builder.after_crash(rule);
        }
        Self { vehicle: builder.build_from(scenario, shipped::vehicle(vehicle)), decoder: Decoder::new() }
    }

    /// Sends a raw payload, for values that the dialect cannot represent.
    pub fn send_payload(&mut self, id: u32, payload: &[u8]) {
        let bytes = self.vehicle.encoder.encode_payload(id, payload);
        self.sim.handle_datagram(GCS, &bytes);
    }

    /// Runs for a time, given in ms, and collects the vehicle's messages.
    pub fn run_ms(&mut self, ms: i64) {
        let until = self.sim.now() + SimTime::from_ms(ms);
        self.sim.handle_timeout(until);
        while let Some(transmit) = self.vehicle.sim.poll_transmit() {
            let frames = self.decoder.datagram(&transmit.bytes);
            assert_eq!(self.decoder.bad_bytes(), 0, "all frames must be complete");
            self.vehicle.received.extend(frames);
        }
    }

    /// Decodes one of the vehicle's datagrams.
    pub fn read(&mut self, bytes: &[u8]) -> Vec<ReceivedFrame> {
        self.decoder.datagram(bytes)
    }

    /// Returns all received messages that a filter accepts, in order.
    pub fn all<T>(&self, pick: impl Fn(&MavMessage) -> Option<T>) -> Vec<T> {
        self.received.iter().filter_map(|f| f.message.as_ref()).filter_map(pick).collect()
    }

    /// Returns all status texts received from the vehicle.
    pub fn texts(&self) -> Vec<String> {
        self.all(|m| if let MavMessage::STATUSTEXT(t) = m { t.text.to_str().ok().map(str::to_owned) } else { None })
    }

    /// Returns true if a status text contains this text.
    pub fn has_text(&self, what: &str) -> bool {
        self.texts().iter().any(|text| text.contains(what))
    }

    /// Returns the ground speed in m/s.
    pub fn speed(&self) -> f32 {
        self.last_message(|m| if let MavMessage::LOCAL_POSITION_NED(p) = m { Some(p.vx.hypot(p.vy)) } else { None }).unwrap()
    }

    /// Returns the gimbal pitch in degrees.
    pub fn gimbal_deg(&self) -> f32 {
        let q =
            self.last_message(|m| if let MavMessage::GIMBAL_DEVICE_ATTITUDE_STATUS(g) = m { Some(g.q) } else { None }).unwrap();
        (2.0 * q[2].atan2(q[0])).to_degrees()
    }

    /// Sends a message and returns the first response that a filter accepts; the response must be immediate.
    pub fn ask<T>(&mut self, message: &MavMessage, pick: impl Fn(&MavMessage) -> Option<T>) -> Option<T> {
        self.received.clear();
        self.send(message);
        self.run_ms(1);
        self.received.iter().filter_map(|f| f.message.as_ref()).find_map(pick)
    }

    /// Sets a parameter from the bits of its wire value and returns the value in the response.
    pub fn set(&mut self, name: &str, param_value: f32, param_type: MavParamType) -> Option<f32> {
        let set = PARAM_SET_DATA { param_value, target_system: 1, target_component: 1, param_id: name.into(), param_type };
        self.ask(&MavMessage::PARAM_SET(set), |m| if let MavMessage::PARAM_VALUE(v) = m { Some(v.param_value) } else { None })
    }

    /// Changes the sender's system and component ID on the same link.
    pub fn send_as(&mut self, system: u8, component: u8) {
        self.vehicle.encoder = Encoder::new(system, component);
    }

    /// Runs until a condition is met; returns false if it is not met within the time limit.
    pub fn run_until(&mut self, limit_s: f64, mut done: impl FnMut(&mut Self) -> bool) -> bool {
        let end = self.sim.now() + SimTime::from_s(limit_s);
        while self.sim.now() < end {
            self.run_ms(100);
            if done(self) {
                return true;
            }
            if self.received.len() > 100_000 {
                self.received.drain(..50_000);
            }
        }
        false
    }

    /// Returns the custom mode of the vehicle's heartbeat.
    pub fn mode(&self) -> Option<u32> {
        self.received.iter().rev().filter(|f| f.component_id == 1).find_map(|f| match &f.message {
            Some(MavMessage::HEARTBEAT(beat)) => Some(beat.custom_mode),
            _ => None,
        })
    }

    /// Returns the reported local position: north, east, down, in meters.
    pub fn place(&self) -> [f32; 3] {
        self.last_message(|m| match m {
            MavMessage::LOCAL_POSITION_NED(p) => Some([p.x, p.y, p.z]),
            _ => None,
        })
        .unwrap()
    }

    /// Returns the reported geographic position as north, east, down of the scenario origin, in meters.
    pub fn site_position_m(&self) -> [f64; 3] {
        let place = self.last_message(|m| match m {
            MavMessage::GLOBAL_POSITION_INT(g) => Some(Geo {
                latitude_deg: f64::from(g.lat) * 1e-7,
                longitude_deg: f64::from(g.lon) * 1e-7,
                altitude_m: f64::from(g.alt) * 1e-3,
            }),
            _ => None,
        });
        self.sim.site().plane().enu_from_geo(place.unwrap()).ned().array()
    }

    /// Returns the position after a time in milliseconds.
    pub fn local_position_after(&mut self, ms: i64) -> [f32; 3] {
        self.run_ms(ms.max(25));
        self.place()
    }

    /// Sends a command and returns the result of its acknowledgment, which must be immediate.
    pub fn command(&mut self, component: u8, command: MavCmd, p: [f32; 7]) -> MavResult {
        self.received.clear();
        self.send(&MavMessage::COMMAND_LONG(station::command(1, component, command, p)));
        self.run_ms(2);
        self.last_message(|m| match m {
            MavMessage::COMMAND_ACK(ack) if ack.command == command && ack.target_system == 255 => Some(ack.result),
            _ => None,
        })
        .unwrap_or_else(|| panic!("no acknowledgment of {command:?}"))
    }

    pub fn sticks(&mut self, forward: i16, right: i16, z: i16, yaw: i16) {
        self.send(&MavMessage::MANUAL_CONTROL(MANUAL_CONTROL_DATA {
            target: 1,
            x: forward,
            y: right,
            z,
            r: yaw,
            ..MANUAL_CONTROL_DATA::default()
        }));
    }

    /// Creates a station with the vehicle armed and climbing under manual control to about five meters.
    pub fn airborne(scenario_name: &str, seed: u64) -> Self {
        let mut station = Self::new(scenario_name, seed);
        station.climb_manually();
        station
    }

    /// Arms the vehicle when ready and climbs to about five meters under manual control.
    pub fn climb_manually(&mut self) {
        self.run_ms(2500);
        self.sticks(0, 0, 500, 0);
        self.run_ms(20);
        assert_eq!(self.command(1, MavCmd::MAV_CMD_DO_SET_MODE, p(&[1.0, 3.0])), MavResult::MAV_RESULT_ACCEPTED);
        assert_eq!(self.command(1, MavCmd::MAV_CMD_COMPONENT_ARM_DISARM, one(1.0)), MavResult::MAV_RESULT_ACCEPTED);
        for _ in 0..150 {
            self.sticks(0, 0, 850, 0);
            self.run_ms(20);
        }
    }
}
