//! Flights with one planted fault each: every one must fail certification for that fault and no other.

use spandrel_model::math;
use spandrel_model::random::RandomStream;
use spandrel_model::scenario::Scenario;
use spandrel_monitor::score::certification::Certification;
use spandrel_monitor::score::completion::verdict;
use spandrel_testkit::job::*;
use spandrel_text::Language;

/// Length of the planted path, m. The ten defects of the test site are beside it, every 10 m.
const PATH_M: f64 = 100.0;
/// Speed between the stops, m/s.
const SPEED_M_S: f64 = 1.5;
/// Tolerance for coverage, as a fraction: half a point spacing at each end of the flown part.
const COVERAGE_TOLERANCE: f64 = 0.015;
/// Code of a contact with a bridge.
const BRIDGE: i32 = 1;

fn job() -> Scenario {
    scenario(vec![task(1, line((10.0, 0.0, 10.0), (10.0 + PATH_M, 0.0, 10.0)), 3.0)])
}

/// An inspection of the path with one possible fault.
#[derive(Clone, Copy)]
struct Inspection {
    /// Part of the path that is flown, m.
    to_m: f64,
    /// Distance kept from the path, m.
    off_m: f64,
    speed_m_s: f64,
    /// Whether the drone photographs the defects, and whether it stops to do so.
    photographs: bool,
    stops: bool,
    /// Standard deviation of the heading between the pictures, rad.
    yaw_noise_rad: f64,
    /// Contacts with the bridge, and the drone's speed during them, m/s.
    contacts: usize,
    contact_speed_m_s: f64,
    battery_pct: i8,
    lands: bool,
    /// Rewinds that the vehicle reports on the way.
    rewinds: i32,
}

const CLEAN: Inspection = Inspection {
    to_m: PATH_M,
    off_m: 0.0,
    speed_m_s: SPEED_M_S,
    photographs: true,
    stops: true,
    yaw_noise_rad: 0.0,
    contacts: 0,
    contact_speed_m_s: 0.0,
    battery_pct: 60,
    lands: true,
    rewinds: 0,
};

impl Inspection {
    fn fly(&self) -> Certification {
        let mut random = RandomStream::new(SEED, "yaw noise");
        let mut tape = Tape::new();
        tape.lamp(true);
        tape.hold(1.0);
        tape.fly((0.0, -self.off_m, 10.0), 2.0);
        let mut index = 0;
        for k in 0..=(self.to_m as u32) {
            tape.yaw_rad = self.yaw_noise_rad * random.normal();
            tape.fly((10.0 + f64::from(k), -self.off_m, 10.0), self.speed_m_s);
            if self.photographs && k % 10 == 0 && k < 100 {
                tape.yaw_rad = 0.0;
                tape.hold(if self.stops { 0.5 } else { 0.0 });
                tape.snapshot(index);
                tape.hold(if self.stops { 0.1 } else { 0.0 });
                index += 1;
            }
        }
        tape.yaw_rad = 0.0;
        (1..=self.rewinds).for_each(|count| tape.int("rewinds", count));
        self.collide(&mut tape);
        tape.battery(self.battery_pct);
        if self.lands {
            tape.fly((tape.at_m.east(), -30.0, 10.0), 4.0);
            tape.fly((0.0, -30.0, 10.0), 4.0);
            tape.land();
        }
        score_tape(&tape, &job()).assessment.certification
    }

    fn collide(&self, tape: &mut Tape) {
        // A contact's speed includes the frames just before it.
        tape.hold(0.5);
        for _ in 0..self.contacts {
            if self.contact_speed_m_s > 0.0 {
                tape.fly((tape.at_m.east() + 0.5, tape.at_m.north(), 10.0), self.contact_speed_m_s);
            }
            tape.contact(BRIDGE);
            tape.hold(0.2);
            tape.contact(0);
            tape.hold(1.5);
        }
    }
}

/// Returns the names of the unmet requirements.
fn unmet(certification: &Certification) -> Vec<&str> {
    certification.requirements.iter().filter(|one| !one.met).map(|one| one.id.as_str()).collect()
}

/// Checks that a flight fails for exactly these requirements, and that the headline names one of them.
fn assert_fails(inspection: &Inspection, wanted: &[&str]) -> Certification {
    let certification = inspection.fly();
    assert_eq!(unmet(&certification), wanted, "{:?}", certification.requirements);
    assert!(!certification.passed && !certification.unmet.is_empty());
    assert!(verdict(certification.passed, &certification.unmet, Language::English).starts_with("Not certified: "));
    certification
}

#[test]
fn regress_clean_flight_is_certified() {
    let certification = CLEAN.fly();
    assert!(certification.passed, "{:?}", certification.unmet);
    assert_eq!(verdict(certification.passed, &certification.unmet, Language::English), "Certified");
    let scores = certification.scores;
    assert_eq!((scores.conformity, scores.safety, scores.accuracy, scores.efficiency), (Some(100.0), 100.0, Some(100.0), 100.0));
    // The drone enters and leaves the path at an angle, which costs a little.
    assert!(scores.precision.unwrap() > 85.0 && scores.sum > 485.0 && scores.sum_max == 500.0, "{scores:?}");
}

