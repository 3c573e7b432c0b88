//! Messages between `spandrel train` and its window: JSON lines over the window's standard input and output.

use crate::path_guide::PathAids;
use serde::de::DeserializeOwned;
use serde::{Deserialize, Serialize};
use spandrel_text::terms::purpose_title;
use spandrel_text::{Language, text};
use std::net::SocketAddr;
use std::path::PathBuf;

/// Purpose of a flight. Determines whether it may be interrupted.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Purpose {
    /// The flight may be paused and restarted; the map is available.
    #[default]
    Practice,
    /// No pause, restart, or map.
    Assessment,
}

impl Purpose {
    /// Returns the name used in files and on the command line.
    #[must_use]
    pub const fn word(self) -> &'static str {
        match self {
            Self::Practice => "practice",
            Self::Assessment => "assessment",
        }
    }

    /// Returns the name for display.
    #[must_use]
    pub fn title(self, language: Language) -> String {
        purpose_title(self.word(), language)
    }
}

/// A trainee who has flown on this machine.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize)]
pub struct TraineeSummary {
    /// The trainee's pseudonym.
    pub name: String,
    /// Number of sessions.
    pub sessions: u32,
    /// Number of practice sessions.
    pub practices: u32,
    /// The most important sentence about the latest session.
    #[serde(default)]
    pub last: Option<String>,
    /// Recommended next job.
    #[serde(default)]
    pub next: Option<NextJob>,
}

/// A job that is recommended or assigned next.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize)]
pub struct NextJob {
    /// Name, or path of the file.
    pub scenario: String,
    /// Title shown to the user.
    pub title: String,
    /// Due date (year-month-day) if an instructor assigned the job.
    #[serde(default)]
    pub due: Option<String>,
    /// Whether the recommendation follows from the last session alone, although there are more.
    #[serde(default)]
    pub from_last_session: bool,
}

impl NextJob {
    /// Returns the job with its reason, such as "Recommended: Drill: hover".
    #[must_use]
    pub fn words(&self, language: Language) -> String {
        let job = self.title.as_str();
        match &self.due {
            Some(due) => text!(language, "window-start-assigned", date = due.as_str(), job = job),
            None => text!(language, "window-start-recommended", job = job),
        }
    }
}

/// An available job.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize)]
pub struct JobOffer {
    /// Name, or path of the file.
    pub name: String,
    /// Title shown to the user.
    pub title: String,
    /// Short description of the job type.
    pub kind: String,
    /// Aircraft, wind and light in short.
    #[serde(default)]
    pub conditions: String,
    /// Whether the job is a lesson.
    #[serde(default)]
    pub is_lesson: bool,
    /// The job's briefing.
    #[serde(default)]
    pub briefing: JobBriefing,
    /// Name or path of the aircraft that conditions and briefing are for.
    #[serde(default)]
    pub vehicle: String,
}

/// An available aircraft.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize)]
pub struct AircraftOffer {
    /// Name, or path of the file.
    pub name: String,
    /// Title shown to the user.
    pub title: String,
}

/// The briefing for a job, as text and pictures.
#[derive(Debug, Clone, PartialEq, Eq, Default, Serialize, Deserialize)]
pub struct JobBriefing {
    /// The instructor's own words.
    pub notes: Vec<String>,
    /// The tasks in order.
    pub tasks: Vec<String>,
    /// Hazards.
    pub hazards: Vec<String>,
    /// Items of the site check.
    pub site_check: Vec<String>,
    /// Aircraft, speed, wind, light and other conditions.
    #[serde(default)]
    pub conditions: Vec<String>,
    /// The scores and the requirements of certification.
    #[serde(default)]
    pub counts: Vec<String>,
    /// The instructor's pictures.
    #[serde(default)]
    pub pictures: Vec<BriefingImage>,
}

/// A picture of the briefing: a PNG or JPEG file.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize)]
pub struct BriefingImage {
    /// Absolute path of the file.
    pub path: String,
    /// Caption.
    pub caption: String,
    /// Width and height as the picture is shown, px.
    pub size_px: (u32, u32),
}

impl BriefingImage {
    /// Returns the height relative to the width.
    #[must_use]
    pub fn height_ratio(&self) -> f64 {
        let (width, height) = self.size_px;
        f64::from(height.max(1)) / f64::from(width.max(1))
    }
}

impl JobBriefing {
    /// Returns whether there is nothing to read.
    #[must_use]
    pub fn is_empty(&self) -> bool {
        *self == Self::default()
    }
}

