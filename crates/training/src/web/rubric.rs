//! A trainee's rubric: criteria with their sign-offs, and the history. Also the page that edits the criteria.

use super::access::{AccessLevel, Visitor};
use super::layout::{counted, message_lines, page, section, table, token, toml_editor};
use crate::rubric::{Rubric, RubricCriterion, SignOffAction, SignOffEvent, current_sign_off};
use maud::{Markup, html};
use spandrel_model::calendar::{day, minute};
use spandrel_text::Language;

/// Maximum length of a note, characters.
pub const MAX_NOTE_LEN: usize = 300;
/// Maximum length of an instructor's name, characters.
pub const MAX_NAME_LEN: usize = 40;

/// Contents of a trainee's rubric page.
#[derive(Debug, Clone, Copy)]
pub struct RubricPage<'a> {
    /// Trainee's pseudonym.
    pub trainee: &'a str,
    /// The criteria.
    pub rubric: &'a Rubric,
    /// Sign-offs and withdrawals in chronological order.
    pub events: &'a [SignOffEvent],
    /// Note that the server's own rubric can't be used; `None` otherwise.
    pub problem: Option<&'a str>,
}

/// Returns the number of criteria signed off, such as "3 of 8 criteria signed off".
#[must_use]
pub fn count_words(rubric: &Rubric, events: &[SignOffEvent]) -> String {
    format!("{} of {} criteria signed off", rubric.signed_off_count(events), rubric.criteria.len())
}

/// Renders a trainee's rubric.
#[must_use]
pub fn rubric_page(visitor: &Visitor, about: &RubricPage<'_>) -> Markup {
    let body = html! {
        p.lead { a href={ "/trainees/" (about.trainee) } { (about.trainee) } " · " (count_words(about.rubric, about.events)) }
        @if let Some(problem) = about.problem { (message_lines("warn", problem)) }
        (section("criteria", "Criteria", &html! {
            ol.rubric { @for criterion in &about.rubric.criteria { li id={ "criterion-" (criterion.id) } { (criterion_item(visitor, about, criterion)) } } }
        }))
        (section("history", "History", &html! {
            @if about.events.is_empty() { p.calm { "Nothing signed off yet." } } @else { (history(about.events)) }
        }))
        @if visitor.satisfies(AccessLevel::Instructor) { p.tools { a href="/rubric" { "Edit the criteria" } } }
    };
    page(visitor, "/trainees", &format!("Rubric of {}", about.trainee), &body)
}

fn criterion_item(visitor: &Visitor, about: &RubricPage<'_>, criterion: &RubricCriterion) -> Markup {
    let signed = current_sign_off(about.events, &criterion.id);
    html! {
        h3 { (criterion.title) }
        p { (criterion.text) }
        p.verdict {
            @match signed {
                Some(event) => { b.good { "Signed off" } " " (day(event.unix_us)) " by " (signer(event)) @if !event.note.is_empty() { ": " (event.note) } },
                None => "Not signed off",
            }
        }
        @if visitor.satisfies(AccessLevel::Instructor) {
            @match signed {
                // Withdrawals are rare, so their form stays closed.
                Some(_) => details { summary { "Withdraw" } (sign_form(visitor, about.trainee, criterion, SignOffAction::Withdrawn)) },
                None => (sign_form(visitor, about.trainee, criterion, SignOffAction::SignedOff)),
            }
        }
    }
}

fn sign_form(visitor: &Visitor, trainee: &str, criterion: &RubricCriterion, action: SignOffAction) -> Markup {
    let (note, button, required) = match action {
        SignOffAction::SignedOff => ("Note (optional)", "Sign off", false),
        SignOffAction::Withdrawn => ("Reason", "Withdraw sign-off", true),
    };
    html! {
        form.inline method="post" action={ "/trainees/" (trainee) "/rubric" } {
            (token(visitor))
            input type="hidden" name="criterion" value=(criterion.id);
            input type="hidden" name="action" value=(action.word());
            label { (note) " " input name="note" required[required] maxlength=(MAX_NOTE_LEN) autocomplete="off"; }
            @if visitor.name.is_none() { label { "Your name " input name="by" required maxlength=(MAX_NAME_LEN) autocomplete="name"; } }
            button type="submit" aria-label={ (button) ": " (criterion.title) } { (button) }
        }
    }
}

/// Returns the instructor's name, or a replacement for an erased one.
fn signer(event: &SignOffEvent) -> &str {
    if event.by.is_empty() { "an erased user" } else { &event.by }
}

