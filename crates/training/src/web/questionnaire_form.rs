//! The questionnaire as a web form. A small script saves every answer immediately, so users can stop at any time and
//! continue later. Without the script, users save with the button.

use super::access::Visitor;
use super::assets;
use super::layout::{message, page_in_language, token};
use crate::questionnaire::{
    Answers, InspectionPhase, OverallItem, PhaseAspect, QuestionnaireItem, STRONGLY_AGREE, STRONGLY_DISAGREE, TLX_MAX, TLX_STEP,
    TlxScale, Wording,
};
use maud::{Markup, html};
use spandrel_text::{Language, text};

/// Prefix of NASA-TLX form fields.
const TLX_FIELD_PREFIX: &str = "tlx.";

/// Content of the form.
#[derive(Debug, Clone, Copy)]
pub struct FormContext<'a> {
    /// Session ID (its folder name).
    pub id: &'a str,
    /// Numbers and names of the session's tasks.
    pub tasks: &'a [(u32, String)],
    /// Texts in the selected language.
    pub wording: &'a Wording,
    /// All available languages.
    pub languages: &'a [Wording],
    /// Answers so far.
    pub answers: &'a Answers,
    /// Whether answers were just saved.
    pub saved: bool,
}

/// Merges a form's answers into the existing ones and returns their number. Ignores fields that are not questions, such
/// as the token.
///
/// # Errors
/// Fails on the first invalid answer, with a message in the language; the caller should then save nothing.
pub fn parse_answers(
    answers: &mut Answers,
    fields: &[(String, String)],
    tasks: &[u32],
    language: Language,
) -> Result<usize, String> {
    let items = QuestionnaireItem::all(tasks);
    let mut taken = 0;
    for (field, value) in fields {
        if let Some(item) = QuestionnaireItem::from_key(field).filter(|item| items.contains(item)) {
            let (least, most) = (STRONGLY_AGREE, STRONGLY_DISAGREE);
            let given = value.parse().ok().filter(|given| (least..=most).contains(given)).ok_or_else(|| {
                text!(language, "people-answer-invalid", field = short(field), value = short(value), least = least, most = most)
            })?;
            answers.given.insert(item, given);
        } else if let Some(scale) = field.strip_prefix(TLX_FIELD_PREFIX).and_then(TlxScale::from_key) {
            if value.is_empty() {
                continue;
            }
            let is_step = |given: &u8| *given <= TLX_MAX && given.is_multiple_of(TLX_STEP);
            let given = value.parse().ok().filter(is_step).ok_or_else(|| {
                let (field, value) = (short(field), short(value));
                let (most, step) = (TLX_MAX, TLX_STEP);
                text!(language, "people-answer-invalid-step", field = field, value = value, least = 0, most = most, step = step)
            })?;
            answers.tlx.insert(scale, given);
        } else {
            continue;
        }
        taken += 1;
    }
    Ok(taken)
}

/// Returns the beginning of a submitted text for a message.
fn short(text: &str) -> String {
    text.chars().filter(|c| !c.is_control()).take(60).collect()
}

/// Renders the questionnaire page.
#[must_use]
pub fn page(visitor: &Visitor, context: &FormContext<'_>) -> Markup {
    let tasks: Vec<u32> = context.tasks.iter().map(|(id, _)| *id).collect();
    let (all, open) = (QuestionnaireItem::all(&tasks).len(), context.answers.open(&tasks).len());
    let overall: Vec<QuestionnaireItem> = OverallItem::ALL.map(QuestionnaireItem::Overall).to_vec();
    let words = &context.wording.form;
    let body = html! {
        (language_selection(context))
        p.lead { (context.wording.introduction) }
        @if context.saved { (message("good", &words.saved)) }
        form.questions method="post" action={ "/sessions/" (context.id) "/questions" } data-save data-answered=(words.answered) data-not-saved=(words.not_saved) {
            (token(visitor))
            input type="hidden" name="language" value=(context.wording.language);
            p.status { span role="status" data-status { (words.answered(all - open, all)) } " · " (words.at_once) }
            (question_group(&context.wording.overall_heading, &overall, context))
            @for phase in InspectionPhase::all(&tasks) {
                (question_group(&phase_name(context, phase), &PhaseAspect::ALL.map(|aspect| QuestionnaireItem::Phase(phase, aspect)), context))
            }
            (workload(context))
            p.tools {
                button type="submit" { (words.save) }
                a href={ "/sessions/" (context.id) } { (words.back) }
            }
        }
    };
    page_in_language(visitor, "/sessions", &context.wording.title, (&context.wording.language, Some(assets::FORM_NAME)), &body)
}

