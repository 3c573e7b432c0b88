//! The vehicle's self-description and rejections; interfaces that must not bypass its rules.
#![allow(deprecated, reason = "clients still send superseded MAVLink messages")]

use spandrel_mavlink::codec::{Decoder, Encoder};
use spandrel_mavlink::dialect::*;
use spandrel_mavlink::signing::{Signing, SigningKey};
use spandrel_model::time::SimTime;
use spandrel_sitl::endpoint::flavor::ardupilot;
use spandrel_sitl::endpoint::{LinkId, LinkKind};
use spandrel_sitl::sim::Sim;
use spandrel_testkit::plans::{self, home_north, item, ready, upload};
use spandrel_testkit::station::Station;

const OK: MavResult = MavResult::MAV_RESULT_ACCEPTED;
const DENIED: MavResult = MavResult::MAV_RESULT_DENIED;
const FAILED: MavResult = MavResult::MAV_RESULT_FAILED;
const NAN: f32 = f32::NAN;
const ARM: MavCmd = MavCmd::MAV_CMD_COMPONENT_ARM_DISARM;
const SIDECAR: LinkId = LinkId(2);
const TIMESTAMP: u64 = 30_000_000_000_000;

fn p(values: &[f32]) -> [f32; 7] {
    std::array::from_fn(|k| values.get(k).copied().unwrap_or(0.0))
}

fn texts(station: &Station) -> Vec<String> {
    station.all(|m| if let MavMessage::STATUSTEXT(t) = m { t.text.to_str().ok().map(str::to_owned) } else { None })
}

fn asked<T>(station: &mut Station, id: f32, pick: impl Fn(&MavMessage) -> Option<T>) -> T {
    station.received.clear();
    assert_eq!(station.command(1, MavCmd::MAV_CMD_REQUEST_MESSAGE, p(&[id])), OK);
    station.last_message(pick).unwrap()
}

#[test]
fn wire_missions_move_the_gimbal_and_report_range_violations() {
    let mut station = ready(7);
    let north = home_north(&station);
    let aim = |seq, pitch| MISSION_ITEM_INT_DATA {
        param1: pitch,
        param3: NAN,
        param4: NAN,
        x: 0,
        y: 0,
        frame: MavFrame::MAV_FRAME_MISSION,
        ..item(seq, MavCmd::MAV_CMD_DO_GIMBAL_MANAGER_PITCHYAW, north, 0.0)
    };
    let items = [item(0, MavCmd::MAV_CMD_NAV_TAKEOFF, north, 4.0), aim(1, -40.0), aim(2, 170.0)];
    assert_eq!(upload(&mut station, &items), plans::ACCEPTED);
    let control = MavCmd::MAV_CMD_DO_GIMBAL_MANAGER_CONFIGURE;
    assert_eq!(station.command(1, control, p(&[-2.0, -2.0, -1.0, -1.0])), OK);
    assert_eq!(station.command(1, MavCmd::MAV_CMD_MISSION_START, p(&[])), OK);
    assert_eq!(station.command(1, ARM, p(&[1.0])), OK);
    station.received.clear();
    station.run_until(30.0, |s| {
        s.all(|m| if let MavMessage::MISSION_ITEM_REACHED(r) = m { Some(r.seq) } else { None }).contains(&2)
    });
    station.run_ms(2_000);
    let pitch = station.last_message(|m| match m {
        MavMessage::GIMBAL_DEVICE_ATTITUDE_STATUS(g) => Some((2.0 * g.q[2].atan2(g.q[0])).to_degrees()),
        _ => None,
    });
    assert!(pitch.is_some_and(|pitch| (pitch + 40.0).abs() < 1.0), "pitch must be within one degree: {pitch:?}");
    let said = texts(&station);
    assert!(said.iter().any(|text| text.starts_with("Mission item 2: gimbal pitch range")), "{said:?}");
    assert!(!said.iter().any(|text| text.starts_with("Mission item 1")), "{said:?}");
}

