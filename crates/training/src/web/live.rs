//! The live page: plan and side views with the moving drone, message log, and instructor actions.

use super::access::Visitor;
use super::assets;
use super::layout::{ELEMENT, page_with_script, script_texts, section, token, with_element};
use crate::terms::contact_title;
use maud::{Markup, PreEscaped, html};
use spandrel_mavlink::contract::practice::MAX_TASK;
use spandrel_mavlink::contract::walk::MAX_PLACE;
use spandrel_text::{Language, text};

/// Maximum length of an instructor's note, characters. A note must fit in one MAVLink message.
pub const MAX_NOTE_LEN: usize = 100;
/// Maximum wind speed, m/s, from the vehicle parameter's upper limit.
pub const MAX_WIND_M_S: u32 = 25;

/// A component that can fail.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum FailingUnit {
    /// Satellite navigation.
    Gnss,
    /// Compass.
    Compass,
    /// Barometer.
    Barometer,
    /// Battery.
    Battery,
}

impl FailingUnit {
    const ALL: [Self; 4] = [Self::Gnss, Self::Compass, Self::Barometer, Self::Battery];

    /// Returns the unit with this form key.
    #[must_use]
    pub fn from_key(key: &str) -> Option<Self> {
        Self::ALL.into_iter().find(|unit| unit.key() == key)
    }

    fn key(self) -> &'static str {
        match self {
            Self::Gnss => "gnss",
            Self::Compass => "compass",
            Self::Barometer => "barometer",
            Self::Battery => "battery",
        }
    }

    /// Returns the unit's name.
    #[must_use]
    pub fn name(self, language: Language) -> String {
        match self {
            Self::Gnss => text!(language, "live-unit-gnss"),
            Self::Compass => text!(language, "live-unit-compass"),
            Self::Barometer => text!(language, "live-unit-barometer"),
            Self::Battery => text!(language, "live-unit-battery"),
        }
    }

    /// Returns the unit's name within a sentence: in German, nouns are capitalized.
    #[must_use]
    pub fn name_in_sentence(self, language: Language) -> String {
        match language {
            Language::German => self.name(language),
            Language::English | Language::Spanish | Language::Pseudo => self.name(language).to_lowercase(),
        }
    }

    /// Returns the MAVLink `FAILURE_UNIT`.
    #[must_use]
    pub fn code(self) -> f32 {
        match self {
            Self::Gnss => 4.0,
            Self::Compass => 2.0,
            Self::Barometer => 3.0,
            Self::Battery => 100.0,
        }
    }
}

/// View of the site or of a bridge that a drawing shows.
#[derive(Debug, Clone, PartialEq, Eq)]
pub enum DrawingView {
    /// The site from above.
    Above,
    /// The bridge with this name from the side.
    Side(String),
    /// The site from the south.
    South,
}

impl DrawingView {
    fn caption(&self, language: Language) -> String {
        match self {
            Self::Above => text!(language, "live-view-above"),
            Self::Side(bridge) => text!(language, "live-view-side", bridge = bridge.as_str()),
            Self::South => text!(language, "live-view-south"),
        }
    }
}

/// Drawings of the job being flown.
#[derive(Debug, Clone, Default, PartialEq, Eq)]
pub struct JobDrawings {
    /// Key that identifies the job and its seed.
    pub key: String,
    /// Job title in the language of the drawings.
    pub title: String,
    /// View and SVG of each drawing, created by `crate::report::plots::job`.
    pub drawings: Vec<(DrawingView, String)>,
}

/// Vehicle selected on the page.
#[derive(Debug, Clone, Default, PartialEq, Eq)]
pub struct VehicleSelection {
    /// `HOST:PORT` of each vehicle.
    pub vehicles: Vec<String>,
    /// Selected vehicle, numbered from 1.
    pub number: usize,
}

impl VehicleSelection {
    fn address(&self) -> Option<&str> {
        self.number.checked_sub(1).and_then(|k| self.vehicles.get(k)).map(String::as_str)
    }
}

