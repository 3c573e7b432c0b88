use super::*;
use spandrel_mavlink::dialect::{
    ATTITUDE_DATA, CAMERA_IMAGE_CAPTURED_DATA, FLIGHT_INFORMATION_DATA, GLOBAL_POSITION_INT_DATA, HEARTBEAT_DATA,
    HIL_STATE_QUATERNION_DATA, ILLUMINATOR_STATUS_DATA, MavBool, MavModeFlag, NAMED_VALUE_INT_DATA, SERVO_OUTPUT_RAW_DATA,
};

const SCENARIO: &str = include_str!("../../../../scenarios/two-bridges.toml");
const VEHICLE: &str = include_str!("../../../../vehicle-params/phantom2.toml");

struct FakeVehicle {
    vehicle: Encoder,
    live: LiveFlight,
    aircraft: Vehicle,
}

impl FakeVehicle {
    fn new() -> Self {
        let scenario =
            spandrel_model::scenario::read("two-bridges.toml", SCENARIO, &|name| Err(format!("{name}: unexpected file")))
                .expect("the shipped scenario must be valid");
        let aircraft = spandrel_model::vehicle::read("phantom2.toml", VEHICLE).expect("the shipped vehicle must be valid");
        Self { vehicle: Encoder::new(1, 1), live: LiveFlight::new(&scenario), aircraft }
    }

    fn send(&mut self, message: &MavMessage, wall_ms: i64) {
        let bytes = self.vehicle.encode(message);
        self.live.handle_datagram(&bytes, SimTime::from_ms(wall_ms));
    }

    /// Sends ground truth for a simulation time, at a position `east_m` east of the origin.
    fn truth(&mut self, sim_ms: i64, wall_ms: i64, east_m: f64) {
        let geo = self.live.plane.geo_from_enu(spandrel_model::frames::Vec3::new(east_m, 0.0, self.live.pad_height_m + 20.0));
        let truth = HIL_STATE_QUATERNION_DATA {
            time_usec: (sim_ms * 1000) as u64,
            attitude_quaternion: [1.0, 0.0, 0.0, 0.0],
            lat: (geo.latitude_deg * 1e7).round() as i32,
            lon: (geo.longitude_deg * 1e7).round() as i32,
            alt: (geo.altitude_m * 1e3).round() as i32,
            vx: 0,
            vy: 100,
            ..Default::default()
        };
        self.send(&MavMessage::HIL_STATE_QUATERNION(truth), wall_ms);
    }

    fn now(&mut self, wall_ms: i64) -> Option<LiveMoment> {
        self.live.moment(SimTime::from_ms(wall_ms), &self.aircraft)
    }
}

/// Telemetry rounds positions to about a centimeter (degE7).
const POSITION_ROUNDING_M: f64 = 0.02;

#[test]
fn exact_moment_is_between_samples_with_the_received_values() {
    let mut wire = FakeVehicle::new();
    assert!(wire.now(0).is_none());
    for k in 0..100 {
        wire.truth(5_000 + 20 * k, 20 * k, 0.02 * k as f64);
        wire.now(20 * k);
    }
    wire.send(&MavMessage::ILLUMINATOR_STATUS(ILLUMINATOR_STATUS_DATA { enable: 1, ..Default::default() }), 1_980);
    let picture = CAMERA_IMAGE_CAPTURED_DATA {
        time_boot_ms: 6_900,
        image_index: 1,
        capture_result: MavBool::MAV_BOOL_TRUE,
        ..Default::default()
    };
    // A retransmission refers to the same picture.
    wire.send(&MavMessage::CAMERA_IMAGE_CAPTURED(picture.clone()), 1_980);
    wire.send(&MavMessage::CAMERA_IMAGE_CAPTURED(picture), 1_980);
    let beat = HEARTBEAT_DATA { base_mode: MavModeFlag::MAV_MODE_FLAG_SAFETY_ARMED, custom_mode: 3 << 16, ..Default::default() };
    wire.send(&MavMessage::HEARTBEAT(beat), 1_980);
    let now = wire.now(1_990).expect("a frame must be ready to draw");
    let behind_s = 6.98 + 0.01 - now.moment.at.s();
    assert!((behind_s - clock::PLAYBACK_DELAY_S).abs() < 0.005, "{behind_s} s behind");
    assert!((now.moment.drone.pose.position_m.east() - (now.moment.at.s() - 5.0)).abs() < POSITION_ROUNDING_M);
    assert!(now.moment.camera.lamp_on && now.moment.drone.spinning);
    assert_eq!((now.hud.pictures, now.hud.last_picture), (1, Some(SimTime::from_ms(6_900))));
    assert_eq!(now.hud.lift_off, Some(SimTime::from_ms(5_000)));
    assert_eq!(wire.live.feed().mode(), "Position");
    let later = wire.now(4_980).expect("a frame must be ready to draw");
    assert!((later.hud.telemetry_age_s - 3.0).abs() < 1e-9, "the telemetry age must increase");
    assert_eq!(later.moment.at, SimTime::from_ms(6_980));
    assert!(
        (later.hud.blink_time_s - now.hud.blink_time_s - 2.99).abs() < 1e-9,
        "blinking must continue while the picture is frozen"
    );
}

