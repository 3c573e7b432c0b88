//! Certification of flights with a planted fault: none may be certified, and the requirement that the fault violates must be
//! among the unmet ones.

use crate::flights::fly_all;
use crate::weaknesses::{GRAVE_FAULTS, NO_WEAKNESS, WEAKNESSES, Weakness};
use spandrel_training::record::SessionRecord;
use std::fmt;

/// The job for certifications.
const JOB: &str = "certification";

/// A planted fault, and what it must lead to.
pub struct CertificationFault {
    /// Name of the weakness.
    pub weakness: &'static str,
    /// Requirements, by ID, that the flight must not meet.
    pub requirements: &'static [&'static str],
    /// Highest allowed conformity of the certification profile.
    pub most_conformity: f64,
}

const fn fault(weakness: &'static str, requirements: &'static [&'static str], most_conformity: f64) -> CertificationFault {
    CertificationFault { weakness, requirements, most_conformity }
}

/// Highest conformity of a flight that covers 49% of every path (issue 19).
const MAX_CONFORMITY_OF_HALF: f64 = 60.0;

/// The faults of issue 19, and the requirement that each one violates.
pub const CERTIFICATION_FAULTS: &[CertificationFault] = &[
    fault("half of every path", &["tasks_done", "conformity"], MAX_CONFORMITY_OF_HALF),
    fault("49% of every path", &["tasks_done", "conformity"], MAX_CONFORMITY_OF_HALF),
    fault("4 m off throughout", &["tasks_done", "conformity"], MAX_CONFORMITY_OF_HALF),
    fault("drives into the bridge", &["contacts", "contact_speed", "safety"], 100.0),
    fault("too fast everywhere", &["precision"], 100.0),
    fault("no pictures", &["accuracy"], 100.0),
    // The pictures of a drone whose nose never rests are blurred or show something else.
    fault("yaw noise", &["accuracy"], 100.0),
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

/// The flights of the faults and of the pilot without a fault.
pub struct CertificationTable {
    flown: Vec<(Option<&'static CertificationFault>, SessionRecord)>,
}

fn weakness(name: &str) -> &'static Weakness {
    WEAKNESSES.iter().chain(GRAVE_FAULTS).find(|one| one.name == name).unwrap()
}

impl CertificationTable {
    /// Flies every fault, and the pilot without one, with every seed.
    pub fn fly(faults: &'static [CertificationFault], seeds: &[u64]) -> Self {
        let all: Vec<Option<&CertificationFault>> = std::iter::once(None).chain(faults.iter().map(Some)).collect();
        let planned = all.iter().flat_map(|fault| seeds.iter().map(move |seed| (*fault, *seed)));
        let (of, flights): (Vec<_>, Vec<_>) =
            planned.map(|(fault, seed)| (fault, (fault.map_or(&NO_WEAKNESS, |fault| weakness(fault.weakness)), seed))).unzip();
        Self { flown: of.into_iter().zip(fly_all(JOB, &flights)).collect() }
    }

    /// Returns what contradicts the expectations: flights with a fault that are certified or fail for another reason, and flights
    /// without a fault that fail.
    pub fn problems(&self) -> Vec<String> {
        self.flown.iter().flat_map(|(fault, record)| problems(*fault, record)).collect()
    }
}

fn problems(fault: Option<&CertificationFault>, record: &SessionRecord) -> Vec<String> {
    let Some(fault) = fault else {
        let failed = (!record.certified).then(|| format!("{}: not certified: {}", record.id, record.unmet.join("; ")));
        return failed.into_iter().collect();
    };
    let mut problems = Vec::new();
    if record.certified {
        problems.push(format!("{}: certified", record.id));
    }
    let certification = record.certification.as_ref().unwrap();
    for id in fault.requirements {
        let requirement = certification.requirements.iter().find(|one| one.id == *id).unwrap();
        let is_listed = record.unmet.iter().any(|words| is_about(words, id));
        if requirement.met || !is_listed {
            problems.push(format!("{}: {id} is met; unmet: {}", record.id, record.unmet.join("; ")));
        }
    }
    let conformity = certification.scores.conformity.unwrap_or(0.0);
    if conformity > fault.most_conformity {
        problems.push(format!("{}: conformity {conformity} exceeds {}", record.id, fault.most_conformity));
    }
    problems
}

impl fmt::Display for CertificationTable {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        writeln!(f, "| fault | seed | certified | requirement that it violates | not met |\n|---|---|---|---|---|")?;
        for (fault, record) in &self.flown {
            let (name, violated) = fault.map_or(("none", String::new()), |one| (one.weakness, one.requirements.join(", ")));
            let certified = if record.certified { "yes" } else { "no" };
            writeln!(f, "| {name} | {} | {certified} | {violated} | {} |", record.seed, record.unmet.join("; "))?;
        }
        Ok(())
    }
}