/// Renders the instructor's live page.
#[must_use]
pub fn live(visitor: &Visitor, drawn: Option<&JobDrawings>, choice: &VehicleSelection) -> Markup {
    let language = visitor.language;
    let has_vehicles = !choice.vehicles.is_empty();
    let body = html! {
        (others(language, choice))
        div.live-page data-live[has_vehicles] data-vehicle=(choice.number) data-job=(drawn.map_or("", |drawn| drawn.key.as_str())) data-texts=(texts(language)) {
            p.lead {
                @match drawn {
                    Some(drawn) => b { (drawn.title) },
                    None => span { (waiting(language, choice)) },
                }
                " " span.state role="status" data-state { (text!(language, "live-not-connected")) }
            }
            noscript { p.message.warn { (text!(language, "web-no-script")) } }
            @if let Some(drawn) = drawn {
                section aria-label=(text!(language, "live-now")) {
                    dl.readout {
                        @for (key, words) in readouts(language) { div { dt { (words) } dd data-now=(key) { "–" } } }
                    }
                    ul.cues aria-label=(text!(language, "live-cues")) data-cues {}
                    ul.cues aria-label=(text!(language, "live-hazards")) data-hazards {}
                }
                div.watch {
                    section aria-label=(text!(language, "live-site")) {
                        @for (view, drawing) in &drawn.drawings {
                            @let caption = view.caption(language);
                            figure.wide { figcaption { (caption) } div.scroll tabindex="0" role="region" aria-label=(caption) { (PreEscaped(drawing)) } }
                        }
                    }
                    div {
                        figure.camera data-camera hidden {
                            figcaption { (text!(language, "live-camera-caption")) }
                            img alt=(text!(language, "live-camera")) data-picture="";
                        }
                        (section("act", &text!(language, "live-actions"), &actions(visitor, choice.number)))
                        (section("said", &text!(language, "live-log"), &html! { ol.said data-said tabindex="0" aria-label=(text!(language, "live-log-label")) {} }))
                    }
                }
            }
        }
    };
    page_with_script(visitor, "/live", &text!(language, "live-title"), Some(assets::LIVE_NAME), &body)
}

/// Explains why there is no flight.
fn waiting(language: Language, choice: &VehicleSelection) -> Markup {
    match choice.address() {
        Some(address) => with_element(&text!(language, "live-waiting", address = ELEMENT), &html! { code { (address) } }),
        None => with_element(
            &text!(language, "live-no-vehicle", command = ELEMENT),
            &html! { code { "spandrel serve --vehicle HOST:PORT" } },
        ),
    }
}

