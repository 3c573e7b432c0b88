//! Flying from the window, in a thread of its own: sticks go out fifty times a second, however long a picture takes.

use super::super::Args;
use crate::app::clock::Stopwatch;
use crate::app::controller::{Hand, Profiles, Source};
use crate::app::errors::AppError;
use crate::app::net::{Arrival, Hub, SocketId};
use crate::base::time::SimTime;
use crate::rc::keyboard::{Keyboard, Keys};
use crate::rc::link::Link;
use crate::rc::{Action, Sticks};
use std::net::SocketAddr;
use std::sync::mpsc::{Receiver, Sender, channel};
use std::time::Duration;

/// Longest wait for a datagram: a quarter of the time between two stick samples.
const WAIT: Duration = Duration::from_millis(5);

/// What happens to keys of the window.
#[derive(Debug, Clone, PartialEq, Eq)]
pub enum Press {
    /// Down.
    Down(String),
    /// Up.
    Up(String),
    /// The window lost the focus: all are up.
    LetGo,
}

/// The window's end of the pilot.
#[derive(Debug)]
pub struct Pilot {
    presses: Sender<Press>,
    told: Receiver<String>,
}

impl Pilot {
    /// Dials the vehicle's port for ground stations. Without a controller the keyboard flies; why there is none is told once.
    ///
    /// # Errors
    /// When no socket can be opened, or a file is wrong.
    pub fn start(args: &Args, vehicle: SocketAddr, keys: Keys) -> Result<Self, AppError> {
        let mut hub = Hub::new();
        let socket = hub.bind(args.listen, 0, "--listen")?;
        let profiles = Profiles::at(args.profiles.clone())?;
        let device = args.device.clone();
        let (presses, pressed) = channel();
        let (teller, told) = channel();
        std::thread::spawn(move || {
            // A device is opened where it is used: some systems' devices may not change threads.
            let hand = Source::device(device.as_deref()).and_then(|source| Hand::take(source, &profiles, None, None));
            let hand = hand
                .inspect_err(|error| tracing::info!("no controller: {error}; the window's keys fly"))
                .map_err(|error| teller.send(format!("No controller: {error}. Keys fly.")))
                .ok();
            let mut seat = Seat { hub, socket, vehicle, link: Link::default(), board: Keyboard::new(keys), hand, touched: false };
            seat.fly(&pressed, &teller);
        });
        Ok(Self { presses, told })
    }

    /// Hands a key on.
    pub fn press(&self, press: Press) {
        // The thread lives as long as the window.
        let _ = self.presses.send(press);
    }

    /// The next thing to tell the person.
    pub fn poll_told(&self) -> Option<String> {
        self.told.try_recv().ok()
    }
}

struct Seat {
    hub: Hub,
    socket: SocketId,
    vehicle: SocketAddr,
    link: Link,
    board: Keyboard,
    hand: Option<Hand>,
    touched: bool,
}

impl Seat {
    fn fly(&mut self, pressed: &Receiver<Press>, teller: &Sender<String>) {
        let watch = Stopwatch::start();
        loop {
            if let Some(Arrival::Datagram { from, bytes, .. }) = self.hub.next(WAIT)
                && from == self.vehicle
            {
                self.link.receive(&bytes);
            }
            let now = SimTime::from_s(watch.elapsed().as_secs_f64());
            loop {
                match pressed.try_recv() {
                    Ok(press) => self.take(&press, now),
                    Err(std::sync::mpsc::TryRecvError::Empty) => break,
                    Err(std::sync::mpsc::TryRecvError::Disconnected) => return,
                }
            }
            let sticks = self.sticks(now);
            self.link.set_sticks(sticks, now);
            self.link.handle_timeout(now);
            while let Some(bytes) = self.link.poll_transmit() {
                self.hub.send(self.socket, self.vehicle, &bytes);
            }
            while let Some(text) = self.link.poll_told() {
                if teller.send(text).is_err() {
                    return;
                }
            }
        }
    }

    fn take(&mut self, press: &Press, now: SimTime) {
        match press {
            Press::Down(key) => {
                let action = self.board.press(key, true, now);
                if let Some(action) = action {
                    self.link.act(action, now);
                }
                // Who has asked for no flight holds no sticks: another ground station may fly, and a script keeps its aircraft. Who arms
                // does, or the vehicle would count as left alone.
                let flies = matches!(action, Some(Action::Arm | Action::TakeOff | Action::Position));
                self.touched |= flies || self.board.sticks(now) != Sticks::default();
            }
            Press::Up(key) => self.board.release(key),
            Press::LetGo => self.board.let_go(),
        }
    }

    /// A controller's sticks, unless keys are held; the keys' once they have been touched.
    fn sticks(&mut self, now: SimTime) -> Option<Sticks> {
        let keys = self.board.sticks(now);
        let Some(hand) = &mut self.hand else { return self.touched.then_some(keys) };
        match hand.look(&mut self.link, now, now) {
            Ok(look) if keys == Sticks::default() => look.sticks.or(self.touched.then_some(keys)),
            Ok(_) => Some(keys),
            Err(error) => {
                tracing::warn!("the controller is given up: {error}");
                self.hand = None;
                None
            }
        }
    }
}
