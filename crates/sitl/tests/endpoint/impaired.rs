//! Plans and parameters over a link that loses 30% of the datagrams, delays them by 200 ms, and reorders and
//! duplicates them, in both directions, with a client that retries indefinitely. All tests run in simulation time from
//! a seed. Files: `impaired_files.rs`.

use super::impaired_files::Disk;
use spandrel_mavlink::codec::{Decoder, Encoder};
use spandrel_mavlink::dialect::*;
use spandrel_model::random::RandomStream;
use spandrel_model::time::SimTime;
use spandrel_testkit::plans::{home_north, item};
use spandrel_testkit::station::{GCS, Station};
use std::collections::{BTreeMap, BTreeSet};

/// Values from the issue: the fraction of lost datagrams, the delay range (which reorders datagrams), and the fraction
/// of duplicated datagrams.
const LOSS: f64 = 0.3;
const DELAY_MS: (f64, f64) = (100.0, 300.0);
const DUPLICATE_PROBABILITY: f64 = 0.1;
/// The client's retry interval, ms: one and a half round trips.
pub(super) const TIMEOUT_MS: i64 = 900;
/// Time limit for each exchange, in seconds of simulation time; only a hang takes longer.
pub(super) const LIMIT_S: f64 = 1_200.0;

/// One direction of the link.
struct LossyPath {
    stream: RandomStream,
    loss: f64,
    in_transit: BTreeMap<(i64, u64), Vec<u8>>,
    count: u64,
}

impl LossyPath {
    fn new(seed: u64, name: &str, loss: f64) -> Self {
        Self { stream: RandomStream::new(seed, name), loss, in_transit: BTreeMap::new(), count: 0 }
    }

    fn send(&mut self, bytes: &[u8], now: SimTime) {
        let copies = if self.stream.uniform() < DUPLICATE_PROBABILITY { 2 } else { 1 };
        for _ in 0..copies {
            if self.stream.uniform() >= self.loss {
                let at = now.ms() + self.stream.range(DELAY_MS.0, DELAY_MS.1) as i64;
                self.count += 1;
                self.in_transit.insert((at, self.count), bytes.to_vec());
            }
        }
    }

    fn arrived(&mut self, now: SimTime) -> Vec<Vec<u8>> {
        let later = self.in_transit.split_off(&(now.ms() + 1, 0));
        std::mem::replace(&mut self.in_transit, later).into_values().collect()
    }
}

/// A client at the remote end.
pub(super) struct Client {
    pub(super) station: Station,
    there: LossyPath,
    back: LossyPath,
    encoder: Encoder,
    pub(super) disk: Disk,
}

impl Client {
    pub(super) fn new(seed: u64) -> Self {
        Self::with_loss(seed, LOSS)
    }

    fn with_loss(seed: u64, loss: f64) -> Self {
        let mut station = Station::new("drill-hover", 7);
        station.run_ms(2_500);
        let (there, back) = (LossyPath::new(seed, "there", loss), LossyPath::new(seed, "back", loss));
        Self { station, there, back, encoder: Encoder::new(255, 190), disk: Disk::default() }
    }

    /// Advances by one millisecond and returns the messages that the client receives.
    pub(super) fn tick(&mut self) -> Vec<MavMessage> {
        let sim = &mut self.station.sim;
        for datagram in self.there.arrived(sim.now()) {
            sim.handle_datagram(GCS, &datagram);
        }
        sim.handle_timeout(sim.poll_timeout());
        while let Some(job) = sim.poll_file_job() {
            let outcome = self.disk.work(&job.action);
            sim.finish_file_job(job.ticket, outcome);
        }
        while let Some(transmit) = sim.poll_transmit() {
            self.back.send(&transmit.bytes, sim.now());
        }
        let arrived = self.back.arrived(sim.now());
        arrived.iter().flat_map(|bytes| Decoder::new().datagram(bytes)).filter_map(|frame| frame.message).collect()
    }

    pub(super) fn send(&mut self, message: &MavMessage) {
        let frame = self.encoder.encode(message);
        self.there.send(&frame, self.station.sim.now());
    }

    /// Sends a request repeatedly until a response matches.
    pub(super) fn ask<T>(&mut self, message: &MavMessage, like: impl FnMut(&MavMessage) -> Option<T>) -> T {
        self.ask_every(TIMEOUT_MS, message, like)
    }

