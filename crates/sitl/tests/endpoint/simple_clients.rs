//! Behavior that simple clients rely on: heartbeat order, clocks that start when the autopilot boots, the older request
//! for mission items, and items without a position.
#![allow(deprecated, reason = "simple clients support nothing newer")]

use super::copter::{ARM, AUTO, METERS_PER_E7_DEGREE, PAD, SET_MODE, copter, copter_at, mode};
use super::copter_plans::item;
use spandrel_mavlink::codec::{Decoder, Encoder};
use spandrel_mavlink::dialect::*;
use spandrel_model::geodesy::{Geo, LocalPlane};
use spandrel_model::time::SimTime;
use spandrel_sitl::endpoint::{LinkId, LinkKind};
use spandrel_testkit::plans::{ready, upload};
use spandrel_testkit::shipped::scenario;
use spandrel_testkit::station::{GCS, Station, one, p};

const ACCEPTED: MavResult = MavResult::MAV_RESULT_ACCEPTED;
/// Links of a lockstep peer and of a sidecar.
const PEER: LinkId = LinkId(9);
const SIDECAR: LinkId = LinkId(10);
/// Maximum position error, m: the mission's acceptance radius plus deceleration.
const POSITION_TOLERANCE_M: f64 = 1.5;

/// Returns the senders of heartbeats in the order of their arrival.
fn heartbeat_senders(station: &mut Station, ms: i64) -> Vec<u8> {
    station.received.clear();
    station.run_ms(ms);
    let beat = |m: &Option<MavMessage>| matches!(m, Some(MavMessage::HEARTBEAT(_)));
    station.received.iter().filter(|frame| beat(&frame.message)).map(|frame| frame.component_id).collect()
}

#[test]
fn regress_autopilot_heartbeat_is_first_and_last_in_every_datagram() {
    let mut station = Station::new("drill-hover", 7);
    let until = station.sim.now() + SimTime::from_ms(20_000);
    let (mut autopilot, mut camera) = (0, 0);
    station.sim.handle_timeout(until);
    while let Some(transmit) = station.sim.poll_transmit() {
        let frames = Decoder::new().datagram(&transmit.bytes);
        let of: Vec<u8> = frames
            .iter()
            .filter(|frame| matches!(frame.message, Some(MavMessage::HEARTBEAT(_))))
            .map(|frame| frame.component_id)
            .collect();
        assert!(of.first().is_none_or(|first| *first == 1) && of.last().is_none_or(|last| *last == 1), "{of:?}");
        autopilot += of.iter().filter(|component| **component == 1).count();
        camera += of.iter().filter(|component| **component == 100).count();
    }
    // From 0 s to 20 s: one heartbeat per second, and another after each camera heartbeat, every 4 s.
    assert_eq!((autopilot, camera), (27, 6));
}

#[test]
fn regress_camera_heartbeat_depends_on_camera_use() {
    let mut station = ready(7);
    station.command(100, MavCmd::MAV_CMD_REQUEST_MESSAGE, one(259.0));
    let used = heartbeat_senders(&mut station, 10_000);
    assert_eq!(used.iter().filter(|component| **component == 100).count(), 10, "{used:?}");
    assert_eq!((used[0], used.len()), (1, 20), "the autopilot's heartbeat must come first: {used:?}");
    let set = |value: i32| {
        MavMessage::PARAM_SET(PARAM_SET_DATA {
            param_value: f32::from_bits(value.cast_unsigned()),
            target_system: 1,
            target_component: 1,
            param_id: "SPAN_CAMERA".into(),
            param_type: MavParamType::MAV_PARAM_TYPE_INT32,
        })
    };
    station.send(&set(0));
    station.run_ms(20);
    assert_eq!(heartbeat_senders(&mut station, 5_000), [1; 5]);
    assert_eq!(
        station.command(1, MavCmd::MAV_CMD_IMAGE_START_CAPTURE, p(&[0.0, 0.0, 1.0])),
        ACCEPTED,
        "taking pictures must still work"
    );
    station.send(&set(1));
    station.run_ms(20);
    assert!(heartbeat_senders(&mut station, 5_000).contains(&100));
    let mut silent = Station::new("drill-hover", 7);
    silent.sim.mute_camera_heartbeat();
    assert!(!heartbeat_senders(&mut silent, 10_000).contains(&100));
}