/// Pilot of a flight.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum FlownBy {
    /// The trainee.
    #[default]
    Trainee,
    /// The synthetic expert, while the trainee watches.
    Expert,
}

/// Selection of trainee, job, aircraft, and purpose.
#[derive(Debug, Clone, PartialEq, Eq, Default, Serialize, Deserialize)]
pub struct FlightChoice {
    /// The trainee's pseudonym.
    pub trainee: String,
    /// Name or path of the job.
    pub scenario: String,
    /// Purpose of the flight.
    pub purpose: Purpose,
    /// Pilot of the flight.
    #[serde(default)]
    pub by: FlownBy,
    /// Name or path of the aircraft.
    #[serde(default)]
    pub vehicle: String,
}

/// Available choices and the current selection.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize)]
pub struct FlightOptions {
    /// Known trainees.
    pub trainees: Vec<TraineeSummary>,
    /// Available jobs.
    pub scenarios: Vec<JobOffer>,
    /// Selection from the command line, or the default.
    pub choice: FlightChoice,
    /// Address of the web pages with this machine's sessions, if a server is running.
    pub web: Option<String>,
    /// Lesson for trainees without sessions.
    #[serde(default)]
    pub lesson: Option<NextJob>,
    /// Available aircraft.
    #[serde(default)]
    pub vehicles: Vec<AircraftOffer>,
}

/// A flight that has started.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize)]
pub struct FlightStarted {
    /// Trainee, job, aircraft, and purpose.
    pub choice: FlightChoice,
    /// The session's seed.
    pub seed: u64,
    /// Address of the vehicle's payload port, which sends telemetry.
    pub connect: SocketAddr,
    /// Address of its ground station port, if it has one.
    pub fly: Option<SocketAddr>,
    /// How much of the path is drawn in a practice session.
    #[serde(default)]
    pub path_aids: PathAids,
    /// Flight that a ghost repeats in a practice session, if there is one.
    #[serde(default)]
    pub ghost: Option<GhostFlight>,
    /// Whether the trainee's own flights are of an earlier version of the job, so that no ghost repeats them.
    #[serde(default)]
    pub is_ghost_outdated: bool,
}

/// An earlier flight of the same job that a ghost repeats.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize)]
pub struct GhostFlight {
    /// Telemetry log of the flight.
    pub telemetry: PathBuf,
    /// Whose flight it is, such as "your best flight, 342 of 400".
    pub words: String,
}

/// One of the four scores.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct FinalScore {
    /// Score as defined in the TASBID paper.
    pub raw: f64,
    /// Score as a percentage.
    pub pct: f64,
}

/// Steps of a lesson.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
pub struct LessonProgress {
    /// Number of steps that were done.
    pub done: usize,
    /// Number of all steps.
    pub steps: usize,
}

impl LessonProgress {
    /// Returns true if all steps were done.
    #[must_use]
    pub fn is_complete(self) -> bool {
        self.done >= self.steps
    }
}

/// A moment of a flight that the report shows.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize)]
pub struct FlightMoment {
    /// Time since lift-off, such as "5:40".
    pub time: String,
    /// Address of the report at this moment.
    pub address: String,
}

/// Result of a flight.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct FlightSummary {
    /// Scores for conformity, efficiency, safety, and accuracy; `None` if not applicable.
    pub scores: [Option<FinalScore>; 4],
    /// Sum and maximum possible sum; `None` if the session is incomplete.
    pub overall: Option<(f64, f64)>,
    /// Completion of the job, as text.
    pub completion: Option<String>,
    /// Whether the job was completed and the drone landed at home.
    pub complete: bool,
    /// Whether the session is certified, as text; `None` if it was not scored.
    pub verdict: Option<String>,
    /// The requirements that were not met.
    #[serde(default)]
    pub unmet: Vec<String>,
    /// Reason why the flight ended or why it has no scores.
    pub why: String,
    /// Personal best on the job and change since the last time; `None` if there is nothing to compare with.
    #[serde(default)]
    pub standing: Option<String>,
    /// Sentences on what to do better, at most three.
    #[serde(default)]
    pub advice: Vec<String>,
    /// Moments of the first sentences, in their order; empty without a server that shows the report.
    #[serde(default)]
    pub moments: Vec<FlightMoment>,
    /// Recommended next job.
    #[serde(default)]
    pub next: Option<NextJob>,
    /// Whether the trainee only watched the synthetic expert.
    #[serde(default)]
    pub watched: bool,
    /// Steps of the lesson, if the session was one. The scores of a lesson don't matter.
    #[serde(default)]
    pub lesson: Option<LessonProgress>,
    /// Address of the report, if one was written.
    pub report: Option<String>,
    /// Address of the questionnaire; empty if no server is running.
    pub questionnaire: String,
}

