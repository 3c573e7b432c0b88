//! Surface coverage by element.

use super::{figure, legend};
use crate::report::Review;
use crate::report::coverage::{BLUR_MAX_PX, Element, REQUIRED_GSD_M, reach_m};
use crate::report::plots::bars::{Row, shares};
use crate::report::table::{Cell, Table};
use crate::report::words;
use crate::site::look::INCIDENCE_MAX_RAD;
use maud::{Markup, html};

/// The section.
pub fn section(review: &Review) -> Markup {
    let total = review.coverage.total();
    if total.inspectable_m2 <= 0.0 {
        return html! { p.calm { "No surface of a bridge lies within the camera's reach of a reference path." } };
    }
    let share = |area: f64| words::number(100.0 * area / total.inspectable_m2, 0);
    html! {
        p { "Of " (words::number(total.inspectable_m2, 0)) " m² that can be inspected from the reference paths, the camera had "
            (share(total.in_view_m2)) " % before it while flying; pictures show " (share(total.pictured_m2)) " %, "
            (share(total.sharp_m2)) " % lit and sharp enough." }
        p.note { "Inspectable is what some point of a reference path sees at " (words::number(1000.0 * REQUIRED_GSD_M, 2))
            " mm per pixel or finer (a crack of 1.27 mm, the limit between condition states 2 and 3, then covers half a pixel; with this camera that is "
            (words::number(reach_m(&review.vehicle.camera), 1)) " m) and at most "
            (words::number(INCIDENCE_MAX_RAD.to_degrees(), 0)) "° off square. Lit: enough for an exposure within the camera's limits, lamp included. Sharp: at most "
            (words::number(BLUR_MAX_PX, 0)) " px of smear by the drone's speed." }
        (figure("Share of each element's inspectable surface", &html! {
            (legend(&[("a-view", "in view while flying".into()), ("a-pictured", "in pictures".into()), ("a-sharp", "in pictures, lit and sharp".into())]))
            div.split {
                // Two columns of about equal length.
                @let rows = rows(review);
                @let (left, right) = rows.split_at(rows.len().div_ceil(2));
                (shares(left, "Surface coverage by element"))
                @if !right.is_empty() { (shares(right, "Surface coverage by element, continued")) }
            }
        }))
        (table(review).folded())
    }
}

fn rows(review: &Review) -> Vec<Row> {
    let row = |element: &Element| {
        let share = |area: f64| area / element.inspectable_m2.max(f64::MIN_POSITIVE);
        Row {
            name: format!(
                "{} · {} ({} m²)",
                element.element,
                words::element(element.element),
                words::number(element.inspectable_m2, 0)
            ),
            bars: vec![
                ("a-view", share(element.in_view_m2)),
                ("a-pictured", share(element.pictured_m2)),
                ("a-sharp", share(element.sharp_m2)),
            ],
            instead: None,
        }
    };
    review.coverage.elements.iter().map(row).collect()
}

fn table(review: &Review) -> Table {
    let row = |element: &Element, name: Cell| {
        vec![
            name,
            words::element(element.element).into(),
            Cell::Number(element.inspectable_m2, 1),
            Cell::Number(element.in_view_m2, 1),
            Cell::Number(element.pictured_m2, 1),
            Cell::Number(element.lit_m2, 1),
            Cell::Number(element.sharp_m2, 1),
        ]
    };
    let mut rows: Vec<Vec<Cell>> = review.coverage.elements.iter().map(|element| row(element, element.element.into())).collect();
    rows.push(row(&review.coverage.total(), "all".into()));
    Table {
        name: "coverage",
        caption: "surface coverage",
        columns: vec!["element", "name", "inspectable, m²", "in view, m²", "in pictures, m²", "and lit, m²", "and sharp, m²"],
        rows,
    }
}
