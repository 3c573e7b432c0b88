//! Offboard setpoints: positions, velocities, accelerations, attitudes, body rates; rejected setpoints; the end of
//! setpoints.
#![allow(deprecated, reason = "clients still send superseded MAVLink messages")]

use spandrel_mavlink::dialect::*;
use spandrel_testkit::station::Station;

type Local = SET_POSITION_TARGET_LOCAL_NED_DATA;

/// Offboard and Hold modes in HEARTBEAT.
const OFFBOARD: u32 = 6 << 16;
const HOLD: u32 = 4 << 16 | 3 << 24;
/// Type masks that use only position, velocity or acceleration, and ignore the heading and its rate.
const POSITION: u16 = 0b1101_1111_1000;
const VELOCITY: u16 = 0b1101_1100_0111;
const ACCELERATION: u16 = 0b1100_0011_1111;

fn local(coordinate_frame: MavFrame, mask: u16, set: impl Fn(&mut Local)) -> MavMessage {
    let mut t = Local { coordinate_frame, target_system: 1, target_component: 1, ..Default::default() };
    t.type_mask = PositionTargetTypemask::from_bits_retain(mask);
    set(&mut t);
    MavMessage::SET_POSITION_TARGET_LOCAL_NED(t)
}

fn attitude(mask: u8, set: impl Fn(&mut SET_ATTITUDE_TARGET_DATA)) -> MavMessage {
    let mut t = SET_ATTITUDE_TARGET_DATA { target_system: 1, target_component: 1, q: [1.0, 0.0, 0.0, 0.0], ..Default::default() };
    t.type_mask = AttitudeTargetTypemask::from_bits_retain(mask);
    set(&mut t);
    MavMessage::SET_ATTITUDE_TARGET(t)
}

/// Sends a setpoint at 20 Hz for `s` seconds.
fn fly(station: &mut Station, setpoint: &MavMessage, s: f64) {
    for _ in 0..(20.0 * s) as usize {
        station.send(setpoint);
        station.run_ms(50);
    }
}

fn offboard(station: &mut Station, setpoint: &MavMessage) {
    station.send(setpoint);
    station.run_ms(5);
    let mode = [1.0, 6.0, 0.0, 0.0, 0.0, 0.0, 0.0];
    assert_eq!(station.command(1, MavCmd::MAV_CMD_DO_SET_MODE, mode), MavResult::MAV_RESULT_ACCEPTED);
}

/// Returns the velocity that the vehicle reports, in m/s.
fn velocity(station: &Station) -> [f32; 3] {
    station.last_message(|m| if let MavMessage::LOCAL_POSITION_NED(p) = m { Some([p.vx, p.vy, p.vz]) } else { None }).unwrap()
}

fn angles(station: &Station) -> ATTITUDE_DATA {
    station.last_message(|m| if let MavMessage::ATTITUDE(a) = m { Some(a.clone()) } else { None }).unwrap()
}

/// Returns a manually flown vehicle at rest in the air, with its nose turned away from north.
fn level() -> Station {
    let mut station = Station::airborne("drill-hover", 7);
    for k in 0..150 {
        station.sticks(0, 0, 500, if k < 50 { 700 } else { 0 });
        station.run_ms(20);
    }
    station
}

#[test]
fn wire_offboard_position_flight_starts_from_the_ground() {
    let mut station = Station::new("drill-hover", 7);
    station.run_ms(2_500);
    let [n, e, d] = station.place();
    let there = local(MavFrame::MAV_FRAME_LOCAL_NED, POSITION, |t| (t.x, t.y, t.z) = (n + 8.0, e + 3.0, d - 6.0));
    offboard(&mut station, &there);
    let arm = [1.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0];
    assert_eq!(station.command(1, MavCmd::MAV_CMD_COMPONENT_ARM_DISARM, arm), MavResult::MAV_RESULT_ACCEPTED);
    fly(&mut station, &there, 20.0);
    let at = station.place();
    let off = (at[0] - n - 8.0).hypot(at[1] - e - 3.0).hypot(at[2] - d + 6.0);
    assert!(off < 0.5, "{at:?}: {off} m off in the vehicle's own estimate");
    assert_eq!(station.mode(), Some(OFFBOARD));
}

#[test]
fn wire_body_frame_velocities_rotate_with_the_heading() {
    for frame in [MavFrame::MAV_FRAME_BODY_NED, MavFrame::MAV_FRAME_BODY_OFFSET_NED, MavFrame::MAV_FRAME_BODY_FRD] {
        let mut station = level();
        let ahead = local(frame, VELOCITY, |t| (t.vx, t.vy) = (2.0, 0.0));
        offboard(&mut station, &ahead);
        fly(&mut station, &ahead, 4.0);
        let yaw = angles(&station).yaw;
        let [vn, ve, _] = velocity(&station);
        let (forward, right) = (vn * yaw.cos() + ve * yaw.sin(), ve * yaw.cos() - vn * yaw.sin());
        assert!((forward - 2.0).abs() < 0.3 && right.abs() < 0.3, "{frame:?}: forward {forward}, right {right}");
        assert!(yaw.sin().abs() > 0.3, "the test requires a heading other than north: {yaw}");
    }
}

