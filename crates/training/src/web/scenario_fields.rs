//! Renders the form of the scenario editor. The fields have no names: a script sends each change to the server, which edits the
//! text. Without the script, only the text is edited.

use super::key_texts::{allowed_words, default_words, meaning};
use super::scenario_form::{Control, Field, FieldGroup, FormSection, ScenarioForm, element_id, section_id};
use super::scenario_labels::label;
use maud::{Markup, html};
use serde_json::{Map, Value, json};
use spandrel_model::toml::DocumentedKey;
use spandrel_text::{Language, text};

/// Renders all sections.
#[must_use]
pub fn fields(language: Language, form: &ScenarioForm) -> Markup {
    html! { @for section in &form.sections { (form_section(language, section)) } }
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

/// Returns the heading of a section with this ID.
fn heading(language: Language, id: &str) -> String {
    match id {
        "job" => text!(language, "editor-section-job"),
        "pictures" => text!(language, "editor-section-pictures"),
        "place" => text!(language, "editor-section-place"),
        "bridges" => text!(language, "editor-section-bridges"),
        "tasks" => text!(language, "editor-section-tasks"),
        "defects" => text!(language, "editor-section-defects"),
        "traffic" => text!(language, "editor-section-traffic"),
        "drones" => text!(language, "editor-section-drones"),
        "ropes" => text!(language, "editor-section-ropes"),
        "wind" => text!(language, "editor-section-wind"),
        "gusts" => text!(language, "editor-section-gusts"),
        "light" => text!(language, "editor-section-light"),
        _ => text!(language, "editor-section-rules"),
    }
}

fn form_section(language: Language, section: &FormSection) -> Markup {
    let id = section_id(section.id);
    let count = section.groups.len();
    let mut heading = heading(language, section.id);
    if section.repeated.is_some() {
        heading = text!(language, "editor-section-count", section = heading, count = count);
    }
    html! {
        details.form-section id=(id) {
            summary data-check=(check_this(language)) { h2 { (heading) } }
            p.field-problem id={ (id) "-problem" } {}
            (all(language, &section.main, &section.more, &id))
            @for (k, group) in section.groups.iter().enumerate() { (field_group(language, group, k, count)) }
            @if section.id == "pictures" { p.note { (text!(language, "editor-pictures-note")) } }
            @if let Some((repeated, label)) = section.repeated.and_then(|repeated| Some((repeated, add_label(language, repeated)?))) {
                button type="button" data-edit=(json!({ "add": repeated })) { (label) }
            }
        }
    }
}

/// Returns the words beside the heading of a section or group with a problem. The style sheet shows them.
fn check_this(language: Language) -> String {
    text!(language, "editor-check-this")
}

/// Returns the label of the button that adds a table; `None` if the form can't add one.
fn add_label(language: Language, repeated: &str) -> Option<String> {
    match repeated {
        "tasks" => Some(text!(language, "editor-add-task")),
        "bridges" => Some(text!(language, "editor-add-bridge")),
        "drones" => Some(text!(language, "editor-add-drone")),
        "ropes" => Some(text!(language, "editor-add-rope")),
        "wind.events" => Some(text!(language, "editor-add-gust")),
        _ => None,
    }
}

fn all(language: Language, main: &[Field], more: &[Field], id: &str) -> Markup {
    html! {
        div.fields { @for field in main { (one_field(language, field)) } }
        @if !more.is_empty() {
            details.more id={ (id) "-more" } {
                summary data-check=(check_this(language)) { (text!(language, "editor-more-keys", count = more.len())) }
                div.fields { @for field in more { (one_field(language, field)) } }
            }
        }
    }
}

fn field_group(language: Language, group: &FieldGroup, k: usize, count: usize) -> Markup {
    let id = element_id(&group.location);
    let at = &group.location;
    let can_move = at.starts_with("tasks[");
    let (number, name) = (k + 1, group.name.as_str());
    html! {
        details.group id=(id) {
            summary data-check=(check_this(language)) { (number) " · " (name) }
            p.field-problem id={ (id) "-problem" } {}
            (all(language, &group.main, &group.more, &id))
            p.row {
                @if can_move && k > 0 {
                    button type="button" data-edit=(json!({ "move": at, "up": true })) aria-label=(text!(language, "editor-move-up-group", number = number, name = name)) { (text!(language, "editor-move-up")) }
                }
                @if can_move && k + 1 < count {
                    button type="button" data-edit=(json!({ "move": at, "up": false })) aria-label=(text!(language, "editor-move-down-group", number = number, name = name)) { (text!(language, "editor-move-down")) }
                }
                button type="button" data-edit=(json!({ "remove": at })) aria-label=(text!(language, "editor-remove-group", number = number, name = name)) { (text!(language, "editor-remove")) }
            }
        }
    }
}

fn one_field(language: Language, field: &Field) -> Markup {
    let id = element_id(&field.location);
    html! {
        @if field.control == Control::Position {
            (position(language, field, &id))
        } @else {
            div.field {
                label for=(id) { (label(language, &field.location)) }
                (input(language, field, &id))
                (notes(language, field, &id))
            }
        }
    }
}

fn input(language: Language, field: &Field, id: &str) -> Markup {
    let described_by = format!("{id}-problem {id}-note");
    let at = &field.location;
    let default = &field.description.documented.default;
    let optional = default != "required";
    let hint = if !optional || default == "none" { String::new() } else { default_words(language, default) };
    match &field.control {
        Control::Choice(words) => html! {
            select id=(id) data-field=(at) aria-describedby=(described_by) {
                @if optional || field.value.is_empty() { option value="" selected[field.value.is_empty()] { (no_choice(language, optional, &hint)) } }
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

fn no_choice(language: Language, optional: bool, default: &str) -> String {
    match (optional, default) {
        (false, _) => text!(language, "editor-choose"),
        (true, "") => text!(language, "editor-not-set"),
        (true, default) => text!(language, "editor-default-choice", value = default),
    }
}

fn position(language: Language, field: &Field, id: &str) -> Markup {
    let labels = [text!(language, "editor-east"), text!(language, "editor-north"), text!(language, "editor-up")];
    let parts = labels.into_iter().zip(position_parts(&field.value));
    let legend = label(language, &field.location);
    let place_field = text!(language, "editor-place-on-plan-field", field = legend.as_str());
    html! {
        fieldset.field.position id=(id) tabindex="-1" {
            legend { (legend) }
            div.row {
                @for (k, (part_label, part)) in parts.enumerate() {
                    label { (part_label) input id={ (id) "-part-" (k) } data-field=(field.location) data-part=(k) inputmode="decimal" autocomplete="off" aria-describedby={ (id) "-problem" } value=(part); }
                }
                button type="button" data-place=(field.location) aria-label=(place_field) { (text!(language, "editor-place-on-plan")) }
            }
            (notes(language, field, id))
        }
    }
}

/// Splits a list of three numbers. The parts of anything else are in the first one.
fn position_parts(value: &str) -> [String; 3] {
    let inner = value.strip_prefix('[').and_then(|rest| rest.strip_suffix(']')).unwrap_or(value);
    let mut parts = inner.splitn(3, ',').map(|part| part.trim().to_owned());
    std::array::from_fn(|_| parts.next().unwrap_or_default())
}

/// Renders the meaning of the key and its allowed values.
fn notes(language: Language, field: &Field, id: &str) -> Markup {
    let DocumentedKey { allowed, default } = &field.description.documented;
    let (own_language, meaning) = meaning(language, field.description);
    let own_tag = Some(own_language.tag()).filter(|_| own_language != language);
    html! {
        p.field-problem id={ (id) "-problem" } {}
        p.note id={ (id) "-note" } {
            span lang=[own_tag] { (with_code(&meaning)) }
            span.allowed {
                @if !["text", "list of texts"].contains(&allowed.as_str()) { " " (text!(language, "editor-allowed", allowed = allowed_words(language, allowed))) }
                @if default != "none" { " " (default_note(language, default)) }
            }
        }
    }
}

fn default_note(language: Language, default: &str) -> String {
    match default {
        "required" => text!(language, "editor-required"),
        default => text!(language, "editor-default", value = default_words(language, default)),
    }
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
        let text = fields(Language::English, &ScenarioForm::read(PRACTICE).unwrap()).into_string();
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
    fn exact_labels_and_meanings_are_in_the_language_of_the_page() {
        let text = fields(Language::German, &ScenarioForm::read(PRACTICE).unwrap()).into_string();
        assert!(text.contains("Aufgaben (4)") && text.contains("Aufgabe hinzufügen") && text.contains(">Abstand (m)<"), "{text}");
        assert!(text.contains("Zulässig: 0 bis 360. Vorgabe: 0.") && text.contains("data-check=\"bitte prüfen\""), "{text}");
        assert!(text.contains("<span>Richtung, aus der der Wind weht") && !text.contains("<span lang"), "{text}");
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
        let text = fields(Language::English, &ScenarioForm::read(&apply(PRACTICE, &edits).unwrap()).unwrap()).into_string();
        assert!(!text.contains("<script>") && !text.contains("\"'&\""), "{text}");
    }
}
