//! Effects of operator settings on failsafes, returns, limits, missions and the geofence.

use spandrel_model::frames::Vec3;
use spandrel_model::math;
use spandrel_sitl::autopilot::FenceAction;
use spandrel_sitl::autopilot::operator_rules::{
    FailsafeResponse, FenceAutoEnable, FenceParts, HeadingRule, LinkLossExceptions, MissionRequirement, OffboardLoss,
    ReturnTargets, SCENARIO_BATTERY_ACTIONS,
};
use spandrel_sitl::autopilot::{
    AutopilotRequest, FlightMode, LandedState, MissionStep, OffboardSetpoint, RequestOutcome, Sticks, Tuning,
};
use spandrel_testkit::bench::Bench;
use spandrel_testkit::shipped::vehicle;

/// Overshoot factor for speed limits: the velocity loop overshoots slightly.
const SPEED_OVERSHOOT_FACTOR: f64 = 1.1;
/// Acceleration tolerance, m/s²: contribution of the control loops.
const ACCELERATION_TOLERANCE_M_S2: f64 = 0.5;
/// Height tolerance, m: barometer noise and control loops.
const HEIGHT_TOLERANCE_M: f64 = 0.8;

fn airborne(change: impl Fn(&mut Tuning)) -> Bench {
    let mut bench = Bench::new(&vehicle("phantom2"), 5);
    change(&mut bench.autopilot.tuning);
    bench.take_off(6.0);
    bench
}

fn away(bench: &mut Bench, north_m: f64) {
    bench.ask(AutopilotRequest::GoTo { north_east_m: Some((north_m, 0.0)), up_m: None, yaw_rad: None, speed_m_s: Some(8.0) });
    bench.run(4.0 + north_m / 5.0, |_| ());
}

fn mode(bench: &Bench) -> FlightMode {
    bench.autopilot.status().mode
}

fn waypoints() -> Vec<MissionStep> {
    [20.0, 40.0, 60.0]
        .map(|n| MissionStep::Waypoint {
            position_m: Vec3::new(n, 0.0, -6.0),
            acceptance_radius_m: 1.0,
            hold_s: 0.0,
            yaw_rad: None,
        })
        .to_vec()
}

#[test]
fn flight_stick_loss_ends_a_mission_unless_excepted_or_released() {
    for (except, let_go, expected) in
        [(false, false, FlightMode::Hold), (true, false, FlightMode::Mission), (false, true, FlightMode::Mission)]
    {
        let mut bench = airborne(|tuning| {
            tuning.rules.responses.manual_loss_exceptions =
                LinkLossExceptions { mission: except, ..LinkLossExceptions::default() };
        });
        bench.sticks = Some(Sticks::default());
        bench.run(0.5, |_| ());
        bench.autopilot.set_mission(waypoints());
        bench.ask(AutopilotRequest::StartMission { first: None });
        bench.run(1.0, |_| ());
        bench.sticks = None;
        if let_go {
            bench.autopilot.release_sticks();
        }
        bench.run(2.0, |_| ());
        assert_eq!(mode(&bench), expected, "exception {except}, released {let_go}");
    }
}

#[test]
fn flight_mission_without_stick_input_continues() {
    let mut bench = airborne(|tuning| tuning.rules.responses.manual_loss_exceptions = LinkLossExceptions::default());
    bench.autopilot.set_mission(waypoints());
    bench.ask(AutopilotRequest::StartMission { first: None });
    bench.run(5.0, |_| ());
    assert_eq!(mode(&bench), FlightMode::Mission);
}

