//! What `train` and its window tell each other: a JSON line each, over the window's standard input and output.

use serde::de::DeserializeOwned;
use serde::{Deserialize, Serialize};
use std::net::SocketAddr;

/// Whether the flight may be interrupted.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Purpose {
    /// It may stand still and begin anew; the map helps.
    #[default]
    Practice,
    /// It is flown through, without the map.
    Assessment,
}

impl Purpose {
    /// As in files and on the command line.
    #[must_use]
    pub const fn word(self) -> &'static str {
        match self {
            Self::Practice => "practice",
            Self::Assessment => "assessment",
        }
    }
}

/// Somebody who has flown here.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize)]
pub struct TraineeSummary {
    /// Pseudonym.
    pub name: String,
    /// Sessions so far.
    pub sessions: u32,
    /// How many of them were practices.
    pub practices: u32,
}

/// A job that can be flown.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize)]
pub struct JobOffer {
    /// Its name, or the path of its file.
    pub name: String,
    /// Title for people.
    pub title: String,
    /// What kind of job it is, in a few words.
    pub kind: String,
}

/// Who flies what, and what for.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize)]
pub struct FlightChoice {
    /// Pseudonym.
    pub trainee: String,
    /// Name or path of the job.
    pub scenario: String,
    /// What for.
    pub purpose: Purpose,
}

/// What can be chosen, and what is chosen unless somebody changes it.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize)]
pub struct FlightOptions {
    /// Who has flown here.
    pub trainees: Vec<TraineeSummary>,
    /// Jobs.
    pub scenarios: Vec<JobOffer>,
    /// As asked for on the command line, or the usual.
    pub choice: FlightChoice,
    /// The pages of this machine's sessions, where they are served.
    pub web: Option<String>,
}

/// A flight that has begun.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize)]
pub struct FlightStarted {
    /// Who flies what.
    pub choice: FlightChoice,
    /// With which aircraft: name or path.
    pub vehicle: String,
    /// The session's seed.
    pub seed: u64,
    /// The vehicle's payload port: its telemetry.
    pub connect: SocketAddr,
    /// Its port for ground stations, where it has one.
    pub fly: Option<SocketAddr>,
}

/// A score.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct FinalScore {
    /// As the paper defines it.
    pub raw: f64,
    /// Of 100.
    pub pct: f64,
}

/// The end of a flight.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct FlightSummary {
    /// Conformity, efficiency, safety, accuracy; none where it does not apply.
    pub scores: [Option<FinalScore>; 4],
    /// Sum, and the most that it can be here; none when the session is incomplete.
    pub overall: Option<(f64, f64)>,
    /// How much of the job was done, in words.
    pub completion: Option<String>,
    /// The job was done and the drone landed at home.
    pub complete: bool,
    /// Certified, or the requirement that failed.
    pub verdict: Option<String>,
    /// Why it ended, in words; or why there are no scores.
    pub why: String,
    /// Address of the report, where there is one.
    pub report: Option<String>,
    /// Address of the questionnaire, where pages are served; else the command that asks it.
    pub questionnaire: String,
}

/// Names of the four scores, in their order.
pub const SCORES: [&str; 4] = ["conformity", "efficiency", "safety", "accuracy"];

/// From `train` to its window.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(tag = "is", rename_all = "snake_case")]
pub enum ToWindow {
    /// What can be chosen.
    Offers(FlightOptions),
    /// A flight has begun.
    Flying(FlightStarted),
    /// Time stands still, or runs again.
    Paused {
        /// It stands still.
        on: bool,
    },
    /// What was wished for is not done.
    Refused {
        /// Why.
        words: String,
    },
    /// The flight is over.
    Ended(FlightSummary),
}

/// From the window to `train`.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize)]
#[serde(tag = "is", rename_all = "snake_case")]
pub enum FromWindow {
    /// The window is open.
    Ready,
    /// Fly this.
    Chosen(FlightChoice),
    /// Time shall stand still.
    Pause,
    /// Time shall run again.
    Resume,
    /// End this attempt and begin the same job anew.
    Restart,
    /// End the session now.
    End,
    /// Fly the same once more.
    Again,
    /// That was all.
    Quit,
}

/// A message as its line, without the line's end.
#[must_use]
pub fn line<T: Serialize>(message: &T) -> String {
    // Plain data with names for keys: nothing in it that JSON cannot say.
    serde_json::to_string(message).unwrap_or_default()
}

/// A line as a message.
///
/// # Errors
/// What is wrong with it, with the line itself.
pub fn read<T: DeserializeOwned>(line: &str) -> Result<T, String> {
    /// Enough of a line to find it again.
    const SHOWN: usize = 120;
    serde_json::from_str(line).map_err(|error| {
        let shown: String = line.chars().take(SHOWN).collect();
        format!("'{shown}' is no message between train and its window: {error}")
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    fn choice() -> FlightChoice {
        FlightChoice { trainee: "anna".into(), scenario: "drill-hover".into(), purpose: Purpose::Assessment }
    }

    #[test]
    fn exact_every_message_survives_its_line() {
        let score = Some(FinalScore { raw: -9.0, pct: 91.0 });
        let offers = FlightOptions {
            trainees: vec![TraineeSummary { name: "anna".into(), sessions: 3, practices: 2 }],
            scenarios: vec![JobOffer { name: "drill-hover".into(), title: "Drill: \"hover\"\n".into(), kind: "drill".into() }],
            choice: choice(),
            web: None,
        };
        let flying = FlightStarted {
            choice: choice(),
            vehicle: "phantom2".into(),
            seed: 7,
            connect: SocketAddr::from(([127, 0, 0, 1], 14280)),
            fly: None,
        };
        let ended = FlightSummary {
            scores: [score, None, score, None],
            overall: Some((182.5, 200.0)),
            completion: Some("Complete: 1 of 1 task, 92 % of the path".into()),
            complete: true,
            verdict: Some("Certified".into()),
            why: "landed".into(),
            report: Some("file:///a%20b".into()),
            questionnaire: "spandrel questionnaire x".into(),
        };
        for message in [
            ToWindow::Offers(offers),
            ToWindow::Flying(flying),
            ToWindow::Paused { on: true },
            ToWindow::Refused { words: "no".into() },
            ToWindow::Ended(ended),
        ] {
            let line = line(&message);
            assert!(!line.contains('\n'), "{line}");
            assert_eq!(read::<ToWindow>(&line), Ok(message));
        }
        for message in [FromWindow::Ready, FromWindow::Chosen(choice()), FromWindow::Restart, FromWindow::Quit] {
            assert_eq!(read::<FromWindow>(&line(&message)), Ok(message));
        }
    }

    #[test]
    fn exact_a_bad_line_is_named() {
        for bad in ["", "pause", r#"{"is":"dance"}"#, r#"{"is":"chosen","trainee":"a"}"#, "\u{0}\u{7f}"] {
            let told = read::<FromWindow>(bad).expect_err(bad);
            assert!(told.contains("no message"), "{told}");
        }
        let long = "x".repeat(10_000);
        assert!(read::<ToWindow>(&long).expect_err("long").len() < 400);
    }
}
