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
use crate::report::table::{Table, TableCell};
use maud::{Markup, html};
use spandrel_model::defect_codes::defect_name;
use spandrel_model::scenario::Bridge;
use spandrel_model::site::outline::ParallelView;

/// Renders the "Defects" section of a session report.
pub fn section(review: &Review, sketcher: &Sketcher) -> Markup {
    if review.defects.is_empty() {
        return html! { p.calm { "This job has no defects." } };
    }
    let missed: Vec<&DefectOutcome> = review.defects.iter().filter(|defect_outcome| defect_outcome.found_by.is_none()).collect();
    html! {
        p { (review.defects.len() - missed.len()) " of " (review.defects.len()) " defects were found." }
        ul.legend {
            li { svg.swatch viewBox="-9 -9 18 18" aria-hidden="true" { circle.found r="8" {} } "found" }
            li { svg.swatch viewBox="-9 -9 18 18" aria-hidden="true" { path.missed d="M0 -8L8 0L0 8L-8 0Z" {} } "missed" }
        }
        @for bridge in &review.scenario.bridges {
            @if review.defects.iter().any(|defect_outcome| defect_outcome.defect.member.starts_with(&format!("{}/", bridge.name))) { (drawings(review, bridge)) }
        }
        @if !missed.is_empty() {
            h3 { "Missed defects" }
            p.note { "Each drawing shows the defect from 4 m away, viewed head-on with the lamp on." }
            ul.gallery { @for defect_outcome in &missed { (card(review, defect_outcome, sketcher)) } }
        }
        (table(review).folded())
    }
}

fn drawings(review: &Review, bridge: &Bridge) -> Markup {
    let scroll = |title: &str, body: &Markup| html! { div.scroll.wide tabindex="0" role="region" aria-label={ "Defects: " (title) } { (body) } };
    let side = format!("Side view of bridge '{}'", bridge.name);
    let under = format!("Top view of bridge '{}'", bridge.name);
    let above = ParallelView { right: ParallelView::side(bridge).right, up: ParallelView::side(bridge).toward_viewer() * -1.0 };
    html! {
        (figure(&side, &scroll(&side, &map::findings(review, bridge, ParallelView::side(bridge), &side))))
        (figure(&under, &scroll(&under, &map::findings(review, bridge, above, &under))))
    }
}

fn card(review: &Review, outcome: &DefectOutcome, sketcher: &Sketcher) -> Markup {
    let defect = &outcome.defect;
    let marks =
        [DefectMark { id: defect.id, at_m: defect.position_m, length_m: defect.length_m, class: "missed", hidden: false }];
    let alt = format!("Defect {}, seen from 4 m away", defect.id);
    let exposure = SketchExposure { light: 1.0, by_lamp: true };
    html! {
        li.shot {
            (frame(sketcher, (&outcome.reference_view(), &review.vehicle.camera), exposure, &marks, &alt))
            p { span.badge.v-false { "missed" } " " b { "Defect " (defect.id) } ", " (defect_name(defect.kind)) ", condition state " (defect.condition_state) }
            p { "On " (defect.member) " (" (defect.element.name()) "), " (size(outcome)) "." }
            p.note { "It was " (outcome.description()) "." @if let Some(approach) = &outcome.best_approach { " " (moment::labeled(approach.moment_s(), &format!("Show {}", formatting::clock(approach.moment_s())))) } }
        }
    }
}

fn size(outcome: &DefectOutcome) -> String {
    let defect = &outcome.defect;
    let long = formatting::number(100.0 * defect.length_m, 0);
    if defect.line {
        format!("{long} cm long, {} mm wide", formatting::number(1000.0 * defect.width_m, 2))
    } else {
        format!("{long} by {} cm", formatting::number(100.0 * defect.width_m, 0))
    }
}

fn table(review: &Review) -> Table {
    let row = |outcome: &DefectOutcome| {
        let defect = &outcome.defect;
        let [east, north, up] = defect.position_m.array();
        let best_approach = outcome.best_approach.as_ref();
        let number = |value: Option<f64>, digits: usize| value.map_or(TableCell::Empty, |value| TableCell::Number(value, digits));
        vec![
            defect.id.into(),
            defect_name(defect.kind).into(),
            u32::from(defect.condition_state).into(),
            u32::from(defect.element.number()).into(),
            defect.element.name().into(),
            defect.member.clone().into(),
            TableCell::Number(1000.0 * defect.length_m, 0),
            TableCell::Number(1000.0 * defect.width_m, 2),
            TableCell::Number(east, 2),
            TableCell::Number(north, 2),
            TableCell::Number(up, 2),
            outcome.found_by.map_or("missed".into(), |number| format!("picture {number}")).into(),
            number(best_approach.map(|c| c.in_view_s), 1),
            number(best_approach.map(|c| c.nearest.0), 1),
            outcome.description().into(),
        ]
    };
    Table {
        name: "defects",
        caption: "defects",
        columns: vec![
            "defect",
            "kind",
            "condition state",
            "element",
            "element name",
            "member",
            "length (mm)",
            "width (mm)",
            "east (m)",
            "north (m)",
            "height (m)",
            "found",
            "time clearly visible (s)",
            "closest approach (m)",
            "outcome",
        ],
        rows: review.defects.iter().map(row).collect(),
    }
}
