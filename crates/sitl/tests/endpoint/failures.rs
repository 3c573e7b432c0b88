//! Failures injected by an instructor, and the vehicle's responses.

use spandrel_mavlink::dialect::*;
use spandrel_model::site::bridge_closures::BridgeClosures;
use spandrel_model::site::changes::SiteChanges;
use spandrel_model::site::traffic::CREW_TRUCK;
use spandrel_model::site::{Site, Surface};
use spandrel_sitl::endpoint::flavor::{Flavor, ardupilot, generic, px4};
use spandrel_testkit::shipped::scenario;
use spandrel_testkit::station::{Station, p};

const OFF: f32 = 1.0;
const OK: f32 = 0.0;
const COMPASS: f32 = 2.0;
const GNSS: f32 = 4.0;
const BATTERY: f32 = 100.0;
const MOTOR: f32 = 101.0;
const STICKS: f32 = 104.0;
const HOLD: u32 = 4 << 16 | 3 << 24;
/// Tolerance for the difference between the configured wind and the wind in telemetry, which includes turbulence, m/s.
const WIND_TOLERANCE_M_S: f64 = 2.5;

fn set(station: &mut Station, name: &str, value: f32, kind: MavParamType) {
    assert!(station.set(name, value, kind).is_some(), "{name}");
}

fn set_whole(station: &mut Station, name: &str, value: i32) {
    set(station, name, f32::from_bits(value.cast_unsigned()), MavParamType::MAV_PARAM_TYPE_INT32);
}

fn set_real(station: &mut Station, name: &str, value: f32) {
    set(station, name, value, MavParamType::MAV_PARAM_TYPE_REAL32);
}

/// Enables failure injection. ArduPilot sends integers as floating-point numbers; the other autopilots send their bit
/// pattern.
fn allow_failures(station: &mut Station, flavor: &Flavor) {
    let one = if flavor.name == ardupilot::FLAVOR.name { 1.0 } else { f32::from_bits(1) };
    set(station, "SYS_FAILURE_EN", one, MavParamType::MAV_PARAM_TYPE_INT32);
}

fn inject(station: &mut Station, unit: f32, kind: f32, instance: f32) -> MavResult {
    station.command(1, MavCmd::MAV_CMD_INJECT_FAILURE, [unit, kind, instance, 0.0, 0.0, 0.0, 0.0])
}

fn has_text(station: &Station, what: &str) -> bool {
    !station
        .all(
            |m| {
                if let MavMessage::STATUSTEXT(t) = m {
                    t.text.to_str().ok().filter(|t| t.contains(what)).map(|_| ())
                } else {
                    None
                }
            },
        )
        .is_empty()
}

/// Returns a vehicle that holds its position at a given height, with failure injection enabled.
fn holding_vehicle() -> Station {
    let mut station = Station::airborne("drill-hover", 7);
    set_whole(&mut station, "SYS_FAILURE_EN", 1);
    let hold = [1.0, 4.0, 3.0, 0.0, 0.0, 0.0, 0.0];
    assert_eq!(station.command(1, MavCmd::MAV_CMD_DO_SET_MODE, hold), MavResult::MAV_RESULT_ACCEPTED);
    station.run_ms(2_000);
    station
}

#[test]
fn wire_failure_injection_requires_permission_and_a_supported_failure() {
    let mut station = Station::airborne("drill-hover", 7);
    assert_eq!(inject(&mut station, GNSS, OFF, 0.0), MavResult::MAV_RESULT_DENIED);
    set_whole(&mut station, "SYS_FAILURE_EN", 1);
    assert_eq!(inject(&mut station, GNSS, OFF, 0.0), MavResult::MAV_RESULT_ACCEPTED);
    for (unit, kind, instance) in
        [(8.0, OFF, 0.0), (GNSS, 99.0, 0.0), (MOTOR, OFF, 9.0), (f32::NAN, OFF, 0.0), (BATTERY, 3.0, 0.0)]
    {
        assert_eq!(inject(&mut station, unit, kind, instance), MavResult::MAV_RESULT_UNSUPPORTED, "{unit} {kind} {instance}");
    }
}

