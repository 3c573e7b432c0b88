//! The lesson of a job: its input from the telemetry, and its messages.

use super::messages::navigation;
use super::{GUIDANCE_INTERVAL, Monitor};
use crate::lesson::{LessonInput, PictureVerdict};
use serde_json::json;
use spandrel_mavlink::contract::truth::Truth;
use spandrel_mavlink::dialect::MavSeverity;
use spandrel_model::site::{CameraPose, DefectView};
use spandrel_model::vehicle::Camera;

impl Monitor {
    /// Updates the lesson and sends its current step and its texts.
    pub(super) fn send_lesson(&mut self, truth: &Truth) {
        let Some(mut lesson) = self.lesson.take() else { return };
        let tasks: Vec<(f64, bool)> = self.live.flown_shares.iter().copied().zip(self.live.done.iter().copied()).collect();
        let team = &self.config.scenario.ground_team;
        let input = LessonInput {
            time: truth.time,
            position_m: truth.motion.position_m,
            heading_rad: truth.motion.ned_from_frd.yaw_rad(),
            speed_m_s: truth.motion.velocity_m_s.norm(),
            pad_m: team.pad_m,
            home_radius_m: team.home_radius_m,
            armed: self.live.armed.unwrap_or(false),
            is_return: self.live.is_return,
            on_ground: self.live.on_ground,
            camera_pitch_rad: self.live.camera_pitch_rad,
            lamp: self.live.lamp,
            tasks: &tasks,
        };
        let before = lesson.done();
        let texts = lesson.update(&input);
        let is_news = lesson.done() != before;
        if is_news {
            self.event("lesson_step", json!({ "done": lesson.done(), "of": self.config.scenario.lesson.len() }));
        }
        for words in texts {
            self.send_text(&words, MavSeverity::MAV_SEVERITY_INFO);
        }
        let is_due = self.lesson_sent.is_none_or(|sent| truth.time - sent >= GUIDANCE_INTERVAL);
        if is_due || is_news {
            self.lesson_sent = Some(truth.time);
            let status = lesson.status(&input);
            self.send(&status.message(u64::try_from(truth.time.us()).unwrap_or(0)));
            // Along the path of a task, ground stations get the way from the guidance.
            if lesson.path_task().is_none() {
                self.send(&navigation(status.way, input.heading_rad));
            }
        }
        self.lesson = Some(lesson);
    }

    /// Tells a trainee who has to photograph a defect what a picture shows.
    pub(super) fn teach_picture(&mut self) {
        let Some(truth) = self.live.truth else { return };
        let Some(mut lesson) = self.lesson.take() else { return };
        if let Some(words) = lesson.handle_picture(&self.picture_verdict(&truth)) {
            self.send_text(&words, MavSeverity::MAV_SEVERITY_INFO);
        }
        self.lesson = Some(lesson);
    }

    /// Returns what a picture taken now shows.
    fn picture_verdict(&self, truth: &Truth) -> PictureVerdict {
        let (Some(survey), vehicle) = (&self.survey, &self.config.vehicle) else { return PictureVerdict::Nothing };
        let pose = CameraPose::on_aircraft(&vehicle.camera, truth.motion.pose(), self.live.camera_pitch_rad, self.live.lamp);
        // The lens may be zoomed.
        let hfov_rad = self.live.camera_fov_rad.unwrap_or(vehicle.camera.hfov_rad);
        let camera = Camera { hfov_rad, ..vehicle.camera };
        let views = survey.view_defects(&pose, &camera, &vehicle.lamp, truth.time);
        if views.iter().any(|view| view.hit) {
            return PictureVerdict::Shown;
        }
        let failing = |view: &&DefectView| view.reasons().len();
        let closest = views.iter().filter(|view| view.in_frame).min_by_key(failing);
        match closest.and_then(|view| view.reasons().into_iter().next()) {
            Some(reason) => PictureVerdict::Missed(reason),
            None => PictureVerdict::Nothing,
        }
    }
}
