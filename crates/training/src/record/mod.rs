//! Session records, which contain all data needed for progress, cohorts and plans. A record is computed solely from the
//! session folder, so it can be recreated at any time.

mod causes;
mod crashes;
mod form;
mod level;
mod outcome;
mod source;
mod task_record;
mod technique;

pub use crashes::Crashes;
pub use form::{FlownForm, differing_forms};
pub use level::SessionLevel;
pub use outcome::SessionOutcome;
pub use source::{FORMAT_VERSION, RecordSource, SourceHashes};
pub use task_record::{DefectRecord, TaskRecord};
pub(crate) use technique::{
    MAX_OFF_PATH_DISTANCE_M, NearPath, clearance_limit_m, is_drifting, is_in_motion, is_turning, last_approach, near_frames,
};
pub use technique::{SessionTechnique, TaskTechnique};

use super::questionnaire::{Answers, ScaleScores, scales};
use serde::{Deserialize, Serialize};
use spandrel_monitor::measures::practice_aids::PracticeAids;
use spandrel_monitor::score::certification::CertificationScores;
use spandrel_monitor::score::certification::precision::PrecisionMeasures;
use spandrel_monitor::score::certification::requirements::Requirement;
use spandrel_monitor::score::completion::Completion;
use spandrel_monitor::score::{SCORER_VERSION, Score};
use spandrel_text::{Language, text};

/// Session record.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct SessionRecord {
    /// Format version of this record.
    pub format: u32,
    /// Session folder name: time, pseudonym, scenario and a short unique ID.
    pub id: String,
    /// Hash of all inputs to the record.
    pub fingerprint: String,
    /// Trainee's pseudonym.
    pub trainee: String,
    /// Session purpose, `practice` or `assessment`; `None` if not specified.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub purpose: Option<String>,
    /// Wall-clock time at simulation time zero, µs since the Unix epoch.
    pub started_unix_us: u64,
    /// Spandrel version that recorded the session.
    pub spandrel_version: String,
    /// Scorer version that computed the scores.
    pub scorer_version: u32,
    /// Machine-readable scenario name, such as `two-bridges`.
    pub scenario: String,
    /// Difficulty level; absent if the scenario had no levels.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub level: Option<SessionLevel>,
    /// Selected form of the scenario; absent if it has no forms, and in records before format 5.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub form: Option<String>,
    /// Predicted detection for which the form's defects were placed, %; absent if the scenario has no forms, and in records before
    /// format 8.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub form_detection_pct: Option<f64>,
    /// SHA-256 of the flown `scenario.toml`, hexadecimal.
    pub scenario_sha256: String,
    /// Vehicle ID, such as `phantom2`.
    pub vehicle: String,
    /// SHA-256 of `vehicle.toml`, hexadecimal.
    pub vehicle_sha256: String,
    /// SHA-256 of `telemetry.tlog`, hexadecimal.
    pub telemetry_sha256: String,
    /// Seed for placing defects and traffic.
    pub seed: u64,
    /// Scores as defined in the TASBID paper.
    pub scores: Scores,
    /// Job completion; absent in format 1 records.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub completion: Option<Completion>,
    /// Tasks in scenario order.
    pub tasks: Vec<TaskRecord>,
    /// Crashes outside all task windows.
    pub crashes_outside: Crashes,
    /// All defects, found or missed.
    pub defects: Vec<DefectRecord>,
    /// Number of snapshots taken.
    pub snapshots: usize,
    /// Number of snapshots that show a new defect.
    pub hits: usize,
    /// Reason why the flight ended: `landed`, `battery`, `time_limit`, `person`, `vehicle`, `crash`, `abort` or
    /// `restart`.
    pub end_reason: String,
    /// Flight duration, s.
    pub seconds: f64,
    /// Whether the battery ran out or the time limit was exceeded.
    pub battery_failed: bool,
    /// Battery charge in the last frame, %.
    pub battery_at_end_pct: f64,
    /// Fraction of frames for which telemetry was received, 0 to 1.
    pub covered: f64,
    /// Whether the session meets all certification requirements.
    pub certified: bool,
    /// Unmet certification requirements, as text.
    #[serde(default)]
    pub unmet: Vec<String>,
    /// Freezes and rewinds; zero in records before format 6.
    #[serde(default)]
    pub practice_aids: PracticeAids,
    /// Certification scores and requirements; absent in records before format 3.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub certification: Option<CertificationRecord>,
    /// Technique outside the tasks; absent in records before format 4.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub technique: Option<SessionTechnique>,
    /// Questionnaire answers, possibly incomplete; `None` if the questionnaire was not started.
    pub answers: Option<Answers>,
}

