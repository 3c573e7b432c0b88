//! Certification of flights with a planted fault: none may be certified, and the requirement that the fault violates must be
//! among the unmet ones.

use crate::flights::fly_all;
use crate::weaknesses::{GRAVE_FAULTS, NO_WEAKNESS, WEAKNESSES, Weakness};
use spandrel_monitor::score::certification::requirements::Requirement;
use spandrel_training::record::SessionRecord;
use std::collections::BTreeMap;
use std::fmt;

/// The job for certifications.
const JOB: &str = "certification";

/// A planted fault, and what it must lead to.
pub struct CertificationFault {
    /// Name of the weakness.
    pub weakness: &'static str,
    /// Requirements, by ID, that the flight must not meet.
    pub violated: &'static [&'static str],
    /// Requirements, by ID, that the flight must meet nevertheless, so that they can't be the reason.
    pub met: &'static [&'static str],
    /// Highest allowed conformity of the certification profile.
    pub most_conformity: f64,
}

const fn fault(weakness: &'static str, violated: &'static [&'static str]) -> CertificationFault {
    CertificationFault { weakness, violated, met: &[], most_conformity: 100.0 }
}

const fn fault_on_paths(weakness: &'static str) -> CertificationFault {
    let violated = &["tasks_done", "conformity"];
    CertificationFault { weakness, violated, met: &[], most_conformity: MAX_CONFORMITY_OF_HALF }
}

/// Highest conformity of a flight that covers 49% of every path (issue 19).
const MAX_CONFORMITY_OF_HALF: f64 = 60.0;
/// Smallest share of flights without a fault that must be certified: the share required of experts.
const MIN_CERTIFIED_WITHOUT_FAULT: f64 = 0.95;

/// The faults of issue 19, and the requirements that each one violates.
pub const CERTIFICATION_FAULTS: &[CertificationFault] = &[
    fault_on_paths("half of every path"),
    fault_on_paths("49% of every path"),
    fault_on_paths("4 m off throughout"),
    CertificationFault {
        met: &["tasks_done", "landed_at_home", "person_or_vehicle_hits", "contact_speed"],
        // Each contact costs points of the safety.
        ..fault("bumps into the bridge 22 times", &["contacts", "safety"])
    },
    fault("too fast everywhere", &["precision"]),
    fault("no pictures", &["accuracy"]),
    // The pictures of a drone whose nose never rests are blurred or show something else.
    CertificationFault { met: &["tasks_done", "landed_at_home", "contacts"], ..fault("nose never rests", &["accuracy"]) },
];

/// Returns whether the text of an unmet requirement is about this one.
fn is_about(words: &str, requirement: &str) -> bool {
    match requirement {
        "tasks_done" => words.starts_with("task "),
        "contacts" => words.contains(" contacts, at most "),
        "contact_speed" => words.starts_with("contact at "),
        score => words.starts_with(&format!("{score} ")) || words == format!("no evidence for {score}"),
    }
}

/// The flights of one fault.
struct FlownFault {
    fault: &'static CertificationFault,
    records: Vec<SessionRecord>,
}

/// The flights of the faults and of the pilot without a fault.
pub struct CertificationTable {
    faultless: Vec<SessionRecord>,
    faults: Vec<FlownFault>,
}

fn weakness(name: &str) -> &'static Weakness {
    WEAKNESSES.iter().chain(GRAVE_FAULTS).find(|one| one.name == name).unwrap()
}

impl CertificationTable {
    /// Flies every fault, and the pilot without one, with every seed.
    pub fn fly(faults: &'static [CertificationFault], seeds: &[u64]) -> Self {
        let pilots = std::iter::once(&NO_WEAKNESS).chain(faults.iter().map(|fault| weakness(fault.weakness)));
        let flights: Vec<_> = pilots.flat_map(|pilot| seeds.iter().map(move |seed| (pilot, *seed))).collect();
        let mut records = fly_all(JOB, &flights).into_iter();
        let mut next = || records.by_ref().take(seeds.len()).collect();
        Self { faultless: next(), faults: faults.iter().map(|fault| FlownFault { fault, records: next() }).collect() }
    }