#[test]
fn regress_half_of_the_path_is_not_certified() {
    let certification = assert_fails(&Inspection { to_m: 50.0, ..CLEAN }, &["tasks_done", "conformity"]);
    assert!(certification.unmet[0].starts_with("task 1 not done: "), "{:?}", certification.unmet);
}

#[test]
fn regress_conformity_is_at_most_60_if_49_percent_was_covered() {
    let certification = assert_fails(&Inspection { to_m: 49.0, ..CLEAN }, &["tasks_done", "conformity"]);
    let coverage = certification.tasks[0].coverage;
    assert!((coverage - 0.49).abs() <= COVERAGE_TOLERANCE, "{coverage}");
    assert!(certification.scores.conformity.unwrap() <= 60.0, "{:?}", certification.scores);
}

#[test]
fn regress_two_percent_of_the_path_is_not_inspected() {
    let certification = assert_fails(&Inspection { to_m: 2.0, ..CLEAN }, &["tasks_done", "conformity", "accuracy"]);
    assert_eq!(certification.flags, ["not_inspected:1"]);
    assert_eq!(certification.scores.conformity, Some(0.0));
}

#[test]
fn regress_flight_4_m_off_the_path_is_not_certified() {
    let wanted = ["tasks_done", "conformity", "precision"];
    let certification = assert_fails(&Inspection { off_m: 4.0, ..CLEAN }, &wanted);
    assert_eq!(certification.unmet[..2], ["task 1 not attempted", "no evidence for conformity"]);
    assert_eq!((certification.scores.conformity, certification.scores.precision), (None, None));
}

#[test]
fn regress_flight_with_22_crashes_is_not_certified() {
    let certification = assert_fails(&Inspection { contacts: 22, ..CLEAN }, &["contacts", "safety"]);
    assert_eq!(certification.unmet[0], "22 contacts, at most 2 allowed");
    assert_eq!(certification.scores.safety, 34.0, "22 contacts cost 3 points each");
}

#[test]
fn regress_two_slow_contacts_are_allowed_but_a_fast_one_is_not() {
    assert!(Inspection { contacts: 2, contact_speed_m_s: 0.8, ..CLEAN }.fly().passed);
    let certification = assert_fails(&Inspection { contacts: 1, contact_speed_m_s: 1.5, ..CLEAN }, &["contact_speed"]);
    assert_eq!(certification.unmet, ["contact at 1.5 m/s, at most 1 m/s allowed"]);
}

#[test]
fn regress_speeding_everywhere_is_not_certified() {
    let certification = assert_fails(&Inspection { speed_m_s: 8.0, ..CLEAN }, &["conformity", "precision"]);
    assert!(certification.tasks[0].precision.unwrap().rms_speeding_ratio > 0.5, "{:?}", certification.tasks);
}

#[test]
fn regress_flight_without_pictures_is_not_certified() {
    let certification = assert_fails(&Inspection { photographs: false, ..CLEAN }, &["accuracy"]);
    assert_eq!(certification.unmet, ["accuracy 0, 50 needed"]);
}

#[test]
fn regress_blurred_pictures_are_no_hits() {
    let certification = assert_fails(&Inspection { stops: false, speed_m_s: 4.0, ..CLEAN }, &["accuracy"]);
    let pictures = &certification.accuracy.pictures;
    assert!(pictures.iter().any(|picture| picture.fails.iter().any(|reason| reason.contains("motion blur"))), "{pictures:?}");
}

#[test]
fn regress_yaw_noise_is_not_certified() {
    let certification = assert_fails(&Inspection { yaw_noise_rad: math::FRAC_PI_2, ..CLEAN }, &["precision"]);
    let (measures, clean) = (certification.precision.unwrap(), CLEAN.fly().precision.unwrap());
    assert_eq!(measures.rms_distance_ratio, clean.rms_distance_ratio, "only the heading is wrong");
    assert!(measures.rms_framing_deg.unwrap() > 33.0 && clean.rms_framing_deg.unwrap() == 0.0, "{measures:?}");
}

#[test]
fn regress_low_battery_and_missing_landing_are_not_certified() {
    let certification = assert_fails(&Inspection { battery_pct: 15, ..CLEAN }, &["battery"]);
    assert_eq!(certification.unmet, ["15% battery at landing, 20% needed"]);
    let certification = assert_fails(&Inspection { lands: false, ..CLEAN }, &["landed_at_home", "battery"]);
    assert_eq!(certification.unmet, ["not landed at home"]);
}

#[test]
fn exact_rewound_flight_is_practice() {
    let certification = assert_fails(&Inspection { rewinds: 2, ..CLEAN }, &["practice_aids"]);
    assert_eq!(certification.unmet, ["rewound twice, so it was practice"]);
    assert_eq!(certification.scores, CLEAN.fly().scores, "the scores stay those of the flight");
}

#[test]
fn exact_requirements_are_scenario_values() {
    let mut lenient = job();
    lenient.certification.max_contacts = 22;
    lenient.certification.min_safety = 34.0;
    let mut tape = Tape::new();
    tape.hold(1.0);
    tape.fly((0.0, 0.0, 10.0), 2.0);
    tape.fly((110.0, 0.0, 10.0), 4.0);
    Inspection { contacts: 22, ..CLEAN }.collide(&mut tape);
    tape.land();
    let certification = score_tape(&tape, &lenient).assessment.certification;
    assert_eq!(unmet(&certification), ["accuracy"], "{:?}", certification.requirements);
}
