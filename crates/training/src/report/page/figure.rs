//! Figures, legends and scrollable frames.

use maud::{Markup, html};

/// Stands in a text for a part of the page: bold text, a link or code.
pub(super) const SLOT: &str = "\u{fffc}";

/// Renders a text with a part in its [`SLOT`].
pub(super) fn filled(text: &str, part: &Markup) -> Markup {
    let (before, after) = text.split_once(SLOT).unwrap_or((text, ""));
    html! { (before) (part) (after) }
}

/// Wraps wide content in a horizontally scrollable box that also accepts keyboard focus.
pub(super) fn scrolling(label: &str, body: &Markup) -> Markup {
    html! { div.scroll tabindex="0" role="region" aria-label=(label) { (body) } }
}

/// Renders a figure with its caption.
pub(super) fn figure(caption: &str, body: &Markup) -> Markup {
    html! { figure { figcaption { (caption) } (body) } }
}

/// Renders a legend from the CSS class and text of each entry.
pub(super) fn legend(entries: &[(&str, String)]) -> Markup {
    html! {
        ul.legend {
            @for (class, words) in entries {
                li { svg.swatch viewBox="0 0 14 14" aria-hidden="true" { rect class=(class) x="1" y="1" width="12" height="12" rx="3" {} } (words) }
            }
        }
    }
}
