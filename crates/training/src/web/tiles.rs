//! Page with a tile for each live flight: picture or map, task, battery and cue. Each tile links to its flight's own page.

use super::access::Visitor;
use super::assets;
use super::layout::page_with_script;
use super::live::JobDrawings;
use maud::{Markup, PreEscaped, html};

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
    let body = html! {
        @if tiles.is_empty() {
            p.message.warn { "No vehicle configured. Start the server with " code { "spandrel serve --vehicle HOST:PORT" } ", once for each flight." }
        } @else {
            noscript { p.message.warn { "This page requires JavaScript." } }
            ul.tiles data-tiles { @for (number, tile) in (1..).zip(tiles) { (tile_item(number, tile)) } }
        }
    };
    page_with_script(visitor, "/live", "Live flights", (!tiles.is_empty()).then_some(assets::TILES_NAME), &body)
}

fn tile_item(number: usize, tile: &VehicleTile) -> Markup {
    let drawn = tile.drawings.as_ref();
    html! {
        li.tile data-tile=(number) data-job=(drawn.map_or("", |drawn| drawn.key.as_str())) {
            h2 { a href={ "/live?vehicle=" (number) } data-now="who" { "Vehicle " (number) } " " span.state data-state { "Not connected" } }
            p.note { @match drawn { Some(drawn) => (drawn.title), None => { "Waiting for a flight at " code { (tile.address) } } } }
            figure.camera data-camera hidden { img alt={ "Camera view of vehicle " (number) } data-picture=""; }
            div data-map { @if let Some((_, plan)) = drawn.and_then(|drawn| drawn.drawings.first()) { (PreEscaped(plan)) } }
            dl.readout {
                @for (key, words) in [("task", "Task"), ("time", "Time"), ("battery", "Battery")] { div { dt { (words) } dd data-now=(key) { "–" } } }
            }
            p.cue { "Last cue: " span data-cue { "–" } }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::super::layout::tests::{HOSTILE_NAME, administrator, check};
    use super::*;

    #[test]
    fn exact_each_vehicle_has_a_tile_that_links_to_its_page() {
        let drawings = Some(JobDrawings {
            key: HOSTILE_NAME.into(),
            title: HOSTILE_NAME.into(),
            drawings: vec![(String::new(), "<svg></svg>".into())],
        });
        let tiles = [
            VehicleTile { address: HOSTILE_NAME.into(), drawings: None },
            VehicleTile { address: "127.0.0.1:14281".into(), drawings },
        ];
        let text = tiles_page(&administrator(), &tiles).into_string();
        check(&text);
        assert!(text.contains("href=\"/live?vehicle=1\"") && text.contains("href=\"/live?vehicle=2\""), "{text}");
        assert_eq!((text.matches("<svg>").count(), text.matches("Waiting for a flight").count()), (1, 1));
        let none = tiles_page(&administrator(), &[]).into_string();
        assert!(none.contains("No vehicle configured") && !none.contains("tiles.js"), "{none}");
    }
}
