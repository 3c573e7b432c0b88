//! Planted weaknesses: the synthetic pilot flies the job with one fault. The training plan must recommend the drill for it, and a
//! grave fault must prevent the certification.
#![allow(clippy::unwrap_used, reason = "a test")]

mod certification;
mod flight;
mod flights;
mod table;
mod weaknesses;

use certification::{CERTIFICATION_FAULTS, CertificationTable};
use spandrel_training::plan::{DEFAULT_RULES, PlanRules, read_rules};
use table::PlanTable;
use weaknesses::WEAKNESSES;

/// First seed of the table in docs/src/measured/plans.md, which has three. One is enough to notice that a rule no longer fits,
/// and takes a third of the time.
const SEED: u64 = 301;
/// Required share of flights with the right drill first (issue 19).
const MIN_FIRST: f64 = 0.90;
/// Required share of flights with the right drill among the first three (issue 19).
const MIN_AMONG_THREE: f64 = 0.98;
/// Maximum share of plans with a drill that neither the weakness nor its consequences call for (issue 19).
const MAX_SPURIOUS: f64 = 0.05;

/// Returns the seeds to fly: one, or those in `SPANDREL_SEEDS`, separated by commas.
fn seeds() -> Vec<u64> {
    match std::env::var("SPANDREL_SEEDS") {
        Ok(list) => list.split(',').map(|seed| seed.trim().parse().unwrap()).collect(),
        Err(_) => vec![SEED],
    }
}

/// Returns the shipped rules, or those in the file in `SPANDREL_PLAN_RULES`.
fn rules() -> PlanRules {
    let own = std::env::var("SPANDREL_PLAN_RULES").ok().map(|path| std::fs::read_to_string(path).unwrap());
    read_rules("rules.toml", own.as_deref().unwrap_or(DEFAULT_RULES)).unwrap_or_else(|problems| panic!("{problems}"))
}

#[test]
fn flight_plans_recommend_the_drill_for_the_planted_weakness() {
    let rules = rules();
    let table = PlanTable::fly(WEAKNESSES, &seeds(), &rules);
    println!("{table}");
    assert!(table.share_first() >= MIN_FIRST, "the right drill is first in {:.0}% of the plans", 100.0 * table.share_first());
    assert!(table.share_among_three() >= MIN_AMONG_THREE, "{:.0}% have it", 100.0 * table.share_among_three());
    assert!(table.share_spurious() <= MAX_SPURIOUS, "{:.0}% are spurious", 100.0 * table.share_spurious());
}

#[test]
fn flight_planted_faults_are_not_certified_for_the_right_reason() {
    let table = CertificationTable::fly(CERTIFICATION_FAULTS, &seeds());
    println!("{table}");
    assert_eq!(table.problems(), Vec::<String>::new());
}
