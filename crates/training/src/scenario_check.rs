//! Checks a scenario beyond its syntax: whether the aircraft fits along the paths, whether the paths of other drones are free,
//! whether the inspector can stand and walk at the places, whether the defects can be placed, and what its forms, levels and
//! certification require. `spandrel check` and the scenario editor show the results.

use crate::path_overlap;
use crate::plan::level_settings;
use crate::terms::element_title;
use spandrel_model::elements::{Element, ElementUnit};
use spandrel_model::frames::{Enu, Vec3};
use spandrel_model::scenario::bridges::ElementQuantity;
use spandrel_model::scenario::drones::POINTS_KEY;
use spandrel_model::scenario::{self, BatteryModel, Bridge, PlacedDefect, Scenario, SiblingLoader, Task, places};
use spandrel_model::site::drone_path;
use spandrel_model::site::drones::SiteDrone;
use spandrel_model::site::geometry::PAD;
use spandrel_model::site::hand_placed::Misplacement;
use spandrel_model::site::ropes::SiteRope;
use spandrel_model::site::walkable::MAX_HEIGHT_ERROR_M;
use spandrel_model::site::{Site, defects};
use spandrel_model::toml::Problem;
use spandrel_model::vehicle::Vehicle;
use spandrel_monitor::measures::image_quality;
use spandrel_monitor::score::certification::{job_time, pictures, requirements};
use spandrel_text::{Language, text};

/// Minimum clearance between the path and obstacles, in addition to half the aircraft's tip-to-tip width, m (issue 2,
/// section 2).
const MIN_CLEARANCE_M: f64 = 0.5;

/// Seeds to try for a scenario without its own seed. One seed is enough to find a task that is too far from the
/// bridges; three also show whether the defects fit (estimate).
const TRIAL_SEEDS: [u64; 3] = [1, 2, 3];

/// Findings of the checks.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct Findings {
    /// Errors that must be corrected.
    pub problems: Vec<Problem>,
    /// Possible errors.
    pub warnings: Vec<String>,
    /// Facts about the scenario.
    pub notes: Vec<String>,
}

/// Text of a scenario.
#[derive(Clone, Copy)]
pub struct ScenarioText<'a> {
    /// File name for messages.
    pub file: &'a str,
    /// Contents (TOML).
    pub text: &'a str,
    /// Loads the files that the scenario refers to.
    pub siblings: SiblingLoader<'a>,
}

/// The aircraft that has to fit, the limit of the work, and the language of the results.
#[derive(Clone, Copy)]
pub struct CheckOptions<'a> {
    /// Aircraft for the clearance check.
    pub aircraft: &'a Vehicle,
    /// Asked before each step that may take long. If it returns false, the remaining steps are skipped.
    pub may_continue: &'a dyn Fn() -> bool,
    /// Language of warnings and notes. Problems are in English, in sentences that the web pages can translate.
    pub language: Language,
}

impl ScenarioText<'_> {
    fn read(&self, text: &str) -> Option<Scenario> {
        scenario::read(self.file, text, self.siblings).ok()
    }
}

/// Checks a valid scenario: clearance along its paths, placement of its defects, the quantities of its bridges' elements, and the
/// requirements for certification.
pub fn check_scenario(source: &ScenarioText<'_>, scenario: &Scenario, options: &CheckOptions<'_>, findings: &mut Findings) {
    if let Some(site) = built_site(scenario, options) {
        findings.problems.extend(site_problems(source, scenario, &site, options));
        findings.warnings.extend(placed_defect_warnings(source, scenario, &site, options));
    }
    findings.warnings.extend(missing_defects_warning(source, scenario, options));
    findings.warnings.extend(repeated_paths(source, scenario, options.language));
    findings.warnings.extend(path_overlap::warnings(source.file, scenario, options.language));
    findings.warnings.extend(unused_temperature(source, scenario, options.language));
    findings.notes.extend(quantity_notes(source, scenario, options.language));
    findings.notes.extend(certification_notes(source, scenario, options));
}

/// Describes the difficulty of a scenario's forms: the requested one, or all. Files with problems have already been reported.
pub fn check_forms(source: &ScenarioText<'_>, requested: Option<&str>, options: &CheckOptions<'_>, findings: &mut Findings) {
    for form in scenario::form_names(source.text).iter().filter(|form| requested.is_none_or(|one| one == *form)) {
        if !(options.may_continue)() {
            return;
        }
        let Some(job) = source.read(&scenario::select_form(source.text, form)) else { return };
        let site = Site::build(&job, 0);
        let (defects, detection) = (site.defects(), site.predicted_detection(&job.tasks, &defects::REFERENCE_CAMERA));
        if job.defects.placed.is_none() && defects.len() < job.defects.count {
            let (placed, count) = (defects.len(), job.defects.count);
            let words = text!(options.language, "check-form-incomplete", form = form.as_str(), placed = placed, count = count);
            findings.warnings.push(format!("{}: {words}", source.file));
        }
        let gradable = defects.iter().filter(|defect| pictures::is_gradable(defect, &job, &options.aircraft.camera).0).count();
        let percent = |share: f64| format!("{:.1}%", 100.0 * share);
        let (low, high) = detection.iter().fold((1.0_f64, 0.0_f64), |(low, high), one| (low.min(*one), high.max(*one)));
        let words = text!(
            options.language,
            "check-form",
            form = form.as_str(),
            mean = percent(detection.iter().sum::<f64>() / detection.len().max(1) as f64),
            low = percent(low),
            high = percent(high),
            gradable = gradable,
            defects = defects.len()
        );
        findings.notes.push(format!("{}: {words}", source.file));
    }
}

