//! Loss of position, manual control, external setpoints and ground station.

use super::input::FailsafeInput;
use super::link_status::LinkStatus;
use super::operator_rules::{FailsafeResponse, OffboardLoss};
use super::response::FailsafeRequest;
use crate::autopilot::events::{EventQueue, Severity};
use crate::autopilot::flight_state::FlightMode;
use crate::autopilot::tuning::LinkLossAction;
use spandrel_model::time::SimTime;

/// Time without a position after which an automatic mode is aborted, s.
const POSITION_LOSS_TIMEOUT_S: f64 = 1.0;

/// A possible loss, in the order of the checks. The first one that requires a different mode ends the checks.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Loss {
    /// Loss of position.
    Position,
    /// Loss of manual control.
    Manual,
    /// Loss of external setpoints or of the ground station.
    Link,
}

impl Loss {
    /// All losses in the order of the checks.
    pub const ALL: [Self; 3] = [Self::Position, Self::Manual, Self::Link];
}

/// Mode of a failsafe that lasts as long as the loss, and the reason for it.
pub type LossMode = (FlightMode, &'static str);

/// The response to a loss.
#[derive(Debug, Clone, PartialEq, Eq)]
pub enum LossResponse {
    /// Fly a mode until the loss ends.
    Fly(LossMode),
    /// Carry out a request. The other losses are still checked.
    Request(FailsafeRequest),
}

/// State of the loss checks.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct LossMonitor {
    /// Reason for the active failsafe.
    pub active: Option<&'static str>,
    /// Whether stick input has been received since arming. If so, its loss counts in automatic modes too.
    pub sticks_received: bool,
    manual_lost_since: Option<SimTime>,
    no_position_since: Option<SimTime>,
}

impl LossMonitor {
    /// Resets the checks while the vehicle is disarmed.
    pub fn reset(&mut self) {
        (self.active, self.manual_lost_since) = (None, None);
    }

    /// Checks for one loss.
    pub fn check(&mut self, loss: Loss, links: &LinkStatus, input: &FailsafeInput) -> Option<LossResponse> {
        match loss {
            Loss::Position => self.check_position(links, input).map(LossResponse::Fly),
            Loss::Manual => self.check_manual(links, input),
            Loss::Link => check_links(links, input),
        }
    }

    /// Handles loss of position. With a pilot, the vehicle switches to altitude mode; automatic modes descend in place.
    fn check_position(&mut self, links: &LinkStatus, input: &FailsafeInput) -> Option<LossMode> {
        let intended = input.flight.intended;
        if input.estimate.position_valid || !intended.needs_position() {
            self.no_position_since = None;
            return None;
        }
        let since = *self.no_position_since.get_or_insert(input.now);
        let lasting = (input.now - since).s() > POSITION_LOSS_TIMEOUT_S;
        let pilot_flies = has_recent_sticks(links, input) && !input.tuning.rules.responses.lands_without_position;
        if pilot_flies {
            (intended.is_manual() || lasting).then_some((FlightMode::Altitude, "position lost, holding altitude only"))
        } else {
            lasting.then_some((FlightMode::Land, "position lost, landing"))
        }
    }

    fn check_manual(&mut self, links: &LinkStatus, input: &FailsafeInput) -> Option<LossResponse> {
        let fresh = has_recent_sticks(links, input);
        self.sticks_received |= fresh;
        let intended = input.flight.intended;
        let except = input.tuning.rules.responses.manual_loss_exceptions;
        let counts = intended.is_manual() || self.sticks_received && !except.includes(intended);
        if fresh || !counts {
            self.manual_lost_since = None;
            return None;
        }
        let since = *self.manual_lost_since.get_or_insert(input.now);
        let hold = hold_mode(input);
        let why = "manual control lost";
        if (input.now - since).s() < input.tuning.failsafe_delay_s {
            return Some(LossResponse::Fly((hold, why)));
        }
        Some(respond_to_loss(input.tuning.manual_loss, hold, why, input))
    }

    /// Reports the start or end of a failsafe. Returns the mode change request.
    pub fn finish_checks(
        &mut self,
        flown: Option<LossMode>,
        input: &FailsafeInput,
        events: &mut EventQueue,
    ) -> Option<FailsafeRequest> {
        if let Some((mode, why)) = flown {
            if self.active != Some(why) {
                self.active = Some(why);
                events.push(Severity::Critical, format!("Failsafe: {why}"));
            }
            return Some(FailsafeRequest::Override(mode));
        }
        if self.active.take().is_some() {
            events.push(Severity::Info, "Failsafe cleared");
        }
        input.flight.overridden.then_some(FailsafeRequest::EndOverride)
    }
}

fn has_recent_sticks(links: &LinkStatus, input: &FailsafeInput) -> bool {
    links.has_recent_sticks(input.tuning.manual_timeout_s(), input.now)
}

/// The mode that keeps the vehicle in place: hold, or land without a position estimate.
fn hold_mode(input: &FailsafeInput) -> FlightMode {
    if input.estimate.position_valid { FlightMode::Hold } else { FlightMode::Land }
}

fn respond_to_loss(action: LinkLossAction, hold: FlightMode, why: &'static str, input: &FailsafeInput) -> LossResponse {
    let mode = match action {
        LinkLossAction::Terminate => return LossResponse::Request(FailsafeRequest::terminate(why)),
        LinkLossAction::Return if input.estimate.position_valid => FlightMode::Return,
        LinkLossAction::Return | LinkLossAction::Land => FlightMode::Land,
        LinkLossAction::Ignore | LinkLossAction::Hold => hold,
    };
    LossResponse::Fly((mode, why))
}

fn check_links(links: &LinkStatus, input: &FailsafeInput) -> Option<LossResponse> {
    let (tuning, intended) = (input.tuning, input.flight.intended);
    if intended == FlightMode::Offboard && !links.has_recent_offboard(tuning.offboard_timeout_s(), input.now) {
        if tuning.setpoint_end_is_normal {
            return Some(LossResponse::Request(FailsafeRequest::EndOffboard));
        }
        return Some(respond_to_offboard_loss(links, input));
    }
    let excepted = tuning.rules.responses.data_link_loss_exceptions.includes(intended);
    let counts = tuning.data_link_loss != LinkLossAction::Ignore && !excepted;
    let silent = links.ground_station.is_some_and(|at| (input.now - at).s() > tuning.data_link_timeout_s());
    (counts && silent).then(|| respond_to_loss(tuning.data_link_loss, FlightMode::Hold, "ground station lost", input))
}

fn respond_to_offboard_loss(links: &LinkStatus, input: &FailsafeInput) -> LossResponse {
    let why = "external setpoints lost";
    let hold = hold_mode(input);
    let respond = |action| respond_to_loss(action, hold, why, input);
    match input.tuning.rules.responses.offboard_loss {
        OffboardLoss::Sticks(mode) => {
            let flyable = input.estimate.position_valid || !mode.needs_position();
            if has_recent_sticks(links, input) && flyable {
                LossResponse::Fly((mode, why))
            } else {
                respond(input.tuning.manual_loss)
            }
        }
        OffboardLoss::Fixed(FailsafeResponse::Terminate) => respond(LinkLossAction::Terminate),
        OffboardLoss::Fixed(FailsafeResponse::Return) => respond(LinkLossAction::Return),
        OffboardLoss::Fixed(FailsafeResponse::Land) => LossResponse::Fly((FlightMode::Land, why)),
        OffboardLoss::Fixed(FailsafeResponse::Hold | FailsafeResponse::Warn) => LossResponse::Fly((hold, why)),
    }
}
