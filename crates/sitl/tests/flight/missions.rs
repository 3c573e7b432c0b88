//! Missions: planned trajectory through waypoints, takeoffs, speeds.

use spandrel_model::frames::{Ned, Vec3};
use spandrel_model::random::RandomStream;
use spandrel_sitl::autopilot::trajectory::{AccelerationLimits, SpeedLimits, Trajectory, TrajectoryPoint, Waypoint};
use spandrel_sitl::autopilot::{AutopilotRequest, FlightMode, LandedState, MissionStep};
use spandrel_testkit::bench::{Bench, VEHICLES};
use spandrel_testkit::shipped::vehicle;

const STEP_S: f64 = 0.0025;
const SPEEDS: SpeedLimits = SpeedLimits { default_speed_m_s: 5.0, max_m_s: 12.0, up_m_s: 3.0, down_m_s: 1.5 };
/// Maximum acceleration, m/s²: along and across the leg combined, each limited to 2.
const MAX_ACCELERATION_M_S2: f64 = 3.0;
/// Maximum jerk, m/s³: 4 for the speed and 2.5 for the corner, plus the effect of speed changes within a corner.
const MAX_JERK_M_S3: f64 = 10.0;

fn point(north: f64, east: f64, up: f64) -> MissionStep {
    MissionStep::Waypoint { position_m: Vec3::new(north, east, -up), acceptance_radius_m: 0.0, hold_s: 0.0, yaw_rad: None }
}

fn random_position(stream: &mut RandomStream, reach_m: f64) -> Vec3<Ned> {
    Vec3::new(stream.range(-reach_m, reach_m), stream.range(-reach_m, reach_m), stream.range(-0.3 * reach_m, 0.3 * reach_m))
}

#[test]
fn prop_planned_trajectory_is_smooth_and_passes_all_waypoints() {
    let mut stream = RandomStream::new(3, "ways");
    for case in 0..200 {
        let reach_m = [3.0, 10.0, 40.0][case % 3];
        let accept_m = stream.range(0.5, 3.0);
        let waypoints: Vec<Waypoint> = (0..2 + case % 7)
            .map(|_| Waypoint {
                position_m: random_position(&mut stream, reach_m),
                speed_m_s: Some(stream.range(1.0, 6.0)),
                acceptance_radius_m: accept_m,
            })
            .collect();
        let mut way = Trajectory::join(TrajectoryPoint::default(), &waypoints, AccelerationLimits::within(6.0, 4.0))
            .expect("the list has waypoints");
        let mut nearest = vec![f64::INFINITY; waypoints.len()];
        let mut before = way.planned();
        for _ in 0..(400.0 / STEP_S) as usize {
            let now = way.advance(&SPEEDS, 0.0, STEP_S);
            let jerk = (now.acceleration_m_s2 - before.acceleration_m_s2) / STEP_S;
            let velocity = (now.position_m - before.position_m) / STEP_S;
            assert!(now.acceleration_m_s2.norm() < MAX_ACCELERATION_M_S2, "case {case}: {now:?}");
            assert!(jerk.norm() < MAX_JERK_M_S3, "case {case}: jerk {}", jerk.norm());
            // Velocity tolerance, m/s: half a step's acceleration.
            assert!((velocity - now.velocity_m_s).norm() < 0.02, "case {case}: {velocity:?} {now:?}");
            for (least, waypoint) in nearest.iter_mut().zip(&waypoints) {
                *least = least.min((now.position_m - waypoint.position_m).norm());
            }
            before = now;
        }
        assert!(nearest.iter().all(|m| *m < 0.5 * accept_m + 0.01), "case {case}: {nearest:?} with {accept_m}");
        // Position and velocity tolerances, m and m/s.
        assert!(nearest.last().is_some_and(|m| *m < 0.02) && before.velocity_m_s.norm() < 0.02, "case {case}: {before:?}");
    }
}

#[test]
fn prop_trajectory_joined_in_flight_continues_the_motion() {
    let mut stream = RandomStream::new(4, "joins");
    for _ in 0..50 {
        let from = TrajectoryPoint {
            position_m: random_position(&mut stream, 5.0),
            velocity_m_s: random_position(&mut stream, 2.0),
            acceleration_m_s2: random_position(&mut stream, 1.0),
        };
        let to = Waypoint { position_m: random_position(&mut stream, 30.0), speed_m_s: None, acceptance_radius_m: 2.0 };
        let mut way = Trajectory::join(from, &[to], AccelerationLimits::within(6.0, 4.0)).expect("a waypoint");
        let begins = way.planned();
        // Rounding tolerances, m, m/s, m/s².
        assert!((begins.position_m - from.position_m).norm() < 1e-9);
        assert!((begins.velocity_m_s - from.velocity_m_s).norm() < 1e-9);
        assert!((begins.acceleration_m_s2 - from.acceleration_m_s2).norm() < 1e-9);
        for _ in 0..(60.0 / STEP_S) as usize {
            way.advance(&SPEEDS, 0.0, STEP_S);
        }
        assert!((way.planned().position_m - to.position_m).norm() < 0.02, "{:?} {to:?}", way.planned());
    }
}

