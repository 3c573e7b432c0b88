//! The flight path's three color modes: the value shown, the legend, and segments of equal color.

use super::plot_map::{PlotMap, TRACK_TOLERANCE};
use super::{line, simplify_polyline};
use crate::report::Review;
use crate::report::formatting;
use spandrel_mavlink::contract::continuity::is_jump;
use spandrel_mavlink::telemetry::Frame;
use spandrel_text::{Language, text};

/// Limits of the clearance colors, m, ascending.
pub const CLEARANCE_LIMITS_M: [f64; 3] = [1.0, 2.5, 5.0];

/// Color modes of the flight path: CSS class of each mode's layer.
pub const COLOR_MODES: [&str; 3] = ["by-path", "by-speed", "by-clearance"];

/// Returns the selection label of a color mode.
#[must_use]
pub fn mode_name(layer: usize, language: Language) -> String {
    match layer {
        0 => text!(language, "plot-color-path"),
        1 => text!(language, "plot-color-speed"),
        _ => text!(language, "plot-color-clearance"),
    }
}

/// Returns the flight path in one color mode: the CSS class and path data of each color, in class order.
pub(super) fn track(review: &Review, map: &PlotMap, layer: usize, shown: &dyn Fn(&Frame) -> bool) -> Vec<(&'static str, String)> {
    let names = classes(layer);
    let color_segments = color_segments(review, map, names.len(), &|i| class_of(review, i, layer), shown);
    names.iter().copied().zip(color_segments).filter(|(_, data)| !data.is_empty()).collect()
}

/// Returns the path data of the entire flight path in a single color.
pub(super) fn plain_color(review: &Review, map: &PlotMap, shown: &dyn Fn(&Frame) -> bool) -> String {
    color_segments(review, map, 1, &|_| 0, shown).swap_remove(0)
}

/// Returns whether the drone was respawned between two consecutive frames.
fn was_respawned(before: &Frame, next: &Frame) -> bool {
    let step_m = (next.position_m - before.position_m).norm();
    is_jump(step_m, before.velocity_m_s.norm().max(next.velocity_m_s.norm()), next.time - before.time)
}

fn color_segments(
    review: &Review,
    map: &PlotMap,
    color_count: usize,
    color_index: &dyn Fn(usize) -> usize,
    shown: &dyn Fn(&Frame) -> bool,
) -> Vec<String> {
    let mut color_segments = vec![String::new(); color_count];
    let mut run: Vec<(f64, f64)> = Vec::new();
    let mut color = 0;
    let mut close = |run: &mut Vec<(f64, f64)>, color: usize| {
        if run.len() > 1 {
            color_segments[color].push_str(&line(&simplify_polyline(run, TRACK_TOLERANCE), false));
        }
        run.clear();
    };
    for (i, frame) in review.frames.iter().enumerate() {
        let broken = i > 0 && was_respawned(&review.frames[i - 1], frame);
        if broken || !shown(frame) {
            close(&mut run, color);
            if !shown(frame) {
                continue;
            }
        }
        let now = color_index(i);
        let here = map.at(frame.position_m);
        if now != color {
            // A line between two points of different colors has the color of the first.
            if !run.is_empty() {
                run.push(here);
            }
            close(&mut run, color);
            color = now;
        }
        run.push(here);
    }
    close(&mut run, color);
    color_segments
}

/// Returns the CSS classes of a color mode, in legend order.
#[must_use]
pub fn classes(layer: usize) -> &'static [&'static str] {
    match layer {
        0 => &["p-between", "p-on", "p-off"],
        1 => &["q-1", "q-2", "q-3", "q-4", "q-over"],
        _ => &["c-unknown", "c-4", "c-3", "c-2", "c-1"],
    }
}

/// Returns the legend of a color mode, in class order.
#[must_use]
pub fn legend(layer: usize, limit_m_s: f64, language: Language) -> Vec<String> {
    match layer {
        0 => vec![
            text!(language, "plot-legend-between"),
            text!(language, "plot-legend-on-path"),
            text!(language, "plot-legend-off-path"),
        ],
        1 => speed_legend(limit_m_s, language),
        _ => clearance_legend(language),
    }
}

fn speed_legend(limit_m_s: f64, language: Language) -> Vec<String> {
    let up_to = |share: f64| text!(language, "plot-legend-speed", speed = formatting::number(share * limit_m_s, 1));
    let over = text!(language, "plot-legend-speeding", speed = formatting::number(limit_m_s, 2));
    [0.25, 0.5, 0.75, 1.0].map(up_to).into_iter().chain([over]).collect()
}

fn clearance_legend(language: Language) -> Vec<String> {
    let [a, b, c] = CLEARANCE_LIMITS_M.map(|limit| formatting::number(limit, 1));
    vec![
        text!(language, "plot-legend-far"),
        text!(language, "plot-legend-over", limit = c.as_str()),
        text!(language, "plot-legend-range", low = b.as_str(), high = c.as_str()),
        text!(language, "plot-legend-range", low = a.as_str(), high = b.as_str()),
        text!(language, "plot-legend-under", limit = a.as_str()),
    ]
}

/// Returns the index into [`classes`] of a frame's color.
fn class_of(review: &Review, i: usize, layer: usize) -> usize {
    let frame = &review.frames[i];
    match layer {
        0 => match (review.track[i].on, review.track[i].inside) {
            (true, _) => 1,
            (false, true) => 2,
            (false, false) => 0,
        },
        1 => speed_class(frame.speed_m_s(), review.scenario.scoring.speed_limit_m_s),
        _ => frame.clearance_m.map_or(0, clearance_class),
    }
}

/// Returns the color index of a speed: one for each quarter of the limit, and one for speeds strictly above it, as in the score.
fn speed_class(speed_m_s: f64, limit_m_s: f64) -> usize {
    if speed_m_s > limit_m_s { 4 } else { ((speed_m_s / limit_m_s * 4.0).ceil() as usize).clamp(1, 4) - 1 }
}

fn clearance_class(clearance_m: f64) -> usize {
    4 - CLEARANCE_LIMITS_M.iter().filter(|limit| clearance_m >= **limit).count()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn exact_speeds_and_clearances_map_to_color_classes() {
        assert_eq!([0.0, 1.0, 1.1, 3.0, 4.0, 4.1].map(|v| speed_class(v, 4.0)), [0, 0, 1, 2, 3, 4]);
        assert_eq!([0.2, 1.0, 2.5, 5.0, 9.0].map(clearance_class), [4, 3, 2, 1, 1]);
        for layer in 0..3 {
            assert_eq!(classes(layer).len(), legend(layer, 4.0, Language::English).len());
        }
    }
}
