//! The camera component: modes, recording, zoom, memory card, and superseded commands.
#![allow(deprecated, reason = "clients still send superseded MAVLink messages")]

use spandrel_mavlink::dialect::*;
use spandrel_model::math;
use spandrel_testkit::plans::{home_north, item, upload};
use spandrel_testkit::shipped::scenario;
use spandrel_testkit::station::{Station, p};

const CAMERA: u8 = 100;
const OK: MavResult = MavResult::MAV_RESULT_ACCEPTED;
const DENIED: MavResult = MavResult::MAV_RESULT_DENIED;
const FAILED: MavResult = MavResult::MAV_RESULT_FAILED;
const UNSUPPORTED: MavResult = MavResult::MAV_RESULT_UNSUPPORTED;
const NAN: f32 = f32::NAN;
/// Size of one picture on the card and of one second of recording (60 Mbit/s), MiB.
const PICTURE_MIB: f32 = 6.0;
const VIDEO_MIB_S: f32 = 60e6 / 8.0 / 1_048_576.0;
/// Tolerance for the ticks between a command and its effect, in seconds of recording.
const TIMING_TOLERANCE_S: f32 = 0.01;

/// The only shipped aircraft that has a zoom lens.
const ZOOM_AIRCRAFT: &str = "m30";

fn on_the_pad(vehicle: &str) -> Station {
    let mut station = Station::of(scenario("drill-hover"), vehicle, 7);
    station.run_ms(100);
    station
}

fn ask(station: &mut Station, id: u32) -> MavResult {
    station.command(CAMERA, MavCmd::MAV_CMD_REQUEST_MESSAGE, p(&[id as f32]))
}

fn settings(station: &Station) -> Option<(CameraMode, f32)> {
    station.last_message(|m| if let MavMessage::CAMERA_SETTINGS(s) = m { Some((s.mode_id, s.zoomLevel)) } else { None })
}

fn status(station: &mut Station) -> CAMERA_CAPTURE_STATUS_DATA {
    assert_eq!(ask(station, 262), OK);
    station.last_message(|m| if let MavMessage::CAMERA_CAPTURE_STATUS(s) = m { Some(s.clone()) } else { None }).unwrap()
}

fn used_mib(station: &mut Station) -> f32 {
    assert_eq!(ask(station, 261), OK);
    let told = station.last_message(|m| if let MavMessage::STORAGE_INFORMATION(s) = m { Some(s.clone()) } else { None }).unwrap();
    assert_eq!((told.status, told.storage_id, told.storage_count), (StorageStatus::STORAGE_STATUS_READY, 1, 1));
    assert!((told.used_capacity + told.available_capacity - told.total_capacity).abs() < 0.01, "{told:?}");
    told.used_capacity
}

fn pictures(station: &Station) -> Vec<i32> {
    station.all(|m| if let MavMessage::CAMERA_IMAGE_CAPTURED(c) = m { Some(c.image_index) } else { None })
}

fn take(station: &mut Station) -> MavResult {
    station.command(CAMERA, MavCmd::MAV_CMD_IMAGE_START_CAPTURE, p(&[0.0, 0.0, 1.0]))
}

