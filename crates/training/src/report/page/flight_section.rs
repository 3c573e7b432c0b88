//! The flight on the site, its timeline and charts, linked by a slider.

use super::figure::{SLOT, figure, filled, legend, scrolling};
use super::{air, moment};
use crate::marks::TimelineMark;
use crate::report::feedback::{CueEpisode, KINDS};
use crate::report::plots::timeline::{TimelineRow, strips};
use crate::report::plots::{colors, map};
use crate::report::table::{Table, TableCell, folded};
use crate::report::{Review, formatting};
use maud::{Markup, html};
use spandrel_text::{Language, text};

/// ID and data columns of each chart.
const CHARTS: [(&str, &str); 6] = [
    ("speed", "speed"),
    ("distance", "distance"),
    ("clearance", "clearance"),
    ("battery", "battery"),
    ("sticks", "fb rl ud rt"),
    (WIND_CHART, "wind"),
];
/// ID of the chart that only flights with reports of the wind have.
const WIND_CHART: &str = "wind";

/// Returns a chart's title.
pub(super) fn chart_title(id: &str, language: Language) -> String {
    match id {
        "speed" => text!(language, "report-chart-speed"),
        "distance" => text!(language, "report-chart-distance"),
        "clearance" => text!(language, "report-chart-clearance"),
        "battery" => text!(language, "report-chart-battery"),
        WIND_CHART => text!(language, "report-chart-wind"),
        _ => text!(language, "report-chart-sticks"),
    }
}

/// Renders the "Flight" section of a session report.
pub fn section(review: &Review) -> Markup {
    let language = review.metadata.language;
    let timeline = strips(&rows(review), end_s(review), &text!(language, "report-flight-timeline-title"));
    html! {
        (controls(review))
        (video(review))
        (marks_legend(language))
        (drawings(review))
        (air::figures(review))
        (figure(&text!(language, "report-flight-timeline"), &html! {
            (legend(&timeline_legend(language)))
            (scrolling(&text!(language, "report-flight-timeline-region"), &timeline))
        }))
        (instructor_marks(review))
        div.charts {
            @for (id, columns) in CHARTS.into_iter().filter(|(id, _)| *id != WIND_CHART || review.has_wind()) {
                @let title = chart_title(id, language);
                figure {
                    figcaption { (title) @if id == "sticks" { (stick_legend(language)) } }
                    div.chart id={ "chart-" (id) } data-columns=(columns) role="img" aria-label=(text!(language, "report-chart-label", title = title.as_str())) {}
                }
            }
        }
        p.note { (text!(language, "report-flight-zoom")) }
        (folded(language, |language| series_table(review, language)))
        p.download { button type="button" id="series-csv" hidden { (text!(language, "report-flight-series")) } " "
            span.note { (text!(language, "report-flight-export", link = text!(language, "sessions-frames"))) } }
    }
}

fn end_s(review: &Review) -> f64 {
    review.t_s(review.frames.len().saturating_sub(1))
}

/// Renders the instructor's marks as a list with links to their moments; empty without marks.
fn instructor_marks(review: &Review) -> Markup {
    let marks = &review.metadata.marks;
    html! {
        @if !marks.is_empty() {
            h3 { (text!(review.metadata.language, "report-flight-marks")) }
            ol.marks { @for mark in marks { li { (moment::link(mark.t_s)) " " (mark.text) @if !mark.by.is_empty() { span.note { " (" (mark.by) ")" } } } } }
        }
    }
}

/// Renders the play button, the slider and its readout.
pub(super) fn slider(language: Language) -> Markup {
    html! {
        button type="button" id="play" aria-pressed="false" { (text!(language, "report-flight-play")) }
        label for="moment" { (text!(language, "report-flight-time-label")) }
        input type="range" id="moment" min="0" max="0" value="0" step="1";
        output id="moment-text" for="moment" { "0:00" }
    }
}

/// Returns the name of a value at the selected time.
pub(super) fn readout_name(id: &str, language: Language) -> String {
    match id {
        "task" => text!(language, "report-readout-task"),
        "state" => text!(language, "report-readout-path"),
        "distance" => text!(language, "report-readout-distance"),
        "speed" => text!(language, "report-readout-speed"),
        "clearance" => text!(language, "report-readout-clearance"),
        _ => text!(language, "report-readout-battery"),
    }
}

