//! Surface coverage by element: the area that the pictures capture well, and the reasons why the rest does not count.

use super::figure::{SLOT, figure, filled, legend};
use crate::report::Review;
use crate::report::coverage::{ElementSurface, MAX_MOTION_BLUR_PX, REQUIRED_GSD_M, SurfaceCoverage, SurfaceOutcome, reach_m};
use crate::report::formatting;
use crate::report::plots::bars::{StackedBar, stacked_bars};
use crate::report::table::{Table, TableCell, folded};
use crate::terms::element_title;
use maud::{Markup, html};
use spandrel_model::elements::Element;
use spandrel_model::site::visibility::MAX_INCIDENCE_RAD;
use spandrel_text::{Language, text};

/// Maximum number of reasons named in the summary.
const MAX_REASONS: usize = 3;
/// Minimum fraction of the inspectable surface that a reason must affect to be named.
const MIN_REASON_SHARE: f64 = 0.01;

/// Renders the "Coverage" section of a session report.
pub fn section(review: &Review) -> Markup {
    let total = review.coverage.total();
    let language = review.metadata.language;
    if total.inspectable_m2 <= 0.0 {
        return html! { p.calm { (text!(language, "report-coverage-none")) } };
    }
    let key: Vec<(&str, String)> =
        SurfaceOutcome::ALL.map(|surface_outcome| (surface_outcome.class(), surface_outcome.name(language))).to_vec();
    html! {
        p { (summary(&total, language))
            @if let Some(why) = reasons_not_captured(&total, language) { " " (text!(language, "report-coverage-rest", reasons = why)) } }
        p.note { (criteria(review)) }
        (figure(&text!(language, "report-coverage-figure"), &html! {
            (legend(&key))
            div.split {
                // Distributes the rows between two columns of about equal length.
                @let rows = rows(&review.coverage, language);
                @let (left, right) = rows.split_at(rows.len().div_ceil(2));
                (stacked_bars(left, &text!(language, "report-coverage-bars")))
                @if !right.is_empty() { (stacked_bars(right, &text!(language, "report-coverage-bars-continued"))) }
            }
        }))
        (folded(language, |language| table(&review.coverage, language)))
    }
}

fn summary(total: &ElementSurface, language: Language) -> Markup {
    let share = formatting::number(100.0 * total.area_m2(SurfaceOutcome::Shown) / total.inspectable_m2, 0);
    let area = formatting::number(total.inspectable_m2, 0);
    let share = text!(language, "report-percent", value = share);
    filled(&text!(language, "report-coverage-summary", share = SLOT, area = area), &html! { b { (share) } })
}

/// Explains when a surface is inspectable and captured well.
fn criteria(review: &Review) -> String {
    text!(
        review.metadata.language,
        "report-coverage-note",
        pixel = formatting::number(1000.0 * REQUIRED_GSD_M, 2),
        reach = formatting::number(reach_m(&review.vehicle.camera), 1),
        angle = formatting::number(MAX_INCIDENCE_RAD.to_degrees(), 0),
        blur = formatting::number(MAX_MOTION_BLUR_PX, 0)
    )
}

/// Returns the main reasons why surface is not captured well; `None` if each affects less than [`MIN_REASON_SHARE`].
fn reasons_not_captured(total: &ElementSurface, language: Language) -> Option<String> {
    let share = |outcome: &SurfaceOutcome| total.area_m2(*outcome) / total.inspectable_m2;
    let mut rest: Vec<SurfaceOutcome> = SurfaceOutcome::ALL
        .into_iter()
        .filter(|surface_outcome| *surface_outcome != SurfaceOutcome::Shown && share(surface_outcome) >= MIN_REASON_SHARE)
        .collect();
    rest.sort_by(|a, b| share(b).total_cmp(&share(a)));
    let words = |outcome: &SurfaceOutcome| {
        let share = formatting::number(100.0 * share(outcome), 0);
        text!(language, "report-coverage-reason", share = share, outcome = outcome.name(language))
    };
    let words: Vec<String> = rest.iter().take(MAX_REASONS).map(words).collect();
    (!words.is_empty()).then(|| words.join("; "))
}

fn rows(coverage: &SurfaceCoverage, language: Language) -> Vec<StackedBar> {
    let row = |(element, surface): (&Element, &ElementSurface)| StackedBar {
        name: format!(
            "{} · {} ({} m²)",
            element.number(),
            element_title(*element, language),
            formatting::number(surface.inspectable_m2, 0)
        ),
        parts: SurfaceOutcome::ALL
            .map(|surface_outcome| (surface_outcome.class(), surface.area_m2(surface_outcome) / surface.inspectable_m2))
            .to_vec(),
    };
    coverage.elements.iter().map(row).collect()
}

fn table(coverage: &SurfaceCoverage, language: Language) -> Table {
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
        .map(|(element, surface)| row(surface, [u32::from(element.number()).into(), element_title(*element, language).into()]))
        .collect();
    rows.push(row(&coverage.total(), [text!(language, "report-coverage-all").into(), TableCell::Empty]));
    let mut columns = vec![
        text!(language, "report-column-element"),
        text!(language, "report-column-name"),
        text!(language, "report-column-inspectable"),
    ];
    columns.extend(SurfaceOutcome::ALL.map(|outcome| text!(language, "report-column-area", outcome = outcome.name(language))));
    columns.extend([
        text!(language, "report-column-pixel-size"),
        text!(language, "report-column-angle"),
        text!(language, "report-column-illuminance"),
        text!(language, "report-column-blur"),
    ]);
    Table { name: "coverage", caption: text!(language, "report-coverage-caption"), columns, rows }
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
        let reasons = reasons_not_captured(&element, Language::English).unwrap();
        assert_eq!(reasons, "35% too dark, lamp off; 20% blurred; 5% too far");
        let table = table(&SurfaceCoverage { elements: [(Element::RcBoxGirder, element)].into() }, Language::English);
        for (k, surface_outcome) in SurfaceOutcome::ALL.iter().enumerate() {
            assert_eq!(table.columns[3 + k], format!("{} (m²)", surface_outcome.name(Language::English)));
        }
        assert!(table.rows.iter().all(|row| row.len() == table.columns.len()));
        assert_eq!(table.rows[1][6], TableCell::Number(35.0, 1), "the total of a single element equals that element");
        let all = ElementSurface {
            inspectable_m2: 1.0,
            area_by_outcome_m2: [(SurfaceOutcome::Shown, 1.0)].into(),
            ..ElementSurface::default()
        };
        assert_eq!(reasons_not_captured(&all, Language::English), None);
    }
}
