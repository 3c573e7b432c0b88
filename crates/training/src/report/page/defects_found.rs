//! Found and missed defects, marked on the bridges. For missed defects, also shows how close the flight came to them
//! and how they would have looked.

use super::figure::figure;
use super::gallery::{DefectMark, frame};
use super::moment;
use crate::report::Review;
use crate::report::defects::DefectOutcome;
use crate::report::formatting;
use crate::report::plots::map;
use crate::report::sketch::{SketchExposure, Sketcher};
use crate::report::table::{Table, TableCell, folded};
use crate::terms::{cause_title, defect_title, element_title};
use maud::{Markup, html};
use spandrel_model::scenario::Bridge;
use spandrel_model::site::outline::ParallelView;
use spandrel_text::{Language, text};

/// Renders the "Defects" section of a session report.
pub fn section(review: &Review, sketcher: &Sketcher) -> Markup {
    let language = review.metadata.language;
    if review.defects.is_empty() {
        return html! { p.calm { (text!(language, "report-defects-none")) } };
    }
    let missed: Vec<&DefectOutcome> = review.defects.iter().filter(|defect_outcome| defect_outcome.found_by.is_none()).collect();
    let (found, placed) = (review.defects.len() - missed.len(), review.defects.len());
    html! {
        p { (text!(language, "report-defects-count", found = found, placed = placed)) }
        ul.legend {
            li { svg.swatch viewBox="-9 -9 18 18" aria-hidden="true" { circle.found r="8" {} } (text!(language, "report-defects-found")) }
            li { svg.swatch viewBox="-9 -9 18 18" aria-hidden="true" { path.missed d="M0 -8L8 0L0 8L-8 0Z" {} } (text!(language, "report-defects-missed")) }
        }
        @for bridge in &review.scenario.bridges {
            @if review.defects.iter().any(|defect_outcome| defect_outcome.defect.member.starts_with(&format!("{}/", bridge.name))) { (drawings(review, bridge)) }
        }
        @if !missed.is_empty() {
            h3 { (text!(language, "report-defects-missed-head")) }
            p.note { (text!(language, "report-defects-drawn")) }
            ul.gallery { @for defect_outcome in &missed { (card(review, defect_outcome, sketcher)) } }
        }
        (folded(language, |language| table(review, language)))
    }
}

fn drawings(review: &Review, bridge: &Bridge) -> Markup {
    let language = review.metadata.language;
    let scroll = |title: &str, body: &Markup| {
        html! { div.scroll.wide tabindex="0" role="region" aria-label=(text!(language, "report-defects-drawing", title = title)) { (body) } }
    };
    let side = text!(language, "report-defects-side", bridge = bridge.name.as_str());
    let under = text!(language, "report-defects-top", bridge = bridge.name.as_str());
    let above = ParallelView { right: ParallelView::side(bridge).right, up: ParallelView::side(bridge).toward_viewer() * -1.0 };
    html! {
        (figure(&side, &scroll(&side, &map::findings(review, bridge, ParallelView::side(bridge), &side))))
        (figure(&under, &scroll(&under, &map::findings(review, bridge, above, &under))))
    }
}

fn card(review: &Review, outcome: &DefectOutcome, sketcher: &Sketcher) -> Markup {
    let (defect, language) = (&outcome.defect, review.metadata.language);
    let marks =
        [DefectMark { id: defect.id, at_m: defect.position_m, length_m: defect.length_m, class: "missed", hidden: false }];
    let alt = text!(language, "report-defects-alt", defect = defect.id);
    let kind = text!(language, "report-defects-kind", kind = defect_title(defect.kind, language), state = defect.condition_state);
    let (member, element) = (defect.member.as_str(), element_title(defect.element, language));
    let place = text!(language, "report-defects-place", member = member, element = element, size = size(outcome, language));
    let description = text!(language, "report-defects-outcome", outcome = outcome.description(language));
    let exposure = SketchExposure { light: 1.0, by_lamp: true };
    html! {
        li.shot {
            (frame(sketcher, (&outcome.reference_view(), &review.vehicle.camera), exposure, &marks, &alt))
            p { span.badge.v-false { (text!(language, "report-defects-missed")) } " " b { (text!(language, "report-defects-number", defect = defect.id)) } ", " (kind) }
            p { (place) @if let Some(cause) = defect.cause { " " (text!(language, "report-defects-cause", cause = cause_title(cause, language))) } }
            p.note { (description) @if let Some(approach) = &outcome.best_approach { " " (moment::shown(approach.moment_s(), language)) } }
        }
    }
}

fn size(outcome: &DefectOutcome, language: Language) -> String {
    let defect = &outcome.defect;
    let length = formatting::number(100.0 * defect.length_m, 0);
    if defect.line {
        let width = formatting::number(1000.0 * defect.width_m, 2);
        text!(language, "report-defects-size-line", length = length, width = width)
    } else {
        let width = formatting::number(100.0 * defect.width_m, 0);
        text!(language, "report-defects-size-area", length = length, width = width)
    }
}

fn found_label(outcome: &DefectOutcome, language: Language) -> String {
    match outcome.found_by {
        Some(picture) => text!(language, "report-defects-picture", picture = picture),
        None => text!(language, "report-defects-missed"),
    }
}

fn table(review: &Review, language: Language) -> Table {
    // The column would be empty in jobs that place defects anywhere.
    let has_causes = review.defects.iter().any(|outcome| outcome.defect.cause.is_some());
    let row = |outcome: &DefectOutcome| {
        let defect = &outcome.defect;
        let [east, north, up] = defect.position_m.array();
        let best_approach = outcome.best_approach.as_ref();
        let number = |value: Option<f64>, digits: usize| value.map_or(TableCell::Empty, |value| TableCell::Number(value, digits));
        let mut cells = vec![
            defect.id.into(),
            defect_title(defect.kind, language).into(),
            u32::from(defect.condition_state).into(),
            u32::from(defect.element.number()).into(),
            element_title(defect.element, language).into(),
            defect.member.clone().into(),
            TableCell::Number(1000.0 * defect.length_m, 0),
            TableCell::Number(1000.0 * defect.width_m, 2),
            TableCell::Number(east, 2),
            TableCell::Number(north, 2),
            TableCell::Number(up, 2),
            found_label(outcome, language).into(),
            number(best_approach.map(|c| c.in_view_s), 1),
            number(best_approach.map(|c| c.nearest.0), 1),
            outcome.description(language).into(),
        ];
        cells.extend(has_causes.then(|| defect.cause.map_or(TableCell::Empty, |cause| cause_title(cause, language).into())));
        cells
    };
    let mut columns = vec![
        text!(language, "report-column-defect"),
        text!(language, "report-column-kind"),
        text!(language, "report-column-condition-state"),
        text!(language, "report-column-element"),
        text!(language, "report-column-element-name"),
        text!(language, "report-column-member"),
        text!(language, "report-column-length-mm"),
        text!(language, "report-column-width-mm"),
        text!(language, "report-column-east"),
        text!(language, "report-column-north"),
        text!(language, "report-column-height"),
        text!(language, "report-column-found"),
        text!(language, "report-column-visible-time"),
        text!(language, "report-column-closest"),
        text!(language, "report-column-outcome"),
    ];
    columns.extend(has_causes.then(|| text!(language, "report-column-cause")));
    Table {
        name: "defects",
        caption: text!(language, "report-defects-caption"),
        columns,
        rows: review.defects.iter().map(row).collect(),
    }
}
