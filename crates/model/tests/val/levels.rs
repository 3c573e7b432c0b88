//! Tests of the shipped drills at every difficulty level: the site has room for the paths and for all defects, and the defects
//! become harder to find.

use crate::shipped_files::{read_vehicle, toml_files};
use spandrel_model::scenario::{Scenario, TaskKind, level_count, select_level};
use spandrel_model::site::Site;
use spandrel_model::site::defects::REFERENCE_CAMERA;
use spandrel_model::time::SimTime;
use std::path::Path;

/// Number of shipped drills with levels: all of them.
const DRILLS: usize = 15;
/// Clearance that `check` requires in addition to half the aircraft's width, m.
const MIN_CLEARANCE_M: f64 = 0.5;
/// Largest difference between the requested and the predicted mean detection: 3 percentage points (sizes are rounded to
/// those that the catalog allows).
const DETECTION_TOLERANCE: f64 = 0.03;

/// Returns every shipped job with levels at every level.
fn levels() -> Vec<(String, Vec<Scenario>)> {
    let texts = toml_files("scenarios").into_iter().map(|path| std::fs::read_to_string(path).unwrap());
    let at =
        |text: &str, level: u8| spandrel_model::scenario::read("drill.toml", &select_level(text, level), &|_| Err(String::new()));
    let jobs = texts.filter_map(|text| level_count(&text).map(|levels| (text, levels))).map(|(text, levels)| {
        let all: Vec<Scenario> = (1..=levels).map(|level| at(&text, level).unwrap()).collect();
        (all[0].name.clone(), all)
    });
    jobs.collect()
}

#[test]
fn val_every_level_of_every_drill_is_valid_and_has_room_for_the_default_aircraft() {
    let aircraft = read_vehicle(&Path::new(concat!(env!("CARGO_MANIFEST_DIR"), "/../..")).join("vehicle-params/phantom2.toml"));
    let needed_m = 0.5 * aircraft.hull.tip_to_tip_m + MIN_CLEARANCE_M;
    let drills = levels();
    assert_eq!(drills.len(), DRILLS);
    for (name, jobs) in drills {
        for (level, job) in (1..).zip(&jobs) {
            let site = Site::build(job, 7);
            assert_eq!(site.defects().len(), job.defects.count, "{name} level {level}");
            for task in job.tasks.iter().filter(|task| task.kind != TaskKind::PierCircle) {
                let gap_m = |p: &_| site.nearest(*p, 50.0, SimTime::ZERO).map_or(50.0, |near| near.distance_m);
                let least_m = task.path_m.iter().map(gap_m).fold(f64::INFINITY, f64::min);
                assert!(least_m >= needed_m, "{name} level {level}: {least_m} m");
            }
        }
    }
}

#[test]
fn val_defects_have_the_predicted_detection_of_their_level() {
    for (name, jobs) in levels() {
        for (level, job) in (1..).zip(&jobs) {
            let Some(wanted) = job.defects.mean_detection else { continue };
            let site = Site::build(job, 7);
            let detection = site.predicted_detection(&job.tasks, &REFERENCE_CAMERA);
            let mean = detection.iter().sum::<f64>() / detection.len() as f64;
            assert!((mean - wanted).abs() <= DETECTION_TOLERANCE, "{name} level {level}: {mean} instead of {wanted}");
        }
    }
}