#[test]
fn regress_vehicle_keeps_its_speed_through_waypoints_on_a_straight_leg() {
    // Minimum speed of 5 m/s that PX4's integration test requires when flying through waypoints.
    const MIN_HELD_SPEED_M_S: f64 = 4.0;
    for name in VEHICLES {
        let mut bench = Bench::new(&vehicle(name), 3);
        let mut steps = vec![MissionStep::Takeoff { up_m: Some(10.0) }, MissionStep::Speed(Some(5.0))];
        steps.extend((0..5).map(|k| point(20.0 * f64::from(k), 0.0, 10.0)));
        bench.autopilot.set_mission(steps);
        bench.run(2.0, |_| ());
        bench.ask(AutopilotRequest::Arm { force: false });
        bench.ask(AutopilotRequest::StartMission { first: None });
        let (mut slowest, mut fastest): (f64, f64) = (f64::INFINITY, 0.0);
        bench.run(70.0, |b| {
            // During the legs to 40 m and 60 m.
            if matches!(b.autopilot.status().mission_current, 4 | 5) {
                let speed = b.state.rigid.velocity_m_s.horizontal_norm();
                (slowest, fastest) = (slowest.min(speed), fastest.max(speed));
            }
        });
        assert!(bench.autopilot.status().mission_finished, "{name}: {:?}", bench.position());
        // Mission speed overshoot, m/s: the estimation error.
        assert!(slowest >= MIN_HELD_SPEED_M_S && fastest < 5.5, "{name}: {slowest} to {fastest} m/s");
    }
}

#[test]
fn regress_takeoff_item_below_ground_level_still_takes_off() {
    for up_m in [-5.0, -0.5, 0.0] {
        let mut bench = Bench::new(&vehicle("phantom2"), 5);
        bench.autopilot.set_mission(vec![MissionStep::Takeoff { up_m: Some(up_m) }, point(10.0, 0.0, 6.0)]);
        bench.run(2.0, |_| ());
        bench.ask(AutopilotRequest::Arm { force: false });
        bench.ask(AutopilotRequest::StartMission { first: None });
        let mut tilt_deg: f64 = 0.0;
        bench.run(40.0, |b| {
            let (roll, pitch, _) = b.state.rigid.attitude.euler();
            tilt_deg = tilt_deg.max(roll.abs().max(pitch.abs()).to_degrees());
        });
        let status = bench.autopilot.status();
        assert!(status.mission_finished && status.landed == LandedState::InAir, "{up_m}: {status:?} {:?}", bench.position());
        // The tilt limit of the aircraft.
        assert!(tilt_deg < 35.0, "height {up_m} m: tilted to {tilt_deg} deg");
    }
}

#[test]
fn regress_takeoff_uses_its_own_climb_rate() {
    // Speed tolerance, m/s.
    const SPEED_TOLERANCE_M_S: f64 = 0.3;
    for (own_m_s, climb_m_s, at_climb_speed, expected_m_s) in
        [(1.0, 3.0, false, 1.0), (2.5, 3.0, false, 2.5), (1.0, 2.0, true, 2.0), (1.0, 4.0, true, 4.0)]
    {
        for by_mission in [false, true] {
            let mut bench = Bench::new(&vehicle("phantom2"), 6);
            let tuning = &mut bench.autopilot.tuning;
            (tuning.takeoff_speed_m_s, tuning.climb_m_s) = (own_m_s, climb_m_s);
            tuning.takeoff_at_climb_speed = at_climb_speed;
            bench.autopilot.set_mission(vec![MissionStep::Takeoff { up_m: Some(14.0) }]);
            bench.run(2.0, |_| ());
            bench.ask(AutopilotRequest::Arm { force: false });
            if by_mission {
                bench.ask(AutopilotRequest::StartMission { first: None });
            } else {
                bench.ask(AutopilotRequest::Takeoff { height_m: Some(14.0) });
            }
            let mut fastest: f64 = 0.0;
            // Below 9 m, because PX4's takeoff rate applies up to 10 m.
            bench.run(20.0, |b| {
                if -b.position().down() < 9.0 {
                    fastest = fastest.max(-b.state.rigid.velocity_m_s.down());
                }
            });
            assert!(
                (fastest - expected_m_s).abs() < SPEED_TOLERANCE_M_S,
                "{own_m_s}, {climb_m_s}, mission {by_mission}: {fastest} m/s"
            );
        }
    }
}

#[test]
fn regress_mission_without_takeoff_item_climbs_first() {
    // Maximum drift, m: a quarter of the takeoff height.
    const MAX_DRIFT_M: f64 = 0.6;
    let mut bench = Bench::new(&vehicle("phantom2"), 7);
    bench.autopilot.set_mission(vec![point(60.0, 0.0, 6.0)]);
    bench.run(2.0, |_| ());
    bench.ask(AutopilotRequest::Arm { force: false });
    bench.ask(AutopilotRequest::StartMission { first: None });
    let mut worst: f64 = 0.0;
    bench.run(30.0, |b| {
        if -b.position().down() < 1.5 {
            worst = worst.max(b.position().horizontal_norm());
        }
    });
    assert!(worst < MAX_DRIFT_M, "drifted {worst} m below a height of 1.5 m");
    let status = bench.autopilot.status();
    assert!(status.mission_finished && status.mode == FlightMode::Hold, "{status:?} {:?}", bench.position());
}
