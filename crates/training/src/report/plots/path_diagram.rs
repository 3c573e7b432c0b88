//! Path diagram of the causal model: demand affects strain, strain affects performance, and feedback moderates the effect of
//! demand on strain.

use super::{coord, line, svg_figure};
use maud::{Markup, html};
use spandrel_text::{Language, text};

const SIZE: (f64, f64) = (854.0, 268.0);
/// Width and height of a box, in drawing units.
const BOX_SIZE: (f64, f64) = (150.0, 54.0);
const MIDDLE_ROW_Y: f64 = 128.0;
const DEMAND_X: f64 = 12.0;
const STRAIN_X: f64 = 352.0;
const PERFORMANCE_X: f64 = 692.0;
const FEEDBACK_POSITION: (f64, f64) = (182.0, 10.0);
/// Half the width of an arrowhead, in drawing units.
const ARROWHEAD_HALF_WIDTH: f64 = 5.0;

/// An effect in the model and whether its confidence interval contains zero.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct PathEffect {
    /// Estimate and confidence interval, as text.
    pub label: String,
    /// Whether the interval contains zero.
    pub contains_zero: bool,
}

/// The four effects of the model.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct PathEffects {
    /// Effect of demand on strain.
    pub on_strain: PathEffect,
    /// Effect of strain on performance.
    pub on_performance: PathEffect,
    /// Direct effect of demand on performance.
    pub direct: PathEffect,
    /// Moderating effect of feedback on the effect of demand on strain.
    pub moderation: PathEffect,
}

/// Draws the path diagram.
#[must_use]
pub fn model(effects: &PathEffects, title: &str, language: Language) -> Markup {
    let middle = MIDDLE_ROW_Y + 0.5 * BOX_SIZE.1;
    let (from, to) = (DEMAND_X + BOX_SIZE.0, STRAIN_X);
    let crossing = 0.5 * (from + to);
    svg_figure(
        SIZE,
        title,
        "model-drawing",
        &html! {
            (boxes(language))
            (arrow(&[(from, middle), (to, middle)], &effects.on_strain))
            (effect_text((crossing, middle + 24.0), &effects.on_strain))
            (arrow(&[(STRAIN_X + BOX_SIZE.0, middle), (PERFORMANCE_X, middle)], &effects.on_performance))
            (effect_text((0.5 * (STRAIN_X + BOX_SIZE.0 + PERFORMANCE_X), middle + 24.0), &effects.on_performance))
            (arrow(&[(crossing, FEEDBACK_POSITION.1 + BOX_SIZE.1), (crossing, middle - 2.0)], &effects.moderation))
            text.value x=(coord(crossing + 10.0)) y=(coord(FEEDBACK_POSITION.1 + BOX_SIZE.1 + 28.0)) { (effects.moderation.label) }
            @let (down, low) = (MIDDLE_ROW_Y + BOX_SIZE.1, SIZE.1 - 30.0);
            (arrow(&[(DEMAND_X + 0.5 * BOX_SIZE.0, down), (DEMAND_X + 0.5 * BOX_SIZE.0, low), (PERFORMANCE_X + 0.5 * BOX_SIZE.0, low), (PERFORMANCE_X + 0.5 * BOX_SIZE.0, down)], &effects.direct))
            (effect_text((0.5 * SIZE.0, low + 20.0), &effects.direct))
        },
    )
}

/// Draws the four variables with their parts.
fn boxes(language: Language) -> Markup {
    let (demand, demand_parts) = (text!(language, "plot-model-demand"), text!(language, "plot-model-demand-parts"));
    let (strain, strain_parts) = (text!(language, "plot-model-strain"), text!(language, "plot-model-strain-parts"));
    let performance = text!(language, "plot-model-performance");
    let performance_parts = text!(language, "plot-model-performance-parts");
    let (feedback, feedback_parts) = (text!(language, "plot-model-feedback"), text!(language, "plot-model-feedback-parts"));
    html! {
        (labeled_box((DEMAND_X, MIDDLE_ROW_Y), &demand, &demand_parts))
        (labeled_box((STRAIN_X, MIDDLE_ROW_Y), &strain, &strain_parts))
        (labeled_box((PERFORMANCE_X, MIDDLE_ROW_Y), &performance, &performance_parts))
        (labeled_box(FEEDBACK_POSITION, &feedback, &feedback_parts))
    }
}

fn labeled_box((x, y): (f64, f64), name: &str, what: &str) -> Markup {
    html! {
        rect.node x=(coord(x)) y=(coord(y)) width=(coord(BOX_SIZE.0)) height=(coord(BOX_SIZE.1)) rx="8" {}
        text.label x=(coord(x + 0.5 * BOX_SIZE.0)) y=(coord(y + 23.0)) text-anchor="middle" { (name) }
        text.tick x=(coord(x + 0.5 * BOX_SIZE.0)) y=(coord(y + 41.0)) text-anchor="middle" { (what) }
    }
}

fn effect_text((x, y): (f64, f64), effect: &PathEffect) -> Markup {
    html! { text.value x=(coord(x)) y=(coord(y)) text-anchor="middle" { (effect.label) } }
}

fn arrow(points: &[(f64, f64)], effect: &PathEffect) -> Markup {
    let head = arrowhead(points);
    html! {
        path class={ "arrow" @if effect.contains_zero { " may-be-none" } } d=(line(points, false)) {}
        path.arrow-head d=(line(&head, true)) {}
    }
}

/// Returns the corners of the arrowhead at a line's end. The line's last segment must be parallel to an axis.
fn arrowhead(points: &[(f64, f64)]) -> Vec<(f64, f64)> {
    let [.., (x0, y0), (x, y)] = points else { return Vec::new() };
    let (dx, dy) = ((x - x0).signum() * f64::from(u8::from(x != x0)), (y - y0).signum() * f64::from(u8::from(y != y0)));
    let (back_x, back_y) = (x - 2.0 * ARROWHEAD_HALF_WIDTH * dx, y - 2.0 * ARROWHEAD_HALF_WIDTH * dy);
    vec![
        (*x, *y),
        (back_x + ARROWHEAD_HALF_WIDTH * dy, back_y + ARROWHEAD_HALF_WIDTH * dx),
        (back_x - ARROWHEAD_HALF_WIDTH * dy, back_y - ARROWHEAD_HALF_WIDTH * dx),
    ]
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn exact_arrowheads_follow_last_segment_and_uncertain_effects_are_dashed() {
        assert_eq!(arrowhead(&[(0.0, 0.0), (50.0, 0.0)]), [(50.0, 0.0), (40.0, 5.0), (40.0, -5.0)]);
        assert_eq!(arrowhead(&[(0.0, 9.0), (0.0, 50.0)]), [(0.0, 50.0), (5.0, 40.0), (-5.0, 40.0)]);
        assert!(arrowhead(&[(0.0, 0.0)]).is_empty());
        let effect = |label: &str, contains_zero| PathEffect { label: label.into(), contains_zero };
        let effects = PathEffects {
            on_strain: effect("0.7 <a>", false),
            on_performance: effect("b", true),
            direct: effect("c", true),
            moderation: effect("d", false),
        };
        let figure = model(&effects, "t", Language::English).into_string();
        assert_eq!((figure.matches("may-be-none").count(), figure.matches("arrow-head").count()), (2, 4));
        assert!(figure.contains("0.7 &lt;a&gt;"), "{figure}");
    }
}
