//! The flight on the site, its timeline and charts, linked by a slider.

use super::figure::{figure, legend, scrolling};
use super::moment;
use crate::marks::TimelineMark;
use crate::report::feedback::KINDS;
use crate::report::plots::timeline::{TimelineRow, strips};
use crate::report::plots::{colors, map};
use crate::report::table::{Table, TableCell};
use crate::report::{Review, formatting};
use maud::{Markup, html};

/// ID, title and data columns of each chart.
const CHARTS: [(&str, &str, &str); 5] = [
    ("speed", "Speed (m/s)", "speed"),
    ("distance", "Distance to the current task's path (m)", "distance"),
    ("clearance", "Clearance to the nearest surface (m)", "clearance"),
    ("battery", "Battery (%)", "battery"),
    ("sticks", "Stick positions (full travel = 1)", "fb rl ud rt"),
];

/// Renders the "Flight" section of a session report.
pub fn section(review: &Review) -> Markup {
    html! {
        (controls(review))
        (video(review))
        (marks_legend())
        (drawings(review))
        (figure("Session timeline", &html! {
            (legend(&timeline_legend()))
            (scrolling("Timeline", &strips(&rows(review), end_s(review), "Control source, tasks, feedback, pictures and gaps over time")))
        }))
        (instructor_marks(review))
        div.charts {
            @for (id, title, columns) in CHARTS {
                figure {
                    figcaption { (title) @if id == "sticks" { (stick_legend()) } }
                    div.chart id={ "chart-" (id) } data-columns=(columns) role="img" aria-label={ (title) " over time; see the table below for the values" } {}
                }
            }
        }
        p.note { "Drag across a chart to zoom in. Double-click to reset the zoom. Click to move the slider." }
        (series_table(review).folded())
        p.download { button type="button" id="series-csv" hidden { "Download time series as CSV" } " "
            span.note { "To export every frame: " code { "spandrel export SESSION --frames frames.csv" } } }
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
            h3 { "Instructor's marks" }
            ol.marks { @for mark in marks { li { (moment::link(mark.t_s)) " " (mark.text) @if !mark.by.is_empty() { span.note { " (" (mark.by) ")" } } } } }
        }
    }
}

/// Renders the play button, the slider and its readout.
pub(super) fn slider() -> Markup {
    html! {
        button type="button" id="play" aria-pressed="false" { "Play" }
        label for="moment" { "Time" }
        input type="range" id="moment" min="0" max="0" value="0" step="1";
        output id="moment-text" for="moment" { "0:00" }
    }
}

/// Renders the slider, the values at the selected time, and the color selection.
fn controls(review: &Review) -> Markup {
    html! {
        div.controls id="controls" {
            div.run hidden id="run" { (slider()) }
            dl.readout hidden id="readout" aria-live="off" {
                @for (id, name) in [("task", "Task"), ("state", "Path"), ("distance", "Distance"), ("speed", "Speed"), ("clearance", "Clearance"), ("battery", "Battery")] {
                    div { dt { (name) } dd id={ "now-" (id) } { "–" } }
                }
            }
            fieldset.switch {
                legend { "Color flight path by" }
                @for (k, (name, class)) in colors::COLOR_MODES.iter().enumerate() {
                    label { input type="radio" name="coloring" value=(class) id=(class) checked[k == 0]; (name) }
                }
            }
            @for (k, (_, class)) in colors::COLOR_MODES.iter().enumerate() {
                div class={ "key " (class) } {
                    (legend(&colors::classes(k).iter().copied().zip(colors::legend(k, review.scenario.scoring.speed_limit_m_s)).collect::<Vec<_>>()))
                }
            }
        }
    }
}

/// Renders the video beside the report. The slider moves it, and while it plays, it moves the slider.
fn video(review: &Review) -> Markup {
    html! {
        @if let Some(file) = review.metadata.video {
            figure.video id="video-figure" {
                figcaption { "Camera view" }
                video id="video" src=(file) controls muted playsinline preload="metadata" {}
                p.note id="video-missing" hidden { "The video cannot be loaded from here. It is also on the session's page and in the session folder (" code { (file) } ")." }
            }
        }
    }
}

