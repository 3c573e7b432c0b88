//! Tests of the conversion from datagrams to frames and scores: gaps, respawns, contacts, windows and session ends.

use spandrel_mavlink::contract::contact::ContactKind;
use spandrel_mavlink::telemetry::Timeline;
use spandrel_model::frames::{Enu, Vec3};
use spandrel_model::geodesy::LocalPlane;
use spandrel_model::scenario::{PlacedDefect, Scenario};
use spandrel_model::site::{CameraPose, DefectView};
use spandrel_model::time::SimTime;
use spandrel_model::vehicle::{Camera, Lamp};
use spandrel_monitor::assessment::assess_log;
use spandrel_monitor::measures::attention::SiteSurvey;
use spandrel_monitor::session::EndReason;
use spandrel_testkit::job::*;

#[test]
fn exact_clean_flight_has_full_score_and_ends_at_touchdown() {
    let assessed_session = score_tape(&clean_flight(), &one_task());
    let assessment = &assessed_session.assessment;
    assert_eq!(assessment.end.reason, EndReason::Landed);
    assert!(!assessment.end.battery_failed);
    assert_eq!(assessment.scores.conformity.unwrap().pct, 100.0);
    assert_eq!(assessment.scores.efficiency.pct, 100.0);
    assert_eq!(assessment.scores.safety.pct, 100.0);
    assert_eq!(assessment.scores.accuracy.unwrap().pct, 0.0);
    assert_eq!(assessment.scores.overall, 300.0);
    let last = assessed_session.frames.last().unwrap();
    assert_eq!(last.speed_m_s(), 0.0);
    let before = &assessed_session.frames[assessed_session.frames.len() - 2];
    assert!(before.speed_m_s() > 0.0, "the session ends with the first frame at rest");
    assert_eq!(assessed_session.frames[0].index, 1);
    assert!(assessed_session.frames[0].position_m.up() > 0.3);
    assert_eq!(assessment.end.seconds, assessed_session.frames.len() as f64 / RATE_HZ);
}

#[test]
fn exact_short_gaps_are_interpolated_and_long_gaps_stay_missing() {
    // Each case lists the gap (ms), interpolated frames and missing frames. Frames are 40 ms apart, and truth messages
    // are 20 ms apart.
    for (ms, interpolated, missing) in [(200, 0, 0), (240, 5, 0), (1_000, 24, 0), (1_040, 0, 25)] {
        let mut tape = Tape::new();
        tape.fly((0.0, 0.0, 10.0), 2.0);
        while !(u64::from(tape.now_ms) - 80).is_multiple_of(40) {
            tape.hold(0.02);
        }
        tape.hold_unrecorded(ms - 20);
        tape.hold(0.5);
        tape.land();
        let assessed_session = score_tape(&tape, &one_task());
        let telemetry = assessed_session.assessment.telemetry;
        let got = (telemetry.interpolated_frames, telemetry.missing_frames);
        // Frame sampling starts at lift-off, so the gap may contain one frame more or fewer.
        assert!(got.0.abs_diff(interpolated) <= 1 && got.1.abs_diff(missing) <= 1, "{ms} ms: {got:?}");
        assert_eq!(telemetry.gaps, usize::from(ms > 200));
        assert_eq!(got.0 == 0, interpolated == 0, "{ms} ms");
        assert_eq!(got.1 == 0, missing == 0, "{ms} ms");
    }
}

#[test]
fn exact_missing_frames_repeat_position_without_contact() {
    let mut tape = Tape::new();
    tape.fly((0.0, 0.0, 10.0), 2.0);
    tape.contact(1);
    tape.hold(0.2);
    let held = tape.at_m;
    tape.hold_unrecorded(3_000);
    tape.at_m = held + spandrel_model::frames::Vec3::new(4.0, 0.0, 0.0);
    tape.contact(0);
    tape.hold(1.0);
    let assessed_session = score_tape(&tape, &one_task());
    let missing: Vec<_> = assessed_session.frames.iter().filter(|frame| frame.missing).collect();
    assert!(missing.len() >= 74);
    for frame in missing {
        assert!((frame.position_m - held).norm() < 0.02, "the last position is repeated");
        assert_eq!(frame.contact, ContactKind::None);
    }
}

