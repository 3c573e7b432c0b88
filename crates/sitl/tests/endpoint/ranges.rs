//! Range finder telemetry: it must match the site's distances in each direction, at positions with an obstacle in every
//! direction.

use spandrel_mavlink::dialect::*;
use spandrel_model::frames::{Enu, Frd, Vec3};
use spandrel_model::math;
use spandrel_model::scenario::Scenario;
use spandrel_model::site::Site;
use spandrel_model::time::SimTime;
use spandrel_testkit::shipped::scenario;
use spandrel_testkit::station::Station;
use std::f64::consts::FRAC_PI_4;

/// Five sigma of noise (2 cm) and bias (1 cm) combined, plus the resolution of the message (1 cm), m; the drone does
/// not move.
const TOLERANCE_M: f64 = 0.12;
const MAX_RANGE_M: f64 = 10.0;

/// Returns the directions of the range finders: down, up, then clockwise from the nose.
fn finders() -> Vec<(MavSensorOrientation, Vec3<Frd>)> {
    use MavSensorOrientation as O;
    let around = [
        O::MAV_SENSOR_ROTATION_NONE,
        O::MAV_SENSOR_ROTATION_YAW_45,
        O::MAV_SENSOR_ROTATION_YAW_90,
        O::MAV_SENSOR_ROTATION_YAW_135,
        O::MAV_SENSOR_ROTATION_YAW_180,
        O::MAV_SENSOR_ROTATION_YAW_225,
        O::MAV_SENSOR_ROTATION_YAW_270,
        O::MAV_SENSOR_ROTATION_YAW_315,
    ];
    let vertical = [
        (O::MAV_SENSOR_ROTATION_PITCH_270, Vec3::new(0.0, 0.0, 1.0)),
        (O::MAV_SENSOR_ROTATION_PITCH_90, Vec3::new(0.0, 0.0, -1.0)),
    ];
    let beside = around.into_iter().enumerate().map(|(k, orientation)| {
        let (sin, cos) = math::sin_cos(k as f64 * FRAC_PI_4);
        (orientation, Vec3::new(cos, sin, 0.0))
    });
    vertical.into_iter().chain(beside).collect()
}

/// Returns the job without traffic, with its pad at the given position and the drone at the given heading.
fn placed_at(base: &Scenario, position_m: Vec3<Enu>, heading_deg: f64) -> Scenario {
    let mut job = base.clone();
    (job.traffic.cars, job.traffic.trucks, job.traffic.pedestrians) = (0, 0, 0);
    job.ground_team.pad_m = position_m;
    job.ground_team.pad_heading_deg = heading_deg;
    job
}

/// Returns, for each task, the position on its path with the most surfaces within range. The pad is placed there in
/// mid-air.
fn positions_near_objects(job: &Scenario, site: &Site) -> Vec<Vec3<Enu>> {
    let hits = |place: &Vec3<Enu>| {
        let level = |k: usize| {
            let (sin, cos) = math::sin_cos(k as f64 * FRAC_PI_4);
            Vec3::new(sin, cos, 0.0)
        };
        let beside = (0..8).filter(|k| site.ray(*place, level(*k), MAX_RANGE_M, SimTime::ZERO).is_some()).count();
        let over = site.ray(*place, Vec3::new(0.0, 0.0, 1.0), MAX_RANGE_M, SimTime::ZERO).is_some();
        beside + if over { 2 } else { 0 }
    };
    job.tasks.iter().filter_map(|task| task.path_m.iter().copied().max_by_key(hits)).collect()
}

/// Returns the distances in DISTANCE_SENSOR and OBSTACLE_DISTANCE and their maximum range, in meters.
fn reported_range(station: &Station, orientation: MavSensorOrientation) -> (f64, f64) {
    let found = station.last_message(|m| match m {
        MavMessage::DISTANCE_SENSOR(d) if d.orientation == orientation => {
            Some((f64::from(d.current_distance) / 100.0, f64::from(d.max_distance) / 100.0))
        }
        _ => None,
    });
    found.unwrap_or_else(|| panic!("no data for {orientation:?}"))
}

