//! Pages of the scenario editor.

use super::access::Visitor;
use super::assets::EDITOR_NAME;
use super::layout::{message_lines, page_with_script, token};
use super::scenario_check_result::{CheckedScenario, form_shape};
use super::scenario_fields::fields;
use super::scenario_form::ScenarioForm;
use super::scenarios::ScenarioEntry;
use maud::{Markup, html};

/// Contents of the editor's page.
pub struct EditorPage<'a> {
    /// Text of the scenario.
    pub text: &'a str,
    /// Name of the scenario that was opened; empty for a new one.
    pub opened: &'a str,
    /// Version of the file that was opened; empty for a new one.
    pub version: &'a str,
    /// Whether the text differs from the saved file.
    pub unsaved: bool,
    /// Message with its CSS class, if any.
    pub notice: Option<(&'a str, &'a str)>,
    /// Whether the saved file has changed since it was opened.
    pub conflict: bool,
    /// Result of a check, if the text was checked.
    pub checked: Option<&'a CheckedScenario>,
}

/// Renders the editor.
#[must_use]
pub fn editor_page(visitor: &Visitor, about: &EditorPage<'_>) -> Markup {
    let form = ScenarioForm::read(about.text);
    let title = if about.opened.is_empty() { "New scenario".to_owned() } else { format!("Edit {}", about.opened) };
    let body = html! {
        div.scenario-editor data-editor data-unsaved=(about.unsaved) data-shape=[form.as_ref().map(form_shape)] {
            @if let Some((kind, words)) = about.notice { div id="notice" { (message_lines(kind, words)) } }
            (main_form(visitor, about))
            div.editor-status {
                p id="status" role="status" aria-live="polite" { (about.checked.map_or_else(|| "Not checked yet.".to_owned(), CheckedScenario::status)) }
                p.placing id="placing" role="status" aria-live="polite" {}
                div id="findings" { @if let Some(checked) = about.checked { (checked.findings_list()) } }
            }
            div.editor-columns {
                div.editor-form {
                    fieldset.plain id="fields" hidden aria-label="Form" { @if let Some(form) = &form { (fields(form)) } }
                    (file(about.text))
                }
                (preview(about.checked))
            }
        }
    };
    page_with_script(visitor, "/scenarios", &title, Some(EDITOR_NAME), &body)
}

fn main_form(visitor: &Visitor, about: &EditorPage<'_>) -> Markup {
    let (discard, leave) = if about.opened.is_empty() {
        ("/scenarios/new".to_owned(), "/scenarios".to_owned())
    } else {
        (format!("/scenarios/{}/edit", about.opened), format!("/scenarios/{}", about.opened))
    };
    html! {
        form id="editor" method="post" action="/scenario-editor/save" {
            (token(visitor))
            input type="hidden" name="opened" value=(about.opened);
            input type="hidden" name="version" value=(about.version);
            @if about.conflict {
                label.overwrite { input type="checkbox" name="overwrite" value="yes"; " Overwrite the other version" }
            }
            div.inline {
                button type="submit" { "Save" }
                button type="submit" formaction="/scenario-editor/check" data-without-script { "Check" }
                button id="download" type="submit" formaction="/scenario-editor/download" { "Download" }
                a.button href=(discard) { "Discard changes" }
                a href=(leave) { "Back" }
            }
            div.inline {
                label { "New name " input id="new-name" name="new_name" maxlength="40" pattern="[a-z0-9\\-]+" autocapitalize="none" autocomplete="off"; }
                button id="save-as" type="submit" name="save_as" value="yes" { "Save as" }
            }
        }
    }
}

fn file(text: &str) -> Markup {
    html! {
        details.form-section id="file" open {
            summary { h2 { "File" } }
            p.note { "The form changes this text and keeps its comments. Lessons, forms, difficulty levels and placed defects have no form: edit them here." }
            label for="text" { "Scenario (TOML)" }
            // A browser drops the first line break in the field.
            textarea.code id="text" name="text" form="editor" rows="30" spellcheck="false" required { "\n" (text) }
        }
    }
}

fn preview(checked: Option<&CheckedScenario>) -> Markup {
    html! {
        section.editor-preview aria-labelledby="preview-head" {
            h2 id="preview-head" { "Preview" }
            p.message.warn id="stale" hidden { "The drawings show the last valid version." }
            div id="preview" {
                @match checked.and_then(|checked| checked.preview.as_ref()) {
                    Some(drawings) => (drawings),
                    None => p.note { "The drawings appear when the scenario is valid." },
                }
            }
        }
    }
}

/// Renders the page that asks for the scenario to start from.
#[must_use]
pub fn new_page(visitor: &Visitor, scenarios: &[ScenarioEntry], (from, name): (&str, &str)) -> Markup {
    let body = html! {
        p.lead { "A new scenario starts as a copy of another one. Nothing is saved until you choose Save." }
        form.stacked method="get" action="/scenarios/new" {
            label { "Start from" select name="from" {
                @for one in scenarios { option value=(one.name) selected[one.name == from] { (one.name) ": " (one.title) } }
            } }
            label { "New name" input name="name" required maxlength="40" pattern="[a-z0-9\\-]+" autocapitalize="none" autocomplete="off" value=(name); }
            p.note { "1 to 40 characters: a-z, 0-9 and -" }
            button type="submit" { "Edit the copy" }
        }
    };
    super::layout::page(visitor, "/scenarios", "New scenario", &body)
}

#[cfg(test)]
mod tests {
    use super::super::layout::tests::{HOSTILE_NAME, administrator, check};
    use super::*;
    use spandrel_model::shipped::PRACTICE;

    #[test]
    fn exact_editor_contains_the_form_and_the_text() {
        let about = EditorPage {
            text: PRACTICE,
            opened: "practice-2",
            version: "v1",
            unsaved: false,
            notice: None,
            conflict: false,
            checked: None,
        };
        let text = editor_page(&administrator(), &about).into_string();
        check(&text);
        assert!(text.contains("name=\"opened\" value=\"practice-2\"") && text.contains("name=\"version\" value=\"v1\""));
        assert!(text.contains("field-wind-from_deg") && text.contains("title = &quot;Practice at two bridges&quot;"));
        assert!(!text.contains("name=\"overwrite\"") && text.contains("/scenario-editor/check"));
    }

    #[test]
    fn exact_hostile_texts_are_escaped() {
        let text = format!("# </textarea>{HOSTILE_NAME}\nname = \"{}\"", HOSTILE_NAME.replace('"', ""));
        let about = EditorPage {
            text: &text,
            opened: "",
            version: "",
            unsaved: true,
            notice: Some(("bad", HOSTILE_NAME)),
            conflict: true,
            checked: None,
        };
        let page = editor_page(&administrator(), &about).into_string();
        check(&page);
        assert!(!page.contains("# </textarea>") && page.contains("name=\"overwrite\""));
        let broken = EditorPage { text: "a = ", ..about };
        check(&editor_page(&administrator(), &broken).into_string());
        let named = [ScenarioEntry { name: "x".into(), title: HOSTILE_NAME.into(), uploaded: true }];
        check(&new_page(&administrator(), &named, (HOSTILE_NAME, HOSTILE_NAME)).into_string());
    }
}
