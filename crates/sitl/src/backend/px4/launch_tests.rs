//! Tests of the parameter table, the scripts and the command line.

use super::testing::{settings, shipped};
use super::{launch, parameters};
use crate::backend::launch::{LaunchParam, LaunchSettings};
use spandrel_model::math::{self, GRAVITY_M_S2};
use spandrel_model::vehicle::{FlightLimits, Vehicle};
use std::collections::BTreeMap;

fn table(vehicle: &Vehicle, settings: &LaunchSettings) -> BTreeMap<String, f64> {
    let rows = parameters(vehicle, settings);
    let out: BTreeMap<String, f64> = rows.iter().map(|row| (row.name.clone(), row.value.parse().unwrap())).collect();
    assert_eq!(out.len(), rows.len(), "a parameter appears twice");
    out
}

fn close(got: f64, expected: f64) {
    assert!((got - expected).abs() <= 1e-6 * expected.abs().max(1.0), "{got} instead of {expected}");
}

#[test]
fn exact_rotor_layout_of_the_shipped_aircraft() {
    for vehicle in shipped() {
        let rows = table(&vehicle, &settings());
        assert_eq!((rows["CA_AIRFRAME"], rows["CA_ROTOR_COUNT"]), (0.0, 4.0));
        for (k, rotor) in vehicle.rotors.iter().enumerate() {
            for (axis, place) in ["PX", "PY", "PZ"].iter().zip(rotor.position_m.array()) {
                close(rows[&format!("CA_ROTOR{k}_{axis}")], place);
            }
            let ratio = vehicle.rotor.torque_coefficient_n_m_s2 / vehicle.rotor.thrust_coefficient_n_s2;
            close(rows[&format!("CA_ROTOR{k}_KM")], rotor.spin * ratio);
            assert_eq!(rows[&format!("PWM_MAIN_FUNC{}", k + 1)], 101.0 + k as f64);
        }
        assert!(!rows.contains_key("PWM_MAIN_FUNC5"));
    }
}

#[test]
fn exact_thrust_curve_is_the_rotor_model() {
    for vehicle in shipped() {
        let settings = settings();
        let rows = table(&vehicle, &settings);
        // The hover throttle holds at the site's altitude.
        let vehicle = vehicle.at_altitude(settings.home.altitude_m);
        let (factor, hover) = (rows["THR_MDL_FAC"], rows["MPC_THR_HOVER"]);
        let m = &vehicle.rotor;
        let thrust_n = |command: f64| {
            let speed = m.idle_speed_rad_s + command * (m.max_speed_rad_s - m.idle_speed_rad_s);
            m.thrust_coefficient_n_s2 * speed * speed
        };
        for command in [0.1, 0.35, 0.8] {
            let share = (thrust_n(command) - thrust_n(0.0)) / (thrust_n(1.0) - thrust_n(0.0));
            close(factor * command * command + (1.0 - factor) * command, share);
        }
        let share = |command: f64| factor * command * command + (1.0 - factor) * command;
        let model = crate::physics::AirframeModel::new(&vehicle, spandrel_model::scenario::BatteryModel::Physical);
        close(share(model.hover_command()), hover);
        close(thrust_n(model.hover_command()) * 4.0, vehicle.mass_kg * GRAVITY_M_S2);
    }
}

#[test]
fn exact_speeds_and_rates_of_the_shipped_aircraft() {
    for vehicle in shipped() {
        let (rows, l) = (table(&vehicle, &settings()), &vehicle.limits);
        close(rows["MPC_VEL_MANUAL"], l.forward_m_s);
        close(rows["MPC_VEL_MAN_SIDE"], l.sideways_speed_m_s);
        close(rows["MPC_Z_VEL_MAX_UP"], l.climb_m_s);
        close(rows["MPC_Z_VEL_MAX_DN"], l.descend_m_s);
        close(rows["MPC_MAN_Y_MAX"], l.yaw_rate_rad_s.to_degrees());
        close(rows["MPC_TILTMAX_AIR"], l.tilt_rad.to_degrees());
        close(rows["MC_PITCHRATE_MAX"], l.rate_rad_s.to_degrees());
        assert!(rows["MPC_XY_VEL_MAX"] >= rows["MPC_VEL_MANUAL"]);
        assert!(rows["MPC_Z_V_AUTO_UP"] <= rows["MPC_Z_VEL_MAX_UP"] && rows["MPC_XY_CRUISE"] <= rows["MPC_XY_VEL_MAX"]);
        for name in ["MPC_XY_MAN_EXPO", "MPC_Z_MAN_EXPO", "MPC_YAW_EXPO"] {
            assert_eq!(rows[name], 0.0, "{name}");
        }
    }
}

