//! The map large, with the next step above it and the side profile below it.

use super::super::lesson_panel::lesson_lines;
use super::super::pane::Pane;
use super::super::state::Hud;
use super::super::task_panel::{SEPARATOR, step_lines};
use super::super::text_metrics::{fitted, text_width};
use super::super::{DrawItem, HudColor, TextAlign};
use super::area::Area;
use super::map::{MapDetail, map};
use super::profile::profile;
use super::site_outline::SiteOutline;
use spandrel_text::text;

/// Normal font size relative to the shorter side of the view, and its smallest value, px at standard pixel density.
const FONT_RATIO: f64 = 0.026;
const MIN_FONT_PX: f64 = 11.0;
/// Gap between map, profile and text, px.
const GAP_PX: f64 = 6.0;
/// Share of the profile of the height that the text leaves.
const PROFILE_SHARE: f64 = 0.3;
/// Height of a line in font sizes.
const LINE_HEIGHT: f64 = 1.4;

/// Returns the large map for a view of the given size, px at standard pixel density.
#[must_use]
pub fn large_map(hud: &Hud, site: &SiteOutline, (width, height): (f64, f64)) -> Vec<DrawItem> {
    let pane = Pane { width: width.max(1.0), height: height.max(1.0) };
    let font = (FONT_RATIO * pane.width.min(pane.height)).max(MIN_FONT_PX) * hud.style.text_scale.factor();
    let whole = Area { x: 0.0, y: 0.0, width: pane.width, height: pane.height }.inside(0.5 * GAP_PX);
    let lines = lines(hud);
    let text_height = LINE_HEIGHT * font * lines.len() as f64 + 0.4 * font;
    let part = |y: f64, height: f64| Area { y, height, ..whole }.inside(0.5 * GAP_PX);
    let rest = whole.height - text_height;
    let (map_top, profile_top) = (whole.y + text_height, whole.y + text_height + (1.0 - PROFILE_SHARE) * rest);
    let mut items = text_items(lines, pane, part(whole.y, text_height), font);
    items.extend(map(hud, site, pane, part(map_top, profile_top - map_top), (font, MapDetail::Large)));
    items.extend(profile(hud, site, pane, part(profile_top, PROFILE_SHARE * rest), font));
    items
}

/// A line of the text with an optional reading at the right.
type TextLine = (String, HudColor, Option<String>);

/// Returns the text above the map. The number of lines does not change during a flight, so that the map stays in its place.
fn lines(hud: &Hud) -> Vec<TextLine> {
    let (language, units) = (hud.style.language, hud.style.units);
    let reading = |name: String, value: String| format!("{name} {value}");
    let height = reading(text!(language, "flight-readout-height"), units.length(hud.height_m, 1));
    let home = reading(text!(language, "flight-readout-home"), units.length(hud.home_distance_m, 0));
    let readings = [height, home].join(SEPARATOR);
    let found = match &hud.lesson {
        Some(lesson) => lesson_lines(lesson, hud.style).to_vec(),
        None => step_lines(hud).unwrap_or([(String::new(), HudColor::White), (String::new(), HudColor::White)]).to_vec(),
    };
    let mut lines: Vec<TextLine> = found.into_iter().map(|(words, color)| (words, color, None)).collect();
    if let Some(first) = lines.first_mut() {
        first.2 = Some(readings);
    }
    lines
}

fn text_items(lines: Vec<TextLine>, pane: Pane, area: Area, font: f64) -> Vec<DrawItem> {
    let mut items = vec![pane.panel((area.x, area.y), area.corner())];
    let (left, right) = (area.x + 0.6 * font, area.x + area.width - 0.6 * font);
    let count = lines.len().max(1) as f64;
    for (row, (words, color, reading)) in lines.into_iter().enumerate() {
        let y = area.y + area.height * (row as f64 + 0.5) / count;
        let all = reading.as_ref().map_or(words.clone(), |reading| format!("{words}  {reading}"));
        let size = fitted(&all, font, right - left);
        let room = right - left - reading.as_ref().map_or(0.0, |reading| text_width(reading, size));
        if !words.is_empty() {
            items.push(pane.text((left, y), TextAlign::Left, fitted(&words, size, room), color, words));
        }
        if let Some(reading) = reading {
            items.push(pane.text((right, y), TextAlign::Right, size, HudColor::White, reading));
        }
    }
    items
}
