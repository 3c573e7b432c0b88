//! Processing of received telemetry frames: log timestamps, live state, events and session end.

use super::{
    CONTACT_SEARCH_RADIUS_M, END_RETRY_DELAY, HEARTBEAT_INTERVAL, LiveState, MONITOR_COMPONENT_ID, Monitor, SCORING_DELAY,
    new_lesson,
};
use crate::assessment::{self, AssessError, AssessedSession, ScoringJob};
use crate::detour::DetourFinder;
use crate::feedback::{FeedbackRules, texts::TextQueue};
use crate::folder::SIMULATOR_RESTARTED;
use crate::guidance::StepAnnouncer;
use crate::measures::attention;
use crate::measures::crash::is_soft_pad_contact;
use crate::session::{EndReason, EndRuleInput as EndInput, lift_off_height_m};
use serde_json::json;
use spandrel_mavlink::codec::ReceivedFrame;
use spandrel_mavlink::contract::contact::ContactKind;
use spandrel_mavlink::contract::truth::Truth;
use spandrel_mavlink::dialect::MavSeverity;
use spandrel_mavlink::instructor_note;
use spandrel_mavlink::telemetry::frame::MIN_GAP;
use spandrel_mavlink::telemetry::sample::{Sample, SampleContent, SampleValue};
use spandrel_mavlink::telemetry::timeline::FrameDisposition;
use spandrel_model::frames::{Enu, Vec3};
use spandrel_model::site::inspector_walks::Walk;
use spandrel_model::time::SimTime;
use spandrel_text::Language;
impl Monitor {
    /// Returns a frame's log timestamp in µs: the session's start plus the simulation time since the first truth
    /// message. It keeps increasing when the simulator restarts.
    pub(super) fn log_timestamp_us(&mut self, received: &ReceivedFrame) -> u64 {
        let own = spandrel_mavlink::telemetry::sample::truth_time(&received.bytes);
        let since_zero = |own: SimTime| u64::try_from(own.us()).unwrap_or(0);
        let started = self.config.started_unix_us;
        self.zero_unix_us = self.zero_unix_us.or(own.map(|own| started.saturating_sub(since_zero(own))));
        let Some(zero) = self.zero_unix_us else { return started };
        let now = own.map_or(self.now(), |own| own.max(self.now()));
        let passed = self.timeline.elapsed_before_epoch(self.timeline.epoch_count() - 1);
        let since = u64::try_from((passed + now).us()).unwrap_or(0);
        zero.saturating_add(since)
    }

    pub(super) fn ingest_frame(&mut self, received: &ReceivedFrame) {
        let before = self.timeline.newest();
        match self.timeline.push(&received.bytes) {
            FrameDisposition::Ignored => {}
            FrameDisposition::Restarted(sample) => self.handle_restart(sample),
            FrameDisposition::Stored(sample) => self.handle_sample(sample, before),
        }
    }

    /// Logs an instructor's note at the current time.
    pub(super) fn log_instructor_note(&mut self, received: &ReceivedFrame) {
        if let Some(((system, MONITOR_COMPONENT_ID), text)) = instructor_note::decode(received)
            && system == self.encoder.system_id()
        {
            self.event("note", json!({ "text": text }));
        }
    }

    fn handle_restart(&mut self, sample: Sample) {
        self.event(SIMULATOR_RESTARTED, json!({}));
        if self.live.lift_off.is_some() {
            self.close();
            return;
        }
        self.live = LiveState::new(&self.config, &self.paths);
        self.apply_site_changes();
        self.feedback = FeedbackRules::new(&self.config.scenario);
        self.texts = TextQueue::default();
        self.announcer = StepAnnouncer::default();
        self.guidance_sent = None;
        self.detours = DetourFinder::default();
        self.lesson = new_lesson(&self.config.scenario, self.guides);
        self.lesson_sent = None;
        self.last_heartbeat_sim_time = None;
        self.handle_sample(sample, None);
    }