fn boot_ms(station: &Station) -> u32 {
    station.last_message(|m| if let MavMessage::ATTITUDE(a) = m { Some(a.time_boot_ms) } else { None }).unwrap()
}

#[test]
fn regress_reboot_restarts_the_boot_clock_but_not_the_truth_clock() {
    let mut station = ready(7);
    station.sim.open_link(SIDECAR, LinkKind::Payload, false);
    station.run_ms(10_000);
    assert!(boot_ms(&station) > 12_000);
    assert_eq!(station.command(1, MavCmd::MAV_CMD_PREFLIGHT_REBOOT_SHUTDOWN, one(1.0)), ACCEPTED);
    station.received.clear();
    let rebooted = station.sim.now();
    let until = rebooted + SimTime::from_ms(3_000);
    station.sim.handle_timeout(until);
    let (mut theirs, mut ours, mut truth) = (Vec::new(), Vec::new(), 0);
    while let Some(transmit) = station.sim.poll_transmit() {
        for message in Decoder::new().datagram(&transmit.bytes).into_iter().filter_map(|frame| frame.message) {
            match message {
                MavMessage::ATTITUDE(a) if transmit.link == GCS => theirs.push(a.time_boot_ms),
                MavMessage::ATTITUDE(a) => ours.push(a.time_boot_ms),
                MavMessage::HIL_STATE_QUATERNION(h) => truth = h.time_usec,
                _ => {}
            }
        }
    }
    assert!(theirs.len() > 100 && theirs[0] < 1_000 && *theirs.last().unwrap() < 3_100, "{:?}", theirs.last());
    assert!(ours.iter().all(|ms| i64::from(*ms) >= rebooted.ms()), "the sidecar's clock must be the simulation time");
    assert!(truth >= 1_000 * rebooted.ms().cast_unsigned());
}

#[test]
fn regress_gps_raw_reports_the_ellipsoid_height() {
    let station = ready(7);
    let (alt, ellipsoid) = station
        .last_message(|m| if let MavMessage::GPS_RAW_INT(g) = m { Some((g.alt, g.alt_ellipsoid)) } else { None })
        .expect("GPS_RAW_INT must be streamed");
    // In the simulator, sea level equals the ellipsoid.
    assert_eq!(alt, ellipsoid);
    assert!(alt > 400_000, "{alt} mm");
}

/// Returns the requested item number of an upload, and whether the older message was used.
fn question(m: &MavMessage) -> Option<(u16, bool)> {
    match m {
        MavMessage::MISSION_REQUEST(r) => Some((r.seq, true)),
        MavMessage::MISSION_REQUEST_INT(r) => Some((r.seq, false)),
        _ => None,
    }
}

fn mission_count(count: u16) -> MavMessage {
    MavMessage::MISSION_COUNT(MISSION_COUNT_DATA { count, target_system: 1, target_component: 1, ..Default::default() })
}

/// Returns an item in the older form, as sent by clients that do not support the newer one.
fn to_mission_item(item: &MISSION_ITEM_INT_DATA) -> MavMessage {
    MavMessage::MISSION_ITEM(MISSION_ITEM_DATA {
        x: (f64::from(item.x) * 1e-7) as f32,
        y: (f64::from(item.y) * 1e-7) as f32,
        z: item.z,
        seq: item.seq,
        command: item.command,
        frame: item.frame,
        autocontinue: 1,
        target_system: 1,
        target_component: 1,
        ..Default::default()
    })
}

#[test]
fn regress_copter_requests_items_with_mission_request() {
    let mut station = copter();
    let home = item(0, MavCmd::MAV_CMD_NAV_WAYPOINT, 0.0, 0.0);
    let there = item(1, MavCmd::MAV_CMD_NAV_WAYPOINT, 10.0, 5.0);
    assert_eq!(station.ask(&mission_count(2), question), Some((0, true)));
    assert_eq!(station.ask(&to_mission_item(&home), question), Some((1, true)));
    let done = station.ask(&to_mission_item(&there), |m| if let MavMessage::MISSION_ACK(a) = m { Some(a.mavtype) } else { None });
    assert_eq!(done, Some(MavMissionResult::MAV_MISSION_ACCEPTED));
}