    /// Same as `ask`, but with another retry interval in ms.
    pub(super) fn ask_every<T>(
        &mut self,
        timeout_ms: i64,
        message: &MavMessage,
        mut like: impl FnMut(&MavMessage) -> Option<T>,
    ) -> T {
        let begin = self.station.sim.now();
        loop {
            self.send(message);
            for _ in 0..timeout_ms {
                if let Some(found) = self.tick().iter().find_map(&mut like) {
                    return found;
                }
            }
            assert!((self.station.sim.now() - begin).s() < LIMIT_S, "no response to {message:?}");
        }
    }
}

fn count(count: u16) -> MavMessage {
    MavMessage::MISSION_COUNT(MISSION_COUNT_DATA { count, target_system: 1, target_component: 1, ..Default::default() })
}

#[test]
fn wire_mission_transfers_survive_a_bad_link() {
    upload_and_download(&mut Client::new(1), 40);
}

/// The case from MAVLink's test suite: 500 items with a quarter of all datagrams lost.
#[test]
fn wire_500_items_are_transferred_despite_25_percent_loss() {
    upload_and_download(&mut Client::with_loss(5, 0.25), 500);
}

fn upload_and_download(client: &mut Client, number: u16) {
    let home = home_north(&client.station);
    let waypoint = |k| item(k, MavCmd::MAV_CMD_NAV_WAYPOINT, home + 2.0 * f64::from(k), 6.0);
    let items: Vec<_> = (0..number).map(waypoint).collect();
    // The vehicle requests the items one by one; the client sends the item requested last.
    let next = |m: &MavMessage| match m {
        MavMessage::MISSION_REQUEST_INT(r) => Some(Some(r.seq)),
        MavMessage::MISSION_ACK(a) if a.mavtype == MavMissionResult::MAV_MISSION_ACCEPTED => Some(None),
        _ => None,
    };
    let mut wanted = client.ask(&count(items.len() as u16), next);
    while let Some(seq) = wanted {
        wanted = client.ask(&MavMessage::MISSION_ITEM_INT(items[usize::from(seq)].clone()), next);
    }
    let list = MavMessage::MISSION_REQUEST_LIST(MISSION_REQUEST_LIST_DATA {
        target_system: 1,
        target_component: 1,
        ..Default::default()
    });
    let total = client.ask(&list, |m| if let MavMessage::MISSION_COUNT(c) = m { Some(c.count) } else { None });
    assert_eq!(usize::from(total), items.len());
    for sent in &items {
        let request = MISSION_REQUEST_INT_DATA { seq: sent.seq, target_system: 1, target_component: 1, ..Default::default() };
        let got = client.ask(&MavMessage::MISSION_REQUEST_INT(request), |m| match m {
            MavMessage::MISSION_ITEM_INT(item) if item.seq == sent.seq => Some((item.command, item.x, item.y, item.z)),
            _ => None,
        });
        assert_eq!(got, (sent.command, sent.x, sent.y, sent.z));
    }
}

#[test]
fn wire_parameters_are_read_and_set_over_a_bad_link() {
    let mut client = Client::new(2);
    let list = MavMessage::PARAM_REQUEST_LIST(PARAM_REQUEST_LIST_DATA { target_system: 1, target_component: 1 });
    let (mut seen, mut total) = (BTreeSet::new(), None);
    client.send(&list);
    // Collects the parameters of the list, then requests the missing ones by index.
    for _ in 0..3_000 {
        for message in client.tick() {
            if let MavMessage::PARAM_VALUE(value) = message
                && value.param_index != u16::MAX
            {
                seen.insert(value.param_index);
                total = Some(value.param_count);
            }
        }
    }
    let total = total.expect("part of the list must arrive");
    assert!(seen.len() < usize::from(total), "the link must lose some parameters");
    for index in (0..total).filter(|index| !seen.contains(index)) {
        let read =
            PARAM_REQUEST_READ_DATA { param_index: index as i16, target_system: 1, target_component: 1, param_id: "".into() };
        client.ask(&MavMessage::PARAM_REQUEST_READ(read), |m| match m {
            MavMessage::PARAM_VALUE(v) if v.param_index == index => Some(()),
            _ => None,
        });
    }
    let set = PARAM_SET_DATA {
        param_value: 6.5,
        target_system: 1,
        target_component: 1,
        param_id: "MIS_TAKEOFF_ALT".into(),
        param_type: MavParamType::MAV_PARAM_TYPE_REAL32,
    };
    client.ask(&MavMessage::PARAM_SET(set), |m| match m {
        MavMessage::PARAM_VALUE(v) if v.param_id.to_str() == Ok("MIS_TAKEOFF_ALT") && v.param_value == 6.5 => Some(()),
        _ => None,
    });
}

