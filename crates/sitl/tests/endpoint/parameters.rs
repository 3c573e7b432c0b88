//! Parameters: the names that QGroundControl's setup pages and the autopilots' own test suites use must exist, be
//! described, and take effect.
#![allow(deprecated, reason = "clients still send superseded MAVLink messages")]

use super::copter::{ARM, AUTO, SET_MODE, copter, copter_at, mode, next_heartbeat};
use spandrel_mavlink::dialect::*;
use spandrel_sitl::autopilot::operator_rules::{
    FailsafeResponse, HeadingRule, HeightReference, LinkLossExceptions, MissionRequirement, OffboardLoss, ReturnTargets,
};
use spandrel_sitl::autopilot::{FlightMode, LinkLossAction, OperatorRules, Tuning};
use spandrel_sitl::endpoint::params::param_view::{COPTER, PX4, ParamView};
use spandrel_sitl::endpoint::params::{AircraftValues, ParamValue, Params, metadata};
use spandrel_testkit::plans::{item, upload};
use spandrel_testkit::station::{Station, one, p};
use std::io::Cursor;

const ACCEPTED: MavResult = MavResult::MAV_RESULT_ACCEPTED;
const FAILED: MavResult = MavResult::MAV_RESULT_FAILED;
/// Minimum fraction of these names that must exist (issue 16).
const MIN_SUPPORTED_FRACTION: f64 = 0.9;

const QGROUNDCONTROL_PX4: &str = include_str!("names/qgroundcontrol-px4.tsv");
const QGROUNDCONTROL_COPTER: &str = include_str!("names/qgroundcontrol-copter.tsv");
const SUITE_PX4: &str = include_str!("names/suite-px4.tsv");
const SUITE_COPTER: &str = include_str!("names/suite-copter.tsv");

fn params(face: &'static ParamView) -> Params {
    Params::new(1, AircraftValues::SMALL_AIRCRAFT, face)
}

/// Returns the names in a list, each with the fields of the autopilot's own description.
fn names(list: &str) -> Vec<(&str, &str)> {
    list.lines().filter(|line| !line.starts_with('#')).filter_map(|line| line.split_once('\t')).collect()
}

/// Returns the parameter descriptions that a ground station receives.
fn described(face: &ParamView) -> Vec<serde_json::Value> {
    let mut text = Vec::new();
    lzma_rs::xz_decompress(&mut Cursor::new(&metadata::files(face).parameter.bytes), &mut text).unwrap();
    let file: serde_json::Value = serde_json::from_slice(&text).unwrap();
    file["parameters"].as_array().unwrap().clone()
}

#[test]
fn regress_parameters_of_qgroundcontrols_setup_pages_exist_with_metadata() {
    for (face, list) in [(&PX4, QGROUNDCONTROL_PX4), (&COPTER, QGROUNDCONTROL_COPTER)] {
        let (own, all) = (params(face), described(face));
        let mut wrong = Vec::new();
        for (name, parts) in names(list) {
            let Some(row) = all.iter().find(|row| row["name"] == name).filter(|_| own.find(name).is_some()) else {
                wrong.push(format!("{name} is missing"));
                continue;
            };
            let lists = |key: &str| row[key].as_array().is_some_and(|list| !list.is_empty());
            let text = |key: &str| row[key].as_str().is_some_and(|text| !text.is_empty());
            // A custom mask may be described by its values, and vice versa.
            let worded = lists("values") || lists("bitmask");
            let kept = !parts.contains("enum") && !parts.contains("bits") || worded;
            if !(text("shortDesc") && text("longDesc") && kept && (!parts.contains("unit") || text("units"))) {
                wrong.push(format!("{name} lacks text, unit or enum: {row}"));
            }
        }
        assert!(wrong.is_empty(), "{}", wrong.join("\n"));
    }
}

#[test]
fn regress_flight_mode_slot_values_have_descriptions() {
    for (face, prefix) in [(&PX4, "COM_FLTMODE"), (&COPTER, "FLTMODE")] {
        let (own, all) = (params(face), described(face));
        for slot in 1..=6 {
            let name = format!("{prefix}{slot}");
            let row = all.iter().find(|row| row["name"] == name.as_str()).unwrap();
            let Some((_, _, ParamValue::Int(value))) = own.find(&name) else { panic!("{name} is not an integer") };
            let worded = row["values"].as_array().unwrap().iter().any(|entry| entry["value"] == value);
            assert!(worded, "{name} = {value} has no description: {row}");
        }
    }
}