#[test]
fn regress_upload_uses_the_request_message_that_the_client_answers() {
    let mut station = ready(7);
    let items = [0, 1, 2].map(|seq| item(seq, MavCmd::MAV_CMD_NAV_WAYPOINT, 5.0 * f64::from(seq), 5.0));
    // A client that responds only to the older request.
    assert_eq!(station.ask(&mission_count(3), question), Some((0, false)));
    station.received.clear();
    assert!(station.run_until(3.0, |s| s.last_message(question) == Some((0, true))), "the other form must be tried");
    assert_eq!(station.ask(&to_mission_item(&items[0]), question), Some((1, true)), "the answered form must be kept");
    assert_eq!(station.ask(&to_mission_item(&items[1]), question), Some((2, true)));
    // If a client rejects one request form, the vehicle must use the other one immediately.
    assert_eq!(station.ask(&mission_count(3), question), Some((0, false)));
    let refusal = MavMessage::MISSION_ACK(MISSION_ACK_DATA {
        mavtype: MavMissionResult::MAV_MISSION_UNSUPPORTED,
        target_system: 1,
        target_component: 1,
        ..Default::default()
    });
    assert_eq!(station.ask(&refusal, question), Some((0, true)));
    assert_eq!(station.ask(&refusal, question), Some((0, false)));
}

/// Returns the vehicle's position from GLOBAL_POSITION_INT, in meters north of the pad and meters above sea level.
fn place(station: &mut Station) -> (f64, f64) {
    station.command(1, MavCmd::MAV_CMD_REQUEST_MESSAGE, one(33.0));
    station
        .last_message(|m| match m {
            MavMessage::GLOBAL_POSITION_INT(g) => {
                Some((f64::from(g.lat - PAD.0) * METERS_PER_E7_DEGREE, f64::from(g.alt) * 1e-3))
            }
            _ => None,
        })
        .unwrap()
}

#[test]
fn regress_zero_position_in_a_copter_item_means_the_current_position() {
    let mut station = copter();
    let (_, pad_m) = place(&mut station);
    let open = |seq, command, z| MISSION_ITEM_INT_DATA { x: 0, y: 0, ..item(seq, command, 0.0, z) };
    let wait = |seq| MISSION_ITEM_INT_DATA { param1: 3.0, x: 0, y: 0, ..item(seq, MavCmd::MAV_CMD_NAV_LOITER_TIME, 0.0, 0.0) };
    let items = [
        item(0, MavCmd::MAV_CMD_NAV_WAYPOINT, 0.0, 0.0),
        item(1, MavCmd::MAV_CMD_NAV_TAKEOFF, 0.0, 5.0),
        item(2, MavCmd::MAV_CMD_NAV_WAYPOINT, 12.0, 5.0),
        open(3, MavCmd::MAV_CMD_NAV_WAYPOINT, 9.0),
        wait(4),
        open(5, MavCmd::MAV_CMD_DO_SET_HOME, 0.0),
        item(6, MavCmd::MAV_CMD_NAV_WAYPOINT, 20.0, 0.0),
        wait(7),
    ];
    assert_eq!(upload(&mut station, &items), MavMissionResult::MAV_MISSION_ACCEPTED);
    assert_eq!(station.command(1, SET_MODE, mode(4.0)), ACCEPTED);
    assert_eq!(station.command(1, ARM, one(1.0)), ACCEPTED);
    assert_eq!(station.command(1, SET_MODE, mode(AUTO)), ACCEPTED);
    assert_eq!(station.command(1, MavCmd::MAV_CMD_MISSION_START, [0.0; 7]), ACCEPTED);
    let reached = |s: &Station, seq: u16| {
        s.last_message(|m| if let MavMessage::MISSION_ITEM_REACHED(r) = m { (r.seq >= seq).then_some(()) } else { None })
            .is_some()
    };
    assert!(station.run_until(120.0, |s| reached(s, 4)), "{:?}", station.texts());
    let (north, up) = place(&mut station);
    assert!(
        (north - 12.0).abs() < POSITION_TOLERANCE_M && (up - pad_m - 9.0).abs() < POSITION_TOLERANCE_M,
        "vertical takeoff: {north} m north, height {} m",
        up - pad_m
    );
    assert!(station.run_until(120.0, |s| reached(s, 7)), "{:?}", station.texts());
    let (north, up) = place(&mut station);
    assert!(
        (north - 20.0).abs() < POSITION_TOLERANCE_M && (up - pad_m - 9.0).abs() < POSITION_TOLERANCE_M,
        "level flight: {north} m north, height {} m",
        up - pad_m
    );
    let home =
        station.last_message(|m| if let MavMessage::HOME_POSITION(h) = m { Some(f64::from(h.altitude) * 1e-3) } else { None });
    assert!(
        home.is_none_or(|home| (home - pad_m - 9.0).abs() < POSITION_TOLERANCE_M),
        "home must be at the position of item 5: {home:?}"
    );
}

