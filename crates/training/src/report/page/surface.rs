//! Surface coverage by element: what the pictures show, and why the rest does not count.

use super::figure::{figure, legend};
use crate::report::Review;
use crate::report::coverage::{BLUR_MAX_PX, ElementSurface, REQUIRED_GSD_M, SurfaceCoverage, SurfaceOutcome, reach_m};
use crate::report::plots::bars::{StackedBar, stacks};
use crate::report::table::{Table, TableCell};
use crate::report::words;
use maud::{Markup, html};
use spandrel_model::elements::Element;
use spandrel_model::site::visibility::INCIDENCE_MAX_RAD;

/// Maximum number of reasons in the summary.
const REASONS: usize = 3;
/// Minimum fraction of the surface for a reason to be listed.
const LEAST_SHARE: f64 = 0.01;

/// Renders the section.
pub fn section(review: &Review) -> Markup {
    let total = review.coverage.total();
    if total.inspectable_m2 <= 0.0 {
        return html! { p.calm { "No bridge surface can be inspected from a reference path: all of it is beyond the camera's range." } };
    }
    let share = |area: f64| words::number(100.0 * area / total.inspectable_m2, 0);
    let key: Vec<(&str, String)> = SurfaceOutcome::ALL.map(|fate| (fate.class(), fate.name().to_owned())).to_vec();
    html! {
        p { "Of " (words::number(total.inspectable_m2, 0)) " m² that can be inspected from the reference paths, pictures show "
            b { (share(total.area_m2(SurfaceOutcome::Shown))) " %" } " well enough." @if let Some(why) = lacking(&total) { " The rest: " (why) "." } }
        p.note { "Surface is inspectable if it is visible from some point of a reference path at " (words::number(1000.0 * REQUIRED_GSD_M, 2))
            " mm per pixel or finer (a crack of 1.27 mm, the limit between condition states 2 and 3, then covers half a pixel; with this camera that is "
            (words::number(reach_m(&review.vehicle.camera), 1)) " m) and at most "
            (words::number(INCIDENCE_MAX_RAD.to_degrees(), 0)) "° from normal. It is shown well if a picture has that size and angle, enough light (including the lamp) for an exposure within the camera's limits, and at most "
            (words::number(BLUR_MAX_PX, 0)) " px of motion blur. The best of several pictures counts." }
        (figure("Coverage of each element's inspectable surface", &html! {
            (legend(&key))
            div.split {
                // Splits the rows into two columns of about equal length.
                @let rows = rows(&review.coverage);
                @let (left, right) = rows.split_at(rows.len().div_ceil(2));
                (stacks(left, "Surface coverage by element"))
                @if !right.is_empty() { (stacks(right, "Surface coverage by element, continued")) }
            }
        }))
        (table(&review.coverage).folded())
    }
}

/// Describes the main reasons why surface is not shown well; `None` if almost nothing is left.
fn lacking(total: &ElementSurface) -> Option<String> {
    let share = |fate: &SurfaceOutcome| total.area_m2(*fate) / total.inspectable_m2;
    let mut rest: Vec<SurfaceOutcome> =
        SurfaceOutcome::ALL.into_iter().filter(|fate| *fate != SurfaceOutcome::Shown && share(fate) >= LEAST_SHARE).collect();
    rest.sort_by(|a, b| share(b).total_cmp(&share(a)));
    let words = |fate: &SurfaceOutcome| format!("{} % {}", words::number(100.0 * share(fate), 0), fate.name());
    let words: Vec<String> = rest.iter().take(REASONS).map(words).collect();
    (!words.is_empty()).then(|| words.join("; "))
}

fn rows(coverage: &SurfaceCoverage) -> Vec<StackedBar> {
    let row = |(element, surface): (&Element, &ElementSurface)| StackedBar {
        name: format!("{} · {} ({} m²)", element.number(), element.name(), words::number(surface.inspectable_m2, 0)),
        parts: SurfaceOutcome::ALL.map(|fate| (fate.class(), surface.area_m2(fate) / surface.inspectable_m2)).to_vec(),
    };
    coverage.elements.iter().map(row).collect()
}

fn table(coverage: &SurfaceCoverage) -> Table {
    let row = |element: &ElementSurface, [number, name]: [TableCell; 2]| {
        let mut row = vec![number, name, TableCell::Number(element.inspectable_m2, 1)];
        row.extend(SurfaceOutcome::ALL.map(|fate| TableCell::Number(element.area_m2(fate), 1)));
        let typical = element.typical();
        let value = |value: Option<f64>, digits| value.map_or(TableCell::Empty, |value| TableCell::Number(value, digits));
        row.push(value(typical.map(|like| 1000.0 * like.gsd_m), 2));
        row.push(value(typical.map(|like| like.incidence_rad.to_degrees()), 0));
        row.push(value(typical.map(|like| like.lux), 0));
        row.push(value(typical.map(|like| like.blur_px), 2));
        row
    };
    let mut rows: Vec<Vec<TableCell>> = coverage
        .elements
        .iter()
        .map(|(element, surface)| row(surface, [u32::from(element.number()).into(), element.name().into()]))
        .collect();
    rows.push(row(&coverage.total(), ["all".into(), TableCell::Empty]));
    let mut columns = vec!["element", "name", "inspectable, m²"];
    columns.extend([
        "shown well, m²",
        "blurred, m²",
        "too dark, lamp on, m²",
        "too dark, lamp off, m²",
        "too oblique, m²",
        "too far, m²",
        "in view, no picture, m²",
        "never in view, m²",
        "pixel, mm",
        "angle from normal, deg",
        "light, lx",
        "motion blur, px",
    ]);
    Table {
        name: "coverage",
        caption: "surface coverage, and average values of the pictures at the required size and angle",
        columns,
        rows,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn exact_every_outcome_has_a_column_and_reasons_are_sorted_by_area() {
        let mut element = ElementSurface { inspectable_m2: 100.0, ..ElementSurface::default() };
        for (fate, area_m2) in [
            (SurfaceOutcome::Shown, 40.0),
            (SurfaceOutcome::DarkLampOff, 35.0),
            (SurfaceOutcome::Blurred, 20.0),
            (SurfaceOutcome::TooFar, 4.6),
            (SurfaceOutcome::Unseen, 0.4),
        ] {
            element.by_fate_m2.insert(fate, area_m2);
        }
        assert_eq!(lacking(&element).unwrap(), "35 % too dark, lamp off; 20 % blurred; 5 % too far");
        let table = table(&SurfaceCoverage { elements: [(Element::RcBoxGirder, element)].into() });
        for (k, fate) in SurfaceOutcome::ALL.iter().enumerate() {
            assert_eq!(table.columns[3 + k], format!("{}, m²", fate.name()));
        }
        assert!(table.rows.iter().all(|row| row.len() == table.columns.len()));
        assert_eq!(table.rows[1][6], TableCell::Number(35.0, 1), "the sum of one is itself");
        let all = ElementSurface {
            inspectable_m2: 1.0,
            by_fate_m2: [(SurfaceOutcome::Shown, 1.0)].into(),
            ..ElementSurface::default()
        };
        assert_eq!(lacking(&all), None);
    }
}
