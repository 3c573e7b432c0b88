//! Freeze and rewind: time stops and never goes back, the aircraft continues from where it was, and an assessment refuses both.

use spandrel_mavlink::contract::named_values::NamedValue;
use spandrel_mavlink::contract::practice::PracticeRequest;
use spandrel_mavlink::contract::truth::clock;
use spandrel_mavlink::dialect::*;
use spandrel_model::time::SimTime;
use spandrel_sitl::endpoint::flavor;
use spandrel_sitl::physics::{PhysicsState, RigidState};
use spandrel_sitl::sim::Sim;
use spandrel_testkit::station::{Station, one, p};

const SEED: u64 = 7;
/// Largest error of the estimated position, m: twice the horizontal noise of the receiver.
const MAX_ESTIMATE_ERROR_M: f64 = 3.0;
/// Largest motion in the 0.1 s before the freeze, m (estimate: a gust on a hovering aircraft).
const MAX_RUN_ON_DRIFT_M: f64 = 0.1;

/// Asks the vehicle to freeze, resume or rewind. Returns the result of its acknowledgment, which must arrive even if time stops.
fn ask(station: &mut Station, request: PracticeRequest) -> MavResult {
    let (command, params) = request.command(0);
    station.command(1, command, params)
}

fn rewind(s: i64) -> PracticeRequest {
    PracticeRequest::Rewind { by: SimTime::from_ms(1_000 * s) }
}

/// Flies with constant sticks for a time in ms. Does nothing while the flight is frozen, as [`Station::run_ms`] does.
fn fly(station: &mut Station, sticks: [i16; 4], ms: i64) {
    for _ in 0..ms / 20 {
        let [forward, right, z, yaw] = sticks;
        station.sticks(forward, right, z, yaw);
        station.run_ms(20);
    }
}

fn named(station: &Station, pick: impl Fn(NamedValue) -> Option<i32>) -> Vec<i32> {
    station.all(|message| NamedValue::of(message).and_then(&pick))
}

fn frozen_values(station: &Station) -> Vec<i32> {
    named(station, |value| if let NamedValue::Frozen(on) = value { Some(i32::from(on)) } else { None })
}

/// Returns the timestamps of the ground truth, which clients use as the clock.
fn truth_times(station: &Station) -> Vec<SimTime> {
    station.all(|m| if let MavMessage::HIL_STATE_QUATERNION(truth) = m { Some(clock(truth.time_usec)) } else { None })
}

fn hex(sim: &Sim) -> String {
    sim.digest().iter().map(|byte| format!("{byte:02x}")).collect()
}

/// Returns what a rewind must restore exactly.
fn motion(state: &PhysicsState) -> (RigidState, f64) {
    (state.rigid, state.battery.charge)
}

#[test]
fn wire_frozen_vehicle_stops_time_and_answers() {
    let mut station = Station::airborne("drill-hover", SEED);
    let accepted = MavResult::MAV_RESULT_ACCEPTED;
    assert_eq!(ask(&mut station, PracticeRequest::Freeze), accepted);
    assert!(station.sim.is_frozen() && station.has_text("Frozen"), "{:?}", station.texts());
    assert_eq!(frozen_values(&station), [1]);
    let (now, before) = (station.sim.now(), station.sim.truth().clone());
    station.received.clear();
    station.run_ms(20_000);
    assert!(station.received.is_empty(), "without time, nothing is due: {:?}", station.received);
    for _ in 0..3 {
        station.sim.pause(false);
    }
    // More datagrams than one tick may process must not block the request that ends the freeze.
    for _ in 0..40 {
        station.sticks(300, 0, 500, 0);
        station.run_ms(1);
    }
    let beats = station.received.iter().filter(|f| f.component_id == 1 && matches!(f.message, Some(MavMessage::HEARTBEAT(_))));
    assert_eq!((beats.count(), frozen_values(&station)), (3, vec![1; 3]));
    assert!(station.sim.is_frozen(), "sticks do not end a freeze");
    assert_eq!((station.sim.now(), station.sim.truth()), (now, &before));
    let read = MavMessage::PARAM_REQUEST_READ(PARAM_REQUEST_READ_DATA {
        target_system: 1,
        target_component: 1,
        param_id: "MPC_XY_VEL_MAX".into(),
        param_index: -1,
    });
    let value = station.ask(&read, |m| if let MavMessage::PARAM_VALUE(v) = m { Some(v.param_value) } else { None });
    assert!(value.is_some(), "parameters are answered");
    assert_eq!(ask(&mut station, PracticeRequest::Freeze), accepted, "a repeated request changes nothing");
    assert_eq!(ask(&mut station, PracticeRequest::Resume), accepted);
    assert!(station.has_text("Continued"), "{:?}", station.texts());
    let freezes = named(&station, |value| if let NamedValue::Freezes(count) = value { Some(count) } else { None });
    assert_eq!((freezes, frozen_values(&station)), (vec![1], vec![0]));
    station.run_ms(100);
    assert_eq!(station.sim.now(), now + SimTime::from_ms(102), "2 ms passed with the request");
}