/// Selects one limit.
type Field = fn(&mut FlightLimits) -> &mut f64;

#[test]
fn prop_every_flight_limit_reaches_the_table() {
    let base = shipped()[0].clone();
    let before = parameters(&base, &settings());
    // The pattern lists every field, so a new one does not compile until it is here.
    let FlightLimits {
        forward_m_s: _,
        sideways_speed_m_s: _,
        climb_m_s: _,
        descend_m_s: _,
        yaw_rate_rad_s: _,
        tilt_rad: _,
        rate_rad_s: _,
        slow_down_time_s: _,
    } = base.limits;
    let changes: [(&str, Field); 8] = [
        ("forward", |l| &mut l.forward_m_s),
        ("sideways", |l| &mut l.sideways_speed_m_s),
        ("climb", |l| &mut l.climb_m_s),
        ("descend", |l| &mut l.descend_m_s),
        ("yaw rate", |l| &mut l.yaw_rate_rad_s),
        ("tilt", |l| &mut l.tilt_rad),
        ("rate", |l| &mut l.rate_rad_s),
        ("slow-down time", |l| &mut l.slow_down_time_s),
    ];
    for (name, field) in changes {
        let mut vehicle = base.clone();
        *field(&mut vehicle.limits) *= 1.1;
        assert_ne!(parameters(&vehicle, &settings()), before, "{name}");
    }
}

#[test]
fn exact_values_stay_in_px4s_ranges() {
    let mut vehicle = shipped()[0].clone();
    vehicle.limits = FlightLimits {
        forward_m_s: 40.0,
        sideways_speed_m_s: 0.5,
        climb_m_s: 20.0,
        descend_m_s: 0.3,
        yaw_rate_rad_s: 720.0_f64.to_radians(),
        tilt_rad: 5.0_f64.to_radians(),
        rate_rad_s: 20.0_f64.to_radians(),
        slow_down_time_s: 10.0,
    };
    let rows = table(&vehicle, &settings());
    let got = ["MPC_VEL_MANUAL", "MPC_Z_VEL_MAX_UP", "MPC_Z_VEL_MAX_DN", "MPC_MAN_Y_MAX", "MPC_TILTMAX_AIR", "MPC_ACC_HOR"];
    got.iter().zip([20.0, 8.0, 0.5, 400.0, 20.0, 40.0 / 7.0]).for_each(|(name, value)| close(rows[*name], value));
    assert!(rows["MPC_LAND_SPEED"] >= 0.6 && rows["MPC_TKO_SPEED"] <= 5.0);
}

#[test]
fn exact_settings_reach_the_table() {
    let vehicle = &shipped()[0];
    let rows = table(vehicle, &settings());
    assert_eq!((rows["BAT_LOW_THR"], rows["BAT_CRIT_THR"], rows["BAT_EMERGEN_THR"]), (0.3, 0.15, 0.075));
    assert_eq!((rows["BAT1_N_CELLS"], rows["BAT1_CAPACITY"], rows["SIM_BAT_ENABLE"]), (3.0, 5200.0, 0.0));
    assert_eq!((rows["COM_DL_LOSS_T"], rows["COM_RC_LOSS_T"]), (10.0, 0.5));
    assert_eq!((rows["IMU_GYRO_RATEMAX"], rows["IMU_INTEG_RATE"]), (800.0, 250.0));
    assert_eq!((rows["MNT_MODE_IN"], rows["MNT_MODE_OUT"], rows["COM_RC_IN_MODE"]), (4.0, 2.0, 1.0));
    assert!(!rows.contains_key("SYS_FAILURE_EN"));
    let fast = table(vehicle, &LaunchSettings { client_speed_factor: 8.0, rate_hz: 1000.0, ..settings() });
    assert_eq!((fast["COM_DL_LOSS_T"], fast["COM_RC_LOSS_T"], fast["COM_OF_LOSS_T"]), (80.0, 4.0, 8.0));
    assert_eq!((fast["IMU_GYRO_RATEMAX"], fast["IMU_INTEG_RATE"]), (1000.0, 1000.0));
    let fastest = table(vehicle, &LaunchSettings { client_speed_factor: 1e6, ..settings() });
    assert_eq!((fastest["COM_DL_LOSS_T"], fastest["COM_RC_LOSS_T"]), (300.0, 35.0));
    let field = crate::sensors::magnetometer::earth_field_gauss(settings().home);
    close(rows["EKF2_MAG_DECL"], math::atan2(field.east(), field.north()).to_degrees());
}

