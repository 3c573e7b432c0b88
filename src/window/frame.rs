//! Renders one window frame (a page, or a flight with its displays) and handles the pages' requests.

use super::cockpit::Cockpit;
use super::flight_view::FlightView;
use super::job_pictures::JobLook;
use super::page_refresh::{ShownPage, must_render};
use super::panes::{PaneContent, ViewOptions};
use super::pilot::{PilotCommand, PilotThread};
use super::window_text::{WindowText, frozen, help, paint_flight, waiting, walk};
use crate::errors::AppError;
use crate::io::files;
use crate::io::png::png;
use serde_json::json;
use spandrel_model::frames::Enu;
use spandrel_model::pose::Pose;
use spandrel_text::monitor_texts::message_words;
use spandrel_text::text;
use spandrel_view::arrange::ViewLayout;
use spandrel_view::flow::pipe::{FlightStarted, FromWindow};
use spandrel_view::flow::{Page, PageLayout, SettingChange, WindowRequest};
use spandrel_view::gpu::{PageTextures, paint_sheet};
use spandrel_view::hud::{StatusAlarms, TextScale};
use spandrel_view::live::LiveMoment;
use spandrel_view::path_guide::PathAids;
use spandrel_view::sound::{ActiveAlarms, SoundInputs};

/// Turn rate of the inspector's view under keyboard control, rad/s, and zoom factor per second (estimates: comfortable
/// on a laptop).
const TURN_RATE_RAD_S: f64 = 1.0;
const ZOOM_FACTOR_PER_S: f64 = 2.0;
/// Display time for messages and for the initial key help, s.
const MESSAGE_DURATION_S: f64 = 7.0;
const KEY_HELP_DURATION_S: f64 = 25.0;
/// Maximum number of messages at the same time.
const MAX_MESSAGES: usize = 4;

impl Cockpit {
    /// Handles messages from `train` and requests from the pages, and renders a frame.
    pub(super) fn frame(&mut self) -> Result<(), AppError> {
        if let Some(fault) = self.screen.as_ref().and_then(|screen| screen.gpu.fault()) {
            return Err(fault.into());
        }
        while let Some(message) = self.threads.train_pipe.as_mut().and_then(super::train_pipe::TrainPipe::poll) {
            self.flow.handle_message(message);
        }
        if matches!(self.flow.page(), Page::Controls | Page::Calibrating)
            && let Some(pilot) = &self.threads.pilot
        {
            self.flow.update_controls(pilot.controls());
        }
        while let Some(order) = self.flow.poll() {
            self.apply_requests(order)?;
        }
        let stands = self.flow.is_paused();
        if std::mem::replace(&mut self.was_paused, stands) != stands {
            self.send_to_pilot(PilotCommand::SetPaused(stands));
        }
        match self.flow.page() {
            Page::Flight | Page::Paused | Page::ConfirmEnd => self.fly(),
            Page::Opening
            | Page::Start
            | Page::Controls
            | Page::Calibrating
            | Page::Tutorial(..)
            | Page::Settings { .. }
            | Page::Keys { .. }
            | Page::Briefing
            | Page::Waiting
            | Page::Results
            | Page::School => {
                self.speaker.silence();
                self.page()
            }
        }
    }

    /// Passes rotor speeds, the distance and warnings to the sound output.
    fn sound(&mut self, now: Option<&LiveMoment>) {
        let now = now.filter(|_| !self.flow.is_paused());
        let (Some(flight), Some(now)) = (&self.threads.flight, now) else {
            self.speaker.silence();
            return;
        };
        let mut live = flight.listener.live();
        if self.speaker.is_on() {
            live.request_rotor_outputs();
        }
        let distance_m = (now.moment.drone.pose.position_m - flight.inspector(now).feet_m).norm();
        let feed = live.feed();
        let status = StatusAlarms::new(now.hud.telemetry_age_s, feed.gnss(), feed.radio(now.moment.at));
        let inputs = SoundInputs {
            rotors_rad_s: live.rotors_rad_s(&flight.job.1),
            distance_m,
            alarms: ActiveAlarms { cues: feed.cues(now.moment.at, false), status },
            cue_texts: feed.cue_texts().clone(),
            style: self.flow.style(),
            silent: false,
        };
        self.speaker.set(inputs.with_freeze(now.hud.is_frozen));
    }