#[test]
fn flight_setpoint_loss_action_follows_its_setting() {
    let fixed = OffboardLoss::Fixed;
    let cases = [
        (OffboardLoss::Sticks(FlightMode::Position), true, FlightMode::Position),
        (OffboardLoss::Sticks(FlightMode::Altitude), true, FlightMode::Altitude),
        (OffboardLoss::Sticks(FlightMode::Position), false, FlightMode::Hold),
        (fixed(FailsafeResponse::Return), false, FlightMode::Return),
        (fixed(FailsafeResponse::Land), false, FlightMode::Land),
        (fixed(FailsafeResponse::Hold), true, FlightMode::Hold),
    ];
    for (loss, sticks, expected) in cases {
        let mut bench = airborne(|tuning| tuning.rules.responses.offboard_loss = loss);
        away(&mut bench, 15.0);
        bench.sticks = sticks.then(Sticks::default);
        bench.run(0.2, |_| ());
        let setpoint = OffboardSetpoint { velocity_m_s: [Some(1.0), Some(0.0), Some(0.0)], ..OffboardSetpoint::default() };
        bench.autopilot.offboard(setpoint, bench.now);
        bench.ask(AutopilotRequest::SetMode(FlightMode::Offboard));
        bench.run(2.0, |_| ());
        assert_eq!(mode(&bench), expected, "{loss:?}, sticks {sticks}");
    }
}

#[test]
fn flight_battery_actions_follow_their_settings() {
    let land = Some(FailsafeResponse::Land);
    let cases = [
        ([None; 3], 9.0, FlightMode::Hold),
        (SCENARIO_BATTERY_ACTIONS, 14.0, FlightMode::Return),
        (SCENARIO_BATTERY_ACTIONS, 6.5, FlightMode::Land),
        ([None, Some(FailsafeResponse::Return), land], 14.0, FlightMode::Hold),
        ([None, Some(FailsafeResponse::Return), land], 6.5, FlightMode::Return),
        ([None, Some(FailsafeResponse::Return), land], 4.0, FlightMode::Land),
    ];
    for (battery, charge_pct, expected) in cases {
        let mut bench = airborne(|tuning| tuning.rules.responses.battery = battery);
        away(&mut bench, 15.0);
        bench.state.battery.charge = 0.01 * charge_pct;
        bench.run(1.0, |_| ());
        assert_eq!(mode(&bench), expected, "{battery:?} at {charge_pct}%");
    }
    // The voltage must be low for the specified time before the failsafe acts.
    let mut bench = airborne(|_| ());
    let responses = &mut bench.autopilot.tuning.rules.responses;
    (responses.battery, responses.battery_low_v, responses.battery_low_time_s) = ([land, None, None], [100.0, 0.0], 5.0);
    bench.run(4.5, |_| ());
    assert_eq!(mode(&bench), FlightMode::Hold, "the failsafe must not trigger yet");
    bench.run(1.0, |_| ());
    assert_eq!(mode(&bench), FlightMode::Land);
}

#[test]
fn flight_arming_requirements_follow_their_settings() {
    let mut bench = Bench::new(&vehicle("phantom2"), 5);
    bench.run(2.0, |_| ());
    bench.ask(AutopilotRequest::Arm { force: false });
    bench.ask(AutopilotRequest::Disarm { force: true });
    bench.autopilot.tuning.rules.responses.arming_requires_mission = true;
    bench.autopilot.tuning.rules.responses.min_arming_voltage_v = 100.0;
    let reasons = bench.autopilot.arming_reasons(bench.now);
    assert_eq!(reasons, ["Battery voltage too low", "No mission"]);
    bench.autopilot.set_mission(waypoints());
    bench.autopilot.tuning.rules.responses.min_arming_voltage_v = 0.0;
    bench.ask(AutopilotRequest::Arm { force: false });
}

#[test]
fn flight_return_respects_speed_delay_and_final_height() {
    let mut bench = airborne(|tuning| {
        tuning.return_height_m = 8.0;
        let rules = &mut tuning.rules.return_rules;
        (rules.speed_m_s, rules.loiter_height_m, rules.wait_s, rules.final_height_m) = (Some(2.0), None, 4.0, 3.0);
    });
    away(&mut bench, 30.0);
    bench.ask(AutopilotRequest::SetMode(FlightMode::Return));
    bench.run(4.0, |_| ());
    let mut fastest = 0.0_f64;
    let mut over_home_s = 0.0;
    bench.run(40.0, |bench| {
        fastest = fastest.max(bench.state.rigid.velocity_m_s.horizontal_norm());
        if bench.position().horizontal_norm() < 0.8 && -bench.position().down() > 7.0 {
            over_home_s += 0.001;
        }
    });
    assert!(fastest < 2.0 * SPEED_OVERSHOOT_FACTOR && fastest > 1.5, "{fastest} m/s");
    assert!(over_home_s > 4.0, "waited {over_home_s} s");
    let status = bench.autopilot.status();
    assert!(status.armed && status.landed == LandedState::InAir, "{status:?}");
    assert!((-bench.position().down() - 3.0).abs() < HEIGHT_TOLERANCE_M, "{:?}", bench.position());
}

