//! What is kept of a session: everything that progress, cohorts and plans need, and nothing that is not in its folder. A record is made
//! from the folder alone and can be made again.

mod causes;
mod outcome;

pub use outcome::SessionOutcome;

use super::questionnaire::{Answers, ScaleScores, scales};
use serde::{Deserialize, Serialize};
use spandrel_mavlink::contract::contact::ContactKind;
use spandrel_model::scenario::{PlacedDefect, Scenario, TaskKind};
use spandrel_monitor::AssessedSession;
use spandrel_monitor::folder::sha256_hex;
use spandrel_monitor::score::completion::{Completion, TaskState};
use spandrel_monitor::score::{SCORER_VERSION, Score};

/// Format of a record; it grows when a record says more, so that older ones are made again.
pub const FORMAT: u32 = 2;

/// One session.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct SessionRecord {
    /// Format of this record.
    pub format: u32,
    /// Name of the session's folder: it holds time, pseudonym, scenario and a short unique id.
    pub id: String,
    /// Over everything that this record was made from.
    pub fingerprint: String,
    /// Pseudonym.
    pub trainee: String,
    /// `practice` or `assessment`, where somebody chose.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub purpose: Option<String>,
    /// Wall time of simulation time zero, µs since the Unix epoch.
    pub started_unix_us: u64,
    /// Version of the program that recorded the session.
    pub spandrel_version: String,
    /// Version of the scorer that made the scores.
    pub scorer_version: u32,
    /// Scenario.
    pub scenario: String,
    /// SHA-256 of `scenario.toml` as flown, hexadecimal.
    pub scenario_sha256: String,
    /// Vehicle.
    pub vehicle: String,
    /// SHA-256 of `vehicle.toml`, hexadecimal.
    pub vehicle_sha256: String,
    /// SHA-256 of `telemetry.tlog`, hexadecimal.
    pub telemetry_sha256: String,
    /// Seed of defects and traffic.
    pub seed: u64,
    /// The paper's scores.
    pub scores: Scores,
    /// How much of the job was done; absent in a record of format 1.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub completion: Option<Completion>,
    /// Tasks in file order.
    pub tasks: Vec<TaskRecord>,
    /// Crashes outside all tasks' windows.
    pub crashes_outside: Crashes,
    /// Defects, found or not.
    pub defects: Vec<DefectRecord>,
    /// Snapshots taken.
    pub snapshots: usize,
    /// Snapshots that show a defect for the first time.
    pub hits: usize,
    /// Why it ended: `landed`, `battery`, `time_limit`, `person`, `vehicle`, `crash`, `abort`, `restart`.
    pub end_reason: String,
    /// Flight time, s.
    pub seconds: f64,
    /// Battery empty or time over.
    pub battery_failed: bool,
    /// Battery at the last frame, %.
    pub battery_at_end_pct: f64,
    /// Share of the frames that telemetry covers.
    pub covered: f64,
    /// The certification profile is passed.
    pub certified: bool,
    /// Requirements of the certification profile that failed, in words.
    #[serde(default)]
    pub unmet: Vec<String>,
    /// Answers to the questionnaire, perhaps not all; absent when none was begun.
    pub answers: Option<Answers>,
}

/// Scores from 0 to 100 each.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct Scores {
    /// Absent for a job without tasks.
    pub conformity: Option<f64>,
    /// Time.
    pub efficiency: f64,
    /// Crashes.
    pub safety: f64,
    /// Absent when no defect was placed.
    pub accuracy: Option<f64>,
    /// Sum of those that apply.
    pub overall: f64,
    /// What the sum is out of.
    pub overall_max: f64,
}

