//! A flight in the window: receives its telemetry and loads its scene.

use super::listener::TelemetryListener;
use super::panes::{PaneContent, RenderJob, ViewFrame, ViewOptions, ViewPanes};
use super::screen::WindowSurface;
use crate::errors::AppError;
use crate::io::log_file::LogFile;
use spandrel_mavlink::telemetry::Timeline;
use spandrel_model::geodesy::LocalPlane;
use spandrel_model::scenario::Scenario;
use spandrel_model::site::inspector_path::{InspectorPath, InspectorPosition};
use spandrel_model::vehicle::Vehicle;
use spandrel_view::arrange::{ViewKind, ViewRect};
use spandrel_view::flown_path::FlownPath;
use spandrel_view::ghost::{Ghost, GhostPath};
use spandrel_view::live::LiveMoment;
use spandrel_view::quality::Quality;
use spandrel_view::scene::LoadingStep;
use spandrel_view::stage::LIFTOFF_HEIGHT_M;
use std::net::{IpAddr, SocketAddr};
use std::path::{Path, PathBuf};
use std::sync::mpsc::{Receiver, TryRecvError, channel};
use std::time::Duration;

/// State of a flight's scene.
pub enum SceneLoading {
    /// Waiting for the session's seed.
    Waiting,
    /// Building the site and its lighting: the current step, and the thread's messages.
    Building(LoadingStep, Receiver<LoadingMessage>),
    /// Ready to render.
    Ready(Box<ViewPanes>),
}

/// Message from the thread that builds the scene.
pub enum LoadingMessage {
    /// A step begins.
    Step(LoadingStep),
    /// The scene is ready.
    Done(Box<RenderJob>),
}

/// Seed for the defects and traffic in the scene.
#[derive(Debug, Default)]
struct SceneSeed {
    /// Seed that was passed to the window.
    requested_seed: Option<u64>,
    /// Seed of the current scene.
    built_seed: Option<u64>,
    /// True once a mismatch with the simulator's seed has been logged.
    mismatch_reported: bool,
}

impl SceneSeed {
    /// Returns the seed to build the scene with: the simulator's seed, the requested seed, or `otherwise`, in that
    /// order of preference.
    fn seed(&self, said: Option<u64>, otherwise: Option<u64>) -> Option<u64> {
        said.or(self.requested_seed).or(otherwise)
    }

    /// Returns the scene's seed and the simulator's seed if they differ.
    fn built_seed_mismatch(&self, said: Option<u64>) -> Option<(u64, u64)> {
        self.built_seed.zip(said).filter(|(built, said)| built != said)
    }

    /// Returns the requested seed and the simulator's seed the first time they differ.
    fn requested_seed_mismatch(&mut self, said: Option<u64>) -> Option<(u64, u64)> {
        let differ = self.requested_seed.zip(said).filter(|(given, said)| !self.mismatch_reported && given != said);
        self.mismatch_reported |= differ.is_some();
        differ
    }
}

/// A flight in the window.
pub struct FlightView {
    /// The flight's scenario and aircraft.
    pub job: (Scenario, Vehicle),
    /// Telemetry listener.
    pub listener: TelemetryListener,
    /// Scene state.
    pub scene: SceneLoading,
    session: SceneSeed,
    /// Time of the first rendered frame.
    pub first_frame_at: Option<Duration>,
    /// Number of rendered frames.
    pub frame_count: u32,
    /// Ghost of an earlier flight.
    ghost: GhostLoading,
}

/// State of the ghost.
enum GhostLoading {
    /// No earlier flight, or it could not be read.
    None,
    /// A thread reads the earlier flight.
    Reading(Receiver<GhostPath>),
    /// Ready to fly.
    Ready(Box<Ghost>),
}

impl FlightView {
    /// Connects to a vehicle. `seed` is the session's seed, if it is known before the simulator reports it.
    ///
    /// # Errors
    /// Returns an error if the socket cannot be opened.
    pub fn begin(listen: IpAddr, vehicle: SocketAddr, job: (Scenario, Vehicle), seed: Option<u64>) -> Result<Self, AppError> {
        let listener = TelemetryListener::connect(listen, vehicle, &job.0)?;
        let session = SceneSeed { requested_seed: seed, ..SceneSeed::default() };
        Ok(Self {
            job,
            listener,
            scene: SceneLoading::Waiting,
            session,
            first_frame_at: None,
            frame_count: 0,
            ghost: GhostLoading::None,
        })
    }

