//! Gimbal control, commands of the superseded mount protocol, and the lamp through all of its interfaces.
#![allow(deprecated, reason = "clients still send superseded MAVLink messages")]

use spandrel_mavlink::dialect::*;
use spandrel_sitl::endpoint::flavor::{ardupilot, generic, px4};
use spandrel_testkit::station::{Station, p};

const OK: MavResult = MavResult::MAV_RESULT_ACCEPTED;
const DENIED: MavResult = MavResult::MAV_RESULT_DENIED;
const NAN: f32 = f32::NAN;
/// Time within which the gimbal must have reached its target at 90 degrees per second, ms.
const GIMBAL_MOVE_MS: i64 = 4_000;
/// Maximum angle error at the target, deg.
const TOLERANCE_DEG: f32 = 0.5;

fn on_the_pad() -> Station {
    let mut station = Station::new("drill-hover", 7);
    // Waits until the home position is known.
    station.run_ms(2_500);
    station
}

fn attitude(station: &Station) -> GIMBAL_DEVICE_ATTITUDE_STATUS_DATA {
    station.last_message(|m| if let MavMessage::GIMBAL_DEVICE_ATTITUDE_STATUS(g) = m { Some(g.clone()) } else { None }).unwrap()
}

fn pitch_deg(station: &mut Station) -> f32 {
    station.run_ms(GIMBAL_MOVE_MS);
    let q = attitude(station).q;
    (2.0 * q[2].atan2(q[0])).to_degrees()
}

/// Returns the primary and secondary controllers, which the manager reports immediately after a change.
fn control(station: &Station) -> Option<[(u8, u8); 2]> {
    station.last_message(|m| match m {
        MavMessage::GIMBAL_MANAGER_STATUS(s) => {
            Some([(s.primary_control_sysid, s.primary_control_compid), (s.secondary_control_sysid, s.secondary_control_compid)])
        }
        _ => None,
    })
}

/// A region of interest 50 m north of the pad and 50 m above it, with the height above sea level in a frame relative to
/// home, as MAVSDK sends it. PX4 uses only the value; the other autopilots respect the frame.
#[test]
fn wire_region_of_interest_height_follows_the_flavor() {
    for flavor in [&px4::FLAVOR, &ardupilot::FLAVOR, &generic::FLAVOR] {
        let mut station = Station::with_flavor(flavor, "drill-hover", 7);
        station.run_ms(2_500);
        let home = |m: &MavMessage| if let MavMessage::HOME_POSITION(h) = m { Some(h.clone()) } else { None };
        assert_eq!(station.command(1, MavCmd::MAV_CMD_REQUEST_MESSAGE, p(&[242.0])), OK);
        let home = station.last_message(home).unwrap();
        assert_eq!(station.command(1, MavCmd::MAV_CMD_SET_MESSAGE_INTERVAL, p(&[285.0, 100_000.0])), OK);
        for (frame, over_sea) in [(MavFrame::MAV_FRAME_GLOBAL, true), (MavFrame::MAV_FRAME_GLOBAL_RELATIVE_ALT, false)] {
            station.send(&MavMessage::COMMAND_INT(COMMAND_INT_DATA {
                command: MavCmd::MAV_CMD_DO_SET_ROI_LOCATION,
                frame,
                x: home.latitude + (50.0 * 360.0 / 40_000_000.0 * 1e7) as i32,
                y: home.longitude,
                z: home.altitude as f32 / 1_000.0 + 50.0,
                target_system: 1,
                target_component: 1,
                ..Default::default()
            }));
            let steep = home.altitude as f32 / 1_000.0 + 50.0;
            let wanted = if over_sea || flavor.roi_altitude_above_sea_level { 45.0 } else { steep.atan2(50.0).to_degrees() };
            let pitch = pitch_deg(&mut station);
            // The drone's position estimate is accurate to about a meter.
            assert!((pitch - wanted).abs() < 1.5, "{} {frame:?}: {pitch} not {wanted}", flavor.name);
        }
    }
    assert!(
        px4::FLAVOR.roi_altitude_above_sea_level
            && !ardupilot::FLAVOR.roi_altitude_above_sea_level
            && !generic::FLAVOR.roi_altitude_above_sea_level
    );
}