#[test]
fn regress_90_percent_of_setup_page_and_test_suite_parameters_exist() {
    for (face, lists) in [(&PX4, [QGROUNDCONTROL_PX4, SUITE_PX4]), (&COPTER, [QGROUNDCONTROL_COPTER, SUITE_COPTER])] {
        let own = params(face);
        let mut all: Vec<&str> = lists.iter().flat_map(|list| names(list)).map(|(name, _)| name).collect();
        all.sort_unstable();
        all.dedup();
        let missing: Vec<&&str> = all.iter().filter(|name| own.find(name).is_none()).collect();
        let share = 1.0 - missing.len() as f64 / all.len() as f64;
        println!("flavor {}: {} of {} names, {:.1}%", face.number, all.len() - missing.len(), all.len(), 100.0 * share);
        assert!(share >= MIN_SUPPORTED_FRACTION, "flavor {}: {share}, missing {missing:?}", face.number);
        let suite = names(lists[1]);
        let known = suite.iter().filter(|(name, _)| own.find(name).is_some()).count();
        println!("flavor {}: suite only, {known} of {}", face.number, suite.len());
        assert!(
            known as f64 >= MIN_SUPPORTED_FRACTION * suite.len() as f64,
            "flavor {}: {known} of {}",
            face.number,
            suite.len()
        );
    }
}

/// Returns the tuning after setting a parameter.
fn tuning_after(face: &'static ParamView, name: &str, value: f64) -> Tuning {
    let mut own = params(face);
    let kind = own.find(name).unwrap_or_else(|| panic!("{name}")).2;
    let value = match kind {
        ParamValue::Int(_) => ParamValue::Int(value as i32),
        ParamValue::Real(_) => ParamValue::Real(value as f32),
    };
    assert_eq!(own.set_value(name, value), Ok(()), "{name}");
    let mut tuning = Tuning::default();
    own.apply(&mut tuning);
    tuning
}

#[test]
fn exact_default_parameters_give_the_default_tuning() {
    let mut tuning = Tuning::default();
    params(&PX4).apply(&mut tuning);
    let mut expected = OperatorRules::default();
    // The parameter has 32 bits on the wire.
    expected.responses.battery_emergency_pct = 100.0 * f64::from(0.05f32);
    expected.responses.takeover_deflection = tuning.rules.responses.takeover_deflection;
    assert!((tuning.rules.responses.takeover_deflection - 0.3).abs() < 1e-6);
    assert_eq!(tuning.rules, expected);
}

type Check = fn(&Tuning) -> bool;

#[test]
fn exact_px4_parameters_change_their_settings() {
    let checks: [(&str, f64, Check); 23] = [
        ("COM_RCL_EXCEPT", 5.0, |t| {
            t.rules.responses.manual_loss_exceptions
                == LinkLossExceptions { mission: true, hold: false, offboard: true, manual: false }
        }),
        ("COM_DLL_EXCEPT", 2.0, |t| t.rules.responses.data_link_loss_exceptions.hold),
        ("COM_OBL_RC_ACT", 4.0, |t| t.rules.responses.offboard_loss == OffboardLoss::Fixed(FailsafeResponse::Land)),
        ("COM_ACT_FAIL_ACT", 3.0, |t| t.rules.responses.motor_failure == FailsafeResponse::Return),
        ("COM_LOW_BAT_ACT", 3.0, |t| {
            t.rules.responses.battery == [None, Some(FailsafeResponse::Return), Some(FailsafeResponse::Land)]
        }),
        ("COM_FAIL_ACT_T", 2.0, |t| t.failsafe_delay_s == 2.0),
        ("COM_RC_OVERRIDE", 2.0, |t| !t.stick_takeover && t.rules.responses.takeover_in_offboard),
        ("COM_RC_STICK_OV", 50.0, |t| t.rules.responses.takeover_deflection == 0.5),
        ("COM_ARM_MIS_REQ", 1.0, |t| t.rules.responses.arming_requires_mission),
        ("COM_ARM_BAT_MIN", 0.5, |t| t.rules.responses.min_arming_charge_pct == 50.0),
        ("COM_POSCTL_NAVL", 1.0, |t| t.rules.responses.lands_without_position),
        ("NAV_RCL_ACT", 5.0, |t| t.manual_loss == LinkLossAction::Terminate),
        ("RTL_TYPE", 1.0, |t| t.rules.return_rules.places == ReturnTargets { home: false, rally: true, mission_landing: true }),
        ("RTL_LAND_DELAY", 12.0, |t| t.rules.return_rules.wait_s == 12.0),
        ("RTL_DESCEND_ALT", 7.0, |t| t.rules.return_rules.loiter_height_m == Some(7.0)),
        ("RTL_CONE_ANG", 45.0, |t| (t.rules.return_rules.cone_slope - 1.0).abs() < 1e-9),
        ("MPC_ACC_HOR", 2.0, |t| t.rules.envelope.acceleration_m_s2 == 2.0),
        ("MPC_VEL_MANUAL", 3.0, |t| t.rules.envelope.manual_speed_m_s == 3.0),
        ("MPC_MAN_Y_MAX", 90.0, |t| (t.rules.envelope.manual_yaw_rate_rad_s - 90f64.to_radians()).abs() < 1e-12),
        ("MPC_YAW_MODE", 5.0, |t| t.rules.heading == HeadingRule::Fixed),
        ("MPC_Z_V_AUTO_UP", 1.0, |t| t.climb_m_s == 1.0),
        ("MIS_TKO_LAND_REQ", 4.0, |t| t.rules.mission_requirement == MissionRequirement::BothOrNeither),
        ("MIS_TAKEOFF_ALT", 100.0, |t| t.takeoff_height_m == 100.0),
    ];
    for (name, value, holds) in checks {
        assert!(!holds(&Tuning::default()), "{name}: the check must not pass before the change");
        assert!(holds(&tuning_after(&PX4, name, value)), "{name} = {value}");
    }
}