fn marks_legend() -> Markup {
    html! {
            ul.legend {
                li { svg.swatch viewBox="0 0 14 14" aria-hidden="true" { path.reference-key d="M0 7H14" {} } "reference path" }
                li { svg.swatch viewBox="-7 -7 14 14" aria-hidden="true" { g.crash { path d="M-5 -5L5 5M5 -5L-5 5" {} } } "contact" }
                li { svg.swatch viewBox="-9 -9 18 18" aria-hidden="true" { g.picture.v-hit { circle r="8" {} } } "picture: hit" }
                li { svg.swatch viewBox="-9 -9 18 18" aria-hidden="true" { g.picture.v-repeat { circle r="8" {} } } "repeat" }
                li { svg.swatch viewBox="-9 -9 18 18" aria-hidden="true" { g.picture.v-near { circle r="8" {} } } "near miss" }
                li { svg.swatch viewBox="-9 -9 18 18" aria-hidden="true" { g.picture.v-false { circle r="8" {} } } "false" }
            }
    }
}

fn drawings(review: &Review) -> Markup {
    let scroll = |label: &str, body: &Markup| html! { div.scroll.wide tabindex="0" role="region" aria-label=(label) { (body) } };
    html! {
        (figure("From above, north up", &scroll("Plan", &map::plan(review))))
        @if review.scenario.bridges.is_empty() {
            (figure("View from the south", &scroll("Elevation", &map::south_elevation(review))))
        }
        @for bridge in &review.scenario.bridges {
            @let title = format!("Side view of bridge '{}', with the nearby flight path", bridge.name);
            (figure(&title, &scroll(&title, &map::elevation(review, bridge))))
        }
        figure.model id="model" {
            figcaption { "3D view " button type="button" id="model-open" hidden { "Rotate" } }
            div.scroll.wide id="model-still" tabindex="0" role="region" aria-label="3D view of the flight" { (map::oblique(review)) }
            div id="model-live" hidden {}
            p.note id="model-note" hidden { "Drag or use the arrow keys to rotate. Use the + and − keys or the mouse wheel to zoom." }
        }
    }
}

fn timeline_legend() -> Vec<(&'static str, String)> {
    vec![
        ("h-pilot", "flown by the pilot".into()),
        ("h-other", "flown by mission, script or autopilot".into()),
        ("w-task", "task".into()),
        ("cue", "cue".into()),
        ("gap", "no telemetry".into()),
    ]
}

fn stick_legend() -> Markup {
    legend(&[("s-fb", "forward".into()), ("s-rl", "right".into()), ("s-ud", "up".into()), ("s-rt", "turn clockwise".into())])
}

fn rows(review: &Review) -> Vec<TimelineRow> {
    let mut rows = vec![control_intervals(review)];
    for (k, window) in review.on_path.windows.iter().enumerate() {
        let stretch =
            window.map(|w| ("w-task".to_owned(), review.t_s(w.first), review.t_s(w.last), review.scenario.tasks[k].name.clone()));
        rows.push(TimelineRow {
            name: format!("task {}", review.scenario.tasks[k].id),
            intervals: stretch.into_iter().collect(),
            marks: Vec::new(),
        });
    }
    for (kind, about) in KINDS.iter().enumerate() {
        let mine = review.feedback.episodes.iter().filter(|episode| episode.kind == kind);
        let intervals: Vec<_> = mine
            .map(|e| {
                (
                    "cue".to_owned(),
                    e.from_s,
                    e.to_s,
                    format!("{} from {} to {}", about.name, formatting::clock(e.from_s), formatting::clock(e.to_s)),
                )
            })
            .collect();
        if !intervals.is_empty() {
            rows.push(TimelineRow { name: about.name.to_owned(), intervals, marks: Vec::new() });
        }
    }
    let picture = |p: &crate::report::pictures::ReviewedPicture| {
        (format!("picture-dot {}", p.verdict.class()), p.t_s, format!("picture {}: {}", p.number, p.verdict.name()))
    };
    rows.push(TimelineRow {
        name: "pictures".into(),
        intervals: Vec::new(),
        marks: review.pictures.iter().map(picture).collect(),
    });
    if !review.feedback.notes.is_empty() {
        let note = |(t_s, text): &(f64, String)| ("note-dot".to_owned(), *t_s, format!("note: {text}"));
        rows.push(TimelineRow {
            name: "notes".into(),
            intervals: Vec::new(),
            marks: review.feedback.notes.iter().map(note).collect(),
        });
    }
    if !review.metadata.marks.is_empty() {
        let mark = |mark: &TimelineMark| ("mark-dot".to_owned(), mark.t_s, format!("mark: {}", mark.text));
        rows.push(TimelineRow {
            name: "marks".into(),
            intervals: Vec::new(),
            marks: review.metadata.marks.iter().map(mark).collect(),
        });
    }
    rows.push(gaps(review));
    rows
}

