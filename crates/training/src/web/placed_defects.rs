//! Defects that an instructor places in the scenario editor: the panel beside the drawings, the list of the placed defects, and the
//! orders of the page's script.

use crate::terms::{defect_title, element_title};
use maud::{Markup, html};
use serde::Deserialize;
use serde_json::json;
use spandrel_model::defect_codes::{self, is_line, size_ranges};
use spandrel_model::elements::Element;
use spandrel_model::frames::Vec3;
use spandrel_model::scenario::edit::with_placed_defect;
use spandrel_model::scenario::values::ScenarioValues;
use spandrel_model::scenario::{self, LENGTH_RANGE_M, MAX_COORDINATE_M, MAX_DEFECTS, SiblingLoader, WIDTH_RANGE_M};
use spandrel_model::site::Site;
use spandrel_model::site::hand_placed::{DefectShape, MAX_SURFACE_DISTANCE_M, Misplacement, SurfaceTarget};
use spandrel_text::{Language, text};

/// Location of the placed defects in a scenario.
const PLACED: &str = "defects.placed";
/// Condition states of a defect. State 1 is a good condition.
const STATES: [u8; 3] = [2, 3, 4];
/// Largest rotation in either direction, deg.
const MAX_TURN_DEG: f64 = 180.0;
/// Millimeters per meter.
const MM_PER_M: f64 = 1_000.0;

/// A defect to place, as the page's script sends it: numbers as typed.
#[derive(Debug, Clone, PartialEq, Deserialize)]
pub struct DefectOrder {
    /// AASHTO MBEI defect code.
    kind: u32,
    /// Condition state, 2 to 4.
    condition_state: u8,
    /// Length, m; empty for a typical one.
    length_m: String,
    /// Width, mm; empty for a typical one.
    width_mm: String,
    /// Rotation on the surface, counterclockwise, deg; empty for none.
    turn_deg: String,
    /// Place.
    place: OrderedPlace,
}

/// Place of a defect: on a line of sight through a drawing, or near a point. East, north and up, m.
#[derive(Debug, Clone, PartialEq, Deserialize)]
#[serde(rename_all = "snake_case")]
enum OrderedPlace {
    Line { through_m: [f64; 3], direction: [f64; 3], bridge: Option<String> },
    Near([String; 3]),
}

impl DefectOrder {
    /// Parses an order in JSON.
    ///
    /// # Errors
    /// Returns a message if it is not an order for a defect in the list.
    pub fn parse(json: &str) -> Result<Self, String> {
        let order: Self = serde_json::from_str(json).map_err(|_| "defect: not valid".to_owned())?;
        let is_known = defect_codes::ALL.contains(&order.kind) && STATES.contains(&order.condition_state);
        if is_known { Ok(order) } else { Err("defect: unknown kind or condition state".to_owned()) }
    }

    fn shape(&self, language: Language) -> Result<DefectShape, String> {
        let typical = typical_size_m(self.kind, self.condition_state);
        let number = |field: String, text: &str, range| number(language, &field, text, range);
        let length_m = number(text!(language, "placing-length"), &self.length_m, LENGTH_RANGE_M)?.unwrap_or(typical.0);
        let (narrow, wide) = WIDTH_RANGE_M;
        let width_mm = number(text!(language, "placing-width"), &self.width_mm, (narrow * MM_PER_M, wide * MM_PER_M))?;
        let width_m = width_mm.map_or(typical.1.min(length_m), |width_mm| width_mm / MM_PER_M);
        let turn = number(text!(language, "placing-turn"), &self.turn_deg, (-MAX_TURN_DEG, MAX_TURN_DEG))?.unwrap_or(0.0);
        if width_m > length_m {
            return Err(text!(language, "placing-width-over-length"));
        }
        let is_fair = |state: u8| state <= 2;
        if let Some(state) = defect_codes::condition_state(self.kind, length_m, width_m)
            && is_fair(state) != is_fair(self.condition_state)
        {
            return Err(text!(language, "placing-other-state", state = state));
        }
        let (kind, condition_state) = (self.kind, self.condition_state);
        Ok(DefectShape { kind, condition_state, length_m, width_m, turn_rad: turn.to_radians() })
    }