    /// Reads an earlier flight for the ghost in another thread. If it cannot be read, there is no ghost.
    pub fn load_ghost(&mut self, telemetry: PathBuf) {
        let (sender, receiver) = channel();
        let scenario = self.job.0.clone();
        std::thread::spawn(move || match ghost_path(&telemetry, &scenario) {
            // Sending fails only if the flight has since ended.
            Ok(Some(path)) => drop(sender.send(path)),
            Ok(None) => tracing::warn!("no ghost: {} contains no flight", telemetry.display()),
            Err(error) => tracing::warn!("no ghost: {error}"),
        });
        self.ghost = GhostLoading::Reading(receiver);
    }

    /// Returns the ghost once it is ready.
    pub fn ghost(&mut self) -> Option<&mut Ghost> {
        if let GhostLoading::Reading(receiver) = &self.ghost {
            match receiver.try_recv() {
                Ok(path) => self.ghost = GhostLoading::Ready(Box::new(Ghost::new(path))),
                Err(TryRecvError::Empty) => {}
                Err(TryRecvError::Disconnected) => self.ghost = GhostLoading::None,
            }
        }
        match &mut self.ghost {
            GhostLoading::Ready(ghost) => Some(ghost),
            GhostLoading::None | GhostLoading::Reading(_) => None,
        }
    }

    /// Returns the current state to render.
    pub fn now(&self) -> Option<LiveMoment> {
        self.listener.live().moment(self.listener.wall(), &self.job.1)
    }

    /// Returns the inspector: over the ground of the scene, once it is ready.
    pub fn inspector(&self, now: &LiveMoment) -> InspectorPosition {
        self.panes().map_or_else(|| self.inspector_path(now).at(now.moment.at), |panes| panes.inspector(now))
    }

    /// Returns the number of the place to which the inspector walks next; `None` if the job has only one place.
    pub fn next_place(&self, now: &LiveMoment) -> Option<u8> {
        self.inspector_path(now).next_place(now.moment.at)
    }

    fn inspector_path(&self, now: &LiveMoment) -> InspectorPath {
        InspectorPath::new(&self.job.0.ground_team).with_walks(now.site_changes.walks.clone(), None)
    }

    /// Advances from waiting to building to rendering as data arrives, and returns to waiting if the simulator starts
    /// another session.
    ///
    /// # Errors
    /// Returns an error if the simulator uses a different scenario.
    pub fn prepare(&mut self, screen: &WindowSurface, quality: Quality, now: Option<&LiveMoment>) -> Result<(), AppError> {
        let (said, crc, real) = {
            let (wall, live) = (self.listener.wall(), self.listener.live());
            (live.seed(), live.scenario_crc(), live.has_no_truth(wall))
        };
        if crc.is_some_and(|crc| crc != self.job.0.crc) {
            return Err(AppError::invalid(
                "the simulator and this window use different scenarios: start both with the same --scenario",
            ));
        }
        self.follow_seed(said);
        match &mut self.scene {
            SceneLoading::Waiting => {
                // The simulator's seed takes precedence over the scenario's seed. Real vehicles do not report a seed.
                let seed = self.session.seed(said, real.then_some(self.job.0.seed.unwrap_or(0)));
                let (Some(seed), Some(now)) = (seed, now) else { return Ok(()) };
                let ((scenario, vehicle), at) = (self.job.clone(), now.moment.at);
                tracing::info!("rendering with {}, {}, seed {seed}", screen.gpu.name, quality.name);
                let (sender, receiver) = channel();
                std::thread::spawn(move || {
                    // Sending fails only if the window has since been closed.
                    let report = |step: LoadingStep| drop(sender.send(LoadingMessage::Step(step)));
                    let job = RenderJob::build(scenario, vehicle, seed, (&quality, at), &report);
                    let _ = sender.send(LoadingMessage::Done(Box::new(job)));
                });
                self.session.built_seed = Some(seed);
                self.scene = SceneLoading::Building(LoadingStep::Site, receiver);
            }
            SceneLoading::Building(current, receiver) => match receiver.try_recv() {
                Ok(LoadingMessage::Step(step)) => *current = step,
                Ok(LoadingMessage::Done(job)) => {
                    self.scene = SceneLoading::Ready(Box::new(ViewPanes::new(screen, quality, *job)))
                }
                Err(TryRecvError::Empty) => {}
                Err(TryRecvError::Disconnected) => {
                    return Err(AppError::failed("the scene could not be built (see the message in the terminal)"));
                }
            },
            SceneLoading::Ready(_) => {}
        }
        Ok(())
    }

    /// Switches to the simulator's seed, which takes precedence over the requested seed and any earlier session's seed.
    fn follow_seed(&mut self, said: Option<u64>) {
        if let Some((given, said)) = self.session.requested_seed_mismatch(said) {
            tracing::warn!("requested seed {given}, but the simulator uses seed {said}; using the simulator's seed");
        }
        if let Some((built, said)) = self.session.built_seed_mismatch(said) {
            tracing::info!("the simulator now uses seed {said} instead of {built}; rebuilding defects and traffic");
            self.session.built_seed = None;
            if matches!(self.scene, SceneLoading::Ready(_)) {
                self.scene = SceneLoading::Waiting;
            }
        }
    }