#[test]
fn flight_gnss_loss_and_recovery_are_reported() {
    let mut station = holding_vehicle();
    let seen = |s: &Station| {
        let healthy = s.last_message(|m| match m {
            MavMessage::SYS_STATUS(s) => {
                Some(s.onboard_control_sensors_health.contains(MavSysStatusSensor::MAV_SYS_STATUS_SENSOR_GPS))
            }
            _ => None,
        });
        let fix = s.last_message(|m| if let MavMessage::GPS_RAW_INT(g) = m { Some(g.fix_type as u8) } else { None });
        (healthy, fix)
    };
    assert_eq!(inject(&mut station, GNSS, OFF, 0.0), MavResult::MAV_RESULT_ACCEPTED);
    assert!(station.run_until(10.0, |s| matches!(seen(s), (Some(false), Some(0 | 1)))), "{:?}", seen(&station));
    station.received.clear();
    assert_eq!(inject(&mut station, GNSS, OK, 0.0), MavResult::MAV_RESULT_ACCEPTED);
    assert!(station.run_until(30.0, |s| seen(s) == (Some(true), Some(3))), "{:?}", seen(&station));
}

/// The estimate may follow a jump in the fixes or reject it; either way, the vehicle must stay in the air without a
/// collision.
#[test]
fn flight_gnss_jump_does_not_cause_a_crash() {
    const INCONSISTENT: f32 = 4.0;
    let mut station = holding_vehicle();
    let before = station.sim.truth().rigid.position_m;
    assert_eq!(inject(&mut station, GNSS, INCONSISTENT, 0.0), MavResult::MAV_RESULT_ACCEPTED);
    station.run_ms(15_000);
    let now = station.sim.truth().rigid;
    assert!((now.position_m.down() - before.down()).abs() < 3.0, "{:?}", now.position_m);
    assert!(now.velocity_m_s.norm() < 8.0, "{:?}", now.velocity_m_s);
}

/// Returns the health bits from one SYS_STATUS message.
fn health(station: &Station) -> Option<MavSysStatusSensor> {
    station.last_message(|m| if let MavMessage::SYS_STATUS(s) = m { Some(s.onboard_control_sensors_health) } else { None })
}

/// Time within which a missing sensor must be reported and prevent arming, s (half a second without data, and
/// SYS_STATUS twice per second).
const DETECTION_LIMIT_S: f64 = 2.0;

#[test]
fn wire_missing_compass_or_barometer_prevents_arming() {
    use MavSysStatusSensor as S;
    const BAROMETER: f32 = 3.0;
    let arm = [1.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0];
    for (unit, name, bit) in [
        (COMPASS, "Compass", S::MAV_SYS_STATUS_SENSOR_3D_MAG),
        (BAROMETER, "Barometer", S::MAV_SYS_STATUS_SENSOR_ABSOLUTE_PRESSURE),
    ] {
        let mut station = Station::new("drill-hover", 7);
        station.run_ms(4_000);
        set_whole(&mut station, "SYS_FAILURE_EN", 1);
        station.run_ms(600);
        assert!(health(&station).unwrap().contains(bit | S::MAV_SYS_STATUS_PREARM_CHECK), "{name}");
        assert_eq!(inject(&mut station, unit, OFF, 0.0), MavResult::MAV_RESULT_ACCEPTED);
        let gone = |s: &mut Station| health(s).is_some_and(|now| !now.intersects(bit | S::MAV_SYS_STATUS_PREARM_CHECK));
        assert!(station.run_until(DETECTION_LIMIT_S, gone), "{name}");
        assert!(has_text(&station, &format!("{name} lost")));
        let refused = station.command(1, MavCmd::MAV_CMD_COMPONENT_ARM_DISARM, arm);
        assert_eq!(refused, MavResult::MAV_RESULT_TEMPORARILY_REJECTED, "{name}");
        assert!(has_text(&station, &format!("{name} missing")));
        assert_eq!(inject(&mut station, unit, OK, 0.0), MavResult::MAV_RESULT_ACCEPTED);
        let back = |s: &mut Station| health(s).is_some_and(|now| now.contains(bit | S::MAV_SYS_STATUS_PREARM_CHECK));
        assert!(station.run_until(DETECTION_LIMIT_S, back), "{name}");
        assert_eq!(station.command(1, MavCmd::MAV_CMD_COMPONENT_ARM_DISARM, arm), MavResult::MAV_RESULT_ACCEPTED);
    }
}