    fn handle_sample(&mut self, sample: Sample, before: Option<SimTime>) {
        match sample.content {
            SampleContent::Truth(truth) if before.is_none_or(|before| truth.time > before) => self.handle_truth(truth, before),
            SampleContent::Truth(_) => {}
            SampleContent::Value(value) => self.handle_value(value),
        }
    }

    fn handle_value(&mut self, value: SampleValue) {
        match value {
            SampleValue::Sticks(_) | SampleValue::Hits(_) | SampleValue::Frozen(_) => {}
            SampleValue::Freezes(count) => self.handle_practice_aid("freeze", count),
            SampleValue::Rewinds(count) => self.handle_practice_aid("rewind", count),
            SampleValue::FieldOfView(rad) => self.live.camera_fov_rad = Some(rad),
            SampleValue::GimbalPitch(pitch_rad) => self.live.camera_pitch_rad = pitch_rad,
            SampleValue::Light(on) => self.live.lamp = on,
            SampleValue::Battery(pct) => self.live.battery_pct = Some(pct),
            SampleValue::Contact(contact) => self.handle_contact(contact),
            SampleValue::Respawns(count) => self.handle_respawns(count),
            SampleValue::Traffic(code) => self.handle_traffic(code),
            SampleValue::Walk(code) => self.handle_walk(code),
            SampleValue::Seed(seed) => self.handle_seed(seed),
            SampleValue::ScenarioCrc(crc) => {
                if let Err(error) = assessment::check_scenario(&self.config.scenario, crc) {
                    self.reject_telemetry(error);
                }
            }
            SampleValue::Clearance(meters) => self.live.clearance_m = Some(meters),
            SampleValue::Heartbeat { armed, by, is_return } => {
                (self.live.armed, self.live.is_return) = (Some(armed), is_return);
                if self.live.flown_by.replace(by) != Some(by) {
                    self.event("flown_by", json!({ "by": by }));
                }
            }
            SampleValue::OnGround(on_ground) => self.live.on_ground = on_ground,
            SampleValue::Snapshot(index) => {
                self.event("snapshot", json!({ "image": index }));
                self.teach_picture();
            }
        }
    }

    fn handle_seed(&mut self, seed: u64) {
        if let Err(error) = assessment::check_seed(self.seed, seed) {
            self.reject_telemetry(error);
            return;
        }
        self.seed = Some(seed);
        if self.survey.is_none() {
            let survey = (self.config.survey_builder)(&self.config.scenario, seed);
            self.survey = Some(survey.with_changes(self.live.changes.clone()).unwrap_or(survey));
            self.event("seed", json!({ "seed": seed }));
        }
    }

    fn reject_telemetry(&mut self, error: AssessError) {
        if self.rejection.is_none() {
            self.event("refused", json!({ "why": error.to_string() }));
            self.text("Monitor: scenario or seed mismatch", MavSeverity::MAV_SEVERITY_WARNING);
            self.rejection = Some(error.clone());
            self.outcome = Some(Err(error));
        }
    }

    /// Applies bridge closures and openings so that the names of nearby objects match the simulator's traffic.
    fn handle_traffic(&mut self, code: i32) {
        let before = self.live.changes.closures.clone();
        self.live.changes.closures.apply_code(code);
        if self.live.changes.closures != before {
            self.event("traffic", json!({ "open": code > 0 }));
            self.apply_site_changes();
        }
    }

    /// Applies a walk so that the inspector is where the simulator's inspector is.
    fn handle_walk(&mut self, code: i32) {
        let before = self.live.changes.walks.clone();
        self.live.changes.walks.apply_code(code);
        if let Some(walk) = Walk::from_code(code).filter(|_| self.live.changes.walks != before) {
            self.event("walk", json!({ "place": walk.to, "from_s": walk.at.s() }));
            self.apply_site_changes();
        }
    }

    fn apply_site_changes(&mut self) {
        self.survey = self.survey.take().map(|survey| survey.with_changes(self.live.changes.clone()).unwrap_or(survey));
    }