#[test]
fn wire_acceleration_setpoint_increases_the_speed() {
    let mut station = level();
    let push = local(MavFrame::MAV_FRAME_LOCAL_NED, ACCELERATION, |t| (t.afx, t.afy, t.afz) = (0.5, 0.0, 0.0));
    offboard(&mut station, &push);
    fly(&mut station, &push, 3.0);
    let [vn, ve, vd] = velocity(&station);
    // Less than 1.5 m/s, because the vehicle takes a few tenths of a second to tilt.
    assert!((0.8..1.8).contains(&vn) && ve.abs() < 0.4 && vd.abs() < 0.4, "{vn} {ve} {vd}");
}

#[test]
fn wire_attitude_and_rate_setpoints_are_flown() {
    let mut station = level();
    let hover = station.last_message(|m| if let MavMessage::ATTITUDE_TARGET(t) = m { Some(t.thrust) } else { None }).unwrap();
    let (sin, cos) = (0.05f32.sin(), 0.05f32.cos());
    let lean = attitude(0b0000_0111, |t| (t.q, t.thrust) = ([cos, sin, 0.0, 0.0], hover));
    offboard(&mut station, &lean);
    fly(&mut station, &lean, 1.0);
    assert!((angles(&station).roll - 0.1).abs() < 0.03, "{}", angles(&station).roll);
    let spin = attitude(0b1000_0000, |t| (t.body_yaw_rate, t.thrust) = (0.6, hover));
    fly(&mut station, &spin, 1.0);
    assert!((angles(&station).yawspeed - 0.6).abs() < 0.1, "{}", angles(&station).yawspeed);
    let pitch = angles(&station).pitch;
    let nod = attitude(0b1000_0000, |t| (t.body_pitch_rate, t.thrust) = (0.4, hover));
    fly(&mut station, &nod, 0.5);
    assert!((angles(&station).pitchspeed - 0.4).abs() < 0.1 && angles(&station).pitch > pitch + 0.1);
}

#[test]
fn wire_invalid_setpoints_are_ignored_and_reported_once_per_second() {
    let frame = MavFrame::MAV_FRAME_LOCAL_NED;
    let wrong = [
        (local(MavFrame::MAV_FRAME_LOCAL_ENU, POSITION, |_| {}), "frame"),
        (local(frame, 0b1101_1111_1111, |_| {}), "no position"),
        (local(frame, ACCELERATION | 1 << 9, |t| t.afx = 1.0), "force"),
        (local(frame, POSITION, |t| t.x = f32::INFINITY), "out of range"),
        (local(frame, POSITION, |t| (t.x, t.y, t.z) = (f32::NAN, f32::NAN, f32::NAN)), "no position"),
        (local(MavFrame::MAV_FRAME_BODY_NED, POSITION, |_| {}), "no position"),
        (attitude(0b1000_0111, |t| t.thrust = 0.5), "no attitude or rates"),
        (attitude(0b0100_0000, |_| {}), "no thrust"),
        (attitude(0, |t| (t.q, t.thrust) = ([0.0; 4], 0.5)), "invalid attitude"),
    ];
    for (setpoint, needle) in wrong {
        let mut station = Station::new("drill-hover", 7);
        station.run_ms(1_500);
        fly(&mut station, &setpoint, 2.0);
        let told: Vec<_> = station.texts().into_iter().filter(|t| t.contains(needle)).collect();
        assert!((2..=3).contains(&told.len()), "{setpoint:?}: {:?}", station.texts());
        let mode = [1.0, 6.0, 0.0, 0.0, 0.0, 0.0, 0.0];
        let result = station.command(1, MavCmd::MAV_CMD_DO_SET_MODE, mode);
        assert_eq!(result, MavResult::MAV_RESULT_TEMPORARILY_REJECTED, "{needle}");
    }
}

#[test]
fn wire_setpoints_for_other_vehicles_are_ignored() {
    let mut station = level();
    let ours = local(MavFrame::MAV_FRAME_LOCAL_NED, VELOCITY, |_| {});
    offboard(&mut station, &ours);
    for (system, component) in [(2, 1), (1, 100), (1, 42)] {
        let theirs = local(MavFrame::MAV_FRAME_LOCAL_NED, VELOCITY, |t| {
            (t.vx, t.target_system, t.target_component) = (3.0, system, component);
        });
        fly(&mut station, &theirs, 0.5);
        fly(&mut station, &ours, 0.5);
        assert!(velocity(&station)[0].abs() < 0.5, "{system}/{component}: {:?}", velocity(&station));
    }
}

#[test]
fn wire_setpoint_loss_is_reported_and_leads_to_hold() {
    let mut station = level();
    let ahead = local(MavFrame::MAV_FRAME_LOCAL_NED, VELOCITY, |t| t.vx = 2.0);
    offboard(&mut station, &ahead);
    fly(&mut station, &ahead, 2.0);
    station.received.clear();
    // COM_OF_LOSS_T is one second, as in PX4; no failsafe may trigger earlier.
    station.run_ms(900);
    assert!(!station.texts().iter().any(|t| t.contains("setpoints lost")), "{:?}", station.texts());
    station.run_ms(1_300);
    assert!(station.texts().iter().any(|t| t.contains("setpoints lost")), "{:?}", station.texts());
    assert_eq!(station.mode(), Some(HOLD));
    station.run_ms(3_000);
    assert!(velocity(&station)[0].abs() < 0.3, "{:?}", velocity(&station));
}
