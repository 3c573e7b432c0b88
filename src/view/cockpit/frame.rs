//! One picture of the window: a page, or a flight with its displays; and what the pages order.

use super::flight_view::FlightView;
use super::panes::PaneContent;
use super::pilot::{PilotCommand, PilotThread};
use super::window::Cockpit;
use super::window_text::{WindowText, compose_text, help, waiting};
use crate::errors::AppError;
use crate::files;
use crate::render::png;
use serde_json::json;
use spandrel_view::flow::pipe::FlightStarted;
use spandrel_view::flow::{Page, PageLayout, WindowRequest};
use spandrel_view::gpu::{PageTextures, paint_sheet};
use spandrel_view::hud;
use spandrel_view::live::LiveMoment;
use spandrel_view::sound::SoundInputs;

/// The inspector's head turns so fast by keys, rad/s, and a second of a held key zooms so many times (estimates: comfortable on a laptop).
const TURN_RAD_S: f64 = 1.0;
const ZOOM_S: f64 = 2.0;
/// Words stay on the screen this long, s, and the first help longer.
const WORDS_S: f64 = 7.0;
const HELP_S: f64 = 25.0;

impl Cockpit {
    /// Hears `train`, does what the pages order, draws.
    pub(super) fn frame(&mut self) -> Result<(), AppError> {
        if let Some(fault) = self.screen.as_ref().and_then(|screen| screen.gpu.fault()) {
            return Err(fault.into());
        }
        while let Some(message) = self.crew.lead.as_mut().and_then(super::train_pipe::TrainPipe::poll) {
            self.flow.handle_message(message);
        }
        if matches!(self.flow.page(), Page::Controls | Page::Calibrating)
            && let Some(pilot) = &self.crew.pilot
        {
            self.flow.update_controls(pilot.controls());
        }
        while let Some(order) = self.flow.poll() {
            self.apply_requests(order)?;
        }
        let stands = self.flow.is_paused();
        if std::mem::replace(&mut self.stood, stands) != stands {
            self.forward_key(PilotCommand::Stand(stands));
        }
        match self.flow.page() {
            Page::Flight | Page::Paused | Page::Leaving => self.fly(),
            _ => {
                self.speaker.stop_speech();
                self.page()
            }
        }
    }

    /// What there is to hear now.
    fn sound(&mut self, now: Option<&LiveMoment>) {
        // What was heard last is not what is to be heard: nobody knows how the rotors turn.
        let now = now.filter(|now| now.hud.silent_s <= hud::SILENT_S && !self.flow.is_paused());
        let (Some(flight), Some(now)) = (&self.crew.flight, now) else {
            self.speaker.stop_speech();
            return;
        };
        let team = &flight.job.0.ground_team;
        let mut live = flight.listener.live();
        if self.speaker.is_on() {
            live.request_rotor_outputs();
        }
        self.speaker.set(SoundInputs {
            rotors_rad_s: live.rotors_rad_s(&flight.job.1),
            distance_m: (now.moment.drone.pose.position_m - team.inspector_m).norm(),
            cues: live.feed().cues(now.moment.at, false),
            silent: false,
        });
    }

    fn apply_requests(&mut self, order: WindowRequest) -> Result<(), AppError> {
        match order {
            WindowRequest::Tell(message) => {
                if let Some(lead) = &self.crew.lead {
                    lead.send(&message);
                }
            }
            WindowRequest::Fly(flying) => self.show(&flying)?,
            WindowRequest::Land => {
                self.handle_release();
                self.forward_key(PilotCommand::Land);
            }
            WindowRequest::Look => self.forward_key(PilotCommand::Look),
            WindowRequest::Calibrate => self.forward_key(PilotCommand::Calibrate),
            WindowRequest::Confirm => self.forward_key(PilotCommand::Confirm),
            WindowRequest::Cancel => self.forward_key(PilotCommand::Cancel),
            WindowRequest::Tune(tune) => self.forward_key(PilotCommand::Tune(tune)),
            WindowRequest::Open(address) => {
                if let Err(error) = open::that_detached(&address) {
                    self.flow.show_notice(format!("No browser opens ({error}): the address stands above."));
                }
            }
            WindowRequest::Sound(on) => {
                self.speaker.set_on(on);
                self.flow.show_notice(if on { "Sound is on." } else { "Sound is off." }.to_owned());
            }
            WindowRequest::Close => self.stop.request(),
        }
        Ok(())
    }

