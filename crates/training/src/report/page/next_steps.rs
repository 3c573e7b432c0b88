//! Recommended next scenarios, based on this session only.

use crate::plan::PlanStep;
use crate::report::Review;
use crate::report::table::{Table, TableCell};
use maud::{Markup, html};

/// Renders the "Next" section of a session report.
pub fn section(review: &Review) -> Markup {
    html! {
        p.note { "Based on this session only. For a plan based on all of a trainee's sessions, run " code { "spandrel plan" } "." }
        ol.steps {
            @for step in &review.next {
                li {
                    b { (step.scenario) }
                    @if let Some(level) = &step.level { p { (level.words) } }
                    ul { @for reason in &step.reasons { li { @if reason.consequence_of.is_some() { "Consequence: " } (reason.words) } } }
                }
            }
        }
        (table(&review.next).folded())
    }
}

fn table(steps: &[PlanStep]) -> Table {
    let rows = steps.iter().flat_map(|step| step.reasons.iter().map(move |reason| (step, reason)));
    let row = |(step, reason): (&PlanStep, &crate::plan::PlanReason)| {
        vec![
            step.scenario.clone().into(),
            step.level.as_ref().map(|level| level.level.to_string()).unwrap_or_default().into(),
            reason.rule.clone().into(),
            reason.consequence_of.clone().unwrap_or_default().into(),
            TableCell::Number(reason.value, 3),
            TableCell::Number(reason.limit, 3),
            TableCell::Number(step.urgency, 2),
            reason.words.clone().into(),
        ]
    };
    Table {
        name: "next",
        caption: "recommended scenarios",
        columns: vec!["scenario", "level", "rule", "consequence of", "measured", "limit", "urgency", "reason"],
        rows: rows.map(row).collect(),
    }
}