fn assert_range(told: f64, there: Option<f64>, what: &str) {
    match there {
        Some(distance) if distance < MAX_RANGE_M - TOLERANCE_M => {
            assert!((told - distance).abs() < TOLERANCE_M, "{what}: {told} instead of {distance}");
        }
        Some(_) => assert!(told > MAX_RANGE_M - 2.0 * TOLERANCE_M, "{what}: {told} near the maximum range"),
        None => assert!(told > MAX_RANGE_M, "{what}: {told} without an obstacle"),
    }
}

#[test]
fn wire_range_finders_report_the_distance_in_their_direction() {
    let base = scenario("two-bridges");
    let places = positions_near_objects(&base, &Site::build(&base, 7));
    let mut met = [0; 10];
    for (place, heading_deg) in places.iter().flat_map(|place| [0.0, 130.0, 250.0].map(|heading| (*place, heading))) {
        let job = placed_at(&base, place, heading_deg);
        let site = Site::build(&job, 7);
        let mut station = Station::of(job, "phantom2", 7);
        station.run_ms(1_500);
        let (truth, now) = (station.sim.truth().rigid, station.sim.now());
        let ray = |direction: Vec3<Frd>| {
            let way: Vec3<Enu> = (truth.attitude * direction).enu();
            site.ray(truth.position_m.enu(), way, MAX_RANGE_M, now).map(|hit| hit.distance_m)
        };
        let map =
            station.last_message(|m| if let MavMessage::OBSTACLE_DISTANCE(o) = m { Some(o.clone()) } else { None }).unwrap();
        assert_eq!((map.frame, map.angle_offset, map.increment_f), (MavFrame::MAV_FRAME_BODY_FRD, 0.0, 5.0));
        assert_eq!(map.increment, 5, "QGroundControl reads 72 sectors of 5 deg");
        assert_eq!((map.min_distance, f64::from(map.max_distance) / 100.0), (10, MAX_RANGE_M));
        for (sector, slot) in map.distances.iter().enumerate() {
            let nearest = (5.0 * sector as f64 / 45.0).round() as usize % 8;
            assert_eq!(*slot, map.distances[9 * nearest], "sector {sector}");
        }
        for (k, (orientation, direction)) in finders().into_iter().enumerate() {
            let there = ray(direction);
            let what = format!("{orientation:?} at {place:?} heading {heading_deg}");
            let (distance, reach) = reported_range(&station, orientation);
            assert_eq!(reach, MAX_RANGE_M);
            assert_range(distance, there, &what);
            if let Some(sector) = k.checked_sub(2) {
                assert_range(f64::from(map.distances[9 * sector]) / 100.0, there, &what);
            }
            met[k] += usize::from(there.is_some_and(|distance| distance < MAX_RANGE_M - TOLERANCE_M));
        }
    }
    assert!(met.iter().all(|times| *times >= 2), "the test must cover obstacles in every direction: {met:?}");
}

#[test]
fn wire_range_finder_rates_are_set_per_link() {
    let mut station = Station::new("drill-hover", 7);
    station.run_ms(1_000);
    let count = |station: &mut Station| {
        station.received.clear();
        station.run_ms(10_000);
        let of = |orientation| {
            station.all(|m| matches!(m, MavMessage::DISTANCE_SENSOR(d) if d.orientation == orientation).then_some(())).len()
        };
        let map = station.all(|m| matches!(m, MavMessage::OBSTACLE_DISTANCE(_)).then_some(())).len();
        [of(MavSensorOrientation::MAV_SENSOR_ROTATION_PITCH_270), of(MavSensorOrientation::MAV_SENSOR_ROTATION_YAW_225), map]
    };
    assert_eq!(count(&mut station), [50, 20, 50]);
    let every = |id: f32, us: f32| [id, us, 0.0, 0.0, 0.0, 0.0, 0.0];
    station.command(1, MavCmd::MAV_CMD_SET_MESSAGE_INTERVAL, every(132.0, 1e6));
    station.command(1, MavCmd::MAV_CMD_SET_MESSAGE_INTERVAL, every(330.0, -1.0));
    assert_eq!(count(&mut station), [10, 10, 0]);
}
