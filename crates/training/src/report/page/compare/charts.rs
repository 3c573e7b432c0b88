//! Charts of both flights: positions on the site and values over time, linked by one slider.

use super::super::figure::{figure, legend};
use super::super::flight_section::{chart_title, readout_name, slider};
use super::super::series::AlignmentEvent;
use crate::report::Review;
use crate::report::plots::overlay;
use crate::report::table::{Table, TableCell, folded};
use maud::{Markup, html};
use spandrel_text::{Language, text};

/// Series column of each chart.
const CHARTS: [&str; 4] = ["speed", "distance", "clearance", "battery"];
/// Columns of the slider's readout, by the script's key.
const READOUT: [&str; 5] = ["task", "distance", "speed", "clearance", "battery"];

/// Renders the section. Drawings are included only if both flights are from the same job.
pub fn section(both: [&Review; 2], same_job: bool, alignment_events: &[AlignmentEvent], key: &[(&str, String)]) -> Markup {
    let language = both[0].metadata.language;
    html! {
        (controls(alignment_events, key, language))
        @if same_job { (drawings(both)) }
        div.charts {
            @for column in CHARTS {
                @let title = chart_title(column, language);
                figure {
                    figcaption { (title) (legend(key)) }
                    div.chart id={ "chart-" (column) } data-columns=(column) role="img" aria-label=(text!(language, "compare-chart-label", title = title.as_str())) {}
                }
            }
        }
        p.note { (text!(language, "report-flight-zoom")) }
        (folded(language, |language| table(both, language)))
    }
}

fn controls(alignment_events: &[AlignmentEvent], key: &[(&str, String)], language: Language) -> Markup {
    html! {
        div.controls id="controls" {
            div.run hidden id="run" {
                (slider(language))
                label { (text!(language, "compare-align")) " " select id="line-up" { @for (k, line_up) in alignment_events.iter().enumerate() { option value=(k) { (line_up.name) } } } }
            }
            div.scroll id="readout" hidden tabindex="0" role="region" aria-label=(text!(language, "compare-readout")) {
                table.moment {
                    thead { tr { th scope="col" { (text!(language, "compare-session")) } @for id in READOUT { th scope="col" { (readout_name(id, language)) } } } }
                    tbody {
                        @for (k, (class, name)) in key.iter().enumerate() {
                            tr {
                                th scope="row" { svg.swatch viewBox="0 0 14 14" aria-hidden="true" { rect class=(class) x="1" y="1" width="12" height="12" rx="3" {} } " " (name) }
                                @for id in READOUT { td data-now=(id) data-flight=(k) { "–" } }
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
    let language = both[0].metadata.language;
    html! {
        (figure(&text!(language, "compare-plan"), &scroll(&text!(language, "report-flight-plan-region"), &overlay::plan(both))))
        @if both[0].scenario.bridges.is_empty() {
            (figure(&text!(language, "report-flight-south"), &scroll(&text!(language, "report-flight-elevation-region"), &overlay::from_south(both))))
        }
        @for bridge in &both[0].scenario.bridges {
            @let title = text!(language, "compare-side", bridge = bridge.name.as_str());
            (figure(&title, &scroll(&title, &overlay::elevation(both, bridge))))
        }
    }
}

/// Returns the charts' data as a table with one row every few seconds since lift-off.
fn table(both: [&Review; 2], language: Language) -> Table {
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
    let of_session = |session: u32| {
        let columns = [
            text!(language, "report-column-task"),
            text!(language, "report-column-distance"),
            text!(language, "report-column-speed"),
            text!(language, "report-column-clearance"),
            text!(language, "report-column-battery"),
        ];
        columns.map(|column| text!(language, "compare-column-of-session", session = session, column = column))
    };
    let columns = [text!(language, "compare-column-time")].into_iter().chain(of_session(1)).chain(of_session(2)).collect();
    Table { name: "both-flights", caption: text!(language, "compare-flights-caption"), columns, rows }
}
