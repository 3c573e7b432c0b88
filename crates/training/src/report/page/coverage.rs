//! Surface coverage by element: the area that the pictures capture well, and the reasons why the rest does not count.

use super::figure::{figure, legend};
use crate::report::Review;
use crate::report::coverage::{ElementSurface, MAX_MOTION_BLUR_PX, REQUIRED_GSD_M, SurfaceCoverage, SurfaceOutcome, reach_m};
use crate::report::formatting;
use crate::report::plots::bars::{StackedBar, stacked_bars};
use crate::report::table::{Table, TableCell};
use maud::{Markup, html};
use spandrel_model::elements::Element;
use spandrel_model::site::visibility::MAX_INCIDENCE_RAD;

/// Maximum number of reasons named in the summary.
const MAX_REASONS: usize = 3;
/// Minimum fraction of the inspectable surface that a reason must affect to be named.
const MIN_REASON_SHARE: f64 = 0.01;

/// Renders the "Coverage" section of a session report.
pub fn section(review: &Review) -> Markup {
    let total = review.coverage.total();
    if total.inspectable_m2 <= 0.0 {
        return html! { p.calm { "No bridge surface can be inspected from the reference paths; all surfaces are beyond the camera's range." } };
    }
    let share = |area: f64| formatting::number(100.0 * area / total.inspectable_m2, 0);
    let key: Vec<(&str, String)> =
        SurfaceOutcome::ALL.map(|surface_outcome| (surface_outcome.class(), surface_outcome.name().to_owned())).to_vec();
    html! {
        p { "The pictures capture " b { (share(total.area_m2(SurfaceOutcome::Shown))) "%" } " of the inspectable bridge surface well ("
            (formatting::number(total.inspectable_m2, 0)) " m² can be inspected from the reference paths)." @if let Some(why) = reasons_not_captured(&total) { " The rest: " (why) "." } }
        p.note { "A surface is inspectable if it is visible from at least one point of a reference path at " (formatting::number(1000.0 * REQUIRED_GSD_M, 2))
            " mm per pixel or finer (at this resolution, a 1.27 mm crack, the limit between condition states 2 and 3, covers half a pixel; this camera achieves it from up to "
            (formatting::number(reach_m(&review.vehicle.camera), 1)) " m away) and at an angle of at most "
            (formatting::number(MAX_INCIDENCE_RAD.to_degrees(), 0)) "° from the surface normal. It is captured well if a picture meets both limits, has enough light (including lamp light) for an exposure within the camera's limits, and has at most "
            (formatting::number(MAX_MOTION_BLUR_PX, 0)) " px of motion blur. If several pictures show the same patch of surface, the best one counts." }
        (figure("Coverage of each element's inspectable surface", &html! {
            (legend(&key))
            div.split {
                // Distributes the rows between two columns of about equal length.
                @let rows = rows(&review.coverage);
                @let (left, right) = rows.split_at(rows.len().div_ceil(2));
                (stacked_bars(left, "Surface coverage by element"))
                @if !right.is_empty() { (stacked_bars(right, "Surface coverage by element, continued")) }
            }
        }))
        (table(&review.coverage).folded())
    }
}

/// Returns the main reasons why surface is not captured well; `None` if each affects less than [`MIN_REASON_SHARE`].
fn reasons_not_captured(total: &ElementSurface) -> Option<String> {
    let share = |outcome: &SurfaceOutcome| total.area_m2(*outcome) / total.inspectable_m2;
    let mut rest: Vec<SurfaceOutcome> = SurfaceOutcome::ALL
        .into_iter()
        .filter(|surface_outcome| *surface_outcome != SurfaceOutcome::Shown && share(surface_outcome) >= MIN_REASON_SHARE)
        .collect();
    rest.sort_by(|a, b| share(b).total_cmp(&share(a)));
    let words = |outcome: &SurfaceOutcome| format!("{}% {}", formatting::number(100.0 * share(outcome), 0), outcome.name());
    let words: Vec<String> = rest.iter().take(MAX_REASONS).map(words).collect();
    (!words.is_empty()).then(|| words.join("; "))
}

