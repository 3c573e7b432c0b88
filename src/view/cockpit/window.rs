//! The window's loop: events in, pages and views out.

use super::display;
use super::flight::Flight;
use super::keeper::Keeper;
use super::keys::{self, Change, Held};
use super::lead::Lead;
use super::pilot::{Ask, Pilot};
use super::plan::Plan;
use super::screen::Screen;
use super::sound::Speaker;
use super::stream::Stream;
use crate::clock::Stopwatch;
use crate::errors::AppError;
use crate::stop::Stop;
use spandrel_clients::rc::keyboard::{Keys, Wish};
use spandrel_view::arrange::Which;
use spandrel_view::flow::pipe::FromWindow;
use spandrel_view::flow::{Flow, Page};
use spandrel_view::gaze::Gaze;
use spandrel_view::gpu::Pictures;
use spandrel_view::hud;
use spandrel_view::quality::{PRESETS, Quality};
use std::time::Duration;
use winit::application::ApplicationHandler;
use winit::event::{ElementState, KeyEvent, MouseButton, MouseScrollDelta, WindowEvent};
use winit::event_loop::{ActiveEventLoop, ControlFlow};
use winit::window::WindowId;

/// No more pictures than this, 1/s: what a screen shows; without a graphics card, what a person still sees as motion.
const MOST_HZ: (f64, f64) = (120.0, 25.0);
/// Pages move by keys alone, and with the sticks, 1/s.
const PAGES_HZ: f64 = 20.0;
/// Rest after a picture without a graphics card, as a share of what it took: the machine has other work.
const REST: f64 = 0.25;
/// A notch of the wheel zooms so many times.
const ZOOM_NOTCH: f64 = 1.15;

/// Who stands behind the window.
pub struct Crew {
    /// Whoever flies from it.
    pub pilot: Option<Pilot>,
    /// Whoever says what is flown.
    pub lead: Option<Lead>,
    /// The flight that is shown from the beginning.
    pub flight: Option<Flight>,
    /// Whoever hands the camera's view on.
    pub stream: Option<Stream>,
}

/// The window with everything behind it.
pub struct Cockpit {
    pub(super) plan: Plan,
    pub(super) keys: Keys,
    pub(super) flow: Flow,
    pub(super) crew: Crew,
    pub(super) keeper: Option<Keeper>,
    pub(super) speaker: Speaker,
    pub(super) stop: Stop,
    pub(super) screen: Option<Screen>,
    pub(super) pictures: Pictures,
    pub(super) gaze: Gaze,
    pub(super) map: bool,
    pub(super) held: Held,
    /// The pilot has been told that time stands still.
    pub(super) stood: bool,
    mouse: Option<(f64, f64)>,
    dragging: bool,
    pub(super) words: Vec<(String, Duration)>,
    pub(super) watch: Stopwatch,
    pub(super) frame_at: Duration,
    due: Duration,
    failed: Option<AppError>,
}

impl Cockpit {
    /// Nothing is open yet.
    pub fn new(plan: Plan, keys: Keys, flow: Flow, crew: Crew, speaker: Speaker, stop: Stop) -> Self {
        Self {
            map: plan.map,
            keeper: crew.flight.as_ref().and(plan.keep.clone()).map(Keeper::start),
            plan,
            keys,
            flow,
            crew,
            speaker,
            stop,
            screen: None,
            pictures: Pictures::default(),
            gaze: Gaze::default(),
            held: Held::default(),
            stood: false,
            mouse: None,
            dragging: false,
            words: Vec::new(),
            watch: Stopwatch::start(),
            frame_at: Duration::ZERO,
            due: Duration::ZERO,
            failed: None,
        }
    }

    /// Opens the window and stays until it is closed.
    pub fn run(mut self) -> Result<(), AppError> {
        let events = display::open()?;
        events.run_app(&mut self).map_err(|error| AppError::failed(format!("the window broke off: {error}")))?;
        self.land();
        self.failed.map_or(Ok(()), Err)
    }

    pub(super) fn quality(&self, screen: &Screen) -> Quality {
        let usual = if screen.gpu.software { "low" } else { "high" };
        self.plan.quality.or_else(|| Quality::named(usual)).unwrap_or(PRESETS[0])
    }

    /// Lets go of the flight that is shown.
    pub(super) fn land(&mut self) {
        self.keeper = None;
        if let Some(flight) = self.crew.flight.take() {
            let wall = flight.listener.wall();
            flight.listener.live().streams(None, wall);
            let watch = self.watch;
            flight.end(self.screen.as_mut(), |first| watch.elapsed().saturating_sub(first));
        }
    }

    /// True while the views are shown, and keys fly.
    fn flies(&self) -> bool {
        self.flow.page() == Page::Flight
    }

    fn key(&mut self, event: &KeyEvent, made_up: bool) {
        if self.held.pressed_elsewhere(event, made_up) {
            return;
        }
        let change = self.held.take(event);
        if !self.flies() {
            self.key_on_page(event, change);
            return;
        }
        match change {
            Some(Change::Down(key)) => {
                self.wish(&key);
                if self.flies() {
                    self.hand_on(Ask::Down(key));
                }
            }
            Some(Change::Up(key)) => self.hand_on(Ask::Up(key)),
            None => {}
        }
    }

    fn key_on_page(&mut self, event: &KeyEvent, change: Option<Change>) {
        let trying = self.flow.page() == Page::Controls;
        match change {
            Some(Change::Down(key)) if self.flow.asks() && self.keys.wish(&key) == Some(Wish::Pause) => {
                self.flow.pause();
                return;
            }
            // On the page of the controller the keys' sticks are seen.
            Some(Change::Down(key)) if trying => self.hand_on(Ask::Down(key)),
            Some(Change::Up(key)) => self.hand_on(Ask::Up(key)),
            _ => {}
        }
        // Keys that are tried there do nothing else.
        let tried = self.flow.tries_keys() && keys::name(&event.logical_key).is_some_and(|key| self.keys.is_stick(&key));
        if let Some(press) = keys::press(event).filter(|_| !tried) {
            self.flow.press(press);
        }
    }