/// Page of the defect school.
#[derive(Debug, Clone, PartialEq, Eq, Default, Serialize, Deserialize)]
pub struct SchoolPage {
    /// Path of the picture (PNG), if there is one.
    pub picture: Option<String>,
    /// Title, such as the number of the question.
    pub title: String,
    /// The question, the verdict, or the result.
    pub lines: Vec<String>,
    /// Possible answers; empty after the answer.
    pub answers: Vec<String>,
    /// Whether the answer was right; `None` before the answer and at the end.
    pub right: Option<bool>,
    /// Whether the round is over.
    pub over: bool,
}

/// A request to the defect school.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum SchoolRequest {
    /// Start a round for this trainee.
    Begin(String),
    /// Give the answer with this number, from 0.
    Answer(usize),
    /// Continue with the next question.
    Continue,
    /// Leave the school.
    Leave,
}

/// Names of the four scores in files, in order.
pub const SCORE_NAMES: [&str; 4] = ["conformity", "efficiency", "safety", "accuracy"];

/// A flight that an instructor has ordered at this station.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize)]
pub struct OrderedFlight {
    /// The flight.
    pub choice: FlightChoice,
    /// Its job.
    pub job: JobOffer,
}

/// Messages from `spandrel train` to its window.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(tag = "is", rename_all = "snake_case")]
pub enum ToWindow {
    /// Choices to offer on the start page.
    Offers(FlightOptions),
    /// An instructor has ordered a flight: lead the trainee to it.
    Ordered(OrderedFlight),
    /// Show the briefing of the selected flight, which the command line fixes.
    Briefing,
    /// A flight has started.
    Flying(FlightStarted),
    /// The simulation has been paused or resumed.
    Paused {
        /// Whether it is paused.
        on: bool,
    },
    /// A request was rejected.
    Refused {
        /// Reason, shown to the user.
        words: String,
    },
    /// The expert's flight for the ghost is ready.
    Ghost(GhostFlight),
    /// The flight has ended.
    Ended(FlightSummary),
    /// Part that is loading for the page that the window waits for, and the share that is done.
    Loading {
        /// Words for the user.
        words: String,
    },
    /// Open a page in the browser.
    OpenPage {
        /// Its address.
        address: String,
    },
    /// The defect school's page.
    School(SchoolPage),
}

/// Messages from the window to `spandrel train`.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize)]
#[serde(tag = "is", rename_all = "snake_case")]
pub enum FromWindow {
    /// The window is open.
    Ready,
    /// Language of the texts that the window shows; sent after [`Self::Ready`] and at each change.
    Language {
        /// Language tag (BCP 47).
        tag: String,
    },
    /// The trainee has selected another aircraft: [`ToWindow::Offers`] with its briefings must follow.
    Aircraft {
        /// Name or path of the aircraft.
        name: String,
    },
    /// The window shows the flight.
    Showing,
    /// The trainee has read the briefing of this flight and acknowledged its site check; [`Self::Chosen`] follows.
    Acknowledged(FlightChoice),
    /// Write the briefing of this flight as a page to print; [`ToWindow::OpenPage`] follows.
    PrintBriefing(FlightChoice),
    /// Start this flight.
    Chosen(FlightChoice),
    /// The trainee has left the pages of the ordered flight without starting it.
    Declined,
    /// Pause the simulation.
    Pause,
    /// Resume the simulation.
    Resume,
    /// End this attempt and restart the same job.
    Restart,
    /// End the session now.
    End,
    /// Fly the same job again.
    Again,
    /// A request to the defect school.
    School(SchoolRequest),
    /// Quit the program.
    Quit,
}

/// Serializes a message as one line, without the line break.
#[must_use]
pub fn line<T: Serialize>(message: &T) -> String {
    // Serializing plain data with string keys cannot fail.
    serde_json::to_string(message).unwrap_or_default()
}

