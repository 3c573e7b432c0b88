//! Camera and gimbal functions as clients use them.

use spandrel_mavlink::dialect::*;
use spandrel_testkit::station::Station;
use std::f32::consts::FRAC_PI_2;

/// Time within which the gimbal must have reached its target at its limited rate, ms.
const GIMBAL_MOVE_MS: i64 = 4_000;
/// Maximum angle error at the target, rad.
const ANGLE_TOLERANCE_RAD: f32 = 0.01;

fn pitch(station: &Station) -> f32 {
    station
        .last_message(|m| match m {
            MavMessage::GIMBAL_DEVICE_ATTITUDE_STATUS(g) => Some(2.0 * g.q[2].atan2(g.q[0])),
            _ => None,
        })
        .unwrap()
}

#[test]
fn wire_gimbal_moves_from_straight_down_to_straight_up() {
    let mut station = Station::new("drill-hover", 7);
    station.run_ms(100);
    let aim = |deg: f32| [deg, 0.0, f32::NAN, f32::NAN, 0.0, 0.0, 0.0];
    for deg in [-90.0, 90.0, 0.0, 45.0] {
        let result = station.command(1, MavCmd::MAV_CMD_DO_GIMBAL_MANAGER_PITCHYAW, aim(deg));
        assert_eq!(result, MavResult::MAV_RESULT_ACCEPTED);
        station.run_ms(GIMBAL_MOVE_MS);
        assert!((pitch(&station) - deg.to_radians()).abs() < ANGLE_TOLERANCE_RAD, "{deg}: {}", pitch(&station));
    }
    for deg in [-120.0, 91.5] {
        let result = station.command(1, MavCmd::MAV_CMD_DO_GIMBAL_MANAGER_PITCHYAW, aim(deg));
        assert_eq!(result, MavResult::MAV_RESULT_DENIED, "{deg}");
    }
}

#[test]
fn wire_gimbal_follows_manager_messages() {
    let mut station = Station::new("drill-hover", 7);
    station.run_ms(100);
    let pitch_yaw = |pitch, pitch_rate, gimbal_device_id| {
        MavMessage::GIMBAL_MANAGER_SET_PITCHYAW(GIMBAL_MANAGER_SET_PITCHYAW_DATA {
            pitch,
            pitch_rate,
            gimbal_device_id,
            flags: GimbalManagerFlags::empty(),
            target_system: 1,
            target_component: 1,
            ..Default::default()
        })
    };
    let manual = |pitch| {
        MavMessage::GIMBAL_MANAGER_SET_MANUAL_CONTROL(GIMBAL_MANAGER_SET_MANUAL_CONTROL_DATA {
            pitch,
            flags: GimbalManagerFlags::empty(),
            target_system: 1,
            target_component: 1,
            ..Default::default()
        })
    };
    let attitude = |angle: f32| {
        MavMessage::GIMBAL_MANAGER_SET_ATTITUDE(GIMBAL_MANAGER_SET_ATTITUDE_DATA {
            q: [(angle / 2.0).cos(), 0.0, (angle / 2.0).sin(), 0.0],
            flags: GimbalManagerFlags::empty(),
            target_system: 1,
            target_component: 1,
            ..Default::default()
        })
    };
    for (message, expected) in [
        (pitch_yaw(-0.5, f32::NAN, 0), -0.5),
        (pitch_yaw(0.7, f32::NAN, 1), 0.7),
        (pitch_yaw(0.1, f32::NAN, 9), 0.7),
        (attitude(-1.0), -1.0),
        (manual(1.0), FRAC_PI_2),
        (manual(-0.5), -FRAC_PI_2 / 2.0),
        (pitch_yaw(f32::NAN, -0.1, 0), -FRAC_PI_2 / 2.0 - 0.1 * GIMBAL_MOVE_MS as f32 / 1000.0),
    ] {
        station.send(&message);
        station.run_ms(GIMBAL_MOVE_MS);
        assert!(
            (pitch(&station) - expected).abs() < 2.0 * ANGLE_TOLERANCE_RAD,
            "{message:?}: {} instead of {expected}",
            pitch(&station)
        );
    }
}

