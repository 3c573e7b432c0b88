//! Many peers, a flood, a slow radio, and an old client: the load on one link must not affect the other links.

use spandrel_mavlink::codec::{Decoder, Encoder, ReceivedFrame};
use spandrel_mavlink::dialect::*;
use spandrel_model::time::SimTime;
use spandrel_sitl::endpoint::{LinkId, LinkKind};
use spandrel_sitl::sim::Sim;
use spandrel_sitl::sim::inbox::{MAX_BYTES_PER_TICK, MAX_DATAGRAMS_PER_TICK};
use spandrel_testkit::station::{GCS, Station};
use std::collections::BTreeMap;

const FLOOD: LinkId = LinkId(2);
const RADIO: LinkId = LinkId(3);
/// Messages per second of the flooding peer (issue: 50,000).
const FLOOD_HZ: u32 = 50_000;
/// Capacity of a radio at 57,600 baud, bytes per second.
const RADIO_BYTES_S: f64 = 5_760.0;
/// Maximum burst after a silent period, bytes, including the last datagram, which is not split.
const MAX_RADIO_BURST_BYTES: usize = 600;

fn drain(sim: &mut Sim) -> BTreeMap<LinkId, Vec<ReceivedFrame>> {
    let mut heard: BTreeMap<LinkId, Vec<ReceivedFrame>> = BTreeMap::new();
    while let Some(transmit) = sim.poll_transmit() {
        heard.entry(transmit.link).or_default().extend(Decoder::new().datagram(&transmit.bytes));
    }
    heard
}

fn run_ms(sim: &mut Sim, ms: i64) -> BTreeMap<LinkId, Vec<ReceivedFrame>> {
    let until = sim.now() + SimTime::from_ms(ms);
    sim.handle_timeout(until);
    drain(sim)
}

fn question(seq: i64) -> MavMessage {
    MavMessage::TIMESYNC(TIMESYNC_DATA { ts1: seq, ..Default::default() })
}

fn text() -> MavMessage {
    MavMessage::STATUSTEXT(STATUSTEXT_DATA { text: "flood".into(), ..Default::default() })
}

fn command(command: MavCmd, param1: f32) -> MavMessage {
    MavMessage::COMMAND_LONG(COMMAND_LONG_DATA { command, param1, target_system: 1, target_component: 1, ..Default::default() })
}

/// The response to a TIMESYNC request must reach its sender; only the response to the vehicle's own request must be
/// consumed.
#[test]
fn wire_timesync_responses_are_forwarded_from_a_lockstep_link() {
    let mut sim = Station::new("drill-hover", 7).vehicle.sim;
    let (sidecar, other) = (LinkId(7), LinkId(8));
    sim.open_link(sidecar, LinkKind::Payload, true);
    sim.open_link(other, LinkKind::Sdk, false);
    let heartbeat = MavMessage::HEARTBEAT(HEARTBEAT_DATA::default());
    for (system, component) in [(1, 195), (42, 17)] {
        sim.handle_datagram(other, &Encoder::new(system, component).encode(&heartbeat));
    }
    let asked = run_ms(&mut sim, 100);
    let token =
        asked[&sidecar].iter().find_map(|f| if let Some(MavMessage::TIMESYNC(t)) = &f.message { Some(t.ts1) } else { None });
    let token = token.expect("the vehicle must send a lockstep request");
    let mut encoder = Encoder::new(1, 191);
    let mut answer = |ts1: i64, target_system: u8, target_component: u8| {
        encoder.encode(&MavMessage::TIMESYNC(TIMESYNC_DATA { tc1: 5, ts1, target_system, target_component }))
    };
    for (ts1, system, component) in [(token, 1, 195), (77, 42, 17), (78, 0, 0), (79, 1, 1)] {
        sim.handle_datagram(sidecar, &answer(ts1, system, component));
        assert!(sim.waiting(), "{ts1} {system} {component} must not count as a response to the request");
    }
    sim.handle_datagram(sidecar, &answer(token, 1, 1));
    assert!(!sim.waiting());
    let heard = run_ms(&mut sim, 2);
    let answers = |frames: &Vec<ReceivedFrame>| -> Vec<(i64, u8, u8)> {
        let foreign = frames.iter().filter(|f| f.component_id == 191).filter_map(|f| f.message.as_ref());
        let sync = |m: &MavMessage| {
            if let MavMessage::TIMESYNC(t) = m { Some((t.ts1, t.target_system, t.target_component)) } else { None }
        };
        foreign.filter_map(sync).collect()
    };
    assert_eq!(answers(&heard[&other]), [(token, 1, 195), (77, 42, 17), (78, 0, 0)]);
    assert_eq!(
        heard.get(&GCS).map(answers).unwrap_or_default(),
        [(78, 0, 0)],
        "broadcasts must reach all links; other messages must reach only their target"
    );
}

