//! Outgoing messages: cues, texts, replies, and log events.

use super::{AUTOPILOT_COMPONENT_ID, CUES_INTERVAL, GUIDANCE_INTERVAL, MONITOR_COMPONENT_ID, Monitor, SessionOutput};
use crate::detour::DetourFinder;
use crate::feedback::{FeedbackInput, HeadingOffset, SurfaceDistance, TaskProximity};
use crate::guidance::GuidanceInput;
use crate::measures::on_path::NearestOnPath;
use crate::session::lift_off_height_m;
use serde_json::json;
use spandrel_mavlink::codec::{Encoder, ReceivedFrame};
use spandrel_mavlink::contract::contact::ContactKind;
use spandrel_mavlink::contract::cue;
use spandrel_mavlink::contract::guidance::{Detour, Guidance, WayTo};
use spandrel_mavlink::contract::named_values::NamedValue;
use spandrel_mavlink::contract::truth::Truth;
use spandrel_mavlink::dialect::{
    COMMAND_ACK_DATA, MavCmd, MavMessage, MavResult, MavSeverity, NAV_CONTROLLER_OUTPUT_DATA, STATUSTEXT_DATA, TIMESYNC_DATA,
};
use spandrel_mavlink::station;
use spandrel_model::frames::{Enu, Vec3};
use spandrel_model::scenario::Task;
use spandrel_model::time::SimTime;

/// Returns the distance from the inspected surface if the task recommends one. `way_back_m` is the displacement from the drone
/// to the nearest position on the path.
fn surface_distance(task: &Task, nearest: NearestOnPath, way_back_m: Vec3<Enu>) -> Option<SurfaceDistance> {
    let stand_off = task.stand_off.as_ref()?;
    let toward_surface = *stand_off.toward_surface.get(nearest.point)?;
    let farther_m = way_back_m.dot(toward_surface);
    Some(SurfaceDistance {
        actual_m: stand_off.recommended_m + farther_m,
        recommended_m: stand_off.recommended_m,
        tolerance_m: stand_off.tolerance_m,
        sideways_m: (way_back_m - toward_surface * farther_m).norm(),
    })
}

/// Returns bearing, distance and height of the next place for ground stations, which show them beside the map. Without a place, the
/// distance is zero.
pub(super) fn navigation(way: Option<WayTo>, heading_rad: f64) -> MavMessage {
    let WayTo { distance_m, bearing_rad, up_m } = way.unwrap_or(WayTo { distance_m: 0.0, bearing_rad: 0.0, up_m: 0.0 });
    let bearing_deg = (heading_rad + bearing_rad).to_degrees().rem_euclid(360.0).round() as i16 % 360;
    MavMessage::NAV_CONTROLLER_OUTPUT(NAV_CONTROLLER_OUTPUT_DATA {
        nav_bearing: bearing_deg,
        target_bearing: bearing_deg,
        wp_dist: distance_m.round().clamp(0.0, f64::from(u16::MAX)) as u16,
        alt_error: up_m as f32,
        ..NAV_CONTROLLER_OUTPUT_DATA::default()
    })
}

impl Monitor {
    pub(super) fn send_feedback(&mut self) {
        let Some(truth) = self.live.truth else { return };
        let input = self.input(&truth);
        let (cues, texts) = self.feedback.update(&input);
        let changed = cues != self.live.cues;
        if changed {
            self.event("cues", json!({ "cues": cues }));
        }
        self.live.cues = cues;
        if changed || self.live.cues_sent.is_none_or(|sent| truth.time - sent >= CUES_INTERVAL) {
            self.live.cues_sent = Some(truth.time);
            self.send(&NamedValue::Cues(cues).message(truth.time.ms() as u32));
        }
        self.texts.enqueue(truth.time, texts);
        while let Some(text) = self.texts.next(truth.time) {
            let quiet = text.cue == cue::BATTERY_YELLOW;
            let severity = if quiet { MavSeverity::MAV_SEVERITY_INFO } else { MavSeverity::MAV_SEVERITY_WARNING };
            self.text(&text.text, severity);
        }
    }