fn timesync(encoder: &mut Encoder, ts1: i64, target_system: u8) -> Vec<u8> {
    encoder.encode(&MavMessage::TIMESYNC(TIMESYNC_DATA {
        tc1: 5,
        ts1,
        target_system,
        target_component: u8::from(target_system > 0),
    }))
}

/// Returns the token of the TIMESYNC request that a lockstep vehicle sends on a link.
fn question(sim: &mut Sim) -> i64 {
    sim.handle_timeout(sim.now() + SimTime::from_ms(100));
    let mut token = None;
    while let Some(transmit) = sim.poll_transmit() {
        for frame in Decoder::new().datagram(&transmit.bytes) {
            if let Some(MavMessage::TIMESYNC(sync)) = frame.message {
                token = Some(sync.ts1);
            }
        }
    }
    token.expect("the vehicle must send a request")
}

#[test]
fn wire_lockstep_response_must_be_addressed_and_signed() {
    let mut sim = Station::new("drill-hover", 7).vehicle.sim;
    sim.open_link(SIDECAR, LinkKind::Payload, true);
    let token = question(&mut sim);
    let mut encoder = Encoder::new(1, 191);
    sim.handle_datagram(SIDECAR, &timesync(&mut encoder, token, 200));
    assert!(sim.waiting(), "a response to another client must not advance time");
    sim.require_signatures(SigningKey::from_passphrase("bridge over water"), TIMESTAMP, &[]);
    sim.set_signing_time(TIMESTAMP);
    let bare = timesync(&mut encoder, token, 0);
    sim.handle_datagram(SIDECAR, &bare);
    assert!(sim.waiting(), "unsigned");
    let mut signing = Signing::new(SigningKey::from_passphrase("bridge over water"), 9, TIMESTAMP);
    let signed = signing.sign(timesync(&mut encoder, token, 1), TIMESTAMP);
    sim.handle_datagram(SIDECAR, &signed);
    assert!(!sim.waiting());
    let refused = sim.rejected_frames();
    question(&mut sim);
    assert_eq!(sim.rejected_frames(), refused + 1, "only the unsigned response must be rejected");
}

/// A full socket buffer loses datagrams, so the request is sent again; repeating it changes nothing.
#[test]
fn wire_lost_lockstep_request_is_repeated() {
    let mut sim = Station::new("drill-hover", 7).vehicle.sim;
    sim.open_link(SIDECAR, LinkKind::Payload, true);
    let token = question(&mut sim);
    let now = sim.now();
    let requests = |sim: &mut Sim| {
        let sent: Vec<_> = std::iter::from_fn(|| sim.poll_transmit()).filter(|transmit| transmit.link == SIDECAR).collect();
        let messages =
            sent.iter().flat_map(|transmit| Decoder::new().datagram(&transmit.bytes)).filter_map(|frame| frame.message);
        messages.filter(|message| matches!(message, MavMessage::TIMESYNC(sync) if sync.tc1 == 0 && sync.ts1 == token)).count()
    };
    assert_eq!(requests(&mut sim), 0, "the request was taken");
    sim.repeat_lockstep_requests();
    assert_eq!((requests(&mut sim), sim.now()), (1, now));
    let mut encoder = Encoder::new(1, 191);
    sim.handle_datagram(SIDECAR, &timesync(&mut encoder, token, 1));
    assert!(!sim.waiting());
    sim.repeat_lockstep_requests();
    assert_eq!(requests(&mut sim), 0, "answered");
}

fn press(station: &mut Station, button: u16) {
    for buttons in [0, 1 << button] {
        let sticks = MANUAL_CONTROL_DATA { z: 500, buttons, target: 1, ..Default::default() };
        station.send(&MavMessage::MANUAL_CONTROL(sticks));
        station.run_ms(20);
    }
}

fn armed(station: &mut Station) -> bool {
    station.received.clear();
    station.run_ms(1_100);
    let beat = station.last_message(|m| match m {
        MavMessage::HEARTBEAT(beat) if beat.mavtype == MavType::MAV_TYPE_QUADROTOR => Some(beat.base_mode),
        _ => None,
    });
    beat.unwrap().contains(MavModeFlag::MAV_MODE_FLAG_SAFETY_ARMED)
}