/// One task of a session, with what it suffered from.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct TaskRecord {
    /// Number.
    pub id: u32,
    /// Name.
    pub name: String,
    /// `slab_side`, `arch_bottom`, `interlayer`, `pier_circle`, `free`.
    pub kind: String,
    /// Its path was entered.
    pub attempted: bool,
    /// Done, part or not attempted; absent in a record of format 1.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub state: Option<TaskState>,
    /// Share of its path that was flown, 0 to 1; absent in a record of format 1.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub covered: Option<f64>,
    /// From first to last on-path frame, s.
    pub seconds: f64,
    /// Share of that time on the path, 0 to 1.
    pub on_path: f64,
    /// The paper's weighted share of that time over the speed limit.
    pub speeding: f64,
    /// Over the limit, s.
    pub speeding_s: f64,
    /// Fastest in that time, m/s.
    pub fastest_m_s: f64,
    /// Off the path but within 8 m of it, s.
    pub off_path_s: f64,
    /// Mean horizontal distance from the path while off it, m; absent when never off.
    pub off_sideways_m: Option<f64>,
    /// Mean vertical distance from the path while off it, m; absent when never off.
    pub off_height_m: Option<f64>,
    /// Crashes in its window.
    pub crashes: Crashes,
    /// Defects that lie nearest to its path.
    pub defects_placed: usize,
    /// Of these, found.
    pub defects_found: usize,
}

/// Crashes by what was hit.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize)]
pub struct Crashes {
    /// Bridges.
    pub bridge: usize,
    /// The ground.
    pub terrain: usize,
    /// The water.
    pub water: usize,
    /// Anything else that is no traffic.
    pub other: usize,
    /// Cars and trucks.
    pub vehicle: usize,
    /// Persons.
    pub person: usize,
}

/// One defect of a session.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct DefectRecord {
    /// Number.
    pub id: u32,
    /// Code (AASHTO MBEI).
    pub kind: u32,
    /// Plain name of the code.
    pub kind_name: String,
    /// Element (AASHTO MBEI).
    pub element: u32,
    /// Condition state.
    pub condition_state: u8,
    /// Number of the task whose path is nearest; absent without tasks.
    pub task: Option<u32>,
    /// A snapshot shows it.
    pub found: bool,
    /// Of one that was not found: what its best picture lacked; empty when no picture was near it.
    pub lacked: Vec<String>,
    /// Of one that was not found: time for which one press would have been a hit, s. Only a session's report works it out.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub in_view_s: Option<f64>,
}

/// One line of a list of sessions.
#[derive(Debug, Clone, PartialEq)]
pub struct SessionListEntry {
    /// Session.
    pub id: String,
    /// Pseudonym.
    pub trainee: String,
    /// `practice` or `assessment`, where somebody chose.
    pub purpose: Option<String>,
    /// µs since the Unix epoch.
    pub started_unix_us: u64,
    /// Job.
    pub scenario: String,
    /// Sum of the scores.
    pub overall: f64,
    /// What it is out of.
    pub overall_max: f64,
    /// Why it ended.
    pub end_reason: String,
    /// How much of the job was done; absent in a record of format 1.
    pub completion: Option<Completion>,
    /// The certification profile is passed.
    pub certified: bool,
    /// Requirements of it that failed, in words.
    pub unmet: Vec<String>,
}

/// Whether incomplete sessions count.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum IncompletePolicy {
    /// They are left out.
    #[default]
    LeaveOut,
    /// They count as any other.
    Include,
}

impl IncompletePolicy {
    /// From a switch.
    #[must_use]
    pub fn included(include: bool) -> Self {
        if include { Self::Include } else { Self::LeaveOut }
    }

    /// Whether a session counts.
    #[must_use]
    pub fn counts(self, record: &SessionRecord) -> bool {
        self == Self::Include || record.is_complete()
    }
}

/// How many incomplete sessions were left out, in words; `None` for none.
#[must_use]
pub fn omitted_summary(count: usize) -> Option<String> {
    match count {
        0 => None,
        1 => Some("1 incomplete session left out".to_owned()),
        many => Some(format!("{many} incomplete sessions left out")),
    }
}

impl SessionOutcome for SessionListEntry {
    fn completion(&self) -> Option<&Completion> {
        self.completion.as_ref()
    }
    fn certification(&self) -> (bool, &[String]) {
        (self.certified, &self.unmet)
    }
}

/// What a record is made from.
#[derive(Debug, Clone, Copy)]
pub struct RecordSource<'a> {
    /// Name of the session's folder.
    pub id: &'a str,
    /// Pseudonym.
    pub trainee: &'a str,
    /// `practice` or `assessment`, where somebody chose.
    pub purpose: Option<&'a str>,
    /// Wall time of simulation time zero, µs since the Unix epoch.
    pub started_unix_us: u64,
    /// Version of the program that recorded it.
    pub spandrel_version: &'a str,
    /// Job.
    pub scenario: &'a Scenario,
    /// Id of the aircraft.
    pub vehicle: &'a str,
    /// Its hashes.
    pub hashes: &'a SourceHashes,
    /// Scores and frames.
    pub graded: &'a AssessedSession,
    /// Defects of the session's seed.
    pub placed: &'a [PlacedDefect],
    /// Answers, if begun.
    pub answers: Option<&'a Answers>,
}