fn own(frames: &[ReceivedFrame]) -> Vec<(u32, u8)> {
    frames.iter().filter(|f| f.system_id == 1).map(|f| (f.message_id, f.component_id)).collect()
}

/// Returns the maximum number of responses and forwarded frames per tick on one link.
fn max_frames_per_tick(first: bool) -> usize {
    // The first call processes datagrams at its beginning and at its end.
    if first { 2 * MAX_DATAGRAMS_PER_TICK } else { MAX_DATAGRAMS_PER_TICK }
}

/// Runs one vehicle with and one without a flooding peer, each with fifty additional ground stations.
#[test]
fn wire_flooding_peer_is_limited_per_tick_and_does_not_affect_fifty_peers() {
    const TICKS: i64 = 1_000;
    let mut calm = Station::new("drill-hover", 7).vehicle.sim;
    let peers: Vec<LinkId> = (10..60).map(LinkId).collect();
    peers.iter().chain([&FLOOD]).for_each(|peer| calm.open_link(*peer, LinkKind::GroundStation, false));
    let mut flooded = calm.clone();
    let mut encoders: Vec<Encoder> = (0..50).map(|k| Encoder::new(100 + k, 190)).collect();
    let mut encoder = Encoder::new(77, 190);
    let (mut sent, mut acted, mut handed_on, mut asked, mut answered) = (0u64, 0, 0, 0, 0);
    for tick in 0..TICKS {
        for (k, (peer, encoder)) in peers.iter().zip(&mut encoders).enumerate() {
            // Each sends five requests per second, at different times.
            if tick % 200 == 4 * k as i64 {
                let ask = encoder.encode(&command(MavCmd::MAV_CMD_REQUEST_MESSAGE, 148.0));
                [&mut calm, &mut flooded].into_iter().for_each(|sim| sim.handle_datagram(*peer, &ask));
                asked += 1;
            }
        }
        for k in 0..FLOOD_HZ / 1_000 {
            // Broadcasts that are forwarded to all links, and requests that are answered.
            let message = if k % 2 == 0 { text() } else { question(tick) };
            flooded.handle_datagram(FLOOD, &encoder.encode(&message));
            sent += 1;
        }
        let (quiet, loud) = (run_ms(&mut calm, 1), run_ms(&mut flooded, 1));
        let heard = |link: &LinkId| loud.get(link).map_or(&[][..], Vec::as_slice);
        let answers = heard(&FLOOD).iter().filter(|f| f.message_id == 111 && f.system_id == 1).count();
        let most = max_frames_per_tick(tick == 0);
        for link in peers.iter().chain([&GCS]) {
            let passed = heard(link).iter().filter(|f| f.system_id == 77 && f.message_id == 253).count();
            assert!(passed + answers <= most, "{passed} forwarded to {link:?} and {answers} answered in tick {tick}");
            let expected = quiet.get(link).map(|frames| own(frames)).unwrap_or_default();
            assert_eq!(own(heard(link)), expected, "{link:?} in tick {tick}");
            answered += expected.iter().filter(|(id, _)| *id == 77).count();
        }
        acted += answers;
        handed_on += heard(&GCS).iter().filter(|f| f.system_id == 77 && f.message_id == 253).count();
    }
    assert_eq!(answered, asked, "every request from the peers must be acknowledged in both runs");
    assert!(acted > 500 && handed_on > 500, "{acted} {handed_on}");
    // Datagrams that are neither processed nor dropped are queued, and the queue must stay short.
    let waiting = sent - flooded.dropped() - (acted + handed_on) as u64;
    assert!((1..=1_024).contains(&waiting), "{waiting}");
    assert_eq!(calm.dropped(), 0);
    // After the flood, queued datagrams are processed, none are lost, and the counts add up.
    let rest = run_ms(&mut flooded, 300);
    acted += rest[&FLOOD].iter().filter(|f| f.message_id == 111 && f.system_id == 1).count();
    handed_on += rest[&GCS].iter().filter(|f| f.system_id == 77 && f.message_id == 253).count();
    assert_eq!(sent, flooded.dropped() + (acted + handed_on) as u64);
}

