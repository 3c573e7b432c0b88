//! Tests of the byte stream in both directions.

use super::interface::{Px4Interface, RATES_HZ};
use super::testing::{Bench, HOME, answer, decoded, settings, shipped};
use crate::backend::interface::{InterfaceEvent, SimulatorInterface};
use crate::physics::Actuators;
use crate::sensors::{FlowReading, GnssReading};
use spandrel_mavlink::codec::Encoder;
use spandrel_mavlink::dialect::{
    COMMAND_LONG_DATA, HEARTBEAT_DATA, HIL_GPS_DATA, HIL_OPTICAL_FLOW_DATA, HIL_SENSOR_DATA, HilSensorUpdatedFlags, MavMessage,
    MavSensorOrientation, ODOMETRY_DATA, STATUSTEXT_DATA,
};
use spandrel_model::frames::{Rotation, Vec3};
use spandrel_model::time::SimTime;

const PERIOD: SimTime = SimTime::from_ms(4);
const INERTIAL_BITS: u32 = 0x3F;
const MAGNETOMETER_BITS: u32 = 0x1C0;
const BAROMETER_BITS: u32 = 0x1A00;

fn interface() -> Px4Interface {
    Px4Interface::new(&shipped()[0], 250.0).unwrap()
}

fn sent(px4: &mut Px4Interface, bench: &Bench, now: SimTime) -> Vec<MavMessage> {
    px4.send(&bench.step(now));
    let messages = px4.poll_transmit().map_or_else(Vec::new, |bytes| decoded(&bytes));
    assert_eq!(px4.poll_transmit(), None, "one write per step");
    messages
}

fn sensors(messages: &[MavMessage]) -> Vec<&HIL_SENSOR_DATA> {
    messages.iter().filter_map(|message| if let MavMessage::HIL_SENSOR(data) = message { Some(data) } else { None }).collect()
}

fn gnss() -> GnssReading {
    GnssReading {
        fix: 3,
        satellites: 14,
        position_m: Vec3::new(100.0, 0.0, -20.0),
        velocity_m_s: Vec3::new(0.0, 3.0, -1.0),
        hdop: 0.8,
        vdop: 1.2,
        eph_m: 0.63,
        epv_m: 1.01,
    }
}

fn hil_gps(messages: &[MavMessage]) -> Option<&HIL_GPS_DATA> {
    messages.iter().find_map(|message| if let MavMessage::HIL_GPS(data) = message { Some(data) } else { None })
}

fn flow(messages: &[MavMessage]) -> Option<&HIL_OPTICAL_FLOW_DATA> {
    messages.iter().find_map(|message| if let MavMessage::HIL_OPTICAL_FLOW(data) = message { Some(data) } else { None })
}

fn rejections(px4: &mut Px4Interface) -> usize {
    std::iter::from_fn(|| px4.poll_event()).filter(|event| matches!(event, InterfaceEvent::Rejected(_))).count()
}

#[test]
fn exact_only_three_rates_are_supported() {
    let vehicle = &shipped()[0];
    for rate_hz in RATES_HZ {
        assert_eq!(Px4Interface::new(vehicle, rate_hz).unwrap().rate_hz(), rate_hz);
    }
    assert!(Px4Interface::new(vehicle, 400.0).is_none());
    assert!(Px4Interface::new(vehicle, f64::NAN).is_none());
}

#[test]
fn wire_clock_advances_after_all_other_sensors_and_groups_are_complete() {
    let (mut px4, mut bench) = (interface(), Bench::new());
    bench.fresh.gnss = Some(gnss());
    bench.fresh.mag_gauss = Some(Vec3::new(0.2, 0.01, 0.4));
    bench.fresh.pressure_pa = Some(96_611.0);
    bench.fresh.range_down_m = Some(0.13);
    bench.fresh.range_around_m = Some([f64::INFINITY; 8]);
    let messages = sent(&mut px4, &bench, PERIOD);
    let readings = sensors(&messages);
    assert_eq!(readings.iter().map(|data| data.id).collect::<Vec<_>>(), [0, 1, 2]);
    let last_three = &messages[messages.len() - 3..];
    assert!(last_three.iter().all(|message| matches!(message, MavMessage::HIL_SENSOR(_))), "position and ranges come first");
    let bits: Vec<u32> = readings.iter().map(|data| data.fields_updated.bits()).collect();
    assert_eq!(bits, [INERTIAL_BITS | MAGNETOMETER_BITS | BAROMETER_BITS, INERTIAL_BITS, INERTIAL_BITS]);
    assert_eq!((readings[0].abs_pressure, readings[0].ymag, readings[0].time_usec), (966.11, 0.01, 4000));
    // The true state, position, nine ranges and three inertial sensors.
    assert_eq!(messages.len(), 1 + 1 + 9 + 3);
}

