//! The briefing before a flight: the tasks in order, the conditions and hazards, what counts, and the site check. It is
//! computed from the scenario, the aircraft and the site, so it holds for every job; [`text`] renders it for a terminal, and
//! `report::page::briefing` as a page.

mod counting;
mod hazards;
mod tasks;
pub mod text;

pub use tasks::TaskBriefing;

use counting::count;
use serde::Serialize;
use spandrel_model::scenario::{Scenario, Task, WindModel};
use spandrel_model::site::Site;
use spandrel_model::vehicle::Vehicle;
use spandrel_monitor::score::certification::{job_time, requirements};

/// The contents of a briefing.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Briefing {
    /// Name of the job, with its form.
    pub job: String,
    /// Title of the job.
    pub title: String,
    /// The instructor's own words, one paragraph each.
    pub notes: Vec<String>,
    /// The tasks in the order in which they are flown.
    pub tasks: Vec<TaskBriefing>,
    /// Conditions of the job: a name and a value each.
    pub conditions: Vec<(String, String)>,
    /// Hazards, one sentence each.
    pub hazards: Vec<String>,
    /// Scores and certification requirements, one sentence each.
    pub counts: Vec<String>,
    /// Items of the site check, which the trainee acknowledges before takeoff.
    pub site_check: Vec<String>,
}

/// The parts of a briefing that follow from the job and its site alone.
#[derive(Debug, Clone, PartialEq)]
pub struct SiteBriefing {
    /// The tasks in the order in which they are flown.
    pub tasks: Vec<TaskBriefing>,
    /// Hazards, one sentence each.
    pub hazards: Vec<String>,
    /// Items of the site check, which the trainee acknowledges before takeoff.
    pub site_check: Vec<String>,
}

impl SiteBriefing {
    /// Computes the parts. The result does not depend on the seed and the defects of the site.
    #[must_use]
    pub fn new(scenario: &Scenario, site: &Site) -> Self {
        let tasks: Vec<TaskBriefing> = scenario.tasks.iter().map(|task| TaskBriefing::new(task, scenario, site)).collect();
        Self { hazards: hazards::hazards(scenario, site, &tasks), site_check: site_check(scenario), tasks }
    }
}

impl Briefing {
    /// Computes the briefing for a job with an aircraft. The result does not depend on the seed of the site.
    #[must_use]
    pub fn new(scenario: &Scenario, vehicle: &Vehicle, site: &Site) -> Self {
        let SiteBriefing { tasks, hazards, site_check } = SiteBriefing::new(scenario, site);
        Self {
            job: scenario.name_with_form(),
            title: scenario.title.clone(),
            notes: scenario.briefing.clone(),
            tasks,
            conditions: conditions(scenario, vehicle),
            hazards,
            counts: counts(scenario),
            site_check,
        }
    }
}

fn conditions(scenario: &Scenario, vehicle: &Vehicle) -> Vec<(String, String)> {
    let length_m: f64 = scenario.tasks.iter().map(Task::length_m).sum();
    let needed_s = job_time::job_needed_s(scenario);
    let scoring = &scenario.scoring;
    let mut rows = vec![
        ("aircraft", vehicle.name.clone()),
        ("tasks", format!("{}, {length_m:.0} m of path", scenario.tasks.len())),
        ("time", format!("about {:.0} min needed, {:.0} min allowed", needed_s / 60.0, scoring.time_max_s / 60.0)),
        (
            "speed",
            format!(
                "{:.1} m/s for inspection, limit {}",
                scenario.certification.inspection_speed_m_s,
                scoring.speed_limit_unit.format_limit(scoring.speed_limit_m_s)
            ),
        ),
        ("defects", if scenario.defects.count == 0 { "none".to_owned() } else { format!("{} to find", scenario.defects.count) }),
        ("wind", wind_words(scenario)),
        ("sky", format!("{:.0}% clouds", 100.0 * scenario.light.cloud_cover)),
        ("traffic", traffic_words(scenario)),
    ];
    rows.retain(|(_, value)| !value.is_empty());
    rows.into_iter().map(|(name, value)| (name.to_owned(), value)).collect()
}

fn wind_words(scenario: &Scenario) -> String {
    let wind = &scenario.wind;
    match wind.model {
        WindModel::Paper => format!("{:.1} N from {:.0}°", wind.paper_force_n, wind.from_deg),
        WindModel::Physical if wind.speed_m_s < 0.05 => "calm".to_owned(),
        WindModel::Physical => format!("{:.1} m/s from {:.0}°", wind.speed_m_s, wind.from_deg),
    }
}

fn traffic_words(scenario: &Scenario) -> String {
    let traffic = &scenario.traffic;
    let kinds = [(traffic.cars, "car"), (traffic.trucks, "truck"), (traffic.pedestrians, "pedestrian")];
    let present: Vec<String> =
        kinds.into_iter().filter(|(number, _)| *number > 0).map(|(number, what)| count(number, what)).collect();
    present.join(", ")
}

fn counts(scenario: &Scenario) -> Vec<String> {
    let mut lines = vec![
        "Conformity: stay on the path, and below the speed limit while you are on it.".to_owned(),
        "Efficiency: land before the time is over and before the battery is empty.".to_owned(),
        "Safety: touch nothing. A person or a vehicle that is hit ends the session.".to_owned(),
    ];
    if scenario.defects.count > 0 {
        lines.push("Accuracy: photograph every defect once, near the middle of the picture, and nothing else.".to_owned());
    }
    lines.extend(requirements::describe(scenario).into_iter().map(|line| format!("To be certified: {line}.")));
    lines
}

fn site_check(scenario: &Scenario) -> Vec<String> {
    let team = &scenario.ground_team;
    let [east, north, _] = (team.pad_m - team.inspector_m).array();
    let away_m = (east * east + north * north).sqrt();
    vec![
        "Risk: I know the hazards, and I stop if somebody enters the flight area.".to_owned(),
        format!(
            "Battery: full. I land with at least {:.0}%, and fly home at the low-battery warning ({:.0}%).",
            scenario.certification.min_battery_pct, scenario.rules.low_battery_pct
        ),
        format!(
            "Landing place: the pad, {away_m:.0} m from the inspector. Landings within {:.0} m of it count as home.",
            team.home_radius_m
        ),
    ]
}

#[cfg(test)]
mod tests;
