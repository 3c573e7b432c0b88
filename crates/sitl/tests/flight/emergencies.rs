//! Emergencies: loss of links, satellites or battery, and upset attitudes.

use spandrel_model::frames::{Frd, Ned, Rotation, Vec3};
use spandrel_model::math;
use spandrel_sitl::autopilot::{AutopilotRequest, FlightMode, LandedState, LinkLossAction, Pose, Severity, Sticks};
use spandrel_testkit::bench::{Bench, VEHICLES};
use spandrel_testkit::shipped::vehicle;

#[test]
fn flight_stick_loss_holds_and_recovery_restores_the_mode() {
    let mut bench = Bench::in_position_mode(&vehicle("phantom2"), 5, 6.0);
    bench.sticks = Some(Sticks { forward: 0.3, ..Sticks::default() });
    bench.run(2.0, |_| ());
    bench.sticks = None;
    bench.run(0.4, |_| ());
    assert_eq!(bench.autopilot.status().mode, FlightMode::Position, "the half-second timeout must not have expired yet");
    bench.run(4.0, |_| ());
    let status = bench.autopilot.status().clone();
    assert_eq!((status.mode, status.failsafe.as_deref()), (FlightMode::Hold, Some("manual control lost")));
    assert!(bench.state.rigid.velocity_m_s.norm() < 0.3);
    bench.sticks = Some(Sticks::default());
    bench.run(0.2, |_| ());
    let status = bench.autopilot.status().clone();
    assert_eq!((status.mode, status.failsafe), (FlightMode::Position, None));
}

#[test]
fn flight_stick_loss_triggers_return_or_landing_if_enabled() {
    for (action, mode) in [(LinkLossAction::Return, FlightMode::Return), (LinkLossAction::Land, FlightMode::Land)] {
        let mut bench = Bench::in_position_mode(&vehicle("phantom2"), 5, 6.0);
        bench.autopilot.tuning.manual_loss = action;
        bench.sticks = None;
        bench.run(4.0, |_| ());
        assert_eq!(bench.autopilot.status().mode, FlightMode::Hold, "the vehicle must hold first");
        bench.run(3.0, |_| ());
        assert_eq!(bench.autopilot.status().mode, mode);
        bench.run(60.0, |_| ());
        assert!(!bench.autopilot.status().armed, "{action:?}: {:?}", bench.autopilot.status());
    }
}

#[test]
fn flight_ground_station_loss_triggers_a_failsafe_if_enabled() {
    for (action, mode) in [(LinkLossAction::Ignore, FlightMode::Hold), (LinkLossAction::Return, FlightMode::Return)] {
        let mut bench = Bench::airborne(&vehicle("phantom2"), 6, 6.0);
        bench.autopilot.tuning.data_link_loss = action;
        bench.autopilot.record_ground_station_heartbeat(bench.now);
        bench.run(9.0, |_| ());
        assert_eq!(bench.autopilot.status().mode, FlightMode::Hold);
        bench.run(2.0, |_| ());
        assert_eq!(bench.autopilot.status().mode, mode);
    }
}

#[test]
fn flight_is_controllable_with_optical_flow_and_no_gnss() {
    // Maximum drift in two minutes, m.
    const MAX_DRIFT_M: f64 = 2.0;
    for name in VEHICLES {
        let mut bench = Bench::in_position_mode(&vehicle(name), 7, 6.0);
        let start = bench.position();
        bench.gnss_lost = true;
        bench.run(120.0, |_| ());
        let status = bench.autopilot.status();
        assert_eq!((status.mode, status.failsafe.clone()), (FlightMode::Position, None), "{name}");
        let drift = (bench.position() - start).horizontal_norm();
        assert!(drift < MAX_DRIFT_M, "{name}: drifted {drift} m");
    }
}