/// Parses a message from a line.
///
/// # Errors
/// Returns a description of the problem and the beginning of the line.
pub fn read<T: DeserializeOwned>(line: &str) -> Result<T, String> {
    /// Maximum number of characters of a line that an error message quotes.
    const MAX_QUOTED_CHARS: usize = 120;
    serde_json::from_str(line).map_err(|error| {
        let shown: String = line.chars().take(MAX_QUOTED_CHARS).collect();
        format!("'{shown}' is not a valid message between `spandrel train` and its window: {error}")
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    fn choice() -> FlightChoice {
        FlightChoice {
            trainee: "anna".into(),
            scenario: "drill-hover".into(),
            purpose: Purpose::Assessment,
            by: FlownBy::Trainee,
            vehicle: "phantom2".into(),
        }
    }

    fn flight_summary(next: NextJob) -> FlightSummary {
        let score = Some(FinalScore { raw: -9.0, pct: 91.0 });
        FlightSummary {
            scores: [score, None, score, None],
            overall: Some((182.5, 200.0)),
            completion: Some("Complete: 1 of 1 task, 92% of the path".into()),
            complete: true,
            verdict: Some("Certified".into()),
            unmet: Vec::new(),
            why: "landed".into(),
            standing: Some("This is the personal best on this job.".into()),
            advice: vec!["You hit the bridge twice in task 3, at 5:40 and 6:02.".into()],
            moments: vec![FlightMoment { time: "5:40".into(), address: "http://127.0.0.1:9/sessions/x/report#t=340".into() }],
            next: Some(next),
            watched: false,
            lesson: None,
            report: Some("file:///a%20b".into()),
            questionnaire: "http://127.0.0.1:9/sessions/x/questions".into(),
        }
    }

    #[test]
    fn exact_messages_survive_serialization() {
        let next = NextJob { scenario: "drill-gap".into(), title: "Drill: gap".into(), due: None, from_last_session: false };
        let offers = FlightOptions {
            trainees: vec![TraineeSummary {
                name: "anna".into(),
                sessions: 3,
                practices: 2,
                last: Some("You hit the bridge.".into()),
                next: Some(next.clone()),
            }],
            scenarios: vec![JobOffer {
                name: "drill-hover".into(),
                title: "Drill: \"hover\"\n".into(),
                kind: "drill".into(),
                conditions: "Wind: calm".into(),
                is_lesson: true,
                briefing: JobBriefing::default(),
                vehicle: "phantom2".into(),
            }],
            choice: choice(),
            web: None,
            lesson: None,
            vehicles: vec![AircraftOffer { name: "my drone.toml".into(), title: "Ours".into() }],
        };
        let flying = FlightStarted {
            choice: choice(),
            seed: 7,
            connect: SocketAddr::from(([127, 0, 0, 1], 14280)),
            fly: None,
            path_aids: PathAids::Gates,
            ghost: Some(GhostFlight { telemetry: "sessions/a b/telemetry.tlog".into(), words: "your best flight".into() }),
            is_ghost_outdated: true,
        };
        let ended = flight_summary(next);
        let ordered = OrderedFlight { choice: choice(), job: offers.scenarios[0].clone() };
        for message in [
            ToWindow::Offers(offers),
            ToWindow::Ordered(ordered),
            ToWindow::Briefing,
            ToWindow::Flying(flying),
            ToWindow::Paused { on: true },
            ToWindow::Refused { words: "no".into() },
            ToWindow::Ghost(GhostFlight { telemetry: "a.tlog".into(), words: "the expert's flight".into() }),
            ToWindow::Ended(ended),
        ] {
            let line = line(&message);
            assert!(!line.contains('\n'), "{line}");
            assert_eq!(read::<ToWindow>(&line), Ok(message));
        }
        for message in [
            FromWindow::Ready,
            FromWindow::Language { tag: "de".into() },
            FromWindow::Aircraft { name: "elios3".into() },
            FromWindow::Showing,
            FromWindow::Acknowledged(choice()),
            FromWindow::Chosen(choice()),
            FromWindow::Declined,
            FromWindow::Restart,
            FromWindow::Quit,
        ] {
            assert_eq!(read::<FromWindow>(&line(&message)), Ok(message));
        }
        assert_eq!(line(&FromWindow::Language { tag: "es".into() }), r#"{"is":"language","tag":"es"}"#);
    }

    #[test]
    fn exact_invalid_line_is_reported() {
        for bad in ["", "pause", r#"{"is":"dance"}"#, r#"{"is":"chosen","trainee":"a"}"#, "\u{0}\u{7f}"] {
            let told = read::<FromWindow>(bad).expect_err(bad);
            assert!(told.contains("not a valid message"), "{told}");
        }
        let long = "x".repeat(10_000);
        assert!(read::<ToWindow>(&long).expect_err("long").len() < 400);
    }
}
