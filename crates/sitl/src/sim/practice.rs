//! Freeze, rewind, and moves to a task, in practice only. Simulation time never goes back: a freeze stops it, and a rewind puts
//! only the aircraft and its battery back to an earlier state, while time, wind, traffic and all counters go on from the present.
//! No client therefore sees a clock that runs backward.

use super::controller::Controller;
use super::practice_controls::{Freeze, KEPT_STATE_INTERVAL};
use super::{Sim, SimEvent};
use crate::autopilot::Sticks;
use crate::backend::Phase;
use crate::endpoint::PracticeState;
use spandrel_mavlink::contract::practice::PracticeRequest;
use spandrel_mavlink::dialect::MavSeverity;
use spandrel_model::frames::{Ned, Vec3};
use spandrel_model::math;
use spandrel_model::time::SimTime;

/// Time for which the simulation runs on after a rewind before it freezes, so that clients receive the new position. It
/// exceeds the 60 ms by which the window's picture lags behind the telemetry, by two samples of ground truth (estimate).
const RUN_ON_TIME: SimTime = SimTime::from_ms(100);
/// Stick deflection that counts as moved, of full deflection (the same as for a sender that takes control of the sticks).
const MOVED_STICK: f64 = 0.1;
/// Horizontal part of a unit viewing direction below which it has no heading (estimate: 6 deg from the vertical).
const MIN_HORIZONTAL_VIEW: f64 = 0.1;

impl Sim {
    /// Refuses all requests to freeze or rewind the flight, as an assessment requires.
    pub fn forbid_freeze_and_rewind(&mut self) {
        self.practice.is_forbidden = true;
    }

    /// Returns whether the flight is frozen: simulation time is stopped until a client resumes it. Clients are still
    /// answered.
    #[must_use]
    pub fn is_frozen(&self) -> bool {
        match self.practice.freeze {
            Freeze::Off | Freeze::Due { .. } => false,
            Freeze::On | Freeze::UntilStick { .. } => true,
        }
    }

    /// Returns what can be requested now.
    pub(super) fn practice_state(&self) -> PracticeState {
        let external = self.controller.external().map(|external| &external.autopilot);
        PracticeState {
            is_allowed: !self.practice.is_forbidden,
            can_freeze: external
                .is_none_or(|autopilot| autopilot.phase() == Phase::Running && !autopilot.interface.runs_in_real_time()),
            can_rewind: external.is_none(),
            has_flown: self.practice.has_states(),
            has_ended: self.end_reason.is_some(),
            tasks: self.config.scenario.tasks.len() as u32,
        }
    }

    /// Carries out the requests that clients have made.
    pub(super) fn apply_practice_requests(&mut self) {
        while let Some(request) = self.controller.next_practice_request() {
            match request {
                PracticeRequest::Freeze => self.freeze(),
                PracticeRequest::Resume => self.unfreeze(),
                PracticeRequest::Rewind { by } => self.rewind(by),
                PracticeRequest::MoveToTask { task } => self.move_to_task(task),
            }
        }
    }

    fn freeze(&mut self) {
        match self.practice.freeze {
            Freeze::Off => {
                self.scoring.freezes += 1;
                self.begin_freeze(Freeze::On, "Frozen");
                self.events.push_back(SimEvent::Freeze);
            }
            // Sticks no longer end the freeze.
            Freeze::UntilStick { .. } => self.practice.freeze = Freeze::On,
            Freeze::Due { at, .. } => self.practice.freeze = Freeze::Due { at, then_until_stick: false },
            Freeze::On => {}
        }
    }

    fn unfreeze(&mut self) {
        if std::mem::take(&mut self.practice.freeze) != Freeze::Off {
            self.scoring.is_frozen = false;
            self.controller.push_text(MavSeverity::MAV_SEVERITY_INFO, "Continued");
        }
    }

    /// Stops simulation time and announces it, because no tick follows that would.
    fn begin_freeze(&mut self, freeze: Freeze, text: &str) {
        self.practice.freeze = freeze;
        self.scoring.is_frozen = true;
        self.controller.push_text(MavSeverity::MAV_SEVERITY_INFO, text);
        self.pause(false);
    }