#[test]
fn wire_camera_records_only_in_video_mode_and_reports_the_duration() {
    let mut station = on_the_pad("phantom2");
    let record = p(&[0.0, 2.0, 0.0]);
    assert_eq!(station.command(CAMERA, MavCmd::MAV_CMD_VIDEO_START_CAPTURE, record), FAILED);
    assert!(station.texts().iter().any(|text| text.contains("video mode")), "{:?}", station.texts());
    assert_eq!(station.command(CAMERA, MavCmd::MAV_CMD_SET_CAMERA_MODE, p(&[0.0, 1.0])), OK);
    assert_eq!(settings(&station).unwrap().0, CameraMode::CAMERA_MODE_VIDEO, "the change must be broadcast immediately");
    assert_eq!(station.command(CAMERA, MavCmd::MAV_CMD_VIDEO_START_CAPTURE, record), OK);
    station.received.clear();
    station.run_ms(3_000);
    let told = station.all(|m| if let MavMessage::CAMERA_CAPTURE_STATUS(s) = m { Some(s.video_status) } else { None });
    assert!((6..=7).contains(&told.len()) && told.iter().all(|on| *on == 1), "the status must arrive twice per second: {told:?}");
    assert_eq!(station.command(CAMERA, MavCmd::MAV_CMD_SET_CAMERA_MODE, p(&[0.0, 0.0])), FAILED);
    assert_eq!(take(&mut station), OK);
    let running = status(&mut station);
    assert_eq!((running.video_status, running.image_count), (1, 1));
    let recorded_s = running.recording_time_ms as f32 / 1000.0;
    assert!((recorded_s - 3.0).abs() < TIMING_TOLERANCE_S, "{recorded_s}");
    assert_eq!(station.command(CAMERA, MavCmd::MAV_CMD_VIDEO_STOP_CAPTURE, p(&[])), OK);
    let card = used_mib(&mut station);
    assert!((card - PICTURE_MIB - 3.0 * VIDEO_MIB_S).abs() < 2.0 * TIMING_TOLERANCE_S * VIDEO_MIB_S, "{card}");
    station.run_ms(5_000);
    assert_eq!(used_mib(&mut station), card, "recording must have stopped");
    assert_eq!(status(&mut station).video_status, 0);
    for mode in [2.0, 3.0, -1.0, NAN] {
        assert_eq!(station.command(CAMERA, MavCmd::MAV_CMD_SET_CAMERA_MODE, p(&[0.0, mode])), DENIED, "{mode}");
    }
}

#[test]
fn wire_formatting_empties_the_card_and_is_rejected_while_recording() {
    let mut station = on_the_pad("phantom2");
    assert_eq!([take(&mut station), take(&mut station)], [OK, OK]);
    assert_eq!(used_mib(&mut station), 2.0 * PICTURE_MIB);
    let format = MavCmd::MAV_CMD_STORAGE_FORMAT;
    assert_eq!(station.command(CAMERA, format, p(&[2.0, 1.0, 1.0])), DENIED, "the camera must not have a second card");
    assert_eq!(station.command(CAMERA, format, p(&[1.0, 0.0, 1.0])), OK);
    assert_eq!((used_mib(&mut station), status(&mut station).image_count), (2.0 * PICTURE_MIB, 0), "only the log must remain");
    assert_eq!(station.command(CAMERA, format, p(&[1.0, 1.0, 1.0])), OK);
    assert_eq!(used_mib(&mut station), 0.0);
    station.received.clear();
    assert_eq!(take(&mut station), OK);
    assert_eq!(pictures(&station), [0]);
    station.command(CAMERA, MavCmd::MAV_CMD_SET_CAMERA_MODE, p(&[0.0, 1.0]));
    station.command(CAMERA, MavCmd::MAV_CMD_VIDEO_START_CAPTURE, p(&[]));
    assert_eq!(station.command(CAMERA, format, p(&[1.0, 1.0, 1.0])), FAILED);
    assert_eq!(status(&mut station).image_count, 1);
}

/// Returns the field of view at a zoom level in degrees.
fn field_of_view_deg(level: f64) -> f64 {
    let (wide_deg, most) = (84.0_f64, 3.1);
    (2.0 * math::atan2(math::tan(0.5 * wide_deg.to_radians()), 1.0 + level * (most - 1.0))).to_degrees()
}

