//! A cohort's questionnaire answers: answer counts per question and a comparison with measured scores.

use super::contradiction::{Contradiction, ContradictionKind};
use super::reliability::{MeasureReliability, reliability_of};
use super::samples::{FLIGHT_TIME, OVERALL, SessionsByTrainee};
use crate::questionnaire::{InspectionPhase, OverallItem, PhaseAspect, QuestionnaireItem, STRONGLY_AGREE, STRONGLY_DISAGREE};
use crate::record::SessionRecord;
use crate::statistics::{Correlation, quantile, spearman};
use serde::Serialize;
use spandrel_monitor::session::EndReason;

/// Highest answer that counts as agreement.
const MAX_AGREEING_ANSWER: u8 = 2;
/// Lowest mean self-rating that counts as a good performance.
const MIN_GOOD_SELF_RATING: f64 = 4.0;
/// Smallest difference of scores that a contradiction's text shows, %.
const PRINTED_SCORE_PCT: f64 = 1.0;
/// Smallest difference of flight times that a contradiction's text shows, s (0.1 min).
const PRINTED_TIME_S: f64 = 6.0;

/// Answer distribution for one question.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct AnswerDistribution {
    /// Question key.
    pub question: String,
    /// The group's repetition, from 1; `None` for all first sessions.
    pub repetition: Option<usize>,
    /// Answer counts from strongly agree to strongly disagree.
    pub counts: [usize; 5],
    /// Number of answers.
    pub n: usize,
    /// Fraction of "agree" and "strongly agree" answers, 0 to 1.
    pub agree: f64,
}

/// Self-ratings compared with measured scores in the first sessions.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct SelfRating {
    /// One entry per trainee who rated their performance.
    pub people: Vec<SelfRatingPair>,
    /// Spearman correlation between self-rating and overall score; `None` if undefined.
    pub overall: Option<Correlation>,
    /// For each task number, the correlation between the task's self-rating and its on-path share.
    pub tasks: Vec<(u32, Option<Correlation>)>,
    /// Contradictions between self-ratings and measured scores.
    pub contradictions: Vec<Contradiction>,
}

/// One trainee's self-rating and measured score.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct SelfRatingPair {
    /// Trainee's pseudonym.
    pub trainee: String,
    /// Mean over the phases, 1 to 5; higher is better.
    pub self_rating: f64,
    /// Overall score, % of the maximum.
    pub measured_pct: f64,
}

pub fn likert(first_sessions: &[&SessionRecord], group: &SessionsByTrainee<'_>, repetitions: usize) -> Vec<AnswerDistribution> {
    let mut rows = count(first_sessions, None);
    for k in 0..repetitions {
        let records: Vec<&SessionRecord> = group.values().map(|sessions| sessions[k]).collect();
        rows.extend(count(&records, Some(k + 1)));
    }
    rows
}

fn count(records: &[&SessionRecord], repetition: Option<usize>) -> Vec<AnswerDistribution> {
    let mut tasks: Vec<u32> = records.iter().flat_map(|record| record.task_ids()).collect();
    tasks.sort_unstable();
    tasks.dedup();
    let row = |item: QuestionnaireItem| {
        let mut counts = [0; 5];
        for answer in records.iter().filter_map(|record| record.answers.as_ref()?.given.get(&item)) {
            counts[usize::from((*answer).clamp(STRONGLY_AGREE, STRONGLY_DISAGREE) - STRONGLY_AGREE)] += 1;
        }
        let n: usize = counts.iter().sum();
        let agreeing: usize = counts[..usize::from(MAX_AGREEING_ANSWER)].iter().sum();
        (n > 0).then(|| AnswerDistribution {
            question: item.to_string(),
            repetition,
            counts,
            n,
            agree: agreeing as f64 / n as f64,
        })
    };
    QuestionnaireItem::all(&tasks).into_iter().filter_map(row).collect()
}

/// Returns the overall score as a percentage of the maximum.
pub fn measured_pct(record: &SessionRecord) -> f64 {
    100.0 * record.scores.overall / record.scores.overall_max
}