#[test]
fn exact_frames_are_not_interpolated_across_respawn() {
    let mut tape = Tape::new();
    tape.fly((0.0, 0.0, 10.0), 2.0);
    tape.fly((30.0, 0.0, 10.0), 4.0);
    let crashed = tape.at_m;
    tape.hold_unrecorded(400);
    tape.int("respawns", 1);
    tape.at_m = spandrel_model::frames::Vec3::new(28.0, 0.0, 12.0);
    let put_back = tape.at_m;
    tape.hold(1.0);
    let assessed_session = score_tape(&tape, &one_task());
    let near = |p: spandrel_model::frames::Vec3<spandrel_model::frames::Enu>, q| (p - q).norm() < 0.02;
    let between = assessed_session.frames.iter().filter(|f| f.time.ms() > i64::from(tape.now_ms) - 1_400);
    for frame in between {
        assert!(near(frame.position_m, crashed) || near(frame.position_m, put_back), "{frame:?}");
    }
}

/// A rewind by less than a jump is no movement either: the number of rewinds alone shows it.
#[test]
fn exact_frames_are_not_interpolated_across_a_short_rewind() {
    let mut tape = Tape::new();
    tape.fly((0.0, 0.0, 10.0), 2.0);
    tape.fly((30.0, 0.0, 10.0), 4.0);
    let flown = tape.at_m;
    tape.hold_unrecorded(60);
    tape.int("rewinds", 1);
    tape.at_m = flown + spandrel_model::frames::Vec3::new(-1.0, 0.0, 0.0);
    let put_back = tape.at_m;
    tape.hold(1.0);
    let assessed_session = score_tape(&tape, &one_task());
    let near = |p: spandrel_model::frames::Vec3<spandrel_model::frames::Enu>, q| (p - q).norm() < 0.02;
    let frames: Vec<_> = assessed_session.frames.iter().filter(|f| f.time.ms() > i64::from(tape.now_ms) - 1_060).collect();
    assert!(
        frames.iter().any(|frame| near(frame.position_m, flown)) && frames.iter().any(|frame| near(frame.position_m, put_back))
    );
    for frame in frames {
        assert!(near(frame.position_m, flown) || near(frame.position_m, put_back), "{frame:?}");
    }
}

#[test]
fn exact_empty_battery_ends_session_before_respawn() {
    let mut tape = Tape::new();
    tape.fly((0.0, 0.0, 10.0), 2.0);
    tape.fly((30.0, 0.0, 10.0), 4.0);
    tape.contact(3);
    tape.hold(2.0);
    tape.battery(0);
    tape.hold(1.0);
    tape.int("respawns", 1);
    tape.contact(0);
    tape.at_m = spandrel_model::frames::Vec3::new(28.0, 0.0, 12.0);
    tape.hold(5.0);
    let assessed_session = score_tape(&tape, &one_task());
    assert_eq!(assessed_session.assessment.end.reason, EndReason::Battery);
    assert!(assessed_session.assessment.end.battery_failed);
    assert_eq!(assessed_session.assessment.scores.efficiency.pct, 0.0);
    assert!((assessed_session.frames.last().unwrap().position_m.east() - 30.0).abs() < 0.02);
}

#[test]
fn exact_empty_battery_after_landing_does_not_count() {
    let mut tape = Tape::new();
    tape.fly((0.0, 0.0, 10.0), 2.0);
    tape.fly((0.0, 0.0, 0.15), 0.8);
    tape.hold(1.0);
    tape.battery(0);
    tape.hold(4.0);
    assert_eq!(score_tape(&tape, &one_task()).assessment.end.reason, EndReason::Landed);
}

#[test]
fn exact_session_ends_at_time_limit() {
    let mut tape = Tape::new();
    tape.fly((0.0, 0.0, 10.0), 2.0);
    tape.hold(1_510.0);
    let end = score_tape(&tape, &one_task()).assessment.end;
    assert_eq!(end.reason, EndReason::TimeLimit);
    assert_eq!(end.frames, (1_500.0 * RATE_HZ) as usize + 1);
    assert!(end.battery_failed);
}