/// Renders the slider, the values at the selected time, and the color selection.
fn controls(review: &Review) -> Markup {
    let language = review.metadata.language;
    let limit_m_s = review.scenario.scoring.speed_limit_m_s;
    let key = |k: usize| -> Vec<(&str, String)> {
        colors::classes(k).iter().copied().zip(colors::legend(k, limit_m_s, language)).collect()
    };
    html! {
        div.controls id="controls" {
            div.run hidden id="run" { (slider(language)) }
            dl.readout hidden id="readout" aria-live="off" {
                @for id in ["task", "state", "distance", "speed", "clearance", "battery"] {
                    div { dt { (readout_name(id, language)) } dd id={ "now-" (id) } { "–" } }
                }
            }
            fieldset.switch {
                legend { (text!(language, "report-flight-color")) }
                @for (k, class) in colors::COLOR_MODES.iter().enumerate() {
                    label { input type="radio" name="coloring" value=(class) id=(class) checked[k == 0]; (colors::mode_name(k, language)) }
                }
            }
            @for (k, class) in colors::COLOR_MODES.iter().enumerate() { div class={ "key " (class) } { (legend(&key(k))) } }
        }
    }
}

/// How the video's element begins, up to its address.
pub const VIDEO_SOURCE: &str = "<video id=\"video\" src=\"";

/// Renders the video beside the report, beginning with [`VIDEO_SOURCE`]. The slider moves it, and while it plays, it moves the slider.
fn video(review: &Review) -> Markup {
    let language = review.metadata.language;
    let missing = text!(language, "report-flight-video-missing", file = SLOT);
    html! {
        @if let Some(file) = review.metadata.video {
            figure.video id="video-figure" {
                figcaption { (text!(language, "report-flight-video")) }
                video id="video" src=(file) controls muted playsinline preload="metadata" {}
                p.note id="video-missing" hidden { (filled(&missing, &html! { code { (file) } })) }
            }
        }
    }
}

fn marks_legend(language: Language) -> Markup {
    html! {
            ul.legend {
                li { svg.swatch viewBox="0 0 14 14" aria-hidden="true" { path.reference-key d="M0 7H14" {} } (text!(language, "report-flight-reference")) }
                li { svg.swatch viewBox="-7 -7 14 14" aria-hidden="true" { g.crash { path d="M-5 -5L5 5M5 -5L-5 5" {} } } (text!(language, "report-flight-contact")) }
                li { svg.swatch viewBox="-9 -9 18 18" aria-hidden="true" { g.picture.v-hit { circle r="8" {} } } (text!(language, "report-flight-picture-hit")) }
                li { svg.swatch viewBox="-9 -9 18 18" aria-hidden="true" { g.picture.v-repeat { circle r="8" {} } } (text!(language, "report-verdict-repeat")) }
                li { svg.swatch viewBox="-9 -9 18 18" aria-hidden="true" { g.picture.v-near { circle r="8" {} } } (text!(language, "report-verdict-near")) }
                li { svg.swatch viewBox="-9 -9 18 18" aria-hidden="true" { g.picture.v-false { circle r="8" {} } } (text!(language, "report-verdict-false")) }
            }
    }
}

fn drawings(review: &Review) -> Markup {
    let scroll = |label: &str, body: &Markup| html! { div.scroll.wide tabindex="0" role="region" aria-label=(label) { (body) } };
    let language = review.metadata.language;
    html! {
        (figure(&text!(language, "report-flight-plan"), &scroll(&text!(language, "report-flight-plan-region"), &map::plan(review))))
        @if review.scenario.bridges.is_empty() {
            (figure(&text!(language, "report-flight-south"), &scroll(&text!(language, "report-flight-elevation-region"), &map::south_elevation(review))))
        }
        @for bridge in &review.scenario.bridges {
            @let title = text!(language, "report-flight-side", bridge = bridge.name.as_str());
            (figure(&title, &scroll(&title, &map::elevation(review, bridge))))
        }
        figure.model id="model" {
            figcaption { (text!(language, "report-flight-3d")) " " button type="button" id="model-open" hidden { (text!(language, "report-flight-rotate")) } }
            div.scroll.wide id="model-still" tabindex="0" role="region" aria-label=(text!(language, "report-flight-3d-region")) { (map::oblique(review)) }
            div id="model-live" hidden {}
            p.note id="model-note" hidden { (text!(language, "report-flight-3d-note")) }
        }
    }
}

