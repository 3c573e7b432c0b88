//! Charts of both flights: positions on the site and values over time, linked by one slider.

use super::super::figure::{figure, legend};
use super::super::flight_section::slider;
use super::super::series::AlignmentEvent;
use crate::report::Review;
use crate::report::plots::overlay;
use crate::report::table::{Table, TableCell};
use maud::{Markup, html};

/// Series column and title of each chart.
const CHARTS: [(&str, &str); 4] = [
    ("speed", "Speed (m/s)"),
    ("distance", "Distance to the current task's path (m)"),
    ("clearance", "Clearance to the nearest surface (m)"),
    ("battery", "Battery (%)"),
];
/// Columns of the slider's readout: script key and heading.
const READOUT: [(&str, &str); 5] =
    [("task", "Task"), ("distance", "Distance"), ("speed", "Speed"), ("clearance", "Clearance"), ("battery", "Battery")];

/// Renders the section. Drawings are included only if both flights are from the same job.
pub fn section(both: [&Review; 2], same_job: bool, alignment_events: &[AlignmentEvent], key: &[(&str, String)]) -> Markup {
    html! {
        (controls(alignment_events, key))
        @if same_job { (drawings(both)) }
        div.charts {
            @for (column, title) in CHARTS {
                figure {
                    figcaption { (title) (legend(key)) }
                    div.chart id={ "chart-" (column) } data-columns=(column) role="img" aria-label={ (title) " of both sessions over time; see the table below for the values" } {}
                }
            }
        }
        p.note { "Drag across a chart to zoom in. Double-click to reset the zoom. Click to move the slider." }
        (table(both).folded())
    }
}

fn controls(alignment_events: &[AlignmentEvent], key: &[(&str, String)]) -> Markup {
    html! {
        div.controls id="controls" {
            div.run hidden id="run" {
                (slider())
                label { "Align at "  select id="line-up" { @for (k, line_up) in alignment_events.iter().enumerate() { option value=(k) { (line_up.name) } } } }
            }
            div.scroll id="readout" hidden tabindex="0" role="region" aria-label="Both sessions at the selected time" {
                table.moment {
                    thead { tr { th scope="col" { "Session" } @for (_, head) in READOUT { th scope="col" { (head) } } } }
                    tbody {
                        @for (k, (class, name)) in key.iter().enumerate() {
                            tr {
                                th scope="row" { svg.swatch viewBox="0 0 14 14" aria-hidden="true" { rect class=(class) x="1" y="1" width="12" height="12" rx="3" {} } " " (name) }
                                @for (id, _) in READOUT { td data-now=(id) data-flight=(k) { "–" } }
                            }
                        }
                    }
                }
            }
        }
    }
}

fn drawings(both: [&Review; 2]) -> Markup {
    let scroll = |label: &str, body: &Markup| html! { div.scroll.wide tabindex="0" role="region" aria-label=(label) { (body) } };
    html! {
        (figure("Both flights from above, north up; crosses mark contacts", &scroll("Plan", &overlay::plan(both))))
        @if both[0].scenario.bridges.is_empty() {
            (figure("View from the south", &scroll("Elevation", &overlay::from_south(both))))
        }
        @for bridge in &both[0].scenario.bridges {
            @let title = format!("Side view of bridge '{}', with nearby parts of both flights", bridge.name);
            (figure(&title, &scroll(&title, &overlay::elevation(both, bridge))))
        }
    }
}

/// Returns the charts' data as a table with one row every few seconds since lift-off.
fn table(both: [&Review; 2]) -> Table {
    let end_s = |review: &Review| review.t_s(review.frames.len().saturating_sub(1));
    let longest_s = f64::max(end_s(both[0]), end_s(both[1]));
    let every_s = (longest_s / 60.0 / 5.0).ceil().max(1.0) * 5.0;
    let known = |value: Option<f64>, digits: usize| value.map_or(TableCell::Empty, |value| TableCell::Number(value, digits));
    let cells = |review: &Review, t_s: f64| {
        let i = (t_s * review.scenario.scoring.frame_rate_hz).round() as usize;
        let frame = review.frames.get(i);
        let step = review.track.get(i);
        let task = step.and_then(|step| step.task).map(|task| review.scenario.tasks[task].id);
        [
            task.map_or(TableCell::Empty, TableCell::from),
            known(step.and_then(|step| step.distance_m), 2),
            known(frame.map(|frame| frame.speed_m_s()), 2),
            known(frame.and_then(|frame| frame.clearance_m), 2),
            known(frame.map(|frame| frame.battery_pct), 0),
        ]
    };
    let rows = (0..=(longest_s / every_s) as usize).map(|k| {
        let t_s = every_s * k as f64;
        let mut row = vec![TableCell::Clock(t_s)];
        both.iter().for_each(|review| row.extend(cells(review, t_s)));
        row
    });
    let rows: Vec<Vec<TableCell>> = rows.collect();
    let columns = vec![
        "time since lift-off",
        "session 1: task",
        "session 1: distance (m)",
        "session 1: speed (m/s)",
        "session 1: clearance (m)",
        "session 1: battery (%)",
        "session 2: task",
        "session 2: distance (m)",
        "session 2: speed (m/s)",
        "session 2: clearance (m)",
        "session 2: battery (%)",
    ];
    Table { name: "both-flights", caption: "both flights, sampled every few seconds", columns, rows }
}
