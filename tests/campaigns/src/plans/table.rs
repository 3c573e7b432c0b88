//! Plans for the planted flights, and how often they recommend the right drill.

use crate::flights::fly_all;
use crate::weaknesses::{NO_WEAKNESS, Weakness};
use spandrel_text::Language;
use spandrel_training::plan::{PlanRules, TrainingPlan, plan};
use spandrel_training::record::SessionRecord;
use std::fmt;

/// Position of the right drill from which it no longer counts.
const AMONG: usize = 3;
/// The job of the plans.
const JOB: &str = "two-bridges";

/// One flight of the job.
pub struct Flown {
    pub weakness: &'static Weakness,
    pub seed: u64,
    pub record: SessionRecord,
}

/// Flies the job without a weakness and then with each one, with every seed, on all cores.
pub fn fly_job(weaknesses: impl Iterator<Item = &'static Weakness>, seeds: &[u64]) -> Vec<Flown> {
    let flights: Vec<(&'static Weakness, u64)> = std::iter::once(&NO_WEAKNESS)
        .chain(weaknesses)
        .flat_map(|weakness| seeds.iter().map(move |seed| (weakness, *seed)))
        .collect();
    let records = fly_all(JOB, &flights);
    flights.into_iter().zip(records).map(|((weakness, seed), record)| Flown { weakness, seed, record }).collect()
}

/// Plan for one flight.
struct PlantedPlan {
    weakness: &'static Weakness,
    seed: u64,
    plan: TrainingPlan,
}

impl PlantedPlan {
    /// Returns the position of the right drill in the plan, from 0.
    fn position(&self) -> Option<usize> {
        self.plan.steps.iter().position(|step| self.weakness.drills.contains(&step.scenario.as_str()))
    }

    /// Returns the recommended scenarios that neither the weakness nor its consequences call for.
    fn spurious(&self) -> Vec<&str> {
        let names = self.plan.steps.iter().map(|step| step.scenario.as_str());
        names.filter(|name| !self.weakness.drills.contains(name) && !self.weakness.also.contains(name)).collect()
    }
}

/// Plans for all planted flights.
pub struct PlanTable {
    planted: Vec<PlantedPlan>,
    /// Plans for the pilot without a fault.
    clean: Vec<PlantedPlan>,
}

impl PlanTable {
    /// Plans for flights with and without a weakness.
    pub fn of(flown: Vec<Flown>, rules: &PlanRules) -> Self {
        let of = |Flown { weakness, seed, record }: Flown| {
            let plan = plan(std::slice::from_ref(&record), rules, record.started_unix_us, Language::English).unwrap();
            PlantedPlan { weakness, seed, plan }
        };
        let is_clean = |one: &PlantedPlan| one.weakness.name == NO_WEAKNESS.name;
        let (clean, planted) = flown.into_iter().map(of).partition(is_clean);
        Self { planted, clean }
    }

    fn share(&self, holds: impl Fn(&PlantedPlan) -> bool) -> f64 {
        self.planted.iter().filter(|one| holds(one)).count() as f64 / self.planted.len() as f64
    }

    /// Returns the share of plans whose first scenario is the right drill.
    pub fn share_first(&self) -> f64 {
        self.share(|one| one.position() == Some(0))
    }

    /// Returns the share of plans whose first three scenarios contain the right drill.
    pub fn share_among_three(&self) -> f64 {
        self.share(|one| one.position().is_some_and(|at| at < AMONG))
    }

    /// Returns the share of all plans, those for the pilot without a fault included, with a spurious scenario.
    pub fn share_spurious(&self) -> f64 {
        let all = self.planted.iter().chain(&self.clean);
        all.clone().filter(|one| !one.spurious().is_empty()).count() as f64 / all.count() as f64
    }
}

impl fmt::Display for PlanTable {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        writeln!(
            f,
            "| weakness | seed | right drill | place | plan | cause of each | spurious |\n|---|---|---|---|---|---|---|"
        )?;
        for one in self.clean.iter().chain(&self.planted) {
            let names: Vec<&str> = one.plan.steps.iter().map(|step| step.scenario.as_str()).collect();
            let place = one.position().map_or("-".to_owned(), |at| (at + 1).to_string());
            let causes: Vec<&str> = one.plan.steps.iter().map(|step| step.reasons[0].rule.as_str()).collect();
            let cause = causes.join(", ");
            let (drills, spurious) = (one.weakness.drills.join(" or "), one.spurious().join(", "));
            let Weakness { name, .. } = one.weakness;
            writeln!(f, "| {name} | {} | {drills} | {place} | {} | {cause} | {spurious} |", one.seed, names.join(", "))?;
        }
        let percent = |share: f64| 100.0 * share;
        write!(
            f,
            "\nright drill first: {:.1}%, among the first three: {:.1}%, plans with a spurious drill: {:.1}%",
            percent(self.share_first()),
            percent(self.share_among_three()),
            percent(self.share_spurious())
        )
    }
}
