//! Requests that are allowed in practice only: to freeze, resume and rewind the flight, and to move the aircraft. The endpoint
//! decides whether a request is accepted; the simulation carries it out.

use super::numbered_requests::{NumberedRequests, RequestNumber};
use super::refused_request::{RefusedRequest, queue_or_refuse};
use super::text_queue::TextQueue;
use super::vehicle_command::VehicleCommand;
use spandrel_mavlink::contract::practice::PracticeRequest;
use spandrel_mavlink::dialect::MavResult;
use std::collections::VecDeque;

/// The accepted requests.
#[derive(Debug, Clone, Default)]
pub struct PracticeInbox {
    requests: VecDeque<PracticeRequest>,
    numbered: NumberedRequests,
}

impl PracticeInbox {
    /// Accepts or refuses a request; `None` for other commands and for mission items. A command that a sender repeats with the same
    /// number, because the acknowledgment was lost, is acknowledged again but not carried out again. Returns the result for the
    /// acknowledgment.
    pub fn take(&mut self, state: &PracticeState, c: &VehicleCommand, texts: &mut TextQueue) -> Option<MavResult> {
        let admitted = state.admit(c)?;
        let number = match RequestNumber::of(c) {
            Ok(number) => number,
            Err(text) => return Some(queue_or_refuse(Err(RefusedRequest::denied(text.to_owned())), &mut self.requests, texts)),
        };
        if self.numbered.is_repeated(number) {
            return Some(MavResult::MAV_RESULT_ACCEPTED);
        }
        let result = queue_or_refuse(admitted, &mut self.requests, texts);
        if result == MavResult::MAV_RESULT_ACCEPTED {
            self.numbered.remember(number);
        }
        Some(result)
    }

    /// Removes and returns the next request.
    pub fn next_request(&mut self) -> Option<PracticeRequest> {
        self.requests.pop_front()
    }
}

/// Requests that the simulation can carry out at this instant.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct PracticeState {
    /// Whether these requests are allowed; not in an assessment.
    pub is_allowed: bool,
    /// Whether simulation time can stop; not with a flight controller, whose clock runs on.
    pub can_freeze: bool,
    /// Whether the flight can be rewound; not with an external autopilot, whose estimator cannot be put back.
    pub can_rewind: bool,
    /// Whether an earlier state in the air is known.
    pub has_flown: bool,
    /// Whether the flight has ended.
    pub has_ended: bool,
    /// Number of tasks.
    pub tasks: u32,
}

impl PracticeState {
    /// Reads a request and decides about it; `None` for other commands and for mission items.
    ///
    /// # Errors
    /// Returns the result and a text if the request is refused.
    fn admit(&self, c: &VehicleCommand) -> Option<Result<PracticeRequest, RefusedRequest>> {
        if c.own {
            return None;
        }
        let request = PracticeRequest::of(c.number, c.p[0])?;
        let admitted = request.map_err(str::to_owned).and_then(|request| self.refusal(request).map_or(Ok(request), Err));
        Some(admitted.map_err(RefusedRequest::denied))
    }

    fn refusal(&self, request: PracticeRequest) -> Option<String> {
        let moves_aircraft = match request {
            PracticeRequest::Freeze | PracticeRequest::Resume => false,
            PracticeRequest::Rewind { .. } | PracticeRequest::MoveToTask { .. } => true,
        };
        self.general_refusal(moves_aircraft).map(str::to_owned).or_else(|| match request {
            PracticeRequest::MoveToTask { task } if !(1..=self.tasks).contains(&task) => {
                Some(format!("No task {task} (allowed: 1 to {})", self.tasks))
            }
            PracticeRequest::Freeze
            | PracticeRequest::Resume
            | PracticeRequest::Rewind { .. }
            | PracticeRequest::MoveToTask { .. } => None,
        })
    }