/// Describes a scenario's difficulty levels: the requested one, or all. Checks the paths and the defects at the easiest and at the
/// hardest level, too, unless a level is requested. Files with problems have already been reported.
pub fn check_levels(source: &ScenarioText<'_>, requested: Option<u8>, options: &CheckOptions<'_>, findings: &mut Findings) {
    if !(options.may_continue)() {
        return;
    }
    let Some(difficulty) = source.read(source.text).and_then(|job| job.difficulty) else { return };
    let levels = difficulty.levels();
    for level in (1..=levels).filter(|level| requested.is_none_or(|one| one == *level)) {
        let settings = level_settings(difficulty.settings_at(level), options.language);
        let words = if level == difficulty.standard {
            text!(options.language, "check-standard-level", level = level, levels = levels, settings = settings)
        } else {
            text!(options.language, "check-level", level = level, levels = levels, settings = settings)
        };
        findings.notes.push(format!("{}: {words}", source.file));
    }
    for level in [1, levels].into_iter().filter(|level| requested.is_none() && *level != difficulty.level) {
        let Some(job) = source.read(&scenario::select_level(source.text, level)) else { continue };
        let at_level = |problem: Problem| Problem { message: format!("at level {level}: {}", problem.message), ..problem };
        let site = built_site(&job, options);
        let problems = site.map_or_else(Vec::new, |site| clearance_problems(source, &job, &site, options));
        findings.problems.extend(problems.into_iter().map(at_level));
        let warning = missing_defects_warning(source, &job, options);
        findings.warnings.extend(warning.map(|words| text!(options.language, "check-at-level", level = level, warning = words)));
    }
}

/// Lists the total quantity of each element of each bridge, as an inspection report does.
fn quantity_notes(source: &ScenarioText<'_>, scenario: &Scenario, language: Language) -> Vec<String> {
    let of_bridge = |bridge: &Bridge| {
        let line = |quantity: &ElementQuantity| {
            let (number, name) = (quantity.element.number(), element_title(quantity.element, language));
            let (bridge, amount) = (bridge.name.as_str(), amount_words(quantity, language));
            let words = text!(language, "check-quantity", bridge = bridge, number = number, name = name, amount = amount);
            format!("{}: {words}", source.file)
        };
        bridge.quantities().iter().map(line).collect::<Vec<_>>()
    };
    scenario.bridges.iter().flat_map(of_bridge).collect()
}

/// Returns a quantity with its unit, in inspection reports and in SI.
fn amount_words(quantity: &ElementQuantity, language: Language) -> String {
    let (reported, si) = (format!("{:.0}", quantity.reported()), format!("{:.1}", quantity.amount));
    match quantity.element.unit() {
        Some(ElementUnit::SquareFeet) => text!(language, "check-amount-area", reported = reported, si = si),
        Some(ElementUnit::Feet) => text!(language, "check-amount-length", reported = reported, si = si),
        Some(ElementUnit::Each) | None => text!(language, "check-amount-each", reported = reported),
    }
}

/// Explains what a flight must reach to be certified in this job, and which defects the aircraft's camera can't resolve.
fn certification_notes(source: &ScenarioText<'_>, scenario: &Scenario, options: &CheckOptions<'_>) -> Vec<String> {
    let CheckOptions { aircraft, language, .. } = *options;
    let mut notes = requirements::describe(scenario, language);
    let path_m: f64 = scenario.tasks.iter().map(Task::length_m).sum();
    let needed_min = job_time::job_needed_s(scenario) / 60.0;
    let (minutes, path) = (format!("{needed_min:.1}"), format!("{path_m:.0}"));
    if scenario.defects.number() == 0 {
        notes.push(text!(language, "check-time", minutes = minutes, path = path));
    } else {
        let defects = scenario.defects.number();
        notes.push(text!(language, "check-time-with-defects", minutes = minutes, path = path, defects = defects));
        let finest_mm = image_quality::best_gsd_mm(&aircraft.camera, pictures::shortest_stand_off_m(scenario));
        let crack_mm = finest_mm / scenario.certification.gsd_per_line_width;
        let (aircraft, finest, crack) = (aircraft.name.as_str(), format!("{finest_mm:.2}"), format!("{crack_mm:.1}"));
        notes.push(text!(language, "check-camera", aircraft = aircraft, finest = finest, crack = crack));
    }
    let words = |note: String| text!(language, "check-to-be-certified", requirement = note);
    notes.into_iter().map(|note| format!("{}: {}", source.file, words(note))).collect()
}

/// Returns the site of a scenario; `None` after the time limit.
fn built_site(scenario: &Scenario, options: &CheckOptions<'_>) -> Option<Site> {
    (options.may_continue)().then(|| Site::without_defects(scenario))
}

/// Returns the problems that only the built site shows: of the tasks' paths, of the inspector's places and of the defects that the file
/// places.
fn site_problems(source: &ScenarioText<'_>, scenario: &Scenario, site: &Site, options: &CheckOptions<'_>) -> Vec<Problem> {
    let mut problems = clearance_problems(source, scenario, site, options);
    if (options.may_continue)() {
        problems.extend(drone_problems(source, site, options));
        problems.extend(rope_problems(source, scenario, site, options));
        problems.extend(place_problems(source, scenario, site));
        problems.extend(placed_defect_problems(source, scenario, site));
    }
    problems
}

/// Heading of the table of a defect that the file places.
const PLACED_TABLES: [&str; 1] = ["[[defects.placed]]"];

/// Returns the problems of the defects that the file places: they must be on a surface of their member, and possible there.
fn placed_defect_problems(source: &ScenarioText<'_>, scenario: &Scenario, site: &Site) -> Vec<Problem> {
    let lines = table_line_numbers(source.text, &PLACED_TABLES);
    let one = |(k, defect): (usize, &PlacedDefect)| {
        let (key, value, allowed, message) = misplacement_words(defect, site.misplacement(defect)?);
        Some(Problem {
            file: source.file.to_owned(),
            line: lines.get(k).copied().unwrap_or(1),
            key: format!("defects.placed.{k}.{key}"),
            location: format!("defects.placed[{k}].{key}"),
            value,
            allowed,
            message: message.to_owned(),
        })
    };
    scenario.defects.placed.iter().flatten().enumerate().filter_map(one).collect()
}

