//! A flight that is shown: who is heard, and what stands between the vehicle and its picture.

use super::listener::TelemetryListener;
use super::panes::{PaneContent, RenderJob, ViewPanes};
use super::screen::WindowSurface;
use crate::errors::AppError;
use spandrel_model::scenario::Scenario;
use spandrel_model::vehicle::Vehicle;
use spandrel_view::arrange::ViewRect;
use spandrel_view::inspector_camera::InspectorCamera;
use spandrel_view::live::LiveMoment;
use spandrel_view::quality::Quality;
use std::net::{IpAddr, SocketAddr};
use std::sync::mpsc::{Receiver, TryRecvError, channel};
use std::time::Duration;

/// What stands between the vehicle and its picture.
pub enum SceneLoading {
    /// Nobody has said which session it is.
    Waiting,
    /// Site and light are being worked out.
    Building(Receiver<RenderJob>),
    /// It is drawn.
    Drawn(Box<ViewPanes>),
}

/// Whose defects and traffic are drawn.
#[derive(Debug, Default)]
struct SceneKey {
    /// The seed that the window was given.
    requested_seed: Option<u64>,
    /// The seed that the scene is built with.
    built_seed: Option<u64>,
    /// It has been told that the simulator says another seed than was given.
    mismatch_reported: bool,
}

impl SceneKey {
    /// The seed to build with: what the simulator says, else what was given, else another.
    fn seed(&self, said: Option<u64>, otherwise: Option<u64>) -> Option<u64> {
        said.or(self.requested_seed).or(otherwise)
    }

    /// The seed that is drawn and the one that is flown, once these differ.
    fn is_outdated(&self, said: Option<u64>) -> Option<(u64, u64)> {
        self.built_seed.zip(said).filter(|(built, said)| built != said)
    }

    /// The seed that was given and the one that is flown, the first time that these differ.
    fn is_other_session(&mut self, said: Option<u64>) -> Option<(u64, u64)> {
        let differ = self.requested_seed.zip(said).filter(|(given, said)| !self.mismatch_reported && given != said);
        self.mismatch_reported |= differ.is_some();
        differ
    }
}

/// A flight that is shown.
pub struct FlightView {
    /// The job and the aircraft.
    pub job: (Scenario, Vehicle),
    /// What is heard.
    pub listener: TelemetryListener,
    /// What is drawn.
    pub scene: SceneLoading,
    session: SceneKey,
    /// What a former session was drawn with, until the screen is at hand to take it back.
    former: Option<Box<ViewPanes>>,
    /// When its first picture was shown.
    pub first_drawn: Option<Duration>,
    /// Pictures so far.
    pub drawn: u32,
}

impl FlightView {
    /// Dials a vehicle. `seed`: the session's, where it is known before the simulator says it.
    ///
    /// # Errors
    /// When no socket can be opened.
    pub fn begin(listen: IpAddr, vehicle: SocketAddr, job: (Scenario, Vehicle), seed: Option<u64>) -> Result<Self, AppError> {
        let listener = TelemetryListener::dial(listen, vehicle, &job.0)?;
        let session = SceneKey { requested_seed: seed, ..SceneKey::default() };
        Ok(Self { job, listener, scene: SceneLoading::Waiting, session, former: None, first_drawn: None, drawn: 0 })
    }

    /// What is to be drawn by now.
    pub fn now(&self) -> Option<LiveMoment> {
        self.listener.live().moment(self.listener.wall(), &self.job.1)
    }

    /// Goes on from waiting to building to drawing, as far as is known by now; and back to waiting when the simulator begins another session.
    ///
    /// # Errors
    /// When the simulator flies another scenario.
    pub fn prepare(&mut self, screen: &WindowSurface, quality: Quality, now: Option<&LiveMoment>) -> Result<(), AppError> {
        let (said, crc, real) = {
            let (wall, live) = (self.listener.wall(), self.listener.live());
            (live.seed(), live.scenario_crc(), live.lacks_truth(wall))
        };
        if crc.is_some_and(|crc| crc != self.job.0.crc) {
            return Err(AppError::wrong(
                "the simulator flies another scenario than this window was given: start both with the same --scenario",
            ));
        }
        self.follow(said);
        match &self.scene {
            SceneLoading::Waiting => {
                // The simulator says its seed, whatever the scenario's own is. A real vehicle names none.
                let seed = self.session.seed(said, real.then_some(self.job.0.seed.unwrap_or(0)));
                let (Some(seed), Some(now)) = (seed, now) else { return Ok(()) };
                let ((scenario, vehicle), at) = (self.job.clone(), now.moment.at);
                tracing::info!("drawing with {}, {}, seed {seed}", screen.gpu.name, quality.name);
                let (sender, receiver) = channel();
                std::thread::spawn(move || {
                    // A window that was closed meanwhile needs no scene.
                    let _ = sender.send(RenderJob::build(scenario, vehicle, seed, &quality, at));
                });
                self.session.built_seed = Some(seed);
                self.scene = SceneLoading::Building(receiver);
            }
            SceneLoading::Building(receiver) => match receiver.try_recv() {
                Ok(job) => self.scene = SceneLoading::Drawn(Box::new(ViewPanes::new(screen, quality, job))),
                Err(TryRecvError::Empty) => {}
                Err(TryRecvError::Disconnected) => {
                    return Err(AppError::failed("the scene could not be built (its message is in the terminal)"));
                }
            },
            SceneLoading::Drawn(_) => {}
        }
        Ok(())
    }

