//! Parameters and launch arguments.

use super::super::{DEFAULTS_FILE, launch, parameters};
use super::{aircraft, settings};
use crate::backend::launch::LaunchParam;
use spandrel_model::vehicle::{FlightLimits, Vehicle};
use std::collections::BTreeMap;

const SHIPPED: [&str; 4] = ["phantom2", "f450", "m30", "elios3"];

fn table(vehicle: &Vehicle) -> BTreeMap<String, f64> {
    let parameters = parameters(vehicle, &settings()).expect("frame");
    let value = |p: &LaunchParam| p.value.parse().expect("number");
    let table: BTreeMap<String, f64> = parameters.iter().map(|p| (p.name.clone(), value(p))).collect();
    assert_eq!(table.len(), parameters.len(), "a name occurs twice");
    table
}

/// Returns the names whose values differ.
fn differences(a: &Vehicle, b: &Vehicle) -> Vec<String> {
    let (a, b) = (table(a), table(b));
    a.iter().filter(|(name, value)| b[*name] != **value).map(|(name, _)| name.clone()).collect()
}

#[test]
fn exact_each_flight_limit_reaches_the_table() {
    type Change = fn(&mut FlightLimits);
    let changes: [(Change, &str); 7] = [
        (|l| l.forward_m_s = 4.0, "LOIT_SPEED"),
        (|l| l.climb_m_s = 1.5, "PILOT_SPEED_UP"),
        (|l| l.descend_m_s = 1.0, "PILOT_SPEED_DN"),
        (|l| l.yaw_rate_rad_s = 1.0, "PILOT_Y_RATE"),
        (|l| l.tilt_rad = 0.4, "ANGLE_MAX"),
        (|l| l.rate_rad_s = 2.0, "ATC_RATE_R_MAX"),
        (|l| l.slow_down_time_s = 4.0, "LOIT_ANG_MAX"),
    ];
    for id in SHIPPED {
        for (change, name) in changes {
            let mut changed = aircraft(id);
            change(&mut changed.limits);
            let differences = differences(&aircraft(id), &changed);
            assert!(differences.iter().any(|d| d == name), "{id}, {name}: {differences:?}");
        }
    }
}

/// ArduPilot has one horizontal speed limit for all directions.
#[test]
fn exact_sideways_limit_has_no_effect() {
    let mut changed = aircraft("m30");
    changed.limits.sideways_speed_m_s = 1.0;
    assert_eq!(differences(&aircraft("m30"), &changed), Vec::<String>::new());
}

#[test]
fn exact_values_have_both_units() {
    let table = table(&aircraft("phantom2"));
    for (name, expected) in [
        ("LOIT_SPEED", 1341.0),
        ("LOIT_SPEED_MS", 13.4112),
        ("ANGLE_MAX", 3500.0),
        ("ATC_ANGLE_MAX", 35.0),
        ("PILOT_Y_RATE", 100.0),
        ("WPNAV_SPEED", 500.0),
        ("WP_SPD", 5.0),
        ("BATT_CAPACITY", 5200.0),
        ("BATT_LOW_MAH", 1300.0),
        ("SYSID_THISMAV", 3.0),
        ("MAV_SYSID", 3.0),
        ("SYSID_MYGCS", 255.0),
        ("MAV_GCS_SYSID", 255.0),
        ("GPS_TYPE", 14.0),
        ("GPS1_TYPE", 14.0),
        ("SCHED_LOOP_RATE", 250.0),
        ("SERVO1_FUNCTION", 33.0),
        ("SERVO4_FUNCTION", 36.0),
    ] {
        assert!((table[name] - expected).abs() < 1e-3, "{name} = {}", table[name]);
    }
}

#[test]
fn prop_tables_of_shipped_aircraft_are_within_documented_ranges() {
    for id in SHIPPED {
        let table = table(&aircraft(id));
        for (name, low, high) in [
            ("MOT_THST_EXPO", 0.5, 0.9),
            ("MOT_THST_HOVER", 0.125, 0.6875),
            ("ATC_RAT_RLL_P", 0.01, 0.5),
            ("ATC_RAT_PIT_D", 0.0, 0.05),
            ("ATC_RAT_YAW_P", 0.1, 2.5),
            ("ATC_ANG_RLL_P", 3.0, 12.0),
            ("LOIT_SPEED", 20.0, 3500.0),
            ("LOIT_ANG_MAX", 10.0, 35.0),
            ("LOIT_BRK_ACCEL", 25.0, 250.0),
            ("PILOT_SPEED_UP", 50.0, 500.0),
            ("WPNAV_SPEED_DN", 10.0, 500.0),
            ("INS_GYRO_FILTER", 20.0, 80.0),
        ] {
            assert!((low..=high).contains(&table[name]), "{id}: {name} = {}", table[name]);
        }
    }
}

/// ArduPilot ignores longer names and cuts lines after 98 characters.
#[test]
fn wire_defaults_file_has_lines_that_ardupilot_reads() {
    let launch = launch(&aircraft("elios3"), &settings()).expect("frame");
    let [file] = &launch.files[..] else { panic!("{:?}", launch.files) };
    assert_eq!((file.name.as_str(), file.executable), (DEFAULTS_FILE, false));
    let lines: Vec<_> = file.text.lines().filter(|line| !line.starts_with('#')).collect();
    assert_eq!(lines.len(), launch.parameters.len());
    for line in lines {
        let (name, value) = line.split_once(' ').expect("two words");
        assert!(name.len() <= 16 && line.len() < 98 && value.parse::<f64>().is_ok(), "{line}");
    }
}

#[test]
fn wire_arguments_open_only_the_chosen_ports() {
    let launch = launch(&aircraft("phantom2"), &settings()).expect("frame");
    let value = |name: &str| {
        let at = launch.args.iter().position(|arg| arg == name).unwrap_or_else(|| panic!("no {name}"));
        launch.args[at + 1].as_str()
    };
    assert_eq!(value("--model"), "JSON:127.0.0.1");
    assert_eq!((value("--sim-port-out"), value("--instance")), ("9022", "2"));
    assert_eq!(value("--serial0"), "udpclient:127.0.0.1:14571");
    assert_eq!(value("--rc-in-port"), "0");
    assert_eq!((value("--serial1"), value("--serial8")), ("none:", "none:"));
    assert_eq!(value("--home"), "47.39774200,8.54559400,488.000,90.0");
    assert_eq!((value("--rate"), value("--defaults")), ("500", DEFAULTS_FILE));
    // ArduPilot removes only this spelling when a reboot command restarts it.
    assert_eq!(launch.first_args, ["-w"]);
    assert!(launch.args(true).any(|arg| arg == "-w") && !launch.args(false).any(|arg| arg == "-w" || arg == "--wipe"));
    assert!(launch.environment.is_empty());
}

#[test]
fn exact_command_line_can_be_pasted() {
    let launch = launch(&aircraft("phantom2"), &settings()).expect("frame");
    let line = launch.command_line(true, "/opt/my builds/arducopter", &[], &[]);
    assert!(line.starts_with("'/opt/my builds/arducopter' --model JSON:127.0.0.1 --sim-port-out 9022 "), "{line}");
    assert!(line.ends_with(" -w"), "{line}");
    assert!(!launch.command_line(false, "arducopter", &[], &[]).contains(" -w"), "parameters survive a restart");
}