#[test]
fn exact_copter_parameters_change_their_settings() {
    let checks: [(&str, f64, Check); 24] = [
        ("FS_OPTIONS", 1.0, |t| {
            t.rules.responses.manual_loss_exceptions.mission && !t.rules.responses.data_link_loss_exceptions.manual
        }),
        ("FS_OPTIONS", 18.0, |t| {
            t.rules.responses.data_link_loss_exceptions.mission && t.rules.responses.data_link_loss_exceptions.manual
        }),
        ("BATT_FS_LOW_ACT", 2.0, |t| t.rules.responses.battery[0] == Some(FailsafeResponse::Return)),
        ("BATT_FS_CRT_ACT", 5.0, |t| t.rules.responses.battery[1] == Some(FailsafeResponse::Terminate)),
        ("BATT_LOW_VOLT", 10.5, |t| t.rules.responses.battery_low_v == [10.5, 0.0]),
        ("BATT_ARM_VOLT", 11.0, |t| t.rules.responses.min_arming_voltage_v == 11.0),
        ("FS_EKF_ACTION", 1.0, |t| t.rules.responses.lands_without_position),
        ("FS_CRASH_CHECK", 0.0, |t| !t.rules.responses.crash_check),
        ("RTL_SPEED", 250.0, |t| t.rules.return_rules.speed_m_s == Some(2.5)),
        ("RTL_ALT_FINAL", 300.0, |t| t.rules.return_rules.final_height_m == 3.0),
        ("RTL_LOIT_TIME", 2_000.0, |t| t.rules.return_rules.wait_s == 2.0),
        ("RTL_CLIMB_MIN", 400.0, |t| t.rules.return_rules.min_climb_m == 4.0),
        ("RTL_CONE_SLOPE", 3.0, |t| t.rules.return_rules.cone_slope == 3.0),
        ("RALLY_INCL_HOME", 0.0, |t| !t.rules.return_rules.places.home),
        ("WP_YAW_BEHAVIOR", 0.0, |t| t.rules.heading == HeadingRule::Fixed),
        ("MIS_RESTART", 1.0, |t| t.rules.mission_restarts),
        ("CIRCLE_RADIUS", 1_200.0, |t| t.rules.orbit_radius_m == 12.0),
        ("FENCE_TYPE", 8.0, |t| !t.rules.fence.areas && t.rules.fence.floor_m == Some(-10.0)),
        ("LAND_SPEED_HIGH", 100.0, |t| t.rules.envelope.landing_descent_rate_m_s == 1.0),
        ("LAND_ALT_LOW", 800.0, |t| t.slow_landing_height_m == 8.0),
        ("LOIT_SPEED", 300.0, |t| t.rules.envelope.manual_speed_m_s == 3.0),
        ("PILOT_SPEED_UP", 100.0, |t| {
            t.rules.envelope.manual_climb_rate_m_s == 1.0 && t.rules.envelope.manual_descent_rate_m_s == 1.0
        }),
        ("WPNAV_ACCEL", 150.0, |t| t.rules.envelope.acceleration_m_s2 == 1.5),
        ("ANGLE_MAX", 2_000.0, |t| (t.rules.envelope.manual_tilt_rad - 20f64.to_radians()).abs() < 1e-9),
    ];
    for (name, value, holds) in checks {
        let mut before = Tuning::default();
        params(&COPTER).apply(&mut before);
        assert!(!holds(&before), "{name}: the check must not pass before the change");
        assert!(holds(&tuning_after(&COPTER, name, value)), "{name} = {value}");
    }
    assert_eq!(tuning_after(&COPTER, "MAV_GCS_SYSID", 42.0).rules, tuning_after(&COPTER, "SYSID_MYGCS", 42.0).rules);
}

