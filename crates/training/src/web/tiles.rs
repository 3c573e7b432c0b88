//! Page with a tile for each live flight: picture or map, task, battery and cue. Each tile links to its flight's own page.

use super::access::Visitor;
use super::assets;
use super::layout::{ELEMENT, page_with_script, with_element};
use super::live::{JobDrawings, texts};
use maud::{Markup, PreEscaped, html};
use spandrel_text::{Language, text};

/// A flight's tile.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct VehicleTile {
    /// `HOST:PORT` of the vehicle's payload port.
    pub address: String,
    /// Drawings of the job; `None` until they are known.
    pub drawings: Option<JobDrawings>,
}

/// Renders the page. The vehicles are numbered from 1, in the order of the tiles.
#[must_use]
pub fn tiles_page(visitor: &Visitor, tiles: &[VehicleTile]) -> Markup {
    let language = visitor.language;
    let command = html! { code { "spandrel serve --vehicle HOST:PORT" } };
    let body = html! {
        @if tiles.is_empty() {
            p.message.warn { (with_element(&text!(language, "live-tiles-no-vehicle", command = ELEMENT), &command)) }
        } @else {
            noscript { p.message.warn { (text!(language, "web-no-script")) } }
            ul.tiles data-tiles data-texts=(texts(language)) { @for (number, tile) in (1..).zip(tiles) { (tile_item(language, number, tile)) } }
        }
    };
    page_with_script(
        visitor,
        "/live",
        &text!(language, "live-tiles-title"),
        (!tiles.is_empty()).then_some(assets::TILES_NAME),
        &body,
    )
}

fn tile_item(language: Language, number: usize, tile: &VehicleTile) -> Markup {
    let drawn = tile.drawings.as_ref();
    let readouts = [
        ("task", text!(language, "live-task")),
        ("time", text!(language, "live-time")),
        ("battery", text!(language, "live-battery")),
    ];
    let waiting = text!(language, "live-tile-waiting", address = ELEMENT);
    html! {
        li.tile data-tile=(number) data-job=(drawn.map_or("", |drawn| drawn.key.as_str())) {
            h2 { a href={ "/live?vehicle=" (number) } data-now="who" { (text!(language, "live-tile-vehicle", number = number)) } " " span.state data-state { (text!(language, "live-not-connected")) } }
            p.note { @match drawn { Some(drawn) => (drawn.title), None => (with_element(&waiting, &html! { code { (tile.address) } })), } }
            figure.camera data-camera hidden { img alt=(text!(language, "live-tile-camera", number = number)) data-picture=""; }
            div data-map { @if let Some((_, plan)) = drawn.and_then(|drawn| drawn.drawings.first()) { (PreEscaped(plan)) } }
            dl.readout {
                @for (key, words) in readouts { div { dt { (words) } dd data-now=(key) { "–" } } }
            }
            p.cue { (text!(language, "live-tile-cue")) " " span data-cue { "–" } }
            p.cue { (text!(language, "live-tile-hazards")) " " span data-hazards { "–" } }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::super::layout::tests::{HOSTILE_NAME, administrator, administrator_with, check, check_translated};
    use super::super::live::DrawingView;
    use super::*;

    #[test]
    fn exact_each_vehicle_has_a_tile_that_links_to_its_page() {
        let drawings = Some(JobDrawings {
            key: HOSTILE_NAME.into(),
            title: HOSTILE_NAME.into(),
            drawings: vec![(DrawingView::Above, "<svg></svg>".into())],
        });
        let tiles = [
            VehicleTile { address: HOSTILE_NAME.into(), drawings: None },
            VehicleTile { address: "127.0.0.1:14281".into(), drawings },
        ];
        let text = tiles_page(&administrator(), &tiles).into_string();
        check(&text);
        assert!(text.contains("href=\"/live?vehicle=1\"") && text.contains("href=\"/live?vehicle=2\""), "{text}");
        assert_eq!((text.matches("<svg>").count(), text.matches("Waiting for a flight").count()), (1, 1));
        let translated =
            tiles_page(&administrator_with(Language::Pseudo), &[VehicleTile { address: "7".into(), drawings: None }]);
        check_translated(&translated.into_string(), &[]);
        check_translated(&tiles_page(&administrator_with(Language::Pseudo), &[]).into_string(), &[]);
        let german = tiles_page(&administrator_with(Language::German), &tiles).into_string();
        assert!(german.contains("Laufende Flüge") && german.contains("Fluggerät 1"), "{german}");
        let none = tiles_page(&administrator(), &[]).into_string();
        assert!(none.contains("No vehicle configured") && !none.contains("tiles.js"), "{none}");
    }
}
