//! The live page: plan and side views with the moving drone, message log, and instructor actions.

use super::access::Visitor;
use super::assets;
use super::layout::{page_with_script, section, token};
use maud::{Markup, PreEscaped, html};
use spandrel_mavlink::contract::practice::MAX_TASK;

/// Maximum length of an instructor's note, characters. A note must fit in one MAVLink message.
pub const MAX_NOTE_LEN: usize = 100;
/// Maximum wind speed, m/s, from the vehicle parameter's upper limit.
pub const MAX_WIND_M_S: f64 = 25.0;

/// Failures that can be injected: form key, label, MAVLink `FAILURE_UNIT`.
pub const INJECTABLE_FAILURES: [(&str, &str, f32); 4] = [
    ("gnss", "Satellite navigation", 4.0),
    ("compass", "Compass", 2.0),
    ("barometer", "Barometer", 3.0),
    ("battery", "Battery", 100.0),
];

/// Drawings of the job being flown.
#[derive(Debug, Clone, Default, PartialEq, Eq)]
pub struct JobDrawings {
    /// Key that identifies the job and its seed.
    pub key: String,
    /// Job title.
    pub title: String,
    /// Caption and SVG of each drawing, created by `crate::report::plots::job`.
    pub drawings: Vec<(String, String)>,
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
    let body = html! {
        (others(choice))
        div.live-page data-live[!choice.vehicles.is_empty()] data-vehicle=(choice.number) data-job=(drawn.map_or("", |drawn| drawn.key.as_str())) {
            p.lead {
                @match drawn {
                    Some(drawn) => b { (drawn.title) },
                    None => @match choice.address() {
                        Some(address) => span { "Waiting for a flight at " code { (address) } ". This page updates when one starts." },
                        None => span { "No vehicle configured. Start the server with " code { "spandrel serve --vehicle HOST:PORT" } "." },
                    },
                }
                " " span.state role="status" data-state { "Not connected" }
            }
            noscript { p.message.warn { "This page requires JavaScript." } }
            @if let Some(drawn) = drawn {
                section aria-label="Now" {
                    dl.readout {
                        @for (key, words) in [("task", "Task"), ("step", "Next step"), ("progress", "Path flown"), ("time", "Time"), ("speed", "Speed"), ("height", "Height"), ("clearance", "Clearance"), ("battery", "Battery"), ("contact", "Contact"), ("traffic", "Traffic")] {
                            div { dt { (words) } dd data-now=(key) { "–" } }
                        }
                    }
                    ul.cues aria-label="Active cues" data-cues {}
                }
                div.watch {
                    section aria-label="Site" {
                        @for (caption, drawing) in &drawn.drawings {
                            figure.wide { figcaption { (caption) } div.scroll tabindex="0" role="region" aria-label=(caption) { (PreEscaped(drawing)) } }
                        }
                    }
                    div {
                        figure.camera data-camera hidden {
                            figcaption { "Camera view, updated about once per second" }
                            img alt="Current camera view" data-picture="";
                        }
                        (section("act", "Instructor actions", &actions(visitor, choice.number)))
                        (section("said", "Message log", &html! { ol.said data-said tabindex="0" aria-label="Messages from the vehicle and the monitor, newest first" {} }))
                    }
                }
            }
        }
    };
    page_with_script(visitor, "/live", "Live flight", Some(assets::LIVE_NAME), &body)
}

/// Renders the page that shows trainees their own flight's camera image; its script refreshes the image.
#[must_use]
pub fn own_flight(visitor: &Visitor) -> Markup {
    let body = html! {
        div.own-flight data-flight {
            p.lead role="status" data-state { "No flight in progress. This page updates when your flight starts." }
            noscript { p.message.warn { "This page requires JavaScript." } }
            figure.camera data-camera hidden {
                figcaption { "Your camera view, updated about once per second" }
                img alt="Your current camera view" data-picture="";
            }
        }
    };
    page_with_script(visitor, "/flight", "My flight", Some(assets::FLIGHT_NAME), &body)
}

/// Renders links to the other vehicles.
fn others(choice: &VehicleSelection) -> Markup {
    html! {
        @if choice.vehicles.len() > 1 {
            nav.pages aria-label="Vehicles" {
                a href="/live/all" { "All flights" }
                @for (number, address) in (1..).zip(&choice.vehicles) {
                    a href={ "/live?vehicle=" (number) } aria-current=[(number == choice.number).then_some("page")] { "Vehicle " (number) " · " (address) }
                }
            }
        }
    }
}

fn actions(visitor: &Visitor, vehicle: usize) -> Markup {
    let hidden = |act: &str| html! { (token(visitor)) input type="hidden" name="act" value=(act); input type="hidden" name="vehicle" value=(vehicle); };
    html! {
        form.stacked method="post" action="/live/act" data-act {
            (hidden("note"))
            label { "Note for the report" input name="text" required maxlength=(MAX_NOTE_LEN) autocomplete="off"; }
            button type="submit" { "Add note" }
        }
        form.stacked method="post" action="/live/act" data-act {
            (hidden("wind"))
            label { "Wind speed (m/s)" input type="number" name="speed" required min="0" max=(MAX_WIND_M_S) step="0.5" value="6"; }
            label { "Wind direction (degrees)" input type="number" name="from" required min="0" max="360" step="5" value="270"; }
            button type="submit" { "Set wind" }
        }
        form.stacked method="post" action="/live/act" data-act {
            (hidden("traffic"))
            p.note { "Closing a bridge stops new traffic; vehicles already on it leave." }
            div.row {
                button type="submit" name="open" value="no" { "Close bridges" }
                button type="submit" name="open" value="yes" { "Open bridges" }
            }
        }
        form.stacked method="post" action="/live/act" data-act {
            (hidden("practice"))
            p.note { "In practice only. A flight that was frozen, rewound or moved is neither certified nor compared with others." }
            div.row {
                button type="submit" name="do" value="freeze" { "Freeze" }
                button type="submit" name="do" value="resume" { "Continue" }
                button type="submit" name="do" value="rewind" { "Rewind 10 s" }
            }
        }
        form.stacked method="post" action="/live/act" data-act {
            (hidden("practice"))
            label { "Task" input type="number" name="task" required min="1" max=(MAX_TASK) value="1"; }
            button type="submit" name="do" value="move" { "Move to the start of this task" }
        }
        form.stacked method="post" action="/live/act" data-act {
            (hidden("failure"))
            label { "Component" select name="unit" { @for (key, words, _) in INJECTABLE_FAILURES { option value=(key) { (words) } } } }
            div.row {
                button type="submit" name="fails" value="yes" { "Inject failure" }
                button type="submit" name="fails" value="no" { "Clear failure" }
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::super::layout::tests::{HOSTILE_NAME, administrator, check};
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
            drawings: vec![(HOSTILE_NAME.into(), "<svg></svg>".into())],
        };
        let text = live(&administrator(), Some(&drawn), &choice).into_string();
        check(&text);
        assert_eq!(text.matches("action=\"/live/act\"").count(), 6);
        assert_eq!(text.matches("name=\"vehicle\" value=\"2\"").count(), 6);
        assert!(text.contains("href=\"/live?vehicle=2\" aria-current=\"page\""), "{text}");
        let text = live(&administrator(), None, &VehicleSelection::default()).into_string();
        assert!(!text.contains("data-live") && text.contains("No vehicle configured"), "no vehicle to connect to: {text}");
    }
}