fn history(events: &[SignOffEvent]) -> Markup {
    let heads = [("Time", false), ("Criterion", false), ("Action", false), ("By", false), ("Note", false)];
    let rows = html! {
        @for event in events.iter().rev() {
            tr {
                th scope="row" { (minute(event.unix_us)) }
                td { (event.title) }
                td { (event.action.words(Language::English)) }
                td { (signer(event)) }
                td { (event.note) }
            }
        }
    };
    table(&format!("{}, newest first", counted(events.len(), "entry", "entries")), &heads, &rows)
}

/// Contents of the page that edits the criteria.
#[derive(Debug, Clone, Copy)]
pub struct RubricEditor<'a> {
    /// Text in the editor.
    pub text: &'a str,
    /// Whether this server uses its own rubric instead of the shipped one.
    pub own: bool,
    /// Result of the last change: `good` or `bad`, and the text, one message per line.
    pub notice: Option<(&'a str, &'a str)>,
}

/// Renders the page that edits the criteria.
#[must_use]
pub fn rubric_editor(visitor: &Visitor, about: &RubricEditor<'_>) -> Markup {
    let body = html! {
        @if let Some((kind, words)) = about.notice { (message_lines(kind, words)) }
        p { "The criteria that instructors sign off for each trainee. " @if about.own { "This server uses its own rubric." } @else { "This server uses the shipped rubric." } }
        p.note { "Sign-offs belong to a criterion's id. If you remove a criterion, its sign-offs stay in the history." }
        (section("edit", "Edit", &toml_editor(visitor, "/rubric", ("Rubric (TOML)", "rubric"), about.text)))
        @if about.own { (section("reset", "Shipped rubric", &html! {
            form method="post" action="/rubric/reset" { (token(visitor)) button.danger type="submit" { "Delete own rubric" } }
        })) }
    };
    page(visitor, "/trainees", "Rubric", &body)
}

#[cfg(test)]
mod tests {
    use super::super::layout::tests::{HOSTILE_NAME, administrator, check};
    use super::*;
    use crate::rubric::{DEFAULT_RUBRIC, read_rubric};
    use crate::trainee::Role;

    fn event(action: SignOffAction) -> SignOffEvent {
        let hostile = || HOSTILE_NAME.to_owned();
        SignOffEvent {
            criterion: "path".into(),
            title: hostile(),
            action,
            unix_us: 1_700_000_000_000_000,
            by: hostile(),
            note: hostile(),
        }
    }

    #[test]
    fn exact_rubric_page_escapes_and_only_instructors_can_sign() {
        let mut rubric = read_rubric("rubric.toml", DEFAULT_RUBRIC).unwrap();
        rubric.criteria[0].title = HOSTILE_NAME.into();
        rubric.criteria[0].text = HOSTILE_NAME.into();
        let events = [event(SignOffAction::SignedOff)];
        let about = RubricPage { trainee: HOSTILE_NAME, rubric: &rubric, events: &events, problem: Some(HOSTILE_NAME) };
        let text = rubric_page(&administrator(), &about).into_string();
        check(&text);
        assert!(text.contains("1 of 8 criteria signed off") && text.contains("2023-11-14"), "{text}");
        assert_eq!((text.matches("value=\"signed_off\"").count(), text.matches("value=\"withdrawn\"").count()), (7, 1));
        assert!(!text.contains("name=\"by\""), "the name of a user with a login is known");
        let local = Visitor { name: None, open: true, ..administrator() };
        assert_eq!(rubric_page(&local, &about).into_string().matches("name=\"by\"").count(), 8);
        let trainee = Visitor { role: Role::Trainee, ..administrator() };
        let text = rubric_page(&trainee, &about).into_string();
        check(&text);
        assert!(!text.contains("/rubric\"") && text.contains("Signed off"), "{text}");
        let withdrawn = [event(SignOffAction::SignedOff), SignOffEvent { by: String::new(), ..event(SignOffAction::Withdrawn) }];
        let text = rubric_page(&administrator(), &RubricPage { events: &withdrawn, ..about }).into_string();
        assert!(text.contains("0 of 8") && text.contains("an erased user") && text.contains("withdrawn"), "{text}");
    }

    #[test]
    fn exact_editor_escapes_the_text() {
        let about = RubricEditor { text: "# </textarea><b>", own: true, notice: Some(("bad", "one\ntwo")) };
        let text = rubric_editor(&administrator(), &about).into_string();
        check(&text);
        assert!(text.contains("# &lt;/textarea&gt;&lt;b&gt;") && text.contains("<p>one</p><p>two</p>"));
        assert!(text.contains("Delete own rubric"));
        let shipped = rubric_editor(&administrator(), &RubricEditor { own: false, notice: None, ..about });
        assert!(!shipped.into_string().contains("Delete own rubric"));
    }
}
