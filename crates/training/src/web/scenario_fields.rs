//! Renders the form of the scenario editor. The fields have no names: a script sends each change to the server, which edits the
//! text. Without the script, only the text is edited.

use super::scenario_form::{Control, Field, FieldGroup, FormSection, ScenarioForm, element_id, label, section_id};
use maud::{Markup, html};
use serde_json::{Map, Value, json};
use spandrel_model::toml::DocumentedKey;

/// Labels of the parts of a position.
const PARTS: [&str; 3] = ["East", "North", "Up"];

/// Renders all sections.
#[must_use]
pub fn fields(form: &ScenarioForm) -> Markup {
    html! { @for section in &form.sections { (form_section(section)) } }
}

/// Returns the texts of all input elements by their IDs.
#[must_use]
pub fn input_texts(form: &ScenarioForm) -> Map<String, Value> {
    let mut texts = Map::new();
    for field in form.fields() {
        let id = element_id(&field.location);
        if field.control == Control::Position {
            for (k, part) in position_parts(&field.value).into_iter().enumerate() {
                texts.insert(format!("{id}-part-{k}"), part.into());
            }
        } else {
            texts.insert(id, field.value.as_str().into());
        }
    }
    texts
}

fn form_section(section: &FormSection) -> Markup {
    let id = section_id(section.id);
    let count = section.groups.len();
    html! {
        details.form-section id=(id) {
            summary { h2 { (section.heading) @if section.repeated.is_some() { " (" (count) ")" } } }
            p.field-problem id={ (id) "-problem" } {}
            (all(&section.main, &section.more, &id))
            @for (k, group) in section.groups.iter().enumerate() { (field_group(group, k, count)) }
            @if let Some(repeated) = section.repeated {
                button type="button" data-edit=(json!({ "add": repeated })) { (add_label(repeated)) }
            }
        }
    }
}

fn add_label(repeated: &str) -> &'static str {
    match repeated {
        "tasks" => "Add a task",
        "bridges" => "Add a bridge",
        _ => "Add a gust",
    }
}

fn all(main: &[Field], more: &[Field], id: &str) -> Markup {
    html! {
        div.fields { @for field in main { (one_field(field)) } }
        @if !more.is_empty() {
            details.more id={ (id) "-more" } {
                summary { "More keys (" (more.len()) ")" }
                div.fields { @for field in more { (one_field(field)) } }
            }
        }
    }
}

fn field_group(group: &FieldGroup, k: usize, count: usize) -> Markup {
    let id = element_id(&group.location);
    let at = &group.location;
    let can_move = at.starts_with("tasks[");
    let named = |verb: &str| format!("{verb} {} {}", k + 1, group.name);
    html! {
        details.group id=(id) {
            summary { (k + 1) " · " (group.name) }
            p.field-problem id={ (id) "-problem" } {}
            (all(&group.main, &group.more, &id))
            p.row {
                @if can_move && k > 0 {
                    button type="button" data-edit=(json!({ "move": at, "up": true })) aria-label=(named("Move up:")) { "Move up" }
                }
                @if can_move && k + 1 < count {
                    button type="button" data-edit=(json!({ "move": at, "up": false })) aria-label=(named("Move down:")) { "Move down" }
                }
                button type="button" data-edit=(json!({ "remove": at })) aria-label=(named("Remove:")) { "Remove" }
            }
        }
    }
}

fn one_field(field: &Field) -> Markup {
    let id = element_id(&field.location);
    html! {
        @if field.control == Control::Position {
            (position(field, &id))
        } @else {
            div.field {
                label for=(id) { (label(&field.location)) }
                (input(field, &id))
                (notes(field, &id))
            }
        }
    }
}

fn input(field: &Field, id: &str) -> Markup {
    let described_by = format!("{id}-problem {id}-note");
    let at = &field.location;
    let default = &field.description.documented.default;
    let optional = default != "required";
    let hint = if !optional || default == "none" { "" } else { default.as_str() };
    match &field.control {
        Control::Choice(words) => html! {
            select id=(id) data-field=(at) aria-describedby=(described_by) {
                @if optional || field.value.is_empty() { option value="" selected[field.value.is_empty()] { (no_choice(optional, hint)) } }
                @for word in words { option value=(word) selected[field.value == *word] { (word) } }
                @if !field.value.is_empty() && !words.contains(&field.value) { option value=(field.value) selected { (field.value) } }
            }
        },
        Control::Lines => html! {
            textarea id=(id) data-field=(at) aria-describedby=(described_by) rows="4" { "\n" (field.value) }
        },
        Control::Number => html! {
            input id=(id) data-field=(at) aria-describedby=(described_by) inputmode="decimal" autocomplete="off" value=(field.value) placeholder=(hint);
        },
        Control::Line | Control::Position => html! {
            input id=(id) data-field=(at) aria-describedby=(described_by) autocomplete="off" value=(field.value) placeholder=(hint);
        },
    }
}

