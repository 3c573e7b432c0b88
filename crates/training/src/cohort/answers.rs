//! Answers of a group: counted by question, and against what was measured.

use super::SessionsByTrainee;
use crate::questionnaire::{InspectionPhase, OverallItem, PhaseAspect, QuestionnaireItem, STRONGLY_AGREE, STRONGLY_DISAGREE};
use crate::record::SessionRecord;
use crate::statistics::{Correlation, quantile, spearman};
use serde::Serialize;

/// Answers up to here agree.
const AGREE: u8 = 2;
/// A self-rating from here on says "done well".
const WELL: f64 = 4.0;

/// One question's answers.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Likert {
    /// Key of the question.
    pub question: String,
    /// Repetition of the group; absent: all first sessions.
    pub repetition: Option<usize>,
    /// From strongly agree to strongly disagree.
    pub counts: [usize; 5],
    /// Answers.
    pub n: usize,
    /// Share that agrees or strongly agrees.
    pub agree: f64,
}

/// Self-rating against measurement, first sessions.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct SelfRating {
    /// People who answered.
    pub people: Vec<SelfRatingPair>,
    /// Spearman's, self-rating with the overall score; absent when it cannot be told.
    pub overall: Option<Correlation>,
    /// By task number: self-rating of the task with the share on its path.
    pub tasks: Vec<(u32, Option<Correlation>)>,
    /// Where the two say the opposite.
    pub contradictions: Vec<Contradiction>,
}

/// One person.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct SelfRatingPair {
    /// Who.
    pub trainee: String,
    /// Mean over the phases, 1 to 5, more is better.
    pub self_rating: f64,
    /// Overall score as a share of what could be had, %.
    pub measured_pct: f64,
}

/// One contradiction.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Contradiction {
    /// Who.
    pub trainee: String,
    /// In words.
    pub words: String,
}

pub fn likert(firsts: &[&SessionRecord], group: &SessionsByTrainee<'_>, repetitions: usize) -> Vec<Likert> {
    let mut rows = count(firsts, None);
    for k in 0..repetitions {
        let records: Vec<&SessionRecord> = group.values().map(|sessions| sessions[k]).collect();
        rows.extend(count(&records, Some(k + 1)));
    }
    rows
}

fn count(records: &[&SessionRecord], repetition: Option<usize>) -> Vec<Likert> {
    let mut tasks: Vec<u32> = records.iter().flat_map(|record| record.task_ids()).collect();
    tasks.sort_unstable();
    tasks.dedup();
    let row = |item: QuestionnaireItem| {
        let mut counts = [0; 5];
        for answer in records.iter().filter_map(|record| record.answers.as_ref()?.given.get(&item)) {
            counts[usize::from((*answer).clamp(STRONGLY_AGREE, STRONGLY_DISAGREE) - STRONGLY_AGREE)] += 1;
        }
        let n: usize = counts.iter().sum();
        let agreeing: usize = counts[..usize::from(AGREE)].iter().sum();
        (n > 0).then(|| Likert { question: item.to_string(), repetition, counts, n, agree: agreeing as f64 / n as f64 })
    };
    QuestionnaireItem::all(&tasks).into_iter().filter_map(row).collect()
}

/// Overall as a share of what could be had, %.
pub fn measured_pct(record: &SessionRecord) -> f64 {
    100.0 * record.scores.overall / record.scores.overall_max
}

pub fn self_rating(firsts: &[&SessionRecord]) -> SelfRating {
    let pair = |record: &&SessionRecord| {
        let self_rating = record.scales()?.self_rating?;
        Some(SelfRatingPair { trainee: record.trainee.clone(), self_rating, measured_pct: measured_pct(record) })
    };
    let people: Vec<SelfRatingPair> = firsts.iter().filter_map(pair).collect();
    let (own, measured): (Vec<f64>, Vec<f64>) = people.iter().map(|pair| (pair.self_rating, pair.measured_pct)).unzip();
    let mut tasks: Vec<u32> = firsts.iter().flat_map(|record| record.task_ids()).collect();
    tasks.sort_unstable();
    tasks.dedup();
    SelfRating {
        overall: spearman(&own, &measured).ok(),
        tasks: tasks.into_iter().map(|id| (id, of_task(firsts, id))).collect(),
        contradictions: contradictions(firsts, &people),
        people,
    }
}

fn of_task(firsts: &[&SessionRecord], id: u32) -> Option<Correlation> {
    let pair = |record: &&SessionRecord| {
        let answer = answer_value(record, QuestionnaireItem::Phase(InspectionPhase::Task(id), PhaseAspect::Performance))?;
        let task = record.tasks.iter().find(|task| task.id == id)?;
        Some((f64::from(STRONGLY_AGREE + STRONGLY_DISAGREE - answer), task.on_path))
    };
    let (own, measured): (Vec<f64>, Vec<f64>) = firsts.iter().filter_map(pair).unzip();
    spearman(&own, &measured).ok()
}

fn answer_value(record: &SessionRecord, item: QuestionnaireItem) -> Option<u8> {
    record.answers.as_ref()?.given.get(&item).copied()
}

/// As the paper's examples: thinks well of a flight among the poorest quarter, or not of one among the best; without time pressure
/// among the slowest, or with it among the quickest.
fn contradictions(firsts: &[&SessionRecord], people: &[SelfRatingPair]) -> Vec<Contradiction> {
    let mut found = Vec::new();
    let ends = |mut values: Vec<f64>| {
        values.sort_by(f64::total_cmp);
        quantile(&values, 0.25).zip(quantile(&values, 0.75))
    };
    if let Some((low, high)) = ends(people.iter().map(|pair| pair.measured_pct).collect()) {
        for pair in people {
            let (own, measured) = (pair.self_rating, pair.measured_pct);
            let words = if own >= WELL && measured < low {
                format!("rates the own performance {own:.1} of 5; measured {measured:.0} %, among the lowest quarter")
            } else if own < WELL && measured > high {
                format!("rates the own performance {own:.1} of 5; measured {measured:.0} %, among the highest quarter")
            } else {
                continue;
            };
            found.push(Contradiction { trainee: pair.trainee.clone(), words });
        }
    }
    if let Some((quick, slow)) = ends(firsts.iter().map(|record| record.seconds).collect()) {
        for record in firsts {
            let Some(answer) = answer_value(record, QuestionnaireItem::Overall(OverallItem::TimePressure)) else { continue };
            let minutes = record.seconds / 60.0;
            let words = if answer <= AGREE && record.seconds > slow {
                format!("felt no time pressure; flew {minutes:.1} min, among the slowest quarter")
            } else if answer > AGREE + 1 && record.seconds < quick {
                format!("felt time pressure; flew {minutes:.1} min, among the quickest quarter")
            } else {
                continue;
            };
            found.push(Contradiction { trainee: record.trainee.clone(), words });
        }
    }
    found
}
