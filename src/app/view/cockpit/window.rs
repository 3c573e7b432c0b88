//! The window's loop: events in, views out.

use super::keeper::Keeper;
use super::keys::{Change, Held};
use super::listener::Listener;
use super::panes::{Job, Panes, Shown};
use super::pilot::{Pilot, Press};
use super::screen::Screen;
use super::stream::Stream;
use crate::app::clock::Stopwatch;
use crate::app::errors::AppError;
use crate::app::render::png;
use crate::app::stop::Stop;
use crate::rc::keyboard::{Keys, Wish};
use crate::scenario::Scenario;
use crate::vehicle::Vehicle;
use crate::view::arrange::Arrangement;
use crate::view::gaze::Gaze;
use crate::view::gpu::paint;
use crate::view::live::Now;
use crate::view::quality::{PRESETS, Quality};
use serde_json::json;
use std::path::PathBuf;
use std::sync::mpsc::{Receiver, channel};
use std::time::Duration;
use winit::application::ApplicationHandler;
use winit::event::{ElementState, MouseButton, MouseScrollDelta, WindowEvent};
use winit::event_loop::{ActiveEventLoop, ControlFlow, EventLoop};
use winit::window::WindowId;

/// No more pictures than this, 1/s: what a screen shows; without a graphics card, what a person still sees as motion.
const MOST_HZ: (f64, f64) = (120.0, 25.0);
/// Rest after a picture without a graphics card, as a share of what it took: the machine has other work.
const REST: f64 = 0.25;
/// The inspector's head turns so fast by keys, rad/s, and by the mouse, rad a pixel (estimates: comfortable on a laptop).
const TURN_RAD_S: f64 = 1.0;
const TURN_RAD_PX: f64 = 0.003;
/// A notch of the wheel, and a second of a held key, zoom so many times.
const ZOOM_NOTCH: f64 = 1.15;
const ZOOM_S: f64 = 2.0;
/// Words stay on the screen this long, s, and the first help longer.
const WORDS_S: f64 = 7.0;
const HELP_S: f64 = 25.0;

/// What is asked for on the command line.
#[derive(Debug, Clone)]
pub struct Plan {
    /// A preset; `None`: by the device.
    pub quality: Option<Quality>,
    /// Size of the window.
    pub size_px: (u32, u32),
    /// The map may be shown.
    pub map: bool,
    /// The session's seed, where it need not be heard.
    pub seed: Option<u64>,
    /// A picture to keep.
    pub picture: Option<Picture>,
    /// Where the camera's view is kept for others.
    pub keep: Option<PathBuf>,
    /// Say on standard output when both views are drawn.
    pub announce: bool,
}

/// A picture of the window.
#[derive(Debug, Clone)]
pub struct Picture {
    /// Where it goes.
    pub path: PathBuf,
    /// When, from the first drawn view.
    pub after: Duration,
}

/// The preset of a name; `None` for auto.
pub fn quality(name: &str) -> Result<Option<Quality>, AppError> {
    if name == "auto" { Ok(None) } else { crate::app::render::quality(name).map(Some) }
}

/// What stands between the vehicle and its picture.
enum Scene {
    /// Nobody has said which session it is.
    Waiting,
    /// Site and light are being worked out.
    Building(Receiver<Job>),
    /// It is drawn.
    Drawn(Box<Panes>),
}

/// The window with everything behind it.
pub struct Cockpit {
    plan: Plan,
    job: (Scenario, Vehicle),
    keys: Keys,
    listener: Listener,
    pilot: Option<Pilot>,
    stream: Option<Stream>,
    stop: Stop,
    screen: Option<Screen>,
    scene: Scene,
    arrangement: Arrangement,
    gaze: Gaze,
    map: bool,
    held: Held,
    mouse: Option<(f64, f64)>,
    dragging: bool,
    words: Vec<(String, Duration)>,
    watch: Stopwatch,
    frame_at: Duration,
    due: Duration,
    first_drawn: Option<Duration>,
    drawn: u32,
    failed: Option<AppError>,
    keeper: Option<Keeper>,
}

impl Cockpit {
    /// Nothing is open yet.
    pub fn new(
        plan: Plan,
        job: (Scenario, Vehicle),
        keys: Keys,
        (listener, pilot, stream): (Listener, Option<Pilot>, Option<Stream>),
        stop: Stop,
    ) -> Self {
        Self {
            map: plan.map,
            keeper: plan.keep.clone().map(Keeper::start),
            plan,
            job,
            keys,
            listener,
            pilot,
            stream,
            stop,
            screen: None,
            scene: Scene::Waiting,
            arrangement: Arrangement::default(),
            gaze: Gaze::default(),
            held: Held::default(),
            mouse: None,
            dragging: false,
            words: Vec::new(),
            watch: Stopwatch::start(),
            frame_at: Duration::ZERO,
            due: Duration::ZERO,
            first_drawn: None,
            drawn: 0,
            failed: None,
        }
    }