#[test]
fn wire_failing_sensors_are_absent() {
    let (mut px4, mut bench) = (interface(), Bench::new());
    let first = sent(&mut px4, &bench, PERIOD);
    assert_eq!(sensors(&first)[0].fields_updated.bits(), INERTIAL_BITS);
    bench.imus[0].specific_force_m_s2 = Vec3::new(f64::NAN, 0.0, 0.0);
    bench.fresh.pressure_pa = Some(f64::NAN);
    bench.fresh.mag_gauss = Some(Vec3::new(0.0, f64::INFINITY, 0.0));
    let second = sent(&mut px4, &bench, PERIOD + PERIOD);
    let primary = sensors(&second)[0];
    assert_eq!(primary.fields_updated, HilSensorUpdatedFlags::from_bits_retain(0x38));
    assert!(hil_gps(&second).is_none() && flow(&second).is_none());
    // The true state is due every 40 ms only.
    assert_eq!((first.len(), second.len()), (4, 3));
}

#[test]
fn exact_impacts_are_clipped_to_the_range_of_the_fifo() {
    let (mut px4, mut bench) = (interface(), Bench::new());
    for imu in &mut bench.imus {
        imu.specific_force_m_s2 = Vec3::new(1e4, -1e4, 3.0);
        imu.rates_rad_s = Vec3::new(-90.0, f64::INFINITY, 0.5);
    }
    for data in sensors(&sent(&mut px4, &bench, PERIOD)) {
        assert_eq!([data.xacc, data.yacc, data.zacc, data.xgyro, data.ygyro, data.zgyro], [156.9, -156.9, 3.0, -34.9, 34.9, 0.5]);
        // PX4 stores the first sensor as 16-bit integers with these scales.
        let (force_lsb, rate_lsb) = (9.806_65 / 2048.0, (2000.0_f64 / 32768.0).to_radians());
        assert!(f64::from(data.xacc) / force_lsb < 32767.0 && f64::from(data.ygyro) / rate_lsb < 32767.0);
    }
}

#[test]
fn wire_time_must_rise_and_never_be_zero() {
    let (mut px4, bench) = (interface(), Bench::new());
    assert!(sent(&mut px4, &bench, SimTime::ZERO).is_empty());
    assert_eq!(rejections(&mut px4), 1);
    let times =
        [4, 8, 8, 6, 12].map(|ms| sensors(&sent(&mut px4, &bench, SimTime::from_ms(ms))).last().map(|data| data.time_usec));
    assert_eq!(times, [Some(4000), Some(8000), None, None, Some(12_000)]);
    assert_eq!(rejections(&mut px4), 0, "reported once per connection");
    // A new process has a new clock.
    px4.connect();
    assert_eq!(sent(&mut px4, &bench, PERIOD).len(), 4);
}

#[test]
fn wire_step_that_was_not_sent_does_not_wait() {
    let (mut px4, bench, mut autopilot) = (interface(), Bench::new(), Encoder::new(3, 1));
    sent(&mut px4, &bench, PERIOD);
    px4.receive(&answer(&mut autopilot, PERIOD, false, &[]));
    assert!(sent(&mut px4, &bench, PERIOD).is_empty());
    assert!(!px4.is_waiting());
}

#[test]
fn wire_first_answer_starts_the_lockstep() {
    let (mut px4, bench, mut autopilot) = (interface(), Bench::new(), Encoder::new(3, 1));
    sent(&mut px4, &bench, PERIOD);
    assert!(!px4.has_answered() && !px4.is_waiting());
    px4.receive(&autopilot.encode(&MavMessage::HEARTBEAT(HEARTBEAT_DATA::default())));
    px4.receive(&autopilot.encode(&MavMessage::COMMAND_LONG(COMMAND_LONG_DATA::default())));
    assert!(!px4.has_answered());
    px4.receive(&answer(&mut autopilot, PERIOD, false, &[]));
    assert!(px4.has_answered() && !px4.is_waiting());
    sent(&mut px4, &bench, PERIOD + PERIOD);
    assert!(px4.is_waiting());
    px4.receive(&answer(&mut autopilot, PERIOD + PERIOD, false, &[]));
    assert!(!px4.is_waiting());
    px4.connect();
    assert!(!px4.has_answered() && !px4.is_waiting());
    assert_eq!((px4.poll_event(), px4.rejected()), (None, super::RejectedCounts::default()));
}

