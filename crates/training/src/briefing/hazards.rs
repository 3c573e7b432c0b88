//! Hazards of a job, derived from its scenario and site.

use super::tasks::TaskBriefing;
use spandrel_model::scenario::{AfterCrash, Scenario, WindModel, WindSpec};
use spandrel_model::site::Site;
use spandrel_text::{Language, text};

/// Wind from which the briefing warns, m/s (estimate: the TASBID paper's "gentle" level is 4.9 m/s).
const NOTABLE_WIND_M_S: f64 = 4.0;
/// Constant force of the paper's wind model from which the briefing warns, N (its "gentle" level).
const NOTABLE_FORCE_N: f64 = 3.0;
/// Clearance below which a path counts as confined, m (estimate: about two aircraft widths on each side).
const CONFINED_CLEARANCE_M: f64 = 2.5;

pub(super) fn hazards(scenario: &Scenario, site: &Site, tasks: &[TaskBriefing], language: Language) -> Vec<String> {
    let mut lines = Vec::new();
    for task in tasks {
        if let Some(clearance_m) = task.clearance_m.filter(|clearance_m| *clearance_m < CONFINED_CLEARANCE_M) {
            let (task, clearance) = (task.id.to_string(), format!("{clearance_m:.1}"));
            lines.push(text!(language, "briefing-confined", task = task, clearance = clearance));
        }
    }
    let dark: Vec<String> = tasks.iter().filter(|task| task.lamp).map(|task| task.id.to_string()).collect();
    if !dark.is_empty() {
        lines.push(text!(language, "briefing-darkness", count = dark.len(), tasks = dark.join(", ")));
    }
    lines.extend(wind_hazard(&scenario.wind, language));
    let traffic = &scenario.traffic;
    let vehicles = traffic.cars + traffic.trucks;
    if vehicles > 0 {
        lines.push(text!(language, "briefing-vehicles", count = vehicles));
    }
    if traffic.pedestrians > 0 {
        lines.push(text!(language, "briefing-people", count = traffic.pedestrians));
    }
    if !scenario.drones.is_empty() {
        lines.push(text!(language, "briefing-other-drones", count = scenario.drones.len()));
    }
    if !scenario.ropes.is_empty() {
        lines.push(text!(language, "briefing-ropes", count = scenario.ropes.len()));
    }
    if scenario.hazards.sky {
        lines.push(text!(language, "briefing-real-sky"));
    } else if scenario.rules.gnss_shadow {
        lines.push(text!(language, "briefing-satellites"));
    }
    if scenario.has_wakes() {
        lines.push(text!(language, "briefing-wakes"));
    }
    if scenario.hazards.compass {
        lines.push(text!(language, "briefing-compass"));
    }
    if scenario.hazards.radio {
        lines.push(text!(language, "briefing-radio"));
    }
    if scenario.rules.has_cold_battery() {
        let temperature = format!("{:.0}", scenario.rules.battery_temperature_c);
        lines.push(text!(language, "briefing-cold-battery", temperature = temperature));
    }
    if scenario.hazards.water {
        lines.push(text!(language, "briefing-flow-over-water"));
    }
    if is_over_water(scenario, site) {
        lines.push(text!(language, "briefing-water"));
    }
    match scenario.rules.after_crash {
        AfterCrash::End => lines.push(text!(language, "briefing-crash-ends")),
        AfterCrash::Continue | AfterCrash::Respawn => {}
    }
    lines
}

fn wind_hazard(wind: &WindSpec, language: Language) -> Option<String> {
    let changes = if wind.events.is_empty() { "no" } else { "yes" };
    match wind.model {
        WindModel::Paper if wind.paper_force_n >= NOTABLE_FORCE_N => {
            let force = format!("{:.1}", wind.paper_force_n);
            Some(text!(language, "briefing-wind-force", force = force, changes = changes))
        }
        WindModel::Physical if wind.speed_m_s >= NOTABLE_WIND_M_S || !wind.events.is_empty() => {
            let speed = format!("{:.1}", wind.speed_m_s);
            Some(text!(language, "briefing-wind-speed", speed = speed, changes = changes))
        }
        WindModel::Paper | WindModel::Physical => None,
    }
}

fn is_over_water(scenario: &Scenario, site: &Site) -> bool {
    let mut points = scenario.tasks.iter().flat_map(|task| &task.path_m);
    points.any(|point| site.ground_up_m(point.east(), point.north()) < scenario.terrain.water_level_m)
}
