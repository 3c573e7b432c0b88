//! `spandrel check`: reports all errors in scenario and vehicle files at once.

use crate::errors::{AppError, EXIT_CODES};
use crate::io::files::{self, SourceFile};
use serde_json::json;
use spandrel_model::scenario::{self, Scenario, Task};
use spandrel_model::site::{Site, defects};
use spandrel_model::toml::{Problem, split_displayed};
use spandrel_model::vehicle::{self, Vehicle};
use spandrel_monitor::measures::image_quality;
use spandrel_monitor::score::certification::{job_time, pictures, requirements};

/// Minimum clearance between the path and obstacles, in addition to half the aircraft's tip-to-tip width, m (issue 2,
/// section 2).
const MIN_CLEARANCE_M: f64 = 0.5;

/// Seeds to try for a scenario without its own seed. One seed is enough to find a task that is too far from the
/// bridges; three also show whether the defects fit (estimate).
const TRIAL_SEEDS: [u64; 3] = [1, 2, 3];

/// Check scenario and vehicle files
///
/// Reports all errors at once, each with file, line, key, value and allowed range. For a scenario, it also builds the
/// site and reports every task with a reference path that is too close to an obstacle, with the location. The minimum
/// clearance is half the aircraft's tip-to-tip width plus 0.5 m. It warns if it cannot place as many defects as the
/// scenario requests. For each form of a scenario, it prints the predicted detection of the defects; for each difficulty
/// level, it prints what the level changes.
#[derive(Debug, clap::Args)]
#[command(after_help = EXIT_CODES, after_long_help = format!("\
Examples:
  spandrel check my-bridge.toml                        check the paths for the default aircraft
  spandrel check my-bridge.toml --vehicle m30          check them for another aircraft
  spandrel check scenarios/*.toml vehicle-params/*.toml --json

{EXIT_CODES}"))]
pub struct Args {
    /// Scenario and vehicle files, or names of shipped scenarios and aircraft
    #[arg(value_name = "FILE", required = true)]
    files: Vec<String>,
    /// Form to check; the files must have it [default: all forms]
    #[arg(long, value_name = "NAME")]
    form: Option<String>,
    /// Difficulty level to check; the files must have it [default: the standard, the easiest and the hardest level]
    #[arg(long, value_name = "N", conflicts_with = "form")]
    level: Option<u8>,
    /// Aircraft for the clearance check: a file, or the name of a shipped aircraft
    #[arg(long, value_name = "FILE|NAME", default_value = "phantom2")]
    vehicle: String,
    /// Print {"problems": [{file, line, key, value, allowed, message}], "warnings": [...], "notes": [...]} on standard
    /// output
    #[arg(long)]
    json: bool,
}

#[derive(Debug, Default)]
struct Findings {
    problems: Vec<Problem>,
    warnings: Vec<String>,
    notes: Vec<String>,
}

/// Runs the subcommand.
///
/// # Errors
/// Returns an error if a file is invalid.
pub fn run(args: &Args) -> Result<(), AppError> {
    let aircraft = files::vehicle(&args.vehicle)?.vehicle;
    let mut findings = Findings::default();
    for file in &args.files {
        match files::any_source(&files::with_variant(file, args.form.as_deref(), args.level)) {
            Ok(source) => {
                check_scenario(&source, &aircraft, &mut findings);
                check_forms(&source, args.form.as_deref(), &aircraft, &mut findings);
                check_levels(&source, args.level, &aircraft, &mut findings);
            }
            Err(error) => findings.problems.push(unreadable(file, &error)),
        }
    }
    let Findings { problems, warnings, notes } = &findings;
    let (first, more) = split_displayed(problems);
    if args.json {
        println!("{:#}", json!({ "problems": first, "more_problems": more, "warnings": warnings, "notes": notes }));
    } else {
        notes.iter().for_each(|note| println!("note: {note}"));
        warnings.iter().for_each(|warning| println!("warning: {warning}"));
        // Errors in unreadable files have no line number.
        first.iter().for_each(|problem| if problem.line == 0 { println!("{}", problem.message) } else { println!("{problem}") });
        if more > 0 {
            println!("and {more} more problems");
        }
    }
    match problems.len() {
        0 if args.json => Ok(()),
        0 => {
            let files = count(args.files.len(), "file");
            match warnings.len() {
                0 => println!("{files} valid"),
                many => println!("{files} valid ({})", count(many, "warning")),
            }
            Ok(())
        }
        many => Err(AppError::invalid(format!("{} in {}", count(many, "problem"), count(args.files.len(), "file")))),
    }
}

fn count(number: usize, what: &str) -> String {
    if number == 1 { format!("1 {what}") } else { format!("{number} {what}s") }
}

fn unreadable(file: &str, error: &AppError) -> Problem {
    let text = String::new;
    Problem { file: file.into(), line: 0, key: text(), value: text(), allowed: text(), message: error.to_string() }
}

/// Describes the difficulty of a scenario's forms: the requested one, or all. Files with problems have already been reported.
fn check_forms(source: &SourceFile, requested: Option<&str>, aircraft: &Vehicle, findings: &mut Findings) {
    for form in scenario::form_names(&source.text).iter().filter(|form| requested.is_none_or(|one| one == *form)) {
        let text = scenario::select_form(&source.text, form);
        let Ok(job) = scenario::read(&source.file, &text, &|name| source.read_referenced_file(name)) else { return };
        let site = Site::build(&job, 0);
        let (defects, detection) = (site.defects(), site.predicted_detection(&job.tasks, &defects::REFERENCE_CAMERA));
        if defects.len() < job.defects.count {
            findings.warnings.push(format!(
                "{}: form {form}: only {} of {} defects could be placed: choose another defect_seed or detection_pct",
                source.file,
                defects.len(),
                job.defects.count
            ));
        }
        let gradable = defects.iter().filter(|defect| pictures::is_gradable(defect, &job, &aircraft.camera).0).count();
        let percent = |share: f64| format!("{:.1}%", 100.0 * share);
        let (low, high) = detection.iter().fold((1.0_f64, 0.0_f64), |(low, high), one| (low.min(*one), high.max(*one)));
        findings.notes.push(format!(
            "{}: form {form}: predicted detection {} on average ({} to {}); {gradable} of {} count for certification",
            source.file,
            percent(detection.iter().sum::<f64>() / detection.len().max(1) as f64),
            percent(low),
            percent(high),
            count(defects.len(), "defect")
        ));
    }
}

/// Describes a scenario's difficulty levels: the requested one, or all. Checks the paths and the defects at the easiest and at the
/// hardest level, too, unless a level is requested. Files with problems have already been reported.
fn check_levels(source: &SourceFile, requested: Option<u8>, aircraft: &Vehicle, findings: &mut Findings) {
    let read = |text: &str| scenario::read(&source.file, text, &|name| source.read_referenced_file(name)).ok();
    let Some(difficulty) = read(&source.text).and_then(|job| job.difficulty) else { return };
    let levels = difficulty.levels();
    for level in (1..=levels).filter(|level| requested.is_none_or(|one| one == *level)) {
        let standard = if level == difficulty.standard { ", the standard level" } else { "" };
        findings.notes.push(format!("{}: level {level} of {levels}{standard}: {}", source.file, difficulty.settings_at(level)));
    }
    for level in [1, levels].into_iter().filter(|level| requested.is_none() && *level != difficulty.level) {
        let Some(job) = read(&scenario::select_level(&source.text, level)) else { continue };
        let at_level = |words: &str| format!("at level {level}: {words}");
        let problems = clearance_problems(source, &job, aircraft).into_iter();
        findings.problems.extend(problems.map(|problem| Problem { message: at_level(&problem.message), ..problem }));
        findings.warnings.extend(missing_defects_warning(source, &job).map(|warning| at_level(&warning)));
    }
}

fn check_scenario(source: &SourceFile, aircraft: &Vehicle, findings: &mut Findings) {
    if is_vehicle_file(&source.text) {
        match vehicle::read(&source.file, &source.text) {
            Ok(vehicle) => {
                let short = defects::reference_shortfalls(&vehicle.camera, &vehicle.lamp);
                findings.notes.extend(short.into_iter().map(|what| format!("{}: {what}", source.file)));
            }
            Err(wrong) => findings.problems.extend(wrong.0),
        }
        return;
    }
    match scenario::read(&source.file, &source.text, &|name| source.read_referenced_file(name)) {
        Ok(scenario) => {
            findings.problems.extend(clearance_problems(source, &scenario, aircraft));
            findings.warnings.extend(missing_defects_warning(source, &scenario));
            findings.notes.extend(certification_notes(source, &scenario, aircraft));
        }
        Err(wrong) => findings.problems.extend(wrong.0),
    }
}

/// Explains what a flight must reach to be certified in this job, and which defects the aircraft's camera can't resolve.
fn certification_notes(source: &SourceFile, scenario: &Scenario, aircraft: &Vehicle) -> Vec<String> {
    let mut notes = requirements::describe(scenario);
    let path_m: f64 = scenario.tasks.iter().map(Task::length_m).sum();
    let needed_min = job_time::job_needed_s(scenario) / 60.0;
    notes.push(format!(
        "time that the job needs: {needed_min:.1} min for {path_m:.0} m of path and {}",
        count(scenario.defects.count, "defect")
    ));
    let finest_mm = image_quality::best_gsd_mm(&aircraft.camera, pictures::shortest_stand_off_m(scenario));
    let crack_mm = finest_mm / scenario.certification.gsd_per_line_width;
    notes.push(format!(
        "the camera of {} reaches {finest_mm:.2} mm/px at the clearance limit; cracks narrower than {crack_mm:.1} mm do not count",
        aircraft.name
    ));
    notes.into_iter().map(|note| format!("{}: to be certified: {note}", source.file)).collect()
}

/// Top-level keys that appear in only one of the two file types. They identify the file type even if some keys are
/// missing.
const VEHICLE_KEYS: [&str; 10] =
    ["mass_kg", "inertia_kg_m2", "rotors", "drag", "hull", "battery", "limits", "sensors", "camera", "lamp"];
const SCENARIO_KEYS: [&str; 17] = [
    "title",
    "briefing",
    "difficulty",
    "forms",
    "seed",
    "origin",
    "terrain",
    "ground_team",
    "bridges",
    "tasks",
    "defects",
    "traffic",
    "wind",
    "light",
    "rules",
    "scoring",
    "certification",
];

fn is_vehicle_file(text: &str) -> bool {
    let mut in_table = false;
    let words = text.lines().filter_map(|line| {
        let line = line.trim();
        let head = line.starts_with('[');
        in_table |= head;
        let word = line.trim_start_matches(['[', ' ']).split(['.', ']', '=', ' ', '\t']).next();
        word.filter(|_| head || !in_table)
    });
    let weigh = |word: &str| i32::from(VEHICLE_KEYS.contains(&word)) - i32::from(SCENARIO_KEYS.contains(&word));
    words.map(weigh).sum::<i32>() > 0
}

fn clearance_problems(source: &SourceFile, scenario: &Scenario, aircraft: &Vehicle) -> Vec<Problem> {
    let needed_m = 0.5 * aircraft.hull.tip_to_tip_m + MIN_CLEARANCE_M;
    let site = Site::without_defects(scenario);
    let lines: Vec<usize> = task_line_numbers(&source.text);
    let tight = |(k, task): (usize, &Task)| {
        let (at_m, near) = site.min_path_clearance(task, needed_m)?;
        let (clearance_m, object) = (near.distance_m, site.object_name(near.object));
        let [east, north, up] = at_m.array();
        Some(Problem {
            file: source.file.clone(),
            line: lines.get(k).copied().unwrap_or(1),
            key: format!("tasks.{k}"),
            value: format!("{clearance_m:.2} m"),
            allowed: format!(
                "at least {needed_m:.2} m for {}: half its {:.2} m tip-to-tip width plus {MIN_CLEARANCE_M} m",
                aircraft.id, aircraft.hull.tip_to_tip_m
            ),
            message: format!(
                "the path of task {} '{}' passes too close to {object} at east {east:.1} m, north {north:.1} m, up {up:.1} m",
                task.id, task.name
            ),
        })
    };
    scenario.tasks.iter().enumerate().filter_map(tight).collect()
}

/// Returns a warning if some requested defects cannot be placed. Tries the scenario's own seed, or the first few seeds.
fn missing_defects_warning(source: &SourceFile, scenario: &Scenario) -> Option<String> {
    let wanted = scenario.defects.count;
    if wanted == 0 || scenario.defects.placed.is_some() {
        return None;
    }
    let seeds = scenario.seed.map_or_else(|| TRIAL_SEEDS.to_vec(), |seed| vec![seed]);
    let placed = seeds.iter().map(|seed| (Site::build(scenario, *seed).defects().len(), *seed));
    let (least, seed) = placed.min()?;
    let line = source.text.lines().position(|line| line.trim_start().starts_with("[defects]")).map_or(1, |k| k + 1);
    (least < wanted).then(|| {
        format!(
            "{}:{line}: defects.count = {wanted}, but only {least} could be placed (seed {seed}): no other spot on a bridge can be \
             photographed from within a task's threshold; move the tasks closer to the structure, extend defects.elements or \
             defects.kinds, or set the count to {least}",
            source.file
        )
    })
}

/// Returns the line number of each task's table.
fn task_line_numbers(text: &str) -> Vec<usize> {
    let heads = text.lines().enumerate().filter(|(_, line)| {
        let line: String = line.chars().filter(|c| !c.is_whitespace()).collect();
        line.starts_with("[[task]]") || line.starts_with("[[tasks]]")
    });
    heads.map(|(k, _)| k + 1).collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use spandrel_model::frames::{Enu, Vec3};

    #[test]
    fn exact_task_lines_are_found() {
        assert_eq!(task_line_numbers("a = 1\n[[tasks]]\nx = 2\n [[ tasks ]]\n[wind]\n"), [2, 4]);
    }

    #[test]
    fn exact_every_shipped_path_fits_the_default_aircraft() {
        let aircraft = files::vehicle("phantom2").unwrap().vehicle;
        for name in files::scenario_names() {
            let mut findings = Findings::default();
            check_scenario(&files::any_source(name).unwrap(), &aircraft, &mut findings);
            assert_eq!(findings.problems, [], "{name}");
        }
    }

    #[test]
    fn exact_levels_are_described_and_checked_at_both_ends() {
        let aircraft = files::vehicle("phantom2").unwrap().vehicle;
        let check = |source: &SourceFile, level| {
            let mut findings = Findings::default();
            check_levels(source, level, &aircraft, &mut findings);
            findings
        };
        let source = files::any_source("drill-gap").unwrap();
        let found = check(&source, None);
        assert_eq!((found.problems, found.warnings, found.notes.len()), (vec![], vec![], 9));
        assert_eq!(found.notes[8], "drill-gap.toml: level 9 of 9: wind 5 m/s, gap 2.8 m");
        assert!(found.notes[4].contains("level 5 of 9, the standard level: wind 0.98 m/s, gap 3.4 m"), "{}", found.notes[4]);
        assert_eq!(check(&source, Some(9)).notes, found.notes[8..]);
        let mut wide = aircraft.clone();
        wide.hull.tip_to_tip_m = 2.0;
        let mut findings = Findings::default();
        check_levels(&source, None, &wide, &mut findings);
        assert!(findings.problems[0].message.starts_with("at level 9: the path of task 1 "), "{:?}", findings.problems);
        assert!(check(&files::any_source("two-bridges").unwrap(), None).notes.is_empty());
    }

    #[test]
    fn regress_missing_defects_cause_a_warning() {
        let aircraft = files::vehicle("phantom2").unwrap().vehicle;
        let mut source = files::any_source("drill-straight-line").unwrap();
        let found = |source: &SourceFile| {
            let mut findings = Findings::default();
            check_scenario(source, &aircraft, &mut findings);
            assert_eq!(findings.problems, []);
            findings.warnings
        };
        assert_eq!(found(&source), Vec::<String>::new(), "no defects requested");
        source.text = source.text.replace("[defects]\ncount = 0", "[defects]\ncount = 4");
        let line = source.text.lines().position(|line| line == "[defects]").unwrap() + 1;
        let warnings = found(&source);
        assert_eq!(warnings.len(), 1, "{warnings:?}");
        assert!(warnings[0].contains(&format!(":{line}: defects.count = 4, but only 0 could be placed")), "{warnings:?}");
    }

    #[test]
    fn regress_only_similar_keys_are_suggested() {
        let message = |key: &str| {
            let mut source = files::any_source("drill-straight-line").unwrap();
            source.text = source.text.replace("[defects]\n", &format!("[defects]\n{key} = 1\n"));
            let wrong = scenario::read(&source.file, &source.text, &|name| source.read_referenced_file(name)).unwrap_err();
            wrong.0.first().map(|problem| problem.message.clone()).unwrap()
        };
        assert_eq!(message("model"), "unknown key");
        assert_eq!(message("wether"), "unknown key");
        assert_eq!(message("kind"), "unknown key; did you mean kinds?");
        assert_eq!(message("size_facter"), "unknown key; did you mean size_factor?");
    }

    #[test]
    fn exact_low_clearance_is_reported_with_the_position() {
        let mut aircraft = files::vehicle("phantom2").unwrap().vehicle;
        aircraft.hull.tip_to_tip_m = 30.0;
        let mut findings = Findings::default();
        check_scenario(&files::any_source("two-bridges").unwrap(), &aircraft, &mut findings);
        assert_eq!(findings.problems.len(), 4, "{:?}", findings.problems);
        let problem = findings.problems[2].to_string();
        assert!(problem.contains("interlayer") || problem.contains("task 3"), "{problem}");
        assert!(problem.contains("allowed: at least 15.50 m") && problem.contains("up "), "{problem}");
    }

    #[test]
    fn exact_clearance_limit_matches_the_aircraft_size() {
        // Tolerance, m: the search along the path stops within 1 mm of the narrowest point.
        const TOLERANCE_M: f64 = 2e-3;
        let source = files::any_source("drill-gap").unwrap();
        let scenario = scenario::read(&source.file, &source.text, &|name| source.read_referenced_file(name)).unwrap();
        let site = Site::build(&scenario, 0);
        let room = |p: &Vec3<Enu>| site.geometry().nearest(*p, 100.0).map_or(100.0, |near| near.distance_m);
        let path = &scenario.tasks[0].path_m;
        let tightest_m = path.windows(2).flat_map(|w| (0..200).map(|k| w[0].lerp(w[1], f64::from(k) / 200.0)));
        let tightest_m = tightest_m.map(|p| room(&p)).fold(f64::INFINITY, f64::min);
        let problems = |tip_to_tip_m: f64| {
            let mut aircraft = files::vehicle("phantom2").unwrap().vehicle;
            aircraft.hull.tip_to_tip_m = tip_to_tip_m;
            clearance_problems(&source, &scenario, &aircraft)
        };
        let fits_m = 2.0 * (tightest_m - MIN_CLEARANCE_M);
        assert_eq!(problems(fits_m - TOLERANCE_M), []);
        let refused = problems(fits_m + 2.0 * TOLERANCE_M);
        assert_eq!(refused.len(), 1);
        assert_eq!(task_line_numbers(&source.text), [refused[0].line]);
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
