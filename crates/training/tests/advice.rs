//! Sentences and moments for flights with planted mistakes.
#![allow(clippy::unwrap_used, reason = "a test")]

use spandrel_mavlink::telemetry::Timeline;
use spandrel_model::geodesy::LocalPlane;
use spandrel_model::scenario::{PlacedDefect, Scenario, TaskKind};
use spandrel_model::site::Site;
use spandrel_monitor::assessment::flight_with_seed;
use spandrel_monitor::sidecar::build_site;
use spandrel_monitor::{AssessedSession, assess_log};
use spandrel_testkit::inspection::{phantom, record_inspection, two_bridges};
use spandrel_testkit::job::*;
use spandrel_text::Language;
use spandrel_training::advice::{
    AdvicePoint, FlightEvidence, MAX_POINTS, MissedDefect, SessionAdvice, session_advice, translation_languages,
};
use spandrel_training::plan::{DEFAULT_RULES, PlanReason, PlanRule, PlanRules, PlanStep, RuleMeasure, plan, read_rules};
use spandrel_training::record::{RecordSource, SessionRecord, SourceHashes, record};
use spandrel_training::report::{Review, SessionMetadata, advice_of, page};
use spandrel_training::testing::untranslated_word;

/// Tolerance for the time of a moment, s: the frame interval and the replay's sampling.
const MOMENT_TOLERANCE_S: f64 = 0.2;
/// Code of a contact with a bridge.
const BRIDGE: i32 = 1;

fn job() -> Scenario {
    let mut first = task(1, line((10.0, 0.0, 10.0), (60.0, 0.0, 10.0)), 3.0);
    first.kind = TaskKind::SlabSide;
    let mut second = task(2, line((60.0, 20.0, 10.0), (10.0, 20.0, 10.0)), 3.0);
    second.kind = TaskKind::PierCircle;
    scenario(vec![first, second])
}

fn rules() -> PlanRules {
    read_rules("rules.toml", DEFAULT_RULES).unwrap()
}

/// Flies both tasks. `spoil` runs in the middle of the second one.
fn flight(spoil: impl FnOnce(&mut Tape)) -> Tape {
    let mut tape = Tape::new();
    tape.hold(1.0);
    tape.fly((0.0, 0.0, 10.0), 2.0);
    tape.fly((60.0, 0.0, 10.0), 3.0);
    tape.fly((60.0, 20.0, 10.0), 3.0);
    tape.fly((35.0, 20.0, 10.0), 3.0);
    spoil(&mut tape);
    tape.fly((10.0, 20.0, 10.0), 3.0);
    tape.fly((0.0, 0.0, 10.0), 3.0);
    tape.land();
    tape
}

fn session_record(assessed_session: &AssessedSession, job: &Scenario, placed: &[PlacedDefect]) -> SessionRecord {
    record(&RecordSource {
        id: "a-session",
        trainee: "anna",
        purpose: None,
        started_unix_us: 1_000_000,
        spandrel_version: "0.1.0",
        scenario: job,
        vehicle: "test",
        hashes: &SourceHashes::of(b"s", b"v", b"t", b""),
        assessed_session,
        placed,
        answers: None,
    })
}

fn advice(tape: &Tape, missed: &[MissedDefect]) -> SessionAdvice {
    let job = job();
    let assessed_session = score_tape(tape, &job);
    let mut timeline = Timeline::new(LocalPlane::new(job.origin));
    timeline.push_log(tape.log(0).as_slice()).unwrap();
    let (flight, _) = flight_with_seed(&timeline, &job, &vehicle()).unwrap();
    let record = session_record(&assessed_session, &job, &[]);
    let steps = |language| plan(std::slice::from_ref(&record), &rules(), record.started_unix_us, language).unwrap().steps;
    let evidence = FlightEvidence {
        scenario: &job,
        vehicle: &vehicle(),
        flight: &flight,
        assessed_session: &assessed_session,
        record: &record,
        missed,
    };
    session_advice(steps, &rules(), &evidence, translation_languages())
}

fn point<'a>(advice: &'a SessionAdvice, rule: &str) -> &'a AdvicePoint {
    advice.points.iter().find(|point| point.rule == rule).unwrap_or_else(|| panic!("{rule}: {advice:#?}"))
}

/// Returns the time of the first frame that satisfies a condition, s since lift-off.
fn first_time_s(tape: &Tape, holds: impl Fn(&spandrel_mavlink::telemetry::Frame) -> bool) -> f64 {
    let frames = score_tape(tape, &job()).frames;
    let found = frames.iter().find(|frame| holds(frame)).unwrap();
    (found.time - frames[0].time).s()
}

fn clock(t_s: f64) -> String {
    spandrel_training::report::formatting::clock(t_s)
}