#[test]
fn wire_fifty_peers_receive_the_same_streams_as_one() {
    let mut sim = Station::new("drill-hover", 7).vehicle.sim;
    let peers: Vec<LinkId> = (10..60).map(LinkId).collect();
    peers.iter().for_each(|peer| sim.open_link(*peer, LinkKind::GroundStation, false));
    let mut encoders: Vec<Encoder> = (0..50).map(|k| Encoder::new(100 + k, 190)).collect();
    let mut heard: BTreeMap<LinkId, Vec<ReceivedFrame>> = BTreeMap::new();
    for second in 0..3 {
        for (peer, encoder) in peers.iter().zip(&mut encoders) {
            sim.handle_datagram(*peer, &encoder.encode(&MavMessage::HEARTBEAT(HEARTBEAT_DATA::default())));
            let list = PARAM_REQUEST_LIST_DATA { target_system: 1, target_component: 1 };
            if second == 0 {
                sim.handle_datagram(*peer, &encoder.encode(&MavMessage::PARAM_REQUEST_LIST(list)));
            }
        }
        for (link, frames) in run_ms(&mut sim, 1_000) {
            heard.entry(link).or_default().extend(frames);
        }
    }
    let streams = |link: &LinkId| own(&heard[link]);
    for peer in &peers {
        assert_eq!(streams(peer), streams(&peers[0]), "{peer:?}");
        let others = heard[peer].iter().filter(|f| f.message_id == 0 && f.system_id >= 100).count();
        assert_eq!(others, 3 * 49, "{peer:?} must receive heartbeats of the other ground stations");
    }
    assert_eq!(sim.dropped(), 0);
}

#[test]
fn wire_radio_stays_within_its_capacity_with_prompt_responses() {
    let mut sim = Station::new("drill-hover", 7).vehicle.sim;
    sim.open_link(RADIO, LinkKind::Serial, false);
    sim.limit_link_rate(RADIO, RADIO_BYTES_S);
    let mut encoder = Encoder::new(250, 190);
    let list = MavMessage::PARAM_REQUEST_LIST(PARAM_REQUEST_LIST_DATA { target_system: 1, target_component: 1 });
    sim.handle_datagram(RADIO, &encoder.encode(&list));
    let (mut bytes, mut beats, mut parameters, mut worst_ms, mut attitudes) = (0, 0, 0, 0, 0);
    let mut total = 0;
    for second in 0..30 {
        let ask = encoder.encode(&command(MavCmd::MAV_CMD_REQUEST_MESSAGE, 148.0));
        sim.handle_datagram(RADIO, &ask);
        let mut answered = None;
        for ms in 0..1_000 {
            for frame in run_ms(&mut sim, 1).remove(&RADIO).unwrap_or_default() {
                bytes += frame.bytes.len();
                beats += usize::from(frame.message_id == 0 && frame.component_id == 1);
                parameters += usize::from(frame.message_id == 22);
                attitudes += usize::from(frame.message_id == 30);
                if let Some(MavMessage::PARAM_VALUE(value)) = &frame.message {
                    total = usize::from(value.param_count);
                }
                if frame.message_id == 77 {
                    answered = answered.or(Some(ms));
                }
            }
        }
        worst_ms = worst_ms.max(answered.unwrap_or(1_000));
        let carried = (RADIO_BYTES_S as usize) * (second + 1) + MAX_RADIO_BURST_BYTES;
        assert!(bytes <= carried, "{bytes} of {carried} bytes after {second} s");
    }
    // One per second, and another after each camera heartbeat, every 4 s.
    assert!((36..=39).contains(&beats), "{beats} heartbeats");
    assert!(parameters >= total && total > 50, "{parameters} of {total} parameters");
    assert!(worst_ms < 500, "an acknowledgment took {worst_ms} ms");
    assert!(attitudes > 30, "{attitudes} attitude messages: streams must slow down but not stop");
    assert!(bytes as f64 > 0.6 * 30.0 * RADIO_BYTES_S, "{bytes} bytes: the radio's capacity must be used");
}