    fn target(&self, language: Language) -> Result<(SurfaceTarget, Option<&str>), String> {
        match &self.place {
            OrderedPlace::Line { through_m, direction, bridge } => {
                let [through_m, direction] = [through_m, direction].map(|[east, north, up]| Vec3::new(*east, *north, *up));
                if !(through_m.norm() <= 2.0 * MAX_COORDINATE_M && (direction.norm() - 1.0).abs() < 0.01) {
                    return Err(text!(language, "placing-no-bridge"));
                }
                Ok((SurfaceTarget::Line { through_m, direction: direction.unit() }, bridge.as_deref()))
            }
            OrderedPlace::Near(typed) => {
                let fields = [text!(language, "editor-east"), text!(language, "editor-north"), text!(language, "editor-up")];
                let mut point = [0.0; 3];
                for ((value, field), typed) in point.iter_mut().zip(&fields).zip(typed) {
                    let range = (-MAX_COORDINATE_M, MAX_COORDINATE_M);
                    *value = number(language, field, typed, range)?.ok_or_else(|| not_a_number(language, field, range))?;
                }
                let [east, north, up] = point;
                Ok((SurfaceTarget::Near(Vec3::new(east, north, up)), None))
            }
        }
    }
}

/// Returns a typed number; `None` if the text is empty.
fn number(language: Language, field: &str, typed: &str, (low, high): (f64, f64)) -> Result<Option<f64>, String> {
    let typed = match language {
        Language::English | Language::Pseudo => typed.trim().to_owned(),
        // These have decimal commas.
        Language::German | Language::Spanish => typed.trim().replace(',', "."),
    };
    if typed.is_empty() {
        return Ok(None);
    }
    let value = typed.parse().ok().filter(|value| (low..=high).contains(value));
    value.map(Some).ok_or_else(|| not_a_number(language, field, (low, high)))
}

fn not_a_number(language: Language, field: &str, (low, high): (f64, f64)) -> String {
    text!(language, "placing-number", field = field, low = low.to_string(), high = high.to_string())
}

/// Returns length and width of a typical defect in the middle of the ranges of its condition state, m, rounded for display.
fn typical_size_m(kind: u32, condition_state: u8) -> (f64, f64) {
    let ranges = size_ranges(kind, condition_state);
    let middle = |(low, high): (f64, f64)| 0.5 * (low + high);
    let rounded = |value: f64, steps_per_m: f64| (value * steps_per_m).round() / steps_per_m;
    let length_m = rounded(middle(ranges.length_m), 1e2);
    let width_m = if is_line(kind) { rounded(middle(ranges.width), 1e5) } else { rounded(middle(ranges.width) * length_m, 1e2) };
    (length_m, width_m)
}

/// Places a defect in the text of a scenario. Returns the new text, and words about the defect.
///
/// # Errors
/// Returns the reason in the language if the scenario is invalid or the defect can't be there.
pub fn place(text: &str, siblings: SiblingLoader, order: &DefectOrder, language: Language) -> Result<(String, String), String> {
    let scenario = scenario::read("", text, siblings).map_err(|_| text!(language, "placing-invalid-scenario"))?;
    if scenario.defects.placed.as_ref().is_some_and(|placed| placed.len() >= MAX_DEFECTS) {
        return Err(text!(language, "placing-too-many", most = MAX_DEFECTS));
    }
    let (shape, (target, bridge)) = (order.shape(language)?, order.target(language)?);
    let placed = Site::without_defects(&scenario).place_defect(&shape, target, bridge);
    let defect = placed.map_err(|reason| reason_words(language, order.kind, reason))?;
    let (text, number) = with_placed_defect(text, &defect)?;
    let element = element_title(defect.element, language);
    Ok((text, text!(language, "placing-done", number = number, member = defect.member, element = element)))
}

fn reason_words(language: Language, kind: u32, reason: Misplacement) -> String {
    match reason {
        Misplacement::NoBridge => text!(language, "placing-no-bridge"),
        Misplacement::OffSurface(distance_m) if distance_m.is_infinite() => text!(language, "placing-no-bridge"),
        Misplacement::OffSurface(distance_m) => {
            let (distance, most) = (format!("{distance_m:.1}"), MAX_SURFACE_DISTANCE_M.to_string());
            text!(language, "placing-off-surface", distance = distance, most = most)
        }
        Misplacement::NotPermitted(element) => not_permitted_words(language, kind, element),
        Misplacement::TooLarge | Misplacement::UnknownMember | Misplacement::OtherElement(_) => {
            text!(language, "placing-too-large")
        }
        Misplacement::Covered => text!(language, "placing-covered"),
    }
}