    fn handle_respawns(&mut self, count: i32) {
        if self.live.respawns.is_some_and(|known| count > known) {
            self.event("respawn", json!({ "count": count }));
        }
        self.live.respawns = Some(count);
    }

    /// Logs a freeze or a rewind. The vehicle sends no number before the first one.
    fn handle_practice_aid(&mut self, event: &'static str, count: i32) {
        let known = self.live.practice_aids.insert(event, count).unwrap_or(0);
        if count > known {
            self.event(event, json!({ "count": count }));
        }
    }

    fn handle_truth(&mut self, truth: Truth, before: Option<SimTime>) {
        if let Some(before) = before.filter(|before| truth.time - *before > MIN_GAP) {
            self.event("telemetry_gap", json!({ "from_s": before.s(), "to_s": truth.time.s() }));
        }
        self.live.truth = Some(truth);
        if self.live.lift_off.is_none() && self.height_m(truth.motion.position_m) > lift_off_height_m(&self.config.vehicle) {
            self.live.lift_off = Some(truth.time);
            self.event("lift_off", json!({}));
        }
        let elapsed = before.map_or(SimTime::ZERO, |before| truth.time - before);
        self.update_task(elapsed, truth.motion.position_m);
        self.send_feedback();
        self.send_lesson(&truth);
        self.send_guidance(&truth);
        self.check_end(&truth);
        let due = |last: Option<SimTime>| last.is_none_or(|last| truth.time - last >= HEARTBEAT_INTERVAL);
        if due(self.last_heartbeat_sim_time) {
            self.last_heartbeat_sim_time = Some(truth.time);
            self.heartbeat();
        }
    }

    pub(super) fn height_m(&self, position_m: Vec3<Enu>) -> f64 {
        position_m.up() - self.config.scenario.ground_team.pad_m.up()
    }

    /// Determines the task that is being flown, and adds the time since the last position to it.
    fn update_task(&mut self, elapsed: SimTime, position_m: Vec3<Enu>) {
        if self.live.lift_off.is_none() {
            return;
        }
        let on = self.paths.task_on_path(position_m, self.live.last_task);
        for (task, flown) in self.live.flown.iter_mut().enumerate() {
            flown.add_frame(on.and_then(|(t, nearest)| (t == task).then_some(nearest.point)), elapsed);
        }
        if let Some((task, _)) = on {
            let done_share = self.config.scenario.scoring.task_completion_fraction;
            let flown = &self.live.flown[task];
            let share = flown.coverage().share;
            self.live.flown_shares[task] = share;
            self.live.done[task] |= share >= done_share;
            let closed = self.config.scenario.tasks[task].closed;
            self.live.finished[task] = self.live.finished[task] || flown.is_finished(closed, done_share);
        }
        let on = on.map(|(task, _)| task);
        if let Some(task) = on.filter(|task| self.live.last_task != Some(*task)) {
            self.event("task_entered", json!({ "task": self.config.scenario.tasks[task].id }));
        }
        self.live.current_task = on;
        self.live.last_task = on.or(self.live.last_task);
    }

    fn handle_contact(&mut self, contact: ContactKind) {
        let onset = self.live.contact == ContactKind::None && contact != ContactKind::None;
        if onset {
            self.live.on_pad = self.is_soft_touchdown(contact);
        }
        let changed = self.live.contact != contact;
        self.live.contact = contact;
        self.live.touched = self.live.touched.more_severe(self.counted_contact());
        if changed && contact != ContactKind::None && !self.live.on_pad && self.live.lift_off.is_some() {
            let what = self.contact_name();
            self.event("crash", json!({ "with": contact.label(), "what": what }));
        }
        if changed {
            self.send_feedback();
        }
    }

    fn is_soft_touchdown(&self, contact: ContactKind) -> bool {
        let team = &self.config.scenario.ground_team;
        matches!(contact, ContactKind::Terrain | ContactKind::Other)
            && self
                .live
                .truth
                .is_some_and(|truth| is_soft_pad_contact(truth.motion.position_m, truth.motion.velocity_m_s.up(), team))
    }

