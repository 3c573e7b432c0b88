//! The TASBID paper's causal model: demand increases strain, strain decreases performance, and helpful feedback during
//! the task moderates the effect of demand on strain. It consists of two regressions on the first sessions. The
//! indirect effect's confidence interval is bootstrapped over trainees (moderated mediation: Preacher, Rucker and Hayes
//! 2007).

use super::answers::measured_pct;
use super::limitation::Limitation;
use super::sample_sizes::RECOMMENDED_RESPONDENTS;
use crate::record::SessionRecord;
use crate::statistics::{Regression, StatisticsError, least_squares, mean, quantile, sd, solve};
use serde::Serialize;
use spandrel_model::random::RandomStream;

/// Maximum number of bootstrap samples.
const MAX_RESAMPLES: usize = 2_000;
/// Minimum number of bootstrap samples, used for large cohorts, for which more samples would take seconds.
const MIN_RESAMPLES: usize = 200;
/// Maximum total number of trainees drawn across all bootstrap samples.
const MAX_DRAWN_TRAINEES: usize = 1_000_000;
/// Fixed seed that makes the bootstrap reproducible.
const BOOTSTRAP_SEED: u64 = 20_221;
/// Range of the feedback rating scale.
const ANSWER_RANGE: [f64; 2] = [1.0, 5.0];

/// An estimated moderated mediation model.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct MediationModel {
    /// Number of trainees with complete answers.
    pub n: usize,
    /// Regression of strain on demand, feedback and their product; demand and feedback are mean-centered.
    pub strain: Regression,
    /// Regression of performance (overall score, % of the maximum) on strain and demand.
    pub performance: Regression,
    /// Indirect effect of demand on performance through strain, percentage points per unit of demand: for low feedback (mean
    /// minus one standard deviation), mean feedback, and high feedback (mean plus one standard deviation). Feedback is clamped to
    /// the answer scale.
    pub indirect: [IndirectEffect; 3],
    /// Change in the indirect effect per unit of feedback (index of moderated mediation).
    pub moderation: IndirectEffect,
    /// Number of bootstrap samples in which the model could be estimated.
    pub resamples: usize,
}

/// An indirect effect with its confidence interval.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
pub struct IndirectEffect {
    /// Feedback value at which the effect applies, 1 to 5; the mean for the moderation.
    pub feedback: f64,
    /// Estimated value.
    pub effect: f64,
    /// 95% bootstrap confidence interval; `None` if too few samples could be estimated.
    pub interval_95: Option<[f64; 2]>,
}

struct Respondent {
    demand: f64,
    strain: f64,
    feedback: f64,
    performance: f64,
}

/// Estimates the model and appends its limitations.
pub fn causal(first_sessions: &[&SessionRecord], limitations: &mut Vec<Limitation>) -> Option<MediationModel> {
    let people: Vec<Respondent> = first_sessions.iter().filter_map(|record| respondent(record)).collect();
    let n = people.len();
    if n < RECOMMENDED_RESPONDENTS {
        limitations.push(Limitation::FewAnswers(n));
    }
    match estimate(&people) {
        Ok(model) => Some(model),
        Err((outcome, reason)) => {
            limitations.push(Limitation::NoCausalModel { outcome, reason });
            None
        }
    }
}

fn respondent(record: &SessionRecord) -> Option<Respondent> {
    let scales = record.scales()?;
    let (demand, strain, feedback) = (scales.demand?, scales.strain?, scales.feedback?);
    Some(Respondent { demand, strain, feedback, performance: measured_pct(record) })
}

/// Estimates the model; an error contains the outcome of the failing regression.
fn estimate(people: &[Respondent]) -> Result<MediationModel, (&'static str, StatisticsError)> {
    let column = |pick: fn(&Respondent) -> f64| people.iter().map(pick).collect::<Vec<f64>>();
    let about_mean = |values: Vec<f64>| {
        let middle = mean(&values).unwrap_or_default();
        values.into_iter().map(|value| value - middle).collect::<Vec<f64>>()
    };
    let feedback_raw = column(|person| person.feedback);
    let middle = mean(&feedback_raw).unwrap_or_default();
    let spread = sd(&feedback_raw).unwrap_or_default();
    let (demand, feedback) = (about_mean(column(|person| person.demand)), about_mean(feedback_raw));
    let product: Vec<f64> = demand.iter().zip(&feedback).map(|(demand, feedback)| demand * feedback).collect();
    let (strain, performance) = (column(|person| person.strain), column(|person| person.performance));
    let first = [("demand", demand.as_slice()), ("feedback", feedback.as_slice()), ("demand x feedback", product.as_slice())];
    let on_strain = least_squares(&strain, &first).map_err(|error| ("strain", error))?;
    let second = [("strain", strain.as_slice()), ("demand", demand.as_slice())];
    let on_performance = least_squares(&performance, &second).map_err(|error| ("performance", error))?;
    let estimates = |model: &Regression| model.coefficients.iter().map(|one| one.estimate).collect::<Vec<f64>>();
    let (a, b) = (estimates(&on_strain), estimates(&on_performance));
    let rows: Vec<[f64; 3]> = (0..people.len()).map(|k| [demand[k], feedback[k], product[k]]).collect();
    let second_rows: Vec<[f64; 2]> = (0..people.len()).map(|k| [strain[k], demand[k]]).collect();
    let drawn = resample(&rows, &strain, &second_rows, &performance);
    let places = [-spread, 0.0, spread].map(|at| at.clamp(ANSWER_RANGE[0] - middle, ANSWER_RANGE[1] - middle));
    let indirect = places.map(|at| IndirectEffect {
        feedback: middle + at,
        effect: (a[1] + a[3] * at) * b[1],
        interval_95: interval(drawn.iter().map(|(own, moderated)| own + moderated * at).collect()),
    });
    let moderation = IndirectEffect {
        feedback: middle,
        effect: a[3] * b[1],
        interval_95: interval(drawn.iter().map(|(_, moderated)| *moderated).collect()),
    };
    Ok(MediationModel {
        n: people.len(),
        strain: on_strain,
        performance: on_performance,
        indirect,
        moderation,
        resamples: drawn.len(),
    })
}

/// Returns, for each bootstrap sample, the indirect effect at mean feedback and its change per unit of feedback.
fn resample(rows: &[[f64; 3]], strain: &[f64], second: &[[f64; 2]], performance: &[f64]) -> Vec<(f64, f64)> {
    let n = rows.len();
    let draws = (MAX_DRAWN_TRAINEES / n.max(1)).clamp(MIN_RESAMPLES, MAX_RESAMPLES);
    let mut stream = RandomStream::new(BOOTSTRAP_SEED, "cohort resampling");
    let draw = |_| {
        let mut weights = vec![0u32; n];
        for _ in 0..n {
            weights[stream.below(n)] += 1;
        }
        let a = solve(rows, strain, &weights)?;
        let b = solve(second, performance, &weights)?;
        Some((a[1] * b[1], a[3] * b[1]))
    };
    (0..draws).filter_map(draw).collect()
}

fn interval(mut effects: Vec<f64>) -> Option<[f64; 2]> {
    effects.sort_by(f64::total_cmp);
    let end = |share| quantile(&effects, share);
    (effects.len() >= MIN_RESAMPLES).then(|| end(0.025).zip(end(0.975))).flatten().map(|(low, high)| [low, high])
}
