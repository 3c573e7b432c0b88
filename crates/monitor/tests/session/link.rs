//! Tests of bad links: lost, duplicated, reordered and truncated datagrams.

use spandrel_mavlink::telemetry::{Timeline, tlog};
use spandrel_model::geodesy::LocalPlane;
use spandrel_model::random::RandomStream;
use spandrel_monitor::assessment::{AssessError, AssessedSession, assess_log};
use spandrel_testkit::job::*;

fn score_tape(datagrams: &[Vec<u8>]) -> AssessedSession {
    assess_log(&log_of(datagrams, 5_000_000), &one_task(), &vehicle(), test_survey).unwrap()
}

fn busy_flight() -> Tape {
    busy_flight_at(0)
}

fn busy_flight_at(epoch_ms: u64) -> Tape {
    let mut tape = Tape::starting_at(epoch_ms, &scenario(Vec::new()));
    tape.fly((0.0, 0.0, 10.0), 2.0);
    for k in 0..10 {
        tape.fly((5.0 * f64::from(k), 0.0, 10.0), 4.0);
        tape.battery(99 - k as i8);
        tape.clearance(4.0 - 0.2 * k as f32);
        tape.lamp(k % 2 == 0);
        tape.snapshot(k);
        tape.contact(k % 3);
        tape.hold(0.1);
        tape.contact(0);
        tape.int("hits", k);
    }
    tape.land();
    tape
}

fn counts(datagrams: &[Vec<u8>]) -> spandrel_mavlink::telemetry::timeline::LinkCounts {
    let mut timeline = Timeline::new(LocalPlane::new(one_task().origin));
    datagrams.iter().for_each(|datagram| {
        timeline.push(datagram);
    });
    timeline.counts()
}

/// Simulation time at which a 32-bit millisecond counter wraps to zero.
const COUNTER_WRAP_MS: u64 = 1 << 32;

#[test]
fn regress_flight_continues_across_32_bit_millisecond_wrap() {
    let epoch_ms = COUNTER_WRAP_MS - 10_000;
    let flights = [0, epoch_ms].map(|epoch_ms| {
        let tape = busy_flight_at(epoch_ms);
        assert!(tape.now_ms > 20_000, "the clock wraps during the flight");
        let mut timeline = Timeline::new(LocalPlane::new(one_task().origin));
        tape.datagrams.iter().for_each(|datagram| {
            timeline.push(datagram);
        });
        let flight = timeline.flight(0);
        let ms = |times: Vec<i64>| -> Vec<i64> { times.into_iter().map(|ms| ms - epoch_ms.cast_signed()).collect() };
        let pictures = ms(flight.snapshots.all().iter().map(|picture| picture.0.ms()).collect());
        let lamp = ms(flight.light.all().iter().map(|lamp| lamp.0.ms()).collect());
        let sticks = ms(flight.sticks.all().iter().map(|sticks| sticks.0.ms()).collect());
        (pictures, lamp, sticks, timeline.epoch_count())
    });
    assert_eq!(flights[0].0.len(), 10, "every picture counts once");
    assert_eq!(flights[1], flights[0]);
}

#[test]
fn prop_reordered_and_duplicate_datagrams_change_no_frame() {
    let tape = busy_flight();
    let clean = score_tape(&tape.datagrams);
    for seed in 0..20 {
        let mut stream = RandomStream::new(seed, "link");
        let mut datagrams = Vec::new();
        for datagram in &tape.datagrams {
            datagrams.push(datagram.clone());
            if stream.below(10) == 0 {
                datagrams.push(datagram.clone());
            }
        }
        for _ in 0..datagrams.len() / 4 {
            let at = stream.below(datagrams.len() - 8);
            datagrams.swap(at, at + 1 + stream.below(7));
        }
        let assessed_session = score_tape(&datagrams);
        let first = assessed_session.frames.iter().zip(&clean.frames).find(|(a, b)| a != b);
        assert_eq!(first, None, "seed {seed}");
        assert_eq!(assessed_session.frames.len(), clean.frames.len(), "seed {seed}");
        assert!(assessed_session.assessment == clean.assessment, "seed {seed}");
    }
}

#[test]
fn exact_link_statistics_match_faults() {
    let tape = busy_flight();
    let all = tape.datagrams.len() as u64;
    assert_eq!(counts(&tape.datagrams).frames, all);
    assert_eq!(counts(&tape.datagrams).lost, 0);

    let mut lossy = tape.datagrams.clone();
    lossy.drain(100..107);
    assert_eq!((counts(&lossy).lost, counts(&lossy).frames), (7, all - 7));

    let mut doubled = tape.datagrams.clone();
    doubled.insert(50, doubled[49].clone());
    assert_eq!((counts(&doubled).duplicated, counts(&doubled).frames), (1, all));

    let mut swapped = tape.datagrams.clone();
    swapped.swap(60, 61);
    let swapped = counts(&swapped);
    assert_eq!((swapped.reordered, swapped.lost), (1, 0));
}