#[test]
fn exact_restart_resets_the_state_and_other_systems_are_ignored() {
    let mut wire = FakeVehicle::new();
    for k in 0..50 {
        wire.truth(60_000 + 20 * k, 20 * k, 5.0);
    }
    let mut stranger = Encoder::new(7, 1);
    let lamp = MavMessage::ILLUMINATOR_STATUS(ILLUMINATOR_STATUS_DATA { enable: 1, ..Default::default() });
    let bytes = stranger.encode(&lamp);
    wire.live.handle_datagram(&bytes, SimTime::from_ms(990));
    for k in 0..20 {
        wire.truth(20 * k, 1_000 + 20 * k, -5.0);
    }
    let now = wire.now(1_400).expect("a frame must be ready to draw");
    assert!(now.moment.at < SimTime::from_ms(500) && (now.moment.drone.pose.position_m.east() + 5.0).abs() < POSITION_ROUNDING_M);
    assert!(!now.moment.camera.lamp_on);
}

#[test]
fn exact_new_seed_starts_a_new_session() {
    let mut wire = FakeVehicle::new();
    let say_seed = |wire: &mut FakeVehicle, value: i32, wall_ms: i64| {
        wire.send(
            &MavMessage::NAMED_VALUE_INT(NAMED_VALUE_INT_DATA { name: "seed".into(), value, ..Default::default() }),
            wall_ms,
        );
    };
    wire.truth(60_000, 0, 5.0);
    say_seed(&mut wire, 7, 0);
    wire.truth(60_020, 20, 5.0);
    for k in 0..20 {
        wire.truth(20 * k, 1_000 + 20 * k, -5.0);
    }
    assert_eq!(wire.live.seed(), None, "a restart must discard the seed");
    say_seed(&mut wire, 8, 1_400);
    assert_eq!(wire.live.seed(), Some(8));
    assert!(wire.now(1_400).is_some(), "the new seed must not cause another restart");
    // The next session starts before the clock has gone back far enough, so only the seed identifies it.
    wire.send(&MavMessage::ILLUMINATOR_STATUS(ILLUMINATOR_STATUS_DATA { enable: 1, ..Default::default() }), 1_420);
    say_seed(&mut wire, 9, 1_440);
    assert_eq!((wire.live.seed(), wire.now(1_440)), (Some(9), None));
    wire.truth(100, 1_460, 3.0);
    let now = wire.now(1_460).expect("a frame must be ready to draw");
    assert!(!now.moment.camera.lamp_on && (now.moment.drone.pose.position_m.east() - 3.0).abs() < POSITION_ROUNDING_M);
    say_seed(&mut wire, 9, 1_480);
    assert!(wire.now(1_480).is_some(), "a repeated seed must not restart the session");
}