/// Without a compass, the gyroscopes maintain the heading well enough to hold position and land.
#[test]
fn flight_compass_loss_is_reported_and_hold_continues() {
    let mut station = holding_vehicle();
    let before = station.sim.truth().rigid.position_m;
    assert_eq!(inject(&mut station, COMPASS, OFF, 0.0), MavResult::MAV_RESULT_ACCEPTED);
    assert!(station.run_until(DETECTION_LIMIT_S, |s| has_text(s, "Compass lost")));
    station.run_ms(20_000);
    let now = station.sim.truth().rigid.position_m;
    assert!((now - before).norm() < 3.0, "{before:?} to {now:?}");
}

/// A sensor that gets stuck on the ground must be reported in the emulated autopilot's wording, prevent arming, and
/// recover.
#[test]
fn wire_stuck_sensor_is_announced_and_prevents_arming() {
    use MavSysStatusSensor as S;
    const STUCK: f32 = 2.0;
    const BAROMETER: f32 = 3.0;
    // Time limit, s: two seconds with the same value, SYS_STATUS twice per second, plus margin.
    const REPORT_LIMIT_S: f64 = 4.0;
    let arm = p(&[1.0]);
    for (flavor, unit, bit, words) in [
        (&px4::FLAVOR, BAROMETER, S::MAV_SYS_STATUS_SENSOR_ABSOLUTE_PRESSURE, "BARO #0 failed: STALE!"),
        (&px4::FLAVOR, COMPASS, S::MAV_SYS_STATUS_SENSOR_3D_MAG, "MAG #0 failed: STALE!"),
        (&px4::FLAVOR, GNSS, S::MAV_SYS_STATUS_SENSOR_GPS, "GPS #0 failed: STALE!"),
        (&ardupilot::FLAVOR, BAROMETER, S::MAV_SYS_STATUS_SENSOR_ABSOLUTE_PRESSURE, "Baro 1 not healthy"),
        (&ardupilot::FLAVOR, COMPASS, S::MAV_SYS_STATUS_SENSOR_3D_MAG, "Compass 1 not healthy"),
        (&ardupilot::FLAVOR, GNSS, S::MAV_SYS_STATUS_SENSOR_GPS, "GPS Glitch or Compass error"),
        (&generic::FLAVOR, BAROMETER, S::MAV_SYS_STATUS_SENSOR_ABSOLUTE_PRESSURE, "Barometer stuck: not used"),
    ] {
        let mut station = Station::with_flavor(flavor, "drill-hover", 7);
        // ArduPilot's streams start when they are requested.
        station.command(1, MavCmd::MAV_CMD_SET_MESSAGE_INTERVAL, p(&[1.0, 500_000.0]));
        station.run_ms(4_000);
        allow_failures(&mut station, flavor);
        station.run_ms(600);
        assert!(health(&station).unwrap().contains(bit), "{words}");
        assert_eq!(inject(&mut station, unit, STUCK, 0.0), MavResult::MAV_RESULT_ACCEPTED);
        station.received.clear();
        let gone = |s: &mut Station| health(s).is_some_and(|now| !now.intersects(bit)) && has_text(s, words);
        assert!(station.run_until(REPORT_LIMIT_S, gone), "{words}: {:?}", station.texts());
        assert_ne!(station.command(1, MavCmd::MAV_CMD_COMPONENT_ARM_DISARM, arm), MavResult::MAV_RESULT_ACCEPTED, "{words}");
        assert_eq!(inject(&mut station, unit, OK, 0.0), MavResult::MAV_RESULT_ACCEPTED);
        assert!(station.run_until(REPORT_LIMIT_S, |s| health(s).is_some_and(|now| now.contains(bit))), "{words}");
    }
}

