//! Tests of the shipped job on its real site: paths, defects, light and camera geometry, from datagrams to scores.

use spandrel_model::frames::{Enu, Vec3};
use spandrel_model::math;
use spandrel_model::scenario::{PlacedDefect, Scenario};
use spandrel_model::site::CameraPose;
use spandrel_model::vehicle::Vehicle;
use spandrel_monitor::measures::attention::SiteSurvey;
use spandrel_monitor::sidecar::build_site;
use spandrel_monitor::{assess_log, export};
use spandrel_testkit::job::Tape;

fn shipped() -> (Scenario, Vehicle) {
    let none = |name: &str| Err(format!("{name} not found"));
    let text = spandrel_model::shipped::TWO_BRIDGES;
    let scenario = spandrel_model::scenario::read("two-bridges.toml", text, &none).unwrap();
    let text = spandrel_model::shipped::PHANTOM2;
    (scenario, spandrel_model::vehicle::read("phantom2.toml", text).unwrap())
}

/// Returns a position (m), heading and gimbal pitch (rad) for photographing a defect within a task's path threshold.
fn viewpoint(
    defect: &PlacedDefect,
    scenario: &Scenario,
    vehicle: &Vehicle,
    site: &dyn SiteSurvey,
) -> Option<(Vec3<Enu>, f64, f64)> {
    let mut points: Vec<(Vec3<Enu>, f64)> =
        scenario.tasks.iter().flat_map(|task| task.path_m.iter().map(|point| (*point, task.threshold_m))).collect();
    points.sort_by(|a, b| (a.0 - defect.position_m).norm().total_cmp(&(b.0 - defect.position_m).norm()));
    let closer = |(point, threshold): &(Vec3<Enu>, f64)| {
        let way = defect.position_m - *point;
        [0.0, 0.45, 0.9].map(|share| *point + way.unit() * (share * threshold).min((way.norm() - 1.0).max(0.0)))
    };
    points.iter().take(60).flat_map(closer).find_map(|place| {
        let to = (defect.position_m - place).unit();
        let (yaw, pitch) = (math::atan2(to.east(), to.north()), math::asin(to.up()));
        let right = Vec3::new(math::cos(yaw), -math::sin(yaw), 0.0);
        let pose = CameraPose { position_m: place, forward: to, right, lamp_on: true };
        let views = site.view_defects(&pose, &vehicle.camera, &vehicle.lamp, spandrel_model::time::SimTime::from_ms(60_000));
        views.iter().any(|view| view.defect_id == defect.id && view.hit).then_some((place, yaw, pitch))
    })
}

#[test]
fn flight_pictures_of_shipped_defects_are_hits() {
    let (scenario, vehicle) = shipped();
    let site = build_site(&scenario, spandrel_testkit::job::SEED);
    let defects = site.defects().to_vec();
    assert_eq!(defects.len(), scenario.defects.count);
    let stands: Vec<_> = defects.iter().filter_map(|defect| viewpoint(defect, &scenario, &vehicle, site.as_ref())).collect();
    assert!(stands.len() >= 8, "found viewpoints for only {} of {} defects", stands.len(), defects.len());
    let mut tape = Tape::of(&scenario);
    let pad = tape.at_m;
    tape.fly((pad.east(), pad.north(), pad.up() + 5.0), 2.0);
    tape.lamp(true);
    for (index, (place, yaw, pitch)) in stands.iter().enumerate() {
        tape.yaw_rad = *yaw;
        tape.fly((place.east(), place.north(), place.up()), 4.0);
        tape.gimbal(*pitch);
        tape.hold(0.5);
        tape.snapshot(i32::try_from(index).unwrap());
        tape.hold(0.1);
    }
    let log = tape.log(0);
    let assessed_session = assess_log(&log, &scenario, &vehicle, |_, _| site.clone()).unwrap();
    let snapshots = &assessed_session.assessment.snapshots;
    assert_eq!(snapshots.taken, stands.len());
    // Positions are sent with a resolution of 1 cm, so one picture near a limit may fail.
    assert!(snapshots.defects_found + 1 >= stands.len(), "{} found, {:#?}", snapshots.defects_found, snapshots.each);
    let exported = serde_json::to_value(export::ScenarioExport::new(&scenario, &defects)).unwrap();
    assert_eq!(exported["tasks"].as_array().unwrap().len(), 4);
}

