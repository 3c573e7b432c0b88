//! Results by task: on-path share, speeding, and crashes by object.

use super::figure::{figure, legend};
use crate::report::Review;
use crate::report::formatting;
use crate::report::plots::bars::{self, CountRow, ShareRow};
use crate::report::table::{Table, TableCell};
use maud::{Markup, html};
use spandrel_mavlink::contract::contact::ContactKind;
use spandrel_monitor::score::completion::TaskState;
use spandrel_text::Language;

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
    html! {
        div.split {
            (figure("Share of each task's time spent on the path and over the speed limit", &html! {
                (legend(&[("b-on", "on the path".into()), ("b-speeding", "over the speed limit".into())]))
                (bars::shares(&rows(review), "On-path share and speeding by task"))
            }))
            (figure("Contacts by task and object", &html! {
                (legend(&contact_kinds(review)))
                @if review.crashes.is_empty() { p.calm { "No contacts." } }
                @else { (bars::counts(&counts(review), "Contacts by task and kind")) }
            }))
        }
        ul { @for (k, task) in review.assessment.tasks.iter().enumerate() {
            li { (task.id) " · " (review.scenario.tasks[k].name) ": " (task.state.description(task.covered, done_share, Language::English)) }
        } }
        (task_table(review).folded())
        (crash_table(review).folded())
    }
}

fn rows(review: &Review) -> Vec<ShareRow> {
    let row = |(k, task): (usize, &spandrel_monitor::assessment::TaskResult)| {
        let facts = &review.tasks[k];
        let share = |seconds: f64| if facts.time_s > 0.0 { seconds / facts.time_s } else { 0.0 };
        ShareRow {
            name: format!("{} · {}", task.id, review.scenario.tasks[k].name),
            bars: vec![("b-on", task.on_path), ("b-speeding", share(facts.speeding_s))],
            placeholder: (!task.attempted).then(|| "not attempted".to_owned()),
        }
    };
    review.assessment.tasks.iter().enumerate().map(row).collect()
}

fn state(task: &spandrel_monitor::assessment::TaskResult) -> &'static str {
    match task.state {
        TaskState::Done => "done",
        TaskState::Part => "partly flown",
        TaskState::NotAttempted => "not attempted",
    }
}

fn of(review: &Review, task: Option<usize>, kind: ContactKind) -> usize {
    review.crashes.iter().filter(|crash| crash.task == task && crash.with == kind).count()
}

fn counts(review: &Review) -> Vec<CountRow> {
    let tasks = (0..review.scenario.tasks.len()).map(Some).chain([None]);
    let name = |task: Option<usize>| match task {
        Some(k) => format!("{} · {}", review.scenario.tasks[k].id, review.scenario.tasks[k].name),
        None => "between tasks".into(),
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
        .map(|(kind, class)| (*class, formatting::contact_label(*kind).to_owned()))
        .collect()
}

fn task_table(review: &Review) -> Table {
    let number = |value: f64, digits: usize| TableCell::Number(value, digits);
    let row = |(k, task): (usize, &spandrel_monitor::assessment::TaskResult)| {
        let facts = &review.tasks[k];
        vec![
            task.id.into(),
            review.scenario.tasks[k].name.clone().into(),
            state(task).into(),
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
        caption: "tasks",
        columns: vec![
            "task",
            "name",
            "state",
            "path flown (%)",
            "time (s)",
            "on-path share (%)",
            "time off path (s)",
            "speeding time (s)",
            "speeding loss",
            "mean distance (m)",
            "maximum distance (m)",
            "maximum speed (m/s)",
            "minimum clearance (m)",
        ],
        rows: review.assessment.tasks.iter().enumerate().map(row).collect(),
    }
}

fn crash_table(review: &Review) -> Table {
    let row = |crash: &spandrel_monitor::measures::crash::Crash| {
        let [east, north, up] = review.frames[crash.frame].position_m.array();
        vec![
            TableCell::Clock(review.t_s(crash.frame)),
            crash.task.map_or("between tasks".into(), |k| format!("task {}", review.scenario.tasks[k].id)).into(),
            formatting::contact_label(crash.with).into(),
            TableCell::Number(crash.speed_m_s, 2),
            TableCell::Number(east, 2),
            TableCell::Number(north, 2),
            TableCell::Number(up, 2),
        ]
    };
    Table {
        name: "contacts",
        caption: "contacts",
        columns: vec!["time", "task", "with", "speed (m/s)", "east (m)", "north (m)", "height (m)"],
        rows: review.crashes.iter().map(row).collect(),
    }
}
