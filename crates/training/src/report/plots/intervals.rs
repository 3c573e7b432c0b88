//! Estimates with confidence intervals, one per row, with a line at zero.

use super::{coord, line, svg_figure, ticks};
use crate::report::formatting;
use maud::{Markup, html};

const WIDTH: f64 = 620.0;
const LEFT_X: f64 = 220.0;
const RIGHT_X: f64 = 600.0;
const ROW_HEIGHT: f64 = 34.0;
/// Margin beyond the outermost values, as a fraction of their range.
const AXIS_MARGIN: f64 = 0.08;

/// An estimate with its confidence interval.
#[derive(Debug, Clone, PartialEq)]
pub struct IntervalEstimate {
    /// Label at the left of the row.
    pub name: String,
    /// Estimated value, shown as a dot.
    pub value: f64,
    /// Lower and upper bounds of the interval, if one could be computed.
    pub interval: Option<[f64; 2]>,
}

/// Returns the axis range: all estimates, intervals and zero, plus a margin.
#[must_use]
pub fn axis_range(estimates: &[IntervalEstimate]) -> (f64, f64) {
    let all = estimates.iter().flat_map(|one| [Some(one.value), one.interval.map(|i| i[0]), one.interval.map(|i| i[1])]);
    let (low, high) = all.flatten().fold((0.0, 0.0), |(low, high): (f64, f64), value| (low.min(value), high.max(value)));
    let room = if high > low { AXIS_MARGIN * (high - low) } else { 1.0 };
    (low - room, high + room)
}

/// Returns the horizontal position of a value on an axis with this range.
#[must_use]
pub fn x_of(value: f64, (low, high): (f64, f64)) -> f64 {
    LEFT_X + (RIGHT_X - LEFT_X) * if high > low { ((value - low) / (high - low)).clamp(0.0, 1.0) } else { 0.5 }
}

/// Draws all estimates on a common axis with the label `axis`.
#[must_use]
pub fn intervals(estimates: &[IntervalEstimate], axis: &str, title: &str) -> Markup {
    let ends = axis_range(estimates);
    let bottom = ROW_HEIGHT * estimates.len() as f64 + 4.0;
    let reach = ends.0.abs().max(ends.1.abs());
    let ticks = ticks(reach, 4);
    let below = ticks.iter().skip(1).map(|tick| -tick);
    let marks: Vec<f64> = below.chain(ticks.iter().copied()).filter(|tick| (ends.0..=ends.1).contains(tick)).collect();
    let digits = if reach < 1.0 { 2 } else { 1 };
    svg_figure(
        (WIDTH, bottom + 42.0),
        title,
        "intervals",
        &html! {
            @for tick in &marks {
                path.grid d=(line(&[(x_of(*tick, ends), 0.0), (x_of(*tick, ends), bottom)], false)) {}
                text.tick x=(coord(x_of(*tick, ends))) y=(coord(bottom + 15.0)) text-anchor="middle" { (formatting::number(*tick, digits)) }
            }
            path.zero d=(line(&[(x_of(0.0, ends), 0.0), (x_of(0.0, ends), bottom)], false)) {}
            text.tick x=(coord(0.5 * (LEFT_X + RIGHT_X))) y=(coord(bottom + 34.0)) text-anchor="middle" { (axis) }
            @for (k, one) in estimates.iter().enumerate() {
                @let y = ROW_HEIGHT * k as f64 + 0.5 * ROW_HEIGHT;
                text.label x=(coord(LEFT_X - 12.0)) y=(coord(y + 5.0)) text-anchor="end" { (one.name) }
                @if let Some([low, high]) = one.interval {
                    path.whisker d={
                        (line(&[(x_of(low, ends), y), (x_of(high, ends), y)], false))
                        (line(&[(x_of(low, ends), y - 6.0), (x_of(low, ends), y + 6.0)], false))
                        (line(&[(x_of(high, ends), y - 6.0), (x_of(high, ends), y + 6.0)], false))
                    } {}
                }
                circle.dot-1 cx=(coord(x_of(one.value, ends))) cy=(coord(y)) r="5" { title { (one.name) ": " (formatting::number(one.value, 2)) } }
            }
        },
    )
}

#[cfg(test)]
mod tests {
    use super::*;

    fn estimate(value: f64, interval: Option<[f64; 2]>) -> IntervalEstimate {
        IntervalEstimate { name: "<a>".into(), value, interval }
    }

    #[test]
    fn exact_axis_contains_all_intervals_and_zero() {
        let all = [estimate(-2.0, Some([-4.0, -1.0])), estimate(0.5, Some([0.0, 1.0])), estimate(0.2, None)];
        assert_eq!(axis_range(&all), (-4.4, 1.4));
        assert_eq!((x_of(-4.4, axis_range(&all)), x_of(1.4, axis_range(&all))), (220.0, 600.0));
        let figure = intervals(&all, "points", "t").into_string();
        assert_eq!((figure.matches("class=\"whisker\"").count(), figure.matches("<circle").count()), (2, 3));
        assert_eq!(
            figure.matches("class=\"grid\"").count(),
            3,
            "one tick each at -4, -2 and 0, and none beyond the ends: {figure}"
        );
        assert!(figure.contains("class=\"zero\"") && figure.contains("&lt;a&gt;"), "{figure}");
        assert_eq!(axis_range(&[estimate(0.0, None)]), (-1.0, 1.0));
        assert_eq!(axis_range(&[]), (-1.0, 1.0));
    }
}
