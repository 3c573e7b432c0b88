//! Questionnaire answers compared with measured scores.

use super::super::figure::{figure, legend, scrolling};
use super::lists_individuals::lists_individuals;
use super::pooled;
use crate::cohort::{AnswerDistribution, Cohort};
use crate::questionnaire::{QuestionnaireItem, SHIPPED, read_wording};
use crate::report::formatting;
use crate::report::plots::likert::{LikertQuestion, likert};
use crate::report::table::{Table, TableCell, folded};
use maud::{Markup, html};
use spandrel_text::{Language, text};

/// Returns the CSS classes and labels of the five answers.
fn answer_legend(language: Language) -> [(&'static str, String); 5] {
    [
        ("answer-1", text!(language, "cohort-answer-strongly-agree")),
        ("answer-2", text!(language, "cohort-answer-agree")),
        ("answer-3", text!(language, "cohort-answer-neutral")),
        ("answer-4", text!(language, "cohort-answer-disagree")),
        ("answer-5", text!(language, "cohort-answer-strongly-disagree")),
    ]
}

/// Renders the Likert charts.
pub fn answers(cohort: &Cohort, language: Language) -> Markup {
    let of = |repetition: Option<usize>| -> Vec<LikertQuestion> {
        let those = cohort.likert.iter().filter(|one| one.repetition == repetition);
        those.map(|one| LikertQuestion { name: question_text(one, language), counts: one.counts }).collect()
    };
    let later: Vec<(usize, Vec<LikertQuestion>)> =
        (1..=cohort.repetitions).map(|k| (k, of(Some(k)))).filter(|(_, questions)| !questions.is_empty()).collect();
    let first = of(None);
    let caption = text!(language, "cohort-answers-first", count = cohort.trainees);
    html! {
        (legend(&answer_legend(language)))
        (figure(&caption, &chart(&first, &text!(language, "cohort-answers-first-title"))))
        @for (k, questions) in &later {
            details.numbers {
                summary { (text!(language, "cohort-answers-later", repetition = *k)) }
                (chart(questions, &text!(language, "cohort-answers-later-title", repetition = *k)))
            }
        }
    }
}

fn chart(questions: &[LikertQuestion], title: &str) -> Markup {
    scrolling(title, &likert(questions, title))
}

/// Returns a question's text, or its key if it is unknown.
fn question_text(one: &AnswerDistribution, language: Language) -> String {
    let file = format!("{}.toml", language.tag());
    let (name, wording) = SHIPPED.into_iter().find(|(name, _)| *name == file).unwrap_or(SHIPPED[0]);
    let wording = read_wording(name, wording).ok();
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
pub fn self_rating(cohort: &Cohort, language: Language) -> Markup {
    let rating = &cohort.self_rating;
    html! {
        @if let Some(overall) = &rating.overall {
            p { (text!(language, "cohort-self-rating-correlation", correlation = formatting::number(overall.r, 2), trainees = overall.n)) }
        }
        @if lists_individuals(cohort) {
            @if !rating.contradictions.is_empty() { ul { @for one in &rating.contradictions { li { b { (one.trainee) } ": " (one.kind.words(language)) } } } }
            (folded(language, |language| self_rating_table(cohort, language)))
        } @else { (pooled::self_rating(cohort, language)) }
    }
}

fn self_rating_table(cohort: &Cohort, language: Language) -> Table {
    let people = cohort.self_rating.people.iter();
    let rows = people.map(|one| {
        vec![one.trainee.clone().into(), TableCell::Number(one.self_rating, 2), TableCell::Number(one.measured_pct, 1)]
    });
    Table {
        name: "self_rating",
        caption: text!(language, "cohort-self-rating-caption"),
        columns: vec![
            text!(language, "cohort-column-trainee"),
            text!(language, "cohort-column-self-rating-scale"),
            text!(language, "cohort-column-measured"),
        ],
        rows: rows.collect(),
    }
}