    fn wish(&mut self, key: &str) {
        match self.keys.wish(key) {
            Some(Wish::Swap) => self.flow.arrangement = self.flow.arrangement.next(),
            Some(Wish::Map) => self.map = !self.map,
            Some(Wish::Follow) => self.gaze = Gaze::default(),
            Some(Wish::Pause) => self.flow.pause(),
            Some(Wish::Restart) => self.flow.restart(),
            Some(Wish::Sound) => self.flow.toggle_sound(),
            Some(Wish::LookLeft | Wish::LookRight | Wish::LookUp | Wish::LookDown | Wish::ZoomIn | Wish::ZoomOut) | None => {}
        }
    }

    pub(super) fn hand_on(&self, ask: Ask) {
        if let Some(pilot) = &self.crew.pilot {
            pilot.ask(ask);
        }
    }

    fn click(&mut self, pressed: bool) {
        self.dragging = false;
        let (Some(screen), Some((x, y)), true) = (&self.screen, self.mouse, pressed) else { return };
        let size = screen.window.inner_size();
        let (width, height) = (f64::from(size.width.max(1)), f64::from(size.height.max(1)));
        let hit = self.flow.click(hud::at(x / width, y / height), width / height);
        self.dragging = !hit && self.flies();
    }

    fn moved(&mut self, x: f64, y: f64) {
        if let (true, Some((from_x, from_y)), Some(flight)) = (self.dragging, self.mouse, &self.crew.flight)
            && let (Some(panes), Some(now)) = (flight.panes(), flight.now())
        {
            // The world is dragged along: what is under the pointer stays there.
            let to = panes.to_aircraft(&now);
            let rad_px = self.gaze.rad_px(self.eyes_px(), to);
            self.gaze.turn(rad_px * (from_x - x), rad_px * (y - from_y), to);
        }
        self.mouse = Some((x, y));
    }

    /// Height of the inspector's view on the screen, px.
    fn eyes_px(&self) -> f64 {
        let window = self.screen.as_ref().map_or(1.0, |screen| f64::from(screen.window.inner_size().height.max(1)));
        let eyes = self.flow.arrangement.places().into_iter().find(|place| place.which == Which::Inspector);
        window * eyes.map_or(1.0, |place| place.height)
    }

    fn redraw(&mut self, events: &ActiveEventLoop) {
        let started = self.watch.elapsed();
        if let Err(error) = self.frame() {
            self.failed = Some(error);
            events.exit();
        }
        let software = self.screen.as_ref().is_some_and(|screen| screen.gpu.software);
        let took = self.watch.elapsed().saturating_sub(started);
        let shown = if software { MOST_HZ.1 } else { MOST_HZ.0 };
        let most_hz = if self.flies() { shown } else { PAGES_HZ };
        let rest = if software { took.mul_f64(REST) } else { Duration::ZERO };
        self.due = started + Duration::from_secs_f64(1.0 / most_hz).max(took + rest);
    }
}

impl ApplicationHandler for Cockpit {
    fn resumed(&mut self, events: &ActiveEventLoop) {
        if self.screen.is_some() {
            return;
        }
        let title = self.crew.flight.as_ref().map_or("Spandrel".to_owned(), |flight| format!("Spandrel: {}", flight.job.0.title));
        match Screen::open(events, &title, self.plan.size_px) {
            Ok(screen) => {
                self.screen = Some(screen);
                if let Some(lead) = &self.crew.lead {
                    lead.tell(&FromWindow::Ready);
                }
            }
            Err(error) => {
                self.failed = Some(error);
                events.exit();
            }
        }
    }

    fn window_event(&mut self, events: &ActiveEventLoop, _: WindowId, event: WindowEvent) {
        if let Some(screen) = &mut self.screen {
            screen.take(&event);
        }
        match event {
            WindowEvent::CloseRequested => events.exit(),
            WindowEvent::RedrawRequested => self.redraw(events),
            WindowEvent::KeyboardInput { event, is_synthetic, .. } => self.key(&event, is_synthetic),
            WindowEvent::Focused(false) => {
                self.held.let_go();
                self.hand_on(Ask::LetGo);
            }
            WindowEvent::MouseInput { state, button: MouseButton::Left, .. } => self.click(state == ElementState::Pressed),
            WindowEvent::CursorMoved { position, .. } => self.moved(position.x, position.y),
            WindowEvent::MouseWheel { delta, .. } => {
                let notches = match delta {
                    MouseScrollDelta::LineDelta(_, lines) => f64::from(lines),
                    // A notch of usual wheels is some 50 px (estimate).
                    MouseScrollDelta::PixelDelta(px) => px.y / 50.0,
                };
                self.gaze.zoom(spandrel_model::math::pow(ZOOM_NOTCH, notches.clamp(-10.0, 10.0)));
            }
            _ => {}
        }
    }

    fn about_to_wait(&mut self, events: &ActiveEventLoop) {
        if self.stop.asked() {
            events.exit();
            return;
        }
        let now = self.watch.elapsed();
        if now >= self.due {
            if let Some(screen) = &self.screen {
                screen.window.request_redraw();
            }
            self.due = now + Duration::from_millis(100);
        }
        events.set_control_flow(ControlFlow::wait_duration(self.due.saturating_sub(now)));
    }
}