#[test]
fn exact_long_loss_is_not_counted_as_reordering() {
    // Sequence numbers wrap at 256. No matter how many datagrams are lost, the next one received must not be treated as
    // old.
    let tape = busy_flight();
    let whole = score_tape(&tape.datagrams).frames;
    for lost in [60, 100, 129, 200, 255, 256, 300] {
        let mut datagrams = tape.datagrams.clone();
        datagrams.drain(700..700 + lost);
        let counts = counts(&datagrams);
        assert_eq!((counts.duplicated, counts.reordered), (0, 0), "{lost} lost");
        assert_eq!(score_tape(&datagrams).frames.len(), whole.len(), "{lost} lost");
    }
}

#[test]
fn exact_truncated_log_scores_its_complete_records() {
    let log = busy_flight().log(5_000_000);
    for cut in log.len() - 120..log.len() {
        let whole = tlog::complete_len(&log[..cut]);
        let a = assess_log(&log[..cut], &one_task(), &vehicle(), test_survey).unwrap();
        let b = assess_log(&log[..whole], &one_task(), &vehicle(), test_survey).unwrap();
        assert!(a == b, "cut at {cut}");
    }
}

#[test]
fn exact_wrong_scenario_or_seed_is_rejected() {
    let tape = clean_flight();
    let mut other = one_task();
    other.crc = 1;
    let refused = assess_log(&tape.log(0), &other, &vehicle(), test_survey).unwrap_err();
    assert_eq!(refused, AssessError::OtherScenario { name: "test-job".to_owned(), received: CRC, expected: 1 });
    let mut seeded = one_task();
    seeded.seed = Some(8);
    let refused = assess_log(&tape.log(0), &seeded, &vehicle(), test_survey).unwrap_err();
    assert_eq!(refused, AssessError::OtherSeed { received: SEED, expected: 8 });
    assert!(refused.to_string().contains("uses seed 7"));
}

#[test]
fn exact_foreign_files_and_logs_without_truth_or_flight_have_distinct_errors() {
    use spandrel_mavlink::codec::Encoder;
    use spandrel_mavlink::dialect::{HEARTBEAT_DATA, MavMessage};
    use spandrel_mavlink::telemetry::tlog;
    let refused = |log: &[u8]| assess_log(log, &one_task(), &vehicle(), test_survey).unwrap_err();
    // A frame of an unknown message, whose checksum can't be verified, doesn't prove that the file is a telemetry log.
    let unknown = tlog::record(0, &[0xFD, 1, 0, 0, 0, 1, 1, 0xFF, 0xFF, 0xFF, 0, 0, 0]);
    for foreign in [&b""[..], b"time,x,y\n0.0,1.0,2.0\n", &unknown] {
        assert_eq!(refused(foreign), AssessError::NotTelemetry, "{foreign:?}");
    }
    let beat = Encoder::new(1, 1).encode(&MavMessage::HEARTBEAT(HEARTBEAT_DATA::default()));
    assert_eq!(refused(&tlog::record(0, &beat)), AssessError::NoTruth);
    let mut parked = Tape::new();
    parked.hold(3.0);
    assert_eq!(refused(&parked.log(0)), AssessError::NeverFlown);
}

#[test]
fn exact_messages_of_other_systems_are_ignored() {
    use spandrel_mavlink::codec::Encoder;
    use spandrel_mavlink::dialect::*;
    let mut monitor = crate::live::new_monitor(one_task());
    let tape = clean_flight();
    let mut stranger = Encoder::new(255, 190);
    let int = |name: &str, value| MavMessage::NAMED_VALUE_INT(NAMED_VALUE_INT_DATA { time_boot_ms: 0, value, name: name.into() });
    let truth = MavMessage::HIL_STATE_QUATERNION(HIL_STATE_QUATERNION_DATA {
        attitude_quaternion: [1.0, 0.0, 0.0, 0.0],
        ..HIL_STATE_QUATERNION_DATA::default()
    });
    let words = [int("seed", 99), int("scn_crc", 1), int("contact", 5), truth.clone(), truth.clone(), truth];
    for (k, datagram) in tape.datagrams.iter().enumerate() {
        monitor.handle_datagram(datagram);
        if k == tape.datagrams.len() / 2 {
            words.iter().for_each(|word| monitor.handle_datagram(&stranger.encode(word)));
            assert_eq!((monitor.refused(), monitor.cues()), (None, 0));
        }
    }
    let outcome = monitor.finished().expect("landed").clone().expect("scored");
    assert_eq!(outcome.assessment.end.reason, spandrel_monitor::session::EndReason::Landed);
    assert_eq!((monitor.link().restarts, outcome.frames.len()), (0, score_tape(&tape.datagrams).frames.len()));
}