/// Returns key, value, allowed values and message for a defect in a wrong place.
fn misplacement_words(defect: &PlacedDefect, wrong: Misplacement) -> (&'static str, String, String, &'static str) {
    let number = |element: Element| element.number().to_string();
    match wrong {
        Misplacement::UnknownMember => ("member", defect.member.clone(), "a member of a bridge".to_owned(), "unknown member"),
        Misplacement::OtherElement(element) => {
            ("element", number(defect.element), number(element), "not the element of the member")
        }
        Misplacement::NotPermitted(element) => {
            let kinds: Vec<String> = element.permitted_defects().iter().map(ToString::to_string).collect();
            ("kind", defect.kind.to_string(), kinds.join(", "), "does not occur on this element")
        }
        Misplacement::OffSurface(distance_m) => {
            ("position_m", format!("{distance_m:.2} m"), "on the surface of the member".to_owned(), "not on a surface")
        }
        Misplacement::NoBridge | Misplacement::TooLarge | Misplacement::Covered => {
            ("position_m", String::new(), "on a free surface of a bridge".to_owned(), "no room for the defect")
        }
    }
}

/// Keys of the difficulty table that have no effect on placed defects.
const DEFECT_LEVEL_KEYS: [&str; 2] = ["detection_pct", "size_factor"];

/// Returns a warning for each defect that the file places where no task's path allows a picture of it, and others if the file also has
/// forms or difficulty levels of the defects, which have no effect on placed ones.
fn placed_defect_warnings(
    source: &ScenarioText<'_>,
    scenario: &Scenario,
    site: &Site,
    options: &CheckOptions<'_>,
) -> Vec<String> {
    let Some(placed) = scenario.defects.placed.as_deref().filter(|placed| !placed.is_empty() && (options.may_continue)()) else {
        return Vec::new();
    };
    let lines = table_line_numbers(source.text, &PLACED_TABLES);
    let seen = |defect: &PlacedDefect| site.misplacement(defect).is_some() || site.can_be_photographed(scenario, defect);
    let hidden = placed.iter().enumerate().take_while(|_| (options.may_continue)()).filter(|(_, defect)| !seen(defect));
    let hidden = hidden.map(|(k, defect)| {
        let line = lines.get(k).copied().unwrap_or(1);
        format!("{}:{line}: {}", source.file, text!(options.language, "check-hidden-defect", defect = defect.id))
    });
    let forms = scenario.form.is_some().then(|| format!("{}: {}", source.file, text!(options.language, "check-placed-in-forms")));
    let level_key = DEFECT_LEVEL_KEYS.into_iter().find_map(|key| Some((key, difficulty_line(source.text, key)?)));
    let levels = level_key.map(|(key, line)| {
        format!(
            "{}:{line}: {}",
            source.file,
            text!(options.language, "check-placed-at-levels", key = format!("difficulty.{key}"))
        )
    });
    hidden.chain(forms).chain(levels).collect()
}

fn clearance_problems(source: &ScenarioText<'_>, scenario: &Scenario, site: &Site, options: &CheckOptions<'_>) -> Vec<Problem> {
    let lines = table_line_numbers(source.text, &TASK_TABLES);
    let tight = |(k, task): (usize, &Task)| {
        let (at_m, near) = site.min_path_clearance(task.segments(), needed_clearance_m(options.aircraft))?;
        let [east, north, up] = at_m.array();
        let object = site.object_name(near.object);
        Some(Problem {
            file: source.file.to_owned(),
            line: lines.get(k).copied().unwrap_or(1),
            key: format!("tasks.{k}"),
            location: format!("tasks[{k}]"),
            value: format!("{:.2} m", near.distance_m),
            allowed: needed_clearance_words(options.aircraft),
            message: format!(
                "the path of task {} '{}' passes too close to {object} at east {east:.1} m, north {north:.1} m, up {up:.1} m",
                task.id, task.name
            ),
        })
    };
    scenario.tasks.iter().enumerate().take_while(|_| (options.may_continue)()).filter_map(tight).collect()
}

/// Returns the clearance that a path of an aircraft needs, m.
fn needed_clearance_m(aircraft: &Vehicle) -> f64 {
    0.5 * aircraft.hull.tip_to_tip_m + MIN_CLEARANCE_M
}

fn needed_clearance_words(aircraft: &Vehicle) -> String {
    let (id, width_m, needed_m) = (&aircraft.id, aircraft.hull.tip_to_tip_m, needed_clearance_m(aircraft));
    format!("at least {needed_m:.2} m for {id}: half its {width_m:.2} m tip-to-tip width plus {MIN_CLEARANCE_M} m")
}

/// Heading of the table of a drone that flies along a path.
const DRONE_TABLES: [&str; 1] = ["[[drones]]"];

/// Returns the problems of the drones' paths: they must be clear of bridges, ground, water and the landing pad, and of the ways of
/// traffic and crew.
fn drone_problems(source: &ScenarioText<'_>, site: &Site, options: &CheckOptions<'_>) -> Vec<Problem> {
    let lines = table_line_numbers(source.text, &DRONE_TABLES);
    let tight = |(k, drone): (usize, &SiteDrone)| {
        let (at_m, distance_m, object) = drone_obstacle(site, drone, options)?;
        let ([east, north, up], name) = (at_m.array(), drone.name());
        Some(Problem {
            file: source.file.to_owned(),
            line: lines.get(k).copied().unwrap_or(1),
            key: format!("drones.{k}.{POINTS_KEY}"),
            location: format!("drones[{k}].{POINTS_KEY}"),
            value: format!("{distance_m:.2} m"),
            allowed: needed_clearance_words(drone.vehicle()),
            message: format!(
                "the path of drone {name} passes too close to {object} at east {east:.1} m, north {north:.1} m, up {up:.1} m"
            ),
        })
    };
    site.drones().iter().enumerate().filter_map(tight).collect()
}