/// Certification scores, and the requirements with their limits and the values reached.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct CertificationRecord {
    /// Scores from 0 to 100, and their sum.
    pub scores: CertificationScores,
    /// Every requirement, in report order.
    pub requirements: Vec<Requirement>,
    /// Precision measures over the visits to all tasks; absent if no path was entered, and in records before format 7.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub precision: Option<PrecisionMeasures>,
    /// Flight time divided by the time that the job needs; absent in records before format 10.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub time_ratio: Option<f64>,
}

/// The four scores, each from 0 to 100, and their sum.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct Scores {
    /// Conformity; absent for a job without tasks.
    pub conformity: Option<f64>,
    /// Efficiency, based on flight time and return.
    pub efficiency: f64,
    /// Safety, based on crashes.
    pub safety: f64,
    /// Accuracy; absent for a job without defects.
    pub accuracy: Option<f64>,
    /// Sum of all applicable scores.
    pub overall: f64,
    /// Maximum possible `overall`: 100 per applicable score.
    pub overall_max: f64,
}

/// An entry in a list of sessions.
#[derive(Debug, Clone, PartialEq)]
pub struct SessionListEntry {
    /// Session ID (its folder name).
    pub id: String,
    /// Trainee's pseudonym.
    pub trainee: String,
    /// Session purpose, `practice` or `assessment`; `None` if not specified.
    pub purpose: Option<String>,
    /// Start time, µs since the Unix epoch.
    pub started_unix_us: u64,
    /// Machine-readable scenario name, such as `two-bridges`.
    pub scenario: String,
    /// Sum of all applicable scores.
    pub overall: f64,
    /// Maximum possible `overall`.
    pub overall_max: f64,
    /// Reason why the flight ended.
    pub end_reason: String,
    /// Job completion; absent in format 1 records.
    pub completion: Option<Completion>,
    /// Whether the session meets all certification requirements.
    pub certified: bool,
    /// Unmet certification requirements, as text.
    pub unmet: Vec<String>,
}

/// Whether to count incomplete sessions.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum IncompletePolicy {
    /// Excludes incomplete sessions.
    #[default]
    Exclude,
    /// Includes incomplete sessions.
    Include,
}

impl IncompletePolicy {
    /// Returns [`Self::Include`] if `include` is set, otherwise [`Self::Exclude`].
    #[must_use]
    pub fn included(include: bool) -> Self {
        if include { Self::Include } else { Self::Exclude }
    }

    /// Returns whether a session counts under this policy.
    #[must_use]
    pub fn counts(self, record: &SessionRecord) -> bool {
        self == Self::Include || record.is_complete()
    }
}

/// Returns a note with the number of excluded sessions; `None` if it is 0.
#[must_use]
pub fn excluded_sessions_note(count: usize, language: Language) -> Option<String> {
    (count > 0).then(|| text!(language, "completion-excluded-sessions", count = count))
}

/// Returns a note with the number of incomplete sessions that are included; `None` if it is 0.
#[must_use]
pub fn included_sessions_note(count: usize, language: Language) -> Option<String> {
    (count > 0).then(|| text!(language, "completion-included-sessions", count = count))
}

impl SessionOutcome for SessionListEntry {
    fn completion(&self) -> Option<&Completion> {
        self.completion.as_ref()
    }
    fn certification(&self) -> (bool, &[String]) {
        (self.certified, &self.unmet)
    }
}