    /// Opens the window and stays until it is closed.
    pub fn run(mut self) -> Result<(), AppError> {
        let events = display()?;
        events.run_app(&mut self).map_err(|error| AppError::failed(format!("the window broke off: {error}")))?;
        if let Some(first) = self.first_drawn {
            let seconds = self.watch.elapsed().saturating_sub(first).as_secs_f64();
            tracing::info!("{} pictures of both views, {:.1} a second", self.drawn, f64::from(self.drawn) / seconds.max(1e-3));
        }
        self.failed.map_or(Ok(()), Err)
    }

    fn quality(&self, screen: &Screen) -> Quality {
        let usual = if screen.gpu.software { "low" } else { "high" };
        self.plan.quality.or_else(|| Quality::named(usual)).unwrap_or(PRESETS[0])
    }

    /// Goes on from waiting to building to drawing, as far as is known by now.
    fn prepare(&mut self, now: Option<&Now>) -> Result<(), AppError> {
        let Some(screen) = &self.screen else { return Ok(()) };
        match &self.scene {
            Scene::Waiting => {
                let (seed, crc, estimated) = {
                    let live = self.listener.live();
                    (live.seed(), live.scenario_crc(), live.is_estimated())
                };
                if crc.is_some_and(|crc| crc != self.job.0.crc) {
                    return Err(AppError::wrong(
                        "the simulator flies another scenario than this window was given: start both with the same --scenario",
                    ));
                }
                // A real vehicle names no seed: its bridges have no seeded defects of ours.
                let seed = self.plan.seed.or(seed).or(self.job.0.seed).or(estimated.then_some(0));
                let (Some(seed), Some(now)) = (seed, now) else { return Ok(()) };
                let ((scenario, vehicle), quality, at) = (self.job.clone(), self.quality(screen), now.moment.at);
                tracing::info!("drawing with {}, {}, seed {seed}", screen.gpu.name, quality.name);
                let (sender, receiver) = channel();
                std::thread::spawn(move || {
                    // A window that was closed meanwhile needs no scene.
                    let _ = sender.send(Job::build(scenario, vehicle, seed, &quality, at));
                });
                self.scene = Scene::Building(receiver);
            }
            Scene::Building(receiver) => {
                if let Ok(job) = receiver.try_recv() {
                    self.scene = Scene::Drawn(Box::new(Panes::new(screen, self.quality(screen), job)));
                }
            }
            Scene::Drawn(_) => {}
        }
        Ok(())
    }

    fn frame(&mut self) -> Result<(), AppError> {
        let started = self.watch.elapsed();
        let step_s = started.saturating_sub(self.frame_at).as_secs_f64();
        self.frame_at = started;
        let (now, feed) = {
            let mut live = self.listener.live();
            (live.now(self.listener.wall(), &self.job.1), live.feed().clone())
        };
        self.prepare(now.as_ref())?;
        self.look(now.as_ref(), step_s);
        while let Some(text) = self.pilot.as_ref().and_then(Pilot::poll_told) {
            tracing::info!("{text}");
            self.words.push((text, started));
        }
        self.words.retain(|(_, since)| started.saturating_sub(*since).as_secs_f64() < WORDS_S);
        let Some(screen) = &mut self.screen else { return Ok(()) };
        let shown = match (&mut self.scene, &now) {
            (Scene::Drawn(panes), Some(now)) => {
                panes.draw(screen, &self.arrangement.places(), now, &feed, &self.gaze, self.map && self.plan.map)
            }
            _ => Vec::new(),
        };
        let text = Text {
            waiting: waiting(&self.scene, now.is_some(), &self.listener),
            words: self.words.iter().map(|(words, _)| words.clone()).collect(),
            help: match self.first_drawn {
                Some(first) if started.saturating_sub(first).as_secs_f64() < HELP_S => help(&self.keys, self.pilot.is_some()),
                _ => String::new(),
            },
        };
        screen.show(|ui| compose(ui, &shown, &text))?;
        if shown.is_empty() {
            return Ok(());
        }
        self.drawn += 1;
        if let (Some(stream), Scene::Drawn(panes), Some(screen)) = (&mut self.stream, &self.scene, &self.screen)
            && stream.is_due()
            && let Some(picture) = panes.camera(screen)?
        {
            self.listener.live().streams(stream.push(picture));
        }
        if self.first_drawn.is_none() {
            self.first_drawn = Some(self.watch.elapsed());
            self.announce();
        }
        self.hand_out()?;
        self.keep_picture(&shown, &text)
    }

