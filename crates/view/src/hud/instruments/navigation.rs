//! Navigation display, heading up: artificial horizon, compass with the directions home and to the next place, and arcs for the
//! obstacles that the range finders measure.

use super::super::pane::Pane;
use super::super::state::Hud;
use super::super::style::TextScale;
use super::super::text_metrics::text_width;
use super::super::{DrawItem, HudColor, TextAlign};
use super::area::Area;
use super::clip::clip_at;
use spandrel_model::math;
use spandrel_text::text;

type Point = (f64, f64);

/// Radii relative to the display's radius: horizon, compass marks, letters, obstacle arcs of the nearest and farthest distance.
const HORIZON_RADIUS: f64 = 0.58;
const TICK_RADII: (f64, f64) = (0.60, 0.65);
const LETTER_RADIUS: f64 = 0.74;
const OBSTACLE_RADII: (f64, f64) = (0.86, 0.98);
/// Pitch at which the horizon reaches the edge of the disc, rad.
const PITCH_RANGE_RAD: f64 = 45.0 / 180.0 * math::PI;
/// Smallest ratio of width to height for texts beside the disc.
const MIN_WIDE_RATIO: f64 = 1.6;
/// Largest size of the letters relative to the disc's radius.
const MAX_LETTER_RATIO: f64 = 0.28;
/// Corners of the disc.
const CORNERS: u32 = 48;
/// Angle between two points of an obstacle arc, rad.
const ARC_STEP_RAD: f64 = 5.0 / 180.0 * math::PI;
/// Obstacles nearer than this many times the too-close distance are yellow.
const CAUTION_RATIO: f64 = 2.0;

/// The disc of the display.
struct Disc {
    pane: Pane,
    middle: Point,
    radius: f64,
    font: f64,
}

pub(super) fn navigation(hud: &Hud, pane: Pane, area: Area, font: f64) -> Vec<DrawItem> {
    // In a wide area, the texts stand at the left of the disc, otherwise above and below it.
    let beside =
        text_width(&text!(hud.style.language, "flight-instruments-obstacle"), font) + font <= 0.5 * (area.width - area.height);
    let wide = area.width >= MIN_WIDE_RATIO * area.height && (beside || hud.style.text_scale == TextScale::Normal);
    let height = if wide { area.height - 0.6 * font } else { area.height - 2.6 * font };
    let radius = 0.5 * area.width.min(height).max(1.0);
    let disc = Disc { pane, middle: area.middle(), radius, font };
    let mut items = vec![pane.panel((area.x, area.y), area.corner())];
    items.extend(disc.horizon(hud));
    items.extend(disc.compass(hud));
    items.extend(disc.obstacles(hud));
    let (x, y) = disc.middle;
    let heading = (hud.heading_rad.to_degrees().round() as i64).rem_euclid(360);
    let left = area.x + 0.5 * font;
    let (side, above, below) = if wide {
        (TextAlign::Left, (left, area.y + 0.9 * font), (left, area.y + area.height - 0.9 * font))
    } else {
        (TextAlign::Center, (x, y - radius - 0.65 * font), (x, y + radius + 0.65 * font))
    };
    items.push(pane.text(above, side, font, HudColor::White, format!("{heading:03}°")));
    if let Some([name, distance]) = obstacle_words(hud) {
        if wide {
            items.push(pane.text((below.0, below.1 - 1.1 * font), side, font, HudColor::White, name));
            items.push(pane.text(below, side, font, HudColor::White, distance));
        } else {
            let words = format!("{name} {distance}");
            let font = font.min(area.width / text_width(&words, 1.0));
            items.push(pane.text(below, side, font, HudColor::White, words));
        }
    }
    items
}

/// Returns the distance of the nearest obstacle in any direction in words; `None` without range finders.
fn obstacle_words(hud: &Hud) -> Option<[String; 2]> {
    let (language, obstacles) = (hud.style.language, hud.obstacles.as_ref()?);
    // The range finders look around, but not up and down.
    let elsewhere_m = obstacles.nearest_m.filter(|nearest_m| *nearest_m <= obstacles.range_m);
    let nearest_m = obstacles.sectors_m.iter().copied().chain(elsewhere_m).fold(f64::INFINITY, f64::min);
    let words = if nearest_m.is_finite() {
        hud.style.units.length(nearest_m, 1)
    } else {
        text!(language, "flight-instruments-none-near")
    };
    Some([text!(language, "flight-instruments-obstacle"), words])
}

impl Disc {
    /// Returns a point of the disc; `angle_rad` is clockwise from the top, `share` is relative to the radius.
    fn at(&self, angle_rad: f64, share: f64) -> Point {
        let (sin, cos) = math::sin_cos(angle_rad);
        (self.middle.0 + share * self.radius * sin, self.middle.1 - share * self.radius * cos)
    }