/// Heading of the table of a rope.
const ROPE_TABLES: [&str; 1] = ["[[ropes]]"];
/// Distance between the points of a task's path at which ropes are searched, m.
const ROPE_SEARCH_STEP_M: f64 = 0.25;

/// Returns the problems of the ropes: the tasks' paths must be clear of them, wherever the wind blows them.
fn rope_problems(source: &ScenarioText<'_>, scenario: &Scenario, site: &Site, options: &CheckOptions<'_>) -> Vec<Problem> {
    let lines = table_line_numbers(source.text, &ROPE_TABLES);
    let needed_m = needed_clearance_m(options.aircraft);
    let mut problems: Vec<Problem> = Vec::new();
    for task in scenario.tasks.iter().take_while(|_| (options.may_continue)()) {
        let near = |at_m: Vec3<Enu>| {
            let close = site.ropes().distances_over_time_m(at_m).filter(|(_, distance_m)| *distance_m < needed_m);
            close.map(|(rope, distance_m)| (rope, distance_m, at_m)).collect::<Vec<_>>()
        };
        let points = drone_path::sampled(task.segments(), ROPE_SEARCH_STEP_M);
        let Some((k, distance_m, at_m)) = points.flat_map(near).min_by(|a, b| a.1.total_cmp(&b.1)) else { continue };
        let [east, north, up] = at_m.array();
        let name = site.ropes().all().get(k).map_or("", SiteRope::name);
        problems.push(Problem {
            file: source.file.to_owned(),
            line: lines.get(k).copied().unwrap_or(1),
            key: format!("ropes.{k}.points_m"),
            location: format!("ropes[{k}].points_m"),
            value: format!("{distance_m:.2} m"),
            allowed: needed_clearance_words(options.aircraft),
            message: format!(
                "the path of task {} '{}' passes too close to rope {name} at east {east:.1} m, north {north:.1} m, up {up:.1} m",
                task.id, task.name
            ),
        });
    }
    problems
}

/// Distance between the points of a drone's path at which traffic and crew are searched, m.
const TRAFFIC_SEARCH_STEP_M: f64 = 0.25;
/// Name of traffic and crew in messages about a drone's path.
const OTHERS: &str = "vehicles or people";

/// Returns a point of a drone's path that is too close to something, the distance in meters, and what it is.
fn drone_obstacle(site: &Site, drone: &SiteDrone, options: &CheckOptions<'_>) -> Option<(Vec3<Enu>, f64, String)> {
    let needed_m = needed_clearance_m(drone.vehicle());
    if let Some((at_m, near)) = site.min_path_clearance(drone.path().segments(), needed_m) {
        return Some((at_m, near.distance_m, site.object_name(near.object)));
    }
    drone.path().sampled(TRAFFIC_SEARCH_STEP_M).take_while(|_| (options.may_continue)()).find_map(|at_m| {
        let pad_m = site.geometry().pad_distance_m(at_m);
        if pad_m < needed_m {
            return Some((at_m, pad_m, site.object_name(PAD)));
        }
        let others_m = site.traffic().min_distance_of_others_m(at_m, needed_m)?;
        Some((at_m, others_m, OTHERS.to_owned()))
    })
}

/// Key of the inspector's first place.
const FIRST_PLACE_KEY: &str = "inspector_m";

/// Returns the problems of the places to which the inspector can walk, and of the ways between them in the order of their numbers.
fn place_problems(source: &ScenarioText<'_>, scenario: &Scenario, site: &Site) -> Vec<Problem> {
    let team = &scenario.ground_team;
    if !team.can_walk() {
        return Vec::new();
    }
    let places: Vec<Vec3<Enu>> = team.inspector_places_m().collect();
    let problem = |key: &str, value: String, allowed: String, message: String| Problem {
        file: source.file.to_owned(),
        line: key_line_number(source.text, key).unwrap_or(1),
        key: format!("ground_team.{key}"),
        location: format!("ground_team.{key}"),
        value,
        allowed,
        message,
    };
    let standing = (1..).zip(&places).filter_map(|(number, place)| {
        let (allowed, message) = place_problem(site, *place)?;
        let key = if number == 1 { FIRST_PLACE_KEY } else { places::KEY };
        Some(problem(key, places::shown(*place), allowed, format!("place {number} {message}")))
    });
    let found: Vec<Problem> = standing.collect();
    if !found.is_empty() {
        return found;
    }
    // The window sends the inspector from each place to the next one, and from the last one to the first one.
    let ways = (1..).zip(&places).zip((2..=places.len()).zip(&places[1..]).chain([(1, &places[0])]));
    let blocked = ways.filter_map(|((from, from_m), (to, to_m))| {
        let (obstacle, [east, north, _]) = site.way_obstacle(*from_m, *to_m).map(|(obstacle, at)| (obstacle, at.array()))?;
        let message = format!("{} is on the way at east {east:.1} m, north {north:.1} m", obstacle.name());
        let allowed = "a straight path over land, clear of obstacles".to_owned();
        Some(problem(places::KEY, format!("place {from} to place {to}"), allowed, message))
    });
    blocked.collect()
}

/// Returns what is allowed, and what is wrong with a place.
fn place_problem(site: &Site, place_m: Vec3<Enu>) -> Option<(String, String)> {
    if let Some(obstacle) = site.place_obstacle(place_m) {
        let allowed = "on land, clear of water, bridges, the landing pad and the truck".to_owned();
        return Some((allowed, format!("is in or too close to {}", obstacle.name())));
    }
    let ground_m = site.ground_up_m(place_m.east(), place_m.north());
    let over_m = place_m.up() - ground_m;
    (over_m.abs() > MAX_HEIGHT_ERROR_M).then(|| {
        let allowed = format!("up {ground_m:.2} ± {MAX_HEIGHT_ERROR_M} m at this point");
        (allowed, format!("is {:.1} m {} the ground", over_m.abs(), if over_m > 0.0 { "above" } else { "below" }))
    })
}

