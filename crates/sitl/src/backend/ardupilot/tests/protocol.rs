//! Packets, resends and restarts.

use super::super::servo_packet::ServoPacket;
use super::{Scene, interface, packet};
use crate::backend::interface::{InterfaceEvent, SimulatorInterface};
use spandrel_model::time::SimTime;

fn timestamp(datagram: &[u8]) -> f64 {
    let json: serde_json::Value = serde_json::from_slice(datagram).expect("JSON");
    json["timestamp"].as_f64().expect("number")
}

#[test]
fn wire_both_packet_sizes_are_decoded() {
    let short = ServoPacket::decode(&packet(0x0102_0304, [1100, 1200, 1300, 1400])).expect("packet");
    assert_eq!(short.frame_count, 0x0102_0304);
    assert_eq!((short.pwm_us[..5].to_vec(), short.pwm_us[16]), (vec![1100, 1200, 1300, 1400, 1000], 0));
    let mut long = 29_569_u16.to_le_bytes().to_vec();
    long.extend([0; 6]);
    long.extend((1..=32_u16).flat_map(u16::to_le_bytes));
    assert_eq!(ServoPacket::decode(&long).expect("packet").pwm_us[31], 32);
}

#[test]
fn wire_other_magic_numbers_and_lengths_are_rejected() {
    let good = packet(1, [1000; 4]);
    let mut foreign = good.clone();
    foreign[0] ^= 1;
    for bad in [&good[..39], &[&good[..], &[0]].concat(), &foreign, &[], &good[..1]] {
        assert!(ServoPacket::decode(bad).is_err(), "{bad:?}");
    }
}

#[test]
fn wire_rejected_datagrams_are_reported_once_and_then_by_powers_of_ten() {
    let mut interface = interface();
    for _ in 0..1000 {
        interface.receive(b"hello");
    }
    let events: Vec<_> = std::iter::from_fn(|| interface.poll_event()).collect();
    assert_eq!(events.len(), 4, "{events:?}");
    assert!(matches!(&events[3], InterfaceEvent::Rejected(text) if text.contains("1000 datagrams")), "{events:?}");
    assert!(!interface.has_answered() && interface.is_waiting());
}

#[test]
fn wire_each_new_frame_gets_one_state() {
    let mut interface = interface();
    let mut scene = Scene::at_rest();
    assert!(interface.is_waiting() && !interface.has_answered(), "the address of ArduPilot is unknown");
    for frame in 0..5 {
        interface.receive(&packet(frame, [1000; 4]));
        assert!(!interface.is_waiting() && interface.has_answered());
        interface.send(&scene.step());
        assert!(interface.is_waiting());
        let reply = interface.poll_transmit().expect("reply");
        let expected_s = 0.002 * f64::from(frame + 1);
        assert!((timestamp(&reply) - expected_s).abs() < 1e-7, "{expected_s}");
        assert_eq!(interface.poll_transmit(), None);
        scene.now += SimTime::from_ms(2);
    }
}

#[test]
fn wire_resent_packet_gets_the_same_reply() {
    let mut interface = interface();
    let mut scene = Scene::at_rest();
    interface.receive(&packet(0, [1000; 4]));
    interface.receive(&packet(0, [1000; 4]));
    assert_eq!(interface.poll_transmit(), None, "the state of this frame is not ready yet");
    interface.send(&scene.step());
    let reply = interface.poll_transmit().expect("reply");
    scene.now += SimTime::from_ms(2);
    interface.receive(&packet(0, [1900; 4]));
    assert!(interface.is_waiting(), "the simulation must not advance");
    assert!(!interface.actuators().armed);
    assert_eq!(interface.poll_transmit(), Some(reply));
    // A caller that sends too early changes nothing.
    interface.send(&scene.step());
    assert_eq!(interface.poll_transmit(), None);
}

#[test]
fn wire_restarted_autopilot_gets_a_new_clock() {
    let mut interface = interface();
    let mut scene = Scene::at_rest();
    for frame in [0, 1, 2] {
        interface.receive(&packet(frame, [1500; 4]));
        interface.send(&scene.step());
        scene.now += SimTime::from_ms(2);
    }
    while interface.poll_transmit().is_some() {}
    interface.receive(&packet(0, [1000; 4]));
    assert_eq!(interface.poll_event(), Some(InterfaceEvent::Restarted));
    assert!(!interface.is_waiting() && !interface.actuators().armed);
    interface.send(&scene.step());
    assert!((timestamp(&interface.poll_transmit().expect("reply")) - 0.002).abs() < 1e-7);
}

#[test]
fn wire_new_connection_waits_for_a_first_packet() {
    let mut interface = interface();
    interface.receive(&packet(700, [1500; 4]));
    interface.send(&Scene::at_rest().step());
    interface.connect();
    assert!(!interface.has_answered() && interface.is_waiting());
    assert_eq!(interface.poll_transmit(), None);
    interface.receive(&packet(3, [1000; 4]));
    assert_eq!(interface.poll_event(), None, "a different process is not a restart");
    assert!(!interface.is_waiting());
}

#[test]
fn exact_pulse_widths_become_motor_commands() {
    let mut interface = interface();
    for (frame, (pulses, motors, armed)) in [
        ([0, 0, 0, 0], [0.0; 4], false),
        ([1000, 999, 0, 1000], [0.0; 4], false),
        ([1000, 1001, 1500, 2200], [0.0, 0.001, 0.5, 1.0], true),
        ([2000, 1000, 1000, u16::MAX], [1.0, 0.0, 0.0, 1.0], true),
    ]
    .into_iter()
    .enumerate()
    {
        interface.receive(&packet(frame as u32, pulses));
        let actuators = interface.actuators();
        assert_eq!((&actuators.motors[..4], actuators.armed), (&motors[..], armed));
        assert_eq!(actuators.motors[4..], [0.0; 4], "other outputs are not motors");
    }
}

#[test]
fn prop_no_datagram_gives_an_invalid_command() {
    let mut interface = interface();
    let mut seed = 1_u64;
    for length in (0..=80).cycle().take(20_000) {
        let mut bytes: Vec<u8> = (0..length)
            .map(|_| {
                seed = seed.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
                (seed >> 56) as u8
            })
            .collect();
        if length == 40 {
            bytes[..2].copy_from_slice(&18_458_u16.to_le_bytes());
        }
        interface.receive(&bytes);
        assert!(interface.actuators().motors.iter().all(|command| (0.0..=1.0).contains(command)));
        while interface.poll_event().is_some() || interface.poll_transmit().is_some() {}
    }
}
