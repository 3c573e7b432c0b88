//! Requests that are allowed in practice only: to freeze the flight, to resume it, to rewind it, and to move the aircraft to
//! a task. They are commands, so that displays, the instructor's page and scripts can send them.

use crate::dialect::MavCmd;
use spandrel_model::time::SimTime;

/// Time by which a flight is rewound if the request does not contain one.
pub const DEFAULT_REWIND: SimTime = SimTime::from_ms(10_000);
/// Longest time by which one request rewinds a flight.
pub const MAX_REWIND: SimTime = SimTime::from_ms(30_000);

/// Largest number of a request: whole numbers up to it survive as 32-bit floats.
const MAX_NUMBER: u32 = (1 << 24) - 1;

/// Returns a number that tells one request of a sender from the next, from the sender's clock in ms. A clock makes it unlikely that
/// a sender that was restarted uses its last number again.
#[must_use]
pub fn request_number(clock_ms: u64) -> u32 {
    (clock_ms % u64::from(MAX_NUMBER)) as u32 + 1
}

/// Returns the number in parameter 2 of a request; `None` if it has none (0 or NaN).
///
/// # Errors
/// Returns a text with the allowed values if the parameter is invalid.
pub fn number_in(param: f64) -> Result<Option<u32>, &'static str> {
    match param {
        none if none.is_nan() || none == 0.0 => Ok(None),
        number if (1.0..=f64::from(MAX_NUMBER)).contains(&number) && number.fract() == 0.0 => Ok(Some(number as u32)),
        _ => Err("Parameter 2 must be 0 to 16777215, whole"),
    }
}

/// A request that is allowed in practice only.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum PracticeRequest {
    /// Stop simulation time: MAV_CMD_USER_1 with 1 in parameter 1.
    Freeze,
    /// Let simulation time continue: MAV_CMD_USER_1 with 0 in parameter 1.
    Resume,
    /// Put the aircraft back to where it was, and freeze: MAV_CMD_USER_2 with the time in s in parameter 1 (0 or NaN:
    /// [`DEFAULT_REWIND`]).
    Rewind {
        /// Time of flight to undo.
        by: SimTime,
    },
    /// Put the aircraft at the start of a task's path, and freeze: MAV_CMD_USER_3 with the task's number in parameter 1.
    MoveToTask {
        /// Number of the task, from 1.
        task: u32,
    },
}

/// Largest number of a task in a request: the maximum number of tasks in a scenario.
pub const MAX_TASK: u32 = 64;

impl PracticeRequest {
    /// Returns the command and its parameters. `number` tells the request from the sender's next one, so that the vehicle carries
    /// out a repeated command only once; see [`request_number`]. 0: each command counts.
    #[must_use]
    pub fn command(self, number: u32) -> (MavCmd, [f32; 7]) {
        let (command, value) = match self {
            Self::Freeze => (MavCmd::MAV_CMD_USER_1, 1.0),
            Self::Resume => (MavCmd::MAV_CMD_USER_1, 0.0),
            Self::Rewind { by } => (MavCmd::MAV_CMD_USER_2, by.s() as f32),
            Self::MoveToTask { task } => (MavCmd::MAV_CMD_USER_3, task as f32),
        };
        (command, [value, number as f32, 0.0, 0.0, 0.0, 0.0, 0.0])
    }

    /// Returns the request of a command with this number and parameter 1; `None` for other commands.
    ///
    /// # Errors
    /// Returns a text with the allowed values if the parameter is invalid.
    #[must_use]
    pub fn of(number: u16, param: f64) -> Option<Result<Self, &'static str>> {
        match number {
            n if n == MavCmd::MAV_CMD_USER_1 as u16 => Some(match param {
                1.0 => Ok(Self::Freeze),
                0.0 => Ok(Self::Resume),
                _ => Err("Freeze: parameter 1 must be 1 or 0 (resume)"),
            }),
            n if n == MavCmd::MAV_CMD_USER_2 as u16 => Some(match param {
                by if by.is_nan() || by == 0.0 => Ok(Self::Rewind { by: DEFAULT_REWIND }),
                by if by >= 1.0 && by <= MAX_REWIND.s() => Ok(Self::Rewind { by: SimTime::from_s(by) }),
                _ => Err("Rewind: parameter 1 must be 1 to 30 s, or 0 (10 s)"),
            }),
            n if n == MavCmd::MAV_CMD_USER_3 as u16 => Some(match param {
                task if (1.0..=f64::from(MAX_TASK)).contains(&task) && task.fract() == 0.0 => {
                    Ok(Self::MoveToTask { task: task as u32 })
                }
                _ => Err("Move: parameter 1 must be 1 to 64"),
            }),
            _ => None,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn exact_requests_survive_the_command() {
        let five = PracticeRequest::Rewind { by: SimTime::from_ms(5_000) };
        for request in [PracticeRequest::Freeze, PracticeRequest::Resume, five, PracticeRequest::MoveToTask { task: 3 }] {
            let (command, params) = request.command(MAX_NUMBER);
            assert_eq!(PracticeRequest::of(command as u16, f64::from(params[0])), Some(Ok(request)));
            assert_eq!(number_in(f64::from(params[1])), Ok(Some(MAX_NUMBER)));
        }
    }

    #[test]
    fn exact_numbers_of_requests_are_whole_or_missing() {
        assert_eq!([0.0, f64::NAN, 1.0].map(number_in), [Ok(None), Ok(None), Ok(Some(1))]);
        for param in [-1.0, 0.5, 16_777_216.0, f64::INFINITY] {
            assert!(number_in(param).is_err_and(|refusal| refusal.len() <= 50), "{param}");
        }
        let numbers = [0, 1, u64::from(MAX_NUMBER) - 1, u64::from(MAX_NUMBER)].map(request_number);
        assert_eq!(numbers, [1, 2, MAX_NUMBER, 1]);
    }

    #[test]
    fn exact_parameters_out_of_range_are_refused() {
        let (freeze, rewind) = (MavCmd::MAV_CMD_USER_1 as u16, MavCmd::MAV_CMD_USER_2 as u16);
        let task = MavCmd::MAV_CMD_USER_3 as u16;
        let freezes = [2.0, f64::NAN].map(|param| (freeze, param));
        let rewinds = [-1.0, 0.5, 30.1, f64::INFINITY].map(|param| (rewind, param));
        let tasks = [0.0, 1.5, -1.0, 65.0, f64::NAN].map(|param| (task, param));
        for (number, param) in freezes.into_iter().chain(rewinds).chain(tasks) {
            let refusal = PracticeRequest::of(number, param).and_then(Result::err).expect("refused");
            // A longer text would need several STATUSTEXT messages.
            assert!(refusal.len() <= 50, "{refusal}");
        }
        assert_eq!(MAX_TASK, 64, "the text names the limit");
        for param in [0.0, f64::NAN] {
            assert_eq!(PracticeRequest::of(rewind, param), Some(Ok(PracticeRequest::Rewind { by: DEFAULT_REWIND })));
        }
        assert_eq!(PracticeRequest::of(MavCmd::MAV_CMD_USER_4 as u16, 1.0), None);
    }
}