#[test]
fn wire_every_zoom_type_works_within_the_zoom_range() {
    let mut station = on_the_pad(ZOOM_AIRCRAFT);
    let zoom = MavCmd::MAV_CMD_SET_CAMERA_ZOOM;
    let wide_mm = 0.5 * 6.17 / (0.5 * 84.0_f32.to_radians()).tan();
    let half_mm = wide_mm * (1.0 + 0.5 * 2.1);
    for (kind, value, level) in [
        (2.0, 50.0, 50.0),
        (0.0, 1.0, 60.0),
        (0.0, -1.0, 50.0),
        (1.0, 1.0, 100.0),
        (3.0, half_mm, 50.0),
        (4.0, field_of_view_deg(0.25) as f32, 25.0),
        (1.0, -1.0, 0.0),
    ] {
        assert_eq!(station.command(CAMERA, zoom, p(&[kind, value])), OK, "{kind} {value}");
        assert!(settings(&station).is_some(), "the camera must answer with its settings");
        station.run_ms(4_000);
        let told = settings(&station).unwrap().1;
        assert!((told - level).abs() < 0.01, "{kind} {value}: {told} instead of {level}");
        assert_eq!(ask(&mut station, 271), OK);
        let field =
            station.last_message(|m| if let MavMessage::CAMERA_FOV_STATUS(f) = m { Some((f.hfov, f.vfov)) } else { None });
        let (hfov, vfov) = field.unwrap();
        assert!((f64::from(hfov) - field_of_view_deg(f64::from(level) / 100.0)).abs() < 0.01, "{level}: {hfov}");
        let tall = (0.5 * vfov.to_radians()).tan() / (0.5 * hfov.to_radians()).tan();
        assert!((tall - 0.75).abs() < 1e-4, "a sensor of 4000 by 3000 pixels: ratio {tall}");
        assert_eq!(ask(&mut station, 269), OK);
        let stream = station.last_message(|m| if let MavMessage::VIDEO_STREAM_INFORMATION(s) = m { Some(s.hfov) } else { None });
        assert!((f32::from(stream.unwrap()) - hfov).abs() <= 0.5);
    }
    for (kind, value) in [(2.0, 101.0), (3.0, 100.0), (4.0, 170.0), (5.0, 1.0), (0.0, NAN), (NAN, 1.0)] {
        assert_eq!(station.command(CAMERA, zoom, p(&[kind, value])), DENIED, "{kind} {value}");
    }
    let mut fixed = on_the_pad("phantom2");
    assert_eq!(fixed.command(CAMERA, zoom, p(&[2.0, 50.0])), UNSUPPORTED);
    for (station, zooms) in [(&mut station, true), (&mut fixed, false)] {
        assert_eq!(ask(station, 259), OK);
        let flags = station.last_message(|m| if let MavMessage::CAMERA_INFORMATION(i) = m { Some(i.flags) } else { None });
        assert_eq!(flags.unwrap().contains(CameraCapFlags::CAMERA_CAP_FLAGS_HAS_BASIC_ZOOM), zooms);
        assert_eq!(ask(station, 260), OK);
        assert_eq!(settings(station).unwrap().1.is_nan(), !zooms);
    }
}

#[test]
fn wire_continuous_zoom_stops_on_command_and_reset_zooms_out() {
    let mut station = on_the_pad(ZOOM_AIRCRAFT);
    let zoom = MavCmd::MAV_CMD_SET_CAMERA_ZOOM;
    assert_eq!(station.command(CAMERA, zoom, p(&[1.0, 0.5])), OK);
    station.run_ms(1_200);
    assert_eq!(station.command(CAMERA, zoom, p(&[1.0, 0.0])), OK);
    let stopped = settings(&station).unwrap().1;
    // The lens moves at half speed for 1.2 s; the full range takes 3 s at full speed.
    assert!((stopped - 20.0).abs() < 0.2, "{stopped}");
    station.run_ms(1_000);
    ask(&mut station, 260);
    assert_eq!(settings(&station).unwrap().1, stopped);
    station.command(CAMERA, MavCmd::MAV_CMD_SET_CAMERA_MODE, p(&[0.0, 1.0]));
    assert_eq!(station.command(CAMERA, MavCmd::MAV_CMD_RESET_CAMERA_SETTINGS, p(&[0.0])), DENIED);
    assert_eq!(station.command(CAMERA, MavCmd::MAV_CMD_RESET_CAMERA_SETTINGS, p(&[1.0])), OK);
    station.run_ms(4_000);
    assert_eq!(settings(&station), Some((CameraMode::CAMERA_MODE_IMAGE, 0.0)));
}