#[test]
fn wire_buttons_follow_the_rules_of_their_commands() {
    let mut station = Station::with_flavor(&ardupilot::FLAVOR, "drill-hover", 7);
    station.run_ms(2_500);
    for (name, value) in [("BTN1_FUNCTION", 1.0), ("BTN2_FUNCTION", 3.0)] {
        station.send(&MavMessage::PARAM_SET(PARAM_SET_DATA {
            param_value: value,
            target_system: 1,
            target_component: 1,
            param_id: name.into(),
            param_type: MavParamType::MAV_PARAM_TYPE_INT32,
        }));
        station.run_ms(5);
    }
    let mode = |number| p(&[1.0, number]);
    assert_eq!(station.command(1, MavCmd::MAV_CMD_DO_SET_MODE, mode(6.0)), OK);
    press(&mut station, 1);
    assert!(texts(&station).contains(&"Arm: RTL mode not armable".to_owned()), "{:?}", texts(&station));
    assert!(!armed(&mut station));
    press(&mut station, 2);
    assert!(texts(&station).contains(&"Takeoff requires mode Guided".to_owned()), "{:?}", texts(&station));
    assert_eq!(station.command(1, MavCmd::MAV_CMD_DO_SET_MODE, mode(4.0)), OK);
    press(&mut station, 1);
    assert!(armed(&mut station), "{:?}", texts(&station));
    press(&mut station, 2);
    assert_eq!(station.command(1, MavCmd::MAV_CMD_SET_MESSAGE_INTERVAL, p(&[245.0, 50_000.0])), OK);
    let flies = station.run_until(15.0, |s| {
        let state = s.last_message(|m| if let MavMessage::EXTENDED_SYS_STATE(e) = m { Some(e.landed_state) } else { None });
        state == Some(MavLandedState::MAV_LANDED_STATE_IN_AIR)
    });
    assert!(flies, "{:?}", texts(&station));
}

#[test]
fn wire_forced_arming_works_in_a_mode_that_is_not_armable() {
    let mut station = Station::with_flavor(&ardupilot::FLAVOR, "drill-hover", 7);
    station.run_ms(2_500);
    assert_eq!(station.command(1, MavCmd::MAV_CMD_DO_SET_MODE, p(&[1.0, 6.0])), OK);
    assert_eq!(station.command(1, ARM, p(&[1.0])), FAILED);
    assert_eq!(station.command(1, ARM, p(&[1.0, 2989.0])), OK);
}

#[test]
fn wire_home_item_is_not_a_jump_target() {
    let mut station = Station::with_flavor(&ardupilot::FLAVOR, "drill-hover", 7);
    station.run_ms(2_500);
    let result = |m: &MavMessage| if let MavMessage::MISSION_ACK(a) = m { Some(a.mavtype) } else { None };
    let home = item(0, MavCmd::MAV_CMD_NAV_WAYPOINT, 0.0, 0.0);
    assert_eq!(upload(&mut station, std::slice::from_ref(&home)), plans::ACCEPTED);
    assert_eq!(station.ask(&MavMessage::MISSION_ITEM_INT(home.clone()), result), Some(plans::ACCEPTED));
    for (aim, wanted) in [(0.0, MavMissionResult::MAV_MISSION_INVALID_PARAM1), (1.0, plans::ACCEPTED)] {
        let jump = MISSION_ITEM_INT_DATA { param1: aim, param2: 1.0, ..item(2, MavCmd::MAV_CMD_DO_JUMP, 0.0, 0.0) };
        let plan = [home.clone(), item(1, MavCmd::MAV_CMD_NAV_WAYPOINT, 5.0, 5.0), jump];
        assert_eq!(upload(&mut station, &plan), wanted, "to {aim}");
    }
}

