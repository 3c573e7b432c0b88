//! Data behind the report: telemetry gaps, control sources, link statistics, files and their hashes.

use crate::report::Review;
use crate::report::formatting;
use crate::report::table::{Table, TableCell, shown};
use crate::terms::purpose_title;
use maud::{Markup, html};
use spandrel_text::{Language, text};

/// Renders the "Record" section of a session report.
pub fn section(review: &Review) -> Markup {
    let telemetry = &review.assessment.telemetry;
    let language = review.metadata.language;
    html! {
        p { (gaps(review)) }
        @if telemetry.missing_frames > 0 {
            p.note { (text!(language, "report-record-frames-note")) }
        }
        (shown(language, |language| control_intervals(review, language)))
        (shown(language, |language| files(review, language)))
        p.note { (text!(language, "report-record-files-note")) }
    }
}

fn gaps(review: &Review) -> String {
    let (t, language) = (&review.assessment.telemetry, review.metadata.language);
    if t.gaps == 0 {
        return text!(language, "report-record-no-gaps");
    }
    text!(
        language,
        "report-record-gaps",
        gaps = t.gaps,
        interpolated = t.interpolated_frames,
        missing = t.missing_frames,
        share = formatting::number(100.0 * t.covered, 1)
    )
}

fn control_intervals(review: &Review, language: Language) -> Table {
    let row = |interval: &spandrel_monitor::assessment::ControlInterval| {
        let t_s = |frame: u32| review.t_s((frame as usize).saturating_sub(1));
        vec![
            TableCell::Clock(t_s(interval.from_frame)),
            TableCell::Clock(t_s(interval.to_frame)),
            formatting::control_source_label(interval.by, language).into(),
        ]
    };
    Table {
        name: "flown-by",
        caption: text!(language, "report-record-control-caption"),
        columns: vec![
            text!(language, "report-column-from"),
            text!(language, "report-column-to"),
            text!(language, "report-column-flown-by"),
        ],
        rows: review.assessment.flown_by.iter().map(row).collect(),
    }
}

fn files(review: &Review, language: Language) -> Table {
    let metadata = &review.metadata;
    let link = &review.link;
    let purpose = match &metadata.purpose {
        Some(purpose) => purpose_title(purpose, language),
        None => text!(language, "report-record-no-purpose"),
    };
    let row = |name: String, value: TableCell| vec![name.into(), value];
    Table {
        name: "record",
        caption: text!(language, "report-record-caption"),
        columns: vec![text!(language, "report-column-item"), text!(language, "report-column-value")],
        rows: vec![
            row(text!(language, "report-record-session"), metadata.folder.clone().into()),
            row(text!(language, "report-record-trainee"), metadata.trainee.clone().into()),
            row(text!(language, "report-record-purpose"), purpose.into()),
            row(text!(language, "report-record-started"), metadata.started_utc.clone().into()),
            row(text!(language, "report-record-scenario"), review.scenario.name.clone().into()),
            row(text!(language, "report-record-scenario-hash"), metadata.scenario_sha256.clone().into()),
            row(text!(language, "report-record-aircraft"), review.vehicle.id.clone().into()),
            row(text!(language, "report-record-aircraft-hash"), metadata.vehicle_sha256.clone().into()),
            row(text!(language, "report-record-telemetry-hash"), metadata.telemetry_sha256.clone().into()),
            row(text!(language, "report-record-seed"), review.seed.to_string().into()),
            row(text!(language, "report-record-scorer"), concat!("spandrel ", env!("CARGO_PKG_VERSION")).into()),
            row(text!(language, "report-record-frames"), review.frames.len().into()),
            row(text!(language, "report-record-received"), TableCell::Number(link.frames as f64, 0)),
            row(text!(language, "report-record-lost"), TableCell::Number(link.lost as f64, 0)),
            row(text!(language, "report-record-duplicate"), TableCell::Number(link.duplicated as f64, 0)),
            row(text!(language, "report-record-reordered"), TableCell::Number(link.reordered as f64, 0)),
        ],
    }
}
