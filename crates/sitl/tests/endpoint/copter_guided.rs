//! ArduCopter's GUIDED mode: effects of GUID_OPTIONS, reported targets, and pause.

use super::copter::{ARM, BRAKE, GUIDED, METERS_PER_E7_DEGREE, SET_MODE, copter, copter_at, mode, next_heartbeat};
use spandrel_mavlink::dialect::*;
use spandrel_testkit::station::{Station, one};

const ACCEPTED: MavResult = MavResult::MAV_RESULT_ACCEPTED;
const REQUEST: MavCmd = MavCmd::MAV_CMD_REQUEST_MESSAGE;
/// Heading tolerance, degrees (ArduPilot's autotest: 5).
const HEADING_TOLERANCE_DEG: f32 = 5.0;

fn set_options(station: &mut Station, bits: f32) {
    assert_eq!(station.set("GUID_OPTIONS", bits, MavParamType::MAV_PARAM_TYPE_INT32), Some(bits));
}

fn heading_deg(station: &mut Station) -> f32 {
    station.command(1, REQUEST, one(30.0));
    station.run_ms(5);
    station.last_message(|m| if let MavMessage::ATTITUDE(a) = m { Some(a.yaw.to_degrees()) } else { None }).unwrap()
}

fn turned_deg(from: f32, to: f32) -> f32 {
    (to - from + 540.0).rem_euclid(360.0) - 180.0
}

fn transmitter(yaw: u16, chan8_raw: u16) -> MavMessage {
    MavMessage::RC_CHANNELS_OVERRIDE(RC_CHANNELS_OVERRIDE_DATA {
        chan1_raw: 1500,
        chan2_raw: 1500,
        chan3_raw: 1500,
        chan4_raw: yaw,
        chan5_raw: u16::MAX,
        chan8_raw,
        target_system: 1,
        target_component: 1,
        ..Default::default()
    })
}

fn hold_yaw(station: &mut Station, us: u16, ms: i64) {
    for _ in 0..ms / 50 {
        station.send(&transmitter(us, u16::MAX));
        station.run_ms(50);
    }
}

#[test]
fn regress_rc_arming_in_guided_requires_guid_options() {
    let mut station = copter();
    assert_eq!(station.set("RC8_OPTION", 153.0, MavParamType::MAV_PARAM_TYPE_INT16), Some(153.0));
    assert_eq!(station.set("FLTMODE_CH", 0.0, MavParamType::MAV_PARAM_TYPE_INT8), Some(0.0));
    assert_eq!(station.command(1, SET_MODE, mode(GUIDED)), ACCEPTED);
    let armed_by_switch = |station: &mut Station| {
        station.send(&transmitter(1500, 1000));
        station.run_ms(50);
        station.send(&transmitter(1500, 2000));
        next_heartbeat(station).base_mode.contains(MavModeFlag::MAV_MODE_FLAG_SAFETY_ARMED)
    };
    assert!(!armed_by_switch(&mut station));
    assert!(station.has_text("Arm: GUIDED mode not armable"), "{:?}", station.texts());
    set_options(&mut station, 1.0);
    assert!(armed_by_switch(&mut station), "{:?}", station.texts());
    station.send(&transmitter(1500, 1000));
    station.run_ms(50);
    set_options(&mut station, 0.0);
    assert_eq!(station.command(1, ARM, one(1.0)), ACCEPTED, "a ground station must always be able to arm");
}

#[test]
fn regress_yaw_stick_in_guided_follows_guid_options() {
    let mut station = copter_at(5.0);
    let before = heading_deg(&mut station);
    hold_yaw(&mut station, 1700, 2_000);
    hold_yaw(&mut station, 1500, 3_000);
    let after = heading_deg(&mut station);
    assert!(turned_deg(before, after) > 20.0, "{before} to {after} deg");
    hold_yaw(&mut station, 1500, 2_000);
    assert!(
        turned_deg(after, heading_deg(&mut station)).abs() < HEADING_TOLERANCE_DEG,
        "the heading must stay where the pilot left it"
    );
    assert_eq!(next_heartbeat(&mut station).custom_mode, GUIDED as u32);
    set_options(&mut station, 4.0);
    hold_yaw(&mut station, 1900, 2_000);
    let ignored = turned_deg(after, heading_deg(&mut station));
    assert!(ignored.abs() < HEADING_TOLERANCE_DEG, "{ignored} deg");
    assert_eq!(next_heartbeat(&mut station).custom_mode, GUIDED as u32);
}

