//! Flying from the window, in a thread of its own: sticks go out fifty times a second, however long a picture takes.

use super::controller_slot::ControllerSlot;
use crate::errors::AppError;
use crate::io::clock::Stopwatch;
use crate::io::controller::ProfileFolder;
use crate::io::net::{NetEvent, SocketHub, SocketId};
use spandrel_clients::rc::controller_link::ControllerLink;
use spandrel_clients::rc::keyboard::{KeyBindings, KeyboardState};
use spandrel_clients::rc::{ControllerAction, Sticks};
use spandrel_model::time::SimTime;
use spandrel_view::flow::{ControllerStatus, ProfileChange};
use std::net::{IpAddr, SocketAddr};
use std::path::PathBuf;
use std::sync::mpsc::{Receiver, Sender, TryRecvError, channel};
use std::sync::{Arc, Mutex, PoisonError};
use std::time::Duration;

/// Longest wait for a datagram: a quarter of the time between two stick samples.
const WAIT: Duration = Duration::from_millis(5);
/// On the ground, how the controller stands is shown this often (a tenth of a person's reaction; estimate).
const SHOW: SimTime = SimTime::from_ms(30);

/// What the window asks of the pilot.
#[derive(Debug, Clone, PartialEq)]
pub enum PilotCommand {
    /// A key went down.
    Down(String),
    /// A key came up.
    Up(String),
    /// The window lost the focus, or shows a page: all keys are up.
    LetGo,
    /// Dial this vehicle's port for ground stations.
    Fly(SocketAddr),
    /// Let go of the vehicle.
    Land,
    /// Time stands still, or goes on: nobody acts meanwhile.
    Stand(bool),
    /// Look for a controller again.
    Look,
    /// Calibrate it.
    Calibrate,
    /// The wizard's Enter.
    Confirm,
    /// Leave the wizard.
    Cancel,
    /// Change this of its profile, and keep it.
    Tune(ProfileChange),
}

/// The window's end of the pilot.
#[derive(Debug)]
pub struct PilotThread {
    commands: Sender<PilotCommand>,
    messages: Receiver<String>,
    controls: Arc<Mutex<ControllerStatus>>,
}

impl PilotThread {
    /// Sits down. Without a controller the keyboard flies; why there is none is told once.
    ///
    /// # Errors
    /// When no socket can be opened, or a file is wrong.
    pub fn start(listen: IpAddr, device: Option<String>, profiles: Option<PathBuf>, keys: KeyBindings) -> Result<Self, AppError> {
        let mut hub = SocketHub::new();
        let socket = hub.bind(listen, 0, "--listen")?;
        let profiles = ProfileFolder::at(profiles);
        let (asks, asked) = channel();
        let (teller, told) = channel();
        let controls = Arc::new(Mutex::new(ControllerStatus::default()));
        let shown = controls.clone();
        std::thread::spawn(move || {
            // A device is opened where it is used: some systems' devices may not change threads.
            let desk = ControllerSlot::new(device, profiles);
            if let Some(why) = desk.keyboard_reason() {
                tracing::info!("{why} The window's keys fly.");
            }
            let words = keys.help_text();
            let board = KeyboardState::new(keys);
            let mut seat = PilotLoop {
                hub,
                socket,
                vehicle: None,
                link: ControllerLink::default(),
                keyboard: board,
                controller: desk,
                touched: false,
                paused: false,
                lost: false,
                shown,
                status_text: words,
                next: SimTime::ZERO,
            };
            seat.fly(&asked, &teller);
        });
        Ok(Self { commands: asks, messages: told, controls })
    }

    /// Asks for something.
    pub fn send_command(&self, ask: PilotCommand) {
        // The thread lives as long as the window.
        let _ = self.commands.send(ask);
    }

    /// The next thing to tell the person.
    pub fn poll_message(&self) -> Option<String> {
        self.messages.try_recv().ok()
    }

    /// How the controller stands.
    pub fn controls(&self) -> ControllerStatus {
        self.controls.lock().unwrap_or_else(PoisonError::into_inner).clone()
    }
}

/// Tells the person. Nobody is left to hear it when the window is closed; then no more is asked either, which ends the thread.
fn tell(teller: &Sender<String>, words: String) {
    let _ = teller.send(words);
}

struct PilotLoop {
    hub: SocketHub,
    socket: SocketId,
    vehicle: Option<SocketAddr>,
    link: ControllerLink,
    keyboard: KeyboardState,
    controller: ControllerSlot,
    touched: bool,
    paused: bool,
    lost: bool,
    shown: Arc<Mutex<ControllerStatus>>,
    status_text: String,
    next: SimTime,
}

