//! The paper's causal model: demand increases strain, strain decreases performance, and helpful in-task feedback moderates the
//! effect of demand on strain. Two regressions on first sessions; the interval of the indirect effect comes from bootstrapping
//! over trainees (Preacher, Rucker and Hayes 2007, moderated mediation).

use super::answers::measured_pct;
use crate::record::SessionRecord;
use crate::statistics::{Regression, least_squares, mean, quantile, sd, solve};
use serde::Serialize;
use spandrel_model::random::RandomStream;

/// Sample size for a power of 0.8 with medium effects and percentile bootstrap (Fritz and MacKinnon 2007). Smaller samples
/// produce a warning.
pub const SENSIBLE_N: usize = 78;
/// Number of bootstrap samples.
const RESAMPLES: usize = 2_000;
/// Minimum number of bootstrap samples, for cohorts so large that more would take seconds.
const RESAMPLES_MIN: usize = 200;
/// Maximum number of trainees drawn over all bootstrap samples.
const DRAWN_MAX: usize = 1_000_000;
/// Fixed seed, so that the bootstrap is reproducible.
const SEED: u64 = 20_221;
/// Range of the feedback scale.
const SCALE: [f64; 2] = [1.0, 5.0];

/// Estimated moderated mediation model.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct MediationModel {
    /// Number of trainees with complete answers.
    pub n: usize,
    /// Regression of strain on demand, feedback and their product; demand and feedback are mean-centered.
    pub strain: Regression,
    /// Regression of performance (overall, % of the maximum) on strain and demand.
    pub performance: Regression,
    /// Indirect effect of demand on performance through strain, points per unit of demand: at low feedback (one standard
    /// deviation below the mean), at the mean, and at high feedback (one standard deviation above); clamped to the answer scale.
    pub indirect: [IndirectEffect; 3],
    /// Change of the indirect effect per unit of feedback (index of moderated mediation).
    pub moderation: IndirectEffect,
    /// Number of bootstrap samples that could be estimated.
    pub resamples: usize,
}

/// An indirect effect with its interval.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
pub struct IndirectEffect {
    /// Feedback value at which the effect applies, 1 to 5; for the moderation, the mean.
    pub feedback: f64,
    /// Point estimate.
    pub effect: f64,
    /// 95 % bootstrap interval; `None` if too few samples could be estimated.
    pub interval_95: Option<[f64; 2]>,
}

struct PersonRow {
    demand: f64,
    strain: f64,
    feedback: f64,
    performance: f64,
}

/// Estimates the model. Adds reasons for caution to `warnings`.
pub fn causal(firsts: &[&SessionRecord], warnings: &mut Vec<String>) -> Option<MediationModel> {
    let people: Vec<PersonRow> = firsts.iter().filter_map(|record| person(record)).collect();
    let n = people.len();
    if n < SENSIBLE_N {
        warnings.push(format!(
            "demand, strain, performance: {n} trainees with complete answers; with fewer than {SENSIBLE_N} the model misses medium effects, \
             so it only describes these trainees"
        ));
    }
    match estimate(&people) {
        Ok(model) => Some(model),
        Err(why) => {
            warnings.push(format!("demand, strain, performance: no estimate: {why}"));
            None
        }
    }
}

fn person(record: &SessionRecord) -> Option<PersonRow> {
    let scales = record.scales()?;
    let (demand, strain, feedback) = (scales.demand?, scales.strain?, scales.feedback?);
    Some(PersonRow { demand, strain, feedback, performance: measured_pct(record) })
}

fn estimate(people: &[PersonRow]) -> Result<MediationModel, String> {
    let column = |pick: fn(&PersonRow) -> f64| people.iter().map(pick).collect::<Vec<f64>>();
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
    let on_strain = least_squares(&strain, &first).map_err(|error| format!("strain: {error}"))?;
    let second = [("strain", strain.as_slice()), ("demand", demand.as_slice())];
    let on_performance = least_squares(&performance, &second).map_err(|error| format!("performance: {error}"))?;
    let estimates = |model: &Regression| model.coefficients.iter().map(|one| one.estimate).collect::<Vec<f64>>();
    let (a, b) = (estimates(&on_strain), estimates(&on_performance));
    let rows: Vec<[f64; 3]> = (0..people.len()).map(|k| [demand[k], feedback[k], product[k]]).collect();
    let second_rows: Vec<[f64; 2]> = (0..people.len()).map(|k| [strain[k], demand[k]]).collect();
    let drawn = resample(&rows, &strain, &second_rows, &performance);
    let places = [-spread, 0.0, spread].map(|at| at.clamp(SCALE[0] - middle, SCALE[1] - middle));
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

/// Returns, for each bootstrap sample, the indirect effect at the mean feedback and its change per unit of feedback.
fn resample(rows: &[[f64; 3]], strain: &[f64], second: &[[f64; 2]], performance: &[f64]) -> Vec<(f64, f64)> {
    let n = rows.len();
    let draws = (DRAWN_MAX / n.max(1)).clamp(RESAMPLES_MIN, RESAMPLES);
    let mut stream = RandomStream::new(SEED, "cohort resampling");
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
    (effects.len() >= RESAMPLES_MIN).then(|| end(0.025).zip(end(0.975))).flatten().map(|(low, high)| [low, high])
}