#[test]
fn exact_hitting_person_or_vehicle_ends_session() {
    for (code, reason, person, car) in [(5, EndReason::Person, 1, 0), (4, EndReason::Vehicle, 0, 1)] {
        let mut tape = Tape::new();
        tape.fly((0.0, 0.0, 10.0), 2.0);
        tape.contact(code);
        tape.hold(2.0);
        tape.contact(0);
        tape.land();
        let assessment = score_tape(&tape, &one_task()).assessment;
        assert_eq!(assessment.end.reason, reason);
        assert_eq!((assessment.crashes.person, assessment.crashes.vehicle), (person, car));
        assert_eq!(assessment.scores.safety.pct, 0.0);
        assert!(!assessment.certification.gates.no_person_or_vehicle_hit);
    }
}

#[test]
fn exact_long_contact_is_one_crash_and_short_contact_is_not_lost() {
    let mut tape = Tape::new();
    tape.fly((0.0, 0.0, 10.0), 2.0);
    tape.contact(1);
    tape.hold(1.0);
    tape.contact(0);
    tape.hold(1.0);
    // The contact starts and ends between two truth messages, so it is shorter than a frame.
    tape.contact(2);
    tape.int("hits", 2);
    tape.contact(0);
    tape.hold(1.0);
    // Both messages for a contact are lost. Only the contact count shows that it happened.
    tape.int("hits", 3);
    tape.land();
    let assessed_session = score_tape(&tape, &one_task());
    assert_eq!(assessed_session.assessment.crashes.other, 3);
    assert_eq!(assessed_session.assessment.scores.safety.pct, 91.0);
    let with = |contact| assessed_session.frames.iter().filter(|frame| frame.contact == contact).count();
    assert_eq!((with(ContactKind::Bridge) > 20, with(ContactKind::Terrain), with(ContactKind::Other)), (true, 1, 1));
    assert_eq!(assessed_session.assessment.crashes.by_task["outside"], 3);
}

#[test]
fn exact_only_hard_pad_contact_is_a_crash() {
    for (speed, crashes) in [(0.8, 0), (1.4, 1)] {
        let mut tape = Tape::new();
        tape.fly((0.0, 0.0, 3.0), 2.0);
        tape.fly((0.0, 0.0, 0.15), speed);
        tape.contact(2);
        tape.hold(4.0);
        let assessed_session = score_tape(&tape, &one_task());
        assert_eq!(assessed_session.assessment.crashes.other, crashes, "{speed} m/s");
        assert_eq!(assessed_session.assessment.end.reason, EndReason::Landed);
        if crashes == 0 {
            assert!(assessed_session.frames.iter().all(|frame| frame.contact == ContactKind::None));
        }
    }
}

#[test]
fn exact_soft_ground_contact_away_from_home_is_a_crash() {
    let mut tape = Tape::new();
    tape.fly((0.0, 0.0, 3.0), 2.0);
    tape.fly((20.0, 0.0, 3.0), 2.0);
    tape.fly((20.0, 0.0, 0.15), 0.5);
    tape.contact(2);
    tape.hold(5.0);
    let assessment = score_tape(&tape, &one_task()).assessment;
    assert_eq!(assessment.crashes.other, 1);
    assert_eq!(assessment.end.reason, EndReason::Abort, "resting elsewhere is not a landing");
}

#[test]
fn exact_overlap_counts_for_task_with_smaller_relative_distance() {
    let wide = task(1, line((10.0, 0.0, 10.0), (60.0, 0.0, 10.0)), 6.0);
    let narrow = task(2, line((10.0, 2.0, 10.0), (60.0, 2.0, 10.0)), 2.0);
    let scenario = scenario(vec![wide, narrow]);
    let mut tape = Tape::new();
    tape.fly((0.0, 0.5, 10.0), 2.0);
    tape.fly((60.0, 0.5, 10.0), 4.0);
    tape.fly((60.0, 2.0, 10.0), 1.0);
    tape.fly((10.0, 2.0, 10.0), 4.0);
    tape.land();
    let assessment = score_tape(&tape, &scenario).assessment;
    let [one, two] = assessment.tasks[..] else { panic!("two tasks") };
    assert!(one.attempted && two.attempted);
    assert!(one.on_path < 1.0, "task 1's window contains frames that belong to task 2");
    assert_eq!(two.on_path, 1.0);
}