    /// Hands the camera's view to whoever watches elsewhere.
    fn hand_out(&mut self) -> Result<(), AppError> {
        let (Some(keeper), Some(screen), Scene::Drawn(panes)) = (&mut self.keeper, &self.screen, &self.scene) else {
            return Ok(());
        };
        if keeper.is_due(self.watch.elapsed())
            && let Some(picture) = panes.camera(screen)?
        {
            keeper.take(picture);
        }
        Ok(())
    }

    /// Keys that are held move the inspector's eyes.
    fn look(&mut self, now: Option<&Now>, step_s: f64) {
        let (Scene::Drawn(panes), Some(now)) = (&self.scene, now) else { return };
        let held = |wish: &str| self.keys.of(wish).is_some_and(|key| self.held.is_down(key));
        let way = |plus: &str, minus: &str| f64::from(i8::from(held(plus)) - i8::from(held(minus)));
        let (right, up) = (way("look_right", "look_left"), way("look_up", "look_down"));
        if right != 0.0 || up != 0.0 {
            self.gaze.turn(TURN_RAD_S * step_s * right, TURN_RAD_S * step_s * up, panes.to_aircraft(now));
        }
        self.gaze.zoom(crate::base::math::pow(ZOOM_S, step_s * way("zoom_in", "zoom_out")));
    }

    fn announce(&self) {
        let Some(screen) = self.screen.as_ref().filter(|_| self.plan.announce) else { return };
        let size = screen.window.inner_size();
        let quality = self.quality(screen).name;
        println!("{}", json!({ "device": screen.gpu.name, "quality": quality, "width": size.width, "height": size.height }));
    }

    fn keep_picture(&mut self, shown: &[Shown], text: &Text) -> Result<(), AppError> {
        let (Some(plan), Some(first), Some(screen)) = (&self.plan.picture, self.first_drawn, &mut self.screen) else {
            return Ok(());
        };
        if self.watch.elapsed().saturating_sub(first) < plan.after {
            return Ok(());
        }
        let picture = screen.picture(|ui| compose(ui, shown, text))?;
        crate::app::files::write(&plan.path.display().to_string(), &png(&picture)?)?;
        self.stop.ask();
        Ok(())
    }

    fn key(&mut self, change: Change) {
        match change {
            Change::Down(key) => {
                match self.keys.wish(&key) {
                    Some(Wish::Swap) => self.arrangement = self.arrangement.next(),
                    Some(Wish::Map) => self.map = !self.map,
                    Some(Wish::Follow) => self.gaze.follows = true,
                    Some(_) | None => {}
                }
                self.hand_on(Press::Down(key));
            }
            Change::Up(key) => self.hand_on(Press::Up(key)),
        }
    }

    fn hand_on(&self, press: Press) {
        if let Some(pilot) = &self.pilot {
            pilot.press(press);
        }
    }

    fn moved(&mut self, x: f64, y: f64) {
        if let (true, Some((from_x, from_y)), Scene::Drawn(panes)) = (self.dragging, self.mouse, &self.scene) {
            let now = self.listener.live().now(self.listener.wall(), &self.job.1);
            if let Some(now) = now {
                // The world is dragged along: what is under the pointer stays there.
                self.gaze.turn(TURN_RAD_PX * (from_x - x), TURN_RAD_PX * (y - from_y), panes.to_aircraft(&now));
            }
        }
        self.mouse = Some((x, y));
    }
}