#[test]
fn exact_clean_flight_has_no_points() {
    let advice = advice(&flight(|_| ()), &[]);
    assert_eq!(advice.points, [], "{advice:#?}");
    let sentences: Vec<&str> = advice.sentences().collect();
    assert_eq!(sentences.len(), 1);
    assert!(
        advice.next.is_some_and(|next| next.command == format!("spandrel train --trainee anna --scenario {}", next.scenario))
    );
}

#[test]
fn exact_crashes_are_listed_with_their_times() {
    let tape = flight(|tape| {
        for _ in 0..2 {
            tape.contact(BRIDGE);
            tape.hold(0.2);
            tape.contact(0);
            tape.hold(3.0);
        }
    });
    let advice = advice(&tape, &[]);
    let point = point(&advice, "crashes in one task");
    let t_s = first_time_s(&tape, |frame| frame.contact != spandrel_mavlink::contract::contact::ContactKind::None);
    let words = format!("You hit the bridge twice in task 2, at {} and {}: keep your distance.", clock(t_s), clock(t_s + 3.2));
    assert_eq!(point.words, words);
    assert_eq!(point.drill, "drill-orbit");
    assert!((point.t_s - t_s).abs() < 3.2 + MOMENT_TOLERANCE_S, "{point:?} {t_s}");
    let frames = score_tape(&tape, &job()).frames;
    assert_eq!(frames[point.frame as usize - 1].index, point.frame);
}

#[test]
fn exact_speeding_states_speed_limit_and_moment() {
    // Back and forth along the second path.
    let tape = flight(|tape| {
        tape.fly((60.0, 20.0, 10.0), 7.0);
        tape.fly((12.0, 20.0, 10.0), 7.0);
        tape.fly((35.0, 20.0, 10.0), 3.0);
    });
    let advice = advice(&tape, &[]);
    let point = point(&advice, "too fast in one task");
    let t_s = first_time_s(&tape, |frame| frame.speed_m_s() > 4.5);
    assert!(point.words.starts_with("You flew up to 7.0 m/s in task 2, over the 4.5 m/s limit for "), "{}", point.words);
    assert!(point.words.ends_with(&format!("from {}: slow down.", clock(point.t_s))), "{}", point.words);
    assert!((point.t_s - t_s).abs() < MOMENT_TOLERANCE_S, "{point:?} {t_s}");
}

#[test]
fn exact_deviation_states_distance_and_the_longest_stretch() {
    let tape = flight(|tape| {
        tape.fly((35.0, 25.0, 10.0), 2.0);
        tape.hold(10.0);
        tape.fly((35.0, 20.0, 10.0), 2.0);
    });
    let advice = advice(&tape, &[]);
    let point = point(&advice, "off the path in one task");
    let t_s = first_time_s(&tape, |frame| frame.position_m.north() > 23.0);
    // 10 s at 5 m, and 1 s each on the way out and back.
    let words = format!("You left the path in task 2 for 12 s from {}, up to 5.0 m away: return before you go on.", clock(t_s));
    assert_eq!(point.words, words);
    assert!((point.t_s - t_s).abs() < MOMENT_TOLERANCE_S, "{point:?} {t_s}");
}

#[test]
fn exact_tasks_not_flown_point_to_the_end() {
    let mut tape = Tape::new();
    tape.hold(1.0);
    tape.fly((0.0, 0.0, 10.0), 2.0);
    tape.fly((60.0, 0.0, 10.0), 3.0);
    tape.fly((0.0, 0.0, 10.0), 3.0);
    tape.land();
    let advice = advice(&tape, &[]);
    let last_s = score_tape(&tape, &job()).assessment.end.seconds;
    let point = point(&advice, "task not attempted");
    assert!(point.words.starts_with("You did not fly task 2: the flight ended at "), "{}", point.words);
    assert!((point.t_s - last_s).abs() < MOMENT_TOLERANCE_S, "{point:?} {last_s}");
}

/// Returns a plan with one step whose only reason is a rule.
fn step_for(rule: &PlanRule) -> PlanStep {
    let reason = PlanReason {
        rule: rule.name.clone(),
        session: "a-session".into(),
        words: "Rule without a moment.".into(),
        value: 9.0,
        limit: rule.limit,
        tasks: if matches!(rule.measure, RuleMeasure::Task(_)) { vec![1, 2] } else { Vec::new() },
        consequence_of: None,
    };
    PlanStep { scenario: rule.scenario.clone(), urgency: 1.0, reasons: vec![reason], level: None }
}

