//! The window's main loop. Handles events and shows pages and views.

use super::display;
use super::flight_view::FlightView;
use super::job_pictures::JobPictures;
use super::keys::{self, HeldKeys, KeyChange};
use super::page_pictures::PagePictures;
use super::page_refresh::ShownPage;
use super::picture_writer::PictureWriter;
use super::pilot::{PilotCommand, PilotThread};
use super::screen::WindowSurface;
use super::sound::AudioOutput;
use super::stream::StreamSender;
use super::train_pipe::TrainPipe;
use super::window_config::WindowConfig;
use super::window_settings::WindowSettings;
use crate::errors::AppError;
use crate::io::clock::Stopwatch;
use crate::io::stop::StopRequest;
use spandrel_clients::rc::keyboard::{KeyBindings, WindowAction};
use spandrel_text::text;
use spandrel_view::arrange::{ViewKind, ViewLayout, WindowShape};
use spandrel_view::flow::pipe::FromWindow;
use spandrel_view::flow::{Page, WindowFlow};
use spandrel_view::gpu::PageTextures;
use spandrel_view::hud;
use spandrel_view::inspector_camera::InspectorCamera;
use spandrel_view::quality::{PRESETS, Quality};
use std::time::Duration;
use winit::application::ApplicationHandler;
use winit::event::{ElementState, KeyEvent, MouseButton, MouseScrollDelta, WindowEvent};
use winit::event_loop::{ActiveEventLoop, ControlFlow};
use winit::window::{Fullscreen, WindowId};

/// Maximum frame rates of the views, 1/s. With a graphics card: the refresh rate of fast displays. Without one: a rate
/// that still looks smooth.
const MAX_FRAME_RATE_HZ: (f64, f64) = (120.0, 25.0);
/// Frame rate of pages, 1/s. Pages change only on key and stick input.
const PAGE_FRAME_RATE_HZ: f64 = 20.0;
/// Pause after each frame as a fraction of the frame time, without a graphics card. It lets other processes run where the window's
/// priority cannot be lowered.
const IDLE_TIME_FRACTION: f64 = if cfg!(unix) { 0.0 } else { 0.25 };
/// Zoom factor per mouse wheel notch.
const ZOOM_FACTOR_PER_NOTCH: f64 = 1.15;
/// Scroll distance per mouse wheel notch and per press of Page up or Page down, as fractions of the window's height.
const NOTCH_SCROLL: f64 = 0.1;
const PAGE_SCROLL: f64 = 0.8;

/// The window's threads and connections.
pub struct WindowThreads {
    /// Pilot thread, if the window can fly the vehicle.
    pub pilot: Option<PilotThread>,
    /// Pipe to `train`, if it started the window.
    pub train_pipe: Option<TrainPipe>,
    /// Flight to show at startup.
    pub flight: Option<FlightView>,
    /// Video stream that shows the camera's view.
    pub stream: Option<StreamSender>,
}

/// The window and its state.
pub struct Cockpit {
    pub(super) plan: WindowConfig,
    pub(super) settings: WindowSettings,
    pub(super) flow: WindowFlow,
    pub(super) threads: WindowThreads,
    pub(super) image_writer: Option<PictureWriter>,
    pub(super) speaker: AudioOutput,
    pub(super) stop: StopRequest,
    pub(super) screen: Option<WindowSurface>,
    pub(super) pictures: PageTextures,
    pub(super) page_pictures: PagePictures,
    pub(super) job_pictures: JobPictures,
    /// `None` while the window shows something else, or a page without its last changes.
    pub(super) shown_page: Option<ShownPage>,
    pub(super) inspector_camera: InspectorCamera,
    pub(super) map: bool,
    /// Whether the path is drawn into the pictures.
    pub(super) path: bool,
    /// Whether the ghost of an earlier flight is shown.
    pub(super) ghost: bool,
    pub(super) held: HeldKeys,
    /// Last pause state sent to the pilot thread.
    pub(super) was_paused: bool,
    mouse: Option<(f64, f64)>,
    dragging: bool,
    pub(super) notices: Vec<(String, Duration)>,
    pub(super) stopwatch: Stopwatch,
    pub(super) last_frame_at: Duration,
    next_frame_at: Duration,
    /// Whether the window itself has requested the next frame.
    frame_requested: bool,
    failed: Option<AppError>,
}