#[test]
fn flight_negative_landing_delay_keeps_the_vehicle_hovering_after_a_return() {
    let mut bench = airborne(|tuning| {
        tuning.return_height_m = 8.0;
        (tuning.rules.return_rules.loiter_height_m, tuning.rules.return_rules.wait_s) = (Some(5.0), -1.0);
    });
    away(&mut bench, 15.0);
    bench.ask(AutopilotRequest::SetMode(FlightMode::Return));
    bench.run(60.0, |_| ());
    assert!(bench.autopilot.status().armed);
    assert!((-bench.position().down() - 5.0).abs() < HEIGHT_TOLERANCE_M, "{:?}", bench.position());
}

#[test]
fn flight_return_height_follows_cone_and_minimum_climb() {
    for (cone_slope, climb_min_m, height_m) in [(0.0, 0.0, 20.0), (0.5, 0.0, 10.0), (0.5, 7.0, 13.0)] {
        let mut bench = airborne(|tuning| {
            tuning.return_height_m = 20.0;
            let rules = &mut tuning.rules.return_rules;
            (rules.cone_slope, rules.min_climb_m, rules.loiter_height_m) = (cone_slope, climb_min_m, None);
        });
        away(&mut bench, 20.0);
        bench.ask(AutopilotRequest::SetMode(FlightMode::Return));
        let mut highest = 0.0_f64;
        bench.run(20.0, |bench| highest = highest.max(-bench.position().down()));
        assert!((highest - height_m).abs() < HEIGHT_TOLERANCE_M, "slope {cone_slope}, climb {climb_min_m}: {highest} m");
    }
}

#[test]
fn flight_return_destination_follows_its_type() {
    use spandrel_sitl::autopilot::home::RallyPoint;
    let rally = RallyPoint { position_m: Vec3::new(30.0, 10.0, 0.0), home_relative: false };
    let landing = MissionStep::Land { position_m: Some(Vec3::new(0.0, 30.0, 0.0)) };
    let cases = [
        (ReturnTargets { home: true, rally: true, mission_landing: false }, (30.0, 10.0)),
        (ReturnTargets { home: false, rally: false, mission_landing: true }, (0.0, 30.0)),
        (ReturnTargets { home: true, rally: false, mission_landing: false }, (0.0, 0.0)),
        (ReturnTargets { home: false, rally: false, mission_landing: false }, (0.0, 0.0)),
    ];
    for (places, (north, east)) in cases {
        let mut bench = airborne(|tuning| {
            tuning.return_height_m = 8.0;
            tuning.rules.return_rules.places = places;
        });
        bench.autopilot.set_rally_points(vec![rally]);
        bench.autopilot.set_mission(vec![landing]);
        away(&mut bench, 20.0);
        bench.ask(AutopilotRequest::SetMode(FlightMode::Return));
        bench.run(45.0, |_| ());
        let at = bench.position();
        assert!(math::hypot(at.north() - north, at.east() - east) < 1.5, "{places:?}: {at:?}");
        assert!(!bench.autopilot.status().armed);
    }
}

