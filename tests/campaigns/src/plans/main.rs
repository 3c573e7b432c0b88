//! Planted weaknesses: the synthetic pilot flies the job with one fault. The training plan must recommend the drill for it, and a
//! grave fault must prevent the certification.
#![allow(clippy::unwrap_used, reason = "a test")]

mod bumps;
mod certification;
mod flight;
mod flights;
mod fourth;
mod further;
mod table;
mod unseen;
mod weaknesses;

use certification::{CERTIFICATION_FAULTS, CertificationTable};
use fourth::FOURTH;
use further::FURTHER;
use spandrel_training::plan::{DEFAULT_RULES, PlanRules, read_rules};
use table::{Flown, PlanTable, fly_job};
use unseen::{EffectTable, UNSEEN, Unseen};
use weaknesses::WEAKNESSES;

/// First seed of the table in docs/src/measured/plans.md, which has three. One is enough to notice that a rule no longer fits,
/// and takes a third of the time.
const SEED: u64 = 301;
/// First seed of the faults by another author: other sites than those of the planted weaknesses.
const UNSEEN_SEED: u64 = 402;
/// First seed of the third set of faults.
const FURTHER_SEED: u64 = 501;
/// First seed of the fourth set of faults.
const FOURTH_SEED: u64 = 701;

/// Bounds on the plans of a set of flights.
struct RequiredShares {
    /// Least share of flights with the right drill first.
    first: f64,
    /// Least share of flights with the right drill among the first three.
    among_three: f64,
    /// Largest share of plans with a drill that neither the weakness nor its consequences call for.
    spurious: f64,
}

/// Required of the planted weaknesses (docs/src/measured/plans.md).
const REQUIRED_SHARES: RequiredShares = RequiredShares { first: 0.90, among_three: 0.98, spurious: 0.05 };

/// Returns the seeds to fly: one, or those in `SPANDREL_SEEDS`, separated by commas.
fn seeds(one: u64) -> Vec<u64> {
    match std::env::var("SPANDREL_SEEDS") {
        Ok(list) => list.split(',').map(|seed| seed.trim().parse().unwrap()).collect(),
        Err(_) => vec![one],
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
    let table = PlanTable::of(fly_job(WEAKNESSES.iter(), &seeds(SEED)), &rules);
    println!("{table}");
    require_shares(&table, &REQUIRED_SHARES);
}

/// Faults by another author, whose drills an instructor would prescribe.
#[test]
fn flight_plans_recommend_the_drill_for_faults_by_another_author() {
    require_shares(&plans_for_faults_of_another_author(UNSEEN, UNSEEN_SEED), &REQUIRED_SHARES);
}

/// A third set. Every fault must show in its flight. The shares are measured, but not required.
#[test]
fn flight_plans_recommend_the_drill_for_further_faults() {
    plans_for_faults_of_another_author(FURTHER, FURTHER_SEED);
}

/// A fourth set, which covers the whole job evenly. The shares are measured, but not required.
#[test]
fn flight_plans_recommend_the_drill_for_a_fourth_set_of_faults() {
    plans_for_faults_of_another_author(FOURTH, FOURTH_SEED);
}

/// Flies the faults, prints what they do and the plans, and requires that each one has an effect.
fn plans_for_faults_of_another_author(faults: &'static [Unseen], first_seed: u64) -> PlanTable {
    let (rules, seeds) = (rules(), seeds(first_seed));
    let flown = fly_faults(faults, &seeds);
    let effects = EffectTable::of(faults, &flown, &seeds);
    let table = PlanTable::of(flown, &rules);
    println!("{effects}\n{table}");
    require_effects(&effects);
    table
}

/// For the author of a fault, who must not know what the rules make of it.
#[test]
#[ignore = "the test of the plans flies the same flights and requires the same"]
fn flight_unseen_faults_have_an_effect() {
    require_effects_of(UNSEEN, UNSEEN_SEED);
}

#[test]
#[ignore = "the test of the plans flies the same flights and requires the same"]
fn flight_further_faults_have_an_effect() {
    require_effects_of(FURTHER, FURTHER_SEED);
}

#[test]
#[ignore = "the test of the plans flies the same flights and requires the same"]
fn flight_fourth_set_of_faults_has_an_effect() {
    require_effects_of(FOURTH, FOURTH_SEED);
}

fn require_effects_of(faults: &'static [Unseen], first_seed: u64) {
    let seeds = seeds(first_seed);
    let effects = EffectTable::of(faults, &fly_faults(faults, &seeds), &seeds);
    println!("{effects}");
    require_effects(&effects);
}

fn fly_faults(faults: &'static [Unseen], seeds: &[u64]) -> Vec<Flown> {
    fly_job(faults.iter().map(|fault| &fault.weakness), seeds)
}

fn require_effects(effects: &EffectTable) {
    assert_eq!(effects.without_effect(), Vec::<String>::new());
}

fn require_shares(table: &PlanTable, required: &RequiredShares) {
    assert!(
        table.share_first() >= required.first,
        "the right drill is first in {:.0}% of the plans",
        100.0 * table.share_first()
    );
    assert!(table.share_among_three() >= required.among_three, "{:.0}% have it", 100.0 * table.share_among_three());
    assert!(table.share_spurious() <= required.spurious, "{:.0}% are spurious", 100.0 * table.share_spurious());
}

#[test]
fn flight_planted_faults_are_not_certified_for_the_right_reason() {
    let table = CertificationTable::fly(CERTIFICATION_FAULTS, &seeds(SEED));
    println!("{table}");
    assert_eq!(table.problems(), Vec::<String>::new());
}
