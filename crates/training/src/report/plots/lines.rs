//! Line chart over repetitions: one line per score or task, one point per session.

use super::{coord, line, svg_figure, ticks};
use crate::report::formatting;
use maud::{Markup, html};

const SIZE: (f64, f64) = (420.0, 240.0);
const LEFT_X: f64 = 36.0;
const RIGHT_X: f64 = 408.0;
const TOP_Y: f64 = 10.0;
const BOTTOM_Y: f64 = 206.0;
/// Number of line colors.
const LINE_COLORS: usize = 4;

/// A line in the chart.
#[derive(Debug, Clone, PartialEq)]
pub struct ChartLine {
    /// Name of the score or task.
    pub name: String,
    /// Style number from 1. Styles above 4 use the same colors with dashed lines.
    pub style: usize,
    /// Value for each session; `None` if the score does not apply.
    pub values: Vec<Option<f64>>,
}

/// Returns the position of a value in session `k` (from 0) of `count`; `max_value` is the maximum value.
#[must_use]
pub fn place(k: usize, count: usize, value: f64, max_value: f64) -> (f64, f64) {
    let share = if count > 1 { k as f64 / (count - 1) as f64 } else { 0.5 };
    (LEFT_X + 14.0 + (RIGHT_X - LEFT_X - 28.0) * share, BOTTOM_Y - (BOTTOM_Y - TOP_Y) * (value / max_value).clamp(0.0, 1.0))
}

/// Draws the lines on a vertical scale from 0 to `max_value`, with session numbers below.
#[must_use]
pub fn lines(lines: &[ChartLine], max_value: f64, title: &str) -> Markup {
    let count = lines.iter().map(|line| line.values.len()).max().unwrap_or(0);
    // With many sessions, only some are numbered.
    let step = count.div_ceil(12).max(1);
    svg_figure(
        SIZE,
        title,
        "lines",
        &html! {
            @for tick in ticks(max_value, 5) {
                @let (_, y) = place(0, 1, tick, max_value);
                path.grid d=(line(&[(LEFT_X, y), (RIGHT_X, y)], false)) {}
                text.tick x=(coord(LEFT_X - 6.0)) y=(coord(y + 4.0)) text-anchor="end" { (formatting::number(tick, 0)) }
            }
            @for k in (0..count).step_by(step) {
                @let (x, _) = place(k, count, 0.0, max_value);
                text.tick x=(coord(x)) y=(coord(BOTTOM_Y + 18.0)) text-anchor="middle" { (k + 1) }
            }
            @for one in lines {
                @let points = points(one, count, max_value);
                path class={ "line line-" (color_number(one.style)) @if one.style > LINE_COLORS { " broken" } } d=(line(&points, false)) {}
                @for (x, y) in &points { circle class={ "dot-" (color_number(one.style)) } cx=(coord(*x)) cy=(coord(*y)) r="4" {} }
            }
        },
    )
}

/// Returns the color number of a style, 1 to 4.
#[must_use]
pub fn color_number(style: usize) -> usize {
    (style.max(1) - 1) % LINE_COLORS + 1
}

fn points(one: &ChartLine, count: usize, max_value: f64) -> Vec<(f64, f64)> {
    one.values.iter().enumerate().filter_map(|(k, value)| value.map(|value| place(k, count, value, max_value))).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn exact_line_chart_positions_and_missing_scores() {
        assert_eq!(place(0, 3, 0.0, 100.0), (50.0, BOTTOM_Y));
        assert_eq!(place(2, 3, 100.0, 100.0), (394.0, TOP_Y));
        assert_eq!(place(0, 1, 50.0, 100.0), (222.0, 108.0));
        let one = ChartLine { name: "a".into(), style: 1, values: vec![Some(0.0), None, Some(100.0)] };
        let figure = lines(&[one], 100.0, "<t>").into_string();
        assert!(figure.contains("d=\"M50 206L394 10\"") && figure.contains("&lt;t&gt;"), "{figure}");
        assert_eq!(figure.matches("<circle").count(), 2);
        assert_eq!([1, 4, 5, 8, 9].map(color_number), [1, 4, 1, 4, 1]);
    }
}