#[test]
fn regress_attitude_thrust_in_guided_follows_guid_options() {
    let mut station = copter_at(5.0);
    let thrust_after = |station: &mut Station, asked: f32| {
        for _ in 0..10 {
            station.send(&MavMessage::SET_ATTITUDE_TARGET(SET_ATTITUDE_TARGET_DATA {
                target_system: 1,
                target_component: 1,
                q: [1.0, 0.0, 0.0, 0.0],
                type_mask: AttitudeTargetTypemask::from_bits_retain(7),
                thrust: asked,
                ..Default::default()
            }));
            station.run_ms(50);
        }
        station.command(1, REQUEST, one(83.0));
        station.run_ms(5);
        station.last_message(|m| if let MavMessage::ATTITUDE_TARGET(a) = m { Some(a.thrust) } else { None }).unwrap()
    };
    // A thrust of 0.5 holds the height.
    let hover = thrust_after(&mut station, 0.5);
    let asked = hover + 0.1;
    assert!((thrust_after(&mut station, asked) - asked).abs() > 0.02, "thrust must be a climb rate by default");
    thrust_after(&mut station, 0.5);
    set_options(&mut station, 8.0);
    let given = thrust_after(&mut station, asked);
    assert!((given - asked).abs() < 0.01, "{given} of {asked}");
}

/// Tolerance within which a speed counts as reached, m/s (ArduPilot's autotest: 0.5).
const SPEED_TOLERANCE_M_S: f32 = 0.5;
/// Bits of a type mask that mark values to ignore, three bits each (MAVLink: POSITION_TARGET_TYPEMASK).
const IGNORE_POSITION: u16 = 0o7;
const IGNORE_VELOCITY: u16 = 0o70;
const IGNORE_ACCELERATION: u16 = 0o700;
const IGNORE_HEADING: u16 = 0xC00;

fn target(ignored: u16, place: [f32; 3], velocity: [f32; 3], acceleration: [f32; 3]) -> MavMessage {
    let ([x, y, z], [vx, vy, vz], [afx, afy, afz]) = (place, velocity, acceleration);
    MavMessage::SET_POSITION_TARGET_LOCAL_NED(SET_POSITION_TARGET_LOCAL_NED_DATA {
        target_system: 1,
        target_component: 1,
        coordinate_frame: MavFrame::MAV_FRAME_LOCAL_NED,
        type_mask: PositionTargetTypemask::from_bits_retain(ignored | IGNORE_HEADING),
        x,
        y,
        z,
        vx,
        vy,
        vz,
        afx,
        afy,
        afz,
        ..Default::default()
    })
}

fn reported(station: &mut Station) -> Option<POSITION_TARGET_LOCAL_NED_DATA> {
    station.received.clear();
    station.command(1, REQUEST, one(85.0));
    station.run_ms(5);
    station.last_message(|m| if let MavMessage::POSITION_TARGET_LOCAL_NED(t) = m { Some(t.clone()) } else { None })
}

fn parts(t: &POSITION_TARGET_LOCAL_NED_DATA) -> [[f32; 3]; 3] {
    [[t.x, t.y, t.z], [t.vx, t.vy, t.vz], [t.afx, t.afy, t.afz]]
}

