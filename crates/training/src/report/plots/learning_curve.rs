//! Scores by repetition with the fitted learning curve, extended by one repetition.

use super::{coord, line, svg_figure, ticks};
use crate::report::formatting;
use crate::statistics::LearningCurve;
use maud::{Markup, html};
use spandrel_text::{Language, text};

const SIZE: (f64, f64) = (312.0, 170.0);
const LEFT_X: f64 = 34.0;
const RIGHT_X: f64 = 298.0;
const TOP_Y: f64 = 8.0;
const BOTTOM_Y: f64 = 140.0;
/// Number of curve segments between two repetitions.
const SEGMENTS_PER_REPETITION: usize = 6;
/// Maximum number of numbered repetitions.
const MAX_NUMBERED_REPETITIONS: usize = 10;

/// Values and curves shown in a learning curve chart.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct PracticeChart<'a> {
    /// Score of each repetition.
    pub values: &'a [f64],
    /// Curve fitted to the scores.
    pub curve: &'a LearningCurve,
    /// Individual curves in the background, each up to its last repetition.
    pub others: &'a [LearningCurve],
    /// Maximum value of the score.
    pub max_value: f64,
}

/// Returns the position of a value at repetition `repetition` (from 1) of `count`. The prediction is at repetition
/// `count` + 1.
#[must_use]
pub fn place(repetition: f64, count: usize, value: f64, max_value: f64) -> (f64, f64) {
    let share = (repetition - 1.0) / count.max(1) as f64;
    (
        LEFT_X + 8.0 + (RIGHT_X - LEFT_X - 16.0) * share.clamp(0.0, 1.0),
        BOTTOM_Y - (BOTTOM_Y - TOP_Y) * (value / max_value).clamp(0.0, 1.0),
    )
}

/// Draws a dot for each repetition, the curve, and a ring for the prediction of the next repetition.
#[must_use]
pub fn practice(chart: &PracticeChart<'_>, title: &str, language: Language) -> Markup {
    let (count, max_value) = (chart.values.len(), chart.max_value);
    let predicted = formatting::number(chart.curve.next.min(max_value), 1);
    let at = |repetition: f64, value: f64| place(repetition, count, value, max_value);
    let along = |curve: &LearningCurve, last: usize| {
        let steps =
            (0..=SEGMENTS_PER_REPETITION * last.saturating_sub(1)).map(|k| 1.0 + k as f64 / SEGMENTS_PER_REPETITION as f64);
        line(&steps.map(|n| at(n, curve.at(n))).collect::<Vec<_>>(), false)
    };
    let step = (count + 1).div_ceil(MAX_NUMBERED_REPETITIONS).max(1);
    svg_figure(
        SIZE,
        title,
        "practice",
        &html! {
            @for tick in ticks(max_value, 4) {
                @let (_, y) = at(1.0, tick);
                path.grid d=(line(&[(LEFT_X, y), (RIGHT_X, y)], false)) {}
                text.tick x=(coord(LEFT_X - 5.0)) y=(coord(y + 4.0)) text-anchor="end" { (formatting::number(tick, 0)) }
            }
            @for k in (1..=count + 1).step_by(step) {
                text.tick x=(coord(at(k as f64, 0.0).0)) y=(coord(BOTTOM_Y + 17.0)) text-anchor="middle" { (k) }
            }
            @for other in chart.others { path.one-of-many d=(along(other, other.n.min(count))) {} }
            path.fitted d=(along(chart.curve, count + 1)) {}
            @for (k, value) in chart.values.iter().enumerate() {
                @let (x, y) = at((k + 1) as f64, *value);
                circle.dot-1 cx=(coord(x)) cy=(coord(y)) r="4" {}
            }
            @let (x, y) = at((count + 1) as f64, chart.curve.next);
            circle.expected cx=(coord(x)) cy=(coord(y)) r="4" { title { (text!(language, "plot-predicted", value = predicted)) } }
        },
    )
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::statistics::learning_curve;

    #[test]
    fn exact_practice_chart_positions_are_clamped() {
        assert_eq!(place(1.0, 4, 0.0, 100.0), (42.0, BOTTOM_Y));
        assert_eq!(place(5.0, 4, 100.0, 100.0), (290.0, TOP_Y));
        assert_eq!(place(3.0, 4, 50.0, 100.0), (166.0, 74.0));
        let values = [40.0, 60.0, 75.0, 88.0, 99.0];
        let curve = learning_curve(&values).unwrap();
        assert!(curve.next > 100.0, "{curve:?}");
        let chart = PracticeChart { values: &values, curve: &curve, others: &[curve], max_value: 100.0 };
        let figure = practice(&chart, "<t>", Language::English).into_string();
        assert_eq!((figure.matches("class=\"dot-1\"").count(), figure.matches("one-of-many").count()), (5, 1));
        assert!(figure.contains("class=\"expected\" cx=\"290\" cy=\"8\"") && figure.contains("&lt;t&gt;"), "{figure}");
    }
}