#[test]
fn exact_integers_have_no_decimal_point() {
    let rows = parameters(&shipped()[0], &settings());
    let value = |name: &str| rows.iter().find(|row| row.name == name).map(|row| row.value.clone());
    assert_eq!(value("CA_ROTOR_COUNT").as_deref(), Some("4"));
    assert_eq!(value("COM_DL_LOSS_T").as_deref(), Some("10"));
    assert_eq!(value("MPC_VEL_MANUAL").as_deref(), Some("13.4112"));
    assert_eq!(value("MPC_XY_MAN_EXPO").as_deref(), Some("0.0"));
    assert!(rows.iter().all(|row: &LaunchParam| row.name.len() <= 16), "PX4's names have at most 16 characters");
}

#[test]
fn exact_launch_passes_every_parameter_and_replaces_px4s_links() {
    let out = launch(&shipped()[2], &settings());
    assert_eq!(out.args, ["-i", "2", "-d"]);
    assert!(out.environment.windows(2).all(|pair| pair[0].0 < pair[1].0), "sorted, no name twice");
    let get = |name: &str| out.environment.iter().find(|(key, _)| key == name).map(|(_, value)| value.as_str());
    assert_eq!((get("PX4_SYS_AUTOSTART"), get("PX4_SIM_MODEL")), (Some("10016"), Some("none_iris")));
    assert_eq!(get("PX4_SIM_SPEED_FACTOR"), None);
    for param in &out.parameters {
        assert_eq!(get(&format!("PX4_PARAM_{}", param.name)), Some(param.value.as_str()));
    }
    assert_eq!(out.environment.len(), out.parameters.len() + 2);
    let [mavlink] = out.files.as_slice() else { panic!("{:?}", out.files) };
    assert_eq!(mavlink.name, "px4-rc.mavlink");
    assert_eq!(mavlink.text.matches("mavlink start").count(), 1);
    assert!(mavlink.text.contains("\nmavlink start -x -u 15100 -o 15000 -r 4000000 -f\n"), "{}", mavlink.text);
    assert!(mavlink.text.contains("\nmavlink stream -r 20 -s GIMBAL_DEVICE_SET_ATTITUDE -u 15100\n"));
}

#[test]
fn exact_other_simulator_port_needs_a_script() {
    let out = launch(&shipped()[0], &LaunchSettings { simulator_port: 6000, ..settings() });
    let script = out.files.iter().find(|file| file.name == "px4-rc.mavlinksim").unwrap();
    assert!(script.text.contains("\nsimulator_mavlink start -c 6000\n"));
    assert!(!script.executable);
}

#[test]
fn exact_command_line_quotes_paths_and_contains_everything() {
    let out = launch(&shipped()[0], &settings());
    let path = [("PATH".to_owned(), "/tmp/run:/opt/it's px4/bin".to_owned())];
    let line = out.command_line(true, "/opt/it's px4/bin/px4", &path, &["/opt/it's px4/etc".to_owned()]);
    let end = r" PATH='/tmp/run:/opt/it'\''s px4/bin' '/opt/it'\''s px4/bin/px4' -i 2 -d '/opt/it'\''s px4/etc'";
    assert!(line.ends_with(end), "{line}");
    for (name, value) in &out.environment {
        assert!(format!(" {line}").contains(&format!(" {name}={value} ")), "{name}");
    }
}
