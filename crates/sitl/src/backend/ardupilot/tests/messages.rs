//! MAVLink messages with sensor readings and sensor errors.

use super::super::sensor_messages::{self, FLOW_SCALER, FLOW_START, SensorInfo};
use super::{HOME, START_UNIX_S, Scene, aircraft, interface, packet};
use crate::backend::interface::SimulatorInterface;
use crate::sensors::magnetometer::earth_field_gauss;
use crate::sensors::{FlowReading, GnssReading};
use spandrel_mavlink::dialect::{GPS_INPUT_DATA, GpsFixType, MavMessage, MavSensorOrientation, OPTICAL_FLOW_DATA};
use spandrel_model::frames::{Rotation, Vec3};
use spandrel_model::time::SimTime;

const OPEN_SKY: GnssReading = GnssReading {
    fix: 3,
    satellites: 18,
    position_m: Vec3::new(100.0, -50.0, -12.0),
    velocity_m_s: Vec3::new(1.5, -2.5, 0.25),
    hdop: 0.75,
    vdop: 1.25,
    eph_m: 0.5,
    epv_m: 0.8,
};

/// Returns the messages for one step, at a time at which all sensors are in use.
fn messages(scene: &Scene) -> Vec<MavMessage> {
    sensor_messages::encode(&scene.step(), &SensorInfo::new(&aircraft("phantom2")), FLOW_START)
}

fn gps_input(reading: GnssReading) -> GPS_INPUT_DATA {
    let mut scene = Scene::at_rest();
    scene.fresh.gnss = Some(reading);
    let messages = messages(&scene);
    let [MavMessage::GPS_INPUT(message)] = &messages[..] else { panic!("{messages:?}") };
    message.clone()
}

#[test]
fn exact_gps_input_has_all_values_of_the_receiver() {
    let message = gps_input(OPEN_SKY);
    let north_deg = f64::from(message.lat) * 1e-7 - HOME.latitude_deg;
    // One degree of latitude is 111.18 km at this place.
    assert!((north_deg * 111_180.0 - 100.0).abs() < 0.1, "{north_deg}");
    assert!(f64::from(message.lon) * 1e-7 < HOME.longitude_deg);
    assert!((message.alt - 500.0).abs() < 0.01);
    assert_eq!((message.vn, message.ve, message.vd), (1.5, -2.5, 0.25));
    assert_eq!((message.hdop, message.vdop), (0.75, 1.25));
    assert_eq!((message.horiz_accuracy, message.vert_accuracy), (0.5, 0.8));
    assert_eq!((message.fix_type, message.satellites_visible), (GpsFixType::GPS_FIX_TYPE_3D_FIX, 18));
    assert_eq!((message.ignore_flags.bits(), message.yaw, message.gps_id), (0, 0, 0));
}

/// 2026-01-01 00:00:07 UTC is 18 s later in GPS time, which is a Thursday in week 2399.
#[test]
fn exact_gps_input_has_gps_time() {
    let message = gps_input(OPEN_SKY);
    assert_eq!(message.time_usec, (START_UNIX_S * 1_000_000 + 7_000_000) as u64);
    assert_eq!((message.time_week, message.time_week_ms), (2399, (4 * 86_400 + 7 + 18) * 1000));
}

#[test]
fn exact_gps_input_reports_lost_fix_and_large_errors() {
    let lost = gps_input(GnssReading { fix: 0, satellites: 3, hdop: f64::INFINITY, eph_m: f64::NAN, ..OPEN_SKY });
    assert_eq!(lost.fix_type, GpsFixType::GPS_FIX_TYPE_NO_FIX, "0 would mean that there is no receiver");
    assert!(lost.hdop.is_finite() && lost.horiz_accuracy.is_finite() && lost.speed_accuracy.is_finite());
    let flat = gps_input(GnssReading { fix: 2, ..OPEN_SKY });
    assert_eq!(flat.fix_type, GpsFixType::GPS_FIX_TYPE_2D_FIX);
    let poor = gps_input(GnssReading { eph_m: 5.0, ..OPEN_SKY });
    assert!(poor.speed_accuracy > 5.0 * gps_input(OPEN_SKY).speed_accuracy);
}

#[test]
fn exact_range_finders_report_centimeters_and_directions() {
    let mut scene = Scene::at_rest();
    scene.fresh.range_down_m = Some(2.345);
    scene.fresh.range_up_m = Some(f64::INFINITY);
    let messages = messages(&scene);
    let [MavMessage::DISTANCE_SENSOR(down), MavMessage::DISTANCE_SENSOR(up)] = &messages[..] else { panic!("{messages:?}") };
    assert_eq!((down.current_distance, down.orientation), (235, MavSensorOrientation::MAV_SENSOR_ROTATION_PITCH_270));
    assert_eq!((up.current_distance, up.orientation), (1001, MavSensorOrientation::MAV_SENSOR_ROTATION_PITCH_90));
    assert_eq!((down.max_distance, up.max_distance), (1000, 1000));
}

fn optical_flow(scene: &Scene) -> OPTICAL_FLOW_DATA {
    let messages = messages(scene);
    let [MavMessage::OPTICAL_FLOW(message)] = &messages[..] else { panic!("{messages:?}") };
    message.clone()
}