    /// Returns why no request of this kind is possible now.
    fn general_refusal(&self, moves_aircraft: bool) -> Option<&'static str> {
        if !self.is_allowed {
            Some("No freeze or rewind in an assessment")
        } else if !self.can_freeze {
            Some("No freeze: a flight controller runs in real time")
        } else if !moves_aircraft {
            None
        } else if !self.can_rewind {
            Some("External autopilot: only freezing is possible")
        } else if self.has_ended {
            Some("Rejected: the flight has ended")
        } else if !self.has_flown {
            Some("Rejected: not flown yet")
        } else {
            None
        }
    }
}

#[cfg(test)]
mod tests {
    use super::super::numbered_requests::MAX_SENDERS;
    use super::*;
    use spandrel_mavlink::contract::practice::MAX_TASK;
    use spandrel_mavlink::dialect::MavCmd;

    const MAV_CMD_USER_2: u16 = MavCmd::MAV_CMD_USER_2 as u16;

    const ALL: PracticeState =
        PracticeState { is_allowed: true, can_freeze: true, can_rewind: true, has_flown: true, has_ended: false, tasks: 2 };

    #[test]
    fn regress_a_repeated_request_with_a_number_is_carried_out_once() {
        let (mut inbox, mut texts) = (PracticeInbox::default(), TextQueue::default());
        let rewind = MAV_CMD_USER_2;
        let mut ask = |number: u16, from: (u8, u8), p: [f64; 2]| {
            let p = [p[0], p[1], 0.0, 0.0, 0.0, 0.0, 0.0];
            let c = VehicleCommand { number, p, frame: 0, component: 1, system: 1, from, whole: false, own: false };
            let result = inbox.take(&ALL, &c, &mut texts);
            (result, inbox.next_request().is_some())
        };
        let (done, repeated) = ((Some(MavResult::MAV_RESULT_ACCEPTED), true), (Some(MavResult::MAV_RESULT_ACCEPTED), false));
        assert_eq!(ask(rewind, (254, 190), [10.0, 7.0]), done);
        assert_eq!(ask(rewind, (254, 190), [10.0, 7.0]), repeated, "the acknowledgment was lost");
        assert_eq!(ask(rewind, (252, 192), [10.0, 7.0]), done, "another sender");
        assert_eq!(ask(rewind, (254, 190), [10.0, 8.0]), done, "the next request");
        assert_eq!(ask(rewind, (254, 190), [10.0, 0.0]), done);
        assert_eq!(ask(rewind, (254, 190), [10.0, 0.0]), done, "without a number, each command counts");
        assert_eq!(ask(rewind, (254, 190), [10.0, 0.5]), (Some(MavResult::MAV_RESULT_DENIED), false));
        for system in 0..=255 {
            ask(rewind, (system, 1), [10.0, 3.0]);
        }
        assert!(inbox.numbered.last.len() <= MAX_SENDERS);
    }

    #[test]
    fn exact_each_reason_refuses_with_a_short_text() {
        let rewind = PracticeRequest::Rewind { by: spandrel_mavlink::contract::practice::DEFAULT_REWIND };
        let move_to = |task| PracticeRequest::MoveToTask { task };
        let requests = [PracticeRequest::Freeze, PracticeRequest::Resume, rewind, move_to(2)];
        let refused = |state: PracticeState| requests.map(|request| state.refusal(request).is_some());
        assert_eq!(refused(ALL), [false; 4]);
        assert_eq!(refused(PracticeState { is_allowed: false, ..ALL }), [true; 4]);
        assert_eq!(refused(PracticeState { can_freeze: false, ..ALL }), [true; 4]);
        for state in [
            PracticeState { can_rewind: false, ..ALL },
            PracticeState { has_flown: false, ..ALL },
            PracticeState { has_ended: true, ..ALL },
        ] {
            assert_eq!(refused(state), [false, false, true, true], "{state:?}");
        }
        assert_eq!(ALL.refusal(move_to(3)), Some("No task 3 (allowed: 1 to 2)".to_owned()));
        assert_eq!(MAX_TASK as usize, spandrel_model::scenario::tasks::MAX_TASKS);
        let none = PracticeState { is_allowed: false, ..ALL };
        // A longer text would need several STATUSTEXT messages.
        assert!(none.refusal(rewind).is_some_and(|text| text.len() <= 50));
    }
}
