//! What the briefing says about each task.

use crate::terms::task_title;
use serde::Serialize;
use spandrel_model::frames::{Enu, Vec3};
use spandrel_model::math;
use spandrel_model::scenario::{Scenario, Task};
use spandrel_model::site::Site;
use spandrel_text::{Language, text};

/// Shortest distance between the ends of a path that gives it a direction, m (estimate).
const MIN_DIRECTED_M: f64 = 2.0;

/// The briefing for one task.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct TaskBriefing {
    /// Task number.
    pub id: u32,
    /// Name.
    pub name: String,
    /// Where to fly, such as "along the edge of the deck of bridge 'arch', from west to east".
    pub place: String,
    /// Length of the path, m.
    pub length_m: f64,
    /// Lowest and highest point of the path above the landing pad, m.
    pub heights_m: (f64, f64),
    /// Recommended distance from the surface and its tolerance, m.
    pub stand_off_m: Option<(f64, f64)>,
    /// Distance from the path up to which the drone is on it, m.
    pub threshold_m: f64,
    /// Whether the lamp is needed.
    pub lamp: bool,
    /// Smallest distance between the path and the structure, m.
    pub clearance_m: Option<f64>,
}

/// Distance up to which structures beside a path are mentioned, m (estimate).
const MAX_CLEARANCE_M: f64 = 10.0;

impl TaskBriefing {
    pub(super) fn new(task: &Task, scenario: &Scenario, site: &Site, language: Language) -> Self {
        let pad_up_m = scenario.ground_team.pad_m.up();
        let heights_m = task.path_m.iter().map(|point| point.up() - pad_up_m);
        let (low_m, high_m) = math::range(heights_m);
        Self {
            id: task.id,
            name: task_title(&scenario.name, &task.name, language),
            place: place(task, scenario, language),
            length_m: task.length_m(),
            heights_m: (low_m, high_m),
            stand_off_m: task.stand_off.as_ref().map(|stand_off| (stand_off.recommended_m, stand_off.tolerance_m)),
            threshold_m: task.threshold_m,
            lamp: task.dark,
            clearance_m: site.min_path_clearance(task.segments(), MAX_CLEARANCE_M).map(|(_, near)| near.distance_m),
        }
    }
}

/// Describes where a task is flown, and in which direction.
fn place(task: &Task, scenario: &Scenario, language: Language) -> String {
    if task.is_hold_position() {
        return text!(language, "briefing-hover");
    }
    let bridge = task.bridge.map_or("", |bridge| scenario.bridges[bridge].name.as_str());
    let named = if task.bridge.is_some() { "yes" } else { "no" };
    let place = text!(language, "briefing-place", kind = task.kind.key(), named = named, bridge = bridge);
    match way(task, language) {
        Some(way) => text!(language, "briefing-place-and-way", place = place, way = way),
        None => place,
    }
}

/// Describes the direction of a task's path; `None` for a task without a path.
fn way(task: &Task, language: Language) -> Option<String> {
    if task.closed {
        return Some(text!(language, "briefing-way-loop"));
    }
    let (first, last) = task.path_m.first().zip(task.path_m.last())?;
    let way = *last - *first;
    Some(if way.norm() < MIN_DIRECTED_M {
        text!(language, "briefing-way-back")
    } else if way.horizontal_norm() >= MIN_DIRECTED_M {
        text!(language, "briefing-way", from = compass(*first - *last, language), to = compass(way, language))
    } else if way.up() > 0.0 {
        text!(language, "briefing-way-up")
    } else {
        text!(language, "briefing-way-down")
    })
}

/// Returns the nearest of eight compass directions.
fn compass(way: Vec3<Enu>, language: Language) -> String {
    let turns = math::atan2(way.east(), way.north()) / (2.0 * math::PI);
    match (8.0 * turns).round().rem_euclid(8.0) as usize % 8 {
        0 => text!(language, "briefing-north"),
        1 => text!(language, "briefing-northeast"),
        2 => text!(language, "briefing-east"),
        3 => text!(language, "briefing-southeast"),
        4 => text!(language, "briefing-south"),
        5 => text!(language, "briefing-southwest"),
        6 => text!(language, "briefing-west"),
        _ => text!(language, "briefing-northwest"),
    }
}