fn control_intervals(review: &Review) -> TimelineRow {
    let stretch = |s: &spandrel_monitor::assessment::ControlInterval| {
        let class = if s.by == Some(spandrel_mavlink::contract::modes::ControlSource::Pilot) { "h-pilot" } else { "h-other" };
        let t_s = |frame: u32| review.t_s((frame as usize).saturating_sub(1));
        (class.to_owned(), t_s(s.from_frame), t_s(s.to_frame), formatting::control_source_label(s.by).to_owned())
    };
    TimelineRow {
        name: "flown by".into(),
        intervals: review.assessment.flown_by.iter().map(stretch).collect(),
        marks: Vec::new(),
    }
}

/// Returns the periods without telemetry, in which frames are interpolated or missing.
fn gaps(review: &Review) -> TimelineRow {
    let mut intervals: Vec<(String, f64, f64, String)> = Vec::new();
    let mut open: Option<usize> = None;
    for (i, frame) in review.frames.iter().enumerate() {
        let gap = frame.missing || frame.interpolated;
        match open {
            None if gap => open = Some(i),
            Some(from) if !gap => {
                let seconds = formatting::number(review.t_s(i) - review.t_s(from), 1);
                intervals.push(("gap".into(), review.t_s(from), review.t_s(i), format!("no telemetry for {seconds} s")));
                open = None;
            }
            None | Some(_) => {}
        }
    }
    intervals.extend(open.map(|from| ("gap".into(), review.t_s(from), end_s(review), "no telemetry until the end".into())));
    TimelineRow { name: "gaps".into(), intervals, marks: Vec::new() }
}

/// Returns the charts' data as a table with one row every few seconds.
fn series_table(review: &Review) -> Table {
    let every_s = (end_s(review) / 60.0 / 5.0).ceil().max(1.0) * 5.0;
    let stride = (every_s * review.scenario.scoring.frame_rate_hz).round().max(1.0) as usize;
    let known = |value: Option<f64>, digits: usize| value.map_or(TableCell::Empty, |value| TableCell::Number(value, digits));
    let row = |(i, frame): (usize, &spandrel_mavlink::telemetry::Frame)| {
        let step = &review.track[i];
        vec![
            TableCell::Clock(review.t_s(i)),
            step.task.map_or(TableCell::Empty, |task| review.scenario.tasks[task].id.into()),
            if step.on {
                "on path"
            } else if step.inside {
                "off path"
            } else {
                "between tasks"
            }
            .into(),
            known(step.distance_m, 2),
            TableCell::Number(frame.speed_m_s(), 2),
            known(frame.clearance_m, 2),
            TableCell::Number(frame.battery_pct, 0),
            TableCell::Number(frame.sticks[0], 2),
            TableCell::Number(frame.sticks[1], 2),
            TableCell::Number(frame.sticks[2], 2),
            TableCell::Number(frame.sticks[3], 2),
        ]
    };
    Table {
        name: "flight",
        caption: "flight data, sampled every few seconds",
        columns: vec![
            "time",
            "task",
            "path",
            "distance (m)",
            "speed (m/s)",
            "clearance (m)",
            "battery (%)",
            "forward",
            "right",
            "up",
            "turn",
        ],
        rows: review.frames.iter().enumerate().step_by(stride).map(row).collect(),
    }
}