#[test]
fn exact_vehicle_without_truth_is_drawn_from_its_own_estimate() {
    let mut wire = FakeVehicle::new();
    wire.send(&MavMessage::HEARTBEAT(HEARTBEAT_DATA::default()), 0);
    let said = |wire: &mut FakeVehicle, ms: i64| {
        wire.live.handle_timeout(SimTime::from_ms(ms));
        let mut decoder = Decoder::new();
        let bytes: Vec<Vec<u8>> = std::iter::from_fn(|| wire.live.poll_transmit()).collect();
        let asks = |message: &MavMessage| matches!(message, MavMessage::COMMAND_LONG(c) if c.command == MavCmd::MAV_CMD_SET_MESSAGE_INTERVAL);
        bytes.iter().flat_map(|b| decoder.datagram(b)).filter(|f| f.message.as_ref().is_some_and(asks)).count()
    };
    assert_eq!((said(&mut wire, 100), said(&mut wire, 3_100)), (0, ESTIMATE_STREAMS.len()));
    wire.send(&MavMessage::ATTITUDE(ATTITUDE_DATA { yaw: 1.0, ..Default::default() }), 3_200);
    let origin = wire.live.plane.origin();
    for k in 0..20 {
        let place = GLOBAL_POSITION_INT_DATA {
            time_boot_ms: 90_000 + 20 * k,
            lat: (origin.latitude_deg * 1e7).round() as i32,
            lon: (origin.longitude_deg * 1e7).round() as i32,
            alt: ((origin.altitude_m + 30.0) * 1e3) as i32,
            ..Default::default()
        };
        wire.send(&MavMessage::GLOBAL_POSITION_INT(place), 3_200 + 20 * i64::from(k));
    }
    let now = wire.now(3_600).expect("a frame must be ready to draw");
    assert!((now.moment.drone.pose.position_m.up() - 30.0).abs() < POSITION_ROUNDING_M && wire.live.is_estimated());
    assert!((now.moment.drone.pose.ned_from_frd.yaw_rad() - 1.0).abs() < 1e-6);
    // Once ground truth arrives, it replaces the estimate, and requests stop.
    for k in 0..10 {
        wire.truth(1_000 + 20 * k, 4_000 + 20 * k, 3.0);
    }
    let now = wire.now(4_200).expect("a frame must be ready to draw");
    assert!((now.moment.drone.pose.position_m.east() - 3.0).abs() < POSITION_ROUNDING_M && !wire.live.is_estimated());
    assert_eq!(said(&mut wire, 20_000), 0);
}

#[test]
fn exact_rotor_outputs_are_requested_only_for_sound() {
    let mut wire = FakeVehicle::new();
    let armed = HEARTBEAT_DATA { base_mode: MavModeFlag::MAV_MODE_FLAG_SAFETY_ARMED, ..Default::default() };
    wire.send(&MavMessage::HEARTBEAT(armed), 0);
    let asked = |wire: &mut FakeVehicle, ms: i64| {
        wire.live.handle_timeout(SimTime::from_ms(ms));
        let bytes: Vec<u8> = std::iter::from_fn(|| wire.live.poll_transmit()).flatten().collect();
        let frames = Decoder::new().datagram(&bytes);
        frames.iter().any(|f| matches!(&f.message, Some(MavMessage::COMMAND_LONG(c)) if c.param1 == 36.0))
    };
    assert!(!asked(&mut wire, 100), "unneeded requests must not be sent");
    wire.live.request_rotor_outputs();
    assert!(
        asked(&mut wire, 200) && !asked(&mut wire, 1_000) && asked(&mut wire, 5_300),
        "requests must repeat until outputs arrive"
    );
    let mut send = |pulse: u16, wall_ms: i64| {
        let servos = SERVO_OUTPUT_RAW_DATA {
            servo1_raw: pulse,
            servo2_raw: 1_500,
            servo3_raw: 900,
            servo4_raw: 2_100,
            ..Default::default()
        };
        wire.send(&MavMessage::SERVO_OUTPUT_RAW(servos), wall_ms);
    };
    send(1_000, 6_000);
    let rotor = wire.aircraft.rotor;
    let half = 0.5 * (rotor.idle_speed_rad_s + rotor.max_speed_rad_s);
    let idle = rotor.idle_speed_rad_s;
    assert_eq!(
        wire.live.rotors_rad_s(&wire.aircraft),
        [idle, half, idle, rotor.max_speed_rad_s],
        "outputs must be clamped to their range"
    );
    wire.send(
        &MavMessage::HEARTBEAT(HEARTBEAT_DATA { base_mode: MavModeFlag::empty(), mavlink_version: 3, ..Default::default() }),
        6_100,
    );
    assert!(wire.live.rotors_rad_s(&wire.aircraft).is_empty(), "disarmed rotors must stop");
}

