//! Two flights of the same job in one drawing, each in its own color. Both drones follow the page's slider.

use super::backdrop::{ground, lake};
use super::colors::plain_color;
use super::map::{
    bounding_points, is_near_bridge, near_bridge_data, north, pad, reference_paths, scale, side_view_map, structure,
};
use super::plot_map::PlotMap;
use super::{coord, svg_figure};
use crate::report::Review;
use crate::report::formatting;
use crate::terms::contact_title;
use maud::{Markup, html};
use spandrel_mavlink::telemetry::Frame;
use spandrel_model::scenario::Bridge;
use spandrel_model::site::outline::ParallelView;
use spandrel_monitor::measures::crash::Crash;
use spandrel_text::text;

/// Draws the plan view with north up.
#[must_use]
pub fn plan(both: [&Review; 2]) -> Markup {
    let map = PlotMap::around(ParallelView::plan(), &both.map(bounding_points).concat());
    svg_figure(
        map.size,
        &text!(both[0].metadata.language, "plot-both-plan"),
        "map",
        &html! {
            (lake(&both[0].scenario, &both[0].site, &map))
            (structure(&both[0].site, &map, None))
            (flights(both, &map, None, &|_| true))
            (north(&map, both[0].metadata.language))
        },
    )
}

/// Draws one bridge from the side, with both flights near it.
#[must_use]
pub fn elevation(both: [&Review; 2], bridge: &Bridge) -> Markup {
    let near = is_near_bridge(bridge);
    let [first, _] = both;
    let flown = both.into_iter().flat_map(|review| review.frames.iter()).filter(|frame| near(frame));
    let map = side_view_map(&first.scenario, &first.site, bridge, flown);
    svg_figure(
        map.size,
        &text!(first.metadata.language, "plot-both-side", bridge = bridge.name.as_str()),
        "map",
        &html! {
            (ground(&first.scenario, &first.site, &map, bridge))
            (structure(&first.site, &map, Some(&format!("{}/", bridge.name))))
            (flights(both, &map, Some(bridge), &near))
        },
    )
}

/// Draws a job without bridges from the south.
#[must_use]
pub fn from_south(both: [&Review; 2]) -> Markup {
    let map = PlotMap::around(ParallelView::from_south(), &both.map(bounding_points).concat());
    let body = html! { (structure(&both[0].site, &map, None)) (flights(both, &map, None, &|_| true)) };
    svg_figure(map.size, &text!(both[0].metadata.language, "plot-both-south"), "map", &body)
}

fn flights(both: [&Review; 2], map: &PlotMap, bridge: Option<&Bridge>, shown: &dyn Fn(&Frame) -> bool) -> Markup {
    let language = both[0].metadata.language;
    html! {
        (reference_paths(&both[0].scenario, map, bridge.map(|bridge| bridge.name.as_str()), language))
        @for (k, review) in both.into_iter().enumerate() {
            path class={ "overlaid line-" (k + 1) } d=(plain_color(review, map, shown)) { title { (text!(language, "plot-session", session = k + 1)) } }
        }
        (pad(&both[0].scenario, map, language))
        @for (k, review) in both.into_iter().enumerate() { (crashes(k, review, map, shown)) }
        @for k in 0..2 {
            g class={ "drone drone-" (k + 1) } data-flight=(k) data-matrix=(map.matrix()) data-near=[bridge.map(near_bridge_data)] {
                circle r="9" {}
                text.mark y="4" text-anchor="middle" { (k + 1) }
            }
        }
        (scale(map))
    }
}

fn crashes(k: usize, review: &Review, map: &PlotMap, shown: &dyn Fn(&Frame) -> bool) -> Markup {
    let language = review.metadata.language;
    let title = |crash: &Crash| {
        let (object, moment) = (contact_title(crash.with.label(), language), formatting::clock(review.t_s(crash.frame)));
        text!(language, "plot-session-crash", session = k + 1, object = object, moment = moment)
    };
    html! {
        @for crash in review.crashes.iter().filter(|crash| shown(&review.frames[crash.frame])) {
            @let (x, y) = map.at(review.frames[crash.frame].position_m);
            g class={ "crash of-" (k + 1) } transform={ "translate(" (coord(x)) " " (coord(y)) ")" } {
                path d="M-5 -5L5 5M5 -5L-5 5" {}
                title { (title(crash)) }
            }
        }
    }
}