#[test]
fn wire_gimbal_control_is_exclusive_until_released() {
    let mut station = Station::new("drill-hover", 7);
    station.run_ms(100);
    let aim = [-20.0, 0.0, f32::NAN, f32::NAN, 0.0, 0.0, 0.0];
    let take = [-2.0, -2.0, -1.0, -1.0, 0.0, 0.0, 0.0];
    let release = [-3.0, -3.0, -1.0, -1.0, 0.0, 0.0, 0.0];
    let configure = MavCmd::MAV_CMD_DO_GIMBAL_MANAGER_CONFIGURE;
    assert_eq!(station.command(1, configure, take), MavResult::MAV_RESULT_ACCEPTED);
    station.run_ms(2_100);
    let holder = station.last_message(|m| match m {
        MavMessage::GIMBAL_MANAGER_STATUS(s) => Some((s.primary_control_sysid, s.primary_control_compid)),
        _ => None,
    });
    assert_eq!(holder, Some((255, 190)));
    station.send_as(254, 190);
    station.received.clear();
    let other = MavMessage::COMMAND_LONG(COMMAND_LONG_DATA {
        command: MavCmd::MAV_CMD_DO_GIMBAL_MANAGER_PITCHYAW,
        param1: -20.0,
        param3: f32::NAN,
        target_system: 1,
        target_component: 1,
        ..Default::default()
    });
    let result = |m: &MavMessage| if let MavMessage::COMMAND_ACK(a) = m { Some(a.result) } else { None };
    assert_eq!(station.ask(&other, result), Some(MavResult::MAV_RESULT_DENIED));
    station.send_as(255, 190);
    assert_eq!(station.command(1, MavCmd::MAV_CMD_DO_GIMBAL_MANAGER_PITCHYAW, aim), MavResult::MAV_RESULT_ACCEPTED);
    assert_eq!(station.command(1, configure, release), MavResult::MAV_RESULT_ACCEPTED);
    station.send_as(254, 190);
    assert_eq!(station.ask(&other, result), Some(MavResult::MAV_RESULT_ACCEPTED));
}

fn shots(station: &Station) -> Vec<(i32, i32, i32)> {
    station.all(|m| if let MavMessage::CAMERA_IMAGE_CAPTURED(c) = m { Some((c.image_index, c.lat, c.lon)) } else { None })
}

#[test]
fn wire_missed_pictures_are_sent_again_and_a_series_stops_on_command() {
    let mut station = Station::airborne("drill-hover", 7);
    station.received.clear();
    let series = [0.0, 0.5, 0.0, 0.0, 0.0, 0.0, 0.0];
    station.command(100, MavCmd::MAV_CMD_IMAGE_START_CAPTURE, series);
    for _ in 0..105 {
        station.sticks(300, 0, 500, 0);
        station.run_ms(20);
    }
    let taken = shots(&station);
    assert_eq!(taken.iter().map(|s| s.0).collect::<Vec<_>>(), [0, 1, 2, 3, 4]);
    station.command(100, MavCmd::MAV_CMD_IMAGE_STOP_CAPTURE, [0.0; 7]);
    station.run_ms(2_000);
    assert!(shots(&station).is_empty());
    for (index, lat, lon) in taken {
        station.command(100, MavCmd::MAV_CMD_REQUEST_MESSAGE, [263.0, index as f32, 0.0, 0.0, 0.0, 0.0, 0.0]);
        assert_eq!(shots(&station), [(index, lat, lon)], "the picture must be reported again with its position");
    }
    let none = station.command(100, MavCmd::MAV_CMD_REQUEST_MESSAGE, [263.0, 99.0, 0.0, 0.0, 0.0, 0.0, 0.0]);
    assert_eq!(none, MavResult::MAV_RESULT_DENIED);
}

#[test]
fn wire_distance_triggered_pictures_have_the_requested_spacing() {
    let mut station = Station::airborne("drill-hover", 7);
    station.received.clear();
    let every = [3.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0];
    assert_eq!(station.command(100, MavCmd::MAV_CMD_DO_SET_CAM_TRIGG_DIST, every), MavResult::MAV_RESULT_ACCEPTED);
    let [n0, e0, _] = station.local_position_after(10);
    for _ in 0..250 {
        station.sticks(400, 0, 500, 0);
        station.run_ms(20);
    }
    let [n, e, _] = station.place();
    let flown = (n - n0).hypot(e - e0);
    let count = shots(&station).len() as f32;
    assert!((count - flown / 3.0).abs() <= 1.5, "{count} pictures over {flown} m");
    assert!(count >= 3.0);
}