#[test]
fn exact_unentered_task_has_no_window() {
    let mut scenario = one_task();
    scenario.tasks.push(task(2, line((10.0, 90.0, 10.0), (60.0, 90.0, 10.0)), 3.0));
    let assessment = score_tape(&clean_flight(), &scenario).assessment;
    let skipped = assessment.tasks[1];
    assert_eq!((skipped.attempted, skipped.first_frame, skipped.last_frame), (false, None, None));
    assert_eq!((skipped.on_path, skipped.speeding), (0.0, 0.0));
    assert_eq!(assessment.certification.flags, ["not_attempted:2"]);
    assert_eq!(assessment.certification.scores.efficiency, 0.0);
    assert_eq!(assessment.scores.efficiency.pct, 100.0);
}

#[test]
fn exact_certification_has_no_evidence_if_no_task_was_entered() {
    let mut tape = Tape::new();
    tape.fly((0.0, 0.0, 3.0), 2.0);
    tape.land();
    let assessment = score_tape(&tape, &one_task()).assessment;
    assert_eq!(assessment.scores.conformity.unwrap().pct, 50.0);
    assert_eq!(assessment.certification.scores.conformity, None);
    assert!(assessment.certification.flags.contains(&"no_evidence".to_owned()));
    assert!(!assessment.certification.passed);
}

#[test]
fn exact_short_path_visit_earns_no_certification_credit() {
    let mut tape = Tape::new();
    tape.fly((0.0, 0.0, 10.0), 2.0);
    tape.fly((9.0, 0.0, 10.0), 4.0);
    tape.land();
    let assessment = score_tape(&tape, &one_task()).assessment;
    assert_eq!(assessment.scores.conformity.unwrap().pct, 100.0);
    let covered = &assessment.certification.tasks[0];
    assert!(covered.coverage < 0.1, "{}", covered.coverage);
    assert!(assessment.certification.scores.conformity.unwrap() < 55.0);
}

#[test]
fn exact_pictures_count_once_and_dark_pictures_have_a_reason() {
    let mut tape = Tape::new();
    tape.fly((0.0, 0.0, 10.0), 2.0);
    tape.fly((20.0, 0.0, 10.0), 4.0);
    tape.snapshot(0);
    tape.hold(1.0);
    tape.lamp(true);
    tape.hold(1.0);
    tape.snapshot(1);
    let taken_ms = tape.now_ms;
    tape.hold(1.0);
    tape.snapshot(2);
    tape.fly((25.0, 0.0, 10.0), 4.0);
    tape.snapshot(3);
    // Much later, the camera resends the message for a picture whose first message was lost.
    tape.snapshot_at(1, taken_ms);
    tape.land();
    let snapshots = score_tape(&tape, &one_task()).assessment.snapshots;
    assert_eq!((snapshots.taken, snapshots.hits, snapshots.defects_found, snapshots.defects_placed), (4, 1, 1, 10));
    let [why] = &snapshots.each[0].views[0].fails[..] else { panic!("{:?}", snapshots.each[0]) };
    assert!(why.starts_with("too dark: lamp off"), "{why}");
    assert_eq!(snapshots.each[1].found, [2]);
    assert!(snapshots.each[2].views[0].shown && !snapshots.each[2].hit, "an earlier picture shows the defect");
    assert!(snapshots.each[3].views.is_empty());
}

#[test]
fn exact_simulator_restart_in_flight_ends_session_and_keeps_frames() {
    let mut tape = Tape::new();
    tape.fly((0.0, 0.0, 10.0), 2.0);
    tape.fly((60.0, 0.0, 10.0), 4.0);
    let flown = tape.now_ms;
    let again = clean_flight();
    tape.datagrams.extend(again.datagrams);
    let mut timeline = Timeline::new(LocalPlane::new(one_task().origin));
    timeline.push_log(&tape.log(0)).unwrap();
    assert_eq!((timeline.epoch_count(), timeline.counts().restarts), (2, 1));
    let flown_before = [0, 1].map(|epoch| timeline.elapsed_before_epoch(epoch).ms());
    assert_eq!(flown_before, [0, i64::from(flown)]);
    let assessed_session = score_tape(&tape, &one_task());
    assert_eq!(assessed_session.assessment.end.reason, EndReason::Restart);
    assert_eq!(assessed_session.frames.last().unwrap().time.ms() / 40, i64::from(flown) / 40);
    assert_eq!(assessed_session.assessment.tasks[0].on_path, 1.0);
}