    fn apply_requests(&mut self, order: WindowRequest) -> Result<(), AppError> {
        match order {
            WindowRequest::Send(message) => {
                if let Some(train_pipe) = &self.threads.train_pipe {
                    train_pipe.send(&message);
                }
            }
            WindowRequest::ShowFlight(flying) => self.show(&flying)?,
            WindowRequest::LoadGhost(telemetry) => {
                if let Some(flight) = &mut self.threads.flight {
                    flight.load_ghost(telemetry);
                }
            }
            WindowRequest::LeaveFlight => {
                self.end_flight();
                self.send_to_pilot(PilotCommand::Disconnect);
            }
            WindowRequest::FindController => self.send_to_pilot(PilotCommand::FindController),
            WindowRequest::Calibrate => self.send_to_pilot(PilotCommand::Calibrate),
            WindowRequest::Confirm => self.send_to_pilot(PilotCommand::Confirm),
            WindowRequest::Cancel => self.send_to_pilot(PilotCommand::Cancel),
            WindowRequest::ChangeProfile(tune) => self.send_to_pilot(PilotCommand::ChangeProfile(tune)),
            WindowRequest::Open(address) => {
                if let Err(error) = open::that_detached(&address) {
                    let words = text!(self.flow.language(), "window-flight-no-browser", error = error.to_string());
                    self.flow.show_notice(words);
                }
            }
            WindowRequest::Sound(on) => {
                let failed = self.settings.set_sound(on);
                self.speaker.set_on(on);
                let language = self.flow.language();
                let told =
                    if on { text!(language, "window-flight-sound-on") } else { text!(language, "window-flight-sound-off") };
                self.flow.show_notice(failed.unwrap_or(told));
            }
            WindowRequest::ChangeSetting(change) => self.change_setting(&change),
            WindowRequest::Close => self.stop.request(),
        }
        Ok(())
    }

    /// Applies a change to the settings everywhere.
    fn change_setting(&mut self, change: &SettingChange) {
        let before = self.settings.language();
        let told = self.settings.apply(change);
        self.flow.update_settings(self.settings.status());
        self.speaker.set_preferences(self.keys().sounds);
        self.send_to_pilot(PilotCommand::SetKeys(self.keys().clone()));
        if self.settings.language() != before {
            self.announce_language();
        }
        told.into_iter().for_each(|words| self.flow.show_notice(words));
    }

    /// Shows a flight that has started.
    fn show(&mut self, flying: &FlightStarted) -> Result<(), AppError> {
        self.end_flight();
        let scenario = files::scenario(&flying.choice.scenario)?.scenario;
        let vehicle = files::vehicle(&flying.choice.vehicle)?.vehicle;
        if let Some(screen) = &self.screen {
            screen.window.set_title(&format!("Spandrel: {}", scenario.title));
        }
        self.threads.flight = Some(FlightView::begin(self.plan.listen, flying.connect, (scenario, vehicle), Some(flying.seed))?);
        self.image_writer = self.plan.camera_file.clone().map(super::picture_writer::PictureWriter::start);
        if let (Some(flight), Some(ghost)) = (&mut self.threads.flight, self.flow.ghost()) {
            flight.load_ghost(ghost.telemetry.clone());
        }
        (self.map, self.path, self.ghost) = (self.plan.map, true, false);
        self.inspector_camera = spandrel_view::inspector_camera::InspectorCamera::default();
        // Discard messages that arrived before the flight.
        while self.threads.pilot.as_ref().and_then(PilotThread::poll_message).is_some() {}
        self.notices.clear();
        self.send_to_pilot(PilotCommand::ReleaseKeys);
        if let Some(vehicle) = flying.fly {
            self.send_to_pilot(PilotCommand::Fly(vehicle));
        }
        Ok(())
    }

    fn page(&mut self) -> Result<(), AppError> {
        while let Some(JobLook { job, picture, drawing }) = self.job_pictures.poll() {
            self.flow.add_job_drawing(job.clone(), drawing);
            self.pictures.add_job(job, picture);
            self.shown_page = None;
        }
        if let Some(job) = self.flow.job_to_draw() {
            self.job_pictures.request(job);
        }
        while let Some((path, picture)) = self.page_pictures.poll() {
            self.pictures.add_file(path, picture);
            self.shown_page = None;
        }
        let sheet = self.flow.sheet(self.shape().window);
        for path in self.pictures.missing_files(&sheet) {
            self.page_pictures.request(path);
        }
        let (Some(screen), pictures) = (&mut self.screen, &mut self.pictures) else { return Ok(()) };
        let at = self.stopwatch.elapsed();
        if !must_render(self.shown_page.as_ref(), &sheet, at) {
            return Ok(());
        }
        let is_presented = screen.show(|ui| paint_page(ui, &sheet, pictures))?;
        self.shown_page = is_presented.then_some(ShownPage { sheet, at });
        Ok(())
    }