fn set(station: &mut Station, name: &str, value: f32) {
    let kind = MavParamType::MAV_PARAM_TYPE_REAL32;
    let set =
        PARAM_SET_DATA { param_value: value, target_system: 1, target_component: 1, param_id: name.into(), param_type: kind };
    let told = station.ask(&MavMessage::PARAM_SET(set), |m| match m {
        MavMessage::PARAM_VALUE(v) if v.param_id.to_str() == Ok(name) => Some(v.param_value),
        _ => None,
    });
    assert_eq!(told, Some(value), "{name}");
}

fn value(station: &mut Station, name: &str) -> f32 {
    let read = PARAM_REQUEST_READ_DATA { param_index: -1, target_system: 1, target_component: 1, param_id: name.into() };
    station
        .ask(
            &MavMessage::PARAM_REQUEST_READ(read),
            |m| if let MavMessage::PARAM_VALUE(v) = m { Some(v.param_value) } else { None },
        )
        .unwrap_or_else(|| panic!("{name}"))
}

fn pulses(us: [u16; 4]) -> MavMessage {
    MavMessage::RC_CHANNELS_OVERRIDE(RC_CHANNELS_OVERRIDE_DATA {
        chan1_raw: us[0],
        chan2_raw: us[1],
        chan3_raw: us[2],
        chan4_raw: us[3],
        target_system: 1,
        target_component: 1,
        ..Default::default()
    })
}

const LOITER: f32 = 5.0;
const LOITER_NUMBER: u32 = 5;
const BRAKE_NUMBER: u32 = 17;

#[test]
fn wire_sticks_are_accepted_only_from_sysid_mygcs() {
    let mut station = copter_at(6.0);
    station.send(&pulses([1_500; 4]));
    station.run_ms(50);
    assert_eq!(station.command(1, SET_MODE, mode(LOITER)), ACCEPTED);
    set(&mut station, "SYSID_MYGCS", 42.0);
    for _ in 0..20 {
        station.send(&pulses([1_500, 1_300, 1_500, 1_500]));
        station.run_ms(100);
    }
    assert!(station.speed() < 0.5, "sticks from system 255 must be ignored: {} m/s", station.speed());
    station.send_as(42, 190);
    // For a while, the other station still counts as the controlling one.
    for _ in 0..45 {
        station.send(&pulses([1_500, 1_300, 1_500, 1_500]));
        station.run_ms(100);
    }
    assert!(station.speed() > 1.0, "sticks from system 42 must be applied: {} m/s", station.speed());
}

#[test]
fn wire_throttle_below_fs_thr_value_counts_as_rc_loss() {
    let mut station = copter_at(6.0);
    station.send(&pulses([1_500; 4]));
    station.run_ms(50);
    assert_eq!(station.command(1, SET_MODE, mode(LOITER)), ACCEPTED);
    for (throttle, number) in [(1_500, LOITER_NUMBER), (950, BRAKE_NUMBER)] {
        for _ in 0..50 {
            station.send(&pulses([1_500, 1_500, throttle, 1_500]));
            station.run_ms(100);
        }
        assert_eq!(next_heartbeat(&mut station).custom_mode, number, "throttle {throttle} us: {:?}", station.texts());
        station.send(&pulses([1_500; 4]));
        station.run_ms(50);
    }
}