impl Cockpit {
    /// Creates the state. The window opens later.
    pub fn new(
        plan: WindowConfig,
        settings: WindowSettings,
        flow: WindowFlow,
        threads: WindowThreads,
        speaker: AudioOutput,
        stop: StopRequest,
    ) -> Self {
        Self {
            map: plan.map,
            path: true,
            ghost: false,
            image_writer: threads.flight.as_ref().and(plan.camera_file.clone()).map(PictureWriter::start),
            plan,
            settings,
            flow,
            threads,
            speaker,
            stop,
            screen: None,
            pictures: PageTextures::default(),
            page_pictures: PagePictures::default(),
            job_pictures: JobPictures::default(),
            shown_page: None,
            inspector_camera: InspectorCamera::default(),
            held: HeldKeys::default(),
            was_paused: false,
            mouse: None,
            dragging: false,
            notices: Vec::new(),
            stopwatch: Stopwatch::start(),
            last_frame_at: Duration::ZERO,
            next_frame_at: Duration::ZERO,
            frame_requested: false,
            failed: None,
        }
    }

    /// Opens the window and runs it until it is closed.
    pub fn run(mut self) -> Result<(), AppError> {
        let events = display::open()?;
        events.run_app(&mut self).map_err(|error| AppError::failed(format!("the window failed: {error}")))?;
        self.end_flight();
        self.failed.map_or(Ok(()), Err)
    }

    pub(super) fn quality(&self, screen: &WindowSurface) -> Quality {
        let usual = if screen.gpu.software { "low" } else { "high" };
        self.settings.current().quality_preset().or_else(|| Quality::by_name(usual)).unwrap_or(PRESETS[0])
    }

    /// Returns the key bindings.
    pub(super) fn keys(&self) -> &KeyBindings {
        &self.settings.current().keys
    }

    /// Stops showing the current flight.
    pub(super) fn end_flight(&mut self) {
        self.image_writer = None;
        if let Some(flight) = self.threads.flight.take() {
            let wall = flight.listener.wall();
            flight.listener.live().set_video_status(None, wall);
            let watch = self.stopwatch;
            flight.end(|first| watch.elapsed().saturating_sub(first));
        }
    }

    /// Returns true while the window shows the views and the keys control the vehicle.
    fn is_flying(&self) -> bool {
        self.flow.page() == Page::Flight
    }

    fn key(&mut self, event: &KeyEvent, is_synthetic: bool) {
        if self.held.pressed_elsewhere(event, is_synthetic) {
            return;
        }
        if keys::is_full_screen_key(event) {
            self.toggle_full_screen();
            return;
        }
        let change = self.held.handle(event);
        if self.flow.is_awaiting_key() {
            self.bind_key(event, change.as_ref());
            return;
        }
        if !self.is_flying() {
            self.key_on_page(event, change);
            return;
        }
        match change {
            Some(KeyChange::Down(key)) => {
                self.handle_action(&key);
                if self.is_flying() {
                    self.send_to_pilot(PilotCommand::Down(key));
                }
            }
            Some(KeyChange::Up(key)) => self.send_to_pilot(PilotCommand::Up(key)),
            None => {}
        }
    }

    /// Binds the pressed key to the function that awaits one.
    fn bind_key(&mut self, event: &KeyEvent, change: Option<&KeyChange>) {
        match change {
            Some(KeyChange::Down(key)) => self.flow.bind_key(Some(key)),
            Some(KeyChange::Up(_)) => {}
            None if event.state == ElementState::Pressed && !event.repeat => self.flow.bind_key(None),
            None => {}
        }
    }

    fn toggle_full_screen(&self) {
        if let Some(screen) = &self.screen {
            let is_full = screen.window.fullscreen().is_some();
            screen.window.set_fullscreen((!is_full).then_some(Fullscreen::Borderless(None)));
        }
    }

    fn key_on_page(&mut self, event: &KeyEvent, change: Option<KeyChange>) {
        let trying = self.flow.page() == Page::Controls;
        match change {
            Some(KeyChange::Down(key))
                if self.flow.is_dialog_open() && self.keys().window_action(&key) == Some(WindowAction::Pause) =>
            {
                self.flow.pause();
                return;
            }
            Some(KeyChange::Down(key))
                if self.flow.is_paused()
                    && self.flow.is_dialog_open()
                    && self.keys().window_action(&key) == Some(WindowAction::Restart) =>
            {
                self.flow.restart();
                return;
            }
            // The controller page shows the keyboard's stick positions.
            Some(KeyChange::Down(key)) if trying => self.send_to_pilot(PilotCommand::Down(key)),
            Some(KeyChange::Up(key)) => self.send_to_pilot(PilotCommand::Up(key)),
            _ => {}
        }
        // Keys that the user tests there have no other effect.
        let tried = keys::name(&event.logical_key).is_some_and(|key| self.flow.only_tests(&key, self.keys().is_stick(&key)));
        if tried {
            return;
        }
        if let Some(pages) = keys::scrolled_pages(event) {
            self.scroll(PAGE_SCROLL * pages);
        } else if let Some(press) = keys::press(event) {
            self.flow.press(press);
        }
    }

