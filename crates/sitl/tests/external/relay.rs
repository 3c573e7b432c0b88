//! The MAVLink interface beside an external autopilot: one vehicle with a camera, a gimbal and a lamp.

use crate::rig::{AUTOPILOT, MONITOR, Rig, STATION};
use mavlink::MessageData;
use spandrel_mavlink::codec::Decoder;
use spandrel_mavlink::contract::named_values::NamedValue;
use spandrel_mavlink::dialect::*;
use spandrel_model::frames::Vec3;
use spandrel_model::scenario::AfterCrash;
use spandrel_model::shipped;
use spandrel_model::site::Site;
use spandrel_model::time::SimTime;
use std::collections::BTreeSet;

const CAMERA: u8 = 100;
const GIMBAL: u8 = 154;
const LAMP: u8 = 243;
const SIMULATOR: u8 = 192;
/// ZOOM_TYPE_RANGE: the zoom as a percentage of its range.
const ZOOM_BY_RANGE: f32 = 2.0;
/// Place on the bank between the first abutment and the first pier of the girder bridge, below the middle of its deck: east, north, m.
const BELOW_DECK_M: [f64; 2] = [-54.0, 0.0];

#[test]
fn wire_ground_station_sees_one_autopilot_and_its_equipment() {
    let mut rig = Rig::ready(AfterCrash::Continue);
    rig.heard.clear();
    let start = rig.sim.now();
    rig.run_s(5.0);
    let beats = rig.heard(STATION, HEARTBEAT_DATA::ID);
    let senders: BTreeSet<(u8, u8)> = beats.iter().map(|frame| (frame.system_id, frame.component_id)).collect();
    assert_eq!(senders, BTreeSet::from([(1, 1), (1, CAMERA), (1, GIMBAL), (1, LAMP)]));
    // The small autopilot sends five heartbeats a second; all of them are its own.
    let own = beats.iter().filter(|frame| frame.component_id == 1).count();
    let sent = (rig.sim.now() - start).s() * 5.0;
    assert!((own as f64 - sent).abs() <= 1.0, "{own} heartbeats, {sent} expected");
}

#[test]
fn wire_monitor_gets_scoring_data_from_the_simulator_and_reports_from_the_autopilot() {
    let mut rig = Rig::ready(AfterCrash::Continue);
    rig.throttle(500);
    rig.run_s(2.0);
    let sender = |id: u32| rig.heard(MONITOR, id).iter().map(|frame| frame.component_id).collect::<BTreeSet<_>>();
    for id in [HIL_STATE_QUATERNION_DATA::ID, NAMED_VALUE_INT_DATA::ID, BATTERY_STATUS_DATA::ID, RC_CHANNELS_DATA::ID] {
        assert_eq!(sender(id), BTreeSet::from([SIMULATOR]), "message {id}");
    }
    assert_eq!(sender(EXTENDED_SYS_STATE_DATA::ID), BTreeSet::from([1]));
    assert_eq!(sender(GIMBAL_DEVICE_ATTITUDE_STATUS_DATA::ID), BTreeSet::from([GIMBAL]));
    // The monitor counts gaps in the autopilot's sequence numbers as lost frames.
    let numbers: Vec<u8> =
        rig.heard[&MONITOR].iter().filter(|frame| frame.component_id == 1).map(|frame| frame.sequence).collect();
    assert!(numbers.windows(2).all(|pair| pair[1] == pair[0].wrapping_add(1)), "{numbers:?}");
}