impl PilotLoop {
    fn fly(&mut self, asked: &Receiver<PilotCommand>, teller: &Sender<String>) {
        let watch = Stopwatch::start();
        loop {
            if let Some(NetEvent::Datagram { from, bytes, .. }) = self.hub.next(WAIT)
                && Some(from) == self.vehicle
            {
                self.link.receive(&bytes);
            }
            let now = SimTime::from_s(watch.elapsed().as_secs_f64());
            loop {
                match asked.try_recv() {
                    Ok(ask) => self.take(ask, now, teller),
                    Err(TryRecvError::Empty) => break,
                    Err(TryRecvError::Disconnected) => return,
                }
            }
            if self.controller.load_profile() {
                self.lost = false;
                let flies = if self.controller.flies() { "It flies." } else { "Keys fly until it is calibrated." };
                tell(teller, format!("A controller is there. {} {flies}", self.controller.note()));
            }
            let (sticks, news) = self.sticks(now);
            // On the ground the page of the controller says it.
            if let Some(news) = news.filter(|_| self.vehicle.is_some()) {
                tell(teller, news);
            }
            match self.vehicle {
                Some(vehicle) => {
                    self.link.set_sticks(sticks, now);
                    self.send(vehicle, now);
                    std::iter::from_fn(|| self.link.poll_message()).for_each(|text| tell(teller, text));
                }
                None => self.show(now),
            }
        }
    }

    fn send(&mut self, vehicle: SocketAddr, now: SimTime) {
        self.link.handle_timeout(now);
        while let Some(bytes) = self.link.poll_transmit() {
            self.hub.send(self.socket, vehicle, &bytes);
        }
    }

    /// On the ground: how the controller stands; buttons have nobody to act on.
    fn show(&mut self, now: SimTime) {
        while self.link.poll_message().is_some() {}
        if now >= self.next {
            self.next = now + SHOW;
            let controls = self.controller.controls(self.keyboard.sticks(now), &self.status_text);
            *self.shown.lock().unwrap_or_else(PoisonError::into_inner) = controls;
        }
    }

    fn take(&mut self, ask: PilotCommand, now: SimTime, teller: &Sender<String>) {
        match ask {
            PilotCommand::Down(key) => {
                let action = self.keyboard.press(&key, true, now);
                if let Some(action) = action.filter(|_| self.vehicle.is_some()) {
                    self.link.act(action, now);
                }
                // Who has asked for no flight holds no sticks: another ground station may fly, and a script keeps its aircraft. Who arms
                // does, or the vehicle would count as left alone.
                let flies =
                    matches!(action, Some(ControllerAction::Arm | ControllerAction::TakeOff | ControllerAction::Position));
                self.touched |= self.vehicle.is_some() && (flies || self.keyboard.sticks(now) != Sticks::default());
            }
            PilotCommand::Up(key) => self.keyboard.release(&key),
            PilotCommand::LetGo => self.keyboard.release_all(),
            PilotCommand::Fly(vehicle) => {
                (self.vehicle, self.link, self.touched) = (Some(vehicle), ControllerLink::default(), false);
                self.link.set_arm_key(&self.keyboard.keys().label("arm"));
                self.paused = false;
                if let Some(why) = self.controller.keyboard_reason() {
                    tell(teller, format!("{why} Keys fly."));
                }
            }
            PilotCommand::Stand(stands) => self.paused = stands,
            PilotCommand::Land => (self.vehicle, self.link) = (None, ControllerLink::default()),
            PilotCommand::Look => self.controller.find_device(),
            PilotCommand::Calibrate => self.controller.calibrate(),
            PilotCommand::Confirm => self.controller.confirm(now),
            PilotCommand::Cancel => self.controller.cancel(),
            PilotCommand::Tune(tune) => self.controller.adjust_profile(tune),
        }
    }

    /// A controller's sticks, unless keys are held; the keys' once they have been touched. With it, what a person must know of the
    /// controller.
    fn sticks(&mut self, now: SimTime) -> (Option<Sticks>, Option<String>) {
        let keys = self.keyboard.sticks(now);
        // While time stands still a button would act late, or never: it has nobody to act on.
        let (mut nobody, flown);
        if self.paused {
            nobody = ControllerLink::default();
            flown = self.controller.sticks(&mut nobody, now);
        } else {
            flown = self.controller.sticks(&mut self.link, now);
        }
        let lost = matches!(flown, Ok(None)) && self.controller.flies() || flown.is_err();
        let news = self.set_device_lost(lost);
        let own = self.touched.then_some(keys);
        match flown {
            Ok(Some(sticks)) if keys == Sticks::default() => (Some(sticks), news),
            Ok(Some(_)) => (Some(keys), news),
            Ok(None) => (own, news),
            Err(error) => {
                tracing::warn!("the controller is given up: {error}");
                self.controller.cancel_wizard(&error);
                (None, Some(self.controller.note().to_owned()))
            }
        }
    }

    /// The controller is lost now, or is not; says so when it was not, or was.
    fn set_device_lost(&mut self, lost: bool) -> Option<String> {
        let before = std::mem::replace(&mut self.lost, lost);
        let name = self.controller.name().unwrap_or("the controller");
        match (before, lost) {
            (false, true) => {
                // Whose controller is gone holds no sticks, whatever keys were pressed before: the vehicle's failsafe acts, until a key flies
                // anew.
                self.touched = false;
                Some(format!("'{name}' is lost: its sticks are centred, then silent. A key takes over."))
            }
            (true, false) if self.controller.flies() => Some(format!("'{name}' flies again.")),
            _ => None,
        }
    }
}