#[test]
fn wire_field_of_view_precedes_every_picture() {
    let mut station = on_the_pad(ZOOM_AIRCRAFT);
    station.command(CAMERA, MavCmd::MAV_CMD_SET_CAMERA_ZOOM, p(&[1.0, 1.0]));
    for _ in 0..5 {
        station.run_ms(430);
        station.received.clear();
        assert_eq!(take(&mut station), OK);
        station.run_ms(20);
        let spoken: Vec<&MavMessage> = station
            .received
            .iter()
            .filter(|frame| frame.component_id == CAMERA)
            .filter_map(|frame| frame.message.as_ref())
            .collect();
        let at = spoken.iter().position(|m| matches!(m, MavMessage::CAMERA_IMAGE_CAPTURED(_))).unwrap();
        let [MavMessage::CAMERA_FOV_STATUS(field), MavMessage::CAMERA_IMAGE_CAPTURED(image)] = spoken[at - 1..=at] else {
            panic!("{:?}", spoken[at - 1])
        };
        assert_eq!((field.time_boot_ms, field.q), (image.time_boot_ms, image.q));
        let level = f64::from(image.time_boot_ms - 100) / 3_000.0;
        // The lens moves in control ticks, which are 2.5 ms apart.
        assert!((f64::from(field.hfov) - field_of_view_deg(level)).abs() < 0.2, "{} at {level}", field.hfov);
    }
}