#[test]
fn wire_commands_reach_the_component_that_executes_them() {
    let mut rig = Rig::ready(AfterCrash::Continue);
    rig.command(1, MavCmd::MAV_CMD_NAV_LAND, &[]);
    rig.command(CAMERA, MavCmd::MAV_CMD_IMAGE_START_CAPTURE, &[0.0, 0.0, 1.0]);
    rig.command(1, MavCmd::MAV_CMD_ILLUMINATOR_ON_OFF, &[1.0]);
    rig.command(1, MavCmd::MAV_CMD_INJECT_FAILURE, &[3.0, 1.0, 0.0]);
    rig.run_s(1.0);
    let accepted = |component| Some((component, MavResult::MAV_RESULT_ACCEPTED));
    assert_eq!(rig.last_ack(MavCmd::MAV_CMD_NAV_LAND), accepted(1));
    assert_eq!(rig.last_ack(MavCmd::MAV_CMD_IMAGE_START_CAPTURE), accepted(CAMERA));
    assert_eq!(rig.last_ack(MavCmd::MAV_CMD_ILLUMINATOR_ON_OFF), accepted(1));
    assert_eq!(rig.last_ack(MavCmd::MAV_CMD_INJECT_FAILURE), accepted(1));
    assert!(rig.sim.payload().lamp.on);
    assert_eq!(rig.heard(STATION, CAMERA_IMAGE_CAPTURED_DATA::ID).len(), 1);
    let seen = rig.px4.commands();
    assert!(seen.contains(&MavCmd::MAV_CMD_NAV_LAND), "{seen:?}");
    for own in [MavCmd::MAV_CMD_ILLUMINATOR_ON_OFF, MavCmd::MAV_CMD_INJECT_FAILURE, MavCmd::MAV_CMD_IMAGE_START_CAPTURE] {
        assert!(!seen.contains(&own), "the autopilot must not execute {own:?} as well");
    }
}

#[test]
fn wire_camera_zooms_and_describes_its_video_beside_another_autopilot() {
    let mut rig = Rig::with_aircraft(shipped::M30);
    rig.command(CAMERA, MavCmd::MAV_CMD_SET_CAMERA_ZOOM, &[ZOOM_BY_RANGE, 50.0]);
    rig.command(CAMERA, MavCmd::MAV_CMD_REQUEST_MESSAGE, &[VIDEO_STREAM_INFORMATION_DATA::ID as f32]);
    rig.run_s(3.0);
    assert_eq!(rig.last_ack(MavCmd::MAV_CMD_SET_CAMERA_ZOOM), Some((CAMERA, MavResult::MAV_RESULT_ACCEPTED)));
    let level = rig.sim.payload().camera.zoom.level();
    assert!((level - 0.5).abs() < 0.01, "{level}");
    let told = rig.heard(STATION, VIDEO_STREAM_INFORMATION_DATA::ID);
    assert!(told.iter().any(|frame| frame.component_id == CAMERA), "{told:?}");
    let seen = rig.px4.commands();
    assert!(!seen.contains(&MavCmd::MAV_CMD_SET_CAMERA_ZOOM), "the autopilot must not zoom as well: {seen:?}");
}

/// Returns the GNSS messages that the autopilot gets on a landing pad at this place of the girder bridge's site.
fn gnss_on_pad(east_m: f64, north_m: f64) -> Vec<HIL_GPS_DATA> {
    let job = spandrel_model::scenario::read("girder.toml", shipped::GIRDER, &|_| Err("none".into())).unwrap();
    let site = Site::build(&job, 1);
    let mut rig = Rig::with_job(AfterCrash::Continue, |changed| {
        *changed = job;
        changed.hazards.sky = true;
        changed.ground_team.pad_m = Vec3::new(east_m, north_m, site.ground_up_m(east_m, north_m));
    });
    let mut fixes = Vec::new();
    let end = rig.sim.now() + SimTime::from_s(10.0);
    while rig.sim.now() < end {
        rig.sim.handle_timeout(rig.sim.now() + SimTime::from_ms(4));
        while let Some(bytes) = rig.sim.poll_autopilot_transmit() {
            let frames = Decoder::new().datagram(&bytes);
            fixes.extend(frames.into_iter().filter_map(|frame| match frame.message {
                Some(MavMessage::HIL_GPS(fix)) => Some(fix),
                _ => None,
            }));
            let answer = rig.px4.simulator(&bytes);
            rig.sim.handle_autopilot_bytes(&answer);
        }
    }
    fixes
}

#[test]
fn wire_sky_below_a_deck_reaches_the_autopilot() {
    let (open, below) = (gnss_on_pad(-84.0, -46.0), gnss_on_pad(BELOW_DECK_M[0], BELOW_DECK_M[1]));
    let satellites =
        |fixes: &[HIL_GPS_DATA]| fixes.iter().map(|fix| f64::from(fix.satellites_visible)).sum::<f64>() / fixes.len() as f64;
    let accuracy_cm = |fixes: &[HIL_GPS_DATA]| fixes.iter().map(|fix| f64::from(fix.eph)).sum::<f64>() / fixes.len() as f64;
    let told = format!(
        "{:.1} and {:.1} satellites, accuracy {:.0} and {:.0} cm",
        satellites(&open),
        satellites(&below),
        accuracy_cm(&open),
        accuracy_cm(&below)
    );
    assert!(satellites(&below) < 0.7 * satellites(&open) && accuracy_cm(&below) > accuracy_cm(&open), "{told}");
}