    /// Renders the views, if the scene is ready.
    ///
    /// # Errors
    /// Returns an error if a device fails.
    pub fn draw(
        &mut self,
        screen: &WindowSurface,
        places: &[ViewRect],
        now: Option<&LiveMoment>,
        options: &ViewOptions,
    ) -> Result<Vec<PaneContent>, AppError> {
        let (SceneLoading::Ready(panes), Some(now)) = (&mut self.scene, now) else { return Ok(Vec::new()) };
        let is_map_large = places.iter().any(|place| place.which == ViewKind::Map);
        let (feed, flown) = {
            let live = self.listener.live();
            (live.feed().clone(), if is_map_large { live.flown_path().clone() } else { FlownPath::default() })
        };
        panes.draw(&ViewFrame { screen, places, now, feed: &feed, options }, flown)
    }

    /// Begins the camera's next picture where a second device renders it.
    ///
    /// # Errors
    /// Returns an error if a device fails.
    pub fn begin_camera(
        &mut self,
        screen: &WindowSurface,
        places: &[ViewRect],
        now: Option<&LiveMoment>,
        options: &ViewOptions,
    ) -> Result<(), AppError> {
        let (SceneLoading::Ready(panes), Some(now)) = (&mut self.scene, now) else { return Ok(()) };
        let feed = self.listener.live().feed().clone();
        panes.begin_camera(&ViewFrame { screen, places, now, feed: &feed, options })
    }

    /// Returns both views, once the scene is ready.
    pub fn panes(&self) -> Option<&ViewPanes> {
        match &self.scene {
            SceneLoading::Ready(panes) => Some(panes),
            SceneLoading::Waiting | SceneLoading::Building(..) => None,
        }
    }

    /// Logs the frame rate.
    pub fn end(self, lasted_since: impl Fn(Duration) -> Duration) {
        let Some(first) = self.first_frame_at else { return };
        tracing::info!(
            "rendered {} frames of both views ({:.1} frames per second)",
            self.frame_count,
            f64::from(self.frame_count) / lasted_since(first).as_secs_f64().max(1e-3)
        );
    }
}

/// Reads the path of an earlier flight of a job; `None` if it contains no flight.
fn ghost_path(telemetry: &Path, scenario: &Scenario) -> Result<Option<GhostPath>, AppError> {
    let mut timeline = Timeline::new(LocalPlane::new(scenario.origin));
    let log = LogFile::open(telemetry)?;
    timeline.push_log(&log).map_err(|error| AppError::failed(format!("{}: {error}", telemetry.display())))?;
    let pad_height_m = scenario.ground_team.pad_m.up();
    let mut flights = (0..timeline.epoch_count()).map(|epoch| timeline.flight(epoch));
    Ok(flights.find_map(|flight| GhostPath::of(&flight, pad_height_m, LIFTOFF_HEIGHT_M)))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn exact_simulator_seed_takes_precedence() {
        let given = SceneSeed { requested_seed: Some(5), ..SceneSeed::default() };
        assert_eq!((given.seed(None, None), given.seed(Some(7), Some(1))), (Some(5), Some(7)));
        let free = SceneSeed::default();
        assert_eq!((free.seed(None, None), free.seed(None, Some(1)), free.seed(Some(7), Some(1))), (None, Some(1), Some(7)));
    }

    #[test]
    fn exact_seed_mismatches_are_reported_once() {
        let mut session = SceneSeed { requested_seed: Some(5), ..SceneSeed::default() };
        assert_eq!(
            (session.built_seed_mismatch(Some(5)), session.requested_seed_mismatch(Some(5))),
            (None, None),
            "nothing built yet"
        );
        session.built_seed = Some(5);
        assert_eq!(
            (session.built_seed_mismatch(None), session.built_seed_mismatch(Some(5))),
            (None, None),
            "no seed is not another session"
        );
        assert_eq!(
            (session.built_seed_mismatch(Some(7)), session.requested_seed_mismatch(Some(7))),
            (Some((5, 7)), Some((5, 7)))
        );
        session.built_seed = Some(7);
        assert_eq!((session.built_seed_mismatch(Some(7)), session.requested_seed_mismatch(Some(7))), (None, None));
        assert_eq!(
            (session.built_seed_mismatch(Some(8)), session.requested_seed_mismatch(Some(8))),
            (Some((7, 8)), None),
            "reported once"
        );
    }
}
