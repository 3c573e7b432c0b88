//! Arming, takeoff, landing, return, missions and external setpoints.

use spandrel_model::frames::Vec3;
use spandrel_model::time::SimTime;
use spandrel_sitl::autopilot::{
    AutopilotRequest, FlightMode, LandedState, MissionStep, OffboardSetpoint, RequestOutcome, Sticks,
};
use spandrel_testkit::bench::{Bench, VEHICLES};
use spandrel_testkit::shipped::vehicle;

/// Position tolerance, m: receiver and control errors.
const POSITION_TOLERANCE_M: f64 = 1.5;

#[test]
fn flight_every_aircraft_can_arm_within_2_s() {
    for name in VEHICLES {
        let mut bench = Bench::new(&vehicle(name), 1);
        let reasons = bench.autopilot.arming_reasons(bench.now);
        assert!(!reasons.is_empty(), "{name} could be armed before its sensors were ready");
        bench.run(2.0, |_| ());
        let reasons = bench.autopilot.status().arming_blockers.clone();
        assert!(reasons.is_empty(), "{name}: {reasons:?}");
    }
}

#[test]
fn flight_arming_rejection_lists_all_reasons() {
    let mut bench = Bench::new(&vehicle("phantom2"), 1);
    bench.gnss_lost = true;
    bench.run(2.0, |_| ());
    bench.sticks = Some(Sticks { forward: 0.5, ..Sticks::default() });
    bench.run(0.1, |_| ());
    let outcome = bench.autopilot.request(AutopilotRequest::Arm { force: false }, bench.now);
    let RequestOutcome::TemporarilyRejected(why) = outcome else { panic!("{outcome:?}") };
    assert!(why.contains("No GNSS fix") && why.contains("Sticks not centered"), "{why}");
    bench.ask(AutopilotRequest::Arm { force: true });
    assert!(bench.autopilot.status().armed);
}

#[test]
fn flight_takeoff_hold_and_landing_stay_at_the_same_position() {
    // Height tolerance, m: barometer offset, plus the receiver's contribution to the height error.
    const HEIGHT_TOLERANCE_M: f64 = 0.8;
    for name in VEHICLES {
        let mut bench = Bench::airborne(&vehicle(name), 1, 5.0);
        let mut worst: f64 = 0.0;
        bench.run(20.0, |b| worst = worst.max(b.position().horizontal_norm()));
        assert!(worst < POSITION_TOLERANCE_M, "{name}: strayed {worst} m");
        assert!((bench.position().down() + 5.0).abs() < HEIGHT_TOLERANCE_M, "{name}: {:?}", bench.position());
        bench.ask(AutopilotRequest::Land);
        let mut impact: f64 = 0.0;
        bench.run(20.0, |b| impact = impact.max(b.state.contact.impact_m_s));
        let status = bench.autopilot.status().clone();
        assert!(!status.armed && status.landed == LandedState::OnGround, "{name}: {status:?} {:?}", bench.position());
        // Maximum impact speed, m/s: gentler than stepping off a curb.
        assert!(impact < 1.2, "{name}: touched down at {impact} m/s");
    }
}

#[test]
fn flight_takeoff_and_landing_with_sticks() {
    for name in VEHICLES {
        let mut bench = Bench::new(&vehicle(name), 2);
        bench.sticks = Some(Sticks::default());
        bench.run(2.0, |_| ());
        bench.ask(AutopilotRequest::SetMode(FlightMode::Position));
        bench.ask(AutopilotRequest::Arm { force: false });
        bench.run(2.0, |_| ());
        assert_eq!(bench.autopilot.status().landed, LandedState::OnGround, "{name} left the ground without a command");
        bench.sticks = Some(Sticks { up: 0.5, ..Sticks::default() });
        bench.run(3.0, |_| ());
        assert_eq!(bench.autopilot.status().landed, LandedState::InAir, "{name}");
        bench.sticks = Some(Sticks::default());
        bench.run(5.0, |_| ());
        assert!(bench.autopilot.status().armed && bench.position().down() < -1.0, "{name}: {:?}", bench.position());
        bench.sticks = Some(Sticks { up: -0.5, ..Sticks::default() });
        bench.run(20.0, |_| ());
        assert!(!bench.autopilot.status().armed, "{name}: {:?}", bench.autopilot.status());
        let texts: Vec<String> = bench.autopilot.drain_events().into_iter().map(|e| e.text).collect();
        assert_eq!(texts, ["Armed", "Takeoff detected", "Landing detected", "Disarmed by landing"], "{name}");
    }
}

#[test]
fn flight_return_lands_at_home() {
    for name in VEHICLES {
        let mut bench = Bench::airborne(&vehicle(name), 6, 6.0);
        bench.autopilot.tuning.return_height_m = 12.0;
        bench.ask(AutopilotRequest::GoTo { north_east_m: Some((20.0, 10.0)), up_m: None, yaw_rad: None, speed_m_s: None });
        bench.run(15.0, |_| ());
        assert!((bench.position() - Vec3::new(20.0, 10.0, -6.0)).norm() < POSITION_TOLERANCE_M, "{name}: {:?}", bench.position());
        bench.ask(AutopilotRequest::SetMode(FlightMode::Return));
        let mut top: f64 = 0.0;
        bench.run(70.0, |b| top = top.max(-b.position().down()));
        assert!(!bench.autopilot.status().armed, "{name}: {:?} {:?}", bench.autopilot.status(), bench.position());
        assert!(
            bench.position().horizontal_norm() < POSITION_TOLERANCE_M && (top - 12.0).abs() < POSITION_TOLERANCE_M,
            "{name}: {:?}, {top}",
            bench.position()
        );
    }
}

