//! Figures in SVG, one file per figure. Colors are CSS classes so that they can differ between light mode, dark mode
//! and print. Coordinates are in drawing units. For each figure, the report has a table with the data.

pub mod air_section;
mod backdrop;
pub mod bars;
pub mod boxes;
pub mod colors;
pub mod histogram;
pub mod intervals;
pub mod job;
pub mod learning_curve;
pub mod likert;
pub mod lines;
pub mod map;
pub mod overlay;
pub mod path_diagram;
pub mod plot_map;
pub mod radar;
pub mod site_picture;
pub mod speed_scale;
pub mod timeline;

use maud::{Markup, html};

/// Formats a coordinate with one decimal place, omitting ".0".
#[must_use]
pub fn coord(value: f64) -> String {
    let text = format!("{value:.1}");
    let text = text.strip_suffix(".0").unwrap_or(&text);
    if text == "-0" { "0".into() } else { text.to_owned() }
}

/// Returns the path data of a polyline.
#[must_use]
pub fn line(points: &[(f64, f64)], closed: bool) -> String {
    let mut data = String::new();
    for (k, (x, y)) in points.iter().enumerate() {
        data.push(if k == 0 { 'M' } else { 'L' });
        data.push_str(&coord(*x));
        data.push(' ');
        data.push_str(&coord(*y));
    }
    if closed && !points.is_empty() {
        data.push('Z');
    }
    data
}

/// Simplifies a polyline with the Ramer-Douglas-Peucker algorithm. Omitted points are at most `within` away from the
/// result.
#[must_use]
pub fn simplify_polyline(points: &[(f64, f64)], within: f64) -> Vec<(f64, f64)> {
    if points.len() < 3 {
        return points.to_vec();
    }
    let last = points.len() - 1;
    let mut keep = vec![false; points.len()];
    (keep[0], keep[last]) = (true, true);
    let mut spans = vec![(0, last)];
    while let Some((from, to)) = spans.pop() {
        let farthest = (from + 1..to)
            .map(|k| (k, distance_to_segment(points[k], points[from], points[to])))
            .max_by(|a, b| a.1.total_cmp(&b.1));
        if let Some((k, distance)) = farthest
            && distance > within
        {
            keep[k] = true;
            spans.extend([(from, k), (k, to)]);
        }
    }
    points.iter().zip(keep).filter_map(|(point, kept)| kept.then_some(*point)).collect()
}

/// Returns the distance from a point to a segment.
fn distance_to_segment(p: (f64, f64), a: (f64, f64), b: (f64, f64)) -> f64 {
    let (dx, dy) = (b.0 - a.0, b.1 - a.1);
    let length_squared = dx * dx + dy * dy;
    let t = if length_squared > 0.0 { (((p.0 - a.0) * dx + (p.1 - a.1) * dy) / length_squared).clamp(0.0, 1.0) } else { 0.0 };
    spandrel_model::math::hypot(p.0 - a.0 - t * dx, p.1 - a.1 - t * dy)
}

/// Returns at most `target_intervals` + 1 round values for axis ticks from 0 to `max_value`.
#[must_use]
pub fn ticks(max_value: f64, target_intervals: usize) -> Vec<f64> {
    if max_value.is_nan() || max_value <= 0.0 || target_intervals == 0 {
        return vec![0.0];
    }
    let rough = max_value / target_intervals as f64;
    let mut decade = 1.0;
    while decade * 10.0 <= rough {
        decade *= 10.0;
    }
    while decade > rough {
        decade /= 10.0;
    }
    let step = [1.0, 2.0, 5.0, 10.0].map(|k| k * decade).into_iter().find(|step| *step >= rough).unwrap_or(10.0 * decade);
    (0..=target_intervals).map(|k| k as f64 * step).take_while(|tick| *tick <= max_value * (1.0 + 1e-9)).collect()
}

/// Wraps a figure in an SVG element with a title for screen readers.
#[must_use]
pub fn svg_figure((width, height): (f64, f64), title: &str, class: &str, body: &Markup) -> Markup {
    html! {
        svg class=(class) viewBox={ "0 0 " (coord(width)) " " (coord(height)) } role="img" aria-label=(title) {
            title { (title) }
            (body)
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn exact_path_data_is_compact() {
        assert_eq!(line(&[(0.0, -0.04), (1.25, 10.0)], true), "M0 0L1.2 10Z");
        assert_eq!(line(&[], true), "");
    }

    #[test]
    fn exact_simplification_keeps_ends_and_corners() {
        let straight: Vec<(f64, f64)> = (0..100).map(|k| (f64::from(k), 0.0)).collect();
        assert_eq!(simplify_polyline(&straight, 0.1), [(0.0, 0.0), (99.0, 0.0)]);
        let corner = [(0.0, 0.0), (1.0, 0.0), (2.0, 0.0), (2.0, 1.0), (2.0, 2.0)];
        assert_eq!(simplify_polyline(&corner, 0.1), [(0.0, 0.0), (2.0, 0.0), (2.0, 2.0)]);
        assert_eq!(simplify_polyline(&[], 0.1), []);
        assert_eq!(simplify_polyline(&[(1.0, 1.0)], 0.1), [(1.0, 1.0)]);
    }

    #[test]
    fn exact_ticks_are_round_numbers() {
        assert_eq!(ticks(100.0, 5), [0.0, 20.0, 40.0, 60.0, 80.0, 100.0]);
        assert_eq!(ticks(7.0, 4), [0.0, 2.0, 4.0, 6.0]);
        assert_eq!(ticks(25.0, 6), [0.0, 5.0, 10.0, 15.0, 20.0, 25.0]);
        assert_eq!(ticks(0.3, 3), [0.0, 0.1, 0.2, 0.30000000000000004]);
        assert_eq!(ticks(0.0, 3), [0.0]);
    }
}
