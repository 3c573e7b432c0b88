//! The air around the bridges: where they slow, turn and stir the wind, and where the drone met it.

use super::figure::{figure, legend};
use super::moment;
use crate::report::bridge_air::BridgeAir;
use crate::report::plots::air_section::{AirSection, TURBULENCE_LEVELS};
use crate::report::plots::speed_scale::CLASSES;
use crate::report::table::folded;
use crate::report::{Review, formatting};
use maud::{Markup, html};
use spandrel_text::{Language, text};

/// CSS classes of the speeds, slowest first.
const SPEED_CLASSES: [&str; CLASSES] = ["air-0", "air-1", "air-2", "air-3", "air-4", "air-5", "air-6", "air-7"];

/// Renders the air around each bridge that was flown; empty if the bridges don't disturb the wind.
pub fn figures(review: &Review) -> Markup {
    let language = review.metadata.language;
    let all: Vec<BridgeAir> = review.scenario.bridges.iter().filter_map(|bridge| BridgeAir::of(review, bridge)).collect();
    html! {
        @if !all.is_empty() {
            h3 { (text!(language, "report-air-title")) }
            p.note { (text!(language, "report-air-about")) }
            (places(review))
            @for air in &all { (drawings(review, air)) }
        }
    }
}

/// Renders the places where the air was disturbed most; empty without any.
fn places(review: &Review) -> Markup {
    let language = review.metadata.language;
    html! {
        @if !review.air.places.is_empty() {
            p { (text!(language, "report-air-places")) }
            ol.air-places {
                @for place in &review.air.places {
                    @let speed = formatting::number(place.added_m_s.norm(), 1);
                    li { (moment::link(place.at_s)) " " @if let Some(zone) = place.zone { (zone.words(&review.scenario, language)) ": " }
                        (text!(language, "report-air-off", speed = speed)) }
                }
            }
            (folded(language, |language| review.air.table(&review.scenario, language)))
        }
    }
}

fn drawings(review: &Review, air: &BridgeAir) -> Markup {
    let (language, bridge) = (review.metadata.language, air.bridge.name.as_str());
    let (speed, from) = (formatting::number(air.wind.speed_m_s, 1), bearing(air.wind.from_rad.to_degrees()));
    let height = formatting::number(air.level.through_m.up() - review.scenario.terrain.water_level_m, 0);
    let (station, heading) = (formatting::number(air.along_m.abs(), 0), bearing(air.bridge.heading_deg));
    let toward = bearing(air.bridge.heading_deg + if air.along_m < 0.0 { 180.0 } else { 0.0 });
    let level = text!(language, "report-air-level", bridge = bridge, height = height);
    let across = text!(language, "report-air-across", bridge = bridge, station = station, toward = toward, heading = heading);
    let drawn = |section: &AirSection, caption: &str| {
        let title = described(section, caption, language);
        let drawing = section.drawing(review, air.bridge, air.speeds, &title);
        figure(caption, &html! { div.scroll.wide tabindex="0" role="region" aria-label=(caption) { (drawing) } })
    };
    html! {
        p { (text!(language, "report-air-wind", bridge = bridge, speed = speed, from = from)) }
        (speed_legend(air, language))
        (mark_legend(language))
        (drawn(&air.level, &level))
        (drawn(&air.across, &across))
    }
}

/// Formats a direction in degrees, 0 to 359.
fn bearing(degrees: f64) -> String {
    formatting::number(degrees.round().rem_euclid(360.0), 0)
}

/// Returns a figure's caption with the range of the speeds, for screen readers.
fn described(section: &AirSection, caption: &str, language: Language) -> String {
    let (slowest, fastest) = section.speed_range_m_s();
    let [slowest, fastest] = [slowest, fastest].map(|speed| formatting::number(speed, 1));
    text!(language, "plot-air", caption = caption, slowest = slowest, fastest = fastest)
}

fn speed_legend(air: &BridgeAir, language: Language) -> Markup {
    let entry = |(class, css): (usize, &&'static str)| {
        let (low, high) = air.speeds.limits_m_s(class);
        let [low, high] = [low, high].map(|limit| formatting::number(limit, air.speeds.digits()));
        (*css, text!(language, "plot-legend-air-speed", low = low, high = high))
    };
    let fastest = air.level.speed_range_m_s().1.max(air.across.speed_range_m_s().1);
    let used = air.speeds.class(fastest) + 1;
    legend(&SPEED_CLASSES.iter().enumerate().take(used).map(entry).collect::<Vec<_>>())
}

fn mark_legend(language: Language) -> Markup {
    let level =
        |k: usize| text!(language, "plot-legend-air-turbulence", share = formatting::number(100.0 * TURBULENCE_LEVELS[k], 0));
    html! {
        ul.legend {
            li { svg.swatch viewBox="0 0 14 14" aria-hidden="true" { path.air-arrows d="M1 7h12l-4.5 -3m4.5 3l-4.5 3" {} } (text!(language, "plot-legend-air-arrow")) }
            li { svg.swatch viewBox="0 0 14 14" aria-hidden="true" { path.turbulence d="M4 10l6 -6" {} } (level(0)) }
            li { svg.swatch viewBox="0 0 14 14" aria-hidden="true" { path.turbulence d="M4 10l6 -6M4 4l6 6" {} } (level(1)) }
            li { svg.swatch viewBox="0 0 14 14" aria-hidden="true" { path.air-flown d="M0 7H14" {} } (text!(language, "plot-legend-air-flown")) }
            li { svg.swatch viewBox="0 0 14 14" aria-hidden="true" { path.air-flown.far d="M0 7H14" {} } (text!(language, "plot-legend-air-flown-far")) }
            li { svg.swatch viewBox="0 0 14 14" aria-hidden="true" { path.air-deck d="M0 7H14" {} } (text!(language, "plot-legend-air-deck")) }
        }
    }
}