fn point(north: f64, east: f64, up: f64) -> MissionStep {
    MissionStep::Waypoint { position_m: Vec3::new(north, east, -up), acceptance_radius_m: 1.0, hold_s: 0.0, yaw_rad: None }
}

#[test]
fn flight_mission_is_flown_in_order_and_lands() {
    let mut bench = Bench::new(&vehicle("phantom2"), 7);
    bench.autopilot.set_mission(vec![
        MissionStep::Takeoff { up_m: Some(5.0) },
        MissionStep::Speed(Some(4.0)),
        point(15.0, 0.0, 5.0),
        MissionStep::Payload,
        MissionStep::Delay(2.0),
        point(15.0, 10.0, 8.0),
        MissionStep::Jump { to: 2, times: 1 },
        MissionStep::Land { position_m: Some(Vec3::new(0.0, 0.0, 0.0)) },
    ]);
    bench.run(2.0, |_| ());
    bench.ask(AutopilotRequest::Arm { force: false });
    bench.ask(AutopilotRequest::StartMission { first: None });
    let mut reached = Vec::new();
    let mut fastest: f64 = 0.0;
    for _ in 0..90 {
        bench.run(1.0, |b| fastest = fastest.max(b.state.rigid.velocity_m_s.horizontal_norm()));
        reached.extend(bench.autopilot.drain_reached());
    }
    assert_eq!(reached, [0, 1, 2, 3, 4, 5, 6, 2, 3, 4, 5, 6, 7]);
    let status = bench.autopilot.status();
    assert!(status.mission_finished && !status.armed, "{status:?} {:?}", bench.position());
    assert!(bench.position().horizontal_norm() < POSITION_TOLERANCE_M, "{:?}", bench.position());
    // Maximum speed including overshoot, m/s.
    assert!(fastest < 4.4, "{fastest}");
}

#[test]
fn flight_setpoints_are_followed_and_their_loss_leads_to_hold() {
    let mut bench = Bench::airborne(&vehicle("phantom2"), 8, 6.0);
    let refused = bench.autopilot.request(AutopilotRequest::SetMode(FlightMode::Offboard), bench.now);
    assert!(matches!(refused, RequestOutcome::TemporarilyRejected(_)), "{refused:?}");
    let velocity = OffboardSetpoint { velocity_m_s: [Some(2.0), Some(-1.0), Some(0.0)], ..OffboardSetpoint::default() };
    bench.autopilot.offboard(velocity, bench.now);
    bench.ask(AutopilotRequest::SetMode(FlightMode::Offboard));
    for _ in 0..50 {
        bench.autopilot.offboard(velocity, bench.now);
        bench.run(0.1, |_| ());
    }
    let v = bench.state.rigid.velocity_m_s;
    assert!((v - Vec3::new(2.0, -1.0, 0.0)).norm() < 0.3, "{v:?}");
    bench.run(8.0, |_| ());
    let status = bench.autopilot.status();
    assert_eq!(status.failsafe.as_deref(), Some("external setpoints lost"));
    assert!(bench.state.rigid.velocity_m_s.norm() < 0.3, "{:?}", bench.state.rigid.velocity_m_s);
}

#[test]
fn regress_same_seed_gives_identical_flights() {
    let fly = |seed| {
        let mut bench = Bench::airborne(&vehicle("f450"), seed, 4.0);
        bench.air.velocity_m_s = Vec3::new(2.0, 1.0, 0.0);
        bench.run(5.0, |_| ());
        (bench.position(), bench.state.rigid.rotor_rad_s, bench.autopilot.estimate().position_m)
    };
    assert_eq!(fly(11), fly(11));
    assert_ne!(fly(11), fly(12));
}

#[test]
fn regress_clone_in_flight_continues_identically() {
    let mut bench = Bench::airborne(&vehicle("m30"), 9, 4.0);
    bench.ask(AutopilotRequest::GoTo {
        north_east_m: Some((8.0, 3.0)),
        up_m: Some(6.0),
        yaw_rad: Some(1.0),
        speed_m_s: Some(2.0),
    });
    bench.run(1.0, |_| ());
    let (state, sensors, autopilot, now) = (bench.state.clone(), bench.sensors.clone(), bench.autopilot.clone(), bench.now);
    bench.run(4.0, |_| ());
    let first = bench.position();
    (bench.state, bench.sensors, bench.autopilot) = (state, sensors, autopilot);
    bench.rewind(now);
    bench.run(4.0, |_| ());
    assert_eq!(bench.position(), first);
    assert!(bench.now > now + SimTime::from_ms(3_999));
}