    /// Shows a flight that has begun.
    fn show(&mut self, flying: &FlightStarted) -> Result<(), AppError> {
        self.handle_release();
        let scenario = files::scenario(&flying.choice.scenario)?.scenario;
        let vehicle = files::vehicle(&flying.vehicle)?.vehicle;
        if let Some(screen) = &self.screen {
            screen.window.set_title(&format!("Spandrel: {}", scenario.title));
        }
        self.crew.flight = Some(FlightView::begin(self.plan.listen, flying.connect, (scenario, vehicle), Some(flying.seed))?);
        self.keeper = self.plan.keep.clone().map(super::picture_writer::PictureWriter::start);
        (self.map, self.gaze) = (self.plan.map, spandrel_view::inspector_camera::InspectorCamera::default());
        // What was said on the ground is past.
        while self.crew.pilot.as_ref().and_then(PilotThread::poll_message).is_some() {}
        self.notices.clear();
        self.forward_key(PilotCommand::LetGo);
        if let Some(vehicle) = flying.fly {
            self.forward_key(PilotCommand::Fly(vehicle));
        }
        Ok(())
    }

    fn page(&mut self) -> Result<(), AppError> {
        let Some(screen) = &mut self.screen else { return Ok(()) };
        let size = screen.window.inner_size();
        let sheet = self.flow.sheet(f64::from(size.width.max(1)) / f64::from(size.height.max(1)));
        let pictures = &mut self.pictures;
        screen.show(|ui| is_over(ui, &sheet, pictures))
    }

    fn fly(&mut self) -> Result<(), AppError> {
        let started = self.stopwatch.elapsed();
        let step_s = started.saturating_sub(self.frame_at).as_secs_f64();
        self.frame_at = started;
        let stands = self.flow.is_paused();
        let mut now = self.crew.flight.as_ref().and_then(FlightView::now);
        if let (Some(now), true) = (&mut now, stands) {
            // Nothing is heard because time stands still: no link is lost.
            now.hud.silent_s = 0.0;
        }
        if let Some(screen) = &self.screen {
            let quality = self.quality(screen);
            if let Some(flight) = &mut self.crew.flight {
                flight.prepare(screen, quality, now.as_ref())?;
            }
        }
        self.render_views(now.as_ref(), step_s);
        self.sound(now.as_ref());
        self.listen(started);
        let text = self.text(now.is_some(), started);
        let map = self.map && self.plan.map && self.flow.shows_map();
        let (Some(screen), Some(flight)) = (&mut self.screen, &mut self.crew.flight) else { return Ok(()) };
        let shown = flight.draw(screen, &self.flow.arrangement.places(), now.as_ref(), &self.gaze, map)?;
        let size = screen.window.inner_size();
        let sheet = self.flow.sheet(f64::from(size.width.max(1)) / f64::from(size.height.max(1)));
        let (pictures, arrangement) = (&mut self.pictures, self.flow.arrangement);
        screen.show(|ui| {
            compose_text(ui, &shown, &text, arrangement);
            is_over(ui, &sheet, pictures);
        })?;
        if shown.is_empty() {
            return Ok(());
        }
        flight.drawn += 1;
        if flight.first_drawn.is_none() {
            flight.first_drawn = Some(self.stopwatch.elapsed());
            self.announce();
        }
        self.publish_frame()?;
        self.keep_picture(&shown, &text)
    }

