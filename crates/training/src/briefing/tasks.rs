//! What the briefing says about each task.

use serde::Serialize;
use spandrel_model::frames::{Enu, Vec3};
use spandrel_model::math;
use spandrel_model::scenario::{Scenario, Task, TaskKind};
use spandrel_model::site::Site;

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
    pub(super) fn new(task: &Task, scenario: &Scenario, site: &Site) -> Self {
        let pad_up_m = scenario.ground_team.pad_m.up();
        let heights_m = task.path_m.iter().map(|point| point.up() - pad_up_m);
        let (low_m, high_m) = heights_m.fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), up| (low.min(up), high.max(up)));
        let bridge = task.bridge.map_or_else(String::new, |bridge| format!(" of bridge '{}'", scenario.bridges[bridge].name));
        Self {
            id: task.id,
            name: task.name.clone(),
            place: if task.is_hold_position() {
                "hover at one place".to_owned()
            } else {
                format!("{}{bridge}{}", place_words(task.kind), direction_words(task))
            },
            length_m: task.length_m(),
            heights_m: (low_m, high_m),
            stand_off_m: task.stand_off.as_ref().map(|stand_off| (stand_off.recommended_m, stand_off.tolerance_m)),
            threshold_m: task.threshold_m,
            lamp: task.dark,
            clearance_m: site.min_path_clearance(task, MAX_CLEARANCE_M).map(|(_, near)| near.distance_m),
        }
    }
}

fn place_words(kind: TaskKind) -> &'static str {
    match kind {
        TaskKind::SlabSide => "along the edge of the deck",
        TaskKind::ArchBottom => "under the arch",
        TaskKind::Interlayer => "between the arch and the deck",
        TaskKind::PierCircle => "around the pier",
        TaskKind::Free => "along the free path",
    }
}

fn direction_words(task: &Task) -> String {
    if task.closed {
        return ", once around, in either direction".to_owned();
    }
    let (Some(first), Some(last)) = (task.path_m.first(), task.path_m.last()) else { return String::new() };
    let way = *last - *first;
    if way.norm() < MIN_DIRECTED_M {
        return ", ending where it starts".to_owned();
    }
    if way.horizontal_norm() < MIN_DIRECTED_M {
        return format!(", {}", if way.up() > 0.0 { "from bottom to top" } else { "from top to bottom" });
    }
    let (from, to) = (compass(*first - *last), compass(way));
    format!(", from {from} to {to}")
}

/// Returns the nearest of eight compass directions.
fn compass(way: Vec3<Enu>) -> &'static str {
    const NAMES: [&str; 8] = ["north", "northeast", "east", "southeast", "south", "southwest", "west", "northwest"];
    let turns = math::atan2(way.east(), way.north()) / (2.0 * math::PI);
    NAMES[(8.0 * turns).round().rem_euclid(8.0) as usize % 8]
}