    /// Scrolls the page by a fraction of the window's height.
    fn scroll(&mut self, by: f64) {
        let window = self.shape().window;
        self.flow.scroll(by, window);
    }

    fn handle_action(&mut self, key: &str) {
        match self.keys().window_action(key) {
            Some(WindowAction::Swap) => self.flow.arrangement = self.flow.arrangement.next(),
            Some(WindowAction::Map) => self.toggle_map(),
            Some(WindowAction::LargeMap) => self.flow.toggle_large_map(self.plan.map),
            Some(WindowAction::Path) => self.path = !self.path,
            Some(WindowAction::Ghost) => self.toggle_ghost(),
            Some(WindowAction::Walk) => self.walk_to_next_place(),
            Some(WindowAction::Follow) => self.inspector_camera = InspectorCamera::default(),
            Some(WindowAction::Pause) => self.flow.pause(),
            Some(WindowAction::Restart) => self.flow.restart(),
            Some(WindowAction::Sound) => self.flow.toggle_sound(),
            Some(
                WindowAction::LookLeft
                | WindowAction::LookRight
                | WindowAction::LookUp
                | WindowAction::LookDown
                | WindowAction::ZoomIn
                | WindowAction::ZoomOut,
            )
            | None => {}
        }
    }

    /// Shows or hides the map. Hiding also leaves the large map.
    fn toggle_map(&mut self) {
        self.map = !self.map && self.flow.arrangement != ViewLayout::Map;
        self.flow.leave_large_map();
    }

    /// Shows or hides the ghost of an earlier flight.
    fn toggle_ghost(&mut self) {
        let Some(ghost) = self.flow.ghost() else { return self.flow.explain_missing_ghost() };
        let language = self.flow.language();
        let words = text!(language, "window-flight-ghost", words = ghost.words.as_str());
        self.ghost = !self.ghost;
        self.flow.show_notice(if self.ghost { words } else { text!(language, "window-flight-ghost-hidden") });
    }

    /// Sends the inspector to the next place.
    fn walk_to_next_place(&mut self) {
        let flight = self.threads.flight.as_ref();
        let Some((flight, now)) = flight.and_then(|flight| Some((flight, flight.now()?))) else { return };
        let language = self.flow.language();
        match (flight.next_place(&now), &self.threads.pilot) {
            (Some(place), Some(pilot)) => pilot.send_command(PilotCommand::Walk(place)),
            (Some(_), None) => self.flow.show_notice(text!(language, "window-flight-walk-not-here")),
            (None, _) => self.flow.show_notice(text!(language, "window-flight-no-places")),
        }
    }

    /// Sends the language of the window to `train` and the pilot thread.
    pub(super) fn announce_language(&self) {
        let language = self.settings.language();
        if let Some(train_pipe) = &self.threads.train_pipe {
            train_pipe.send(&FromWindow::Language { tag: language.tag().to_owned() });
        }
        self.send_to_pilot(PilotCommand::SetLanguage(language));
    }

    pub(super) fn send_to_pilot(&self, ask: PilotCommand) {
        if let Some(pilot) = &self.threads.pilot {
            pilot.send_command(ask);
        }
    }

    fn click(&mut self, pressed: bool) {
        self.dragging = false;
        let (Some(screen), Some((x, y)), true) = (&self.screen, self.mouse, pressed) else { return };
        let size = screen.window.inner_size();
        let (width, height) = (f64::from(size.width.max(1)), f64::from(size.height.max(1)));
        let hit = self.flow.click(hud::at(x / width, y / height), width / height);
        self.dragging = !hit && self.is_flying();
    }

    fn handle_mouse_move(&mut self, x: f64, y: f64) {
        if let (true, Some((from_x, from_y)), Some(flight)) = (self.dragging, self.mouse, &self.threads.flight)
            && let (Some(panes), Some(now)) = (flight.panes(), flight.now())
        {
            // The scene follows the pointer, so the same object stays under it.
            let to = panes.inspector_to_aircraft(&now);
            let rad_per_px = self.inspector_camera.rad_per_px(self.inspector_view_height_px(), to);
            self.inspector_camera.turn(rad_per_px * (from_x - x), rad_per_px * (y - from_y), to);
        }
        self.mouse = Some((x, y));
    }