    /// Hands the camera's view to whoever watches elsewhere: taken once, for all who want it now.
    fn publish_frame(&mut self) -> Result<(), AppError> {
        let (Some(screen), Some(flight)) = (&self.screen, &self.crew.flight) else { return Ok(()) };
        let Some(panes) = flight.panes() else { return Ok(()) };
        let stream = self.crew.stream.as_mut().filter(|stream| stream.is_due());
        let now = self.stopwatch.elapsed();
        let keeper = self.keeper.as_mut().and_then(|keeper| keeper.is_due(now).then_some(keeper));
        if stream.is_none() && keeper.is_none() {
            return Ok(());
        }
        let Some(picture) = panes.camera(screen)? else { return Ok(()) };
        if let Some(keeper) = keeper {
            keeper.take(picture.clone());
        }
        if let Some(stream) = stream {
            let (video, wall) = (stream.push(picture), flight.listener.wall());
            flight.listener.live().set_video_status(video, wall);
        }
        Ok(())
    }

    /// What the vehicle, the pilot and the pages have to say.
    fn listen(&mut self, now: std::time::Duration) {
        while let Some(text) = self.crew.pilot.as_ref().and_then(PilotThread::poll_message) {
            tracing::info!("{text}");
            self.notices.push((text, now));
        }
        if let Some(text) = self.flow.take_notice() {
            tracing::info!("{text}");
            self.notices.push((text, now));
        }
        self.notices.retain(|(_, since)| now.saturating_sub(*since).as_secs_f64() < WORDS_S);
    }

    fn text(&self, heard: bool, now: std::time::Duration) -> WindowText {
        let Some(flight) = &self.crew.flight else { return WindowText::default() };
        WindowText {
            waiting: waiting(&flight.scene, heard, &flight.listener),
            lines: self.notices.iter().map(|(words, _)| words.clone()).collect(),
            help: match flight.first_drawn {
                Some(first) if now.saturating_sub(first).as_secs_f64() < HELP_S => help(&self.keys, self.crew.pilot.is_some()),
                _ => String::new(),
            },
        }
    }

    /// Keys that are held move the inspector's eyes.
    fn render_views(&mut self, now: Option<&LiveMoment>, step_s: f64) {
        let (Some(panes), Some(now)) = (self.crew.flight.as_ref().and_then(FlightView::panes), now) else { return };
        let held = |wish: &str| self.keys.of(wish).is_some_and(|key| self.held.is_down(key));
        let way = |plus: &str, minus: &str| f64::from(i8::from(held(plus)) - i8::from(held(minus)));
        let (right, up) = (way("look_right", "look_left"), way("look_up", "look_down"));
        if right != 0.0 || up != 0.0 {
            self.gaze.turn(TURN_RAD_S * step_s * right, TURN_RAD_S * step_s * up, panes.to_aircraft(now));
        }
        self.gaze.zoom(spandrel_model::math::pow(ZOOM_S, step_s * way("zoom_in", "zoom_out")));
    }

    fn announce(&self) {
        let Some(screen) = self.screen.as_ref().filter(|_| self.plan.announce) else { return };
        let size = screen.window.inner_size();
        let quality = self.quality(screen).name;
        println!("{}", json!({ "device": screen.gpu.name, "quality": quality, "width": size.width, "height": size.height }));
    }

    fn keep_picture(&mut self, shown: &[PaneContent], text: &WindowText) -> Result<(), AppError> {
        let first = self.crew.flight.as_ref().and_then(|flight| flight.first_drawn);
        let (Some(plan), Some(first), Some(screen)) = (&self.plan.picture, first, &mut self.screen) else {
            return Ok(());
        };
        if self.stopwatch.elapsed().saturating_sub(first) < plan.after {
            return Ok(());
        }
        let arrangement = self.flow.arrangement;
        let picture = screen.picture(|ui| compose_text(ui, shown, text, arrangement))?;
        files::write(&plan.path.display().to_string(), &png(&picture)?)?;
        self.stop.request();
        Ok(())
    }
}

/// A page over everything.
fn is_over(ui: &mut egui::Ui, sheet: &PageLayout, pictures: &mut PageTextures) {
    let painter = ui.ctx().layer_painter(egui::LayerId::background());
    paint_sheet(&painter, sheet, ui.ctx().content_rect(), pictures);
}
