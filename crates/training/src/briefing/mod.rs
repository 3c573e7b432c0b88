//! The briefing before a flight: the tasks in order, the conditions and hazards, what counts, and the site check. It is
//! computed from the scenario, the aircraft and the site, so it holds for every job; [`mod@text`] renders it for a terminal, and
//! `report::page::briefing` as a page.

mod hazards;
mod tasks;
pub mod text;

pub use tasks::TaskBriefing;

use crate::terms::scenario_title;
use serde::Serialize;
use spandrel_model::math;
use spandrel_model::scenario::{BriefingPicture, Scenario, Task, WeatherSpec, WindModel};
use spandrel_model::site::Site;
use spandrel_model::time::SimTime;
use spandrel_model::vehicle::Vehicle;
use spandrel_monitor::score::certification::{job_time, requirements};
use spandrel_text::{Language, text};

/// The contents of a briefing.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Briefing {
    /// Name of the job, with its form.
    pub job: String,
    /// Title of the job.
    pub title: String,
    /// The instructor's own words, one paragraph each.
    pub notes: Vec<String>,
    /// The instructor's pictures, in their order.
    pub pictures: Vec<BriefingPicture>,
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

impl Briefing {
    /// Computes the briefing for a job with an aircraft. The result does not depend on the seed of the site.
    #[must_use]
    pub fn new(scenario: &Scenario, vehicle: &Vehicle, site: &Site, language: Language) -> Self {
        let tasks = scenario.tasks.iter().map(|task| TaskBriefing::new(task, scenario, site, language));
        let tasks: Vec<TaskBriefing> = tasks.collect();
        Self {
            job: scenario.name_with_form(),
            title: scenario_title(&scenario.name, &scenario.title, language),
            notes: scenario.briefing.clone(),
            pictures: scenario.briefing_pictures.clone(),
            conditions: conditions(scenario, vehicle, site, language),
            hazards: hazards::hazards(scenario, site, &tasks, language),
            tasks,
            counts: counts(scenario, language),
            site_check: site_check(scenario, language),
        }
    }
}

/// Returns aircraft, wind and light, a name and a value each.
#[must_use]
pub fn flight_conditions(scenario: &Scenario, vehicle: &Vehicle, site: &Site, language: Language) -> [(String, String); 4] {
    [
        (text!(language, "briefing-aircraft"), vehicle.name.clone()),
        (text!(language, "briefing-wind"), wind_words(scenario, language)),
        (text!(language, "briefing-light"), light_words(scenario, site, language)),
        (text!(language, "briefing-sky"), sky_words(scenario, language)),
    ]
}

fn conditions(scenario: &Scenario, vehicle: &Vehicle, site: &Site, language: Language) -> Vec<(String, String)> {
    let [aircraft, wind, light, sky] = flight_conditions(scenario, vehicle, site, language);
    let mut rows = vec![
        aircraft,
        (text!(language, "briefing-tasks"), tasks_words(scenario, language)),
        (text!(language, "briefing-time"), time_words(scenario, language)),
        (text!(language, "briefing-speed"), speed_words(scenario, language)),
        (text!(language, "briefing-defects"), defects_words(scenario, language)),
        wind,
        light,
        sky,
        (text!(language, "briefing-traffic"), traffic_words(scenario, language)),
    ];
    rows.retain(|(_, value)| !value.is_empty());
    rows
}

fn tasks_words(scenario: &Scenario, language: Language) -> String {
    let length_m: f64 = scenario.tasks.iter().map(Task::length_m).sum();
    let (tasks, length) = (scenario.tasks.len().to_string(), format!("{length_m:.0}"));
    text!(language, "briefing-tasks-and-length", tasks = tasks, length = length)
}

fn time_words(scenario: &Scenario, language: Language) -> String {
    let minutes = |time_s: f64| format!("{:.0}", time_s / 60.0);
    let (needed, allowed) = (minutes(job_time::job_needed_s(scenario)), minutes(scenario.scoring.time_max_s));
    text!(language, "briefing-time-needed", needed = needed, allowed = allowed)
}

fn speed_words(scenario: &Scenario, language: Language) -> String {
    let scoring = &scenario.scoring;
    let speed = format!("{:.1}", scenario.certification.inspection_speed_m_s);
    let limit = scoring.speed_limit_unit.format_limit(scoring.speed_limit_m_s);
    text!(language, "briefing-speed-limit", speed = speed, limit = limit)
}

