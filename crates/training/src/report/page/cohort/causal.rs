//! The causal model section: demand, strain and performance, with feedback as moderator.

use super::super::figure::{figure, scrolling};
use crate::cohort::{Cohort, IndirectEffect, MediationModel, RECOMMENDED_RESPONDENTS};
use crate::report::formatting;
use crate::report::plots::intervals::{IntervalEstimate, intervals};
use crate::report::plots::path_diagram::{PathEffect, PathEffects, model};
use crate::report::table::{Table, TableCell, folded, shown};
use crate::statistics::{Coefficient, Regression};
use maud::{Markup, html};
use spandrel_text::{Language, text};

/// Renders the section on the causal model.
pub fn causal(cohort: &Cohort, language: Language) -> Markup {
    html! {
        p { (text!(language, "cohort-causal-intro")) }
        @match &cohort.causal {
            Some(model) => (model_section(model, language)),
            None => p.caution { (text!(language, "cohort-causal-none", count = RECOMMENDED_RESPONDENTS)) },
        }
    }
}

fn model_section(model_: &MediationModel, language: Language) -> Markup {
    let diagram = model(&effects(model_), &text!(language, "cohort-causal-diagram-title"), language);
    let axis = text!(language, "cohort-causal-indirect-axis");
    let indirect = intervals(&indirect(model_, language), &axis, &text!(language, "cohort-causal-indirect-title"));
    html! {
        @if model_.n < RECOMMENDED_RESPONDENTS {
            p.caution {
                b { (text!(language, "cohort-causal-count", count = model_.n)) } " "
                (text!(language, "cohort-causal-caution", recommended = RECOMMENDED_RESPONDENTS))
            }
        }
        (figure(&text!(language, "cohort-causal-diagram"), &scrolling(&text!(language, "cohort-causal-diagram-region"), &diagram)))
        p.note { (text!(language, "cohort-causal-scales")) }
        (figure(&text!(language, "cohort-causal-indirect"), &scrolling(&text!(language, "cohort-causal-indirect-region"), &indirect)))
        (shown(language, |language| effects_table(model_, language)))
        (folded(language, |language| coefficients(model_, language)))
    }
}

fn feedback_level_name(at: usize, language: Language) -> String {
    match at {
        0 => text!(language, "cohort-causal-low"),
        1 => text!(language, "cohort-causal-mean"),
        _ => text!(language, "cohort-causal-high"),
    }
}

fn indirect(model: &MediationModel, language: Language) -> Vec<IntervalEstimate> {
    let name = |k: usize, feedback: f64| {
        let level = feedback_level_name(k, language);
        text!(language, "cohort-causal-level", level = level, feedback = formatting::number(feedback, 1))
    };
    let estimate = |(k, one): (usize, &IndirectEffect)| IntervalEstimate {
        name: name(k, one.feedback),
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

fn effects_table(model: &MediationModel, language: Language) -> Table {
    let ends = |one: &IndirectEffect, k: usize| one.interval_95.map_or(TableCell::Empty, |ends| TableCell::Number(ends[k], 2));
    let row = |name: String, one: &IndirectEffect| {
        vec![name.into(), TableCell::Number(one.feedback, 2), TableCell::Number(one.effect, 2), ends(one, 0), ends(one, 1)]
    };
    let mut rows: Vec<Vec<TableCell>> =
        model.indirect.iter().enumerate().map(|(k, one)| row(feedback_level_name(k, language), one)).collect();
    rows.push(row(text!(language, "cohort-causal-moderation"), &model.moderation));
    Table {
        name: "indirect_effects",
        caption: text!(language, "cohort-causal-effects-caption"),
        columns: vec![
            text!(language, "cohort-column-feedback-level"),
            text!(language, "cohort-column-feedback"),
            text!(language, "cohort-column-effect"),
            text!(language, "cohort-column-ci-lower"),
            text!(language, "cohort-column-ci-upper"),
        ],
        rows,
    }
}

/// Returns the display name of a variable in the regressions.
fn term_label(term: &str, language: Language) -> String {
    match term {
        "intercept" => text!(language, "cohort-term-intercept"),
        "demand" => text!(language, "cohort-term-demand"),
        "strain" => text!(language, "cohort-term-strain"),
        "feedback" => text!(language, "cohort-column-feedback"),
        "demand x feedback" => text!(language, "cohort-term-interaction"),
        "performance" => text!(language, "cohort-term-performance"),
        other => other.to_owned(),
    }
}

fn coefficients(model: &MediationModel, language: Language) -> Table {
    let maybe = |value: Option<f64>, digits: usize| value.map_or(TableCell::Empty, |value| TableCell::Number(value, digits));
    let row = |of: &'static str, one: &Coefficient| {
        vec![
            term_label(of, language).into(),
            term_label(&one.name, language).into(),
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
        caption: text!(language, "cohort-causal-coefficients-caption"),
        columns: vec![
            text!(language, "cohort-column-outcome"),
            text!(language, "cohort-column-term"),
            text!(language, "cohort-column-estimate"),
            text!(language, "cohort-column-standard-error"),
            "t".to_owned(),
            "p".to_owned(),
            text!(language, "cohort-column-ci-lower"),
            text!(language, "cohort-column-ci-upper"),
        ],
        rows: [of("strain", &model.strain), of("performance", &model.performance)].concat(),
    }
}