    /// Returns the sky and the ground as seen along the nose, and the fixed symbol of the aircraft.
    fn horizon(&self, hud: &Hud) -> Vec<DrawItem> {
        let rim: Vec<Point> =
            (0..CORNERS).map(|k| self.at(math::TAU * f64::from(k) / f64::from(CORNERS), HORIZON_RADIUS)).collect();
        let (sin, cos) = math::sin_cos(hud.roll_rad);
        let drop = (hud.pitch_rad / PITCH_RANGE_RAD).clamp(-0.95, 0.95) * HORIZON_RADIUS * self.radius;
        // Depth below the horizon, px. When the aircraft rolls right, the horizon turns left.
        let depth = |(x, y): Point| (y - self.middle.1) * cos + (x - self.middle.0) * sin - drop;
        let mut items = vec![self.pane.fill(&rim, HudColor::Sky)];
        let ground = clip_at(&rim, &depth);
        if ground.len() >= 3 {
            items.push(self.pane.fill(&ground, HudColor::Earth));
        }
        let wing = |from: f64, to: f64| {
            let at = |share: f64| (self.middle.0 + share * self.radius, self.middle.1);
            self.pane.line(&[at(from), at(to)], 0.035 * self.radius, HudColor::Yellow)
        };
        items.extend([wing(-0.36, -0.12), wing(0.12, 0.36), wing(-0.02, 0.02)]);
        items
    }

    /// Returns the compass marks, and the directions home (white square) and to the next place (yellow triangle).
    fn compass(&self, hud: &Hud) -> Vec<DrawItem> {
        let mut items = Vec::new();
        for k in 0..12 {
            let angle = math::TAU * f64::from(k) / 12.0 - hud.heading_rad;
            items.push(self.pane.line(
                &[self.at(angle, TICK_RADII.0), self.at(angle, TICK_RADII.1)],
                0.012 * self.radius,
                HudColor::Gray,
            ));
        }
        let language = hud.style.language;
        let letters = [
            (text!(language, "flight-compass-north"), 0.0),
            (text!(language, "flight-compass-east"), 1.0),
            (text!(language, "flight-compass-south"), 2.0),
            (text!(language, "flight-compass-west"), 3.0),
        ];
        for (letter, quarter) in letters {
            let place = self.at(0.25 * math::TAU * quarter - hud.heading_rad, LETTER_RADIUS);
            let font = self.font.min(MAX_LETTER_RATIO * self.radius);
            items.push(self.pane.text(place, TextAlign::Center, font, HudColor::White, letter));
        }
        let home = hud.pad_m - hud.position_m;
        if home.horizontal_norm() > 1.0 {
            let angle = math::atan2(home.east(), home.north()) - hud.heading_rad;
            let (place, side) = (self.at(angle, 0.5 * (TICK_RADII.1 + OBSTACLE_RADII.0)), 0.045 * self.radius);
            let square = [(-side, -side), (side, -side), (side, side), (-side, side)].map(|(x, y)| (place.0 + x, place.1 + y));
            items.push(self.pane.fill(&square, HudColor::White));
        }
        let lesson = hud.lesson.as_ref().and_then(|lesson| lesson.status.way);
        if let Some(way) = lesson.or(hud.guidance.and_then(|guidance| guidance.first_way())) {
            let (tip, spread) = (OBSTACLE_RADII.0 - 0.01, 0.07);
            let angle = way.bearing_rad;
            let corners = [self.at(angle, tip), self.at(angle + spread, TICK_RADII.0), self.at(angle - spread, TICK_RADII.0)];
            items.push(self.pane.fill(&corners, HudColor::Yellow));
        }
        items
    }

    /// Returns an arc for each obstacle: the nearer, the closer to the middle and the thicker.
    fn obstacles(&self, hud: &Hud) -> Vec<DrawItem> {
        let Some(obstacles) = &hud.obstacles else { return Vec::new() };
        let count = obstacles.sectors_m.len().max(1);
        let width_rad = math::TAU / count as f64;
        let mut items = Vec::new();
        let mut first = 0;
        while first < obstacles.sectors_m.len() {
            let distance_m = obstacles.sectors_m[first];
            // Sectors with the reading of the same range finder form one arc.
            let last =
                (first..count).take_while(|k| obstacles.sectors_m[*k].to_bits() == distance_m.to_bits()).last().unwrap_or(first);
            let (from, to) = ((first as f64 - 0.5) * width_rad, (last as f64 + 0.5) * width_rad);
            first = last + 1;
            if !distance_m.is_finite() {
                continue;
            }
            let share = (distance_m / obstacles.range_m.max(1.0)).clamp(0.0, 1.0);
            let (color, width) = match distance_m / obstacles.too_close_m.max(0.1) {
                near if near <= 1.0 => (HudColor::Red, 0.06),
                near if near <= CAUTION_RATIO => (HudColor::Yellow, 0.04),
                _ => (HudColor::Gray, 0.02),
            };
            let radius = OBSTACLE_RADII.0 + share * (OBSTACLE_RADII.1 - OBSTACLE_RADII.0);
            let steps = ((to - from) / ARC_STEP_RAD).ceil().max(1.0);
            let points: Vec<Point> =
                (0..=steps as u32).map(|k| self.at(from + (to - from) * f64::from(k) / steps, radius)).collect();
            items.push(self.pane.line(&points, width * self.radius, color));
        }
        items
    }
}