#[test]
fn wire_gimbal_control_can_be_acquired_transferred_and_released() {
    let mut station = on_the_pad();
    let configure = MavCmd::MAV_CMD_DO_GIMBAL_MANAGER_CONFIGURE;
    let (me, nobody) = ((255, 190), (0, 0));
    for (wish, wanted) in [
        (p(&[-2.0, -2.0, -1.0, -1.0]), [me, nobody]),
        (p(&[-1.0, -1.0, 42.0, 17.0]), [me, (42, 17)]),
        (p(&[-1.0, -1.0, -3.0, -3.0]), [me, (42, 17)]),
        (p(&[-1.0, -1.0, 0.0, 0.0]), [me, nobody]),
        (p(&[42.0, 17.0, -2.0, -2.0]), [(42, 17), me]),
        (p(&[-3.0, -3.0, -3.0, -3.0]), [(42, 17), nobody]),
        (p(&[0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 1.0]), [nobody, nobody]),
    ] {
        assert_eq!(station.command(1, configure, wish), OK, "{wish:?}");
        assert_eq!(control(&station), Some(wanted), "{wish:?}");
    }
    for wish in [p(&[-4.0]), p(&[300.0, 1.0]), p(&[NAN, NAN, -1.0, -1.0]), p(&[-2.0, -2.0, -1.0, -1.0, 0.0, 0.0, 3.0])] {
        assert_eq!(station.command(1, configure, wish), DENIED, "{wish:?}");
    }
}

#[test]
fn wire_gimbal_angle_respects_its_rate_and_integer_flags() {
    let mut station = on_the_pad();
    let aim = MavCmd::MAV_CMD_DO_GIMBAL_MANAGER_PITCHYAW;
    assert_eq!(station.command(1, aim, p(&[-60.0, NAN, 10.0, NAN])), OK);
    station.run_ms(2_000);
    let q = attitude(&station).q;
    let slow = (2.0 * q[2].atan2(q[0])).to_degrees();
    assert!((slow + 20.0).abs() < 2.0, "10 degrees per second for two seconds: {slow}");
    assert!((attitude(&station).angular_velocity_y.to_degrees() + 10.0).abs() < 0.1);
    // In COMMAND_INT, the flags are an unscaled integer (MAVSDK sends rates this way).
    let whole = |flags| {
        MavMessage::COMMAND_INT(COMMAND_INT_DATA {
            command: MavCmd::MAV_CMD_DO_GIMBAL_MANAGER_PITCHYAW,
            param1: NAN,
            param2: NAN,
            param3: NAN,
            param4: NAN,
            x: flags,
            z: 1.0,
            target_system: 1,
            target_component: 1,
            ..Default::default()
        })
    };
    let result = |m: &MavMessage| if let MavMessage::COMMAND_ACK(a) = m { Some(a.result) } else { None };
    assert_eq!(station.ask(&whole(1), result), Some(DENIED), "retracting must be rejected");
    assert_eq!(station.ask(&whole(2), result), Some(OK));
    assert!(pitch_deg(&mut station).abs() < TOLERANCE_DEG);
    assert!(attitude(&station).flags.contains(GimbalDeviceFlags::GIMBAL_DEVICE_FLAGS_NEUTRAL));
    assert_eq!(station.command(1, aim, p(&[NAN, 30.0, NAN, NAN])), DENIED, "yaw must be rejected");
    assert_eq!(station.command(1, aim, p(&[NAN, NAN, -40.0, NAN])), OK);
    assert!((pitch_deg(&mut station) + 90.0).abs() < TOLERANCE_DEG);
    let flags = attitude(&station);
    assert!(flags.failure_flags.contains(GimbalDeviceErrorFlags::GIMBAL_DEVICE_ERROR_FLAGS_AT_PITCH_LIMIT), "{flags:?}");
    assert!(!flags.flags.contains(GimbalDeviceFlags::GIMBAL_DEVICE_FLAGS_NEUTRAL));
}

