//! A trainee's rubric: criteria with their sign-offs, and the history. Also the page that edits the criteria.

use super::access::{AccessLevel, Visitor};
use super::layout::{ELEMENT, Notice, message, page, section, table, token, toml_editor, with_element};
use crate::rubric::{Rubric, RubricCriterion, SignOffAction, SignOffEvent, criterion_title, current_sign_off};
use maud::{Markup, html};
use spandrel_model::calendar::{day, minute};
use spandrel_text::{Language, text};

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
pub fn count_words(language: Language, rubric: &Rubric, events: &[SignOffEvent]) -> String {
    let (signed, all) = (rubric.signed_off_count(events), rubric.criteria.len());
    text!(language, "people-rubric-count", signed = signed, all = all)
}

/// Renders a trainee's rubric.
#[must_use]
pub fn rubric_page(visitor: &Visitor, about: &RubricPage<'_>) -> Markup {
    let language = visitor.language;
    let body = html! {
        p.lead { a href={ "/trainees/" (about.trainee) } { (about.trainee) } " · " (count_words(language, about.rubric, about.events)) }
        @if let Some(problem) = about.problem { (message("warn", problem)) }
        (section("criteria", &text!(language, "people-criteria"), &html! {
            ol.rubric { @for criterion in &about.rubric.criteria { li id={ "criterion-" (criterion.id) } { (criterion_item(visitor, about, criterion)) } } }
        }))
        (section("history", &text!(language, "people-history"), &html! {
            @if about.events.is_empty() { p.calm { (text!(language, "people-no-history")) } } @else { (history(language, about.events)) }
        }))
        @if visitor.satisfies(AccessLevel::Instructor) { p.tools { a href="/rubric" { (text!(language, "people-edit-criteria")) } } }
    };
    page(visitor, "/trainees", &text!(language, "people-rubric-of", name = about.trainee), &body)
}

fn criterion_item(visitor: &Visitor, about: &RubricPage<'_>, criterion: &RubricCriterion) -> Markup {
    let language = visitor.language;
    let signed = current_sign_off(about.events, &criterion.id);
    html! {
        h3 { (criterion.shown_title(language)) }
        p { (criterion.shown_text(language)) }
        p.verdict {
            @match signed {
                Some(event) => (sign_off(language, event)),
                None => (text!(language, "people-not-signed")),
            }
        }
        @if visitor.satisfies(AccessLevel::Instructor) {
            @match signed {
                // Withdrawals are rare, so their form stays closed.
                Some(_) => details { summary { (text!(language, "people-withdraw")) } (sign_form(visitor, about.trainee, criterion, SignOffAction::Withdrawn)) },
                None => (sign_form(visitor, about.trainee, criterion, SignOffAction::SignedOff)),
            }
        }
    }
}

/// Describes when and by whom a criterion was signed off.
fn sign_off(language: Language, event: &SignOffEvent) -> Markup {
    let signed = html! { b.good { (text!(language, "people-signed")) } };
    let (day, instructor) = (day(event.unix_us), signer(language, event));
    let sentence = match event.note.as_str() {
        "" => text!(language, "people-signed-by", signed = ELEMENT, day = day, instructor = instructor),
        note => text!(language, "people-signed-by-with-note", signed = ELEMENT, day = day, instructor = instructor, note = note),
    };
    with_element(&sentence, &signed)
}

fn sign_form(visitor: &Visitor, trainee: &str, criterion: &RubricCriterion, action: SignOffAction) -> Markup {
    let language = visitor.language;
    let (note, button, required) = match action {
        SignOffAction::SignedOff => (text!(language, "people-note-optional"), text!(language, "people-sign"), false),
        SignOffAction::Withdrawn => (text!(language, "people-reason"), text!(language, "people-withdraw-sign-off"), true),
    };
    let label = text!(language, "people-button-for", button = button.as_str(), criterion = criterion.shown_title(language));
    html! {
        form.inline method="post" action={ "/trainees/" (trainee) "/rubric" } {
            (token(visitor))
            input type="hidden" name="criterion" value=(criterion.id);
            input type="hidden" name="action" value=(action.word());
            label { (note) " " input name="note" required[required] maxlength=(MAX_NOTE_LEN) autocomplete="off"; }
            @if visitor.name.is_none() { label { (text!(language, "people-your-name")) " " input name="by" required maxlength=(MAX_NAME_LEN) autocomplete="name"; } }
            button type="submit" aria-label=(label) { (button) }
        }
    }
}

/// Returns the instructor's name, or a replacement for an erased one.
fn signer(language: Language, event: &SignOffEvent) -> String {
    if event.by.is_empty() { text!(language, "people-erased-user") } else { event.by.clone() }
}