fn not_permitted_words(language: Language, kind: u32, element: Element) -> String {
    let (kinds, name) = (element.permitted_defects(), element_title(element, language));
    if kinds.is_empty() {
        return text!(language, "placing-nothing-permitted", element = name);
    }
    let kinds: Vec<String> = kinds.iter().map(|kind| defect_title(*kind, language)).collect();
    text!(language, "placing-not-permitted", kind = defect_title(kind, language), element = name, kinds = kinds.join("; "))
}

/// Renders the panel. A script shows it, sends the orders and updates the list.
#[must_use]
pub fn panel(language: Language, text: &str) -> Markup {
    html! {
        details.form-section id="placer" hidden data-typical=(typical_sizes()) {
            summary { h3 { (text!(language, "placing-title")) } }
            fieldset.plain id="placer-fields" aria-label=(text!(language, "placing-title")) {
                p.note { (text!(language, "placing-note")) }
                (shape_fields(language))
                p.row { button type="button" id="place-on-drawing" { (text!(language, "placing-on-drawing")) } }
                (coordinate_fields(language))
                p.placing id="placed-result" role="status" aria-live="polite" {}
                div id="placed-list" { @if let Some(list) = list(language, text) { (list) } }
            }
        }
    }
}

/// Returns the typical sizes as JSON: length, m, and width, mm, by defect code and condition state.
fn typical_sizes() -> String {
    let size = |kind: u32, state: u8| {
        let (length_m, width_m) = typical_size_m(kind, state);
        // The width in micrometers is a whole number.
        json!([length_m.to_string(), ((width_m * 1e6).round() / MM_PER_M).to_string()])
    };
    let states =
        |kind: u32| STATES.iter().map(|state| (state.to_string(), size(kind, *state))).collect::<serde_json::Map<_, _>>();
    let all: serde_json::Map<_, _> = defect_codes::ALL.iter().map(|kind| (kind.to_string(), states(*kind).into())).collect();
    serde_json::Value::Object(all).to_string()
}

fn shape_fields(language: Language) -> Markup {
    let states = [text!(language, "placing-state-2"), text!(language, "placing-state-3"), text!(language, "placing-state-4")];
    let numbers = [
        ("place-length", text!(language, "placing-length")),
        ("place-width", text!(language, "placing-width")),
        ("place-turn", text!(language, "placing-turn")),
    ];
    html! {
        div.fields {
            div.field {
                label for="place-kind" { (text!(language, "placing-kind")) }
                select id="place-kind" { @for kind in defect_codes::ALL { option value=(kind) selected[*kind == defect_codes::CRACK] { (defect_title(*kind, language)) } } }
            }
            div.field {
                label for="place-state" { (text!(language, "placing-state")) }
                select id="place-state" { @for (state, words) in STATES.iter().zip(states) { option value=(state) { (words) } } }
            }
            @for (id, label) in numbers {
                div.field { label for=(id) { (label) } input id=(id) inputmode="decimal" autocomplete="off" aria-describedby="place-size-note"; }
            }
            div.field.whole-row {
                label for="place-surface" { (text!(language, "placing-surface")) }
                select id="place-surface" {
                    option value="front" { (text!(language, "placing-surface-front")) }
                    option value="back" { (text!(language, "placing-surface-back")) }
                }
            }
        }
        p.note id="place-size-note" { (text!(language, "placing-size-note")) }
    }
}

fn coordinate_fields(language: Language) -> Markup {
    let labels = [text!(language, "editor-east"), text!(language, "editor-north"), text!(language, "editor-up")];
    html! {
        fieldset.field.position {
            legend { (text!(language, "placing-coordinates")) }
            div.row {
                @for (k, label) in labels.iter().enumerate() {
                    label { (label) input id={ "place-at-" (k) } inputmode="decimal" autocomplete="off" aria-describedby="place-at-note"; }
                }
                button type="button" id="place-at-coordinates" { (text!(language, "placing-at-coordinates")) }
            }
            p.note id="place-at-note" { (text!(language, "placing-coordinates-note", most = MAX_SURFACE_DISTANCE_M.to_string())) }
        }
    }
}