/// Creates a session record.
#[must_use]
pub fn record(source: &RecordSource<'_>) -> SessionRecord {
    let assessment = &source.assessed_session.assessment;
    let pct = |score: Score| score.pct;
    let causes = causes::causes(source);
    SessionRecord {
        format: FORMAT_VERSION,
        id: source.id.to_owned(),
        fingerprint: source.hashes.fingerprint(),
        trainee: source.trainee.to_owned(),
        purpose: source.purpose.map(str::to_owned),
        started_unix_us: source.started_unix_us,
        spandrel_version: source.spandrel_version.to_owned(),
        scorer_version: SCORER_VERSION,
        scenario: source.scenario.name.clone(),
        level: source.scenario.difficulty.as_ref().map(SessionLevel::of),
        form: source.scenario.form.as_ref().map(|form| form.name.clone()),
        form_detection_pct: form::detection_pct(source.scenario),
        scenario_sha256: source.hashes.scenario.clone(),
        vehicle: source.vehicle.to_owned(),
        vehicle_sha256: source.hashes.vehicle.clone(),
        telemetry_sha256: source.hashes.telemetry.clone(),
        seed: source.assessed_session.seed,
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
        technique: Some(causes.technique),
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
        practice_aids: assessment.practice_aids,
        certification: Some(CertificationRecord {
            scores: assessment.certification.scores,
            requirements: assessment.certification.requirements.clone(),
            precision: assessment.certification.precision,
            time_ratio: Some(assessment.certification.time.ratio),
        }),
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
    /// Returns the scenario name, followed by `@` and a level other than the standard one. Only sessions with the same name
    /// and equated forms are comparable ([`Self::is_same_job`]).
    #[must_use]
    pub fn scenario_with_level(&self) -> String {
        SessionLevel::named(&self.scenario, self.level)
    }

    /// Returns the form that was flown.
    #[must_use]
    pub fn flown_form(&self) -> FlownForm {
        FlownForm { name: self.form.clone(), detection_pct: self.form_detection_pct }
    }

    /// Returns whether both sessions flew the same scenario at the same level, on forms that are equally difficult.
    #[must_use]
    pub fn is_same_job(&self, other: &Self) -> bool {
        self.scenario_with_level() == other.scenario_with_level() && self.flown_form().is_equated_with(&other.flown_form())
    }

    /// Returns whether the session can be compared with others and counts toward mastery: it was neither frozen nor rewound.
    #[must_use]
    pub fn is_unaided(&self) -> bool {
        self.practice_aids.count() == 0
    }

    /// Returns the task numbers in scenario order.
    #[must_use]
    pub fn task_ids(&self) -> Vec<u32> {
        self.tasks.iter().map(|task| task.id).collect()
    }

    /// Returns the crash counts for the whole session.
    #[must_use]
    pub fn crashes(&self) -> Crashes {
        self.tasks.iter().map(|task| task.crashes).fold(self.crashes_outside, Crashes::combined_with)
    }

    /// Returns the crash counts of the whole session with contacts less than a second apart merged; the counts before merging
    /// for records before format 4.
    #[must_use]
    pub fn contacts(&self) -> Crashes {
        self.tasks.iter().map(TaskRecord::contacts).fold(self.contacts_outside(), Crashes::combined_with)
    }

    /// Returns the crash counts outside all task windows, as [`Self::contacts`].
    #[must_use]
    pub fn contacts_outside(&self) -> Crashes {
        self.technique.map_or(self.crashes_outside, |technique| technique.contacts_outside)
    }

    /// Returns the questionnaire's scale scores; `None` if it was not started.
    #[must_use]
    pub fn scales(&self) -> Option<ScaleScores> {
        self.answers.as_ref().map(|answers| scales(answers, &self.task_ids()))
    }

    /// Validates the numbers in a record read from storage.
    ///
    /// # Errors
    /// Returns the invalid key, its value and the allowed range.
    pub fn check(&self) -> Result<(), String> {
        let scores = &self.scores;
        let hundred = [
            ("scores.conformity", scores.conformity),
            ("scores.efficiency", Some(scores.efficiency)),
            ("scores.safety", Some(scores.safety)),
            ("scores.accuracy", scores.accuracy),
            ("battery_at_end_pct", Some(self.battery_at_end_pct)),
            ("form_detection_pct", self.form_detection_pct),
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
        if let Some(level) = self.level {
            level.check()?;
        }
        // Older formats lack this data, so such a session counts as incomplete.
        if !(1..=FORMAT_VERSION).contains(&self.format) {
            return Err(format!("format = {} (allowed: 1 to {FORMAT_VERSION})", self.format));
        }
        Ok(())
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use spandrel_mavlink::contract::contact::ContactKind;

    #[test]
    fn exact_fingerprint_depends_on_every_source() {
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
    fn exact_headlines_are_in_the_language_of_the_page() {
        let record = crate::testing::perfect_record("anna", 1);
        assert_eq!(record.headlines(Language::English), "Complete: 4 of 4 tasks, 100% of the path. Certified");
        assert_eq!(record.headlines(Language::German), "Vollständig: 4 von 4 Aufgaben, 100% der Bahn. Zertifiziert");
        assert_eq!(excluded_sessions_note(2, Language::Spanish).as_deref(), Some("2 sesiones incompletas excluidas"));
        assert_eq!(excluded_sessions_note(0, Language::German), None);
        let pseudo = record.headlines(Language::Pseudo);
        assert_eq!(crate::testing::untranslated_word(&pseudo, &[]), None, "{pseudo}");
    }

    #[test]
    fn exact_crash_counts_are_summed() {
        let mut crashes = Crashes::default();
        for with in [ContactKind::Bridge, ContactKind::Bridge, ContactKind::Water, ContactKind::None, ContactKind::Person] {
            crashes.add(with);
        }
        assert_eq!((crashes.bridge, crashes.water, crashes.total()), (2, 1, 4));
        assert_eq!(crashes.combined_with(crashes).total(), 8);
    }
}
