//! Scale scores computed from the answers, as used in TASBID's causal model: demand, strain, feedback and self-rating.

use super::{Answers, InspectionPhase, OverallItem, PhaseAspect, QuestionnaireItem, STRONGLY_AGREE, STRONGLY_DISAGREE, TlxScale};
use serde::{Deserialize, Serialize};

/// Scale scores from 1 to 5. A higher value means more of the quality that the scale is named after. A scale is present
/// if at least half of its questions were answered.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct ScaleScores {
    /// Mean mental demand over the phases.
    pub mental_demand: Option<f64>,
    /// Mean physical demand over the phases.
    pub physical_demand: Option<f64>,
    /// Mean of mental and physical demand; the causal factors in the TASBID paper.
    pub demand: Option<f64>,
    /// Mean of time pressure and frustration; the psychological states in the TASBID paper.
    pub strain: Option<f64>,
    /// Helpfulness of in-task feedback; the moderator in the TASBID paper.
    pub feedback: Option<f64>,
    /// Mean self-rated performance over the phases.
    pub self_rating: Option<f64>,
}

/// Computes the scale scores of one session.
#[must_use]
pub fn scales(answers: &Answers, tasks: &[u32]) -> ScaleScores {
    let of = |aspects: &[PhaseAspect]| {
        let phases = InspectionPhase::all(tasks);
        let items = phases.iter().flat_map(|phase| aspects.iter().map(|aspect| QuestionnaireItem::Phase(*phase, *aspect)));
        average(answers, items.collect())
    };
    let whole = |which: &[OverallItem]| average(answers, which.iter().map(|one| QuestionnaireItem::Overall(*one)).collect());
    // Disagreeing with a demand or strain statement means a high value. Feedback and performance statements are worded
    // the other way around, so their values are reversed here.
    let affirmed = |mean: f64| f64::from(STRONGLY_AGREE + STRONGLY_DISAGREE) - mean;
    ScaleScores {
        mental_demand: of(&[PhaseAspect::MentalDemand]),
        physical_demand: of(&[PhaseAspect::PhysicalDemand]),
        demand: of(&[PhaseAspect::MentalDemand, PhaseAspect::PhysicalDemand]),
        strain: whole(&[OverallItem::TimePressure, OverallItem::Frustration]),
        feedback: whole(&[OverallItem::Feedback]).map(affirmed),
        self_rating: of(&[PhaseAspect::Performance]).map(affirmed),
    }
}

fn average(answers: &Answers, items: Vec<QuestionnaireItem>) -> Option<f64> {
    let given: Vec<f64> = items.iter().filter_map(|item| answers.given.get(item)).map(|answer| f64::from(*answer)).collect();
    (!given.is_empty() && 2 * given.len() >= items.len()).then(|| given.iter().sum::<f64>() / given.len() as f64)
}

/// Returns the unweighted NASA-TLX score: the mean of its six scales, 0 to 100; `None` unless all six are answered.
#[must_use]
pub fn raw_tlx(answers: &Answers) -> Option<f64> {
    let given: Option<Vec<f64>> =
        TlxScale::ALL.iter().map(|scale| answers.tlx.get(scale).map(|value| f64::from(*value))).collect();
    given.map(|values| values.iter().sum::<f64>() / values.len() as f64)
}

#[cfg(test)]
mod tests {
    use super::*;

    const TASKS: [u32; 4] = [1, 2, 3, 4];

    #[test]
    fn exact_scale_directions_match_their_names() {
        let mut answers = Answers::default();
        for item in QuestionnaireItem::all(&TASKS) {
            answers.given.insert(item, STRONGLY_AGREE);
        }
        let best = scales(&answers, &TASKS);
        assert_eq!((best.demand, best.strain, best.feedback, best.self_rating), (Some(1.0), Some(1.0), Some(5.0), Some(5.0)));
        answers.given.insert(QuestionnaireItem::Phase(InspectionPhase::Task(3), PhaseAspect::MentalDemand), 5);
        let told = scales(&answers, &TASKS);
        assert_eq!(told.mental_demand, Some(11.0 / 7.0));
        assert_eq!(told.demand, Some(18.0 / 14.0));
        assert_eq!(told.physical_demand, Some(1.0));
    }

    #[test]
    fn exact_scale_requires_half_of_its_answers() {
        let mut answers = Answers::default();
        answers.given.insert(QuestionnaireItem::Overall(OverallItem::TimePressure), 4);
        let told = scales(&answers, &TASKS);
        assert_eq!((told.strain, told.feedback, told.self_rating), (Some(4.0), None, None));
        for phase in [InspectionPhase::Calibration, InspectionPhase::TakingOff, InspectionPhase::Landing] {
            answers.given.insert(QuestionnaireItem::Phase(phase, PhaseAspect::Performance), 2);
        }
        assert_eq!(scales(&answers, &TASKS).self_rating, None, "three of seven answers are too few");
        answers.given.insert(QuestionnaireItem::Phase(InspectionPhase::Task(1), PhaseAspect::Performance), 2);
        assert_eq!(scales(&answers, &TASKS).self_rating, Some(4.0));
    }

    #[test]
    fn exact_raw_tlx_is_mean_of_six_scales() {
        let mut answers = Answers::default();
        for (scale, value) in TlxScale::ALL.into_iter().zip([10, 20, 30, 40, 50, 90]) {
            assert_eq!(raw_tlx(&answers), None);
            answers.tlx.insert(scale, value);
        }
        assert_eq!(raw_tlx(&answers), Some(40.0));
    }
}