#[test]
fn wire_auto_options_allow_arming_in_auto_and_mis_total_counts_the_mission() {
    let mut station = copter();
    assert_eq!(value(&mut station, "MIS_TOTAL"), 0.0);
    let items = [
        item(0, MavCmd::MAV_CMD_NAV_WAYPOINT, 0.0, 0.0),
        item(1, MavCmd::MAV_CMD_NAV_TAKEOFF, 0.0, 5.0),
        item(2, MavCmd::MAV_CMD_NAV_RETURN_TO_LAUNCH, 0.0, 0.0),
    ];
    assert_eq!(upload(&mut station, &items), MavMissionResult::MAV_MISSION_ACCEPTED);
    assert_eq!(value(&mut station, "MIS_TOTAL"), 3.0);
    assert_eq!(station.command(1, SET_MODE, mode(AUTO)), ACCEPTED);
    assert_eq!(station.command(1, ARM, one(1.0)), FAILED, "arming in AUTO requires the option");
    // The option only allows arming; takeoff waits for the throttle.
    set(&mut station, "AUTO_OPTIONS", 1.0);
    assert_eq!(station.command(1, ARM, one(1.0)), ACCEPTED);
    let ground = station.local_position_after(100)[2];
    station.run_ms(4_000);
    assert!((ground - station.place()[2]).abs() < 0.2, "took off without raising the throttle");
    // With the second option bit set, the vehicle also takes off.
    set(&mut station, "AUTO_OPTIONS", 3.0);
    assert!(station.run_until(15.0, |s| ground - s.place()[2] > 2.0), "no takeoff: {:?}", station.texts());
}

#[test]
fn flight_com_act_fail_act_terminates_on_a_failed_motor() {
    const MOTOR: f32 = 101.0;
    const OFF: f32 = 1.0;
    for terminate in [false, true] {
        let mut station = Station::airborne("drill-hover", 7);
        let whole = |value: i32| f32::from_bits(value.cast_unsigned());
        for (name, value) in [("SYS_FAILURE_EN", 1), ("COM_ACT_FAIL_ACT", if terminate { 4 } else { 0 })] {
            let kind = MavParamType::MAV_PARAM_TYPE_INT32;
            let set = PARAM_SET_DATA {
                param_value: whole(value),
                target_system: 1,
                target_component: 1,
                param_id: name.into(),
                param_type: kind,
            };
            station.send(&MavMessage::PARAM_SET(set));
        }
        station.run_ms(20);
        assert_eq!(station.command(1, MavCmd::MAV_CMD_INJECT_FAILURE, p(&[MOTOR, OFF, 1.0])), ACCEPTED);
        station.run_until(3.0, |s| s.has_text("Disarmed: motor failure"));
        assert!(station.has_text("Attitude control lost"), "{:?}", station.texts());
        assert_eq!(station.has_text("Disarmed: motor failure"), terminate, "{:?}", station.texts());
    }
}

#[test]
fn exact_rc_loss_exceptions_apply_to_the_right_modes() {
    for mode in [FlightMode::Land, FlightMode::Return] {
        assert!(LinkLossExceptions::default().includes(mode), "{mode:?}");
    }
    assert!(
        !LinkLossExceptions::default().includes(FlightMode::Mission)
            && LinkLossExceptions::from_bits(1).includes(FlightMode::Mission)
    );
}

#[test]
fn regress_height_reference_accepts_every_value_and_affects_the_filter() {
    use HeightReference::{Barometer, Gnss, RangeFinder};
    const INT: MavParamType = MavParamType::MAV_PARAM_TYPE_INT32;
    const REAL: MavParamType = MavParamType::MAV_PARAM_TYPE_REAL32;
    let references = [Barometer, Gnss, RangeFinder, Gnss];
    for (face, name, codes) in [(&PX4, "EKF2_HGT_REF", [0, 1, 2, 3]), (&COPTER, "EK3_SRC1_POSZ", [1, 3, 2, 6])] {
        let (mut own, all) = (params(face), described(face));
        let row = all.iter().find(|row| row["name"] == name).unwrap();
        assert!(!row["longDesc"].as_str().unwrap().contains("No effect"), "{row}");
        for (code, reference) in codes.into_iter().zip(references) {
            let (wire, kind) = if face.cast { (code as f32, REAL) } else { (ParamValue::Int(code).to_wire(), INT) };
            assert_eq!(own.set(name, wire, kind), Ok(()), "{name} {code}");
            let mut tuning = Tuning::default();
            own.apply(&mut tuning);
            assert_eq!(tuning.rules.height_reference, reference, "{name} {code}");
        }
    }
}