/// Scenario from issue 16: the vehicle goes to a height of 12 m, and the barometer gets stuck during the climb.
#[test]
fn regress_stuck_barometer_is_announced_and_the_climb_succeeds() {
    const STUCK: f32 = 2.0;
    const BAROMETER: f32 = 3.0;
    // Height tolerance, m, when only the GNSS height remains.
    const HEIGHT_TOLERANCE_M: f64 = 2.5;
    let mut station = holding_vehicle();
    let before = station.sim.truth().rigid.position_m.enu();
    let altitude =
        station.last_message(|m| if let MavMessage::GLOBAL_POSITION_INT(g) = m { Some(g.alt as f32 * 1e-3) } else { None });
    let up = p(&[-1.0, 1.0, 0.0, f32::NAN, f32::NAN, f32::NAN, altitude.unwrap() + 7.0]);
    assert_eq!(station.command(1, MavCmd::MAV_CMD_DO_REPOSITION, up), MavResult::MAV_RESULT_ACCEPTED);
    station.run_ms(1_500);
    assert_eq!(inject(&mut station, BAROMETER, STUCK, 0.0), MavResult::MAV_RESULT_ACCEPTED);
    station.received.clear();
    assert!(station.run_until(4.0, |s| has_text(s, "BARO #0 failed: STALE!")), "{:?}", station.texts());
    for _ in 0..60 {
        station.run_ms(1_000);
        let climbed = station.sim.truth().rigid.position_m.enu().up() - before.up();
        assert!(climbed < 7.0 + HEIGHT_TOLERANCE_M, "{climbed} m instead of 7 m");
    }
    let climbed = station.sim.truth().rigid.position_m.enu().up() - before.up();
    assert!((climbed - 7.0).abs() < HEIGHT_TOLERANCE_M, "{climbed} m instead of 7 m");
}

/// With one motor stopped, the vehicle tilts and spins; it must report this before it has fallen.
#[test]
fn flight_motor_failure_changes_attitude_and_is_reported() {
    let mut station = holding_vehicle();
    let level = |s: &Station| s.last_message(|m| if let MavMessage::ATTITUDE(a) = m { Some(a.clone()) } else { None }).unwrap();
    let before = level(&station);
    assert!(before.roll.hypot(before.pitch) < 0.2 && !has_text(&station, "Attitude control lost"), "{before:?}");
    assert_eq!(inject(&mut station, MOTOR, OFF, 2.0), MavResult::MAV_RESULT_ACCEPTED);
    let (mut tilt, mut turn) = (0.0f32, 0.0f32);
    let told = station.run_until(2.0, |s| {
        let now = level(s);
        (tilt, turn) = (tilt.max(now.roll.abs().max(now.pitch.abs())), turn.max(now.yawspeed.abs()));
        has_text(s, "Attitude control lost: motor/propeller failure?")
    });
    assert!(told && tilt > 0.7 && turn > 0.5, "reported {told}, tilt {tilt} rad, turn rate {turn} rad/s");
    let obeys = MavSysStatusSensor::MAV_SYS_STATUS_SENSOR_ATTITUDE_STABILIZATION;
    assert!(station.run_until(1.0, |s| health(s).is_some_and(|health| !health.contains(obeys))));
}