#[test]
fn wire_second_answer_does_not_count_for_the_next_step() {
    let (mut px4, bench, mut autopilot) = (interface(), Bench::new(), Encoder::new(3, 1));
    sent(&mut px4, &bench, PERIOD);
    px4.receive(&answer(&mut autopilot, PERIOD, true, &[0.1; 4]));
    let late = answer(&mut autopilot, PERIOD, true, &[0.2; 4]);
    sent(&mut px4, &bench, PERIOD + PERIOD);
    px4.receive(&late);
    assert!(px4.is_waiting(), "an answer to the previous step");
    px4.receive(&answer(&mut autopilot, PERIOD + PERIOD, true, &[0.3; 4]));
    assert!(!px4.is_waiting());
    assert!((px4.actuators().motors[0] - 0.3).abs() < 1e-6);
}

#[test]
fn exact_motors_keep_their_order_and_range() {
    let (mut px4, mut autopilot) = (interface(), Encoder::new(3, 1));
    px4.receive(&answer(&mut autopilot, PERIOD, true, &[0.25, 0.5, -0.5, 1.5, 0.75]));
    let [a, b, c, d, rest @ ..] = px4.actuators().motors;
    assert_eq!([a, b, c, d], [0.25, 0.5, 0.0, 1.0]);
    assert_eq!(rest, [0.0; 4], "outputs without a rotor");
    assert!(px4.actuators().armed);
    px4.receive(&answer(&mut autopilot, PERIOD, false, &[0.25; 4]));
    assert_eq!(px4.actuators(), Actuators::default());
}

#[test]
fn exact_all_eight_rotors_get_their_command() {
    let mut vehicle = shipped()[0].clone();
    let four = vehicle.rotors.clone();
    vehicle.rotors.extend(four);
    let mut px4 = Px4Interface::new(&vehicle, 250.0).unwrap();
    let controls: Vec<f32> = (0..16_u8).map(|k| f32::from(k) / 16.0).collect();
    px4.receive(&answer(&mut Encoder::new(1, 1), PERIOD, true, &controls));
    assert_eq!(px4.actuators().motors, std::array::from_fn(|k| k as f64 / 16.0));
}

#[test]
fn wire_invalid_commands_keep_the_previous_one_and_end_the_wait() {
    let (mut px4, bench, mut autopilot) = (interface(), Bench::new(), Encoder::new(3, 1));
    px4.receive(&answer(&mut autopilot, PERIOD, true, &[0.5; 4]));
    let before = px4.actuators();
    for (k, bad) in [f32::NAN, f32::INFINITY, f32::NEG_INFINITY].into_iter().enumerate() {
        let now = SimTime::from_ms(4 * (k as i64 + 2));
        sent(&mut px4, &bench, now);
        px4.receive(&answer(&mut autopilot, now, true, &[0.1, 0.1, bad, 0.1]));
        assert_eq!((px4.actuators(), px4.is_waiting()), (before, false));
    }
    assert_eq!((px4.rejected().commands, rejections(&mut px4)), (3, 1));
    // Outputs without a rotor may be anything.
    px4.receive(&answer(&mut autopilot, PERIOD, true, &[0.1, 0.1, 0.1, 0.1, f32::NAN]));
    assert_ne!(px4.actuators(), before);
}

#[test]
fn prop_any_split_of_the_stream_gives_the_same_commands() {
    let mut autopilot = Encoder::new(3, 1);
    let mut stream = autopilot.encode(&MavMessage::HEARTBEAT(HEARTBEAT_DATA::default()));
    for k in 1..=20_u8 {
        stream.extend(answer(&mut autopilot, SimTime::from_ms(4 * i64::from(k)), k > 10, &[f32::from(k) / 20.0; 4]));
    }
    let whole = {
        let mut px4 = interface();
        px4.receive(&stream);
        px4.actuators()
    };
    for size in (1..100).chain([stream.len()]) {
        let mut px4 = interface();
        for part in stream.chunks(size) {
            px4.receive(part);
        }
        assert_eq!((px4.actuators(), px4.rejected(), px4.poll_event()), (whole, super::RejectedCounts::default(), None));
    }
}

