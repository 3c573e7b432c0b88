//! Manual control through MANUAL_CONTROL and RC overrides: stick ownership and timeouts.

use spandrel_mavlink::codec::Decoder;
use spandrel_mavlink::dialect::*;
use spandrel_model::time::SimTime;
use spandrel_sitl::endpoint::flavor::{ardupilot, generic, px4};
use spandrel_sitl::endpoint::{LinkId, LinkKind};
use spandrel_testkit::station::{GCS, Station};

const HOLD: u32 = 4 << 16 | 3 << 24;
const POSITION: u32 = 3 << 16;
/// Maximum drift while holding a position, m (gusts plus drift of the estimate).
const MAX_DRIFT_M: f32 = 0.7;

fn channels(station: &mut Station, pitch: u16, throttle: u16) {
    station.send(&MavMessage::RC_CHANNELS_OVERRIDE(RC_CHANNELS_OVERRIDE_DATA {
        chan1_raw: 1500,
        chan2_raw: pitch,
        chan3_raw: throttle,
        chan4_raw: 1500,
        target_system: 1,
        target_component: 1,
        ..Default::default()
    }));
}

#[test]
fn wire_rc_override_acts_like_sticks_with_reversed_pitch() {
    let mut station = Station::airborne("drill-hover", 7);
    // The first sender keeps stick control until it releases the sticks.
    station.run_ms(600);
    for _ in 0..150 {
        channels(&mut station, 1200, 1500);
        station.run_ms(20);
    }
    let (v, yaw) = (
        station.last_message(|m| if let MavMessage::LOCAL_POSITION_NED(p) = m { Some([p.vx, p.vy]) } else { None }).unwrap(),
        station.last_message(|m| if let MavMessage::ATTITUDE(a) = m { Some(a.yaw) } else { None }).unwrap(),
    );
    let forward = v[0] * yaw.cos() + v[1] * yaw.sin();
    assert!(forward > 2.0, "a pitch pulse below center must fly forward: {forward}");
}

/// Returns the echoed channels 1 to 4 on each link after `send`.
fn echoed_channels(station: &mut Station, send: impl Fn(&mut Station)) -> Vec<(LinkId, [u16; 4])> {
    let mut out = Vec::new();
    for _ in 0..4 {
        send(station);
        station.vehicle.sim.handle_timeout(station.vehicle.sim.now() + SimTime::from_ms(20));
        while let Some(transmit) = station.sim.poll_transmit() {
            for frame in Decoder::new().datagram(&transmit.bytes) {
                if let Some(MavMessage::RC_CHANNELS(c)) = frame.message {
                    out.push((transmit.link, [c.chan1_raw, c.chan2_raw, c.chan3_raw, c.chan4_raw]));
                }
            }
        }
    }
    // Keeps each link's last echo.
    out.into_iter().rev().take(3).collect()
}

/// At 400 Hz, a client waits at most one control tick of 2.5 ms for the sticks that it has sent. The ticks are 1 ms long, and so the
/// stream alone would leave 3 ms between every second pair of messages.
#[test]
fn exact_echo_of_changed_sticks_at_the_highest_rate_comes_with_the_next_tick() {
    const TICK: SimTime = SimTime::from_ms(1);
    let mut station = Station::new("drill-hover", 7);
    station.run_ms(1_000);
    let rate = [65.0, 2_500.0, 0.0, 0.0, 0.0, 0.0, 0.0];
    assert_eq!(station.command(1, MavCmd::MAV_CMD_SET_MESSAGE_INTERVAL, rate), MavResult::MAV_RESULT_ACCEPTED);
    for round in 0..20_u16 {
        // Different phases of the stream.
        station.run_ms(7 + i64::from(round));
        let pitch = 1_200 + 10 * round;
        channels(&mut station, pitch, 1500);
        let until = station.vehicle.sim.now() + TICK;
        station.vehicle.sim.handle_timeout(until);
        let mut echoed = Vec::new();
        while let Some(transmit) = station.sim.poll_transmit() {
            let frames = Decoder::new().datagram(&transmit.bytes);
            echoed.extend(frames.into_iter().filter_map(|frame| match frame.message {
                Some(MavMessage::RC_CHANNELS(c)) => Some(c.chan2_raw),
                _ => None,
            }));
        }
        assert_eq!(echoed, [pitch], "round {round}");
    }
}

