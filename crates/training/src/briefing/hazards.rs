//! Hazards of a job, derived from its scenario and site.

use super::counting::count;
use super::tasks::TaskBriefing;
use spandrel_model::scenario::{AfterCrash, Scenario, WindModel, WindSpec};
use spandrel_model::site::Site;

/// Wind from which the briefing warns, m/s (estimate: the TASBID paper's "gentle" level is 4.9 m/s).
const NOTABLE_WIND_M_S: f64 = 4.0;
/// Constant force of the paper's wind model from which the briefing warns, N (its "gentle" level).
const NOTABLE_FORCE_N: f64 = 3.0;
/// Clearance below which a path counts as confined, m (estimate: about two aircraft widths on each side).
const CONFINED_CLEARANCE_M: f64 = 2.5;

pub(super) fn hazards(scenario: &Scenario, site: &Site, tasks: &[TaskBriefing]) -> Vec<String> {
    let mut lines = Vec::new();
    for task in tasks {
        if let Some(clearance_m) = task.clearance_m.filter(|clearance_m| *clearance_m < CONFINED_CLEARANCE_M) {
            lines.push(format!("Confined space: in task {}, structure comes within {clearance_m:.1} m of the path.", task.id));
        }
    }
    let dark: Vec<String> = tasks.iter().filter(|task| task.lamp).map(|task| task.id.to_string()).collect();
    if !dark.is_empty() {
        let noun = if dark.len() == 1 { "task" } else { "tasks" };
        lines.push(format!("Darkness: the lamp is needed in {noun} {}.", dark.join(", ")));
    }
    lines.extend(wind_hazard(&scenario.wind));
    let traffic = &scenario.traffic;
    let vehicles = traffic.cars + traffic.trucks;
    if vehicles > 0 {
        lines.push(format!("Traffic: {} on the bridges. Stay away from the roadway.", count(vehicles, "vehicle")));
    }
    if traffic.pedestrians > 0 {
        lines.push(format!("People: {} on the walkways. Never fly above them.", count(traffic.pedestrians, "pedestrian")));
    }
    if scenario.rules.gnss_shadow {
        lines.push("GNSS: the structure blocks satellites. Under the deck, the position can drift.".to_owned());
    }
    if is_over_water(scenario, site) {
        lines.push("Water: parts of the paths are above water. An emergency landing there loses the aircraft.".to_owned());
    }
    match scenario.rules.after_crash {
        AfterCrash::End => lines.push("A crash ends the session.".to_owned()),
        AfterCrash::Continue | AfterCrash::Respawn => {}
    }
    lines
}

fn wind_hazard(wind: &WindSpec) -> Option<String> {
    let changes = if wind.events.is_empty() { "" } else { " It changes or gusts during the flight." };
    match wind.model {
        WindModel::Paper if wind.paper_force_n >= NOTABLE_FORCE_N => {
            Some(format!("Wind: a force of {:.1} N.{changes} Expect to be pushed off the path.", wind.paper_force_n))
        }
        WindModel::Physical if wind.speed_m_s >= NOTABLE_WIND_M_S || !wind.events.is_empty() => Some(format!(
            "Wind: {:.1} m/s on average.{changes} Expect turbulence behind piers and under the deck.",
            wind.speed_m_s
        )),
        WindModel::Paper | WindModel::Physical => None,
    }
}

fn is_over_water(scenario: &Scenario, site: &Site) -> bool {
    let mut points = scenario.tasks.iter().flat_map(|task| &task.path_m);
    points.any(|point| site.ground_up_m(point.east(), point.north()) < scenario.terrain.water_level_m)
}
