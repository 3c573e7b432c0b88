//! Timeline of the session with a common time axis: rows for control source, tasks, feedback, pictures and gaps.

use super::{coord, line, svg_figure, ticks};
use crate::report::formatting;
use maud::{Markup, html};

const WIDTH: f64 = 900.0;
const LEFT_X: f64 = 118.0;
const RIGHT_X: f64 = 890.0;
const ROW_HEIGHT: f64 = 26.0;

/// A row of the timeline.
#[derive(Debug, Clone, PartialEq)]
pub struct TimelineRow {
    /// Label at the left of the row.
    pub name: String,
    /// Intervals: CSS class, start and end (s), and description.
    pub intervals: Vec<(String, f64, f64, String)>,
    /// Events: CSS class, time (s), and description.
    pub marks: Vec<(String, f64, String)>,
}

/// Returns the horizontal position of a time in the drawing.
#[must_use]
pub fn x_of(t_s: f64, end_s: f64) -> f64 {
    LEFT_X + (RIGHT_X - LEFT_X) * if end_s > 0.0 { (t_s / end_s).clamp(0.0, 1.0) } else { 0.0 }
}

/// Draws all rows on a time axis from 0 to `end_s`.
#[must_use]
pub fn strips(rows: &[TimelineRow], end_s: f64, title: &str) -> Markup {
    let bottom = 6.0 + ROW_HEIGHT * rows.len() as f64;
    // Ticks at whole or half minutes are easier to read than ticks at tenths of a minute.
    let minutes = ticks(end_s / 60.0, 8);
    svg_figure(
        (WIDTH, bottom + 26.0),
        title,
        "strips",
        &html! {
            @for minute in &minutes {
                @let x = x_of(60.0 * minute, end_s);
                path.grid d=(line(&[(x, 2.0), (x, bottom)], false)) {}
                text.tick x=(coord(x)) y=(coord(bottom + 16.0)) text-anchor="middle" { (formatting::clock(60.0 * minute)) }
            }
            @for (k, row) in rows.iter().enumerate() {
                @let top = 6.0 + ROW_HEIGHT * k as f64;
                text.label x=(coord(LEFT_X - 10.0)) y=(coord(top + 14.0)) text-anchor="end" { (row.name) }
                path.grid d=(line(&[(LEFT_X, top + 9.5), (RIGHT_X, top + 9.5)], false)) {}
                @for (class, from_s, to_s, said) in &row.intervals {
                    @let x = x_of(*from_s, end_s);
                    rect class=(class) x=(coord(x)) y=(coord(top + 2.0)) width=(coord((x_of(*to_s, end_s) - x).max(1.5))) height="15" rx="2" {
                        title { (said) }
                    }
                }
                @for (class, t_s, said) in &row.marks {
                    circle class=(class) cx=(coord(x_of(*t_s, end_s))) cy=(coord(top + 9.5)) r="5" { title { (said) } }
                }
            }
            path.cursor data-left=(coord(LEFT_X)) data-right=(coord(RIGHT_X)) d=(line(&[(0.0, 0.0), (0.0, bottom)], false)) {}
        },
    )
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn exact_timeline_positions_increase_with_time() {
        assert_eq!((x_of(0.0, 100.0), x_of(50.0, 100.0), x_of(100.0, 100.0)), (118.0, 504.0, 890.0));
        assert_eq!((x_of(-1.0, 100.0), x_of(101.0, 100.0), x_of(1.0, 0.0)), (118.0, 890.0, 118.0));
        let row = TimelineRow {
            name: "row".into(),
            intervals: vec![("on".into(), 25.0, 75.0, "<said>".into())],
            marks: vec![("hit".into(), 100.0, String::new())],
        };
        let figure = strips(&[row], 100.0, "t").into_string();
        assert!(figure.contains("x=\"311\" y=\"8\" width=\"386\""), "{figure}");
        assert!(figure.contains("cx=\"890\"") && figure.contains("&lt;said&gt;"), "{figure}");
    }
}