#[test]
fn wire_stick_echo_matches_the_input_on_each_link() {
    const SDK: LinkId = LinkId(5);
    const SIDECAR: LinkId = LinkId(6);
    for flavor in [&px4::FLAVOR, &ardupilot::FLAVOR, &generic::FLAVOR] {
        let mut station = Station::with_flavor(flavor, "drill-hover", 7);
        station.sim.open_link(SDK, LinkKind::Sdk, false);
        station.sim.open_link(SIDECAR, LinkKind::Payload, false);
        station.run_ms(1_000);
        if flavor.streams_on_request_only {
            let rate = [65.0, 20_000.0, 0.0, 0.0, 0.0, 0.0, 0.0];
            assert_eq!(station.command(1, MavCmd::MAV_CMD_SET_MESSAGE_INTERVAL, rate), MavResult::MAV_RESULT_ACCEPTED);
        }
        let wait = |station: &mut Station, sent: fn(&mut Station), [others, sidecar]: [[u16; 4]; 2]| {
            let heard = echoed_channels(station, sent);
            assert!(heard.contains(&(GCS, others)) && heard.contains(&(SIDECAR, sidecar)), "{}: {heard:?}", flavor.name);
            assert!(flavor.streams_on_request_only || heard.contains(&(SDK, others)), "{}: {heard:?}", flavor.name);
        };
        wait(&mut station, |s| channels(s, 1300, 1600), [[1500, 1300, 1600, 1500], [1500, 1700, 1600, 1500]]);
        // Values beyond full deflection must be clamped.
        wait(&mut station, |s| channels(s, 900, 2100), [[1500, 900, 2100, 1500], [1500, 2000, 2000, 1500]]);
        let sticks = |s: &mut Station| s.sticks(400, 200, 750, -1000);
        wait(&mut station, sticks, [[1600, 1300, 1750, 1000], [1600, 1700, 1750, 1000]]);
        let again = [65.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0];
        assert_eq!(station.command(1, MavCmd::MAV_CMD_REQUEST_MESSAGE, again), MavResult::MAV_RESULT_ACCEPTED);
        let asked = station.last_message(|m| if let MavMessage::RC_CHANNELS(c) = m { Some(c.chan2_raw) } else { None });
        assert_eq!(asked, Some(1300), "{}: response to the ground station's request", flavor.name);
    }
}

/// Session records depend on this: the monitor's link receives every stick sample, even several within one control
/// tick, including samples from senders that do not have control.
#[test]
fn wire_sidecar_receives_every_stick_sample() {
    let sidecar = LinkId(6);
    let mut station = Station::new("drill-hover", 7);
    station.sim.open_link(sidecar, LinkKind::Payload, false);
    let beat = MavMessage::HEARTBEAT(HEARTBEAT_DATA::default());
    station.sim.handle_datagram(sidecar, &spandrel_mavlink::codec::Encoder::new(1, 191).encode(&beat));
    station.run_ms(10);
    let (mut sent, mut heard) = (Vec::new(), Vec::new());
    for at in 0..60 {
        for k in 0..at % 4 {
            let sample = (255 - u8::from(k == 2), 10 * at + k);
            station.send_as(sample.0, 190);
            station.sticks(sample.1, 0, 500, 0);
            sent.push(sample);
        }
        station.vehicle.sim.handle_timeout(station.vehicle.sim.now() + SimTime::from_ms(i64::from(1 + 7 * (at % 3))));
        while let Some(transmit) = station.sim.poll_transmit() {
            let frames = Decoder::new().datagram(&transmit.bytes).into_iter().filter(|_| transmit.link == sidecar);
            heard.extend(frames.filter_map(|frame| match frame.message {
                Some(MavMessage::MANUAL_CONTROL(sticks)) => Some((frame.system_id, sticks.x)),
                _ => None,
            }));
        }
    }
    assert!(sent.len() > 80);
    assert_eq!(heard, sent);
}