impl ApplicationHandler for Cockpit {
    fn resumed(&mut self, events: &ActiveEventLoop) {
        if self.screen.is_some() {
            return;
        }
        let title = format!("Spandrel: {}", self.job.0.title);
        match Screen::open(events, &title, self.plan.size_px) {
            Ok(screen) => self.screen = Some(screen),
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
            WindowEvent::RedrawRequested => {
                let started = self.watch.elapsed();
                if let Err(error) = self.frame() {
                    self.failed = Some(error);
                    events.exit();
                }
                let software = self.screen.as_ref().is_some_and(|screen| screen.gpu.software);
                let took = self.watch.elapsed().saturating_sub(started);
                let least = Duration::from_secs_f64(1.0 / if software { MOST_HZ.1 } else { MOST_HZ.0 });
                let rest = if software { took.mul_f64(REST) } else { Duration::ZERO };
                self.due = started + least.max(took + rest);
            }
            WindowEvent::KeyboardInput { event, .. } => {
                if let Some(change) = self.held.take(&event) {
                    self.key(change);
                }
            }
            WindowEvent::Focused(false) => {
                self.held.let_go();
                self.hand_on(Press::LetGo);
            }
            WindowEvent::MouseInput { state, button: MouseButton::Left, .. } => self.dragging = state == ElementState::Pressed,
            WindowEvent::CursorMoved { position, .. } => self.moved(position.x, position.y),
            WindowEvent::MouseWheel { delta, .. } => {
                let notches = match delta {
                    MouseScrollDelta::LineDelta(_, lines) => f64::from(lines),
                    // A notch of usual wheels is some 50 px (estimate).
                    MouseScrollDelta::PixelDelta(px) => px.y / 50.0,
                };
                self.gaze.zoom(crate::base::math::pow(ZOOM_NOTCH, notches.clamp(-10.0, 10.0)));
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

/// The display's events.
fn display() -> Result<EventLoop<()>, AppError> {
    // The library for keyboards is looked for when it is first used, and its absence is a panic there: here it is one more thing that is
    // missing.
    let told = std::panic::take_hook();
    std::panic::set_hook(Box::new(|_| {}));
    let opened = std::panic::catch_unwind(EventLoop::new);
    std::panic::set_hook(told);
    let why = match opened {
        Ok(Ok(events)) => return Ok(events),
        Ok(Err(error)) => error.to_string(),
        Err(_) => "a library is missing; Debian and Ubuntu: apt-get install libxkbcommon-x11-0 libx11-xcb1 libxcursor1 libxi6 libxrandr2"
            .to_owned(),
    };
    Err(AppError::failed(format!("there is no display to open a window on ({why}); everything else works without")))
}

/// Words of the window itself.
struct Text {
    waiting: String,
    words: Vec<String>,
    help: String,
}

fn waiting(scene: &Scene, heard: bool, listener: &Listener) -> String {
    match scene {
        Scene::Drawn(_) => String::new(),
        Scene::Building(_) => "Building the site and its light ...".to_owned(),
        Scene::Waiting if heard => "The vehicle is heard; waiting for the session's seed ...".to_owned(),
        Scene::Waiting => format!("Waiting for the vehicle at {} ...", listener.vehicle()),
    }
}

fn help(keys: &Keys, flies: bool) -> String {
    let key = |name: &str| keys.of(name).unwrap_or("?").to_uppercase();
    let mut words = format!(
        "{} views    {} map    drag or {} {} look around    wheel zoom    {} follow the drone",
        key("swap"),
        key("map"),
        key("look_left"),
        key("look_right"),
        key("follow")
    );
    if flies {
        words.push_str(&format!(
            "\n{} motors on    {} take off    {} {} up and down    {} {} turn    arrows fly    {} lamp    {} picture    {} land",
            key("arm"),
            key("take_off"),
            key("up"),
            key("down"),
            key("turn_left"),
            key("turn_right"),
            key("lamp"),
            key("snapshot"),
            key("land")
        ));
    }
    words
}

/// The window's content: pictures with their displays, and the window's own words.
fn compose(ui: &mut egui::Ui, shown: &[Shown], text: &Text) {
    let area = ui.ctx().content_rect();
    let painter = ui.ctx().layer_painter(egui::LayerId::background());
    for view in shown {
        let at = |x: f64, y: f64| area.min + egui::vec2(x as f32 * area.width(), y as f32 * area.height());
        let place = &view.place;
        let rect = egui::Rect::from_min_max(at(place.left, place.top), at(place.left + place.width, place.top + place.height));
        let whole = egui::Rect::from_min_max(egui::Pos2::ZERO, egui::pos2(1.0, 1.0));
        painter.image(view.picture, rect, whole, egui::Color32::WHITE);
        paint(&painter.with_clip_rect(rect), &view.items, rect);
        let edge = egui::Stroke::new(1.0, egui::Color32::from_gray(20));
        painter.rect_stroke(rect, 0.0, edge, egui::StrokeKind::Inside);
    }
    let size = 0.03 * area.height().max(300.0);
    if !text.waiting.is_empty() {
        let font = egui::FontId::proportional(1.2 * size);
        painter.text(area.center(), egui::Align2::CENTER_CENTER, &text.waiting, font, egui::Color32::from_gray(225));
    }
    let mut lines = text.words.clone();
    if !text.help.is_empty() {
        lines.push(text.help.clone());
    }
    if !lines.is_empty() {
        let font = egui::FontId::proportional(0.75 * size);
        let place = area.left_bottom() + egui::vec2(0.6 * size, -0.6 * size);
        let galley = painter.layout_no_wrap(lines.join("\n"), font, egui::Color32::from_gray(235));
        let rect = egui::Rect::from_min_size(place - egui::vec2(0.0, galley.size().y), galley.size());
        painter.rect_filled(rect.expand(0.3 * size), 0.2 * size, egui::Color32::from_black_alpha(160));
        painter.galley(rect.min, galley, egui::Color32::WHITE);
    }
}
