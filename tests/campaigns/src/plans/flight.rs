//! A flight of the synthetic pilot with a planted weakness, in lockstep, and its session record.

use crate::weaknesses::{DroneState, Hands, Weakness};
use spandrel_clients::pilot::{Pilot, PilotConfig};
use spandrel_mavlink::codec::{Decoder, Encoder};
use spandrel_model::scenario::Scenario;
use spandrel_model::site::Site;
use spandrel_model::time::SimTime;
use spandrel_model::vehicle::Vehicle;
use spandrel_monitor::sidecar::build_site;
use spandrel_monitor::{Monitor, MonitorConfig};
use spandrel_sitl::endpoint::{LinkId, LinkKind};
use spandrel_sitl::sim::{Sim, SimConfig};
use spandrel_testkit::shipped;
use spandrel_training::record::{RecordSource, SessionRecord, SourceHashes, record};
use std::sync::Arc;

const PILOT: LinkId = LinkId(1);
const MONITOR: LinkId = LinkId(2);
/// MAVLink IDs of a ground station (QGroundControl's values).
const GROUND_STATION: (u8, u8) = (255, 190);
/// Longest interval between two exchanges of datagrams, simulation time.
const STEP: SimTime = SimTime::from_ms(20);
/// Simulation time after which a pilot that considers the flight finished ends the session: longer than the 3 s for which
/// a landed drone must be at rest.
const PATIENCE: SimTime = SimTime::from_ms(5_000);
/// Simulation time beyond the time limit after which a flight counts as stuck, s.
const EXTRA_TIME_S: f64 = 300.0;
/// The aircraft of all flights.
const AIRCRAFT: &str = "phantom2";

struct PlantedFlight {
    sim: Sim,
    pilot: Pilot,
    monitor: Monitor,
    hands: Hands,
    decoder: Decoder,
    encoder: Encoder,
    tamper: crate::weaknesses::Tamper,
    pilot_done_at: Option<SimTime>,
}

/// Returns the session ID of a flight.
pub fn flight_id(job: &str, weakness: &Weakness, seed: u64) -> String {
    format!("{job}-{}-{seed}", weakness.name)
}

/// Flies a shipped job and returns the session record.
pub fn fly(job_name: &str, weakness: &Weakness, seed: u64) -> SessionRecord {
    let job = Arc::new(shipped::scenario(job_name));
    let aircraft = Arc::new(shipped::vehicle(AIRCRAFT));
    let site = Site::build(&job, seed);
    let placed = site.defects().to_vec();
    // The weakness affects what the pilot intends to fly, not where the defects are.
    let mut belief = (*job).clone();
    belief.defects.placed = Some(placed.clone());
    (weakness.belief)(&mut belief);
    let mut flight = PlantedFlight::new(&job, &aircraft, (site, belief), (weakness, seed));
    flight.run(job.scoring.time_max_s + EXTRA_TIME_S);
    let assessed_session = flight.monitor.finished().unwrap().as_ref().unwrap_or_else(|error| panic!("{error}"));
    record(&RecordSource {
        id: &flight_id(job_name, weakness, seed),
        trainee: "planted",
        purpose: None,
        started_unix_us: 1_000_000,
        spandrel_version: env!("CARGO_PKG_VERSION"),
        scenario: &job,
        vehicle: AIRCRAFT,
        hashes: &SourceHashes::of(b"", b"", b"", b""),
        assessed_session,
        placed: &placed,
        answers: None,
    })
}

impl PlantedFlight {
    fn new(
        job: &Arc<Scenario>,
        aircraft: &Arc<Vehicle>,
        (site, belief): (Site, Scenario),
        (weakness, seed): (&Weakness, u64),
    ) -> Self {
        let config = SimConfig {
            scenario: job.clone(),
            vehicle: aircraft.clone(),
            seed,
            instance: 0,
            flavor: &spandrel_sitl::endpoint::flavor::px4::FLAVOR,
            after_crash: None,
        };
        let site = Arc::new(site);
        let mut sim = Sim::new(config, site.clone());
        sim.open_link(PILOT, LinkKind::GroundStation, true);
        sim.open_link(MONITOR, LinkKind::Payload, true);
        let monitor = Monitor::new(MonitorConfig {
            scenario: (**job).clone(),
            vehicle: (**aircraft).clone(),
            trainee: "planted".to_owned(),
            purpose: None,
            started_unix_us: 0,
            system_id: 1,
            seed: Some(seed),
            survey_builder: build_site,
        });
        let pilot =
            Pilot::new(PilotConfig { scenario: Arc::new(belief), vehicle: aircraft.clone(), skill: weakness.skill, seed });
        Self {
            sim,
            pilot,
            monitor,
            hands: Hands::new(seed, site, job.ground_team.inspector_m, aircraft.limits),
            decoder: Decoder::new(),
            encoder: Encoder::new(GROUND_STATION.0, GROUND_STATION.1),
            tamper: weakness.tamper,
            pilot_done_at: None,
        }
    }

    fn run(&mut self, limit_s: f64) {
        while self.monitor.finished().is_none() {
            assert!(self.sim.now() < SimTime::from_s(limit_s), "the flight did not end: {}", self.pilot.status_text());
            if self.pilot.finished().is_some() {
                self.pilot_done_at.get_or_insert(self.sim.now());
            }
            if self.pilot_done_at.is_some_and(|at| self.sim.now() > at + PATIENCE) {
                self.monitor.close();
                break;
            }
            if !self.sim.waiting() {
                self.sim.handle_timeout(self.sim.now() + STEP);
            } else {
                assert!(self.exchange(), "the pilot or the monitor did not answer the simulator");
            }
            self.exchange();
        }
    }

    fn exchange(&mut self) -> bool {
        let mut any = false;
        while let Some(transmit) = self.sim.poll_transmit() {
            any = true;
            if transmit.link == PILOT {
                self.pilot.handle_datagram(&transmit.bytes);
            } else {
                self.monitor.handle_datagram(&transmit.bytes);
            }
        }
        while let Some(bytes) = self.pilot.poll_transmit() {
            any = true;
            self.hands.observe(&self.pilot.status_text(), drone_state(&self.sim));
            for frame in self.decoder.datagram(&bytes) {
                for message in (self.tamper)(&mut self.hands, frame.message.unwrap()) {
                    let tampered = self.encoder.encode(&message);
                    self.sim.handle_datagram(PILOT, &tampered);
                }
            }
        }
        while let Some(bytes) = self.monitor.poll_transmit() {
            any = true;
            self.sim.handle_datagram(MONITOR, &bytes);
        }
        while self.monitor.poll_record().is_some() {}
        while self.sim.poll_event().is_some() {}
        any
    }
}

fn drone_state(sim: &Sim) -> DroneState {
    let state = sim.truth();
    DroneState {
        position_m: state.rigid.position_m.enu(),
        heading_rad: state.rigid.attitude.yaw_rad(),
        touching: state.contact.touching(),
    }
}