#[test]
fn wire_garbage_is_counted_and_reported_once() {
    let (mut px4, mut autopilot) = (interface(), Encoder::new(3, 1));
    px4.receive(b"GET / HTTP/1.1\r\n\r\n");
    px4.receive(&answer(&mut autopilot, PERIOD, true, &[0.5; 4]));
    let text = autopilot.encode(&MavMessage::STATUSTEXT(STATUSTEXT_DATA::default()));
    for _ in 0..50 {
        px4.receive(b"no frame");
        px4.receive(&text);
    }
    let counts = px4.rejected();
    assert_eq!((counts.bytes, counts.messages, counts.commands), (18 + 50 * 8, 50, 0));
    assert_eq!(rejections(&mut px4), 2, "one event per kind");
    assert!(px4.actuators().armed);
    // The final counts follow with the end of the connection.
    px4.connect();
    let Some(InterfaceEvent::Rejected(text)) = px4.poll_event() else { panic!("no summary") };
    assert!(text.contains("418 invalid bytes, 50 unexpected messages"), "{text}");
}

#[test]
fn regress_dialect_does_not_reject_answers_with_unknown_flags() {
    let mut payload = [0xFF; 81];
    payload[16..80].fill(0);
    let mut px4 = interface();
    px4.receive(&Encoder::new(1, 1).encode_payload(93, &payload));
    assert!(px4.has_answered() && px4.actuators().armed);
}

#[test]
fn wire_gnss_accuracy_is_in_centimeters_and_time_is_utc() {
    let (mut px4, mut bench) = (interface(), Bench::new());
    bench.fresh.gnss = Some(gnss());
    let messages = sent(&mut px4, &bench, PERIOD);
    let data = hil_gps(&messages).unwrap();
    assert_eq!((data.fix_type, data.satellites_visible, data.eph, data.epv), (3, 14, 63, 101));
    assert_eq!((data.vel, data.vn, data.ve, data.vd, data.cog), (300, 0, 300, -100, 9000));
    assert_eq!(data.time_usec, 1_700_000_000_004_000);
    // 100 m north of the origin, 20 m above it (the ellipsoid falls away by under 1 mm over that distance).
    assert_eq!((data.lon, data.alt), (80_000_000, 420_001));
    assert!((f64::from(data.lat) * 1e-7 - HOME.latitude_deg - 100.0 / 111_170.0).abs() < 1e-6, "{}", data.lat);
    bench.fresh.gnss = Some(GnssReading { fix: 0, satellites: 2, ..gnss() });
    let data = sent(&mut px4, &bench, PERIOD + PERIOD);
    let data = hil_gps(&data).unwrap();
    assert_eq!((data.fix_type, data.satellites_visible, data.lat, data.eph), (0, 2, 0, u16::MAX));
}

#[test]
fn wire_ranges_have_orientations_that_px4_knows() {
    let (mut px4, mut bench) = (interface(), Bench::new());
    bench.fresh.range_down_m = Some(1.234);
    bench.fresh.range_up_m = Some(f64::INFINITY);
    bench.fresh.range_around_m = Some([3.0; 8]);
    let messages = sent(&mut px4, &bench, PERIOD);
    let ranges: Vec<_> =
        messages.iter().filter_map(|m| if let MavMessage::DISTANCE_SENSOR(data) = m { Some(data) } else { None }).collect();
    assert_eq!(ranges.iter().map(|data| data.id).collect::<Vec<_>>(), (0..10).collect::<Vec<_>>());
    assert_eq!((ranges[0].orientation, ranges[0].current_distance), (MavSensorOrientation::MAV_SENSOR_ROTATION_PITCH_270, 123));
    assert_eq!((ranges[1].orientation, ranges[1].current_distance), (MavSensorOrientation::MAV_SENSOR_ROTATION_PITCH_90, 1001));
    assert_eq!((ranges[1].max_distance, ranges[1].signal_quality), (1000, 0), "beyond the maximum, quality unknown");
    let codes: Vec<u32> = ranges[2..].iter().map(|data| data.orientation as u32).collect();
    assert_eq!(codes, [0, 100, 2, 100, 12, 100, 6, 100]);
    for (sector, data) in ranges[2..].iter().enumerate() {
        let turn =
            Rotation::<spandrel_model::frames::Frd, spandrel_model::frames::Ned>::from_wxyz(data.quaternion.map(f64::from));
        let apart = turn.unwrap().yaw_rad() - sector as f64 * std::f64::consts::FRAC_PI_4;
        assert!(spandrel_model::math::wrap_pi(apart).abs() < 1e-6, "{sector}");
    }
}

/// Sends 50 ms of steps at a range and returns the flow message of the last one.
fn flow_after(bench: &mut Bench, reading: FlowReading, range_m: f64) -> Option<HIL_OPTICAL_FLOW_DATA> {
    let mut px4 = interface();
    let mut last = None;
    for k in 1..=13 {
        bench.fresh.range_down_m = (k == 1).then_some(range_m);
        bench.fresh.flow = (k == 13).then_some(reading);
        last = flow(&sent(&mut px4, bench, SimTime::from_ms(4 * k))).cloned();
    }
    last
}