/// PX4's retry interval, ms. MAVSDK gives up after five half-seconds without messages or five repetitions of an item.
const RETRY_MS: i64 = 250;

#[expect(deprecated, reason = "clients still support only superseded MAVLink messages")]
fn requests_or_ack(station: &mut Station) -> Vec<(i64, Option<u16>)> {
    let mut heard = Vec::new();
    for _ in 0..1_500 {
        station.vehicle.sim.handle_timeout(station.vehicle.sim.poll_timeout());
        let now_ms = station.sim.now().ms();
        while let Some(transmit) = station.sim.poll_transmit() {
            let frames = Decoder::new().datagram(&transmit.bytes);
            heard.extend(frames.into_iter().filter_map(|frame| match frame.message? {
                MavMessage::MISSION_REQUEST_INT(request) => Some((now_ms, Some(request.seq))),
                MavMessage::MISSION_REQUEST(request) => Some((now_ms, Some(request.seq))),
                MavMessage::MISSION_ACK(_) => Some((now_ms, None)),
                _ => None,
            }));
        }
    }
    heard
}

/// The vehicle repeats its request four times per second to a client whose items were lost, and repeats an
/// acknowledgment that may have been lost. On a lossless link, it sends only one acknowledgment, as PX4 does.
#[test]
fn regress_upload_requests_are_repeated_after_250_ms() {
    let mut station = Station::new("drill-hover", 7);
    station.run_ms(2_500);
    let mut encoder = Encoder::new(255, 190);
    let home = home_north(&station);
    let waypoint = |k| MavMessage::MISSION_ITEM_INT(item(k, MavCmd::MAV_CMD_NAV_WAYPOINT, home, 6.0));
    for loses in [true, false] {
        station.sim.handle_datagram(GCS, &encoder.encode(&count(1)));
        if loses {
            let heard = requests_or_ack(&mut station);
            let gaps: Vec<i64> = heard.windows(2).map(|pair| pair[1].0 - pair[0].0).collect();
            assert!(heard.iter().all(|(_, asked)| *asked == Some(0)) && gaps.len() == 5, "{heard:?}");
            assert!(gaps.iter().all(|gap| (RETRY_MS..=RETRY_MS + 2).contains(gap)), "{gaps:?}");
        }
        station.sim.handle_datagram(GCS, &encoder.encode(&waypoint(0)));
        let heard = requests_or_ack(&mut station);
        let acknowledged = heard.iter().filter(|(_, asked)| asked.is_none()).count();
        assert_eq!(acknowledged, if loses { 5 } else { 1 }, "{heard:?}");
    }
    // The vehicle repeats its request sooner to a client that has responded within a few milliseconds: 120 ms after the
    // request's control tick (2.5 ms). More requests then fit into the client's timeout.
    station.sim.handle_datagram(GCS, &encoder.encode(&count(2)));
    station.run_ms(3);
    station.sim.handle_datagram(GCS, &encoder.encode(&waypoint(0)));
    let heard = requests_or_ack(&mut station);
    let gaps: Vec<i64> = heard.windows(2).map(|pair| pair[1].0 - pair[0].0).collect();
    assert!(heard.iter().all(|(_, asked)| *asked == Some(1)) && gaps.iter().all(|gap| (118..=122).contains(gap)), "{heard:?}");
    station.sim.handle_datagram(GCS, &encoder.encode(&waypoint(1)));
    requests_or_ack(&mut station);
    // A client that starts a new transfer no longer waits for the old one.
    station.sim.handle_datagram(GCS, &encoder.encode(&count(1)));
    requests_or_ack(&mut station);
    station.sim.handle_datagram(GCS, &encoder.encode(&waypoint(0)));
    let list = MISSION_REQUEST_LIST_DATA { target_system: 1, target_component: 1, ..Default::default() };
    station.sim.handle_datagram(GCS, &encoder.encode(&MavMessage::MISSION_REQUEST_LIST(list)));
    let heard = requests_or_ack(&mut station);
    assert_eq!(heard.iter().filter(|(_, asked)| asked.is_none()).count(), 1, "{heard:?}");
}