#[test]
fn flight_freeze_does_not_change_the_flight() {
    let start = Station::airborne("drill-hover", SEED);
    let flown = |freezes: bool| {
        let mut station = start.clone();
        fly(&mut station, [400, -300, 600, 200], 2_000);
        // The inputs of both flights are the same; only one of them is frozen in between.
        let requests = if freezes { [PracticeRequest::Freeze, PracticeRequest::Resume] } else { [PracticeRequest::Resume; 2] };
        for request in requests {
            let (command, params) = request.command(0);
            station.send(&MavMessage::COMMAND_LONG(spandrel_mavlink::station::command(1, 1, command, params)));
            let now = station.sim.now();
            station.sim.handle_timeout(now);
        }
        fly(&mut station, [400, -300, 600, 200], 2_000);
        (station.sim.truth().clone(), station.sim.now())
    };
    assert_eq!(flown(true), flown(false));
}

/// Flies fast, stops, and rewinds: the aircraft has its earlier motion and battery charge, time goes on, the estimator agrees
/// with the truth, and the flight continues.
#[test]
fn flight_rewind_restores_the_motion_and_the_flight_continues() {
    let mut station = Station::airborne("drill-hover", SEED);
    fly(&mut station, [700, 0, 550, 0], 4_000);
    // The vehicle keeps its state at each whole second.
    let to_second_ms = 1_000 - station.sim.now().ms() % 1_000;
    station.run_ms(to_second_ms);
    let (at, earlier) = (station.sim.now(), motion(station.sim.truth()));
    fly(&mut station, [700, 400, 500, 0], 5_000);
    fly(&mut station, [0, 0, 500, 0], 3_000);
    let request = PracticeRequest::Rewind { by: station.sim.now() - at };
    station.received.clear();
    let before = station.sim.now();
    let (command, params) = request.command(0);
    station.send(&MavMessage::COMMAND_LONG(spandrel_mavlink::station::command(1, 1, command, params)));
    station.sim.handle_timeout(before);
    assert_eq!((motion(station.sim.truth()), station.sim.now()), (earlier, before));
    assert!(earlier.0.velocity_m_s.norm() > 2.0, "{earlier:?}");
    station.run_ms(1_000);
    assert!(station.sim.is_frozen() && station.has_text("Frozen: move a stick"), "{:?}", station.texts());
    assert_eq!(station.sim.now(), before + SimTime::from_ms(100));
    fly(&mut station, [0, 0, 500, 0], 200);
    assert!(station.sim.is_frozen(), "centered sticks do not continue the flight");
    fly(&mut station, [0, 200, 500, 0], 1_000);
    assert!(!station.sim.is_frozen());
    fly(&mut station, [0, 0, 500, 0], 5_000);
    let truth = station.sim.truth().rigid;
    let estimate = station.site_position_m();
    let error_m = truth.position_m.array().iter().zip(estimate).map(|(a, b)| (a - b) * (a - b)).sum::<f64>().sqrt();
    assert!(error_m < MAX_ESTIMATE_ERROR_M, "{error_m} m");
    assert!(truth.velocity_m_s.norm() < 0.5 && station.sim.armed(), "{truth:?}");
    let times = truth_times(&station);
    assert!(times.windows(2).all(|pair| pair[0] < pair[1]), "time must rise");
    assert!(times.iter().filter(|time| **time > before).count() > 5, "clients receive the new position before time stops");
    let rewinds = named(&station, |value| if let NamedValue::Rewinds(count) = value { Some(count) } else { None });
    assert_eq!(rewinds.first(), Some(&1), "{rewinds:?}");
}