#[test]
fn wire_focus_is_unsupported_and_the_stream_status_follows_its_sender() {
    let mut station = on_the_pad("phantom2");
    for (kind, result) in [(0.0, UNSUPPORTED), (1.0, UNSUPPORTED), (2.0, UNSUPPORTED), (3.0, UNSUPPORTED), (4.0, OK), (6.0, OK)] {
        assert_eq!(station.command(CAMERA, MavCmd::MAV_CMD_SET_CAMERA_FOCUS, p(&[kind, 1.0])), result, "{kind}");
    }
    assert_eq!(station.command(CAMERA, MavCmd::MAV_CMD_VIDEO_START_STREAMING, p(&[1.0])), FAILED);
    assert!(station.texts().iter().any(|text| text.contains("stream")));
    assert_eq!(station.command(CAMERA, MavCmd::MAV_CMD_VIDEO_START_STREAMING, p(&[2.0])), DENIED);
    assert_eq!(station.command(CAMERA, MavCmd::MAV_CMD_VIDEO_STOP_STREAMING, p(&[1.0])), OK);
    let told = station.last_message(|m| if let MavMessage::VIDEO_STREAM_STATUS(s) = m { Some(s.flags) } else { None });
    assert_eq!(told, Some(VideoStreamStatusFlags::empty()));
    assert_eq!(ask(&mut station, 269), OK);
    let stream =
        station.last_message(|m| if let MavMessage::VIDEO_STREAM_INFORMATION(s) = m { Some(s.clone()) } else { None }).unwrap();
    assert_eq!((stream.stream_id, stream.count, stream.mavtype), (1, 1, VideoStreamType::VIDEO_STREAM_TYPE_RTPUDP));
    assert_eq!((stream.flags, stream.uri.to_str()), (VideoStreamStatusFlags::empty(), Ok("5600")));
    let running = VideoStreamStatusFlags::VIDEO_STREAM_STATUS_FLAGS_RUNNING;
    let sent = VIDEO_STREAM_STATUS_DATA {
        framerate: 20.0,
        bitrate: 1_000_000,
        flags: running,
        resolution_h: 640,
        resolution_v: 360,
        stream_id: 1,
        ..Default::default()
    };
    station.received.clear();
    station.send(&MavMessage::VIDEO_STREAM_STATUS(sent.clone()));
    station.run_ms(100);
    let told = |station: &Station| {
        station.last_message(|m| if let MavMessage::VIDEO_STREAM_INFORMATION(s) = m { Some(s.clone()) } else { None })
    };
    let stream = told(&station).expect("the status must be broadcast immediately");
    assert_eq!((stream.flags, stream.resolution_h, stream.resolution_v, stream.framerate), (running, 640, 360, 20.0));
    for (width, announced) in [(640, false), (960, true), (640, true)] {
        station.received.clear();
        station.send(&MavMessage::VIDEO_STREAM_STATUS(VIDEO_STREAM_STATUS_DATA { resolution_h: width, ..sent.clone() }));
        station.run_ms(100);
        assert_eq!(told(&station).map(|s| s.resolution_h), announced.then_some(width), "a new size must be broadcast");
    }
    assert_eq!(station.command(CAMERA, MavCmd::MAV_CMD_VIDEO_START_STREAMING, p(&[1.0])), OK);
    station.send(&MavMessage::VIDEO_STREAM_STATUS(VIDEO_STREAM_STATUS_DATA {
        framerate: f32::NAN,
        resolution_h: 9,
        ..sent.clone()
    }));
    station.run_ms(3_000);
    assert_eq!(ask(&mut station, 269), OK);
    assert_eq!(told(&station).map(|s| (s.flags, s.resolution_h)), Some((running, 640)), "invalid values must have no effect");
    station.run_ms(1_000);
    assert_eq!(ask(&mut station, 269), OK);
    assert_eq!(told(&station).map(|s| s.flags), Some(VideoStreamStatusFlags::empty()), "the stream must be reported as stopped");
    station.sim.set_speed_factor(10.0);
    station.send(&MavMessage::VIDEO_STREAM_STATUS(sent));
    station.run_ms(30_000);
    assert_eq!(ask(&mut station, 269), OK);
    assert_eq!(told(&station).map(|s| s.flags), Some(running), "the timeout is three seconds");
    for track in [MavCmd::MAV_CMD_CAMERA_TRACK_POINT, MavCmd::MAV_CMD_CAMERA_STOP_TRACKING] {
        assert_eq!(station.command(CAMERA, track, p(&[0.5, 0.5])), UNSUPPORTED);
    }
}

#[test]
fn wire_superseded_and_current_requests_return_the_same_messages() {
    use MavCmd as M;
    let mut station = on_the_pad("phantom2");
    take(&mut station);
    for (id, older) in [
        (259, M::MAV_CMD_REQUEST_CAMERA_INFORMATION),
        (260, M::MAV_CMD_REQUEST_CAMERA_SETTINGS),
        (261, M::MAV_CMD_REQUEST_STORAGE_INFORMATION),
        (262, M::MAV_CMD_REQUEST_CAMERA_CAPTURE_STATUS),
        (263, M::MAV_CMD_REQUEST_CAMERA_IMAGE_CAPTURE),
        (269, M::MAV_CMD_REQUEST_VIDEO_STREAM_INFORMATION),
        (270, M::MAV_CMD_REQUEST_VIDEO_STREAM_STATUS),
    ] {
        let first = if id == 263 { 0.0 } else { 1.0 };
        for (command, values) in [(older, p(&[first, 1.0])), (M::MAV_CMD_REQUEST_MESSAGE, p(&[id as f32, 0.0]))] {
            assert_eq!(station.command(CAMERA, command, values), OK, "{command:?}");
            let told = station.received.iter().filter(|frame| (frame.message_id, frame.component_id) == (id, CAMERA)).count();
            assert_eq!(told, 1, "{command:?}");
        }
    }
    for (id, number) in [(261.0, 2.0), (269.0, 2.0), (270.0, -1.0), (263.0, 1.0)] {
        assert_eq!(station.command(CAMERA, M::MAV_CMD_REQUEST_MESSAGE, p(&[id, number])), DENIED, "{id} {number}");
    }
    assert_eq!(station.command(CAMERA, M::MAV_CMD_REQUEST_VIDEO_STREAM_STATUS, p(&[7.0])), DENIED);
}