    /// Draws what the simulator flies: its word goes before what was given, and before what was said of an earlier session.
    fn follow(&mut self, said: Option<u64>) {
        if let Some((given, said)) = self.session.is_other_session(said) {
            tracing::warn!("seed {given} was asked for, but the simulator flies seed {said}: that is drawn");
        }
        if let Some((built, said)) = self.session.is_outdated(said) {
            tracing::info!("the simulator flies seed {said}, no longer seed {built}: defects and traffic are placed anew");
            self.session.built_seed = None;
            if let SceneLoading::Drawn(panes) = std::mem::replace(&mut self.scene, SceneLoading::Waiting) {
                self.former = Some(panes);
            }
        }
    }

    /// The views that can be drawn by now.
    ///
    /// # Errors
    /// When a device fails.
    pub fn draw(
        &mut self,
        screen: &mut WindowSurface,
        places: &[ViewRect],
        now: Option<&LiveMoment>,
        gaze: &InspectorCamera,
        map: bool,
    ) -> Result<Vec<PaneContent>, AppError> {
        if let Some(former) = self.former.take() {
            former.close(screen);
        }
        let (SceneLoading::Drawn(panes), Some(now)) = (&mut self.scene, now) else { return Ok(Vec::new()) };
        let feed = self.listener.live().feed().clone();
        panes.draw(screen, places, now, &feed, gaze, map)
    }

    /// Both views, once they are drawn.
    pub fn panes(&self) -> Option<&ViewPanes> {
        match &self.scene {
            SceneLoading::Drawn(panes) => Some(panes),
            SceneLoading::Waiting | SceneLoading::Building(_) => None,
        }
    }

    /// Gives back what it holds of the screen.
    pub fn end(self, screen: Option<&mut WindowSurface>, lasted_since: impl Fn(Duration) -> Duration) {
        if let Some(first) = self.first_drawn {
            let seconds = lasted_since(first).as_secs_f64();
            tracing::info!("{} pictures of both views, {:.1} a second", self.drawn, f64::from(self.drawn) / seconds.max(1e-3));
        }
        let Some(screen) = screen else { return };
        if let SceneLoading::Drawn(panes) = self.scene {
            panes.close(screen);
        }
        if let Some(former) = self.former {
            former.close(screen);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn exact_the_simulators_seed_goes_before_all_others() {
        let given = SceneKey { requested_seed: Some(5), ..SceneKey::default() };
        assert_eq!((given.seed(None, None), given.seed(Some(7), Some(1))), (Some(5), Some(7)));
        let free = SceneKey::default();
        assert_eq!((free.seed(None, None), free.seed(None, Some(1)), free.seed(Some(7), Some(1))), (None, Some(1), Some(7)));
    }

    #[test]
    fn exact_another_seed_is_another_session_and_a_contradiction_is_reported_once() {
        let mut session = SceneKey { requested_seed: Some(5), ..SceneKey::default() };
        assert_eq!((session.is_outdated(Some(5)), session.is_other_session(Some(5))), (None, None), "nothing is built yet");
        session.built_seed = Some(5);
        assert_eq!((session.is_outdated(None), session.is_outdated(Some(5))), (None, None), "silence is no other session");
        assert_eq!((session.is_outdated(Some(7)), session.is_other_session(Some(7))), (Some((5, 7)), Some((5, 7))));
        session.built_seed = Some(7);
        assert_eq!((session.is_outdated(Some(7)), session.is_other_session(Some(7))), (None, None));
        assert_eq!((session.is_outdated(Some(8)), session.is_other_session(Some(8))), (Some((7, 8)), None), "told once");
    }
}