/// SHA-256 of a session's source files, hexadecimal.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct SourceHashes {
    /// `scenario.toml`.
    pub scenario: String,
    /// `vehicle.toml`.
    pub vehicle: String,
    /// `telemetry.tlog`.
    pub telemetry: String,
    /// `answers.json`; of nothing when there is none.
    pub answers: String,
}

impl SourceHashes {
    /// Of the files' bytes.
    #[must_use]
    pub fn of(scenario: &[u8], vehicle: &[u8], telemetry: &[u8], answers: &[u8]) -> Self {
        let hex = sha256_hex;
        Self { scenario: hex(scenario), vehicle: hex(vehicle), telemetry: hex(telemetry), answers: hex(answers) }
    }

    /// One hash over all, the scorer and the record's format: while it stays the same, so does the record.
    #[must_use]
    pub fn fingerprint(&self) -> String {
        let Self { scenario, vehicle, telemetry, answers } = self;
        sha256_hex(format!("{FORMAT} {SCORER_VERSION} {scenario} {vehicle} {telemetry} {answers}").as_bytes())
    }
}

/// Makes the record of a session.
#[must_use]
pub fn record(source: &RecordSource<'_>) -> SessionRecord {
    let assessment = &source.graded.assessment;
    let pct = |score: Score| score.pct;
    let causes = causes::causes(source);
    SessionRecord {
        format: FORMAT,
        id: source.id.to_owned(),
        fingerprint: source.hashes.fingerprint(),
        trainee: source.trainee.to_owned(),
        purpose: source.purpose.map(str::to_owned),
        started_unix_us: source.started_unix_us,
        spandrel_version: source.spandrel_version.to_owned(),
        scorer_version: SCORER_VERSION,
        scenario: source.scenario.name.clone(),
        scenario_sha256: source.hashes.scenario.clone(),
        vehicle: source.vehicle.to_owned(),
        vehicle_sha256: source.hashes.vehicle.clone(),
        telemetry_sha256: source.hashes.telemetry.clone(),
        seed: source.graded.seed,
        scores: Scores {
            conformity: assessment.scores.conformity.map(pct),
            efficiency: assessment.scores.efficiency.pct,
            safety: assessment.scores.safety.pct,
            accuracy: assessment.scores.accuracy.map(pct),
            overall: assessment.scores.overall,
            overall_max: assessment.scores.overall_max,
        },
        completion: Some(assessment.completion),
        tasks: causes.tasks,
        crashes_outside: causes.crashes_outside,
        defects: causes.defects,
        snapshots: assessment.snapshots.taken,
        hits: assessment.snapshots.hits,
        end_reason: assessment.end.reason.label().to_owned(),
        seconds: assessment.end.seconds,
        battery_failed: assessment.end.battery_failed,
        battery_at_end_pct: assessment.certification.battery_at_end_pct,
        covered: assessment.telemetry.covered,
        certified: assessment.certification.passed,
        unmet: assessment.certification.unmet.clone(),
        answers: source.answers.cloned(),
    }
}

impl SessionOutcome for SessionRecord {
    fn completion(&self) -> Option<&Completion> {
        self.completion.as_ref()
    }
    fn certification(&self) -> (bool, &[String]) {
        (self.certified, &self.unmet)
    }
}

impl SessionRecord {
    /// Numbers of the tasks.
    #[must_use]
    pub fn task_ids(&self) -> Vec<u32> {
        self.tasks.iter().map(|task| task.id).collect()
    }

    /// All crashes.
    #[must_use]
    pub fn crashes(&self) -> Crashes {
        self.tasks.iter().map(|task| task.crashes).fold(self.crashes_outside, Crashes::with_added)
    }

    /// What the answers add up to.
    #[must_use]
    pub fn scales(&self) -> Option<ScaleScores> {
        self.answers.as_ref().map(|answers| scales(answers, &self.task_ids()))
    }