#[test]
fn flight_heading_follows_its_setting() {
    // The bench starts with the nose to the north; the flight goes east, so home is to the west.
    let east = std::f64::consts::FRAC_PI_2;
    let cases = [
        (HeadingRule::Fixed, FlightMode::Hold, 0.0),
        (HeadingRule::Target, FlightMode::Hold, east),
        (HeadingRule::Home, FlightMode::Hold, -east),
        (HeadingRule::AwayFromHome, FlightMode::Hold, east),
        (HeadingRule::Path, FlightMode::Hold, east),
        (HeadingRule::TargetExceptReturn, FlightMode::Return, 0.0),
    ];
    for (heading, flown, expected) in cases {
        let mut bench = airborne(|tuning| {
            tuning.rules.heading = if flown == FlightMode::Return { HeadingRule::Fixed } else { heading };
            tuning.return_height_m = 6.0;
        });
        bench.ask(AutopilotRequest::GoTo { north_east_m: Some((0.0, 60.0)), up_m: None, yaw_rad: None, speed_m_s: Some(5.0) });
        bench.run(7.0, |_| ());
        if flown == FlightMode::Return {
            bench.autopilot.tuning.rules.heading = heading;
            bench.ask(AutopilotRequest::SetMode(FlightMode::Return));
            bench.run(5.0, |_| ());
        }
        let error = math::wrap_pi(bench.state.rigid.attitude.yaw_rad() - expected);
        assert!(error.abs() < 0.2, "{heading:?}: {} rad off", error);
    }
}

#[test]
fn flight_manual_and_automatic_limits_are_respected() {
    // Check the acceleration of a go-to command.
    for limit in [1.0, f64::INFINITY] {
        let mut bench = airborne(|tuning| tuning.rules.envelope.acceleration_m_s2 = limit);
        bench.ask(AutopilotRequest::GoTo { north_east_m: Some((40.0, 0.0)), up_m: None, yaw_rad: None, speed_m_s: Some(5.0) });
        bench.run(2.0, |_| ());
        let speed = bench.state.rigid.velocity_m_s.horizontal_norm();
        let kept = speed < 2.0 * (1.0 + ACCELERATION_TOLERANCE_M_S2);
        assert_eq!(kept, limit.is_finite(), "limit {limit}: {speed} m/s after 2 s");
    }
    // Check speed, climb rate, descent rate and yaw rate under stick control.
    let mut bench = Bench::in_position_mode(&vehicle("phantom2"), 5, 12.0);
    let set = &mut bench.autopilot.tuning.rules.envelope;
    (set.manual_speed_m_s, set.manual_climb_rate_m_s, set.manual_descent_rate_m_s, set.manual_yaw_rate_rad_s) =
        (2.0, 0.8, 0.5, 0.5);
    let centered = Sticks::default();
    let cases = [
        (Sticks { forward: 1.0, ..centered }, 2.0),
        (Sticks { up: 1.0, ..centered }, 0.8),
        (Sticks { up: -1.0, ..centered }, 0.5),
        (Sticks { yaw: 1.0, ..centered }, 0.5),
    ];
    for (k, (sticks, limit)) in cases.into_iter().enumerate() {
        bench.sticks = Some(centered);
        bench.run(3.0, |_| ());
        bench.sticks = Some(sticks);
        bench.run(3.0, |_| ());
        let (v, rate) = (bench.state.rigid.velocity_m_s, bench.state.rigid.rates_rad_s.down());
        let seen = [v.horizontal_norm(), -v.down(), v.down(), rate][k];
        assert!(seen < limit * SPEED_OVERSHOOT_FACTOR && seen > 0.7 * limit, "stick {k}: {seen}, limit {limit}");
    }
    // Check the tilt limit.
    bench.sticks = Some(centered);
    bench.run(3.0, |_| ());
    bench.autopilot.tuning.rules.envelope.manual_tilt_rad = 0.15;
    bench.ask(AutopilotRequest::SetMode(FlightMode::Altitude));
    bench.sticks = Some(Sticks { forward: 1.0, ..centered });
    let mut most = 0.0_f64;
    bench.run(1.5, |bench| most = most.max(bench.state.rigid.attitude.euler().1.abs()));
    assert!(most < 0.2 && most > 0.1, "{most} rad");
}