/// Encodes a frame in MAVLink 1.
fn mavlink1_frame(sequence: u8, id: u8, payload: &[u8]) -> Vec<u8> {
    use mavlink::Message;
    let mut out = vec![0xFE, payload.len() as u8, sequence, 255, 190, id];
    out.extend(payload);
    let crc = mavlink::calculate_crc(&out[1..], MavMessage::extra_crc(u32::from(id)));
    out.extend(crc.to_le_bytes());
    out
}

#[test]
fn wire_mavlink_1_clients_are_supported() {
    let mut station = Station::new("drill-hover", 7);
    station.run_ms(2_500);
    let mut lamp = [0u8; 33];
    lamp[..4].copy_from_slice(&1f32.to_le_bytes());
    lamp[28..30].copy_from_slice(&405u16.to_le_bytes());
    (lamp[30], lamp[31]) = (1, 1);
    station.sim.handle_datagram(GCS, &mavlink1_frame(0, 76, &lamp));
    station.run_ms(600);
    assert_eq!(station.last_message(|m| if let MavMessage::ILLUMINATOR_STATUS(s) = m { Some(s.enable) } else { None }), Some(1));
}

#[test]
fn wire_setup_signing_is_never_forwarded() {
    let mut sim = Station::new("drill-hover", 7).vehicle.sim;
    sim.open_link(FLOOD, LinkKind::GroundStation, false);
    let mut encoder = Encoder::new(77, 190);
    let secret = MavMessage::SETUP_SIGNING(SETUP_SIGNING_DATA { secret_key: [7; 32], ..Default::default() });
    sim.handle_datagram(FLOOD, &encoder.encode(&secret));
    sim.handle_datagram(FLOOD, &encoder.encode(&text()));
    let heard = run_ms(&mut sim, 5);
    let passed: Vec<u32> = heard[&GCS].iter().filter(|f| f.system_id == 77).map(|f| f.message_id).collect();
    assert_eq!(passed, [253]);
}

#[test]
fn wire_oversized_datagram_is_dropped() {
    let mut sim = Station::new("drill-hover", 7).vehicle.sim;
    let question = Encoder::new(255, 190).encode(&question(1));
    sim.handle_datagram(GCS, &question.repeat(MAX_BYTES_PER_TICK / question.len() + 1));
    let answered = run_ms(&mut sim, 5)[&GCS].iter().filter(|f| f.message_id == 111 && f.system_id == 1).count();
    assert_eq!((answered, sim.dropped()), (0, 1));
}

/// A peer known only by its source address must get responses, but no streams until a heartbeat arrives from that
/// address; otherwise, one byte would trigger 266 kB.
#[test]
fn regress_unknown_peer_gets_no_streams_before_its_heartbeat() {
    let mut sim = Station::new("drill-hover", 7).vehicle.sim;
    let peer = LinkId(9);
    sim.open_link(peer, LinkKind::Payload, false);
    sim.await_heartbeat(peer);
    let mut encoder = Encoder::new(245, 191);
    sim.handle_datagram(peer, &encoder.encode(&question(1)));
    sim.open_link(FLOOD, LinkKind::GroundStation, false);
    sim.handle_datagram(FLOOD, &Encoder::new(77, 190).encode(&text()));
    let heard = run_ms(&mut sim, 3_000).remove(&peer).unwrap_or_default();
    let kinds: Vec<u32> = heard.iter().map(|frame| frame.message_id).collect();
    assert_eq!(kinds, [111], "only the response must be sent");
    sim.handle_datagram(peer, &encoder.encode(&MavMessage::HEARTBEAT(HEARTBEAT_DATA::default())));
    let heard = run_ms(&mut sim, 1_500).remove(&peer).unwrap_or_default();
    let count = |id: u32| heard.iter().filter(|frame| frame.message_id == id && frame.component_id == 1).count();
    // A sidecar receives ground truth at 50 Hz for one and a half seconds.
    assert!(count(0) >= 1 && count(115) > 70, "{} heartbeats, {} ground truth messages", count(0), count(115));
}
