//! The questionnaire after a session: three statements on the whole and three on each phase (24 for a job of four tasks), answered from
//! 1 (strongly agree, the most positive) to 5 (strongly disagree); and NASA-TLX without weights as an option. The wording is a data
//! file, ready for translation; the keys of the answers are the same in every language.

mod answers;
mod language;
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
/// Steps of a NASA-TLX scale, points.
pub const TLX_STEP: u8 = 5;
/// Upper end of a NASA-TLX scale, points.
pub const TLX_MAX: u8 = 100;

/// What is asked of the whole inspection.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub enum OverallItem {
    /// Without stress for time.
    TimePressure,
    /// Never insecure, irritated, stressed.
    Frustration,
    /// In-task feedback helped.
    Feedback,
}

/// What is asked of each phase.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub enum PhaseAspect {
    /// Done well.
    Performance,
    /// Was easy.
    MentalDemand,
    /// Needed no physical activity.
    PhysicalDemand,
}

/// A phase of the inspection.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub enum InspectionPhase {
    /// Getting ready.
    Calibration,
    /// Taking off.
    TakingOff,
    /// A task, by its number.
    Task(u32),
    /// Landing.
    Landing,
}

/// One question.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub enum QuestionnaireItem {
    /// Of the whole.
    Overall(OverallItem),
    /// Of a phase.
    Phase(InspectionPhase, PhaseAspect),
}

/// One scale of NASA-TLX.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub enum TlxScale {
    /// Thinking.
    MentalDemand,
    /// Body.
    PhysicalDemand,
    /// Pace.
    TemporalDemand,
    /// 0 is perfect, 100 failure.
    Performance,
    /// Work for it.
    Effort,
    /// Annoyance.
    Frustration,
}

impl OverallItem {
    /// In the order of asking.
    pub const ALL: [Self; 3] = [Self::TimePressure, Self::Frustration, Self::Feedback];

    /// Key.
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
    /// In the order of asking.
    pub const ALL: [Self; 3] = [Self::Performance, Self::MentalDemand, Self::PhysicalDemand];

    /// Key.
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
    /// All phases of a job with these tasks, in flying order.
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
    /// All questions of a job with these tasks, in the order of asking: 24 for four tasks.
    #[must_use]
    pub fn all(tasks: &[u32]) -> Vec<Self> {
        let phases = InspectionPhase::all(tasks);
        let by_phase = phases.iter().flat_map(|phase| PhaseAspect::ALL.map(|aspect| Self::Phase(*phase, aspect)));
        OverallItem::ALL.map(Self::Overall).into_iter().chain(by_phase).collect()
    }

    /// The question with this key, of whatever job.
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
        // `task_01` would be a second name of the same question.
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
    /// In the order of asking.
    pub const ALL: [Self; 6] =
        [Self::MentalDemand, Self::PhysicalDemand, Self::TemporalDemand, Self::Performance, Self::Effort, Self::Frustration];

    /// Key.
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

    /// The scale with this key.
    #[must_use]
    pub fn from_key(key: &str) -> Option<Self> {
        Self::ALL.into_iter().find(|scale| scale.key() == key)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn exact_the_papers_job_asks_24_questions_with_keys_of_their_own() {
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