fn timeline_legend(language: Language) -> Vec<(&'static str, String)> {
    vec![
        ("h-pilot", text!(language, "report-timeline-pilot")),
        ("h-other", text!(language, "report-timeline-other")),
        ("w-task", text!(language, "report-timeline-task")),
        ("cue", text!(language, "report-timeline-cue")),
        ("gap", text!(language, "report-timeline-gap")),
    ]
}

fn stick_legend(language: Language) -> Markup {
    legend(&[
        ("s-fb", text!(language, "terms-direction-forward")),
        ("s-rl", text!(language, "terms-direction-right")),
        ("s-ud", text!(language, "terms-direction-up")),
        ("s-rt", text!(language, "report-stick-turn-clockwise")),
    ])
}

fn rows(review: &Review) -> Vec<TimelineRow> {
    let language = review.metadata.language;
    let mut rows = vec![control_intervals(review)];
    for (k, window) in review.on_path.windows.iter().enumerate() {
        let stretch =
            window.map(|w| ("w-task".to_owned(), review.t_s(w.first), review.t_s(w.last), review.task_name(k, language)));
        rows.push(TimelineRow {
            name: text!(language, "report-task", task = review.scenario.tasks[k].id),
            intervals: stretch.into_iter().collect(),
            marks: Vec::new(),
        });
    }
    for (kind, about) in KINDS.iter().enumerate() {
        let mine = review.feedback.episodes.iter().filter(|episode| episode.kind == kind);
        let name = about.label(language);
        let interval = |e: &CueEpisode| {
            let (from, to) = (formatting::clock(e.from_s), formatting::clock(e.to_s));
            let words = text!(language, "report-timeline-episode", cue = name.as_str(), from = from, to = to);
            ("cue".to_owned(), e.from_s, e.to_s, words)
        };
        let intervals: Vec<_> = mine.map(interval).collect();
        if !intervals.is_empty() {
            rows.push(TimelineRow { name, intervals, marks: Vec::new() });
        }
    }
    let picture = |p: &crate::report::pictures::ReviewedPicture| {
        let words = text!(language, "report-timeline-picture", picture = p.number, verdict = p.verdict.name(language));
        (format!("picture-dot {}", p.verdict.class()), p.t_s, words)
    };
    rows.push(TimelineRow {
        name: text!(language, "report-timeline-pictures"),
        intervals: Vec::new(),
        marks: review.pictures.iter().map(picture).collect(),
    });
    if !review.feedback.notes.is_empty() {
        let note = |(t_s, note): &(f64, String)| {
            ("note-dot".to_owned(), *t_s, text!(language, "report-timeline-note", note = note.as_str()))
        };
        rows.push(TimelineRow {
            name: text!(language, "report-timeline-notes"),
            intervals: Vec::new(),
            marks: review.feedback.notes.iter().map(note).collect(),
        });
    }
    if !review.metadata.marks.is_empty() {
        let mark = |mark: &TimelineMark| {
            ("mark-dot".to_owned(), mark.t_s, text!(language, "report-timeline-mark", mark = mark.text.as_str()))
        };
        rows.push(TimelineRow {
            name: text!(language, "report-timeline-marks"),
            intervals: Vec::new(),
            marks: review.metadata.marks.iter().map(mark).collect(),
        });
    }
    rows.push(gaps(review));
    rows
}