#[test]
fn flight_along_shipped_paths_has_full_conformity() {
    let (scenario, vehicle) = shipped();
    let site = build_site(&scenario, spandrel_testkit::job::SEED);
    let mut tape = Tape::of(&scenario);
    let pad = tape.at_m;
    tape.fly((pad.east(), pad.north(), pad.up() + 5.0), 2.0);
    for task in &scenario.tasks {
        let around = if task.closed { task.path_m.first() } else { None };
        for point in task.path_m.iter().chain(around) {
            tape.fly((point.east(), point.north(), point.up()), 4.0);
        }
        // Flies sideways and up first so that no transit crosses a task's path.
        let [e, n, u] = tape.at_m.array();
        let side = if n < -5.0 || task.closed { -40.0 } else { 40.0 };
        tape.fly((e, n + side, u), 4.0);
        tape.fly((e, n + side, 60.0), 4.0);
        tape.fly((0.0, 60.0, 60.0), 10.0);
    }
    let [e, n, u] = pad.array();
    tape.fly((e, n, u + 5.0), 4.0);
    tape.fly((e, n, u), 0.8);
    tape.hold(4.0);
    let assessed_session = assess_log(&tape.log(0), &scenario, &vehicle, |_, _| site.clone()).unwrap();
    let assessment = &assessed_session.assessment;
    assert!(assessment.tasks.iter().all(|task| task.attempted && task.speeding == 0.0), "{:?}", assessment.tasks);
    for (task, visits) in assessment.tasks.iter().zip(&assessment.certification.tasks) {
        assert!(task.on_path == 1.0 && visits.on_path == 1.0, "{task:?} {visits:?}");
        assert!(visits.coverage > 0.99, "{visits:?}");
    }
    assert_eq!(assessment.scores.conformity.unwrap().pct, 100.0);
    assert_eq!(assessment.scores.efficiency.pct, 100.0);
    assert_eq!(assessment.end.reason, spandrel_monitor::session::EndReason::Landed);
}

#[test]
fn regress_defects_are_placed_on_free_tasks_at_a_bridge() {
    let (mut scenario, _) = shipped();
    // Specifies the slab task's path point by point. Such a task has no bridge or viewing direction.
    let mut free = scenario.tasks[0].clone();
    (free.kind, free.bridge, free.viewing_directions) =
        (spandrel_model::scenario::TaskKind::Free, None, vec![Vec3::new(1.0, 0.0, 0.0); free.path_m.len()]);
    scenario.tasks = vec![free];
    scenario.defects.count = 4;
    for seed in 1..=3 {
        let site = build_site(&scenario, seed);
        assert_eq!(site.defects().len(), 4, "seed {seed}");
        assert!(
            site.defects().iter().all(|defect| scenario.bridges.iter().any(|bridge| defect.member.starts_with(&bridge.name)))
        );
    }
}

#[test]
fn regress_values_near_limits_are_shown_with_enough_digits() {
    let view = spandrel_model::site::DefectView {
        defect_id: 1,
        in_frame: true,
        unoccluded: true,
        incidence_rad: 60.3_f64.to_radians(),
        extent_px: 9.96,
        width_px: 0.498,
        illuminance_lux: 49.7,
        required_illuminance_lux: 50.0,
        distance_m: 3.0,
        hit: false,
        lamp_on: true,
        line: true,
    };
    assert_eq!(
        view.reasons(),
        [
            "too oblique: 60.3 deg, limit 60 deg",
            "too small: 9.96 px, at least 10 px",
            "line too thin: 0.498 px, at least 0.5 px",
            "too dark: lamp on, 49.7 lx of 50 lx needed",
        ]
    );
}
