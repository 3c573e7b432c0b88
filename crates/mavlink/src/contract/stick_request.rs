//! Request to change how the sticks command motion in position mode. It is a command, so that keys, buttons and scripts can
//! send it.

use crate::dialect::MavCmd;
use spandrel_model::stick_response::StickResponse;

/// Name of the parameter with the number of the active response.
pub const PARAMETER: &str = "SPAN_RESPONSE";

/// A request for a response to the sticks: MAV_CMD_USER_5 with its number in parameter 1.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum StickRequest {
    /// This response: its number.
    Select(StickResponse),
    /// The response after the active one: NaN. Parameter 2 numbers the request.
    Next,
}

impl StickRequest {
    /// Returns the command and its parameters. `number` tells the request from the sender's next one, so that the vehicle carries
    /// out a repeated command only once; see [`request_number`](super::practice::request_number). 0: each command counts.
    #[must_use]
    pub fn command(self, number: u32) -> (MavCmd, [f32; 7]) {
        let response = match self {
            Self::Select(response) => response.number() as f32,
            Self::Next => f32::NAN,
        };
        (MavCmd::MAV_CMD_USER_5, [response, number as f32, 0.0, 0.0, 0.0, 0.0, 0.0])
    }

    /// Returns the request of a command with this number and parameter 1; `None` for other commands.
    ///
    /// # Errors
    /// Returns a text with the allowed values if the parameter is invalid.
    #[must_use]
    pub fn of(number: u16, param: f64) -> Option<Result<Self, &'static str>> {
        if number != MavCmd::MAV_CMD_USER_5 as u16 {
            return None;
        }
        if param.is_nan() {
            return Some(Ok(Self::Next));
        }
        let named = if param.fract() == 0.0 { StickResponse::from_number(param as i32) } else { None };
        Some(named.map(Self::Select).ok_or("Sticks: parameter 1 must be 0 (position), 1 (sport) or 2 (tripod)"))
    }

    /// Returns the requested response if another one is active.
    #[must_use]
    pub fn response_after(self, active: StickResponse) -> StickResponse {
        match self {
            Self::Select(response) => response,
            Self::Next => StickResponse::from_number(active.number() + 1).unwrap_or_default(),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn exact_request_survives_the_command() {
        let selected = StickResponse::ALL.map(|(_, response)| StickRequest::Select(response));
        for request in selected.into_iter().chain([StickRequest::Next]) {
            let (command, params) = request.command(7);
            assert_eq!(StickRequest::of(command as u16, f64::from(params[0])), Some(Ok(request)));
        }
        assert_eq!(StickRequest::of(MavCmd::MAV_CMD_USER_4 as u16, 1.0), None);
    }

    #[test]
    fn exact_invalid_numbers_are_refused() {
        for param in [-1.0, 0.5, 3.0, f64::INFINITY] {
            let refusal = StickRequest::of(MavCmd::MAV_CMD_USER_5 as u16, param).and_then(Result::err);
            assert!(refusal.is_some_and(|text| text.contains("0 (position)")), "{param}");
        }
    }

    #[test]
    fn exact_next_goes_around() {
        let mut response = StickResponse::Position;
        let seen = [(); 3].map(|()| {
            response = StickRequest::Next.response_after(response);
            response
        });
        assert_eq!(seen, [StickResponse::Sport, StickResponse::Tripod, StickResponse::Position]);
    }
}