#[test]
fn wire_vehicles_have_unique_ids_and_the_product_vendor_id() {
    let of = |instance| {
        let mut station = Station::with_instance("drill-hover", 7, instance);
        station.run_ms(1_000);
        let command = COMMAND_LONG_DATA {
            command: MavCmd::MAV_CMD_REQUEST_MESSAGE,
            param1: 148.0,
            target_system: instance + 1,
            target_component: 1,
            ..Default::default()
        };
        let version = |m: &MavMessage| if let MavMessage::AUTOPILOT_VERSION(v) = m { Some(v.clone()) } else { None };
        station.ask(&MavMessage::COMMAND_LONG(command), version).unwrap()
    };
    let (first, second) = (of(0), of(1));
    assert_ne!(first.uid, second.uid);
    assert_eq!((first.vendor_id, first.product_id), (second.vendor_id, second.product_id));
    assert!(first.vendor_id != 0 && first.product_id != 0 && first.board_version != 0);
}

#[test]
fn wire_battery_state_follows_its_parameters() {
    let mut station = Station::new("drill-hover", 7);
    station.run_ms(1_000);
    let state = |station: &mut Station| {
        station.run_ms(100);
        asked(station, 147.0, |m| if let MavMessage::BATTERY_STATUS(b) = m { Some(b.charge_state) } else { None })
    };
    let set = |station: &mut Station, value: f32| {
        station.send(&MavMessage::PARAM_SET(PARAM_SET_DATA {
            param_value: value,
            target_system: 1,
            target_component: 1,
            param_id: "BAT_LOW_THR".into(),
            param_type: MavParamType::MAV_PARAM_TYPE_REAL32,
        }));
    };
    let full =
        station.last_message(|m| if let MavMessage::BATTERY_STATUS(b) = m { Some(b.battery_remaining) } else { None }).unwrap();
    assert_eq!(state(&mut station), MavBatteryChargeState::MAV_BATTERY_CHARGE_STATE_OK, "{full}%");
    set(&mut station, 0.5);
    assert_eq!(state(&mut station), MavBatteryChargeState::MAV_BATTERY_CHARGE_STATE_OK);
    // A failed battery has 5% left.
    station.send(&MavMessage::PARAM_SET(PARAM_SET_DATA {
        param_value: f32::from_bits(1),
        target_system: 1,
        target_component: 1,
        param_id: "SYS_FAILURE_EN".into(),
        param_type: MavParamType::MAV_PARAM_TYPE_INT32,
    }));
    station.run_ms(5);
    station.send(&MavMessage::PARAM_SET(PARAM_SET_DATA {
        param_value: 0.03,
        target_system: 1,
        target_component: 1,
        param_id: "BAT_CRIT_THR".into(),
        param_type: MavParamType::MAV_PARAM_TYPE_REAL32,
    }));
    station.run_ms(5);
    assert_eq!(station.command(1, MavCmd::MAV_CMD_INJECT_FAILURE, p(&[100.0, 1.0])), OK);
    assert_eq!(
        state(&mut station),
        MavBatteryChargeState::MAV_BATTERY_CHARGE_STATE_LOW,
        "5% must be above the critical level of 3%"
    );
}

#[test]
fn wire_failsafe_reports_current_and_intended_mode() {
    let mut station = Station::airborne("drill-hover", 7);
    let modes =
        |m: &MavMessage| if let MavMessage::CURRENT_MODE(c) = m { Some((c.custom_mode, c.intended_custom_mode)) } else { None };
    station.run_ms(1_500);
    let (flown, intended) = asked(&mut station, 436.0, modes);
    assert_eq!(intended, 3 << 16, "Position");
    assert_ne!(flown, intended, "the failsafe mode must differ from the requested one");
    station.sticks(0, 0, 500, 0);
    station.run_ms(200);
    assert_eq!(asked(&mut station, 436.0, modes), (3 << 16, 3 << 16));
}