#[test]
fn flight_incomplete_mission_is_rejected() {
    let place = waypoints()[0];
    let takeoff = MissionStep::Takeoff { up_m: Some(6.0) };
    let cases = [
        (MissionRequirement::Takeoff, vec![place], Some("Mission has no takeoff item")),
        (MissionRequirement::Takeoff, vec![takeoff, place], None),
        (MissionRequirement::Both, vec![takeoff, place], Some("Mission has no landing item")),
        (MissionRequirement::BothOrNeither, vec![place], None),
        (MissionRequirement::BothOrNeither, vec![place, MissionStep::Return], Some("Mission has no takeoff item")),
        (MissionRequirement::Nothing, vec![place, MissionStep::Return], None),
    ];
    let mut bench = airborne(|_| ());
    for (needs, steps, refusal) in cases {
        bench.ask(AutopilotRequest::SetMode(FlightMode::Hold));
        bench.autopilot.tuning.rules.mission_requirement = needs;
        bench.autopilot.set_mission(steps.clone());
        let outcome = bench.autopilot.request(AutopilotRequest::StartMission { first: None }, bench.now);
        let expected = refusal.map_or(RequestOutcome::Accepted, |why| RequestOutcome::Denied(why.into()));
        assert_eq!(outcome, expected, "{needs:?} {steps:?}");
    }
    bench.ask(AutopilotRequest::SetMode(FlightMode::Hold));
    bench.autopilot.tuning.rules.mission_requirement = MissionRequirement::Nothing;
    bench.autopilot.tuning.rules.max_first_waypoint_distance_m = 15.0;
    bench.autopilot.set_mission(waypoints());
    let outcome = bench.autopilot.request(AutopilotRequest::StartMission { first: None }, bench.now);
    assert_eq!(outcome, RequestOutcome::Denied("First waypoint too far from home: 20 m, limit 15 m".into()));
}

#[test]
fn flight_restarted_mission_starts_at_its_first_item() {
    for restarts in [false, true] {
        let mut bench = airborne(|tuning| tuning.rules.mission_restarts = restarts);
        bench.autopilot.set_mission(waypoints());
        bench.ask(AutopilotRequest::StartMission { first: None });
        bench.run(8.0, |_| ());
        let before = bench.autopilot.status().mission_current;
        assert!(before > 0, "the vehicle must have reached the second waypoint");
        bench.ask(AutopilotRequest::SetMode(FlightMode::Hold));
        bench.run(1.0, |_| ());
        bench.ask(AutopilotRequest::SetMode(FlightMode::Mission));
        bench.run(0.1, |_| ());
        let expected = if restarts { 0 } else { before };
        assert_eq!(bench.autopilot.status().mission_current, expected, "restarts {restarts}");
    }
}

#[test]
fn flight_only_enabled_fence_parts_take_effect() {
    let parts = |height, floor_m| FenceParts { height, distance: true, areas: true, floor_m, auto: FenceAutoEnable::Never };
    let up = |up_m| AutopilotRequest::GoTo { north_east_m: None, up_m: Some(up_m), yaw_rad: None, speed_m_s: None };
    for height in [true, false] {
        let mut bench = airborne(|tuning| {
            tuning.fence_height_m = 10.0;
            tuning.rules.fence = parts(height, None);
        });
        let outcome = bench.autopilot.request(up(14.0), bench.now);
        assert_eq!(outcome == RequestOutcome::Accepted, !height, "{outcome:?}");
    }
    let mut bench = airborne(|tuning| {
        tuning.fence_action = FenceAction::Hold;
        tuning.rules.fence = parts(true, Some(3.0));
    });
    assert_eq!(bench.autopilot.status().fence.count, 0, "climbing through the floor must not be a breach");
    assert_eq!(bench.autopilot.request(up(2.0), bench.now), RequestOutcome::Denied("Target outside geofence".into()));
    bench.sticks = Some(Sticks::default());
    bench.run(0.2, |_| ());
    bench.ask(AutopilotRequest::SetMode(FlightMode::Position));
    bench.sticks = Some(Sticks { up: -1.0, ..Sticks::default() });
    bench.run(6.0, |_| ());
    assert_eq!((mode(&bench), bench.autopilot.status().fence.count), (FlightMode::Hold, 1));
    bench.sticks = None;
    bench.ask(AutopilotRequest::SetMode(FlightMode::Land));
    bench.run(20.0, |_| ());
    assert_eq!(bench.autopilot.status().fence.count, 1, "a landing must not be a breach");
}
