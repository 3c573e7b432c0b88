//! One flight of a study: simulator, monitor and synthetic trainee in one thread, in lockstep, without sockets or clocks.
//! The result depends only on the scenario, the aircraft, the pilot and the seed.

use crate::cli::args::Flavor;
use crate::io::pacing::LOCKSTEP_STEP;
use crate::io::stop::StopRequest;
use spandrel_clients::pilot::{Pilot, PilotConfig, Skill};
use spandrel_mavlink::telemetry::sample::truth_time;
use spandrel_mavlink::telemetry::tlog::{self, TlogReader};
use spandrel_model::scenario::Scenario;
use spandrel_model::site::Site;
use spandrel_model::time::SimTime;
use spandrel_model::vehicle::Vehicle;
use spandrel_monitor::measures::cue_validity::{CueLog, CueValidity};
use spandrel_monitor::sidecar::build_site;
use spandrel_monitor::{Assessment, Monitor, MonitorConfig, SessionOutput};
use spandrel_sitl::endpoint::{LinkId, LinkKind};
use spandrel_sitl::sim::{Sim, SimConfig};
use spandrel_text::Language;
use std::panic::{AssertUnwindSafe, catch_unwind};
use std::sync::Arc;
use std::time::Duration;

/// Links of the vehicle, in the same order as in `spandrel demo`.
const PILOT: LinkId = LinkId(1);
const MONITOR: LinkId = LinkId(2);
/// Simulation time beyond the scenario's time limit after which a flight counts as stuck, s: start, landing and the end of
/// the session take less than a minute (estimate).
const EXTRA_TIME_S: f64 = 300.0;

/// Rest of a recorded flight after each step of 20 ms, because it is flown beside a trainee's flight. A step takes about as long
/// (estimate), so half of a core stays free.
const BACKGROUND_REST: Duration = Duration::from_millis(1);

/// Inputs of a flight.
#[derive(Debug, Clone)]
pub struct FlightInputs {
    pub scenario: Arc<Scenario>,
    pub vehicle: Arc<Vehicle>,
    pub skill: Skill,
    pub seed: u64,
}

/// Reason why a flight has no result.
#[derive(Debug, Clone, PartialEq, Eq, thiserror::Error)]
pub enum FlightError {
    /// The study was stopped during the flight.
    #[error("stopped")]
    Stopped,
    /// The flight failed. The same inputs always fail in the same way.
    #[error("{0}")]
    Failed(String),
}

/// A scored flight.
#[derive(Debug, Clone, PartialEq)]
pub struct FlownFlight {
    pub assessment: Assessment,
    /// Comparison of the cues with the frames.
    pub cues: CueValidity,
    /// SHA-256 of the vehicle's state at every tick.
    pub digest: [u8; 32],
}

/// Flies and scores one flight. A panic counts as a failure of this flight.
///
/// # Errors
/// Returns an error if the flight failed or the study was stopped.
pub fn fly(inputs: &FlightInputs, stop: &StopRequest) -> Result<FlownFlight, FlightError> {
    guarded(|| LockstepFlight::new(inputs).run(stop))
}

/// Flies one flight and returns a telemetry log that contains only its ground truth.
///
/// # Errors
/// Returns an error if the flight failed or was stopped.
pub fn record_motion(inputs: &FlightInputs, stop: &StopRequest) -> Result<Vec<u8>, FlightError> {
    guarded(|| {
        let mut flight = LockstepFlight::new(inputs);
        flight.motion = Some(Vec::new());
        let flown = flight.run(stop)?;
        if !flown.assessment.completion.complete {
            return Err(FlightError::Failed(flown.assessment.completion.headline(Language::English)));
        }
        Ok(flight.motion.unwrap_or_default())
    })
}

/// Runs a flight. A panic counts as a failure of this flight.
fn guarded<T>(flight: impl FnOnce() -> Result<T, FlightError>) -> Result<T, FlightError> {
    catch_unwind(AssertUnwindSafe(flight)).unwrap_or_else(|panic| {
        let words = panic.downcast_ref::<String>().map(String::as_str).or_else(|| panic.downcast_ref::<&str>().copied());
        Err(FlightError::Failed(format!("the program panicked: {}", words.unwrap_or("no message"))))
    })
}

/// Returns the simulator of a flight, without links.
fn simulator(inputs: &FlightInputs) -> Sim {
    let FlightInputs { scenario, vehicle, seed, .. } = inputs;
    let config = SimConfig {
        scenario: scenario.clone(),
        vehicle: vehicle.clone(),
        seed: *seed,
        instance: 0,
        flavor: Flavor::Px4.display_name(),
        after_crash: None,
    };
    Sim::new(config, Arc::new(Site::build(scenario, *seed)))
}

struct LockstepFlight {
    sim: Sim,
    pilot: Pilot,
    monitor: Monitor,
    cue_log: CueLog,
    scenario: Arc<Scenario>,
    time_limit: SimTime,
    /// Telemetry log of the ground truth, if it is recorded.
    motion: Option<Vec<u8>>,
}