/// ArduPilot's rate of the image, rad/s, from the message.
fn image_rate(flow: i16) -> f64 {
    f64::from(flow) * (1.0 + 0.001 * f64::from(FLOW_SCALER)) * 0.05
}

#[test]
fn exact_flow_has_the_angular_rate_of_the_ground() {
    let mut scene = Scene::at_rest();
    scene.truth.velocity_m_s = Vec3::zero();
    scene.truth.attitude = Rotation::from_euler(0.0, 0.0, 2.0);
    scene.latest.range_down_m = Some(4.0);
    scene.fresh.flow = Some(FlowReading { forward_m_s: 2.0, right_m_s: 1.0, quality: 1.0 });
    scene.imus[0].rates_rad_s = Vec3::new(0.125, -0.25, 0.0);
    let message = optical_flow(&scene);
    // Moving right turns the image like a rotation to the left; moving forward like one with the nose up.
    assert!((image_rate(message.flow_x) - (0.125 - 1.0 / 4.0)).abs() < 5e-4, "{}", message.flow_x);
    assert!((image_rate(message.flow_y) - (-0.25 + 2.0 / 4.0)).abs() < 5e-4, "{}", message.flow_y);
    assert_eq!(message.quality, 255);
}

#[test]
fn exact_flow_needs_the_distance_to_the_ground() {
    let mut scene = Scene::at_rest();
    scene.fresh.flow = Some(FlowReading { forward_m_s: 2.0, right_m_s: 1.0, quality: 1.0 });
    scene.latest.range_down_m = Some(f64::INFINITY);
    assert_eq!(messages(&scene), []);
}

#[test]
fn exact_flow_begins_after_gnss_is_in_use() {
    let mut scene = Scene::at_rest();
    scene.latest.range_down_m = Some(4.0);
    scene.fresh.flow = Some(FlowReading { forward_m_s: 2.0, right_m_s: 1.0, quality: 1.0 });
    let info = SensorInfo::new(&aircraft("phantom2"));
    let count = |elapsed| sensor_messages::encode(&scene.step(), &info, elapsed).len();
    assert_eq!((count(FLOW_START - SimTime::from_ms(1)), count(FLOW_START)), (0, 1));
}

/// Runs the interface for `seconds` and returns the last value of each parameter that it set.
fn parameters_after(scene: &mut Scene, seconds: i64) -> std::collections::BTreeMap<String, f32> {
    let mut interface = interface();
    let mut out = std::collections::BTreeMap::new();
    for frame in 0..seconds * 500 {
        interface.receive(&packet(frame as u32, [1000; 4]));
        interface.send(&scene.step());
        scene.now += SimTime::from_ms(2);
        while let Some(message) = interface.poll_message() {
            if let MavMessage::PARAM_SET(set) = message {
                assert_eq!((set.target_system, set.target_component), (3, 1));
                out.insert(set.param_id.to_str().expect("name").into(), set.param_value);
            }
        }
        while interface.poll_transmit().is_some() {}
    }
    out
}

#[test]
fn exact_errors_of_barometer_and_compass_become_simulation_parameters() {
    let mut scene = Scene::at_rest();
    scene.fresh.baro_up_m = Some(scene.truth.position_m.enu().up() + 0.75);
    let field = scene.truth.attitude.inverse() * earth_field_gauss(HOME);
    scene.fresh.mag_gauss = Some(field + Vec3::new(0.01, -0.02, 0.03));
    let set = parameters_after(&mut scene, 1);
    assert!((set["SIM_BARO_GLITCH"] - 0.75).abs() < 1e-3);
    // ArduPilot subtracts the offset, and its calibration removes (5, 13, -18) mG.
    for (axis, expected) in [("X", 5.0 - 10.0), ("Y", 13.0 + 20.0), ("Z", -18.0 - 30.0)] {
        let got = set[&format!("SIM_MAG1_OFS_{axis}")];
        assert!((got - expected).abs() < 0.01, "{axis}: {got}");
    }
    assert_eq!((set["SIM_BARO_DISABLE"], set["SIM_MAG1_FAIL"]), (0.0, 0.0), "values of an earlier flight are replaced");
}

#[test]
fn exact_stuck_barometer_lags_by_the_whole_climb() {
    let mut scene = Scene::at_rest();
    let stuck_up_m = scene.truth.position_m.enu().up();
    scene.fresh.baro_up_m = Some(stuck_up_m);
    scene.truth.position_m += Vec3::new(0.0, 0.0, -5.0);
    let set = parameters_after(&mut scene, 1);
    assert!((set["SIM_BARO_GLITCH"] + 5.0).abs() < 1e-3, "{set:?}");
    assert_eq!(set["SIM_BARO_DISABLE"], 0.0, "the sensor still delivers readings");
}

#[test]
fn exact_sensors_without_readings_fail() {
    let set = parameters_after(&mut Scene::at_rest(), 1);
    assert_eq!((set["SIM_BARO_DISABLE"], set["SIM_MAG1_FAIL"]), (1.0, 1.0));
}

#[test]
fn wire_messages_are_bounded_if_nobody_collects_them() {
    let mut interface = interface();
    let mut scene = Scene::at_rest();
    scene.fresh.gnss = Some(OPEN_SKY);
    for frame in 0..1000 {
        interface.receive(&packet(frame, [1000; 4]));
        interface.send(&scene.step());
    }
    assert!(std::iter::from_fn(|| interface.poll_message()).count() <= 64);
}
