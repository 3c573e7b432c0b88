//! Recommended next scenarios, based on this session only.

use crate::plan::{PlanReason, PlanStep, rule_title};
use crate::report::Review;
use crate::report::table::{Table, TableCell, folded};
use crate::terms::job_title;
use maud::{Markup, html};
use spandrel_text::{Language, text};

/// Renders the "Next" section of a session report.
pub fn section(review: &Review) -> Markup {
    let language = review.metadata.language;
    html! {
        p.note { (text!(language, "report-next-note")) }
        ol.steps {
            @for step in &review.next {
                li {
                    b { (job_title(&step.scenario, language)) }
                    @if let Some(level) = &step.level { p { (level.words) } }
                    ul { @for reason in &step.reasons { li { (reason_words(reason, language)) } } }
                }
            }
        }
        (folded(language, |language| table(&review.next, language)))
    }
}

fn reason_words(reason: &PlanReason, language: Language) -> String {
    match reason.consequence_of {
        Some(_) => text!(language, "report-next-consequence", reason = reason.words.as_str()),
        None => reason.words.clone(),
    }
}

fn table(steps: &[PlanStep], language: Language) -> Table {
    let rows = steps.iter().flat_map(|step| step.reasons.iter().map(move |reason| (step, reason)));
    let row = |(step, reason): (&PlanStep, &PlanReason)| {
        vec![
            step.scenario.clone().into(),
            step.level.as_ref().map(|level| level.level.to_string()).unwrap_or_default().into(),
            rule_title(&reason.rule, language).into(),
            reason.consequence_of.as_deref().map(|rule| rule_title(rule, language)).unwrap_or_default().into(),
            TableCell::Number(reason.value, 3),
            TableCell::Number(reason.limit, 3),
            TableCell::Number(step.urgency, 2),
            reason.words.clone().into(),
        ]
    };
    Table {
        name: "next",
        caption: text!(language, "report-next-caption"),
        columns: vec![
            text!(language, "report-column-scenario"),
            text!(language, "report-column-level"),
            text!(language, "report-column-rule"),
            text!(language, "report-column-consequence-of"),
            text!(language, "report-column-measured"),
            text!(language, "report-column-limit"),
            text!(language, "report-column-urgency"),
            text!(language, "report-column-reason"),
        ],
        rows: rows.map(row).collect(),
    }
}