/// A stick that is held during the rewind must be centered before it can continue the flight.
#[test]
fn flight_held_stick_does_not_end_the_freeze() {
    let mut station = Station::airborne("drill-hover", SEED);
    fly(&mut station, [0, 0, 500, 0], 6_000);
    fly(&mut station, [800, 0, 500, 0], 1_000);
    assert_eq!(ask(&mut station, rewind(5)), MavResult::MAV_RESULT_ACCEPTED);
    fly(&mut station, [800, 0, 500, 0], 1_000);
    assert!(station.sim.is_frozen());
    fly(&mut station, [0, 0, 500, 0], 100);
    assert!(station.sim.is_frozen());
    fly(&mut station, [0, 0, 500, 800], 100);
    assert!(!station.sim.is_frozen());
}

/// Each further request goes farther back, and nothing is older than the first seconds in the air.
#[test]
fn flight_repeated_rewinds_go_back_step_by_step() {
    let mut station = Station::airborne("drill-hover", SEED);
    let mut places = Vec::new();
    for _ in 0..12 {
        fly(&mut station, [300, 0, 500, 0], 1_000);
        places.push(station.sim.truth().rigid.position_m);
    }
    let from_first = |station: &Station| (station.sim.truth().rigid.position_m - places[0]).norm();
    let mut distances = vec![from_first(&station)];
    for _ in 0..4 {
        assert_eq!(ask(&mut station, rewind(4)), MavResult::MAV_RESULT_ACCEPTED);
        station.run_ms(200);
        distances.push(from_first(&station));
    }
    let steps: Vec<f64> = distances.windows(2).map(|pair| pair[0] - pair[1]).collect();
    assert!(steps[..2].iter().all(|step| *step > 2.0), "{distances:?}");
    let rewinds = named(&station, |value| if let NamedValue::Rewinds(count) = value { Some(count) } else { None });
    assert_eq!(rewinds.last(), Some(&4));
    let heights = station.sim.truth().rigid.position_m.enu().up() - station.sim.site().ground_up_m(0.0, 0.0);
    assert!(heights > 1.0, "still in the air: {heights} m");
}

/// A crash and its respawn are undone as well: the flight continues before the crash.
#[test]
fn flight_rewind_after_a_crash_continues_before_it() {
    let mut station = Station::airborne("drill-hover", SEED);
    fly(&mut station, [0, 0, 500, 0], 6_000);
    let place = station.sim.truth().rigid.position_m;
    let stop = p(&[0.0, 21_196.0]);
    assert_eq!(station.command(1, MavCmd::MAV_CMD_COMPONENT_ARM_DISARM, stop), MavResult::MAV_RESULT_ACCEPTED);
    fly(&mut station, [0, 0, 500, 0], 2_500);
    assert!((station.sim.truth().rigid.position_m - place).norm() > 3.0, "the aircraft must have fallen");
    assert_eq!(ask(&mut station, rewind(5)), MavResult::MAV_RESULT_ACCEPTED);
    station.run_ms(1_000);
    assert_eq!(ask(&mut station, PracticeRequest::Resume), MavResult::MAV_RESULT_ACCEPTED);
    fly(&mut station, [0, 0, 500, 0], 5_000);
    let away_m = (station.sim.truth().rigid.position_m - place).norm();
    assert!(station.sim.armed() && away_m < 2.0, "{away_m} m, {:?}", station.texts());
}

/// The acknowledgment of a rewind is lost, and the sender repeats the command.
#[test]
fn regress_a_repeated_rewind_goes_back_once() {
    let mut station = Station::airborne("drill-hover", SEED);
    fly(&mut station, [500, 0, 500, 0], 9_000);
    let (command, params) = rewind(3).command(17);
    let mut rewinds = Vec::new();
    for _ in 0..2 {
        assert_eq!(station.command(1, command, params), MavResult::MAV_RESULT_ACCEPTED);
        station.run_ms(500);
        rewinds.extend(named(&station, |value| if let NamedValue::Rewinds(count) = value { Some(count) } else { None }));
    }
    assert_eq!(rewinds.last(), Some(&1), "{:?}", station.texts());
    let (command, params) = rewind(3).command(18);
    assert_eq!(station.command(1, command, params), MavResult::MAV_RESULT_ACCEPTED);
    station.run_ms(500);
    let rewinds = named(&station, |value| if let NamedValue::Rewinds(count) = value { Some(count) } else { None });
    assert_eq!(rewinds.last(), Some(&2), "another request");
    assert_eq!(station.command(1, command, p(&[3.0, 0.5])), MavResult::MAV_RESULT_DENIED);
    // The text follows when time continues.
    fly(&mut station, [0, 0, 500, 0], 500);
    fly(&mut station, [500, 0, 500, 0], 1_000);
    assert!(station.has_text("Parameter 2 must be"), "{:?}", station.texts());
}

