//! Outgoing messages: cues, texts, replies, and log events.

use super::{AUTOPILOT_COMPONENT_ID, CUES_INTERVAL, MONITOR_COMPONENT_ID, Monitor, SessionOutput};
use crate::feedback::{FeedbackInput, TaskProximity};
use crate::session::lift_off_height_m;
use serde_json::json;
use spandrel_mavlink::codec::{Encoder, ReceivedFrame};
use spandrel_mavlink::contract::contact::ContactKind;
use spandrel_mavlink::contract::cue;
use spandrel_mavlink::contract::named_values::NamedValue;
use spandrel_mavlink::contract::truth::Truth;
use spandrel_mavlink::dialect::{COMMAND_ACK_DATA, MavCmd, MavMessage, MavResult, MavSeverity, STATUSTEXT_DATA, TIMESYNC_DATA};
use spandrel_mavlink::station;

/// Fraction of a path's points that the drone must pass before the path counts as flown (estimate: cutting a corner
/// skips some points).
const MIN_FLOWN_SHARE: f64 = 0.9;

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

    fn input(&self, truth: &Truth) -> FeedbackInput {
        let scenario = &self.config.scenario;
        let in_session = self.live.lift_off.is_some() && self.live.end.is_none() && self.outcome.is_none();
        let near = |(t, task): (usize, &spandrel_model::scenario::Task)| {
            let nearest = self.paths.nearest(t, truth.motion.position_m);
            TaskProximity {
                distance_m: nearest.map_or(f64::INFINITY, |nearest| nearest.distance_m),
                threshold_m: task.threshold_m,
                too_close_m: task.too_close_m,
                id: task.id,
                may_leave_task: nearest.is_some_and(|nearest| self.may_leave_task(t, nearest.point)),
            }
        };
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
            tasks: scenario.tasks.iter().enumerate().map(near).collect(),
            current_task: self.live.current_task,
            last_task: self.live.last_task,
        }
    }

    /// Returns whether the trainee may leave the task at this point: anywhere once its path has been flown, otherwise only at an end
    /// of the path.
    fn may_leave_task(&self, task: usize, point: usize) -> bool {
        let count = self.paths.path(task).points_m().len();
        let passed = self.live.visited_points[task].iter().filter(|passed| **passed).count();
        let at_end = !self.config.scenario.tasks[task].closed && (point == 0 || point + 1 >= count);
        at_end || passed as f64 >= MIN_FLOWN_SHARE * count as f64
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
        self.send(&MavMessage::STATUSTEXT(STATUSTEXT_DATA { severity, text: words.into(), ..STATUSTEXT_DATA::default() }));
    }

    fn send(&mut self, message: &MavMessage) {
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
