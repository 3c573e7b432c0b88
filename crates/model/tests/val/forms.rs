//! Tests of the shipped jobs with forms: equivalent forms have the same predicted detection, and a harder one has less.

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
/// Defects of the certification job that are no cracks. Fewer make a single session too uncertain (docs/src/measured/certification.md).
const CERTIFICATION_AREAS: usize = 62;
/// Smallest distance between defects of different forms, m: a defect must not be remembered from another form.
const MIN_DISTANCE_M: f64 = 0.5;

fn root() -> PathBuf {
    Path::new(concat!(env!("CARGO_MANIFEST_DIR"), "/../..")).to_path_buf()
}

fn form(job: &str, name: &str) -> (Scenario, Site) {
    let text = std::fs::read_to_string(root().join(format!("scenarios/{job}.toml"))).unwrap();
    let none = |file: &str| Err(format!("no file {file}"));
    let job = spandrel_model::scenario::read("job.toml", &select_form(&text, name), &none).unwrap();
    // The session's seed does not affect the defects of a form.
    let site = Site::build(&job, 7);
    assert_eq!(site.defects(), Site::build(&job, 8).defects());
    (job, site)
}

fn mean_detection((job, site): &(Scenario, Site), camera: &Camera) -> f64 {
    assert_eq!(site.defects().len(), job.defects.count);
    site.predicted_detection(&job.tasks, camera).iter().sum::<f64>() / job.defects.count as f64
}

/// Returns the cameras of all shipped aircraft and the reference camera.
fn cameras() -> Vec<Camera> {
    let aircraft = ["phantom2", "f450", "m30", "elios3"];
    let shipped = aircraft.map(|name| read_vehicle(&root().join(format!("vehicle-params/{name}.toml"))).camera);
    shipped.into_iter().chain([REFERENCE_CAMERA]).collect()
}

/// Returns the mean detection of the easiest form and of the hardest one.
fn extremes(forms: &[(Scenario, Site)], camera: &Camera) -> (f64, f64) {
    let means = forms.iter().map(|form| mean_detection(form, camera));
    means.fold((0.0, 1.0), |(most, least): (f64, f64), mean| (most.max(mean), least.min(mean)))
}

#[test]
fn val_forms_of_the_pilot_study_are_equivalent_with_every_camera() {
    let equal = ["A", "B", "C"].map(|name| form("pilot-study", name));
    let hard = form("pilot-study", "H");
    for camera in cameras() {
        let (most, least) = extremes(&equal, &camera);
        assert!(most - least <= EQUIVALENT, "{least} to {most}");
        let harder = mean_detection(&hard, &camera);
        assert!(harder <= least - HARDER, "{harder} and {least}");
    }
}

#[test]
fn val_forms_of_the_certification_job_are_equivalent_with_every_camera() {
    let forms = ["A", "B", "C"].map(|name| form("certification", name));
    for camera in cameras() {
        let (most, least) = extremes(&forms, &camera);
        assert!(most - least <= EQUIVALENT, "{least} to {most}");
    }
    for (_, site) in &forms {
        let areas = site.defects().iter().filter(|defect| !defect.line).count();
        assert_eq!(areas, CERTIFICATION_AREAS);
    }
}

#[test]
fn val_forms_of_the_pilot_study_share_no_positions_and_few_cracks() {
    let sites = ["A", "B", "C", "H"].map(|name| form("pilot-study", name));
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