#[test]
fn wire_flow_has_px4s_signs_and_integrates_the_gyroscope() {
    let mut bench = Bench::new();
    let reading = FlowReading { forward_m_s: 2.0, right_m_s: 1.0, quality: 0.8 };
    let data = flow_after(&mut bench, reading, 4.0).unwrap();
    // PX4: velocity forward = range · (y - gyro y) / interval, velocity to the right = -range · (x - gyro x) / interval.
    assert_eq!((data.integration_time_us, data.quality, data.distance), (52_000, 204, -1.0));
    assert!((f64::from(data.integrated_x) + 1.0 / 4.0 * 0.052).abs() < 1e-7, "{}", data.integrated_x);
    assert!((f64::from(data.integrated_y) - 2.0 / 4.0 * 0.052).abs() < 1e-7, "{}", data.integrated_y);
    bench.imus[0].rates_rad_s = Vec3::new(0.5, -0.25, 0.125);
    let turned = flow_after(&mut bench, reading, 4.0).unwrap();
    let gyro = [turned.integrated_xgyro, turned.integrated_ygyro, turned.integrated_zgyro].map(f64::from);
    for (got, rate) in gyro.iter().zip([0.5, -0.25, 0.125]) {
        assert!((got - rate * 0.052).abs() < 1e-7, "{gyro:?}");
    }
    assert!((turned.integrated_x - turned.integrated_xgyro - data.integrated_x).abs() < 1e-7);
    assert!((turned.integrated_y - turned.integrated_ygyro - data.integrated_y).abs() < 1e-7);
}

/// Returns the vision message.
fn vision(messages: &[MavMessage]) -> Option<&ODOMETRY_DATA> {
    messages.iter().find_map(|message| if let MavMessage::ODOMETRY(data) = message { Some(data) } else { None })
}

#[test]
fn wire_flow_without_a_surface_below_is_a_vision_velocity() {
    let reading = FlowReading { forward_m_s: 2.0, right_m_s: 1.0, quality: 0.8 };
    let (mut px4, mut bench) = (interface(), Bench::new());
    bench.fresh.range_down_m = Some(4.0);
    sent(&mut px4, &bench, PERIOD);
    bench.fresh.range_down_m = None;
    bench.fresh.flow = Some(reading);
    let recent = sent(&mut px4, &bench, SimTime::from_ms(50));
    assert!(flow(&recent).is_some() && vision(&recent).is_none());
    // The range finder failed long ago.
    bench.rigid.velocity_m_s = Vec3::new(2.0, 1.0, -0.5);
    let late = sent(&mut px4, &bench, SimTime::from_ms(400));
    assert!(flow(&late).is_none());
    let data = vision(&late).unwrap();
    assert_eq!([data.vx, data.vy, data.vz], [2.0, 1.0, -0.5]);
    assert_eq!((data.quality, data.reset_counter), (80, 0));
    assert!(data.x.is_nan() && data.q[0].is_nan() && data.rollspeed.is_nan(), "only the velocity is known");
    let noise = shipped()[0].sensors.flow_velocity_m_s;
    for index in [0, 6, 11] {
        assert!((f64::from(data.velocity_covariance[index]) - noise * noise).abs() < 1e-6);
    }
    // Nothing within reach below.
    bench.fresh.range_down_m = Some(f64::INFINITY);
    let high = sent(&mut px4, &bench, SimTime::from_ms(450));
    assert!(flow(&high).is_none() && vision(&high).is_some());
    assert!(matches!(high[high.len() - 3], MavMessage::HIL_SENSOR(_)), "before the sensor that advances the clock");
}

#[test]
fn wire_tilted_camera_sees_the_velocity_along_the_body() {
    let mut bench = Bench::new();
    bench.rigid.attitude = Rotation::from_euler(0.0, -0.5, 1.2);
    let reading = FlowReading { forward_m_s: 3.0, right_m_s: 0.0, quality: 1.0 };
    let data = flow_after(&mut bench, reading, 2.0).unwrap();
    let expected = 3.0 * spandrel_model::math::cos(0.5) / 2.0 * 0.052;
    assert!((f64::from(data.integrated_y) - expected).abs() < 1e-7 && data.integrated_x.abs() < 1e-7);
}

#[test]
fn exact_instance_starts_in_the_settings_rate() {
    assert!(Px4Interface::new(&shipped()[0], settings().rate_hz).is_some());
}