    pub(super) fn send_guidance(&mut self, truth: &Truth) {
        if !self.guides || self.guidance_sent.is_some_and(|sent| truth.time - sent < GUIDANCE_INTERVAL) {
            return;
        }
        self.guidance_sent = Some(truth.time);
        if !self.trainee_follows_paths() {
            return;
        }
        let guidance = self.guidance(truth);
        self.send(&guidance.message(u64::try_from(truth.time.us()).unwrap_or(0)));
        self.send(&navigation(guidance.first_way(), truth.motion.ned_from_frd.yaw_rad()));
        for words in self.announcer.update(truth.time, &guidance) {
            self.event("guidance", json!({ "words": words }));
            self.send_text(&words, MavSeverity::MAV_SEVERITY_INFO);
        }
    }

    /// Returns whether the trainee follows the paths of the tasks: a lesson leads itself, except along the path of a task.
    fn trainee_follows_paths(&self) -> bool {
        self.lesson.as_ref().is_none_or(|lesson| lesson.path_task().is_some())
    }

    fn guidance(&mut self, truth: &Truth) -> Guidance {
        let scenario = &self.config.scenario;
        let tasks: Vec<TaskProximity> = (0..scenario.tasks.len()).map(|task| self.task_proximity(task, truth)).collect();
        let input = GuidanceInput {
            scenario,
            paths: &self.paths,
            flown: &self.live.flown,
            tasks: &tasks,
            active_task: self.feedback.current_task(),
            position_m: truth.motion.position_m,
            heading_rad: truth.motion.ned_from_frd.yaw_rad(),
            taken_off: self.live.lift_off.is_some(),
            over: self.live.end.is_some() || self.outcome.is_some(),
            flown_s: self.flight_time().map_or(0.0, SimTime::s),
            needed_s: self.needed_s,
        };
        let (guidance, far_place_m) = (input.next_step(), input.far_place_m());
        Guidance { detour: self.detour(truth, far_place_m), ..guidance }
    }

    /// Returns the way around the bridge or the ground if it blocks the straight way to a place.
    fn detour(&mut self, truth: &Truth, far_place_m: Option<Vec3<Enu>>) -> Option<Detour> {
        let Self { survey, detours, .. } = self;
        let site = survey.as_ref().and_then(|survey| survey.site());
        let Some((site, to_m)) = site.zip(far_place_m) else {
            *detours = DetourFinder::default();
            return None;
        };
        let motion = &truth.motion;
        let found = detours.update(site, truth.time, (motion.position_m, to_m))?;
        let offset = HeadingOffset::new(found.place_m - motion.position_m, motion.ned_from_frd.yaw_rad());
        Some(Detour { kind: found.kind, way: offset.way() })
    }

    fn input(&self, truth: &Truth) -> FeedbackInput {
        let scenario = &self.config.scenario;
        let in_session = self.live.lift_off.is_some() && self.live.end.is_none() && self.outcome.is_none();
        let contact = self.counted_contact();
        let onset = contact != ContactKind::None && self.live.cues & cue::CRASH == 0;
        FeedbackInput {
            time: truth.time,
            in_session,
            airborne: !self.live.on_ground && !self.is_low_over_pad(truth),
            speed_m_s: truth.motion.velocity_m_s.norm(),
            battery_pct: self.live.battery_pct,
            clearance_m: self.live.clearance_m,
            contact,
            contact_name: if onset { self.contact_name() } else { None },
            tasks: (0..scenario.tasks.len()).map(|task| self.task_for_cues(task, truth)).collect(),
            current_task: self.live.current_task.filter(|_| self.trainee_follows_paths()),
        }
    }

    /// Returns the task as the cues see it: while a lesson leads elsewhere, a path nearby is not the trainee's, so it is far away.
    fn task_for_cues(&self, index: usize, truth: &Truth) -> TaskProximity {
        let task = self.task_proximity(index, truth);
        if self.trainee_follows_paths() {
            return task;
        }
        TaskProximity { distance_m: f64::INFINITY, surface: None, too_close_m: None, ..task }
    }

    fn task_proximity(&self, index: usize, truth: &Truth) -> TaskProximity {
        let (task, position_m) = (&self.config.scenario.tasks[index], truth.motion.position_m);
        let nearest = self.paths.nearest(index, position_m);
        let distance_m = nearest.map_or(f64::INFINITY, |nearest| nearest.distance_m);
        // The cues use the direction only near the path.
        let near = nearest.filter(|_| distance_m <= self.config.scenario.feedback.off_path_max_m);
        let foot_m = near.and_then(|_| self.paths.path(index).closest_position(position_m));
        let way_back_m = foot_m.map(|foot_m| foot_m - position_m);
        let heading_rad = truth.motion.ned_from_frd.yaw_rad();
        let last = task.path_m.len().saturating_sub(1);
        TaskProximity {
            distance_m,
            threshold_m: task.threshold_m,
            way_back: way_back_m.map_or(HeadingOffset::default(), |way_back_m| HeadingOffset::new(way_back_m, heading_rad)),
            surface: near.zip(way_back_m).and_then(|(nearest, way_back_m)| surface_distance(task, nearest, way_back_m)),
            too_close_m: task.too_close_m,
            id: task.id,
            at_path_end: !task.closed && nearest.is_some_and(|nearest| nearest.point == 0 || nearest.point >= last),
            flown_share: self.live.flown_shares[index],
            done: self.live.done[index],
            finished: self.live.finished[index],
        }
    }

