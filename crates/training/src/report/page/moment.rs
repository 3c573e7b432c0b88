//! Links that move the slider to a moment of the flight.

use crate::report::formatting;
use maud::{Markup, html};
use spandrel_text::{Language, text};

/// Renders a link to a moment, s since lift-off. Without scripts, it leads to the flight's drawings.
pub fn link(t_s: f64) -> Markup {
    labeled(t_s, &formatting::clock(t_s))
}

/// Renders a link that offers to show a moment.
pub fn shown(t_s: f64, language: Language) -> Markup {
    labeled(t_s, &text!(language, "report-better-show", moment = formatting::clock(t_s)))
}

fn labeled(t_s: f64, label: &str) -> Markup {
    html! { a.moment-link href="#flight" data-t=(formatting::number(t_s, 2)) { (label) } }
}