/// The first negative value shows that a sender's throttle ranges from -1000 to 1000; this is remembered per sender.
#[test]
fn wire_negative_throttle_selects_the_signed_range() {
    let mut station = Station::new("drill-hover", 7);
    let up = |station: &mut Station, z: i16| {
        station.sticks(0, 0, z, 0);
        station.run_ms(40);
        station.last_message(|m| if let MavMessage::RC_CHANNELS(c) = m { Some(c.chan3_raw) } else { None }).unwrap()
    };
    for (z, us) in [(500, 1500), (0, 1000), (1000, 2000), (-2000, 1500), (500, 1500)] {
        assert_eq!(up(&mut station, z), us, "{z}");
    }
    let told = |s: &Station| texts(s).iter().filter(|text| text.ends_with("throttle range -1000 to 1000")).count();
    assert_eq!(told(&station), 0);
    for (z, us) in [(-1, 1500), (-1000, 1000), (0, 1500), (500, 1750), (1000, 2000), (i16::MAX, 1500), (-500, 1250)] {
        assert_eq!(up(&mut station, z), us, "{z}");
    }
    assert_eq!(told(&station), 1, "once: {:?}", texts(&station));
    station.run_ms(600);
    station.send_as(254, 190);
    assert_eq!(up(&mut station, 0), 1000, "another sender's center must be 500");
}

#[test]
fn wire_released_channels_are_not_stick_input() {
    let mut station = Station::new("drill-hover", 7);
    station.run_ms(1_000);
    station.received.clear();
    for value in [0, u16::MAX] {
        station.send(&MavMessage::RC_CHANNELS_OVERRIDE(RC_CHANNELS_OVERRIDE_DATA {
            chan1_raw: value,
            chan2_raw: value,
            chan3_raw: value,
            chan4_raw: value,
            target_system: 1,
            target_component: 1,
            ..Default::default()
        }));
        station.run_ms(100);
    }
    assert!(station.all(|m| matches!(m, MavMessage::RC_CHANNELS(_)).then_some(())).is_empty());
}

/// Returns the time, in seconds, from the client's last message to the failsafe of a manually flown vehicle at the
/// given simulation speed.
fn timeout_s(pace: f64, lockstep: bool) -> f64 {
    let mut station = Station::airborne("drill-hover", 7);
    station.sim.set_speed_factor(pace);
    if lockstep {
        station.sim.open_link(LinkId(9), LinkKind::Payload, true);
    }
    station.sticks(0, 0, 500, 0);
    station.run_ms(1);
    assert_eq!(station.mode(), Some(POSITION));
    let silent_since = station.sim.now();
    let lost = |s: &Station| {
        s.last_message(|m| match m {
            MavMessage::STATUSTEXT(t) => t.text.to_str().ok().filter(|t| t.contains("manual control lost")).map(|_| ()),
            _ => None,
        })
        .is_some()
    };
    while !lost(&station) {
        station.run_ms(20);
        answer_lockstep(&mut station);
        assert!((station.sim.now() - silent_since).s() < 60.0);
    }
    station.run_ms(20);
    (station.sim.now() - silent_since).s()
}

/// The lockstep peer responds immediately, so time advances.
fn answer_lockstep(station: &mut Station) {
    if station.sim.waiting() {
        let now = station.sim.now().ns();
        let answer = MavMessage::TIMESYNC(TIMESYNC_DATA { tc1: 1, ts1: now, ..Default::default() });
        let bytes = spandrel_mavlink::codec::Encoder::new(1, 191).encode(&answer);
        station.sim.handle_datagram(LinkId(9), &bytes);
    }
}

#[test]
fn wire_client_timeouts_scale_with_the_speed_without_lockstep() {
    // COM_RC_LOSS_T is 0.5 s; the failsafe check runs every 50 ms.
    for (pace, lockstep, expected_s) in [(1.0, false, 0.5), (8.0, false, 4.0), (8.0, true, 0.5), (0.5, false, 0.5)] {
        let s = timeout_s(pace, lockstep);
        assert!(
            (expected_s..expected_s + 0.15).contains(&s),
            "speed {pace}, lockstep {lockstep}: {s} s instead of {expected_s} s"
        );
    }
    let mut station = Station::new("drill-hover", 7);
    station.sim.set_speed_factor(8.0);
    station.run_ms(10);
    let told = station.last_message(|m| match m {
        MavMessage::NAMED_VALUE_FLOAT(v) if v.name.to_str() == Ok("pace") => Some(v.value),
        _ => None,
    });
    assert_eq!(told, Some(8.0), "the scale must be logged");
    let text =
        station.last_message(|m| if let MavMessage::STATUSTEXT(t) = m { t.text.to_str().ok().map(str::to_owned) } else { None });
    assert_eq!(text.as_deref(), Some("Client timeouts are scaled by 8"));
}

