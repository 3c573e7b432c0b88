//! Histogram of one score with the mean marked.

use super::{coord, line, svg_figure, ticks};
use crate::report::formatting;
use crate::statistics::HistogramBin;
use maud::{Markup, html};
use spandrel_text::{Language, text};

const SIZE: (f64, f64) = (312.0, 150.0);
const LEFT_X: f64 = 44.0;
const RIGHT_X: f64 = 290.0;
const TOP_Y: f64 = 8.0;
const BOTTOM_Y: f64 = 122.0;

/// Draws the bins as bars and the mean as a vertical line.
#[must_use]
pub fn histogram(bins: &[HistogramBin], mean: f64, title: &str, language: Language) -> Markup {
    let (from, to) = (bins.first().map_or(0.0, |bin| bin.from), bins.last().map_or(1.0, |bin| bin.to));
    let max_value = bins.iter().map(|bin| bin.count).max().unwrap_or(0).max(2) as f64;
    let x =
        |value: f64| LEFT_X + (RIGHT_X - LEFT_X) * if to > from { ((value - from) / (to - from)).clamp(0.0, 1.0) } else { 0.0 };
    let y = |count: f64| BOTTOM_Y - (BOTTOM_Y - TOP_Y) * count / max_value;
    svg_figure(
        SIZE,
        title,
        "histogram",
        &html! {
            // Counts are integers, so fractional ticks are omitted.
            @for tick in ticks(max_value, 4).into_iter().filter(|tick| tick.fract() == 0.0) {
                path.grid d=(line(&[(LEFT_X, y(tick)), (RIGHT_X, y(tick))], false)) {}
                text.tick x=(coord(LEFT_X - 5.0)) y=(coord(y(tick) + 4.0)) text-anchor="end" { (formatting::number(tick, 0)) }
            }
            @for bin in bins.iter().filter(|bin| bin.count > 0) {
                rect.bar x=(coord(x(bin.from) + 0.5)) y=(coord(y(bin.count as f64))) width=(coord(x(bin.to) - x(bin.from) - 1.0)) height=(coord(BOTTOM_Y - y(bin.count as f64))) {
                    title { (text!(language, "plot-bin", count = bin.count, low = formatting::number(bin.from, 0), high = formatting::number(bin.to, 0))) }
                }
            }
            path.median d=(line(&[(x(mean), TOP_Y), (x(mean), BOTTOM_Y)], false)) { title { (text!(language, "plot-mean", mean = formatting::number(mean, 1))) } }
            @for tick in ticks(to, 4) { text.tick x=(coord(x(tick))) y=(coord(BOTTOM_Y + 17.0)) text-anchor="middle" { (formatting::number(tick, 0)) } }
        },
    )
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn exact_histogram_bar_height_is_proportional() {
        let bins = [HistogramBin { from: 0.0, to: 50.0, count: 1 }, HistogramBin { from: 50.0, to: 100.0, count: 2 }];
        let figure = histogram(&bins, 75.0, "t", Language::English).into_string();
        assert!(figure.contains("x=\"44.5\" y=\"65\" width=\"122\" height=\"57\""), "{figure}");
        assert!(figure.contains("x=\"167.5\" y=\"8\" width=\"122\" height=\"114\""), "{figure}");
        assert!(figure.contains("M228.5 8L228.5 122"), "{figure}");
        assert!(!histogram(&[], 0.0, "t", Language::English).into_string().contains("NaN"));
    }
}