/// Returns the number of the first line that sets a key, alone or after the names of its tables; `None` if there is none.
fn key_line_number(text: &str, key: &str) -> Option<usize> {
    text.lines().position(|line| sets(line, key)).map(|k| k + 1)
}

/// Returns whether a line sets a key.
fn sets(line: &str, key: &str) -> bool {
    line.split_once('=').is_some_and(|(name, _)| name.trim().rsplit('.').next() == Some(key))
}

/// Returns the line that sets a key in the difficulty table.
fn difficulty_line(text: &str, key: &str) -> Option<usize> {
    let head = *table_line_numbers(text, &["[difficulty]"]).first()?;
    let mut table = text.lines().skip(head).take_while(|line| !line.trim_start().starts_with('['));
    table.position(|line| sets(line, key)).map(|k| head + k + 1)
}

/// Returns a warning for each task whose path an earlier task has, too, such as a copied task that was not changed.
fn repeated_paths(source: &ScenarioText<'_>, scenario: &Scenario, language: Language) -> Vec<String> {
    let tasks = &scenario.tasks;
    let earlier = |k: usize| tasks[..k].iter().find(|task| task.path_m == tasks[k].path_m);
    let words = |task: &Task, earlier: &Task| {
        format!("{}: {}", source.file, text!(language, "check-same-path", task = task.id, other = earlier.id))
    };
    tasks.iter().enumerate().filter_map(|(k, task)| Some(words(task, earlier(k)?))).collect()
}

/// Returns a warning if the battery's temperature is set, but has no effect.
fn unused_temperature(source: &ScenarioText<'_>, scenario: &Scenario, language: Language) -> Option<String> {
    const KEY: &str = "battery_temperature_c";
    let line = key_line_number(source.text, KEY)?;
    (scenario.rules.battery == BatteryModel::Paper)
        .then(|| format!("{}:{line}: {}", source.file, text!(language, "check-unused-temperature")))
}

/// Returns a warning if some requested defects cannot be placed. Tries the scenario's own seed, or the first few seeds.
fn missing_defects_warning(source: &ScenarioText<'_>, scenario: &Scenario, options: &CheckOptions<'_>) -> Option<String> {
    let wanted = scenario.defects.count;
    if wanted == 0 || scenario.defects.placed.is_some() {
        return None;
    }
    let seeds = scenario.seed.map_or_else(|| TRIAL_SEEDS.to_vec(), |seed| vec![seed]);
    let placed =
        seeds.iter().take_while(|_| (options.may_continue)()).map(|seed| (Site::build(scenario, *seed).defects().len(), *seed));
    let (least, seed) = placed.min()?;
    let line = source.text.lines().position(|line| line.trim_start().starts_with("[defects]")).map_or(1, |k| k + 1);
    (least < wanted).then(|| {
        let seed = seed.to_string();
        let words = text!(options.language, "check-missing-defects", wanted = wanted, placed = least, seed = seed);
        format!("{}:{line}: {words}", source.file)
    })
}

/// Headings of the table of a task.
const TASK_TABLES: [&str; 2] = ["[[task]]", "[[tasks]]"];