#[test]
fn flight_vehicle_falls_after_a_motor_failure() {
    let mut station = holding_vehicle();
    let before = station.sim.truth().rigid.position_m.down();
    assert_eq!(inject(&mut station, MOTOR, OFF, 2.0), MavResult::MAV_RESULT_ACCEPTED);
    assert!(
        station.run_until(8.0, |s| s.sim.truth().rigid.position_m.down() - before > 4.0),
        "a quadrotor with three rotors must fall"
    );
}

#[test]
fn flight_manual_control_loss_holds_until_it_returns() {
    let mut station = Station::airborne("drill-hover", 7);
    set_whole(&mut station, "SYS_FAILURE_EN", 1);
    assert_eq!(inject(&mut station, STICKS, OFF, 0.0), MavResult::MAV_RESULT_ACCEPTED);
    for _ in 0..50 {
        station.sticks(500, 0, 500, 0);
        station.run_ms(40);
    }
    assert_eq!(station.mode(), Some(HOLD));
    assert_eq!(inject(&mut station, STICKS, OK, 0.0), MavResult::MAV_RESULT_ACCEPTED);
    for _ in 0..50 {
        station.sticks(0, 0, 500, 0);
        station.run_ms(40);
    }
    assert_eq!(station.mode(), Some(3 << 16));
}

#[test]
fn wire_battery_failure_is_reported() {
    let mut station = holding_vehicle();
    assert_eq!(inject(&mut station, BATTERY, OFF, 0.0), MavResult::MAV_RESULT_ACCEPTED);
    assert!(station.run_until(5.0, |s| has_text(s, "Low battery")));
    station.run_ms(600);
    let left = station.last_message(|m| if let MavMessage::BATTERY_STATUS(b) = m { Some(b.battery_remaining) } else { None });
    assert!(left.unwrap() <= 5, "{left:?}");
}

/// A failed cell must be reported, must reduce the pack voltage, and must be able to recover.
#[test]
fn wire_failed_cell_is_reported_and_reduces_the_voltage() {
    let mut station = holding_vehicle();
    let cells =
        |s: &Station| s.last_message(|m| if let MavMessage::BATTERY_STATUS(b) = m { Some(b.voltages) } else { None }).unwrap();
    let pack = |s: &Station| {
        s.last_message(|m| if let MavMessage::SYS_STATUS(b) = m { Some(f32::from(b.voltage_battery)) } else { None }).unwrap()
    };
    station.run_ms(1_000);
    let (whole, before) = (cells(&station), pack(&station));
    assert_eq!(whole.iter().filter(|mv| **mv != u16::MAX).count(), 3, "the pack must have three cells");
    assert_eq!(inject(&mut station, BATTERY, OFF, 2.0), MavResult::MAV_RESULT_ACCEPTED);
    station.run_ms(1_000);
    assert_eq!((cells(&station)[1], cells(&station)[0] > 3_000), (0, true), "{:?}", cells(&station));
    assert!((pack(&station) / before - 2.0 / 3.0).abs() < 0.05, "{} of {before} mV", pack(&station));
    assert_eq!(inject(&mut station, BATTERY, OFF, 4.0), MavResult::MAV_RESULT_DENIED);
    assert_eq!(inject(&mut station, BATTERY, OK, 2.0), MavResult::MAV_RESULT_ACCEPTED);
    station.run_ms(1_000);
    assert!(cells(&station)[1] > 3_000);
}

#[test]
fn flight_instructor_wind_takes_effect() {
    let mut station = holding_vehicle();
    set_real(&mut station, "SIM_WIND_DIR", 270.0);
    set_real(&mut station, "SIM_WIND_SPD", 8.0);
    station.run_ms(10_000);
    let mean = (0..50).map(|_| {
        station.run_ms(200);
        f64::from(station.last_message(|m| if let MavMessage::WIND_COV(w) = m { Some(w.wind_y) } else { None }).unwrap())
    });
    let east = mean.sum::<f64>() / 50.0;
    assert!((east - 8.0).abs() < WIND_TOLERANCE_M_S, "west wind: {east} m/s eastward");
}

