//! Pages of the scenario editor.

use super::access::Visitor;
use super::assets::EDITOR_NAME;
use super::layout::{Notice, page_with_script, script_texts, token};
use super::placed_defects;
use super::scenario_check_result::{CheckedScenario, form_shape};
use super::scenario_fields::fields;
use super::scenario_form::ScenarioForm;
use super::scenarios::ScenarioEntry;
use maud::{Markup, html};
use spandrel_text::{Language, text};

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
    /// Result of saving, if any.
    pub notice: Option<Notice<'a>>,
    /// Whether the saved file has changed since it was opened.
    pub conflict: bool,
    /// Result of a check, if the text was checked.
    pub checked: Option<&'a CheckedScenario>,
}

/// Renders the editor.
#[must_use]
pub fn editor_page(visitor: &Visitor, about: &EditorPage<'_>) -> Markup {
    let form = ScenarioForm::read(about.text);
    let language = visitor.language;
    let title = match about.opened {
        "" => text!(language, "editor-new-scenario"),
        name => text!(language, "editor-edit-title", name = name),
    };
    let status = about.checked.map_or_else(|| text!(language, "editor-not-checked"), |checked| checked.status(language));
    let body = html! {
        div.scenario-editor data-editor data-unsaved=(about.unsaved) data-shape=[form.as_ref().map(form_shape)] data-texts=(texts(language)) {
            @if let Some(notice) = about.notice { div id="notice" { (notice.render()) } }
            (main_form(visitor, about))
            div.editor-status {
                p id="status" role="status" aria-live="polite" { (status) }
                p.placing id="placing" role="status" aria-live="polite" {}
                div id="findings" { @if let Some(checked) = about.checked { (checked.findings_list(language)) } }
            }
            div.editor-columns {
                div.editor-form {
                    fieldset.plain id="fields" hidden aria-label=(text!(language, "editor-form")) { @if let Some(form) = &form { (fields(language, form)) } }
                    (file(language, about.text))
                }
                (preview(language, about))
            }
        }
    };
    page_with_script(visitor, "/scenarios", &title, Some(EDITOR_NAME), &body)
}

/// Texts of the script.
fn texts(language: Language) -> String {
    script_texts([
        ("not_checked_status", text!(language, "editor-script-not-checked-status", status = "{status}")),
        ("not_checked_login", text!(language, "editor-script-not-checked-login")),
        ("not_placed", text!(language, "placing-not-placed", reason = "{reason}")),
        ("not_checked", text!(language, "editor-script-not-checked", reason = "{reason}")),
        ("no_plan", text!(language, "editor-script-no-plan")),
        ("place", text!(language, "editor-script-place")),
        ("place_defect", text!(language, "placing-script-click")),
        ("downloaded", text!(language, "editor-script-downloaded", status = "{status}")),
    ])
}

fn main_form(visitor: &Visitor, about: &EditorPage<'_>) -> Markup {
    let language = visitor.language;
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
                label.overwrite { input type="checkbox" name="overwrite" value="yes"; " " (text!(language, "editor-overwrite")) }
            }
            div.inline {
                button type="submit" { (text!(language, "editor-save")) }
                button type="submit" formaction="/scenario-editor/check" data-without-script { (text!(language, "editor-check")) }
                button id="download" type="submit" formaction="/scenario-editor/download" { (text!(language, "editor-download")) }
                a.button href=(discard) { (text!(language, "editor-discard")) }
                a href=(leave) { (text!(language, "editor-back")) }
                @if !about.opened.is_empty() { a href={ (leave) "/briefing" } { (text!(language, "editor-briefing")) } }
            }
            div.inline {
                label { (text!(language, "editor-new-name")) " " input id="new-name" name="new_name" maxlength="40" pattern="[a-z0-9\\-]+" autocapitalize="none" autocomplete="off"; }
                button id="save-as" type="submit" name="save_as" value="yes" { (text!(language, "editor-save-as")) }
            }
        }
    }
}

fn file(language: Language, text: &str) -> Markup {
    html! {
        details.form-section id="file" open {
            summary { h2 { (text!(language, "editor-file")) } }
            p.note { (text!(language, "editor-file-note")) }
            label for="text" { (text!(language, "editor-scenario-toml")) }
            // A browser drops the first line break in the field.
            textarea.code id="text" name="text" form="editor" rows="30" spellcheck="false" required { "\n" (text) }
        }
    }
}

fn preview(language: Language, about: &EditorPage<'_>) -> Markup {
    html! {
        section.editor-preview aria-labelledby="preview-head" {
            h2 id="preview-head" { (text!(language, "editor-preview")) }
            p.message.warn id="stale" hidden { (text!(language, "editor-stale")) }
            (placed_defects::panel(language, about.text))
            div id="preview" {
                @match about.checked.and_then(|checked| checked.preview.as_ref()) {
                    Some(drawings) => (drawings),
                    None => p.note { (text!(language, "editor-no-preview")) },
                }
            }
        }
    }
}

/// Renders the page that asks for the scenario to start from.
#[must_use]
pub fn new_page(visitor: &Visitor, scenarios: &[ScenarioEntry], (from, name): (&str, &str)) -> Markup {
    let language = visitor.language;
    let body = html! {
        p.lead { (text!(language, "editor-new-lead")) }
        form.stacked method="get" action="/scenarios/new" {
            label { (text!(language, "editor-start-from")) select name="from" {
                @for one in scenarios { option value=(one.name) selected[one.name == from] { (one.name) ": " (one.shown_title(language)) } }
            } }
            label { (text!(language, "editor-new-name")) input name="name" required maxlength="40" pattern="[a-z0-9\\-]+" autocapitalize="none" autocomplete="off" value=(name); }
            p.note { (text!(language, "editor-new-name-note")) }
            button type="submit" { (text!(language, "editor-edit-copy")) }
        }
    };
    super::layout::page(visitor, "/scenarios", &text!(language, "editor-new-scenario"), &body)
}

#[cfg(test)]
mod tests {
    use super::super::layout::tests::{HOSTILE_NAME, administrator, administrator_with, check, check_translated};
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
            notice: Some(Notice::bad(HOSTILE_NAME)),
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

    #[test]
    fn exact_editor_is_translated() {
        let visitor = administrator_with(Language::Pseudo);
        let about =
            EditorPage { text: "a = ", opened: "7", version: "", unsaved: true, notice: None, conflict: true, checked: None };
        check_translated(&editor_page(&visitor, &about).into_string(), &["TOML"]);
        let named = [ScenarioEntry { name: "7".into(), title: "8".into(), uploaded: true }];
        check_translated(&new_page(&visitor, &named, ("7", "9")).into_string(), &[]);
        let german = editor_page(&administrator_with(Language::German), &about).into_string();
        assert!(german.contains("<h1>7 bearbeiten</h1>") && german.contains("Speichern unter"), "{german}");
    }
}