/// Renders the language selection, with each language in its own name. Answers are already saved, so switching
/// languages loses none.
fn language_selection(context: &FormContext<'_>) -> Markup {
    let words = &context.wording.form;
    html! {
        form.inline.languages method="get" action={ "/sessions/" (context.id) "/questions" } {
            label { (words.choose_language) " "
                select name="language" {
                    @for one in context.languages {
                        option value=(one.language) lang=(one.language) selected[one.language == context.wording.language] { (one.language_name) }
                    }
                }
            }
            button type="submit" { (words.change_language) }
        }
    }
}

fn phase_name(context: &FormContext<'_>, phase: InspectionPhase) -> String {
    let name = |id: u32| context.tasks.iter().find(|(task, _)| *task == id).map_or(String::new(), |(_, name)| name.clone());
    context.wording.phase(phase, name)
}

fn question_group(heading: &str, items: &[QuestionnaireItem], context: &FormContext<'_>) -> Markup {
    html! {
        section {
            h2 { (heading) }
            @for item in items { (question(*item, heading, context)) }
        }
    }
}

fn question(item: QuestionnaireItem, heading: &str, context: &FormContext<'_>) -> Markup {
    let given = context.answers.given.get(&item).copied();
    html! {
        fieldset.likert-question data-question {
            legend { (context.wording.statement(item)) span.hidden { " (" (heading) ")" } }
            div.choices {
                @for (k, words) in (STRONGLY_AGREE..=STRONGLY_DISAGREE).zip(&context.wording.scale) {
                    label { input type="radio" name=(item) value=(k) checked[given == Some(k)]; span { (words) } }
                }
            }
        }
    }
}

fn workload(context: &FormContext<'_>) -> Markup {
    html! {
        section {
            details open[!context.answers.tlx.is_empty()] {
                summary { (context.wording.tlx_title) }
                p { (context.wording.tlx_introduction) }
                @for scale in TlxScale::ALL {
                    @let (question, low, high) = context.wording.tlx(scale);
                    label.scale {
                        span { (question) }
                        select name={ (TLX_FIELD_PREFIX) (scale.key()) } {
                            option value="" selected[!context.answers.tlx.contains_key(&scale)] { "–" }
                            @for value in (0..=TLX_MAX).step_by(usize::from(TLX_STEP)) {
                                option value=(value) selected[context.answers.tlx.get(&scale) == Some(&value)] {
                                    (value) @if value == 0 { " " (low) } @else if value == TLX_MAX { " " (high) }
                                }
                            }
                        }
                    }
                }
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::super::layout::tests::{HOSTILE_NAME, administrator, check};
    use super::*;
    use crate::questionnaire::Languages;

    fn fields(pairs: &[(&str, &str)]) -> Vec<(String, String)> {
        pairs.iter().map(|(a, b)| ((*a).to_owned(), (*b).to_owned())).collect()
    }

    #[test]
    fn exact_valid_answers_are_merged_and_invalid_ones_rejected() {
        let mut answers = Answers::default();
        let given = fields(&[
            ("token", "x"),
            ("frustration", "4"),
            ("task_2.performance", "1"),
            ("tlx.effort", "35"),
            ("tlx.frustration", ""),
        ]);
        assert_eq!(parse_answers(&mut answers, &given, &[1, 2], Language::English), Ok(3));
        assert_eq!((answers.given.len(), answers.tlx[&TlxScale::Effort]), (2, 35));
        assert_eq!(
            parse_answers(&mut answers, &fields(&[("task_3.performance", "1")]), &[1, 2], Language::English),
            Ok(0),
            "this session has no such task"
        );
        for (field, value, allowed) in
            [("frustration", "6", "1 to 5"), ("feedback", "<b>", "1 to 5"), ("tlx.effort", "33", "0 to 100 in steps of 5")]
        {
            let wrong = parse_answers(&mut answers, &fields(&[(field, value)]), &[1], Language::English).unwrap_err();
            assert_eq!(wrong, format!("{field} = {value}: invalid answer (allowed: {allowed})"));
        }
    }

    #[test]
    fn exact_form_shows_answers_and_escapes_names() {
        let languages = Languages::with(Vec::new()).unwrap();
        let wording = languages.of("de").unwrap();
        let mut answers = Answers::default();
        answers.given.insert(QuestionnaireItem::Overall(OverallItem::Feedback), 5);
        let tasks = [(1, HOSTILE_NAME.to_owned())];
        let asked = FormContext { id: "s", tasks: &tasks, wording, languages: languages.all(), answers: &answers, saved: true };
        let text = page(&administrator(), &asked).into_string();
        check(&text);
        assert!(text.contains("name=\"feedback\" value=\"5\" checked"), "{text}");
        assert_eq!(text.matches(" checked").count(), 1);
        assert!(text.contains("<html lang=\"de\">") && text.contains("<header class=\"bar\" lang=\"en\">"), "{text}");
        assert!(text.contains("Gespeichert.") && text.contains("lang=\"es\">Español"), "{text}");
        assert_eq!(text.matches("<fieldset").count(), QuestionnaireItem::all(&[1]).len());
    }
}
