//! An instructor's commands and their outcomes, in words.

use spandrel_mavlink::contract::practice::PracticeRequest;
use spandrel_mavlink::contract::walk::WalkRequest;
use spandrel_text::{Language, text};
use spandrel_training::web::live::FailingUnit;

/// An instructor's command.
#[derive(Debug, Clone, PartialEq)]
pub enum InstructorCommand {
    /// Adds a note to the monitor's event log.
    Note(String),
    /// Sets the mean wind.
    Wind {
        /// Mean wind speed, m/s.
        speed_m_s: f64,
        /// Wind direction (where the wind comes from), degrees clockwise from north.
        from_deg: f64,
    },
    /// Opens the bridges to traffic or closes them.
    Traffic {
        /// True to open the bridges.
        open: bool,
    },
    /// Freezes, resumes or rewinds a practice flight.
    Practice(PracticeRequest),
    /// Sends the inspector to another place.
    Walk(WalkRequest),
    /// Injects or clears a failure.
    Failure {
        /// The component.
        unit: FailingUnit,
        /// True to inject the failure, false to clear it.
        fails: bool,
    },
}

impl InstructorCommand {
    /// Returns the command in words, for the message log.
    fn words(&self, language: Language) -> String {
        match self {
            Self::Note(note) => text!(language, "live-report-note", note = note.as_str()),
            Self::Wind { speed_m_s, from_deg } => {
                text!(language, "live-report-wind", speed = speed_m_s.to_string(), from = from_deg.to_string())
            }
            Self::Traffic { open: true } => text!(language, "live-report-bridges-open"),
            Self::Traffic { open: false } => text!(language, "live-report-bridges-closed"),
            Self::Practice(request) => practice_words(*request, language),
            Self::Walk(WalkRequest { place }) => text!(language, "live-report-walk", place = place.to_string()),
            Self::Failure { unit, fails: true } => {
                text!(language, "live-report-fails", unit = unit.name_in_sentence(language))
            }
            Self::Failure { unit, fails: false } => {
                text!(language, "live-report-restored", unit = unit.name_in_sentence(language))
            }
        }
    }
}

fn practice_words(request: PracticeRequest, language: Language) -> String {
    match request {
        PracticeRequest::Freeze => text!(language, "live-report-freeze"),
        PracticeRequest::Resume => text!(language, "live-report-continue"),
        PracticeRequest::Rewind { by } => text!(language, "live-report-rewind", seconds = format!("{:.0}", by.s())),
        PracticeRequest::MoveToTask { task } => text!(language, "live-report-move", task = task),
    }
}

/// Why the vehicle rejected a command.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Rejection {
    /// Not in the current state.
    NotNow,
    /// The vehicle does not support the command.
    Unsupported,
    /// The vehicle denied the command.
    Denied,
    /// The vehicle reported a failure.
    Failed,
    /// The vehicle has no such parameter.
    NoSuchParameter,
    /// The value is out of range.
    OutOfRange,
    /// The parameter is read-only.
    ReadOnly,
    /// The vehicle rejected the value for another reason.
    InvalidValue,
}

impl Rejection {
    fn words(self, language: Language) -> String {
        match self {
            Self::NotNow => text!(language, "live-rejected-not-now"),
            Self::Unsupported => text!(language, "live-rejected-unsupported"),
            Self::Denied => text!(language, "live-rejected-denied"),
            Self::Failed => text!(language, "live-rejected-failed"),
            Self::NoSuchParameter => text!(language, "live-rejected-no-such-parameter"),
            Self::OutOfRange => text!(language, "live-rejected-out-of-range"),
            Self::ReadOnly => text!(language, "live-rejected-read-only"),
            Self::InvalidValue => text!(language, "live-rejected-invalid-value"),
        }
    }
}

/// Outcome of a command.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum CommandOutcome {
    /// It was carried out.
    Done,
    /// The vehicle did not respond.
    NoResponse,
    /// The vehicle rejected it.
    Rejected(Rejection),
}

/// A finished command.
#[derive(Debug, Clone, PartialEq)]
pub struct InstructorReport {
    /// The command.
    pub command: InstructorCommand,
    /// Its outcome.
    pub outcome: CommandOutcome,
}

impl InstructorReport {
    /// Returns the line for the message log.
    pub fn words(&self, language: Language) -> String {
        let command = self.command.words(language);
        match self.outcome {
            CommandOutcome::Done => command,
            CommandOutcome::NoResponse => text!(language, "live-report-no-response", command = command),
            CommandOutcome::Rejected(why) => {
                text!(language, "live-report-rejected", command = command, reason = why.words(language))
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn exact_reports_are_in_the_language_of_the_page() {
        let command = InstructorCommand::Failure { unit: FailingUnit::Gnss, fails: true };
        let report = InstructorReport { command, outcome: CommandOutcome::Rejected(Rejection::NotNow) };
        assert_eq!(report.words(Language::English), "instructor: satellite navigation fails: rejected, not now");
        assert_eq!(report.words(Language::German), "Ausbilder: Satellitennavigation fällt aus: abgelehnt, nicht jetzt");
        let wind = InstructorCommand::Wind { speed_m_s: 8.5, from_deg: 270.0 };
        let done = InstructorReport { command: wind, outcome: CommandOutcome::Done };
        assert_eq!(done.words(Language::Spanish), "instructor: viento de 8.5 m/s desde 270°");
    }
}