    /// Puts the aircraft back into an earlier state. The present keeps what does not belong to the aircraft: time, wind, traffic,
    /// failures, pictures, counters.
    fn rewind(&mut self, by: SimTime) {
        let Some((earlier, undone)) = self.practice.take(self.now, by) else { return };
        let from_m = self.state.rigid.position_m;
        self.state.restore(&earlier.physics);
        self.sensors.discard_pending();
        self.last_safe_hover = earlier.safe_hover;
        self.continue_at_new_place(from_m);
        self.events.push_back(SimEvent::Rewind { undone });
        self.controller.push_text(MavSeverity::MAV_SEVERITY_INFO, &format!("Rewound {:.0} s", undone.s()));
    }

    /// Puts the aircraft at the start of a task's path, hovering and facing the inspected surface. Everything else is as in the
    /// present. Scores count it as a rewind.
    fn move_to_task(&mut self, number: u32) {
        let Some((position_m, yaw_rad)) = self.task_start(number) else { return };
        let from_m = self.state.rigid.position_m;
        self.place_at_rest(position_m, yaw_rad, self.model.hover_rotor_rad_s());
        self.last_safe_hover = (position_m, yaw_rad);
        self.continue_at_new_place(from_m);
        self.events.push_back(SimEvent::MoveToTask { task: number });
        self.controller.push_text(MavSeverity::MAV_SEVERITY_INFO, &format!("At the start of task {number}"));
    }

    /// Returns the first point of a task's path and the heading toward the inspected surface. Along a vertical viewing direction,
    /// the heading stays.
    fn task_start(&self, number: u32) -> Option<(Vec3<Ned>, f64)> {
        let task = self.config.scenario.tasks.iter().find(|task| task.id == number)?;
        let view = task.viewing_directions.first()?;
        let is_vertical = math::hypot(view.east(), view.north()) < MIN_HORIZONTAL_VIEW;
        let yaw_rad = if is_vertical { self.state.rigid.attitude.euler().2 } else { math::atan2(view.east(), view.north()) };
        Some((task.path_m.first()?.ned(), yaw_rad))
    }

    /// Ends contact and crash, starts the estimator at the new place, and lets the simulation run on until every client has the
    /// new position.
    fn continue_at_new_place(&mut self, from_m: Vec3<Ned>) {
        self.end_contact();
        self.scoring.rewinds += 1;
        self.scoring.is_frozen = false;
        let (pose, now) = (self.pose(), self.now);
        if let Controller::Builtin(own) = &mut self.controller {
            own.autopilot.continue_at(from_m, &pose, now);
        }
        self.practice.freeze = Freeze::Due { at: now + RUN_ON_TIME, then_until_stick: true };
    }

    /// Freezes the flight if this is due after a rewind.
    pub(super) fn freeze_after_rewind(&mut self) {
        if let Freeze::Due { at, then_until_stick } = self.practice.freeze
            && self.now >= at
        {
            if then_until_stick {
                self.begin_freeze(Freeze::UntilStick { is_centered: false }, "Frozen: move a stick to continue");
            } else {
                self.begin_freeze(Freeze::On, "Frozen");
            }
        }
    }

    /// Resumes a flight that was rewound once a stick has moved. A stick that was held during the rewind must return to its center
    /// first.
    pub(super) fn resume_by_stick(&mut self) {
        let Freeze::UntilStick { is_centered } = self.practice.freeze else { return };
        let sticks = self.controller.vehicle().and_then(|vehicle| vehicle.sticks(self.now)).unwrap_or_default();
        let is_moved = has_moved(sticks);
        if is_centered && is_moved {
            self.unfreeze();
        } else {
            self.practice.freeze = Freeze::UntilStick { is_centered: !is_moved };
        }
    }

    /// Keeps the state of the aircraft for a rewind, if this is due and the aircraft flies undamaged.
    pub(super) fn keep_state(&mut self) {
        let is_due = self.now.ns() % KEPT_STATE_INTERVAL.ns() == 0 && !self.practice.is_forbidden;
        let is_intact = self.crashed_since.is_none() && !self.hard_contact && !self.state.contact.touching();
        if !is_due || !is_intact || !self.controller.is_flying() {
            return;
        }
        self.practice.keep(self.now, &self.state, self.last_safe_hover);
    }
}

fn has_moved(sticks: Sticks) -> bool {
    [sticks.forward, sticks.right, sticks.up, sticks.yaw].iter().any(|axis| axis.abs() > MOVED_STICK)
}