/// A site with defects visible only in pictures with a narrow field of view.
#[derive(Debug)]
struct NarrowViewSite(TestSurvey);

impl SiteSurvey for NarrowViewSite {
    fn defects(&self) -> &[PlacedDefect] {
        &self.0.defects
    }
    fn view_defects(&self, pose: &CameraPose, camera: &Camera, lamp: &Lamp, at: SimTime) -> Vec<DefectView> {
        let narrow = camera.hfov_rad < 0.5;
        self.0
            .view_defects(pose, camera, lamp, at)
            .into_iter()
            .map(|view| DefectView { hit: view.hit && narrow, ..view })
            .collect()
    }
    fn nearest_object_name(&self, _: Vec3<Enu>, _: f64, _: SimTime) -> Option<String> {
        None
    }
}

#[test]
fn exact_pictures_use_reported_field_of_view() {
    let mut tape = Tape::new();
    tape.fly((0.0, 0.0, 10.0), 2.0);
    tape.lamp(true);
    tape.fly((10.0, 0.0, 10.0), 4.0);
    tape.snapshot(0);
    tape.hold(1.0);
    tape.field_of_view(20.0);
    tape.snapshot(1);
    tape.fly((20.0, 0.0, 10.0), 4.0);
    tape.hold(1.0);
    // Invalid fields of view are ignored.
    tape.field_of_view(f32::NAN);
    tape.field_of_view(0.0);
    tape.snapshot(2);
    tape.hold(1.0);
    tape.field_of_view(vehicle().camera.hfov_rad.to_degrees() as f32);
    tape.fly((30.0, 0.0, 10.0), 4.0);
    tape.snapshot(3);
    tape.land();
    let build =
        |_: &Scenario, _: u64| -> std::sync::Arc<dyn SiteSurvey> { std::sync::Arc::new(NarrowViewSite(TestSurvey::of(10))) };
    let assessed_session = assess_log(&tape.log(1_000_000), &one_task(), &vehicle(), build).unwrap();
    let hits: Vec<bool> = assessed_session.assessment.snapshots.each.iter().map(|snapshot| snapshot.hit).collect();
    assert_eq!(hits, [false, true, true, false]);
}

#[test]
fn exact_nominal_field_of_view_leaves_camera_unchanged() {
    use spandrel_monitor::measures::attention::camera;
    let own = vehicle().camera;
    let mut timeline = Timeline::new(LocalPlane::new(one_task().origin));
    let mut tape = Tape::new();
    tape.fly((0.0, 0.0, 10.0), 2.0);
    tape.field_of_view(own.hfov_rad.to_degrees() as f32);
    tape.hold(0.5);
    tape.datagrams.iter().for_each(|datagram| {
        timeline.push(datagram);
    });
    let flight = timeline.flight(0);
    let end = SimTime::from_ms(i64::from(tape.now_ms));
    assert!(flight.field_of_view.at(end).is_some(), "the field of view was received");
    assert_eq!(camera(&flight, end, &own), own);
    assert_eq!(camera(&flight, SimTime::ZERO, &own), own);
}

#[test]
fn exact_pictures_with_reused_numbers_after_formatting_are_new() {
    let mut tape = Tape::new();
    tape.fly((0.0, 0.0, 10.0), 2.0);
    tape.lamp(true);
    tape.fly((10.0, 0.0, 10.0), 4.0);
    tape.snapshot(0);
    let taken_ms = tape.now_ms;
    tape.fly((20.0, 0.0, 10.0), 4.0);
    // Image numbers restart after the memory card is formatted.
    tape.snapshot(0);
    tape.hold(1.0);
    tape.snapshot_at(0, taken_ms);
    tape.land();
    let snapshots = score_tape(&tape, &one_task()).assessment.snapshots;
    assert_eq!((snapshots.taken, snapshots.hits), (2, 2));
}