#[test]
fn exact_seed_and_scenario_checksum_are_received() {
    let mut wire = FakeVehicle::new();
    wire.truth(20, 0, 0.0);
    for (name, value) in [("seed", 7), ("scn_crc", -2)] {
        let named = NAMED_VALUE_INT_DATA { name: name.into(), value, ..Default::default() };
        wire.send(&MavMessage::NAMED_VALUE_INT(named), 10);
    }
    assert_eq!((wire.live.seed(), wire.live.scenario_crc()), (Some(7), Some(u32::MAX - 1)));
}

#[test]
fn exact_late_viewer_requests_the_takeoff_time() {
    let mut wire = FakeVehicle::new();
    wire.truth(300_000, 0, 0.0);
    wire.truth(300_020, 20, 0.0);
    assert_eq!(
        wire.now(20).unwrap().hud.lift_off,
        Some(SimTime::from_ms(300_000)),
        "until the actual takeoff time arrives, the first position must define it"
    );
    wire.live.handle_timeout(SimTime::from_ms(20));
    let mut decoder = Decoder::new();
    let asked = std::iter::from_fn(|| wire.live.poll_transmit()).any(|bytes| {
        decoder.datagram(&bytes).iter().any(|frame| match &frame.message {
            Some(MavMessage::COMMAND_LONG(said)) => {
                said.command == MavCmd::MAV_CMD_REQUEST_MESSAGE && said.param1 == FLIGHT_INFORMATION_ID as f32
            }
            _ => false,
        })
    });
    assert!(asked);
    let flight = FLIGHT_INFORMATION_DATA { takeoff_time_utc: 12_500_000, ..Default::default() };
    wire.send(&MavMessage::FLIGHT_INFORMATION(flight.clone()), 40);
    assert_eq!(wire.now(40).unwrap().hud.lift_off, Some(SimTime::from_ms(12_500)));
    wire.send(&MavMessage::FLIGHT_INFORMATION(FLIGHT_INFORMATION_DATA { takeoff_time_utc: 99_000_000, ..flight }), 60);
    assert_eq!(wire.now(60).unwrap().hud.lift_off, Some(SimTime::from_ms(12_500)), "the takeoff time must not change");
}

#[test]
fn exact_stream_status_is_sent_while_running_and_once_at_the_end() {
    let mut wire = FakeVehicle::new();
    let video = VideoStatus { width_px: 640, height_px: 360, rate_hz: 20.0, bits_s: 1_000_000 };
    let mut decoder = Decoder::new();
    let mut said = |live: &mut LiveFlight| -> Vec<bool> {
        let frames: Vec<_> = std::iter::from_fn(|| live.poll_transmit()).flat_map(|bytes| decoder.datagram(&bytes)).collect();
        let runs = |message: &MavMessage| match message {
            MavMessage::VIDEO_STREAM_STATUS(status) => Some(!status.flags.is_empty()),
            _ => None,
        };
        frames.iter().filter_map(|frame| frame.message.as_ref().and_then(runs)).collect()
    };
    let at = SimTime::from_ms;
    wire.live.set_video_status(None, at(0));
    wire.live.handle_timeout(at(0));
    assert!(said(&mut wire.live).is_empty(), "a stream that never started must not be reported as ended");
    wire.live.set_video_status(Some(video), at(500));
    let mut beats = |live: &mut LiveFlight, from_s: i64| -> Vec<Vec<bool>> {
        let beat = |k| {
            live.handle_timeout(at(1_000 * k));
            said(live)
        };
        (from_s..from_s + 5).map(beat).collect()
    };
    let ended: [&[bool]; 5] = [&[true], &[true], &[true], &[false], &[]];
    assert_eq!(beats(&mut wire.live, 1), ended, "the stream must end 3 s after its last picture");
    wire.live.set_video_status(Some(video), at(10_000));
    assert_eq!(beats(&mut wire.live, 10)[0], [true]);
    wire.live.set_video_status(Some(video), at(15_000));
    wire.live.set_video_status(None, at(15_000));
    assert_eq!(beats(&mut wire.live, 15)[0], [false], "the end must be reported with the next heartbeat");
}