#[test]
fn wire_repeated_picture_command_takes_one_picture_and_other_cameras_are_ignored() {
    let mut station = on_the_pad("phantom2");
    let numbered = |number: f32| p(&[0.0, 0.0, 1.0, number]);
    let shoot = MavCmd::MAV_CMD_IMAGE_START_CAPTURE;
    let mut all = Vec::new();
    for number in [1.0, 1.0, 2.0, 2.0, 2.0, 3.0] {
        assert_eq!(station.command(CAMERA, shoot, numbered(number)), OK);
        station.run_ms(50);
        all.extend(pictures(&station));
    }
    assert_eq!(all, [0, 1, 2]);
    for (camera, result) in [(0.0, OK), (100.0, OK), (2.0, DENIED), (101.0, DENIED)] {
        assert_eq!(station.command(1, shoot, p(&[camera, 0.0, 1.0])), result, "{camera}");
    }
    assert_eq!(station.command(1, shoot, p(&[1.0, 0.0, 1.0])), DENIED, "the autopilot must not have an image sensor");
    assert_eq!(station.command(CAMERA, shoot, p(&[1.0, 0.0, 1.0])), OK, "the camera must have an image sensor");
}

#[test]
fn wire_missed_pictures_can_be_requested_again() {
    let mut station = on_the_pad("phantom2");
    for _ in 0..8 {
        take(&mut station);
    }
    for (first, last, wanted) in [
        (3.0, 0.0, vec![3]),
        (3.0, 5.0, vec![3, 4, 5]),
        (6.0, -1.0, vec![6, 7]),
        (-1.0, 0.0, (0..8).collect()),
        (5.0, 99.0, vec![5, 6, 7]),
    ] {
        let ask = p(&[263.0, first, last]);
        assert_eq!(station.command(CAMERA, MavCmd::MAV_CMD_REQUEST_MESSAGE, ask), OK);
        station.run_ms(50);
        assert_eq!(pictures(&station), wanted, "{first} {last}");
    }
    for (first, last) in [(8.0, 0.0), (-2.0, 0.0), (NAN, 0.0), (0.0, -2.0)] {
        let ask = p(&[263.0, first, last]);
        assert_eq!(station.command(CAMERA, MavCmd::MAV_CMD_REQUEST_MESSAGE, ask), DENIED, "{first} {last}");
    }
}

/// Returns a mission item with a payload command. It has seven parameters, with 5 and 6 as transmitted.
fn payload_item(seq: u16, command: MavCmd, p: [f32; 4], x: i32, z: f32) -> MISSION_ITEM_INT_DATA {
    let [param1, param2, param3, param4] = p;
    let frame = MavFrame::MAV_FRAME_MISSION;
    MISSION_ITEM_INT_DATA { param1, param2, param3, param4, x, y: 0, frame, ..item(seq, command, 0.0, z) }
}

