//! Data behind the report: telemetry gaps, control sources, link statistics, files and their hashes.

use crate::report::Review;
use crate::report::formatting;
use crate::report::table::{Table, TableCell};
use maud::{Markup, html};

/// Renders the "Record" section of a session report.
pub fn section(review: &Review) -> Markup {
    let telemetry = &review.assessment.telemetry;
    html! {
        p { (gaps(review)) }
        @if telemetry.missing_frames > 0 {
            p.note { "In gaps longer than 1 s, missing frames repeat the last known position and are scored at that position." }
        }
        (control_intervals(review).shown())
        (files(review).shown())
        p.note { "This report is computed from the telemetry, the scenario file and the aircraft file. The same three files always produce the same report." }
    }
}

fn gaps(review: &Review) -> String {
    let t = &review.assessment.telemetry;
    if t.gaps == 0 {
        return "The telemetry has no gaps longer than 0.2 s.".into();
    }
    format!(
        "Telemetry gaps longer than 0.2 s: {}. Interpolated frames: {}. Missing frames: {}. Telemetry covers {}% of the session.",
        t.gaps,
        t.interpolated_frames,
        t.missing_frames,
        formatting::number(100.0 * t.covered, 1)
    )
}

fn control_intervals(review: &Review) -> Table {
    let row = |interval: &spandrel_monitor::assessment::ControlInterval| {
        let t_s = |frame: u32| review.t_s((frame as usize).saturating_sub(1));
        vec![
            TableCell::Clock(t_s(interval.from_frame)),
            TableCell::Clock(t_s(interval.to_frame)),
            formatting::control_source_label(interval.by).into(),
        ]
    };
    Table {
        name: "flown-by",
        caption: "control source over time",
        columns: vec!["from", "to", "flown by"],
        rows: review.assessment.flown_by.iter().map(row).collect(),
    }
}

fn files(review: &Review) -> Table {
    let metadata = &review.metadata;
    let link = &review.link;
    let row = |name: &str, value: TableCell| vec![name.into(), value];
    Table {
        name: "record",
        caption: "session data",
        columns: vec!["item", "value"],
        rows: vec![
            row("session", metadata.folder.clone().into()),
            row("trainee", metadata.trainee.clone().into()),
            row("purpose", metadata.purpose.clone().unwrap_or_else(|| "not specified".into()).into()),
            row("started", metadata.started_utc.clone().into()),
            row("scenario", review.scenario.name.clone().into()),
            row("scenario SHA-256", metadata.scenario_sha256.clone().into()),
            row("aircraft", review.vehicle.id.clone().into()),
            row("aircraft SHA-256", metadata.vehicle_sha256.clone().into()),
            row("telemetry SHA-256", metadata.telemetry_sha256.clone().into()),
            row("seed", review.seed.to_string().into()),
            row("scorer", concat!("spandrel ", env!("CARGO_PKG_VERSION")).into()),
            row("frames scored", review.frames.len().into()),
            row("MAVLink frames received", TableCell::Number(link.frames as f64, 0)),
            row("frames lost", TableCell::Number(link.lost as f64, 0)),
            row("duplicate frames", TableCell::Number(link.duplicated as f64, 0)),
            row("frames out of order", TableCell::Number(link.reordered as f64, 0)),
        ],
    }
}
