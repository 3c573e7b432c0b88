//! The paper's causal model: demand raises strain, strain lowers performance, and helpful in-task feedback softens the first of the two.
//! Two regressions on first sessions; the indirect effect with an interval by resampling people (Preacher, Rucker and Hayes 2007,
//! moderated mediation).

use super::answers::measured_pct;
use crate::record::SessionRecord;
use crate::statistics::{Regression, least_squares, mean, quantile, sd, solve};
use serde::Serialize;
use spandrel_model::random::RandomStream;

/// People for a power of 0.8 with medium effects by percentile resampling (Fritz and MacKinnon 2007); fewer are warned of.
pub const SENSIBLE_N: usize = 78;
/// Draws of people with replacement.
const RESAMPLES: usize = 2_000;
/// Fewest draws, for cohorts so large that more would take seconds.
const RESAMPLES_MIN: usize = 200;
/// People drawn in all, at most.
const DRAWN_MAX: usize = 1_000_000;
/// The resampling is the same in every run.
const SEED: u64 = 20_221;
/// The least and the most that feedback can have helped, as answers go.
const SCALE: [f64; 2] = [1.0, 5.0];

/// The model.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct MediationModel {
    /// People with whole answers.
    pub n: usize,
    /// Strain on demand, feedback and their product; demand and feedback about their means.
    pub strain: Regression,
    /// Performance (overall, % of what could be had) on strain and demand.
    pub performance: Regression,
    /// Points of performance per step of demand through strain: where feedback helped little (a standard deviation below the mean), at
    /// the mean, where it helped much (a standard deviation above); never beyond the scale of answers.
    pub indirect: [IndirectEffect; 3],
    /// How much that effect changes per step of feedback: the moderation itself.
    pub moderation: IndirectEffect,
    /// Draws that could be estimated.
    pub resamples: usize,
}

/// An effect with its interval.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
pub struct IndirectEffect {
    /// Feedback at which it holds, 1 to 5; for the moderation its mean.
    pub feedback: f64,
    /// Estimate.
    pub effect: f64,
    /// 95 %, by resampling; absent when too few draws could be estimated.
    pub interval_95: Option<[f64; 2]>,
}

struct PersonRow {
    demand: f64,
    strain: f64,
    feedback: f64,
    performance: f64,
}

/// Estimates the model; what stands against it is added to the warnings.
pub fn causal(firsts: &[&SessionRecord], warnings: &mut Vec<String>) -> Option<MediationModel> {
    let people: Vec<PersonRow> = firsts.iter().filter_map(|record| person(record)).collect();
    let n = people.len();
    if n < SENSIBLE_N {
        warnings.push(format!(
            "demand, strain, performance: {n} people with whole answers; below {SENSIBLE_N} the model misses medium effects, \
             read it as a description of these people only"
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

/// Of each draw the indirect effect at the mean feedback, and its change per step of feedback.
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