#[test]
fn flight_keeps_height_and_tilt_control_without_position() {
    // Maximum height change in two minutes, m: barometer drift.
    const MAX_HEIGHT_CHANGE_M: f64 = 1.0;
    for name in VEHICLES {
        let mut bench = Bench::in_position_mode(&vehicle(name), 8, 8.0);
        let height = bench.position().down();
        (bench.gnss_lost, bench.flow_lost) = (true, true);
        bench.run(120.0, |_| ());
        let status = bench.autopilot.status().clone();
        assert_eq!(status.mode, FlightMode::Altitude, "{name}");
        assert!(status.failsafe.is_some_and(|f| f.contains("position lost")), "{name}");
        let e = bench.autopilot.estimate();
        assert!(
            !e.position_valid && (bench.position().down() - height).abs() < MAX_HEIGHT_CHANGE_M,
            "{name}: {:?}",
            bench.position()
        );
        bench.sticks = Some(Sticks { forward: 0.3, ..Sticks::default() });
        bench.run(1.5, |_| ());
        let (_, pitch, _) = bench.state.rigid.attitude.euler();
        assert!(pitch < -0.05, "{name}: the stick had no effect on tilt: {pitch}");
        bench.sticks = Some(Sticks::default());
        (bench.gnss_lost, bench.flow_lost) = (false, false);
        bench.run(20.0, |_| ());
        let status = bench.autopilot.status().clone();
        assert_eq!((status.mode, status.failsafe), (FlightMode::Position, None), "{name}");
        assert!(bench.state.rigid.velocity_m_s.norm() < 0.3, "{name}: {:?}", bench.state.rigid.velocity_m_s);
    }
}

#[test]
fn flight_lands_without_position_and_pilot() {
    let mut bench = Bench::airborne(&vehicle("phantom2"), 9, 4.0);
    (bench.gnss_lost, bench.flow_lost) = (true, true);
    bench.run(90.0, |_| ());
    let status = bench.autopilot.status();
    assert!(!status.armed && status.landed == LandedState::OnGround, "{status:?} {:?}", bench.position());
}

#[test]
fn flight_low_battery_triggers_a_return_if_enabled() {
    for (returns, mode) in [(false, FlightMode::Hold), (true, FlightMode::Return)] {
        let mut bench = Bench::with_rules(&vehicle("phantom2"), 10, |rules| rules.low_battery_return = returns);
        bench.take_off(6.0);
        bench.ask(AutopilotRequest::GoTo { north_east_m: Some((15.0, 0.0)), up_m: None, yaw_rad: None, speed_m_s: None });
        bench.run(10.0, |_| ());
        bench.autopilot.drain_events();
        bench.state.battery.charge = 0.01 * (bench.autopilot.tuning.battery_low_pct - 0.5);
        bench.run(1.0, |_| ());
        assert_eq!(bench.autopilot.status().mode, mode);
        let warned =
            bench.autopilot.drain_events().iter().any(|e| e.severity == Severity::Warning && e.text.contains("Low battery"));
        assert!(warned);
    }
}

#[test]
fn flight_critical_battery_triggers_a_landing_if_enabled() {
    for (returns, mode) in [(false, FlightMode::Hold), (true, FlightMode::Land)] {
        let mut bench = Bench::with_rules(&vehicle("phantom2"), 10, |rules| rules.low_battery_return = returns);
        bench.take_off(6.0);
        bench.autopilot.drain_events();
        bench.state.battery.charge = 0.01 * (bench.autopilot.tuning.battery_critical_pct - 0.5);
        bench.run(1.0, |_| ());
        assert_eq!(bench.autopilot.status().mode, mode);
        let told = bench
            .autopilot
            .drain_events()
            .iter()
            .any(|e| e.severity == Severity::Critical && e.text.contains("Critical battery"));
        assert!(told);
    }
}

#[test]
fn flight_takeoff_with_low_battery_triggers_one_return() {
    let mut bench = Bench::with_rules(&vehicle("phantom2"), 10, |rules| rules.low_battery_return = true);
    bench.state.battery.charge = 0.01 * (bench.autopilot.tuning.battery_low_pct - 0.5);
    bench.run(2.0, |_| ());
    bench.ask(AutopilotRequest::Arm { force: false });
    bench.ask(AutopilotRequest::Takeoff { height_m: Some(4.0) });
    let mut returned = false;
    for _ in 0..30 {
        bench.run(0.1, |_| ());
        returned |= bench.autopilot.status().mode == FlightMode::Return;
    }
    assert!(returned, "{:?}", bench.autopilot.status().mode);
    // The pilot's command takes priority.
    bench.ask(AutopilotRequest::SetMode(FlightMode::Hold));
    bench.run(2.0, |_| ());
    assert_eq!(bench.autopilot.status().mode, FlightMode::Hold);
}