    /// Returns what contradicts the expectations: flights with a fault that are certified or fail for another reason, and too many
    /// failures without a fault.
    pub fn problems(&self) -> Vec<String> {
        let certified = certified(&self.faultless) as f64 / self.faultless.len() as f64;
        let failures = self.faultless.iter().filter(|record| !record.certified);
        let failed = failures.map(|record| format!("{}: not certified: {}", record.id, record.unmet.join("; ")));
        let too_many = failed.filter(|_| certified < MIN_CERTIFIED_WITHOUT_FAULT);
        let faulty = self.faults.iter().flat_map(|one| one.records.iter().flat_map(|record| problems(one.fault, record)));
        too_many.chain(faulty).collect()
    }
}

fn certified(records: &[SessionRecord]) -> usize {
    records.iter().filter(|record| record.certified).count()
}

fn requirements(record: &SessionRecord) -> &[Requirement] {
    &record.certification.as_ref().unwrap().requirements
}

fn is_met(record: &SessionRecord, id: &str) -> bool {
    requirements(record).iter().find(|one| one.id == id).unwrap().met
}

fn problems(fault: &CertificationFault, record: &SessionRecord) -> Vec<String> {
    let unmet = record.unmet.join("; ");
    let mut problems = Vec::new();
    if record.certified {
        problems.push(format!("{}: certified", record.id));
    }
    for id in fault.violated {
        let is_listed = record.unmet.iter().any(|words| is_about(words, id));
        if is_met(record, id) || !is_listed {
            problems.push(format!("{}: {id} is met; unmet: {unmet}", record.id));
        }
    }
    let missed = fault.met.iter().filter(|id| !is_met(record, id));
    problems.extend(missed.map(|id| format!("{}: {id} is not met; unmet: {unmet}", record.id)));
    let conformity = record.certification.as_ref().unwrap().scores.conformity.unwrap_or(0.0);
    if conformity > fault.most_conformity {
        problems.push(format!("{}: conformity {conformity} exceeds {}", record.id, fault.most_conformity));
    }
    problems
}

/// Counts the flights that don't meet each requirement, for the requirements that a condition selects.
fn unmet_counts(records: &[SessionRecord], is_selected: impl Fn(&str) -> bool) -> BTreeMap<&str, usize> {
    let mut counts = BTreeMap::new();
    for one in records.iter().flat_map(requirements).filter(|one| one.applies && !one.met && is_selected(&one.id)) {
        *counts.entry(one.id.as_str()).or_default() += 1;
    }
    counts
}

fn in_words(counts: &BTreeMap<&str, usize>) -> String {
    counts.iter().map(|(id, count)| format!("{id} {count}")).collect::<Vec<String>>().join(", ")
}

impl fmt::Display for CertificationTable {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        writeln!(f, "| fault | seed | certified | contacts | not met |\n|---|---|---|---|---|")?;
        let flights = self.faults.iter().map(|one| (one.fault.weakness, &one.records));
        let flights: Vec<_> = std::iter::once(("none", &self.faultless)).chain(flights).collect();
        for (name, record) in flights.iter().flat_map(|(name, records)| records.iter().map(move |record| (name, record))) {
            let certified = if record.certified { "yes" } else { "no" };
            let (seed, contacts, unmet) = (record.seed, record.contacts().total(), record.unmet.join("; "));
            writeln!(f, "| {name} | {seed} | {certified} | {contacts} | {unmet} |")?;
        }
        writeln!(
            f,
            "\n| fault | certified | requirement that it violates, not met in flights | other requirements not met |\n|---|---|---|---|"
        )?;
        let none = (certified(&self.faultless), self.faultless.len(), in_words(&unmet_counts(&self.faultless, |_| true)));
        writeln!(f, "| none | {} of {} | | {} |", none.0, none.1, none.2)?;
        for FlownFault { fault, records } in &self.faults {
            let is_violated = |id: &str| fault.violated.contains(&id);
            let violated = in_words(&unmet_counts(records, is_violated));
            let others = in_words(&unmet_counts(records, |id| !is_violated(id)));
            writeln!(f, "| {} | {} of {} | {violated} | {others} |", fault.weakness, certified(records), records.len())?;
        }
        Ok(())
    }
}