fn history(language: Language, events: &[SignOffEvent]) -> Markup {
    let heads = [
        (text!(language, "people-time"), false),
        (text!(language, "people-criterion"), false),
        (text!(language, "people-action"), false),
        (text!(language, "people-by"), false),
        (text!(language, "people-note"), false),
    ];
    let rows = html! {
        @for event in events.iter().rev() {
            tr {
                th scope="row" { (minute(event.unix_us)) }
                td { (criterion_title(&event.criterion, &event.title, language)) }
                td { (event.action.words(language)) }
                td { (signer(language, event)) }
                td { (event.note) }
            }
        }
    };
    table(&text!(language, "people-history-count", count = events.len()), &heads, &rows)
}

/// Contents of the page that edits the criteria.
#[derive(Debug, Clone, Copy)]
pub struct RubricEditor<'a> {
    /// Text in the editor.
    pub text: &'a str,
    /// Whether this server uses its own rubric instead of the shipped one.
    pub own: bool,
    /// Result of the last change.
    pub notice: Option<Notice<'a>>,
}

/// Renders the page that edits the criteria.
#[must_use]
pub fn rubric_editor(visitor: &Visitor, about: &RubricEditor<'_>) -> Markup {
    let language = visitor.language;
    let label = text!(language, "people-rubric-toml");
    let body = html! {
        @if let Some(notice) = about.notice { (notice.render()) }
        p { @if about.own { (text!(language, "people-rubric-own")) } @else { (text!(language, "people-rubric-shipped")) } }
        p.note { (text!(language, "people-rubric-note")) }
        (section("edit", &text!(language, "people-rubric-edit"), &toml_editor(visitor, "/rubric", (&label, "rubric"), about.text)))
        @if about.own { (section("reset", &text!(language, "people-rubric-reset"), &html! {
            form method="post" action="/rubric/reset" { (token(visitor)) button.danger type="submit" { (text!(language, "people-rubric-delete")) } }
        })) }
    };
    page(visitor, "/trainees", &text!(language, "people-rubric"), &body)
}

#[cfg(test)]
mod tests {
    use super::super::layout::tests::{HOSTILE_NAME, administrator, administrator_with, check, check_translated};
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
        let about = RubricEditor { text: "# </textarea><b>", own: true, notice: Some(Notice::bad("one\ntwo")) };
        let text = rubric_editor(&administrator(), &about).into_string();
        check(&text);
        assert!(text.contains("# &lt;/textarea&gt;&lt;b&gt;") && text.contains("<p>one</p><p>two</p>"));
        assert!(text.contains("Delete own rubric"));
        let shipped = rubric_editor(&administrator(), &RubricEditor { own: false, notice: None, ..about });
        assert!(!shipped.into_string().contains("Delete own rubric"));
    }

    #[test]
    fn exact_default_criteria_are_shown_in_the_visitors_language() {
        let rubric = read_rubric("rubric.toml", DEFAULT_RUBRIC).unwrap();
        let title = rubric.criterion("path").unwrap().title.clone();
        let signed = SignOffEvent { title, by: "7".into(), note: String::new(), ..event(SignOffAction::SignedOff) };
        let events = [signed];
        let about = RubricPage { trainee: "anna", rubric: &rubric, events: &events, problem: None };
        let page = |language| rubric_page(&administrator_with(language), &about).into_string();
        check_translated(&page(Language::Pseudo), &["anna", "UTC"]);
        let german = page(Language::German);
        assert_eq!(german.matches("Fliegt die Bahn").count(), 3, "heading, button and history: {german}");
    }

    #[test]
    fn exact_rubric_pages_are_translated() {
        let rubric =
            read_rubric("rubric.toml", "format = 1\n[[criteria]]\nid = \"path\"\ntitle = \"7\"\ntext = \"8\"\n").unwrap();
        let signed =
            |action, note: &str| SignOffEvent { by: String::new(), title: "7".into(), note: note.into(), ..event(action) };
        let visitor = Visitor { name: None, open: true, ..administrator_with(Language::Pseudo) };
        let histories = [vec![], vec![signed(SignOffAction::SignedOff, "")], vec![signed(SignOffAction::SignedOff, "9")]];
        for events in
            histories.into_iter().chain([vec![signed(SignOffAction::SignedOff, ""), signed(SignOffAction::Withdrawn, "9")]])
        {
            let about = RubricPage { trainee: "anna", rubric: &rubric, events: &events, problem: None };
            check_translated(&rubric_page(&visitor, &about).into_string(), &["anna", "UTC"]);
            let german = rubric_page(&administrator_with(Language::German), &about).into_string();
            assert!(german.contains("von 1 Kriterien bestätigt"), "{german}");
        }
        let notice = Notice { kind: "bad", text: "7", details: "rubric.toml: in English" };
        let editor = rubric_editor(&visitor, &RubricEditor { text: "", own: true, notice: Some(notice) }).into_string();
        check_translated(&editor, &["TOML"]);
        assert!(editor.contains("<div lang=\"en\"><p>rubric.toml: in English</p></div>"), "{editor}");
    }
}
