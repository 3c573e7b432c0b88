//! Questionnaire answers compared with measured scores.

use super::super::figure::{figure, legend, scrolling};
use super::lists_individuals::lists_individuals;
use super::pooled;
use crate::cohort::{AnswerDistribution, Cohort};
use crate::questionnaire::{QuestionnaireItem, SHIPPED, read_wording};
use crate::report::formatting;
use crate::report::plots::likert::{LikertQuestion, likert};
use crate::report::table::{Table, TableCell};
use maud::{Markup, html};

/// CSS classes and labels of the five answers.
const ANSWERS: [(&str, &str); 5] = [
    ("answer-1", "strongly agree"),
    ("answer-2", "agree"),
    ("answer-3", "neutral"),
    ("answer-4", "disagree"),
    ("answer-5", "strongly disagree"),
];

/// Renders the Likert charts.
pub fn answers(cohort: &Cohort) -> Markup {
    let key: Vec<(&str, String)> = ANSWERS.iter().map(|(class, words)| (*class, (*words).to_owned())).collect();
    let of = |repetition: Option<usize>| -> Vec<LikertQuestion> {
        let those = cohort.likert.iter().filter(|one| one.repetition == repetition);
        those.map(|one| LikertQuestion { name: question_text(one), counts: one.counts }).collect()
    };
    let later: Vec<(usize, Vec<LikertQuestion>)> =
        (1..=cohort.repetitions).map(|k| (k, of(Some(k)))).filter(|(_, questions)| !questions.is_empty()).collect();
    let first = of(None);
    html! {
        (legend(&key))
        (figure(&format!("All first sessions (up to {} answers)", cohort.trainees), &chart(&first, "Answers from all first sessions")))
        @for (k, questions) in &later {
            details.numbers { summary { "Trainees with repeat sessions: repetition " (k) } (chart(questions, &format!("Answers for repetition {k}"))) }
        }
    }
}

fn chart(questions: &[LikertQuestion], title: &str) -> Markup {
    scrolling(title, &likert(questions, title))
}

/// Returns a question's English text, or its key if it is unknown.
fn question_text(one: &AnswerDistribution) -> String {
    let wording = read_wording(SHIPPED[0].0, SHIPPED[0].1).ok();
    match (QuestionnaireItem::from_key(&one.question), wording) {
        (Some(item), Some(wording)) => {
            let statement = wording.statement(item);
            if matches!(item, QuestionnaireItem::Overall(_)) {
                statement.to_owned()
            } else {
                format!("{}: {statement}", wording.heading(item, |_| String::new()).trim_end_matches([':', ' ']))
            }
        }
        (_, _) => one.question.clone(),
    }
}

/// Renders the comparison of self-ratings with measured scores.
pub fn self_rating(cohort: &Cohort) -> Markup {
    let rating = &cohort.self_rating;
    html! {
        @if let Some(overall) = &rating.overall {
            p { "Spearman correlation between self-rating and overall score: " (formatting::number(overall.r, 2)) ", " (overall.n) " trainees." }
        }
        @if lists_individuals(cohort) {
            @if !rating.contradictions.is_empty() { ul { @for one in &rating.contradictions { li { b { (one.trainee) } ": " (one.words) } } } }
            (self_rating_table(cohort).folded())
        } @else { (pooled::self_rating(cohort)) }
    }
}

fn self_rating_table(cohort: &Cohort) -> Table {
    let people = cohort.self_rating.people.iter();
    let rows = people.map(|one| {
        vec![one.trainee.clone().into(), TableCell::Number(one.self_rating, 2), TableCell::Number(one.measured_pct, 1)]
    });
    Table {
        name: "self_rating",
        caption: "self-rating vs. measured score",
        columns: vec!["trainee", "self-rating (1 to 5)", "measured score (%)"],
        rows: rows.collect(),
    }
}