#[test]
fn wire_stick_loss_leads_to_hold_and_returning_sticks_resume_control() {
    let mut station = Station::airborne("drill-hover", 7);
    station.run_ms(1_700);
    assert_eq!(station.mode(), Some(HOLD));
    for _ in 0..60 {
        station.sticks(0, 0, 500, 0);
        station.run_ms(20);
    }
    assert_eq!(station.mode(), Some(POSITION));
    // The link closes; another station observes the flight and takes control of the sticks.
    station.sim.open_link(OTHER_LINK, LinkKind::GroundStation, false);
    station.sim.close_link(GCS);
    station.received.clear();
    station.run_ms(2_000);
    assert_eq!(station.mode(), Some(HOLD));
    assert!(station.has_text("manual control lost"), "{:?}", station.texts());
    let [north, east, down] = station.place();
    let later = station.local_position_after(3_000);
    assert!(
        (later[0] - north).hypot(later[1] - east) < MAX_DRIFT_M && (later[2] - down).abs() < MAX_DRIFT_M,
        "the vehicle must hold its position: {later:?}"
    );
    for _ in 0..60 {
        send_from_other_link(&mut station, 0);
        station.run_ms(20);
    }
    assert_eq!(station.mode(), Some(POSITION));
    assert!(station.has_text("Failsafe cleared"), "{:?}", station.texts());
}

/// The parameter selects landing (3), returning (2) or a warning only (0).
#[test]
fn wire_stick_loss_failsafe_follows_its_parameter() {
    const LAND: u32 = 4 << 16 | 6 << 24;
    const RETURN: u32 = 4 << 16 | 5 << 24;
    for (choice, mode) in [(3, LAND), (2, RETURN), (1, HOLD)] {
        let mut station = Station::airborne("drill-hover", 7);
        set(&mut station, "NAV_RCL_ACT", choice);
        station.sticks(0, 0, 500, 0);
        station.run_ms(100);
        assert_eq!(station.mode(), Some(POSITION));
        // The vehicle holds first, for the time in COM_FAIL_ACT_T.
        station.run_ms(2_000);
        assert_eq!(station.mode(), Some(HOLD), "choice {choice}");
        station.run_ms(5_000);
        assert_eq!(station.mode(), Some(mode), "choice {choice}");
    }
}

const OTHER_LINK: LinkId = LinkId(5);

fn texts(station: &Station) -> Vec<String> {
    station.all(|m| if let MavMessage::STATUSTEXT(t) = m { t.text.to_str().ok().map(str::to_owned) } else { None })
}

/// Sends right stick deflection from a second ground station that has the same IDs but its own link.
fn send_from_other_link(station: &mut Station, y: i16) {
    let sticks = MANUAL_CONTROL_DATA { y, z: 500, target: 1, ..Default::default() };
    let frame = spandrel_mavlink::codec::Encoder::new(255, 190).encode(&MavMessage::MANUAL_CONTROL(sticks));
    station.sim.handle_datagram(OTHER_LINK, &frame);
}

fn set(station: &mut Station, name: &str, value: i32) {
    station.send(&MavMessage::PARAM_SET(PARAM_SET_DATA {
        param_value: f32::from_bits(value.cast_unsigned()),
        target_system: 1,
        target_component: 1,
        param_id: name.into(),
        param_type: MavParamType::MAV_PARAM_TYPE_INT32,
    }));
    station.run_ms(2);
}

fn roll_echo(station: &Station) -> u16 {
    station.last_message(|m| if let MavMessage::RC_CHANNELS(c) = m { Some(c.chan1_raw) } else { None }).unwrap()
}