fn no_choice(optional: bool, default: &str) -> String {
    match (optional, default) {
        (false, _) => "Choose".to_owned(),
        (true, "") => "Not set".to_owned(),
        (true, default) => format!("Default: {default}"),
    }
}

fn position(field: &Field, id: &str) -> Markup {
    let parts = position_parts(&field.value);
    html! {
        fieldset.field.position id=(id) tabindex="-1" {
            legend { (label(&field.location)) }
            div.row {
                @for (k, part) in parts.iter().enumerate() {
                    label { (PARTS[k]) input id={ (id) "-part-" (k) } data-field=(field.location) data-part=(k) inputmode="decimal" autocomplete="off" aria-describedby={ (id) "-problem" } value=(part); }
                }
                button type="button" data-place=(field.location) aria-label={ "Place on the plan: " (label(&field.location)) } { "Place on the plan" }
            }
            (notes(field, id))
        }
    }
}

/// Splits a list of three numbers. The parts of anything else are in the first one.
fn position_parts(value: &str) -> [String; 3] {
    let inner = value.strip_prefix('[').and_then(|rest| rest.strip_suffix(']')).unwrap_or(value);
    let mut parts = inner.splitn(3, ',').map(|part| part.trim().to_owned());
    std::array::from_fn(|_| parts.next().unwrap_or_default())
}

fn notes(field: &Field, id: &str) -> Markup {
    let DocumentedKey { allowed, default } = &field.description.documented;
    html! {
        p.field-problem id={ (id) "-problem" } {}
        p.note id={ (id) "-note" } {
            (with_code(&field.description.meaning))
            span.allowed {
                @if !["text", "list of texts"].contains(&allowed.as_str()) { " Allowed: " (allowed) "." }
                @if default != "none" { " " (default_words(default)) }
            }
        }
    }
}

fn default_words(default: &str) -> String {
    if default == "required" { "Required.".to_owned() } else { format!("Default: {default}.") }
}

/// Renders Markdown of the documentation: words in backticks as code, without emphasis.
fn with_code(markdown: &str) -> Markup {
    html! {
        @for (k, part) in markdown.split('`').enumerate() {
            @if k % 2 == 1 { code { (part) } } @else { (part.replace('*', "")) }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::web::layout::tests::HOSTILE_NAME;
    use spandrel_model::scenario::edit::{Edit, apply};
    use spandrel_model::shipped::PRACTICE;

    #[test]
    fn exact_fields_show_value_meaning_and_allowed_range() {
        let text = fields(&ScenarioForm::read(PRACTICE).unwrap()).into_string();
        assert!(text.contains("id=\"field-wind-from_deg\"") && text.contains("value=\"200.0\""));
        assert!(text.contains("Direction that the wind blows from") && text.contains("Allowed: 0 to 360. Default: 0."), "{text}");
        assert!(text.contains("<option value=\"light\" selected"), "{text}");
        assert!(text.contains("Add a task") && text.contains("Tasks (4)"));
        assert!(text.contains("Default: respawn") && text.contains("More keys ("));
        assert_eq!(text.matches(">Move up<").count(), 3);
        let label_count = text.matches("<label").count() + text.matches("<legend").count();
        let input_count = text.matches("data-field").count();
        assert!(label_count >= input_count, "every input has a label");
    }

    #[test]
    fn exact_positions_have_three_parts() {
        let form = ScenarioForm::read(PRACTICE).unwrap();
        let texts = input_texts(&form);
        assert_eq!(texts["field-ground_team-pad_m-part-1"], "78.0");
        assert_eq!(texts["field-tasks-3-bridge"], "suspension");
        assert_eq!(position_parts("here"), ["here", "", ""]);
    }

    #[test]
    fn exact_hostile_values_are_escaped() {
        let set = |location: &str| Edit::Set { location: location.into(), text: HOSTILE_NAME.into() };
        let edits = ["title", "tasks[0].name", "bridges[0].name", "wind.level", "ground_team.pad_m"].map(set);
        let text = fields(&ScenarioForm::read(&apply(PRACTICE, &edits).unwrap()).unwrap()).into_string();
        assert!(!text.contains("<script>") && !text.contains("\"'&\""), "{text}");
    }
}
