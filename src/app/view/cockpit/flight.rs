//! A flight that is shown: who is heard, and what stands between the vehicle and its picture.

use super::listener::Listener;
use super::panes::{Job, Panes, Shown};
use super::screen::Screen;
use crate::app::errors::AppError;
use crate::scenario::Scenario;
use crate::vehicle::Vehicle;
use crate::view::arrange::Place;
use crate::view::gaze::Gaze;
use crate::view::live::Now;
use crate::view::quality::Quality;
use std::net::{IpAddr, SocketAddr};
use std::sync::mpsc::{Receiver, TryRecvError, channel};
use std::time::Duration;

/// What stands between the vehicle and its picture.
pub enum Scene {
    /// Nobody has said which session it is.
    Waiting,
    /// Site and light are being worked out.
    Building(Receiver<Job>),
    /// It is drawn.
    Drawn(Box<Panes>),
}

/// A flight that is shown.
pub struct Flight {
    /// The job and the aircraft.
    pub job: (Scenario, Vehicle),
    /// What is heard.
    pub listener: Listener,
    /// What is drawn.
    pub scene: Scene,
    seed: Option<u64>,
    /// When its first picture was shown.
    pub first_drawn: Option<Duration>,
    /// Pictures so far.
    pub drawn: u32,
}

impl Flight {
    /// Dials a vehicle. `seed`: the session's, where it need not be heard.
    ///
    /// # Errors
    /// When no socket can be opened.
    pub fn begin(listen: IpAddr, vehicle: SocketAddr, job: (Scenario, Vehicle), seed: Option<u64>) -> Result<Self, AppError> {
        let listener = Listener::dial(listen, vehicle, &job.0)?;
        Ok(Self { job, listener, scene: Scene::Waiting, seed, first_drawn: None, drawn: 0 })
    }

    /// What is to be drawn by now.
    pub fn now(&self) -> Option<Now> {
        self.listener.live().now(self.listener.wall(), &self.job.1)
    }

    /// Goes on from waiting to building to drawing, as far as is known by now.
    ///
    /// # Errors
    /// When the simulator flies another scenario.
    pub fn prepare(&mut self, screen: &Screen, quality: Quality, now: Option<&Now>) -> Result<(), AppError> {
        let (seed, crc, real) = {
            let (wall, live) = (self.listener.wall(), self.listener.live());
            (live.seed(), live.scenario_crc(), live.says_no_truth(wall))
        };
        if crc.is_some_and(|crc| crc != self.job.0.crc) {
            return Err(AppError::wrong(
                "the simulator flies another scenario than this window was given: start both with the same --scenario",
            ));
        }
        match &self.scene {
            Scene::Waiting => {
                // The simulator says its seed, whatever the scenario's own is. A real vehicle names none.
                let seed = self.seed.or(seed).or_else(|| real.then_some(self.job.0.seed.unwrap_or(0)));
                let (Some(seed), Some(now)) = (seed, now) else { return Ok(()) };
                let ((scenario, vehicle), at) = (self.job.clone(), now.moment.at);
                tracing::info!("drawing with {}, {}, seed {seed}", screen.gpu.name, quality.name);
                let (sender, receiver) = channel();
                std::thread::spawn(move || {
                    // A window that was closed meanwhile needs no scene.
                    let _ = sender.send(Job::build(scenario, vehicle, seed, &quality, at));
                });
                self.scene = Scene::Building(receiver);
            }
            Scene::Building(receiver) => match receiver.try_recv() {
                Ok(job) => self.scene = Scene::Drawn(Box::new(Panes::new(screen, quality, job))),
                Err(TryRecvError::Empty) => {}
                Err(TryRecvError::Disconnected) => {
                    return Err(AppError::failed("the scene could not be built (its message stands above)"));
                }
            },
            Scene::Drawn(_) => {}
        }
        Ok(())
    }

    /// The views that can be drawn by now.
    pub fn draw(&mut self, screen: &mut Screen, places: &[Place], now: Option<&Now>, gaze: &Gaze, map: bool) -> Vec<Shown> {
        let (Scene::Drawn(panes), Some(now)) = (&mut self.scene, now) else { return Vec::new() };
        let feed = self.listener.live().feed().clone();
        panes.draw(screen, places, now, &feed, gaze, map)
    }

    /// Both views, once they are drawn.
    pub fn panes(&self) -> Option<&Panes> {
        match &self.scene {
            Scene::Drawn(panes) => Some(panes),
            Scene::Waiting | Scene::Building(_) => None,
        }
    }

    /// Gives back what it holds of the screen.
    pub fn end(self, screen: Option<&mut Screen>, lasted_since: impl Fn(Duration) -> Duration) {
        if let Some(first) = self.first_drawn {
            let seconds = lasted_since(first).as_secs_f64();
            tracing::info!("{} pictures of both views, {:.1} a second", self.drawn, f64::from(self.drawn) / seconds.max(1e-3));
        }
        if let (Scene::Drawn(panes), Some(screen)) = (self.scene, screen) {
            panes.close(screen);
        }
    }
}