fn defects_words(scenario: &Scenario, language: Language) -> String {
    match scenario.defects.number() {
        0 => text!(language, "briefing-no-defects"),
        count => text!(language, "briefing-defects-to-find", count = count.to_string()),
    }
}

fn wind_words(scenario: &Scenario, language: Language) -> String {
    let wind = &scenario.wind;
    let strength = match wind.model {
        WindModel::Physical if wind.speed_m_s < 0.05 => return text!(language, "briefing-calm"),
        WindModel::Physical => format!("{:.1} m/s", wind.speed_m_s),
        WindModel::Paper => format!("{:.1} N", wind.paper_force_n),
    };
    text!(language, "briefing-wind-from", wind = strength, bearing = format!("{:.0}", wind.from_deg))
}

/// Returns the solar time at the start of the job, and the height of the sun.
fn light_words(scenario: &Scenario, site: &Site, language: Language) -> String {
    const DAY_S: f64 = 86_400.0;
    let day_share = (scenario.light.start_unix_s as f64 / DAY_S + scenario.origin.longitude_deg / 360.0).rem_euclid(1.0);
    let minutes = (day_share * 1_440.0).floor();
    let time = format!("{:02.0}:{:02.0}", (minutes / 60.0).floor(), minutes % 60.0);
    let height_deg = math::asin(site.light().daylight(SimTime::ZERO).sun.up()).to_degrees();
    if height_deg > 0.0 {
        text!(language, "briefing-sun", time = time, height = format!("{height_deg:.0}"))
    } else {
        text!(language, "briefing-no-sun", time = time)
    }
}

fn sky_words(scenario: &Scenario, language: Language) -> String {
    let weather = &scenario.weather;
    let clouds = text!(language, "briefing-clouds", share = format!("{:.0}", 100.0 * scenario.light.cloud_cover));
    let is_foggy = weather.visibility_m < WeatherSpec::CLEAR_VISIBILITY_M;
    let fog = is_foggy.then(|| text!(language, "briefing-visibility", distance = format!("{:.0}", weather.visibility_m)));
    let rain = (weather.rain_mm_h > 0.0).then(|| text!(language, "briefing-rain", rate = weather.rain_mm_h.to_string()));
    let snow = (weather.snow_mm_h > 0.0).then(|| text!(language, "briefing-snow", rate = weather.snow_mm_h.to_string()));
    [Some(clouds), fog, rain, snow].into_iter().flatten().collect::<Vec<_>>().join(", ")
}

fn traffic_words(scenario: &Scenario, language: Language) -> String {
    let traffic = &scenario.traffic;
    let cars = (traffic.cars > 0).then(|| text!(language, "briefing-cars", count = traffic.cars));
    let trucks = (traffic.trucks > 0).then(|| text!(language, "briefing-trucks", count = traffic.trucks));
    let pedestrians = (traffic.pedestrians > 0).then(|| text!(language, "briefing-pedestrians", count = traffic.pedestrians));
    let drones = scenario.drones.len();
    let drones = (drones > 0).then(|| text!(language, "briefing-drones", count = drones));
    [cars, trucks, pedestrians, drones].into_iter().flatten().collect::<Vec<_>>().join(", ")
}

fn counts(scenario: &Scenario, language: Language) -> Vec<String> {
    let mut lines =
        vec![text!(language, "briefing-conformity"), text!(language, "briefing-efficiency"), text!(language, "briefing-safety")];
    if scenario.defects.number() > 0 {
        lines.push(text!(language, "briefing-accuracy"));
    }
    let requirements = requirements::describe(scenario, language);
    lines.extend(requirements.into_iter().map(|line| text!(language, "briefing-to-be-certified", requirement = line)));
    lines
}

fn site_check(scenario: &Scenario, language: Language) -> Vec<String> {
    let team = &scenario.ground_team;
    let [east, north, _] = (team.pad_m - team.inspector_m).array();
    let away = format!("{:.0}", (east * east + north * north).sqrt());
    let radius = format!("{:.0}", team.home_radius_m);
    let least = format!("{:.0}", scenario.certification.min_battery_pct);
    let low = format!("{:.0}", scenario.rules.low_battery_pct);
    let mut lines = vec![
        text!(language, "briefing-check-risk"),
        text!(language, "briefing-check-battery", least = least, low = low),
        text!(language, "briefing-check-landing", away = away, radius = radius),
    ];
    if team.can_walk() {
        lines.push(text!(language, "briefing-check-places", count = team.places_m.len()));
    }
    lines
}

#[cfg(test)]
mod tests;