    fn fly(&mut self) -> Result<(), AppError> {
        self.shown_page = None;
        let started = self.stopwatch.elapsed();
        let step_s = started.saturating_sub(self.last_frame_at).as_secs_f64();
        self.last_frame_at = started;
        let stands = self.flow.is_paused();
        let now = self.threads.flight.as_ref().and_then(|flight| shown_moment(flight, stands));
        if let Some(screen) = &self.screen {
            let quality = self.quality(screen);
            if let Some(flight) = &mut self.threads.flight {
                flight.prepare(screen, quality, now.as_ref())?;
            }
        }
        self.turn_inspector_view(now.as_ref(), step_s);
        self.sound(now.as_ref());
        self.listen(started);
        let text = self.text(now.as_ref(), started);
        let is_map_allowed = self.plan.map && self.flow.shows_map();
        if !is_map_allowed {
            self.flow.leave_large_map();
        }
        let map = is_map_allowed && (self.map || self.flow.arrangement == ViewLayout::Map);
        if let Some(flight) = &self.threads.flight {
            self.flow.camera_aspect = flight.job.1.camera.aspect();
            self.flow.flown_s = now.as_ref().map_or(self.flow.flown_s, LiveMoment::flown_s);
            if matches!(self.flow.arrangement, ViewLayout::Camera | ViewLayout::Map) {
                flight.listener.live().request_obstacles();
            }
        }
        let ghost = self.ghost_pose(now.as_ref(), step_s);
        let shape = self.shape();
        let options = ViewOptions {
            inspector_camera: self.inspector_camera,
            map,
            path_aids: self.path_aids(),
            ghost,
            control_names: self.flow.control_names(),
            style: self.flow.style(),
        };
        let (Some(screen), Some(flight)) = (&mut self.screen, &mut self.threads.flight) else { return Ok(()) };
        let places = self.flow.arrangement.view_rects(shape);
        let shown = flight.draw(screen, &places, now.as_ref(), &options)?;
        flight.begin_camera(screen, &places, shown_moment(flight, stands).as_ref(), &options)?;
        let size = screen.window.inner_size();
        let sheet = self.flow.sheet(f64::from(size.width.max(1)) / f64::from(size.height.max(1)));
        let text_scale = self.flow.style().text_scale;
        let (pictures, anchor) = (&mut self.pictures, self.flow.arrangement.words(shape, text_scale));
        screen.show(|ui| {
            paint_flight(ui, &shown, &text, (anchor, text_scale));
            paint_page(ui, &sheet, pictures);
        })?;
        if shown.is_empty() {
            return Ok(());
        }
        flight.frame_count += 1;
        if flight.first_frame_at.is_none() {
            flight.first_frame_at = Some(self.stopwatch.elapsed());
            self.announce();
            if let Some(train_pipe) = &self.threads.train_pipe {
                train_pipe.send(&FromWindow::Showing);
            }
        }
        self.publish_frame()?;
        self.save_screenshot(&shown, &text)
    }

    /// Passes the camera's view to the stream and the picture file, using a single readback for both.
    fn publish_frame(&mut self) -> Result<(), AppError> {
        let (Some(screen), Some(flight)) = (&self.screen, &self.threads.flight) else { return Ok(()) };
        let Some(panes) = flight.panes() else { return Ok(()) };
        let stream = self.threads.stream.as_mut().filter(|stream| stream.is_due());
        let now = self.stopwatch.elapsed();
        let image_writer = self.image_writer.as_mut().and_then(|image_writer| image_writer.is_due(now).then_some(image_writer));
        if stream.is_none() && image_writer.is_none() {
            return Ok(());
        }
        let Some(picture) = panes.camera(screen)? else { return Ok(()) };
        if let Some(image_writer) = image_writer {
            image_writer.save(picture.clone());
        }
        if let Some(stream) = stream {
            let (video, wall) = (stream.push(picture), flight.listener.wall());
            flight.listener.live().set_video_status(video, wall);
        }
        Ok(())
    }

    /// Collects messages from the pilot thread and the pages.
    fn listen(&mut self, now: std::time::Duration) {
        while let Some(text) = self.threads.pilot.as_ref().and_then(PilotThread::poll_message) {
            tracing::info!("{text}");
            let words = message_words(&text, self.flow.language()).unwrap_or(text);
            self.notices.push((words, now));
        }
        if let Some(text) = self.flow.take_notice() {
            tracing::info!("{text}");
            self.notices.push((text, now));
        }
        self.notices.retain(|(_, since)| now.saturating_sub(*since).as_secs_f64() < MESSAGE_DURATION_S);
    }