#[test]
fn wire_first_sender_keeps_stick_control_until_its_timeout() {
    let mut station = Station::airborne("drill-hover", 7);
    station.sim.open_link(OTHER_LINK, LinkKind::GroundStation, false);
    for _ in 0..100 {
        station.sticks(0, 0, 500, 0);
        send_from_other_link(&mut station, 1000);
        station.run_ms(20);
    }
    assert_eq!(roll_echo(&station), 1500);
    let ignored = texts(&station).iter().filter(|text| text.contains("ignored")).count();
    assert_eq!(ignored, 2, "the text must be sent once on each link: {:?}", texts(&station));
    for _ in 0..40 {
        send_from_other_link(&mut station, 1000);
        station.run_ms(20);
    }
    assert_eq!(roll_echo(&station), 2000, "the second sender must take control when the first stops");
    assert!(texts(&station).iter().any(|text| text.contains("took control of the sticks")), "{:?}", texts(&station));
}

#[test]
fn wire_parameter_can_give_control_to_the_last_sender_to_move_a_stick() {
    let mut station = Station::airborne("drill-hover", 7);
    station.sim.open_link(OTHER_LINK, LinkKind::GroundStation, false);
    set(&mut station, "SPAN_STICKS", 1);
    for y in [0, 1000] {
        for _ in 0..5 {
            station.sticks(0, 0, 500, 0);
            send_from_other_link(&mut station, y);
            station.run_ms(20);
        }
        assert_eq!(roll_echo(&station), if y == 0 { 1500 } else { 2000 }, "centered sticks must not take control");
    }
}

#[test]
fn wire_unset_channels_keep_their_values_until_all_are_released() {
    let mut station = Station::airborne("drill-hover", 7);
    station.run_ms(600);
    channels(&mut station, 1300, 1500);
    station.run_ms(20);
    channels(&mut station, u16::MAX, 1600);
    station.run_ms(20);
    let echo = |s: &Station| {
        s.last_message(|m| if let MavMessage::RC_CHANNELS(c) = m { Some((c.chan2_raw, c.chan3_raw)) } else { None })
    };
    station.run_ms(20);
    assert_eq!(echo(&station), Some((1300, 1600)));
    channels(&mut station, 2500, 65_534);
    station.run_ms(40);
    assert_eq!(echo(&station), Some((1300, 1600)), "invalid pulse widths must have no effect");
    station.send(&MavMessage::RC_CHANNELS_OVERRIDE(RC_CHANNELS_OVERRIDE_DATA {
        target_system: 1,
        target_component: 1,
        ..Default::default()
    }));
    station.run_ms(20);
    station.received.clear();
    station.run_ms(100);
    assert_eq!(echo(&station), None, "released sticks must not be echoed");
}

#[test]
fn wire_buttons_trigger_their_configured_action_once_per_press() {
    let mut station = Station::airborne("drill-hover", 7);
    set(&mut station, "BTN3_FUNCTION", 11);
    set(&mut station, "BTN9_FUNCTION", 10);
    let press = |station: &mut Station, buttons: u16, s: i16| {
        let extensions = 1;
        let sticks = MANUAL_CONTROL_DATA { z: 500, buttons, target: 1, enabled_extensions: extensions, s, ..Default::default() };
        station.send(&MavMessage::MANUAL_CONTROL(sticks));
        station.run_ms(40);
    };
    station.received.clear();
    for buttons in [0, 1 << 3, 1 << 3, 1 << 3 | 1 << 9, 1 << 9, 0] {
        press(&mut station, buttons, 0);
    }
    let pictures = station.all(|m| matches!(m, MavMessage::CAMERA_IMAGE_CAPTURED(_)).then_some(())).len();
    assert_eq!(pictures, 1);
    for _ in 0..25 {
        press(&mut station, 0, -900);
    }
    assert_eq!(station.last_message(|m| if let MavMessage::ILLUMINATOR_STATUS(s) = m { Some(s.enable) } else { None }), Some(1));
    let pitch = station
        .last_message(|m| if let MavMessage::GIMBAL_DEVICE_ATTITUDE_STATUS(g) = m { Some(2.0 * g.q[2].asin()) } else { None });
    assert!(pitch.unwrap() < -0.5, "the gimbal must point down: {pitch:?}");
}
