//! Tests of the comparison between the cues and the frames of a flight.

use crate::live::new_monitor;
use spandrel_monitor::SessionOutput;
use spandrel_monitor::measures::cue_validity::{CueLog, CueValidity};
use spandrel_testkit::job::*;

/// Leaves the path, lands at home, and compares the flight's cues with its frames. The monitor's own cues are ignored if `masks`
/// (time in s, cue mask) replace them.
fn validity(mut tape: Tape, masks: Option<&[(f64, i32)]>) -> CueValidity {
    tape.fly((60.0, 30.0, 10.0), 4.0);
    tape.fly((0.0, 30.0, 10.0), 4.0);
    tape.land();
    let mut monitor = new_monitor(one_task());
    let mut log = CueLog::default();
    for datagram in &tape.datagrams {
        monitor.handle_datagram(datagram);
        while let Some(record) = monitor.poll_record() {
            if let (SessionOutput::Event(line), None) = (record, masks) {
                log.add_event(&serde_json::from_str(&line).unwrap());
            }
        }
    }
    for (t_s, cues) in masks.into_iter().flatten() {
        log.add_event(&serde_json::json!({ "t_s": t_s, "event": "cues", "cues": cues }));
    }
    let session = monitor.finished().expect("landed").clone().expect("scored");
    CueValidity::measure(&log, &session.frames, &one_task())
}

/// Flies the path with a deviation of four seconds and 5 m at 30 m east. Returns the tape, and the time in s when the
/// deviation begins.
fn flight_with_deviation() -> (Tape, f64) {
    let mut tape = Tape::new();
    tape.hold(1.0);
    tape.fly((0.0, 0.0, 10.0), 2.0);
    tape.fly((30.0, 0.0, 10.0), 4.0);
    let from_s = f64::from(tape.now_ms) / 1_000.0;
    tape.fly((30.0, 5.0, 10.0), 4.0);
    tape.hold(4.0);
    tape.fly((30.0, 0.0, 10.0), 4.0);
    tape.fly((60.0, 0.0, 10.0), 4.0);
    (tape, from_s)
}

#[test]
fn regress_the_monitor_reports_a_deviation_and_nothing_else() {
    let (tape, _) = flight_with_deviation();
    let of = validity(tape, None);
    assert_eq!((of.off_path, of.off_path_outside, of.deviations, of.deviations_missed), (1, 0, 1, 0), "{of:?}");
    assert_eq!((of.texts, of.speeding, of.stand_off, of.too_close), (1, 0, 0, 0), "{of:?}");
}

#[test]
fn exact_missing_false_and_short_cues_are_counted() {
    use spandrel_mavlink::contract::cue::{OFF_PATH, SPEEDING, STAND_OFF};
    let (tape, from_s) = flight_with_deviation();
    let end_s = f64::from(tape.now_ms) / 1_000.0;
    let silent = validity(tape.clone(), Some(&[]));
    assert_eq!((silent.off_path, silent.deviations, silent.deviations_missed), (0, 1, 1));
    let stand_off = validity(tape.clone(), Some(&[(from_s + 2.0, STAND_OFF), (from_s + 3.0, 0)]));
    assert_eq!((stand_off.stand_off, stand_off.deviations_missed), (1, 0), "the stand-off cue also reports it");
    // The task ends where the drone leaves the path's end. Later cues are false.
    let masks = [(from_s + 2.0, OFF_PATH), (from_s + 3.0, 0), (end_s + 3.0, OFF_PATH | SPEEDING), (end_s + 3.9, OFF_PATH)];
    let late = validity(tape, Some(&masks));
    assert_eq!((late.off_path, late.off_path_outside, late.speeding, late.speeding_short), (2, 1, 1, 1));
}
