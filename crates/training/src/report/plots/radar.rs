//! Radar chart (Kiviat diagram) with one axis per score, 0 at the center and 100 at the edge.

use super::{coord, line, svg_figure};
use crate::report::formatting;
use maud::{Markup, html};
use spandrel_model::math;
use spandrel_text::{Language, text};

const SIZE: (f64, f64) = (520.0, 360.0);
const CENTER: (f64, f64) = (260.0, 186.0);
const RADIUS: f64 = 118.0;

/// One axis of the chart.
#[derive(Debug, Clone, PartialEq)]
pub struct RadarAxis {
    /// Score name.
    pub name: String,
    /// Value for each session, 0 to 100; `None` if the score does not apply.
    pub values: Vec<Option<f64>>,
}

/// Returns the position of `pct` on axis `k` of `count`, right and down from the center. The first axis points up; the others
/// follow clockwise.
#[must_use]
pub fn place(k: usize, count: usize, pct: f64) -> (f64, f64) {
    let (s, c) = math::sin_cos(math::TAU * k as f64 / count.max(1) as f64);
    let r = RADIUS * pct / 100.0;
    (r * s, -r * c)
}

/// Draws one or more sessions in the same chart.
#[must_use]
pub fn radar(spokes: &[RadarAxis], title: &str, language: Language) -> Markup {
    let count = spokes.len();
    let value = |value: &Option<f64>| match value {
        Some(pct) => formatting::number(*pct, 0),
        None => text!(language, "plot-not-applicable"),
    };
    let at = |k: usize, pct: f64| {
        let (x, y) = place(k, count, pct);
        (CENTER.0 + x, CENTER.1 + y)
    };
    let ring = |pct: f64| line(&(0..count).map(|k| at(k, pct)).collect::<Vec<_>>(), true);
    let sessions = spokes.iter().map(|spoke| spoke.values.len()).max().unwrap_or(0);
    let shape = |session: usize| -> Vec<(f64, f64)> {
        let value = |spoke: &RadarAxis| spoke.values.get(session).copied().flatten();
        spokes.iter().enumerate().filter_map(|(k, spoke)| value(spoke).map(|pct| at(k, pct))).collect()
    };
    svg_figure(
        SIZE,
        title,
        "radar",
        &html! {
            @for pct in [25.0, 50.0, 75.0, 100.0] {
                path.grid d=(ring(pct)) {}
                @if pct < 100.0 { text.tick x=(coord(CENTER.0 + 4.0)) y=(coord(CENTER.1 - RADIUS * pct / 100.0 + 4.0)) { (formatting::number(pct, 0)) } }
            }
            @for (k, spoke) in spokes.iter().enumerate() {
                @let (x, y) = at(k, 100.0);
                path.grid d=(line(&[CENTER, (x, y)], false)) {}
                @let (lx, ly) = label(at(k, 114.0));
                text.label x=(coord(lx)) y=(coord(ly + 4.0)) text-anchor=(anchor(lx)) { (spoke.name) }
                text.value x=(coord(lx)) y=(coord(ly + 22.0)) text-anchor=(anchor(lx)) {
                    @if spoke.values.iter().all(Option::is_none) { (value(&None)) }
                    @else { (spoke.values.iter().map(value).collect::<Vec<_>>().join(" / ")) }
                }
            }
            @for session in 0..sessions {
                path class={ "shape shape-" (session + 1) } d=(line(&shape(session), true)) {}
                @for (x, y) in shape(session) { circle class={ "dot dot-" (session + 1) } cx=(coord(x)) cy=(coord(y)) r="4" {} }
            }
        },
    )
}

/// Returns the position of a label. Labels at the top are moved up because they have two lines.
fn label((x, y): (f64, f64)) -> (f64, f64) {
    (x, if y < CENTER.1 - RADIUS { y - 18.0 } else { y })
}

fn anchor(x: f64) -> &'static str {
    if (x - CENTER.0).abs() < 20.0 {
        "middle"
    } else if x > CENTER.0 {
        "start"
    } else {
        "end"
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Rounding error of the sine function at multiples of 90 degrees, drawing units.
    const ROUNDING_TOLERANCE: f64 = 1e-12;

    #[test]
    fn exact_radar_axes_have_expected_directions_and_scale() {
        for (k, (x, y)) in [(0.0, -1.0), (1.0, 0.0), (0.0, 1.0), (-1.0, 0.0)].into_iter().enumerate() {
            for pct in [0.0, 50.0, 100.0] {
                let (px, py) = place(k, 4, pct);
                assert!(
                    (px - x * RADIUS * pct / 100.0).abs() < ROUNDING_TOLERANCE
                        && (py - y * RADIUS * pct / 100.0).abs() < ROUNDING_TOLERANCE
                );
            }
        }
    }

    #[test]
    fn exact_radar_polygon_skips_missing_scores() {
        let spoke = |name: &str, value| RadarAxis { name: name.into(), values: vec![value] };
        let spokes = [spoke("a", Some(100.0)), spoke("b", Some(50.0)), spoke("c", Some(0.0)), spoke("d", None)];
        let figure = radar(&spokes, "t", Language::English).into_string();
        assert!(figure.contains("d=\"M260 68L319 186L260 186Z\""), "{figure}");
        assert!(figure.contains("n/a"));
        assert_eq!(figure.matches("<circle").count(), 3);
    }
}
