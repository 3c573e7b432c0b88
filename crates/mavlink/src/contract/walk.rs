//! Request that the inspector walks to another place of the site. It is a command, so that displays, the instructor's page and
//! scripts can send it.

use crate::dialect::MavCmd;

/// Largest number of a place in a request: the maximum number of places in a scenario.
pub const MAX_PLACE: u8 = 8;

/// A request that the inspector walks to a place: MAV_CMD_USER_4 with the number of the place in parameter 1.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct WalkRequest {
    /// Number of the place, from 1.
    pub place: u8,
}

impl WalkRequest {
    /// Returns the command and its parameters.
    #[must_use]
    pub fn command(self) -> (MavCmd, [f32; 7]) {
        (MavCmd::MAV_CMD_USER_4, [f32::from(self.place), 0.0, 0.0, 0.0, 0.0, 0.0, 0.0])
    }

    /// Returns the request of a command with this number and parameter 1; `None` for other commands.
    ///
    /// # Errors
    /// Returns a text with the allowed values if the parameter is invalid.
    #[must_use]
    pub fn of(number: u16, param: f64) -> Option<Result<Self, &'static str>> {
        if number != MavCmd::MAV_CMD_USER_4 as u16 {
            return None;
        }
        let is_valid = (1.0..=f64::from(MAX_PLACE)).contains(&param) && param.fract() == 0.0;
        Some(if is_valid { Ok(Self { place: param as u8 }) } else { Err("Walk: parameter 1 must be 1 to 8") })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn exact_request_survives_the_command() {
        for place in 1..=MAX_PLACE {
            let (command, params) = WalkRequest { place }.command();
            assert_eq!(WalkRequest::of(command as u16, f64::from(params[0])), Some(Ok(WalkRequest { place })));
        }
        assert_eq!(WalkRequest::of(MavCmd::MAV_CMD_USER_3 as u16, 1.0), None);
    }

    #[test]
    fn exact_invalid_places_are_refused() {
        for param in [0.0, -1.0, 1.5, 9.0, f64::NAN, f64::INFINITY] {
            let refusal = WalkRequest::of(MavCmd::MAV_CMD_USER_4 as u16, param).and_then(Result::err).expect("refused");
            assert!(refusal.ends_with(&format!("1 to {MAX_PLACE}")), "{refusal}");
        }
    }
}