/// The inspector belongs to the site, so the simulator answers instead of the autopilot.
#[test]
fn wire_inspector_walks_beside_another_autopilot() {
    let mut rig = Rig::with_job(AfterCrash::Continue, |job| {
        job.ground_team.places_m = vec![job.ground_team.inspector_m + Vec3::new(-14.0, 0.0, 0.0)];
    });
    for (place, result) in [(3.0, MavResult::MAV_RESULT_DENIED), (2.0, MavResult::MAV_RESULT_ACCEPTED)] {
        rig.command(1, MavCmd::MAV_CMD_USER_4, &[place]);
        rig.run_s(0.1);
        assert_eq!(rig.last_ack(MavCmd::MAV_CMD_USER_4), Some((1, result)));
    }
    assert!(!rig.px4.commands().contains(&MavCmd::MAV_CMD_USER_4), "the autopilot must not execute the request as well");
    let named =
        rig.heard(MONITOR, NAMED_VALUE_INT_DATA::ID).into_iter().filter_map(|frame| NamedValue::of(frame.message.as_ref()?));
    let walks: Vec<i32> = named.filter_map(|value| if let NamedValue::Walk(code) = value { Some(code) } else { None }).collect();
    assert_eq!(walks.first().map(|code| code % 100), Some(12), "{walks:?}");
    rig.run_s(11.0);
    assert_eq!(rig.sim.site().inspector().at(rig.sim.now()).feet_m, rig.sim.site().inspector().place_m(2).unwrap());
}

/// Simulation time can stop, because the autopilot runs in lockstep, but its estimator cannot be put back.
#[test]
fn wire_flight_freezes_but_does_not_rewind() {
    let mut rig = Rig::ready(AfterCrash::Continue);
    rig.take_off(3.0);
    rig.command(1, MavCmd::MAV_CMD_USER_2, &[5.0]);
    rig.run_s(0.1);
    assert_eq!(rig.last_ack(MavCmd::MAV_CMD_USER_2), Some((1, MavResult::MAV_RESULT_DENIED)));
    rig.command(1, MavCmd::MAV_CMD_USER_1, &[1.0]);
    rig.exchange_until(|rig| rig.sim.is_frozen());
    let (at, before) = (rig.sim.now(), rig.sim.truth().clone());
    (0..100).for_each(|_| rig.exchange());
    assert_eq!((rig.sim.now(), rig.sim.truth()), (at, &before));
    rig.command(1, MavCmd::MAV_CMD_USER_1, &[0.0]);
    rig.run_s(1.0);
    assert!(!rig.sim.is_frozen() && rig.sim.armed());
    assert!(!rig.px4.commands().contains(&MavCmd::MAV_CMD_USER_1), "the autopilot must not execute the request as well");
}

#[test]
fn wire_injected_failures_change_the_readings_of_the_autopilot() {
    let mut rig = Rig::ready(AfterCrash::Continue);
    // Barometer off.
    rig.command(1, MavCmd::MAV_CMD_INJECT_FAILURE, &[3.0, 1.0, 0.0]);
    rig.run_s(0.5);
    let mut groups = HilSensorUpdatedFlags::empty();
    for _ in 0..100 {
        rig.sim.handle_timeout(rig.sim.now() + spandrel_model::time::SimTime::from_ms(4));
        while let Some(bytes) = rig.sim.poll_autopilot_transmit() {
            for frame in spandrel_mavlink::codec::Decoder::new().datagram(&bytes) {
                if let Some(MavMessage::HIL_SENSOR(sensor)) = &frame.message {
                    groups |= sensor.fields_updated;
                }
            }
            let answer = rig.px4.simulator(&bytes);
            rig.sim.handle_autopilot_bytes(&answer);
        }
    }
    assert!(groups.contains(HilSensorUpdatedFlags::HIL_SENSOR_UPDATED_XMAG), "{groups:?}");
    assert!(!groups.contains(HilSensorUpdatedFlags::HIL_SENSOR_UPDATED_ABS_PRESSURE), "{groups:?}");
}