#[test]
fn regress_home_at_zero_means_the_current_position_only_for_copter() {
    let mut station = copter_at(6.0);
    assert_eq!(station.command(1, MavCmd::MAV_CMD_DO_SET_HOME, [0.0; 7]), ACCEPTED);
    station.run_ms(100);
    station.command(1, MavCmd::MAV_CMD_REQUEST_MESSAGE, one(33.0));
    let up = station
        .last_message(|m| if let MavMessage::GLOBAL_POSITION_INT(g) = m { Some(f64::from(g.relative_alt) * 1e-3) } else { None });
    assert!(up.is_some_and(|up| up.abs() < POSITION_TOLERANCE_M), "home must be at the hover position, but is {up:?} m above it");
    assert_eq!(ready(7).command(1, MavCmd::MAV_CMD_DO_SET_HOME, [0.0; 7]), MavResult::MAV_RESULT_DENIED);
}

/// Encodes a lockstep response with the peer's clock.
fn answer(clock: i64, token: i64) -> Vec<u8> {
    let sync = TIMESYNC_DATA { tc1: clock, ts1: token, ..Default::default() };
    Encoder::new(7, 191).encode(&MavMessage::TIMESYNC(sync))
}

#[test]
fn regress_lockstep_starts_with_the_first_response() {
    let mut sim = Station::new("drill-hover", 7).vehicle.sim;
    sim.open_link(PEER, LinkKind::Sdk, true);
    let heard = |sim: &mut spandrel_sitl::sim::Sim| -> Vec<MavMessage> {
        let sent = std::iter::from_fn(|| sim.poll_transmit()).filter(|t| t.link == PEER);
        sent.flat_map(|t| Decoder::new().datagram(&t.bytes)).filter_map(|frame| frame.message).collect()
    };
    sim.handle_timeout(SimTime::from_ms(1_000));
    assert_eq!(
        (sim.now(), sim.awaits_first_response()),
        (SimTime::from_ms(20), Some(false)),
        "time must not advance before the first response"
    );
    heard(&mut sim);
    sim.send_first_heartbeats();
    let knocked = heard(&mut sim);
    let beats = knocked.iter().filter(|m| matches!(m, MavMessage::HEARTBEAT(_))).count();
    let asks = knocked.iter().filter(|m| matches!(m, MavMessage::TIMESYNC(t) if t.ts1 == 20_000_000)).count();
    assert!(beats > 0 && asks == 1, "the vehicle must be discoverable and repeat its request: {knocked:?}");
    sim.stop_awaiting_first_responses();
    assert!(sim.runs_in_real_time() && !sim.waiting());
    sim.handle_timeout(SimTime::from_ms(1_000));
    assert_eq!(sim.now(), SimTime::from_ms(1_000), "a peer without lockstep must not stop time");
    assert!(heard(&mut sim).iter().any(|m| matches!(m, MavMessage::ATTITUDE(_))));
    sim.handle_datagram(PEER, &answer(5, 900_000_000));
    sim.handle_timeout(SimTime::from_ms(5_000));
    assert_eq!(
        (sim.now(), sim.waiting(), sim.runs_in_real_time()),
        (SimTime::from_ms(1_020), true, false),
        "lockstep must start with the first response"
    );
    sim.handle_datagram(PEER, &answer(6, 1_020_000_000));
    sim.handle_timeout(SimTime::from_ms(5_000));
    assert_eq!(sim.now(), SimTime::from_ms(1_040));
    assert_eq!(sim.awaits_first_response(), None, "the vehicle must no longer wait for a first response");
}