    pub(super) fn counted_contact(&self) -> ContactKind {
        if self.live.on_pad && !matches!(self.live.contact, ContactKind::Person | ContactKind::Vehicle) {
            ContactKind::None
        } else {
            self.live.contact
        }
    }

    pub(super) fn contact_name(&self) -> Option<String> {
        let truth = self.live.truth?;
        self.survey.as_ref()?.nearest_object_name(truth.motion.position_m, CONTACT_SEARCH_RADIUS_M, truth.time)
    }

    fn check_end(&mut self, truth: &Truth) {
        let touched = std::mem::take(&mut self.live.touched);
        let Some(start) = self.live.lift_off else { return };
        if self.live.end.is_none() && truth.time >= self.live.next_end_check {
            let rate = self.config.scenario.scoring.frame_rate_hz;
            let end_input = EndInput {
                time: truth.time,
                flight_time_s: (truth.time - start).s() + 1.0 / rate,
                position_m: truth.motion.position_m,
                speed_m_s: truth.motion.velocity_m_s.norm(),
                contact: touched.more_severe(self.counted_contact()),
                battery_pct: self.live.battery_pct.unwrap_or(100.0),
                armed: self.live.armed,
                on_ground: self.live.on_ground,
            };
            self.live.end = self.live.end_rule.update(&end_input).map(|(_, reason)| (truth.time, reason));
        }
        if let Some((time, _)) = self.live.end
            && truth.time - time >= SCORING_DELAY
            && !self.replaying
        {
            self.try_to_finish(truth.time);
        }
    }

    /// Scores the session. The live rule evaluates messages, while the scorer evaluates frames. If the scorer finds no
    /// end yet, monitoring continues.
    fn try_to_finish(&mut self, now: SimTime) {
        let outcome = self.score();
        match &outcome {
            Ok(assessed_session) if assessed_session.assessment.end.reason == EndReason::Abort => {
                self.live.end = None;
                self.live.next_end_check = now + END_RETRY_DELAY;
            }
            Ok(_) | Err(_) => self.finish(outcome),
        }
    }

    pub(super) fn score(&mut self) -> Result<AssessedSession, AssessError> {
        if let Some(refused) = &self.rejection {
            return Err(refused.clone());
        }
        let Self { config, timeline, survey, .. } = self;
        let flight = assessment::scored_flight(timeline, &config.scenario, &config.vehicle);
        let seed = assessment::check_identity(&flight, &config.scenario, self.seed)?;
        let survey = survey.get_or_insert_with(|| (config.survey_builder)(&config.scenario, seed)).clone();
        let survey = attention::with_flight_changes(survey, &flight);
        let job = ScoringJob { scenario: &config.scenario, vehicle: &config.vehicle, survey: survey.as_ref() };
        let (assessment, frames) = assessment::assess(&flight, &job)?;
        Ok(AssessedSession { assessment, frames, seed })
    }

    pub(super) fn finish(&mut self, outcome: Result<AssessedSession, AssessError>) {
        let (reason, words) = match &outcome {
            Ok(assessed_session) => {
                let (overall, completion) = (assessed_session.assessment.scores.overall, assessed_session.assessment.completion);
                let verdict = if assessed_session.assessment.certification.passed { "certified" } else { "not certified" };
                let words = match completion.complete {
                    true => format!("Session over: {overall:.0} points, {verdict}"),
                    // Longer texts do not fit into a STATUSTEXT message. An incomplete session is never certified.
                    false => completion.summary(Language::English),
                };
                (json!(assessed_session.assessment.end.reason), words)
            }
            Err(error) => (json!(error.to_string()), "Session over: nothing to score".to_owned()),
        };
        let counts = self.link();
        self.event("end", json!({ "reason": reason, "link": counts }));
        self.text(&words, MavSeverity::MAV_SEVERITY_INFO);
        self.outcome = Some(outcome);
    }
}