    /// Refuses numbers that no session has.
    ///
    /// # Errors
    /// The key, the value and what is allowed.
    pub fn check(&self) -> Result<(), String> {
        let scores = &self.scores;
        let hundred = [
            ("scores.conformity", scores.conformity),
            ("scores.efficiency", Some(scores.efficiency)),
            ("scores.safety", Some(scores.safety)),
            ("scores.accuracy", scores.accuracy),
            ("battery_at_end_pct", Some(self.battery_at_end_pct)),
        ];
        let shares = self.tasks.iter().map(|task| ("tasks.on_path", Some(task.on_path), 1.0));
        let covered = self.tasks.iter().map(|task| ("tasks.covered", task.covered, 1.0));
        let path = ("completion.path_share", self.completion.map(|completion| completion.path_share), 1.0);
        let rest =
            [path, ("scores.overall", Some(scores.overall), scores.overall_max), ("seconds", Some(self.seconds), 86_400.0)];
        for (key, value, most) in
            hundred.into_iter().map(|(key, value)| (key, value, 100.0)).chain(shares).chain(covered).chain(rest)
        {
            if let Some(value) = value.filter(|value| !(0.0..=most).contains(value)) {
                return Err(format!("{key} = {value} (allowed: 0 to {most})"));
            }
        }
        // What an older format does not say is unknown, and such a session counts as incomplete.
        if !(1..=FORMAT).contains(&self.format) {
            return Err(format!("format = {} (allowed: 1 to {FORMAT})", self.format));
        }
        Ok(())
    }
}

impl Crashes {
    /// Counts one.
    fn add(&mut self, with: ContactKind) {
        match with {
            ContactKind::None => {}
            ContactKind::Bridge => self.bridge += 1,
            ContactKind::Terrain => self.terrain += 1,
            ContactKind::Water => self.water += 1,
            ContactKind::Other => self.other += 1,
            ContactKind::Vehicle => self.vehicle += 1,
            ContactKind::Person => self.person += 1,
        }
    }

    /// Both together.
    #[must_use]
    pub fn with_added(self, more: Self) -> Self {
        Self {
            bridge: self.bridge + more.bridge,
            terrain: self.terrain + more.terrain,
            water: self.water + more.water,
            other: self.other + more.other,
            vehicle: self.vehicle + more.vehicle,
            person: self.person + more.person,
        }
    }

    /// Each kind with its word.
    #[must_use]
    pub fn by_kind(&self) -> [(&'static str, usize); 6] {
        [
            ("bridge", self.bridge),
            ("terrain", self.terrain),
            ("water", self.water),
            ("other", self.other),
            ("vehicle", self.vehicle),
            ("person", self.person),
        ]
    }

    /// All of them.
    #[must_use]
    pub fn total(&self) -> usize {
        self.by_kind().iter().map(|(_, count)| count).sum()
    }
}

fn kind_word(kind: TaskKind) -> &'static str {
    match kind {
        TaskKind::SlabSide => "slab_side",
        TaskKind::ArchBottom => "arch_bottom",
        TaskKind::Interlayer => "interlayer",
        TaskKind::PierCircle => "pier_circle",
        TaskKind::Free => "free",
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn exact_a_fingerprint_follows_every_source() {
        let base = SourceHashes::of(b"s", b"v", b"t", b"");
        let others = [
            SourceHashes::of(b"S", b"v", b"t", b""),
            SourceHashes::of(b"s", b"V", b"t", b""),
            SourceHashes::of(b"s", b"v", b"T", b""),
            SourceHashes::of(b"s", b"v", b"t", b"a"),
        ];
        for other in others {
            assert_ne!(base.fingerprint(), other.fingerprint());
        }
        assert_eq!(base.fingerprint(), SourceHashes::of(b"s", b"v", b"t", b"").fingerprint());
    }

    #[test]
    fn exact_crashes_add_up() {
        let mut crashes = Crashes::default();
        for with in [ContactKind::Bridge, ContactKind::Bridge, ContactKind::Water, ContactKind::None, ContactKind::Person] {
            crashes.add(with);
        }
        assert_eq!((crashes.bridge, crashes.water, crashes.total()), (2, 1, 4));
        assert_eq!(crashes.with_added(crashes).total(), 8);
    }
}
