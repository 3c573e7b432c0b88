//! Results by task: on-path share, speeding, and crashes by object.

use super::figure::{figure, legend};
use crate::report::Review;
use crate::report::plots::bars::{self, CountRow, ShareRow};
use crate::report::table::{Table, TableCell, folded};
use crate::terms::contact_title;
use maud::{Markup, html};
use spandrel_mavlink::contract::contact::ContactKind;
use spandrel_monitor::score::completion::TaskState;
use spandrel_text::{Language, text};

/// Object hit and CSS class, in the order of the bars.
const KINDS: [(ContactKind, &str); 6] = [
    (ContactKind::Bridge, "k-bridge"),
    (ContactKind::Terrain, "k-terrain"),
    (ContactKind::Water, "k-water"),
    (ContactKind::Other, "k-other"),
    (ContactKind::Vehicle, "k-grave"),
    (ContactKind::Person, "k-grave"),
];

/// Renders the "Tasks" section of a session report.
pub fn section(review: &Review) -> Markup {
    let done_share = review.assessment.completion.done_share;
    let language = review.metadata.language;
    html! {
        div.split {
            (figure(&text!(language, "report-tasks-shares"), &html! {
                (legend(&[("b-on", text!(language, "report-tasks-on-path")), ("b-speeding", text!(language, "report-tasks-speeding"))]))
                (bars::shares(&rows(review), &text!(language, "report-tasks-shares-title")))
            }))
            (figure(&text!(language, "report-tasks-contacts"), &html! {
                (legend(&contact_kinds(review)))
                @if review.crashes.is_empty() { p.calm { (text!(language, "report-tasks-no-contacts")) } }
                @else { (bars::counts(&counts(review), &text!(language, "report-tasks-contacts-title"))) }
            }))
        }
        ul { @for (k, task) in review.assessment.tasks.iter().enumerate() {
            li { (task.id) " · " (review.task_name(k, language)) ": " (task.state.description(task.covered, done_share, language)) }
        } }
        (folded(language, |language| task_table(review, language)))
        (folded(language, |language| crash_table(review, language)))
    }
}

fn rows(review: &Review) -> Vec<ShareRow> {
    let row = |(k, task): (usize, &spandrel_monitor::assessment::TaskResult)| {
        let facts = &review.tasks[k];
        let share = |seconds: f64| if facts.time_s > 0.0 { seconds / facts.time_s } else { 0.0 };
        ShareRow {
            name: format!("{} · {}", task.id, review.task_name(k, review.metadata.language)),
            bars: vec![("b-on", task.on_path), ("b-speeding", share(facts.speeding_s))],
            placeholder: (!task.attempted).then(|| text!(review.metadata.language, "report-not-attempted")),
        }
    };
    review.assessment.tasks.iter().enumerate().map(row).collect()
}

fn state(task: &spandrel_monitor::assessment::TaskResult, language: Language) -> String {
    match task.state {
        TaskState::Done => text!(language, "report-tasks-done"),
        TaskState::Part => text!(language, "report-tasks-part"),
        TaskState::NotAttempted => text!(language, "report-not-attempted"),
    }
}

fn of(review: &Review, task: Option<usize>, kind: ContactKind) -> usize {
    review.crashes.iter().filter(|crash| crash.task == task && crash.with == kind).count()
}

fn counts(review: &Review) -> Vec<CountRow> {
    let tasks = (0..review.scenario.tasks.len()).map(Some).chain([None]);
    let name = |task: Option<usize>| match task {
        Some(k) => format!("{} · {}", review.scenario.tasks[k].id, review.task_name(k, review.metadata.language)),
        None => text!(review.metadata.language, "report-between-tasks"),
    };
    tasks
        .map(|task| CountRow { name: name(task), kinds: KINDS.map(|(kind, class)| (class, of(review, task, kind))).to_vec() })
        .collect()
}

fn contact_kinds(review: &Review) -> Vec<(&'static str, String)> {
    let present = |kind: ContactKind| review.crashes.iter().any(|crash| crash.with == kind);
    KINDS
        .iter()
        .filter(|(kind, _)| present(*kind))
        .map(|(kind, class)| (*class, contact_title(kind.label(), review.metadata.language)))
        .collect()
}

fn task_table(review: &Review, language: Language) -> Table {
    let number = |value: f64, digits: usize| TableCell::Number(value, digits);
    let row = |(k, task): (usize, &spandrel_monitor::assessment::TaskResult)| {
        let facts = &review.tasks[k];
        vec![
            task.id.into(),
            review.task_name(k, language).into(),
            state(task, language).into(),
            number(100.0 * task.covered, 1),
            number(facts.time_s, 1),
            number(100.0 * task.on_path, 1),
            number(facts.off_path_s, 1),
            number(facts.speeding_s, 1),
            number(task.speeding, 3),
            number(facts.mean_distance_m, 2),
            number(facts.max_distance_m, 2),
            number(facts.max_speed_m_s, 2),
            number(facts.min_clearance_m, 2),
        ]
    };
    Table {
        name: "tasks",
        caption: text!(language, "report-tasks-caption"),
        columns: vec![
            text!(language, "report-column-task"),
            text!(language, "report-column-name"),
            text!(language, "report-column-state"),
            text!(language, "report-column-path-flown"),
            text!(language, "report-column-time-s"),
            text!(language, "report-column-on-path-share"),
            text!(language, "report-column-off-path-time"),
            text!(language, "report-column-speeding-time"),
            text!(language, "report-column-speeding-loss"),
            text!(language, "report-column-mean-distance"),
            text!(language, "report-column-max-distance"),
            text!(language, "report-column-max-speed"),
            text!(language, "report-column-min-clearance"),
        ],
        rows: review.assessment.tasks.iter().enumerate().map(row).collect(),
    }
}

/// Returns the name of the task being flown, if any.
pub fn task_label(task: Option<usize>, review: &Review, language: Language) -> String {
    match task {
        Some(k) => text!(language, "report-task", task = review.scenario.tasks[k].id),
        None => text!(language, "report-between-tasks"),
    }
}

fn crash_table(review: &Review, language: Language) -> Table {
    let row = |crash: &spandrel_monitor::measures::crash::Crash| {
        let [east, north, up] = review.frames[crash.frame].position_m.array();
        vec![
            TableCell::Clock(review.t_s(crash.frame)),
            task_label(crash.task, review, language).into(),
            contact_title(crash.with.label(), language).into(),
            TableCell::Number(crash.speed_m_s, 2),
            TableCell::Number(east, 2),
            TableCell::Number(north, 2),
            TableCell::Number(up, 2),
        ]
    };
    Table {
        name: "contacts",
        caption: text!(language, "report-tasks-contacts-caption"),
        columns: vec![
            text!(language, "report-column-time"),
            text!(language, "report-column-task"),
            text!(language, "report-column-with"),
            text!(language, "report-column-speed"),
            text!(language, "report-column-east"),
            text!(language, "report-column-north"),
            text!(language, "report-column-height"),
        ],
        rows: review.crashes.iter().map(row).collect(),
    }
}