/// Renders the list of the defects that a text places; `None` if it is not valid TOML.
#[must_use]
pub fn list(language: Language, text: &str) -> Option<Markup> {
    let values = ScenarioValues::read(text)?;
    let count = values.count(PLACED);
    let shown = count.min(MAX_DEFECTS);
    let value = |k: usize, key: &str| values.get(&format!("{PLACED}[{k}].{key}")).unwrap_or_default();
    let kind = |k: usize| defect_title(value(k, "kind").parse().unwrap_or_default(), language);
    let entry = |k: usize| {
        let (number, state, member) = (value(k, "id"), value(k, "condition_state"), value(k, "member"));
        text!(language, "placing-entry", number = number, kind = kind(k), state = state, member = member)
    };
    Some(html! {
        h4 id="placed-head" tabindex="-1" { (text!(language, "placing-list", count = count)) }
        @if count == 0 { p.note { (text!(language, "placing-none")) } } @else {
            ul.placed { @for k in 0..shown { li {
                span { (entry(k)) } " "
                button type="button" data-edit=(json!({ "remove": format!("{PLACED}[{k}]") })) aria-label=(text!(language, "placing-remove", number = value(k, "id"))) { (text!(language, "editor-remove")) }
            } } }
        }
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::web::layout::tests::{HOSTILE_NAME, check_translated};
    use spandrel_model::defect_codes::{CRACK, SPALL};
    use spandrel_model::shipped::PRACTICE;

    const NO_FILES: SiblingLoader<'static> = &|_| Err("none".to_owned());

    /// Returns an order for a crack at the underside of the deck of the suspension bridge, seen from below in the plan.
    fn order(kind: u32, length_m: &str, width_mm: &str) -> DefectOrder {
        let place = json!({ "line": { "through_m": [10.0, 150.0, 0.0], "direction": [0.0, 0.0, 1.0], "bridge": null } });
        order_at(kind, length_m, width_mm, &place)
    }

    fn order_at(kind: u32, length_m: &str, width_mm: &str, place: &serde_json::Value) -> DefectOrder {
        let json = json!({ "kind": kind, "condition_state": 3, "length_m": length_m, "width_mm": width_mm, "turn_deg": "", "place": place });
        DefectOrder::parse(&json.to_string()).unwrap()
    }

    fn placed(order: &DefectOrder) -> Result<(String, String), String> {
        place(PRACTICE, NO_FILES, order, Language::English)
    }

    #[test]
    fn exact_an_order_becomes_an_entry_of_the_scenario() {
        let (text, words) = placed(&order(CRACK, "0.5", "2")).unwrap();
        let scenario = scenario::read("job.toml", &text, NO_FILES).unwrap();
        let [defect] = scenario.defects.placed.as_deref().unwrap() else { panic!("{text}") };
        assert_eq!((defect.id, defect.kind, defect.condition_state, defect.line), (1, CRACK, 3, true));
        assert_eq!((defect.length_m, defect.width_m), (0.5, 0.002));
        assert!(defect.normal.up() < -0.99 && (defect.position_m.east() - 10.0).abs() < 1e-3, "{defect:?}");
        assert_eq!(words, format!("Defect 1 was placed on {} ({}).", defect.member, defect.element.name()));
        let list = list(Language::English, &text).unwrap().into_string();
        assert!(list.contains(&format!("1: cracking, condition state 3, {}", defect.member)), "{list}");
        assert!(list.contains("Placed defects (1)") && list.contains("defects.placed[0]"), "{list}");
        let at = defect.position_m.array().map(|value| value.to_string());
        let near = place(&text, NO_FILES, &order_at(CRACK, "", "", &json!({ "near": at })), Language::English).unwrap();
        assert!(near.1.starts_with("Defect 2 was placed"), "{}", near.1);
    }

    #[test]
    fn exact_wrong_orders_have_a_reason() {
        let reason = |order: DefectOrder| placed(&order).unwrap_err();
        assert_eq!(reason(order(CRACK, "x", "")), "Length (m): not a number from 0.0001 to 50.");
        assert_eq!(reason(order(CRACK, "51", "")), "Length (m): not a number from 0.0001 to 50.");
        assert_eq!(reason(order(CRACK, "0,5", "")), "Length (m): not a number from 0.0001 to 50.");
        assert_eq!(order(CRACK, "0,5", "2").shape(Language::German).unwrap().length_m, 0.5, "a decimal comma");
        assert_eq!(reason(order(CRACK, "0.1", "200")), "the width is larger than the length.");
        assert_eq!(reason(order(CRACK, "0.5", "0.4")), "with this size, the condition state is 2.");
        assert_eq!(
            reason(order(SPALL, "40", "")),
            "the defect would reach beyond its surface. Make it smaller, or place it farther from the edge."
        );
        let nowhere = json!({ "line": { "through_m": [4000.0, 0.0, 0.0], "direction": [0.0, 0.0, 1.0], "bridge": null } });
        assert_eq!(reason(order_at(CRACK, "", "", &nowhere)), "there is no bridge at this point of the drawing.");
        let slanted = json!({ "line": { "through_m": [0.0, 0.0, 0.0], "direction": [0.0, 0.0, 9.0], "bridge": null } });
        assert_eq!(reason(order_at(CRACK, "", "", &slanted)), "there is no bridge at this point of the drawing.");
        assert_eq!(
            reason(order_at(CRACK, "", "", &json!({ "near": ["1", "", "2"] }))),
            "North: not a number from -5000 to 5000."
        );
        let far = reason(order_at(CRACK, "", "", &json!({ "near": ["0", "0", "900"] })));
        assert!(far.starts_with("the nearest surface of a bridge is ") && far.ends_with("(allowed: at most 0.5 m)."), "{far}");
        let wrong = place("a = ", NO_FILES, &order(CRACK, "", ""), Language::German).unwrap_err();
        assert_eq!(wrong, "Das Szenario hat Probleme. Beheben Sie diese zuerst.");
        let mortar = reason(order(defect_codes::MORTAR, "", ""));
        assert!(
            mortar.starts_with("'mortar breakdown' does not occur on this element (") && mortar.contains("cracking"),
            "{mortar}"
        );
        for json in
            ["", "{}", r#"{"kind":1,"condition_state":3,"length_m":"","width_mm":"","turn_deg":"","place":{"near":["","",""]}}"#]
        {
            assert!(DefectOrder::parse(json).is_err(), "{json}");
        }
    }

    #[test]
    fn prop_typical_sizes_belong_to_their_condition_state() {
        for kind in defect_codes::ALL {
            for state in STATES {
                let (length_m, width_m) = typical_size_m(*kind, state);
                let ranges = size_ranges(*kind, state);
                assert!((ranges.length_m.0..=ranges.length_m.1).contains(&length_m), "{kind}, {state}: {length_m}");
                assert!(width_m > 0.0 && width_m <= length_m, "{kind}, {state}: {width_m}");
                let derived = defect_codes::condition_state(*kind, length_m, width_m);
                assert!(derived.is_none_or(|derived| derived == state.min(3)), "{kind}, {state}: {derived:?}");
            }
        }
        assert!(typical_sizes().contains(r#""1130":{"2":["0.95","0.79"]"#), "{}", typical_sizes());
    }

    #[test]
    fn exact_panel_and_list_are_translated_and_escaped() {
        let (text, _) = placed(&order(CRACK, "", "")).unwrap();
        let hostile = text.replace("member = \"", &format!("member = \"{}", HOSTILE_NAME.replace('"', "")));
        let page = panel(Language::English, &hostile).into_string();
        assert!(!page.contains("<script>") && page.contains("&lt;script&gt;"), "{page}");
        let only_numbers = text.replace("member = \"", "member = \"7\" # ");
        check_translated(&format!("<main>{}", panel(Language::Pseudo, &only_numbers).into_string()), &[]);
        let german = list(Language::German, PRACTICE).unwrap().into_string();
        assert!(german.contains("Platzierte Schäden (0)") && german.contains("zufällig"), "{german}");
        assert!(list(Language::German, "a = ").is_none());
    }
}