pub fn self_rating(first_sessions: &[&SessionRecord], reliability: &[MeasureReliability]) -> SelfRating {
    let pair = |record: &&SessionRecord| {
        let self_rating = record.scales()?.self_rating?;
        Some(SelfRatingPair { trainee: record.trainee.clone(), self_rating, measured_pct: measured_pct(record) })
    };
    let people: Vec<SelfRatingPair> = first_sessions.iter().filter_map(pair).collect();
    let (own, measured): (Vec<f64>, Vec<f64>) = people.iter().map(|pair| (pair.self_rating, pair.measured_pct)).unzip();
    let mut tasks: Vec<u32> = first_sessions.iter().flat_map(|record| record.task_ids()).collect();
    tasks.sort_unstable();
    tasks.dedup();
    SelfRating {
        overall: spearman(&own, &measured).ok(),
        tasks: tasks.into_iter().map(|id| (id, task_correlation(first_sessions, id))).collect(),
        contradictions: contradictions(first_sessions, &people, reliability),
        people,
    }
}

fn task_correlation(first_sessions: &[&SessionRecord], id: u32) -> Option<Correlation> {
    let pair = |record: &&SessionRecord| {
        let answer = answer_value(record, QuestionnaireItem::Phase(InspectionPhase::Task(id), PhaseAspect::Performance))?;
        let task = record.tasks.iter().find(|task| task.id == id)?;
        Some((f64::from(STRONGLY_AGREE + STRONGLY_DISAGREE - answer), task.on_path))
    };
    let (own, measured): (Vec<f64>, Vec<f64>) = first_sessions.iter().filter_map(pair).unzip();
    spearman(&own, &measured).ok()
}

fn answer_value(record: &SessionRecord, item: QuestionnaireItem) -> Option<u8> {
    record.answers.as_ref()?.given.get(&item).copied()
}

/// Returns contradictions as defined in the TASBID paper: a high self-rating with a score in the bottom quarter, a low
/// self-rating with a score in the top quarter, no time pressure despite one of the slowest flights, or time pressure
/// despite one of the fastest; only flights that ended by a landing are compared in time. A value counts as low or high only
/// if it also differs from the median by more than the measure's error and by at least one unit of its last printed digit:
/// in a cohort whose values are practically equal, nobody is slow.
fn contradictions(
    first_sessions: &[&SessionRecord],
    people: &[SelfRatingPair],
    reliability: &[MeasureReliability],
) -> Vec<Contradiction> {
    let mut found = Vec::new();
    let error = |measure: &str| reliability_of(reliability, measure)?.reliability.map(|one| one.minimal_detectable_change);
    let ends = |mut values: Vec<f64>, margin: f64| {
        values.sort_by(f64::total_cmp);
        let [low, median, high] = [0.25, 0.5, 0.75].map(|share| quantile(&values, share));
        let median = median?;
        Some((low?.min(median - margin), high?.max(median + margin)))
    };
    let overall_max = first_sessions.first().map_or(f64::INFINITY, |record| record.scores.overall_max);
    let score_margin = error(OVERALL.0).map_or(0.0, |points| 100.0 * points / overall_max).max(PRINTED_SCORE_PCT);
    if let Some((low, high)) = ends(people.iter().map(|pair| pair.measured_pct).collect(), score_margin) {
        for pair in people {
            let (own, measured) = (pair.self_rating, pair.measured_pct);
            let kind = if own >= MIN_GOOD_SELF_RATING && measured < low {
                ContradictionKind::RatedTooHigh { own, measured_pct: measured }
            } else if own < MIN_GOOD_SELF_RATING && measured > high {
                ContradictionKind::RatedTooLow { own, measured_pct: measured }
            } else {
                continue;
            };
            found.push(Contradiction { trainee: pair.trainee.clone(), kind });
        }
    }
    let time_margin = error(FLIGHT_TIME).unwrap_or_default().max(PRINTED_TIME_S);
    // A flight that ended in a crash or by an abort is short, but not fast.
    let landed: Vec<&SessionRecord> =
        first_sessions.iter().copied().filter(|record| record.end_reason == EndReason::Landed.label()).collect();
    if let Some((quick, slow)) = ends(landed.iter().map(|record| record.seconds).collect(), time_margin) {
        for record in landed {
            let Some(answer) = answer_value(record, QuestionnaireItem::Overall(OverallItem::TimePressure)) else { continue };
            let time_s = record.seconds;
            let kind = if answer <= MAX_AGREEING_ANSWER && record.seconds > slow {
                ContradictionKind::SlowWithoutPressure { time_s }
            } else if answer > MAX_AGREEING_ANSWER + 1 && record.seconds < quick {
                ContradictionKind::FastUnderPressure { time_s }
            } else {
                continue;
            };
            found.push(Contradiction { trainee: record.trainee.clone(), kind });
        }
    }
    found
}