#[test]
fn wire_gimbal_manager_and_device_report_their_capabilities() {
    let mut station = on_the_pad();
    for id in [280.0, 281.0, 283.0, 285.0] {
        assert_eq!(station.command(1, MavCmd::MAV_CMD_REQUEST_MESSAGE, p(&[id])), OK, "{id}");
        assert!(station.received.iter().any(|frame| f64::from(frame.message_id) == f64::from(id)), "{id}");
    }
    station.command(1, MavCmd::MAV_CMD_REQUEST_MESSAGE, p(&[280.0]));
    let manager =
        station.last_message(|m| if let MavMessage::GIMBAL_MANAGER_INFORMATION(g) = m { Some(g.clone()) } else { None }).unwrap();
    station.command(1, MavCmd::MAV_CMD_REQUEST_MESSAGE, p(&[283.0]));
    let device =
        station.last_message(|m| if let MavMessage::GIMBAL_DEVICE_INFORMATION(g) = m { Some(g.clone()) } else { None }).unwrap();
    assert_eq!((manager.pitch_min, manager.pitch_max), (device.pitch_min, device.pitch_max));
    // The manager has all capabilities of the device, and can also point at positions.
    let point = GimbalManagerCapFlags::GIMBAL_MANAGER_CAP_FLAGS_CAN_POINT_LOCATION_GLOBAL;
    assert_eq!(manager.cap_flags, GimbalManagerCapFlags::from_bits_retain(u32::from(device.cap_flags.bits())) | point);
    assert_eq!((manager.gimbal_device_id, device.gimbal_device_id), (1, 1));
    let half = (-50.0_f32).to_radians() / 2.0;
    let look = MavMessage::GIMBAL_DEVICE_SET_ATTITUDE(GIMBAL_DEVICE_SET_ATTITUDE_DATA {
        q: [half.cos(), 0.0, half.sin(), 0.0],
        angular_velocity_x: NAN,
        angular_velocity_y: NAN,
        angular_velocity_z: NAN,
        flags: GimbalDeviceFlags::empty(),
        target_system: 1,
        target_component: 1,
    });
    station.send(&look);
    assert!((pitch_deg(&mut station) + 50.0).abs() < TOLERANCE_DEG);
    station.command(1, MavCmd::MAV_CMD_DO_GIMBAL_MANAGER_PITCHYAW, p(&[10.0, NAN, NAN, NAN]));
    station.command(1, MavCmd::MAV_CMD_DO_GIMBAL_MANAGER_CONFIGURE, p(&[42.0, 17.0, -1.0, -1.0]));
    station.send(&look);
    assert!((pitch_deg(&mut station) - 10.0).abs() < TOLERANCE_DEG, "only the controlling station may move the gimbal");
}

#[test]
fn wire_superseded_mount_commands_follow_their_modes() {
    let mut station = on_the_pad();
    let (control, configure) = (MavCmd::MAV_CMD_DO_MOUNT_CONTROL, MavCmd::MAV_CMD_DO_MOUNT_CONFIGURE);
    assert_eq!(station.command(1, control, p(&[-35.0, 0.0, 0.0, 0.0, 0.0, 0.0, 2.0])), OK);
    assert!((pitch_deg(&mut station) + 35.0).abs() < TOLERANCE_DEG);
    assert_eq!(station.command(1, control, p(&[-35.0, 0.0, 0.0, 0.0, 0.0, 0.0, 1.0])), OK);
    assert!(pitch_deg(&mut station).abs() < TOLERANCE_DEG, "neutral");
    // A position 100 m north of the pad and 100 m above it is at an elevation of 45 degrees.
    let (lat, lon, up) = (46.7052 + 100.0 / 111_180.0, 8.3814, 430.0 + 100.0);
    assert_eq!(station.command(1, control, p(&[0.0, 0.0, 0.0, up, lat, lon, 4.0])), OK);
    let seen = pitch_deg(&mut station);
    assert!((seen - 45.0).abs() < 1.0, "{seen} is not within the tolerance for height error and rounding");
    // Home 100 m north of the pad and 100 m below it.
    assert_eq!(station.command(1, MavCmd::MAV_CMD_DO_SET_HOME, p(&[0.0, 0.0, 0.0, 0.0, lat, lon, up - 200.0])), OK);
    assert_eq!(station.command(1, control, p(&[0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 6.0])), OK);
    let seen = pitch_deg(&mut station);
    assert!((seen + 45.0).abs() < 1.0, "{seen} is not within the tolerance for height error and rounding");
    for mode in [0.0, 5.0, 7.0, 8.0] {
        assert_eq!(station.command(1, control, p(&[0.0, 0.0, 0.0, 0.0, 0.0, 0.0, mode])), DENIED, "{mode}");
        assert_eq!(station.command(1, configure, p(&[mode, 1.0, 1.0])), DENIED, "{mode}");
    }
    assert_eq!(station.command(1, configure, p(&[1.0, 1.0, 1.0, 0.0])), OK);
    assert!(pitch_deg(&mut station).abs() < TOLERANCE_DEG);
    assert_eq!(
        station.command(1, configure, p(&[2.0, 1.0, 1.0, 0.0, 0.0, 1.0, 0.0])),
        OK,
        "the configuration must turn pitch into a rate"
    );
    assert_eq!(station.command(1, control, p(&[5.0, 0.0, 0.0, 0.0, 0.0, 0.0, 2.0])), OK);
    let turned = pitch_deg(&mut station);
    assert!((turned - 5.0 * GIMBAL_MOVE_MS as f32 / 1000.0).abs() < 1.0, "{turned}");
}

