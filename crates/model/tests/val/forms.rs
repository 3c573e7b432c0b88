//! Tests of the shipped job with forms: the equivalent forms have the same predicted detection, and the harder one has less.

use crate::shipped_files::read_vehicle;
use spandrel_model::scenario::{Scenario, select_form};
use spandrel_model::site::Site;
use spandrel_model::site::defects::REFERENCE_CAMERA;
use spandrel_model::vehicle::Camera;
use std::path::{Path, PathBuf};

/// Largest difference between the means of equivalent forms: 3 percentage points, a third of one defect of ten.
const EQUIVALENT: f64 = 0.03;
/// Smallest difference between the mean of the harder form and the others, with any camera: one defect of ten.
const HARDER: f64 = 0.1;
/// Smallest number of defects that count for certification with the default aircraft.
const MIN_GRADABLE: usize = 8;
/// Smallest distance between defects of different forms, m: a defect must not be remembered from another form.
const MIN_DISTANCE_M: f64 = 0.5;

fn root() -> PathBuf {
    Path::new(concat!(env!("CARGO_MANIFEST_DIR"), "/../..")).to_path_buf()
}

fn form(name: &str) -> (Scenario, Site) {
    let text = std::fs::read_to_string(root().join("scenarios/pilot-study.toml")).unwrap();
    let none = |file: &str| Err(format!("no file {file}"));
    let job = spandrel_model::scenario::read("pilot-study.toml", &select_form(&text, name), &none).unwrap();
    // The session's seed does not affect the defects of a form.
    let site = Site::build(&job, 7);
    assert_eq!(site.defects(), Site::build(&job, 8).defects());
    (job, site)
}

fn mean_detection((job, site): &(Scenario, Site), camera: &Camera) -> f64 {
    assert_eq!(site.defects().len(), 10);
    site.predicted_detection(&job.tasks, camera).iter().sum::<f64>() / 10.0
}

#[test]
fn val_forms_of_the_pilot_study_are_equivalent_with_every_camera() {
    let equal = ["A", "B", "C"].map(form);
    let hard = form("H");
    let aircraft = ["phantom2", "f450", "m30", "elios3"];
    let cameras = aircraft.map(|name| read_vehicle(&root().join(format!("vehicle-params/{name}.toml"))).camera);
    for camera in cameras.iter().chain([&REFERENCE_CAMERA]) {
        let means = equal.each_ref().map(|one| mean_detection(one, camera));
        let (low, high) = means.iter().fold((1.0_f64, 0.0_f64), |(low, high), mean| (low.min(*mean), high.max(*mean)));
        assert!(high - low <= EQUIVALENT, "{means:?}");
        let harder = mean_detection(&hard, camera);
        assert!(harder <= low - HARDER, "{harder} and {means:?}");
    }
}

#[test]
fn val_forms_of_the_pilot_study_share_no_positions_and_few_cracks() {
    let sites = ["A", "B", "C", "H"].map(form);
    for (k, (_, one)) in sites.iter().enumerate() {
        let areas = one.defects().iter().filter(|defect| !defect.line).count();
        assert!(areas >= MIN_GRADABLE, "{areas}");
        for (_, other) in &sites[k + 1..] {
            let near = |a: &&spandrel_model::scenario::PlacedDefect| {
                other.defects().iter().any(|b| (a.position_m - b.position_m).norm() < MIN_DISTANCE_M)
            };
            assert_eq!(one.defects().iter().find(near), None);
        }
    }
}