fn readouts(language: Language) -> [(&'static str, String); 14] {
    [
        ("task", text!(language, "live-task")),
        ("step", text!(language, "live-step")),
        ("progress", text!(language, "live-progress")),
        ("time", text!(language, "live-time")),
        ("speed", text!(language, "live-speed")),
        ("height", text!(language, "live-height")),
        ("clearance", text!(language, "live-clearance")),
        ("battery", text!(language, "live-battery")),
        ("contact", text!(language, "live-contact")),
        ("traffic", text!(language, "live-traffic")),
        ("wind", text!(language, "live-wind")),
        ("gnss", text!(language, "live-gnss")),
        ("compass", text!(language, "live-compass")),
        ("radio", text!(language, "live-radio")),
    ]
}

/// Texts of the scripts of this page and the page with all flights. The names of contacts and of the traffic's states are
/// those of [`super::live_state::LiveFlightState::to_json`].
pub(super) fn texts(language: Language) -> String {
    script_texts([
        ("frozen", text!(language, "live-state-frozen")),
        ("armed", text!(language, "live-state-armed")),
        ("disarmed", text!(language, "live-state-disarmed")),
        ("silent", text!(language, "live-state-silent")),
        ("off_path", text!(language, "live-off-path")),
        ("traffic_open", text!(language, "live-traffic-open")),
        ("traffic_closed", text!(language, "live-traffic-closed")),
        ("contact_none", contact_title("none", language)),
        ("contact_bridge", contact_title("bridge", language)),
        ("contact_terrain", contact_title("terrain", language)),
        ("contact_water", contact_title("water", language)),
        ("contact_vehicle", contact_title("vehicle", language)),
        ("contact_person", contact_title("person", language)),
        ("contact_other", contact_title("other", language)),
        ("not_connected", text!(language, "live-not-connected")),
        ("failed_status", text!(language, "live-failed-status", status = "{status}")),
        ("failed_login", text!(language, "live-failed-login")),
        ("failed_silent", text!(language, "live-failed-silent")),
        ("tile_vehicle", text!(language, "live-tile-vehicle", number = "{number}")),
        ("tile_no_hazard", text!(language, "live-tile-no-hazard")),
        ("tile_no_cue", text!(language, "live-tile-no-cue")),
        ("tile_status", text!(language, "live-tile-status", status = "{status}")),
        ("tile_login", text!(language, "live-tile-login")),
        ("tile_not_connected", text!(language, "live-tile-not-connected")),
    ])
}

/// Renders the page that shows trainees their own flight's camera image; its script refreshes the image.
#[must_use]
pub fn own_flight(visitor: &Visitor) -> Markup {
    let language = visitor.language;
    let texts = script_texts([
        ("none", text!(language, "live-own-none")),
        ("window", text!(language, "live-own-window")),
        ("flying", text!(language, "live-own-flying")),
        ("status", text!(language, "live-own-status", status = "{status}")),
        ("login", text!(language, "live-own-login")),
        ("not_connected", text!(language, "live-not-connected")),
    ]);
    let body = html! {
        div.own-flight data-flight data-texts=(texts) {
            p.lead role="status" data-state { (text!(language, "live-own-none")) }
            noscript { p.message.warn { (text!(language, "web-no-script")) } }
            figure.camera data-camera hidden {
                figcaption { (text!(language, "live-own-caption")) }
                img alt=(text!(language, "live-own-camera")) data-picture="";
            }
        }
    };
    page_with_script(visitor, "/flight", &text!(language, "live-own-title"), Some(assets::FLIGHT_NAME), &body)
}

/// Renders links to the other vehicles.
fn others(language: Language, choice: &VehicleSelection) -> Markup {
    let label = |number: usize, address: &str| text!(language, "live-vehicle-at", number = number, address = address);
    html! {
        @if choice.vehicles.len() > 1 {
            nav.pages aria-label=(text!(language, "live-vehicles")) {
                a href="/live/all" { (text!(language, "live-all-flights")) }
                @for (number, address) in (1..).zip(&choice.vehicles) {
                    a href={ "/live?vehicle=" (number) } aria-current=[(number == choice.number).then_some("page")] { (label(number, address)) }
                }
            }
        }
    }
}

fn actions(visitor: &Visitor, vehicle: usize) -> Markup {
    let language = visitor.language;
    let hidden = |act: &str| html! { (token(visitor)) input type="hidden" name="act" value=(act); input type="hidden" name="vehicle" value=(vehicle); };
    html! {
        form.stacked method="post" action="/live/act" data-act {
            (hidden("note"))
            label { (text!(language, "live-note")) input name="text" required maxlength=(MAX_NOTE_LEN) autocomplete="off"; }
            button type="submit" { (text!(language, "live-add-note")) }
        }
        form.stacked method="post" action="/live/act" data-act {
            (hidden("wind"))
            label { (text!(language, "live-wind-speed")) input type="number" name="speed" required min="0" max=(MAX_WIND_M_S) step="0.5" value="6"; }
            label { (text!(language, "live-wind-from")) input type="number" name="from" required min="0" max="360" step="5" value="270"; }
            button type="submit" { (text!(language, "live-set-wind")) }
        }
        form.stacked method="post" action="/live/act" data-act {
            (hidden("traffic"))
            p.note { (text!(language, "live-traffic-note")) }
            div.row {
                button type="submit" name="open" value="no" { (text!(language, "live-close-bridges")) }
                button type="submit" name="open" value="yes" { (text!(language, "live-open-bridges")) }
            }
        }
        form.stacked method="post" action="/live/act" data-act {
            (hidden("practice"))
            p.note { (text!(language, "live-practice-note")) }
            div.row {
                button type="submit" name="do" value="freeze" { (text!(language, "live-freeze")) }
                button type="submit" name="do" value="resume" { (text!(language, "live-continue")) }
                button type="submit" name="do" value="rewind" { (text!(language, "live-rewind")) }
            }
        }
        form.stacked method="post" action="/live/act" data-act {
            (hidden("practice"))
            label { (text!(language, "live-task")) input type="number" name="task" required min="1" max=(MAX_TASK) value="1"; }
            button type="submit" name="do" value="move" { (text!(language, "live-move")) }
        }
        form.stacked method="post" action="/live/act" data-act {
            (hidden("walk"))
            label { (text!(language, "live-place")) input type="number" name="place" required min="1" max=(MAX_PLACE) value="2"; }
            button type="submit" { (text!(language, "live-walk")) }
        }
        form.stacked method="post" action="/live/act" data-act {
            (hidden("failure"))
            label { (text!(language, "live-component")) select name="unit" { @for unit in FailingUnit::ALL { option value=(unit.key()) { (unit.name(language)) } } } }
            div.row {
                button type="submit" name="fails" value="yes" { (text!(language, "live-inject")) }
                button type="submit" name="fails" value="no" { (text!(language, "live-clear")) }
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::super::layout::tests::{HOSTILE_NAME, administrator, administrator_with, check, check_translated};
    use super::*;

    #[test]
    fn exact_own_flight_page_shows_only_camera() {
        let trainee = Visitor { role: crate::trainee::Role::Trainee, ..administrator() };
        let text = own_flight(&trainee).into_string();
        check(&text);
        assert!(text.contains("href=\"/flight\" aria-current=\"page\"") && text.contains("data-camera hidden"), "{text}");
        assert!(!text.contains("class=\"map\"") && !text.contains("/live"), "{text}");
        assert!(
            !own_flight(&administrator()).into_string().contains("href=\"/flight\""),
            "instructors use the live page instead"
        );
    }

    #[test]
    fn exact_live_page_without_flight_has_no_actions() {
        let choice = VehicleSelection { vehicles: vec!["127.0.0.1:14280".into(), HOSTILE_NAME.into()], number: 2 };
        let text = live(&administrator(), None, &choice).into_string();
        check(&text);
        assert!(!text.contains("/live/act") && text.contains("Waiting for a flight"));
        let drawn = JobDrawings {
            key: "k".into(),
            title: HOSTILE_NAME.into(),
            drawings: vec![(DrawingView::Side(HOSTILE_NAME.into()), "<svg></svg>".into())],
        };
        let text = live(&administrator(), Some(&drawn), &choice).into_string();
        check(&text);
        assert_eq!(text.matches("action=\"/live/act\"").count(), 7);
        assert_eq!(text.matches("name=\"vehicle\" value=\"2\"").count(), 7);
        assert!(text.contains("href=\"/live?vehicle=2\" aria-current=\"page\""), "{text}");
        let text = live(&administrator(), None, &VehicleSelection::default()).into_string();
        assert!(!text.contains("data-live") && text.contains("No vehicle configured"), "no vehicle to connect to: {text}");
    }

    #[test]
    fn exact_live_pages_are_translated() {
        let visitor = administrator_with(Language::Pseudo);
        let choice = VehicleSelection { vehicles: vec!["7".into(), "8".into()], number: 2 };
        let drawings = vec![(DrawingView::Above, String::new()), (DrawingView::Side("7".into()), String::new())];
        let drawn = JobDrawings { key: "k".into(), title: "7".into(), drawings };
        for drawn in [None, Some(&drawn)] {
            check_translated(&live(&visitor, drawn, &choice).into_string(), &[]);
        }
        check_translated(&live(&visitor, None, &VehicleSelection::default()).into_string(), &[]);
        check_translated(&own_flight(&visitor).into_string(), &[]);
        let scripted = texts(Language::Pseudo);
        let values: std::collections::BTreeMap<String, String> = serde_json::from_str(&scripted).unwrap();
        values.values().for_each(|value| check_translated(&format!("<p>{value}</p>"), &["status", "number"]));
        let german = live(&administrator_with(Language::German), Some(&drawn), &choice).into_string();
        assert!(german.contains("Brücken sperren") && german.contains("Von oben, Norden oben"), "{german}");
    }

    #[test]
    fn exact_every_contact_and_unit_has_a_text() {
        let values: serde_json::Value = serde_json::from_str(&texts(Language::German)).unwrap();
        for contact in spandrel_mavlink::contract::contact::ContactKind::ALL {
            assert!(values[format!("contact_{}", contact.label())].is_string(), "{contact:?}");
        }
        for unit in FailingUnit::ALL {
            assert_eq!(FailingUnit::from_key(unit.key()), Some(unit));
        }
        assert_eq!(FailingUnit::from_key("wings"), None);
    }
}