fn rows(coverage: &SurfaceCoverage) -> Vec<StackedBar> {
    let row = |(element, surface): (&Element, &ElementSurface)| StackedBar {
        name: format!("{} · {} ({} m²)", element.number(), element.name(), formatting::number(surface.inspectable_m2, 0)),
        parts: SurfaceOutcome::ALL
            .map(|surface_outcome| (surface_outcome.class(), surface.area_m2(surface_outcome) / surface.inspectable_m2))
            .to_vec(),
    };
    coverage.elements.iter().map(row).collect()
}

fn table(coverage: &SurfaceCoverage) -> Table {
    let row = |element: &ElementSurface, [number, name]: [TableCell; 2]| {
        let mut row = vec![number, name, TableCell::Number(element.inspectable_m2, 1)];
        row.extend(SurfaceOutcome::ALL.map(|surface_outcome| TableCell::Number(element.area_m2(surface_outcome), 1)));
        let average_picture = element.average_picture();
        let value = |value: Option<f64>, digits| value.map_or(TableCell::Empty, |value| TableCell::Number(value, digits));
        row.push(value(average_picture.map(|like| 1000.0 * like.gsd_m), 2));
        row.push(value(average_picture.map(|like| like.incidence_rad.to_degrees()), 0));
        row.push(value(average_picture.map(|like| like.lux), 0));
        row.push(value(average_picture.map(|like| like.blur_px), 2));
        row
    };
    let mut rows: Vec<Vec<TableCell>> = coverage
        .elements
        .iter()
        .map(|(element, surface)| row(surface, [u32::from(element.number()).into(), element.name().into()]))
        .collect();
    rows.push(row(&coverage.total(), ["all".into(), TableCell::Empty]));
    let mut columns = vec!["element", "name", "inspectable area (m²)"];
    columns.extend([
        "captured well (m²)",
        "blurred (m²)",
        "too dark, lamp on (m²)",
        "too dark, lamp off (m²)",
        "too oblique (m²)",
        "too far (m²)",
        "in view, not photographed (m²)",
        "never in view (m²)",
        "pixel size (mm)",
        "angle from normal (deg)",
        "illuminance (lx)",
        "motion blur (px)",
    ]);
    Table {
        name: "coverage",
        caption: "surface coverage; pixel size, angle, light and blur are averages over pictures that meet the required resolution and angle",
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
        for (surface_outcome, area_m2) in [
            (SurfaceOutcome::Shown, 40.0),
            (SurfaceOutcome::DarkLampOff, 35.0),
            (SurfaceOutcome::Blurred, 20.0),
            (SurfaceOutcome::TooFar, 4.6),
            (SurfaceOutcome::NeverInView, 0.4),
        ] {
            element.area_by_outcome_m2.insert(surface_outcome, area_m2);
        }
        assert_eq!(reasons_not_captured(&element).unwrap(), "35% too dark, lamp off; 20% blurred; 5% too far");
        let table = table(&SurfaceCoverage { elements: [(Element::RcBoxGirder, element)].into() });
        for (k, surface_outcome) in SurfaceOutcome::ALL.iter().enumerate() {
            assert_eq!(table.columns[3 + k], format!("{} (m²)", surface_outcome.name()));
        }
        assert!(table.rows.iter().all(|row| row.len() == table.columns.len()));
        assert_eq!(table.rows[1][6], TableCell::Number(35.0, 1), "the total of a single element equals that element");
        let all = ElementSurface {
            inspectable_m2: 1.0,
            area_by_outcome_m2: [(SurfaceOutcome::Shown, 1.0)].into(),
            ..ElementSurface::default()
        };
        assert_eq!(reasons_not_captured(&all), None);
    }
}
