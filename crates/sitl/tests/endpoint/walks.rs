//! Walks of the inspector: the command, its refusals, and the feed from which every subscriber computes the same position.

use spandrel_mavlink::contract::named_values::NamedValue;
use spandrel_mavlink::contract::practice::PracticeRequest;
use spandrel_mavlink::contract::walk::WalkRequest;
use spandrel_mavlink::dialect::*;
use spandrel_model::frames::Vec3;
use spandrel_model::scenario::Scenario;
use spandrel_model::site::changes::SiteChanges;
use spandrel_model::site::inspector_path::WALKING_SPEED_M_S;
use spandrel_model::site::inspector_walks::InspectorWalks;
use spandrel_model::site::traffic::INSPECTOR;
use spandrel_model::site::{Site, Surface};
use spandrel_model::time::SimTime;
use spandrel_testkit::shipped::scenario;
use spandrel_testkit::station::{Station, one};

const SEED: u64 = 7;
/// Largest distance that the inspector walks in two time steps of the codes, m.
const CODE_STEP_M: f64 = 0.02 * WALKING_SPEED_M_S;

/// Returns a job on flat ground in which the inspector can walk 28 m to the north or 14 m to the east of place 1.
fn job() -> Scenario {
    let mut job = scenario("drill-hover");
    let here_m = job.ground_team.inspector_m;
    job.ground_team.places_m = vec![here_m + Vec3::new(0.0, -28.0, 0.0), here_m + Vec3::new(-14.0, 0.0, 0.0)];
    job
}

fn airborne() -> Station {
    let mut station = Station::of(job(), "phantom2", SEED);
    station.climb_manually();
    station
}

fn walk(station: &mut Station, place: u8) -> MavResult {
    let (command, params) = WalkRequest { place }.command();
    station.command(1, command, params)
}

fn codes(station: &Station) -> Vec<i32> {
    station.all(|message| match NamedValue::of(message) {
        Some(NamedValue::Walk(code)) => Some(code),
        _ => None,
    })
}

#[test]
fn wire_telemetry_reproduces_the_walks() {
    let job = job();
    let mut station = Station::of(job.clone(), "phantom2", SEED);
    station.run_ms(11_000);
    assert!(codes(&station).is_empty(), "an inspector who stays is not reported");
    let mut sent = Vec::new();
    for (place, wait_ms) in [(2, 12_000), (3, 5_000), (1, 30_000), (2, 8_000)] {
        assert_eq!(walk(&mut station, place), MavResult::MAV_RESULT_ACCEPTED);
        station.run_ms(20);
        sent.extend(codes(&station));
        station.run_ms(wait_ms);
        sent.extend(codes(&station));
        // A program that has the scenario and the telemetry must be able to compute the same position.
        let walks = InspectorWalks::from_codes(sent.iter().copied());
        let theirs = Site::without_defects(&job).with_changes(SiteChanges { walks, ..SiteChanges::default() });
        let (now, own) = (station.sim.now(), station.sim.site().inspector());
        assert_eq!(theirs.inspector().walks(), own.walks());
        assert_eq!(theirs.inspector().at(now), own.at(now));
        // The body is where the inspector is.
        let chest_m = own.at(now).feet_m + Vec3::new(0.0, 0.0, 1.2);
        let near = station.sim.site().nearest(chest_m, 1.0, now).expect("the body");
        assert_eq!((near.object, near.surface), (INSPECTOR, Surface::Person));
    }
    let there = station.sim.site().inspector().at(station.sim.now());
    let walked_m = (there.feet_m - job.ground_team.inspector_m).norm();
    assert!((walked_m - 8.02 * WALKING_SPEED_M_S).abs() < CODE_STEP_M && there.walks(), "{walked_m} m of the last walk");
    // A late subscriber gets the last walk again.
    station.received.clear();
    station.run_ms(5_100);
    assert_eq!(codes(&station).len(), 1, "{:?}", codes(&station));
}

#[test]
fn wire_invalid_walks_are_denied_with_a_reason() {
    let mut station = Station::of(job(), "phantom2", SEED);
    station.run_ms(2_000);
    for (place, text) in [(4, "No place 4 (allowed: 1 to 3)"), (9, "Walk: parameter 1 must be 1 to 8")] {
        assert_eq!(walk(&mut station, place), MavResult::MAV_RESULT_DENIED);
        station.run_ms(20);
        assert!(station.has_text(text), "{:?}", station.texts());
    }
    assert_eq!(station.command(1, MavCmd::MAV_CMD_USER_4, one(1.5)), MavResult::MAV_RESULT_DENIED);
    assert_eq!(walk(&mut station, 1), MavResult::MAV_RESULT_ACCEPTED, "the inspector is there already");
    station.run_ms(10_000);
    assert!(codes(&station).is_empty() && station.sim.site().inspector().walks().is_empty());
    let mut alone = Station::new("drill-hover", SEED);
    alone.run_ms(2_000);
    assert_eq!(walk(&mut alone, 2), MavResult::MAV_RESULT_DENIED);
    alone.run_ms(20);
    assert!(alone.has_text("Walk: this job has only place 1"), "{:?}", alone.texts());
}

/// Time never goes back in a rewind, so the inspector goes on from the present; a frozen flight stops the inspector as well.
#[test]
fn flight_walks_stop_in_a_freeze_and_stay_in_a_rewind() {
    let mut station = airborne();
    assert_eq!(walk(&mut station, 2), MavResult::MAV_RESULT_ACCEPTED);
    station.run_ms(5_000);
    let feet = |station: &Station| station.sim.site().inspector().at(station.sim.now()).feet_m;
    let request = |station: &mut Station, request: PracticeRequest| {
        let (command, params) = request.command(0);
        assert_eq!(station.command(1, command, params), MavResult::MAV_RESULT_ACCEPTED);
    };
    request(&mut station, PracticeRequest::Freeze);
    let before = feet(&station);
    station.run_ms(10_000);
    assert_eq!(feet(&station), before);
    assert_eq!(walk(&mut station, 1), MavResult::MAV_RESULT_ACCEPTED);
    request(&mut station, PracticeRequest::Resume);
    station.run_ms(1_000);
    assert!((feet(&station) - before).norm() > 1.0, "the inspector turns when the flight continues");
    let before = feet(&station);
    request(&mut station, PracticeRequest::Rewind { by: SimTime::from_ms(3_000) });
    station.run_ms(200);
    assert!((feet(&station) - before).norm() < 0.3, "the rewind moves only the aircraft");
}

#[test]
fn flight_walks_are_reproducible() {
    let start = airborne();
    let flown = |mut station: Station, walks: bool| {
        for place in [2, 3, 1] {
            if walks {
                walk(&mut station, place);
            }
            station.run_ms(2_000);
        }
        (station.sim.digest(), station.sim.site().inspector().walks().clone(), station.sim.truth().clone())
    };
    let walked = flown(start.clone(), true);
    assert_eq!(walked, flown(start.clone(), true), "from a snapshot");
    let stayed = flown(start, false);
    assert!(walked.0 != stayed.0 && stayed.1.is_empty());
}