impl LockstepFlight {
    fn new(inputs: &FlightInputs) -> Self {
        let FlightInputs { scenario, vehicle, skill, seed } = inputs;
        let mut sim = simulator(inputs);
        sim.open_link(PILOT, LinkKind::GroundStation, true);
        sim.open_link(MONITOR, LinkKind::Payload, true);
        let monitor = Monitor::new(MonitorConfig {
            scenario: (**scenario).clone(),
            vehicle: (**vehicle).clone(),
            trainee: "synthetic".to_owned(),
            purpose: None,
            started_unix_us: 0,
            system_id: 1,
            seed: Some(*seed),
            survey_builder: build_site,
        });
        let pilot = Pilot::new(PilotConfig { scenario: scenario.clone(), vehicle: vehicle.clone(), skill: *skill, seed: *seed });
        let time_limit = SimTime::from_s(scenario.scoring.time_max_s + EXTRA_TIME_S);
        Self { sim, pilot, monitor, cue_log: CueLog::default(), scenario: scenario.clone(), time_limit, motion: None }
    }

    fn run(&mut self, stop: &StopRequest) -> Result<FlownFlight, FlightError> {
        while self.monitor.finished().is_none() {
            if self.motion.is_some() {
                std::thread::sleep(BACKGROUND_REST);
            }
            if stop.is_requested() {
                return Err(FlightError::Stopped);
            }
            if self.monitor.refused().is_some() {
                self.monitor.close();
                break;
            }
            if self.sim.now() > self.time_limit {
                let words = self.pilot.status_text();
                return Err(self.failed(&format!("the flight did not end (pilot: {words})")));
            }
            if !self.sim.waiting() {
                self.sim.handle_timeout(self.sim.now() + LOCKSTEP_STEP);
            } else if !self.exchange() {
                return Err(self.failed("the pilot or the monitor did not answer the simulator"));
            }
            self.exchange();
        }
        match self.monitor.finished() {
            Some(Ok(session)) => Ok(FlownFlight {
                assessment: session.assessment.clone(),
                cues: CueValidity::measure(&self.cue_log, &session.frames, &self.scenario),
                digest: self.sim.digest(),
            }),
            Some(Err(error)) => Err(self.failed(&error.to_string())),
            None => Err(self.failed("the session has no result")),
        }
    }

    fn failed(&self, words: &str) -> FlightError {
        FlightError::Failed(format!("{words}, at simulation time {}", self.sim.now()))
    }

    /// Delivers all waiting datagrams, and collects the cues from what a session folder would store. Returns whether there
    /// were any datagrams.
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
            self.sim.handle_datagram(PILOT, &bytes);
        }
        while let Some(bytes) = self.monitor.poll_transmit() {
            any = true;
            self.sim.handle_datagram(MONITOR, &bytes);
        }
        while let Some(record) = self.monitor.poll_record() {
            match record {
                SessionOutput::Event(line) => {
                    if let Ok(event) = serde_json::from_str(&line) {
                        self.cue_log.add_event(&event);
                    }
                }
                SessionOutput::Telemetry(bytes) => self.record_motion(&bytes),
            }
        }
        while self.sim.poll_event().is_some() {}
        any
    }
}

impl LockstepFlight {
    /// Keeps a record of the ground truth, if it is recorded.
    fn record_motion(&mut self, bytes: &[u8]) {
        let Some(motion) = &mut self.motion else { return };
        for record in TlogReader::new(bytes) {
            if truth_time(record.frame).is_some() {
                motion.extend(tlog::record(record.timestamp_us, record.frame));
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::io::files;

    fn inputs(scenario: &str, seed: u64) -> FlightInputs {
        FlightInputs {
            scenario: Arc::new(files::scenario(scenario).unwrap().scenario),
            vehicle: Arc::new(files::vehicle("phantom2").unwrap().vehicle),
            skill: Skill::TRAINED,
            seed,
        }
    }

    #[test]
    fn flight_drill_is_scored_and_reproducible() {
        let stop = StopRequest::default();
        let first = fly(&inputs("drill-hover", 7), &stop).unwrap();
        assert!(first.assessment.completion.complete, "{:?}", first.assessment.completion);
        assert_eq!(fly(&inputs("drill-hover", 7), &stop).unwrap(), first);
        assert_ne!(fly(&inputs("drill-hover", 8), &stop).unwrap().digest, first.digest, "the seed matters");
    }

    #[test]
    fn regress_a_pilot_who_connects_late_flies() {
        let inputs = inputs("drill-hover", 7);
        let mut flight = LockstepFlight::new(&inputs);
        flight.sim = simulator(&inputs);
        while flight.sim.now() < SimTime::from_s(100.0) {
            flight.sim.handle_timeout(flight.sim.now() + LOCKSTEP_STEP);
            while flight.sim.poll_transmit().is_some() || flight.sim.poll_event().is_some() {}
        }
        flight.sim.open_link(PILOT, LinkKind::GroundStation, true);
        flight.sim.open_link(MONITOR, LinkKind::Payload, true);
        let flown = flight.run(&StopRequest::default()).unwrap();
        assert!(flown.assessment.completion.complete, "{:?}", flown.assessment.completion);
    }

    #[test]
    fn exact_stopped_and_stuck_flights_have_no_result() {
        let stop = StopRequest::default();
        let mut stuck = LockstepFlight::new(&inputs("drill-hover", 7));
        stuck.time_limit = SimTime::from_s(1.0);
        let Err(FlightError::Failed(words)) = stuck.run(&stop) else { panic!("ended within a second") };
        assert!(words.starts_with("the flight did not end (pilot: "), "{words}");
        stop.request();
        assert_eq!(fly(&inputs("drill-hover", 7), &stop), Err(FlightError::Stopped));
    }
}
