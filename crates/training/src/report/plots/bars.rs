//! Horizontal bar charts: fractions of a whole and counts by kind.

use super::{coord, svg_figure};
use crate::report::formatting;
use maud::{Markup, html};

const WIDTH: f64 = 420.0;
const LEFT_X: f64 = 4.0;
const RIGHT_X: f64 = 372.0;
const BAR_HEIGHT: f64 = 14.0;

/// A row of bars that show fractions.
#[derive(Debug, Clone, PartialEq)]
pub struct ShareRow {
    /// Label shown above the row.
    pub name: String,
    /// CSS class and fraction (0 to 1) of each bar, from top to bottom.
    pub bars: Vec<(&'static str, f64)>,
    /// Text shown in place of the bars, such as "not attempted".
    pub placeholder: Option<String>,
}

/// Returns the length of the bar for `share` on an axis that ends at `full`, in drawing units.
#[must_use]
pub fn length(share: f64, full: f64) -> f64 {
    if full > 0.0 { (RIGHT_X - LEFT_X) * (share / full).clamp(0.0, 1.0) } else { 0.0 }
}

/// Draws rows of fractions, each with its label above the bars.
#[must_use]
pub fn shares(rows: &[ShareRow], title: &str) -> Markup {
    let mut y = 4.0;
    let mut places = Vec::new();
    for row in rows {
        places.push(y);
        y += 22.0 + (BAR_HEIGHT + 4.0) * row.bars.len().max(1) as f64 + 8.0;
    }
    svg_figure(
        (WIDTH, y),
        title,
        "bars",
        &html! {
            @for (row, top) in rows.iter().zip(&places) {
                text.label x=(coord(LEFT_X)) y=(coord(top + 14.0)) { (row.name) }
                @if let Some(words) = &row.placeholder {
                    text.tick x=(coord(LEFT_X)) y=(coord(top + 22.0 + 11.0)) { (words) }
                } @else {
                    @for (k, (class, share)) in row.bars.iter().enumerate() {
                        @let at = top + 22.0 + (BAR_HEIGHT + 4.0) * k as f64;
                        rect.track x=(coord(LEFT_X)) y=(coord(at)) width=(coord(RIGHT_X - LEFT_X)) height=(coord(BAR_HEIGHT)) rx="3" {}
                        rect class=(class) x=(coord(LEFT_X)) y=(coord(at)) width=(coord(length(*share, 1.0))) height=(coord(BAR_HEIGHT)) rx="3" {}
                        text.tick x=(coord(WIDTH - 2.0)) y=(coord(at + 11.5)) text-anchor="end" { (formatting::number(100.0 * share, 0)) "%" }
                    }
                }
            }
        },
    )
}

/// A row of counts with one segment per kind.
#[derive(Debug, Clone, PartialEq)]
pub struct CountRow {
    /// Label shown above the row.
    pub name: String,
    /// CSS class and count of each segment, from left to right.
    pub kinds: Vec<(&'static str, usize)>,
}

/// Draws rows of counts on a common scale.
#[must_use]
pub fn counts(rows: &[CountRow], title: &str) -> Markup {
    let sum = |row: &CountRow| row.kinds.iter().map(|(_, count)| count).sum::<usize>();
    let max_value = rows.iter().map(sum).max().unwrap_or(0).max(4) as f64;
    svg_figure(
        (WIDTH, 40.0 * rows.len() as f64 + 4.0),
        title,
        "bars",
        &html! {
            @for (k, row) in rows.iter().enumerate() {
                @let top = 40.0 * k as f64;
                text.label x=(coord(LEFT_X)) y=(coord(top + 14.0)) { (row.name) }
                @let kinds: Vec<_> = row.kinds.iter().map(|(class, count)| (*class, *count as f64)).collect();
                @for (class, from, count) in parts(&kinds) {
                    rect class=(class) x=(coord(LEFT_X + length(from, max_value))) y=(coord(top + 19.0))
                        width=(coord((length(count, max_value) - 1.5).max(1.0))) height=(coord(BAR_HEIGHT)) rx="2" {}
                }
                @let total = sum(row);
                text.tick x=(coord(LEFT_X + length(total as f64, max_value) + 5.0)) y=(coord(top + 30.5)) { (total) }
            }
        },
    )
}

/// A bar that shows a whole and its parts.
#[derive(Debug, Clone, PartialEq)]
pub struct StackedBar {
    /// Label shown above the row.
    pub name: String,
    /// CSS class of each part and its fraction of the whole (0 to 1), from left to right. The first fraction is also shown as a
    /// number.
    pub parts: Vec<(&'static str, f64)>,
}

/// Draws stacked bars of equal length.
#[must_use]
pub fn stacked_bars(rows: &[StackedBar], title: &str) -> Markup {
    svg_figure(
        (WIDTH, 44.0 * rows.len() as f64 + 4.0),
        title,
        "bars",
        &html! {
            @for (k, row) in rows.iter().enumerate() {
                @let top = 44.0 * k as f64;
                text.label x=(coord(LEFT_X)) y=(coord(top + 14.0)) { (row.name) }
                rect.track x=(coord(LEFT_X)) y=(coord(top + 21.0)) width=(coord(RIGHT_X - LEFT_X)) height=(coord(BAR_HEIGHT)) rx="2" {}
                @for (class, from, share) in parts(&row.parts) {
                    rect class=(class) x=(coord(LEFT_X + length(from, 1.0))) y=(coord(top + 21.0)) width=(coord(length(share, 1.0))) height=(coord(BAR_HEIGHT)) {}
                }
                @let first = row.parts.first().map_or(0.0, |part| part.1);
                text.tick x=(coord(WIDTH - 2.0)) y=(coord(top + 32.5)) text-anchor="end" { (formatting::number(100.0 * first, 0)) "%" }
            }
        },
    )
}

/// Returns the CSS class, offset and length of each nonempty part.
fn parts(parts: &[(&'static str, f64)]) -> Vec<(&'static str, f64, f64)> {
    let mut before = 0.0;
    let mut out = Vec::new();
    for (class, size) in parts {
        if *size > 0.0 {
            out.push((*class, before, *size));
        }
        before += size;
    }
    out
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn exact_bar_length_is_proportional() {
        assert_eq!((length(0.0, 1.0), length(0.25, 1.0), length(1.0, 1.0)), (0.0, 92.0, 368.0));
        assert_eq!((length(2.0, 1.0), length(3.0, 12.0), length(1.0, 0.0)), (368.0, 92.0, 0.0));
        let row = ShareRow { name: "task <1>".into(), bars: vec![("on", 0.5)], placeholder: None };
        let figure = shares(&[row], "t").into_string();
        assert!(figure.contains("class=\"on\" x=\"4\" y=\"26\" width=\"184\""), "{figure}");
        assert!(figure.contains("task &lt;1&gt;") && figure.contains("50%"), "{figure}");
    }

    #[test]
    fn exact_bar_segments_are_contiguous() {
        let row = CountRow { name: "a".into(), kinds: vec![("x", 2), ("y", 0), ("z", 3)] };
        assert_eq!(parts(&[("x", 2.0), ("y", 0.0), ("z", 3.0)]), [("x", 0.0, 2.0), ("z", 2.0, 3.0)]);
        let figure = counts(&[row], "t").into_string();
        assert!(figure.contains("class=\"z\" x=\"151.2\""), "the bar for a count of 5 is 368 wide and starts at 4: {figure}");
    }

    #[test]
    fn exact_stacked_parts_are_contiguous_and_first_is_labeled() {
        let row = StackedBar { name: "deck".into(), parts: vec![("good", 0.25), ("none", 0.0), ("bad", 0.5)] };
        let figure = stacked_bars(&[row], "t").into_string();
        assert!(figure.contains("class=\"good\" x=\"4\" y=\"21\" width=\"92\""), "{figure}");
        assert!(figure.contains("class=\"bad\" x=\"96\" y=\"21\" width=\"184\"") && !figure.contains("none"), "{figure}");
        assert!(figure.contains("25%"), "{figure}");
    }
}