#[test]
fn regress_time_requests_are_answered_while_waiting_for_the_first_response() {
    let mut sim = Station::new("drill-hover", 7).vehicle.sim;
    sim.open_link(PEER, LinkKind::Sdk, true);
    sim.handle_timeout(SimTime::from_ms(1_000));
    let answers = |sim: &mut spandrel_sitl::sim::Sim| {
        let sent: Vec<_> = std::iter::from_fn(|| sim.poll_transmit()).filter(|t| t.link == PEER).collect();
        let frames = sent.iter().flat_map(|t| Decoder::new().datagram(&t.bytes));
        let answer =
            |message| if let MavMessage::TIMESYNC(t) = message { Some((t.ts1, t.tc1)).filter(|_| t.tc1 != 0) } else { None };
        frames.filter_map(|frame| answer(frame.message?)).collect::<Vec<_>>()
    };
    answers(&mut sim);
    let request = TIMESYNC_DATA { tc1: 0, ts1: 77, ..Default::default() };
    sim.handle_datagram(PEER, &Encoder::new(7, 191).encode(&MavMessage::TIMESYNC(request)));
    assert_eq!(answers(&mut sim), [(77, 20_000_000)], "the simulation waits at 20 ms");
    sim.handle_datagram(PEER, &answer(5, 20_000_000));
    sim.handle_timeout(SimTime::from_ms(1_000));
    assert!(sim.now() > SimTime::from_ms(20) && answers(&mut sim).is_empty(), "each request has one answer");
}

#[test]
fn regress_digest_does_not_depend_on_client_clocks() {
    let fly = |clock: u32, north: f32| {
        let mut station = Station::new("drill-hover", 7);
        station.sim.open_link(PEER, LinkKind::Sdk, true);
        let mut encoder = Encoder::new(7, 191);
        for k in 0..100 {
            station.sim.handle_timeout(SimTime::from_ms(10_000));
            let token = station.sim.now().ns();
            if k % (2 + i64::from(clock) % 3) == 0 {
                // Sends requests that include the client's own clock.
                let ask = TIMESYNC_DATA { tc1: 0, ts1: i64::from(clock) + k, ..Default::default() };
                station.sim.handle_datagram(PEER, &encoder.encode(&MavMessage::TIMESYNC(ask)));
            }
            let target = SET_POSITION_TARGET_LOCAL_NED_DATA {
                time_boot_ms: clock + k as u32,
                x: north,
                z: -5.0,
                coordinate_frame: MavFrame::MAV_FRAME_LOCAL_NED,
                type_mask: PositionTargetTypemask::from_bits_retain(0b1101_1111_1000),
                target_system: 1,
                target_component: 1,
                ..Default::default()
            };
            station.sim.handle_datagram(PEER, &encoder.encode(&MavMessage::SET_POSITION_TARGET_LOCAL_NED(target)));
            station.sim.handle_datagram(PEER, &answer(i64::from(clock) + k, token));
            while station.sim.poll_transmit().is_some() {}
        }
        assert!(station.sim.now() >= SimTime::from_ms(1_980));
        station.sim.digest()
    };
    assert_eq!(fly(1_000, 3.0), fly(900_001, 3.0), "the client's clock must not affect the flight");
    assert_ne!(fly(1_000, 3.0), fly(1_000, 4.0), "another setpoint must change the flight");
}

#[test]
fn exact_test_pad_matches_the_drill() {
    let job = scenario("drill-hover");
    let plane = LocalPlane::new(job.origin);
    let pad = Geo { latitude_deg: f64::from(PAD.0) * 1e-7, longitude_deg: f64::from(PAD.1) * 1e-7, ..job.origin };
    let off = plane.enu_from_geo(pad) - job.ground_team.pad_m;
    assert!(off.ned().horizontal_norm() < POSITION_TOLERANCE_M, "{off:?}");
}