/// The buttons that QGroundControl creates from the actions file in docs/src/how-to/.
#[test]
fn wire_actions_of_the_qgroundcontrol_file_are_accepted() {
    let file: serde_json::Value =
        serde_json::from_str(&spandrel_testkit::shipped::text("docs/src/how-to/qgroundcontrol-actions.json")).unwrap();
    assert_eq!((file["fileType"].as_str(), file["version"].as_u64()), (Some("MavlinkActions"), Some(1)));
    let mut station = Station::airborne("drill-hover", 7);
    for action in file["actions"].as_array().unwrap() {
        let label = action["label"].as_str().unwrap();
        assert!(action["description"].is_string(), "{label}");
        let number = action["mavCmd"].as_u64().unwrap() as u16;
        let component = action["compId"].as_u64().unwrap() as u8;
        // COMMAND_LONG as transmitted: seven parameters, number, target.
        let mut payload = Vec::new();
        for k in 1..=7 {
            payload.extend((action[format!("param{k}")].as_f64().unwrap_or(0.0) as f32).to_le_bytes());
        }
        payload.extend(number.to_le_bytes());
        payload.extend([1, component, 0]);
        station.received.clear();
        station.send_payload(76, &payload);
        station.run_ms(5);
        let result = station.last_message(|m| match m {
            MavMessage::COMMAND_ACK(ack) if ack.command as u16 == number => Some(ack.result),
            _ => None,
        });
        assert_eq!(result, Some(MavResult::MAV_RESULT_ACCEPTED), "{label}");
    }
}

#[test]
fn wire_only_the_controlling_client_can_release_the_gimbal() {
    let mut station = Station::airborne("drill-hover", 7);
    let configure = |s: &mut Station, who: f32| {
        let message = MavMessage::COMMAND_LONG(COMMAND_LONG_DATA {
            command: MavCmd::MAV_CMD_DO_GIMBAL_MANAGER_CONFIGURE,
            param1: who,
            param2: who,
            param3: -1.0,
            param4: -1.0,
            target_system: 1,
            target_component: 1,
            ..Default::default()
        });
        s.send(&message);
    };
    let control = |s: &mut Station| {
        s.run_ms(2_100);
        s.last_message(|m| if let MavMessage::GIMBAL_MANAGER_STATUS(g) = m { Some(g.primary_control_sysid) } else { None })
            .unwrap()
    };
    configure(&mut station, -2.0);
    assert_eq!(control(&mut station), 255);
    station.send_as(254, 190);
    configure(&mut station, -3.0);
    assert_eq!(control(&mut station), 255, "another client must not be able to release it");
    station.send_as(255, 190);
    configure(&mut station, -3.0);
    assert_eq!(control(&mut station), 0);
}

#[test]
fn wire_single_picture_does_not_end_a_series() {
    let mut station = Station::airborne("drill-hover", 7);
    let taken = |s: &Station| s.all(|m| matches!(m, MavMessage::CAMERA_IMAGE_CAPTURED(_)).then_some(())).len();
    let series = [0.0, 1.0, 0.0, 0.0, 0.0, 0.0, 0.0];
    assert_eq!(station.command(100, MavCmd::MAV_CMD_IMAGE_START_CAPTURE, series), MavResult::MAV_RESULT_ACCEPTED);
    station.run_ms(1_500);
    let one = [0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 0.0];
    assert_eq!(station.command(100, MavCmd::MAV_CMD_IMAGE_START_CAPTURE, one), MavResult::MAV_RESULT_ACCEPTED);
    station.run_ms(3_000);
    // The single picture, and the pictures from three more seconds of the series.
    assert_eq!(taken(&station), 4);
}

#[test]
fn wire_lamp_rejects_dimming_and_gimbal_has_a_neutral_position() {
    let mut station = Station::airborne("drill-hover", 7);
    let configure = MavCmd::MAV_CMD_DO_ILLUMINATOR_CONFIGURE;
    for (mode, pct, result) in [(1.0, 100.0, true), (0.0, f32::NAN, true), (1.0, 30.0, false), (2.0, 100.0, false)] {
        let answer = station.command(1, configure, [mode, pct, 0.0, 0.0, 0.0, 0.0, 0.0]);
        assert_eq!(answer == MavResult::MAV_RESULT_ACCEPTED, result, "{mode} {pct}");
    }
    let pitch = |s: &mut Station| {
        s.run_ms(3_000);
        s.last_message(|m| if let MavMessage::GIMBAL_DEVICE_ATTITUDE_STATUS(g) = m { Some(2.0 * g.q[2].asin()) } else { None })
            .unwrap()
    };
    let aim = |s: &mut Station, p: [f32; 7]| s.command(1, MavCmd::MAV_CMD_DO_GIMBAL_MANAGER_PITCHYAW, p);
    let nan = f32::NAN;
    assert_eq!(aim(&mut station, [-40.0, 0.0, nan, nan, 0.0, 0.0, 0.0]), MavResult::MAV_RESULT_ACCEPTED);
    assert!(pitch(&mut station) < -0.6);
    assert_eq!(aim(&mut station, [nan, nan, nan, nan, 2.0, 0.0, 0.0]), MavResult::MAV_RESULT_ACCEPTED);
    assert!(pitch(&mut station).abs() < 0.05, "the neutral pitch must be level");
    assert_eq!(aim(&mut station, [nan, nan, nan, nan, 1.0, 0.0, 0.0]), MavResult::MAV_RESULT_DENIED);
}