    fn text(&self, moment: Option<&LiveMoment>, now: std::time::Duration) -> WindowText {
        let Some(flight) = &self.threads.flight else { return WindowText::default() };
        let style = self.flow.style();
        // The messages must not cover the picture; larger text has room for only one.
        let most = if style.text_scale == TextScale::Normal { MAX_MESSAGES } else { 1 };
        let latest = self.notices.iter().skip(self.notices.len().saturating_sub(most));
        let is_frozen = moment.is_some_and(|moment| moment.hud.is_frozen);
        let frozen = is_frozen.then(|| frozen(self.flow.key_names(), self.threads.pilot.is_some(), style.language));
        let walk = moment.and_then(|now| walk(&flight.inspector(now), style.language));
        let lines: Vec<String> =
            frozen.into_iter().chain(walk).chain(latest.map(|(words, _)| style.units.words(words))).collect();
        let shows_help = style.text_scale == TextScale::Normal || lines.is_empty();
        WindowText {
            waiting: waiting(&flight.scene, moment.is_some(), &flight.listener, style.language),
            lines,
            help: match flight.first_frame_at {
                Some(first) if shows_help && now.saturating_sub(first).as_secs_f64() < KEY_HELP_DURATION_S => {
                    help(self.flow.key_names(), self.threads.pilot.is_some(), style)
                }
                _ => String::new(),
            },
        }
    }

    /// Turns and zooms the inspector's view while keys are held.
    fn turn_inspector_view(&mut self, now: Option<&LiveMoment>, step_s: f64) {
        let (Some(panes), Some(now)) = (self.threads.flight.as_ref().and_then(FlightView::panes), now) else { return };
        let (keys, held) = (&self.settings.current().keys, &self.held);
        let held = |wish: &str| keys.of(wish).is_some_and(|key| held.is_down(key));
        let way = |plus: &str, minus: &str| f64::from(i8::from(held(plus)) - i8::from(held(minus)));
        let (right, up) = (way("look_right", "look_left"), way("look_up", "look_down"));
        if right != 0.0 || up != 0.0 {
            self.inspector_camera.turn(
                TURN_RATE_RAD_S * step_s * right,
                TURN_RATE_RAD_S * step_s * up,
                panes.inspector_to_aircraft(now),
            );
        }
        self.inspector_camera.zoom(spandrel_model::math::pow(ZOOM_FACTOR_PER_S, step_s * way("zoom_in", "zoom_out")));
    }

    /// Moves the ghost and returns its pose; `None` if it is hidden, not loaded yet, or not allowed.
    fn ghost_pose(&mut self, now: Option<&LiveMoment>, step_s: f64) -> Option<Pose<Enu>> {
        let is_shown = self.ghost && self.flow.ghost().is_some();
        let (flight, now) = (self.threads.flight.as_mut().filter(|_| is_shown)?, now?);
        flight.ghost()?.advance(now.moment.drone.pose.position_m, step_s)
    }

    /// Returns how much of the path is drawn: nothing in an assessment, and less for better pilots.
    fn path_aids(&self) -> PathAids {
        if self.path && self.plan.map { self.flow.path_aids().min(self.plan.path_aids) } else { PathAids::None }
    }

    fn announce(&self) {
        let Some(screen) = self.screen.as_ref().filter(|_| self.plan.announce) else { return };
        let size = screen.window.inner_size();
        let quality = self.quality(screen).name;
        println!("{}", json!({ "device": screen.gpu.name, "quality": quality, "width": size.width, "height": size.height }));
    }

    fn save_screenshot(&mut self, shown: &[PaneContent], text: &WindowText) -> Result<(), AppError> {
        let first = self.threads.flight.as_ref().and_then(|flight| flight.first_frame_at);
        let text_scale = self.flow.style().text_scale;
        let anchor = self.flow.arrangement.words(self.shape(), text_scale);
        let (Some(plan), Some(first), Some(screen)) = (&self.plan.picture, first, &mut self.screen) else {
            return Ok(());
        };
        if self.stopwatch.elapsed().saturating_sub(first) < plan.after {
            return Ok(());
        }
        let picture = screen.picture(|ui| paint_flight(ui, shown, text, (anchor, text_scale)))?;
        files::write(&plan.path.display().to_string(), &png(&picture)?)?;
        self.stop.request();
        Ok(())
    }
}

/// Returns the current state of a flight. While the simulation is paused, no telemetry arrives, but the link is not lost.
fn shown_moment(flight: &FlightView, is_paused: bool) -> Option<LiveMoment> {
    let mut now = flight.now()?;
    if is_paused {
        now.hud.telemetry_age_s = 0.0;
    }
    Some(now)
}

/// Paints a page on top of the window.
fn paint_page(ui: &mut egui::Ui, sheet: &PageLayout, pictures: &mut PageTextures) {
    let painter = ui.ctx().layer_painter(egui::LayerId::background());
    paint_sheet(&painter, sheet, ui.ctx().content_rect(), pictures);
}