#[test]
fn prop_every_rule_has_a_sentence_with_a_number_and_a_moment() {
    let (job, mut tape) = (two_bridges(), record_inspection(&two_bridges(), 240.0, 6));
    tape.battery(12);
    tape.hold(1.0);
    let log = tape.log(0);
    let mut timeline = Timeline::new(LocalPlane::new(job.origin));
    timeline.push_log(log.as_slice()).unwrap();
    let (flight, _) = flight_with_seed(&timeline, &job, &phantom()).unwrap();
    let assessed_session = assess_log(log.as_slice(), &job, &phantom(), build_site).unwrap();
    let site = Site::build(&job, assessed_session.seed);
    let record = session_record(&assessed_session, &job, site.defects());
    let missed: Vec<MissedDefect> = record
        .defects
        .iter()
        .filter(|defect| !defect.found)
        .map(|defect| MissedDefect { id: defect.id, t_s: 100.0, in_view_s: 4.5 * f64::from(defect.id % 2), nearest_m: 3.0 })
        .collect();
    let (vehicle, rules) = (phantom(), rules());
    let evidence = FlightEvidence {
        scenario: &job,
        vehicle: &vehicle,
        flight: &flight,
        assessed_session: &assessed_session,
        record: &record,
        missed: &missed,
    };
    let end_s = assessed_session.assessment.end.seconds;
    let mut with_moment = 0;
    for rule in &rules.rules {
        let languages = [Language::German, Language::Spanish, Language::Pseudo];
        let advice = session_advice(|_| vec![step_for(rule)], &rules, &evidence, languages.into_iter());
        let in_language = |language| advice.in_language(language).points[0].words.clone();
        let [point] = advice.points.as_slice() else { panic!("{}: {advice:#?}", rule.name) };
        println!("{:32} {}", rule.name, point.words);
        assert!((0.0..=end_s + MOMENT_TOLERANCE_S).contains(&point.t_s) && point.frame >= 1, "{point:?}");
        assert!(point.words.ends_with('.') && !point.words.contains("NaN") && !point.words.contains("inf"), "{point:?}");
        if !point.words.starts_with("Rule without") {
            with_moment += 1;
            assert_translated(&rule.name, Language::ALL.map(in_language), &in_language(Language::Pseudo));
            assert!(point.words.chars().any(|c| c.is_ascii_digit()), "{point:?}");
        }
    }
    assert!(with_moment > rules.rules.len() / 3, "{with_moment} of {} rules", rules.rules.len());
}

/// Checks that a sentence differs between the languages, and that the pseudo language leaves only units in plain letters.
fn assert_translated(rule: &str, [english, german, spanish]: [String; 3], pseudo: &str) {
    assert!(german != english && spanish != english && german != spanish, "{rule}: {english} {german} {spanish}");
    assert_eq!(untranslated_word(pseudo, &["s", "min"]), None, "{rule}: {pseudo}");
}

#[test]
fn prop_advice_of_an_inspection_matches_its_report() {
    let (job, metadata) = (two_bridges(), SessionMetadata { trainee: "anna".into(), ..SessionMetadata::default() });
    for picture_every in [6, 9] {
        let tape = record_inspection(&job, 240.0, picture_every);
        let log = tape.log(0);
        let review = Review::of(&log, &job, &phantom(), metadata.clone()).unwrap();
        assert_eq!(advice_of(&log, &job, &phantom(), &metadata).unwrap(), review.advice);
        let german = SessionMetadata { language: Language::German, ..metadata.clone() };
        let german = Review::of(&log, &job, &phantom(), german).unwrap();
        assert_eq!(german.advice, review.advice, "the file does not depend on the report's language");
        let sentence = &review.advice.points[0].translations["de"];
        assert!(*sentence != review.advice.points[0].words && page::session(&german).contains(sentence), "{sentence}");
        assert_ne!(german.next[0].reasons[0].words, review.next[0].reasons[0].words, "the plan is in the report's language");
        let points = &review.advice.points;
        assert!((1..=MAX_POINTS).contains(&points.len()), "{points:#?}");
        for point in points {
            assert!((review.t_s(point.frame as usize - 1) - point.t_s).abs() < 1e-9, "{point:?}");
            assert!(point.words.ends_with('.') && point.words.chars().any(|c| c.is_ascii_digit()), "{point:?}");
        }
        let page = page::session(&review);
        let link = format!("class=\"moment-link\" href=\"#flight\" data-t=\"{:.2}\"", points[0].t_s);
        assert!(page.contains(&link), "{link}");
        assert!(page.find(&points[0].words).unwrap() < page.find("<h2 id=\"scores-head\"").unwrap());
        let missed = review.defects.iter().filter(|defect| defect.found_by.is_none()).count();
        let defects = page.split("<h3>Missed defects</h3>").nth(1).unwrap().split("<details").next().unwrap();
        assert_eq!(defects.matches("moment-link").count(), missed, "every missed defect links to its moment");
    }
}
