//! Box plots side by side on a common scale.

use super::{coord, line, svg_figure, ticks};
use crate::report::formatting;
use crate::statistics::BoxPlot;
use maud::{Markup, html};
use spandrel_text::{Language, text};

const LEFT_X: f64 = 40.0;
const TOP_Y: f64 = 10.0;
const BOTTOM_Y: f64 = 190.0;
const BOX_SPACING: f64 = 56.0;
const HALF_BOX_WIDTH: f64 = 15.0;

/// A labeled box plot.
#[derive(Debug, Clone, PartialEq)]
pub struct NamedBox<'a> {
    /// Label below the box.
    pub name: String,
    /// Box plot data.
    pub plot: &'a BoxPlot,
}

/// Returns the vertical position of a value on a scale from `low` to `high`.
#[must_use]
pub fn y_of(value: f64, (low, high): (f64, f64)) -> f64 {
    let share = if high > low { (value - low) / (high - low) } else { 0.5 };
    BOTTOM_Y - (BOTTOM_Y - TOP_Y) * share.clamp(0.0, 1.0)
}

/// Draws box plots on a vertical scale from 0 to `max_value`.
#[must_use]
pub fn boxes(named: &[NamedBox<'_>], max_value: f64, title: &str, language: Language) -> Markup {
    // Sets a minimum width so that a few boxes are not enlarged.
    let width = LEFT_X + BOX_SPACING * named.len().max(5) as f64 + 10.0;
    let y = |value: f64| y_of(value, (0.0, max_value));
    svg_figure(
        (width, BOTTOM_Y + 26.0),
        title,
        "boxes",
        &html! {
            @for tick in ticks(max_value, 5) {
                path.grid d=(line(&[(LEFT_X, y(tick)), (width, y(tick))], false)) {}
                text.tick x=(coord(LEFT_X - 6.0)) y=(coord(y(tick) + 4.0)) text-anchor="end" { (formatting::number(tick, 0)) }
            }
            @for (k, one) in named.iter().enumerate() {
                @let x = LEFT_X + BOX_SPACING * (k as f64 + 0.5);
                @let b = one.plot;
                path.whisker d={
                    (line(&[(x, y(b.high_whisker)), (x, y(b.q3))], false)) (line(&[(x, y(b.q1)), (x, y(b.low_whisker))], false))
                    (line(&[(x - 7.0, y(b.high_whisker)), (x + 7.0, y(b.high_whisker))], false))
                    (line(&[(x - 7.0, y(b.low_whisker)), (x + 7.0, y(b.low_whisker))], false))
                } {}
                rect.box x=(coord(x - HALF_BOX_WIDTH)) y=(coord(y(b.q3))) width=(coord(2.0 * HALF_BOX_WIDTH)) height=(coord((y(b.q1) - y(b.q3)).max(1.0))) {
                    title { (box_text(one, language)) }
                }
                path.median d=(line(&[(x - HALF_BOX_WIDTH, y(b.median)), (x + HALF_BOX_WIDTH, y(b.median))], false)) {}
                path.mean d=(line(&[(x - 4.0, y(b.mean) - 4.0), (x + 4.0, y(b.mean) + 4.0)], false)) {}
                path.mean d=(line(&[(x - 4.0, y(b.mean) + 4.0), (x + 4.0, y(b.mean) - 4.0)], false)) {}
                @for place in outlier_positions(&b.outliers, y) { circle.outlier cx=(coord(x)) cy=(place) r="3" {} }
                text.tick x=(coord(x)) y=(coord(BOTTOM_Y + 18.0)) text-anchor="middle" { (one.name) }
            }
        },
    )
}

fn box_text(one: &NamedBox<'_>, language: Language) -> String {
    let plot = one.plot;
    text!(
        language,
        "plot-box",
        name = one.name.as_str(),
        median = formatting::number(plot.median, 1),
        low = formatting::number(plot.q1, 1),
        high = formatting::number(plot.q3, 1),
        trainees = plot.n
    )
}

/// Returns the vertical positions of the outliers, ascending, rounded to whole units and without duplicates.
fn outlier_positions(outliers: &[f64], y: impl Fn(f64) -> f64) -> Vec<String> {
    let mut places: Vec<String> = outliers.iter().map(|value| coord(y(*value).round())).collect();
    places.dedup();
    places
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::statistics::box_plot;

    #[test]
    fn exact_box_spans_quartiles_and_outliers_lie_outside() {
        assert_eq!([0.0, 50.0, 100.0].map(|value| y_of(value, (0.0, 100.0))), [190.0, 100.0, 10.0]);
        let plot = box_plot(&[50.0, 50.0, 50.0, 60.0, 70.0, 70.0, 70.0, 0.0]).unwrap();
        assert_eq!((plot.q1, plot.median, plot.q3, plot.outliers.len()), (50.0, 55.0, 70.0, 1));
        let figure = boxes(&[NamedBox { name: "<1>".into(), plot: &plot }], 100.0, "t", Language::English).into_string();
        assert!(figure.contains("class=\"box\" x=\"53\" y=\"64\" width=\"30\" height=\"36\""), "{figure}");
        assert_eq!(outlier_positions(&[1.0, 1.4, 3.0], |value| value), ["1", "3"]);
        assert!(figure.contains("cy=\"190\"") && figure.contains("&lt;1&gt;"), "{figure}");
    }
}