#[test]
fn wire_telemetry_reproduces_traffic_on_closed_bridges() {
    let mut station = Station::new("two-bridges", 7);
    let codes = |s: &Station| -> Vec<i32> {
        let has_text = s.received.iter().filter_map(|frame| frame.message.as_ref());
        has_text
            .filter_map(|m| {
                if let MavMessage::NAMED_VALUE_INT(v) = m { (v.name.to_str() == Ok("traffic")).then_some(v.value) } else { None }
            })
            .collect()
    };
    station.run_ms(11_000);
    assert!(codes(&station).is_empty(), "unchanged bridges must not be reported");
    assert!(station.sim.site().traffic().closures().is_empty());
    for (open, wait_ms) in [(0, 90_000), (1, 90_000)] {
        set_whole(&mut station, "SIM_TRAFFIC", open);
        station.run_ms(wait_ms);
        let closures = BridgeClosures::from_codes(codes(&station));
        assert_eq!(station.sim.site().traffic().closures(), &closures);
        // A program that has the scenario, the seed and the telemetry must be able to compute the same cars.
        let theirs = Site::build(&scenario("two-bridges"), 7).with_changes(SiteChanges { closures, ..SiteChanges::default() });
        let now = station.sim.now();
        let (here, there) = (station.sim.site().traffic().solids(now), theirs.traffic().solids(now));
        assert_eq!(here, there);
        let driving = here.iter().filter(|(object, surface, _)| *surface == Surface::Vehicle && *object != CREW_TRUCK).count();
        assert_eq!(driving > 0, open == 1, "{driving} vehicle parts on the bridges after 90 s");
    }
}

#[test]
fn exact_bridge_closures_are_deterministic() {
    let flown = || {
        let mut station = Station::new("two-bridges", 7);
        station.run_ms(3_000);
        set_whole(&mut station, "SIM_TRAFFIC", 0);
        station.run_ms(5_000);
        (station.sim.digest(), station.sim.site().traffic().closures().clone())
    };
    assert_eq!(flown(), flown());
}

#[test]
fn wire_link_impairment_loses_and_delays_datagrams() {
    let mut station = Station::new("drill-hover", 7);
    station.run_ms(1_000);
    let frames = |s: &mut Station| {
        s.received.clear();
        s.run_ms(5_000);
        s.received.iter().filter(|f| f.message_id == 30).count() as f64
    };
    let good = frames(&mut station);
    set_real(&mut station, "SIM_LINK_LOSS", 50.0);
    let share = frames(&mut station) / good;
    assert!((0.35..0.65).contains(&share), "{share}");
    // The command to restore the radio must get through the degraded link.
    let healed = (0..100).any(|_| station.set("SIM_LINK_LOSS", 0.0, MavParamType::MAV_PARAM_TYPE_REAL32).is_some());
    assert!(healed);
    station.send(&MavMessage::PARAM_SET(PARAM_SET_DATA {
        param_value: f32::from_bits(150),
        target_system: 1,
        target_component: 1,
        param_id: "SIM_LINK_DELAY".into(),
        param_type: MavParamType::MAV_PARAM_TYPE_INT32,
    }));
    station.run_ms(5);
    let asked_at = station.sim.now();
    station.received.clear();
    station.send(&MavMessage::TIMESYNC(TIMESYNC_DATA { ts1: 77, ..Default::default() }));
    while station
        .last_message(|m| if let MavMessage::TIMESYNC(t) = m { (t.tc1 != 0 && t.ts1 == 77).then_some(()) } else { None })
        .is_none()
    {
        station.run_ms(1);
        assert!((station.sim.now() - asked_at).ms() < 1_000, "the response must arrive despite the delay");
    }
    let there_and_back = (station.sim.now() - asked_at).ms();
    assert!((300..=305).contains(&there_and_back), "{there_and_back} ms");
}
