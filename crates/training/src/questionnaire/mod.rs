//! The questionnaire after a session: three statements about the whole inspection and three about each phase (24 for a
//! job with four tasks), rated from 1 (strongly agree, most positive) to 5 (strongly disagree), plus, optionally, the
//! unweighted NASA-TLX. The wording is a translatable data file. Answer keys are the same in every language.

mod answers;
mod language;
mod language_tag;
mod scales;
mod wording;

pub use answers::{ANSWERS, Answers, read_answers};
pub use language::{Languages, SHIPPED};
pub use scales::{ScaleScores, raw_tlx, scales};
pub use wording::{FormWording, Wording, read_wording};

use std::fmt;

/// Most positive answer.
pub const STRONGLY_AGREE: u8 = 1;
/// Most negative answer.
pub const STRONGLY_DISAGREE: u8 = 5;
/// Step size of a NASA-TLX scale, points.
pub const TLX_STEP: u8 = 5;
/// Maximum of a NASA-TLX scale, points.
pub const TLX_MAX: u8 = 100;

/// Statements about the entire inspection.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub enum OverallItem {
    /// There was no time pressure.
    TimePressure,
    /// The trainee never felt insecure, irritated or stressed.
    Frustration,
    /// Feedback during the task was helpful.
    Feedback,
}

/// Statements about each phase.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub enum PhaseAspect {
    /// The phase went well.
    Performance,
    /// The phase was easy.
    MentalDemand,
    /// The phase required no physical effort.
    PhysicalDemand,
}

/// A phase of the inspection.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub enum InspectionPhase {
    /// Calibration before the flight.
    Calibration,
    /// Takeoff.
    TakingOff,
    /// A task, by number.
    Task(u32),
    /// Landing.
    Landing,
}

/// A question in the questionnaire.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub enum QuestionnaireItem {
    /// Statement about the whole inspection.
    Overall(OverallItem),
    /// Statement about one phase.
    Phase(InspectionPhase, PhaseAspect),
}

/// A NASA-TLX scale.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub enum TlxScale {
    /// How mentally demanding the session was.
    MentalDemand,
    /// How physically demanding the session was.
    PhysicalDemand,
    /// How hurried the pace was.
    TemporalDemand,
    /// How successful the trainee felt; 0 is perfect, 100 is failure.
    Performance,
    /// How hard the trainee had to work.
    Effort,
    /// How irritated, discouraged or annoyed the trainee felt.
    Frustration,
}

impl OverallItem {
    /// All statements in questionnaire order.
    pub const ALL: [Self; 3] = [Self::TimePressure, Self::Frustration, Self::Feedback];

    /// Returns the key used in files and forms.
    #[must_use]
    pub fn key(self) -> &'static str {
        match self {
            Self::TimePressure => "time_pressure",
            Self::Frustration => "frustration",
            Self::Feedback => "feedback",
        }
    }
}

impl PhaseAspect {
    /// All statements in questionnaire order.
    pub const ALL: [Self; 3] = [Self::Performance, Self::MentalDemand, Self::PhysicalDemand];

    /// Returns the key used in files and forms.
    #[must_use]
    pub fn key(self) -> &'static str {
        match self {
            Self::Performance => "performance",
            Self::MentalDemand => "mental_demand",
            Self::PhysicalDemand => "physical_demand",
        }
    }
}

impl InspectionPhase {
    /// Returns all phases for a job with these tasks, in flight order.
    #[must_use]
    pub fn all(tasks: &[u32]) -> Vec<Self> {
        let before = [Self::Calibration, Self::TakingOff].into_iter();
        before.chain(tasks.iter().map(|id| Self::Task(*id))).chain([Self::Landing]).collect()
    }
}

impl fmt::Display for InspectionPhase {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Calibration => f.write_str("calibration"),
            Self::TakingOff => f.write_str("taking_off"),
            Self::Task(id) => write!(f, "task_{id}"),
            Self::Landing => f.write_str("landing"),
        }
    }
}

impl QuestionnaireItem {
    /// Returns all questions for a job with these tasks, in questionnaire order: 24 for four tasks.
    #[must_use]
    pub fn all(tasks: &[u32]) -> Vec<Self> {
        let phases = InspectionPhase::all(tasks);
        let by_phase = phases.iter().flat_map(|phase| PhaseAspect::ALL.map(|aspect| Self::Phase(*phase, aspect)));
        OverallItem::ALL.map(Self::Overall).into_iter().chain(by_phase).collect()
    }

    /// Returns the question with this key. Task numbers are not checked against a job.
    #[must_use]
    pub fn from_key(key: &str) -> Option<Self> {
        let Some((phase, aspect)) = key.split_once('.') else {
            return OverallItem::ALL.into_iter().find(|overall| overall.key() == key).map(Self::Overall);
        };
        let aspect = PhaseAspect::ALL.into_iter().find(|known| known.key() == aspect)?;
        let phase = match phase {
            "calibration" => InspectionPhase::Calibration,
            "taking_off" => InspectionPhase::TakingOff,
            "landing" => InspectionPhase::Landing,
            task => InspectionPhase::Task(task.strip_prefix("task_")?.parse().ok()?),
        };
        let item = Self::Phase(phase, aspect);
        // Rejects `task_01`, which would be a second key for the same question.
        (item.to_string() == key).then_some(item)
    }
}

impl fmt::Display for QuestionnaireItem {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Overall(overall) => f.write_str(overall.key()),
            Self::Phase(phase, aspect) => write!(f, "{phase}.{}", aspect.key()),
        }
    }
}

impl TlxScale {
    /// All scales in questionnaire order.
    pub const ALL: [Self; 6] =
        [Self::MentalDemand, Self::PhysicalDemand, Self::TemporalDemand, Self::Performance, Self::Effort, Self::Frustration];

    /// Returns the key used in files and forms.
    #[must_use]
    pub fn key(self) -> &'static str {
        match self {
            Self::MentalDemand => "mental_demand",
            Self::PhysicalDemand => "physical_demand",
            Self::TemporalDemand => "temporal_demand",
            Self::Performance => "performance",
            Self::Effort => "effort",
            Self::Frustration => "frustration",
        }
    }

    /// Returns the scale with this key.
    #[must_use]
    pub fn from_key(key: &str) -> Option<Self> {
        Self::ALL.into_iter().find(|scale| scale.key() == key)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn exact_tasbid_job_has_24_questions_with_unique_keys() {
        let items = QuestionnaireItem::all(&[1, 2, 3, 4]);
        assert_eq!(items.len(), 24);
        for item in &items {
            assert_eq!(QuestionnaireItem::from_key(&item.to_string()), Some(*item));
        }
        assert_eq!(items[0].to_string(), "time_pressure");
        assert_eq!(items[23].to_string(), "landing.physical_demand");
        for bad in ["", "task_1", "task_.performance", "task_01.performance", "landing.effort", "performance"] {
            assert_eq!(QuestionnaireItem::from_key(bad), None, "{bad}");
        }
    }
}