fn control_intervals(review: &Review) -> TimelineRow {
    let language = review.metadata.language;
    let stretch = |s: &spandrel_monitor::assessment::ControlInterval| {
        let class = if s.by == Some(spandrel_mavlink::contract::modes::ControlSource::Pilot) { "h-pilot" } else { "h-other" };
        let t_s = |frame: u32| review.t_s((frame as usize).saturating_sub(1));
        (class.to_owned(), t_s(s.from_frame), t_s(s.to_frame), formatting::control_source_label(s.by, language))
    };
    TimelineRow {
        name: text!(language, "report-timeline-flown-by"),
        intervals: review.assessment.flown_by.iter().map(stretch).collect(),
        marks: Vec::new(),
    }
}

/// Returns the periods without telemetry, in which frames are interpolated or missing.
fn gaps(review: &Review) -> TimelineRow {
    let language = review.metadata.language;
    let mut intervals: Vec<(String, f64, f64, String)> = Vec::new();
    let mut open: Option<usize> = None;
    for (i, frame) in review.frames.iter().enumerate() {
        let gap = frame.missing || frame.interpolated;
        match open {
            None if gap => open = Some(i),
            Some(from) if !gap => {
                let seconds = formatting::number(review.t_s(i) - review.t_s(from), 1);
                let words = text!(language, "report-timeline-gap-for", seconds = seconds);
                intervals.push(("gap".into(), review.t_s(from), review.t_s(i), words));
                open = None;
            }
            None | Some(_) => {}
        }
    }
    let to_end = text!(language, "report-timeline-gap-to-end");
    intervals.extend(open.map(|from| ("gap".into(), review.t_s(from), end_s(review), to_end)));
    TimelineRow { name: text!(language, "report-timeline-gaps"), intervals, marks: Vec::new() }
}

/// Returns whether the drone is inside a task and on its path, as text.
fn path_state(inside: bool, on: bool, language: Language) -> String {
    match (inside, on) {
        (_, true) => text!(language, "report-on-path"),
        (true, false) => text!(language, "report-off-path"),
        (false, false) => text!(language, "report-between-tasks"),
    }
}

/// Returns the charts' data as a table with one row every few seconds.
fn series_table(review: &Review, language: Language) -> Table {
    let every_s = (end_s(review) / 60.0 / 5.0).ceil().max(1.0) * 5.0;
    let stride = (every_s * review.scenario.scoring.frame_rate_hz).round().max(1.0) as usize;
    let has_wind = review.has_wind();
    let known = |value: Option<f64>, digits: usize| value.map_or(TableCell::Empty, |value| TableCell::Number(value, digits));
    let row = |(i, frame): (usize, &spandrel_mavlink::telemetry::Frame)| {
        let step = &review.track[i];
        let mut cells = vec![
            TableCell::Clock(review.t_s(i)),
            step.task.map_or(TableCell::Empty, |task| review.scenario.tasks[task].id.into()),
            path_state(step.inside, step.on, language).into(),
            known(step.distance_m, 2),
            TableCell::Number(frame.speed_m_s(), 2),
            known(frame.clearance_m, 2),
            TableCell::Number(frame.battery_pct, 0),
            TableCell::Number(frame.sticks[0], 2),
            TableCell::Number(frame.sticks[1], 2),
            TableCell::Number(frame.sticks[2], 2),
            TableCell::Number(frame.sticks[3], 2),
        ];
        if has_wind {
            let (speed_m_s, from_deg) = review.wind(i).unzip();
            cells.extend([known(speed_m_s, 1), known(from_deg, 0)]);
        }
        cells
    };
    let mut columns = vec![
        text!(language, "report-column-time"),
        text!(language, "report-column-task"),
        text!(language, "report-column-path"),
        text!(language, "report-column-distance"),
        text!(language, "report-column-speed"),
        text!(language, "report-column-clearance"),
        text!(language, "report-column-battery"),
        text!(language, "terms-direction-forward"),
        text!(language, "terms-direction-right"),
        text!(language, "terms-direction-up"),
        text!(language, "report-stick-turn"),
    ];
    if has_wind {
        columns.extend([text!(language, "report-column-wind"), text!(language, "report-column-wind-from")]);
    }
    Table {
        name: "flight",
        caption: text!(language, "report-flight-caption"),
        columns,
        rows: review.frames.iter().enumerate().step_by(stride).map(row).collect(),
    }
}
