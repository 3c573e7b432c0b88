//! The live page: map and side views that the script moves the drone on, what was said, and the instructor's actions.

use super::access::Visitor;
use super::assets;
use super::frame::{scripted, section, token};
use maud::{Markup, PreEscaped, html};

/// Longest note, characters: it is one message on the wire.
pub const NOTE_MOST: usize = 100;
/// Strongest wind, m/s: the vehicle's parameter ends there.
pub const WIND_MOST_M_S: f64 = 25.0;

/// What may fail, as the form and the wire name it: key, words, FAILURE_UNIT.
pub const UNITS: [(&str, &str, f32); 4] = [
    ("gnss", "Satellite navigation", 4.0),
    ("compass", "Compass", 2.0),
    ("barometer", "Barometer", 3.0),
    ("battery", "Battery", 100.0),
];

/// The job that is flown, drawn.
#[derive(Debug, Clone, Default, PartialEq, Eq)]
pub struct Drawn {
    /// Names the job and its seed.
    pub key: String,
    /// Title.
    pub title: String,
    /// Drawings: caption and SVG, made by `crate::report::plots::job`.
    pub drawings: Vec<(String, String)>,
}

/// The page.
#[must_use]
pub fn live(visitor: &Visitor, drawn: Option<&Drawn>, vehicle: &str) -> Markup {
    let body = html! {
        div.live-page data-live data-job=(drawn.map_or("", |drawn| drawn.key.as_str())) {
            p.lead {
                @match drawn {
                    Some(drawn) => b { (drawn.title) },
                    None => span { "Waiting for a flight at " code { (vehicle) } ". This page follows as soon as one begins." },
                }
                " " span.state role="status" data-state { "not connected" }
            }
            noscript { p.message.warn { "This page needs scripts: it follows the flight." } }
            @if let Some(drawn) = drawn {
                section aria-label="Now" {
                    dl.readout {
                        @for (key, words) in [("task", "Task"), ("time", "Time"), ("speed", "Speed"), ("height", "Height"), ("clearance", "Clearance"), ("battery", "Battery"), ("contact", "Touches")] {
                            div { dt { (words) } dd data-now=(key) { "–" } }
                        }
                    }
                    ul.cues aria-label="Cues that are on" data-cues {}
                }
                div.watch {
                    section aria-label="Site" {
                        @for (caption, drawing) in &drawn.drawings {
                            figure.wide { figcaption { (caption) } div.scroll tabindex="0" role="region" aria-label=(caption) { (PreEscaped(drawing)) } }
                        }
                    }
                    div {
                        (section("act", "Act in this flight", &actions(visitor)))
                        (section("said", "What is said", &html! { ol.said data-said tabindex="0" aria-label="Texts of the vehicle and the monitor, the newest first" {} }))
                    }
                }
            }
        }
    };
    scripted(visitor, "/live", "Live flight", Some(assets::LIVE_NAME), &body)
}

fn actions(visitor: &Visitor) -> Markup {
    html! {
        form.stacked method="post" action="/live/act" data-act {
            (token(visitor)) input type="hidden" name="act" value="note";
            label { "Note at this moment" input name="text" required maxlength=(NOTE_MOST) autocomplete="off"; }
            button type="submit" { "Note" }
        }
        form.stacked method="post" action="/live/act" data-act {
            (token(visitor)) input type="hidden" name="act" value="wind";
            label { "Wind, m/s" input type="number" name="speed" required min="0" max=(WIND_MOST_M_S) step="0.5" value="6"; }
            label { "From, degrees" input type="number" name="from" required min="0" max="360" step="5" value="270"; }
            button type="submit" { "Set the wind" }
        }
        form.stacked method="post" action="/live/act" data-act {
            (token(visitor)) input type="hidden" name="act" value="failure";
            label { "What" select name="unit" { @for (key, words, _) in UNITS { option value=(key) { (words) } } } }
            div.row {
                button type="submit" name="fails" value="yes" { "Let it fail" }
                button type="submit" name="fails" value="no" { "Make it whole" }
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::super::frame::tests::{EVIL, administrator, check};
    use super::*;

    #[test]
    fn exact_without_a_flight_there_is_nothing_to_act_in() {
        let text = live(&administrator(), None, "127.0.0.1:14280").into_string();
        check(&text);
        assert!(!text.contains("/live/act") && text.contains("Waiting for a flight"));
        let drawn = Drawn { key: "k".into(), title: EVIL.into(), drawings: vec![(EVIL.into(), "<svg></svg>".into())] };
        let text = live(&administrator(), Some(&drawn), "x").into_string();
        check(&text);
        assert_eq!(text.matches("action=\"/live/act\"").count(), 3);
    }
}
