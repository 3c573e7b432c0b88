//! The causal model section: demand, strain and performance, with feedback as moderator.

use super::super::figure::{figure, scrolling};
use crate::cohort::{Cohort, IndirectEffect, MediationModel, RECOMMENDED_TRAINEES};
use crate::report::formatting;
use crate::report::plots::intervals::{IntervalEstimate, intervals};
use crate::report::plots::path_diagram::{PathEffect, PathEffects, model};
use crate::report::table::{Table, TableCell};
use crate::statistics::{Coefficient, Regression};
use maud::{Markup, html};

/// Renders the section on the causal model.
pub fn causal(cohort: &Cohort) -> Markup {
    html! {
        p { "Does demand increase strain, does strain reduce performance, and does in-flight feedback weaken the effect of demand on strain? Estimated from the first sessions of all trainees who answered the questionnaire." }
        @match &cohort.causal {
            Some(model) => (model_section(model)),
            None => p.caution { "No estimate available: too few trainees answered the questionnaire, or their answers do not vary. At least " (RECOMMENDED_TRAINEES) " trainees with complete answers are recommended." },
        }
    }
}

fn model_section(model_: &MediationModel) -> Markup {
    html! {
        @if model_.n < RECOMMENDED_TRAINEES {
            p.caution { b { (model_.n) " trainees with complete answers." } " With fewer than " (RECOMMENDED_TRAINEES) ", the model can miss medium effects. It describes these trainees only and does not generalize." }
        }
        (figure("Path diagram; dashed arrows mark effects whose 95% confidence interval includes zero", &scrolling("Causal model", &model(&effects(model_), "Demand, strain, performance and feedback"))))
        p.note { "Demand, strain and feedback are rated from 1 to 5; performance is the overall score as a percentage of the maximum." }
        (figure("Indirect effect of one unit of demand on performance via strain, by feedback helpfulness, with 95% confidence intervals", &scrolling("Indirect effects", &intervals(&indirect(model_), "% of overall score per unit of demand", "Indirect effect of demand by feedback helpfulness"))))
        (effects_table(model_).shown())
        (coefficients(model_).folded())
    }
}

fn feedback_level_name(at: usize) -> &'static str {
    ["low feedback", "mean feedback", "high feedback"].get(at).copied().unwrap_or_default()
}

fn indirect(model: &MediationModel) -> Vec<IntervalEstimate> {
    let estimate = |(k, one): (usize, &IndirectEffect)| IntervalEstimate {
        name: format!("{} ({})", feedback_level_name(k), formatting::number(one.feedback, 1)),
        value: one.effect,
        interval: one.interval_95,
    };
    model.indirect.iter().enumerate().map(estimate).collect()
}

fn effects(model: &MediationModel) -> PathEffects {
    PathEffects {
        on_strain: effect(&model.strain, "demand"),
        on_performance: effect(&model.performance, "strain"),
        direct: effect(&model.performance, "demand"),
        moderation: effect(&model.strain, "demand x feedback"),
    }
}

fn effect(regression: &Regression, name: &str) -> PathEffect {
    let Some(one) = regression.coefficients.iter().find(|one| one.name == name) else {
        return PathEffect { label: "–".into(), contains_zero: true };
    };
    let [low, high] = one.interval_95;
    let number = |value: f64| formatting::number(value, 2).replace('-', "−");
    PathEffect {
        label: format!("{} [{}, {}]", number(one.estimate), number(low), number(high)),
        contains_zero: low <= 0.0 && high >= 0.0,
    }
}

fn effects_table(model: &MediationModel) -> Table {
    let ends = |one: &IndirectEffect, k: usize| one.interval_95.map_or(TableCell::Empty, |ends| TableCell::Number(ends[k], 2));
    let row = |name: &str, one: &IndirectEffect| {
        vec![name.into(), TableCell::Number(one.feedback, 2), TableCell::Number(one.effect, 2), ends(one, 0), ends(one, 1)]
    };
    let mut rows: Vec<Vec<TableCell>> =
        model.indirect.iter().enumerate().map(|(k, one)| row(feedback_level_name(k), one)).collect();
    rows.push(row("moderation: change in effect per unit of feedback", &model.moderation));
    Table {
        name: "indirect_effects",
        caption: "indirect effect of demand on performance via strain, with bootstrap confidence intervals",
        columns: vec!["feedback level", "feedback", "effect (%)", "95% CI lower bound", "95% CI upper bound"],
        rows,
    }
}

fn coefficients(model: &MediationModel) -> Table {
    let maybe = |value: Option<f64>, digits: usize| value.map_or(TableCell::Empty, |value| TableCell::Number(value, digits));
    let row = |of: &'static str, one: &Coefficient| {
        vec![
            of.into(),
            one.name.clone().into(),
            TableCell::Number(one.estimate, 3),
            TableCell::Number(one.standard_error, 3),
            maybe(one.t, 2),
            maybe(one.p, 3),
            TableCell::Number(one.interval_95[0], 3),
            TableCell::Number(one.interval_95[1], 3),
        ]
    };
    let of = |name: &'static str, regression: &Regression| {
        regression.coefficients.iter().map(move |one| row(name, one)).collect::<Vec<_>>()
    };
    Table {
        name: "causal_model",
        caption: "coefficients of the two regressions",
        columns: vec!["outcome", "term", "estimate", "standard error", "t", "p", "95% CI lower bound", "95% CI upper bound"],
        rows: [of("strain", &model.strain), of("performance", &model.performance)].concat(),
    }
}
