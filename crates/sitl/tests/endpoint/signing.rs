//! If signatures are required, only clients with the key may control the vehicle.

use spandrel_mavlink::codec::{Decoder, Encoder};
use spandrel_mavlink::dialect::{COMMAND_LONG_DATA, HEARTBEAT_DATA, MavCmd, MavMessage, STATUSTEXT_DATA};
use spandrel_mavlink::signing::{SignatureVerdict, Signing, SigningKey};
use spandrel_sitl::endpoint::{LinkId, LinkKind};
use spandrel_sitl::sim::Sim;
use spandrel_testkit::station::{GCS, Station};

const NOW: u64 = 30_000_000_000_000;
const SIDECAR: LinkId = LinkId(2);

fn key() -> SigningKey {
    SigningKey::from_passphrase("bridge over water")
}

fn signed_vehicle() -> Sim {
    let mut sim = Station::new("drill-hover", 7).vehicle.sim;
    sim.open_link(SIDECAR, LinkKind::Payload, false);
    sim.require_signatures(key(), NOW, &[]);
    sim.set_signing_time(NOW);
    sim
}

fn lamp_on(encoder: &mut Encoder) -> Vec<u8> {
    let command = MavCmd::MAV_CMD_ILLUMINATOR_ON_OFF;
    encoder.encode(&MavMessage::COMMAND_LONG(COMMAND_LONG_DATA {
        command,
        param1: 1.0,
        target_system: 1,
        target_component: 1,
        ..Default::default()
    }))
}

/// Returns the acknowledgments and texts sent on each link.
fn messages(sim: &mut Sim) -> Vec<(LinkId, &'static str)> {
    let until = sim.now() + spandrel_model::time::SimTime::from_ms(5);
    sim.handle_timeout(until);
    let mut out = Vec::new();
    while let Some(transmit) = sim.poll_transmit() {
        for frame in Decoder::new().datagram(&transmit.bytes) {
            match frame.message {
                Some(MavMessage::COMMAND_ACK(_)) => out.push((transmit.link, "ack")),
                Some(MavMessage::STATUSTEXT(_)) if frame.component_id == 191 => out.push((transmit.link, "text")),
                _ => {}
            }
        }
    }
    out
}

#[test]
fn wire_only_signed_frames_are_accepted_and_only_once() {
    let mut sim = signed_vehicle();
    let (mut encoder, mut signing) = (Encoder::new(255, 190), Signing::new(key(), 9, NOW));
    let bare = lamp_on(&mut encoder);
    sim.handle_datagram(GCS, &bare);
    assert_eq!(messages(&mut sim), [], "unsigned");
    let mut stranger = Signing::new(SigningKey::from_passphrase("another bridge"), 9, NOW);
    sim.handle_datagram(GCS, &stranger.sign(bare, NOW));
    assert_eq!(messages(&mut sim), [], "a frame with another key must be ignored");
    let good = signing.sign(lamp_on(&mut encoder), NOW);
    sim.handle_datagram(GCS, &good);
    assert_eq!(messages(&mut sim), [(GCS, "ack")]);
    sim.handle_datagram(GCS, &good);
    assert_eq!(messages(&mut sim), [], "a replayed frame must be ignored");
    assert_eq!(sim.rejected_frames(), 3);
}

#[test]
fn wire_all_outgoing_frames_are_signed() {
    let mut sim = signed_vehicle();
    let until = sim.now() + spandrel_model::time::SimTime::from_ms(2_000);
    sim.handle_timeout(until);
    let mut guards = [Signing::new(key(), 0, NOW), Signing::new(key(), 0, NOW)];
    let mut frames = 0;
    while let Some(transmit) = sim.poll_transmit() {
        for frame in Decoder::new().datagram(&transmit.bytes) {
            frames += 1;
            assert_eq!(
                guards[transmit.link.0 as usize - 1].verify(&frame, NOW),
                SignatureVerdict::Good,
                "message {}",
                frame.message_id
            );
        }
    }
    assert!(frames > 200, "{frames}");
}

#[test]
fn wire_unsigned_sidecar_messages_are_forwarded_but_not_executed() {
    let mut sim = signed_vehicle();
    let mut monitor = Encoder::new(1, 191);
    sim.handle_datagram(SIDECAR, &monitor.encode(&MavMessage::HEARTBEAT(HEARTBEAT_DATA::default())));
    let text = MavMessage::STATUSTEXT(STATUSTEXT_DATA { text: "Too close".into(), ..Default::default() });
    sim.handle_datagram(SIDECAR, &monitor.encode(&text));
    assert_eq!(messages(&mut sim), [(GCS, "text")]);
    sim.handle_datagram(SIDECAR, &lamp_on(&mut monitor));
    assert_eq!(messages(&mut sim), []);
}

#[test]
fn wire_unsigned_frames_require_a_trusted_link() {
    let mut sim = Station::new("drill-hover", 7).vehicle.sim;
    sim.open_link(SIDECAR, LinkKind::Sdk, false);
    sim.require_signatures(key(), NOW, &[LinkKind::Sdk]);
    let mut encoder = Encoder::new(255, 190);
    sim.handle_datagram(SIDECAR, &lamp_on(&mut encoder));
    assert_eq!(messages(&mut sim), [(SIDECAR, "ack")]);
    sim.handle_datagram(GCS, &lamp_on(&mut encoder));
    assert_eq!(messages(&mut sim), []);
    let mut stranger = Signing::new(SigningKey::from_passphrase("another bridge"), 9, NOW);
    sim.handle_datagram(SIDECAR, &stranger.sign(lamp_on(&mut encoder), NOW));
    assert_eq!(messages(&mut sim), []);
}