#[test]
fn wire_flight_times_are_reported_per_flight() {
    let mut station = Station::new("drill-hover", 7);
    station.run_ms(2_500);
    let info = |m: &MavMessage| if let MavMessage::FLIGHT_INFORMATION(f) = m { Some(f.clone()) } else { None };
    let none = asked(&mut station, 264.0, info);
    assert_eq!((none.flight_uuid, none.arming_time_utc, none.takeoff_time_utc, none.landing_time), (0, 0, 0, 0));
    let now_us = station.sim.now().us().cast_unsigned();
    assert_eq!(station.command(1, MavCmd::MAV_CMD_NAV_TAKEOFF, p(&[0.0, 0.0, 0.0, NAN, NAN, NAN, NAN])), OK);
    assert_eq!(station.command(1, ARM, p(&[1.0])), OK);
    station.run_ms(8_000);
    let up = asked(&mut station, 264.0, info);
    assert!(up.flight_uuid == 1 && up.landing_time == 0, "{up:?}");
    assert!(up.arming_time_utc >= now_us && up.takeoff_time_utc >= up.arming_time_utc, "{up:?}");
    assert_eq!(station.command(1, MavCmd::MAV_CMD_NAV_LAND, p(&[])), OK);
    station.run_ms(25_000);
    let down = asked(&mut station, 264.0, info);
    assert!(u64::from(down.landing_time) * 1_000 > up.takeoff_time_utc, "{down:?}");
    assert_eq!((down.flight_uuid, down.takeoff_time_utc), (1, up.takeoff_time_utc));
    assert_eq!(station.command(1, ARM, p(&[1.0])), OK);
    station.run_ms(100);
    let next = asked(&mut station, 264.0, info);
    assert_eq!((next.flight_uuid, next.takeoff_time_utc, next.landing_time), (2, 0, 0));
    assert!(next.arming_time_utc > down.arming_time_utc);
}

#[test]
fn wire_rejections_include_a_reason() {
    use MavCmd as M;
    let mut station = ready(7);
    for (command, values, wanted, words) in [
        (ARM, p(&[0.5]), DENIED, "Arming: parameter 1"),
        (M::MAV_CMD_CONDITION_YAW, p(&[NAN]), DENIED, "Yaw: "),
        (M::MAV_CMD_DO_SET_STANDARD_MODE, p(&[99.0]), DENIED, "No such standard mode 99"),
        (M::MAV_CMD_DO_SET_HOME, p(&[0.0, 0.0, 0.0, 0.0, NAN, NAN, NAN]), DENIED, "Home: "),
        (M::MAV_CMD_DO_REPOSITION, p(&[0.0, 1.0, 0.0, NAN, 10.0, 10.0, 500.0]), DENIED, "Go-to: target beyond 20 km"),
        (M::MAV_CMD_DO_ORBIT, p(&[5.0, 1.0, 17.0]), DENIED, "Orbit: "),
        (M::MAV_CMD_DO_FENCE_ENABLE, p(&[2.0]), DENIED, "Fence: "),
        (M::MAV_CMD_DO_CHANGE_SPEED, p(&[2.0, 3.0]), DENIED, "Speed: type"),
        (M::MAV_CMD_DO_CHANGE_SPEED, p(&[1.0, -7.0]), DENIED, "Speed: must be > 0"),
        (M::MAV_CMD_NAV_TAKEOFF, p(&[0.0, 0.0, 0.0, 0.0, NAN, NAN, 5_000.0]), DENIED, "Takeoff height"),
        (M::MAV_CMD_DO_SET_MISSION_CURRENT, p(&[99.0]), DENIED, "No such mission item"),
    ] {
        assert_eq!(station.command(1, command, values), wanted, "{command:?}");
        station.run_ms(5);
        assert!(texts(&station).iter().any(|text| text.starts_with(words)), "{command:?}: {:?}", texts(&station));
    }
    let mut copter = Station::with_flavor(&ardupilot::FLAVOR, "drill-hover", 7);
    copter.run_ms(2_500);
    assert_eq!(copter.command(1, M::MAV_CMD_DO_REPOSITION, p(&[0.0, 0.0, 0.0, NAN, NAN, NAN, NAN])), DENIED);
    copter.run_ms(5);
    assert!(texts(&copter).iter().any(|text| text.starts_with("Go-to: not allowed in this mode")), "{:?}", texts(&copter));
}