    /// Returns the aspect ratios of the window and of the camera's picture.
    pub(super) fn shape(&self) -> WindowShape {
        let size = self.screen.as_ref().map(|screen| screen.window.inner_size());
        let window = size.map_or(1.0, |size| f64::from(size.width.max(1)) / f64::from(size.height.max(1)));
        WindowShape { window, camera: self.flow.camera_aspect }
    }

    /// Returns the on-screen height of the inspector's view in pixels.
    fn inspector_view_height_px(&self) -> f64 {
        let window = self.screen.as_ref().map_or(1.0, |screen| f64::from(screen.window.inner_size().height.max(1)));
        let eyes =
            self.flow.arrangement.view_rects(self.shape()).into_iter().find(|view_rect| view_rect.which == ViewKind::Inspector);
        window * eyes.map_or(1.0, |view_rect| view_rect.height)
    }

    fn redraw(&mut self, events: &ActiveEventLoop) {
        let started = self.stopwatch.elapsed();
        // The system requests a frame if something else was drawn over the window.
        if !std::mem::take(&mut self.frame_requested) {
            self.shown_page = None;
        }
        if let Err(error) = self.frame() {
            self.failed = Some(error);
            events.exit();
        }
        let software = self.screen.as_ref().is_some_and(|screen| screen.gpu.software);
        let shown = if software { MAX_FRAME_RATE_HZ.1 } else { MAX_FRAME_RATE_HZ.0 };
        let most_hz = if self.is_flying() { shown } else { PAGE_FRAME_RATE_HZ };
        let took = self.stopwatch.elapsed().saturating_sub(started);
        let rest = if software { took.mul_f64(IDLE_TIME_FRACTION) } else { Duration::ZERO };
        self.next_frame_at = started + Duration::from_secs_f64(1.0 / most_hz).max(took + rest);
    }
}

impl ApplicationHandler for Cockpit {
    fn resumed(&mut self, events: &ActiveEventLoop) {
        if self.screen.is_some() {
            return;
        }
        let title =
            self.threads.flight.as_ref().map_or("Spandrel".to_owned(), |flight| format!("Spandrel: {}", flight.job.0.title));
        match WindowSurface::open(events, &title, self.plan.size_px, self.plan.second_screen) {
            Ok(screen) => {
                self.screen = Some(screen);
                if let Some(train_pipe) = &self.threads.train_pipe {
                    train_pipe.send(&FromWindow::Ready);
                }
                self.announce_language();
            }
            Err(error) => {
                self.failed = Some(error);
                events.exit();
            }
        }
    }

    fn window_event(&mut self, events: &ActiveEventLoop, _: WindowId, event: WindowEvent) {
        if let Some(screen) = &mut self.screen {
            screen.handle_event(&event);
        }
        match event {
            WindowEvent::CloseRequested => events.exit(),
            WindowEvent::RedrawRequested => self.redraw(events),
            WindowEvent::Resized(_) | WindowEvent::ScaleFactorChanged { .. } | WindowEvent::Occluded(_) => self.shown_page = None,
            WindowEvent::KeyboardInput { event, is_synthetic, .. } => self.key(&event, is_synthetic),
            WindowEvent::Focused(false) => {
                self.held.clear();
                self.send_to_pilot(PilotCommand::ReleaseKeys);
            }
            WindowEvent::MouseInput { state, button: MouseButton::Left, .. } => self.click(state == ElementState::Pressed),
            WindowEvent::CursorMoved { position, .. } => self.handle_mouse_move(position.x, position.y),
            WindowEvent::MouseWheel { delta, .. } => {
                let notches = match delta {
                    MouseScrollDelta::LineDelta(_, lines) => f64::from(lines),
                    // A mouse wheel notch is typically about 50 px (estimate).
                    MouseScrollDelta::PixelDelta(px) => px.y / 50.0,
                };
                if self.is_flying() {
                    self.inspector_camera.zoom(spandrel_model::math::pow(ZOOM_FACTOR_PER_NOTCH, notches.clamp(-10.0, 10.0)));
                } else {
                    self.scroll(-NOTCH_SCROLL * notches);
                }
            }
            _ => {}
        }
    }

    fn about_to_wait(&mut self, events: &ActiveEventLoop) {
        if self.stop.is_requested() {
            events.exit();
            return;
        }
        let now = self.stopwatch.elapsed();
        if now >= self.next_frame_at {
            if let Some(screen) = &self.screen {
                screen.window.request_redraw();
                self.frame_requested = true;
            }
            self.next_frame_at = now + Duration::from_millis(100);
        }
        events.set_control_flow(ControlFlow::wait_duration(self.next_frame_at.saturating_sub(now)));
    }
}