/// Returns the line number of each table with one of these headings.
fn table_line_numbers(text: &str, headings: &[&str]) -> Vec<usize> {
    let heads = text.lines().enumerate().filter(|(_, line)| {
        let line: String = line.chars().filter(|c| !c.is_whitespace()).collect();
        headings.iter().any(|heading| line.starts_with(heading))
    });
    heads.map(|(k, _)| k + 1).collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use spandrel_model::{shipped, vehicle};

    const ALWAYS: &dyn Fn() -> bool = &|| true;

    /// The practice job with a drone that flies between two points.
    fn with_drone(from: [f64; 3], to: [f64; 3]) -> String {
        let practice = shipped_text("practice");
        format!("{practice}\n[[drones]]\nname = \"survey\"\nvehicle = \"m30\"\npoints_m = [{from:?}, {to:?}]\n")
    }

    #[test]
    fn exact_paths_of_other_drones_must_be_clear() {
        // The example of the documentation is free.
        let example = shipped::SCENARIO_README.split("```toml\n").find(|block| block.starts_with("[[drones]]")).unwrap();
        let documented = format!("{}\n{}", shipped_text("practice"), example.split("```").next().unwrap());
        assert_eq!(scenario_findings("practice", &documented, &aircraft()).problems, []);
        let job = |from, to| scenario_findings("practice", &with_drone(from, to), &aircraft()).problems;
        assert_eq!(job([-30.0, 60.0, 60.0], [30.0, 60.0, 60.0]), []);
        let pad_m = scenario::read("practice", &shipped_text("practice"), &|_| Err(String::new())).unwrap().ground_team.pad_m;
        let pad = pad_m.array();
        let over = |up: f64| [pad[0], pad[1], pad[2] + up];
        for (from, to, object) in [
            ([0.0, -40.0, 34.0], [0.0, 40.0, 34.0], "arch/"),
            ([-100.0, 40.0, 36.0], [-100.0, 40.0, -9.0], "ground"),
            (over(30.0), over(0.7), "pad"),
        ] {
            let problems = job(from, to);
            assert_eq!(problems.len(), 1, "{problems:?}");
            let Problem { key, location, line, message, allowed, .. } = &problems[0];
            assert_eq!((key.as_str(), location.as_str()), ("drones.0.points_m", "drones[0].points_m"));
            assert_eq!([*line], table_line_numbers(&with_drone(from, to), &DRONE_TABLES)[..]);
            assert!(
                message.starts_with("the path of drone survey passes too close to ") && message.contains(object),
                "{message}"
            );
            assert!(allowed.starts_with("at least 1.") && allowed.contains(" for m30: half its "), "{allowed}");
        }
        // Two meters above the lane, the deck is far enough, but a car is 1.5 m high.
        let low = job([0.0, 1.8, 36.0], [1.0, 1.8, 36.0]);
        assert!(low.len() == 1 && low[0].message.contains("vehicles or people"), "{low:?}");
    }

    #[test]
    fn exact_paths_of_tasks_must_be_clear_of_ropes() {
        let practice = shipped_text("practice");
        let example = shipped::SCENARIO_README.split("```toml\n").find(|block| block.starts_with("[[ropes]]")).unwrap();
        let example = example.split("```").next().unwrap();
        assert_eq!(scenario_findings("practice", &format!("{practice}\n{example}"), &aircraft()).problems, []);
        let task = scenario::read("practice.toml", &practice, &|_| Err("none".into())).unwrap().tasks[0].clone();
        let [east, north, up] = task.path_m[0].lerp(task.path_m[1], 0.5).array();
        let job =
            |up: f64| format!("{practice}\n[[ropes]]\nname = \"line\"\npoints_m = [[{east}, {north}, {up}]]\nlength_m = 2\n");
        assert_eq!(scenario_findings("practice", &job(up + 10.0), &aircraft()).problems, []);
        let low = scenario_findings("practice", &job(up + 1.0), &aircraft()).problems;
        assert_eq!(low.len(), 1, "{low:?}");
        assert_eq!((low[0].key.as_str(), low[0].location.as_str()), ("ropes.0.points_m", "ropes[0].points_m"));
        assert_eq!([low[0].line], table_line_numbers(&job(up + 1.0), &ROPE_TABLES)[..]);
        assert!(low[0].message.contains("passes too close to rope line at "), "{low:?}");
    }

    fn aircraft() -> Vehicle {
        vehicle::read("phantom2.toml", shipped::PHANTOM2).unwrap()
    }

    fn shipped_text(name: &str) -> String {
        shipped::SCENARIOS.iter().find(|(stem, _)| *stem == name).unwrap().1.to_owned()
    }

    /// Runs `check` with the text of a file, the aircraft and empty findings, and returns the findings.
    fn found(
        name: &str,
        text: &str,
        aircraft: &Vehicle,
        check: impl Fn(&ScenarioText, &CheckOptions, &mut Findings),
    ) -> Findings {
        let file = format!("{name}.toml");
        let source = ScenarioText { file: &file, text, siblings: &|_| Err("none".into()) };
        let mut findings = Findings::default();
        check(&source, &CheckOptions { aircraft, may_continue: ALWAYS, language: Language::English }, &mut findings);
        findings
    }

    fn scenario_findings(name: &str, text: &str, aircraft: &Vehicle) -> Findings {
        found(name, text, aircraft, |source, options, findings| {
            check_scenario(source, &source.read(text).unwrap(), options, findings);
        })
    }

    fn level_findings(name: &str, level: Option<u8>, aircraft: &Vehicle) -> Findings {
        found(name, &shipped_text(name), aircraft, |source, options, findings| check_levels(source, level, options, findings))
    }

    #[test]
    fn exact_task_lines_are_found() {
        assert_eq!(table_line_numbers("a = 1\n[[tasks]]\nx = 2\n [[ tasks ]]\n[wind]\n", &TASK_TABLES), [2, 4]);
    }

    #[test]
    fn exact_every_shipped_path_fits_the_default_aircraft() {
        let aircraft = aircraft();
        for (name, text) in shipped::SCENARIOS {
            assert_eq!(scenario_findings(name, text, &aircraft).problems, [], "{name}");
        }
    }

    #[test]
    fn regress_a_job_without_defects_requires_no_accuracy_and_no_pictures() {
        let notes = |name: &str| scenario_findings(name, &shipped_text(name), &aircraft()).notes.join("\n");
        let about_defects = ["accuracy", "mm/px", "crack", "defect"];
        let (without, with) = (notes("drill-straight-line"), notes("two-bridges"));
        for word in about_defects {
            assert!(!without.contains(word) && with.contains(word), "{word}: {without}");
        }
        assert!(without.contains("conformity at least") && without.contains("min for "), "{without}");
    }

    /// The page states what the command prints for both jobs.
    #[test]
    fn exact_the_page_of_the_forms_agrees_with_the_check() {
        const PAGE: &str = include_str!("../../../docs/src/explanation/forms.md");
        let row = |label: &str| {
            let line = PAGE.lines().find(|line| line.starts_with(&format!("| {label}"))).unwrap();
            line.split('|').map(str::trim).skip(2).take(2).map(str::to_owned).collect::<Vec<_>>()
        };
        let (paths, times) = (row("path, m"), row("time that the job needs"));
        for (k, name) in ["two-bridges", "pilot-study"].into_iter().enumerate() {
            let notes = scenario_findings(name, &shipped_text(name), &aircraft()).notes;
            let time = notes.iter().find(|note| note.contains("time that the job needs: ")).unwrap();
            let expected = format!("{} min for {} m of path and 10 defects", times[k], paths[k]);
            assert!(time.ends_with(&expected), "{time}; the page: {expected}");
        }
        let words = format!("allows {} minutes: {} m at 1 m/s", times[1], paths[1]);
        assert!(PAGE.contains(&words), "{words}");
    }

    #[test]
    fn exact_levels_are_described_and_checked_at_both_ends() {
        let found = level_findings("drill-gap", None, &aircraft());
        assert_eq!((found.problems, found.warnings, found.notes.len()), (vec![], vec![], 9));
        assert_eq!(found.notes[8], "drill-gap.toml: level 9 of 9: wind 5 m/s, gap 2.8 m");
        assert!(found.notes[4].contains("level 5 of 9, the standard level: wind 0.98 m/s, gap 3.4 m"), "{}", found.notes[4]);
        assert_eq!(level_findings("drill-gap", Some(9), &aircraft()).notes, found.notes[8..]);
        let mut wide = aircraft();
        wide.hull.tip_to_tip_m = 2.0;
        let found = level_findings("drill-gap", None, &wide);
        assert!(found.problems[0].message.starts_with("at level 9: the path of task 1 "), "{:?}", found.problems);
        assert!(level_findings("two-bridges", None, &aircraft()).notes.is_empty());
    }

    #[test]
    fn regress_missing_defects_cause_a_warning() {
        let text = shipped_text("drill-straight-line");
        let found = |text: &str| {
            let findings = scenario_findings("drill-straight-line", text, &aircraft());
            assert_eq!(findings.problems, []);
            findings.warnings
        };
        assert_eq!(found(&text), Vec::<String>::new(), "no defects requested");
        let text = text.replace("[defects]\ncount = 0", "[defects]\ncount = 4");
        let line = text.lines().position(|line| line == "[defects]").unwrap() + 1;
        let warnings = found(&text);
        assert_eq!(warnings.len(), 1, "{warnings:?}");
        assert!(warnings[0].contains(&format!(":{line}: defects.count = 4, but only 0 could be placed")), "{warnings:?}");
    }

    #[test]
    fn exact_copied_task_is_a_warning() {
        let text = shipped_text("drill-straight-line");
        let task = &text[text.find("[[tasks]]").unwrap()..];
        let end = task[1..].find("\n[").map_or(task.len(), |end| end + 2);
        let twice = text.replace(&task[..end], &task[..end].repeat(2));
        let warnings = scenario_findings("drill-straight-line", &twice, &aircraft()).warnings;
        assert_eq!(warnings, ["drill-straight-line.toml: task 2 has the same path as task 1"]);
    }

    #[test]
    fn exact_temperature_without_effect_is_a_warning() {
        let warnings = |keys: &str| {
            let text = shipped_text("masonry-arch").replace("battery = \"paper\"\n", keys);
            let warn = |source: &ScenarioText, _: &CheckOptions, findings: &mut Findings| {
                findings.warnings.extend(unused_temperature(source, &source.read(&text).unwrap(), Language::English));
            };
            found("masonry-arch", &text, &aircraft(), warn).warnings
        };
        let line = shipped_text("masonry-arch").lines().position(|line| line == "battery = \"paper\"").unwrap() + 2;
        assert_eq!(
            warnings("battery = \"paper\"\nbattery_temperature_c = -10.0\n"),
            [format!(
                "masonry-arch.toml:{line}: rules.battery_temperature_c has no effect with battery = \"paper\": set battery = \"physical\""
            )]
        );
        for keys in ["battery = \"physical\"\nbattery_temperature_c = -10.0\n", "battery = \"paper\"\n"] {
            assert_eq!(warnings(keys), Vec::<String>::new(), "{keys}");
        }
    }

    #[test]
    fn exact_placed_defects_must_be_on_their_member_and_in_sight_of_a_task() {
        let base = shipped_text("practice");
        let scenario = scenario::read("practice.toml", &base, &|_| Err("none".into())).unwrap();
        let own = Site::build(&scenario, 3).defects()[0].clone();
        let findings = |defect: &PlacedDefect| {
            let (text, _) = scenario::edit::with_placed_defect(&base, defect).unwrap();
            let line = text.lines().position(|line| line == "[[defects.placed]]").unwrap() + 1;
            (line, scenario_findings("practice", &text, &aircraft()))
        };
        let (_, fine) = findings(&own);
        assert_eq!((fine.problems, fine.warnings), (vec![], vec![]));
        assert!(fine.notes.iter().any(|note| note.ends_with("and 1 defect")), "{:?}", fine.notes);
        let (drill, _) = scenario::edit::with_placed_defect(&shipped_text("drill-lamp"), &own).unwrap();
        let found = scenario_findings("drill-lamp", &drill, &aircraft());
        let expected = "difficulty.detection_pct has no effect: the placed defects are the same at all levels";
        let line = drill.lines().position(|line| line.starts_with("detection_pct = [")).unwrap() + 1;
        assert!(found.warnings.contains(&format!("drill-lamp.toml:{line}: {expected}")), "{found:?}");
        let problem = |defect: PlacedDefect| {
            let (line, found) = findings(&defect);
            let [problem] = found.problems.as_slice() else { panic!("{found:?}") };
            assert_eq!(problem.line, line);
            (problem.location.clone(), problem.message.clone())
        };
        let at = |key: &str, words: &str| (format!("defects.placed[0].{key}"), words.to_owned());
        assert_eq!(problem(PlacedDefect { member: "arch/x".into(), ..own.clone() }), at("member", "unknown member"));
        let other = PlacedDefect { element: Element::TimberDeck, ..own.clone() };
        assert_eq!(problem(other), at("element", "not the element of the member"));
        let moved = PlacedDefect { position_m: own.position_m + own.normal, ..own.clone() };
        assert_eq!(problem(moved), at("position_m", "not on a surface"));
        let tiny = PlacedDefect { length_m: 0.0002, width_m: 0.0001, ..own };
        let (line, found) = findings(&tiny);
        assert_eq!((found.problems, found.warnings.len()), (vec![], 1));
        assert!(
            found.warnings[0].starts_with(&format!("practice.toml:{line}: defect 1 cannot be photographed")),
            "{:?}",
            found.warnings
        );
    }

    #[test]
    fn exact_low_clearance_is_reported_with_the_position() {
        let mut aircraft = aircraft();
        aircraft.hull.tip_to_tip_m = 30.0;
        let findings = scenario_findings("two-bridges", shipped::TWO_BRIDGES, &aircraft);
        assert_eq!(findings.problems.len(), 4, "{:?}", findings.problems);
        let problem = findings.problems[2].to_string();
        assert!(problem.contains("interlayer") || problem.contains("task 3"), "{problem}");
        assert!(problem.contains("allowed: at least 15.50 m") && problem.contains("up "), "{problem}");
        assert_eq!(findings.problems[2].location, "tasks[2]");
    }

    #[test]
    fn exact_places_without_room_for_a_person_are_reported() {
        let base = shipped_text("two-bridges");
        let start = base.find("places_m").unwrap();
        let (before, rest) = base.split_at(start);
        let rest = &rest[rest.find("\ntruck_m").unwrap()..];
        let line = before.lines().count() + 1;
        let problems = |list: &str| -> Vec<String> {
            let text = format!("{before}places_m = {list}{rest}");
            let found = scenario_findings("two-bridges", &text, &aircraft()).problems;
            assert!(found.iter().all(|problem| problem.location == "ground_team.places_m"), "{found:?}");
            found.iter().map(ToString::to_string).collect()
        };
        let land = "on land, clear of water, bridges, the landing pad and the truck";
        let head = format!("two-bridges.toml:{line}: ground_team.places_m = ");
        assert_eq!(problems("[[-124.0, 74.0, 4.95]]"), Vec::<String>::new());
        assert_eq!(
            problems("[[0.0, 78.0, 0.0], [-121.0, 84.0, 4.95]]"),
            [
                format!("{head}[0, 78, 0]: place 2 is in or too close to the water (allowed: {land})"),
                format!("{head}[-121, 84, 4.95]: place 3 is in or too close to the truck (allowed: {land})"),
            ]
        );
        let high = problems("[[-124.0, 74.0, 7.0]]");
        assert!(high[0].contains("place 2 is 2.0 m above the ground (allowed: up 4.95 ± 0.5 m"), "{high:?}");
        // At the anchorage of the suspension bridge, and beyond the edge of the terrain.
        let others = problems("[[-115.0, 150.0, 6.0], [-410.0, 78.0, 60.0]]");
        let names: Vec<bool> =
            ["a bridge", "the edge of the terrain"].iter().zip(&others).map(|(name, words)| words.contains(name)).collect();
        assert_eq!(names, [true; 2], "{others:?}");
        // The straight way from place 1 leads over the landing pad.
        let over_pad = problems("[[-106.0, 82.0, 4.95]]");
        let words = format!("{head}place 1 to place 2: the landing pad is on the way at east -11");
        assert!(over_pad.len() == 2 && over_pad[0].starts_with(&words), "{over_pad:?}");
        assert!(over_pad[1].contains("place 2 to place 1"), "{over_pad:?}");
    }

    #[test]
    fn exact_forms_of_a_job_with_placed_defects_lack_none() {
        let job = scenario::read("a.toml", shipped::PILOT_STUDY, &|_| Err("none".into())).unwrap();
        let site = Site::build(&job, 0);
        let (text, _) = scenario::edit::with_placed_defect(shipped::PILOT_STUDY, &site.defects()[0]).unwrap();
        let findings = found("pilot-study", &text, &aircraft(), |source, options, findings| {
            check_forms(source, Some("A"), options, findings);
        });
        assert_eq!((findings.warnings, findings.notes.len()), (Vec::new(), 1));
    }

    #[test]
    fn exact_no_step_begins_after_the_limit() {
        let aircraft = aircraft();
        let options = CheckOptions { aircraft: &aircraft, may_continue: &|| false, language: Language::English };
        let source = ScenarioText { file: "a.toml", text: shipped::PILOT_STUDY, siblings: &|_| Err("none".into()) };
        let mut findings = Findings::default();
        check_forms(&source, None, &options, &mut findings);
        check_scenario(&source, &source.read(source.text).unwrap(), &options, &mut findings);
        assert_eq!((findings.problems, findings.warnings), (Vec::new(), Vec::new()));
    }

    #[test]
    fn exact_clearance_limit_matches_the_aircraft_size() {
        // Tolerance, m: the search along the path stops within 1 mm of the narrowest point.
        const TOLERANCE_M: f64 = 2e-3;
        let text = shipped_text("drill-gap");
        let scenario = scenario::read("drill-gap.toml", &text, &|_| Err("none".into())).unwrap();
        let site = Site::build(&scenario, 0);
        let room = |p: &Vec3<Enu>| site.geometry().nearest(*p, 100.0).map_or(100.0, |near| near.distance_m);
        let path = &scenario.tasks[0].path_m;
        let tightest_m = path.windows(2).flat_map(|w| (0..200).map(|k| w[0].lerp(w[1], f64::from(k) / 200.0)));
        let tightest_m = tightest_m.map(|p| room(&p)).fold(f64::INFINITY, f64::min);
        let problems = |tip_to_tip_m: f64| {
            let mut aircraft = aircraft();
            aircraft.hull.tip_to_tip_m = tip_to_tip_m;
            let check = |source: &ScenarioText, options: &CheckOptions, findings: &mut Findings| {
                findings.problems = clearance_problems(source, &scenario, &Site::without_defects(&scenario), options);
            };
            found("drill-gap", &text, &aircraft, check).problems
        };
        let fits_m = 2.0 * (tightest_m - MIN_CLEARANCE_M);
        assert_eq!(problems(fits_m - TOLERANCE_M), []);
        let refused = problems(fits_m + 2.0 * TOLERANCE_M);
        assert_eq!(refused.len(), 1);
        assert_eq!(table_line_numbers(&text, &TASK_TABLES), [refused[0].line]);
        // The clearance at the reported point matches the reported clearance.
        let number = |after: &str| {
            let rest = refused[0].message.split(after).nth(1).unwrap();
            rest.trim_start().split(' ').next().unwrap().parse::<f64>().unwrap()
        };
        let at = Vec3::new(number("at east"), number("north"), number("up"));
        assert!((room(&at) - tightest_m).abs() < 0.1, "{}", refused[0].message);
        assert!(refused[0].value == format!("{tightest_m:.2} m"), "{}", refused[0].value);
    }
}