#[test]
fn wire_gimbal_device_obeys_the_autopilot_and_simple_clients_get_control() {
    let mut rig = Rig::ready(AfterCrash::Continue);
    let request = |command, params: &[f32]| {
        MavMessage::COMMAND_LONG(spandrel_mavlink::station::command(0, 0, command, spandrel_mavlink::station::params(params)))
    };
    rig.px4.send(&request(MavCmd::MAV_CMD_REQUEST_MESSAGE, &[GIMBAL_DEVICE_INFORMATION_DATA::ID as f32]));
    rig.run_s(0.1);
    let described = rig.heard(AUTOPILOT, GIMBAL_DEVICE_INFORMATION_DATA::ID);
    assert_eq!(described.iter().map(|frame| frame.component_id).collect::<Vec<_>>(), [GIMBAL]);
    // A pitch of -30 degrees.
    let (sine, cosine) = spandrel_model::math::sin_cos((-30.0f64).to_radians() / 2.0);
    let set = GIMBAL_DEVICE_SET_ATTITUDE_DATA {
        q: [cosine as f32, 0.0, sine as f32, 0.0],
        target_system: 1,
        target_component: GIMBAL,
        flags: GimbalDeviceFlags::empty(),
        angular_velocity_x: f32::NAN,
        angular_velocity_y: f32::NAN,
        angular_velocity_z: f32::NAN,
    };
    rig.px4.send(&MavMessage::GIMBAL_DEVICE_SET_ATTITUDE(set));
    rig.run_s(1.0);
    let pitch_deg = rig.sim.payload().gimbal.pitch_rad.to_degrees();
    assert!((pitch_deg + 30.0).abs() < 0.5, "{pitch_deg}");
    // Nobody is in control: the simulator requests control for a client that moves the gimbal.
    rig.px4
        .send(&MavMessage::GIMBAL_MANAGER_STATUS(GIMBAL_MANAGER_STATUS_DATA { gimbal_device_id: GIMBAL, ..Default::default() }));
    rig.run_s(0.1);
    rig.command(1, MavCmd::MAV_CMD_DO_GIMBAL_MANAGER_PITCHYAW, &[-20.0]);
    rig.run_s(0.1);
    let seen: Vec<MavCmd> = rig.px4.commands();
    let at = |wanted| seen.iter().position(|command| *command == wanted);
    let (configure, pitch) = (at(MavCmd::MAV_CMD_DO_GIMBAL_MANAGER_CONFIGURE), at(MavCmd::MAV_CMD_DO_GIMBAL_MANAGER_PITCHYAW));
    assert!(configure.is_some() && configure < pitch, "{seen:?}");
}

#[test]
fn wire_instructor_controls_the_wind_beside_the_autopilot() {
    let mut rig = Rig::ready(AfterCrash::Continue);
    let set = PARAM_SET_DATA {
        param_value: 7.5,
        target_system: 1,
        target_component: 1,
        param_id: "SIM_WIND_SPD".into(),
        param_type: MavParamType::MAV_PARAM_TYPE_REAL32,
    };
    rig.say(&MavMessage::PARAM_SET(set.clone()));
    rig.say(&MavMessage::PARAM_SET(PARAM_SET_DATA { param_id: "MPC_XY_CRUISE".into(), ..set }));
    rig.run_s(20.0);
    let answer = rig.heard(STATION, PARAM_VALUE_DATA::ID);
    assert!(matches!(&answer[0].message, Some(MavMessage::PARAM_VALUE(value)) if value.param_value == 7.5), "{answer:?}");
    let sets = rig.px4.received.iter().filter(|frame| frame.message_id == PARAM_SET_DATA::ID).count();
    assert_eq!(sets, 1, "only the autopilot's own parameter reaches it");
    let winds = rig.heard(MONITOR, WIND_COV_DATA::ID);
    let speed = |frame: &spandrel_mavlink::codec::ReceivedFrame| match &frame.message {
        Some(MavMessage::WIND_COV(wind)) => wind.wind_x.hypot(wind.wind_y),
        _ => 0.0,
    };
    assert!(winds.iter().map(|frame| speed(frame)).fold(0.0, f32::max) > 1.0, "the wind has increased");
}

