//! Scores by repetition with the fitted learning curve, extended by one repetition.

use super::{coord, line, svg_figure, ticks};
use crate::report::formatting;
use crate::statistics::LearningCurve;
use maud::{Markup, html};

const SIZE: (f64, f64) = (312.0, 170.0);
const LEFT: f64 = 34.0;
const RIGHT: f64 = 298.0;
const TOP: f64 = 8.0;
const BOTTOM: f64 = 140.0;
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
    pub most: f64,
}

/// Returns the position of a value at repetition `repetition` (from 1) of `count`. The prediction is at repetition
/// `count` + 1.
#[must_use]
pub fn place(repetition: f64, count: usize, value: f64, most: f64) -> (f64, f64) {
    let share = (repetition - 1.0) / count.max(1) as f64;
    (LEFT + 8.0 + (RIGHT - LEFT - 16.0) * share.clamp(0.0, 1.0), BOTTOM - (BOTTOM - TOP) * (value / most).clamp(0.0, 1.0))
}

/// Draws a dot for each repetition, the curve, and a ring for the prediction of the next repetition.
#[must_use]
pub fn practice(drawn: &PracticeChart<'_>, title: &str) -> Markup {
    let (count, most) = (drawn.values.len(), drawn.most);
    let at = |repetition: f64, value: f64| place(repetition, count, value, most);
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
            @for tick in ticks(most, 4) {
                @let (_, y) = at(1.0, tick);
                path.grid d=(line(&[(LEFT, y), (RIGHT, y)], false)) {}
                text.tick x=(coord(LEFT - 5.0)) y=(coord(y + 4.0)) text-anchor="end" { (formatting::number(tick, 0)) }
            }
            @for k in (1..=count + 1).step_by(step) {
                text.tick x=(coord(at(k as f64, 0.0).0)) y=(coord(BOTTOM + 17.0)) text-anchor="middle" { (k) }
            }
            @for other in drawn.others { path.one-of-many d=(along(other, other.n.min(count))) {} }
            path.fitted d=(along(drawn.curve, count + 1)) {}
            @for (k, value) in drawn.values.iter().enumerate() {
                @let (x, y) = at((k + 1) as f64, *value);
                circle.dot-1 cx=(coord(x)) cy=(coord(y)) r="4" {}
            }
            @let (x, y) = at((count + 1) as f64, drawn.curve.next);
            circle.expected cx=(coord(x)) cy=(coord(y)) r="4" { title { "predicted next: " (formatting::number(drawn.curve.next.min(most), 1)) } }
        },
    )
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::statistics::learning_curve;

    #[test]
    fn exact_practice_chart_positions_are_clamped() {
        assert_eq!(place(1.0, 4, 0.0, 100.0), (42.0, BOTTOM));
        assert_eq!(place(5.0, 4, 100.0, 100.0), (290.0, TOP));
        assert_eq!(place(3.0, 4, 50.0, 100.0), (166.0, 74.0));
        let values = [40.0, 60.0, 75.0, 88.0, 99.0];
        let curve = learning_curve(&values).unwrap();
        assert!(curve.next > 100.0, "{curve:?}");
        let drawn = PracticeChart { values: &values, curve: &curve, others: &[curve], most: 100.0 };
        let figure = practice(&drawn, "<t>").into_string();
        assert_eq!((figure.matches("class=\"dot-1\"").count(), figure.matches("one-of-many").count()), (5, 1));
        assert!(figure.contains("class=\"expected\" cx=\"290\" cy=\"8\"") && figure.contains("&lt;t&gt;"), "{figure}");
    }
}
