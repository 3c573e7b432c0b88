//! Flies the vehicle from the window. A separate thread sends stick positions at 50 Hz, regardless of the frame rate.

use super::controller_slot::ControllerSlot;
use crate::errors::AppError;
use crate::io::clock::Stopwatch;
use crate::io::controller::ProfileFolder;
use crate::io::net::{NetEvent, SocketHub, SocketId};
use crate::io::user_settings::UserSettings;
use spandrel_clients::rc::controller_link::ControllerLink;
use spandrel_clients::rc::keyboard::{KeyBindings, KeyboardState};
use spandrel_clients::rc::{ControllerAction, Sticks};
use spandrel_model::time::SimTime;
use spandrel_text::{Language, text};
use spandrel_view::flow::{ControllerStatus, ProfileChange};
use std::net::{IpAddr, SocketAddr};
use std::path::PathBuf;
use std::sync::mpsc::{Receiver, Sender, TryRecvError, channel};
use std::sync::{Arc, Mutex, PoisonError};
use std::time::Duration;

/// Maximum time to wait for a datagram: one-quarter of the interval between stick samples.
const MAX_DATAGRAM_WAIT: Duration = Duration::from_millis(5);
/// Interval at which the controller's status is updated on the ground: one-tenth of a person's reaction time
/// (estimate).
const STATUS_INTERVAL: SimTime = SimTime::from_ms(30);

/// A command from the window to the pilot thread.
#[derive(Debug, Clone, PartialEq)]
pub enum PilotCommand {
    /// A key with this name was pressed.
    Down(String),
    /// A key with this name was released.
    Up(String),
    /// Release all keys, because the window lost focus or shows a page.
    ReleaseKeys,
    /// Connect to this vehicle's ground station port.
    Fly(SocketAddr),
    /// Disconnect from the vehicle.
    Disconnect,
    /// Send the inspector to the place with this number.
    Walk(u8),
    /// Pause or resume: no actions are sent while the simulation is paused.
    SetPaused(bool),
    /// Search for a controller again.
    FindController,
    /// Start the calibration wizard.
    Calibrate,
    /// Confirm the wizard's current step.
    Confirm,
    /// Leave the calibration wizard without saving.
    Cancel,
    /// Change the controller's profile and save it.
    ChangeProfile(ProfileChange),
    /// Use these keys.
    SetKeys(KeyBindings),
    /// Use this language for messages.
    SetLanguage(Language),
}

/// The window's handle to the pilot thread.
#[derive(Debug)]
pub struct PilotThread {
    commands: Sender<PilotCommand>,
    messages: Receiver<String>,
    controls: Arc<Mutex<ControllerStatus>>,
}

impl PilotThread {
    /// Starts the thread. Without a controller, logs the reason and uses the keyboard.
    ///
    /// # Errors
    /// Returns an error if the socket cannot be opened, or a file is invalid.
    pub fn start(
        listen: IpAddr,
        device: Option<String>,
        profiles: Option<PathBuf>,
        settings: &UserSettings,
    ) -> Result<Self, AppError> {
        let mut hub = SocketHub::new();
        let socket = hub.bind(listen, 0, "--listen")?;
        let profiles = ProfileFolder::at(profiles);
        let (keys, language) = (settings.keys.clone(), settings.style.language);
        let (asks, asked) = channel();
        let (message_sender, told) = channel();
        let controls = Arc::new(Mutex::new(ControllerStatus::default()));
        let shown = controls.clone();
        std::thread::spawn(move || {
            // The device is opened in the thread that uses it, because some systems do not allow moving devices between
            // threads.
            let mut desk = ControllerSlot::new(device, profiles);
            if let Some(why) = desk.keyboard_only_reason() {
                tracing::info!("{why} Flying with the keyboard.");
            }
            desk.set_language(language);
            let board = KeyboardState::new(keys);
            let mut seat = PilotLoop {
                hub,
                socket,
                vehicle: None,
                link: ControllerLink::default(),
                keyboard: board,
                controller: desk,
                keyboard_in_use: false,
                paused: false,
                lost: false,
                shown,
                language,
                next: SimTime::ZERO,
            };
            seat.fly(&asked, &message_sender);
        });
        Ok(Self { commands: asks, messages: told, controls })
    }