#[test]
fn flight_recovers_from_an_upset_attitude() {
    // Maximum height loss, m, and maximum recovery time, s, for a vehicle that was turned upside down.
    const MAX_HEIGHT_LOSS_M: f64 = 14.0;
    const MAX_RECOVERY_TIME_S: f64 = 5.0;
    for name in VEHICLES {
        let mut bench = Bench::airborne(&vehicle(name), 12, 25.0);
        let height = bench.position().down();
        bench.state.rigid.rates_rad_s = Vec3::new(14.0, 3.0, 2.0);
        bench.run(0.2, |_| ());
        let mut fall: f64 = 0.0;
        bench.run(MAX_RECOVERY_TIME_S, |b| fall = fall.max(b.position().down() - height));
        let down = (bench.state.rigid.attitude * Vec3::<Frd>::new(0.0, 0.0, 1.0)).down();
        assert!(down > 0.95 && fall < MAX_HEIGHT_LOSS_M, "{name}: fell {fall} m, upright {down}");
        bench.run(10.0, |_| ());
        assert!(bench.state.rigid.velocity_m_s.norm() < 0.3, "{name}: {:?}", bench.state.rigid.velocity_m_s);
    }
}

/// Lets the autopilot continue at rest at the aircraft's present place; it was at `from_m`.
fn respawn(bench: &mut Bench, from_m: Vec3<Ned>) {
    let rigid = bench.state.rigid;
    let pose = Pose { position_m: rigid.position_m, velocity_m_s: Vec3::zero(), attitude: rigid.attitude };
    bench.autopilot.respawn(from_m, &pose, bench.now);
}

#[test]
fn flight_flipped_vehicle_on_the_ground_stops_its_motors() {
    let mut bench = Bench::airborne(&vehicle("phantom2"), 13, 3.0);
    let from_m = bench.position();
    bench.state.rigid.attitude = Rotation::from_euler(math::PI, 0.0, 0.0);
    bench.state.rigid.position_m = Vec3::<Ned>::new(0.0, 0.0, -0.15);
    bench.state.rigid.velocity_m_s = Vec3::zero();
    respawn(&mut bench, from_m);
    bench.run(12.0, |_| ());
    assert!(!bench.autopilot.status().armed, "{:?} {:?}", bench.autopilot.status(), bench.state.rigid);
}

#[test]
fn flight_respawned_vehicle_hovers() {
    for name in VEHICLES {
        let mut bench = Bench::in_position_mode(&vehicle(name), 14, 5.0);
        bench.ask(AutopilotRequest::Disarm { force: true });
        bench.run(4.0, |_| ());
        let (from_m, place) = (bench.position(), Vec3::<Ned>::new(6.0, -4.0, -7.0));
        bench.state.place(place, 0.5);
        respawn(&mut bench, from_m);
        let mut stray: f64 = 0.0;
        bench.run(10.0, |b| stray = stray.max((b.position() - place).norm()));
        let status = bench.autopilot.status();
        assert!(status.armed && status.mode == FlightMode::Position, "{name}: {status:?}");
        // Maximum deviation, m: the rotors start from rest, so the vehicle sinks before it holds its height.
        assert!(stray < 2.5, "{name}: deviation of {stray} m");
        assert!(bench.state.rigid.velocity_m_s.norm() < 0.3, "{name}");
    }
}

#[test]
fn flight_stick_movement_interrupts_automatic_modes() {
    let mut bench = Bench::airborne(&vehicle("phantom2"), 15, 5.0);
    bench.sticks = Some(Sticks { up: -1.0, ..Sticks::default() });
    bench.ask(AutopilotRequest::SetMode(FlightMode::Position));
    bench.run(0.2, |_| ());
    bench.ask(AutopilotRequest::SetMode(FlightMode::Hold));
    bench.run(1.0, |_| ());
    assert_eq!(bench.autopilot.status().mode, FlightMode::Hold, "an idle throttle stick at its end stop must not take over");
    bench.sticks = Some(Sticks { forward: 0.6, up: -1.0, ..Sticks::default() });
    bench.run(0.2, |_| ());
    assert_eq!(bench.autopilot.status().mode, FlightMode::Position);
}