#[test]
fn regress_guided_reports_targets_with_arducopters_masks() {
    let mut station = copter_at(5.0);
    let [north, east, down] = station.place();
    let place = [north + 30.0, east, down];
    let (velocity, acceleration, still) = ([1.5, -0.5, 0.0], [0.2, 0.1, 0.0], [0.0; 3]);
    let asked = [
        (IGNORE_VELOCITY | IGNORE_ACCELERATION, [place, still, still], 0xDF8),
        (IGNORE_POSITION | IGNORE_ACCELERATION, [still, velocity, still], 0xC07),
        (IGNORE_POSITION, [still, velocity, acceleration], 0xC07),
        (IGNORE_ACCELERATION, [place, velocity, still], 0xC00),
        (IGNORE_POSITION | IGNORE_VELOCITY, [still, still, acceleration], 0xC3F),
    ];
    for (ignored, wanted, mask) in asked {
        station.send(&target(ignored, wanted[0], wanted[1], wanted[2]));
        station.run_ms(200);
        let shown = reported(&mut station).expect("a target");
        assert_eq!(shown.type_mask.bits(), mask, "{ignored:#x}");
        let off = parts(&shown).iter().flatten().zip(wanted.iter().flatten()).map(|(a, b)| (a - b).abs()).fold(0.0, f32::max);
        assert!(off < 1e-3, "{:?} not {wanted:?}", parts(&shown));
    }
    station.command(1, SET_MODE, mode(BRAKE));
    station.run_ms(200);
    assert_eq!(reported(&mut station), None, "targets must be reported only in GUIDED");
}

#[test]
fn regress_global_target_is_reported_only_for_positions() {
    let mut station = copter_at(5.0);
    let [north, east, down] = station.place();
    let shown = |station: &mut Station| {
        station.received.clear();
        station.command(1, REQUEST, one(87.0));
        station.run_ms(5);
        station.last_message(|m| {
            if let MavMessage::POSITION_TARGET_GLOBAL_INT(t) = m { Some((t.lat_int, t.type_mask.bits())) } else { None }
        })
    };
    station.send(&target(IGNORE_VELOCITY | IGNORE_ACCELERATION, [north, east, down], [0.0; 3], [0.0; 3]));
    station.run_ms(200);
    let (here, mask) = shown(&mut station).expect("a place");
    assert_eq!(mask, 0xFDF8);
    station.send(&target(IGNORE_VELOCITY | IGNORE_ACCELERATION, [north + 10.0, east, down], [0.0; 3], [0.0; 3]));
    station.run_ms(200);
    let (there, _) = shown(&mut station).expect("a place");
    assert!((f64::from(there - here) * METERS_PER_E7_DEGREE - 10.0).abs() < 0.1, "{here} to {there}");
    station.send(&target(IGNORE_POSITION | IGNORE_ACCELERATION, [0.0; 3], [1.0, 0.0, 0.0], [0.0; 3]));
    station.run_ms(200);
    assert_eq!(shown(&mut station), None, "a velocity target must not have a position");
}

/// ArduPilot's test case PAUSE_CONTINUE_GUIDED, but with a velocity.
#[test]
fn regress_guided_velocity_can_be_paused_and_continued() {
    let mut station = copter_at(5.0);
    assert_eq!(station.set("GUID_TIMEOUT", 120.0, MavParamType::MAV_PARAM_TYPE_REAL32), Some(120.0));
    let velocity = [2.0, 1.0, 0.0];
    station.send(&target(IGNORE_POSITION | IGNORE_ACCELERATION, [0.0; 3], velocity, [0.0; 3]));
    let flies = |wanted: [f32; 3]| {
        move |station: &mut Station| {
            let at =
                station.last_message(|m| if let MavMessage::LOCAL_POSITION_NED(p) = m { Some([p.vx, p.vy, p.vz]) } else { None });
            at.is_some_and(|v| v.iter().zip(wanted).all(|(v, w)| (v - w).abs() < SPEED_TOLERANCE_M_S))
        }
    };
    assert!(station.run_until(10.0, flies(velocity)));
    for (go, wanted) in [(0.0, [0.0; 3]), (1.0, velocity)] {
        assert_eq!(station.command(1, MavCmd::MAV_CMD_DO_PAUSE_CONTINUE, one(go)), ACCEPTED);
        assert!(station.run_until(10.0, flies(wanted)), "{go}");
        station.run_ms(3_000);
        assert!(flies(wanted)(&mut station), "the state must persist: {go}");
    }
    assert_eq!(next_heartbeat(&mut station).custom_mode, GUIDED as u32);
}