#[test]
fn wire_requests_are_refused_with_a_reason() {
    let denied = MavResult::MAV_RESULT_DENIED;
    let mut station = Station::new("drill-hover", SEED);
    station.run_ms(2_500);
    assert_eq!(ask(&mut station, rewind(10)), denied);
    assert!(station.has_text("Rejected: not flown yet"), "{:?}", station.texts());
    for (command, param) in [(MavCmd::MAV_CMD_USER_1, 3.0), (MavCmd::MAV_CMD_USER_2, 31.0)] {
        assert_eq!(station.command(1, command, one(param)), denied);
        assert!(station.has_text("parameter 1 must be"), "{:?}", station.texts());
    }
    let mut station = Station::airborne("drill-hover", SEED);
    fly(&mut station, [0, 0, 500, 0], 3_000);
    station.sim.forbid_freeze_and_rewind();
    for request in [PracticeRequest::Freeze, PracticeRequest::Resume, rewind(2)] {
        assert_eq!(ask(&mut station, request), denied);
        assert!(station.has_text("No freeze or rewind in an assessment"), "{:?}", station.texts());
    }
    assert!(!station.sim.is_frozen());
}

/// The same requests at the same ticks give the same flight, from the start and from a snapshot.
#[test]
fn flight_freezes_and_rewinds_are_reproducible() {
    let start = Station::airborne("two-bridges", SEED);
    let flown = |mut station: Station, waits: usize| {
        fly(&mut station, [500, 0, 550, 0], 6_000);
        for request in [PracticeRequest::Freeze, rewind(4), PracticeRequest::Resume] {
            ask(&mut station, request);
            // The flight does not depend on how long it was frozen.
            (0..waits).for_each(|_| station.run_ms(500));
        }
        fly(&mut station, [0, 500, 500, 0], 4_000);
        hex(&station.sim)
    };
    let one = flown(start.clone(), 1);
    assert_eq!(flown(start, 1), one);
}

/// Clients that ask for their own streams learn about a freeze as well.
#[test]
fn wire_copter_station_learns_that_the_flight_is_frozen() {
    let mut station = Station::with_flavor(&flavor::ardupilot::FLAVOR, "drill-hover", SEED);
    station.run_ms(3_000);
    assert_eq!(ask(&mut station, PracticeRequest::Freeze), MavResult::MAV_RESULT_ACCEPTED);
    assert_eq!(frozen_values(&station), [1]);
}

#[test]
fn flight_move_to_a_task_hovers_at_its_start_until_a_stick_moves() {
    let mut station = Station::airborne("drill-orbit", SEED);
    fly(&mut station, [0, 0, 600, 0], 2_000);
    let start = spandrel_model::scenario::read("drill-orbit.toml", spandrel_model::shipped::DRILL_ORBIT, &|_| Err(String::new()));
    let start = start.unwrap().tasks[0].path_m[0].ned();
    let charge = station.sim.truth().battery.charge;
    assert_eq!(ask(&mut station, PracticeRequest::MoveToTask { task: 2 }), MavResult::MAV_RESULT_DENIED);
    assert!(station.has_text("No task 2 (allowed: 1 to 1)"), "{:?}", station.texts());
    assert_eq!(ask(&mut station, PracticeRequest::MoveToTask { task: 1 }), MavResult::MAV_RESULT_ACCEPTED);
    station.run_ms(1_000);
    assert!(station.sim.is_frozen() && station.has_text("At the start of task 1"), "{:?}", station.texts());
    let distance_m = |station: &Station| (station.sim.truth().rigid.position_m - start).norm();
    assert!(distance_m(&station) < MAX_RUN_ON_DRIFT_M, "{} m", distance_m(&station));
    assert!((station.sim.truth().battery.charge - charge).abs() < 1e-3, "the battery is that of the present");
    let rewinds = named(&station, |value| if let NamedValue::Rewinds(count) = value { Some(count) } else { None });
    assert_eq!(rewinds.last(), Some(&1));
    fly(&mut station, [0, 0, 500, 0], 100);
    fly(&mut station, [0, 0, 500, 300], 100);
    assert!(!station.sim.is_frozen(), "a stick resumes the flight");
    fly(&mut station, [0, 0, 500, 0], 5_000);
    assert!(distance_m(&station) < MAX_ESTIMATE_ERROR_M, "{} m", distance_m(&station));
}