#[test]
fn wire_failed_sticks_do_not_reach_the_autopilot() {
    let mut rig = Rig::ready(AfterCrash::Continue);
    rig.throttle(600);
    rig.run_s(0.1);
    // Manual control off.
    rig.command(1, MavCmd::MAV_CMD_INJECT_FAILURE, &[104.0, 1.0, 0.0]);
    rig.run_s(0.1);
    let count = |rig: &Rig| rig.px4.received.iter().filter(|frame| frame.message_id == MANUAL_CONTROL_DATA::ID).count();
    let before = count(&rig);
    assert!(before > 0);
    rig.throttle(700);
    rig.run_s(0.2);
    assert_eq!(count(&rig), before);
}

#[test]
fn wire_no_peer_can_impersonate_the_autopilot_or_the_equipment() {
    let mut rig = Rig::ready(AfterCrash::Continue);
    let before = rig.heard(STATION, STATUSTEXT_DATA::ID).len();
    let text = MavMessage::STATUSTEXT(STATUSTEXT_DATA { text: "forged".into(), ..Default::default() });
    for component in [1, CAMERA, GIMBAL, SIMULATOR, LAMP] {
        let bytes = spandrel_mavlink::codec::Encoder::new(1, component).encode(&text);
        rig.sim.handle_datagram(MONITOR, &bytes);
    }
    rig.run_s(0.2);
    assert_eq!(rig.heard(STATION, STATUSTEXT_DATA::ID).len(), before);
    assert_eq!(rig.px4.system_id(), 1);
}

#[test]
fn wire_sticks_of_any_station_reach_an_autopilot_that_accepts_one_sender() {
    let sender = (7, 8);
    let mut rig = Rig::with_stick_sender(AfterCrash::Continue, Some(sender));
    rig.start();
    rig.throttle(612);
    rig.run_s(0.1);
    let sticks: Vec<_> = rig.px4.received.iter().filter(|frame| frame.message_id == MANUAL_CONTROL_DATA::ID).collect();
    assert_eq!(sticks.len(), 1);
    assert_eq!((sticks[0].system_id, sticks[0].component_id), sender);
    assert!(matches!(&sticks[0].message, Some(MavMessage::MANUAL_CONTROL(sticks)) if sticks.z == 612));
}

#[test]
fn wire_unanswered_requests_to_the_autopilot_are_repeated() {
    let mut rig = Rig::ready(AfterCrash::Continue);
    let requests = |rig: &Rig| {
        let version = |frame: &&spandrel_mavlink::codec::ReceivedFrame| {
            matches!(&frame.message, Some(MavMessage::COMMAND_LONG(command))
                if command.command == MavCmd::MAV_CMD_REQUEST_MESSAGE && command.param1 == AUTOPILOT_VERSION_DATA::ID as f32)
        };
        let lists = rig.heard(AUTOPILOT, PARAM_REQUEST_LIST_DATA::ID).len();
        (lists, rig.heard(AUTOPILOT, COMMAND_LONG_DATA::ID).into_iter().filter(version).count())
    };
    // The small autopilot answers neither request.
    rig.run_s(10.0);
    let (lists, versions) = requests(&rig);
    assert!((4..=6).contains(&lists) && versions >= 4, "{lists} parameter lists and {versions} versions requested");
    rig.px4.send(&MavMessage::AUTOPILOT_VERSION(AUTOPILOT_VERSION_DATA { flight_sw_version: 1, ..Default::default() }));
    let value =
        |name: &str, param_index| PARAM_VALUE_DATA { param_id: name.into(), param_count: 2, param_index, ..Default::default() };
    rig.px4.send(&MavMessage::PARAM_VALUE(value("FIRST", 0)));
    rig.run_s(1.0);
    assert!(!rig.sim.autopilot_report().is_some_and(|report| report.has_all_parameters()));
    rig.px4.send(&MavMessage::PARAM_VALUE(value("SECOND", 1)));
    rig.run_s(1.0);
    assert!(rig.sim.autopilot_report().is_some_and(|report| report.has_all_parameters()));
    let before = requests(&rig);
    rig.run_s(10.0);
    assert_eq!(requests(&rig), before, "nothing is requested after the answers");
}