    /// Sends a command to the pilot thread.
    pub fn send_command(&self, ask: PilotCommand) {
        // The thread runs as long as the window is open.
        let _ = self.commands.send(ask);
    }

    /// Returns the next message for the user.
    pub fn poll_message(&self) -> Option<String> {
        self.messages.try_recv().ok()
    }

    /// Returns the controller's status.
    pub fn controls(&self) -> ControllerStatus {
        self.controls.lock().unwrap_or_else(PoisonError::into_inner).clone()
    }
}

/// Sends a message to the user. Fails if the window has been closed, which also ends the thread.
fn send_message(message_sender: &Sender<String>, words: String) {
    let _ = message_sender.send(words);
}

struct PilotLoop {
    hub: SocketHub,
    socket: SocketId,
    vehicle: Option<SocketAddr>,
    link: ControllerLink,
    keyboard: KeyboardState,
    controller: ControllerSlot,
    keyboard_in_use: bool,
    paused: bool,
    lost: bool,
    shown: Arc<Mutex<ControllerStatus>>,
    language: Language,
    next: SimTime,
}

impl PilotLoop {
    fn fly(&mut self, asked: &Receiver<PilotCommand>, message_sender: &Sender<String>) {
        let watch = Stopwatch::start();
        loop {
            if let Some(NetEvent::Datagram { from, bytes, .. }) = self.hub.next(MAX_DATAGRAM_WAIT)
                && Some(from) == self.vehicle
            {
                self.link.receive(&bytes);
            }
            let now = SimTime::from_s(watch.elapsed().as_secs_f64());
            loop {
                match asked.try_recv() {
                    Ok(ask) => self.run_command(ask, now, message_sender),
                    Err(TryRecvError::Empty) => break,
                    Err(TryRecvError::Disconnected) => return,
                }
            }
            if self.controller.open_new_device() {
                self.lost = false;
                send_message(message_sender, self.connected_message());
            }
            let (sticks, news) = self.sticks(now);
            // On the ground, the controller page shows this message.
            if let Some(news) = news.filter(|_| self.vehicle.is_some()) {
                send_message(message_sender, news);
            }
            match self.vehicle {
                Some(vehicle) => {
                    self.link.set_sticks(sticks, now);
                    self.send(vehicle, now);
                    std::iter::from_fn(|| self.link.poll_message()).for_each(|text| send_message(message_sender, text));
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

    /// Updates the status on the ground, where buttons have no effect.
    fn show(&mut self, now: SimTime) {
        while self.link.poll_message().is_some() {}
        if now >= self.next {
            self.next = now + STATUS_INTERVAL;
            let controls = self.controller.controls(self.keyboard.sticks(now), self.keyboard.keys().help(self.language));
            *self.shown.lock().unwrap_or_else(PoisonError::into_inner) = controls;
        }
    }

    /// Passes the language and the name of the arm key to the link.
    fn update_link_texts(&mut self) {
        self.link.set_language(self.language);
        self.link.set_arm_key(&self.keyboard.keys().label("arm", self.language));
    }

    /// Returns the message about a controller that has just been connected.
    fn connected_message(&self) -> String {
        let (language, note) = (self.language, self.controller.note());
        if self.controller.is_calibrated() {
            text!(language, "window-controls-message-connected", note = note)
        } else {
            text!(language, "window-controls-message-connected-uncalibrated", note = note)
        }
    }

    fn run_command(&mut self, ask: PilotCommand, now: SimTime, message_sender: &Sender<String>) {
        match ask {
            PilotCommand::Down(key) => {
                let action = self.keyboard.press(&key, true, now);
                if let Some(action) = action.filter(|_| self.vehicle.is_some()) {
                    self.link.request_action(action, now);
                }
                // Send stick positions only after the user has started to fly, because another ground station or a
                // script may be in control. Arming counts as flying; otherwise, the vehicle would detect a lost control
                // link.
                let flies =
                    matches!(action, Some(ControllerAction::Arm | ControllerAction::TakeOff | ControllerAction::Position));
                self.keyboard_in_use |= self.vehicle.is_some() && (flies || self.keyboard.sticks(now) != Sticks::default());
            }
            PilotCommand::Up(key) => self.keyboard.release(&key),
            PilotCommand::ReleaseKeys => self.keyboard.release_all(),
            PilotCommand::Fly(vehicle) => {
                (self.vehicle, self.link, self.keyboard_in_use) = (Some(vehicle), ControllerLink::default(), false);
                self.update_link_texts();
                self.paused = false;
                if let Some(why) = self.controller.keyboard_only_reason() {
                    send_message(message_sender, text!(self.language, "window-controls-message-keyboard", note = why));
                }
            }
            PilotCommand::Walk(place) => self.link.request_walk(place, now),
            PilotCommand::SetPaused(stands) => self.paused = stands,
            PilotCommand::Disconnect => (self.vehicle, self.link) = (None, ControllerLink::default()),
            PilotCommand::FindController => self.controller.find_device(),
            PilotCommand::Calibrate => self.controller.calibrate(),
            PilotCommand::Confirm => self.controller.confirm(now),
            PilotCommand::Cancel => self.controller.cancel(),
            PilotCommand::ChangeProfile(tune) => self.controller.adjust_profile(tune),
            PilotCommand::SetKeys(keys) => {
                self.keyboard = KeyboardState::new(keys);
                self.update_link_texts();
            }
            PilotCommand::SetLanguage(language) => {
                self.language = language;
                self.controller.set_language(language);
                self.update_link_texts();
            }
        }
    }

    /// Returns the controller's stick positions, unless keys are held. Without a controller, returns the keyboard's
    /// stick positions once it has been used. Also returns a message for the user about the controller.
    fn sticks(&mut self, now: SimTime) -> (Option<Sticks>, Option<String>) {
        let keys = self.keyboard.sticks(now);
        // While the simulation is paused, button actions would be delayed or lost, so they go to a dummy link.
        let (mut nobody, flown);
        if self.paused {
            nobody = ControllerLink::default();
            flown = self.controller.sticks(&mut nobody, now);
        } else {
            flown = self.controller.sticks(&mut self.link, now);
        }
        let lost = matches!(flown, Ok(None)) && self.controller.is_calibrated() || flown.is_err();
        let news = self.update_connection_state(lost);
        let own = self.keyboard_in_use.then_some(keys);
        match flown {
            Ok(Some(sticks)) if keys == Sticks::default() => (Some(sticks), news),
            Ok(Some(_)) => (Some(keys), news),
            Ok(None) => (own, news),
            Err(error) => {
                tracing::warn!("controller disabled: {error}");
                self.controller.disable(&error);
                (None, Some(self.controller.note()))
            }
        }
    }

    /// Updates the controller's connection state. Returns a message if the state has changed.
    fn update_connection_state(&mut self, lost: bool) -> Option<String> {
        let before = std::mem::replace(&mut self.lost, lost);
        let language = self.language;
        let name = self.controller.name().map_or_else(|| text!(language, "window-controls-the-controller"), str::to_owned);
        match (before, lost) {
            (false, true) => {
                // If the controller is disconnected, send no stick positions, even if keys were used before. The
                // vehicle's failsafe is then active until the user presses a key again.
                self.keyboard_in_use = false;
                Some(text!(language, "window-controls-message-disconnected", name = name))
            }
            (true, false) if self.controller.is_calibrated() => {
                Some(text!(language, "window-controls-message-reconnected", name = name))
            }
            _ => None,
        }
    }
}