fn lamp(station: &Station) -> Option<bool> {
    station.last_message(|m| if let MavMessage::ILLUMINATOR_STATUS(i) = m { Some(i.enable == 1) } else { None })
}

#[test]
fn wire_lamp_responds_through_every_interface() {
    let mut station = on_the_pad();
    use MavCmd as M;
    for (command, values, on) in [
        (M::MAV_CMD_ILLUMINATOR_ON_OFF, p(&[1.0]), true),
        (M::MAV_CMD_DO_SET_RELAY, p(&[0.0, 0.0]), false),
        (M::MAV_CMD_DO_SET_ACTUATOR, p(&[0.8, NAN, NAN, NAN, NAN, NAN, 0.0]), true),
        (M::MAV_CMD_DO_SET_ACTUATOR, p(&[NAN, NAN, NAN, NAN, NAN, NAN, 0.0]), true),
        (M::MAV_CMD_DO_SET_ACTUATOR, p(&[-1.0, NAN, NAN, NAN, NAN, NAN, 0.0]), false),
        (M::MAV_CMD_DO_SET_SERVO, p(&[9.0, 1_900.0]), true),
        (M::MAV_CMD_DO_SET_SERVO, p(&[9.0, 1_100.0]), false),
        (M::MAV_CMD_DO_SET_RELAY, p(&[0.0, 1.0]), true),
    ] {
        assert_eq!(station.command(1, command, values), OK, "{command:?} {values:?}");
        station.run_ms(1_100);
        assert_eq!(lamp(&station), Some(on), "{command:?} {values:?}");
        let relay = station.last_message(|m| if let MavMessage::RELAY_STATUS(r) = m { Some((r.on, r.present)) } else { None });
        assert_eq!(relay, Some((u16::from(on), 1)));
        let servo = station.last_message(|m| if let MavMessage::SERVO_OUTPUT_RAW(s) = m { Some(s.servo9_raw) } else { None });
        assert_eq!(servo, Some(if on { 1_900 } else { 1_100 }));
    }
    for (command, values) in [
        (M::MAV_CMD_DO_SET_RELAY, p(&[1.0, 1.0])),
        (M::MAV_CMD_DO_SET_SERVO, p(&[1.0, 1_900.0])),
        (M::MAV_CMD_DO_SET_SERVO, p(&[9.0, 5_000.0])),
        (M::MAV_CMD_DO_SET_ACTUATOR, p(&[NAN, 0.5, NAN, NAN, NAN, NAN, 0.0])),
        (M::MAV_CMD_DO_SET_ACTUATOR, p(&[0.5, NAN, NAN, NAN, NAN, NAN, 1.0])),
        (M::MAV_CMD_DO_SET_ACTUATOR, p(&[7.0, NAN, NAN, NAN, NAN, NAN, 0.0])),
        (M::MAV_CMD_DO_REPEAT_RELAY, p(&[1.0, 3.0, 1.0])),
        (M::MAV_CMD_DO_REPEAT_RELAY, p(&[0.0, 0.0, 1.0])),
        (M::MAV_CMD_DO_REPEAT_RELAY, p(&[0.0, 3.0, 0.0])),
        (M::MAV_CMD_DO_ILLUMINATOR_CONFIGURE, p(&[1.0, 100.0, 0.5, 50.0])),
    ] {
        assert_eq!(station.command(1, command, values), DENIED, "{command:?} {values:?}");
    }
    station.run_ms(1_100);
    assert_eq!(lamp(&station), Some(true), "rejected commands must have no effect");
}

#[test]
fn wire_relay_repeat_command_blinks_the_lamp_and_restores_its_state() {
    let mut station = on_the_pad();
    station.received.clear();
    assert_eq!(station.command(1, MavCmd::MAV_CMD_DO_REPEAT_RELAY, p(&[0.0, 3.0, 0.4])), OK);
    station.run_ms(3_000);
    let told = station.all(|m| if let MavMessage::ILLUMINATOR_STATUS(i) = m { Some((i.uptime_ms, i.enable == 1)) } else { None });
    let mut changes: Vec<(u32, bool)> = Vec::new();
    for (at, on) in told {
        if changes.last().map_or(on, |last| last.1 != on) {
            changes.push((at, on));
        }
    }
    assert_eq!(changes.iter().map(|change| change.1).collect::<Vec<_>>(), [true, false, true, false, true, false]);
    for pair in changes.windows(2) {
        assert!((i64::from(pair[1].0 - pair[0].0) - 200).abs() <= 3, "changes must be reported immediately: {changes:?}");
    }
}
