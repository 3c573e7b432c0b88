//! The synthetic expert's flight of a job, flown in the background: the ghost of trainees who have no complete flight of it yet.

use crate::cli::study::flight::{FlightInputs, record_motion};
use crate::errors::AppError;
use crate::io::replace::replace;
use crate::io::stop::StopRequest;
use spandrel_clients::pilot::Skill;
use spandrel_model::scenario::Scenario;
use spandrel_model::vehicle::Vehicle;
use spandrel_view::flow::pipe::GhostFlight;
use std::path::{Path, PathBuf};
use std::sync::Arc;
use std::sync::mpsc::{Receiver, channel};

/// Folder in the sessions folder with the expert's flights. Its name starts with a dot, so that it is no session.
const FOLDER: &str = ".ghosts";
/// Seed of the expert's flights. It affects gusts, sensor noise, traffic and defects, but not the paths.
const SEED: u64 = 1;

/// A job that the expert flies for a ghost.
#[derive(Debug, Clone)]
pub struct GhostJob {
    file: PathBuf,
    scenario: Scenario,
    vehicle: Vehicle,
    /// Whose flight it is, for the trainee.
    words: String,
}

impl GhostJob {
    /// Creates a job whose flight is stored below the sessions folder. `None` for a lesson, which has no tasks for the expert.
    pub fn new(sessions: &Path, scenario: Scenario, vehicle: Vehicle, words: String) -> Option<Self> {
        let name = format!("{}-{:08x}-{}.tlog", scenario.name, scenario.crc, vehicle.id);
        let file = sessions.join(FOLDER).join(name);
        scenario.lesson.is_empty().then_some(Self { file, scenario, vehicle, words })
    }

    /// Returns the expert's flight, if it was flown earlier.
    pub fn flown(&self) -> Option<GhostFlight> {
        self.file.is_file().then(|| GhostFlight { telemetry: self.file.clone(), words: self.words.clone() })
    }

    /// Flies the job and stores the flight.
    fn fly(&self, stop: &StopRequest) -> Result<(), AppError> {
        let (scenario, vehicle) = (Arc::new(self.scenario.clone()), Arc::new(self.vehicle.clone()));
        let inputs = FlightInputs { scenario, vehicle, skill: Skill::EXPERT, seed: SEED };
        let motion = record_motion(&inputs, stop).map_err(|error| AppError::failed(error.to_string()))?;
        if let Some(folder) = self.file.parent() {
            std::fs::create_dir_all(folder).map_err(|error| AppError::failed(format!("{}: {error}", folder.display())))?;
        }
        replace(&self.file, &motion)
    }
}

/// The expert of one attempt of the trainee: the job to fly, or its flight.
#[derive(Default)]
pub struct BackgroundExpert {
    /// Job that is not flown yet.
    job: Option<GhostJob>,
    flight: Option<ExpertFlight>,
}

impl BackgroundExpert {
    /// Creates an expert without starting the flight. Without a job, there is nothing to fly.
    pub fn new(job: Option<GhostJob>) -> Self {
        Self { job, flight: None }
    }

    /// Starts the flight, unless it is already flown.
    pub fn start(&mut self) {
        if let Some(job) = self.job.take() {
            self.flight = Some(ExpertFlight::start(job));
        }
    }

    /// Continues the flight of an earlier attempt at the same job. The flight of another job stops.
    pub fn take_over(&mut self, earlier: Self) {
        let flies_this = |flight: &ExpertFlight| self.job.as_ref().is_some_and(|job| job.file == flight.file);
        if let Some(flight) = earlier.flight.filter(flies_this) {
            (self.job, self.flight) = (None, Some(flight));
        }
    }

    /// Returns the flight once, when it is ready.
    pub fn poll(&self) -> Option<GhostFlight> {
        self.flight.as_ref().and_then(ExpertFlight::poll)
    }
}

/// The expert's flight while it is flown. It stops when this is dropped.
struct ExpertFlight {
    file: PathBuf,
    stop: StopRequest,
    result: Receiver<Option<GhostFlight>>,
}

impl ExpertFlight {
    /// Starts the flight in another thread.
    fn start(job: GhostJob) -> Self {
        let (file, stop) = (job.file.clone(), StopRequest::default());
        let (sender, result) = channel();
        let stopped = stop.clone();
        std::thread::spawn(move || {
            let flown = job.fly(&stopped);
            if let Err(error) = &flown
                && !stopped.is_requested()
            {
                tracing::warn!("no ghost: the expert cannot fly {}: {error}", job.scenario.name);
            }
            // Sending fails only if the trainee's flight has ended.
            let _ = sender.send(job.flown());
        });
        Self { file, stop, result }
    }

    fn poll(&self) -> Option<GhostFlight> {
        self.result.try_recv().ok().flatten()
    }
}

impl Drop for ExpertFlight {
    fn drop(&mut self) {
        self.stop.request();
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::io::files;
    use crate::io::log_file::LogFile;
    use spandrel_mavlink::telemetry::Timeline;
    use spandrel_model::geodesy::LocalPlane;

    #[test]
    fn flight_expert_flies_a_drill_once_and_the_flight_is_kept() {
        let sessions = tempfile::tempdir().unwrap();
        let (scenario, vehicle) = (files::scenario("drill-hover").unwrap().scenario, files::vehicle("phantom2").unwrap().vehicle);
        let job = GhostJob::new(sessions.path(), scenario.clone(), vehicle.clone(), "the expert's flight".into()).unwrap();
        assert_eq!(job.flown(), None);
        let flight = ExpertFlight::start(job.clone());
        let ghost = flight.result.recv().unwrap().unwrap();
        assert_eq!(job.flown(), Some(ghost.clone()));
        let mut timeline = Timeline::new(LocalPlane::new(scenario.origin));
        timeline.push_log(&LogFile::open(&ghost.telemetry).unwrap()).unwrap();
        let flown = timeline.flight(0);
        assert!(flown.lift_off(scenario.ground_team.pad_m.up(), 0.3).is_some() && flown.truths.len() > 1_000);
        let lesson = files::scenario("first-flight").unwrap().scenario;
        assert!(GhostJob::new(sessions.path(), lesson, vehicle, String::new()).is_none());
    }

    #[test]
    fn regress_a_restarted_attempt_does_not_restart_the_expert() {
        let sessions = tempfile::tempdir().unwrap();
        let expert = |name: &str| {
            let (scenario, vehicle) = (files::scenario(name).unwrap().scenario, files::vehicle("phantom2").unwrap().vehicle);
            BackgroundExpert::new(GhostJob::new(sessions.path(), scenario, vehicle, String::new()))
        };
        let mut first = expert("two-bridges");
        first.start();
        let stop = first.flight.as_ref().unwrap().stop.clone();
        let mut second = expert("two-bridges");
        second.take_over(first);
        second.start();
        assert!(!stop.is_requested() && second.job.is_none() && second.flight.is_some());
        let mut other = expert("practice");
        other.take_over(second);
        assert!(stop.is_requested() && other.flight.is_none(), "another job needs another flight");
        let mut none = BackgroundExpert::default();
        none.start();
        assert!(none.flight.is_none() && none.poll().is_none());
    }
}