/// An uploader that works like MAVSDK 4.1: a request for an item that it has already sent sets it back, and a request
/// for an item beyond its next one is ignored.
struct Uploader {
    station: Station,
    encoder: Encoder,
    home: f64,
    next: u16,
}

impl Uploader {
    fn begin(items: u16) -> Self {
        let mut station = Station::new("drill-hover", 7);
        station.run_ms(2_500);
        let home = home_north(&station);
        let mut uploader = Self { station, encoder: Encoder::new(255, 190), home, next: 0 };
        uploader.station.sim.handle_datagram(GCS, &uploader.encoder.encode(&count(items)));
        uploader
    }

    fn send(&mut self, seq: u16) {
        let waypoint = item(seq, MavCmd::MAV_CMD_NAV_WAYPOINT, self.home + 2.0 * f64::from(seq), 6.0);
        self.station.sim.handle_datagram(GCS, &self.encoder.encode(&MavMessage::MISSION_ITEM_INT(waypoint)));
    }

    /// Handles a request and returns whether it was answered.
    fn answer(&mut self, seq: u16) -> bool {
        if seq > self.next {
            return false;
        }
        self.next = seq + 1;
        self.send(seq);
        true
    }

    /// Advances by one millisecond and returns the messages from the vehicle.
    fn tick(&mut self) -> Vec<MavMessage> {
        self.station.vehicle.sim.handle_timeout(self.station.vehicle.sim.poll_timeout());
        let sent: Vec<_> = std::iter::from_fn(|| self.station.sim.poll_transmit()).collect();
        sent.iter().flat_map(|transmit| Decoder::new().datagram(&transmit.bytes)).filter_map(|frame| frame.message).collect()
    }

    /// Answers requests until this item is requested or the upload is acknowledged; returns the requests.
    fn answer_until(&mut self, stop: Option<u16>) -> Vec<u16> {
        let mut requests = Vec::new();
        for _ in 0..MAVSDK_TIMEOUT_MS {
            for message in self.tick() {
                match message {
                    MavMessage::MISSION_REQUEST_INT(request) if Some(request.seq) == stop => return requests,
                    MavMessage::MISSION_REQUEST_INT(request) => {
                        requests.push(request.seq);
                        self.answer(request.seq);
                    }
                    MavMessage::MISSION_ACK(ack) => {
                        assert_eq!(ack.mavtype, MavMissionResult::MAV_MISSION_ACCEPTED, "after {requests:?}");
                        return requests;
                    }
                    _ => {}
                }
            }
        }
        panic!("neither {stop:?} nor an acknowledgment arrived: {requests:?}")
    }
}

/// Three half-seconds without messages, after which MAVSDK has given up.
const MAVSDK_TIMEOUT_MS: i64 = 1_500;

/// A delayed request sets MAVSDK back. The item that it repeats must show the vehicle where to continue.
#[test]
fn regress_upload_continues_after_a_delayed_request() {
    let mut client = Uploader::begin(30);
    client.answer_until(Some(20));
    client.answer(15);
    let requests = client.answer_until(None);
    let led: Vec<u16> = (16..30).collect();
    assert_eq!(requests, led, "item 16 must follow the repeated item 15, and each must be requested once");
}

/// Same as above, but the repeated item is lost, so the vehicle must request earlier and earlier items.
#[test]
fn regress_upload_continues_after_a_lost_repeated_item() {
    let mut client = Uploader::begin(30);
    client.answer_until(Some(20));
    // The link has reordered a datagram before.
    client.send(18);
    client.next = 16;
    let requests = client.answer_until(None);
    assert_eq!(requests.iter().rev().take(14).rev().copied().collect::<Vec<_>>(), (16..30).collect::<Vec<_>>(), "{requests:?}");
    assert!(requests.iter().filter(|seq| **seq > 16).count() < 24, "requests must not be duplicated: {requests:?}");
}

/// A duplicated datagram must not cause a second request.
#[test]
fn regress_duplicated_item_causes_no_further_request() {
    let mut client = Uploader::begin(10);
    client.answer_until(Some(5));
    client.send(3);
    client.send(4);
    client.answer(5);
    assert_eq!(client.answer_until(None), [6, 7, 8, 9]);
    // A datagram that arrives after the acknowledgment must not undo the upload.
    client.send(7);
    let answers: Vec<_> = (0..50).flat_map(|_| client.tick()).filter(|m| matches!(m, MavMessage::MISSION_ACK(_))).collect();
    assert!(answers.is_empty(), "{answers:?}");
}