    /// Returns whether the drone is low over the pad. Heights elsewhere are not checked because a job can take the
    /// drone below the pad.
    fn is_low_over_pad(&self, truth: &Truth) -> bool {
        let team = &self.config.scenario.ground_team;
        let at_home = (truth.motion.position_m - team.pad_m).horizontal_norm() <= team.home_radius_m;
        at_home && self.height_m(truth.motion.position_m) <= lift_off_height_m(&self.config.vehicle)
    }

    pub(super) fn handle_command(&mut self, received: &ReceivedFrame) {
        let ours = |system: u8, component: u8| {
            (system == 0 || system == self.encoder.system_id()) && (component == 0 || component == MONITOR_COMPONENT_ID)
        };
        match &received.message {
            Some(MavMessage::TIMESYNC(sync)) if sync.tc1 == 0 && ours(sync.target_system, sync.target_component) => {
                let answer = TIMESYNC_DATA {
                    tc1: self.now().ns().max(1),
                    ts1: sync.ts1,
                    target_system: received.system_id,
                    target_component: received.component_id,
                };
                self.send(&MavMessage::TIMESYNC(answer));
            }
            Some(MavMessage::COMMAND_LONG(command)) if command.target_component == MONITOR_COMPONENT_ID => {
                if ours(command.target_system, MONITOR_COMPONENT_ID) {
                    self.reject_command(command.command, received);
                }
            }
            Some(MavMessage::COMMAND_INT(command)) if command.target_component == MONITOR_COMPONENT_ID => {
                if ours(command.target_system, MONITOR_COMPONENT_ID) {
                    self.reject_command(command.command, received);
                }
            }
            Some(MavMessage::HEARTBEAT(_)) if received.component_id == AUTOPILOT_COMPONENT_ID => {
                self.adopt_system(received.system_id)
            }
            Some(_) | None => {}
        }
    }

    /// Uses the system ID of the scored flight or, until there is one, of the last heartbeat received.
    fn adopt_system(&mut self, system: u8) {
        let system = self.timeline.system().unwrap_or(system);
        if system != self.encoder.system_id() {
            self.encoder = Encoder::new(system, MONITOR_COMPONENT_ID);
        }
    }

    fn reject_command(&mut self, command: MavCmd, requester: &ReceivedFrame) {
        self.send(&MavMessage::COMMAND_ACK(COMMAND_ACK_DATA {
            command,
            result: MavResult::MAV_RESULT_UNSUPPORTED,
            target_system: requester.system_id,
            target_component: requester.component_id,
            ..COMMAND_ACK_DATA::default()
        }));
    }

    pub(super) fn heartbeat(&mut self) {
        self.send(&station::companion_heartbeat());
    }

    pub(super) fn text(&mut self, words: &str, severity: MavSeverity) {
        self.event("text", json!({ "text": words }));
        self.send_text(words, severity);
    }

    pub(super) fn send_text(&mut self, words: &str, severity: MavSeverity) {
        self.send(&MavMessage::STATUSTEXT(STATUSTEXT_DATA { severity, text: words.into(), ..STATUSTEXT_DATA::default() }));
    }

    pub(super) fn send(&mut self, message: &MavMessage) {
        if !self.replaying {
            let bytes = self.encoder.encode(message);
            self.outgoing.push_back(bytes);
        }
    }

    pub(super) fn event(&mut self, kind: &str, mut detail: serde_json::Value) {
        if self.replaying {
            return;
        }
        let mut line = serde_json::Map::new();
        line.insert("t_s".to_owned(), json!(self.now().s()));
        line.insert("event".to_owned(), json!(kind));
        if let Some(detail) = detail.as_object_mut() {
            line.append(detail);
        }
        self.records.push_back(SessionOutput::Event(serde_json::Value::Object(line).to_string() + "\n"));
    }
}