#[test]
fn wire_mission_items_have_the_same_effect_as_commands() {
    use MavCmd as M;
    let mut station = on_the_pad(ZOOM_AIRCRAFT);
    station.run_ms(2_500);
    let north = home_north(&station);
    let items = [
        item(0, M::MAV_CMD_NAV_TAKEOFF, north, 6.0),
        payload_item(1, M::MAV_CMD_SET_CAMERA_MODE, [0.0, 1.0, NAN, NAN], 0, NAN),
        payload_item(2, M::MAV_CMD_VIDEO_START_CAPTURE, [0.0, 0.0, 0.0, NAN], 0, NAN),
        payload_item(3, M::MAV_CMD_SET_CAMERA_ZOOM, [2.0, 50.0, 0.0, NAN], 0, NAN),
        payload_item(4, M::MAV_CMD_SET_CAMERA_FOCUS, [4.0, NAN, 0.0, NAN], 0, NAN),
        payload_item(5, M::MAV_CMD_DO_SET_SERVO, [9.0, 1_900.0, 0.0, 0.0], 0, 0.0),
        payload_item(6, M::MAV_CMD_DO_MOUNT_CONFIGURE, [2.0, 1.0, 1.0, 0.0], 0, 0.0),
        payload_item(7, M::MAV_CMD_DO_MOUNT_CONTROL, [-50.0, 0.0, 0.0, 0.0], 0, 2.0),
        item(8, M::MAV_CMD_NAV_WAYPOINT, north + 8.0, 6.0),
        // One command as MAVLink defines it, and one as sent by stations that always scale parameter 5.
        payload_item(9, M::MAV_CMD_DO_DIGICAM_CONTROL, [0.0; 4], 1, 0.0),
        item(10, M::MAV_CMD_NAV_WAYPOINT, north, 6.0),
        payload_item(11, M::MAV_CMD_DO_DIGICAM_CONTROL, [0.0; 4], 10_000_000, 0.0),
        payload_item(12, M::MAV_CMD_VIDEO_STOP_CAPTURE, [0.0, 0.0, NAN, NAN], 0, NAN),
        payload_item(13, M::MAV_CMD_DO_REPEAT_RELAY, [0.0, 2.0, 0.2, 0.0], 0, 0.0),
        payload_item(14, M::MAV_CMD_DO_GIMBAL_MANAGER_PITCHYAW, [NAN, NAN, NAN, NAN], 2, 1.0),
        item(15, M::MAV_CMD_NAV_LAND, north, 0.0),
    ];
    assert_eq!(upload(&mut station, &items), MavMissionResult::MAV_MISSION_ACCEPTED);
    assert_eq!(station.command(1, M::MAV_CMD_MISSION_START, p(&[])), OK);
    assert_eq!(station.command(1, M::MAV_CMD_COMPONENT_ARM_DISARM, p(&[1.0])), OK);
    let (mut lowest, mut changes, mut lamp) = (0.0_f32, 0, false);
    let ended = station.run_until(90.0, |s| {
        for frame in s.received.drain(..).collect::<Vec<_>>() {
            match frame.message {
                Some(MavMessage::GIMBAL_DEVICE_ATTITUDE_STATUS(g)) => lowest = lowest.min(2.0 * g.q[2].atan2(g.q[0])),
                Some(MavMessage::ILLUMINATOR_STATUS(i)) => {
                    changes += u32::from(lamp != (i.enable == 1));
                    lamp = i.enable == 1;
                }
                Some(MavMessage::STATUSTEXT(t)) => {
                    let text = t.text.to_str().unwrap_or_default().to_owned();
                    assert!(!text.contains("refused"), "{text}");
                    if text == "Disarmed by landing" {
                        return true;
                    }
                }
                _ => {}
            }
        }
        false
    });
    assert!(ended, "the mission must end with a landing");
    assert!((lowest.to_degrees() + 50.0).abs() < 1.0, "lowest pitch after mount control: {}", lowest.to_degrees());
    assert_eq!((changes, lamp), (5, true), "the servo must switch the lamp on, and the relay off and on twice");
    let done = status(&mut station);
    assert_eq!((done.image_count, done.video_status), (2, 0));
    let video_mib = used_mib(&mut station) - 2.0 * PICTURE_MIB;
    assert!(video_mib > 5.0 * VIDEO_MIB_S, "recording must run during the whole mission: {video_mib}");
    ask(&mut station, 260);
    assert!((settings(&station).unwrap().1 - 50.0).abs() < 0.01);
    station.run_ms(200);
    let flags = station.last_message(|m| if let MavMessage::GIMBAL_DEVICE_ATTITUDE_STATUS(g) = m { Some(g.flags) } else { None });
    assert!(flags.unwrap().contains(GimbalDeviceFlags::GIMBAL_DEVICE_FLAGS_NEUTRAL));
}
